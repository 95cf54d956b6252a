"""The development of a barrel on its page: SVG in px of its own; lengths that it tells are in the recipe's unit."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.ribs import PLACES, layer, line_in
from camgeo.measures.units import UNIT_NAMES
from camgeo.report.page.chart import FIELD, LEFT, TOP, axes, chart, clip, field, path
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from kin.numeric.arrays import Array

PARTS = 360  # of a turn at which rollers are known
BEYOND = 0.5  # rad, by which the paths of axes beside a radius are drawn beyond the turn
ROUND = 48  # chords of a roller's section
EVERY = 4  # of the points of a flank that are drawn


def scale(design: IndexDesign) -> float:
    """Scale of the development, px per mm: its width is one turn at the radius of the blank."""
    return FIELD / (TURN * design.recipe.form.blank)


def rollers(design: IndexDesign, theta: Array) -> list[tuple[Array, Array]]:
    """Places where the rollers' axes meet the blank, at shaft angles (n,), rad: a pair for each roller near it.

    A pair has the polar angle from the shaft angle, in turns, and the height, mm, (n,) each.
    """
    found, flank = [], design.flanks["lower"]
    for turn in design.turns:
        pose = flank.pose(theta + TURN * turn)
        _, y, z = flank.form.axis(pose, np.zeros_like(theta))
        found.append((np.arcsin(np.clip(y / design.recipe.form.blank, -1.0, 1.0)) / TURN, z))
    return found


def development(design: IndexDesign) -> str:
    """The blank unrolled over one turn, with the flanks there and at the rollers' inner end, and the rollers."""
    recipe = design.recipe
    tall = scale(design) * recipe.length
    blank, inner = recipe.form.blank, recipe.roller.inner
    parts = [f'<path class="metal" d="{path(piece)}Z"/>' for piece in _ribs(design, tall)]
    for radius, look in ((blank, "line"), (inner, "line inner")):
        pieces = [piece for name in design.flanks for piece in _lines(design, name, radius, tall)]
        parts += [f'<path class="{look}" d="{path(piece)}"/>' for piece in pieces]
    theta = np.linspace(-BEYOND, TURN + BEYOND, PARTS + 1)
    for beside, z in rollers(design, theta):
        parts.append(f'<path class="line pitch" d="{path(_placed(design, theta / TURN + beside, z, tall))}"/>')
    sections = "".join(
        f'<path class="section{look}" d="{path(_section(design, radius))}Z"/>'
        for radius, look in ((blank, ""), (inner, " inner"))
    )
    for beside, z in rollers(design, np.zeros(1)):
        ((x, y),) = _placed(design, beside, z, tall).tolist()
        parts += [
            f'<g class="roller-at" transform="translate({x + FIELD * k:.2f} {y:.2f})">{sections}</g>'
            for k in (-1, 0, 1)
        ]
    told = "the barrel unrolled over one turn: the rib between the flanks, and the paths of the rollers' axes"
    frame = axes(tall, (0.0, recipe.length / recipe.mm), "angle on the barrel, °", f"z, {UNIT_NAMES[recipe.units]}")
    body = f'{clip("flat", tall)}{field(tall)}<g clip-path="url(#flat)">{"".join(parts)}</g>{frame}'
    return chart("development", tall, told, body)


def legend(design: IndexDesign) -> str:
    """Sentence that says what the lines of the development are."""
    mm, unit = design.recipe.mm, UNIT_NAMES[design.recipe.units]
    blank, inner = f"{design.recipe.form.blank / mm:.6g} {unit}", f"{design.recipe.roller.inner / mm:.6g} {unit}"
    return f"Metal and full lines: on the blank, {blank}; dashed: at {inner}, where the rollers begin to bear."


def _placed(design: IndexDesign, share: Array, z: Array, tall: float) -> Array:
    """Places (n, 2), px, of shares of a turn and heights, mm (n,)."""
    share = share if design.recipe.sense > 0.0 else 1.0 - share
    return np.column_stack([LEFT + FIELD * share, TOP + tall - scale(design) * z])


def _ribs(design: IndexDesign, tall: float) -> list[Array]:
    """Outlines (n, 2), px, of the rib on the blank."""
    of, found = layer(design, design.recipe.form.blank), []
    for whole, begin, end in of.spans(0.0, PLACES):
        place = np.arange(math.ceil(begin), math.floor(end) + 1, dtype=float)
        bottom, top = of.heights(place)
        share = place / PLACES - whole * 1.0
        edges = [_placed(design, share, z, tall) for z in (bottom, top)]
        found.append(np.concatenate([edges[0], edges[1][::-1]]))
    return found


def _lines(design: IndexDesign, name: str, radius: float, tall: float) -> list[Array]:
    """Lines (n, 2), px, of a flank at a radius, mm, by turns of the cam."""
    phi, z = line_in(design.flanks[name], radius)
    keep = np.unique(np.append(np.arange(0, phi.size, EVERY), phi.size - 1))
    share, z = phi[keep] / TURN, z[keep]
    found = []
    for whole in range(math.floor(share[0]), math.floor(share[-1]) + 1):
        inside = np.flatnonzero((share >= whole) & (share <= whole + 1))
        run = slice(max(inside[0] - 1, 0), inside[-1] + 2)  # a point more at each end, beyond the field
        found.append(_placed(design, share[run] - whole, z[run], tall))
    return found


def _section(design: IndexDesign, radius: float) -> Array:
    """A roller cut by a cylinder, unrolled, in px from the place of its axis, as on a radius."""
    size = design.recipe.roller.radius
    t = np.arange(ROUND) * (TURN / ROUND)
    across = np.arcsin(min(size / radius, 1.0) * np.sin(t)) * (FIELD / TURN)
    return np.column_stack([across, -scale(design) * size * np.cos(t)])
