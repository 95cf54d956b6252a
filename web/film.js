"use strict";
// A film of the drawing: one turn, or one way to and fro, as a GIF and as WebM.

const PICTURES = 72; // of a turn
const HUNDREDTHS = 5; // of a second that each stands
const MOST_BYTES = 3e6;
const SIDES = [480, 360, 270, 200]; // px of the longer side: the first whose film is small enough

// What the drawing has at each of the pictures: its elements, each with its look, and the matrix of each. The shaft
// stands afterwards where it stood, before the screen has shown anything of it.
function filmed() {
  const root = document.documentElement;
  const [at, playing] = [root.dataset.at, root.dataset.playing === "true"];
  const svg = byId("drawing");
  const parts = [...svg.querySelectorAll("path, circle, text")].filter((part) => part.getClientRects().length && getComputedStyle(part).visibility !== "hidden");
  const looks = parts.map(lookOf);
  const outlines = parts.map((part) => part.getAttribute("d"));
  const { most, closed } = shown.input;
  const slider = byId("slider");
  const turnTo = (angle) => {
    slider.value = angle;
    slider.dispatchEvent(new Event("input"));
  };
  const poses = Array.from({ length: PICTURES }, (_, i) => {
    const share = i / PICTURES;
    turnTo(most * (closed ? share : 1 - Math.abs(1 - 2 * share)));
    const back = svg.getScreenCTM().inverse();
    const spots = parts.map((part) => (part.tagName === "text" ? [Number(part.getAttribute("x")), Number(part.getAttribute("y"))] : null));
    return parts.map((part, k) => {
      const drawn = part.getAttribute("d");
      const shape = drawn === outlines[k] ? null : new Path2D(drawn); // of a part that is drawn anew at each angle
      return { matrix: DOMMatrix.fromMatrix(back.multiply(part.getScreenCTM())), spot: spots[k], shape };
    });
  });
  turnTo(at);
  if (playing) byId("play").click();
  const { x, y, width, height } = svg.viewBox.baseVal;
  const ground = [svg, svg.closest(".stage"), tab].map((one) => getComputedStyle(one).backgroundColor).find((colour) => !/^rgba.*, 0\)$/.test(colour));
  return { looks, poses, ground, box: [x, y, width, height], name: shown.name };
}

function lookOf(part) {
  const style = getComputedStyle(part);
  const shape = part.tagName === "path" ? new Path2D(part.getAttribute("d")) : new Path2D();
  if (part.tagName === "circle") shape.arc(part.cx.baseVal.value, part.cy.baseVal.value, part.r.baseVal.value, 0, 2 * Math.PI);
  const { fill, fillRule, fontStyle, fontWeight, fontFamily } = style;
  const [opacity, alpha, width, size] = [style.opacity, style.fillOpacity, style.strokeWidth, style.fontSize].map(parseFloat);
  const dashes = style.strokeDasharray === "none" ? [] : style.strokeDasharray.split(/[ ,]+/).map(parseFloat);
  const words = part.tagName === "text" ? part.textContent : "";
  return { shape, words, fill, fillRule, opacity, alpha, stroke: style.stroke, width, dashes, size, font: [fontStyle, fontWeight, fontFamily] };
}

