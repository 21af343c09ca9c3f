// The first screen: title line, decision, operating points, warnings, and the map beside the panel to try settings.

const TO_RPM = 60 / (2 * Math.PI);
const celsius = (kelvin) => kelvin - 273.15;
// What was measured against which speed: a torque of a rotation, or friction.
const measured = data.fit.domain?.quantity ?? "torque";
const friction = measured !== "torque";
const [PER_SPEED, SPEED_UNIT] = (data.fit.domain?.speed_unit ?? "rad/s") === "rad/s" ? [TO_RPM, "rpm"] : [1, data.fit.domain.speed_unit];
const inUnit = (name, unit) => unit ? `${name}, ${unit}` : name;
const degrees = (kelvin) => data.fit.temperature_scale === "K" ? `${digits(kelvin, 4)} K` : `${digits(celsius(kelvin), 3)} °C`;
const perSecond = (speed) => speed === null || speed === undefined ? "–" : digits(speed * 1e3, 3);
// The unit in which the torques of the document read best, with its factor from N·m.
function torqueUnit() {
  if (friction) return [1, data.fit.domain.unit];
  const unit = data.units?.torque ?? (Math.max(...data.points.map((p) => Math.abs(p.torque))) >= 1 ? "N·m" : "mN·m");
  return [unit === "mN·m" ? 1e3 : 1, unit];
}
function seconds(value) {
  return value >= 600 ? `${(value / 60).toFixed(1)} min` : `${digits(value)} s`;
}
const counted = (value) => String(value).replace(/\B(?=(\d{3})+$)/g, "\u202f");

function titleLine() {
  const head = document.getElementById("title");
  head.className = "title";
  add(head, "h1", data.title);
  if (data.synthetic) add(head, "span", "synthetic", "mark");
  const duration = data.files.reduce((sum, f) => sum + f.duration, 0);
  const made = data.made ? new Date(data.made).toLocaleString("en-GB", { day: "numeric", month: "short", year: "numeric", hour: "2-digit", minute: "2-digit" }) : "";
  const from = [made, `${counted(data.quality.rows)} rows${duration ? `, ${seconds(duration)}` : ""}`, data.machine?.name ?? ""];
  add(head, "span", from.filter(Boolean).join(" · "), "meta");
  const tools = add(head, "span", "", "tools");
  link(tools, "Contents", "contents").className = "btn";
  button(tools, "Print", () => window.print());
  theme(tools);
}

// Sections by the names that flags use, and their short names.
const SECTIONS = { film: "regime", verdict: "regime", models: "candidates", quality: "data", log: "data", fit: "torque", damping: "torque", stability: "band", step: "band", plans: "plan", points: "plan", comparison: "compare" };
const SHORT = { torque: measured[0].toUpperCase() + measured.slice(1), regime: "Regime", data: "Data", band: "Speeds", plan: "Profile" };
const sectionOf = (name) => SECTIONS[name] ?? name;

