// The ring: the setting tried, with its values as tags on both axes of the map. Only it takes a drag; everything else
// scrolls.

function mapRing(drawing, { map, hot, columns, slowest, fastest, across, up, speedAt, columnAt, kept, place_of }, move) {
  const inCelsius = (kelvin) => kelvin - 273.15, inMillimetres = (speed) => 1e3 * speed;
  let setting = null, frame = null;
  const ring = held();

  function held() {
    const group = svg("g", { class: "tried" }, drawing);
    const parts = {
      across: svg("path", { class: "lead" }, group), down: svg("path", { class: "lead" }, group),
      speed: svg("g", { class: "tag", "aria-hidden": "true" }, group), temperature: svg("g", { class: "tag", "aria-hidden": "true" }, group),
    };
    for (const tag of [parts.speed, parts.temperature]) {
      svg("rect", { width: 34, height: 16, rx: 2 }, tag);
      svg("text", { x: 17, y: 12, "text-anchor": "middle" }, tag);
    }
    const handle = svg("g", { class: "ring", tabindex: 0, role: "slider", "aria-label": "Setting tried: drive speed and temperature",
      "aria-orientation": "vertical", "aria-valuenow": 0,
      "aria-valuemin": digits(inMillimetres(slowest)), "aria-valuemax": digits(inMillimetres(fastest)) }, group);
    svg("circle", { r: 22, class: "reach" }, handle);
    svg("circle", { r: 9, class: "round" }, handle);
    svg("circle", { r: 3, class: "dot" }, handle);
    let from = null;
    handle.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX - across(column()), y: event.clientY - up(kept(setting.speed)) };
      handle.setPointerCapture(event.pointerId);
      handle.focus({ preventScroll: true });
      event.preventDefault();
    });
    handle.addEventListener("pointermove", (event) => {
      if (!from) return;
      const speed = kept(speedAt(event.clientY - from.y)), x = columnAt(event.clientX - from.x);
      moved(Number(speed.toPrecision(3)), Math.round(inCelsius(x)) + 273.15);
    });
    handle.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => { from = null; });
    handle.addEventListener("keydown", (event) => {
      const times = event.shiftKey ? 10 : 1;
      const step = 1.02 ** times, keys = { ArrowUp: [step, 0], ArrowDown: [1 / step, 0], ArrowLeft: [1, -times], ArrowRight: [1, times] };
      const [factor, kelvin] = keys[event.key] ?? [];
      if (factor === undefined) return;
      event.preventDefault();
      moved(setting.speed * factor, (setting.temperature ?? 0) + kelvin);
    });
    return { ...parts, handle };
  }
  function moved(speed, kelvin) {
    const within_map = Math.min(Math.max(kelvin, columns[0]), columns.at(-1));
    setting = { ...setting, speed: kept(speed), temperature: hot ? within_map : null };
    move(setting.speed, setting.temperature);
  }
  function column() {
    if (hot) return Math.min(Math.max(setting.temperature, columns[0]), columns.at(-1));
    const same = map.points.findIndex((point) => point.speed === setting.speed);
    return same < 0 ? 0.5 : place_of(map.points[same], same);
  }

  function draw(tried, framed, tickWords) {
    setting = tried;
    frame = framed;
    ring.handle.parentNode.setAttribute("visibility", setting ? "visible" : "hidden");
    if (!setting || !frame) return;
    const x = across(column()), y = up(kept(setting.speed));
    ring.handle.setAttribute("transform", `translate(${x} ${y})`);
    ring.across.setAttribute("d", `M${frame.left} ${y}H${x - 10}`);
    ring.down.setAttribute("d", hot ? `M${x} ${frame.bottom}V${y + 10}` : "");
    // A number of an axis half under a tag is not read.
    for (const [at, level, word] of tickWords) {
      const under = at === null ? Math.abs(level - y) < 13 : Math.abs(at - x) < 28;
      word.setAttribute("visibility", under ? "hidden" : "inherit");
    }
    ring.speed.setAttribute("transform", `translate(${frame.left - 34} ${y - 8})`);
    ring.speed.lastChild.textContent = digits(inMillimetres(setting.speed));
    ring.temperature.setAttribute("transform", `translate(${x - 17} ${frame.bottom + 4})`);
    ring.temperature.setAttribute("visibility", hot ? "inherit" : "hidden");
    if (hot) ring.temperature.lastChild.textContent = inCelsius(setting.temperature).toFixed(0);
    ring.handle.setAttribute("aria-valuenow", digits(inMillimetres(setting.speed)));
    const where = hot ? ` at ${inCelsius(setting.temperature).toFixed(0)} °C` : "";
    ring.handle.setAttribute("aria-valuetext", `${digits(inMillimetres(setting.speed))} mm/s${where}, ${setting.zone ?? "unknown"}`);
  }
  return { draw };
}
