"use strict";
// What the explorer shows of chosen inputs: distributions of the outputs, the return fraction, and where landers come
// down, each over all refits and refit by refit.

const BINS = 120;
// Cells along the width of the map of one half of the body.
const MAP_CELLS = 60;
// Draws of each refit at each choice of the inputs: with fifty refits enough for smooth curves, and quick.
const POINTS = 500;

// The generalised golden ratio: its powers fill a cube of so many sides evenly. (Roberts, 2018.)
function evenSteps(sides) {
  let ratio = 2;
  for (let turn = 0; turn < 60; turn++) ratio = (1 + ratio) ** (1 / (sides + 1));
  return Array.from({ length: sides }, (_, side) => ratio ** -(side + 1));
}

function fraction(value) {
  return value - Math.floor(value);
}

class Explorer {
  constructor(law, flown, facts) {
    Object.assign(this, { law, flown, facts, attitude: facts.attitude ? new Attitude(facts.attitude) : null });
    // Sides of the cube: the inputs, then outcome, row, flight, and a normal number for each output.
    const { inputs, outputs } = law;
    this.own = 3 + outputs;
    this.steps = evenSteps(inputs + this.own);
    this.numbers = this.ownNumbers();
    this.y = new Float64Array(outputs);
    this.axes = null;
    // The axes show nearly all draws over the whole law of the inputs.
    this.axes = this.widestAxes();
    this.whole = this.at(Array.from({ length: inputs }, () => [0, 1]));
  }

  widestAxes() {
    const found = this.facts.outputs.map(() => []);
    this.eachDraw(Array.from({ length: this.law.inputs }, () => [0, 1]), POINTS, (refit, row) => {
      if (row >= 0 && this.canLeave()) for (let k = 0; k < found.length; k++) found[k].push(this.y[k]);
    });
    return found.map((values, k) => {
      values.sort((a, b) => a - b);
      const most = values[Math.floor(0.995 * values.length)] ?? 1;
      return this.facts.outputs[k].most ?? 1.05 * most;
    });
  }

  // What each draw has of its own, [refit_count, POINTS, 3 + output_count]: uniform numbers for outcome, row and flight,
  // normal ones for the outputs. Each refit has the next points of one even sequence, so that all together fill it.
  ownNumbers() {
    const { law, own } = this, found = new Float64Array(law.refits * POINTS * own);
    for (let place = 0; place < law.refits * POINTS; place++)
      for (let side = 0; side < own; side++) {
        const share = fraction((place + 0.5) * this.steps[law.inputs + side]);
        found[place * own + side] = side < 3 ? share : normalQuantile(share);
      }
    return found;
  }

  // Go through draws at inputs between two probabilities of their laws [input_count][2]; this.y has the outputs. points:
  // so many of the draws of each refit.
  eachDraw(ranges, points, visit) {
    const { law, steps, own, numbers, y } = this, germs = new Float64Array(law.inputs);
    for (let number = 0; number < points; number++) {
      for (let input = 0; input < law.inputs; input++) {
        const [low, high] = ranges[input];
        germs[input] = law.germAt(input, low + (high - low) * fraction((number + 0.5) * steps[input]));
      }
      // The terms of an attitude go together; three of their sides of the cube are enough for all.
      this.attitude?.into(germs, law, this.attitude.inputs.slice(0, 3).map((input) => fraction((number + 0.5) * steps[input])));
      const point = law.pointAt(germs);
      for (let refit = 0; refit < law.refits; refit++) {
        const first = (refit * POINTS + number) * own;
        const row = law.draw(refit, point, numbers[first], numbers[first + 1], numbers, first + 3, y);
        visit(refit, row, numbers[first + 2]);
      }
    }
  }

  // Whether speed and elevation of the drawn outputs are a way to leave; those of an expansion need not be.
  canLeave() {
    const elevation = this.y[this.facts.elevation];
    return this.y[this.facts.speed] > 0 && elevation > 0 && elevation <= 0.5 * Math.PI;
  }

  // Direction [rad] of the drawn lander: that of its row, or of its own velocity where outputs hold one.
  azimuthOf(row) {
    const { level } = this.facts;
    return level ? Math.atan2(this.y[level[1]], this.y[level[0]]) : this.law.azimuth[row];
  }

