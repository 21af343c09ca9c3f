// The verdict on a setting: its zone, a signal, a few words and the line below them.

function verdicts({ map, points, limit, motor, questions }) {
  // The verdict of the report on a setting of its own machine: that of an operating point, or that of the intervals of
  // the map, which include all draws of the drive.
  const WORDS = {
    smooth: ["good", "smooth from any start"], bistable: ["watch", "depends on start"],
    stick_slip: ["act", "sticks from any start"], unstarted: ["watch", "may not start from rest"],
    open: ["watch", "uncertain: within the 95 % interval of V* or of the transition"],
  };
  const between = (row, temperature) => {
    if (!map.temperature) return row[0];
    const right = Math.min(Math.max(map.temperature.findIndex((t) => t >= temperature), 1), map.temperature.length - 1);
    const [a, b] = [map.temperature[right - 1], map.temperature[right]], share = Math.min(Math.max((temperature - a) / (b - a), 0), 1);
    return row[right - 1] * (row[right] / row[right - 1]) ** share;
  };
  function reported({ speed, temperature }) {
    const own = points.find((p) => Math.abs(p.speed / speed - 1) < 1e-6 && (!map.temperature || Math.abs(p.temperature - temperature) < 1e-6));
    if (own) return { signal: own.signal, words: own.brief || own.words, own: true };
    if (map.speed_limit !== null && speed > map.speed_limit * (1 + 1e-9)) {
      return { signal: "act", words: `above the drive limit, ${digits(1e3 * map.speed_limit)} mm/s` };
    }
    const held = (map.holding_interval ?? []).map((row) => between(row, temperature));
    if (map.torque_limit !== null && held[0] > map.torque_limit) return { signal: "act", words: "does not start from rest" };
    const [turn, fold] = [map.transition_interval, map.upper_interval].map((ends) => ends.map((row) => between(row, temperature)));
    const kind = speed >= Math.max(fold[1], turn[1]) ? "smooth" : speed < turn[0] ? "stick_slip" : speed >= turn[1] && speed < fold[0] ? "bistable" : "open";
    const [signal, words] = WORDS[map.torque_limit !== null && held[1] > map.torque_limit && kind !== "stick_slip" ? "unstarted" : kind];
    return { signal, words };
  }
  const speedText = (v) => `${digits(1e3 * v)} mm/s`;
  // Whether a motion ends in sliding; an oscillation below a thousandth of its speed counts as sliding.
  const slides = (motion, { speed }) => motion?.kind === "steady_sliding"
    || (motion?.kind === "oscillation" && motion.speed_max - motion.speed_min < 1e-3 * speed);
  function zoneNow({ setting, answer, found }) {
    if (found && !found.stale && answer.law) return questions.zone({ speed: setting.speed, limit, motor }, answer.law, answer.force, found);
    const starts = answer.law.holding_force <= limit, beyond = motor ? "motor" : "stall";
    const rest = slides(answer.cycle, setting), above = slides(answer.above, setting);
    const sliding = rest && above ? "smooth" : above ? "bistable" : answer.above.kind === "oscillation" ? "swing" : "stick_slip";
    const moving = answer.force > limit ? beyond : sliding;
    return { state: starts ? moving : beyond, moving, starts };
  }

  // Signal, word and the line below it.
  function told(now) {
    const { setting, answer, kicked } = now;
    const { cycle, motion, force, law } = answer, radius = map.roll_radius, zone = zoneNow(now);
    const torque = `torque ${torqueText(force * radius)}`;
    const laps = cycle.frequency > 0 ? `${digits(cycle.frequency)} Hz, at rest ${digits(100 * cycle.stuck_fraction, 2)} % of the time` : "";
    if (setting.profile) return { zone, ...follows(now) };
    if (!zone.starts) {
      const holds = `starting needs ${torqueText(law.holding_force * radius)}, the ${motor ? "motor" : "grip"} gives ${torqueText(limit * radius)}`;
      const on = ["bistable", "smooth"].includes(zone.moving) ? "; slides once it is moving" : "";
      return { zone, signal: "act", words: `does not start from rest${on}`, sub: [torque, holds] };
    }
    switch (zone.state) {
      case "stall":
        return { zone, signal: "act", words: "stalls: the drive slips", sub: [torque, `the grip is ${torqueText(limit * radius)}`] };
      case "motor":
        return { zone, signal: "act", words: "stalls: above the motor limit", sub: [torque, `the motor gives ${torqueText(limit * radius)}`] };
      case "smooth": return { zone, signal: "good", words: "smooth from any start", sub: [torque, settles(motion, setting)] };
      case "bistable": {
        const kick = kicked ? (kicked.value === null ? "sliding withstands any sudden loss of speed" : `sliding withstands a sudden loss of ${digits(1e3 * kicked.value, 2)} mm/s`) : "";
        return { zone, signal: "watch", words: "depends on start: sticks from rest, slides when slowed down", sub: [torque, laps, kick] };
      }
      case "swing": return { zone, signal: "watch", words: "depends on start: oscillates when slowed down, sticks once it has stuck", sub: [torque, laps] };
      default:
        if (setting.speed <= law.stick_speed) return { zone, signal: "act", words: "sticks: slower than the stick speed", sub: [torque] };
        return { zone, signal: "act", words: "sticks from any start", sub: [laps, cycle.speed_max > 0 ? `peak ${speedText(cycle.speed_max)}` : torque] };
    }
  }
  const [perNewtonMetre, torqueName] = torqueUnit();
  const torqueText = (value) => `${digits(perNewtonMetre * value)} ${torqueName}`;
  // The time from the first slip until the belt stays within 2 % of the drive.
  function settles({ time, belt_speed: v }, setting) {
    let off = v.length - 1, slip = 0;
    while (off >= 0 && Math.abs(v[off] / setting.speed - 1) <= 0.02) off -= 1;
    while (slip < v.length && v[slip] < setting.speed) slip += 1;
    if (slip >= v.length) return "";
    if (off > 0.97 * v.length) return `settles after more than ${digits(time.at(-1))} s`;
    return `settles ${digits(Math.max(time[off + 1] - time[slip], 0), 2)} s after the first slip`;
  }
  function follows({ setting, answer }) {
    const { motion, law } = answer, { time, belt_speed: v } = motion, last = setting.profile.at(-1)[0];
    let stuck = v.length - 1, first = 0;
    while (stuck >= 0 && v[stuck] > law.stick_speed * (1 + 1e-6)) stuck -= 1;
    while (first < v.length && !(v[first] > law.stick_speed * (1 + 1e-6))) first += 1;
    const peak = v.reduce((a, b) => Math.max(a, b), 0), pull = motion.spring_force.reduce((a, b) => Math.max(a, b), 0);
    const sub = [`peak ${speedText(peak)}`, `spring force up to ${digits(pull)} N`];
    if (first >= v.length) return { signal: "act", words: "does not start with this profile", sub };
    const watched = 3 * 2 * Math.PI * Math.sqrt(answer.train.mass / answer.train.stiffness);
    if (time.at(-1) - time[Math.max(stuck, 0)] > watched && time.at(-1) > last) {
      return { signal: "good", words: `slides from ${digits(time[Math.min(stuck + 1, v.length - 1)], 3)} s on with this profile`, sub };
    }
    return { signal: "act", words: "still sticks at the end of this profile", sub };
  }
  return { slides, told, reported, speedText };
}
