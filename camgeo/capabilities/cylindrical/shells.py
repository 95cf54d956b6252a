"""A drum as thin cylinders about its axis, for pictures: what stands on each, and how it looks from the side.

A shell is seen along the roller's axis, from outside: x to the right, y up, both mm, with the drum's axis at x = 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.crossings import sampled
from camgeo.capabilities.cylindrical.development import drawn
from kin.numeric.angles import TURN
from kin.turned.files import Developed

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from kin.numeric.arrays import Array, Indices, Mask

PLACES = 240  # of a turn, at which heights are known
COARSE = 2e-4  # of the blank: to this a line is drawn
DEEP = 5  # shells from the floor to the blank, of which the blank is the last
EXACT = 1e-9  # of the distance between two places
LONGEST = 200  # places of a band
FACE, RIM = 48, 8  # chords of a half that is seen, and of a strip of the far half beside the core


class Shell(NamedTuple):
    """Metal on a cylinder of a radius, mm: bands of (low, high) heights (PLACES,), at equal steps of the polar angle.

    Heights are nan where a band is not, as between tracks that cross. Angles are those of the drum as it is made,
    mirrored for `rotation: ccw`.
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
    if design.recipe.turns > 1:
        return Shell(radius, tuple(_islands(design, radius)))
    rising = design.recipe.track.rising
    edges = [height(design, name, radius) for name in rising]
    # metal lies below a lower flank and above an upper one
    edges = [np.zeros(PLACES), *edges] if rising[0] == "lower" else edges
    edges = [*edges, np.full(PLACES, design.recipe.height)] if rising[-1] == "upper" else edges
    return Shell(radius, tuple(zip(edges[::2], edges[1::2], strict=True)))


def _islands(design: DrumDesign, radius: float) -> list[tuple[Array, Array]]:
    """Bands of metal between the tracks of a groove that crosses itself, from below and above all of them on.

    Each of the others ends in a point beside its last place; one that goes on for long is several.
    """
    columns = _columns(design, radius)
    lowest, highest = (np.array([column[end] for column in columns]).T for end in (0, -1))
    found = [(lowest[0], lowest[1]), (highest[0], highest[1])]
    following: dict[tuple[int, int], tuple[int, int]] = {}
    for j, column in enumerate(columns):
        after = columns[(j + 1) % PLACES]
        for i, (low, high) in enumerate(column[1:-1], 1):
            over = [min(high, top) - max(low, bottom) for bottom, top in after[1:-1]]
            if over and max(over) > 0.0:
                following[j, i] = (j + 1) % PLACES, 1 + over.index(max(over))
    begins = [(j, i) for j, column in enumerate(columns) for i in range(1, len(column) - 1)]
    for begin in sorted(set(begins) - set(following.values())):
        chain = [begin]
        while chain[-1] in following and len(chain) < PLACES * design.recipe.turns:
            chain.append(following[chain[-1]])
        rows = [columns[j][i] for j, i in chain]
        begin_at, end_at = (0.5 * (row[0] + row[1]) for row in (rows[0], rows[-1]))
        whole = np.array([(begin_at, begin_at), *rows, (end_at, end_at)])
        first = begin[0] - 1
        pieces = [(first + part, whole[part : part + LONGEST + 1]) for part in range(0, len(whole) - 1, LONGEST)]
        found += [_placed(*piece) for piece in pieces]
    return found


def _placed(first: int, rows: Array) -> tuple[Array, Array]:
    """Bottom and top (PLACES,) of a band from a place on; nan elsewhere."""
    band = np.full((2, PLACES), np.nan)
    band[:, np.mod(first + np.arange(len(rows)), PLACES)] = rows.T
    return band[0], band[1]


def _columns(design: DrumDesign, radius: float) -> list[list[tuple[float, float]]]:
    """Metal on a cylinder at each place of the turn, from below: bottom and top of each stretch of it, mm."""
    rows = [sampled(design.flanks[name], radius)[0] for name in ("lower", "upper")]
    low, high = (
        row.reshape(design.recipe.turns, -1)[:, :: row.size // design.recipe.turns // PLACES].T for row in rows
    )
    if design.recipe.mirrored:
        low, high = (np.roll(part[::-1], 1, axis=0) for part in (low, high))
    found = []
    for begins, ends in zip(low, high, strict=True):
        column, up = [], 0.0
        for begin, end in sorted(zip(begins.tolist(), ends.tolist(), strict=True)):
            if begin > up:
                column.append((up, begin))
            up = max(up, end)
        found.append([*column, (up, design.recipe.height)])
    return found


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
    found = []
    for band in of.bands:
        bottom, top = (np.column_stack([x, _between(z, at)]) for z in band)
        there = runs(np.isfinite(bottom[:, 1] + top[:, 1]))
        found += [np.concatenate([bottom[run], top[run][::-1]]) for run in there]
    return found


def _between(z: Array, at: Array) -> Array:
    """Heights, mm (n,), at places between known ones (PLACES,), which count alone at one of them."""
    near = np.rint(at)
    found = np.interp(at, np.arange(PLACES + 1), np.append(z, z[0]))
    return np.where(np.abs(at - near) < EXACT, z[near.astype(np.intp) % PLACES], found)


def runs(good: Mask) -> list[Indices]:
    """Indices of true values, run by run."""
    at = np.flatnonzero(good)
    return [run for run in np.split(at, np.flatnonzero(np.diff(at) > 1) + 1) if run.size]


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
    found: list[Array] = []
    for side in (-1.0, 1.0):
        ends = [seen(each, turn, side * 0.5 * math.pi, side * 0.5 * math.pi, 0) for each in of]
        if len({len(end) for end in ends}) > 1:  # beside the point of a band
            continue
        bands = zip(*(sorted(end, key=lambda row: float(row[0, 1])) for end in ends), strict=True)
        found += [np.array([row[0] for row in rows] + [row[-1] for row in reversed(rows)]) for rows in bands]
    return found
