// The machine: a form with a sketch of each quantity, or the machine file as text.

import { button, draw, link, make, renew, sign, typed } from "./building.js";

const open = new Set();
const GROUPS = { limits: "Limits", contact: "Contact", lubricant: "Lubricant", rest: "No-load torque", drivetrain: "Stick speed" };

export function showMachine(place, view, questions, act) {
  const machine = view.machine;
  const press = (mode, text) => make("button", { type: "button", "aria-pressed": String(machine.mode === mode), "data-control": `mode:${mode}`, text, onclick: () => act.turn(mode) });
  renew(place,
    make("div", { class: "head" },
      make("h2", {}, make("span", { class: "number", text: "3" }), " Machine ", make("span", { class: "note", text: "optional" })),
      make("span", { class: "segments", role: "group", "aria-label": "Machine as" }, press("form", "Form"), press("toml", "TOML"))),
    view.refused ? make("p", { class: "alone", role: "status", text: view.refused }) : null,
    make("div", { class: "machine" }, ...(machine.mode === "form" ? form(view, questions, act) : text(view, act))));
}

const of = (view, at) => view.all_faults.filter((fault) => fault.at === at);
const told = (faults) => faults.map((fault) => `${fault.title} ${fault.text}`).join(" ");

function text(view, act) {
  const faults = of(view, "toml");
  return [make("label", { class: "hint", for: "toml", text: "Machine file: every value with its unit. Or drop a file here." }),
    make("textarea", { id: "toml", class: faults.length ? "wrong" : null, spellcheck: "false", "data-control": "toml", value: view.machine.text, "aria-describedby": "toml-hint", "aria-invalid": faults.length ? "true" : null,
      ...typed((field) => act.machine({ text: field.value })) }),
    make("div", { class: "line" }, make("p", { class: `hint${faults.length ? " act" : ""}`, id: "toml-hint", text: told(faults) }))];
}

function form(view, questions, act) {
  const machine = view.machine;
  const drawing = sketch();
  const meant = (letter) => drawing.querySelectorAll("[data-letter]").forEach((part) => part.classList.toggle("meant", part.dataset.letter === letter));
  const line = (q) => {
    const faults = of(view, `field:${q.key}`);
    const hint = told(faults) || (q.key === "drivetrain.stick_speed" ? "If not measured, type a range, e.g. 1 to 4." : "");
    const id = `m-${q.key}`;
    return make("div", { class: "line" },
      make("label", { for: id, title: q.words }, ...(q.letter ? [make("i", { text: q.letter }), " "] : []), q.called),
      make("input", { class: `field${faults.length ? " wrong" : ""}`, id, "data-control": `field:${q.key}`, value: machine.answers[q.key] ?? "", autocomplete: "off",
        "aria-invalid": faults.length ? "true" : null, "aria-describedby": `${id}-hint`, ...typed((field) => act.machine({ answers: { [q.key]: field.value } })), onfocus: () => meant(q.letter), onblur: () => meant("") }),
      make("span", { class: "unit", text: sign(q.unit) }),
      make("p", { class: `hint${faults.length ? " act" : ""}`, id: `${id}-hint` }, hint, ...faults.filter((fault) => fault.keep).flatMap((fault) => [" ", link(fault.keep, () => act.keep(fault))]), hint ? "" : make("span", { class: "hidden", text: q.words })));
  };
  const others = questions.machine.filter((q) => !q.first);
  const sections = [...new Set(others.map((q) => q.section))];
  const guilty = others.some((q) => of(view, `field:${q.key}`).length);
  const summary = make("summary", { text: "Limits, contact, lubricant, no-load torque", "data-control": "more" });
  const more = make("details", { open: open.has("more") || guilty, ontoggle: () => (more.open ? open.add("more") : open.delete("more")) }, summary,
    ...sections.flatMap((section) => [make("h3", { text: GROUPS[section] }), ...others.filter((q) => q.section === section).map(line)]));
  const kept = machine.kept.length ? make("p", { class: "note", "data-kept": "", text: `Kept from the TOML: ${machine.kept.join(", ")}. The form has no fields for these; edit them in the TOML.` }) : null;
  const place = make("div", {}, drawing, ...questions.machine.filter((q) => q.first).map(line), points(), more, kept,
    ...of(view, "toml").map((fault) => make("div", { class: "alone", text: `${fault.title} ${fault.text}` })));
  return [place];

  function points() {
    const field = (point, number, q) => {
      const at = `field:points.${number}.${q.field}`;
      const faults = of(view, at);
      return make("input", { class: `field${faults.length ? " wrong" : ""}`, "data-control": at, value: point[q.field] ?? "", "aria-label": `${q.field} of point ${number + 1}${q.unit ? `, ${sign(q.unit)}` : ""}`,
        "aria-invalid": faults.length ? "true" : null, placeholder: q.bare_example, ...typed((own) => act.machine({ point: number, answers: { [q.key]: own.value } })) });
    };
    const rows = machine.points.map((point, number) => make("div", { class: "point" }, ...questions.point.map((q) => field(point, number, q)),
      button("×", () => act.machine({ remove: number }), { "aria-label": `Remove point ${number + 1}` })));
    const faults = view.all_faults.filter((fault) => fault.at.startsWith("field:points."));
    return make("div", { class: "points", role: "group", "aria-label": "Operating points" },
      make("div", { class: "line" }, make("span", { text: "Points" }), make("span", { class: "note", text: rows.length ? "" : "speeds to judge" }),
        button("Add", () => act.machine({ add: true }), { "data-control": "points" })),
      rows.length ? make("div", { class: "point headings", "aria-hidden": "true" }, make("span", { text: "name" }), make("span", { text: "mm/s" }), make("span", { text: "°C" })) : null,
      ...rows, faults.length ? make("p", { class: "hint act", text: told(faults) }) : null);
  }
}

