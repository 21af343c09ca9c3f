// Paths of our own drawings, and the width of a text, so that names can be placed before they are drawn.

const shape = {
  pen: document.createElement("canvas").getContext("2d"),
  width(text, size = 11.5, weight = 400) {
    shape.family ??= getComputedStyle(document.body).fontFamily;
    shape.pen.font = `${weight} ${size}px ${shape.family}`;
    return shape.pen.measureText(text).width;
  },
  // A line in pixels, to a tenth; a point that is not a number interrupts it.
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
