"use strict";
// The law of the emulator: what lithobrake.emulator evaluates, from the same numbers, in the same order of steps. An
// expansion is one without bounds, whose scatter may grow with the speed of the impact.

// Arrays of the page by name: each was packed as base64 of little-endian numbers with a shape.
function unpack(packed) {
  const kinds = { float64: Float64Array, float32: Float32Array, uint8: Uint8Array };
  const found = {};
  for (const [name, { type, shape, base64 }] of Object.entries(packed)) {
    const bytes = Uint8Array.from(atob(base64), (one) => one.charCodeAt(0));
    found[name] = Object.assign(new kinds[type](bytes.buffer), { shape });
  }
  return found;
}

// Quantile of the standard normal law. to nine digits, by Acklam's rational approximation.
function normalQuantile(share) {
  const a = [-39.69683028665376, 220.9460984245205, -275.9285104469687, 138.357751867269, -30.66479806614716, 2.506628277459239];
  const b = [-54.47609879822406, 161.5858368580409, -155.6989798598866, 66.80131188771972, -13.28068155288572];
  const c = [-0.007784894002430293, -0.3223964580411365, -2.400758277161838, -2.549732539343734, 4.374664141464968, 2.938163982698783];
  const d = [0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416];
  const at = (list, x) => list.reduce((sum, one) => sum * x + one, 0);
  const tail = Math.min(share, 1 - share);
  if (tail < 0.02425) {
    const q = Math.sqrt(-2 * Math.log(tail)), value = at(c, q) / at([...d, 1], q);
    return share < 0.5 ? value : -value;
  }
  const q = share - 0.5;
  return q * at(a, q * q) / at([...b, 1], q * q);
}

class Law {
  // tables: those of explorer.h5; facts: its names and the numbers of the energy bound.
  constructor(tables, facts) {
    Object.assign(this, tables, { facts });
    [this.refits, , this.outputs] = this.location.shape;
    this.rowCount = this.rows.shape[1];
    [this.terms, this.inputs] = this.multi_indices.shape;
    this.degree = this.center.shape[1];
    this.classes = facts.outcomeNames.length;
    this.classTerms = this.class_slopes.shape[2];
    this.grows ??= new Float64Array(this.outputs);
    this.withOutputs = facts.outcomeNames.indexOf(facts.outputOutcome);
    // Inputs by whose nearness rows are drawn.
    this.near = Array.from(this.kernel_widths.keys()).filter((input) => Number.isFinite(this.kernel_widths[input]));
    this.polynomial = new Float64Array(this.degree + 1);
    this.factors = new Float64Array(this.inputs * (this.degree + 1));
    this.nearness = new Float64Array(this.rowCount);
    this.ends = new Float64Array(this.rowCount);
    this.chances = new Float64Array(this.classes);
    this.where = new Float64Array(this.outputs);
    this.scale = new Float64Array(this.outputs);
    const alike = (_, refit) => this.accumulated(refit, null, new Float64Array(this.rowCount));
    this.fixedEnds = Array.from({ length: this.refits }, alike);
    // Terms that no refit uses cost time alone.
    this.used = Array.from({ length: this.terms }, (_, term) => term).filter((term) => this.isUsed(term));
  }

  isUsed(term) {
    for (let refit = 0; refit < this.refits; refit++)
      for (let k = 0; k < this.outputs; k++)
        for (const table of [this.location, this.log_scale])
          if (table[(refit * (this.terms + 1) + term + 1) * this.outputs + k] !== 0) return true;
    if (term < this.classTerms)
      for (let row = 0; row < this.refits * this.classes; row++)
        if (this.class_slopes[row * this.classTerms + term] !== 0) return true;
    return term < this.inputs;
  }

  germOf(input, x) {
    return ((this.is_log[input] ? Math.log(x) : x) - this.germ_zero[input]) * this.germ_slope[input];
  }

  valueOf(input, germ) {
    const value = this.germ_zero[input] + germ / this.germ_slope[input];
    return this.is_log[input] ? Math.exp(value) : value;
  }

  // Germ that is not exceeded with a probability, straight between the stored quantiles.
  germAt(input, probability) {
    const steps = this.germ_quantiles.shape[1] - 1, place = probability * steps;
    const low = Math.min(Math.floor(place), steps - 1), first = input * (steps + 1) + low;
    return this.germ_quantiles[first] + (place - low) * (this.germ_quantiles[first + 1] - this.germ_quantiles[first]);
  }

