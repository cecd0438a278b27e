"use strict";
// Drawing on canvases in the colours of the page, sharp on every screen, in light and dark.

function pen(canvas, height) {
  const width = canvas.clientWidth, sharp = window.devicePixelRatio || 1, context = canvas.getContext("2d");
  if (canvas.width !== Math.round(width * sharp) || canvas.height !== Math.round(height * sharp)) {
    canvas.width = Math.round(width * sharp);
    canvas.height = Math.round(height * sharp);
    canvas.style.height = `${height}px`;
  }
  context.setTransform(sharp, 0, 0, sharp, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px Arial, 'Liberation Sans', sans-serif";
  const style = getComputedStyle(canvas);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  return { context, width, height, colour };
}

// About `count` round numbers from 0 to a largest one.
function roundSteps(largest, count) {
  const rough = largest / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((one) => one * power >= rough) * power;
  const length = Math.floor(largest / step + 1e-9) + 1;
  return Array.from({ length }, (_, place) => Number((place * step).toPrecision(12)));
}

// A number to three digits, without a power of ten where a person would not write one.
function shortNumber(value) {
  const isFar = value !== 0 && (Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3);
  return isFar ? value.toExponential(1).replace("e+", "e") : String(Number(value.toPrecision(3)));
}

// A distribution: band and line of densities [bin_count] between 0 and an axis' end, the whole law as a grey line.
function drawDistribution(canvas, { low, high, mean, whole, largest }) {
  const { context, width, height, colour } = pen(canvas, 170);
  const left = 6, right = width - 10, bottom = height - 24, top = 8, bins = mean.length;
  const most = Math.max(...high, ...whole) || 1;
  const x = (bin) => left + (right - left) * bin / bins, y = (value) => bottom - (bottom - top) * value / most;
  const steps = (values) => {
    for (let bin = 0; bin < bins; bin++) for (const end of [bin, bin + 1]) context.lineTo(x(end), y(values[bin]));
  };
  context.fillStyle = colour("band");
  context.beginPath();
  steps(high);
  for (let bin = bins - 1; bin >= 0; bin--) for (const end of [bin + 1, bin]) context.lineTo(x(end), y(low[bin]));
  context.fill();
  for (const [values, name, thick] of [[whole, "quiet", 1], [mean, "accent", 2]]) {
    context.strokeStyle = colour(name);
    context.lineWidth = thick;
    context.beginPath();
    steps(values);
    context.stroke();
  }
  context.strokeStyle = context.fillStyle = colour("quiet");
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(left, bottom + 0.5);
  context.lineTo(right, bottom + 0.5);
  context.textAlign = "center";
  for (const value of roundSteps(largest, width / 45)) {
    const place = left + (right - left) * value / largest;
    context.moveTo(place, bottom);
    context.lineTo(place, bottom + 4);
    context.fillText(shortNumber(value), Math.max(place, 10), bottom + 18);
  }
  context.stroke();
}
