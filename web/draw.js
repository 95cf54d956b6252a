"use strict";
// The motion drawn: handles at the joints of its segments, on the plot of the lift, and what is done to a segment.

const plots = document.querySelector(".curves");
const layer = byId("joints");
plots.prepend(byId("draw"));
plots.append(layer, byId("bubble"));

let chosen = 0; // index of the segment that the tools are about, whose end has the focus
let grip = null; // of a joint that is being dragged
const REACH = 44; // px of a handle

// the plot of the lift in px of the section, and its axes; null where it is not there
function frame() {
  const svg = byId("plots").querySelector(".plot svg");
  if (!svg?.dataset.frame) return null;
  const [left, right, top, bottom, low, high] = JSON.parse(svg.dataset.frame);
  const [box, own] = [svg.getBoundingClientRect(), plots.getBoundingClientRect()];
  const [width, height] = [box.width - left - right, box.height - top - bottom];
  const place = { x: box.left - own.left - plots.clientLeft + left, y: box.top - own.top - plots.clientTop + top };
  return { ...place, width, height, low, high, left, top, box };
}

// degrees, or a travel as the recipe has it
function inputOf(angle) {
  return `${short(angle)}${unitOf(shown.input.unit)}`;
}

function across(at, angle) {
  return at.x + (angle / shown.input.most) * at.width;
}

function upright(at, lift) {
  return at.y + ((at.high - lift) / (at.high - at.low)) * at.height;
}

function unitOf(word) {
  return word === "°" ? "°" : ` ${word}`;
}

// a number as it is read, which the text has in full
function short(value) {
  return String(Number(value.toPrecision(6)));
}

// what a joint says of itself
function said(place, level) {
  const unit = shown.plots[0].unit;
  return `${inputOf(place.angle)}, ${short(level)}${unitOf(unit)}`;
}

// takes the motion of a design; where a recipe with faults has none, that stays which was drawn into its text
function takeMotion(answered) {
  const drawn = motion.text === recipe.text;
  if (!drawn && answered) byId("draw-told").textContent = ""; // it was of another text
  if (answered) motion = { ...answered, text: recipe.text };
  else if (!drawn) motion = { why: "" };
  showMotion();
}

// --- what is shown --------------------------------------------------------------------------------------------------

function drawable() {
  return !motion.why && motion.segments && shown?.plots.length && !tab.classList.contains("empty");
}

function showMotion() {
  const there = drawable();
  byId("draw").hidden = !there && !motion.why;
  byId("draw-why").textContent = motion.why;
  byId("draw-why").hidden = !motion.why;
  byId("draw-tools").hidden = !there;
  layer.hidden = !there;
  if (!there) return layer.replaceChildren();
  chosen = Math.min(chosen, motion.segments.length - 1);
  showSegments();
  showHandles();
}

function named(segment, index) {
  const unit = unitOf(shown.plots[0].unit);
  const stroke = segment.kind in STEPPED ? ` ${short(Math.abs(segment.change))}${unit}` : "";
  return `${index + 1}: ${segment.kind.replace("_", " and ")}${stroke} over ${inputOf(segment.over)}`;
}

function showSegments() {
  const list = byId("segment");
  list.replaceChildren(...motion.segments.map((segment, i) => new Option(named(segment, i), i)));
  list.value = chosen;
  const field = fieldAt(chosen, "law");
  const law = byId("segment-law");
  law.labels[0].hidden = !field?.choices;
  if (field?.choices) {
    law.replaceChildren(...field.choices.map((word) => new Option(word, word)));
    law.value = field.text;
  }
  byId("repeat").labels[0].hidden = !motion.closed;
  const least = `${motion.step}${unitOf(shown.input.unit)}`;
  byId("joint-keys-step").textContent = least;
  if (document.activeElement !== byId("repeat")) byId("repeat").value = motion.repeat;
  byId("delete").disabled = motion.segments.length < 2;
}

