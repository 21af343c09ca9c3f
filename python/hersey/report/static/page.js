// The page of a report. It shows the analysis document and the charts made from it, and computes nothing
// but the change of units for people.

const TO_RPM = 60 / (2 * Math.PI);
const celsius = (kelvin) => kelvin - 273.15;
const degrees = (kelvin) => data.fit.temperature_scale === "K" ? `${digits(kelvin, 4)} K` : `${digits(celsius(kelvin), 3)} degC`;

function interval(e, scale = 1, count = 4) {
  if (e.low === null || e.high === null) return `${digits(e.value * scale, count)} (interval not told)`;
  return `${digits(e.value * scale, count)} [${digits(e.low * scale, count)}, ${digits(e.high * scale, count)}]`;
}
function ends(e, scale = 1) {
  const sensors = e.systematic ? `; sensors ±${digits(e.systematic * scale, 2)}` : "";
  if (e.low === null || e.high === null) return `interval not told${sensors}`;
  return `95 %: ${digits(e.low * scale, 3)} to ${digits(e.high * scale, 3)}${sensors}`;
}
function seconds(value) {
  return value >= 600 ? `${(value / 60).toFixed(1)} min` : `${digits(value)} s`;
}

function head() {
  add(report, "p", `hersey ${data.hersey_version} · lubrication report`, "soft");
  add(report, "h1", data.title);
  const verdict = add(report, "div", "", "verdict");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", text));
  if (data.warnings.length) {
    const list = add(report, "ul", "", "warnings");
    list.id = "warnings";
    data.warnings.forEach((text) => add(list, "li", text));
  }
  const cards = add(report, "div", "", "cards");
  const card = (value, label) => {
    const box = add(cards, "div", "", "card");
    add(box, "b", value);
    add(box, "span", label);
  };
  const { coefficients: c, transition } = data.fit;
  card(digits(c.c.value, 3), `exponent of speed c, ${ends(c.c)}`);
  if (c.b) {
    const scale = data.fit.temperature_scale;
    card(digits(c.b.value, 3), `exponent of temperature b (in ${scale}), ${ends(c.b)}`);
  }
  if (transition) {
    const t = data.fit.reference_temperature;
    const at = t === null ? "" : ` at ${degrees(t)}`;
    const s = transition.speed;
    card(`${digits(s.value * TO_RPM, 3)} rpm`, `transition${at}, ${ends(s, TO_RPM)}`);
    const m = transition.mixed_exponent;
    card(digits(m.value, 3), `exponent below it, ${ends(m)}`);
  } else {
    card("none", "transition to a falling branch");
  }
  card(digits(data.fit.r_squared_torque, 4), `R² of torque (of damping: ${digits(data.fit.r_squared_damping, 4)})`);
  card(String(data.points.length), "steady points (dwells)");
}

function quality() {
  add(report, "h2", "What the log holds");
  const q = data.quality;
  const share = (rows) => `${rows} (${((100 * rows) / q.rows).toFixed(1)} %)`;
  add(report, "p", `Of ${q.rows} rows, ${share(q.rows_used)} lie in settled dwells, ${share(q.rows_settling)} are the settling `
    + `and edges of those dwells, and ${share(q.rows_rejected)} are not used, for the reasons below.`);
  if (q.standing_torque !== null) {
    const used = q.tare ? "subtracted everywhere" : "not subtracted";
    add(report, "p", `Torque while the drive stood: ${digits(q.standing_torque * 1e3, 3)} mN·m (${used}).`);
  }
  const reasons = new Map();
  for (const r of q.rejected) {
    const kind = r.reason.split(/ by |: /)[0];
    const known = reasons.get(kind) ?? { count: 0, rows: 0 };
    reasons.set(kind, { count: known.count + 1, rows: known.rows + r.rows });
  }
  if (reasons.size) {
    table(report, ["not used because", "stretches", "rows"],
      [...reasons].map(([kind, r]) => [kind, String(r.count), String(r.rows)]), [1, 2]);
    const all = fold(report, "every stretch that is not used");
    table(all, ["file", "from (s)", "to (s)", "rows", "reason"], q.rejected.map((r) => [
      data.files[r.run].name, r.start.toFixed(2), r.end.toFixed(2), String(r.rows), r.reason]), [1, 2, 3]);
  }
}

function files() {
  add(report, "h2", "Input");
  table(report, ["file", "rows", "duration", "every", "gaps", "channels"], data.files.map((f) => [
    f.name, String(f.rows), f.duration ? seconds(f.duration) : "–", f.sampling_interval ? `${digits(f.sampling_interval * 1e3, 3)} ms` : "–", String(f.gaps),
    f.channels.map((c) => `${c.role}: ${c.name || "(no name)"} [${c.unit}]`).join(", ")]), [1, 2, 3, 4]);
  for (const f of data.files) f.comments.forEach((text) => add(report, "p", `${f.name}: “${text}”`, "soft"));
}

