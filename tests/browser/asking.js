// Asks the core in a page what `belts.py` asks the core in Python: each quantity of an answer for itself, or the words
// of an error.
async ([source, bytes, text]) => {
  const settings = JSON.parse(text);
  const physics = new Function(`${source}; return physics;`)();
  const core = await physics(Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0)));
  const KINDS = ["steady_sliding", "oscillation", "stick_slip", "unsettled", "stalled", "grip_slip"];
  const asks = {
    motion(setting, law) {
      const run = core.motion({ ...setting, law, schedule: setting.rows });
      const events = ["time", "stretch", "belt_speed"].map((name) => run.events.map((event) => event[name]));
      return [[...run.belt_speed], [...run.spring_force], [...run.slipping], [run.steps], ...events];
    },
    cycle(setting, law) {
      const cycle = core.cycle({ ...setting, law });
      return [
        [cycle.speed_min, cycle.speed_max], [cycle.stretch_min, cycle.stretch_max],
        [cycle.slip_duration, cycle.stick_duration, cycle.grip_slip_duration],
        [cycle.frequency], [cycle.drag_work], [cycle.stuck_fraction],
        [KINDS.indexOf(cycle.kind), cycle.laps_per_period],
      ];
    },
    forces: (setting, law) => [[core.holding(law)], ...Array.from(core.forces(law, setting.speeds), (force) => [force])],
    band(setting, law) {
      const band = core.band({ ...setting, law, lower: true });
      return [[band.lower], [band.transition], [band.upper], [Number(band.stalls)]];
    },
    edge(setting) {
      const asked = { ...setting, temperatures: [setting.temperature], rule: "with transition", lower: true };
      const edges = core.edges(asked);
      return [edges.lower, edges.transition, edges.upper, edges.stalls].map((edge) => [edge[0]]);
    },
  };
  const answers = settings.map((setting) => {
    try {
      return asks[setting.question](setting, core.drag(setting.drag, setting.temperature));
    } catch (error) {
      return error.message;
    }
  });
  return JSON.stringify(answers, (_, value) => (typeof value === "number" && !Number.isFinite(value) ? String(value) : value));
}
