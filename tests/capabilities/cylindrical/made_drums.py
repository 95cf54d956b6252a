"""Recipes of drums for tests: one to begin with, changes of it, and random ones."""

from __future__ import annotations

import copy
import functools
import math
from pathlib import Path
from typing import TYPE_CHECKING

from capabilities.cylindrical.positions import Lift

from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.reading import read_cylindrical
from camgeo.common.clock import Clock
from camgeo.schema.yaml_source import read_source
from kin.numeric.records import replace

if TYPE_CHECKING:
    from random import Random

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe


def changed(text: str, *pairs: tuple[str, str]) -> str:
    """Text with the first of each pair replaced by the second; each has to be there."""
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


MOTION = (
    "[{rise: 40, over: 120, law: cycloidal}, {dwell: 60}, {return: 40, over: 120, law: polynomial-345}, {dwell: 60}]"
)
GROOVE = f"""cam:
  kind: cylindrical
  radius: 50
  track: {{groove: {{depth: 12.5}}}}
  follower: {{radius: 10, from: 38}}
  pitch_height: 20
  motion: {MOTION}
part: {{length: 80, bore: 24, keyway: din6885}}
export: {{tolerance: 0.02, files: [stl]}}
"""
RIB = GROOVE.replace("groove: {depth: 12.5}", "rib: {distance: 50, depth: 12}").replace(", from: 38", "")
RIB = RIB.replace("pitch_height: 20", "pitch_height: 40").replace("length: 80", "length: 125")
TOP = GROOVE.replace("groove: {depth: 12.5}", "end: top")
BOTTOM = GROOVE.replace("groove: {depth: 12.5}", "end: bottom")
UNDERCUT = """cam:
  kind: cylindrical
  radius: 40
  track: {groove: {depth: 20}}
  follower: {radius: 12}
  pitch_height: 25
  undercut: shorten
  motion:
    [{rise: 15, over: 60, law: cycloidal}, {dwell: 120}, {return: 15, over: 60, law: cycloidal}, {dwell: 120}]
part: {length: 65}
export: {tolerance: 0.05, files: [stl]}
"""
"""Drums of the worked cases: a groove, its rib and end cams, and one that is undercut near its floor."""
CONE = changed(GROOVE, ("radius: 10,", "radius: 10, taper: axis, at: 44,"))
BESIDE = changed(GROOVE, ("radius: 10,", "radius: 10, offset: 6,"))
ARM = changed(
    GROOVE,
    ("radius: 10,", "radius: 10, arm: {length: 80, offset: 78, pivot: 40},"),
    ("pitch_height: 20", f"pitch_height: {40.0 - 80.0 * math.sin(math.radians(15.0))!r}"),
    ("rise: 40", "rise: 30"),
    ("return: 40", "return: 30"),
)
LEADING = changed(ARM, ("offset: 78, pivot: 40", "offset: -78, pivot: 40, side: leading"))
CONE_ON_ARM = changed(ARM, ("radius: 10,", "radius: 10, taper: 6, at: 44,"))
RIB_ON_ARM = changed(
    ARM,
    ("groove: {depth: 12.5}", "rib: {distance: 36, depth: 12}"),
    (", from: 38", ""),
    ("pivot: 40", "pivot: 60"),
    ("pitch_height: ", f"pitch_height: {60.0 - 80.0 * math.sin(math.radians(15.0))!r} # "),
    ("length: 80, bore", "length: 120, bore"),
)
"""Drums whose roller is a cone, beside a radius or on an arm, and a rib between two rollers on one arm."""
LAWS = ("cycloidal", "polynomial-345", "polynomial-4567")


def recipe_of(text: str, name: str = "drum.yaml") -> DrumRecipe:
    """Recipe of a text."""
    return read_cylindrical(read_source(text.encode(), name), Path(name))


def design_of(text: str) -> DrumDesign:
    """Exact drum of a text."""
    return designed(recipe_of(text), Clock())


@functools.cache
def shared_design(text: str) -> DrumDesign:
    """Exact drum of a text, made once in a process: for tests that leave it as it is."""
    return design_of(text)


def cut_short(recipe: DrumRecipe) -> DrumDesign:
    """The drum of UNDERCUT, whose cuts are sought once in a process, with the files that a recipe asks for."""
    design = copy.copy(shared_design(UNDERCUT))
    design.__dict__["recipe"] = replace(design.recipe, export=recipe.export)
    return design


LED = ("carriage", "beside", "cone", "apex", "trailing", "leading", "cone on an arm")


