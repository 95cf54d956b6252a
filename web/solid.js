"use strict";
// The solid in three dimensions before it is saved: its triangles, each of one shade, turned by drag and keys.

const VERTEX = `attribute vec3 place, normal; uniform mat3 turn; uniform vec3 middle; uniform vec3 scale; varying vec3 side;
void main() { vec3 at = turn * (place - middle); side = turn * normal; gl_Position = vec4(at.xy * scale.xy, -at.z * scale.z, 1.0); }`;
const FRAGMENT = `precision mediump float; varying vec3 side; uniform vec3 colour;
void main() { float light = max(dot(normalize(side), normalize(vec3(-0.3, 0.5, 1.0))), 0.0); gl_FragColor = vec4(colour * (0.35 + 0.75 * light), 1.0); }`;

let solid = null; // what is shown: the context, the number of its corners, its middle and size, and how it is turned
const START = { spin: -0.5, tilt: -0.95, zoom: 1.3 }; // rad about the shaft, and of that towards the screen; of 1 all fits however it turns

// corners of triangles, and of each the outward normal: nine numbers for every triangle
function normalsOf(corners) {
  const normals = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; i += 9) {
    const [a, b] = [3, 6].map((k) => [0, 1, 2].map((axis) => corners[i + k + axis] - corners[i + axis]));
    const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const length = Math.hypot(...cross) || 1;
    for (let k = 0; k < 9; k++) normals[i + k] = cross[k % 3] / length;
  }
  return normals;
}

function programOf(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  return program;
}

function showSolid(corners) {
  const canvas = byId("solid-view");
  const gl = canvas.getContext("webgl", { antialias: true });
  const program = solid?.program || programOf(gl);
  for (const buffer of solid?.buffers || []) gl.deleteBuffer(buffer);
  const buffers = [gl.createBuffer(), gl.createBuffer()];
  for (const [i, [name, numbers]] of [["place", corners], ["normal", normalsOf(corners)]].entries()) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[i]);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    const at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 0, 0);
  }
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let i = 0; i < corners.length; i++) {
    low[i % 3] = Math.min(low[i % 3], corners[i]);
    high[i % 3] = Math.max(high[i % 3], corners[i]);
  }
  const middle = low.map((least, axis) => 0.5 * (least + high[axis]));
  const size = Math.hypot(...low.map((least, axis) => high[axis] - least));
  solid = { ...START, gl, program, buffers, middle, size, count: corners.length / 3 };
  const words = low.map((least, axis) => short(Number((high[axis] - least).toFixed(2)))).join(" × ");
  byId("solid-size").textContent = `${words} mm, ${corners.length / 9} triangles`;
  byId("solid-figure").hidden = false;
  drawSolid();
  byId("solid-figure").scrollIntoView({ behavior: "smooth", block: "nearest" });
}

function drawSolid() {
  if (!solid || byId("solid-figure").hidden) return;
  const { gl, program, middle, size, count, spin, tilt, zoom } = solid;
  const { canvas } = gl;
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map((px) => Math.round(px * devicePixelRatio));
  gl.viewport(0, 0, canvas.width, canvas.height);
  const place = (name) => gl.getUniformLocation(program, name);
  const [c, s, d, t] = [Math.cos(spin), Math.sin(spin), Math.cos(tilt), Math.sin(tilt)];
  gl.uniformMatrix3fv(place("turn"), false, [c, s * d, s * t, -s, c * d, c * t, 0, -t, d]); // by columns
  gl.uniform3fv(place("middle"), middle);
  const reach = (2 * zoom * Math.min(canvas.width, canvas.height)) / size;
  gl.uniform3f(place("scale"), reach / canvas.width, reach / canvas.height, 1 / size);
  const metal = getComputedStyle(tab).getPropertyValue("--metal").trim();
  gl.uniform3fv(place("colour"), [1, 3, 5].map((i) => parseInt(metal.slice(i, i + 2), 16) / 255));
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.drawArrays(gl.TRIANGLES, 0, count);
}

function turnSolid(spin, tilt, zoom = 1) {
  if (!solid) return;
  solid.spin += spin;
  solid.tilt = Math.min(Math.max(solid.tilt + tilt, -Math.PI), 0);
  solid.zoom = Math.min(Math.max(solid.zoom * zoom, 0.5), 8);
  drawSolid();
}

const view = byId("solid-view");
view.addEventListener("pointerdown", (event) => view.setPointerCapture(event.pointerId));
view.addEventListener("pointermove", (event) => event.buttons && turnSolid(event.movementX / 120, event.movementY / 120));
const BY_KEY = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1], "+": [0, 0, 1.1], "-": [0, 0, 1 / 1.1] };
view.addEventListener("keydown", (event) => {
  const way = BY_KEY[event.key];
  if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation(); // an arrow would turn the shaft
  turnSolid(...way);
});
new ResizeObserver(drawSolid).observe(view);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawSolid);
view.addEventListener("webglcontextlost", () => (solid = null));

byId("solid").addEventListener("click", async () => {
  if (!view.getContext("webgl")) {
    byId("hand-told").textContent = "This browser has no WebGL, so the solid is not shown here; its STL, saved, opens in any viewer of solids.";
    showUnrolled();
    return;
  }
  const late = setTimeout(showUnrolled, PATIENCE);
  const answer = await ofMade(byId("solid"), "making the solid", "solid");
  clearTimeout(late);
  if (!answer) return;
  byId("solid-meanwhile").hidden = true;
  showSolid(new Float32Array(answer.files[0].bytes.buffer));
});
tab.addEventListener("made", () => {
  byId("solid-figure").hidden = true;
  byId("solid-meanwhile").hidden = true;
});

// Until its mesh is there, or where none comes, a drum is shown unrolled.
const PATIENCE = 2000; // ms
function showUnrolled() {
  const drawn = byId("panels").querySelector("#development");
  if (!drawn || made?.text !== recipe.text) return;
  const copy = drawn.cloneNode(true);
  for (const part of [copy, ...copy.querySelectorAll("[id]")]) part.removeAttribute("id");
  byId("solid-unrolled").replaceChildren(copy);
  byId("solid-figure").hidden = true;
  byId("solid-meanwhile").hidden = false;
  byId("solid-meanwhile").scrollIntoView({ block: "nearest" });
}
