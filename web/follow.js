"use strict";
// The part of the live page where a follower runs on somebody's file without a recipe.

// which boxes a follower has; one that has none of a kind leaves that box out
function boxesOf(touch, arm, yoke) {
  const round = touch !== "flat";
  return {
    radius: touch === "roller" || touch === "shoe",
    size: touch === "roller",
    width: !round && !arm,
    offset: !arm && !yoke,
    pivot: arm,
    arm: arm && round,
    side: arm,
    yoke: !arm,
    track: touch === "roller" && !yoke,
    across: isDrawing(),
  };
}

function followerBoxes() {
  return boxesOf(byId("touch").value, byId("led").value === "arm", byId("led").value === "stem" && byId("yoke").checked);
}

function showFollower() {
  for (const [id, there] of Object.entries(followerBoxes())) byId(id).labels[0].hidden = !there;
  const size = byId("touch").value === "roller" ? byId("size").value : "radius";
  byId("radius").labels[0].firstChild.data = `${size} `;
}

function follower() {
  const boxes = followerBoxes();
  const touch = byId("touch").value;
  const length = (id) => (boxes[id] ?? true ? pointed(byId(id).value) : "");
  return {
    diameter: boxes.size && byId("size").value === "diameter",
    roller: touch === "knife" ? "0" : touch === "roller" ? length("radius") : "",
    shoe: touch === "shoe" ? length("radius") : "",
    flat: touch === "flat",
    width: length("width"),
    offset: length("offset"),
    pivot: length("pivot"),
    arm: length("arm"),
    leading: boxes.side && byId("side").value === "leading",
    yoke: boxes.yoke && byId("yoke").checked,
    track: boxes.track ? byId("track").value : "external",
    x: length("at-x"),
    y: length("at-y"),
    rotation: byId("rotation").value,
    reading: length("reading"),
    units: byId("units").value,
    gap: givenGap(),
    across: boxes.across ? byId("across").value : "",
  };
}

tab.addEventListener("chosen", showFollower);
byId("follow-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const of = snapshot();
  const file = somebodys.name; // another one may come meanwhile
  const answer = await onForeign(byId("follow"), "following", "follow", { file, follower: follower() });
  if (!answer) return;
  showJudged(answer, `What ${file} does`, of);
  if (!answer.recipe) return;
  const button = element("button", { type: "button", className: "main" }, "Make it the recipe");
  button.addEventListener("click", () => {
    beginRecipe({ name: answer.name, text: answer.recipe, tables: answer.tables });
    byId("main").scrollIntoView();
  });
  byId("next").replaceChildren(button, " Then its motion is smooth, and every number of it can be changed.");
});

for (const id of ["touch", "size", "led", "yoke"]) byId(id).addEventListener("change", showFollower);
showFollower();
