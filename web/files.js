"use strict";
// What is made and judged, files that go out, and somebody's that come in.

// --- files ----------------------------------------------------------------------------------------------------------

const TYPES = { svg: "image/svg+xml", html: "text/html", json: "application/json", csv: "text/csv", zip: "application/zip" };

function downloads(list, files) {
  for (const old of list.querySelectorAll("a")) URL.revokeObjectURL(old.href);
  list.replaceChildren(...files.map(download));
}

function download({ name, bytes }) {
  const type = TYPES[name.split(".").at(-1)] || "application/octet-stream";
  const link = element("a", { href: URL.createObjectURL(new Blob([bytes], { type })), download: name }, name);
  return element("li", {}, link, ` ${bytes.length < 1000 ? `${bytes.length} B` : `${(bytes.length / 1000).toFixed(1)} kB`}`);
}

function save(name, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type: "application/yaml" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// A call that judges, from a button: what was made before is marked.
async function long(button, words, call, input, files) {
  if (underWay) return null;
  markOlder("This is of the run before: another one is under way.");
  const answer = await atWork(button, words, (said) => work.ask(call, input, files, said));
  if (!answer || answer.faults) markOlder("This is of a run before.");
  return answer;
}

// What takes its time, from a button: beside that stand its stage, its seconds and Stop. `run` is given what shows a
// stage; its answer is null where it was stopped, which `halt` does. One such thing is under way.
let underWay = false;
let halting = halted;
async function atWork(button, words, run, halt = halted) {
  if (underWay) return null;
  underWay = true;
  halting = halt;
  const busy = byId("busy");
  button.after(byId("at-work"));
  tab.classList.add("working");
  byId("stop").disabled = false;
  const begun = performance.now();
  const seconds = () => (performance.now() - begun) / 1000;
  let stage = work.ready ? "" : "Python is coming";
  const show = () => {
    byId("seconds").textContent = `${seconds().toFixed(0)} s`;
    busy.textContent = `${words}${stage ? `: ${stage}` : ""}…`;
  };
  const clock = setInterval(show, 250);
  show();
  const answer = await run((told) => {
    stage = told;
    show(); // at once: it may be done before the clock's next stroke
  });
  clearInterval(clock);
  underWay = false;
  tab.classList.remove("working");
  byId("stop").disabled = true;
  byId("seconds").textContent = "";
  busy.textContent = !answer ? "stopped" : answer.faults ? "nothing came of it" : `done in ${seconds().toFixed(1)} s${whereFrom(button)}`;
  tab.dataset.seconds = String(seconds());
  return answer;
}

// where what was made stands, of a button outside of that
function whereFrom(button) {
  const judged = byId("judged");
  if (judged.contains(button)) return "";
  return `, see ${button.compareDocumentPosition(judged) & Node.DOCUMENT_POSITION_PRECEDING ? "above" : "below"}`;
}

// what stands there is not what was asked for last
function markOlder(words) {
  byId("judged").classList.add("older");
  byId("since").textContent = words;
}

// what was made or judged of a recipe, which may have changed meanwhile
function showJudged(answer, head, { name, text }, rejected = "") {
  const judged = byId("judged");
  judged.hidden = false;
  judged.classList.remove("older");
  judgedText = text;
  showSince();
  byId("judged-head").textContent = head;
  const absent = (answer.missing || []).map(({ what, why }) => `\n${what} cannot be made in a browser: ${why}`);
  const elsewhere = `\nSave the recipe: camgeo export ${name}.yaml makes what is left out here, on a machine.`;
  const missing = absent.join("") + (absent.length ? elsewhere : "");
  byId("outcome").textContent = `${answer.verdict}${rejected && !answer.ok ? `\n${rejected}` : ""}${missing}`;
  byId("next").replaceChildren();
  downloads(byId("files"), answer.files);
  takeMade(null);
  const page = byId("page").cloneNode(); // a new frame, as another page in the same one is an entry of the history
  page.srcdoc = answer.page;
  page.hidden = !answer.page;
  byId("page").replaceWith(page);
  tab.dataset.judged = String(Number(tab.dataset.judged || 0) + 1);
  judged.scrollIntoView({ behavior: "smooth", block: "start" });
}

byId("make").addEventListener("click", async () => {
  if (typed) changed();
  const { name, text, tables } = recipe;
  byId("faults").replaceChildren();
  const answer = await long(byId("make"), "making and judging", "make", { name, text }, encodedTables());
  if (!answer) return;
  if (answer.faults) return showFaults(answer.faults, answer.trace);
  showJudged(answer, "Made and judged", { name, text }, "A check fails, so no file to make it from is given out; the page below shows which.");
  takeMade({ name, text, tables, files: answer.files, ok: answer.ok });
});

function halted() {
  work.stop();
  changed();
}

byId("stop").addEventListener("click", () => halting());

let somebodys = null; // a drawing or a solid: its name and its bytes
const MOST = 60e6; // bytes of a file; a browser's Python has 2 GB

async function takeFiles(list) {
  for (const file of list) {
    const name = clean(file.name);
    const end = name.split(".").at(-1).toLowerCase();
    if (file.size > MOST) notice(`${file.name} has ${(file.size / 1e6).toFixed(0)} MB; this page takes up to ${MOST / 1e6} MB. camgeo on your machine takes more.`);
    else if (["yaml", "yml"].includes(end)) beginRecipe({ name: name.replace(/\.ya?ml$/i, ""), text: await file.text(), tables: recipe.tables });
    else if (end === "csv" || end === "txt") takeTable(name, await file.text());
    else if (!tab.dataset.kinds.split(" ").includes(end)) {
      notice(`${file.name} is nothing that this page reads: give a recipe (yaml), a table of lifts (csv, txt), or a drawing or a solid (${tab.dataset.kinds.replaceAll(" ", ", ")}).`);
      byId("notice").scrollIntoView({ block: "nearest" });
    } else {
      somebodys = { name, bytes: new Uint8Array(await file.arrayBuffer()) };
      byId("chosen").textContent = name;
      byId("file-faults").replaceChildren();
      byId("with-file").hidden = false;
      byId("gap").labels[0].hidden = !isDrawing();
      tab.dispatchEvent(new Event("chosen"));
      byId("with-file").scrollIntoView({ behavior: "smooth", block: "nearest" });
    }
  }
}

// a table stays beside the recipe, which can name it, and is its motion where that is asked for
function takeTable(name, text) {
  noteStep(null);
  put({ ...snapshot(), tables: { ...recipe.tables, [name]: text } });
  const use = element("button", { type: "button", className: "main" }, "Use it as the motion");
  use.addEventListener("click", async () => {
    if (await rewritten("with_table", { table: name })) notice("");
  });
  notice(`${name} is here, and the recipe can name it.`, use);
  byId("notice").classList.add("news");
  byId("notice").scrollIntoView({ block: "nearest" });
}

// only lines of a drawing have ends
function isDrawing() {
  return tab.dataset.drawings.split(" ").includes(somebodys?.name.split(".").at(-1).toLowerCase());
}

function givenGap() {
  return isDrawing() ? pointed(byId("gap").value) : "";
}

async function onForeign(button, words, call, input) {
  byId("file-faults").replaceChildren();
  const answer = await long(button, words, call, input, { ...encodedTables(), [somebodys.name]: somebodys.bytes.slice() });
  if (!answer?.faults) return answer;
  byId("file-faults").replaceChildren(...faultRows(answer.faults, answer.trace));
  byId("file-faults").scrollIntoView({ block: "nearest" });
  return null;
}

byId("verify").addEventListener("click", async () => {
  const { name, text } = recipe;
  const file = somebodys.name; // another one may come meanwhile
  const answer = await onForeign(byId("verify"), "judging", "verify", { name, text, file, units: byId("units").value, gap: givenGap() });
  if (answer) showJudged(answer, `${file} by the recipe`, { name, text });
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
