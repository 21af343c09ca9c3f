// Paths of our own drawings, and how wide a text becomes, so that names can be placed before they are drawn.

const shape = {
  pen: document.createElement("canvas").getContext("2d"),
  width(text, size = 11.5, weight = 400) {
    shape.family ??= getComputedStyle(document.body).fontFamily;
    shape.pen.font = `${weight} ${size}px ${shape.family}`;
    return shape.pen.measureText(text).width;
  },
  // Pixels of a line, to a tenth; a point that is no number lifts the pen.
  path(points) {
    let text = "", down = false;
    for (const [x, y] of points) {
      if (!Number.isFinite(x) || !Number.isFinite(y)) { down = false; continue; }
      text += `${down ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
      down = true;
    }
    return text;
  },
};
