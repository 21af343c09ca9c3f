// The page of a report: the first screen, then the sections, each with its finding. It shows the analysis
// document and the charts made from it, and computes nothing but units and words.

function interval(e, scale = 1, count = 3) {
  if (e.low === null || e.high === null) return `${digits(e.value * scale, count)} (interval not told)`;
  return `${digits(e.value * scale, count)} [${digits(e.low * scale, count)}, ${digits(e.high * scale, count)}]`;
}
const bounds = (e, scale = 1, count = 3) => e.low === null || e.high === null ? "not told" : `[${digits(e.low * scale, count)}, ${digits(e.high * scale, count)}]`;
const twoPlaces = (value) => value.toFixed(2).replace("-", "−");
const share = (part, whole) => `${digits((100 * part) / whole, 2)} %`;
const NUMBERS = ["no", "one", "two", "three", "four", "five", "six"];
const plural = (count, word, words = `${word}s`) => `${NUMBERS[count] ?? count} ${count === 1 ? word : words}`;
const capital = (text) => `${text.slice(0, 1).toUpperCase()}${text.slice(1)}`;
const radius = data.map?.roll_radius ?? null;
// A speed of the roll, at the belt where its radius is known.
const rolled = (speed) => radius === null ? `${digits(speed * TO_RPM, 2)} rpm` : `${digits(1e3 * speed * radius, 2)} mm/s`;
const whole = (kelvin) => data.fit.temperature_scale === "K" ? degrees(kelvin) : `${Math.round(celsius(kelvin))} °C`;

// A section with its topic and its finding; listed in the contents.
const made = [];
function section(parent, id, topic, finding) {
  const element = add(parent, "section");
  element.id = id;
  element.setAttribute("aria-labelledby", `${id}-topic`);
  add(element, "h2", topic).id = `${id}-topic`;
  if (finding) add(element, "p", pretty(finding), "finding");
  made.push({ id, topic, element });
  return element;
}
function judged(kind, text) {
  const cell = document.createElement("b");
  cell.className = kind;
  cell.append(signal(kind), text);
  cell.dataset.text = text;
  return cell;
}

// Torque and damping

