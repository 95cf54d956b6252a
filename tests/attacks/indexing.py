# needs: indexing
"""Random indexing cams, whose developments are held against rollers at all angles by positions alone; and slips."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import yaml
from capabilities.indexing.made_indexers import Rollers, design_of, random_indexer, recipe_of, window
from support.heavy import ezdxf

from attacks.outcome import Attack
from attacks.programs import program_keys
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

REMEDY = re.compile(
    r"index\.yaml:\d+:\d+: (?P<path>[\w.]+): (?P<problem>[^,;\d]+)[^;]*; .*?"
    r"(?P<word>less than|at most|more than|at least|between) (?P<size>-?[\d.e+-]+)(?: \w+ and (?P<most>-?[\d.e+-]+))?"
)
SLIPS = (
    ("radius:", "raduis:"),
    ("depth", "deep"),
    ("depth: ", "depth: 9"),
    ("stops: ", "stops: 1"),
    ("stops: ", "stops: -"),
    ("roller: ", "roller: 9"),
    ("roller: ", "roller: 1e-7"),
    ("over: ", "over: 1e9"),
    ("rise: ", "rise: 1"),
    ("rotation: cw", "rotation: left"),
    ("length: ", "length: 1e-9"),
    ("length: ", "length: 9"),
    ("law: ", "law: un"),
    ("bore: ", "bore: 9"),
    ("side: ", "side: un"),
    ("distance: ", "distance: 1"),
    ("distance: ", "distance: 0.00"),
    ("barrel: ", "globoid: "),
    ("globoid: ", "barrel: "),
    ("turret: {", "turret: {height: 1e4, "),
    ("turret: {", "turret: {height: -1e4, "),
    ("turret: {", "turret: {height: 9, "),
    ("turret: {", "turret: {start: 179, "),
    ("turret: {", "turret: {from: 40, to: 39, "),
    ("turret: {", "turret: {to: 9, "),
    ("barrel: {", "barrel: {offset: 9, "),
    ("depth: ", "depth: 0.00"),
    ("length: ", "length: 1"),
    ("radius: ", "radius: 1"),
    ("radius: ", "radius: 0.0"),
    ("clearance: ", "preload: 1, clearance: "),
    ("preload: ", "preload: 9"),
    ("kind: indexing", "kind: globoid"),
)


def stepped(rng: Random, number: int) -> Attack:
    """A random barrel or globoid as a table: it is made, or refused with a reason, and nothing else."""
    text = random_indexer(rng, rng.choice(["barrel", "globoid"]), inch=rng.random() < 0.5, ccw=rng.random() < 0.5)
    text = text.replace("files: [stl]", f"files: [{{csv: {{step: {rng.choice([0.5, 1, 7.3])}}}}}]")

    def judge(done: Done, folder: Path) -> list[str]:
        (table, *_) = [*folder.rglob("*.csv"), None]
        return [] if done.status or table is None else misstepped(table, text)

    return Attack(f"indexing cam {number}", ("export", "index.yaml"), {"index.yaml": text.encode()}, (0, 1, 2), judge)


def number_after(text: str, key: str) -> float:
    """First number behind a key."""
    return float(re.split(r"[\s,}\]]", text.split(key, 1)[1], maxsplit=1)[0])


def misstepped(table: Path, text: str) -> list[str]:
    """Rows of a table by which the turret does not begin half a pitch below the middle, or not end as much above."""
    rows = np.genfromtxt(table, delimiter=",", skip_header=1)
    half, dwell = 180.0 / number_after(text, "stops: "), number_after(text, "over: ")
    rest = rows[:, 0] >= dwell
    found = []
    if abs(rows[0, 1] + half) > 1e-6:
        found.append(f"the turret begins at {rows[0, 1]:.6g} degrees")
    if rest.any() and np.abs(rows[rest, 1] - half).max() > 1e-6:
        found.append("the turret does not rest half a pitch above the middle")
    if (np.diff(rows[:, 1]) < -1e-9).any():
        found.append("the turret turns back")
    return found


def unrolled(rng: Random, number: int) -> Attack:
    """A random barrel: each line of its development is where rollers touch the blank."""
    text = random_indexer(rng, "barrel", inch=rng.random() < 0.5, ccw=rng.random() < 0.5)
    text = text.replace("files: [stl]", "files: [{dxf: {at: [outer]}}]")

    def judge(done: Done, folder: Path) -> list[str]:
        return [] if done.status else wrong(next(folder.rglob("*.dxf")), text)

    return Attack(
        f"unrolled barrel {number}", ("export", "index.yaml"), {"index.yaml": text.encode()}, (0, 1, 2), judge
    )


def wrong(path: Path, text: str) -> list[str]:
    """Lines that no roller touches, or that one has cut away, within ten tolerances."""
    recipe = recipe_of(text)
    mm, found = recipe.mm, []
    law = recipe.motion.motion(2.0 * np.pi, "", None).motion
    rollers = _Led(recipe, law)
    for line in ezdxf.readfile(path).modelspace().query("LWPOLYLINE"):
        name = line.dxf.layer.rpartition("_")[2].lower()
        if name not in {"lower", "upper"}:
            continue
        x, z = np.array(line.get_points("xy")).T * mm
        radius = recipe.form.radius
        phi = recipe.sense * x / radius
        points = np.column_stack([radius * np.cos(phi), radius * np.sin(phi), z])[:: max(1, len(x) // 60)]
        size = recipe.roller.radius + (recipe.clearance if name == "upper" else 0.0)
        off = float(np.abs(rollers.away(points, window(recipe.stops)).min(axis=1) - size).max())
        if off > 10.0 * recipe.export.tolerance + 1e-3:
            found.append(f"flank: {line.dxf.layer} is off by {off:.4g} mm")
    return found


class _Led(Rollers):
    """Rollers led by the law of a recipe."""

    def __init__(self, recipe, law) -> None:
        super().__init__(recipe.turret.word, vars(recipe.form), recipe.stops, 0.0, recipe.start)
        self.law = law

    def psi(self, theta: np.ndarray) -> np.ndarray:
        """Angle of the roller of no turn, rad."""
        turns = np.floor(theta / (2.0 * np.pi))
        values = self.law.derivatives(theta - 2.0 * np.pi * turns, 0)[0]
        return np.asarray(self.start + turns * 2.0 * np.pi / self.stops + values)


def milled(rng: Random, number: int) -> Attack:
    """A random cam as a program with random words: it is made, or refused with a reason, and nothing else."""
    inch = rng.random() < 0.5
    mm = 25.4 if inch else 1.0
    text = random_indexer(rng, rng.choice(["barrel"] * 5 + ["globoid"]), inch=inch, ccw=rng.random() < 0.5)
    roller = number_after(text, "roller: ")
    axes = ["[X, A]", *["[X, Y, A]"] * 6, "[A, X, Z, Y]", "[X]"]
    options = program_keys(rng, axes, [roller * by for by in (2.0, 2.0, 1.998, 1.9, 1.5, 0.9, 2.1)], mm)
    text = text.replace("files: [stl]", f"files: [{{gcode: {{{options}}}}}]")

    def judge(done: Done, _: Path) -> list[str]:  # 1 where a check of the cam fails, and not of the program
        return [f"verdict: {done.err[:200]}"] if ".ngc)" in done.err else []

    name = f"milled indexing cam {number}"
    return Attack(name, ("export", "index.yaml"), {"index.yaml": text.encode()}, (0, 1, 2), judge)


def slipped(rng: Random, number: int) -> Attack:
    """A random recipe with a slip in it: it is refused, or made, and nothing is half written."""
    text = random_indexer(rng, rng.choice(["barrel", "globoid"]), inch=False, ccw=False)
    text = text.replace("ccw", "cw")
    old, new = rng.choice([slip for slip in SLIPS if slip[0] in text])
    text = text.replace("files: [stl]", "files: [csv]").replace(old, new, 1)

    def judge(done: Done, _: Path) -> list[str]:
        return [] if done.status != 2 else useless(done.err, text)

    words = ("check", "index.yaml")
    return Attack(f"slipped indexing cam {number}", words, {"index.yaml": text.encode()}, (0, 1, 2), judge)


def useless(told: str, text: str) -> list[str]:
    """A size that a refusal names, of which the same field is refused with the same words once it is given."""
    found = REMEDY.search(told)
    values = yaml.safe_load(text)
    if found is None or "motion" in found["path"]:
        return []
    *way, last = found["path"].split(".")
    where = values
    for key in way:
        where = where[key]
    size, most = float(found["size"]), float(found["most"] or 0.0)
    where[last] = {"less than": 0.9999 * size, "more than": 1.0001 * size, "between": 0.5 * (size + most)}.get(
        found["word"], size
    )
    if "the turret's axis in" in told:
        values["cam"]["turret"].pop("height", None)
    try:
        design_of(yaml.safe_dump(values))
    except RecipeErrors as errors:
        again = REMEDY.search(str(errors))
        if again is not None and (again["path"], again["problem"]) == (found["path"], found["problem"]):
            return [f"remedy: followed, and told again: {told.strip()[-300:]}"]
    return []
