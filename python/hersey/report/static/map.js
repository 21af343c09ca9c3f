// The operating map: temperature across, drive speed up. It is the same with and without a panel; only the ring, the
// setting tried, needs one.

function operatingMap(place, map, move = null) {
  const hot = map.temperature !== null;
  const columns = hot ? map.temperature : [0, 1];
  const wide = (values) => Array.from(hot ? values : [values[0], values[0]], (v) => v ?? Infinity);
  const [slowest, fastest] = [map.speed[0], map.speed.at(-1)];
  const given = {
    lower: wide(map.lower), transition: wide(map.transition), upper: wide(map.upper), folds: true,
    starts: wide(map.holding).map((torque) => torque <= (map.torque_limit ?? Infinity)),
  };
  const [below, above] = [wide(map.stall_below), wide(map.stall_above)];
  const intervals = [...map.transition_interval, ...map.upper_interval].map(wide);
  const celsius = (kelvin) => kelvin - 273.15, millimetres = (speed) => 1e3 * speed;
  const rpm = 60 / (2 * Math.PI * map.roll_radius);
  const named = `hatch-${Math.random().toString(36).slice(2)}`;
  const beyond = map.limited_by === "motor torque" ? "motor stalls" : "stall";
  let edges = given, lagging = false, changed = false, setting = null, frame = null, printing = false, unnamed = [], keyed = "", tickWords = [];

  place.classList.add("map");
  const caption = add(place, "div", "", "cap");
  add(caption, "h2", "Operating map");
  const hint = add(caption, "span", move ? "drag the ring, or arrow keys" : "", "hint");
  const drawing = svg("svg", { role: "group", "aria-label": "Operating map" }, place);
  const hatch = svg("pattern", {
    id: named, width: 7, height: 7, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)",
  }, svg("defs", {}, drawing));
  svg("path", { d: "M0 0v7", class: "hatch" }, hatch);
  const image = svg("g", { role: "img" }, drawing), picture = svg("g", { "aria-hidden": "true" }, image);
  const key = add(place, "ul", "", "key");
  const figures = fold(place, "Map as a table");
  figures.className = "figures";

  // Pixels of a temperature and of a speed, and back.
  const across = (x) => frame.left + (x - columns[0]) / (columns.at(-1) - columns[0]) * frame.width;
  const up = (v) => frame.bottom - Math.log(v / slowest) / Math.log(fastest / slowest) * frame.height;
  const speedAt = (y) => slowest * (fastest / slowest) ** ((frame.bottom - y) / frame.height);
  const columnAt = (x) => columns[0] + (x - frame.left) / frame.width * (columns.at(-1) - columns[0]);
  const kept = (v) => Math.min(Math.max(v, slowest), fastest);
  const line = (values) => columns.map((x, i) => (values[i] > 0.2 * slowest && values[i] < 5 * fastest ? [across(x), up(values[i])] : [NaN, NaN]));

  function place_of(point, number) {
    return hot ? point.temperature : (number + 1) / (map.points.length + 1);
  }

  const ring = move ? mapRing(drawing, { map, hot, columns, slowest, fastest, across, up, speedAt, columnAt, kept, place_of }, move) : null;

  function draw() {
    const room = printing ? paperWidth(place) : place.clientWidth;
    if (!room) return;
    const asked = Number.parseFloat(getComputedStyle(place).getPropertyValue("--map-height")) - 86;
    const height = printing ? 380 : room > 600 ? Math.min(Math.max(asked || 424, 340), 480) : 372, left = 34, right = 34, top = 24;
    frame = { left, top, width: room - left - right, bottom: height - 36, height: height - 36 - top, right: room - right };
    drawing.setAttribute("viewBox", `0 0 ${room} ${height}`);
    drawing.setAttribute("width", room);
    drawing.setAttribute("height", height);
    picture.replaceChildren();
    image.setAttribute("aria-label", finding());
    const clip = svg("rect", { x: left, y: top, width: frame.width, height: frame.height }, svg("clipPath", { id: `${named}-frame` }, picture));
    clip.parentNode.setAttribute("clipPathUnits", "userSpaceOnUse");
    const inside = svg("g", { "clip-path": `url(#${named}-frame)` }, picture);
    const zones = drawZones(inside);
    drawHatch(inside);
    const torques = drawTorques(inside);
    drawLines(inside);
    const box = measured();
    svg("rect", { x: box[0], y: box[1], width: Math.max(box[2] - box[0], 0), height: Math.max(box[3] - box[1], 0), class: "measured" }, inside);
    svg("rect", { x: left, y: top, width: frame.width, height: frame.height, class: "box" }, picture);
    drawAxes();
    const names = mapNames({ map, frame, picture, edges, beyond, slowest, fastest, across, up, speedAt, columnAt, place_of, valueAt, runs });
    names.drawPoints();
    names.nameLimit();
    names.nameTorques(torques);
    unnamed = names.nameZones(zones, box);
    drawKey();
    if (figures.open) drawTable();
    ring?.draw(setting, frame, tickWords);
  }

  function finding() {
    const middle = Math.floor(columns.length / 2), ends = hot ? [0, columns.length - 1] : [0];
    const told = (edge) => ends.map((i) => digits(millimetres(edges[edge][i]))).join(" to ");
    const from = hot ? ` from ${celsius(columns[0]).toFixed(0)} to ${celsius(columns.at(-1)).toFixed(0)} °C` : "";
    if (!edges.folds) return `Operating map: the ${map.train.part} sticks below ${told("transition")} mm/s${from}; V* is not computed for this closure`;
    const band = edges.upper[middle] > 1.01 * edges.transition[middle] || edges.upper.at(-1) > 1.01 * edges.transition.at(-1);
    return `Operating map: the ${map.train.part} sticks below ${told("transition")} mm/s${from}`
      + (band ? `, and runs smoothly from any start above ${told("upper")} mm/s` : ", and runs smoothly above");
  }

  // Areas: the speeds between two edges, and those below and above the limits of the drive.
  function parts() {
    const lowest = columns.map(() => slowest), highest = columns.map(() => fastest);
    const floor = below.map((v, i) => (edges.starts[i] ? kept(changed ? 0 : v) : fastest)), roof = above.map(kept);
    const between = (low, high) => low.map((v, i) => {
      const a = Math.min(Math.max(kept(v), floor[i]), Math.max(roof[i], floor[i]));
      return [a, Math.max(Math.min(Math.max(kept(high[i]), floor[i]), Math.max(roof[i], floor[i])), a)];
    });
    return {
      smooth: [between(edges.upper.map((v, i) => Math.max(v, edges.transition[i])), highest)],
      depends: [between(edges.lower, edges.upper)],
      sticks: [between(lowest, edges.lower)],
      stall: [lowest.map((v, i) => [v, floor[i]]), roof.map((v, i) => [Math.max(v, floor[i]), fastest])],
    };
  }

  function drawZones(inside) {
    const zones = {};
    for (const [name, bands] of Object.entries(parts())) {
      zones[name] = bands.map((band) => band.map(([low, high], i) => [across(columns[i]), up(low), up(high)]));
      for (const run of zones[name].flatMap(runs)) {
        if (Math.max(...run.map(([, low, high]) => low - high)) < 0.5) continue;
        const outline = [...run.map(([x, low]) => [x, low]), ...run.map(([x, , high]) => [x, high]).reverse()];
        svg("path", { d: `${shape.path(outline)}Z`, class: `zone ${name}${lagging ? " lags" : ""}` }, inside);
      }
    }
    return zones;
  }
  // Runs of columns with edges; at some temperatures a law has none.
  function runs(band) {
    const out = [[]];
    for (const each of band) {
      if (each.every(Number.isFinite)) out.at(-1).push(each);
      else if (out.at(-1).length) out.push([]);
    }
    return out.filter((run) => run.length > 1);
  }

  function measured() {
    const [low, high] = map.measured_speed.map((v) => up(kept(v)));
    const sides = map.measured_temperature ? map.measured_temperature.map(across) : [frame.left, frame.right];
    return [Math.max(sides[0], frame.left), high, Math.min(sides[1], frame.right), low];
  }

  function drawHatch(inside) {
    const [x, y, x2, y2] = measured(), { left, top, right, bottom } = frame;
    const d = `M${left} ${top}H${right}V${bottom}H${left}Z` + (x2 > x && y2 > y ? `M${x} ${y}V${y2}H${x2}V${y}Z` : "");
    svg("path", { d, fill: `url(#${named})`, "fill-rule": "evenodd" }, inside);
  }

  // Lines of constant torque in steady sliding, from the torques of the map.
  function drawTorques(inside) {
    const rising = map.torque.map((row, i) => row.filter((_, j) => map.speed[j] >= (map.transition[i] ?? Infinity)));
    const all = rising.flat();
    if (!all.length) return [];
    const low = Math.min(...all), high = Math.min(Math.max(...all), map.torque_limit ?? Infinity);
    const [scale, unit] = torqueUnit();
    if (!(high > low)) return [];
    const step = ticks(0, scale * (high - low), 6)[1];
    const lines = [];
    for (let k = Math.ceil(scale * low / step); k * step < scale * high; k += 1) {
      const speeds = map.torque.map((row, i) => crossing(row, map.transition[i] ?? Infinity, k * step / scale));
      const points = line(hot ? speeds : [speeds[0], speeds[0]]);
      const d = shape.path(points);
      if (!d.includes("L")) continue;
      svg("path", { d, class: "torque" }, inside);
      lines.push([digits(k * step), points.filter(([x, y]) => Number.isFinite(x) && y > frame.top && y < frame.bottom)]);
    }
    if (lines.length) lines[0][0] += ` ${unit}`;
    return lines;
  }

  function crossing(row, from, torque) {
    for (let j = 1; j < row.length; j += 1) {
      if (map.speed[j - 1] >= from && row[j - 1] <= torque && row[j] > torque) {
        return map.speed[j - 1] * (map.speed[j] / map.speed[j - 1]) ** (Math.log(torque / row[j - 1]) / Math.log(row[j] / row[j - 1]));
      }
    }
    return NaN;
  }

  function drawLines(inside) {
    const draw_line = (values, name) => svg("path", { d: shape.path(line(values)), class: name }, inside);
    const [low, high, vLow, vHigh] = intervals;
    const band = [...columns.map((x, i) => [across(x), up(kept(low[i]))]), ...columns.map((x, i) => [across(x), up(kept(high[i]))]).reverse()];
    const faint = changed ? " lags" : "";
    svg("path", { d: `${shape.path(band)}Z`, class: `interval${faint}` }, inside);
    const beyond_bend = (edge) => edge.map((v, i) => (v > 1.01 * high[i] ? v : NaN));
    for (const end of edges.folds ? [vLow, vHigh] : []) draw_line(beyond_bend(end), `fold-interval${faint}`);
    for (const edge of [below, above]) draw_line(edge.map((v) => v || NaN), "stall-edge");
    const lags = lagging ? " lags" : "";
    draw_line(edges.upper.map((v, i) => (v > 1.01 * edges.transition[i] ? v : NaN)), `fold${lags}`);
    draw_line(edges.transition, `transition${lags}`);
    if (map.speed_limit !== null && map.speed_limit < fastest) draw_line(columns.map(() => map.speed_limit), "limit");
  }

  function drawAxes() {
    const { left, right, top, bottom } = frame;
    tickWords = [];
    svg("text", { x: 0, y: 12, class: "axis" }, picture, "Drive speed (mm/s)");
    svg("text", { x: right + 34, y: 12, "text-anchor": "end", class: "axis" }, picture, "rpm");
    for (const value of logTicks(1e3 * slowest, 1e3 * fastest)) {
      const y = up(value / 1e3);
      svg("path", { d: `M${left} ${y}h-4`, class: "tick" }, picture);
      tickWords.push([null, y, svg("text", { x: left - 7, y: y + 4, "text-anchor": "end", class: "ticks" }, picture, digits(value, 4))]);
    }
    for (const value of logTicks(rpm * slowest, rpm * fastest)) {
      const y = up(value / rpm);
      svg("path", { d: `M${right} ${y}h4`, class: "tick" }, picture);
      svg("text", { x: right + 7, y: y + 4, class: "ticks" }, picture, digits(value, 4));
    }
    if (!hot) {
      const words = "all temperatures of the log";
      svg("text", { x: (left + right) / 2, y: bottom + 18, "text-anchor": "middle", class: "axis" }, picture, words);
      return;
    }
    for (const value of ticks(celsius(columns[0]), celsius(columns.at(-1)), frame.width / 90)) {
      const x = across(value + 273.15);
      svg("path", { d: `M${x} ${bottom}v4`, class: "tick" }, picture);
      tickWords.push([x, null, svg("text", { x, y: bottom + 16, "text-anchor": "middle", class: "ticks" }, picture, digits(value, 4))]);
    }
    svg("text", { x: (left + right) / 2, y: bottom + 31, "text-anchor": "middle", class: "axis" }, picture, "Temperature (°C)");
  }

  function drawKey() {
    const words = [];
    const entry = (kind, text) => words.push([kind, text]);
    const draw_entry = ([kind, text]) => {
      const item = add(key, "li"), sample = svg("svg", { viewBox: "0 0 26 12", "aria-hidden": "true" }, item);
      if (kind === "measured" || kind.startsWith("zone")) svg("rect", { x: 2.5, y: 1.5, width: 20, height: 9, class: kind }, sample);
      else if (kind === "hatched") svg("rect", { x: 1, y: 0, width: 24, height: 12, fill: `url(#${named})` }, sample);
      else svg("path", { d: "M1 6h24", class: kind }, sample);
      item.append(text);
      explained(item, { transition: "transition", fold: "V*" }[kind]);
    };
    const valued = (values) => {
      if (!setting && hot) return "";
      const value = millimetres(valueAt(values, setting?.temperature ?? 0));
      return ` ${digits(value, value >= 100 ? 3 : 2)} mm/s`;
    };
    entry("transition", `transition${valued(edges.transition)}`);
    if (!edges.folds) entry("fold", "V*: not computed for this closure");
    else if (edges.upper.some((v, i) => v > 1.01 * edges.transition[i])) entry("fold", `V*${valued(edges.upper)}${setting && hot ? ` at ${celsius(setting.temperature).toFixed(0)} °C` : ""}`);
    if (edges.folds && intervals[3].some((v, i) => v > 1.01 * intervals[1][i])) {
      entry("fold-interval", changed ? "95 % interval as reported" : "95 % interval");
    }
    entry("torque", "drag torque");
    entry("measured", "measured");
    entry("hatched", "extrapolated");
    for (const [name, word] of unnamed) entry(`zone ${name}`, word);
    const same = words.join();
    if (keyed === same) return;
    keyed = same;
    key.replaceChildren();
    words.forEach(draw_entry);
  }

  // A value of an edge at the temperature of the setting, between two columns.
  function valueAt(values, kelvin) {
    const i = Math.min(Math.max(columns.findIndex((x) => x >= kelvin), 1), columns.length - 1);
    const share = hot ? Math.min(Math.max((kelvin - columns[i - 1]) / (columns[i] - columns[i - 1]), 0), 1) : 0;
    return values[i - 1] * (values[i] / values[i - 1]) ** share;
  }

  function drawTable() {
    for (const old of figures.querySelectorAll(".wide")) old.remove();
    const every = Math.max(1, Math.round((columns.length - 1) / 10));
    const rows = columns.map((_, i) => i).filter((i) => (hot ? i % every === 0 : i === 0));
    const value = (v) => (Number.isFinite(v) ? digits(millimetres(v)) : Number.isNaN(v) ? "not computed" : "never");
    const range = (i, low, high) => `${value(intervals[low][i])} to ${value(intervals[high][i])}`;
    const known = map.torque_limit !== null;
    const heads = ["Sticks below", "Transition", "95 % as reported", "Smooth above V*", "95 % as reported", known ? "Stall from" : "Stall"].map((head, i) => (i < 5 || known ? `${head} (mm/s)` : head));
    table(figures, [...(hot ? ["°C"] : []), ...heads], rows.map((i) => [
      ...(hot ? [celsius(columns[i]).toFixed(0)] : []), value(edges.lower[i]), value(edges.transition[i]), range(i, 0, 1),
      value(edges.upper[i]), range(i, 2, 3), map.torque_limit === null ? "unknown" : edges.starts[i] ? value(above[i]) : "not started"]),
    [0, 1, 2, 3, 4, 5, 6]);
  }

  figures.addEventListener("toggle", () => { if (figures.open) drawTable(); });
  new ResizeObserver(() => { if (!printing && frame && place.clientWidth !== frame.right + 34) draw(); }).observe(place);
  addEventListener("beforeprint", () => { printing = true; draw(); });
  addEventListener("afterprint", () => { printing = false; draw(); });
  draw();
  document.fonts?.ready.then(draw);

  return {
    hint,
    // The setting tried: speed (m/s), temperature (K) and the word of its zone.
    show(tried) {
      setting = tried;
      ring?.draw(setting, frame, tickWords);
      drawKey();
    },
    // Edges of another machine, at the temperatures of the map; null for those of the report. Without `folds` it is
    // not known from which speed on it slides from any start.
    edges(other, folds = true) {
      edges = other ? {
        lower: wide(other.lower), transition: wide(other.transition), folds,
        upper: folds ? wide(other.upper) : columns.map(() => NaN), starts: wide(other.holding).map((force) => force <= (map.torque_limit ?? Infinity) / map.roll_radius),
      } : given;
      changed = Boolean(other);
      lagging = false;
      draw();
    },
    lag() {
      if (lagging) return;
      lagging = true;
      for (const each of picture.querySelectorAll(".zone, .transition, .fold, .word")) each.classList.add("lags");
    },
  };
}
