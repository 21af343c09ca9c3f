// Files and channels: the contents of a log, the role of each channel, and its problems below it.

import { button, digits, draw, link, make, renew, sign, signal, size, typed } from "./building.js";

const ROLES = ["time", "torque", "speed", "temperature", "load", "radius", "run"];
const OTHER = "other…";
const open = new Set();

/** A problem with the button that fixes it. */
export function words(fault, act) {
  return make("div", { class: "fault-line" }, make("span", { class: "words" },
    make("span", { class: "act" }, signal("act"), make("b", { text: fault.title })), fault.title && fault.text ? " " : "", fault.text),
    fault.button ? button(fault.button, () => act.mend(fault)) : null,
    fault.keep ? link(fault.keep, () => act.keep(fault)) : null);
}

const of = (view, at) => view.all_faults.filter((fault) => fault.at === at);

export function showFiles(place, view, act) {
  renew(place, ...view.files.map((file) => {
    const faults = of(view, `file:${file.id}`);
    const wrong = faults.length > 0;
    const busy = file.state === "arriving" || file.state === "looking";
    const told = wrong ? [make("span", { text: faults[0].text })] : [make("span", { class: "note", text: about(file, view) })];
    return make("li", { id: `file-${file.id}` },
      make("span", { class: `sign ${wrong ? "act" : "good"}` }, busy ? "…" : signal(wrong ? "act" : "good")),
      make("span", {}, make("b", { text: file.name }), " ", ...told, busy ? progress(file) : ""),
      button("Remove", () => act.removeFile(file), { "data-control": `file:${file.id}`, "aria-label": `Remove ${file.name}` }));
  }));
}

/** How much of a file has come; without a share while its channels are read. */
function progress(file) {
  const bar = make("progress", { max: 1, "aria-label": `Progress of ${file.name}` });
  if (file.state === "arriving" && file.total) bar.value = file.received / file.total;
  return bar;
}

function about(file, view) {
  if (file.state === "arriving") return `copying, ${size(file.received)}${file.total ? ` of ${size(file.total)}` : ""}`;
  if (file.state === "looking") return `${size(file.size)} · reading the channels`;
  if (file.state === "mapping") return ["sets the roles, units and corrections below", ...(view.mapping_kept.length ? [`also kept: ${view.mapping_kept.join(", ")}`] : [])].join(" · ");
  const parts = [size(file.size), `${file.rows.toLocaleString("en").replace(/,/g, " ")} rows`];
  if (file.means) parts.push("table of means");
  if (file.duration) parts.push(file.duration < 120 ? `${digits(file.duration, 3)} s` : `${digits(file.duration / 60, 3)} min`);
  if (file.gaps) parts.push(`${file.gaps} gap${file.gaps > 1 ? "s" : ""}, ${digits((100 * file.lost) / file.duration, 2)} % of the time`);
  if (file.cut_off) parts.push("truncated");
  if (view.beside.includes(file.name)) parts.push("used by the machine file or the mapping");
  return parts.join(" · ");
}

export function showChannels(place, view, questions, act) {
  const title = (note) => make("h2", {}, make("span", { class: "number", text: "2" }), " Channels ", make("span", { class: "note", text: note }));
  if (!view.log) {
    renew(place, title("drop a log to see them"));
    return;
  }
  const rows = view.channels.flatMap((channel) => row(channel, view, act));
  const lacking = view.all_faults.filter((fault) => fault.at.startsWith("lacking:") || fault.at === "file:");
  renew(place,
    title("check the proposed roles and units"),
    pair(view, act),
    ...lacking.map((fault) => make("div", { class: "alone", "data-control": fault.at, tabindex: "-1" }, words(fault, act))),
    make("table", { class: "channels" },
      make("caption", { class: "hidden", text: `Channels of ${view.log.name}` }),
      make("thead", {}, make("tr", {}, ...["As in the file", "Preview", "Range", "Role", "Unit"].map((text) => make("th", { scope: "col", text })))),
      make("tbody", {}, ...rows)),
    view.hidden ? make("p", { class: "note", text: `${view.hidden} more channels without a role are not shown` }) : null,
    corrections(view, questions, act));
}

/** Whether two logs are runs of one machine, or one is compared with the other. */
function pair(view, act) {
  if (!view.pair.length) return null;
  const [one, other] = view.pair;
  const compared = (later, earlier) => make("option", { value: earlier.id, text: `compare ${later.name} with ${earlier.name}` });
  const select = make("select", { id: "pair", "data-control": "option:against", onchange: (event) => act.choose({ options: { against: event.target.value } }) },
    make("option", { value: "", text: "runs of one machine, fitted together" }), compared(other, one), compared(one, other));
  select.value = view.options.against;
  return make("p", { class: "pairing" }, make("label", { for: "pair", text: "These two logs: " }), select);
}

