"use strict";
// The live page's state: the worker that designs and judges, the recipe with its steps, and the address that holds it.

const byId = (id) => document.getElementById(id);
const tab = byId("tab");

function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes("-") || key === "for" || key === "list") made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children);
  return made;
}

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
      notice(`Python could not be loaded: ${data.broken}. Reload the page; it needs a server, and a browser of 2023 or later.`);
      byId("loading").hidden = true;
      return;
    }
    if (data.stage !== undefined) {
      byId("loading").hidden = data.share === 1;
      byId("progress").value = data.share;
      byId("stage-of-loading").textContent = data.stage;
      this.ready = data.share === 1;
      if (this.ready) this.current?.said?.("");
      if (this.ready) tab.dataset.loaded = String(Math.round(performance.now()));
      return;
    }
    if (data.say !== undefined) {
      this.current?.said?.(data.say);
      return;
    }
    const { done } = this.current;
    this.current = null;
    done(data.error ? { faults: [{ line: 0, text: data.error }] } : { ...data.output, files: data.files });
    this.next();
  }

  // a promise of the answer; of a picture or a design that a newer one replaces it is null. What the call says on its
  // way is given to `said`
  ask(call, input, files = {}, said = null) {
    return new Promise((done) => {
      const older = this.waiting.findIndex((waiting) => OF_NEWEST.includes(waiting.call));
      if (OF_NEWEST.includes(call) && older >= 0) this.waiting.splice(older, 1)[0].done(null);
      this.waiting.push({ call, input, files, done, said });
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
  beside: null, // a design that is kept to compare with: its name, text and tables
  bare: null, // its text without comments, of the text that was read last
  undone: [],
  done: [],
};
const first = { name: recipe.name, text: recipe.text, tables: {} }; // the first example

const work = new Work();
let changeCount = 0; // changes of the recipe; the last that was answered stands in the page

// files that the recipe names, as the worker takes them
function encodedTables() {
  return encoded(recipe.tables);
}

function encoded(tables) {
  const encoder = new TextEncoder();
  return Object.fromEntries(Object.entries(tables).map(([name, text]) => [name, encoder.encode(text)]));
}

function snapshot() {
  return { name: recipe.name, text: recipe.text, tables: recipe.tables, beside: recipe.beside };
}

// a step that can be undone; what belongs to one movement of a slider is one step
let step = null;
function noteStep(movement) {
  if (movement === null || movement !== step) {
    recipe.done.push(snapshot());
    if (recipe.done.length > 200) recipe.done.shift();
    recipe.undone = [];
    noteEntry();
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

function put({ name, text, tables, beside = recipe.beside }) {
  Object.assign(recipe, { name, text, tables, beside, fields: [] });
  byId("text").value = text;
  showSteps();
  changed();
}

function beginRecipe(next) {
  noteStep(null);
  put({ tables: {}, ...next });
}

// --- address --------------------------------------------------------------------------------------------------------

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

// CRC-32 of letters: no change of one letter leaves it as it is
function checksum(letters) {
  let sum = ~0;
  for (let i = 0; i < letters.length; i++) {
    sum ^= letters.charCodeAt(i);
    for (let bit = 0; bit < 8; bit++) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return (~sum >>> 0).toString(16).padStart(8, "0");
}

// what stands behind the # for a recipe: the checksum of the rest, and the rest; a design that is kept comes last, but
// for the place of the shaft or the plate, which links of the examples have
async function packed({ name, text, tables, beside = null }) {
  const json = JSON.stringify([name, text, tables, ...(beside ? [[beside.name, beside.text, beside.tables]] : [])]);
  const bytes = await through(new TextEncoder().encode(json), new CompressionStream("deflate-raw"));
  let binary = "";
  for (const byte of bytes) binary += String.fromCharCode(byte);
  const letters = btoa(binary).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
  return `#r=${checksum(letters)}${letters}`;
}

// whether an address holds a recipe (true), a whole or a spoilt one, or names a place of the page (false)
function holdsRecipe(hash) {
  return hash.length > 1 && !document.getElementById(hash.slice(1));
}

function isWhole(hash) {
  const held = /^#r=([0-9a-f]{8})([\w-]+)$/.exec(hash);
  return held !== null && checksum(held[2]) === held[1];
}

// the recipe of a whole address
async function unpacked(hash) {
  const binary = atob(hash.slice(11).replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(binary, (letter) => letter.charCodeAt(0));
  const held = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
  return { ...whole(held), beside: held[3] ? whole(held[3]) : null, ...(Number.isFinite(held[4]) ? { at: held[4] } : {}) };
}

function whole([name, text, tables]) {
  if (typeof name !== "string" || typeof text !== "string" || !tables || typeof tables !== "object") throw new TypeError("no recipe");
  return { name: clean(name), text, tables: Object.fromEntries(Object.entries(tables).map(([key, value]) => [clean(key), String(value)])) };
}

function clean(name) {
  return name.replace(/[^\w.-]/g, "-").replace(/^[.-]+/, "").slice(-60) || "recipe";
}

// The address follows the recipe: each step that can be undone has one entry of the history, which movements and
// letters of the same step rewrite. Browsers allow a few changes a second.
let later = 0;
let due = null; // what is written next
let fresh = false; // whether that is a new entry
let own = ""; // what was written last
let writing = Promise.resolve();
let place = null; // where the design of a link stands when it is there

function noteEntry() {
  writeAddress();
  fresh = true;
}

function remember() {
  due = { ...snapshot(), entry: fresh || Boolean(due?.entry) };
  fresh = false;
  clearTimeout(later);
  later = setTimeout(writeAddress, 400);
}

function writeAddress() {
  clearTimeout(later);
  if (!due) return;
  const { entry, ...state } = due;
  due = null;
  writing = writing.then(async () => {
    const there = location.hash;
    if (holdsRecipe(there) && there !== own) return; // it was gone to, and is about to arrive
    const address = await packed(state);
    if (address === own || location.hash !== there) return; // what was gone back to meanwhile stays
    own = address;
    history[entry ? "pushState" : "replaceState"](null, "", address);
    if (recipe.done.length) keep(address); // a design of this tab's own, no link that was only looked at
  });
}

// takes the recipe of the address that was gone to; going back and forward is undoing and doing again where it can be
async function arrived() {
  const hash = location.hash;
  if (hash === own || !holdsRecipe(hash)) return;
  clearTimeout(later); // an address of the design that is left would take the place of this one
  due = null;
  const next = isWhole(hash) ? await unpacked(hash).catch(() => null) : null;
  if (location.hash !== hash) return;
  due = null;
  own = hash;
  place = next?.at ?? null;
  if (next === null) refuse();
  else if (isLast(recipe.done, next)) back(recipe.done, recipe.undone);
  else if (isLast(recipe.undone, next)) back(recipe.undone, recipe.done);
  else {
    beginRecipe(next);
    fresh = false;
  }
}

function isLast(steps, next) {
  return steps.length > 0 && JSON.stringify(steps.at(-1)) === JSON.stringify(next);
}

// a link that was cut or altered: nothing is drawn, and the address stays until a recipe is begun
function refuse() {
  clearTimeout(later);
  endTyping();
  own = location.hash;
  if (shown) noteStep(null);
  changeCount += 1;
  Object.assign(recipe, { name: "recipe", text: "", tables: {}, beside: null, fields: [], bare: null });
  byId("text").value = "";
  showNothing();
  const begin = element("button", { type: "button", className: "main" }, "Begin with the first example");
  begin.addEventListener("click", () => beginRecipe(first));
  notice("This link is not whole: it was cut or altered on its way, or an earlier version of this page made it. Ask for it again.", begin);
  tab.dataset.answered = String(changeCount);
}

// --- what this browser keeps ----------------------------------------------------------------------------------------

const KEPT = "camgeo.last";
let keeps = true;

function keep(address) {
  if (!keeps) return;
  try {
    localStorage.setItem(KEPT, address);
  } catch {
    forget(); // there is no room for it, or no leave: an older one would be taken for the last
  }
}

// the address of the last design; empty where none is kept
function kept() {
  try {
    return localStorage.getItem(KEPT) || "";
  } catch {
    return "";
  }
}

function forget() {
  try {
    localStorage.removeItem(KEPT);
  } catch {
    // nothing is kept where there is no leave
  }
}
