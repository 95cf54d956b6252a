"use strict";
// A design that is kept beside the others: its outlines in the drawing, its curves in the plots, its figures in a table.

let beside = null; // what the worker says of the kept design, with its key
let room = null; // mm: the part of the plane that the drawing shows meanwhile; it only grows, so that its scale stays

const MM = { mm: 1, in: 25.4 };

function keyOf(kept) {
  return kept ? JSON.stringify([kept.name, kept.text, kept.tables]) : "";
}

// brings the kept design of the recipe, where another one stands there
async function bringBeside() {
  const key = keyOf(recipe.beside);
  if (key === (beside?.key || "")) return;
  beside = room = null;
  showBeside();
  if (!recipe.beside) return shown && play(shown);
  const { name, text, tables } = recipe.beside;
  beside = { key }; // under way
  const answer = await work.ask("beside", { name, text }, encoded(tables));
  if (key !== keyOf(recipe.beside)) return;
  beside = answer && { key, ...answer }; // what was stopped is asked for again
  if (answer?.faults) byId("told").textContent = `The kept design cannot be shown: ${answer.faults.map(({ told }) => told).join("; ")}`;
  if (shown) play(shown);
  showBeside();
}

// the box of a drawing in the plane of its scene: least x and y, greatest x and y
function boxOf({ drawing, view }) {
  const [width, height] = /viewBox="0 0 (\S+) (\S+)"/.exec(drawing).slice(1).map(Number);
  const [scale, x, y] = view;
  return [x, y - height / scale, x + width / scale, y];
}

function union(a, b) {
  return a ? [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])] : b;
}

tab.addEventListener("plays", () => {
  const { scene } = beside || {};
  delete shown.beside;
  for (const plot of shown.plots) delete plot.beside;
  if (!scene) return;
  const factor = MM[scene.unit] / MM[shown.unit];
  for (const one of [scene, shown]) room = union(room, boxOf(one).map((value) => value * MM[one.unit]));
  const { input } = scene;
  const alike = input.name === shown.input.name; // a turn and a travel go by their shares
  const reach = alike ? input.most * (input.unit === scene.unit ? factor : 1) : shown.input.most;
  const { drawing, bodies, player } = scene;
  shown.beside = { drawing, bodies, player, factor, reach, room: room.map((value) => value / MM[shown.unit]) };
  for (const plot of alike ? shown.plots : []) {
    const other = scene.plots.find(({ title, unit }) => title === plot.title && inMm(unit) === inMm(plot.unit));
    if (other) plot.beside = other.series.map((series) => (other.unit === plot.unit ? series : scaled(series, factor)));
  }
});

// a unit of an axis, as it is in mm
function inMm(unit) {
  return unit.replace(/^in\b/, "mm");
}

// a packed row of numbers times a factor
function scaled(row, by) {
  if ("c" in row) return { ...row, c: row.c * by };
  return "n" in row ? { ...row, n: row.n.map((value) => value && value * by) } : { ...row, d: row.d - Math.log10(by) };
}

// --- figures --------------------------------------------------------------------------------------------------------

let figuresNow = []; // of the design that was answered last
function showBeside(figures = figuresNow) {
  figuresNow = figures;
  byId("keep").textContent = recipe.beside ? "Keep this one instead" : "Keep to compare";
  byId("unkeep").hidden = !recipe.beside;
  byId("beside").hidden = !beside?.figures;
  if (!beside?.figures) return;
  const names = [...new Set([...figures, ...beside.figures].map(({ name }) => name))];
  const of = (list, name) => list.find((figure) => figure.name === name);
  const cell = (figure) => element("td", { className: "number" }, figure ? `${figure.text}${unitWord(figure.unit)}` : "–");
  const rows = names.map((name) => {
    const [now, then] = [of(figures, name), of(beside.figures, name)];
    const same = now && then && now.unit === then.unit && now.value !== null && then.value !== null;
    const by = same ? Number((now.value - then.value).toPrecision(6)) : NaN;
    const change = Number.isNaN(by) ? "" : by && Math.abs(by) > 1e-9 ? `${by > 0 ? "+" : "−"}${Math.abs(Number(by.toPrecision(3)))}` : "same";
    return element("tr", {}, element("th", { scope: "row" }, name.replaceAll("-", " ")), cell(then), cell(now), element("td", { className: "number" }, change));
  });
  byId("beside-name").textContent = recipe.beside.name;
  byId("beside-rows").replaceChildren(...rows);
}

function unitWord(unit) {
  return unit ? ` ${unit.replace("deg", "°").replace("^2", "²").replace("^3", "³")}`.replace(" °", "°") : "";
}

// --- keeping --------------------------------------------------------------------------------------------------------

function setBeside(kept) {
  noteStep(null);
  recipe.beside = kept;
  changed();
}

byId("keep").addEventListener("click", () => {
  const { name, text, tables } = recipe;
  setBeside({ name, text: recipe.bare?.of === text ? recipe.bare.text : text, tables });
});
byId("unkeep").addEventListener("click", () => {
  setBeside(null);
  byId("keep").focus(); // which stays
});
