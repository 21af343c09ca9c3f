// Charts of the package, drawn by Vega at the width of their place, with title and notes as text of the page, the
// colours of the page, and the data and files of each in a fold.

// The colours of charts, and what they become on a dark ground.
const ON_DARK = {
  "#15202b": "#e7ecf0", "#4b5965": "#a9b5c0", "#c9d1d6": "#33404b", "#73808c": "#8593a0", "#0a5c8f": "#74bdea",
  "#17694a": "#74d0a4", "#845400": "#f0be61", "#a5301a": "#ff9a80", "#ffffff": "#11171d", "#f3f6f7": "#19212a",
  "#e7f1f4": "#1b2c35", "#f4dc94": "#65511a", "#e2a78f": "#7d402b", "#4e5a66": "#8b97a3", "#eaeef1": "#202a33",
  "#dce9ef": "#1d2f39", "#f0eee2": "#2b2a21", "#cfdccb": "#27352a", "#eed9cf": "#3a2922",
  "#2b4f9e": "#8fb1ff", "#7a3f9d": "#cb9df0", "#b32c66": "#f58bb6", "#b8500c": "#f3a566",
};
const NAMED = { white: "#ffffff", black: "#15202b" };
const COLOURED = /colou?r$|^fill$|^stroke$|^range$|^value$/i;

