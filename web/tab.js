"use strict";
// The live page: the recipe as text and as a form, one worker that designs and judges, and what it gives back.

const byId = (id) => document.getElementById(id);
const tab = byId("tab");

// --- the worker -----------------------------------------------------------------------------------------------------

// one call is under way; of pictures and designs that wait the newest is kept, other calls wait their turn before it
const OF_NEWEST = ["picture", "design"];
class Work {
  constructor() {
    this.number = 0;
    this.waiting = [];
    this.start();
  }

  start() {
    this.current = null;
    this.ready = false;
    this.worker = new Worker(tab.dataset.worker, { type: "module" });
    this.worker.onmessage = ({ data }) => this.heard(data);
    this.worker.onerror = (event) => this.heard({ broken: event.message || "its worker does not start" });
  }

  heard(data) {
    if (data.broken) {
      tell(`Python could not be loaded: ${data.broken}. Reload the page; it needs a server, and a browser of 2023 or later.`);
      byId("loading").hidden = true;
      return;
    }
    if (data.stage !== undefined) {
      byId("loading").hidden = data.share === 1;
      byId("progress").value = data.share;
      byId("stage-of-loading").textContent = data.stage;
      this.ready = data.share === 1;
      if (this.ready) tab.dataset.loaded = String(Math.round(performance.now()));
      return;
    }
    const { done } = this.current;
    this.current = null;
    done(data.error ? { faults: [{ line: 0, text: data.error }] } : { ...data.output, files: data.files });
    this.next();
  }

  // a promise of the answer; of a picture or a design that a newer one replaces it is null
  ask(call, input, files = {}) {
    return new Promise((done) => {
      const older = this.waiting.findIndex((waiting) => OF_NEWEST.includes(waiting.call));
      if (OF_NEWEST.includes(call) && older >= 0) this.waiting.splice(older, 1)[0].done(null);
      this.waiting.push({ call, input, files, done });
      this.next();
    });
  }

  next() {
    if (this.current || !this.waiting.length) return;
    this.current = this.waiting.shift();
    const { call, input, files } = this.current;
    this.worker.postMessage({ id: ++this.number, call, input, files });
  }

  stop() {
    this.worker.terminate();
    const ended = [this.current, ...this.waiting].filter(Boolean);
    this.waiting = [];
    this.start();
    for (const request of ended) request.done(null);
  }
}

// --- the recipe -----------------------------------------------------------------------------------------------------

const recipe = {
  name: "disc-roller",
  text: byId("text").value,
  tables: {}, // files that it names, by their names
  fields: [],
  undone: [],
  done: [],
};

function snapshot() {
  return { name: recipe.name, text: recipe.text, tables: recipe.tables };
}

// a step that can be undone; what belongs to one movement of a slider is one step
let step = null;
function noteStep(movement) {
  if (movement === null || movement !== step) {
    recipe.done.push(snapshot());
    if (recipe.done.length > 200) recipe.done.shift();
    recipe.undone = [];
  }
  step = movement;
  showSteps();
}

function showSteps() {
  byId("undo").disabled = !recipe.done.length;
  byId("redo").disabled = !recipe.undone.length;
}

function back(from, to) {
  if (!from.length) return;
  to.push(snapshot());
  step = null;
  put(from.pop());
}

function put({ name, text, tables }) {
  Object.assign(recipe, { name, text, tables, fields: [] });
  byId("text").value = text;
  showSteps();
  changed();
}

function beginRecipe(next) {
  noteStep(null);
  put({ tables: {}, ...next });
}

// --- design ---------------------------------------------------------------------------------------------------------

const work = new Work();
let endPlayer = null;
let formOf = "";
let changeCount = 0; // changes of the recipe; the last that was answered stands in the page

function encodedTables() {
  const encoder = new TextEncoder();
  return Object.fromEntries(Object.entries(recipe.tables).map(([name, text]) => [name, encoder.encode(text)]));
}

const RESTING = 120; // ms that a slider that is held rests before its cam is checked
let judgedText = ""; // of the recipe that was made or judged last

async function changed() {
  byId("since").textContent = recipe.text === judgedText ? "" : "The recipe has changed since.";
  const turn = ++changeCount;
  await designed(recipe.name, recipe.text);
  tab.dataset.answered = String(turn);
}

