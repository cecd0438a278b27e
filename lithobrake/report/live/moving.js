"use strict";
// The two views of the page in three dimensions: a landing that moves, and the body with where landers come down.

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

// The view with a moment that moves.
function showLanding(holder, scene, times) {
  const canvas = holder.querySelector("canvas"), view = new View3d(canvas, scene), last = times.length - 1;
  const ends = { min: 0, max: last, step: "any", value: 0 };
  const slider = element("input", { type: "range", ...ends, ariaLabel: "Time of the landing" });
  const shown = element("output"), button = element("button", { type: "button", textContent: "Play" });
  const follows = element("input", { type: "checkbox" }), colour = element("select");
  const draw = () => {
    view.moment = Math.min(Number(slider.value), last);
    const frame = Math.min(Math.floor(view.moment), last - 1), part = view.moment - frame;
    shown.textContent = `t = ${(times[frame] + part * (times[frame + 1] - times[frame])).toFixed(3)} s`;
    view.draw();
  };
  let began = null;
  const step = (now) => {
    if (began === null) return;
    // Frames come evenly, eight seconds for all of them.
    slider.value = (now - began) / 8000 * last;
    draw();
    if (Number(slider.value) < last) requestAnimationFrame(step); else stop();
  };
  const stop = () => { began = null; button.textContent = "Play"; };
  button.addEventListener("click", () => {
    if (began !== null) return stop();
    const start = Number(slider.value) < last ? Number(slider.value) : 0;
    began = performance.now() - start / last * 8000;
    button.textContent = "Stop";
    requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => { stop(); draw(); });
  follows.checked = view.follows = Boolean(scene.follows);
  follows.addEventListener("change", () => { view.follows = follows.checked; draw(); });
  for (const name of ["body", ...scene.shades.map((one) => one.name)])
    colour.append(element("option", { value: name, textContent: name }));
  colour.addEventListener("change", () => { view.colourBy(colour.value === "body" ? null : colour.value); draw(); });
  const colours = element("label", { textContent: "colour by " }, colour);
  const choices = [control("follow the lander", follows), colours];
  holder.querySelector(".tools").append(button, slider, shown, ...choices);
  draw();
  return view;
}

async function start3d(name, show) {
  const holder = document.getElementById(name), data = document.getElementById(`${name}-data`);
  if (!holder || !data) return null;
  const facts = JSON.parse(data.textContent), found = await inflate(facts.arrays);
  try {
    return show(holder, { ...triangles(found), ...facts }, found);
  } catch (error) {
    // An old browser or a machine without a picture: the figures above show the same.
    holder.querySelector(".tools").textContent = `No view here: ${error.message}.`;
    return null;
  }
}

const landing3d = start3d("landing-3d", (holder, scene, found) =>
  showLanding(holder, { ...scene, poses: poses(found, scene), shading: found }, found.times));
const body3d = start3d("body-3d", (holder, scene, found) => {
  const lines = found.path_corner ? { corner: found.path_corner, paint: found.path_paint } : null;
  const still = Float32Array.of(0, 0, 0, 0, 0, 0, 0, 1);
  const view = new View3d(holder.querySelector("canvas"), { ...scene, lines, poses: still });
  view.draw();
  return view;
});
