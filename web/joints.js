"use strict";
// A motion as a list of segments, and what a joint between two of them changes: in numbers, and in the recipe's text.

let motion = { why: "" }; // of the design that was answered last, or as it was drawn since; segments where it has some

const STILL = ["dwell", "rise_fall", "displacement"]; // segments whose ends rise and fall together
const STEPPED = { rise: 1, return: -1 }; // which way a stroke goes

// the shortest text of a number without the rounding of sums
function brief(value) {
  return String(Number(value.toFixed(9)));
}

// angle and displacement at the end of each segment, from the beginning of the motion
function ends(segments) {
  let [angle, level] = [0, 0];
  return segments.map((segment) => ({ angle: (angle += segment.over), level: (level += segment.change) }));
}

// displacement at the beginning, above the lowest place; where its opposite follows a motion begins where it does
function foot(segments) {
  if (motion.behind === "opposite") return motion.start;
  const least = (of) => Math.min(0, ...ends(of).map(({ level }) => level));
  return motion.start + least(motion.segments) - least(segments);
}

// a hundredth of the greatest lift, to one digit
function hundredth(segments) {
  const levels = [0, ...ends(segments).map(({ level }) => level)];
  const heights = segments.filter(({ kind }) => kind === "rise_fall").map(({ shape }) => Math.max(...shape.map(Math.abs)));
  const lift = Math.max(...levels) - Math.min(...levels) || Math.max(0, ...heights) || 1;
  return Number((lift / 100).toPrecision(1));
}

// Segments about a joint, the end of segment k: those whose strokes change with its lift, and whether its angle can.
// A rest beside it moves as a whole; between two rests it becomes a peak.
function about(segments, k) {
  const last = segments.length - 1;
  const peak = k < last && segments[k].kind === "dwell" && segments[k + 1].kind === "dwell";
  let [before, behind] = [k, k + 1];
  while (!peak && before >= 0 && STILL.includes(segments[before].kind)) before -= 1;
  while (!peak && behind <= last && STILL.includes(segments[behind].kind)) behind += 1;
  const turns = k < last && !segments[k].free && !segments[k + 1].free;
  return { before, behind, peak, turns, lifts: before >= 0 && (behind <= last || !motion.closed) };
}

// the segments with a joint at another angle and displacement, as near as may be; `by` is the least step of a lift
function withJoint(segments, k, angle, level, by) {
  const { before, behind, peak, turns, lifts } = about(segments, k);
  const moved = segments.map((segment) => ({ ...segment }));
  const places = ends(segments);
  if (turns) {
    const least = Math.min(motion.step, segments[k].over, segments[k + 1].over);
    const begin = places[k].angle - segments[k].over;
    const wanted = Math.min(Math.max(angle, begin + least), places[k + 1].angle - least);
    moved[k + 1].over = Number((segments[k].over + segments[k + 1].over - (wanted - begin)).toFixed(9));
    moved[k].over = Number((wanted - begin).toFixed(9));
  }
  if (lifts) {
    const others = places.filter((_, i) => i < before || i >= behind).map((place) => place.level);
    const floor = Math.min(0, ...others);
    let rise = Math.max(level, floor) - places[k].level;
    const parts = [[before, 1], [behind, -1]].filter(([i]) => moved[i]);
    const goes = peak && motion.segments[k]?.kind === "dwell" ? Math.abs(rise) >= 0.5 * by : true;
    const empty = ([i, sign]) => moved[i].kind !== "to" && Math.abs(segments[i].change + sign * rise) < 1e-9;
    // a stroke is above 0: that is stepped over, or stopped at where the ground is behind it
    const way = rise < 0 && places[k].level + rise - by >= floor ? -1 : 1;
    for (let tries = 0; tries < 3 && goes && parts.some(empty); tries++) rise += way * by;
    for (const [i, sign] of goes ? parts : []) {
      moved[i].change = Number((segments[i].change + sign * rise).toFixed(9));
      if (moved[i].kind === "to") continue;
      if (moved[i].kind === "dwell") moved[i].shape = moved[i].shape.map((_, j, { length }) => smooth(j / (length - 1)));
      moved[i].kind = moved[i].change > 0 ? "rise" : "return";
    }
  }
  return moved;
}

// a law that rests at both ends, until the design says how it is
function smooth(u) {
  return u - Math.sin(2 * Math.PI * u) / (2 * Math.PI);
}

// --- the text -------------------------------------------------------------------------------------------------------

function fieldAt(index, key) {
  return recipe.fields.find(({ path }) => path === `${motion.path}[${index}].${key}`);
}

// a number as a field's text, in its own unit
function inField(field, value) {
  return brief(value / (field.units[field.unit] || 1));
}

// puts segments into the text in place of those that it has; false where that is not possible
function writeSegments(segments, movement) {
  const changes = [];
  const added = [];
  const levels = ends(segments);
  const renamed = [];
  for (const [i, segment] of segments.entries()) {
    const old = motion.segments[i];
    const angle = fieldAt(i, old.kind === "dwell" ? "dwell" : "over");
    if (!angle) return false;
    if (!old.free && segment.over !== old.over) changes.push([angle, inField(angle, segment.over)]);
    if (segment.kind !== old.kind && old.kind === "dwell") {
      const key = keyBefore(angle, "dwell");
      if (!key) return false;
      const stroke = brief(Math.abs(segment.change));
      const column = key.start - recipe.text.lastIndexOf("\n", key.start - 1) - 1;
      const apart = segment.flow ? ", " : `\n${" ".repeat(column)}`;
      changes.push([key, `${segment.kind}: ${stroke}${apart}over`]);
      added.push({ i, kind: segment.kind, key, stroke });
      renamed.push([angle, `${motion.path}[${i}].over`]);
      continue;
    }
    if (old.kind === "dwell" || (old.kind !== "to" && segment.change === old.change)) continue;
    const stroke = fieldAt(i, old.kind);
    const value = old.kind === "to" ? levels[i].level : Math.abs(segment.change);
    if (!(old.kind in STEPPED || old.kind === "to")) continue;
    if (!stroke || stroke.value === null) return false;
    if (Math.abs(value / (stroke.units[stroke.unit] || 1) - stroke.value) > 1e-9) changes.push([stroke, inField(stroke, value)]);
    if (segment.kind === old.kind) continue;
    const key = keyBefore(stroke, old.kind);
    if (!key) return false;
    changes.push([key, segment.kind]);
    renamed.push([stroke, `${motion.path}[${i}].${segment.kind}`]);
  }
  motion = { ...motion, start: foot(segments), segments };
  if (!changes.length) return true;
  for (const [field, path] of renamed) field.path = path;
  const keys = added.map(({ key }) => key);
  recipe.fields.push(...keys); // so that they move along with the text before them
  edit(changes, movement);
  motion.text = recipe.text;
  recipe.fields = recipe.fields.filter((field) => !keys.includes(field));
  for (const { i, kind, key, stroke } of added) {
    const start = key.start + kind.length + 2;
    const field = { path: `${motion.path}[${i}].${kind}`, kind: "number", text: stroke, value: Number(stroke), unit: "", units: {} };
    recipe.fields.push({ ...field, start, end: start + stroke.length }); // until the design names it
  }
  return true;
}

// the place of a key, which stands before its value
function keyBefore(field, name) {
  const found = new RegExp(`(?:^|[\\s{,])(${name})\\s*:\\s*["']?$`).exec(recipe.text.slice(0, field.start));
  if (!found) return null;
  const start = found.index + found[0].indexOf(name);
  return { path: field.path, start, end: start + name.length };
}
