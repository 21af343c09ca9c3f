// Of a joint or gear motor: its friction curve, the parameters of that, and the laws compared.

const moving = data.moving ?? null;
const held = moving ? "window" : "dwell";
const PARAMETERS = {
  T_C: "Coulomb friction", T_S: "friction towards standstill", w_S: "Stribeck speed", k_v: "viscous friction", s: "fall of ln k_v per kelvin",
  J: "moment of inertia", offset: "torque zero, or T_C that differs by direction", delay: "of torque behind speed",
};
const LAWS = { coulomb_viscous: "Coulomb plus viscous friction", stribeck: "Stribeck friction" };
// A value and the ends of its interval with the same decimals: the interval has two figures, the value three or more.
function together({ value, low, high }, factor = 1) {
  if (low === null || high === null) return [digits(value * factor), "unknown"];
  const all = [value, low, high].map((each) => each * factor), largest = Math.max(...all.map(Math.abs)), width = all[2] - all[1];
  if (!(largest > 1e-5 && largest < 1e6 && width > 0)) return [digits(all[0]), `[${digits(all[1])}, ${digits(all[2])}]`];
  let places = Math.max(0, Math.min(2 - Math.floor(Math.log10(largest)), 1 - Math.floor(Math.log10(width))));
  const shown = () => all.map((each) => each.toFixed(places).replace("-", "−"));
  while (places < 8 && new Set(shown()).size < 3) places += 1;
  const [middle, from, to] = shown();
  return [middle, `[${from}, ${to}]`];
}
async function frictionSection(parent) {
  const { friction: curve } = data;
  const part = section(parent, "torque", "Friction curve", curve.finding);
  if (data.map) add(part, "p", pretty(lawOfStability()), "text");
  const columns = add(part, "div", "", "columns");
  if (data.map) await chart(columns, "torque", { heading: torqueHeading(), note: torqueNote(), says: curve.finding });
  const box = data.map ? part : add(columns, "div");
  await chart(columns, "residuals");
  frictionParameters(box, curve);
  if (moving) add(box, "p", pretty(moving.cost), "text");
  const all = fold(part, `Statistics and all ${data.points.length} ${moving ? "windows of speed" : "dwells"}`, (inside) => {
    add(inside, "pre", curve.summary).id = "summary";
    dwells(inside);
  });
  all.id = "statistics";
  if (!moving) explained(all.firstChild, "dwell");
}
function lawOfStability() {
  return `V*, the map and start-up profiles use drag curves by weight (${curveNames()}) instead of this friction curve, because these also allow for what torque does below the slowest ${held}.`;
}
// Friction first, then what else takes torque while the speed changes.
function frictionParameters(parent, { parameters, apart, formula }) {
  const [factor, unit] = torqueUnit();
  const others = moving ? moving.parameters.filter(({ name }) => ["J", "offset", "delay"].includes(name)) : [];
  const rows = [...parameters, ...others].map((p) => {
    const [scale, shown] = unitOf(p, factor, unit), [value, interval] = together(p.estimate, scale);
    const way = apart ? [parameters.includes(p) ? p.direction : ""] : [];
    return [p.name, ...way, p.bounded === false ? "not determined" : value, interval, shown, PARAMETERS[p.name]];
  });
  if (moving?.inertia_given != null) rows.push(["J", ...(apart ? [""] : []), digits(moving.inertia_given), "given", "kg·m²", PARAMETERS.J]);
  add(parent, "p", pretty(`${moving ? `torque = J dw/dt${others.some((p) => p.name === "offset") ? " + offset" : ""} + friction, ` : ""}${formula}, w in rad/s.`), "note");
  table(parent, ["Parameter", ...(apart ? ["Direction"] : []), "Value", "95 % interval", "Unit", "Meaning"], rows, apart ? [2, 3] : [1, 2], { name: "friction", label: "Parameters of the friction curve" });
}
function unitOf({ unit, estimate }, factor, torque) {
  if (unit.startsWith("N m")) return [factor, unit.replace("N m", torque).replace(" s/rad", "·s/rad")];
  const small = Math.max(...[estimate.value, estimate.low, estimate.high].map(Math.abs)) < 0.1;
  if (unit === "kg m^2") return small ? [1e3, "g·m²"] : [1, "kg·m²"];
  return unit === "s" && small ? [1e3, "ms"] : [1, unit];
}
// The laws of friction, and a power of speed, which a film would be.
function frictionLaws(parent) {
  const { friction: curve, fit } = data, apart = fit.aicc - curve.aicc, best = curve.tried[0].aicc;
  const of = (kind, each) => `${LAWS[kind]} (${each ? "each direction separately" : "one law for both directions"})`;
  const both = curve.forward_speeds !== null && curve.reverse_speeds !== null;
  const named = (kind, each) => both ? of(kind, each) : LAWS[kind];
  const power = fit.transition ? "two powers of speed that meet at the lowest torque" : "a single power of speed";
  const worse = `${power}, as of a lubricant film, ${fit.transition ? "are" : "is"} ${apart >= 0.05 ? `worse by ${digits(apart, 2)} in AICc` : "as good"}`;
  const part = section(parent, "candidates", "Model comparison", `${named(curve.kind, curve.apart)} describes the ${moving ? "windows of speed" : "dwells"}; ${worse}. No lubrication regime is determined.`);
  const rows = [...curve.tried.map((each) => [named(each.kind, each.apart), each]), [power, fit]];
  table(fold(part, `All ${rows.length} models`), ["Model", "ΔAICc", "Scatter, %"], rows.sort((a, b) => a[1].aicc - b[1].aicc).map(([name, each]) => [
    name, digits(each.aicc - Math.min(best, fit.aicc)), digits(100 * each.scatter, 2)]), [1, 2], { name: "candidates", label: "Model comparison" });
  if (moving) add(part, "p", "Compared on the windows of speed; the law itself was chosen and fitted on every sample.", "note");
}
