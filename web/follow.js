"use strict";
// The part of the live page where a follower runs on somebody's file without a recipe.

// which boxes a follower has; one that has none of a kind leaves that box out
function boxesOf(touch, arm, yoke) {
  const round = touch !== "flat";
  return {
    radius: touch === "roller" || touch === "shoe",
    width: !round && !arm,
    offset: !arm && !yoke,
    pivot: arm,
    arm: arm && round,
    side: arm,
    yoke: !arm,
    track: touch === "roller" && !yoke,
  };
}

function followerBoxes() {
  return boxesOf(byId("touch").value, byId("led").value === "arm", byId("led").value === "stem" && byId("yoke").checked);
}

function showFollower() {
  for (const [id, there] of Object.entries(followerBoxes())) byId(id).labels[0].hidden = !there;
}

function follower() {
  const boxes = followerBoxes();
  const touch = byId("touch").value;
  const length = (id) => (boxes[id] ?? true ? pointed(byId(id).value) : "");
  return {
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
  };
}

byId("follow-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const answer = await onForeign("following…", "follow", { file: somebodys.name, follower: follower() });
  if (!answer) return;
  showJudged(answer, `What ${somebodys.name} does`);
  if (!answer.recipe) return;
  const button = element("button", { type: "button" }, "Make it the recipe");
  button.addEventListener("click", () => {
    beginRecipe({ name: answer.name, text: answer.recipe, tables: answer.tables });
    byId("main").scrollIntoView();
  });
  byId("files").append(element("li", {}, button));
});

for (const id of ["touch", "led", "yoke"]) byId(id).addEventListener("change", showFollower);
showFollower();
