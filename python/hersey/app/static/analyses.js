// The list of analyses: preparing, running, done with its signal, stopped with its reason.

import { button, link, make, renew, signal } from "./building.js";

const WORDS = { good: "Good", watch: "Watch", act: "Act" };
const plural = (count, one) => `${count} ${one}${count === 1 ? "" : "s"}`;

const lasting = (seconds) => (seconds < 90 ? `${Math.max(1, Math.round(seconds))} s` : `${Math.round(seconds / 60)} min`);

/** What is left, where a run like it has ended before; else how long it has been at work. */
export const left = (one) => (one.left !== null ? `about ${lasting(one.left)} left` : one.spent !== null ? `${lasting(one.spent)} so far` : "");

export function showAnalyses(place, analyses, current, act) {
  renew(place, ...analyses.map((one) => {
    const item = make("li", { "aria-current": one.id === current ? "true" : null },
      make("button", { class: "name", type: "button", text: one.name, "data-control": `analysis:${one.id}`, onclick: () => act.show(one.id) }));
    item.append(...state(one, act));
    if (analyses.length > 1 && one.state !== "running" && one.state !== "preparing") {
      item.append(make("div", { class: "row" }, link("Remove", () => act.removeAnalysis(one.id), { "aria-label": `Remove ${one.name}` })));
    }
    return item;
  }));
}

function state(one, act) {
  const busy = one.state === "running" || one.state === "preparing";
  if (busy) {
    const bar = make("progress", { max: 1, "aria-label": `Progress of ${one.name}` });
    if (one.share !== null) bar.value = one.share;
    return [make("span", { class: "note", text: one.state === "preparing" ? `preparing: ${one.step}` : one.step }), bar,
      make("div", { class: "row" }, make("span", { class: "note", text: left(one) }),
        button("Cancel", () => act.cancel(one.id), { "aria-label": `Cancel ${one.name}` }))];
  }
  if (one.state === "done") {
    return [
      make("p", {}, ...(one.signal ? [make("span", { class: one.signal }, signal(one.signal), WORDS[one.signal])] : [make("span", { text: "Done" })]),
        make("span", { class: "note", text: ` today ${one.finished}` })),
      make("div", { class: "row" }, make("a", { href: `report/${one.report}`, target: "_blank", rel: "noopener", text: "Open report" })),
      make("p", { class: "note", text: `kept as ${one.saved}` })];
  }
  if (one.state === "stopped") return [make("p", { class: "act" }, signal("act"), `stopped: ${one.reason}`)];
  if (one.faults) return [make("p", { class: "act" }, signal("act"), `${plural(one.faults, "fault")} to put right`)];
  if (one.ready) return [make("p", { class: "good" }, signal("good"), "ready to run")];
  return [make("p", { class: "note", text: "no log yet" })];
}