  // Terms but the constant [term_count] at germs [input_count]; the first ones are the standardised inputs.
  termsAt(germs, into) {
    const width = this.degree + 1;
    for (let input = 0; input < this.inputs; input++) {
      const start = input * width, first = input * this.degree;
      this.factors[start] = 1;
      for (let k = 0; k < this.degree; k++) {
        let value = (germs[input] - this.center[first + k]) * this.factors[start + k];
        if (k > 0) value -= this.spread[first + k - 1] * this.factors[start + k - 1];
        this.factors[start + k + 1] = value / this.spread[first + k];
      }
    }
    for (const term of this.used) {
      let product = 1;
      for (let input = 0; input < this.inputs; input++) {
        const power = this.multi_indices[term * this.inputs + input];
        if (power) product *= this.factors[input * width + power];
      }
      into[term] = product;
    }
    return into;
  }

  // Locations and scales [output_count] of the coordinates, into this.where and this.scale.
  placeAt(refit, terms) {
    const { used, outputs, location, log_scale, where, scale } = this;
    const first = refit * (this.terms + 1) * outputs;
    for (let k = 0; k < outputs; k++) [where[k], scale[k]] = [location[first + k], log_scale[first + k]];
    for (let one = 0; one < used.length; one++) {
      const factor = terms[used[one]], start = first + (used[one] + 1) * outputs;
      for (let k = 0; k < outputs; k++) {
        where[k] += factor * location[start + k];
        scale[k] += factor * log_scale[start + k];
      }
    }
    for (let k = 0; k < outputs; k++) {
      const least = this.scale_limits[2 * refit * outputs + k], most = this.scale_limits[(2 * refit + 1) * outputs + k];
      scale[k] = Math.exp(Math.min(Math.max(scale[k], least), most));
    }
  }

  // Chances of the outcomes [class_count].
  chancesAt(refit, terms, into) {
    let largest = -Infinity, total = 0, never = 0;
    for (let c = 0; c < this.classes; c++) {
      let logit = this.class_intercepts[refit * this.classes + c];
      for (const term of this.used)
        if (term < this.classTerms) logit += terms[term] * this.class_slopes[(refit * this.classes + c) * this.classTerms + term];
      const unmet = this.class_never[refit * this.classes + c];
      never += unmet;
      into[c] = unmet > 0 ? -Infinity : logit;
      largest = Math.max(largest, into[c]);
    }
    for (let c = 0; c < this.classes; c++) total += into[c] = Math.exp(into[c] - largest);
    for (let c = 0; c < this.classes; c++)
      into[c] = this.class_never[refit * this.classes + c] + (1 - never) * into[c] / total;
    return into;
  }

  // How near each row is to a point, the same for all refits; without a kernel all are alike.
  nearnessAt(terms) {
    if (!this.near.length) return null;
    let least = Infinity;
    for (let row = 0; row < this.rowCount; row++) {
      let square = 0;
      for (const input of this.near)
        square += ((terms[input] - this.row_inputs[row * this.inputs + input]) / this.kernel_widths[input]) ** 2;
      least = Math.min(least, this.nearness[row] = square);
    }
    for (let row = 0; row < this.rowCount; row++)
      this.nearness[row] = Math.exp(-0.5 * (this.nearness[row] - least));
    return this.nearness;
  }

  // Sums of the chances of rows, of which the last is 1.
  accumulated(refit, nearness, into) {
    let sum = 0;
    for (let row = 0; row < this.rowCount; row++)
      into[row] = sum += this.row_weights[refit * this.rowCount + row] * (nearness ? nearness[row] : 1);
    for (let row = 0; row < this.rowCount; row++) into[row] /= sum;
    return into;
  }

  endsAt(refit, nearness) {
    return nearness ? this.accumulated(refit, nearness, this.ends) : this.fixedEnds[refit];
  }

  // Residuals of a row [output_count] with the smoothing that normal numbers from a place on give.
  scatterOf(refit, row, normals, place, into) {
    const size = this.smoothing_size[refit], count = this.outputs, shrink = Math.sqrt(1 + size * size);
    for (let k = 0; k < count; k++) {
      let noise = 0;
      for (let j = 0; j < count; j++) noise += normals[place + j] * this.smoothing_root[(refit * count + k) * count + j];
      into[k] = (this.rows[(refit * this.rowCount + row) * count + k] + size * noise) / shrink;
    }
    return into;
  }

