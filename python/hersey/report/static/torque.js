// Torque and damping: the charts, what they say, exponents and dwells.

function torqueNote() {
  if (moving && !data.friction) return "Dots: windows of speed of a log that moves all the time; bars: two standard errors.";
  if (moving) return "Line: the friction curve fitted to every sample, shaded: 95 % limits; pale: single moments, without inertia and offset; dots: windows of speed.";
  if (data.friction) return "Line: the fitted friction curve, shaded: 95 % limits; bars: two standard errors.";
  const level = radius === null ? "" : ` 10 rpm = ${perSecond((10 / TO_RPM) * radius)} mm/s.`;
  return `Filled: from a lower speed; open: from a higher; bars: two standard errors.${level}`;
}
const torqueHeading = () => data.friction ? "Friction torque" : friction ? capital(measured) : `Drag torque${data.fit.rest ? ", no-load torque subtracted" : ""}`;
const dampingUnit = () => friction ? `${data.fit.domain.unit} s/${SPEED_UNIT === "m/s" ? "m" : "rad"}`.trim() : `${torqueUnit()[1]}·s/rad`;
// The models of the drag curves that carry most of the weight.
function curveNames() {
  const names = new Map();
  for (const { words, weight } of data.fit.laws ?? []) names.set(words, (names.get(words) ?? 0) + weight);
  const most = [...names].filter(([, weight]) => weight >= 0.05).sort((a, b) => b[1] - a[1]);
  return most.length ? most.map(([words, weight]) => `${words}${most.length > 1 ? ` (${digits(100 * weight, 2)} %)` : ""}`).join(", ") : "the fitted law of damping";
}
// Transition speeds over the measured temperatures, from the map where there is one.
function transitions() {
  const { map, fit } = data;
  if (!map?.temperature || !map.measured_temperature) return fit.transition_curve;
  const [low, high] = map.measured_temperature;
  return map.temperature.map((temperature, i) => ({ temperature, speed: (map.transition[i] ?? 0) / map.roll_radius }))
    .filter((each) => each.speed > 0 && each.temperature >= low - 1 && each.temperature <= high + 1);
}
// How torque varies with speed; whether it rises and falls is decided by the tests on the dwells.
function torqueFinding() {
  const { transition, trend, reference_temperature: level } = data.fit, [slow, fast] = data.fit.speed_range;
  const rises = trend?.rises ?? true, falls = trend?.falls ?? transition !== null, curve = transitions();
  if (rises && falls && trend && !(trend.least > 1.01 * slow && trend.least < 0.99 * fast)) {
    return `${capital(measured)} rises with speed, then falls, from ${rolled(slow)} to ${rolled(fast)}.`;
  }
  if (rises && falls && curve.length >= 2) {
    const [cold, hot] = [curve[0], curve.at(-1)];
    return `${capital(measured)} is lowest at the transition speed: ${rolled(cold.speed)} at ${whole(cold.temperature)}, ${rolled(hot.speed)} at ${whole(hot.temperature)}.`;
  }
  if (rises && falls) {
    const at = transition ? `up to ${rolled(transition.speed.value)}${level === null ? "" : ` at ${degrees(level)}`}` : "at the slow end";
    return `${capital(measured)} falls with speed ${at} and rises above that.`;
  }
  const over = `from ${rolled(slow)} to ${rolled(fast)}`;
  if (rises || falls) return `${capital(measured)} ${rises ? "rises" : "falls"} with speed ${over}.`;
  // the exponent of a law may exclude a constant torque where no test without a law does
  const { low, high } = data.fit.coefficients.c, flat = low === null || high === null || (low <= -1 && high >= -1);
  return `${capital(measured)} ${flat ? "is constant within" : "stays about its mean within"} ${digits(100 * trend.spread, 2)} % ${over}.`;
}
async function torqueSection(parent) {
  if (data.friction) return frictionSection(parent);
  const finding = torqueFinding();
  const part = section(parent, "torque", `${capital(measured)} and damping`, finding);
  const columns = add(part, "div", "", "columns");
  if (data.map) await chart(columns, "torque", { heading: torqueHeading(), note: "", says: finding });
  await chart(columns, "damping", { heading: `Damping = ${measured} / speed`, note: data.map ? "" : `Dashed: constant ${measured} (slope −1).`, says: finding });
  if (!data.map) await chart(columns, "residuals");
  if (data.map) add(part, "p", pretty(`${torqueNote()} Dashed: constant torque.`), "note");
  const all = fold(part, `Models, statistics and ${data.points.length === 1 ? `the ${held}` : `all ${data.points.length} ${held}s`}`, async (inside) => {
    add(inside, "p", `${friction ? "Curves" : "Drag curves"}: ${curveNames()}.`, "text");
    exponents(inside);
    add(inside, "pre", data.fit.summary).id = "summary";
    dwells(inside);
    const pair = add(inside, "div", "", "columns");
    if (data.map) await chart(pair, "residuals");
    await chart(pair, "surface", { behind: false });
  });
  all.id = "statistics";
  explained(all.firstChild, "dwell");
}
function exponents(parent) {
  const { coefficients: c, transition } = data.fit;
  const rows = [["exponent of speed, c", digits(c.c.value), bounds(c.c), transition ? "of damping, above the transition" : "of damping, over all speeds"]];
  if (transition) {
    const at = data.fit.reference_temperature === null ? "" : ` at ${degrees(data.fit.reference_temperature)}`;
    rows.push(["exponent below it", digits(transition.mixed_exponent.value), bounds(transition.mixed_exponent), `${measured} falls with speed where it is below −1`]);
    rows.push([`transition${at}, ${SPEED_UNIT}`, digits(transition.speed.value * PER_SPEED), bounds(transition.speed, PER_SPEED),
      transition.closure === null ? "where the branches meet" : `lowest ${measured} of a gradual bend; the trend lines meet at ${digits(transition.meeting_speed * PER_SPEED)} ${SPEED_UNIT}`]);
    rows.push(["gain in AICc of the second branch", digits(transition.evidence), "", "over a single power law"]);
  }
  if (c.b) rows.push(["exponent of temperature, b", digits(c.b.value), bounds(c.b), `in ${data.fit.temperature_scale === "K" ? "K" : "°C"}`]);
  rows.push([`R² of ${measured}`, digits(data.fit.r_squared_torque, 4), "", `of damping: ${digits(data.fit.r_squared_damping, 4)}`]);
  table(parent, ["Quantity", "Value", "95 % interval", "Meaning"], rows, [1, 2], { label: "Exponents and transition" });
  if (data.fit.no_transition) add(parent, "p", pretty(`No falling branch is reported: ${data.fit.no_transition}.`), "text");
}
function dwells(parent) {
  const hot = data.points.some((p) => p.temperature !== null);
  const [factor, unit] = torqueUnit(), when = moving ? [] : ["Approached", "From, s", "To, s"];
  const heads = [`Speed, ${SPEED_UNIT}`, ...(hot ? ["°C"] : []), inUnit(capital(measured), unit), "± (1 s.e.)", `Damping, ${dampingUnit()}`, "Measured / fitted − 1, %", ...when];
  table(parent, heads, data.points.map((p, i) => [
    digits(p.speed * PER_SPEED, 4), ...(hot ? [celsius(p.temperature).toFixed(1)] : []), digits(p.torque * factor, 4),
    digits(p.torque_error * factor, 2), digits(p.damping * factor, 4), (100 * Math.expm1(data.friction?.residuals[i] ?? p.residual)).toFixed(1).replace("-", "−"),
    ...(moving ? [] : [p.approach, p.start.toFixed(1), p.end.toFixed(1)])]),
  heads.flatMap((head, i) => head === "Approached" ? [] : [i]), { name: `${held}s`, label: moving ? "All windows" : "All dwells" });
}
