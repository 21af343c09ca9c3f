// The app's page: asks the server on this computer, shows its answers, and sends what is chosen.

import { left, showAnalyses, showEarlier } from "./analyses.js";
import { button, find, link, make, renew, signal, size } from "./building.js";
import { showChannels, showFiles } from "./channels.js";
import { showMachine } from "./machine.js";

const at = (id) => document.getElementById(id);
const SOON = 400;
let refused = false; // what is said was refused while something ran: it no longer holds when nothing does
let token = "", questions = null, analyses = [], earlier = [], current = "", view = null, timer = 0;

/** Ask the server; what it refuses is said above the page. */
async function ask(method, path, body, headers = {}) {
  let answer, said;
  try {
    answer = await fetch(`api/${path}`, { method, body, headers: { "X-Hersey-Token": token, ...headers } });
    said = await answer.json(); // which fails, too, if the server ends while it answers
  } catch {
    say("hersey app does not answer: it has ended. Start it again and open the address it prints.");
    return null;
  }
  if (answer.ok) return said;
  say(said.error);
  refused = busy();
  return null;
}
const busy = () => analyses.some((one) => one.state === "running" || one.state === "preparing");
const post = (path, given = {}) => ask("POST", path, JSON.stringify(given), { "Content-Type": "application/json" });

function say(words) {
  refused = false;
  at("problem").textContent = words;
  at("problem").hidden = !words;
}

async function refresh() {
  clearTimeout(timer);
  const state = await ask("GET", "state");
  if (!state || pending) return;
  analyses = state.analyses;
  earlier = state.earlier;
  if (!analyses.some((one) => one.id === current)) current = analyses.at(-1)?.id ?? "";
  const line = analyses.find((one) => one.id === current);
  if (line && (view?.id !== current || view.revision !== line.revision || arriving())) await look();
  else if (line) Object.assign(view, { state: line.state, step: line.step, share: line.share, spent: line.spent, left: line.left });
  show();
  if (refused && !busy()) say("");
  const more = busy() || view?.files.some((file) => file.state === "arriving" || file.state === "looking");
  if (more) timer = setTimeout(refresh, SOON);
}

const arriving = () => view?.files.some((file) => file.state === "arriving");

async function look() {
  const seen = await ask("GET", `analyses/${current}`);
  if (seen && !pending && seen.id === current) view = seen;
}

let pending = 0, queue = Promise.resolve();

/** Change something, one change after the other; what the server says of all but the last is old. */
function change(asked) {
  pending += 1;
  queue = queue.then(async () => {
    const seen = await asked();
    pending -= 1;
    if (seen && !pending && seen.id === current) view = seen;
    if (!pending) await refresh();
    return seen;
  });
  return queue;
}

const here = () => `analyses/${current}`;
const act = {
  show: async (id) => { current = id; say(""); await refresh(); },
  removeAnalysis: async (id) => { await ask("DELETE", `analyses/${id}`); await refresh(); },
  cancel: async (id) => { await post(`analyses/${id}/cancel`); await refresh(); },
  removeFile: (file) => change(() => ask("DELETE", `${here()}/files/${file.id}`)),
  choose: (given) => change(() => post(`${here()}/choices`, given)),
  mend: async (fault) => { say(""); await change(() => post(`${here()}/mend`, { fault: fault.key })); (find(fault.at) ?? at("run"))?.focus(); },
  keep: (fault) => change(() => post(`${here()}/mend`, { fault: fault.key, keep: true })),
  machine: (given) => change(() => post(`${here()}/machine`, given)),
  turn: async (mode) => { const seen = await change(() => post(`${here()}/machine`, { mode })); if (seen?.refused) { view.refused = seen.refused; show(); } },
};

async function send(files) {
  say("");
  const dropped = [...files]; // a list of the browser's may change
  await queue; // a new analysis may just be made
  const one = current;
  const sent = dropped.map((file) => ask("POST", `analyses/${one}/files`, file, { "X-Name": encodeURIComponent(file.name), "Content-Type": "application/octet-stream" }));
  setTimeout(refresh, SOON / 8); // the file is in the list while it is still on its way
  await Promise.all(sent);
  await refresh();
}

async function save(path, name, kind) {
  const answer = await fetch(`api/${here()}/${path}`, { headers: { "X-Hersey-Token": token } });
  if (!answer.ok) return say((await answer.json().catch(() => ({ error: "This file is no longer here." }))).error);
  const url = URL.createObjectURL(new Blob([await answer.blob()], { type: kind }));
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
  return undefined;
}

function show() {
  if (!view || !questions) return;
  at("what").textContent = view.files.length ? view.name : "New analysis";
  showAnalyses(at("analyses"), analyses, current, act);
  showEarlier(at("earlier"), earlier);
  showFiles(at("files"), view, act);
  showChannels(at("channels"), view, questions, act);
  showMachine(at("machine"), view, questions, act);
  showBar();
  document.body.dataset.ready = "true";
}

