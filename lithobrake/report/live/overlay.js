"use strict";
// What stands over a picture in three dimensions: words at places of it, and a bar of a round length at its middle.

// The largest of 1, 2 and 5 times a power of ten that is not more.
function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find((one) => one * power <= most) * power;
}

class Overlay {
  // labels: words, place [m], and whether the body around the origin may hide it.
  constructor(canvas, labels) {
    const stage = element("div", { className: "stage" });
    canvas.replaceWith(stage);
    this.canvas = canvas;
    this.bar = element("span", { className: "bar" });
    this.labels = labels.map((one) => ({ ...one, shown: element("span", { textContent: one.words }) }));
    stage.append(canvas, this.bar, ...this.labels.map((one) => one.shown));
  }

  // camera: of the picture, column by column; eye [m]; distance: of the middle of the picture from it [m].
  show(camera, eye, distance) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    for (const { place, canHide, shown } of this.labels) {
      const clip = [0, 1, 3].map((row) => [...place, 1].reduce((sum, one, k) => sum + camera[4 * k + row] * one, 0));
      const isBehind = canHide && place.reduce((sum, one, k) => sum + one * (eye[k] - one), 0) < 0;
      const x = 0.5 * width * (1 + clip[0] / clip[2]), y = 0.5 * height * (1 - clip[1] / clip[2]);
      shown.hidden = isBehind || clip[2] <= 0 || x < 0 || x > 1.2 * width || y < 0 || y > height;
      // Words that would be cut off at the right stand farther left.
      shown.style.transform = `translate(${Math.min(x, width - shown.offsetWidth - 12)}px, ${y}px)`;
    }
    // The shorter side of the picture takes in a third of a right angle.
    const metres = 2 * distance * Math.tan(Math.PI / 12) / Math.min(width, height), length = roundLength(140 * metres);
    this.bar.style.width = `${length / metres}px`;
    this.bar.textContent = `${shortLength(length)}`;
  }
}

// A length in the unit of a reader.
function shortLength(metres) {
  if (metres >= 1000) return `${Number((metres / 1000).toPrecision(3))} km`;
  return metres < 0.01 ? `${Number((1000 * metres).toPrecision(3))} mm` : `${Number(metres.toPrecision(3))} m`;
}