// Any other colour on a dark ground: dark ones are lightened half way to white, pale ones darkened.
function onDark(hex) {
  if (ON_DARK[hex]) return ON_DARK[hex];
  const parts = [1, 3, 5].map((i) => Number.parseInt(hex.slice(i, i + 2), 16));
  const pale = (0.3 * parts[0] + 0.6 * parts[1] + 0.1 * parts[2]) > 190;
  return `#${parts.map((each) => Math.round(pale ? 0.28 * each : each + 0.5 * (255 - each)).toString(16).padStart(2, "0")).join("")}`;
}
function recoloured(part, key = "") {
  if (typeof part === "string") {
    const hex = NAMED[part] ?? part.toLowerCase().replace(/^#(.)(.)(.)$/, "#$1$1$2$2$3$3");
    return COLOURED.test(key) && /^#[0-9a-f]{6}$/.test(hex) ? `light-dark(${hex}, ${onDark(hex)})` : part;
  }
  if (Array.isArray(part)) return key === "values" ? part : part.map((each) => recoloured(each, key));
  if (part === null || typeof part !== "object") return part;
  return Object.fromEntries(Object.entries(part).map(([name, each]) => [name, recoloured(each, name)]));
}

const SECONDARY = "light-dark(#4b5965, #a9b5c0)";
const RULE = "light-dark(#c9d1d6, #33404b)";
const EDGE = "light-dark(#73808c, #8593a0)";
const LOOKS = {
  aria: false, background: null, font: getComputedStyle(document.body).fontFamily, padding: { left: 0, top: 4, right: 1, bottom: 4 }, view: { stroke: null },
  axis: { labelFontSize: 11.5, labelColor: SECONDARY, titleFontSize: 12, titleFontWeight: "normal", titleColor: SECONDARY,
    gridColor: RULE, gridWidth: 0.8, domainColor: EDGE, tickColor: EDGE, tickSize: 4, labelPadding: 4 },
  axisX: { grid: false, labelFlush: false, labelOverlap: "greedy", labelSeparation: 8 },
  axisY: { labelOverlap: "greedy", labelSeparation: 4 },
  legend: { offset: 6, labelFontSize: 12, titleFontSize: 12, labelColor: SECONDARY, titleColor: SECONDARY, titleFontWeight: "normal" },
  header: { labelColor: SECONDARY, titleColor: SECONDARY },
  title: { color: SECONDARY, subtitleColor: SECONDARY },
  text: { color: "light-dark(#15202b, #e7ecf0)", fontSize: 12 },
};
// Titles of vertical axes are above them.
const ABOVE = {
  axisLeft: { titleAngle: 0, titleAnchor: "end", titleAlign: "left", titleBaseline: "bottom", titleX: -38, titleY: -8, minExtent: 38 },
  axisRight: { titleAngle: 0, titleAnchor: "end", titleAlign: "right", titleBaseline: "bottom", titleX: 38, titleY: -8 },
};

const lines = (text) => (text === undefined || text === null ? [] : Array.isArray(text) ? text : [text]);
// Rows and heads of every layer that has tooltips.
function numbersOf(part) {
  const out = [];
  const tips = part.encoding?.tooltip;
  if (Array.isArray(tips) && part.data?.values?.length) {
    const fields = tips.map((tip) => ({ field: tip.field, title: tip.title ?? tip.field, number: tip.type === "quantitative" }));
    out.push({ heads: fields.map((each) => String(each.title)), numeric: fields.flatMap((each, i) => each.number ? [i] : []),
      rows: part.data.values.map((row) => fields.map(({ field, number: is }) => is ? digits(row[field], 4) : String(row[field] ?? "–"))) });
  }
  for (const inner of [...(part.layer ?? []), ...(part.vconcat ?? []), ...(part.hconcat ?? []), ...(part.spec ? [part.spec] : [])]) out.push(...numbersOf(inner));
  return out;
}

// The title of a chart, or of the first of its panels that has one.
function titleOf({ title = {}, ...part }) {
  const own = lines(typeof title === "string" ? title : title.text).join(" ");
  return own || (part.vconcat ?? part.hconcat ?? []).map(titleOf).find(Boolean) || "";
}
const drawnViews = [];
async function embedded(place, specification) {
  const simple = !["vconcat", "hconcat", "concat", "facet", "repeat"].some((kind) => kind in specification);
  const shown = recoloured(specification);
  delete shown.title;
  delete shown.config;
  if (simple) Object.assign(shown, { width: "container", autosize: { type: "fit-x", contains: "padding" } });
  const looks = { ...LOOKS, ...(simple ? ABOVE : {}) };
  const { view } = await window.vegaEmbed(place, shown, {
    renderer: "svg", ast: true, actions: false, defaultStyle: false, config: looks, tooltip: { disableDefaultStyle: true },
  });
  if (simple) drawnViews.push({ view, place, height: view.height() });
  return view;
}
async function pictureOf(specification, name, kind) {
  const place = add(document.body, "div", "", "sr-only");
  const { view } = await window.vegaEmbed(place, specification, { renderer: "svg", ast: true, actions: false });
  const address = await view.toImageURL(kind, 2);
  view.finalize();
  place.remove();
  const anchor = document.createElement("a");
  anchor.href = address;
  anchor.download = `hersey-${name}.${kind}`;
  anchor.click();
}

// A chart under its title, with a label for screen readers. `heading` and `note` replace the chart's own, which are
// then in the fold with the data; `behind` is false where a table of the same numbers stands beside the chart.
async function chart(parent, name, { heading = null, level = "h3", note = null, says = "", behind = true, height = null } = {}) {
  const specification = charts[name];
  if (!specification) return null;
  const title = typeof specification.title === "string" ? { text: specification.title } : specification.title ?? {};
  const figure = add(parent, "figure", "", "fig");
  figure.id = `chart-${name}`;
  const words = heading ?? lines(title.text).join(" ");
  if (words) add(figure, level, words);
  const place = add(figure, "div", "", "chart");
  const notes = note === null ? lines(title.subtitle) : lines(note);
  const view = await embedded(place, height === null ? specification : { ...specification, height });
  const drawing = place.querySelector("svg");
  const label = words || titleOf(specification) || name.replaceAll("_", " ");
  figure.setAttribute("role", "group");
  figure.setAttribute("aria-label", label);
  for (const inner of drawing.querySelectorAll("[role], [aria-roledescription], [aria-label]")) {
    for (const name of ["role", "aria-roledescription", "aria-label"]) inner.removeAttribute(name);
  }
  for (const inner of drawing.children) inner.setAttribute("aria-hidden", "true");
  drawing.setAttribute("role", "img");
  drawing.setAttribute("aria-label", [`${label}.`, says, ...notes].filter(Boolean).join(" "));
  for (const text of notes) add(figure, "p", pretty(text), "note");
  if (behind) {
    fold(figure, "Data", (all) => {
      toggles(all, specification, view);
      if (note !== null) for (const text of lines(title.subtitle)) if (!notes.includes(text)) add(all, "p", pretty(text), "note");
      numbersOf(specification).forEach(({ heads, rows, numeric }, i) => table(all, heads, rows, numeric, { name: `${name}${i ? `-${i + 1}` : ""}`, label: words }));
      const foot = add(all, "div", "", "foot");
      for (const kind of ["svg", "png"]) button(foot, `Save ${kind.toUpperCase()}`, () => pictureOf(specification, name, kind));
    }).className = "behind";
  }
  return figure;
}
// Buttons that show and hide the series of a chart.
function toggles(figure, specification, view) {
  const series = specification.usermeta?.series ?? [];
  if (series.length < 2) return;
  const key = add(figure, "div", "", "key");
  key.setAttribute("role", "group");
  key.setAttribute("aria-label", "Show or hide");
  const hidden = new Set();
  for (const { name, value, color } of series) {
    const press = button(key, name, () => {
      if (!hidden.delete(value)) hidden.add(value);
      press.setAttribute("aria-pressed", String(!hidden.has(value)));
      view.signal("hidden", [...hidden]).run();
    });
    press.className = "toggle";
    press.setAttribute("aria-pressed", "true");
    const mark = svg("svg", { viewBox: "0 0 18 10", "aria-hidden": "true" });
    svg("path", { d: "M1 5h16", stroke: recoloured(color, "stroke"), "stroke-width": "2.5" }, mark);
    press.prepend(mark);
  }
}
// On paper, charts take its width and are lower.
const LOWER = 0.64;
addEventListener("beforeprint", () => drawnViews.forEach(({ view, place, height }) => view.width(paperWidth(place)).height(Math.max(110, LOWER * height)).run()));
addEventListener("afterprint", () => drawnViews.forEach(({ view, place, height }) => view.width(place.clientWidth).height(height).run()));
