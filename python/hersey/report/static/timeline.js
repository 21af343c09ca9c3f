// The log in one figure: the dwells used, then speed, torque and temperature on one axis of time with one cursor.

const ROW = 82;
const ROW_ON_PAPER = 56;
const BETWEEN = 12;
function timeline(parent, says) {
  const { speed, torque, temperature, starts } = data.timeline;
  const [factor, unit] = torqueUnit();
  const rows = [
    { name: "Speed", unit: SPEED_UNIT, time: speed.time, value: speed.value.map((each) => each * PER_SPEED) },
    { name: capital(measured), unit, time: torque.time, value: torque.value.map((each) => each * factor) },
    ...(temperature ? [{ name: "Temp.", unit: "°C", time: temperature.time, value: temperature.value.map(celsius) }] : []),
  ];
  const first = Math.min(...rows.map((row) => row.time[0]));
  const last = Math.max(...rows.map((row) => row.time.at(-1)));
  const figure = add(parent, "figure", "", "fig");
  figure.id = "timeline";
  add(figure, "h3", "The log");
  const place = add(figure, "div", "", "chart");
  add(figure, "p", `${moving ? "" : "Green: used; red: stick-slip."}${starts.length > 1 ? " Files follow one another." : ""} Arrow keys read values.`, "note");
  const read = add(figure, "p", "", "sr-only");
  read.setAttribute("aria-live", "polite");

  let at = null;
  const left = 38;
  const top = moving ? 8 : 36;
  const draw = (width) => {
    const rowHeight = onPaper ? ROW_ON_PAPER : ROW;
    const right = width - 6;
    const x = (time) => left + ((time - first) / (last - first || 1)) * (right - left);
    const root = svg("svg", { width, role: "img", "aria-label": `The log: speed, ${measured} and temperature against time. ${says}` });
    if (!moving) strip(root, x, left, right);
    const scales = rows.map((row, i) => {
      const floor = top + i * (rowHeight + BETWEEN) + rowHeight;
      let [low, high] = [Math.min(...row.value), Math.max(...row.value)];
      const pad = 0.06 * (high - low || Math.abs(high) || 1);
      [low, high] = [low - (low < 0 || low > 0.3 * high ? pad : 0), high + pad];
      if (low > 0 && low < 0.35 * high) low = 0;
      const y = (value) => floor - ((value - low) / (high - low)) * rowHeight;
      for (const each of ticks(low, high, 3)) {
        svg("line", { x1: left, x2: right, y1: y(each), y2: y(each), class: "grid" }, root);
        svg("text", { x: left - 6, y: y(each) + 4, class: "tl", "text-anchor": "end" }, root, digits(each, 4));
      }
      svg("path", { d: `M${left} ${floor}H${right}M${left} ${floor}V${floor - rowHeight}`, class: "axis" }, root);
      let path = "";
      row.time.forEach((time, k) => { path += `${k && !starts.some((start, n) => n && row.time[k - 1] < start && time >= start) ? "L" : "M"}${x(time).toFixed(1)} ${y(row.value[k]).toFixed(1)}`; });
      svg("path", { d: path, class: "trace thin" }, root);
      svg("text", { x: left + 6, y: floor - rowHeight + 12, class: "strong" }, root, row.unit ? `${row.name} (${row.unit})` : row.name);
      return { floor, y };
    });
    const bottom = scales.at(-1).floor;
    for (const each of ticks(first, last, width > 600 ? 9 : 4)) {
      svg("path", { d: `M${x(each)} ${bottom}v4`, class: "axis" }, root);
      svg("text", { x: x(each), y: bottom + 16, class: "tl", "text-anchor": "middle" }, root, digits(each, 6));
    }
    svg("text", { x: (left + right) / 2, y: bottom + 31, class: "tl", "text-anchor": "middle" }, root, "Time (s)");
    root.setAttribute("height", bottom + 36);
    root.setAttribute("viewBox", `0 0 ${width} ${bottom + 36}`);
    const cursor = svg("g", { class: "cursor" }, root);
    const move = () => {
      cursor.replaceChildren();
      if (at === null) return;
      const to = x(at);
      svg("line", { x1: to, x2: to, y1: top - 22, y2: bottom }, cursor);
      const words = rows.map((row, i) => {
        const value = row.value[nearest(row.time, at)];
        const text = `${digits(value, 3)} ${row.unit}`.trim();
        tag(cursor, to, scales[i].floor - rowHeight + 2, text, right);
        return `${row.name} ${text}`;
      });
      tag(cursor, to, bottom + 4, `${digits(at, 4)} s`, right);
      read.textContent = `${digits(at, 4)} s: ${words.join(", ")}`;
    };
    root.addEventListener("pointermove", (event) => {
      const place_ = root.getBoundingClientRect();
      const share = ((event.clientX - place_.left) * width / place_.width - left) / (right - left);
      at = first + Math.min(1, Math.max(0, share)) * (last - first);
      move();
    });
    root.addEventListener("pointerleave", () => { if (document.activeElement !== place) { at = null; move(); } });
    place.onkeydown = (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!by) return;
      event.preventDefault();
      at = Math.min(last, Math.max(first, (at ?? (first + last) / 2) + by * (event.shiftKey ? 0.05 : 0.005) * (last - first)));
      move();
    };
    for (const inner of root.children) inner.setAttribute("aria-hidden", "true");
    place.replaceChildren(root);
    move();
  };
  place.tabIndex = 0;
  place.setAttribute("role", "group");
  place.setAttribute("aria-label", "The log: arrow keys move the cursor");
  atWidth(place, draw);
  return figure;
}
// Redraw our own drawings where their place gets another width, and for paper.
function atWidth(place, draw) {
  let known = 0;
  const again = (width) => {
    if (width > 0 && width !== known) { known = width; draw(width); }
  };
  again(Math.round(place.clientWidth));
  new ResizeObserver(() => again(Math.round(place.clientWidth))).observe(place);
  addEventListener("beforeprint", () => again(paperWidth(place)));
  addEventListener("afterprint", () => again(Math.round(place.clientWidth)));
}
function nearest(times, at) {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] > at) high = middle; else low = middle;
  }
  return at - times[low] < times[high] - at ? low : high;
}
// The values at the cursor, on the side where there is room.
function tag(parent, x, y, text, right) {
  const width = 7.2 * text.length + 8;
  const from = x + width + 4 > right ? x - width - 4 : x + 4;
  svg("rect", { x: from, y, width, height: 16, rx: 2 }, parent);
  svg("text", { x: from + width / 2, y: y + 12, "text-anchor": "middle" }, parent, text);
}
function strip(root, x, left, right) {
  const { starts } = data.timeline;
  svg("text", { x: left - 6, y: 24, class: "tl", "text-anchor": "end" }, root, "Used");
  svg("line", { x1: left, x2: right, y1: 20, y2: 20, class: "axis" }, root);
  for (const each of data.points) {
    const [from, to] = [x(starts[each.run] + each.start), x(starts[each.run] + each.end)];
    svg("rect", { x: from, y: 15, width: Math.max(1, to - from - 0.6), height: 10, class: "used" }, root);
  }
  let named = false;
  for (const each of data.quality.rejected) {
    if (each.kind !== "stick-slip") continue;
    const [from, to] = [x(starts[each.run] + each.start), x(starts[each.run] + each.end)];
    svg("rect", { x: from, y: 15, width: Math.max(2, to - from), height: 10, class: "stuck" }, root);
    if (!named) {
      const middle = (from + to) / 2;
      const anchor = middle > right - 40 ? "end" : middle < left + 40 ? "start" : "middle";
      svg("text", { x: anchor === "end" ? right : anchor === "start" ? left : middle, y: 10, class: "tl", "text-anchor": anchor }, root, "stick-slip");
    }
    named = true;
  }
}