// draws picture `i` of a film on a canvas
function paint(canvas, film, i) {
  const context = canvas.getContext("2d", { willReadFrequently: true });
  const [x, y, width] = film.box;
  const scale = canvas.width / width;
  const toCanvas = new DOMMatrix([scale, 0, 0, scale, -x * scale, -y * scale]);
  context.globalAlpha = 1;
  context.fillStyle = film.ground;
  context.fillRect(0, 0, canvas.width, canvas.height);
  Object.assign(context, { lineJoin: "round", lineCap: "round", textAlign: "center", textBaseline: "middle" });
  for (const [k, look] of film.looks.entries()) {
    const { matrix, spot, shape } = film.poses[i][k];
    context.setLineDash(look.dashes);
    if (spot) {
      const at = toCanvas.multiply(matrix).transformPoint(new DOMPoint(...spot));
      const [slant, weight, family] = look.font;
      context.font = `${slant} ${weight} ${look.size * scale}px ${family}`;
      context.lineWidth = look.width * scale;
      context.globalAlpha = look.opacity;
      if (look.stroke !== "none") context.strokeStyle = look.stroke;
      if (look.stroke !== "none") context.strokeText(look.words, at.x, at.y);
      context.fillStyle = look.fill;
      context.fillText(look.words, at.x, at.y);
      continue;
    }
    const path = new Path2D();
    path.addPath(shape || look.shape, toCanvas.multiply(matrix));
    context.globalAlpha = look.opacity * look.alpha;
    if (look.fill !== "none") context.fillStyle = look.fill;
    if (look.fill !== "none") context.fill(path, look.fillRule);
    context.globalAlpha = look.opacity;
    context.lineWidth = look.width;
    if (look.stroke !== "none") context.strokeStyle = look.stroke;
    if (look.stroke !== "none") context.stroke(path);
  }
  return context;
}

function canvasFor(film, side) {
  const [, , width, height] = film.box;
  const scale = side / Math.max(width, height);
  return element("canvas", { width: Math.round(width * scale), height: Math.round(height * scale) });
}

let cut = false; // the film that is made is no longer wanted
const breath = () => new Promise((done) => setTimeout(done)); // the page answers meanwhile

async function gifOf(film, said) {
  for (const side of SIDES) {
    const canvas = canvasFor(film, side);
    const { width, height } = canvas;
    const picture = (i) => paint(canvas, film, i).getImageData(0, 0, width, height).data;
    const gif = new Gif(width, height, paletteOf([0, 1, 2, 3, 4, 5].map((i) => picture((i * PICTURES) / 6))), HUNDREDTHS);
    for (let i = 0; i < PICTURES && gif.size < MOST_BYTES; i++) {
      said(`picture ${i + 1} of ${PICTURES}`);
      gif.add(picture(i));
      await breath();
      if (cut) return null;
    }
    if (gif.size < MOST_BYTES) return { name: `${film.name}.gif`, bytes: gif.bytes() };
  }
  return { faults: [{ told: "This drawing does not fit into 3 MB, even at a small size." }] };
}

const WEBM = window.MediaRecorder?.isTypeSupported("video/webm") && "captureStream" in HTMLCanvasElement.prototype;

async function webmOf(film, said) {
  const canvas = canvasFor(film, SIDES[0]);
  paint(canvas, film, 0);
  const recorder = new MediaRecorder(canvas.captureStream(), { mimeType: "video/webm", videoBitsPerSecond: 2.5e6 });
  const pieces = [];
  recorder.ondataavailable = ({ data }) => pieces.push(data);
  const ended = new Promise((done) => (recorder.onstop = done));
  recorder.start();
  const begun = performance.now();
  // by the clock, as it is recorded; the last picture is the first one of the next turn
  for (let i = 0; i <= PICTURES && !cut; i = Math.max(i + 1, Math.floor((performance.now() - begun) / (10 * HUNDREDTHS)))) {
    said(`picture ${i + 1} of ${PICTURES}`);
    paint(canvas, film, i % PICTURES);
    await new Promise((done) => setTimeout(done, Math.max(0, begun + 10 * HUNDREDTHS * (i + 1) - performance.now())));
  }
  recorder.stop();
  await ended;
  return cut ? null : { name: `${film.name}.webm`, bytes: new Uint8Array(await new Blob(pieces).arrayBuffer()) };
}

for (const [id, make] of [["gif", gifOf], ["webm", webmOf]]) {
  byId(id).addEventListener("click", async () => {
    const mine = made;
    byId("hand-told").textContent = "";
    const begin = (said) => {
      cut = false; // of one that is under way it stays as it is
      return make(filmed(), said);
    };
    const file = await atWork(byId(id), "filming the drawing", begin, () => (cut = true));
    if (!file || made !== mine) return;
    if (file.faults) byId("hand-told").textContent = file.faults[0].told;
    else handOver(file);
  });
}
byId("webm").hidden = !WEBM;
