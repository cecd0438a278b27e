"use strict";
// What moves in a view: its arrays, a slider of moments with a button that plays them, and a landing.

// Arrays that the page has deflated: the same as unpack gives of the others.
async function inflate(packed) {
  const plain = {};
  for (const [name, one] of Object.entries(packed)) {
    const bytes = Uint8Array.from(atob(one.base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const kinds = { float32: Float32Array, int32: Int32Array, int16: Int16Array, uint8: Uint8Array };
    plain[name] = new kinds[one.type](await new Response(stream).arrayBuffer());
  }
  return plain;
}

// Triangles with corners of their own: corner, body and paint of each, from hulls that share vertices.
function triangles({ vertices, faces, paint, vertexBody }) {
  const count = faces.length, corner = new Float32Array(3 * count), body = new Float32Array(count);
  const colour = new Uint8Array(3 * count);
  for (let k = 0; k < count; k++) {
    corner.set(vertices.subarray(3 * faces[k], 3 * faces[k] + 3), 3 * k);
    body[k] = vertexBody ? vertexBody[faces[k]] : 0;
    const face = Math.floor(k / 3);
    colour.set(paint.subarray(3 * face, 3 * face + 3), 3 * k);
  }
  return { corner, body, paint: colour };
}

// Poses [8 frames bodies] of steps between frames of whole quanta.
function poses(found, { bodyCount, frameCount }) {
  const made = new Float32Array(8 * frameCount * bodyCount), sums = new Int16Array(7 * bodyCount), size = 7 * bodyCount;
  for (let frame = 0; frame < frameCount; frame++)
    for (let body = 0; body < bodyCount; body++) {
      const to = 8 * (frame * bodyCount + body);
      for (let part = 0; part < 7; part++) {
        // Sums of 16 bits wrap around as the differences did.
        sums[7 * body + part] += found.steps[frame * size + 7 * body + part];
        const value = sums[7 * body + part];
        made[to + part + (part > 2 ? 1 : 0)] = part > 2 ? value / 32767
          : found.middles[3 * body + part] + found.quanta[body] * value;
      }
    }
  return made;
}

function control(label, ...inside) {
  return element("label", {}, ...inside, ` ${label}`);
}

// A slider over moments from 0 to a last one, and a button that plays them, evenly, in eight seconds.
function player(words, last, changed) {
  const slider = element("input", { type: "range", min: 0, max: last, step: "any", value: 0, ariaLabel: words });
  const button = element("button", { type: "button", textContent: "Play" });
  let began = null;
  const stop = () => { began = null; button.textContent = "Play"; };
  const step = (now) => {
    if (began === null) return;
    slider.value = (now - began) / 8000 * Number(slider.max);
    changed();
    if (Number(slider.value) < Number(slider.max)) requestAnimationFrame(step); else stop();
  };
  button.addEventListener("click", () => {
    if (began !== null) return stop();
    const end = Number(slider.max), start = Number(slider.value) < end ? Number(slider.value) : 0;
    began = performance.now() - start / end * 8000;
    button.textContent = "Stop";
    requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => { stop(); changed(); });
  return { slider, button, stop };
}

// A bar of colours with the values at both its ends.
function colourBar() {
  const [low, colours, high] = [element("span"), element("i"), element("span")];
  const box = element("p", { className: "colours", hidden: true }, low, colours, high);
  const show = (shade) => {
    box.hidden = !shade;
    if (shade?.scale) colours.style.setProperty("--scale", shade.scale);
    if (shade) [low.textContent, high.textContent] = [shade.low, `${shade.high} ${shade.unit}`];
  };
  return { box, show };
}

// The view with a moment that moves.
function showLanding(holder, scene, times) {
  const canvas = holder.querySelector("canvas"), view = new View3d(canvas, scene), last = times.length - 1;
  const shown = element("output"), follows = element("input", { type: "checkbox" }), colour = element("select");
  const bar = colourBar();
  const draw = () => {
    view.moment = Math.min(Number(slider.value), last);
    const frame = Math.min(Math.floor(view.moment), last - 1), part = view.moment - frame;
    shown.textContent = `t = ${(times[frame] + part * (times[frame + 1] - times[frame])).toFixed(3)} s`;
    view.draw();
  };
  const { slider, button } = player("Time of the landing", last, draw);
  follows.checked = view.follows = Boolean(scene.follows);
  follows.addEventListener("change", () => { view.follows = follows.checked; draw(); });
  for (const name of ["body", ...scene.shades.map((one) => one.name)])
    colour.append(element("option", { value: name, textContent: name }));
  colour.addEventListener("change", () => {
    view.colourBy(colour.value === "body" ? null : colour.value);
    bar.show(scene.shades.find((one) => one.name === colour.value));
    draw();
  });
  const colours = element("label", { textContent: "colour of the grains by " }, colour);
  const choices = [control("follow the lander", follows), colours];
  holder.querySelector(".tools").append(button, slider, shown, ...choices, bar.box);
  draw();
  return view;
}

// What stands where it is: lines and triangles among the arrays.
function stillParts(found) {
  return [["floor", "TRIANGLES"], ["grid", "LINES"], ["mark", "LINES"], ["path", "LINES"]].flatMap(([name, kind]) =>
    found[`${name}_corner`] ? [{ kind, corner: found[`${name}_corner`], paint: found[`${name}_paint`] }] : []);
}

async function start3d(name, show) {
  const holder = document.getElementById(name), data = document.getElementById(`${name}-data`);
  if (!holder || !data) return null;
  const facts = JSON.parse(data.textContent), found = await inflate(facts.arrays);
  try {
    return show(holder, { ...triangles(found), ...facts, still: stillParts(found) }, found);
  } catch (error) {
    // An old browser or a machine without a picture: the figures above show the same.
    holder.querySelector(".tools").textContent = `No view here: ${error.message}.`;
    return null;
  }
}