/** What each number is: the drive pulls through a spring k on the mass m, which slides under a load. */
function sketch() {
  const part = (letter, ...children) => draw("g", letter ? { "data-letter": letter } : {}, ...children);
  const word = (x, y, text, anchor = "middle") => draw("text", { x, y, "text-anchor": anchor, text });
  const path = (kind, d) => draw("path", { class: kind, d });
  return draw("svg", { class: "sketch", viewBox: "0 0 300 168", width: 300, height: 168, role: "img",
    "aria-label": "Sketch: the drive pulls through a spring k on the mass m, which slides on a surface, pressed on with the load N by a wheel of radius R with a soft layer h and length L; its friction is µ" },
  draw("rect", { class: "body", x: 150, y: 12, width: 112, height: 20, rx: 2 }), word(206, 26, "surface"),
  part("m", draw("path", { class: "belt", d: "M112 38H284", "stroke-width": 3 }), word(118, 31, "m")),
  part("h", draw("circle", { class: "rubber", cx: 206, cy: 94, r: 52 }), path("dimension", "M233 121L243 131M243 131H264"), word(271, 135, "h")),
  draw("circle", { class: "body", cx: 206, cy: 94, r: 38 }),
  part("R", path("dimension", "M206 94H154M206 90v8"), word(182, 88, "R")),
  part("µ", path("dimension", "M214 42l8 12"), word(228, 66, "µ")),
  part("E", word(206, 142, "E")),
  part("L", draw("circle", { class: "dimension", cx: 222, cy: 94, r: 5 }), draw("circle", { cx: 222, cy: 94, r: 1.5 }), word(234, 98, "L")),
  part("k", path("belt", "M112 38h-8l-4-7-8 14-8-14-8 14-8-14-4 7h-8"), word(84, 25, "k")),
  draw("circle", { class: "body", cx: 36, cy: 38, r: 20 }), word(36, 42, "drive"),
  part("N", path("dimension", "M206 164v-14m-4 5 4-6 4 6"), word(216, 164, "N", "start")),
  part("", path("dimension", "M104 52h28m-5-3 5 3-5 3"), word(86, 70, "speed")));
}
