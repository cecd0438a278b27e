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

// Where landers come down: the share of all draws in cells of longitude and latitude, and the site.
function drawMap(canvas, map, columns, rows, site) {
  const { context, width, height, colour } = pen(canvas, Math.min(0.5 * canvas.clientWidth, 340) + 22);
  const bottom = height - 22, most = Math.max(...map), cellWidth = width / columns, cellHeight = bottom / rows;
  context.fillStyle = colour("wash");
  context.fillRect(0, 0, width, bottom);
  context.fillStyle = colour("accent");
  for (let cell = 0; cell < map.length; cell++) {
    if (!map[cell]) continue;
    // The root keeps thin parts of a map visible beside its peak.
    context.globalAlpha = 0.12 + 0.88 * Math.sqrt(map[cell] / most);
    // Whole pixels, so that cells neither overlap nor leave gaps.
    const column = cell % columns, row = Math.floor(cell / columns);
    const x = Math.round(column * cellWidth), y = Math.round(bottom - (row + 1) * cellHeight);
    context.fillRect(x, y, Math.round((column + 1) * cellWidth) - x, Math.round(bottom - row * cellHeight) - y);
  }
  context.globalAlpha = 1;
  context.fillStyle = colour("quiet");
  context.strokeStyle = colour("rule");
  context.textAlign = "center";
  context.beginPath();
  for (const longitude of [-120, -60, 0, 60, 120]) {
    const place = width * (longitude + 180) / 360;
    context.moveTo(place, 0);
    context.lineTo(place, bottom);
    context.fillText(`${longitude}°`, place, bottom + 16);
  }
  for (const latitude of [-45, 0, 45]) {
    const place = bottom * (90 - latitude) / 180;
    context.moveTo(0, place);
    context.lineTo(width, place);
    context.fillText(`${latitude}°`, 16, place - 3);
  }
  context.stroke();
  if (site[0] === null) return;
  context.strokeStyle = colour("mark");
  context.lineWidth = 2;
  context.beginPath();
  context.arc(width * (site[1] + 180) / 360, bottom * (90 - site[0]) / 180, 5, 0, 7);
  context.stroke();
}