  // Everything that is shown, at inputs between two probabilities of their laws.
  at(ranges, points = POINTS) {
    const { law, flown, facts } = this, cells = 2 * MAP_CELLS ** 2;
    const counts = new Float64Array(law.refits * law.outputs * BINS), map = new Float64Array(cells);
    const [left, returns, known] = [0, 1, 2].map(() => new Float64Array(law.refits));
    const fates = new Float64Array(facts.fates.length);
    let draws = 0;
    this.eachDraw(ranges, points, (refit, row, uniform) => {
      draws++;
      const isCaptured = row < 0 && facts.outcomeNames[-1 - row] === facts.capturedName;
      if (row < 0 || !this.canLeave()) {
        if (isCaptured || facts.ofAll) known[refit]++;
        if (isCaptured && facts.holds) returns[refit]++;
        return;
      }
      left[refit]++;
      for (let k = 0; k < facts.outputs.length; k++) {
        // A spin without bounds may be drawn below 0, and is then none.
        const bin = Math.max(Math.floor(BINS * this.y[k] / this.axes[k]), 0);
        if (bin < BINS) counts[(refit * law.outputs + k) * BINS + bin]++;
      }
      known[refit]++;
      if (!flown) return;
      const flight = flown.near(this.y[facts.speed], this.y[facts.elevation], this.azimuthOf(row), uniform);
      fates[flown.status[flight]]++;
      if (flown.status[flight] !== facts.impact) return;
      returns[refit]++;
      map[flown.cells[flight]]++;
    });
    return { counts, left, returns, known, map, fates, draws };
  }
}

function meanOf(values) {
  return values.reduce((sum, one) => sum + one, 0) / values.length;
}

// Variance of numbers, one of each refit, and what of it is the refits': that less what finite draws add. What so few
// draws cannot tell from chance counts as its own standard error.
function freedVariance(values, chance) {
  const mean = meanOf(values), count = values.length;
  const total = values.reduce((sum, one) => sum + (one - mean) ** 2, 0) / (count - 1);
  return [total, Math.max(total - chance, total * Math.sqrt(2 / count))];
}

// Share and its bounds over beds that were not in the study, as lithobrake.analysis.refit_interval has them; a share of
// 0 or 1 has no other bounds here. runCount: runs that the law was fitted to; limit: what they leave open of an event
// that none of them has met (90 %).
function refitInterval(returns, known, bedCount, reach, runCount, limit) {
  const shares = Array.from(returns, (one, refit) => one / known[refit]), total = meanOf(known) * known.length;
  const chance = meanOf(shares.map((one, refit) => one * (1 - one) / (known[refit] - 1)));
  const share = meanOf(returns) * returns.length / total, between = freedVariance(shares, chance)[1];
  // Drawing B of B beds scatters by (B - 1) / B of what B beds scatter by.
  const half = reach * Math.sqrt(between * bedCount / (bedCount - 1) + share * (1 - share) / total);
  if (share >= 0.1 && share <= 0.9 || share === 0 || share === 1)
    return [share, Math.max(share - half, 0), Math.min(share + half, 1)];
  const odds = share / (1 - share), factor = Math.exp(Math.min(half / (share * (1 - share)), 600));
  const low = odds / factor / (1 + odds / factor), high = odds * factor / (1 + odds * factor);
  // Few runs that have met an event leave no more open than none.
  const isUnseen = Math.min(share, 1 - share) * runCount < 0.5;
  if (share < 0.5) return [share, low, Math.max(Math.min(high, Math.max(share + half, limit)), isUnseen ? limit : 0)];
  return [share, Math.min(Math.max(low, Math.min(share - half, 1 - limit)), isUnseen ? 1 - limit : 1), high];
}

// Value that a share of counts does not exceed, straight within a bin; axis: where the last bin ends.
function quantileOf(counts, total, share, axis) {
  let sum = 0;
  for (let bin = 0; bin < counts.length; bin++) {
    if (sum + counts[bin] >= share * total && counts[bin] > 0)
      return axis * (bin + (share * total - sum) / counts[bin]) / counts.length;
    sum += counts[bin];
  }
  return axis;
}

// The middle nine tenths of numbers, one of each refit, drawn together by what chance of this variance has added.
function middle(values, chance) {
  const sorted = Float64Array.from(values).sort(), last = sorted.length - 1, mean = meanOf(values);
  const [total, freed] = freedVariance(values, chance), part = total > 0 ? Math.sqrt(freed / total) : 1;
  const at = (share) => {
    const place = share * last, low = Math.floor(place), high = Math.min(low + 1, last);
    return mean + part * (sorted[low] + (place - low) * (sorted[high] - sorted[low]) - mean);
  };
  return [at(0.05), at(0.95)];
}
