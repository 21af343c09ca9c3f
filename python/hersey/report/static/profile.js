// A profile of the drive's speed: drawn by hand into the chart, moved at its handles, or written into a table.

function profile(place, chart, { change, leave, written, refused }) {
  const box = add(place, "div", "", "profile");
  box.hidden = true;
  box.id = "profile";
  const line = add(box, "div", "", "foot");
  const draws = button(line, "Draw by hand", () => arm(!armed));
  draws.setAttribute("aria-pressed", "false");
  button(line, "Add a row", () => { const [t, v] = rows.at(-1); emit([...rows, [t + 0.2, v]]); });
  button(line, "Save CSV", () => save("profile.csv", written(rows), "text/csv"));
  button(line, "Remove profile", () => leave());
  add(box, "p", "Straight lines between rows; the last speed is held.", "hint");
  const cells = add(box, "div", "", "rows");
  cells.setAttribute("role", "group");
  cells.setAttribute("aria-label", "Rows of the profile");
  let rows = null, armed = false, sheet = null, points = null; // points of what is being drawn by hand
  const neat = ([t, v]) => [Math.round(t * 1000) / 1000, Number(v.toPrecision(3))];
  const emit = (next) => change(next.map(neat));

  function fields() {
    cells.replaceChildren();
    add(cells, "span", "Time (s)", "hint");
    add(cells, "span", "Speed (mm/s)", "hint");
    add(cells, "span", "", "hint");
    rows.forEach((row, i) => {
      for (const [column, scale, name] of [[0, 1, "time in s"], [1, 1e3, "speed in mm/s"]]) {
        const field = add(cells, "input", "", "value");
        Object.assign(field, { type: "text", inputMode: "decimal", value: String(Number((row[column] * scale).toPrecision(6))) });
        field.setAttribute("aria-label", `Row ${i + 1}, ${name}`);
        field.addEventListener("change", () => {
          const typed = Number(field.value.trim().replace(",", "."));
          const next = rows.map((each, j) => (j === i ? each.with(column, typed / scale) : each));
          const fits = field.value.trim() !== "" && sound(next);
          field.setAttribute("aria-invalid", String(!fits));
          if (fits) change(next);
          else refused("Times must rise from 0, and the last speed must be above 0");
        });
      }
      const drop = button(cells, "Remove", () => emit(rows.filter((_, j) => j !== i)));
      drop.setAttribute("aria-label", `Remove row ${i + 1}`);
      drop.disabled = rows.length < 2 || (i === rows.length - 1 && !(rows[i - 1][1] > 0));
    });
  }
  const sound = (next) => next.every(([t, v], i) => Number.isFinite(t) && Number.isFinite(v) && t >= 0 && v >= 0 && (i === 0 || t >= next[i - 1][0]))
    && next.at(-1)[1] > 0;

  function arm(on) {
    armed = on;
    draws.setAttribute("aria-pressed", String(on));
    handles();
  }
  // Handles in the chart; while drawing by hand, a sheet over it instead.
  function handles() {
    if (points) return; // an answer that comes meanwhile must not take the sheet away
    const active = document.activeElement?.dataset?.row;
    chart.over.replaceChildren();
    sheet = null;
    const scales = chart.scales();
    if (!rows || !scales) return;
    if (armed) { paper(scales); return; }
    rows.forEach(([t, v], i) => {
      if (t > scales.t.end) return;
      const handle = svg("g", { class: "handle", tabindex: 0, role: "slider", "data-row": i,
        transform: `translate(${scales.t(t)} ${scales.y(Math.min(v, scales.top))})`,
        "aria-label": `Row ${i + 1} of the profile`, "aria-valuemin": 0, "aria-valuemax": digits(1e3 * scales.top), "aria-valuenow": digits(1e3 * v),
        "aria-valuetext": `${digits(1e3 * v)} mm/s at ${digits(t)} s` }, chart.over);
      svg("circle", { r: 14, class: "reach" }, handle);
      svg("circle", { r: 4.5, class: "round" }, handle);
      handle.addEventListener("keydown", (event) => {
        const times = event.shiftKey ? 10 : 1;
        const later = 0.01 * times, faster = 1.02 ** times;
        const keys = { ArrowLeft: [-later, 1], ArrowRight: [later, 1], ArrowUp: [0, faster], ArrowDown: [0, 1 / faster] };
        const [dt, factor] = keys[event.key] ?? [];
        if (dt === undefined) return;
        event.preventDefault();
        move(i, t + dt, v === 0 && factor > 1 ? 0.001 : v * factor);
      });
      handle.addEventListener("pointerdown", (event) => {
        event.preventDefault();
        const follow = (moved) => move(i, ...chart.at(moved));
        const stop = () => {
          removeEventListener("pointermove", follow);
          for (const end of ["pointerup", "pointercancel"]) removeEventListener(end, stop);
        };
        addEventListener("pointermove", follow);
        for (const end of ["pointerup", "pointercancel"]) addEventListener(end, stop);
      });
      handle.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
      if (active === String(i)) handle.focus({ preventScroll: true });
    });
  }
  function move(i, t, v) {
    const least = i ? rows[i - 1][0] : 0, most = i + 1 < rows.length ? rows[i + 1][0] : Infinity;
    const row = [Math.min(Math.max(t, least), most), i === rows.length - 1 ? Math.max(v, 0.001) : v];
    emit(rows.map((each, j) => (j === i ? row : each)));
  }
  function paper(scales) {
    const left = scales.t(0);
    sheet = svg("rect", { x: left, y: 0, width: scales.right - left, height: scales.bottom, class: "sheet drawing" }, chart.over);
    const line_drawn = svg("path", { class: "drive" }, chart.over);
    sheet.addEventListener("pointerdown", (event) => {
      points = [[0, chart.at(event)[1]], chart.at(event)];
      sheet.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    sheet.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
    sheet.addEventListener("pointermove", (event) => {
      if (!points) return;
      const [t, v] = chart.at(event);
      if (t > points.at(-1)[0]) points.push([t, v]);
      line_drawn.setAttribute("d", shape.path(points.map(([a, b]) => [scales.t(a), scales.y(b)])));
    });
    sheet.addEventListener("pointerup", () => {
      const drawn = points && points.length > 2 ? simpler(points, scales) : null;
      points = null;
      if (!drawn) return;
      drawn[drawn.length - 1][1] = Math.max(drawn.at(-1)[1], 0.001);
      arm(false);
      emit(drawn);
    });
    sheet.addEventListener("pointercancel", () => { points = null; handles(); });
  }
  // The fewest rows within 3 pixels of what was drawn.
  function simpler(points, scales) {
    const [a, b] = [points[0], points.at(-1)], off = ([t, v]) => {
      const share = b[0] > a[0] ? (t - a[0]) / (b[0] - a[0]) : 0;
      return Math.abs(scales.y(v) - scales.y(a[1] + share * (b[1] - a[1])));
    };
    let worst = 0;
    points.forEach((point, i) => { if (off(point) > off(points[worst])) worst = i; });
    if (worst === 0 || worst === points.length - 1 || off(points[worst]) < 3) return [[...a], [...b]];
    return [...simpler(points.slice(0, worst + 1), scales).slice(0, -1), ...simpler(points.slice(worst), scales)];
  }
  return {
    box,
    show(next) {
      const same = rows && next && JSON.stringify(rows) === JSON.stringify(next);
      rows = next;
      box.hidden = !rows;
      if (!rows) armed = false;
      if (rows && !same && !cells.contains(document.activeElement)) fields();
      else if (rows && !same) refresh();
      handles();
    },
  };
  // The values of the fields, where one of them has the focus.
  function refresh() {
    const inputs = cells.querySelectorAll("input");
    if (inputs.length !== 2 * rows.length) { fields(); return; }
    rows.flat().forEach((value, i) => { inputs[i].value = String(Number((value * (i % 2 ? 1e3 : 1)).toPrecision(6))); });
  }
}
