"use strict";
// The explorer on the page: two ends to each input, and everything that follows from them drawn at once.

// Bins that are drawn as one: finer ones are for quantiles alone.
const SHOWN_TOGETHER = 3;
// Milliseconds that the draws of a moving picture may take, and the fewest draws of each refit that say anything.
const FRAME = 20, FEWEST_POINTS = 60;

// Two sliders in one place: the probabilities between which an input is drawn.
function inputControl(explorer, input, changed) {
  const { words: name, unit } = explorer.facts.inputs[input], value = element("output");
  const ends = [0, 1].map((end) => element("input", {
    type: "range", min: 0, max: 1, step: 0.005, value: end, ariaLabel: `${name}, ${end ? "upper" : "lower"} end`,
  }));
  const range = () => ends.map((one) => Number(one.value)).sort((a, b) => a - b);
  const show = () => {
    const [low, high] = range().map((share) => explorer.law.valueOf(input, explorer.law.germAt(input, share)));
    const words = low === high ? shortNumber(low) : `${shortNumber(low)} to ${shortNumber(high)}`;
    value.textContent = `${words} ${unit}`.trim();
  };
  for (const one of ends) one.addEventListener("input", () => { show(); changed(); });
  const box = element("div", { className: "control" },
    element("div", { className: "name" }, element("span", { textContent: name }), value),
    element("div", { className: "ends" }, ...ends));
  const reset = (low, high) => { [ends[0].value, ends[1].value] = [low, high]; show(); };
  reset(0, 1);
  return { box, range, reset };
}

// A choice of the side of the lander that is toward the ground.
function attitudeControl(explorer, changed) {
  const { choices } = explorer.facts.attitude, value = element("select", { ariaLabel: "attitude" },
    ...choices.map(({ words }, place) => element("option", { value: place, textContent: words })));
  value.addEventListener("change", () => { explorer.attitude.downs = choices[value.value].downs; changed(); });
  return element("div", { className: "control" },
    element("div", { className: "name" }, element("span", { textContent: "side down" }), value));
}

// Densities of an output by shown bin: of all draws, and the middle nine tenths of the refits.
function densities(found, law, k) {
  const bins = BINS / SHOWN_TOGETHER;
  const [mean, low, high] = [0, 1, 2].map(() => new Float64Array(bins));
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
    const chance = meanOf(ofRefits.map((one, refit) => one * (1 - one) / Math.max(found.left[refit] - 1, 1)));
    [low[bin], high[bin]] = middle(ofRefits, chance);
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
  const total = all.reduce((sum, one) => sum + one, 0), value = quantileOf(all, total, share, axes[k]);
  // Variance of a quantile of finite draws: by the density there, of a tenth of the axis as one bin has too few.
  const bin = Math.floor(BINS * value / axes[k]), near = all.slice(Math.max(bin - 6, 0), bin + 6);
  const density = near.reduce((sum, one) => sum + one, 0) / total / (near.length * axes[k] / BINS);
  const chance = share * (1 - share) * law.refits / total / density ** 2;
  return [value, ...middle(of, chance)].map((one) => shortNumber(factor * one));
}

function shareWords(explorer, found) {
  const { facts, law } = explorer, per = (one) => (100 * one).toFixed(1);
  const sum = (list) => list.reduce((all, one) => all + one, 0);
  if (!sum(found.known)) return "No sample has a known outcome.";
  const runs = [facts.bedCount, facts.reach ?? 0, law.rowCount, facts.unseenLimit];
  const [share, low, high] = refitInterval(found.returns, found.known, ...runs);
  const interval = facts.reach ? ` (90 % interval of the emulator: ${per(low)} to ${per(high)} %)` : "";
  return `${per(share)} % ${facts.action}${interval}`;
}

// The explorer that a section of the page holds.
function readExplorer(holder) {
  const data = document.getElementById(`${holder.id}-data`);
  const { facts, law: packedLaw, flown: packedFlown } = JSON.parse(data.textContent);
  const law = new Law(unpack(packedLaw), facts);
  if (!packedFlown) return new Explorer(law, null, facts);
  const found = unpack(packedFlown);
  const flown = new Flown(found.starts, found.status);
  flown.cells = Uint16Array.from(found.status, (_, flight) =>
    mapCell(facts.site, found.places[2 * flight], found.places[2 * flight + 1]));
  return new Explorer(law, flown, facts);
}

// A titled canvas with a line of words below.
function view(title, words, className = "") {
  const canvas = element("canvas"), caption = element("figcaption", { textContent: words });
  return { canvas, caption, box: element("figure", { className }, element("h3", { textContent: title }), canvas, caption) };
}

// The pictures of the explorer; returns what shows findings in them.
function pictures(explorer, holder) {
  const { facts, law, flown, axes } = explorer;
  const whole = facts.outputs.map((_, k) => densities(explorer.whole, law, k).mean);
  const views = facts.outputs.map(({ words, unit }) => view(`${words} [${unit}]`, ""));
  const map = view("Where they come down", "Both halves of the body without a change of area; the ring is the aim point.", "map");
  holder.querySelector(".charts").append(...[...views, ...(flown ? [map] : [])].map((one) => one.box));
  return (found) => {
    views.forEach(({ canvas, caption }, k) => {
      const { factor, unit } = facts.outputs[k], [value, low, high] = quantileWords(explorer, found, k, 0.5);
      drawDistribution(canvas, { ...densities(found, law, k), whole: whole[k], largest: factor * axes[k] });
      caption.textContent = `Median ${value} ${unit} (refits: ${low} to ${high})`;
    });
    if (facts.action) holder.querySelector(".share").textContent = shareWords(explorer, found);
    if (flown) drawMap(map.canvas, found.map, facts.site);
  };
}

function startExplorer(holder) {
  const explorer = readExplorer(holder), { facts } = explorer, show = pictures(explorer, holder);
  let waiting = false, points = POINTS, settled = 0;
  const draw = (all) => {
    waiting = false;
    const began = performance.now(), ranges = facts.inputs.map((_, input) => controls.get(input)?.range() ?? [0, 1]);
    const found = explorer.at(ranges, all ? POINTS : points), took = performance.now() - began;
    // A slow machine has fewer draws while an end moves, and all of them when it has stopped.
    if (!all) points = Math.min(Math.max(Math.round(points * FRAME / took), FEWEST_POINTS), POINTS);
    show(found);
  };
  // As often as the screen shows, and no more.
  const changed = () => {
    if (!waiting) { waiting = true; requestAnimationFrame(() => draw(false)); }
    clearTimeout(settled);
    settled = setTimeout(() => draw(true), 200);
  };
  const controls = new Map(facts.moved.map((input) => [input, inputControl(explorer, input, changed)]));
  const set = (words, low, high) => {
    const button = element("button", { type: "button", textContent: words });
    button.addEventListener("click", () => { controls.forEach((one) => one.reset(low, high)); changed(); });
    return button;
  };
  const attitude = explorer.attitude && !explorer.attitude.drawn ? [attitudeControl(explorer, changed)] : [];
  holder.querySelector(".controls").append(...attitude, ...Array.from(controls.values(), (one) => one.box),
    element("p", { className: "buttons" }, set("The whole law", 0, 1), set("All at their medians", 0.5, 0.5)));
  addEventListener("resize", changed);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  draw(true);
  return explorer;
}

// By the id of its section.
const explorers = Object.fromEntries(
  Array.from(document.querySelectorAll("section.explorer"), (holder) => [holder.id, startExplorer(holder)]));
