// Parts of the sections: numbers with intervals, a topic with its finding.

function interval(e, scale = 1, count = 3) {
  if (e.low === null || e.high === null) return `${digits(e.value * scale, count)} (interval unknown)`;
  return `${digits(e.value * scale, count)} [${digits(e.low * scale, count)}, ${digits(e.high * scale, count)}]`;
}
const bounds = (e, scale = 1, count = 3) => e.low === null || e.high === null ? "unknown" : `[${digits(e.low * scale, count)}, ${digits(e.high * scale, count)}]`;
const twoPlaces = (value) => value.toFixed(2).replace("-", "−");
const share = (part, whole) => `${digits((100 * part) / whole, 2)} %`;
const NUMBERS = ["no", "one", "two", "three", "four", "five", "six"];
const plural = (count, word, words = `${word}s`) => `${NUMBERS[count] ?? count} ${count === 1 ? word : words}`;
const capital = (text) => `${text.slice(0, 1).toUpperCase()}${text.slice(1)}`;
const noun = data.part; // what slides
const radius = data.map?.roll_radius ?? null;
// A rotational speed, where it slides if the radius is known.
const rolled = (speed) => radius === null ? `${digits(speed * PER_SPEED, 2)} ${SPEED_UNIT}` : `${digits(1e3 * speed * radius, 2)} mm/s`;
const whole = (kelvin) => data.fit.temperature_scale === "K" ? degrees(kelvin) : `${Math.round(celsius(kelvin))} °C`;

// A section with its topic and its finding; listed in the contents.
const made = [];
function section(parent, id, topic, finding) {
  const element = add(parent, "section");
  element.id = id;
  element.setAttribute("aria-labelledby", `${id}-topic`);
  add(element, "h2", topic).id = `${id}-topic`;
  if (finding) add(element, "p", pretty(finding), "finding");
  made.push({ id, topic, element });
  return element;
}
// Warnings in sight, and in a fold with their count the notes and what is `elsewhere` on the page.
function warnings(parent, all, { heading, folded, elsewhere = () => false, id = "" }) {
  const minor = all.filter((each) => each.severity === "note" || elsewhere(each)), major = all.filter((each) => !minor.includes(each));
  const box = add(parent, "div", "", "listed");
  if (id) box.id = id;
  if (major.length) {
    add(box, "h3", heading);
    checks(box, major.map((each) => [each.severity, warned(each)]));
  }
  if (!minor.length) return;
  const list = add(fold(box, `${folded} (${minor.length})`), "ul", "", "checks plain");
  for (const each of minor) add(list, "li", warned(each));
}
