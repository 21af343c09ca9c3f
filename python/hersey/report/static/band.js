// Band and safe step.

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
  if (data.map) data.map.warnings.forEach((each) => add(part, "p", warned(each), "note"));
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
  if (!parts.length && data.band) return data.band.verdict;
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
