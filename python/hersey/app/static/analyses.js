// The list of analyses: preparing, running, done with its decision, stopped with its reason; and earlier reports.

import { button, draw, link, make, renew, signal } from "./building.js";

const WORDS = { good: "Good", watch: "Watch", act: "Act" };
const plural = (count, one) => `${count} ${one}${count === 1 ? "" : "s"}`;

const lasting = (seconds) => (seconds < 90 ? `${Math.max(1, Math.round(seconds))} s` : `${Math.round(seconds / 60)} min`);

/** The time left, if a similar run has ended before; else the time since the start. */
export const left = (one) => (one.left !== null ? `about ${lasting(one.left)} left` : one.spent !== null ? `${lasting(one.spent)} so far` : "");

/** Names of the analyses, those that are equal numbered in the order in which they were begun. */
function names(analyses) {
  const seen = new Map();
  return analyses.map(({ name }) => {
    const count = (seen.get(name) ?? 0) + 1;
    seen.set(name, count);
    return count > 1 ? `${name} (${count})` : name;
  });
}

export function showAnalyses(place, analyses, current, act) {
  const called = names(analyses);
  renew(place, ...analyses.map((one, number) => {
    const name = called[number];
    const item = make("li", { "aria-current": one.id === current ? "true" : null },
      make("button", { class: "name", type: "button", text: name, "data-control": `analysis:${one.id}`, onclick: () => act.show(one.id) }));
    item.append(...state({ ...one, name }, act));
    if (analyses.length > 1 && one.state !== "running" && one.state !== "preparing") {
      item.append(make("div", { class: "row" }, link("Remove", () => act.removeAnalysis(one.id), { "aria-label": `Remove ${name}` })));
    }
    return item;
  }));
}

/** Reports that were kept before this start, the newest in sight. */
const IN_SIGHT = 4;
export function showEarlier(place, reports) {
  if (place.childElementCount || !reports.length) return;
  const list = (those) => make("ul", { class: "list" }, ...those.map((one) => make("li", {}, make("b", { text: one.name }), ...finished(one))));
  place.append(make("h3", { text: "Earlier reports" }), list(reports.slice(0, IN_SIGHT)));
  if (reports.length > IN_SIGHT) place.append(make("details", {}, make("summary", { text: `${reports.length - IN_SIGHT} more` }), list(reports.slice(IN_SIGHT))));
}

/** A finished analysis: its decision, a small map, the report. */
function finished(one) {
  const said = one.words ? `${one.words.replace(/\.?$/, "")}.` : "";
  return [
    make("p", {}, ...(one.signal ? [make("span", { class: one.signal }, signal(one.signal), WORDS[one.signal])] : [make("span", { text: "Done" })]),
      make("span", { class: "note", text: ` ${one.finished}` })),
    said ? make("p", { class: "decision", text: said }) : "",
    one.map ? smallMap(one.map) : "",
    make("div", { class: "row" }, make("a", { href: `report/${one.report}`, target: "_blank", rel: "noopener", text: "Open report" })),
    make("p", { class: "note", text: one.saved })];
}

/** The operating map in small: temperature across, drive speed up, the zones and the operating points. */
function smallMap({ temperature, speed: [slow, fast], lower, transition, upper, points }) {
  const WIDTH = 180, HEIGHT = 64, [cold, hot] = [temperature[0], temperature.at(-1)];
  const across = (kelvin) => (hot > cold ? ((kelvin - cold) / (hot - cold)) * WIDTH : WIDTH / 2);
  const up = (v) => HEIGHT - (Math.log(Math.min(Math.max(v ?? fast, slow), fast) / slow) / Math.log(fast / slow)) * HEIGHT;
  const ends = hot > cold ? temperature.map((kelvin, i) => [across(kelvin), i]) : [[0, 0], [WIDTH, 0]];
  const below = (edge) => [...ends.map(([x, i]) => `${x.toFixed(1)},${up(edge(i)).toFixed(1)}`), `${WIDTH},${HEIGHT}`, `0,${HEIGHT}`].join(" ");
  const marks = points.filter(([kelvin, v]) => v >= slow && v <= fast && (hot <= cold || (kelvin >= cold && kelvin <= hot)));
  return draw("svg", { class: "small-map", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", role: "img", "aria-label": "Small operating map" },
    draw("rect", { class: "smooth", width: WIDTH, height: HEIGHT }),
    draw("polygon", { class: "depends", points: below((i) => upper[i]) }),
    draw("polygon", { class: "sticks", points: below((i) => Math.min(lower[i] ?? fast, transition[i] ?? fast)) }),
    ...marks.map(([kelvin, v]) => draw("path", { class: "point", d: `M${across(kelvin).toFixed(1)} ${(up(v) - 4.5).toFixed(1)}l4.5 4.5l-4.5 4.5l-4.5 -4.5Z` })));
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
  if (one.state === "done") return finished({ ...one, finished: `today ${one.finished}` });
  if (one.state === "stopped") return [make("p", { class: "act" }, signal("act"), `stopped: ${one.reason}`)];
  if (one.faults) return [make("p", { class: "act" }, signal("act"), `${plural(one.faults, "problem")} to fix`)];
  if (one.ready) return [make("p", { class: "good" }, signal("good"), "ready to run")];
  return [make("p", { class: "note", text: "no log yet" })];
}
