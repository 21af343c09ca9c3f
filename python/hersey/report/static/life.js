// The page of a life test: which specimens need attention and what to do, beside it the ages with other limits, then
// the evidence section by section.

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
// What needs attention, and what to measure next.
function decided({ signal: kind, lead, more, next }) {
  const box = add(report, "div", "", "life-decision");
  box.id = "verdict";
  const line = add(box, "p", "", "lead");
  line.append(signal(kind), lead);
  more.forEach((text) => add(box, "p", pretty(text), "more"));
  if (next.length) {
    const advice = add(box, "p", "", "next");
    add(advice, "b", "Do next: ");
    advice.append(pretty(next[0]), " ");
    if (next.length > 1) link(advice, `${next.length - 1} more`, "next");
  }
}
function specimens(parent, { heads, rows, first }) {
  const element = add(parent, "section", "", "part");
  element.id = "ages";
  add(element, "h2", "Specimens, most urgent first");
  const cells = rows.map(([kind, state, ...others]) => [judged(kind, state), ...others]);
  table(element, heads, cells.slice(0, first), [3], { name: "ages", label: "Specimens" });
  if (cells.length > first) table(fold(element, `${cells.length - first} more`), heads, cells.slice(first), [3], { name: "ages-more", label: "More specimens" });
  add(element, "p", "Ages with 90 % intervals.", "note");
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
    list(box, shown);
    if (warnings.length > shown.length) list(fold(box, `${warnings.length - shown.length} more ${warnings.length - shown.length === 1 ? "warning" : "warnings"}`), warnings.slice(shown.length));
  }
  const [ends, ...others] = data.sections;
  const first = add(report, "div", "", data.uses ? "first" : "");
  const left = add(first, "div");
  if (data.uses) {
    const panel = add(first, "div", "", "panel");
    panel.id = "uses";
    otherUses(panel, data.uses);
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