function torqueNote() {
  const dwells = plural(data.points.length, "dwell");
  const level = radius === null ? "" : ` 10 rpm is ${perSecond((10 / TO_RPM) * radius)} mm/s at the belt.`;
  return `${dwells}; filled: reached from below, open: from above, bars: two standard errors. Lines: the fitted law.${data.fit.rest ? " The rest of the drive is taken off." : ""}${level}`;
}
// Transition speeds over temperature, by the map as far as dwells were measured.
function transitions() {
  const { map, fit } = data;
  if (!map?.temperature || !map.measured_temperature) return fit.transition_curve;
  const [low, high] = map.measured_temperature;
  return map.temperature.map((temperature, i) => ({ temperature, speed: (map.transition[i] ?? 0) / map.roll_radius }))
    .filter((each) => each.speed > 0 && each.temperature >= low - 1 && each.temperature <= high + 1);
}
function torqueFinding() {
  const { transition, reference_temperature: level } = data.fit;
  const curve = transitions();
  if (!transition) return untoldFinding();
  if (curve.length < 2) return `Torque falls up to ${rolled(transition.speed.value)}${level === null ? "" : ` at ${degrees(level)}`} and rises above.`;
  const [cold, hot] = [curve[0], curve.at(-1)];
  const way = hot.speed > cold.speed ? "climbs" : "falls";
  return `Torque rises with speed above the transition and falls below it; the transition ${way} from ${rolled(cold.speed)} at ${whole(cold.temperature)} to ${rolled(hot.speed)} at ${whole(hot.temperature)}.`;
}
// Without a transition: where torque falls with speed, damping falls faster than as its inverse.
function untoldFinding() {
  const c = data.fit.coefficients.c.value;
  const [slow, fast] = data.regime.lack_of_fit?.local_exponents ?? [c, c];
  const fallsSlow = slow < -1;
  if (fallsSlow !== fast < -1) {
    const [falls, rises] = fallsSlow ? ["slow", "fast"] : ["fast", "slow"];
    return `Torque falls with speed at the ${falls} end (exponent of damping ${twoPlaces(fallsSlow ? slow : fast)}) and rises at the ${rises} one; no transition is told.`;
  }
  return fallsSlow ? "Torque falls with speed over all speeds measured." : "Torque rises with speed over all speeds measured; no falling branch is seen.";
}
async function torqueSection(parent) {
  const finding = torqueFinding();
  const part = section(parent, "torque", "Torque and damping", finding);
  const columns = add(part, "div", "", "columns");
  if (data.map) await chart(columns, "torque", { heading: "Drag torque", note: "", says: finding });
  await chart(columns, "damping", { heading: "Damping = torque / speed", note: data.map ? "" : "Dashed: slope −1, where torque does not depend on speed.", says: finding });
  if (!data.map) await chart(columns, "residuals");
  if (data.map) add(part, "p", `${torqueNote()} Dashed: slope −1, where torque does not depend on speed.`, "note");
  const all = fold(part, `Exponents, statistics and ${data.points.length === 1 ? "the dwell" : `all ${data.points.length} dwells`}`, async (inside) => {
    exponents(inside);
    add(inside, "pre", data.fit.summary).id = "summary";
    dwells(inside);
    const pair = add(inside, "div", "", "columns");
    if (data.map) await chart(pair, "residuals");
    await chart(pair, "surface", { behind: false });
  });
  all.id = "statistics";
}
function exponents(parent) {
  const { coefficients: c, transition } = data.fit;
  const rows = [["exponent of speed, c", digits(c.c.value), bounds(c.c), transition ? "damping above the transition" : "damping, over all speeds"]];
  if (transition) {
    const at = data.fit.reference_temperature === null ? "" : ` at ${degrees(data.fit.reference_temperature)}`;
    rows.push(["exponent below it", digits(transition.mixed_exponent.value), bounds(transition.mixed_exponent), "below −1: torque falls with speed"]);
    rows.push([`transition${at}, rpm`, digits(transition.speed.value * TO_RPM), bounds(transition.speed, TO_RPM),
      transition.closure === null ? "where the branches meet" : `least torque of a gradual bend; the trend lines meet at ${digits(transition.meeting_speed * TO_RPM)} rpm`]);
    rows.push(["gain in AICc of the second branch", digits(transition.evidence), "", "over a single power law"]);
  }
  if (c.b) rows.push(["exponent of temperature, b", digits(c.b.value), bounds(c.b), `in ${data.fit.temperature_scale === "K" ? "K" : "°C"}`]);
  rows.push(["R² of torque", digits(data.fit.r_squared_torque, 4), "", `of damping: ${digits(data.fit.r_squared_damping, 4)}`]);
  table(parent, ["Number", "Value", "95 % interval", "Meaning"], rows, [1, 2], { label: "Exponents and transition" });
  if (data.fit.no_transition) add(parent, "p", pretty(`No falling branch is announced: ${data.fit.no_transition}.`), "text");
}
function dwells(parent) {
  const hot = data.points.some((p) => p.temperature !== null);
  const [factor, unit] = torqueUnit();
  table(parent, ["Roll, rpm", ...(hot ? ["°C"] : []), `Torque, ${unit}`, "± (1 s.e.)", `Damping, ${unit}·s/rad`, "Off the fit, %", "Approached", "From, s", "To, s"],
    data.points.map((p) => [
      digits(p.speed * TO_RPM, 4), ...(hot ? [celsius(p.temperature).toFixed(1)] : []), digits(p.torque * factor, 4),
      digits(p.torque_error * factor, 2), digits(p.damping * factor, 4), (100 * Math.expm1(p.residual)).toFixed(1).replace("-", "−"),
      p.approach, p.start.toFixed(1), p.end.toFixed(1)]),
    [0, 1, 2, 3, 4, ...(hot ? [5, 7, 8] : [6, 7])], { name: "dwells", label: "All dwells" });
}

// Regime and film, as one story