async function designed(name, text) {
  byId("name").textContent = name;
  numberLines([]);
  remember();
  if (work.ready) showUnjudged();
  const picture = await work.ask("picture", { name, text }, encodedTables());
  if (!picture || recipe.text !== text) return;
  if (picture.drawing) showPicture(picture);
  if (step?.startsWith("slide")) await new Promise((done) => setTimeout(done, RESTING));
  if (recipe.text !== text) return;
  const answer = await work.ask("design", { name, text }, encodedTables());
  if (!answer || recipe.text !== text) return;
  tab.classList.remove("unjudged");
  showFaults(answer.faults, answer.trace);
  if (answer.fields.length || !answer.faults.length) {
    recipe.fields = answer.fields.filter(({ path }) => path !== "units"); // the unit is changed with all lengths
    showForm();
  }
  if (byId("add").open) showMore();
  tab.classList.toggle("stale", Boolean(answer.faults.length));
  if (answer.units) byId("unit").value = answer.units;
  if (!answer.scene) return;
  const verdict = byId("verdict");
  verdict.textContent = answer.verdict;
  verdict.className = `verdict ${answer.ok ? "ok" : "failed"}`;
  byId("why").hidden = answer.ok;
  byId("checks").innerHTML = answer.checks;
  showFailed(answer.failed);
  play(answer.scene);
  if (!picture.drawing) countShown();
}

// what was said and plotted of the recipe before is no longer held to be right
function showUnjudged() {
  tab.classList.add("unjudged");
  const verdict = byId("verdict");
  verdict.textContent = "judging…";
  verdict.className = "verdict";
  byId("why").hidden = true;
}

// the mechanism before its checks
function showPicture(picture) {
  tab.classList.remove("stale");
  const same = shown.name === picture.name && !shown.linked;
  play({ ...shown, ...picture, marks: [], ...(same ? {} : { plots: [], rests: [], linked: false }) });
  countShown();
}

function countShown() {
  tab.dataset.shown = String(Number(tab.dataset.shown || 0) + 1);
}

let shown = null; // the scene that stands there
function play(scene) {
  shown = scene;
  const root = document.documentElement;
  const begin = endPlayer
    ? { degrees: Number(root.dataset.degrees), playing: root.dataset.playing === "true" }
    : { degrees: 0, playing: !window.matchMedia("(prefers-reduced-motion: reduce)").matches };
  if (endPlayer) endPlayer();
  endPlayer = playScene(scene, begin);
}

function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes("-") || key === "for" || key === "list") made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children);
  return made;
}

function tell(text) {
  byId("faults").replaceChildren(element("li", {}, element("b", {}, text)));
}

function faultRows(faults, trace) {
  const rows = faults.map((fault) => {
    const place = fault.line ? `line ${fault.line}: ` : "";
    const button = element("button", { type: "button" }, `${place}${fault.text}`);
    if (fault.line) button.addEventListener("click", () => goTo(fault.line, fault.column));
    return element("li", {}, button);
  });
  if (trace) rows.push(element("li", {}, element("pre", {}, trace)));
  return rows;
}

function showFaults(faults, trace) {
  byId("faults").replaceChildren(...faultRows(faults, trace));
  numberLines(faults.map((fault) => fault.line));
  const verdict = byId("verdict");
  if (faults.length) {
    verdict.textContent = faults.length === 1 ? "a fault in the recipe" : `${faults.length} faults in the recipe`;
    verdict.className = "verdict failed";
    byId("why").hidden = true;
  }
}

function showFailed(failed) {
  byId("failed").replaceChildren(
    ...failed.map((check) => {
      const row = element("div", { className: "failing" }, element("b", {}, check.head), ` ${check.text} `);
      row.insertAdjacentHTML("beforeend", check.place);
      if (check.line) {
        const button = element("button", { type: "button" }, `${check.path}, line ${check.line}`);
        button.addEventListener("click", () => goTo(check.line, check.column));
        row.append(button);
      }
      return row;
    }),
  );
}

// --- the text -------------------------------------------------------------------------------------------------------

function numberLines(bad) {
  const count = recipe.text.split("\n").length;
  const lines = [];
  for (let line = 1; line <= count; line++) {
    lines.push(element("span", { className: bad.includes(line) ? "bad" : "" }, String(line)), "\n");
  }
  byId("lines").replaceChildren(...lines);
  byId("lines").scrollTop = byId("text").scrollTop;
}

