// The page of a report: the first screen, then the sections, each with its finding. It shows the analysis
// document and its charts, and computes only units and words.

async function comparison(parent) {
  const { compare } = data;
  if (!compare) return;
  const part = section(parent, "compare", "Comparison", compare.verdict);
  await chart(part, "compare", { says: compare.verdict, note: `A: ${compare.a}; B: ${compare.b}. Bars: simultaneous 95 % limits.` });
  // A quantity that is compared as a ratio is a speed of the roll.
  const of = (c) => c.is_ratio ? [`${c.name}, rpm`, digits(c.of_a * TO_RPM), digits(c.of_b * TO_RPM)] : [c.name, digits(c.of_a), digits(c.of_b)];
  table(part, ["Quantity", compare.a, compare.b, "Change", "95 % interval", "p-value", "Real"], compare.changes.map((c) => [
    ...of(c), `${c.is_ratio ? "× " : ""}${digits(c.change.value)}`, bounds(c.change), c.p_value === null ? "–" : digits(c.p_value, 2),
    c.real ? judged("watch", "yes") : "no"]), [1, 2, 3, 4, 5], { name: "comparison", label: "What changed" });
  const all = compare.warnings.length ? fold(part, `Warnings (${compare.warnings.length})`) : part;
  compare.warnings.forEach((each) => add(all, "p", warned(each), "note"));
}
async function warmUp(parent) {
  if (!data.warm_up) return;
  const part = section(parent, "warm-up", "Warm-up", data.warm_up.verdict);
  await chart(part, "warm_up");
  data.warm_up.beside.forEach((text) => add(part, "p", pretty(text), "text"));
  checks(part, data.warm_up.warnings.map((each) => [each.severity, warned(each)]));
}
function reproduce(parent) {
  const { rest } = data.fit;
  const inputs = [...data.files, ...(data.against ?? []), ...(data.machine ? [data.machine] : []), ...(rest?.sha256 ?? []).map((sha256) => ({ name: rest.source, sha256 }))];
  const seed = data.decision?.points.find((p) => p.plan)?.plan.seed;
  const files = plural(inputs.length, "file");
  const part = section(parent, "reproduce", "Reproduce this report",
    `${data.command ? `Run this command on ${files}` : `The report was made from ${files}`}${seed === undefined ? "" : ` (random seed ${seed})`}.`);
  if (data.command) add(part, "pre", data.command).id = "command";
  const foot = add(part, "div", "", "foot");
  if (data.command) button(foot, "Copy command", (from) => copy(data.command, from));
  button(foot, "Save document (JSON)", () => save("hersey.json", document.getElementById("document").textContent, "application/json"));
  if (data.recipe) {
    const recipe = fold(part, "Recipe of the dwells (TOML)");
    recipe.className = "behind";
    add(recipe, "p", "Save it beside the files as recipe.toml and run hersey report --recipe recipe.toml.", "note hint");
    add(recipe, "pre", data.recipe.toml).id = "recipe";
    const keep = add(recipe, "div", "", "foot");
    button(keep, "Copy recipe", (from) => copy(data.recipe.toml, from));
    button(keep, "Save recipe", () => save("recipe.toml", data.recipe.toml, "text/plain"));
  }
  const all = fold(part, "Input files and hashes");
  table(all, ["File", "sha256"], inputs.map((f) => {
    const hash = document.createElement("span");
    hash.className = "mono";
    hash.textContent = f.sha256;
    hash.dataset.text = f.sha256;
    return [f.name, hash];
  }), [], { label: "Input" });
  add(all, "p", `Document schema ${data.schema_version}; intervals at 95 %.`, "note");
}

function contents(parent) {
  const list = add(parent, "ol");
  const links = made.map(({ id, topic }) => link(add(list, "li"), topic, id));
  const mark = () => {
    const current = made.findLastIndex(({ element }) => element.getBoundingClientRect().top < innerHeight / 3);
    links.forEach((each, i) => { if (i === Math.max(0, current)) each.setAttribute("aria-current", "true"); else each.removeAttribute("aria-current"); });
  };
  addEventListener("scroll", mark, { passive: true });
  mark();
}

async function main() {
  document.title = `hersey: ${data.title}`;
  titleLine();
  decision();
  await mapAndPanel();
  const grid = add(report, "div", "", "sections");
  const nav = add(grid, "nav", "", "contents");
  nav.id = "contents";
  nav.setAttribute("aria-label", "Contents");
  add(nav, "h2", "Contents");
  const parts = add(grid, "div");
  await torqueSection(parts);
  await regimeSection(parts);
  candidates(parts);
  dataSection(parts);
  await bandSection(parts);
  await planSection(parts);
  await comparison(parts);
  await warmUp(parts);
  reproduce(parts);
  contents(nav);
  linkFlags();
  if (controller) for (const press of document.querySelectorAll("[data-profile]")) press.disabled = false;
  document.getElementById("end").textContent = `hersey ${data.hersey_version}`;
}

show(main);