function regimeFinding() {
  const { named, why_unnamed: why } = data.regime;
  const c = twoPlaces(data.fit.coefficients.c.value);
  const nip = data.film?.points[0]?.regime ?? data.film?.dwells[0]?.regime ?? null;
  const fits = data.film?.exponents?.predictions.find((each) => each.film === nip)?.consistent;
  if (nip && named && fits === false) return `The log looks like ${named}; the nip says ${nip}. Trust the exponent for prediction, not for film thickness.`;
  if (nip && named) return `Log and nip agree: ${named}. Damping goes as speed to the power ${c}, as the ${nip} film of this nip.`;
  if (nip) return `The nip says ${nip}; the log's exponent ${c} names no regime alone.`;
  if (named) return `The exponent ${c} is that of ${named}; only the nip's own numbers can say more.`;
  return `The exponent ${c} names no regime: ${why}.`;
}
async function regimeSection(parent) {
  const finding = regimeFinding();
  const part = section(parent, "regime", "Regime and film", finding);
  const columns = add(part, "div", "", "columns");
  const c = data.fit.coefficients.c;
  await chart(columns, "regime", { heading: `1. What the log says: ${twoPlaces(c.value)}`, says: finding });
  const nip = data.film?.points[0]?.regime ?? data.film?.dwells[0]?.regime;
  await chart(columns, "film", { heading: `2. What the nip says: ${nip ?? ""}`, says: finding });
  if (data.film) misfits(part);
  else explanations(columns);
  const more = add(part, "div", "", "columns");
  await chart(more, "transition");
  await chart(more, "carried");
  if (data.carried) {
    const said = add(more, "div", "", "across");
    said.id = "carried";
    for (const text of data.carried.text) add(said, "p", pretty(text), "note");
  }
  const all = fold(part, "The reasoning in full, and all regimes tested");
  const verdict = add(all, "div");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", pretty(text), "text"));
  hypotheses(all);
  if (data.film) explanations(all);
}
function misfits(parent) {
  const given = data.film.misfits ?? [];
  if (given.length) {
    add(parent, "h3", "3. What does not fit, largest first");
    checks(parent, given.map((each) => [each.signal, sentence(each.text)]));
  }
  add(parent, "h3", given.length ? "What else the film says" : "3. What the film of this nip says");
  const notes = add(parent, "ul", "", "checks plain");
  notes.id = "notes";
  for (const text of data.film.notes) add(notes, "li", pretty(text));
}
function hypotheses(parent) {
  const element = table(parent, ["Regime", "Exponent", "p-value", "Result", "Meaning"], data.regime.hypotheses.map((h) => {
    const [low, high] = [digits(h.low), digits(h.high)];
    const range = h.low === null ? `below ${high}` : low === high ? high : `${low} to ${high}`;
    return [h.name, range, h.p_value < 1e-4 ? "< 0.0001" : h.p_value.toFixed(4), h.consistent ? "not excluded" : "excluded", pretty(h.meaning)];
  }), [2], { name: "regimes", label: "Regimes tested" });
  data.regime.hypotheses.forEach((h, i) => { if (h.consistent) element.tBodies[0].rows[i].className = "kept"; });
  const tested = data.fit.transition ? "of the rising branch" : "over all speeds";
  add(parent, "p", `Tested is the exponent c ${tested}, ${interval(data.fit.coefficients.c)}. p-values count all regimes tested, and allow for what the sensors do not know.`, "note");
}
function explanations(parent) {
  const box = add(parent, "div");
  add(box, "h3", "What the dwells do not exclude");
  const list = add(box, "ul");
  list.id = "explanations";
  data.regime.explanations.forEach((e) => add(list, "li", pretty(e.name)));
  add(box, "p", "An exponent is evidence, not proof.", "note");
}

// Candidates

