"use strict";
// Attitudes of a lander at its touchdown, and the terms of them that the emulator reads: as
// lithobrake.geometry.attitude_terms has them.

class Attitude {
  // inputs: places of the terms among the inputs; axes [axis_count][3] of the lander; hasSides, isCube: as in Python;
  // drawn: terms of the attitudes of the study, where it has not any.
  constructor({ inputs, axes, hasSides, isCube, drawn }) {
    Object.assign(this, { inputs, axes, hasSides, isCube, drawn, downs: [] });
  }

  // Normal of the ground and direction of travel, seen from the lander, by three uniform numbers: in any attitude, or
  // with one of the directions `downs` of the lander toward the ground.
  ways(first, second, third) {
    const turn = 2 * Math.PI * third;
    let normal;
    if (this.downs.length) normal = this.downs[Math.floor(first * this.downs.length)].map((one) => -one);
    else {
      const cosine = 1 - 2 * first, sine = Math.sqrt(1 - cosine * cosine), angle = 2 * Math.PI * second;
      normal = [sine * Math.cos(angle), sine * Math.sin(angle), cosine];
    }
    // Across the normal, from the axis that is farthest from it.
    const least = normal.map(Math.abs).reduce((best, one, k, all) => (one < all[best] ? k : best), 0);
    const across = cross(normal, [0, 1, 2].map((k) => (k === least ? 1 : 0))), length = Math.hypot(...across);
    const east = across.map((one) => one / length), north = cross(normal, east);
    return [normal, east.map((one, k) => Math.cos(turn) * one + Math.sin(turn) * north[k])];
  }

  // The terms [term_count] of a normal and a direction of travel.
  terms(normal, travel) {
    const b = cross(normal, travel), along = (way) => this.axes.map((axis) => axis.reduce((sum, one, k) => sum + one * way[k], 0));
    const [n, t, s] = [normal, travel, b].map(along), sum = (part) => n.reduce((all, _, k) => all + part(k), 0);
    if (this.isCube)
      return [sum((k) => n[k] ** 4), sum((k) => n[k] ** 3 * t[k]), sum((k) => n[k] ** 2 * (t[k] ** 2 - s[k] ** 2))];
    const second = n.map((_, k) => [n[k] ** 2, 2 * n[k] * t[k], t[k] ** 2 - s[k] ** 2]);
    return this.hasSides ? [...second.slice(0, 2).flat(), ...n, ...t] : second.flat();
  }

  // Put the germs of the terms of an attitude, by three uniform numbers, among those of the inputs.
  into(germs, law, uniforms) {
    const terms = this.drawn ? this.drawn[Math.floor(uniforms[0] * this.drawn.length)] : this.terms(...this.ways(...uniforms));
    this.inputs.forEach((input, k) => { germs[input] = law.germOf(input, terms[k]); });
  }
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
