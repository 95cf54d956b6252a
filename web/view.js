"use strict";
// What the page shows of a recipe: its picture, the verdict, faults and checks that fail.

// --- design ---------------------------------------------------------------------------------------------------------

let endPlayer = null;

const RESTING = 120; // ms that a slider that is held rests before its cam is checked
let judgedText = ""; // of the recipe that was made or judged last

async function changed() {
  endTyping();
  showSince();
  const turn = ++changeCount;
  await designed(recipe.name, recipe.text);
  if (turn !== changeCount) return; // an older change may end later, when its slider has rested
  tab.dataset.answered = String(turn);
  enterWaiting();
}

// whether what was made or judged is of another recipe than the one that stands there
function showSince() {
  if (!byId("judged").classList.contains("older")) byId("since").textContent = recipe.text === judgedText ? "" : "The recipe has changed since.";
}

async function designed(name, text) {
  byId("name").textContent = name;
  numberLines([]);
  remember();
  notice("");
  if (work.ready) showUnjudged();
  bringBeside();
  const picture = await work.ask("picture", { name, text }, encodedTables());
  if (!picture || recipe.text !== text) return;
  if (picture.drawing) showPicture(picture);
  if (step?.startsWith("slide")) await new Promise((done) => setTimeout(done, RESTING));
  if (recipe.text !== text) return;
  const answer = await work.ask("design", { name, text, figures: Boolean(recipe.beside) }, encodedTables());
  if (!answer || recipe.text !== text) return;
  tab.classList.remove("unjudged");
  showFaults(answer.faults, answer.trace);
  const fields = answer.fields || []; // none of a text on which camgeo has failed
  if (fields.length || !answer.faults.length) {
    recipe.fields = fields.filter(({ path }) => path !== "units"); // the unit is changed with all lengths
    showForm();
  }
  showBoxFaults(answer.faults);
  if (byId("add").open) showMore();
  tab.classList.toggle("stale", Boolean(answer.faults.length));
  if (answer.units) byId("unit").value = answer.units;
  takeMotion(answer.motion);
  if (answer.bare !== undefined) recipe.bare = { of: text, text: answer.bare };
  if (!answer.scene) return;
  const verdict = byId("verdict");
  verdict.textContent = answer.verdict;
  verdict.className = `verdict ${answer.ok ? "ok" : "failed"}`;
  byId("why").hidden = answer.ok;
  byId("checks").innerHTML = answer.checks;
  showFailed(answer.failed);
  showBeside(answer.figures);
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
  const same = shown?.name === picture.name && !shown.linked && shown.input.name === picture.input.name;
  const none = { plots: [], rests: [], linked: false, panels: "" };
  play({ ...firstScene, ...shown, player: null, ...picture, marks: [], ...(same ? {} : none) });
  countShown();
}

function countShown() {
  tab.dataset.shown = String(Number(tab.dataset.shown || 0) + 1);
}

const firstScene = JSON.parse(byId("first").textContent);
let shown = null; // the scene that stands there
function play(scene) {
  const arrives = scene !== shown && scene !== firstScene; // and is no other look at what stood there before
  shown = scene;
  tab.dispatchEvent(new Event("plays"));
  tab.classList.remove("empty");
  showPanels(scene.panels || "");
  const root = document.documentElement;
  const begin = place !== null && arrives ? { at: place, playing: false } : endPlayer
    ? { at: Number(root.dataset.at), playing: root.dataset.playing === "true" }
    : { at: 0, playing: !window.matchMedia("(prefers-reduced-motion: reduce)").matches };
  if (arrives) place = null;
  if (endPlayer) endPlayer();
  endPlayer = playScene(scene, begin);
  tab.dispatchEvent(new Event("played"));
}

// panels of a kind of cams of its own, which its player moves
let panels = "";
function showPanels(html) {
  if (html === panels) return;
  panels = html;
  byId("panels").hidden = !html;
  byId("panels").innerHTML = html;
}

// --- faults ---------------------------------------------------------------------------------------------------------
// what the whole page has to say, with buttons; it stands above everything else
function notice(text, ...buttons) {
  byId("notice").hidden = !text;
  byId("notice").classList.remove("news"); // which is no fault
  byId("notice").replaceChildren(text, ...buttons);
}

// no recipe, no cam, no verdict
function showNothing() {
  if (endPlayer) endPlayer();
  endPlayer = null;
  shown = null;
  tab.classList.add("empty");
  tab.classList.remove("unjudged", "stale");
  byId("stage").querySelector("figure").replaceChildren();
  showPanels("");
  for (const id of ["checks", "failed", "faults", "form", "name"]) byId(id).replaceChildren();
  formOf = "";
  numberLines([]);
  byId("verdict").textContent = "no recipe";
  byId("verdict").className = "verdict";
  byId("why").hidden = true;
  document.documentElement.dataset.ready = "true";
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