// Laws that were fitted to the rising branch, the likeliest first.
function tried(parent) {
  const all = data.regime.tried ?? [];
  if (!all.length) return;
  const count = plural(all.length, "law");
  const held = all.filter((each) => each.verdict === "not excluded");
  const next = held[1] ? `; the next is worse by ${digits(held[1].aicc - held[0].aicc, 2)} in AICc` : "";
  const part = section(parent, "candidates", "Candidates", held.length
    ? `Of ${count} tried ${held.length === 1 ? "one is not excluded" : `${plural(held.length, "law").split(" ")[0]} are not excluded, the likeliest`}: ${held[0].name}${next}.`
    : `Of ${count} tried none holds; the nearest is ${all[0].name}.`);
  const least = Math.min(...all.map((each) => each.aicc));
  table(fold(part, `The ${count}`), ["Law", "ΔAICc", "Constant share, %", "p of its bend", "Result"], all.map((each) => [
    each.name, digits(each.aicc - least), each.constant_share === null ? "–" : digits(100 * each.constant_share), each.curvature === null ? "–" : digits(each.curvature, 2), pretty(each.verdict)]),
  [1, 2, 3], { name: "candidates", label: "Candidates" });
}
function candidates(parent) {
  const { models } = data;
  if (!models) {
    tried(parent);
    return;
  }
  const order = [...models.candidates].sort((a, b) => (a.delta_aicc ?? 1e9) - (b.delta_aicc ?? 1e9));
  const best = models.candidates.find((each) => each.key === models.chosen);
  const next = order.find((each) => each.key !== models.chosen && each.delta_aicc !== null);
  const part = section(parent, "candidates", "Candidates",
    `Of ${plural(order.length, "law")} ${best?.name ?? models.chosen} is chosen${best?.cross_validation ? `: it misses dwells left out by ${digits(100 * best.cross_validation)} %` : ""}`
    + `${next ? `; the next is worse by ${digits(next.delta_aicc - (best?.delta_aicc ?? 0), 2)} in AICc` : ""}.`);
  checks(part, models.warnings.map((text) => ["watch", pretty(text)]));
  const all = fold(part, `The ${order.length} laws`);
  const percent = (value) => value === null ? "–" : digits(100 * value);
  const element = table(all, ["Law", "Numbers", "ΔAICc", "ΔBIC", "Left out, %", "Scatter, %"], order.map((each) => [
    each.name, String(Object.keys(each.parameters).length), digits(each.delta_aicc), digits(each.delta_bic), percent(each.cross_validation), percent(each.scatter)]),
  [1, 2, 3, 4, 5], { name: "candidates", label: "Candidates" });
  order.forEach((each, i) => { if (each.key === models.chosen) element.tBodies[0].rows[i].className = "kept"; });
  const why = fold(part, "Why this one, and its numbers");
  models.reasons.forEach((text) => add(why, "p", pretty(text), "text"));
  table(why, ["Number", "Value", "Unit", "95 % interval"], models.parameters.map((p) => {
    const [low, high] = Object.values(p.intervals)[0] ?? [null, null];
    return [p.name, digits(p.value, 4), p.unit, `[${digits(low, 4)}, ${digits(high, 4)}]`];
  }), [1, 3], { name: "parameters", label: "Numbers of the law chosen" });
  for (const text of [models.activation_energy.verdict, models.hersey_collapse?.verdict, models.errors_in_variables.verdict]) if (text) add(why, "p", pretty(text), "text");
  for (const each of models.refused) add(why, "p", pretty(`Not fitted: ${each.name}: ${each.reason}`), "note");
}

// Data quality

