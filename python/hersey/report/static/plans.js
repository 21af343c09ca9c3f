// A plan per operating point.

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
    line.append(signal(point.signal), point.reason ? pretty(point.reason) : `${point.signal === "act" ? "" : "Needs no plan: "}${pretty(point.words)}.`);
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
  marks.push(...plan.obstacles.map((each) => ["act", pretty(each.text)]), ...plan.warnings.map((each) => [each.severity, warned(each)]));
  checks(side, marks);
  const all = fold(columns, "How sure, in full");
  all.classList.add("across");
  add(all, "p", pretty(plan.verdict), "text");
  add(all, "p", `${digits(100 * plan.share, 3)} % of ${plural(plan.draws, "draw")} slide; the true share exceeds ${digits(Math.floor(1000 * plan.share_low) / 10, 3)} % with 95 % confidence. `
    + `${failuresOf(plan) ? `Others: ${failuresOf(plan)}. ` : ""}Seed ${plan.seed}, ${plural(plan.tried, "profile")} tried.`, "text");
}
// A value and its unit.
function amount(name, value) {
  const [factor, unit] = /torque/.test(name) ? torqueUnit() : /force|grip/.test(name) ? [1, "N"] : /acceleration/.test(name) ? [1e3, "mm/s²"] : /speed/.test(name) ? [1e3, "mm/s"] : [1, ""];
  return [digits(value * factor), unit];
}
