// What all pages share: their data, text, tables, folds, signals and axes. All text enters through textContent, so
// nothing in a log can run.

const data = JSON.parse(document.getElementById("document").textContent);
const charts = JSON.parse(document.getElementById("charts").textContent);
const report = document.getElementById("report");

// A number for readers, with so many digits and a true minus.
function digits(value, count = 3) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size >= 1e6 || size < 1e-4) ? value.toExponential(count - 1) : String(Number(value.toPrecision(count)));
  return text.replaceAll("-", "−");
}
// A text of the package as it is printed: true minus, degree sign, squares.
function pretty(text) {
  return text.replaceAll(" degC", " °C").replace(/(\d) (?=%|°C)/g, "$1\u00a0").replaceAll("+/-", "±").replace(/(^|[\s[(,±])-(?=\d)/g, "$1−").replace(/(?<=[a-z])\^2\b/g, "²")
    .replace(/\b(mN|N) m\b/g, "$1·m").replace(/(\d)e-0*(\d+)\b/g, (_, first, power) => `${first}·10⁻${[...power].map((each) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[each]).join("")}`);
}
// A warning: what it concerns, its title and its text.
const warned = (each) => pretty([each.where, each.title, each.text].filter(Boolean).join(": "));

function add(parent, tag, text = "", className = "") {
  const element = document.createElement(tag);
  element.textContent = text;
  if (className) element.className = className;
  parent.appendChild(element);
  return element;
}
function svg(tag, attributes = {}, parent = null, text = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text) element.textContent = text;
  if (parent) parent.appendChild(element);
  return element;
}
function button(parent, text, act) {
  const element = add(parent, "button", text, "btn");
  element.type = "button";
  element.addEventListener("click", () => act(element));
  return element;
}
function link(parent, text, id) {
  const element = add(parent, "a", text);
  element.href = `#${id}`;
  return element;
}

const SIGNALS = { good: "Good", note: "Note", watch: "Watch", act: "Act" };
const SHAPES = { good: "M6.5 0a6 6 0 1 1 0 12a6 6 0 1 1 0-12Z", note: "M1 5h11v2h-11Z", watch: "M6.5 0 13 12H0Z", act: "M.5 0h12v12h-12Z" };
// A signal's shape; its word is beside it.
function signal(kind) {
  const icon = svg("svg", { class: `i ${kind}`, viewBox: "0 0 13 12", "aria-hidden": "true" });
  svg("path", { d: SHAPES[kind], fill: "currentColor" }, icon);
  return icon;
}
// A verdict beside its signal, as a cell of a table.
function judged(kind, text) {
  const cell = document.createElement("b");
  cell.className = kind;
  cell.append(signal(kind), text);
  cell.dataset.text = text;
  return cell;
}
// Items with a signal before each: [[signal, text], ...].
function checks(parent, items) {
  const list = add(parent, "ul", "", "checks");
  for (const [kind, text] of items) {
    const item = add(list, "li");
    const icon = signal(kind);
    icon.removeAttribute("aria-hidden");
    icon.setAttribute("role", "img");
    icon.setAttribute("aria-label", SIGNALS[kind]);
    item.append(icon, text);
  }
  return list;
}

function save(name, content, type) {
  const address = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  const anchor = document.createElement("a");
  anchor.href = address;
  anchor.download = name;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
async function copy(text, from) {
  const label = from.textContent;
  try {
    await navigator.clipboard.writeText(text);
    from.textContent = "Copied";
  } catch {
    from.textContent = "Blocked: select and copy";
  }
  setTimeout(() => { from.textContent = label; }, 2000);
}

// Rows of a fold that are printed.
const PRINTED = 3;
const number = (text) => Number.parseFloat(String(text).replaceAll("−", "-").replaceAll(" ", "").replace(/^[^\d.-]+/, ""));
// An apostrophe before a cell that a spreadsheet would run as a formula, as in hersey/files/tables.py.
const FORMULA = /(^|[;\t\r\n])(?=["'\s]*[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20])/g;
const PLAIN_NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
function csv(heads, rows) {
  const cell = (text) => {
    const shown = String(text).replaceAll("−", "-").replaceAll("–", "");
    const plain = PLAIN_NUMBER.test(shown) ? shown : shown.replace(FORMULA, "$1'");
    return /[",\r\n]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
  };
  return [heads, ...rows].map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
}
// A table that sorts by its heads and saves as CSV. A cell is a text, or a node with data-text.
function table(parent, heads, rows, numeric = [], { name = "", label = "" } = {}) {
  const wide = add(parent, "div", "", "wide");
  const element = add(wide, "table", "", "d");
  if (label) element.setAttribute("aria-label", label);
  const line = add(add(element, "thead"), "tr");
  const body = add(element, "tbody");
  const textOf = (cell) => typeof cell === "string" ? cell : cell.dataset.text;
  const lines = rows.map((row, index) => {
    const entry = add(body, "tr");
    row.forEach((cell, i) => add(entry, "td", "", numeric.includes(i) ? "number" : "").append(cell));
    return { entry, index, texts: row.map(textOf) };
  });
  let order = { column: -1, down: false };
  const sort = (column) => {
    order = { column, down: order.column === column && !order.down };
    const kind = numeric.includes(column)
      ? (a, b) => (Number.isNaN(a) ? 1 : 0) - (Number.isNaN(b) ? 1 : 0) || a - b : (a, b) => a.localeCompare(b);
    const key = (each) => numeric.includes(column) ? number(each.texts[column]) : each.texts[column];
    lines.sort((a, b) => (order.down ? -1 : 1) * kind(key(a), key(b)) || a.index - b.index);
    body.append(...lines.map((each) => each.entry));
    [...line.cells].forEach((cell, i) => {
      if (i === column) cell.setAttribute("aria-sort", order.down ? "descending" : "ascending");
      else cell.removeAttribute("aria-sort");
    });
  };
  heads.forEach((text, i) => {
    const head = add(line, "th", "", numeric.includes(i) ? "number" : "");
    head.scope = "col";
    if (rows.length < 2 || !text) head.textContent = text;
    else {
      const by = add(head, "button", text, "by");
      by.type = "button";
      by.addEventListener("click", () => sort(i));
    }
  });
  if (rows.length > PRINTED) {
    element.classList.add("long");
    add(parent, "p", `${PRINTED} of ${rows.length} rows`, "on-paper note");
  }
  if (name) {
    const foot = add(parent, "div", "", "foot");
    button(foot, "Save CSV", () => save(`${name}.csv`, csv(heads, lines.map((each) => each.texts)), "text/csv"));
  }
  reachable(wide);
  return element;
}
// Width of a place on paper, pixels: A4 less its margins at the scale of page.css, whole or one of two columns.
const PAPER = Math.floor(695 / 0.85);
function paperWidth(place) {
  return place.closest(".columns") && !place.closest(".across") ? (PAPER - 24) / 2 : PAPER;
}
// Make an element that scrolls reachable by keyboard.
function reachable(element) {
  new ResizeObserver(() => {
    if (element.scrollWidth > element.clientWidth + 1 || element.scrollHeight > element.clientHeight + 1) element.tabIndex = 0;
    else element.removeAttribute("tabindex");
  }).observe(element);
}
// A fold; its content is drawn when it is first opened or printed.
const unopened = new Map();
function fold(parent, title, fill = null) {
  const details = add(parent, "details");
  add(details, "summary", title);
  if (fill) {
    unopened.set(details, fill);
    details.addEventListener("toggle", () => filled(details));
  }
  return details;
}
function filled(details) {
  const fill = unopened.get(details);
  unopened.delete(details);
  if (fill) fill(details);
}
// On paper folds are open, but for those of class "behind"; the first rows of their tables are printed.
let closed = [];
let onPaper = false;
addEventListener("beforeprint", () => {
  onPaper = true;
  closed = [...document.querySelectorAll("details:not([open]):not(.behind)")];
  closed.forEach((details) => { filled(details); details.open = true; });
});
addEventListener("afterprint", () => {
  onPaper = false;
  closed.forEach((details) => { details.open = false; });
});

// Round numbers between two, and those of a logarithmic axis: 1, 2, 5 of each decade.
function ticks(low, high, count = 5) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((each) => each * power >= rough);
  const out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) out.push(Number((i * step).toPrecision(12)));
  return out;
}
function logTicks(low, high) {
  const out = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
    for (const each of [1, 2, 5]) if (each * 10 ** power >= low && each * 10 ** power <= high) out.push(each * 10 ** power);
  }
  return out;
}
// Positions near those given, each at least a gap from the next.
function apart(places, gap = 14) {
  const order = places.map((_, i) => i).sort((a, b) => places[a] - places[b]);
  const out = places.slice();
  for (let round = 0; round < 60; round += 1) {
    for (let i = 1; i < order.length; i += 1) {
      const short = gap - (out[order[i]] - out[order[i - 1]]);
      if (short > 0) { out[order[i]] += short / 2; out[order[i - 1]] -= short / 2; }
    }
  }
  return out;
}

// Light or dark, for as long as the page is open.
function theme(parent) {
  const root = document.documentElement;
  const set = (dark) => {
    root.dataset.theme = dark ? "dark" : "light";
    press.textContent = dark ? "Light" : "Dark";
  };
  const press = button(parent, "Dark", () => set(root.dataset.theme !== "dark"));
  press.id = "theme";
  set(matchMedia("(prefers-color-scheme: dark)").matches);
}

function show(main) {
  main().then(() => { document.body.dataset.ready = "true"; }).catch((error) => {
    add(report, "p", `The page could not be drawn: ${error}`, "failure");
    document.body.dataset.ready = "failed";
  });
}