function dataSection(parent) {
  const q = data.quality;
  const sticks = q.rejected.filter((r) => /stick-slip/.test(r.reason)).length;
  const others = q.rejected.length - sticks;
  const left = [sticks ? `${plural(sticks, "stretch", "stretches")} of stick-slip` : "", others ? plural(others, sticks ? "other" : "stretch", sticks ? "others" : "stretches") : ""].filter(Boolean).join(" and ");
  const count = sticks + others;
  const finding = `${share(q.rows_used, q.rows)} of the rows lie in ${plural(data.points.length, "settled dwell")}${left ? `; ${left} ${count === 1 ? "is" : "are"} left out` : ""}.`;
  const part = section(parent, "data", "Data quality", finding);
  if (data.timeline.starts.length && data.timeline.speed.time.length > 1) timeline(part, finding);
  add(part, "p", `${share(q.rows_settling, q.rows)} of the rows are the settling and the edges of dwells, ${share(q.rows_rejected, q.rows)} are not used.`
    + (q.standing_torque === null ? "" : ` Torque while the drive stood: ${digits(q.standing_torque * 1e3)} mN·m, ${q.tare ? "taken off everywhere" : "not taken off"}.`), "note");
  if (data.warnings.length) {
    add(part, "h3", "What to know before trusting the numbers");
    const list = add(part, "ul", "", "checks plain");
    list.id = "warnings";
    for (const text of data.warnings) add(list, "li", pretty(text));
  }
  if (q.rejected.length) {
    const all = fold(part, `Every stretch that is not used, and why (${q.rejected.length})`);
    const reasons = new Map();
    for (const r of q.rejected) {
      const kind = r.reason.split(/ by |: /)[0];
      const known = reasons.get(kind) ?? [0, 0];
      reasons.set(kind, [known[0] + 1, known[1] + r.rows]);
    }
    table(all, ["Reason", "Stretches", "Rows"], [...reasons].map(([kind, [stretches, rows]]) => [kind, String(stretches), counted(rows)]), [1, 2], { label: "Reasons" });
    table(all, ["File", "From, s", "To, s", "Rows", "Reason"], q.rejected.map((r) => [
      data.files[r.run].name, r.start.toFixed(2), r.end.toFixed(2), String(r.rows), pretty(r.reason)]), [1, 2, 3], { name: "not-used", label: "Stretches not used" });
  }
  const input = fold(part, `${capital(plural(data.files.length, "file"))}: channels, units and comments`);
  table(input, ["File", "Rows", "Duration", "Every, ms", "Gaps", "Channels"], data.files.map((f) => [
    f.name, counted(f.rows), f.duration ? seconds(f.duration) : "–", f.sampling_interval ? digits(f.sampling_interval * 1e3) : "–", String(f.gaps),
    f.channels.map((c) => `${c.role}: ${c.name || "(no name)"} [${c.unit}]`).join(", ")]), [1, 2, 3, 4], { label: "Files" });
  for (const f of data.files) f.comments.forEach((text) => add(input, "p", `${f.name}: “${text}”`, "note"));
}

// Band and safe step

