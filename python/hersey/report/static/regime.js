// The lubrication regime: what the log shows, what the contact predicts, and the models compared.

function regimeFinding() {
  const { named, why_unnamed: why } = data.regime;
  const c = twoPlaces(data.fit.coefficients.c.value);
  const nip = data.film?.points[0]?.regime ?? data.film?.dwells[0]?.regime ?? null;
  const fits = data.film?.exponents?.predictions.find((each) => each.film === nip)?.consistent;
  const law = `damping ~ speed^${c}`;
  if (nip && named && fits === false) return `The log shows ${named} (${law}), but the contact data predict ${nip}. Use the exponent to predict torque, not film thickness.`;
  if (nip && named) return `The log shows ${named} (${law}). The contact data predict the same: ${nip}.`;
  if (nip) return `The contact data predict ${nip}. The log alone determines no regime (${law}).`;
  if (named) return `The log shows ${named} (${law}). Add contact data to confirm it.`;
  return `The exponent ${c} determines no regime: ${why}.`;
}
async function regimeSection(parent) {
  if (data.friction) return;
  const finding = regimeFinding();
  const part = section(parent, "regime", "Lubrication regime", finding);
  const columns = add(part, "div", "", "columns");
  await chart(columns, "regime", { heading: "Measured exponent", says: finding });
  const nip = data.film?.points[0]?.regime ?? data.film?.dwells[0]?.regime;
  await chart(columns, "film", { heading: nip ? `Predicted film: ${nip}` : "Predicted film", note: filmNote(), says: finding });
  if (data.film) ofTheContact(part);
  else explanations(columns);
  const more = add(part, "div", "", "columns");
  await chart(more, "transition");
  await chart(more, "torque_budget");
  const all = fold(part, "All regimes tested");
  const verdict = add(all, "div");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", pretty(text), "text"));
  hypotheses(all);
  if (data.film) explanations(all);
  if (data.torque_budget) {
    const said = add(all, "div");
    said.id = "torque_budget";
    add(said, "h3", "Torque budget in numbers");
    for (const text of data.torque_budget.text) add(said, "p", pretty(text), "text");
  }
}
const filmNote = () => data.film?.dwells.length && data.film.points.length ? "Diamonds: operating points; dots: dwells." : "";
// What the contact data say: warnings in sight, the rest in a fold.
function ofTheContact(parent) {
  warnings(parent, data.film.warnings, { heading: "Where the film differs from the log", folded: "Film in detail" });
}
function hypotheses(parent) {
  const element = table(parent, ["Regime", "Exponent", "p-value", "Result", "Meaning"], data.regime.hypotheses.map((h) => {
    const [low, high] = [digits(h.low), digits(h.high)];
    const range = h.low === null ? `below ${high}` : low === high ? high : `${low} to ${high}`;
    return [h.name, range, h.p_value < 1e-4 ? "< 0.0001" : h.p_value.toFixed(4), h.consistent ? "not excluded" : "excluded", pretty(h.meaning)];
  }), [2], { name: "regimes", label: "Regimes tested" });
  data.regime.hypotheses.forEach((h, i) => { if (h.consistent) element.tBodies[0].rows[i].className = "kept"; });
  const tested = data.fit.transition ? "of the rising branch" : "over all speeds";
  add(parent, "p", `Tested: exponent c ${tested}, ${interval(data.fit.coefficients.c)}. The p-values are corrected for the number of regimes and include sensor uncertainty.`, "note");
}
function explanations(parent) {
  const box = add(parent, "div");
  add(box, "h3", "Explanations that the dwells do not exclude");
  const list = add(box, "ul");
  list.id = "explanations";
  data.regime.explanations.forEach((e) => add(list, "li", pretty(e.name)));
}

// Models fitted to the rising branch, the best first.
function tried(parent) {
  const all = data.regime.tried ?? [];
  if (!all.length) return;
  const count = plural(all.length, "model");
  const held = all.filter((each) => each.verdict === "not excluded");
  const next = held[1] ? `; the next is ${digits(held[1].aicc - held[0].aicc, 2)} higher in AICc` : "";
  const part = section(parent, "candidates", "Model comparison", held.length
    ? `${capital(plural(held.length, "model").split(" ")[0])} of ${count} ${held.length === 1 ? "fits: " : "fit. The best is "}${held[0].name}${next}.`
    : `None of ${count} fits; the closest is ${all[0].name}.`);
  const least = Math.min(...all.map((each) => each.aicc));
  table(fold(part, `All ${count}`), ["Model", "ΔAICc", "Constant share, %", "p of curvature", "Result"], all.map((each) => [
    each.name, digits(each.aicc - least), each.constant_share === null ? "–" : digits(100 * each.constant_share), each.curvature === null ? "–" : digits(each.curvature, 2), pretty(each.verdict)]),
  [1, 2, 3], { name: "candidates", label: "Model comparison" });
}
function candidates(parent) {
  const { models } = data;
  if (data.friction) frictionLaws(parent);
  if (!models) {
    if (!data.friction) tried(parent);
    return;
  }
  const order = [...models.candidates].sort((a, b) => (a.delta_aicc ?? 1e9) - (b.delta_aicc ?? 1e9));
  const best = models.candidates.find((each) => each.key === models.chosen);
  const next = order.find((each) => each.key !== models.chosen && each.delta_aicc !== null);
  const part = section(parent, "candidates", "Model comparison",
    `The best of ${plural(order.length, "model")} is ${best?.name ?? models.chosen}${best?.cross_validation ? ` (error on excluded dwells ${digits(100 * best.cross_validation)} %)` : ""}`
    + `${next ? `; the next is ${digits(next.delta_aicc - (best?.delta_aicc ?? 0), 2)} higher in AICc` : ""}.`);
  checks(part, models.warnings.map((each) => [each.severity, warned(each)]));
  const all = fold(part, `All ${order.length} models`);
  const percent = (value) => value === null ? "–" : digits(100 * value);
  const element = table(all, ["Model", "Parameters", "ΔAICc", "ΔBIC", "Error on excluded dwells, %", "Scatter, %"], order.map((each) => [
    each.name, String(Object.keys(each.parameters).length), digits(each.delta_aicc), digits(each.delta_bic), percent(each.cross_validation), percent(each.scatter)]),
  [1, 2, 3, 4, 5], { name: "candidates", label: "Model comparison" });
  order.forEach((each, i) => { if (each.key === models.chosen) element.tBodies[0].rows[i].className = "kept"; });
  const why = fold(part, "Reasons and parameters");
  models.reasons.forEach((text) => add(why, "p", pretty(text), "text"));
  table(why, ["Parameter", "Value", "Unit", "95 % interval"], models.parameters.map((p) => {
    const [low, high] = Object.values(p.intervals)[0] ?? [null, null];
    return [p.name, digits(p.value, 4), p.unit, `[${digits(low, 4)}, ${digits(high, 4)}]`];
  }), [1, 3], { name: "parameters", label: "Parameters of the chosen model" });
  for (const text of [models.activation_energy.verdict, models.hersey_collapse?.verdict, models.errors_in_variables.verdict]) if (text) add(why, "p", pretty(text), "text");
  for (const each of models.refused) add(why, "p", pretty(`Not fitted: ${each.name}: ${each.reason}`), "note");
}
