"use strict";
// Both halves of a body without a change of area, as lithobrake.report.figures.ground_map has them for the other maps.

// Radii of a sphere of radius 1 from the middle of a half to its edge on the map.
const EDGE = Math.SQRT2;
const HALVES = ["the half around the aim point", "the other half"];

// Lambert's azimuthal map of a sphere of radius 1: east and north of a place [deg] from the middle of a half [deg], and
// the cosine of the angle between them, which is above 0 on this half.
function onHalf([middle, meridian], latitude, longitude) {
  const [lat, mid, turn] = [latitude, middle, longitude - meridian].map((one) => one * Math.PI / 180);
  const facing = Math.sin(mid) * Math.sin(lat) + Math.cos(mid) * Math.cos(lat) * Math.cos(turn);
  const north = Math.cos(mid) * Math.sin(lat) - Math.sin(mid) * Math.cos(lat) * Math.cos(turn);
  const size = Math.sqrt(2 / Math.max(1 + facing, 1e-12));
  return [size * Math.cos(lat) * Math.sin(turn), size * north, facing];
}

function middlesOf([latitude, longitude]) {
  return [[latitude, longitude], [-latitude, longitude + 180]];
}

// The cell of both halves about an aim point that a place lies in: half by half, from south to north.
function mapCell(aim, latitude, longitude) {
  const seen = middlesOf(aim).map((middle) => onHalf(middle, latitude, longitude)), half = seen[0][2] >= 0 ? 0 : 1;
  const [column, row] = seen[half].map((one) => Math.min(Math.floor((one / EDGE + 1) / 2 * MAP_CELLS), MAP_CELLS - 1));
  return (half * MAP_CELLS + row) * MAP_CELLS + column;
}

// The lines of latitude and longitude on a half, to be stroked; visit: given those of latitude with their western ends.
function tracePlaces(context, middle, at, visit) {
  const steps = Array.from({ length: 121 }, (_, step) => step / 120);
  const trace = (places) => {
    let isDrawn = false, west = null;
    for (const [latitude, longitude] of places) {
      const [east, north, facing] = onHalf(middle, latitude, longitude), place = at(east, north);
      if (facing < 0) { isDrawn = false; continue; }
      context[isDrawn ? "lineTo" : "moveTo"](...place);
      isDrawn = true;
      if (!west || place[0] < west[0]) west = place;
    }
    return west;
  };
  for (let longitude = -180; longitude < 180; longitude += 30) trace(steps.map((part) => [180 * part - 90, longitude]));
  for (let latitude = -60; latitude <= 60; latitude += 30) {
    const west = trace(steps.map((part) => [latitude, middle[1] + 360 * part - 180]));
    // Names of 60 degrees would stand on the poles.
    if (west && Math.abs(latitude) < 60) visit(latitude, west);
  }
}

// Where landers come down: the share of all draws in the cells of both halves, and the aim point.
function drawMap(canvas, map, aim) {
  // A canvas that is not shown has no width.
  if (canvas.clientWidth <= 32) return;
  const size = Math.min((canvas.clientWidth - 16) / 2, 340), { context, width, colour } = pen(canvas, size + 26);
  const most = Math.max(...map), radius = size / 2 - 1, pixel = size / MAP_CELLS;
  context.textAlign = "center";
  middlesOf(aim).forEach((middle, half) => {
    const x = width / 2 + (half - 0.5) * (size + 16), y = 24 + size / 2;
    const at = (east, north) => [x + radius * east / EDGE, y - radius * north / EDGE];
    context.fillStyle = colour("quiet");
    context.fillText(HALVES[half], x, 14);
    context.save();
    context.beginPath();
    context.arc(x, y, radius, 0, 7);
    context.clip();
    context.fillStyle = colour("wash");
    context.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
    context.fillStyle = colour("accent");
    map.subarray(half * MAP_CELLS ** 2, (half + 1) * MAP_CELLS ** 2).forEach((count, cell) => {
      if (!count) return;
      // The root keeps thin parts of a map visible beside its peak.
      context.globalAlpha = 0.12 + 0.88 * Math.sqrt(count / most);
      // Whole pixels, so that cells neither overlap nor leave gaps.
      const [left, low] = [cell % MAP_CELLS, Math.floor(cell / MAP_CELLS)];
      const [west, east] = [left, left + 1].map((one) => Math.round(x - size / 2 + one * pixel));
      const [south, north] = [low, low + 1].map((one) => Math.round(y + size / 2 - one * pixel));
      context.fillRect(west, north, east - west, south - north);
    });
    context.globalAlpha = 1;
    drawFrame(context, colour, middle, at, [x, y, radius]);
  });
  const x = width / 2 - (size + 16) / 2;
  context.strokeStyle = colour("mark");
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, 24 + size / 2, 5, 0, 7);
  context.stroke();
}

// Lines of latitude and longitude with their names, the poles, and the edge of a half, whose clip ends here.
function drawFrame(context, colour, middle, at, [x, y, radius]) {
  const names = [];
  context.strokeStyle = colour("rule");
  context.lineWidth = 1;
  context.beginPath();
  tracePlaces(context, middle, at, (latitude, place) => names.push([latitude, place]));
  context.stroke();
  context.restore();
  context.fillStyle = context.strokeStyle = colour("quiet");
  context.beginPath();
  context.arc(x, y, radius, 0, 7);
  context.stroke();
  context.textAlign = "left";
  for (const [latitude, [west, north]] of names) {
    const side = latitude > 0 ? "° N" : latitude < 0 ? "° S" : "°";
    context.fillText(Math.abs(latitude) + side, west + 4, north - 3);
  }
  context.textAlign = "center";
  for (const [latitude, name] of [[90, "N"], [-90, "S"]]) {
    const [east, north, facing] = onHalf(middle, latitude, 0), place = at(east, north);
    if (facing >= -1e-9) context.fillText(`+ ${name}`, place[0] + 6, place[1] + 4);
  }
}
