// Data quality: the log on one time axis, and which part of it is used.

function dataSection(parent) {
  const q = data.quality;
  const part = section(parent, "data", "Data quality", dataFinding());
  if (data.timeline.starts.length && data.timeline.speed.time.length > 1) timeline(part, dataFinding());
  const flagged = data.decision?.flags ?? [];
  const shown = (each) => (each.kind === "synthetic" && data.synthetic) || flagged.some((flag) => flag.kind === each.kind);
  if (data.warnings.length) warnings(part, data.warnings, { heading: "Warnings", folded: "Notes on the data", elsewhere: shown, id: "warnings" });
  if (moving && !data.friction) add(part, "p", pretty(moving.cost), "text");
  if (q.rejected.length && !moving) {
    const all = fold(part, `Excluded stretches (${q.rejected.length})`);
    add(all, "p", `${share(q.rows_settling, q.rows)} of the rows are at the edges of dwells, where ${measured} settles; ${share(q.rows_rejected, q.rows)} are excluded.`
      + (q.standing_torque === null ? "" : ` ${capital(measured)} at standstill: ${friction ? digits(q.standing_torque) : `${digits(q.standing_torque * 1e3)} mN·m`}, ${q.tare ? "subtracted from all dwells" : "not subtracted"}.`), "note");
    const reasons = new Map();
    for (const r of q.rejected) {
      const known = reasons.get(r.label) ?? [0, 0];
      reasons.set(r.label, [known[0] + 1, known[1] + r.rows]);
    }
    table(all, ["Reason", "Stretches", "Rows"], [...reasons].map(([label, [stretches, rows]]) => [label, String(stretches), counted(rows)]), [1, 2], { label: "Reasons" });
    const each = fold(all, "Every stretch");
    each.className = "behind";
    table(each, ["File", "From, s", "To, s", "Rows", "Reason"], q.rejected.map((r) => [
      data.files[r.run].name, r.start.toFixed(2), r.end.toFixed(2), String(r.rows), pretty(r.reason)]), [1, 2, 3], { name: "not-used", label: "Excluded stretches" });
  }
  const input = fold(part, data.files.length === 1 ? "Channels and units" : `Channels and units (${data.files.length} files)`);
  table(input, ["File", "Rows", "Duration", "Every, ms", "Gaps", "Channels"], data.files.map((f) => [
    f.name, counted(f.rows), f.duration ? seconds(f.duration) : "–", f.sampling_interval ? digits(f.sampling_interval * 1e3) : "–", String(f.gaps),
    f.channels.map((c) => `${c.role}: ${c.name || "(no name)"} [${c.unit}]`).join(", ")]), [1, 2, 3, 4], { label: "Files" });
  for (const f of data.files) f.comments.forEach((text) => add(input, "p", `${f.name}: “${text}”`, "note"));
}
// How much of the log is used.
function dataFinding() {
  const q = data.quality;
  if (moving) return `The speed changes all the time: friction is fitted to every sample, and ${share(moving.used, 1)} of the log is used.`;
  const sticks = q.rejected.filter((r) => r.kind === "stick-slip").length, others = q.rejected.length - sticks;
  const excluded = [sticks ? plural(sticks, "stick-slip stretch", "stick-slip stretches") : "", others ? plural(others, sticks ? "other" : "stretch", sticks ? "others" : "stretches") : ""].filter(Boolean).join(" and ");
  const used = `${capital(plural(data.points.length, "dwell"))} ${data.points.length === 1 ? "uses" : "use"} ${share(q.rows_used, q.rows)} of the log.`;
  return excluded ? `${used} ${capital(excluded)} ${sticks + others === 1 ? "is" : "are"} excluded.` : used;
}
