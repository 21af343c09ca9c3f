// The start-up profile of each operating point.

const failuresOf = (plan) => Object.entries(plan.failures).filter(([, count]) => count).map(([name, count]) => `${name.replaceAll("_", " ")} ${count}`).join(", ");
function planFinding(point) {
  const { plan } = point;
  const name = capital(point.name);
  const sure = plan.share ? ` The ${noun} slides with ${plan.share > 0.99 ? "over 99" : digits(100 * plan.share, 2)} % probability.` : "";
  const way = (verb, speed, time) => time > 0 ? `${verb} to ${perSecond(speed)} mm/s${verb === "ramp" && plan.kind === "direct" ? ` in ${digits(time, 2)} s` : ""}` : `step to ${perSecond(speed)} mm/s at once`;
  const jumps = !(plan.rise > 0) || (plan.kind === "overshoot" && !(plan.fall > 0));
  const limit = jumps ? " For a ramp instead of a step, state the acceleration of the drive in [limits], e.g. acceleration = \"500 mm/s^2\"." : "";
  if (plan.kind === "overshoot") return `${name}: ${way("ramp", plan.peak_speed, plan.rise)}, hold ${digits(plan.hold, 2)} s, ${way("slow", plan.target_speed, plan.fall)}.${sure}${limit}`;
  if (plan.kind === "direct") return `${name}: ${way("ramp", plan.target_speed, plan.rise)}.${sure}${limit}`;
  return `${name}: no profile within the limits reaches smooth running at ${perSecond(plan.target_speed)} mm/s.`;
}
async function planSection(parent) {
  const all = data.decision?.points ?? [];
  const planned = all.filter((p) => p.plan);
  const whole = data.plan ? [{ name: "profile", speed: data.plan.target_speed, temperature: data.plan.temperature, plan: data.plan }] : [];
  const shown = planned.length ? planned : whole;
  if (!shown.length && !all.length) return;
  const part = section(parent, "plan", "Start-up profiles", shown.length ? planFinding(shown[0]) : unplanned(all));
  let i = 0;
  for (const point of shown) {
    await onePlan(part, point, i);
    i += 1;
  }
  for (const point of all.filter((p) => !p.plan)) {
    const line = add(part, "p", "", "text"), name = add(line, "b", capital(point.name));
    name.prepend(signal(point.signal));
    line.append(`: ${pretty(point.reason || (point.signal === "good" ? "no profile needed" : point.words))}`);
  }
}
const unplanned = (all) => all.every((point) => point.signal === "good") ? "No operating point needs a start-up profile." : "No start-up profile was found.";
const pointName = (p) => `${capital(p.name)}, ${perSecond(p.speed)} mm/s${p.temperature === null ? "" : ` at ${degrees(p.temperature)}`}`;
async function onePlan(parent, point, i) {
  const { plan } = point;
  add(parent, "h3", pointName(point));
  if (i) add(parent, "p", pretty(planFinding(point)), "text");
  const columns = add(parent, "div", "", "columns");
  await chart(columns, `plan_${i}`, { heading: "", says: planFinding(point), behind: false });
  const side = add(columns, "div");
  if (plan.rows.length) {
    const heads = ["Time, s", "Drive, mm/s", ...(radius === null ? [] : ["Drive, rpm"])];
    table(side, heads, plan.rows.map((row) => [row.time.toFixed(3), digits(row.drive_speed * 1e3), ...(radius === null ? [] : [digits((row.drive_speed / radius) * TO_RPM)])]),
      heads.map((_, k) => k), { name: `profile-${i + 1}`, label: `Profile of ${point.name}` });
    const foot = side.querySelector(".foot");
    const press = button(foot, "Try this profile", () => { controller?.profile(plan.rows); document.getElementById("map").scrollIntoView(); });
    press.disabled = true;
    press.dataset.profile = "";
  }
  const marks = plan.uses.map((use) => [use.used !== null && use.used > use.limit ? "watch" : "good", `${capital(use.name.replaceAll("_", " "))}: ${use.used === null ? "unknown" : amount(use.name, use.used)[0]} of ${amount(use.name, use.limit).join(" ")}`]);
  marks.push(...plan.obstacles.map((each) => ["act", pretty(each.text)]), ...plan.warnings.map((each) => [each.severity, warned(each)]));
  checks(side, marks);
  const all = fold(columns, "Probability in detail");
  all.classList.add("across");
  add(all, "p", pretty(plan.verdict), "text");
  add(all, "p", `The ${noun} slides in ${digits(100 * plan.share, 3)} % of ${plural(plan.draws, "draw")}; the true share is above ${digits(Math.floor(1000 * plan.share_low) / 10, 3)} % with 95 % confidence. `
    + `${failuresOf(plan) ? `Failures: ${failuresOf(plan)}. ` : ""}Random seed ${plan.seed}; ${plural(plan.tried, "profile")} tried.`, "text");
}
// A value and its unit.
function amount(name, value) {
  const [factor, unit] = /torque/.test(name) ? torqueUnit() : /force|grip/.test(name) ? [1, "N"] : /acceleration/.test(name) ? [1e3, "mm/s²"] : /speed/.test(name) ? [1e3, "mm/s"] : [1, ""];
  return [digits(value * factor), unit];
}