async function bandSection(parent) {
  const all = data.decision?.points ?? [];
  const bears = all.filter((p) => p.disturbance);
  const steps = all.flatMap((p) => p.steps.map((step) => ({ ...step, to: p })));
  if (!data.map && !data.band && !bears.length && !steps.length) return;
  const part = section(parent, "band", "Band and safe step", bandFinding(bears, steps));
  const columns = add(part, "div", "", "columns");
  await chart(columns, "stick_speed", { says: bandFinding(bears, steps) });
  if (data.map && !charts.stick_speed) bandTable(columns);
  const right = add(columns, "div");
  if (bears.length) {
    add(right, "h3", "What sliding there bears");
    table(right, ["Point", "Kick, mm/s", "Step down, mm/s"], bears.map((p) => [
      p.name, p.disturbance.kick === null ? "any" : perSecond(p.disturbance.kick), p.disturbance.step === null ? "any" : perSecond(p.disturbance.step)]), [1, 2], { label: "What sliding bears" });
  }
  if (steps.length) {
    add(right, "h3", "Steps from steady sliding");
    table(right, ["Step, mm/s", "To", "Slowest, mm/s", "Result"], steps.map((s) => [
      `${perSecond(s.from_speed)} to ${perSecond(s.to_speed)}`, s.to.name, perSecond(s.slowest),
      s.sticks ? judged("act", s.ramp_time === null ? "sticks, on any ramp" : `sticks; a ramp of ${rampOf(s)} slides`) : judged("good", "slides")]),
    [2], { name: "steps", label: "Steps from steady sliding" });
  }
  if (data.band) {
    const moves = Object.entries(data.band.sensitivity).filter(([, value]) => value !== null && Math.abs(value) >= 0.005);
    if (moves.length) add(part, "p", `One per cent more moves V* by: ${moves.map(([name, value]) => `${name.replaceAll("_", " ")} ${digits(value, 2)} %`).join(", ")}.`, "note");
  }
  if (data.map && charts.stick_speed) fold(part, "Edges of the band by temperature", bandTable);
  if (data.map) data.map.warnings.forEach((text) => add(part, "p", sentence(text), "note"));
}
const rampOf = (step) => step.ramp_time >= 1 ? `${digits(step.ramp_time, 2)} s` : `${digits(step.ramp_time * 1e3, 2)} ms`;
function bandFinding(bears, steps) {
  const parts = [];
  const weak = bears.filter((p) => p.disturbance.kick !== null || p.disturbance.step !== null).sort((a, b) => (a.disturbance.kick ?? 9) - (b.disturbance.kick ?? 9))[0];
  if (weak) {
    const can = [weak.disturbance.kick === null ? "" : `a kick of ${digits(1e3 * weak.disturbance.kick, 2)} mm/s`, weak.disturbance.step === null ? "" : `a step of ${digits(1e3 * weak.disturbance.step, 2)}`].filter(Boolean);
    parts.push(`At ${perSecond(weak.speed)} mm/s the belt bears ${can.join(" or ")}`);
  }
  const bad = steps.find((s) => s.sticks);
  if (bad) parts.push(`from ${perSecond(bad.from_speed)} straight to ${perSecond(bad.to_speed)} it sticks${bad.ramp_time === null ? "" : `, a ramp of ${rampOf(bad)} saves it`}`);
  else if (steps.length) parts.push("no step between your points makes it stick");
  if (!parts.length && data.map) {
    const { temperature, transition, upper } = data.map;
    const i = transition.length - 1;
    const at = temperature ? ` at ${degrees(temperature[i])}` : "";
    parts.push(transition[i] === null ? "Nothing sticks within the speeds looked at" : `Smooth above ${perSecond(upper[i] ?? transition[i])} mm/s${at}; below ${perSecond(transition[i])} it sticks`);
  }
  if (!parts.length && data.band) return data.band.verdict.split(". ")[0];
  return parts.length ? `${capital(parts.join("; "))}.` : "";
}
// The edges at a few temperatures of the map.
function bandTable(parent) {
  const { temperature, lower, transition, upper, upper_interval: ends } = data.map;
  const box = add(parent, "div");
  if (parent.className === "columns") add(box, "h3", "Edges of the band");
  const count = transition.length;
  const [low, high] = data.map.measured_temperature ?? [-Infinity, Infinity];
  const inside = transition.map((_, i) => i).filter((i) => !temperature || (temperature[i] >= low - 1 && temperature[i] <= high + 1));
  const from = inside.length ? inside : transition.map((_, i) => i);
  const shown = count === 1 ? [0] : [...new Set([0, 1, 2, 3, 4].map((k) => from[Math.round((k * (from.length - 1)) / 4)]))];
  table(box, [...(temperature ? ["Temperature, °C"] : []), "Sticks below, mm/s", "Smooth above (V*), mm/s", "95 %"], shown.map((i) => [
    ...(temperature ? [digits(celsius(temperature[i]))] : []), perSecond(transition[i]), perSecond(upper[i] ?? null),
    `[${perSecond(ends[0]?.[i])}, ${perSecond(ends[1]?.[i])}]`]), temperature ? [0, 1, 2, 3] : [0, 1, 2], { name: "band", label: "Edges of the band" });
}

// Plan per point

