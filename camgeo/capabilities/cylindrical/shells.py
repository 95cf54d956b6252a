"""A drum as thin cylinders about its axis, for pictures: what stands on each, and how it looks from the side.

A shell is seen along the roller's axis, from outside: x to the right, y up, both mm, with the drum's axis at x = 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.development import drawn
from camgeo.capabilities.cylindrical.keys import Rib
from kin.cylindrical.intent import Developed

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from kin.numeric.arrays import Array

TURN = 2.0 * math.pi
PLACES = 240  # of a turn, at which heights are known
COARSE = 2e-4  # of the blank: to this a line is drawn
DEEP = 5  # shells from the floor to the blank, of which the blank is the last
FACE, RIM = 48, 8  # chords of a half that is seen, and of a strip of the far half beside the core


class Shell(NamedTuple):
    """Metal on a cylinder of a radius, mm: bands of (low, high) heights (PLACES,), at equal steps of the polar angle.

    Angles are those of the drum as it is made, mirrored for `rotation: ccw`.
    """

    radius: float
    bands: tuple[tuple[Array, Array], ...]


def height(design: DrumDesign, name: str, radius: float) -> Array:
    """Height of a flank on a cylinder, mm (PLACES,), at equal steps of the polar angle; what is cut away is left out.

    Raises ToleranceError for a flank that takes too many points.
    """
    line = drawn(design, Developed("", radius, name), COARSE * design.recipe.radius)  # type: ignore[arg-type]
    at = np.arange(PLACES) * (TURN / PLACES)
    z = np.interp(at, line.points[:, 0] / radius, line.points[:, 1], period=TURN)
    return np.asarray(np.clip(z, 0.0, design.recipe.height))


def shell(design: DrumDesign, radius: float) -> Shell:
    """The metal on the cylinder of a radius, mm, above the floor."""
    flanks = {name: height(design, name, radius) for name in design.flanks}
    if isinstance(design.recipe.track, Rib):
        return Shell(radius, ((flanks["upper"], flanks["lower"]),))
    ends = {"lower": np.zeros(PLACES), "upper": np.full(PLACES, design.recipe.height)}
    bands = [(ends[name], z) if name == "lower" else (z, ends[name]) for name, z in flanks.items()]
    return Shell(radius, tuple(bands))


def shells(design: DrumDesign) -> list[Shell]:
    """Shells from the floor to the blank."""
    floor, blank = design.recipe.floor, design.recipe.radius
    return [shell(design, floor + (blank - floor) * k / DEEP) for k in range(DEEP + 1)]


def seen(of: Shell, turn: float, low: float, high: float, chords: int) -> list[Array]:
    """Outlines (n, 2) of the bands of a shell between two angles to the right of the viewer, rad.

    `turn` is the angle of the drum that faces the viewer, rad.
    """
    psi = np.linspace(low, high, chords + 1)
    x, at = of.radius * np.sin(psi), np.mod(psi + turn, TURN) * (PLACES / TURN)
    places = np.arange(PLACES + 1)
    found = []
    for band in of.bands:
        bottom, top = (np.column_stack([x, np.interp(at, places, np.append(z, z[0]))]) for z in band)
        found.append(np.concatenate([bottom, top[::-1]]))
    return found


def far(of: Shell, turn: float, core: float) -> list[Array]:
    """Outlines of the far half of a shell, where a core of a radius, mm, does not hide it."""
    beside = math.pi - math.asin(min(core / of.radius, 1.0))
    ends = (0.5 * math.pi, beside), (TURN - beside, 1.5 * math.pi)
    return [outline for low, high in ends for outline in seen(of, turn, low, high, RIM)]


def near(of: Shell, turn: float) -> list[Array]:
    """Outlines of the near half of a shell."""
    return seen(of, turn, -0.5 * math.pi, 0.5 * math.pi, FACE)


def rims(of: list[Shell], turn: float) -> list[Array]:
    """Outlines of the metal between the first shell and the last, cut across the line of sight."""
    found = []
    for side in (-1.0, 1.0):
        ends = [seen(each, turn, side * 0.5 * math.pi, side * 0.5 * math.pi, 0) for each in of]
        for band in range(len(of[0].bands)):
            rows = [end[band] for end in ends]
            found.append(np.array([row[0] for row in rows] + [row[-1] for row in reversed(rows)]))
    return found
