// Sliding speed against time and the phase plane, on one scale of speed. The first slip does not set the scale: it is cut
// off and its peak is written.

function traces(place) {
  const HEIGHT = 190, TOP = 14, BOTTOM = 34, LEFT = 34;
  const two = add(place, "div", "", "two");
  const panes = [["Sliding speed", "(mm/s)", "Time (s)"], ["Phase plane", "(mm/s over N)", "Spring force (N)"]].map(([title, unit, below]) => {
    const box = add(two, "div"), heading = add(box, "h3", `${title} `);
    add(heading, "span", unit);
    const drawing = svg("svg", { role: "group", "aria-label": title, height: HEIGHT }, box);
    const image = svg("g", { role: "img", "aria-label": title }, drawing), picture = svg("g", { "aria-hidden": "true" }, image), axes = svg("g", {}, picture);
    const name = `pane-${Math.random().toString(36).slice(2)}`;
    const edge = svg("rect", { y: TOP }, svg("clipPath", { id: name }, picture));
    const inside = svg("g", { "clip-path": `url(#${name})` }, picture);
    const line = (kind) => svg("path", { class: kind }, inside);
    const lines = Object.fromEntries(["drive", "unstable", "from-rest", "from-above"].map((kind) => [kind, line(kind)]));
    return { box, drawing, image, axes, edge, below, lines,
      dot: svg("circle", { r: 4.5, visibility: "hidden" }, inside), peak: svg("text", { class: "peak" }, picture), over: svg("g", {}, drawing) };
  });
  const [time, plane] = panes;
  const key = add(place, "ul", "", "key");
  const named = { "from-rest": "from rest", "from-above": "slowed down", unstable: "sticks outside this loop", drive: "drive" };
  const entries = Object.entries(named).map(([kind, text]) => {
    const item = add(key, "li");
    svg("path", { d: "M1 6h24", class: kind }, svg("svg", { viewBox: "0 0 26 12", "aria-hidden": "true" }, item));
    item.append(text);
    return [kind, item];
  });
  let scales = null, last = null, printing = false, seen = null;
  const peakOf = (values, from = 0) => { let most = 0; for (let i = from; i < values.length; i += 1) most = Math.max(most, values[i]); return most; };

  // The first sample after the first slip, when the belt is slower than the drive again.
  function afterFirst({ belt_speed: v }, speed) {
    let i = 0;
    while (i < v.length && v[i] <= speed) i += 1;
    while (i < v.length && v[i] > speed) i += 1;
    return i < v.length ? i : 0;
  }
  const ends = (values, about) => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [0.8 * about, 1.2 * about]);
  function nice(least) {
    const power = 10 ** Math.floor(Math.log10(least));
    return power * [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find((m) => m * power >= least * (1 - 1e-9));
  }

  function scale(answer, setting) {
    const { motion, cycle, lap, unstable, train } = answer, k = train.stiffness;
    const lasts = cycle.frequency > 0 && cycle.speed_max > 0 && !setting.profile;
    const fastest = setting.profile ? Math.max(...setting.profile.map((row) => row[1])) : setting.speed;
    const lively = setting.profile ? Math.min(peakOf(motion.belt_speed, afterFirst(motion, fastest)), 2.4 * fastest) : 0;
    const edge = unstable ? peakOf(unstable.speed) : 0;
    const most = Math.max(lasts ? 1.1 * cycle.speed_max : 1.9 * fastest, 1.25 * fastest, 1.05 * lively, 1.1 * edge);
    let forces = lasts ? [k * cycle.stretch_min, k * cycle.stretch_max]
      : ends(motion.spring_force.subarray(afterFirst(motion, setting.speed)), answer.force);
    if (unstable) forces = [Math.min(forces[0], ...unstable.force), Math.max(forces[1], ...unstable.force)];
    if (setting.profile) forces = [Math.min(0, ...motion.spring_force), Math.max(...motion.spring_force)];
    const room = 0.08 * (forces[1] - forces[0]);
    let [low, high] = [forces[0] - room, forces[1] + room];
    if (low < 0.45 * high && low > 0) low = 0;
    return { top: nice(1e3 * most) / 1e3, duration: answer.duration, low, high: Math.max(high, low + 1e-9) };
  }

  function axes(pane, width, across, label, y) {
    const right = width - 6, bottom = HEIGHT - BOTTOM, same = [width, scales.top, ...across.flat()].join(" ");
    if (pane.same === same) return;
    pane.same = same;
    pane.drawing.setAttribute("width", width);
    pane.drawing.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    for (const [name, value] of Object.entries({ x: LEFT, width: right - LEFT, height: bottom - TOP + 1 })) pane.edge.setAttribute(name, value);
    pane.axes.replaceChildren();
    for (const v of ticks(0, 1e3 * scales.top, 4)) {
      svg("path", { d: `M${LEFT} ${y(v / 1e3)}H${right}`, class: "grid" }, pane.axes);
      svg("text", { x: LEFT - 6, y: y(v / 1e3) + 4, "text-anchor": "end", class: "ticks" }, pane.axes, digits(v, 4));
    }
    svg("path", { d: `M${LEFT} ${TOP}V${bottom}H${right}`, class: "axisline" }, pane.axes);
    for (const [value, x] of across) {
      svg("path", { d: `M${x} ${bottom}v4`, class: "tick" }, pane.axes);
      svg("text", { x, y: bottom + 16, "text-anchor": "middle", class: "ticks" }, pane.axes, digits(value, 4));
    }
    svg("text", { x: (LEFT + right) / 2, y: bottom + 31, "text-anchor": "middle", class: "axis" }, pane.axes, label);
  }

  const put = (pane, kind, d) => pane.lines[kind].setAttribute("d", d);
  function draw(answer, setting) {
    last = [answer, setting];
    const { motion, lap, decay, steady, unstable, force } = answer;
    scales = scale(answer, setting);
    const bottom = HEIGHT - BOTTOM, y = (v) => bottom - v / scales.top * (bottom - TOP);
    const paper = paperWidth(two) - 32, widths = printing ? [0.61 * paper, 0.39 * paper] : seen ??= panes.map(({ box }) => Math.max(box.clientWidth, 120));
    const t = (s) => LEFT + s / scales.duration * (widths[0] - 6 - LEFT);
    const f = (n) => LEFT + (n - scales.low) / (scales.high - scales.low) * (widths[1] - 6 - LEFT);
    scales = { ...scales, t, y, right: widths[0] - 6, bottom };
    axes(time, widths[0], ticks(0, scales.duration, 4).map((s) => [s, t(s)]), time.below, y);
    axes(plane, widths[1], ticks(scales.low, scales.high, 4).map((n) => [n, f(n)]), plane.below, y);
    put(time, "from-rest", track(motion.time, motion.belt_speed, t, y));
    put(time, "from-above", steady ? track(steady.time, steady.belt_speed, t, y) : "");
    const rows = setting.profile ?? [[0, setting.speed]], drive = [...rows, [scales.duration, rows.at(-1)[1]]];
    put(time, "drive", shape.path([...(drive[0][0] > 0 ? [[0, drive[0][1]]] : []), ...drive].map(([s, v]) => [t(s), y(v)])));
    const lapped = lap ?? decay ?? motion, from = lap || setting.profile ? 0 : afterFirst(lapped, setting.speed);
    put(plane, "from-rest", track(lapped.spring_force.subarray(from), lapped.belt_speed.subarray(from), f, y));
    put(plane, "unstable", unstable ? track(unstable.force, unstable.speed, f, y) : "");
    const { above } = answer, sits = above.speed_max - above.speed_min < 1e-3 * setting.speed;
    plane.dot.setAttribute("visibility", "visible");
    plane.dot.setAttribute("class", sits ? "steady" : "unsteady");
    plane.dot.setAttribute("cx", f(force));
    plane.dot.setAttribute("cy", y(setting.speed));
    peaks(motion);
    for (const [kind, item] of entries) {
      item.hidden = (kind === "from-above" && !steady) || (kind === "unstable" && !unstable);
    }
  }
  function track(xs, ys, x, y) {
    let d = "";
    for (let i = 0; i < xs.length; i += 1) d += `${i ? "L" : "M"}${x(xs[i]).toFixed(1)} ${y(ys[i]).toFixed(1)}`;
    return d;
  }
  function peaks({ time: s, belt_speed: v }) {
    let at = 0, cut = 0;
    for (let i = 1; i < v.length; i += 1) {
      if (v[i] > v[at]) at = i;
      if (v[i] > scales.top && v[i - 1] <= scales.top) cut += 1;
    }
    const over = v[at] > scales.top, text = over ? `↑ ${digits(1e3 * v[at])}${cut > 1 ? " max" : ""}` : "";
    const width = over ? shape.width(text) : 0, x = scales.t(s[at]);
    time.peak.textContent = text;
    time.peak.setAttribute("x", x - width - 8 > LEFT ? x - width - 8 : x + 12);
    time.peak.setAttribute("y", TOP - 2);
  }
  const again = () => { if (last) draw(...last); };
  new ResizeObserver(() => { seen = null; if (!printing) again(); }).observe(two);
  addEventListener("beforeprint", () => { printing = true; again(); });
  addEventListener("afterprint", () => { printing = false; again(); });

  return {
    draw, key,
    over: time.over, drawing: time.drawing,
    scales: () => scales,
    // Pixels of the drawing as seconds and m/s.
    at(event) {
      const box = time.drawing.getBoundingClientRect();
      const share = (event.clientX - box.left - LEFT) / (scales.right - LEFT);
      const up = (scales.bottom - (event.clientY - box.top)) / (scales.bottom - TOP);
      return [Math.min(Math.max(share, 0), 1) * scales.duration, Math.min(Math.max(up, 0), 1) * scales.top];
    },
    say(text, phase) {
      time.image.setAttribute("aria-label", text);
      plane.image.setAttribute("aria-label", phase);
    },
    lag(on, kinds = null) {
      if (!kinds) two.classList.toggle("lags", on);
      for (const pane of panes) for (const kind of kinds ?? []) pane.lines[kind].classList.toggle("lags", on);
    },
  };
}