const failuresOf = (plan) => Object.entries(plan.failures).filter(([, count]) => count).map(([name, count]) => `${name.replaceAll("_", " ")} ${count}`).join(", ");
function planFinding(point) {
  const { plan } = point;
  const name = capital(point.name);
  const sure = plan.share ? ` It slides in ${digits(100 * plan.share, 2)} % of the machines that fit the log.` : "";
  if (plan.kind === "overshoot") return `${name}: up to ${perSecond(plan.peak_speed)} mm/s, hold ${digits(plan.hold, 2)} s, down to ${perSecond(plan.target_speed)}.${sure}`;
  if (plan.kind === "direct") return `${name}: straight up to ${perSecond(plan.target_speed)} mm/s in ${digits(plan.rise, 2)} s.${sure}`;
  return `${name}: no profile within the limits reaches ${perSecond(plan.target_speed)} mm/s sliding.`;
}
async function planSection(parent) {
  const all = data.decision?.points ?? [];
  const planned = all.filter((p) => p.plan);
  const whole = data.plan ? [{ name: "profile", speed: data.plan.target_speed, temperature: data.plan.temperature, plan: data.plan }] : [];
  const shown = planned.length ? planned : whole;
  if (!shown.length && !all.length) return;
  const part = section(parent, "plan", "Plan per point", shown.length ? planFinding(shown[0]) : "No point needs a plan: straight up to speed, and the belt slides.");
  let i = 0;
  for (const point of shown) {
    await onePlan(part, point, i);
    i += 1;
  }
  for (const point of all.filter((p) => !p.plan)) {
    add(part, "h3", pointName(point));
    const line = add(part, "p");
    line.append(signal(point.signal), point.reason ? pretty(point.reason) : `Needs no plan: ${pretty(point.words)}.`);
  }
}
const pointName = (p) => `${capital(p.name)}, ${perSecond(p.speed)} mm/s${p.temperature === null ? "" : ` at ${degrees(p.temperature)}`}`;
async function onePlan(parent, point, i) {
  const { plan } = point;
  add(parent, "h3", pointName(point));
  if (i) add(parent, "p", pretty(planFinding(point)), "text");
  const columns = add(parent, "div", "", "columns");
  await chart(columns, `plan_${i}`, { heading: "", says: planFinding(point), behind: false });
  const side = add(columns, "div");
  if (plan.rows.length) {
    const heads = ["Time, s", "Drive, mm/s", ...(radius === null ? [] : ["Roll, rpm"])];
    table(side, heads, plan.rows.map((row) => [row.time.toFixed(3), digits(row.drive_speed * 1e3), ...(radius === null ? [] : [digits((row.drive_speed / radius) * TO_RPM)])]),
      heads.map((_, k) => k), { name: `profile-${i + 1}`, label: `Profile of ${point.name}` });
    const foot = side.querySelector(".foot");
    const press = button(foot, "Try this profile", () => { controller?.profile(plan.rows); document.getElementById("map").scrollIntoView(); });
    press.disabled = true;
    press.dataset.profile = "";
  }
  const marks = plan.uses.map((use) => [use.used !== null && use.used > use.limit ? "watch" : "good", `${capital(use.name.replaceAll("_", " "))}: ${use.used === null ? "not told" : amount(use.name, use.used)[0]} of ${amount(use.name, use.limit).join(" ")}`]);
  marks.push(...plan.obstacles.map((each) => ["act", pretty(each.text)]), ...plan.warnings.map((text) => ["watch", pretty(text)]));
  checks(side, marks);
  const all = fold(columns, "How sure, in full");
  all.classList.add("across");
  add(all, "p", pretty(plan.verdict), "text");
  add(all, "p", `${digits(100 * plan.share, 3)} % of ${plural(plan.draws, "draw")} slide; the true share exceeds ${digits(100 * plan.share_low, 3)} % with 95 % confidence. `
    + `${failuresOf(plan) ? `Others: ${failuresOf(plan)}. ` : ""}Seed ${plan.seed}, ${plural(plan.tried, "profile")} tried.`, "text");
}
// A value and its unit.
function amount(name, value) {
  const [factor, unit] = /torque/.test(name) ? torqueUnit() : /force|grip/.test(name) ? [1, "N"] : /acceleration/.test(name) ? [1e3, "mm/s²"] : /speed/.test(name) ? [1e3, "mm/s"] : [1, ""];
  return [digits(value * factor), unit];
}

// Comparison, and whatever else the document holds

