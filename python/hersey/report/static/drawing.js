// What pages are drawn with: the data inside them, and pieces of text, tables and charts. All text enters
// through textContent: nothing in a log can run.

const data = JSON.parse(document.getElementById("document").textContent);
const charts = JSON.parse(document.getElementById("charts").textContent);
const report = document.getElementById("report");

function digits(value, count = 4) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e6 || size < 1e-4)) return value.toExponential(count - 1);
  return String(Number(value.toPrecision(count)));
}

function add(parent, tag, text = "", className = "") {
  const element = document.createElement(tag);
  element.textContent = text;
  if (className) element.className = className;
  parent.appendChild(element);
  return element;
}
function table(parent, heads, rows, numeric = []) {
  const wide = add(parent, "div", "", "wide");
  const element = add(wide, "table");
  const head = add(add(element, "thead"), "tr");
  heads.forEach((text, i) => add(head, "th", text, numeric.includes(i) ? "number" : ""));
  const body = add(element, "tbody");
  for (const row of rows) {
    const line = add(body, "tr");
    row.forEach((text, i) => add(line, "td", text, numeric.includes(i) ? "number" : ""));
  }
  return element;
}
function fold(parent, title) {
  const details = add(parent, "details");
  add(details, "summary", title);
  return details;
}
async function chart(parent, name) {
  if (!charts[name]) return;
  const place = add(parent, "div", "", "chart");
  place.id = `chart-${name}`;
  await window.vegaEmbed(place, charts[name], {
    renderer: "svg",
    ast: true,
    actions: { export: true, source: false, compiled: false, editor: false },
    downloadFileName: `hersey-${name}`,
  });
}

function show(main) {
  main().then(() => { document.body.dataset.ready = "true"; }).catch((error) => {
    add(report, "p", `The page could not be drawn: ${error}`, "warnings");
    document.body.dataset.ready = "failed";
  });
}