function goTo(line, column) {
  const area = byId("text");
  const rows = recipe.text.split("\n");
  const before = rows.slice(0, line - 1).reduce((sum, row) => sum + row.length + 1, 0);
  const place = before + Math.min(Math.max(column - 1, 0), (rows[line - 1] || "").length);
  area.focus();
  area.setSelectionRange(place, before + (rows[line - 1] || "").length);
  area.scrollTop = Math.max(0, (line - 4) * (area.scrollHeight / Math.max(rows.length, 1)));
  area.scrollIntoView({ block: "nearest" });
}

let typed = 0;
byId("text").addEventListener("input", () => {
  noteStep("text");
  changeCount += 1;
  recipe.text = byId("text").value;
  recipe.fields = [];
  numberLines([]);
  clearTimeout(typed);
  typed = setTimeout(changed, 120);
});
byId("text").addEventListener("blur", () => (step = null));
byId("text").addEventListener("scroll", () => (byId("lines").scrollTop = byId("text").scrollTop));
let leaving = false;
byId("text").addEventListener("keydown", (event) => {
  if (event.key === "Tab" && !leaving && !event.shiftKey) {
    event.preventDefault();
    document.execCommand("insertText", false, "  ");
  }
  leaving = event.key === "Escape";
});

// --- the form -------------------------------------------------------------------------------------------------------

// puts texts in the place of the values of fields, and moves the places behind them
function edit(changes, movement) {
  noteStep(movement);
  const ordered = [...changes].sort(([a], [b]) => b.start - a.start);
  for (const [field, text] of ordered) {
    recipe.text = recipe.text.slice(0, field.start) + text + recipe.text.slice(field.end);
    const grown = text.length - (field.end - field.start);
    for (const other of recipe.fields) {
      if (other.start > field.start) {
        other.start += grown;
        other.end += grown;
      }
    }
    field.end += grown;
    field.text = text;
    if (field.kind === "number") field.value = Number(text);
  }
  const area = byId("text");
  const top = area.scrollTop;
  area.value = recipe.text;
  area.scrollTop = top;
  changed();
}

const UNIT = { degrees: "°", inch: "in", "square mm": "mm²", "N/mm^2": "N/mm²" };

function label(path) {
  const words = path.replace(/\[(\d+)\]/g, (_, index) => ` ${Number(index) + 1} `).split(/[._]/).slice(path.includes(".") ? 1 : 0);
  return words.join(" ").replace(/\s+/g, " ").trim();
}

// the ends and the step of a slider about a value
function range(field) {
  const value = field.value;
  const size = Math.abs(value) || 10;
  const round = (x) => {
    const power = 10 ** Math.floor(Math.log10(x));
    return Math.ceil(x / power - 1e-9) * power;
  };
  let [low, high] = [value < 0 || field.least === null || field.least < 0 ? -round(2 * size) : 0, round(2 * size)];
  if (value > 0 && field.least !== null && field.least < 0) low = -round(size);
  if (field.unit === "degrees" && value >= 0 && field.most !== null && field.most <= 360) high = Math.min(field.most, round(2.5 * size));
  if (field.least !== null) low = Math.max(low, field.least);
  if (field.most !== null) high = Math.min(high, field.most);
  let by = 10 ** Math.floor(Math.log10((high - low) / 100));
  if (field.whole) by = field.odd ? 2 : 1;
  if (field.open && low === field.least) low += by;
  return { low, high, by };
}

function digits(value, by) {
  const places = Math.max(0, -Math.floor(Math.log10(by) + 1e-9));
  return String(Number(value.toFixed(places)));
}