  // A point of the inputs, ready for draws: terms, nearness of rows, upper bounds of the outputs, and how much larger
  // than that of the runs the scatter is that grows.
  pointAt(germs) {
    const terms = this.termsAt(germs, new Float64Array(this.terms));
    const near = this.nearnessAt(terms), upper = Float64Array.from(this.upper);
    const values = Array.from(germs, (germ, input) => this.valueOf(input, germ));
    const growth = this.scatter_speed ? this.valueIn(values, "impact.speed") / this.scatter_speed[0] : 1;
    let gyration = 0;
    if (Number.isFinite(upper[this.facts.speed])) {
      [upper[this.facts.speed], gyration] = this.energyBoundAt(values);
      upper[this.facts.spin] = upper[this.facts.speed] / gyration;
    }
    return { terms, near: near && Float64Array.from(near), upper, gyration, growth };
  }

  // An input among values, or what the study fixes it to; 0 for one that it has not.
  valueIn(values, name) {
    const { bound, inputNames } = this.facts;
    return inputNames.includes(name) ? values[inputNames.indexOf(name)] : bound[name] ?? 0;
  }

  // One draw of a refit at a point, from two uniform numbers and normal ones, which begin at a place: the row that it
  // has its scatter of, or -1 - outcome where there are no outputs; outputs come into `y` [output_count].
  draw(refit, point, ofOutcome, ofRow, normals, place, y) {
    const chances = this.chancesAt(refit, point.terms, this.chances);
    let outcome = 0;
    for (let sum = chances[0]; outcome < this.classes - 1 && sum <= ofOutcome; sum += chances[++outcome]);
    if (outcome !== this.withOutputs) return -1 - outcome;
    const row = placeOf(this.endsAt(refit, point.near), ofRow);
    this.scatterOf(refit, row, normals, place, y);
    this.placeAt(refit, point.terms);
    for (let k = 0; k < this.outputs; k++)
      y[k] = fromCoordinate(
        this.where[k] + this.scale[k] * y[k] * (this.grows[k] ? point.growth : 1), this.lower[k], point.upper[k],
        this.distant[k]);
    // What the speed has taken is not there for the spin.
    const { speed, spin } = this.facts, most = point.upper[speed] ** 2 - y[speed] ** 2;
    if (point.gyration) y[spin] = Math.min(y[spin], Math.sqrt(Math.max(most, 0)) / point.gyration);
    return row;
  }

  // The most that energy allows at values of the inputs: speed [m/s] and radius of gyration [m].
  energyBoundAt(values) {
    const { bound } = this.facts, at = (name) => this.valueIn(values, name);
    const ratio = (name) => bound[name] ? at(name) / bound[name] : 1;
    const power = ratio("lander.mass") ** bound.mass_power * ratio("lander.diameter") ** bound.diameter_power;
    const spin = ["x", "y", "z"].reduce((sum, axis) => sum + at(`impact.spin_${axis}`) ** 2, 0);
    const slope = Math.sin(at("surface.slope_deg") * Math.PI / 180), gravity = Math.abs(at("surface.gravity"));
    const limit = bound.time_limit, downhill = at("impact.speed") * limit + 0.5 * gravity * slope * limit ** 2;
    const gained = gravity * (bound.height + (bound.across + downhill) * slope);
    const square = at("impact.speed") ** 2 + bound.largest * power * spin + 2 * gained;
    return [Math.sqrt(square), Math.sqrt(bound.smallest * power)];
  }
}

// Place of a uniform number among accumulated chances.
function placeOf(ends, uniform) {
  let low = 0, high = ends.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ends[middle] > uniform) high = middle; else low = middle + 1;
  }
  return low;
}

// An output of its coordinate: logit between two bounds, logarithm beyond one, itself where there is none or where they
// are distant. No output is beyond a bound, or on a lower one of 0.
function fromCoordinate(coordinate, lower, upper, isDistant) {
  const limited = Math.min(Math.max(coordinate, -700), 700), from = Number.isFinite(lower), to = Number.isFinite(upper);
  let y = coordinate;
  if (!isDistant && from && to) y = lower + (upper - lower) / (1 + Math.exp(-limited));
  else if (!isDistant && (from || to)) y = from ? lower + Math.exp(limited) : upper - Math.exp(-limited);
  return Math.min(Math.max(y, lower + Number.MIN_VALUE), upper);
}