function row(channel, view, act) {
  const faults = [...of(view, `role:${channel.name}`), ...of(view, `unit:${channel.name}`)];
  const wrong = (kind) => faults.some((fault) => fault.at === `${kind}:${channel.name}`);
  const facts = [`col ${channel.column}`];
  if (channel.role === "time" && channel.interval) facts.push(`${digits(1 / channel.interval, 3)} per second`);
  if (!channel.written && channel.role !== "run") facts.push(channel.proposed ? `${sign(channel.proposed)} from its name` : "no unit in the file");
  if (channel.role && channel.warnings.length) facts.push(channel.warnings[0].text);
  const line = make("tr", { class: faults.length ? "guilty" : null },
    make("td", {}, channel.written ? `${channel.name} [${channel.written}]` : channel.name, make("small", { text: facts.join(" · ") })),
    make("td", {}, preview(channel.preview)),
    make("td", { class: "range", text: `${digits(channel.low)} to ${digits(channel.high)}` }),
    make("td", {}, roleOf(channel, wrong("role"), act)),
    make("td", {}, channel.role && channel.role !== "run" ? unitOf(channel, view, wrong("unit"), act) : null));
  return [line, ...faults.map((fault) => make("tr", { class: "fault" }, make("td", { colspan: 5 }, words(fault, act))))];
}

function roleOf(channel, wrong, act) {
  const select = make("select", { "aria-label": `Role of ${channel.name}`, class: wrong ? "wrong" : null, "aria-invalid": wrong ? "true" : null,
    "data-control": `role:${channel.name}`, onchange: (event) => act.choose({ roles: { [channel.name]: event.target.value } }) },
  ...ROLES.map((role) => make("option", { value: role, text: role })), make("option", { value: "", text: "not used" }));
  select.value = channel.role;
  return select;
}

function unitOf(channel, view, wrong, act) {
  const control = `unit:${channel.name}`;
  const choose = (unit) => act.choose({ units: { [channel.name]: unit } });
  const known = [...new Set([...view.units[channel.role], channel.proposed, channel.unit].filter(Boolean))];
  const shown = { "aria-label": `Unit of ${channel.name}`, class: wrong ? "wrong" : null, "aria-invalid": wrong ? "true" : null, "data-control": control };
  const select = make("select", { ...shown, onchange: (event) => {
    if (event.target.value !== OTHER) return choose(event.target.value);
    const field = make("input", { ...shown, class: "field", placeholder: "9.84 mN*m / 100", ...typed((own) => choose(own.value)) });
    select.replaceWith(field);
    field.focus();
    return undefined;
  } },
  ...(channel.unit ? [] : [make("option", { value: "", text: "choose…" })]),
  ...known.map((unit) => make("option", { value: unit, text: sign(unit) + (unit === channel.proposed && !channel.written ? " (proposed)" : "") })),
  make("option", { value: OTHER, text: OTHER }));
  select.value = channel.unit;
  return select;
}

function preview(points) {
  const parts = [];
  for (const [place, low, high] of points) {
    const x = (1 + 148 * place).toFixed(1);
    for (const share of low === high ? [low] : [low, high]) parts.push(`${parts.length ? "L" : "M"}${x} ${(27 - 24 * share).toFixed(1)}`);
  }
  return draw("svg", { class: "preview", viewBox: "0 0 150 30", "aria-hidden": "true", preserveAspectRatio: "none" }, draw("path", { d: parts.join("") || "M0 0" }));
}

/** The tare in sight; in a fold, what lies between sensor and roll, and rows that lack a number. */
function corrections(view, questions, act) {
  const faults = view.all_faults.filter((fault) => questions.corrections.some((q) => fault.at === `field:${q.key}`));
  const line = (q) => {
    const wrong = of(view, `field:${q.key}`);
    const id = `c-${q.key}`;
    return make("div", { class: "line" }, make("label", { for: id, text: `${q.section} ${q.called}`, title: q.words }),
      make("input", { class: `field${wrong.length ? " wrong" : ""}`, id, value: view.corrections[q.key] ?? "", "data-control": `field:${q.key}`, placeholder: q.example,
        "aria-invalid": wrong.length ? "true" : null, "aria-describedby": `${id}-hint`,
        ...typed((field) => act.choose({ corrections: { [q.key]: field.value } })) }),
      make("span", { class: "unit", text: sign(q.unit) }),
      make("p", { class: `hint${wrong.length ? " act" : ""}`, id: `${id}-hint`, text: wrong.length ? `${wrong[0].title} ${wrong[0].text}` : q.words }));
  };
  const check = (text, checked, given) => make("label", {}, make("input", { type: "checkbox", checked, "data-control": `option:${Object.keys(given(true))[0]}`,
    onchange: (event) => act.choose({ options: given(event.target.checked) }) }), ` ${text}`);
  const summary = make("summary", { text: "Gears, sensor corrections, missing values", "data-control": "corrections" });
  const details = make("details", { open: open.has("corrections") || faults.length > 0, ontoggle: () => (details.open ? open.add("corrections") : open.delete("corrections")) },
    summary,
    make("p", {}, check("skip rows with a missing value, even if there are many", view.options.drop_missing, (on) => ({ drop_missing: on }))),
    make("p", {}, check("ignore temperature", view.options.isothermal, (on) => ({ isothermal: on }))),
    make("div", { class: "pair" }, ...questions.corrections.map(line)));
  const tare = make("p", { class: "tare" }, check("Subtract the torque at standstill (tare)", view.options.tare === "standing", (on) => ({ tare: on ? "standing" : "none" })),
    make("span", { class: "note", text: " · No-load log: drop it and name it in the machine TOML, [rest] log" }));
  return make("div", {}, tare, details);
}
