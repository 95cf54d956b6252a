"use strict";
// The recipe as text and as a form: both change the one text, and its faults stand at both.

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

let typed = 0; // timer of letters that are read when no more come; 0 for none
function endTyping() {
  clearTimeout(typed);
  typed = 0;
}

byId("text").addEventListener("input", () => {
  noteStep("text");
  changeCount += 1;
  recipe.text = byId("text").value;
  recipe.fields = [];
  lastBox = "";
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
  lastBox = changes[0][0].path;
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

let formOf = ""; // which boxes stand there
function showForm() {
  const shape = JSON.stringify(recipe.fields.map(({ path, kind, unit, choices, about, before }) => [path, kind, unit, choices, about, before]));
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
    if (slider) slider.hidden = field.value === null;
    if (!slider || slider.hidden || document.activeElement === slider) return;
    if (!(field.value > Number(slider.min) && field.value < Number(slider.max)) || slider.dataset.fresh) {
      const { low, high, by } = range(field);
      Object.assign(slider, { min: low, max: high, step: by });
      delete slider.dataset.fresh;
    }
    slider.value = field.value;
    slider.setAttribute("aria-valuetext", `${field.text} ${field.unit}`);
  });
}

// Faults at their boxes; one that no box is at stands at the one changed last, or the first, of what it is about. They
// stand in the list above the form too.
let lastBox = ""; // path of the field that was changed last
function showBoxFaults(faults) {
  for (const note of byId("form").querySelectorAll(".fault")) note.remove();
  for (const box of byId("form").querySelectorAll("[aria-invalid]")) box.removeAttribute("aria-invalid");
  for (const { path, told } of faults) {
    const index = fieldOf(path);
    const box = byId(`box-${index}`);
    if (!box || byId(`fault-${index}`)) continue;
    box.setAttribute("aria-invalid", "true");
    const note = element("p", { id: `fault-${index}`, className: "fault" }, told);
    box.parentElement.append(note);
    if (recipe.fields[index].path === lastBox) note.scrollIntoView({ block: "nearest" });
  }
}