function decision() {
  const row = add(report, "div", "", "decide");
  const box = add(row, "div", "", "decision");
  box.id = "decision";
  const told = data.decision;
  const kind = told?.signal ?? "watch";
  const sign = add(box, "div", "", `sign ${kind}`);
  sign.append(largeSign(kind));
  add(sign, "span", SIGNALS[kind]);
  const words = add(box, "div");
  const lead = add(words, "p", pretty(told?.instruction ?? data.verdict[0] ?? ""), "lead");
  const more = told?.otherwise || told?.interval ? add(words, "p", pretty(told.otherwise ?? ""), "more") : null;
  if (told?.interval) {
    more.append(" ");
    add(more, "span", pretty(told.interval), "interval");
  }
  if (told?.next) nextStep(words, told);
  if (lead.textContent.length + 0.6 * (told?.otherwise.length ?? 0) > 210) row.classList.add("tight");
  if (told?.points.length) points(row, told.points);
  else row.style.gridTemplateColumns = "minmax(0, 1fr)";
  if (told?.flags.length) {
    const flags = add(report, "ul", "", "flags");
    flags.id = "flags";
    for (const flag of told.flags) {
      const item = add(flags, "li");
      const title = add(item, "b", "", flag.severity);
      title.append(signal(flag.severity));
      add(title, "span", `${SIGNALS[flag.severity]}: `, "sr-only");
      title.append(`${pretty(flag.title)}.`);
      item.append(` ${pretty(flag.text)} `);
      item.dataset.section = sectionOf(flag.where);
    }
  }
}
// What to do next; the reason of a measurement stands in a fold beside it.
const CLOSURE_WORDS = { retained: "comes to rest gradually", stiction: "stops abruptly", stribeck: "follows a Stribeck curve", lugre: "follows the LuGre model" };
function nextStep(words, { next, measurement, fold: safe, closures }) {
  const line = add(words, "div", "", "next");
  add(line, "p", pretty(next));
  if (!measurement) return;
  const why = fold(line, "Why this one");
  const reasons = [];
  if (safe?.low != null && safe.high != null) {
    reasons.push(`V* is only known to lie between ${perSecond(safe.low)} and ${perSecond(safe.high)} mm/s (95 %).`);
    const ratio = safe.high / safe.low;
    if (measurement.left < 1) reasons.push(`This measurement should narrow the ratio of the two from ${digits(ratio, 2)} to ${digits(ratio ** measurement.left, 2)}.`);
  }
  const likely = Object.entries(closures ?? {}).filter(([name, share]) => share >= 0.05 && share <= 0.95 && CLOSURE_WORDS[name]);
  if (likely.length > 1) reasons.push(`How the ${noun} comes to rest is not known: it ${likely.map(([name, share]) => `${CLOSURE_WORDS[name]} (${digits(100 * share, 2)} %)`).join(" or ")}.`);
  const text = add(why, "p", `${reasons.join(" ")} `);
  link(text, "How V* depends on the stick speed", "band");
}
function largeSign(kind) {
  const drawing = svg("svg", { viewBox: "0 0 44 40", "aria-hidden": "true" });
  const outline = { good: "M22 3a17 17 0 1 1 0 34a17 17 0 1 1 0-34Z", watch: "M22 3 42 37H2Z", act: "M5 3h34v34H5Z" }[kind];
  const inside = { good: "M14 20l6 6 10-12", watch: "M22 14v11M22 29v4", act: "M22 9v14M22 28v4" }[kind];
  svg("path", { d: outline, fill: "none", stroke: "currentColor", "stroke-width": 4, "stroke-linejoin": "round" }, drawing);
  svg("path", { d: inside, fill: "none", stroke: "currentColor", "stroke-width": 4 }, drawing);
  return drawing;
}
function points(row, all) {
  const element = add(row, "table", "", "points");
  const levels = new Set(all.map((p) => degrees(p.temperature)));
  add(element, "caption", `Operating points${levels.size === 1 ? ` at ${[...levels][0]}` : ""}`);
  const body = add(element, "tbody");
  all.forEach((point, i) => {
    const line = add(body, "tr");
    const word = add(line, "td", "", `s ${point.signal}`);
    word.append(signal(point.signal), SIGNALS[point.signal]);
    add(line, "td", point.name, point.name.length < 16 ? "n short" : "n");
    add(line, "td", `${perSecond(point.speed)} mm/s${levels.size > 1 ? `, ${degrees(point.temperature)}` : ""}`, "v");
    const words = add(line, "td", point.plan ? "" : pretty(point.words), "w");
    if (point.plan) link(words, pretty(point.words), "plan");
    const press = button(add(line, "td", "", "b"), "Show", () => controller?.show(i));
    press.setAttribute("aria-label", `Show ${point.name}`);
    press.dataset.show = i;
    press.disabled = true;
  });
}
// Link each flag to its section, once the sections are there.
function linkFlags() {
  for (const item of document.querySelectorAll("#flags li")) {
    const section = document.getElementById(item.dataset.section);
    if (section) link(item, SHORT[section.id] ?? section.querySelector("h2").textContent, section.id);
  }
}

// The panel; null where no setting can be tried.
let controller = null;
async function mapAndPanel() {
  const row = add(report, "div", "", "first");
  const place = add(row, "figure");
  place.id = "map";
  const panel = add(row, "div", "", "panel");
  panel.id = "panel";
  const free = innerHeight - place.getBoundingClientRect().top - scrollY - 8;
  place.style.setProperty("--map-height", `${Math.round(Math.min(560, Math.max(380, free)))}px`);
  if (!data.map) {
    await chart(place, "torque", { heading: torqueHeading(), level: "h2", note: torqueNote(), height: Math.round(Math.min(560, Math.max(300, free))) - 140 });
    missing(panel);
    return;
  }
  if (typeof live === "function") {
    const block = document.getElementById("physics");
    const bytes = block && typeof WebAssembly === "object" ? bytesOf(JSON.parse(block.textContent)) : null;
    controller = await live(data, bytes, { map: place, panel });
  } else if (typeof operatingMap === "function") operatingMap(place, data.map);
  else add(panel, "p", "No settings can be tried in this report.", "u");
  if (controller) for (const press of document.querySelectorAll("[data-show], [data-profile]")) press.disabled = false;
}
function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}
// Lines that would let the report answer more, ready to copy.
function missing(panel) {
  const cap = add(panel, "div", "", "cap");
  add(cap, "h2", "To get more from this log");
  const all = data.decision?.missing ?? [];
  if (!all.length) {
    add(panel, "p", "Add a machine file (--machine) to see at which speeds the drive runs smoothly, sticks or stalls.", "text");
    return;
  }
  all.forEach((each, i) => {
    const place = i ? fold(panel, `${each.file}: ${each.purpose}`) : add(panel, "div");
    if (!i) add(place, "p", `With these lines the report shows ${each.purpose}.`);
    const head = add(place, "div", "", "cap");
    head.style.marginTop = "6px";
    add(head, "b", `Add to ${each.file}`);
    reachable(add(place, "pre", each.lines));
    button(head, "Copy the lines", (from) => copy(each.lines, from));
  });
}
