// The page of a life test: what ends the units and when, then section by section what it rests on.

function list(parent, lines, className = "") {
  if (!lines.length) return;
  const items = add(parent, "ul", "", className);
  lines.forEach((text) => add(items, "li", text));
}
async function section(each) {
  add(report, "h2", each.title).id = each.name;
  for (const text of each.text) add(report, "p", text);
  for (const name of each.charts) await chart(report, name);
  for (const { title, heads, rows, numeric } of each.tables) {
    table(title ? fold(report, title) : report, heads, rows, numeric);
  }
  if (each.notes.length) list(each.notes.length > 4 ? fold(report, "more in words") : report, each.notes, "soft");
}
async function main() {
  document.title = `hersey: ${data.title}`;
  add(report, "p", `hersey ${data.hersey_version} · life of units`, "soft");
  add(report, "h1", data.title);
  const verdict = add(report, "div", "", "verdict");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", text));
  list(report, data.warnings, "warnings");
  for (const each of data.sections) {
    await section(each);
    if (each.name === "ends" && data.uses) {
      add(report, "h2", "With another limit, start or duty").id = "uses";
      otherUses(report, data.uses);
    }
  }
  add(report, "h2", "How to reproduce this report");
  add(report, "pre", data.command).id = "command";
  add(report, "p", `hersey ${data.hersey_version}, document schema ${data.schema_version}. Runs:`, "soft");
  const all = fold(report, `${data.runs.length} logs`);
  add(all, "pre", data.runs.map((run) => `sha256 ${run.sha256}  ${run.log}`).join("\n"));
}

show(main);
