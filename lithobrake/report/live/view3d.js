"use strict";
// Bodies in three dimensions with plain WebGL 2: all triangles in one buffer, each corner with the number of its body;
// poses in a texture that the corners read, so that a moment is one number and a picture one draw call.

// Texels in a row of the texture of poses: no machine has narrower ones.
const ROW = 2048;

const CORNERS = `#version 300 es
precision highp float;
precision highp sampler2D;
in vec3 corner;
in float body;
in vec3 paint;
uniform sampler2D poses;
uniform float moment, bodies, shaded, isStill;
uniform mat4 camera;
out vec3 place, colour;

vec4 texel(float frame, int part) {
  int number = 2 * int(frame * bodies + body) + part;
  return texelFetch(poses, ivec2(number % ${ROW}, number / ${ROW}), 0);
}

// Dark blue over teal to yellow, told apart by colour-blind readers too.
vec3 scale(float share) {
  vec3 low = mix(vec3(.27, .0, .33), vec3(.13, .57, .55), min(2. * share, 1.));
  return mix(low, vec3(.99, .91, .14), max(2. * share - 1., 0.));
}

void main() {
  // Ground and lines stand where they are, whatever moves.
  if (isStill > .5) {
    place = corner;
    colour = paint;
    gl_Position = camera * vec4(place, 1.);
    return;
  }
  float frame = floor(moment), part = moment - frame;
  vec4 here = texel(frame, 0), there = part > 0. ? texel(frame + 1., 0) : here;
  vec4 turn = texel(frame, 1), next = part > 0. ? texel(frame + 1., 1) : turn;
  vec4 q = normalize(mix(turn, dot(turn, next) < 0. ? -next : next, part));
  // Quaternions stand as x, y, z, w.
  vec3 turned = corner + 2. * cross(q.xyz, cross(q.xyz, corner) + q.w * corner);
  place = turned + mix(here.xyz, there.xyz, part);
  // Between two frames straight on the scale, which is one of equal factors. The lander, the last, keeps its own.
  colour = shaded > .5 && body < bodies - 1.5 ? scale(mix(here.w, there.w, part)) : paint;
  gl_Position = camera * vec4(place, 1.);
}`;

const FACES = `#version 300 es
precision highp float;
in vec3 place, colour;
uniform vec3 light;
uniform float isFlat;
out vec4 shown;

void main() {
  // Flat faces: their normal is that of the triangle on the screen.
  vec3 normal = isFlat > .5 ? vec3(0., 0., 1.) : normalize(cross(dFdx(place), dFdy(place)));
  float sun = max(dot(normal, light), 0.);
  shown = vec4(colour * (.62 + .08 * normal.z + .34 * sun), 1.);
}`;

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, CORNERS], [gl.FRAGMENT_SHADER, FACES]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  gl.useProgram(made);
  return made;
}

