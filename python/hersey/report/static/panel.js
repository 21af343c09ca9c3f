// The panel to try settings: what happens at a setting of the machine, and how to reproduce it.

async function live(analysis, bytes, { map: mapPlace, panel: place }) {
  place.classList.add("panel");
  const heading = add(place, "div", "", "cap");
  add(heading, "h2", "Try a setting");
  const still = { show() {}, profile() {}, reset() {} };
  const able = bytes && typeof WebAssembly === "object";
  if (!able) {
    operatingMap(mapPlace, analysis.map);
    add(place, "p", "This browser has no WebAssembly, so no settings can be tried. All figures of the report are valid.");
    return still;
  }
  let core;
  try {
    core = await physics(bytes);
  } catch (error) {
    operatingMap(mapPlace, analysis.map);
    add(place, "p", `No settings can be tried: ${error.message}. All figures of the report are valid.`);
    return still;
  }
  const hint = add(heading, "span", "", "hint");
  const { map } = analysis, motor = map.limited_by === "motor torque", hot = map.temperature !== null;
  const limit = map.torque_limit === null ? Infinity : map.torque_limit / map.roll_radius;
  const known = settings(analysis), questions = answers(core);
  const { slides, told, reported, speedText } = verdicts({ map, points: analysis.decision?.points ?? [], limit, motor, questions });
  const SLOW = ["stribeck", "lugre"], QUICK_BAND = 5, FRAME = 20_000;
  const CLOSURES = {
    retained: "gradually (retained)", stiction: "abruptly (stiction)", stribeck: "Stribeck", lugre: "LuGre",
  };
  const ZONES = { creep: "sticks", stick_slip: "sticks", swing: "depends on start", bistable: "depends on start", smooth: "smooth", stall: "stall", motor: "stall" };
  let point = worst(), base = known.own(point), setting = known.read(location.hash, base) ?? { ...base };
  let answer = null, found = null, kicked = null, spread = null, asked = 0, drawn = 0, mapped = "", bandCost = 0, spoken = 0, open = "", touched = false;

  const picture = operatingMap(mapPlace, map, (speed, temperature) => tried({ speed, temperature }));
  const controls = controlsOf();
  const verdict = add(place, "div", "", "verdict-line"), said = add(place, "div", "", "unseen");
  said.setAttribute("aria-live", "polite");
  const printed = add(place, "p", "", "print-values");
  const chart = traces(place);
  const course = profile(place, chart, {
    change: (rows) => tried({ profile: rows, speed: rows.at(-1)[1] }),
    leave: () => tried({ profile: null }),
    written: (rows) => known.course(rows),
    refused: refuse,
  });
  const foot = add(place, "div", "", "foot"), out = add(place, "div", "", "out");
  out.hidden = true;
  const outs = {
    Link: () => link(), Command: () => known.command(setting, answer.law, answer.duration), TOML: () => known.toml(setting, answer.law),
    ...(map.drag.speeds ? { Drag: () => known.curve(answer.law) } : {}),
  };
  const FILES = { TOML: "setting.toml", Drag: "drag.csv" };
  const behind = numbers(place);
  const buttons = Object.keys(outs).map((name) => {
    const each = button(foot, name, () => { open = open === name ? "" : name; output(); });
    each.setAttribute("aria-expanded", "false");
    return each;
  });
  const courses = button(foot, "Profile", () => tried({ profile: setting.profile ? null : [[0, 0], [0.2, setting.speed]] }));
  courses.setAttribute("aria-pressed", "false");
  const back = button(foot, "Reset", () => reset());
  back.classList.add("back");
  back.title = "Back to the report’s setting";
  const after = labour(core.module, heard), edges = labour(core.module, heardEdges);

  // The point that most needs attention: the gravest signal, or the first point that is not smooth.
  function worst() {
    const signals = analysis.decision?.points?.map((each) => ["good", "watch", "act"].indexOf(each.signal)) ?? [];
    const gravest = signals.indexOf(Math.max(...signals));
    if (signals.length) return Math.max(map.points.findIndex((each) => each.name === analysis.decision.points[gravest].name), 0);
    return Math.max(map.points.findIndex((each) => each.at.state !== "smooth"), 0);
  }

  function controlsOf() {
    const made = {};
    const one = (where, name, label, unit, scale, low, high, options = {}) => {
      made[name] = control(where, { name, label, unit, low: low / scale, high: high / scale, refused: refuse, ...options,
        change: (value) => tried(options.given ? options.given(value) : { [name]: value * scale }) });
      made[name].scale = scale;
    };
    one(place, "speed", "Drive speed", "mm/s", 1e-3, map.speed[0], map.speed.at(-1), {
      given: (value) => ({ speed: value / 1e3, profile: setting.profile?.with(-1, [setting.profile.at(-1)[0], value / 1e3]) ?? null }) });
    if (hot) {
      one(place, "temperature", "Temperature", "°C", 1, map.temperature[0] - 273.15, map.temperature.at(-1) - 273.15, {
        logarithmic: false, step: 1, given: (value) => ({ temperature: value + 273.15 }) });
      made.temperature.shift = 273.15;
    }
    one(place, "stiffness", "Stiffness", "N/mm", 1e3, base.stiffness / 10, base.stiffness * 10);
    const level = hot ? ` at ${digits(known.stick.temperature - 273.15)} °C` : "";
    one(place, "stick_speed", "Stick speed", "mm/s", 1e-3, base.stick_speed / 10, base.stick_speed * 10, { spoken: `Stick speed${level}`, term: "stick speed" });
    const row = add(place, "div", "", "chosen"), label = add(row, "label", "Below it, stops"), select = add(row, "select");
    label.htmlFor = select.id = "try-closure";
    explained(label, "closure");
    const mark = document.createElement("span");
    mark.className = "changed";
    label.prepend(mark);
    for (const name of known.closures) add(select, "option", CLOSURES[name]).value = name;
    select.addEventListener("change", () => tried({ closure: select.value }));
    const further = add(place, "div", "", "further");
    further.id = "further";
    further.hidden = true;
    const more = button(row, "Mass, uncertainty…", () => {
      further.hidden = !further.hidden;
      more.setAttribute("aria-expanded", String(!further.hidden));
    });
    more.setAttribute("aria-expanded", "false");
    more.setAttribute("aria-controls", "further");
    one(further, "mass", "Mass", "kg", 1, base.mass / 10, base.mass * 10);
    const ranges = Object.keys(rangesOf(base));
    if (ranges.length) one(further, "spread", "Uncertainty", "×", 1, 0.1, 3, { count: 2 });
    const stated = ranges.map((name) => name.replace("_", " ")).join(" and ");
    add(further, "p", ranges.length ? `1 × is the uncertainty of ${stated} in the machine file (95 %).`
      : "The machine file states no [uncertainty], so V* has no interval here.", "hint");
    const told_spread = add(further, "p", "", "hint");
    one(further, "bristle_stiffness", "Bristles", "N/mm", 1e3, base.bristle_stiffness / 100, base.bristle_stiffness * 100);
    one(further, "bristle_damping", "Bristle damping", "N·s/m", 1, base.bristle_damping / 100, base.bristle_damping * 100);
    const bristles = add(further, "p", "Assumed until measured: bristles 100 × stiffness, damping 2 √(bristles × mass).", "hint");
    return { made, select, mark, more, further, bristles, spread: told_spread };
  }

  // Why a number was refused, in place of the hint until the next setting.
  function refuse(text) {
    hint.textContent = text;
    hint.classList.add("refused");
    said.textContent = text;
  }

  // The stated range of each parameter, about the value set and widened by the spread.
  function rangesOf(now) {
    const stated = analysis.uncertainty ?? {}, ranges = {};
    for (const [name, own] of [["stiffness", base.stiffness], ["mass", base.mass], ["stick_speed", base.stick_speed]]) {
      if (!stated[name]) continue;
      ranges[name] = stated[name].map((end) => now[name] * (end / own) ** now.spread);
    }
    return ranges;
  }

  function tried(change) {
    touched = true;
    setting = { ...setting, ...change };
    if (hot) setting.temperature = Math.min(Math.max(setting.temperature, map.temperature[0]), map.temperature.at(-1));
    if (!asked) asked = requestAnimationFrame(() => { asked = 0; update(); });
  }

  const job = () => ({
    train: known.train(setting), drag: known.drag(setting), temperature: setting.temperature, rule: map.stick_speed_rule,
    speed: setting.speed, stick_speed: setting.stick_speed, profile: setting.profile, limit, motor, slow: SLOW.includes(setting.closure),
  });
  const bristlesOf = (s) => (s.closure === "lugre" ? [s.bristle_stiffness, s.bristle_damping] : []);
  const machineKey = (s) => [s.stiffness, s.mass, s.stick_speed, s.closure, ...bristlesOf(s)].join(" ");
  const bandKey = (s) => `${machineKey(s)} ${s.temperature}`;

  function update() {
    showControls();
    const task = job(), number = drawn += 1;
    let whole = task.slow;
    kicked = spread = null;
    said.textContent = "";
    if (found?.key !== bandKey(setting)) found = found && { ...found, stale: true };
    try {
      if (!whole) whole = !answered(task);
      if (whole) {
        chart.lag(true);
      } else {
        if ((!found || found.stale) && bandCost < QUICK_BAND) {
          const start = performance.now();
          found = { ...questions.band(task), key: bandKey(setting) };
          bandCost = performance.now() - start;
        }
        if (between()) answer.unstable = questions.unstable(task);
        chart.lag(false);
        chart.draw(answer, setting);
      }
      if (whole) picture.show({ ...setting, zone: null });
      else showAnswer();
      const asked_too = { whole, band: !found || found.stale, kick: !whole && between(), ranges: Object.entries(rangesOf(setting)) };
      after.ask("after", { ...task, ...asked_too }, { number, key: bandKey(setting), task: { ...task, whole } });
      askEdges(task);
    } catch (error) {
      failed(reason(error));
    }
  }
  // A refusal of the core, in the words and at the temperature of the panel's controls.
  function reason({ message, quantity, value, limit: most }) {
    if (quantity !== "stick_speed" || !(most > 0)) return message;
    return `the stick speed must be less than the transition speed, ${speedText(setting.stick_speed * most / value)} here`;
  }
  // Whether the motion could be computed within a frame; anything slower goes to the worker.
  function answered(task) {
    const next = { train: task.train, unstable: null };
    try {
      for (const part of questions.setting({ ...task, work: FRAME })) Object.assign(next, part);
    } catch (error) {
      if (error.unfinished) return false;
      throw error;
    }
    answer = next;
    return true;
  }
  const between = () => answer && slides(answer.above, setting) && !slides(answer.cycle, setting);

  function heard({ part, failure }, about) {
    if (!about || about.number !== drawn) return;
    if (failure) {
      // A motion that is drawn stands, though what belongs to it could not be had.
      if (about.task.whole) failed(failure);
      return;
    }
    if (!part) return;
    const { band, kick, spread: ends, unstable, ...motion } = part;
    if (motion.law) answer = { train: about.task.train, unstable: null };
    if (band !== undefined) found = band && { ...band, key: about.key };
    if (band) bandCost *= 0.9;
    if (kick !== undefined) kicked = { value: kick };
    if (ends) spread = spreadOf(ends);
    if (!answer) return;
    Object.assign(answer, motion);
    if (unstable && between()) answer.unstable = unstable;
    if (answer?.motion && (part.motion || part.lap || part.steady || part.unstable)) {
      chart.lag(false);
      chart.draw(answer, setting);
    }
    if (answer?.motion) showAnswer();
  }
  // The ends of V* of all parameters together: the relative changes of each, squared and added.
  function spreadOf(each) {
    if (!found || found.stale) return null;
    const upper = Math.max(found.upper, found.transition);
    const ends = each.map((pair) => pair.map((v) => Math.log(v / upper)).sort((a, b) => a - b));
    const side = (i) => Math.hypot(...ends.map((pair) => (i ? Math.max(pair[1], 0) : Math.min(pair[0], 0))));
    return [upper * Math.exp(-side(0)), upper * Math.exp(side(1))];
  }

  function askEdges(task) {
    const key = machineKey(setting);
    if (key === mapped) return;
    mapped = key;
    if (key === machineKey(base)) { edges.forget(); picture.edges(null); return; }
    picture.lag();
    // The folds of a smooth closure take minutes at all temperatures: they are left out.
    const drag = task.slow ? { ...task.drag, closure: "retained" } : task.drag;
    edges.ask("edges", { train: task.train, drag, temperatures: map.temperature, rule: map.stick_speed_rule }, { key, slow: task.slow });
  }
  function heardEdges({ part, failure }, about) {
    if (failure || !part || about.key !== mapped) return;
    picture.edges(part, !about.slow);
  }

  function extrapolated() {
    const [slow, fast] = map.measured_speed, [cold, warm] = map.measured_temperature ?? [-Infinity, Infinity];
    return setting.speed < slow || setting.speed > fast || (hot && (setting.temperature < cold || setting.temperature > warm));
  }
  function showAnswer() {
    const now = told({ setting, answer, found, kicked });
    // the machine of the report has the verdict of the report, which counts all draws; drawn is the typical one
    const ofReport = map.given && !setting.profile && machineKey(setting) === machineKey(base);
    const { zone, signal: kind, words, sub, own } = ofReport ? { ...now, ...reported(setting) } : now;
    const [least, most] = (spread ?? []).map((v) => digits(1e3 * v));
    controls.spread.textContent = spread ? `With this uncertainty, V* is ${digits(1e3 * found.upper)} [${least}, ${most}] mm/s.` : "\u00a0";
    const far = extrapolated() && !own ? " (extrapolated)" : "";
    verdict.replaceChildren();
    const word = add(verdict, "span", "", `signal ${kind}`);
    word.append(signal(kind), { good: "Good:", watch: "Watch:", act: "Act:" }[kind]);
    verdict.append(` ${words}${far}`);
    const below = add(verdict, "span", "", "sub");
    sub.filter(Boolean).forEach((text, i) => add(below, "span", `${i ? " · " : ""}${text}`));
    setting.zone = ZONES[zone.state];
    picture.show(setting);
    if (answer.motion) behind.show(answer.motion, { ...setting });
    clearTimeout(spoken);
    spoken = setTimeout(() => {
      if (touched) said.textContent = verdict.textContent; // the verdict of the page that opens is read in its place
      printed.textContent = inWords();
      if (open) output();
      chart.say(`Sliding speed: ${words} at ${speedText(setting.speed)}`, `Phase plane at ${speedText(setting.speed)}: ${words}`);
    }, 500);
    trackColours();
    course.show(setting.profile);
  }
  function trackColours() {
    const { speed } = controls.made;
    if (found?.stale) { speed.slider.classList.add("lags"); return; }
    if (!found) speed.track([]);
    speed.slider.classList.remove("lags");
    if (!found) return;
    const [low, high] = [1e3 * map.speed[0], 1e3 * map.speed.at(-1)], lower = 1e3 * Math.min(found.lower ?? found.transition, found.transition);
    const upper = 1e3 * Math.max(found.upper, found.transition);
    speed.track([[low, lower, "sticks"], [lower, upper, "depends"], [upper, high, "smooth"]]);
  }
  function failed(reason) {
    verdict.replaceChildren();
    const word = add(verdict, "span", "", "signal act");
    word.append(signal("act"), "Not computed:");
    verdict.append(` ${reason}`);
    said.textContent = verdict.textContent;
    picture.show({ ...setting, zone: null });
    picture.lag();
    mapped = "";
    controls.made.speed.slider.classList.add("lags");
    chart.lag(true);
  }

  const differs = (name) => JSON.stringify(setting[name]) !== JSON.stringify(base[name]);
  function showControls() {
    const { made, select, mark, more, bristles } = controls;
    for (const [name, each] of Object.entries(made)) each.show((setting[name] - (each.shift ?? 0)) / each.scale, differs(name));
    select.value = setting.closure;
    mark.textContent = differs("closure") ? "◆ " : "";
    const lugre = setting.closure === "lugre";
    for (const each of [made.bristle_stiffness.row, made.bristle_damping.row, bristles]) each.hidden = !lugre;
    const hidden = ["mass", "spread", ...(lugre ? ["bristle_stiffness", "bristle_damping"] : [])].some(differs);
    more.textContent = `${hidden ? "◆ " : ""}Mass, uncertainty…`;
    courses.textContent = `${setting.profile ? "◆ " : ""}Profile`;
    courses.setAttribute("aria-pressed", String(Boolean(setting.profile)));
    const name = map.points[point]?.name;
    const changed = ["speed", "temperature", "stiffness", "mass", "stick_speed", "closure", "spread", "profile"].some(differs) || hidden;
    hint.classList.remove("refused");
    hint.textContent = changed ? "◆ differs from the report" : name ? `as reported: ${name}` : "as reported";
    back.disabled = !changed;
  }
  function inWords() {
    const parts = [`Drive speed ${speedText(setting.speed)}`, ...(hot ? [`temperature ${digits(setting.temperature - 273.15)} °C`] : []),
      `stiffness ${digits(setting.stiffness / 1e3)} N/mm`, `mass ${digits(setting.mass)} kg`,
      `stick speed ${speedText(setting.stick_speed)}${hot ? ` at ${digits(known.stick.temperature - 273.15)} °C` : ""}`, `closure ${setting.closure}`];
    return `${parts.join(", ")}.`;
  }

  function link() {
    const words = known.link(setting);
    address(words);
    return location.href.split("#")[0] + words;
  }
  // A page in a sandbox may not change its address.
  function address(words) {
    try { history.replaceState(null, "", words); } catch { /* the link stands in its field */ }
  }
  function output() {
    for (const each of buttons) each.setAttribute("aria-expanded", String(each.textContent === open));
    out.hidden = !open;
    if (!open || !answer?.law) { out.hidden = true; return; }
    if (!out.firstChild) {
      const field = add(out, "textarea");
      field.readOnly = true;
      field.rows = 5;
      const line = add(out, "div", "", "foot");
      button(line, "Copy", (from) => copy(field.value, from));
      out.save = button(line, "Save", () => save(FILES[open] ?? `${open.toLowerCase()}.txt`, field.value, "text/plain"));
    }
    const field = out.querySelector("textarea");
    const names = { Link: "Address of this setting", Command: "Command that reproduces this setting", TOML: "Machine file of this setting", Drag: "Drag curve of this setting" };
    field.setAttribute("aria-label", names[open]);
    field.value = outs[open]();
  }

  function reset() {
    setting = { ...base };
    if (location.hash.startsWith("#setting?")) address(location.pathname + location.search);
    tried({});
  }
  addEventListener("beforeprint", () => { printed.textContent = inWords(); });
  addEventListener("hashchange", () => {
    const there = known.read(location.hash, base);
    if (there) { setting = there; tried({}); }
  });
  update();
  return {
    show(index) {
      const name = analysis.decision?.points?.[index]?.name;
      point = Math.max(name ? map.points.findIndex((each) => each.name === name) : index, 0);
      base = known.own(point);
      reset();
    },
    profile(rows) {
      const course_rows = known.rows(rows.map((row) => [row.time, row.drive_speed]));
      if (course_rows) tried({ profile: course_rows, speed: course_rows.at(-1)[1] });
    },
    reset,
  };
}
