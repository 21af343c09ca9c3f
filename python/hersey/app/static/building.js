// Elements from text: nothing that a file says becomes markup.

const SVG = "http://www.w3.org/2000/svg";

/** An element with properties (attributes where there is no such property), listeners (onclick) and children. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "text") element.textContent = value;
    else if (name === "value" || name === "checked") element[name] = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined && child !== ""));
  return element;
}

/** An element of a drawing. */
export function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "text") element.textContent = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

const SHAPES = { good: "M6.5 0a6 6 0 1 0 .001 0Z", watch: "M6.5 0 13 12H0Z", act: "M1 0h11v12H1Z" };

/** The shape of a signal, beside which its word stands. */
export function signal(kind) {
  return draw("svg", { class: `signal ${kind}`, viewBox: "0 0 13 12", "aria-hidden": "true" },
    draw("path", { d: SHAPES[kind], fill: "currentColor" }));
}

export const button = (text, act, more = {}) => make("button", { class: "button", type: "button", text, onclick: act, ...more });
export const link = (text, act, more = {}) => make("button", { class: "link", type: "button", text, onclick: act, ...more });

/** A number for people: few digits, a true minus. */
export function digits(value, count = 4) {
  if (value === null || value === undefined) return "–";
  const size = Math.abs(value);
  const text = size >= 1e6 || (size > 0 && size < 1e-4) ? value.toExponential(count - 2) : String(Number(value.toPrecision(count)));
  return text.replace(/-/g, "−");
}

/** A unit as people write it. */
export const sign = (unit) => unit.replace(/\bdeg([CF])\b/g, "°$1").replace(/\*/g, "·");

/** Bytes for people. */
export const size = (bytes) => (bytes >= 1e9 ? `${digits(bytes / 1e9, 3)} GB` : bytes >= 1e6 ? `${digits(bytes / 1e6, 3)} MB` : `${digits(bytes / 1e3, 3)} kB`);

/** Build anew what an element holds, and leave focus and what is being typed where they are. */
export function renew(place, ...children) {
  const active = place.contains(document.activeElement) ? document.activeElement : null;
  const control = active?.dataset.control;
  const typed = active && "value" in active ? active.value : null;
  const dirty = active?.dataset.typed === "1";
  if (active) active.dataset.typed = ""; // what has left the page sends nothing
  const ends = active?.selectionStart !== undefined && active?.type !== "checkbox" ? [active.selectionStart, active.selectionEnd] : null;
  place.replaceChildren(...children.filter((child) => child));
  if (!control) return;
  const again = find(control, place);
  if (!again) return;
  if (dirty && typed !== null) {
    again.value = typed;
    again.dataset.typed = "1";
  }
  again.focus({ preventScroll: true });
  if (ends && ends[0] !== null && again.setSelectionRange) again.setSelectionRange(...ends);
}

/** The control of a name. */
export const find = (control, place = document) => [...place.querySelectorAll("[data-control]")].find((each) => each.dataset.control === control);

/** Listeners of a field whose text counts when it is left, or at Enter; also where the field was built anew meanwhile. */
export const typed = (send) => {
  const leave = (event) => {
    if (event.target.dataset.typed !== "1") return;
    event.target.dataset.typed = "";
    send(event.target);
  };
  return { oninput: (event) => { event.target.dataset.typed = "1"; }, onchange: leave, onfocusout: leave };
};