/** Start a run; that it starts is shown at once, before the server has answered. */
function start() {
  say("");
  const shown = { state: "preparing", step: "starting", share: null, spent: null, left: null };
  Object.assign(view, shown);
  Object.assign(analyses.find((one) => one.id === current) ?? {}, shown);
  const asked = change(() => post(`${here()}/run`));
  show();
  return asked;
}

/** Run, what must be fixed before it, and what can be saved. */
function showBar() {
  const busy = view.state === "running" || view.state === "preparing";
  const stem = (view.log?.name ?? "log").replace(/\.[^.]*$/, "");
  const run = make("button", { class: "run", id: "run", type: "button", text: view.report ? "Run again" : "Run", "data-control": "run", "aria-disabled": String(!view.ready || busy), "aria-describedby": "why",
    onclick: () => { if (view.ready && !busy) start(); } });
  renew(at("bar"), run, make("span", { class: "why", id: "why", "aria-live": "polite" }, ...why(busy)),
    make("span", { class: "right" },
      view.report ? make("a", { class: "button", href: `report/${view.report}`, target: "_blank", rel: "noopener", text: "Open report" }) : null,
      view.report ? button("Save report", () => save("report.html", `${stem}.html`, "text/html"), { "data-control": "save-report" }) : null,
      view.report ? button("Save recipe", () => save("recipe.toml", "recipe.toml", "application/toml"), { "data-control": "save-recipe" }) : null,
      view.log ? button("Save mapping", () => save("hersey.toml", "hersey.toml", "application/toml"), { "data-control": "save-mapping" }) : null,
      view.machine.blank ? null : button("Save TOML", () => save("machine.toml", "machine.toml", "application/toml"), { "data-control": "save-toml" })));
}

function why(busy) {
  if (busy) return [make("b", { text: view.state === "running" ? "Running: " : "Preparing: " }), [view.step, left(view)].filter(Boolean).join(", ") + " ", button("Cancel", () => act.cancel(current), { "data-control": "cancel" })];
  if (view.all_faults.length) {
    const stopped = view.state === "stopped" ? [make("b", { class: "act", text: `Stopped: ${view.reason} ` })] : [];
    return [...stopped, make("b", { class: "act" }, signal("act"), "Fix first: "), ...view.all_faults.flatMap((fault, number) => [number ? ", " : "", link(fault.link, () => lead(fault.at))])];
  }
  if (view.state === "stopped") return [make("b", { class: "act" }, signal("act"), "Stopped: "), view.reason];
  if (!view.log) return [make("span", { class: "note", text: view.files.length ? "A file is being read." : "Drop a log first." })];
  const points = view.machine.points.length;
  const parts = view.machine.blank ? "damping and regime (for the operating map, fill in the machine)" : `damping, regime, operating map${points ? `, profiles for ${points} point${points > 1 ? "s" : ""}` : ""}`;
  return [make("b", { class: "good" }, signal("good"), "Ready: "), parts];
}

/** Bring the control with the problem into view. */
function lead(place) {
  const file = place.startsWith("file:") ? at(`file-${place.slice(5)}`)?.querySelector("button") : null;
  const control = file ?? find(place) ?? (place.startsWith("lacking:") ? document.querySelector("#channels select") : at("toml")) ?? at("machine").querySelector("input");
  control?.closest("details")?.setAttribute("open", "");
  control?.scrollIntoView({ block: "center" });
  control?.focus();
}

function theme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  at("theme").textContent = dark ? "Light" : "Dark";
}

function listen() {
  const drop = at("drop");
  at("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme !== "dark"));
  at("new").addEventListener("click", () => {
    queue = queue.then(async () => {
      const made = await post("analyses");
      if (made) {
        current = made.id;
        view = made;
      }
      await refresh();
      at("choose").focus();
    });
  });
  at("choose").addEventListener("change", async (event) => { const files = [...event.target.files]; event.target.value = ""; await send(files); });
  document.addEventListener("dragover", (event) => { event.preventDefault(); drop.classList.add("over"); });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) drop.classList.remove("over"); });
  document.addEventListener("drop", (event) => { event.preventDefault(); drop.classList.remove("over"); if (event.dataTransfer.files.length) send(event.dataTransfer.files); });
}

/** The token of this start: in the fragment of the address, which no request holds; kept for a reload. */
function key() {
  if (location.hash.length > 1) {
    sessionStorage.setItem("token", location.hash.slice(1));
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem("token") ?? "";
}

token = key();
theme(matchMedia("(prefers-color-scheme: dark)").matches);
listen();
if (!token) say("Open the address that hersey app printed, with everything after its #.");
else {
  questions = await ask("GET", "questions");
  if (questions) {
    at("formats").textContent = `CSV, TDMS, MF4, HDF5, LVM, Excel, MATLAB; up to ${size(questions.most)}. Your files are not changed.`;
    await refresh();
  }
}