async function comparison(parent) {
  const { compare } = data;
  if (!compare) return;
  const part = section(parent, "compare", "Comparison", compare.verdict.split(". ")[0].replace(/\.?$/, "."));
  await chart(part, "compare", { says: compare.verdict });
  // What is compared as a ratio is a speed of the roll.
  const of = (c) => c.is_ratio ? [`${c.name}, rpm`, digits(c.of_a * TO_RPM), digits(c.of_b * TO_RPM)] : [c.name, digits(c.of_a), digits(c.of_b)];
  table(part, ["Number", compare.a, compare.b, "Change", "95 % interval", "p-value", "Real"], compare.changes.map((c) => [
    ...of(c), `${c.is_ratio ? "× " : ""}${digits(c.change.value)}`, bounds(c.change), c.p_value === null ? "–" : digits(c.p_value, 2),
    c.real ? judged("watch", "yes") : "no"]), [1, 2, 3, 4, 5], { name: "comparison", label: "What changed" });
  const all = fold(part, "In full");
  add(all, "p", pretty(compare.verdict), "text");
  compare.notes.forEach((text) => add(all, "p", pretty(text), "note"));
}
async function warmUp(parent) {
  if (!data.warm_up) return;
  const part = section(parent, "warm-up", "Warm-up", data.warm_up.verdict.split(". ")[0].replace(/\.?$/, "."));
  await chart(part, "warm_up");
  [data.warm_up.verdict, ...data.warm_up.beside].forEach((text) => add(part, "p", pretty(text), "text"));
  checks(part, data.warm_up.warnings.map((text) => ["watch", pretty(text)]));
}
const SHOWN = new Set(["schema_version", "hersey_version", "title", "command", "made", "machine", "synthetic", "decision", "verdict", "warnings", "files", "quality", "points", "fit",
  "regime", "film", "carried", "simulation", "timeline", "stick_speed_sweep", "models", "compare", "against", "units", "band", "map", "plan", "warm_up", "uncertainty"]);
function others(parent) {
  const left = Object.entries(data).filter(([name, part]) => part !== null && !SHOWN.has(name));
  if (!left.length) return;
  const part = section(parent, "others", "Further results", `The document also holds ${left.map(([name]) => name.replaceAll("_", " ")).join(", ")}.`);
  for (const [name, each] of left) add(fold(part, name.replaceAll("_", " ")), "pre", JSON.stringify(each, null, 1));
}

function reproduce(parent) {
  const { rest } = data.fit;
  const inputs = [...data.files, ...(data.against ?? []), ...(data.machine ? [data.machine] : []), ...(rest?.sha256 ?? []).map((sha256) => ({ name: rest.source, sha256 }))];
  const seed = data.decision?.points.find((p) => p.plan)?.plan.seed;
  const part = section(parent, "reproduce", "Reproduce", `One command, ${plural(inputs.length, "file")}${seed === undefined ? "" : `, one seed (${seed})`}.`);
  if (data.command) add(part, "pre", data.command).id = "command";
  const all = inputs.length > 8 ? fold(part, `${inputs.length} files and their hashes`) : part;
  table(all, ["File", "sha256"], inputs.map((f) => {
    const hash = document.createElement("span");
    hash.className = "mono";
    hash.textContent = f.sha256;
    hash.dataset.text = f.sha256;
    return [f.name, hash];
  }), [], { label: "Input" });
  add(part, "p", `hersey ${data.hersey_version}, document schema ${data.schema_version}, intervals at 95 %.`, "note");
  const foot = add(part, "div", "", "foot");
  if (data.command) button(foot, "Copy command", (from) => copy(data.command, from));
  button(foot, "Save document (JSON)", () => save("hersey.json", document.getElementById("document").textContent, "application/json"));
}

function contents(parent) {
  const list = add(parent, "ol");
  const links = made.map(({ id, topic }) => link(add(list, "li"), topic, id));
  const mark = () => {
    const current = made.findLastIndex(({ element }) => element.getBoundingClientRect().top < innerHeight / 3);
    links.forEach((each, i) => { if (i === Math.max(0, current)) each.setAttribute("aria-current", "true"); else each.removeAttribute("aria-current"); });
  };
  addEventListener("scroll", mark, { passive: true });
  mark();
}

async function main() {
  document.title = `hersey: ${data.title}`;
  titleLine();
  decision();
  await mapAndPanel();
  const grid = add(report, "div", "", "sections");
  const nav = add(grid, "nav", "", "contents");
  nav.id = "contents";
  nav.setAttribute("aria-label", "Contents");
  add(nav, "h2", "Contents");
  const parts = add(grid, "div");
  await torqueSection(parts);
  await regimeSection(parts);
  candidates(parts);
  dataSection(parts);
  await bandSection(parts);
  await planSection(parts);
  await comparison(parts);
  await warmUp(parts);
  others(parts);
  reproduce(parts);
  contents(nav);
  linkFlags();
  if (controller) for (const press of document.querySelectorAll("[data-profile]")) press.disabled = false;
  document.getElementById("end").textContent = `hersey ${data.hersey_version}`;
}

show(main);