function showForm() {
  const shape = JSON.stringify(recipe.fields.map(({ path, kind, unit, choices, about }) => [path, kind, unit, choices, about]));
  const form = byId("form");
  if (shape !== formOf) {
    formOf = shape;
    form.replaceChildren();
    const groups = new Map();
    showAbsent();
    recipe.fields.forEach((field, index) => {
      const top = field.path.includes(".") ? field.path.split(/[.[]/)[0] : "recipe";
      if (!groups.has(top)) {
        groups.set(top, element("fieldset", {}, element("legend", {}, top)));
        form.append(groups.get(top));
      }
      groups.get(top).append(row(field, index));
    });
  }
  recipe.fields.forEach((field, index) => {
    if (field.kind === "list") {
      const row = form.querySelector(`[data-path="${CSS.escape(field.path)}"]`);
      for (const tick of row.querySelectorAll("input")) tick.checked = field.words.includes(tick.value);
      return;
    }
    const box = byId(`box-${index}`);
    if (document.activeElement !== box || field.kind === "choice") box.value = field.text;
    box.parentElement.classList.toggle("long", field.kind === "number" && field.text.length > 6);
    const slider = byId(`slide-${index}`);
    if (!slider || document.activeElement === slider) return;
    if (!(field.value > Number(slider.min) && field.value < Number(slider.max)) || slider.dataset.fresh) {
      const { low, high, by } = range(field);
      Object.assign(slider, { min: low, max: high, step: by });
      delete slider.dataset.fresh;
    }
    slider.value = field.value;
    slider.setAttribute("aria-valuetext", `${field.text} ${field.unit}`);
  });
}

// files that a browser cannot make of this part say so where they are ticked
async function showAbsent() {
  const shape = formOf;
  const { name, text } = recipe;
  const answer = await work.ask("absent", { name, text }, encodedTables());
  if (!answer?.absent || shape !== formOf) return;
  for (const [word, why] of Object.entries(answer.absent)) {
    const tick = byId("form").querySelector(`.ticks [value="${CSS.escape(word)}"]`);
    if (!tick) continue;
    tick.parentElement.title = why;
    tick.parentElement.append(" ", element("small", {}, "not in a browser"));
  }
}

function row(field, index) {
  const id = `box-${index}`;
  const name = element("label", { htmlFor: id, title: field.about }, label(field.path));
  const made = element("div", { className: "field" }, name);
  made.dataset.path = field.path;
  if (field.kind === "choice") {
    const select = element("select", { id, className: "wide" }, ...field.choices.map((word) => new Option(word, word)));
    select.addEventListener("change", () => edit([[recipe.fields[index], select.value]], null));
    made.append(select);
    return made;
  }
  if (field.kind === "list") {
    name.replaceWith(element("span", { title: field.about }, label(field.path)));
    const boxes = field.choices.map((word) => {
      const tick = element("input", { type: "checkbox", value: word });
      tick.addEventListener("change", () => {
        const ticked = [...made.querySelectorAll("input")].filter((entry) => entry.checked).map((entry) => entry.value);
        const kept = recipe.fields[index].words.filter((entry) => ticked.includes(entry));
        if (!ticked.length) tick.checked = true;
        else edit([[recipe.fields[index], `[${[...new Set([...kept, ...ticked])].join(", ")}]`]], null);
      });
      return element("label", {}, tick, word);
    });
    made.append(element("div", { className: "ticks", role: "group", "aria-label": label(field.path) }, ...boxes));
    return made;
  }
  const box = element("input", { id, className: field.kind === "number" ? "box" : "wide" });
  if (field.kind === "number") box.inputMode = "decimal";
  box.addEventListener("change", () => entered(recipe.fields[index], box));
  box.addEventListener("keydown", (event) => {
    if (event.key === "Enter") event.preventDefault();
    if (event.key === "Enter") entered(recipe.fields[index], box);
  });
  made.append(box);
  if (field.kind === "number") {
    made.append(element("span", { className: "unit" }, UNIT[field.unit] || field.unit));
    const slider = element("input", { type: "range", id: `slide-${index}`, "aria-label": label(field.path) });
    slider.dataset.fresh = "true";
    slider.addEventListener("input", () => slid(recipe.fields[index], Number(slider.value), Number(slider.step)));
    slider.addEventListener("change", () => (step = null));
    made.append(slider);
  }
  return made;
}

// a number as it is typed with the decimal point and the sign of YAML
function pointed(text) {
  return text.trim().replace(/^−/, "-").replace(/^([+-]?\d*),(\d+)/, "$1.$2");
}

// what stands in a box: a number with a point or a comma, with or without a unit, or a text
function entered(field, box) {
  if (!field) return;
  let text = box.value.trim();
  if (field.kind === "number") text = pointed(text);
  else if (!/^[\w(][^:#,[\]{}"'\n]*$/.test(text)) text = JSON.stringify(text);
  box.setAttribute("aria-invalid", String(!text));
  if (!text || text === field.text) return;
  edit([[field, text]], null);
}

// a slider moves what belongs together: of a motion the next segment gives what a segment takes, and the return what a rise rises
function slid(field, value, by) {
  if (!field) return;
  const text = digits(value, by);
  const change = Number(text) - field.value;
  if (!change) return;
  const changes = [[field, text]];
  const other = partner(field);
  if (other) {
    const rest = other.value + (other.opposite ? -change : change);
    if (rest <= 0) return;
    changes.push([other.field, digits(rest, Math.min(by, 10 ** -decimals(other.field.text)))]);
  }
  edit(changes, `slide ${field.path}`);
}

function decimals(text) {
  return (text.split(".")[1] || "").length;
}

function partner(field) {
  const place = /^(.*\bmotion)\[(\d+)\]\.(over|dwell|rise|return)$/.exec(field.path);
  if (!place) return null;
  const [, motion, index, key] = place;
  const numbers = recipe.fields.filter((entry) => entry.kind === "number" && entry.path.startsWith(`${motion}[`));
  const count = 1 + Math.max(...numbers.map((entry) => Number(/\[(\d+)\]/.exec(entry.path.slice(motion.length))[1])));
  const fieldAt = (i, keys) => numbers.find((entry) => keys.some((word) => entry.path === `${motion}[${(i + count) % count}].${word}`));
  const wanted = { over: ["over", "dwell"], dwell: ["over", "dwell"], rise: ["return"], return: ["rise"] }[key];
  const way = key === "return" ? -1 : 1;
  for (let i = 1; i < count; i++) {
    const other = fieldAt(Number(index) + way * i, wanted);
    if (other) return { field: other, value: other.value, opposite: key === "over" || key === "dwell" };
  }
  return null;
}

byId("form").addEventListener("submit", (event) => event.preventDefault());

// --- fields that are not there yet, and the unit ----------------------------------------------------------------------

let possible = [];
async function showMore() {
  const { name, text } = recipe;
  const answer = await work.ask("more", { name, text });
  if (!answer || recipe.text !== text) return;
  if (!answer.more) return; // a text that is no recipe yet: its fault stands there already
  const list = byId("add-path");
  const chosen = list.value;
  possible = answer.more;
  const groups = new Map();
  for (const { path } of possible) {
    const top = path.includes(".") ? path.split(".")[0] : "recipe";
    if (!groups.has(top)) groups.set(top, element("optgroup", { label: top }));
    groups.get(top).append(new Option(label(path), path));
  }
  list.replaceChildren(...groups.values());
  if (possible.some(({ path }) => path === chosen)) list.value = chosen;
  showAbout();
}

function showAbout() {
  const field = possible.find(({ path }) => path === byId("add-path").value);
  byId("add-about").textContent = field ? `${field.about}; ${field.wanted}${field.default ? `; default: ${field.default}` : ""}` : "";
}

// asks for another text of the recipe, and takes it
async function rewritten(call, input) {
  const { name, text } = recipe;
  const answer = await work.ask(call, { name, text, ...input }, encodedTables());
  if (!answer || recipe.text !== text) return false;
  if (answer.faults) showFaults(answer.faults, answer.trace);
  else beginRecipe({ ...snapshot(), text: answer.text });
  return !answer.faults;
}

byId("add").addEventListener("toggle", () => byId("add").open && showMore());
byId("add-path").addEventListener("change", showAbout);
byId("add-it").addEventListener("click", async () => {
  const value = byId("add-value").value.trim().replace(/^([+-]?\d+),(\d+)$/, "$1.$2");
  if (value && (await rewritten("added", { path: byId("add-path").value, value }))) byId("add-value").value = "";
});
byId("add-value").addEventListener("keydown", (event) => event.key === "Enter" && byId("add-it").click());
byId("unit").addEventListener("change", async () => {
  const wanted = byId("unit").value;
  if (!(await rewritten("converted", { units: wanted }))) byId("unit").value = wanted === "mm" ? "inch" : "mm";
});

// --- address --------------------------------------------------------------------------------------------------------

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

async function packedAddress() {
  const text = JSON.stringify([recipe.name, recipe.text, recipe.tables]);
  const packed = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  let letters = "";
  for (const byte of packed) letters += String.fromCharCode(byte);
  return `#r=${btoa(letters).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "")}`;
}

async function unpackedAddress(hash) {
  const packed = /^#r=([\w-]+)$/.exec(hash);
  if (!packed) return null;
  const letters = atob(packed[1].replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const [name, text, tables] = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
  if (typeof name !== "string" || typeof text !== "string" || !tables || typeof tables !== "object") throw new TypeError("no recipe");
  return { name: clean(name), text, tables: Object.fromEntries(Object.entries(tables).map(([key, value]) => [clean(key), String(value)])) };
}

// the address follows the recipe; browsers allow a few changes a second
let later = 0;
let own = "";
function remember() {
  clearTimeout(later);
  later = setTimeout(async () => {
    own = await packedAddress();
    history.replaceState(null, "", own);
  }, 400);
}

async function arrived() {
  if (location.hash === own) return false;
  try {
    const next = await unpackedAddress(location.hash);
    if (next) beginRecipe(next);
    return Boolean(next);
  } catch {
    tell("The address holds no whole recipe: it was cut short on its way.");
    return false;
  }
}
window.addEventListener("hashchange", arrived);

// --- starters -------------------------------------------------------------------------------------------------------

async function listStarters() {
  const answer = await fetch(tab.dataset.starters);
  const starters = await answer.json();
  for (const starter of starters) {
    const picture = element("img", { alt: "", loading: "lazy", src: `pictures/${starter.name}${starter.shipped ? "-shipped" : ""}.svg` });
    const button = element("button", { type: "button" }, picture, element("b", {}, starter.name), starter.title);
    button.addEventListener("click", () => {
      byId("begin").open = false;
      beginRecipe({ name: starter.name, text: starter.text, tables: starter.tables });
      byId("desk-head").scrollIntoView({ block: "nearest" });
    });
    const item = element("li", {}, button);
    item.dataset.words = `${starter.name} ${starter.title}`.toLowerCase();
    byId(starter.shipped ? "shipped" : "starters").append(item);
  }
}
byId("begin").addEventListener("toggle", () => !byId("starters").children.length && listStarters());
byId("find").addEventListener("input", () => {
  const words = byId("find").value.toLowerCase().split(/\s+/);
  for (const item of document.querySelectorAll(".starters li")) {
    item.hidden = !words.every((word) => item.dataset.words.includes(word));
  }
});

// --- files ----------------------------------------------------------------------------------------------------------

const TYPES = { svg: "image/svg+xml", html: "text/html", json: "application/json", csv: "text/csv", zip: "application/zip" };

function downloads(list, files) {
  for (const old of list.querySelectorAll("a")) URL.revokeObjectURL(old.href);
  list.replaceChildren(
    ...files.map(({ name, bytes }) => {
      const type = TYPES[name.split(".").at(-1)] || "application/octet-stream";
      const link = element("a", { href: URL.createObjectURL(new Blob([bytes], { type })), download: name }, name);
      return element("li", {}, link, ` ${bytes.length < 1000 ? `${bytes.length} B` : `${(bytes.length / 1000).toFixed(1)} kB`}`);
    }),
  );
}

function save(name, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type: "application/yaml" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function clean(name) {
  return name.replace(/[^\w.-]/g, "-").replace(/^[.-]+/, "").slice(-60) || "recipe";
}

// a call that takes its time: meanwhile it can be stopped
async function long(words, call, input, files) {
  const busy = byId("busy");
  byId("stop").disabled = false;
  busy.textContent = words;
  const begun = performance.now();
  const answer = await work.ask(call, input, files);
  const seconds = ((performance.now() - begun) / 1000).toFixed(1);
  byId("stop").disabled = true;
  busy.textContent = answer ? `it took ${seconds} s` : "stopped";
  tab.dataset.seconds = String((performance.now() - begun) / 1000);
  return answer;
}

function showJudged(answer, head, rejected = "") {
  const judged = byId("judged");
  judged.hidden = false;
  judgedText = recipe.text;
  byId("since").textContent = "";
  byId("judged-head").textContent = head;
  const absent = (answer.missing || []).map(({ what, why }) => `\n${what} cannot be made in a browser: ${why}`);
  const elsewhere = `\nSave the recipe: camgeo export ${recipe.name}.yaml makes what is left out here, on a machine.`;
  const missing = absent.join("") + (absent.length ? elsewhere : "");
  byId("outcome").textContent = `${answer.verdict}${rejected && !answer.ok ? `\n${rejected}` : ""}${missing}`;
  downloads(byId("files"), answer.files);
  byId("page").srcdoc = answer.page;
  byId("page").hidden = !answer.page;
  tab.dataset.judged = String(Number(tab.dataset.judged || 0) + 1);
  judged.scrollIntoView({ behavior: "smooth", block: "start" });
}

byId("why").addEventListener("click", (event) => {
  event.preventDefault(); // the address holds the recipe
  byId("checks-head").scrollIntoView();
});

byId("make").addEventListener("click", async () => {
  clearTimeout(typed);
  const { name, text } = recipe;
  const answer = await long("making and judging…", "make", { name, text }, encodedTables());
  if (!answer) return;
  if (answer.faults) showFaults(answer.faults, answer.trace);
  else showJudged(answer, "Made and judged", "A check fails, so no file to make it from is given out; the page below shows which.");
});

byId("stop").addEventListener("click", () => {
  work.stop();
  changed();
});

let somebodys = null; // a drawing or a solid: its name and its bytes
const MOST = 60e6; // bytes of a file; a browser's Python has 2 GB

async function takeFiles(list) {
  for (const file of list) {
    const name = clean(file.name);
    const end = name.split(".").at(-1).toLowerCase();
    if (file.size > MOST) tell(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB; this page takes up to ${MOST / 1e6} MB. camgeo on your machine takes more.`);
    else if (["yaml", "yml"].includes(end)) beginRecipe({ name: name.replace(/\.ya?ml$/i, ""), text: await file.text(), tables: recipe.tables });
    else if (end === "csv" || end === "txt") {
      noteStep(null);
      put({ ...snapshot(), tables: { ...recipe.tables, [name]: await file.text() } });
      byId("busy").textContent = `the recipe can name ${name} now`;
    } else {
      somebodys = { name, bytes: new Uint8Array(await file.arrayBuffer()) };
      byId("chosen").textContent = name;
      byId("file-faults").replaceChildren();
      byId("with-file").hidden = false;
      byId("with-file").scrollIntoView({ behavior: "smooth", block: "nearest" });
    }
  }
}

async function onForeign(words, call, input) {
  byId("file-faults").replaceChildren();
  const answer = await long(words, call, input, { ...encodedTables(), [somebodys.name]: somebodys.bytes.slice() });
  if (!answer?.faults) return answer;
  byId("file-faults").replaceChildren(...faultRows(answer.faults, answer.trace));
  byId("file-faults").scrollIntoView({ block: "nearest" });
  return null;
}

byId("verify").addEventListener("click", async () => {
  const { name, text } = recipe;
  const answer = await onForeign("judging…", "verify", { name, text, file: somebodys.name, units: byId("units").value });
  if (answer) showJudged(answer, `${somebodys.name} by the recipe`);
});

byId("judge-form").addEventListener("submit", (event) => event.preventDefault());
for (const id of ["open", "choose"]) byId(id).addEventListener("click", () => byId("file").click());
byId("file").addEventListener("change", async (event) => {
  await takeFiles(event.target.files);
  event.target.value = "";
});
for (const kind of ["dragover", "dragleave", "drop"]) {
  document.addEventListener(kind, (event) => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    tab.classList.toggle("dropping", kind === "dragover");
    if (kind === "drop") takeFiles(event.dataTransfer.files);
  });
}

// --- tools ----------------------------------------------------------------------------------------------------------

byId("undo").addEventListener("click", () => back(recipe.done, recipe.undone));
byId("redo").addEventListener("click", () => back(recipe.undone, recipe.done));
byId("save").addEventListener("click", () => {
  save(`${recipe.name}.yaml`, recipe.text);
  for (const [name, text] of Object.entries(recipe.tables)) save(name, text);
});
byId("link").addEventListener("click", async () => {
  own = await packedAddress();
  history.replaceState(null, "", own);
  try {
    await navigator.clipboard.writeText(location.href);
    byId("busy").textContent = "the link is copied; it holds the recipe";
  } catch {
    byId("busy").textContent = "the link stands in the address";
  }
});
document.addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  const again = key === "y" || (key === "z" && event.shiftKey);
  if (key !== "z" && !again) return;
  event.preventDefault();
  if (again) back(recipe.undone, recipe.done);
  else back(recipe.done, recipe.undone);
});

// --- begin ----------------------------------------------------------------------------------------------------------

play(JSON.parse(byId("first").textContent));
numberLines([]);
arrived().then((begun) => {
  if (!begun) changed();
});