// handles stay the same elements while one of them is dragged
function showHandles() {
  const at = grip ? grip.at : frame();
  layer.hidden = !at;
  if (!at) return;
  const { segments } = motion;
  const base = foot(segments);
  const places = ends(segments);
  const wanted = places.map((_, k) => about(segments, k)).map(({ turns, lifts }, k) => (turns || lifts ? k : -1)).filter((k) => k >= 0);
  let curve = layer.querySelector("svg");
  if (!curve) {
    curve = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    curve.setAttribute("aria-hidden", "true");
    for (const name of ["preview", "selected"]) {
      const path = document.createElementNS(curve.namespaceURI, "path");
      path.setAttribute("class", name);
      curve.append(path);
    }
    layer.append(curve);
  }
  const handles = [...layer.querySelectorAll("button")];
  for (const extra of handles.splice(wanted.length)) extra.remove();
  while (handles.length < wanted.length) {
    handles.push(handle());
    layer.append(handles.at(-1));
  }
  for (const [i, k] of wanted.entries()) {
    const { turns, lifts } = about(segments, k);
    const level = places[k].level + base;
    handles[i].dataset.joint = k;
    handles[i].className = `joint${k === chosen ? " chosen" : ""}${grip?.joint === k ? " held" : ""}`;
    handles[i].style.translate = `${across(at, places[k].angle) - REACH / 2}px ${upright(at, level) - REACH / 2}px`;
    const ways = turns && lifts ? "" : turns ? `, in ${shown.input.noun === "shaft" ? "angle" : "travel"} only` : ", in lift only";
    handles[i].setAttribute("aria-label", `joint ${k + 1}: ${said(places[k], level)}${ways}`);
  }
  const path = (points) => points.map(([angle, lift], i) => `${i ? "L" : "M"}${across(at, angle).toFixed(1)} ${upright(at, lift).toFixed(1)}`).join("");
  curve.querySelector(".preview").setAttribute("d", grip?.moved ? path(wholeTurn(segments, base)) : "");
  curve.querySelector(".selected").setAttribute("d", path(lines(segments, chosen, chosen + 1, base)));
  const bubble = byId("bubble");
  bubble.hidden = !grip;
  if (!grip) return;
  const place = places[grip.joint];
  bubble.textContent = said(place, place.level + base);
  const x = Math.min(Math.max(across(at, place.angle), 76), plots.clientWidth - 76);
  const y = upright(at, place.level + base);
  bubble.style.translate = `${x}px ${y - at.y > 52 ? y - 46 : y + 30}px`;
}

// points of segments on the plot
function lines(segments, from, to, base) {
  const places = ends(segments);
  return segments.slice(from, to).flatMap((segment, i) => {
    const end = places[from + i];
    const begin = { angle: end.angle - segment.over, level: end.level - segment.change + base };
    const height = segment.kind === "rise_fall" ? fieldAt(from + i, "rise_fall")?.value || 0 : segment.change;
    return segment.shape.map((share, j) => [begin.angle + (segment.over * j) / (segment.shape.length - 1), begin.level + height * share]);
  });
}

// points of the motion over its whole input: its repeats, or the other half, which falls as the first one rises
function wholeTurn(segments, base) {
  const points = lines(segments, 0, segments.length, base);
  const parts = Math.round(shown.input.most / motion.total);
  const last = points.at(-1)[1];
  const other = ([angle, lift], k) => [angle + k * motion.total, motion.closed ? lift : last - lift + base];
  return Array.from({ length: parts }, (_, k) => points.map((point) => (k ? other(point, k) : point))).flat();
}

// --- a joint is moved -----------------------------------------------------------------------------------------------

function handle() {
  const made = element("button", { type: "button", "aria-describedby": "joint-keys" });
  made.addEventListener("focus", () => {
    if (grip) return;
    chosen = Number(made.dataset.joint);
    showSegments();
    showHandles();
  });
  made.addEventListener("pointerdown", (event) => event.button === 0 && gripped(event));
  made.addEventListener("pointermove", dragged);
  for (const name of ["pointerup", "pointercancel"]) made.addEventListener(name, released);
  made.addEventListener("keydown", pressed);
  made.addEventListener("keyup", (event) => KEYS[event.key] && endMovement());
  return made;
}

let movements = 0; // gestures so far: each is one step
function gripped(event) {
  event.preventDefault();
  if (!recipe.fields.length) return; // the text is being read
  const at = frame();
  const box = plots.getBoundingClientRect();
  const place = [event.clientX - box.left - plots.clientLeft, event.clientY - box.top - plots.clientTop];
  // where handles lie over each other the nearest one is meant
  const base = foot(motion.segments);
  const far = (one) => {
    const { angle, level } = ends(motion.segments)[Number(one.dataset.joint)];
    return Math.hypot(across(at, angle) - place[0], upright(at, level + base) - place[1]);
  };
  const nearest = [...layer.querySelectorAll("button")].sort((a, b) => far(a) - far(b))[0];
  const joint = Number(nearest.dataset.joint);
  const { angle, level } = ends(motion.segments)[joint];
  const off = [across(at, angle) - place[0], upright(at, level + base) - place[1]];
  grip = { joint, at, base, off, from: motion.segments, step: hundredth(motion.segments), movement: `slide joint ${++movements}`, handle: event.currentTarget };
  event.currentTarget.setPointerCapture(event.pointerId);
  chosen = joint;
  nearest.focus({ preventScroll: true });
  showSegments();
  showHandles();
}

