// Regime and film, as one story, and the laws that were tried.

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
  if (data.film) ofTheNip(part);
  else explanations(columns);
  const more = add(part, "div", "", "columns");
  await chart(more, "transition");
  await chart(more, "torque_budget");
  if (data.torque_budget) {
    const said = add(more, "div", "", "across");
    said.id = "torque_budget";
    for (const text of data.torque_budget.text) add(said, "p", pretty(text), "note");
  }
  const all = fold(part, "The reasoning in full, and all regimes tested");
  const verdict = add(all, "div");
  verdict.id = "verdict";
  data.verdict.forEach((text) => add(verdict, "p", pretty(text), "text"));
  hypotheses(all);
  if (data.film) explanations(all);
}
function ofTheNip(parent) {
  const [given, others] = [true, false].map((off) => data.film.warnings.filter((each) => (each.severity !== "note") === off));
  if (given.length) {
    add(parent, "h3", "3. What does not fit, largest first");
    checks(parent, given.map((each) => [each.severity, warned(each)]));
  }
  add(parent, "h3", given.length ? "What else the film says" : "3. What the film of this nip says");
  const notes = add(parent, "ul", "", "checks plain");
  notes.id = "notes";
  for (const each of others) add(notes, "li", warned(each));
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

// Laws that were fitted to the rising branch, the likeliest first.
function tried(parent) {
  const all = data.regime.tried ?? [];
  if (!all.length) return;
  const count = plural(all.length, "law");
  const held = all.filter((each) => each.verdict === "not excluded");
  const next = held[1] ? `; the next is worse by ${digits(held[1].aicc - held[0].aicc, 2)} in AICc` : "";
  const part = section(parent, "candidates", "Model comparison", held.length
    ? `Of ${count} tried ${held.length === 1 ? "one is not excluded" : `${plural(held.length, "law").split(" ")[0]} are not excluded, the likeliest`}: ${held[0].name}${next}.`
    : `Of ${count} tried none holds; the nearest is ${all[0].name}.`);
  const least = Math.min(...all.map((each) => each.aicc));
  table(fold(part, `The ${count}`), ["Law", "ΔAICc", "Constant share, %", "p of its bend", "Result"], all.map((each) => [
    each.name, digits(each.aicc - least), each.constant_share === null ? "–" : digits(100 * each.constant_share), each.curvature === null ? "–" : digits(each.curvature, 2), pretty(each.verdict)]),
  [1, 2, 3], { name: "candidates", label: "Model comparison" });
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
  const part = section(parent, "candidates", "Model comparison",
    `Of ${plural(order.length, "law")} ${best?.name ?? models.chosen} is chosen${best?.cross_validation ? `: it misses dwells left out by ${digits(100 * best.cross_validation)} %` : ""}`
    + `${next ? `; the next is worse by ${digits(next.delta_aicc - (best?.delta_aicc ?? 0), 2)} in AICc` : ""}.`);
  checks(part, models.warnings.map((each) => [each.severity, warned(each)]));
  const all = fold(part, `The ${order.length} laws`);
  const percent = (value) => value === null ? "–" : digits(100 * value);
  const element = table(all, ["Law", "Numbers", "ΔAICc", "ΔBIC", "Left out, %", "Scatter, %"], order.map((each) => [
    each.name, String(Object.keys(each.parameters).length), digits(each.delta_aicc), digits(each.delta_bic), percent(each.cross_validation), percent(each.scatter)]),
  [1, 2, 3, 4, 5], { name: "candidates", label: "Model comparison" });
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
