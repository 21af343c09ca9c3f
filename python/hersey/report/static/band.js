// Safe speeds: what moves V*, which disturbances sliding survives, and which steps between points are safe.

async function bandSection(parent) {
  const all = data.decision?.points ?? [];
  const withstand = all.filter((p) => p.disturbance);
  const steps = all.flatMap((p) => p.steps.map((step) => ({ ...step, to: p })));
  if (!data.map && !data.band && !withstand.length && !steps.length) return;
  const part = section(parent, "band", "Safe speeds and steps", bandFinding(withstand, steps));
  const columns = add(part, "div", "", "columns");
  await chart(columns, "stick_speed", { says: bandFinding(withstand, steps) });
  if (data.map && !charts.stick_speed) bandTable(columns);
  const right = add(columns, "div");
  if (withstand.length) {
    add(right, "h3", "Disturbances that sliding survives");
    table(right, ["Point", "Speed loss, mm/s", "Step down, mm/s"], withstand.map((p) => [
      p.name, p.disturbance.kick === null ? "any" : perSecond(p.disturbance.kick), p.disturbance.step === null ? "any" : perSecond(p.disturbance.step)]), [1, 2], { label: "Disturbances that sliding survives" });
  }
  if (steps.length) {
    add(right, "h3", "Steps between points");
    table(right, ["Step, mm/s", "To", "Slowest, mm/s", "Result"], steps.map((s) => [
      `${perSecond(s.from_speed)} to ${perSecond(s.to_speed)}`, s.to.name, perSecond(s.slowest),
      s.sticks ? judged("act", s.ramp_time === null ? "sticks on any ramp" : `sticks; use a ramp ≥ ${rampOf(s)}`) : judged("good", "smooth")]),
    [2], { name: "steps", label: "Steps from steady sliding" });
  }
  const moves = Object.entries(data.band?.sensitivity ?? {}).filter(([, value]) => value !== null && Math.abs(value) >= 0.005);
  const table_too = data.map && charts.stick_speed;
  if (table_too || moves.length) {
    const more = fold(part, table_too ? `V* by temperature${moves.length ? " and sensitivity" : ""}` : "Sensitivity of V*");
    if (table_too) bandTable(more);
    if (moves.length) add(more, "p", `V* changes by this much when a parameter rises by 1 %: ${moves.map(([name, value]) => `${name.replaceAll("_", " ")} ${digits(value, 2)} %`).join(", ")}.`, "note");
  }
  if (data.map) warnings(part, data.map.warnings, { heading: "Warnings about the map", folded: "Notes on the map" });
}
const rampOf = (step) => step.ramp_time >= 1 ? `${digits(step.ramp_time, 2)} s` : `${digits(step.ramp_time * 1e3, 2)} ms`;
function bandFinding(withstand, steps) {
  const parts = [];
  const weak = withstand.filter((p) => p.disturbance.kick !== null || p.disturbance.step !== null).sort((a, b) => (a.disturbance.kick ?? 9) - (b.disturbance.kick ?? 9))[0];
  if (weak && !steps.length) { // the tables and the panel have it
    parts.push(`At ${perSecond(weak.speed)} mm/s, sliding survives a sudden speed change of ${perSecond(Math.min(weak.disturbance.kick ?? Infinity, weak.disturbance.step ?? Infinity))} mm/s`);
  }
  const bad = steps.find((s) => s.sticks);
  if (bad) {
    const step = `from ${perSecond(bad.from_speed)} to ${perSecond(bad.to_speed)} mm/s`;
    parts.push(bad.ramp_time === null ? `Any change ${step} makes it stick` : `${bad.to_speed < bad.from_speed ? "Slow down" : "Speed up"} ${step} over at least ${rampOf(bad)}`);
  } else if (steps.length) parts.push("No step between the operating points makes it stick");
  if (!parts.length && data.map) {
    const { temperature, transition, upper } = data.map;
    const i = transition.length - 1;
    const at = temperature ? ` at ${degrees(temperature[i])}` : "";
    parts.push(transition[i] === null ? "Nothing sticks in the speed range of the map" : `Smooth above ${perSecond(upper[i] ?? transition[i])} mm/s${at}; below ${perSecond(transition[i])} it sticks`);
  }
  if (!parts.length && data.band) return data.band.verdict;
  return parts.length ? `${parts.join(". ")}.` : "";
}
// Sticks below and smooth above, at a few temperatures of the map.
function bandTable(parent) {
  const { temperature, lower, transition, upper, upper_interval: ends } = data.map;
  const box = add(parent, "div");
  if (parent.className === "columns") add(box, "h3", "V* by temperature");
  const count = transition.length;
  const [low, high] = data.map.measured_temperature ?? [-Infinity, Infinity];
  const inside = transition.map((_, i) => i).filter((i) => !temperature || (temperature[i] >= low - 1 && temperature[i] <= high + 1));
  const from = inside.length ? inside : transition.map((_, i) => i);
  const shown = count === 1 ? [0] : [...new Set([0, 1, 2, 3, 4].map((k) => from[Math.round((k * (from.length - 1)) / 4)]))];
  table(box, [...(temperature ? ["Temperature, °C"] : []), "Sticks below, mm/s", "Smooth above (V*), mm/s", "95 %"], shown.map((i) => [
    ...(temperature ? [digits(celsius(temperature[i]))] : []), perSecond(transition[i]), perSecond(upper[i] ?? null),
    `[${perSecond(ends[0]?.[i])}, ${perSecond(ends[1]?.[i])}]`]), temperature ? [0, 1, 2, 3] : [0, 1, 2], { name: "band", label: "V* by temperature" });
}