function dragged(event) {
  if (!grip || event.currentTarget !== grip.handle) return;
  const { at, off, base } = grip;
  const box = plots.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left - plots.clientLeft + off[0], event.clientY - box.top - plots.clientTop + off[1]];
  const fine = event.shiftKey ? 0.1 : 1;
  const [turn, by] = [motion.step * fine, grip.step * fine];
  const angle = Math.round((((x - at.x) / at.width) * shown.input.most) / turn) * turn;
  const lift = Math.round((at.high - ((y - at.y) / at.height) * (at.high - at.low)) / by) * by;
  moveTo(angle, lift - base, by);
}

// puts the joint that is held at an angle and a displacement
function moveTo(angle, level, by) {
  const segments = withJoint(grip.from, grip.joint, angle, level, by);
  const same = (segment, i) => segment.over === motion.segments[i].over && segment.change === motion.segments[i].change;
  if (segments.every(same)) return;
  grip.moved = true;
  if (!writeSegments(segments, grip.movement)) return refused();
  showHandles();
}

function refused() {
  grip.moved = false;
  released();
  byId("draw-told").textContent = "This segment is changed as text: its numbers stand where they cannot be moved.";
}

function released(event) {
  if (!grip || (event && event.currentTarget !== grip.handle)) return;
  const { moved, joint } = grip;
  grip = null;
  endMovement();
  if (moved && shown) {
    for (const plot of shown.plots) delete plot.frame;
    play(shown);
  }
  showMotion();
  const place = ends(motion.segments)[joint];
  if (moved) byId("draw-told").textContent = `Joint ${joint + 1} is at ${said(place, place.level + foot(motion.segments))}.`;
}

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
function pressed(event) {
  const way = KEYS[event.key];
  if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation();
  if (!recipe.fields.length) return;
  const joint = Number(event.currentTarget.dataset.joint);
  if (!event.repeat || !step?.startsWith("slide joint")) movements += 1;
  const fine = event.shiftKey ? 0.1 : 1;
  const by = hundredth(motion.segments) * fine;
  const { angle, level } = ends(motion.segments)[joint];
  grip = { joint, at: frame(), from: motion.segments, movement: `slide joint ${movements}`, handle: event.currentTarget };
  moveTo(angle + way[0] * motion.step * fine, level + way[1] * by, by);
  grip = null;
  const place = ends(motion.segments)[joint];
  byId("draw-told").textContent = said(place, place.level + foot(motion.segments));
  showHandles();
}

function endMovement() {
  step = null;
}

// --- a segment is changed -------------------------------------------------------------------------------------------

async function changeSegments(change, at = 0) {
  const { name, text } = recipe;
  const answer = await work.ask("with_segments", { name, text, change, index: chosen, at }, encodedTables());
  if (!answer || recipe.text !== text) return;
  byId("draw-told").textContent = answer.faults ? answer.faults.map(({ told, text: whole }) => told || whole).join(" ") : "";
  if (answer.faults) return;
  chosen = answer.chosen;
  beginRecipe({ ...snapshot(), text: answer.text });
}

for (const change of ["split", "copy", "delete", "reverse"]) byId(change).addEventListener("click", () => changeSegments(change));
byId("add-joint").addEventListener("click", () => changeSegments("add", Number(document.documentElement.dataset.at)));
byId("repeat").addEventListener("change", () => changeSegments("repeat", Number(byId("repeat").value)));
byId("segment").addEventListener("change", () => {
  chosen = Number(byId("segment").value);
  showSegments();
  showHandles();
});
whenRead(byId("segment-law"), () => {
  const field = fieldAt(chosen, "law");
  if (field) edit([[field, (field.before || "") + byId("segment-law").value]], null);
});

// the plot keeps its scale while a joint is dragged
tab.addEventListener("plays", () => {
  if (grip && shown.plots[0]) shown.plots[0].frame = [grip.at.low, grip.at.high];
});
tab.addEventListener("played", showMotion);
new ResizeObserver(() => !grip && drawable() && showHandles()).observe(plots);
