// The page of a life test: what ends the units and when, beside it the ages in other uses of the machine, then section
// by section what it rests on.

function list(parent, lines, className = "") {
  if (!lines.length) return;
  const items = add(parent, "ul", "", className);
  lines.forEach((text) => add(items, "li", text));
}
async function section(parent, each, title = each.title) {
  const element = add(parent, "section", "", "part");
  element.id = each.name;
  if (title) add(element, "h2", title);
  for (const text of each.text) add(element, "p", text);
  for (const name of each.charts) await chart(element, name);
  for (const { title: of, heads, rows, numeric } of each.tables) {
    table(of ? fold(element, of) : element, heads, rows, numeric, { name: `${each.name}${of ? "-each" : ""}` });
  }
  const words = [...each.lines, ...each.warnings.map(warned)];
  if (words.length) list(words.length > 4 ? fold(element, "More in words") : element, words, "soft");
}
async function main() {
  document.title = `hersey: ${data.title}`;
  const header = document.getElementById("title");
  add(header, "h1", data.title);
  add(header, "span", `life of units · hersey ${data.hersey_version}`, "meta");
  theme(add(header, "div", "", "tools"));
  const verdict = add(report, "div", "", "verdict");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", text));
  list(report, data.warnings.map(warned), "warnings");
  const [ends, ...others] = data.sections;
  const first = add(report, "div", "", data.uses ? "first" : "");
  const left = add(first, "div");
  if (data.uses) {
    const panel = add(first, "div", "", "panel");
    panel.id = "uses";
    otherUses(panel, data.uses);
  }
  await section(left, { ...ends, tables: [] }, "");
  await section(report, { ...ends, name: "ages", charts: [], text: [], lines: [], warnings: [] });
  for (const each of others) await section(report, each);
  const last = add(report, "section", "", "part");
  last.id = "reproduce";
  add(last, "h2", "How to reproduce this report");
  add(last, "pre", data.command).id = "command";
  add(last, "p", `hersey ${data.hersey_version}, document schema ${data.schema_version}. Runs:`, "soft");
  const all = fold(last, `${data.runs.length} logs`);
  add(all, "pre", data.runs.map((run) => `sha256 ${run.sha256}  ${run.log}`).join("\n"));
}

show(main);
