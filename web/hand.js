"use strict";
// What was made is handed over as people share things: each button beside the files makes one more of them.

let made = null; // what stands there: name, text and tables of its recipe, its files, and whether every check holds

function takeMade(next) {
  made = next;
  byId("hand").hidden = !made;
  byId("hand-told").textContent = "";
  tab.dispatchEvent(new Event("made"));
}

// a call of the worker about what was made, from a button; null where nothing came of it, which is said
async function ofMade(button, words, call, input = {}, files = {}) {
  const { name, text, tables } = made;
  byId("hand-told").textContent = "";
  const mine = made;
  const answer = await atWork(button, words, (said) => work.ask(call, { name, text, ...input }, { ...encoded(tables), ...files }, said));
  if (made !== mine || !answer) return null;
  if (answer.faults) byId("hand-told").textContent = answer.faults.map(({ told, text: whole }) => told || whole).join(" ");
  return answer.faults ? null : answer;
}

// a file that was made besides: it is saved, and stands among the others
function handOver(file) {
  const list = byId("files");
  for (const old of list.querySelectorAll("a")) {
    if (old.download !== file.name) continue;
    URL.revokeObjectURL(old.href);
    old.parentElement.remove();
  }
  list.append(download(file));
  const link = list.lastElementChild.querySelector("a");
  made.files = [...made.files.filter(({ name }) => name !== file.name), file];
  link.click();
}

byId("zip").addEventListener("click", async () => {
  const files = made.files.filter(({ name }) => !name.endsWith(".zip"));
  const bytes = Object.fromEntries(files.map((file) => [file.name, file.bytes]));
  const tables = Object.keys(made.tables).filter((name) => made.text.includes(name));
  const answer = await ofMade(byId("zip"), "packing", "zipped", { files: [...files.map(({ name }) => name), ...tables] }, bytes);
  if (answer) handOver(answer.files[0]);
});

byId("pdf").addEventListener("click", async () => {
  const answer = await ofMade(byId("pdf"), "drawing 1:1", "paper");
  if (answer) handOver(answer.files[0]);
});

// a part that fails a check is not drawn to be made
tab.addEventListener("made", () => {
  for (const id of ["pdf", "solid"]) byId(id).hidden = !made?.ok;
});
