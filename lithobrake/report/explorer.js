"use strict";
// The explorer on the page: two ends to each input, and everything that follows from them drawn at once.

// Bins that are drawn as one: finer ones are for quantiles alone.
const SHOWN_TOGETHER = 3;
// Milliseconds that the draws of a moving picture may take, and the fewest draws of each refit that say anything.
const FRAME = 20, FEWEST_POINTS = 60;

// Two sliders in one place: the probabilities between which an input is drawn.
function inputControl(explorer, input, changed) {
  const { words, unit } = explorer.facts.inputs[input], value = element("output");
  const ends = [0, 1].map((end) => element("input", {
    type: "range", min: 0, max: 1, step: 0.005, value: end, ariaLabel: `${words}, ${end ? "upper" : "lower"} end`,
  }));
  const range = () => ends.map((one) => Number(one.value)).sort((a, b) => a - b);
  const show = () => {
    const [low, high] = range().map((share) => explorer.law.valueOf(input, explorer.law.germAt(input, share)));
    value.textContent = `${low === high ? shortNumber(low) : `${shortNumber(low)} to ${shortNumber(high)}`} ${unit}`.trim();
  };
  for (const one of ends) one.addEventListener("input", () => { show(); changed(); });
  const box = element("div", { className: "control" },
    element("div", { className: "name" }, element("span", { textContent: words }), value),
    element("div", { className: "ends" }, ...ends));
  const reset = (low, high) => { [ends[0].value, ends[1].value] = [low, high]; show(); };
  reset(0, 1);
  return { box, range, reset };
}

// Densities of an output by shown bin: of all draws, and the middle nine tenths of the refits.
function densities(found, law, k) {
  const bins = BINS / SHOWN_TOGETHER, mean = new Float64Array(bins), low = new Float64Array(bins), high = new Float64Array(bins);
  const total = found.left.reduce((sum, one) => sum + one, 0) || 1;
  for (let bin = 0; bin < bins; bin++) {
    let sum = 0;
    const ofRefits = Array.from({ length: law.refits }, (_, refit) => {
      let count = 0;
      for (let fine = 0; fine < SHOWN_TOGETHER; fine++)
        count += found.counts[(refit * law.outputs + k) * BINS + bin * SHOWN_TOGETHER + fine];
      sum += count;
      return count / (found.left[refit] || 1);
    });
    mean[bin] = sum / total;
    [low[bin], high[bin]] = middle(ofRefits);
  }
  return { mean, low, high };
}

// A quantile of an output, and the middle nine tenths of it over the refits.
function quantileWords(explorer, found, k, share) {
  const { law, axes } = explorer, { factor } = explorer.facts.outputs[k], of = [];
  const all = new Float64Array(BINS);
  for (let refit = 0; refit < law.refits; refit++) {
    const counts = found.counts.subarray((refit * law.outputs + k) * BINS, (refit * law.outputs + k + 1) * BINS);
    counts.forEach((count, bin) => { all[bin] += count; });
    if (found.left[refit]) of.push(quantileOf(counts, found.left[refit], share, axes[k]));
  }
  const value = quantileOf(all, found.left.reduce((sum, one) => sum + one, 0), share, axes[k]);
  return [value, ...middle(of)].map((one) => shortNumber(factor * one));
}

function shareWords(explorer, found) {
  const { facts } = explorer, sum = (list) => list.reduce((all, one) => all + one, 0), per = (one) => (100 * one).toFixed(1);
  if (!sum(found.known)) return "No draw has an answer.";
  const [share, low, high] = refitInterval(found.stays, found.known, facts.bedCount, facts.reach ?? 0);
  const interval = facts.reach ? ` (90 % interval of the emulator: ${per(low)} to ${per(high)} %)` : "";
  return `${per(share)} % ${facts.action}${interval}`;
}

function startExplorer() {
  const holder = document.getElementById("explorer"), data = document.getElementById("explorer-data");
  if (!holder || !data) return null;
  const { facts, law: packedLaw, flown: packedFlown } = JSON.parse(data.textContent);
  const starts = unpack(packedFlown), law = new Law(unpack(packedLaw), facts);
  const flown = starts.status.length ? new Flown(starts.starts, starts.status) : null;
  if (flown) flown.cells = Uint16Array.from(starts.status, (_, flight) => mapCell(starts.places, flight));
  const explorer = new Explorer(law, flown, facts), charts = holder.querySelector(".charts");
  const views = facts.outputs.map(({ words, unit }) => {
    const canvas = element("canvas"), caption = element("figcaption");
    charts.append(element("figure", {}, element("h3", { textContent: `${words} [${unit}]` }), canvas, caption));
    return { canvas, caption };
  });
  const map = element("canvas");
  if (flown) charts.append(element("figure", { className: "map" }, element("h3", { textContent: "Where they come down" }), map,
    element("figcaption", { textContent: "Longitude and latitude; the ring is the site." })));
  const whole = facts.outputs.map((_, k) => densities(explorer.whole, law, k).mean);
  let waiting = false, points = POINTS, settled = 0;
  const draw = (all) => {
    waiting = false;
    const began = performance.now(), found = explorer.at(controls.map((one) => one.range()), all ? POINTS : points);
    // A slow machine has fewer draws while an end moves, and all of them when it has stopped.
    const took = performance.now() - began;
    if (!all) points = Math.min(Math.max(Math.round(points * FRAME / took), FEWEST_POINTS), POINTS);
    views.forEach(({ canvas, caption }, k) => {
      drawDistribution(canvas, { ...densities(found, law, k), whole: whole[k], largest: facts.outputs[k].factor * explorer.axes[k] });
      const [value, low, high] = quantileWords(explorer, found, k, 0.5);
      caption.textContent = `Median ${value} ${facts.outputs[k].unit} (refits: ${low} to ${high})`;
    });
    holder.querySelector(".share").textContent = flown ? shareWords(explorer, found) : "";
    if (flown) drawMap(map, found.map, MAP_COLUMNS, MAP_ROWS, facts.site);
  };
  // As often as the screen shows, and no more.
  const changed = () => {
    if (!waiting) { waiting = true; requestAnimationFrame(() => draw(false)); }
    clearTimeout(settled);
    settled = setTimeout(() => draw(true), 200);
  };
  const controls = facts.inputs.map((_, input) => inputControl(explorer, input, changed));
  const set = (words, low, high) => {
    const button = element("button", { type: "button", textContent: words });
    button.addEventListener("click", () => { controls.forEach((one) => one.reset(low, high)); changed(); });
    return button;
  };
  holder.querySelector(".controls").append(...controls.map((one) => one.box),
    element("p", { className: "buttons" }, set("The whole law", 0, 1), set("All at their medians", 0.5, 0.5)));
  addEventListener("resize", changed);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  draw(true);
  return explorer;
}

// The cell of the map that a flight ended in.
function mapCell(places, flight) {
  const row = Math.min(Math.floor((places[2 * flight] + 90) / 180 * MAP_ROWS), MAP_ROWS - 1);
  const column = Math.min(Math.floor((places[2 * flight + 1] + 180) / 360 * MAP_COLUMNS), MAP_COLUMNS - 1);
  return row * MAP_COLUMNS + column;
}

const explorer = startExplorer();
