"use strict";
// How the page begins: starters, the tools above the recipe, and the first design. It runs behind every other script.

// --- starters -------------------------------------------------------------------------------------------------------

async function listStarters() {
  const answer = await fetch(tab.dataset.starters);
  const starters = await answer.json();
  for (const starter of starters) {
    const picture = element("img", { alt: "", loading: "lazy", src: `pictures/${starter.name}${starter.shipped ? "-shipped" : ""}.svg` });
    const button = element("button", { type: "button" }, picture, element("b", {}, starter.task), starter.title);
    button.addEventListener("click", () => {
      byId("begin").open = false;
      beginRecipe({ name: starter.name, text: starter.text, tables: starter.tables });
      byId("desk-head").scrollIntoView({ block: "nearest" });
    });
    const item = element("li", {}, button);
    item.dataset.name = starter.name;
    item.dataset.words = `${starter.name} ${starter.task} ${starter.title} ${starter.also}`.toLowerCase();
    byId(starter.shipped ? "shipped" : "starters").append(item);
  }
  findStarters(); // words may stand there already
}
let listing = null; // under way: it may be opened again meanwhile
byId("begin").addEventListener("toggle", () => {
  if (!byId("starters").children.length) listing ??= listStarters().finally(() => (listing = null));
});
byId("find").addEventListener("input", findStarters);
function findStarters() {
  const words = byId("find").value.toLowerCase().split(/[\s,;.]+/);
  for (const item of document.querySelectorAll(".starters li")) {
    item.hidden = !words.every((word) => item.dataset.words.includes(word));
  }
  const shown = (list) => byId(list).querySelectorAll("li:not([hidden])").length;
  const count = shown("starters") + shown("shipped");
  byId("shipped-head").hidden = !shown("shipped");
  byId("found").textContent = count ? "" : "Nothing is found by these words. Say what touches the cam, or what it is for: roller, flat, arm, valve, toy, yoke.";
}

// --- tools ----------------------------------------------------------------------------------------------------------

byId("undo").addEventListener("click", () => back(recipe.done, recipe.undone));
byId("redo").addEventListener("click", () => back(recipe.undone, recipe.done));
byId("save").addEventListener("click", () => {
  save(`${recipe.name}.yaml`, recipe.text);
  for (const [name, text] of Object.entries(recipe.tables)) save(name, text);
});
// a link is short: it leaves comments out, which the tab's own address keeps
byId("link").addEventListener("click", async () => {
  const bare = recipe.bare?.of === recipe.text ? recipe.bare.text : recipe.text;
  const link = location.href.split("#")[0] + (await packed({ ...snapshot(), text: bare }));
  const kept = recipe.beside ? " and the kept design" : "";
  const holds = `the recipe${bare === recipe.text ? "" : " without its comments"}${kept}, in ${link.length} characters`;
  try {
    await navigator.clipboard.writeText(link);
    byId("told").textContent = `The link is copied. It holds ${holds}.`;
  } catch {
    const box = element("input", { readOnly: true, value: link, "aria-label": "link" });
    byId("told").replaceChildren(`Copy this link, which holds ${holds}: `, box);
    box.select();
  }
});
byId("forget").addEventListener("click", () => {
  keeps = false;
  forget();
  byId("keeps").textContent = "Forgotten: this browser keeps nothing more of this tab but its address and history.";
});
// the address holds the recipe, so places of the page are gone to without it
for (const link of document.querySelectorAll('a[href^="#"]')) {
  link.addEventListener("click", (event) => {
    event.preventDefault();
    byId(link.hash.slice(1)).scrollIntoView();
  });
}
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

window.addEventListener("hashchange", arrived);

// the recipe of the address; without one the last design of this browser, or the first example
async function begin() {
  numberLines([]);
  const linked = holdsRecipe(location.hash);
  const hash = linked ? location.hash : kept();
  if (linked && !isWhole(hash)) return refuse();
  play(firstScene);
  const next = isWhole(hash) ? await unpacked(hash).catch(() => null) : null;
  place = next?.at ?? null;
  if (next) own = hash;
  else if (linked) return refuse();
  if (next && !linked) history.replaceState(null, "", hash);
  put(next || first);
}
begin();