// index of the field that a path is, or is about; -1 for none
function fieldOf(path) {
  const about = (outer) => {
    const within = recipe.fields.map((field) => field.path).filter((own) => own === outer || own.startsWith(`${outer}.`) || own.startsWith(`${outer}[`));
    return within.includes(lastBox) ? lastBox : within[0];
  };
  const found = path && (about(path) ?? about(path.replace(/[.[][^.[]*$/, "")));
  return recipe.fields.findIndex((field) => field.path === found);
}

// files that a browser cannot make of this part say so where they are ticked
async function showAbsent() {
  const shape = formOf;
  const { name, text } = recipe;
  const answer = await work.ask("absent", { name, text }, encodedTables());
  if (shape !== formOf) return;
  if (!answer) formOf = ""; // it was stopped: the boxes are made anew with the next answer, and it is asked again
  if (!answer?.absent) return;
  for (const [word, why] of Object.entries(answer.absent)) {
    const tick = byId("form").querySelector(`.ticks [value="${CSS.escape(word)}"]`);
    if (!tick) continue;
    tick.parentElement.title = why;
    tick.parentElement.append(" ", element("small", {}, "not in a browser"));
  }
}

// What is entered while the text is read, when no field has its place, is entered behind that: into the same box, if it
// stands there still.
let waiting = null;
function enterWaiting() {
  const act = waiting;
  waiting = null;
  if (recipe.fields.length) act?.();
}

function whenRead(box, act) {
  const held = box.type === "checkbox" ? "checked" : "value";
  box.addEventListener("change", () => {
    if (recipe.fields.length) return act();
    const given = box[held];
    waiting = () => {
      box[held] = given;
      if (box.isConnected) act();
    };
  });
}

// of a key whose name does not say what people look for
const MEANT = { "cam.arm": "sets the base radius" };

function row(field, index) {
  const id = `box-${index}`;
  const name = element("label", { htmlFor: id, title: field.about }, label(field.path));
  if (MEANT[field.path]) name.append(" ", element("small", {}, MEANT[field.path]));
  const made = element("div", { className: "field" }, name);
  made.dataset.path = field.path;
  if (field.kind === "choice") {
    const shown = (word) => (field.before && word === field.text ? `${word} (by default)` : word);
    const select = element("select", { id, className: "wide" }, ...field.choices.map((word) => new Option(shown(word), word)));
    whenRead(select, () => {
      const chosen = recipe.fields[index];
      edit([[chosen, (chosen.before || "") + select.value]], null); // before it stands its key, where the text has none
    });
    made.append(select);
    return made;
  }
  if (field.kind === "list") {
    name.replaceWith(element("span", { title: field.about }, label(field.path)));
    const boxes = field.choices.map((word) => {
      const tick = element("input", { type: "checkbox", value: word });
      whenRead(tick, () => {
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
  whenRead(box, () => entered(recipe.fields[index], box));
  box.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    box.dispatchEvent(new Event("change"));
  });
  box.setAttribute("aria-describedby", `fault-${index}`);
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
  const text = box.value.trim();
  if (!text) showBoxFaults([{ path: field.path, told: `empty: give a value${field.kind === "number" && field.value === null ? "" : `, such as ${field.text}`}` }]);
  if (!text) return;
  if (field.kind !== "number") {
    const written = /^[\w(][^:#,[\]{}"'\n]*$/.test(text) ? text : JSON.stringify(text);
    if (written !== field.text) edit([[field, written]], null);
    return;
  }
  const number = pointed(text);
  if (number === field.text) return;
  const from = startOf(field);
  const moved = together(field, amount(number, field), 10 ** -Math.max(decimals(number), 3));
  edit([[field, number], ...(moved || [])], null);
  astray = moved ? null : { path: field.path, text: number, from };
  byId("told").textContent = (moved || []).map(([other, rest]) => `${label(other.path)} follows: ${rest}`).join();
}

// what a box says in the unit of its field: a number or a fraction, with a unit or without; NaN for anything else
function amount(text, field) {
  const said = /^([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)(?:\/(\d+))?\s*([^\s\d].*)?$/i.exec(text);
  if (!said) return NaN;
  const factor = said[3] ? field.units[said[3]] / field.units[field.unit] : 1;
  return (Number(said[1]) / Number(said[2] || 1)) * factor;
}

function slid(field, value, by) {
  if (!field) return;
  const text = digits(value, by);
  if (Number(text) === field.value) return;
  const moved = together(field, Number(text), by);
  if (moved) edit([[field, text], ...moved], `slide ${field.path}`);
}

// What moves along with a field, from the last value at which it did: a number that is corrected, such as 400 for 40, has
// moved nothing meanwhile. Null where nothing can.
let astray = null; // a field whose text has moved nothing, and its value before
function startOf(field) {
  return astray?.path === field.path && astray.text.startsWith(field.text) ? astray.from : field.value;
}

function together(field, value, by) {
  const from = startOf(field);
  return from !== null && Number.isFinite(value) ? along(field, value - from, by) : null;
}

// What moves along with a change of a field, as it belongs together: of a motion the next segment gives what a segment
// takes, and the return falls what a rise rises. Null where that one would not stay above 0.
function along(field, change, by) {
  const other = partner(field);
  if (!other) return [];
  const same = field.unit === other.field.unit ? 1 : field.units[field.unit] / field.units[other.field.unit];
  const rest = other.value + (other.opposite ? -change : change) * same;
  if (!(rest > 0)) return null;
  return [[other.field, digits(rest, Math.min(by, 10 ** -decimals(other.field.text)))]];
}

function decimals(text) {
  return (text.split(".")[1] || "").length;
}

function partner(field) {
  const place = /^(.*\bmotion)\[(\d+)\]\.(over|dwell|rise|return)$/.exec(field.path);
  if (!place) return null;
  if (motion.behind === "nothing") return null; // a travel is as long as its segments, and ends where they do
  const [, list, index, key] = place;
  const numbers = recipe.fields.filter((entry) => entry.kind === "number" && entry.value !== null && entry.path.startsWith(`${list}[`));
  const count = 1 + Math.max(...numbers.map((entry) => Number(/\[(\d+)\]/.exec(entry.path.slice(list.length))[1])));
  const fieldAt = (i, keys) => numbers.find((entry) => keys.some((word) => entry.path === `${list}[${(i + count) % count}].${word}`));
  if (/^(over|dwell)$/.test(key) && /\b(over|dwell): *rest\b/.test(recipe.text)) return null; // that one takes what is left
  const wanted = { over: ["over", "dwell"], dwell: ["over", "dwell"], rise: ["return"], return: ["rise"] }[key];
  const way = key === "return" ? -1 : 1;
  for (let i = 1; i < count; i++) {
    const other = fieldAt(Number(index) + way * i, wanted);
    if (other) return { field: other, value: other.value, opposite: key === "over" || key === "dwell" };
  }
  return null;
}

byId("form").addEventListener("submit", (event) => event.preventDefault());

// --- fields that are not there yet, and the unit --------------------------------------------------------------------

let possible = [];
async function showMore() {
  const { name, text } = recipe;
  const answer = await work.ask("more", { name, text }, encodedTables());
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

byId("add").addEventListener("toggle", async () => {
  if (!byId("add").open) return;
  await showMore();
  byId("add").scrollIntoView({ block: "nearest" });
});
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
