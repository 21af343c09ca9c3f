// A setting to try, in SI: taken from the report, kept in an address, written as a command or as TOML.

function settings(analysis) {
  const { map } = analysis;
  const CLOSURES = ["retained", "stiction", "stribeck", "lugre"];
  const NUMBERS = ["speed", "temperature", "stiffness", "mass", "stick_speed", "bristle_stiffness", "bristle_damping", "spread"];
  const anchor = map.points[0] ?? null;
  // The stick speed is set at the temperature at which the report states it; elsewhere it follows the map's rule.
  const stick = anchor ? { speed: anchor.at.stick_speed, temperature: anchor.temperature }
    : { speed: map.drag.stick_speed, temperature: map.drag.reference_temperature };
  const middle = (ends) => Math.sqrt(ends[0] * ends[1]);

  function own(point) {
    // Without a point: the middle of what was measured, in round numbers.
    const at = map.points[point] ?? {
      speed: Number(middle(map.measured_speed).toPrecision(2)),
      temperature: map.temperature && Math.round((map.measured_temperature[0] + map.measured_temperature[1]) / 2 - 273.15) + 273.15,
    };
    return {
      speed: at.speed, temperature: map.temperature ? at.temperature : null, stiffness: map.train.stiffness, mass: map.train.mass,
      stick_speed: stick.speed, closure: map.drag.closure, bristle_stiffness: map.drag.bristle_stiffness ?? 100 * map.train.stiffness,
      bristle_damping: map.drag.bristle_damping ?? 2 * Math.sqrt(100 * map.train.stiffness * map.train.mass), spread: 1, profile: null,
    };
  }
  const drag = (setting) => ({
    ...map.drag, stick_speed: map.drag.stick_speed * (setting.stick_speed / stick.speed), closure: setting.closure,
    ...(setting.closure === "lugre" ? { bristle_stiffness: setting.bristle_stiffness, bristle_damping: setting.bristle_damping } : {}),
  });
  const train = (setting) => ({ ...map.train, stiffness: setting.stiffness, mass: setting.mass });

  function link(setting) {
    const said = (name) => setting[name] !== null && (setting.closure === "lugre" || !name.startsWith("bristle"))
      && (name !== "spread" || setting.spread !== 1);
    const words = NUMBERS.filter(said).map((name) => `${name}=${setting[name]}`);
    if (setting.profile) words.push(`profile=${setting.profile.map((row) => row.join(":")).join(",")}`);
    return `#setting?${[...words, `closure=${setting.closure}`].join("&")}`;
  }
  // The setting of an address, or null if it holds none; values that it omits are those of the report.
  function read(address, base) {
    if (!address.startsWith("#setting?")) return null;
    const words = new URLSearchParams(address.slice("#setting?".length)), setting = { ...base, profile: null };
    for (const name of NUMBERS) {
      const value = Number(words.get(name));
      if (words.has(name) && Number.isFinite(value) && value > 0 && setting[name] !== null) setting[name] = value;
    }
    if (CLOSURES.includes(words.get("closure"))) setting.closure = words.get("closure");
    if (words.has("profile")) setting.profile = rows(words.get("profile").split(",").map((row) => row.split(":").map(Number)));
    if (setting.profile) setting.speed = setting.profile.at(-1)[1];
    setting.speed = Math.min(Math.max(setting.speed, map.speed[0]), map.speed.at(-1));
    if (map.temperature) setting.temperature = Math.min(Math.max(setting.temperature, map.temperature[0]), map.temperature.at(-1));
    return setting;
  }
  // Rows of a profile that a motion can follow: ascending times, the last speed above 0; else null.
  function rows(given) {
    const sound = given.length > 0 && given.length <= 200 && given.every(([t, v], i) => Number.isFinite(t) && Number.isFinite(v)
      && t >= 0 && v >= 0 && (i === 0 || t >= given[i - 1][0]));
    return sound && given.at(-1)[1] > 0 ? given : null;
  }

  // Six digits: more are neither known nor shown.
  const neat = (value) => Number(value.toPrecision(6));
  const beside = (law) => map.train.grip !== null || law.rest_force !== 0 || law.rest_damping !== 0;
  function command(setting, law, duration) {
    const shape = map.drag.speeds ? [["static-force", law.breakaway_force, "N"]]
      : [["transition-force", law.transition_force, "N"], ["transition-speed", law.transition_speed, "m/s"]];
    const amounts = [...(setting.profile ? [] : [["drive-speed", setting.speed, "m/s"]]), ["stiffness", setting.stiffness, "N/m"], ["mass", setting.mass, "kg"],
      ...shape, ["stick-speed", law.stick_speed, "m/s"],
      ...(setting.closure === "lugre"
        ? [["bristle-stiffness", setting.bristle_stiffness, "N/m"], ["bristle-damping", setting.bristle_damping, "N*s/m"]] : [])];
    const words = amounts.map(([name, value, unit]) => `--${name} "${neat(value)} ${unit}"`);
    const curve = map.drag.speeds ? ["--drag-table drag.csv"]
      : [`--ehl-exponent=${neat(map.drag.ehl_exponent)}`, `--mixed-exponent=${neat(map.drag.mixed_exponent)}`];
    const plain = [...curve, `--closure ${setting.closure}`];
    const machine = beside(law) ? ["--machine setting.toml"] : [];
    const course = setting.profile ? ["--profile profile.csv", `--duration "${duration} s"`] : [];
    return ["hersey simulate", ...course, ...machine, ...words, ...plain].join(" ");
  }
  function toml(setting, law) {
    const radius = map.roll_radius, at = setting.temperature === null ? "" : ` at ${digits(setting.temperature - 273.15)} °C`;
    const closed = setting.closure === "retained" ? [] : [`# The closure tried is ${setting.closure}; machine files and hersey map, plan and report use only retained.`];
    const lines = [...closed, "# The setting tried: a machine file for hersey map, plan, report and simulate.", "[drivetrain]", `part = "${map.train.part}"`,
      `stiffness = "${neat(setting.stiffness)} N/m"`, `mass = "${neat(setting.mass)} kg"`, `roll_radius = "${radius} m"`,
      `stick_speed = "${neat(law.stick_speed)} m/s"`];
    if (setting.temperature !== null) lines.push(`stick_speed_temperature = "${setting.temperature} K"`);
    if (map.stick_speed_rule === "fixed") lines.push('stick_speed_rule = "fixed"');
    const limits = [...(map.limited_by === "motor torque" ? [`motor_torque = "${map.torque_limit} N*m"`] : []),
      ...(map.train.grip === null ? [] : ["roll_friction = 1.0  # with this load, the grip", `nip_load = "${map.train.grip} N"`]),
      ...(map.speed_limit === null ? [] : [`speed = "${map.speed_limit} m/s"`])];
    if (limits.length) lines.push("", "[limits]", ...limits);
    if (law.rest_force !== 0 || law.rest_damping !== 0) {
      lines.push("", `[rest]  # no-load torque${at}`, `torque = "${neat(law.rest_force * radius)} N*m"`,
        `damping = "${neat(law.rest_damping * radius ** 2)} N*m*s/rad"`);
    }
    if (setting.temperature !== null) {
      lines.push("", "[[points]]", 'name = "tried"', `speed = "${setting.speed} m/s"`, `temperature = "${setting.temperature} K"`);
    }
    return `${lines.join("\n")}\n`;
  }
  // The drag curve at the temperature of a law, as a file of the command: that of the contact alone.
  function curve(law) {
    const { speeds, forces } = map.drag, least = forces.indexOf(Math.min(...forces));
    const faster = law.transition_speed / speeds[least], stronger = law.transition_force / forces[least];
    return csv(["speed (m/s)", "force (N)"], speeds.map((v, i) => [String(neat(v * faster)), String(neat(forces[i] * stronger))]));
  }
  // The profile as a file of the command.
  const course = (profile) => csv(["time (s)", "speed (mm/s)"], profile.map(([t, v]) => [String(t), String(neat(1e3 * v))]));
  return { own, drag, train, link, read, rows, command, toml, curve, course, stick, closures: CLOSURES };
}
