"use strict";
// Where a drawn lander ends: nothing is flown here, so it takes the end of a flown one that left nearly as it does.

// Flown starts to a cell: few enough to be near each other, and enough for each end to be met as often as it should.
const STARTS_IN_A_CELL = 8;

class Flown {
  // starts [3 count]: speed, elevation and azimuth of each; status [count]: places among the words of the fates.
  constructor(starts, status) {
    this.status = status;
    this.starts = starts;
    this.order = Uint32Array.from(status, (_, flight) => flight);
    this.spread = [0, 1, 2].map((axis) => this.widthOf(0, status.length, axis) || 1);
    // Nodes of a tree: axis and value at which its starts are halved, into 2 node + 1 and 2 node + 2; the axis of a cell
    // is -1, and its starts stand between two places of the order.
    const count = 4 << Math.ceil(Math.log2(Math.max(status.length / STARTS_IN_A_CELL, 1)));
    this.axis = new Int8Array(count).fill(-1);
    this.value = new Float64Array(count);
    this.ends = new Uint32Array(2 * count);
    if (status.length) this.split(0, 0, status.length);
  }

  widthOf(from, to, axis) {
    let low = Infinity, high = -Infinity;
    for (let place = from; place < to; place++) {
      const value = this.starts[3 * this.order[place] + axis];
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return high - low;
  }

  // Halve the starts between two places at the median of their widest axis, until a cell is small.
  split(node, from, to) {
    this.ends.set([from, to], 2 * node);
    if (to - from <= STARTS_IN_A_CELL) return;
    // The speed decides most of where a flight ends: its axis counts twice.
    const widths = [0, 1, 2].map((axis) => (axis ? 1 : 2) * this.widthOf(from, to, axis) / this.spread[axis]);
    const axis = widths.indexOf(Math.max(...widths)), middle = (from + to) >> 1;
    this.order.subarray(from, to).sort((a, b) => this.starts[3 * a + axis] - this.starts[3 * b + axis]);
    this.axis[node] = axis;
    this.value[node] = this.starts[3 * this.order[middle] + axis];
    this.split(2 * node + 1, from, middle);
    this.split(2 * node + 2, middle, to);
  }

  // A flown start in the cell of this one, chosen by a uniform number.
  near(speed, elevation, azimuth, uniform) {
    let node = 0;
    while (this.axis[node] >= 0) {
      const own = this.axis[node] === 0 ? speed : this.axis[node] === 1 ? elevation : azimuth;
      node = 2 * node + (own < this.value[node] ? 1 : 2);
    }
    const from = this.ends[2 * node], to = this.ends[2 * node + 1];
    return this.order[from + Math.floor(uniform * (to - from))];
  }
}
