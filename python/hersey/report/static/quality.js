// Data quality: the log on one time axis, and what of it is used.

function dataSection(parent) {
  const q = data.quality;
  const sticks = q.rejected.filter((r) => r.kind === "stick-slip").length;
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
    for (const each of data.warnings) add(list, "li", warned(each));
  }
  if (q.rejected.length) {
    const all = fold(part, `Every stretch that is not used, and why (${q.rejected.length})`);
    const reasons = new Map();
    for (const r of q.rejected) {
      const known = reasons.get(r.label) ?? [0, 0];
      reasons.set(r.label, [known[0] + 1, known[1] + r.rows]);
    }
    table(all, ["Reason", "Stretches", "Rows"], [...reasons].map(([label, [stretches, rows]]) => [label, String(stretches), counted(rows)]), [1, 2], { label: "Reasons" });
    table(all, ["File", "From, s", "To, s", "Rows", "Reason"], q.rejected.map((r) => [
      data.files[r.run].name, r.start.toFixed(2), r.end.toFixed(2), String(r.rows), pretty(r.reason)]), [1, 2, 3], { name: "not-used", label: "Stretches not used" });
  }
  const input = fold(part, `${capital(plural(data.files.length, "file"))}: channels, units and comments`);
  table(input, ["File", "Rows", "Duration", "Every, ms", "Gaps", "Channels"], data.files.map((f) => [
    f.name, counted(f.rows), f.duration ? seconds(f.duration) : "–", f.sampling_interval ? digits(f.sampling_interval * 1e3) : "–", String(f.gaps),
    f.channels.map((c) => `${c.role}: ${c.name || "(no name)"} [${c.unit}]`).join(", ")]), [1, 2, 3, 4], { label: "Files" });
  for (const f of data.files) f.comments.forEach((text) => add(input, "p", `${f.name}: “${text}”`, "note"));
}
