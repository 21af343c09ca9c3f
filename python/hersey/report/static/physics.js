// The core in the page: questions become numbers for the WebAssembly of crates/wasm, and its answers become objects.
// Nothing is computed here; all is SI. It is one function, so that a worker can be made of its text. The content and
// order of each question are defined in crates/wasm/src.

async function physics(bytes) {
  const MODES = ["ehl", "mixed", "microslip", "stuck"];
  const GUARDS = [
    "transition_speed", "stick_speed", "holding_force", "reversal", "table_point", "grip_lost", "grip_regained",
  ];
  const KINDS = ["steady_sliding", "oscillation", "stick_slip", "unsettled", "stalled", "grip_slip"];
  const RULES = ["with transition", "fixed"];
  // those of hersey.simulate and hersey.hysteresis, where a question does not say
  const TOLERANCE = { motion: 1e-9, band: 1e-11 };
  const MOST_STEPS = 5_000_000;
  const NONE = NaN;

  const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
  let core = (await WebAssembly.instantiate(module)).exports;
  // words and names of which a law of drag is made, in the order in which a question has them
  core.hersey_names();
  const NAMES = JSON.parse(words());

  function words() {
    const text = new Uint8Array(core.memory.buffer, core.hersey_refusal(), core.hersey_answer_length());
    return new TextDecoder().decode(text.slice());
  }

  function refused(fields) {
    const error = Object.assign(new Error(fields.message), fields);
    error.name = fields.unfinished ? "UnfinishedError" : "ParameterError";
    return error;
  }

  function asked(name, numbers) {
    if (core === null) throw refused({ message: "the calculation restarts: try again", unfinished: true });
    try {
      const place = core.hersey_question(numbers.length);
      new Float64Array(core.memory.buffer, place, numbers.length).set(numbers);
      const refuses = core[name]();
      if (refuses) throw refused(JSON.parse(words()));
      return new Float64Array(core.memory.buffer, core.hersey_answer(), core.hersey_answer_length()).slice();
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      // the memory of the page did not suffice: nothing in there can be relied on any more
      core = null;
      WebAssembly.instantiate(module).then((fresh) => { core = fresh.exports; });
      throw refused({ message: `too much for the page to compute: ${error.message}`, unfinished: true });
    }
  }

  function number(name, value) {
    if (typeof value === "number" && !Number.isNaN(value)) return value;
    throw refused({ message: `${name} is ${value}: a finite number is needed`, quantity: name });
  }
  const or = (name, object, otherwise) => number(name, object[name] ?? otherwise);
  const given = (name, value) => (value === null || value === undefined ? NONE : number(name, value));
  const named = (names, object) => names.map((name) => number(name, object[name]));
  function known(name, names, value) {
    const place = names.indexOf(value);
    if (place >= 0) return place;
    throw refused({ message: `${name} '${value}' is not known: ${names.join(", ")}`, quantity: name });
  }
  const steps = (options) => number("most_steps", options.most_steps ?? MOST_STEPS);
  const list = (name, values) => [values.length, ...Array.from(values, (value) => number(name, value))];
  const ofTrain = (train) => [...named(["stiffness", "mass"], train), given("grip", train.grip)];

  // the words and lists of a law, which its fields tell: powers, points, or mixed lubrication
  function ofShape(drag) {
    if (drag.sharing) return { law: "mixed", numbers: named(NAMES.sharing, drag.sharing) };
    if (!drag.speeds) return { law: "power" };
    if (drag.speeds.length !== drag.forces.length) {
      throw refused({ message: `the drag table has ${drag.speeds.length} speeds, but ${drag.forces.length} forces` });
    }
    const { speeds, forces } = drag;
    [...speeds, ...forces].forEach((value) => number("drag table", value));
    return { law: "table", speeds, forces };
  }
  const varies = (drag) => drag.reference_temperature !== null && drag.reference_temperature !== undefined;
  const zeroOf = (drag) => or("temperature_zero", drag, 0);

  function ofTemperature(drag) {
    if (!varies(drag)) return { temperature_law: "none" };
    if (!drag.viscosity_law) return { temperature_law: "power" };
    const { kind, ...law } = drag.viscosity_law;
    known("viscosity law", Object.keys(NAMES.viscosity), kind);
    return { temperature_law: kind, viscosity_numbers: named(NAMES.viscosity[kind], law) };
  }

  function ofDrag(drag) {
    const growth = or("static_growth", drag, 0);
    if (growth && (drag.closure !== "stiction" || !drag.static_growth_time)) {
      const needed = drag.closure === "stiction" ? "static_growth_time" : "closure 'stiction'";
      throw refused({ message: `static_growth is ${growth}: it needs ${needed}`, quantity: "static_growth" });
    }
    const { law, temperature_law, ...lists } = { ...ofShape(drag), ...ofTemperature(drag) };
    return [
      known("law", NAMES.law, law), known("closure", NAMES.closure, drag.closure),
      known("temperature_law", NAMES.temperature_law, temperature_law),
      ...NAMES.numbers.map((name) => given(name, drag[name])),
      ...NAMES.lists.flatMap((name) => list(name, lists[name] ?? [])),
    ];
  }

  function scaled(drag, temperature) {
    const is = temperature !== null && temperature !== undefined;
    if (varies(drag) && !is) throw refused({ message: "the drag varies with temperature: give temperature" });
    if (is && !varies(drag)) {
      throw refused({ message: "temperature is given, but the drag does not vary with it" });
    }
    return is ? number("temperature", temperature) - zeroOf(drag) : NONE;
  }

  // "rest", "steady" (with a nudge where the motion settles: an unstable balance is nothing that a belt can keep),
  // or belt speed and stretch
  function ofStart(start, nudged) {
    if (Array.isArray(start)) return [3, number("start belt_speed", start[0]), number("start stretch", start[1])];
    known("start", ["rest", "steady"], start);
    return [start === "rest" ? 0 : nudged ? 2 : 1, 0, 0];
  }

  const bandOf = (row) => {
    const [lower, transition, upper, stalls, speedMax, lowerAccuracy, upperAccuracy, half, deeper, laps] = row;
    const known = (value) => (Number.isNaN(value) ? null : value);
    return {
      lower: known(lower), transition, upper, stalls: stalls > 0, speed_max: known(speedMax),
      lower_accuracy: known(lowerAccuracy), upper_accuracy: upperAccuracy,
      method: half > 0 ? "half laps" : "simulation", deeper: deeper > 0, laps,
    };
  };

  return {
    // The module, for workers: `physics(module)` there takes no time to compile it.
    module,

    // The law of a part of the document at a temperature (K; none if it does not vary). Of `changes`, `stick_speed`
    // is that at this temperature, `rule: "fixed"` keeps the drag's own there, and any other field (closure,
    // bristle_stiffness, static_force, rest_force ...) takes the place of the drag's.
    drag(drag, temperature, { rule = "with transition", stick_speed, ...changes } = {}) {
      const part = { ...drag, ...changes };
      const fixed = known("rule", RULES, rule) === 1;
      const there = stick_speed ?? (fixed ? part.stick_speed : null);
      const numbers = [...ofDrag(part), scaled(part, temperature), given("stick_speed", there)];
      const [transitionForce, transitionSpeed, stickSpeed, breakaway, holding, restForce, restDamping, risingFrom] =
        asked("hersey_law", numbers);
      return {
        numbers: Float64Array.from(numbers), temperature: temperature ?? null, closure: part.closure,
        transition_force: transitionForce, transition_speed: transitionSpeed, stick_speed: stickSpeed,
        breakaway_force: breakaway, holding_force: holding, rest_force: restForce, rest_damping: restDamping,
        rising_from: risingFrom,
      };
    },

    // Drag in steady sliding at each speed (N), the no-load torque counted.
    forces: (law, speeds) => asked("hersey_forces", [...law.numbers, ...list("speed", speeds)]),

    // What a belt at rest withstands (N).
    holding: (law) => law.holding_force,

    // Motion under a drive of straight lines through `schedule`, [[s, m/s], ...], or at one speed.
    motion({ train, law, schedule, start, duration, samples, ...options }) {
      const rows = typeof schedule === "number" ? [[0, schedule]] : schedule;
      const answer = asked("hersey_motion", [
        steps(options), ...ofTrain(train), ...law.numbers,
        number("tolerance", options.tolerance ?? TOLERANCE.motion), number("duration", duration),
        number("samples", samples), ...list("time of the drive", rows.map((row) => row[0])),
        ...list("drive_speed", rows.map((row) => row[1])), ...ofStart(start, false),
      ]);
      const [taken, count, changes] = answer;
      const column = (i) => answer.slice(3 + i * count, 3 + (i + 1) * count);
      const mode = Uint8Array.from(column(3));
      const events = Array.from({ length: changes }, (_, i) => {
        const begin = 3 + 5 * count + 6 * i;
        const [time, from, to, guard, stretch, speed] = answer.subarray(begin, begin + 6);
        return { time, from_mode: MODES[from], to_mode: MODES[to], guard: GUARDS[guard], stretch, belt_speed: speed };
      });
      return {
        time: column(0), belt_speed: column(1), spring_force: column(2), mode,
        stuck: mode.map((place) => (MODES[place] === "stuck" ? 1 : 0)), slipping: Uint8Array.from(column(4)),
        events, steps: taken, status: "done",
      };
    },

    // What the motion settles to at a constant drive speed.
    cycle({ train, law, drive_speed, start, ...options }) {
      const [kind, frequency, slip, stick, speedMin, speedMax, stretchMin, stretchMax, gripSlip, work, period, laps] =
        asked("hersey_cycle", [
          steps(options), ...ofTrain(train), ...law.numbers,
          number("tolerance", options.tolerance ?? TOLERANCE.motion), number("drive_speed", drive_speed),
          ...ofStart(start, true),
        ]);
      return {
        kind: KINDS[kind], frequency, slip_duration: slip, stick_duration: stick, stuck_fraction: stick * frequency,
        speed_min: speedMin, speed_max: speedMax, stretch_min: stretchMin, stretch_max: stretchMax,
        grip_slip_duration: gripSlip, drag_work: work, laps_per_period: period, laps,
      };
    },

    // Edges of the behaviour over drive speed; null for what was not asked for or is not known, infinite beyond the
    // search.
    band({ train, law, lower = false, ...options }) {
      const numbers = [...law.numbers];
      const [temperature, stickSpeed] = numbers.splice(-2);
      return bandOf(asked("hersey_bands", [
        steps(options), ...ofTrain(train), ...numbers, lower ? 1 : 0,
        number("tolerance", options.tolerance ?? TOLERANCE.band), stickSpeed,
        ...(Number.isNaN(temperature) ? [0] : [1, temperature]),
      ]));
    },

    // The same at many temperatures (K; null for a drag that does not vary), by the rule of the stick speed. Without a
    // band the three speeds are one. Where there is none at a temperature, not a number; if at none, an error says why.
    // With what a belt at rest withstands (N).
    edges({ train, drag, temperatures, rule, lower = false, ...options }) {
      const fixed = known("rule", RULES, rule) === 1;
      const scale = temperatures ? Array.from(temperatures, (t) => scaled(drag, t)) : [];
      if (!temperatures) scaled(drag, null);
      const answer = asked("hersey_bands", [
        steps(options), ...ofTrain(train), ...ofDrag(drag), lower ? 1 : 0,
        number("tolerance", options.tolerance ?? TOLERANCE.band), fixed ? drag.stick_speed : NONE,
        scale.length, ...scale,
      ]);
      const column = (i) => Float64Array.from({ length: answer.length / 11 }, (_, row) => answer[11 * row + i]);
      const transition = column(1);
      const edges = { transition, upper: column(2).map((upper, i) => Math.max(upper, transition[i])) };
      if (lower) edges.lower = column(0).map((edge, i) => Math.min(edge, transition[i]));
      return { ...edges, stalls: Uint8Array.from(column(3)), holding: column(10) };
    },

    // The lap in the phase plane (m/s, N) that parts the starts which come to slide from those which come to stick, or
    // null where all come to one motion. Where no lap comes back to its start, or none that rounding lets find, it is
    // the one that just meets the stick speed: not closed.
    unstable({ train, law, drive_speed, samples = 361, ...options }) {
      const answer = asked("hersey_unstable", [
        steps(options), ...ofTrain(train), ...law.numbers,
        number("tolerance", options.tolerance ?? TOLERANCE.band), number("drive_speed", drive_speed),
        number("samples", samples),
      ]);
      if (!answer.length) return null;
      return { closed: answer[0] > 0, speed: answer.slice(1, 1 + samples), force: answer.slice(1 + samples) };
    },
  };
}
