// The data of the motion that is drawn: a table that sorts and can be saved, rebuilt while it is open.

function numbers(place) {
  const ROWS = 300;
  const box = fold(place, "Data of this motion");
  box.className = "numbers behind";
  let last = null, soon = 0;
  function speedAt(profile, time) {
    const next = profile.findIndex((row) => row[0] > time);
    if (next <= 0) return profile.at(next)[1];
    const [[from, low], [to, high]] = [profile[next - 1], profile[next]];
    return low + (high - low) * (time - from) / (to - from);
  }
  function fill() {
    while (box.childNodes.length > 1) box.lastChild.remove();
    if (!last) return;
    const { motion, setting } = last, every = Math.max(1, Math.round(motion.time.length / ROWS));
    const drive = setting.profile ?? [[0, setting.speed]];
    const rows = [];
    for (let i = 0; i < motion.time.length; i += every) {
      rows.push([digits(motion.time[i], 5), digits(1e3 * speedAt(drive, motion.time[i]), 4), digits(1e3 * motion.belt_speed[i], 4),
        digits(motion.spring_force[i], 4), motion.stuck[i] ? "yes" : "no"]);
    }
    table(box, ["Time, s", "Drive, mm/s", "Sliding, mm/s", "Spring, N", "Stuck"], rows, [0, 1, 2, 3], { name: "motion", label: "Motion from rest" });
  }
  box.addEventListener("toggle", () => { if (box.open) fill(); });
  return {
    // The motion is taken at once, so that what is opened is of now; a table that is open follows when it rests.
    show(motion, setting) {
      last = { motion, setting };
      clearTimeout(soon);
      if (box.open) soon = setTimeout(fill, 300);
    },
  };
}