function points() {
  const all = fold(report, "every steady point");
  const hot = data.points.some((p) => p.temperature !== null);
  table(all, ["rpm", ...(hot ? ["°C"] : []), "torque (mN·m)", "± (1 s.e.)", "B (mN·m·s/rad)", "off the fit", "approached", "dwell (s)"],
    data.points.map((p) => [
      digits(p.speed * TO_RPM), ...(hot ? [celsius(p.temperature).toFixed(1)] : []), digits(p.torque * 1e3),
      digits(p.torque_error * 1e3, 2), digits(p.damping * 1e3), `${(100 * Math.expm1(p.residual)).toFixed(1)} %`,
      p.approach, `${p.start.toFixed(1)}–${p.end.toFixed(1)}`]), hot ? [0, 1, 2, 3, 4, 5] : [0, 1, 2, 3, 4]);
}

function hypotheses() {
  const element = table(report, ["hypothesis", "exponent", "p-value", "", "meaning"], data.regime.hypotheses.map((h) => {
    const [low, high] = [digits(h.low, 3), digits(h.high, 3)];
    const range = h.low === null ? `below ${high}` : low === high ? high : `${low} to ${high}`;
    return [h.name, range, h.p_value < 1e-4 ? "< 0.0001" : h.p_value.toFixed(4), h.consistent ? "not excluded" : "excluded", h.meaning];
  }), [2]);
  data.regime.hypotheses.forEach((h, i) => { if (h.consistent) element.tBodies[0].rows[i].className = "kept"; });
  const tested = data.fit.transition ? "of the rising branch" : "over all speeds";
  add(report, "p", `Tested is the exponent c ${tested}, ${interval(data.fit.coefficients.c, 1, 3)}. `, "soft");
  add(report, "p", "p-values count all regimes tested, and allow for what the sensors do not know. An exponent is evidence, "
    + "not proof. All that these dwells do not exclude:", "soft");
  const list = add(report, "ul", "", "soft");
  list.id = "explanations";
  data.regime.explanations.forEach((e) => add(list, "li", e.name));
}

async function film() {
  if (!data.film) return;
  add(report, "h2", "What film theory says of this nip");
  await chart(report, "film");
  await chart(report, "transition");
  const notes = add(report, "ul");
  data.film.notes.forEach((text) => add(notes, "li", text));
}

async function carried() {
  if (!data.carried) return;
  add(report, "h2", "What carries the torque");
  const lines = add(report, "ul");
  lines.id = "carried";
  data.carried.text.forEach((text) => add(lines, "li", text));
  await chart(report, "carried");
}

function reproduce() {
  add(report, "h2", "How to reproduce this report");
  if (data.command) add(report, "pre", data.command).id = "command";
  add(report, "p", `hersey ${data.hersey_version}, document schema ${data.schema_version}. Input:`, "soft");
  add(report, "pre", data.files.map((f) => `sha256 ${f.sha256}  ${f.name}`).join("\n"));
}

async function main() {
  document.title = `hersey: ${data.title}`;
  head();
  quality();
  for (const name of ["timeline_speed", "timeline_torque", "timeline_temperature"]) await chart(report, name);
  add(report, "h2", "Torque and damping");
  add(report, "p", "Drag to move, Shift and wheel to zoom, double-click to reset; point at a mark for its numbers.", "soft hint");
  await chart(report, "torque");
  await chart(report, "damping");
  points();
  add(report, "h2", "The surface");
  await chart(report, "surface");
  add(report, "pre", data.fit.summary).id = "summary";
  await chart(report, "residuals");
  add(report, "h2", "Which regime of lubrication");
  await chart(report, "regime");
  hypotheses();
  const level = data.fit.reference_temperature;
  const at = level === null ? "" : ` (at ${degrees(level)})`;
  add(report, "p", data.fit.transition
    ? `The second branch is better than a single power law by ${data.fit.transition.evidence.toFixed(0)} in AICc. Torque is least `
      + `at ${interval(data.fit.transition.speed, TO_RPM, 3)} rpm${at}, ${data.fit.transition.closure === null ? "where the branches meet."
        : `the minimum of a smooth curve: the bend is gradual, and the trend lines on either side meet at ${digits(data.fit.transition.meeting_speed * TO_RPM, 3)} rpm.`}`
    : `No falling branch is announced: ${data.fit.no_transition}.`);
  await film();
  await carried();
  if (data.simulation) await motion();
  files();
  reproduce();
}

async function motion() {
  add(report, "h2", "What stick-slip looks like");
  await chart(report, "simulation_speed");
  await chart(report, "simulation_force");
  add(report, "p", "Exact solution of the paper's hybrid model from rest; parameters: "
    + Object.entries(data.simulation.parameters).map(([k, v]) => `${k.replace("_", " ")} ${typeof v === "number" ? digits(v) : v}`).join(", ")
    + ` (${data.simulation.units}).`, "soft");
}

show(main);
