// The questions of the panel to the core about one setting, in the page or in a worker made of the same text. The
// core computes every number; this file only decides which questions are asked, and in which order. All SI.

function answers(core) {
  // Lengths of a trace, in s. They are few, so that the axis stays the same while a slider moves.
  const LENGTHS = [0.1, 0.2, 0.5, 1, 2, 3, 5, 8, 12, 20, 30, 50, 80, 120, 200, 300, 500, 800, 1200];
  const SAMPLES = 1200, STEADY_SAMPLES = 200, LAP_SAMPLES = 240, DECAY = 8, HALVINGS = 12, WORK = 1_000_000;
  const lawOf = (job) => core.drag(job.drag, job.temperature, { rule: job.rule });
  const forceAt = (law, speed) => core.forces(law, [speed])[0];
  const drawn = ({ time, belt_speed, spring_force, stuck }) => ({ time, belt_speed, spring_force, stuck });

  function lengthOf({ train, speed, profile }, law, cycle) {
    if (profile) return LENGTHS.find((each) => each >= 1.6 * profile.at(-1)[0] + 0.3) ?? 2 * profile.at(-1)[0];
    const period = cycle.frequency > 0 ? 1 / cycle.frequency : 2 * Math.PI * Math.sqrt(train.mass / train.stiffness);
    const wanted = law.holding_force / (train.stiffness * speed) + (cycle.frequency > 0 ? 6 : 10) * period;
    return LENGTHS.find((length) => length >= wanted) ?? LENGTHS.at(-1);
  }

  const swings = ({ belt_speed: v }, speed) => v.subarray(Math.floor(0.85 * v.length)).some((each) => Math.abs(each / speed - 1) > 0.05);

  // The motion of a setting, the quick parts first; each step adds to the answer.
  function* setting(job) {
    const { train, speed, profile } = job, work = job.work ? { most_steps: job.work } : {}, law = lawOf(job), force = forceAt(law, speed);
    const cycle = core.cycle({ train, law, drive_speed: speed, start: "rest", ...work });
    const above = core.cycle({ train, law, drive_speed: speed, start: "steady", ...work });
    yield { law, force, cycle, above };
    let duration = lengthOf(job, law, cycle);
    const schedule = profile ?? [[0, speed]];
    const run = (length) => drawn(core.motion({ train, law, schedule, start: "rest", duration: length, samples: SAMPLES, ...work }));
    let motion = run(duration);
    // One that slides in the end is followed until it does.
    if (!profile && !job.slow && cycle.kind === "steady_sliding" && swings(motion, speed)) {
      duration = LENGTHS.find((each) => each >= 4 * duration) ?? duration;
      motion = run(duration);
    }
    yield { motion, duration };
    if (cycle.frequency > 0 && !profile) {
      const last = SAMPLES - 1, start = [motion.belt_speed[last], motion.spring_force[last] / train.stiffness];
      const length = 1.02 * cycle.laps_per_period / cycle.frequency;
      yield { lap: drawn(core.motion({ train, law, schedule, start, duration: length, samples: LAP_SAMPLES })) };
    }
    if (cycle.kind === "steady_sliding" && !profile) {
      const length = law.holding_force / (train.stiffness * speed) + DECAY * 2 * Math.PI * Math.sqrt(train.mass / train.stiffness);
      const part = { duration: Math.min(length, duration), samples: 2 * LAP_SAMPLES };
      yield { decay: drawn(core.motion({ train, law, schedule, start: "rest", ...part, ...work })) };
    }
    if (!profile && above.kind !== cycle.kind) {
      // An unstable balance is left a little, or rounding would decide.
      const start = above.kind === "steady_sliding" ? "steady" : [1.001 * speed, force / train.stiffness];
      yield { steady: drawn(core.motion({ train, law, schedule, start, duration, samples: STEADY_SAMPLES })) };
    }
  }

  // The unstable cycle between sliding and sticking, and the greatest sudden loss of belt speed that steady sliding
  // survives; null where there is none.
  function unstable(job) {
    try {
      return core.unstable({ train: job.train, law: lawOf(job), drive_speed: job.speed, most_steps: WORK });
    } catch (error) {
      if (error.unfinished) return null;
      throw error;
    }
  }
  function kick(job) {
    const { train, speed } = job, law = lawOf(job), stretch = forceAt(law, speed) / train.stiffness;
    const sticks = (loss) => {
      const found = core.cycle({ train, law, drive_speed: speed, start: [speed - loss, stretch] });
      return found.kind !== "steady_sliding" && found.speed_min <= law.stick_speed * (1 + 1e-9);
    };
    if (!sticks(speed)) return null;
    let [low, high] = [0, speed];
    for (let i = 0; i < HALVINGS; i += 1) {
      const middle = 0.5 * (low + high);
      if (sticks(middle)) high = middle; else low = middle;
    }
    return low;
  }

  // The band; null where a smooth closure needs more work than a reader waits for.
  function band(job) {
    try {
      return core.band({ train: job.train, law: lawOf(job), lower: !job.slow, ...(job.slow ? { most_steps: WORK } : {}) });
    } catch (error) {
      if (job.slow && error.unfinished) return null;
      throw error;
    }
  }

  // Edges of the whole map, and the starting force at each of its temperatures.
  function* edges({ train, drag, temperatures, rule }) {
    yield core.edges({ train, drag, temperatures, rule, lower: true });
  }

  // V* at both ends of the stated range of each parameter, the others as set.
  function spread(job) {
    return job.ranges.map(([name, ends]) => ends.map((value) => {
      const train = name in job.train ? { ...job.train, [name]: value } : job.train;
      const drag = name in job.train ? job.drag : { ...job.drag, stick_speed: job.drag.stick_speed * value / job.stick_speed };
      const found = core.band({ train, law: lawOf({ ...job, drag }) });
      return Math.max(found.upper, found.transition);
    }));
  }

  // The zone of a setting, by the names of the map's states.
  function zone({ speed, limit, motor }, law, force, found) {
    const starts = law.holding_force <= limit, lower = Math.min(found.lower ?? found.transition, found.transition);
    const held = lower === 0 && speed < found.transition, beyond = motor ? "motor" : "stall";
    const moving = force > limit || (held && !starts) ? beyond
      : speed < lower ? "stick_slip" : speed < found.transition ? "swing" : speed < found.upper ? "bistable" : "smooth";
    return { state: starts ? moving : beyond, moving, starts };
  }

  // Tasks of a worker by name; each yields the parts of an answer as soon as they are known.
  const tasks = {
    *after(job) {
      if (job.whole) yield* setting(job);
      yield { unstable: unstable(job) };
      if (job.kick) yield { kick: kick(job) };
      if (job.band) yield { band: band(job) };
      if (job.ranges.length && !job.slow) yield { spread: spread(job) };
    },
    edges,
  };
  return { setting, band, unstable, zone, tasks };
}
