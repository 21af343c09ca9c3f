// A slider with its number field and unit. A value that differs from the report is marked, for screen readers too.

function control(place, { name, label, unit, low, high, logarithmic = true, count = 3, step = null, spoken = label, term = "", change, refused }) {
  const STEPS = 1000;
  const row = add(place, "div", "", "control");
  const caption = add(row, "label");
  const mark = add(caption, "span", "", "changed");
  caption.append(label);
  const slider = add(row, "input");
  const field = add(row, "input", "", "value");
  const unitText = add(row, "span", unit, "unit");
  caption.htmlFor = field.id = `try-${name}`;
  Object.assign(slider, { type: "range", min: 0, max: STEPS, step: 1, id: `slide-${name}` });
  slider.setAttribute("aria-label", `${spoken}, ${unit}`);
  if (spoken !== label) { caption.title = spoken; field.setAttribute("aria-label", `${spoken}, ${unit}`); }
  explained(caption, term);
  Object.assign(field, { type: "text", inputMode: "decimal", autocomplete: "off" });
  let value = null, marked = null, tracked = "";
  const position = (v) => STEPS * (logarithmic ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low));
  const at = (p) => (logarithmic ? low * (high / low) ** (p / STEPS) : low + (high - low) * p / STEPS);
  const rounded = (v) => (step ? Math.round(v / step) * step : Number(v.toPrecision(count)));
  slider.addEventListener("input", () => change(Math.min(Math.max(rounded(at(Number(slider.value))), low), high)));
  field.addEventListener("change", () => {
    const typed = Number(field.value.trim().replace(",", ".").replace("−", "-"));
    const fits = field.value.trim() !== "" && Number.isFinite(typed) && typed >= low * (1 - 1e-9) && typed <= high * (1 + 1e-9);
    field.setAttribute("aria-invalid", String(!fits));
    if (fits) { change(typed); return; }
    refused(`${spoken}: type a number from ${digits(low)} to ${digits(high)} ${unit}`);
  });
  return {
    row, field, slider,
    show(next, changed) {
      const same = next === value && changed === marked && field.getAttribute("aria-invalid") !== "true";
      if (same) return;
      [value, marked] = [next, changed];
      const text = digits(value, 4);
      slider.value = position(Math.min(Math.max(value, low), high));
      slider.setAttribute("aria-valuetext", `${text} ${unit}`);
      if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true") field.value = text.replace("−", "-");
      if (field.getAttribute("aria-invalid") === "true" && document.activeElement !== field) field.setAttribute("aria-invalid", "false");
      row.classList.toggle("differs", changed);
      mark.textContent = changed ? "◆ " : "";
      mark.title = changed ? "differs from the report" : "";
      field.setAttribute("aria-description", changed ? "differs from the report" : "");
    },
    // Colours of the track: [[share from, share to, colour], ...] of values.
    track(bands) {
      const place_of = (v) => `${(Math.min(Math.max(position(v) / STEPS, 0), 1) * 100).toFixed(1)}%`;
      const stops = bands.map(([from, to, colour]) => `var(--${colour}) ${place_of(from)}, var(--${colour}) ${place_of(to)}`);
      const colours = bands.length ? `linear-gradient(90deg, ${stops.join(", ")})` : "";
      if (colours !== tracked) slider.style.setProperty("--track", tracked = colours);
    },
    unit(text) { unitText.textContent = text; },
  };
}
