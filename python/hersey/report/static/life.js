// The page of a life test: which specimens need attention and what to do, beside it the ages with other limits, then
// the evidence section by section.

// An age with so many digits, without a power of ten; and one with its interval, whose ends may not be known.
function aged(age, count = 3) {
  return String(Number(age.toPrecision(count)));
}
function interval({ low, high }) {
  if (low === null) return "not reached";
  return high === null ? `from ${aged(low)}, no upper limit` : `${aged(low)} to ${aged(high)}`;
}

function list(parent, lines, className = "") {
  if (!lines.length) return;
  const items = add(parent, "ul", "", className);
  lines.forEach((text) => add(items, "li", text));
}
async function section(parent, each, title = each.title) {
  const element = add(parent, "section", "", "part");
  element.id = each.name;
  if (title) add(element, "h2", title);
  for (const text of each.text) add(element, "p", pretty(text));
  for (const name of each.charts) await chart(element, name, title ? {} : { level: "h2" });
  for (const { title: of, heads, rows, numeric } of each.tables) {
    table(of ? fold(element, of) : element, heads, rows, numeric, { name: `${each.name}${of ? "-each" : ""}`, label: of || title });
  }
  const words = [...each.lines.map(pretty), ...each.warnings.map(warned)];
  if (words.length) list(words.length > 4 ? fold(element, `Details (${words.length})`) : element, words, "soft");
}
// What needs attention, and what to do next.
function decided({ signal: kind, lead, more, next }) {
  const box = add(report, "div", "", "life-decision");
  box.id = "verdict";
  const line = add(box, "p", "", "lead");
  line.append(signal(kind), pretty(lead[0]));
  lead.slice(1).forEach((text) => add(line, "span", ` ${pretty(text)}`, "others"));
  more.forEach((text) => add(box, "p", pretty(text), "more"));
  if (next.length) {
    const advice = add(box, "p", "", "next");
    add(advice, "b", "Do next: ");
    advice.append(pretty(next.slice(0, 2).join(" ")), " ");
    if (next.length > 2) link(advice, `${next.length - 2} more`, "next");
  }
}
// The 90 % interval of an age from 0 to the end of the axis, dashed where it is not known whether it has come.
function bar({ signal: kind, specimen, age, last }, end) {
  const WIDTH = 300, HEIGHT = 16, x = (at) => Math.min(at / end, 1) * WIDTH;
  const drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", class: `bar ${kind}` });
  drawing.dataset.text = interval(age);
  drawing.setAttribute("aria-label", `${specimen}: ${interval(age)}`);
  svg("line", { x1: x(last), x2: x(last), y1: 0, y2: HEIGHT, stroke: "var(--edge)" }, drawing);
  if (age.low === null) return drawing;
  const line = svg("line", { x1: x(age.low), x2: age.high === null ? WIDTH : x(age.high), y1: 8, y2: 8, stroke: "currentColor", "stroke-width": 3 }, drawing);
  if (kind === "watch") line.setAttribute("stroke-dasharray", "5 3");
  else if (age.value !== null && age.value <= end) svg("circle", { cx: x(age.value), cy: 8, r: 4.5, fill: "currentColor" }, drawing);
  return drawing;
}
function specimens(parent, { heads, rows, first, end, age_unit: unit }) {
  const element = add(parent, "section", "", "part");
  element.id = "ages";
  add(element, "h2", "Time to first failure, most urgent first");
  const cells = rows.map((row) => [row.specimen, judged(row.signal, row.state), row.modes, row.expected, bar(row, end)]);
  table(element, heads, cells.slice(0, first), [3], { name: "ages", label: "Specimens" });
  const dashed = rows.some((row) => row.signal === "watch") ? " Dashed: whether it has failed is not known." : "";
  const note = add(element, "p", `Bars: 90 % interval, on an axis from 0 to ${aged(end, 2)} ${unit}; vertical line: last seen.${dashed} `, "note");
  link(note, "All failure modes of each specimen", "ends");
  if (cells.length > first) table(fold(element, `${cells.length - first} more`), heads, cells.slice(first), [3], { name: "ages-more", label: "More specimens" });
}
// B10 of new specimens; and how many of those followed fail before the age that is stated.
function population(parent, { b10: tenth, failing, age_unit: unit }) {
  add(parent, "h2", tenth ? "Population" : "Specimens");
  const rows = add(parent, "dl", "", "population");
  if (tenth) {
    add(rows, "dt", `10 % have failed by (B10), ${unit}`);
    const cell = add(rows, "dd", tenth.value === null ? "" : `${aged(tenth.value)} `);
    add(cell, "span", tenth.value === null && tenth.low !== null ? `later than ${aged(tenth.low)}` : `(${interval(tenth)})`, "u");
  }
  if (failing) {
    const { value, low, high } = failing.failed;
    add(rows, "dt", `Of the ${failing.specimens} followed, failures before ${aged(failing.age, 6)} ${unit}`);
    const cell = add(rows, "dd", low === high ? `${value}` : `${value} `);
    if (low !== high) add(cell, "span", `(${low} to ${high})`, "u");
  }
}
async function main() {
  document.title = `hersey: ${data.title}`;
  const header = document.getElementById("title");
  header.className = "title";
  add(header, "h1", data.title);
  add(header, "span", data.origin, "meta");
  const tools = add(header, "span", "", "tools");
  button(tools, "Print", () => window.print());
  theme(tools);
  decided(data.decision);
  const warnings = data.warnings.map(warned), shown = warnings.slice(0, data.shown_warnings);
  if (warnings.length) {
    const box = add(report, "div", "", "warnings");
    checks(box, data.warnings.slice(0, shown.length).map((each) => [each.severity, warned(each)]));
    if (warnings.length > shown.length) list(fold(box, `${warnings.length - shown.length} more ${warnings.length - shown.length === 1 ? "warning" : "warnings"}`), warnings.slice(shown.length));
  }
  const [ends, ...others] = data.sections;
  const counts = data.decision.b10 || data.decision.failing, beside = data.uses || counts;
  const first = add(report, "div", "", beside ? "first life-first" : "");
  const left = add(first, "div");
  if (beside) {
    const panel = add(first, "div", "", "panel");
    if (data.uses) otherUses(add(panel, "div", "", "uses"), data.uses);
    if (counts) population(panel, data.decision);
  }
  specimens(left, data.decision);
  await section(left, ends);
  for (const each of others) await section(report, each);
  const last = add(report, "section", "", "part");
  last.id = "reproduce";
  add(last, "h2", "Reproduce this report");
  add(last, "pre", data.command).id = "command";
  const all = fold(last, `${data.runs.length} ${data.runs.length === 1 ? "log" : "logs"} and their hashes`);
  add(all, "pre", data.runs.map((run) => `sha256 ${run.sha256}  ${run.log}`).join("\n"));
  add(all, "p", `Document schema ${data.schema_version}.`, "soft");
  document.getElementById("end").textContent = `hersey ${data.hersey_version}`;
}

show(main);