// Column-major product of the perspective and of a look from `eye` to `target`, z up.
function cameraMatrix(eye, target, aspect, near, far) {
  const sub = (a, b) => a.map((one, k) => one - b[k]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((one) => one / Math.hypot(...a));
  const back = unit(sub(eye, target)), right = unit(cross([0, 0, 1], back)), up = cross(back, right);
  // A third of a right angle upright; a tall screen sees as much across.
  const reach = 1 / Math.tan(Math.PI / 12) * Math.min(1, aspect), depth = (far + near) / (near - far);
  const rows = [
    [...right, -dot(right, eye)].map((one) => one * reach / aspect),
    [...up, -dot(up, eye)].map((one) => one * reach),
    [...back, -dot(back, eye)].map((one, k) => one * depth + (k === 3 ? 2 * far * near / (near - far) : 0)),
    [...back, -dot(back, eye)].map((one) => -one),
  ];
  return Float32Array.from({ length: 16 }, (_, k) => rows[k % 4][Math.floor(k / 4)]);
}

class View3d {
  // scene: corner [3 n], body [n], paint [3 n] of the corners; poses [8 frames bodies]: place, shade, quaternion;
  // shades by name [frames bodies]: places on the scale of colours, from 0 to 255; still: what stands where it is, lines
  // or triangles of corners and paints; labels: words and place [m] of each, and whether the body may hide it.
  constructor(canvas, scene) {
    Object.assign(this, { canvas, scene, moment: 0, drawCalls: 0 });
    this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("this browser has no WebGL 2");
    const { gl } = this;
    this.program = program(gl);
    this.bodies = this.held(scene.corner, scene.body, scene.paint);
    this.still = (scene.still ?? []).map(({ corner, paint, kind }) =>
      ({ kind, count: corner.length / 3, held: this.held(corner, new Float32Array(corner.length / 3), paint) }));
    this.overlay = new Overlay(canvas, scene.labels ?? []);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    this.colourBy(null);
    gl.enable(gl.DEPTH_TEST);
    this.orbit = { ...scene.orbit };
    this.listen();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // Colour by a shade of this name, or each body by its own paint; poses go to the machine with it.
  colourBy(name) {
    const { gl, scene } = this, rows = Math.ceil(scene.poses.length / 4 / ROW);
    const texels = new Float32Array(4 * ROW * rows);
    texels.set(scene.poses);
    this.shade = name;
    if (name) scene.shading[name].forEach((shade, place) => { texels[8 * place + 3] = shade / 255; });
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, ROW, rows, 0, gl.RGBA, gl.FLOAT, texels);
  }

  held(corner, body, paint) {
    const { gl } = this, found = gl.createVertexArray();
    gl.bindVertexArray(found);
    for (const [name, data, size] of [["corner", corner, 3], ["body", body, 1], ["paint", paint, 3]]) {
      const place = gl.getAttribLocation(this.program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      const isByte = data instanceof Uint8Array;
      gl.vertexAttribPointer(place, size, isByte ? gl.UNSIGNED_BYTE : gl.FLOAT, isByte, 0, 0);
    }
    return found;
  }

  // Where the last body is, between two frames.
  lander() {
    const count = this.scene.bodyCount, frame = Math.floor(this.moment), part = this.moment - frame;
    const at = (one) => this.scene.poses.subarray(8 * (one * count + count - 1), 8 * (one * count + count - 1) + 3);
    const here = at(frame), there = part ? at(frame + 1) : here;
    return Array.from(here, (one, k) => one + part * (there[k] - one));
  }

  draw() {
    const { gl, canvas, scene, orbit } = this, sharp = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * sharp), height = Math.round(canvas.clientHeight * sharp);
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const target = this.follows ? this.lander() : orbit.target;
    const level = Math.cos(orbit.elevation);
    const away = [level * Math.cos(orbit.azimuth), level * Math.sin(orbit.azimuth), Math.sin(orbit.elevation)];
    const eye = target.map((one, k) => one + orbit.distance * away[k]);
    const set = (name, kind, ...values) => gl[`uniform${kind}`](gl.getUniformLocation(this.program, name), ...values);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const seen = cameraMatrix(eye, target, width / height, orbit.distance / 50, 50 * orbit.distance);
    set("camera", "Matrix4fv", false, seen);
    set("moment", "1f", this.moment);
    set("bodies", "1f", scene.bodyCount);
    set("shaded", "1f", this.shade ? 1 : 0);
    // A sun at the upper left of whoever looks.
    const turn = orbit.azimuth - 1, light = [0.66 * Math.cos(turn), 0.66 * Math.sin(turn), 0.75];
    set("light", "3f", ...light);
    set("isFlat", "1f", 0);
    set("isStill", "1f", 0);
    gl.bindVertexArray(this.bodies);
    gl.drawArrays(gl.TRIANGLES, 0, scene.corner.length / 3);
    set("isFlat", "1f", 1);
    set("isStill", "1f", 1);
    for (const { kind, count, held } of this.still) {
      gl.bindVertexArray(held);
      gl.drawArrays(gl[kind], 0, count);
    }
    this.drawCalls = 1 + this.still.length;
    this.overlay.show(seen, eye, orbit.distance);
  }

  // Drag to turn, wheel or two fingers to come nearer, arrow keys for both.
  listen() {
    const { canvas, orbit } = this, fingers = new Map();
    const turn = (x, y) => {
      orbit.azimuth -= 0.008 * x;
      orbit.elevation = Math.min(Math.max(orbit.elevation + 0.008 * y, -1.5), 1.5);
    };
    const first = orbit.distance, nearer = (factor) => {
      orbit.distance = Math.min(Math.max(orbit.distance * factor, 0.1 * first), 10 * first);
    };
    const apart = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const was = fingers.size === 2 ? apart() : 0;
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      if (fingers.size === 2) nearer(was / apart()); else turn(event.clientX - before[0], event.clientY - before[1]);
      this.draw();
    });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("wheel", (event) => {
      // Whoever scrolls the page must get past a picture.
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      nearer(Math.exp(0.001 * event.deltaY));
      this.draw();
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [12, 0], ArrowRight: [-12, 0], ArrowUp: [0, 12], ArrowDown: [0, -12] };
      const step = steps[event.key], near = { "+": 0.9, "-": 1.1 }[event.key];
      if (!step && !near) return;
      event.preventDefault();
      if (step) turn(...step); else nearer(near);
      this.draw();
    });
  }
}
