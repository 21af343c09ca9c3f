// Names in the map, placed so that none covers another: points, limit, torques, and the word of each zone where it
// has the most room.

function mapNames({ map, frame, picture, edges, beyond, slowest, fastest, across, up, speedAt, columnAt, place_of, valueAt, runs }) {
  // Boxes that are occupied.
  const taken = [];
  const free = (box) => taken.every((b) => box[2] < b[0] || box[0] > b[2] || box[3] < b[1] || box[1] > b[3]);
  const within = (box) => box[0] >= frame.left + 2 && box[2] <= frame.right - 2 && box[1] >= frame.top + 2 && box[3] <= frame.bottom - 2;

  function drawPoints() {
    const shown = map.points.map((point, i) => [point, across(place_of(point, i)), up(point.speed)])
      .filter(([, x, y]) => x >= frame.left && x <= frame.right && y >= frame.top && y <= frame.bottom);
    for (const [, x, y] of shown) taken.push([x - 13, y - 13, x + 13, y + 13]);
    for (const [point, x, y] of shown) {
      const width = shape.width(point.name, 12.5, 700);
      const places = [[x - 15 - width, y], [x + 15, y], [x - width / 2, y - 20], [x - width / 2, y + 20], [x - 15 - width, y - 13],
        [x - 15 - width, y + 14], [x - 15 - width, y - 26], [x - 15 - width, y + 28], [x + 15, y - 18], [x + 15, y + 18]];
      const boxed = ([a, b]) => [a - 2, b - 7, a + width + 2, b + 7];
      const best = places.find((p) => within(boxed(p)) && free(boxed(p)));
      if (best) {
        taken.push(boxed(best));
        svg("text", { x: best[0], y: best[1] + 4.5, class: "name" }, picture, point.name);
      }
    }
    for (const [point, x, y] of shown) {
      const mark = svg("path", { d: `M${x} ${y - 6.5}l6.5 6.5l-6.5 6.5l-6.5 -6.5Z`, class: "point" }, picture);
      svg("title", {}, mark, point.name);
    }
  }

  function nameLimit() {
    if (map.speed_limit === null || !(map.speed_limit > slowest && map.speed_limit < fastest)) return;
    const text = `drive limit ${digits(1e3 * map.speed_limit)} mm/s`, width = shape.width(text, 11.5);
    const y = up(map.speed_limit);
    for (const offset of [-5, 13]) {
      for (const share of [0.5, 0.3, 0.7, 0.2, 0.8]) {
        const x = frame.left + share * frame.width - width / 2, box = [x - 2, y + offset - 10, x + width + 2, y + offset + 3];
        if (!within(box) || !free(box)) continue;
        taken.push(box, [frame.left, y - 2, frame.right, y + 2]);
        svg("text", { x, y: y + offset, class: "limit-name" }, picture, text);
        return;
      }
    }
  }

  function nameTorques(lines) {
    for (const [text, points] of lines) {
      const width = shape.width(text, 11.5);
      const order = points.map((p, i) => [Math.abs(i / points.length - 0.3), p]).sort((a, b) => a[0] - b[0]);
      const found = order.map(([, [x, y]]) => [x - width / 2 - 2, y - 7, x + width / 2 + 2, y + 7]).find((box) => within(box) && free(box));
      if (!found) continue;
      taken.push(found);
      const [x, y] = [(found[0] + found[2]) / 2, found[3] - 3];
      svg("text", { x, y, "text-anchor": "middle", class: `torque-name on-${groundAt(x, y - 4)}` }, picture, text);
    }
  }

  // The zone below a name.
  function groundAt(x, y) {
    const speed = speedAt(y), at = columnAt(x);
    if (speed < valueAt(edges.lower, at)) return "sticks";
    return speed < valueAt(edges.upper, at) ? "depends" : "smooth";
  }

  // Place the word of each zone where it has the most room, upright or along the zone; else it goes into the key.
  function nameZones(zones, box) {
    // A word on the edge of what was measured would be crossed out.
    const [left, top, right, bottom] = box;
    taken.push([left - 1, top, left + 1, bottom], [right - 1, top, right + 1, bottom], [left, top - 1, right, top + 1], [left, bottom - 1, right, bottom + 1]);
    const nameless = [];
    for (const [name, bands] of Object.entries(zones)) {
      const word = name === "stall" ? beyond : name === "depends" ? "depends on start" : name, size = 14, width = shape.width(word, size, 700) + 6;
      let best = null, thick = 0;
      for (const band of bands.flatMap(runs)) {
        thick = Math.max(thick, ...band.map(([, low, high]) => low - high));
        for (let x = frame.left + width / 2 + 4; x < frame.right - width / 2 - 4; x += 8) {
          for (const spot of [upright(band, x, width), along(band, x, width)]) {
            if (!spot || !free(spot.box)) continue;
            const inside = x > box[0] && x < box[2] && spot.y > box[1] && spot.y < box[3];
            const score = Math.min(spot.room, 90) + (inside ? 30 : 0) - Math.abs(x - frame.left - 0.4 * frame.width) / 20 - (spot.turn ? 45 : 0);
            if (!best || score > best.score) best = { ...spot, x, score };
          }
        }
      }
      if (best) {
        taken.push(best.box);
        svg("text", { x: best.x, y: best.y + 5, "text-anchor": "middle", class: `word ${name}`,
          ...(best.turn ? { transform: `rotate(${best.turn} ${best.x} ${best.y})` } : {}) }, picture, word);
      } else if (thick > 2) nameless.push([name, word]);
    }
    return nameless;
  }

  function heights(band, from, to) {
    return band.filter(([x]) => x >= from - frame.width / band.length && x <= to + frame.width / band.length);
  }
  function upright(band, x, width) {
    const over = heights(band, x - width / 2, x + width / 2);
    const top = Math.max(...over.map(([, , high]) => high)), bottom = Math.min(...over.map(([, low]) => low));
    if (bottom - top < 18) return null;
    const y = (top + bottom) / 2;
    return { y, turn: 0, room: bottom - top, box: [x - width / 2, y - 9, x + width / 2, y + 9] };
  }
  function along(band, x, width) {
    const over = heights(band, x - width / 2, x + width / 2).filter(([, low, high]) => low - high > 10);
    if (over.length < 2) return null;
    const [first, last] = [over[0], over.at(-1)], middle = ([, low, high]) => (low + high) / 2;
    if (last[0] - first[0] < 0.8 * width) return null;
    const slope = (middle(last) - middle(first)) / (last[0] - first[0]), centre = middle(first) + slope * (x - first[0]);
    const spare = ([a, low, high]) => Math.min(low - centre - slope * (a - x), centre + slope * (a - x) - high);
    const room = 2 * Math.min(...over.map(spare)) / Math.hypot(1, slope);
    if (room < 15 || Math.abs(slope) > 1) return null;
    const rise = Math.abs(slope) * width / 2;
    return { y: centre, turn: Math.atan(slope) * 180 / Math.PI, room, box: [x - width / 2, centre - 8 - rise, x + width / 2, centre + 8 + rise] };
  }
  return { drawPoints, nameLimit, nameTorques, nameZones };
}
