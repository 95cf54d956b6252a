"""Recipes of indexing cams for tests, and their rollers by positions alone: no flank, no derivative."""

from __future__ import annotations

import functools
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.exact import designed
from camgeo.capabilities.indexing.reading import read_indexing
from camgeo.common.clock import Clock
from camgeo.schema.yaml_source import read_source

if TYPE_CHECKING:
    from random import Random

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe

BARREL = """cam:
  kind: indexing
  barrel: {radius: 50}
  depth: 13
  turret: {stops: 6, radius: 60, roller: 9}
  motion: [{rise: 60, over: 150, law: cycloidal}, {dwell: 210}]
part: {length: 80, bore: 24, keyway: din6885}
export: {tolerance: 0.01, files: [stl]}
"""
GLOBOID = """cam:
  kind: indexing
  globoid: {distance: 90, radius: 49}
  depth: 13.5
  turret: {stops: 8, roller: 8}
  motion: [{rise: 45, over: 120, law: cycloidal}, {dwell: 240}]
part: {length: 60, bore: 20}
export: {tolerance: 0.01, files: [stl]}
"""


def changed(text: str, *pairs: tuple[str, str]) -> str:
    """Text with the first of each pair replaced by the second; each has to be there."""
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def recipe_of(text: str, name: str = "index.yaml") -> IndexRecipe:
    """Recipe of a text."""
    return read_indexing(read_source(text.encode(), name), Path(name))


def design_of(text: str) -> IndexDesign:
    """Exact cam of a text."""
    return designed(recipe_of(text), Clock())


@functools.cache
def shared_design(text: str) -> IndexDesign:
    """Exact cam of a text, made once in a process: for tests that leave it as it is."""
    return design_of(text)


# --- by positions -----------------------------------------------------------------------------------------------------


def advance(theta: np.ndarray, stops: int, over: float) -> np.ndarray:
    """Angle of the turret, rad, that rises by a cycloid over so many degrees of each turn, and rests."""
    turns = np.floor(theta / math.tau)
    u = np.minimum((theta - math.tau * turns) / math.radians(over), 1.0)
    return (turns + u - np.sin(math.tau * u) / math.tau) * math.tau / stops


class Rollers:
    """All rollers of a turret as they run past a cam, by distances from their axes."""

    def __init__(self, form: str, sizes: dict[str, float], stops: int, over: float, start: float) -> None:
        """`sizes` are in mm: height, and of a barrel pitch, offset and side, of a globoid distance; `start` in rad."""
        self.form, self.stops, self.over, self.start = form, stops, over, start
        self.sizes = sizes

    def psi(self, theta: np.ndarray) -> np.ndarray:
        """Angle of the roller of no turn, rad."""
        return self.start + advance(theta, self.stops, self.over)

    def away(self, points: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Distances (k, n) of points (k, 3) from the axis of the roller of no turn at shaft angles (n,)."""
        x, y, z = (part[:, None] for part in np.asarray(points).T)
        out, across = x * np.cos(theta) + y * np.sin(theta), y * np.cos(theta) - x * np.sin(theta)
        psi, up = self.psi(theta), z - self.sizes["height"]
        if self.form == "barrel":
            beside = self.sizes["offset"] - self.sizes["side"] * self.sizes["pitch"] * np.cos(psi)
            off = np.hypot(across - beside, up - self.sizes["pitch"] * np.sin(psi))
            return np.where(out > 0.0, off, np.inf)
        inwards = self.sizes["distance"] - out
        along = inwards * np.cos(psi) + up * np.sin(psi)
        off = np.hypot(across, up * np.cos(psi) - inwards * np.sin(psi))
        return np.where(along > 0.0, off, np.inf)


def rollers_of(design: IndexDesign, over: float) -> Rollers:
    """Rollers of a design whose motion is one cycloid over so many degrees, by the sizes that its recipe states."""
    recipe = design.recipe
    return Rollers(recipe.turret.word, vars(recipe.form), recipe.stops, over, recipe.start)


def window(stops: int) -> np.ndarray:
    """Shaft angles (n,), rad, at which the roller of no turn stands within a quarter turn of the cam, and some more.

    The turret begins half a pitch below the plane across the cam's axis.
    """
    turns = stops // 4 + 1
    return np.linspace(-turns * math.tau, turns * math.tau, 2 * turns * 2880 + 1)


# --- random recipes ---------------------------------------------------------------------------------------------------


def random_indexer(rng: Random, form: str, *, inch: bool, ccw: bool) -> str:
    """Text of a random recipe; some of them make no sound cam, and are refused."""
    mm = 25.4 if inch else 1.0
    stops = rng.randint(4, 12)
    over = rng.uniform(100.0, 260.0)
    law = rng.choice(["cycloidal", "modified-sine", "polynomial-345"])
    if form == "barrel":
        radius, pitch = rng.uniform(35.0, 60.0), rng.uniform(45.0, 80.0)
        roller = rng.uniform(0.12, 0.3) * 2.0 * pitch * math.sin(math.pi / stops)
        own = f"barrel: {{radius: {radius / mm!r}}}"
        turret = f"stops: {stops}, radius: {pitch / mm!r}, roller: {roller / mm!r}"
        length = 2.0 * pitch * rng.uniform(0.4, 0.7)
        turret += rng.choice(["", "", ", side: leading"])
        depth = rng.uniform(0.15, 0.3) * radius
    else:
        radius = rng.uniform(35.0, 60.0)
        roller = rng.uniform(0.12, 0.3) * 2.0 * radius * math.sin(math.pi / stops)
        depth = rng.uniform(0.15, 0.35) * radius
        distance = radius + depth + rng.uniform(1.2, 2.5) * roller + rng.uniform(8.0, 20.0)
        own = f"globoid: {{distance: {distance / mm!r}, radius: {radius / mm!r}}}"
        turret = f"stops: {stops}, roller: {roller / mm!r}"
        length = 2.0 * radius * rng.uniform(0.4, 0.75)
    turret += rng.choice(["", "", f", clearance: {0.02 / mm!r}", f", preload: {0.01 / mm!r}"])
    return f"""{"units: inch" if inch else "units: mm"}
rotation: {"ccw" if ccw else "cw"}
cam:
  kind: indexing
  {own}
  depth: {depth / mm!r}
  turret: {{{turret}}}
  motion: [{{rise: {360.0 / stops!r}, over: {over!r}, law: {law}}}, {{dwell: {360.0 - over!r}}}]
part: {{length: {length / mm!r}, bore: {8.0 / mm!r}}}
export: {{tolerance: {0.02 / mm!r}, files: [stl]}}
"""
