// Ages with another torque limit, coldest start or duty. All combinations were computed before; the page only chooses
// one. Exposes `otherUses(parent, uses)`; ages with the values of the machine file are beside it.

const otherUses = (() => {
  const LEFT = 66, RIGHT = 14, TOP = 20, ROW = 22;
  const celsius = (kelvin) => `${digits(kelvin - 273.15)} °C`;
  function span({ value, low, high }, scale = 1) {
    if (value === null) return low === null ? "not reached" : `later than ${aged(low * scale)}`;
    return `${aged(value * scale)} [${aged(low * scale)}, ${high === null ? "no upper limit" : aged(high * scale)}]`;
  }

  // The chosen use, from the address and back into it.
  function read(uses, start) {
    const given = new URLSearchParams(location.hash.startsWith("#use?") ? location.hash.slice(5) : "");
    const index = (name, list, fallback) => {
      const at = Number(given.get(name));
      return given.has(name) && Number.isInteger(at) && at >= 0 && at < list.length ? at : fallback;
    };
    return {
      limit: index("limit", uses.torque_limits, start.limit), cold: index("cold", uses.coldest, start.cold),
      duty: index("duty", uses.duties, start.duty), day: given.get("day") ?? "",
    };
  }
  function address(chosen, start) {
    const parts = Object.entries(chosen).filter(([name, value]) => value !== (start[name] ?? ""));
    return parts.length ? `#use?${new URLSearchParams(parts)}` : "";
  }

  return function otherUses(parent, uses) {
    const limits = Math.max(uses.torque_limits.length, 1);
    const place = ({ limit, cold, duty }) => (cold * uses.duties.length + duty) * limits + limit;
    const stated = uses.uses.findIndex((use) => use.stated);
    const start = { limit: stated % limits, duty: Math.floor(stated / limits) % uses.duties.length, cold: Math.floor(stated / limits / uses.duties.length), day: "" };
    const chosen = read(uses, start);
    const own = uses.uses[stated];
    const unit = uses.age_unit || "units of age";
    const box = parent;
    const head = add(box, "div", "", "cap");
    add(head, "h2", "Try another limit");
    const hint = add(head, "span", "", "hint");
    const refresh = [];

    function control(label, name, make) {
      const row = add(box, "div", "", "use-row");
      const mark = add(row, "span", "", "differs");
      const text = add(row, "label", label);
      text.htmlFor = `use-${name}`;
      make(row).id = `use-${name}`;
      refresh.push(() => { mark.textContent = chosen[name] !== (start[name] ?? "") ? "◆" : ""; mark.title = mark.textContent ? "differs from the machine file" : ""; });
    }
    const words = {
      limit: (at) => `${digits(uses.torque_limits[at])} N·m`, cold: (at) => celsius(uses.coldest[at]), duty: (at) => uses.duties[at] === "as stated" ? "as stated" : `only ${uses.duties[at]}`,
    };
    function steps(label, name, count) {
      control(label, name, (row) => {
        const range = add(row, "input");
        Object.assign(range, { type: "range", min: 0, max: count - 1, step: 1, value: chosen[name] });
        const shown = add(row, "output", "", "u");
        range.addEventListener("input", () => { chosen[name] = Number(range.value); draw(); });
        refresh.push(() => { range.value = chosen[name]; shown.textContent = words[name](chosen[name]); range.setAttribute("aria-valuetext", shown.textContent); });
        return range;
      });
    }
    if (uses.torque_limits.length) steps("Motor torque limit", "limit", uses.torque_limits.length);
    if (uses.coldest.length) steps("Coldest start", "cold", uses.coldest.length);
    if (uses.duties.length > 1) {
      control("Duty", "duty", (row) => {
        const list = add(row, "select");
        uses.duties.forEach((_, at) => { add(list, "option", words.duty(at)).value = at; });
        list.addEventListener("change", () => { chosen.duty = Number(list.value); draw(); });
        refresh.push(() => { list.value = chosen.duty; });
        return list;
      });
    }
    control(`${unit[0].toUpperCase()}${unit.slice(1)} per day`, "day", (row) => {
      const field = add(row, "input");
      Object.assign(field, { type: "text", inputMode: "decimal", placeholder: "optional" });
      const said = add(row, "span", "", "u");
      said.setAttribute("role", "status");
      field.addEventListener("input", () => { chosen.day = field.value.trim(); draw(); });
      refresh.push(() => {
        if (document.activeElement !== field) field.value = chosen.day;
        const wrong = chosen.day !== "" && !(perDay() > 0);
        said.textContent = wrong ? "Type a number above 0, e.g. 500" : "";
        if (wrong) field.setAttribute("aria-invalid", "true");
        else field.removeAttribute("aria-invalid");
      });
      return field;
    });
    const perDay = () => (/^\d+([.,]\d+)?$/.test(chosen.day) ? Number(chosen.day.replace(",", ".")) : NaN);

    const verdict = add(box, "p", "", "use-verdict");
    verdict.setAttribute("aria-live", "polite");
    const changed = add(box, "div");
    const figure = add(changed, "div", "", "chart");
    figure.id = "chart-uses";
    const held = add(fold(changed, "Data"), "div");
    const toml = add(changed, "pre", "", "mono");
    toml.id = "use-toml";
    const foot = add(changed, "div", "", "foot");
    button(foot, "Link", (from) => copy(location.href.split("#")[0] + address(chosen, start), from));
    button(foot, "TOML", (from) => copy(toml.textContent, from));
    button(foot, "Reset", () => { Object.assign(chosen, start); draw(); });

    function lines() {
      const out = [];
      if (uses.torque_limits.length) out.push("[limits]", `motor_torque = "${uses.torque_limits[chosen.limit]} N*m"`);
      if (uses.coldest.length) out.push("[life]", `coldest = "${Number((uses.coldest[chosen.cold] - 273.15).toFixed(4))} degC"`);
      if (chosen.duty) out.push(`# [[points]]: share = "100 %" for ${uses.duties[chosen.duty]}, "0 %" for the others`);
      return out.join("\n");
    }

    function picture(use, width) {
      const rows = use.ends.length;
      const end = 1.05 * Math.max(...[own, use].flatMap((each) => each.ends).map(({ age }) => age.high ?? 2 * (age.low ?? 0)).filter(Number.isFinite), 1);
      const height = TOP + rows * ROW + 34;
      const x = (age) => LEFT + (Math.min(age, end) / end) * (width - LEFT - RIGHT);
      const words = use.ends.map(({ name, age }) => `${name} ${span(age)}`).join("; ");
      const drawing = svg("svg", { width, height, role: "img", "aria-label": `First failure of each specimen, ${unit}: ${words}` });
      for (const tick of ticks(0, end, 5)) {
        svg("line", { x1: x(tick), x2: x(tick), y1: TOP, y2: height - 30, stroke: "var(--rule)" }, drawing);
        svg("text", { x: x(tick), y: height - 15, "text-anchor": "middle", class: "tl" }, drawing, aged(tick));
      }
      svg("text", { x: 0, y: 12 }, drawing, use === own ? `First failure (${unit})` : `First failure (${unit}); hollow: machine file`);
      use.ends.forEach(({ name, age }, i) => {
        const y = TOP + (i + 0.5) * ROW;
        svg("text", { x: LEFT - 8, y: y + 4, "text-anchor": "end" }, drawing, name);
        const bar = (each, lift, filled) => {
          if (each.low === null) return;
          svg("line", { x1: x(each.low), x2: x(each.high ?? end), y1: y + lift, y2: y + lift, stroke: filled ? "var(--accent)" : "var(--edge)", "stroke-width": filled ? 2 : 1 }, drawing);
          if (each.value !== null) svg("circle", { cx: x(each.value), cy: y + lift, r: 4, fill: filled ? "var(--accent)" : "var(--ground)", stroke: filled ? "var(--accent)" : "var(--edge)" }, drawing);
        };
        const before = own.ends.find((each) => each.name === name);
        if (before && use !== own) bar(before.age, 5, false);
        bar(age, use === own ? 0 : -3, true);
      });
      for (const inner of drawing.children) inner.setAttribute("aria-hidden", "true");
      return drawing;
    }

    // What other values or a number of pages a day change, in a sentence; nothing as the machine file states.
    function said(use, day) {
      if (!use.ends.length) return "No failure mode can be followed under these conditions.";
      if (use === own && !(day > 0)) return "";
      const first = (each) => each.b50 ?? each.ends.map(({ age }) => age).sort((a, b) => (a.value ?? Infinity) - (b.value ?? Infinity))[0];
      const days = day > 0 ? `${span(first(use), 1 / day)} days at ${aged(day)} ${unit} a day` : "";
      const ages = use === own ? "" : `${span(first(use))} ${unit}`;
      const at = first(use).value === null ? "" : use === own ? "after " : "by ";
      return `${use.b50 ? "Half of new specimens fail" : "The first specimen fails"} ${at}${[ages, days].filter(Boolean).join(", ")}.`;
    }

    function draw() {
      const use = uses.uses[place(chosen)];
      refresh.forEach((each) => each());
      const day = perDay();
      verdict.textContent = said(use, day);
      verdict.hidden = verdict.textContent === "";
      changed.hidden = address(chosen, start) === "";
      figure.replaceChildren(picture(use, Math.max(figure.clientWidth, 300)));
      held.replaceChildren();
      const heads = ["Specimen", `First failure (${unit})`, ...(day > 0 ? ["Days"] : []), "Failure mode"];
      table(held, heads, use.ends.map(({ name, age, ways }) => [name, span(age), ...(day > 0 ? [span(age, 1 / day)] : []), ways]), day > 0 ? [1, 2] : [1], { name: "ages" });
      toml.textContent = lines();
      hint.textContent = address(chosen, start) === "" ? "as in the machine file" : "◆ differs from the machine file";
      history.replaceState(null, "", address(chosen, start) || location.pathname + location.search);
    }
    addEventListener("resize", draw);
    addEventListener("hashchange", () => { if (location.hash.startsWith("#use?")) { Object.assign(chosen, read(uses, start)); draw(); } });
    draw();
  };
})();