def _led(rng: Random, led: str, radius: float, stroke: float) -> tuple[dict, dict]:
    """Keys of a follower, and what `Lift` takes of it; of an arm its start in degrees, not the pivot's height."""
    if led == "beside":
        offset = rng.uniform(-0.12, 0.12) * radius
        return {"offset": offset}, {"offset": offset}
    if led == "apex":
        return {"taper": "axis"}, {}
    taper = rng.uniform(2, 9)
    cone = {"taper": taper} if led.startswith("cone") else {}
    if led in {"carriage", "cone"}:
        return cone, dict(cone)
    side, length = (-1 if led == "leading" else 1), rng.uniform(1.1, 2.0) * radius
    half = math.asin(0.5 * stroke / length)
    y = 0.5 * side * length * (1.0 + math.cos(half)) + rng.uniform(-1.0, 1.0)
    start = rng.uniform(-4, 4) - math.degrees(half)
    return cone, {**cone, "arm": (length, y, start, side)}


def random_drum(
    rng: Random, track: str, *, inch: bool, ccw: bool, undercut: bool, led: str = "carriage"
) -> tuple[str, Lift]:
    """Text of a random recipe, and its motion and roller by positions; `led` is one of `LED`.

    An undercut drum has a large roller and a sharp motion.
    """
    mm = 25.4 if inch else 1.0
    radius = rng.uniform(35, 60)
    roller = rng.uniform(0.2, 0.27) * radius if undercut else rng.uniform(0.1, 0.18) * radius
    depth = rng.uniform(0.35, 0.45) * radius if undercut else rng.uniform(0.12, 0.25) * radius
    strokes = [rng.uniform(0.25, 0.4) * radius] if undercut else [rng.uniform(0.2, 0.8) * radius]
    over = rng.uniform(55, 65) if undercut else rng.uniform(100, 150)
    back = rng.uniform(60, 75) if undercut else rng.uniform(100, 140)
    rest = rng.uniform(0.3, 0.7) * (360 - over - back)
    up, down = rng.choice(LAWS), rng.choice(LAWS)
    (stroke,) = strokes
    distance = 2.0 * roller + rng.uniform(0.8, 1.5) * radius
    clearance = rng.choice([0.0, rng.uniform(0.01, 0.1)])
    low = roller + rng.uniform(3, 9) + (0.5 * distance if track == "rib" else 0.0)
    if led != "carriage":  # a cone is thicker outside, and an arm has its rollers aslant
        low += 0.2 * radius
    level, length = low, low + stroke + low + rng.uniform(0, 5)
    taken, drawn = _led(rng, led, radius, stroke)
    at = radius - 0.5 * depth + 0.25  # the middle of a roller from the floor's gap to the blank
    if led == "apex":
        drawn |= {"taper": math.degrees(math.atan(roller / at)), "at": at}
    elif "taper" in drawn:
        drawn |= {"at": at}
    guide = "".join(f", {key}: {value / mm if key == 'offset' else value}" for key, value in taken.items())
    if "arm" in drawn:
        arm_length, y, start, side = drawn["arm"]
        z = -arm_length * math.sin(math.radians(start))
        drawn["arm"] = (arm_length, y, z, side)
        place = {"length": arm_length, "offset": y, "pivot": level + z}
        told = ", ".join(f"{key}: {value / mm!r}" for key, value in place.items())
        guide += f", arm: {{{told}, side: {'trailing' if side > 0 else 'leading'}}}"
        stroke = math.degrees(2.0 * math.asin(0.5 * stroke / arm_length))
    unit = 1.0 if "arm" in drawn else mm
    motion = [("rise", stroke, over, up), ("dwell", 0.0, rest, ""), ("return", stroke, back, down)]
    motion.append(("dwell", 0.0, 360 - over - rest - back, ""))
    rows = ", ".join(
        f"{{dwell: {a!r}}}" if kind == "dwell" else f"{{{kind}: {s / unit!r}, over: {a!r}, law: {law}}}"
        for kind, s, a, law in motion
    )
    own = {
        "groove": f"{{groove: {{depth: {depth / mm!r}, clearance: {clearance / mm!r}}}}}",
        "rib": f"{{rib: {{distance: {distance / mm!r}, depth: {depth / mm!r}}}}}",
        "top": "{end: top}",
        "bottom": "{end: bottom}",
    }[track]
    begins = f", from: {(radius - depth + 0.5) / mm!r}" if track in {"top", "bottom"} else ""
    bore = 2.0 * rng.uniform(0.3, 0.6) * (radius - depth) / mm
    return (
        f"units: {'inch' if inch else 'mm'}\nrotation: {'ccw' if ccw else 'cw'}\n"
        f"cam:\n  kind: cylindrical\n  radius: {radius / mm!r}\n  track: {own}\n"
        f"  follower: {{radius: {roller / mm!r}{begins}{guide}}}\n  pitch_height: {level / mm!r}\n"
        f"  undercut: {'shorten' if undercut else 'refuse'}\n  motion: [{rows}]\n"
        f"part: {{length: {length / mm!r}, bore: {bore!r}}}\n"
        f"export: {{tolerance: {rng.choice([0.1, 0.05, 0.02]) / mm!r}, files: [stl]}}\n"
    ), Lift(motion, **drawn)
