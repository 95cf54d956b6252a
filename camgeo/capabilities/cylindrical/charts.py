"""Charts of the page of a cylindrical cam: its development, and its pressure angle over shaft angle and radius.

Both are SVG in their own px; lengths that they tell are in the recipe's unit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.crossings import sampled
from camgeo.capabilities.cylindrical.figures import carried_from, outer_end
from camgeo.capabilities.cylindrical.shells import PLACES, height, runs, shell
from camgeo.capabilities.cylindrical.turning import LINES, outline, rollers
from camgeo.measures.units import UNIT_NAMES
from camgeo.recipe.figures import PRESSURE_ANGLE
from camgeo.report.page.chart import FIELD, FOOT, LEFT, TOP, axes, chart, clip, field, path
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array, Mask

HIGH = 150.0  # px of the map's field
BEYOND = 0.3  # rad, by which the path of an axis beside a radius is drawn beyond the turn
ROUND = 48  # chords of a roller's section
COLUMNS, ROWS = 180, 16  # cells of the map
STEPS_OF = (1.0, 2.0, 5.0, 10.0, 15.0)  # degrees from colour to colour
MOST_COLOURS = 8


# --- development ------------------------------------------------------------------------------------------------------


def flat_scale(design: DrumDesign) -> float:
    """Scale of the development, px per mm: its width is one turn at the radius of the blank."""
    return FIELD / (TURN * design.recipe.radius)


def development(design: DrumDesign) -> str:
    """The blank unrolled over one turn, with the flanks there and at the roller's inner end, and the roller."""
    recipe, scale = design.recipe, flat_scale(design)
    tall = scale * recipe.height
    blank, inner = recipe.radius, recipe.roller.inner
    x = LEFT + FIELD * np.arange(PLACES + 1) / PLACES

    def y(z: Array) -> Array:
        return TOP + tall - scale * np.append(z, z[0])

    parts = []
    for low, high in shell(design, blank).bands:
        bottom, top = np.column_stack([x, y(low)]), np.column_stack([x, y(high)])
        there = runs(np.isfinite(bottom[:, 1] + top[:, 1]))
        parts += [f'<path class="metal" d="{path(np.concatenate([bottom[k], top[k][::-1]]))}Z"/>' for k in there]
    for radius, look in ((blank, "line"), (inner, "line inner")):
        lines = [line for name in design.flanks for line in _flanks(design, name, radius)]
        parts += [f'<path class="{look}" d="{path(np.column_stack([x, TOP + tall - scale * z]))}"/>' for z in lines]
    more = 0.0 if recipe.guide.radial else BEYOND  # beside a radius a path begins elsewhere than the turn
    turns = recipe.turns
    theta = np.linspace(-more, recipe.period + more, LINES * turns + 1)
    short = lost_from(design, theta) > inner
    sections = "".join(
        f'<path class="section{look}" d="{path(_section(design, radius))}Z"/>'
        for radius, look in ((blank, ""), (inner, " inner"))
    )
    shown = ""
    for flank in rollers(design):
        beside, z = flat_axis(design, flank, theta)
        share = theta / TURN + beside
        share = share if design.recipe.sense > 0.0 else 1.0 - share
        points = np.column_stack([LEFT + FIELD * share, TOP + tall - scale * z])
        x, y = np.array([np.interp(0.0, theta, row) for row in points.T]).tolist()
        pieces = [points]
        if turns > 1:  # every turn from the chart's own edge on
            points[:, 0] = LEFT + FIELD * np.mod(share, 1.0)
            pieces = np.split(points, np.flatnonzero(np.abs(np.diff(points[:, 0])) > 0.5 * FIELD) + 1)
        parts += [f'<path class="line pitch" d="{path(piece)}"/>' for piece in pieces if len(piece) > 1]
        parts += [f'<path class="line lost" d="{path(points[run])}"/>' for run in runs(short) if run.size > 1]
        shown += "".join(
            f'<g class="roller-at" transform="translate({x + FIELD * (k - 1):.2f} {y:.2f})">{sections}</g>'
            for k in range(3)
        )
    parts += [
        f'<circle class="crossing" cx="{LEFT + FIELD * place:.2f}" cy="{TOP + tall - scale * up:.2f}" r="4"/>'
        for place, up in crossed(design)
    ]
    over = f" with the tracks of all {turns}" if turns > 1 else ""
    told = f"the drum unrolled over one turn{over}: {', '.join(design.flanks)} flank and the path of the roller's axis"
    frame = axes(tall, _lengths(design, 0.0, recipe.height), "angle on the drum, °", f"z, {UNIT_NAMES[recipe.units]}")
    body = f'{clip("flat", tall)}{field(tall)}<g clip-path="url(#flat)">{"".join(parts)}{shown}</g>{frame}'
    return chart("development", tall, told, body)


def _flanks(design: DrumDesign, name: str, radius: float) -> list[Array]:
    """Heights (PLACES + 1,), mm, of a flank on a cylinder over each of its turns."""
    if design.recipe.turns == 1:
        z = height(design, name, radius)
        return [np.append(z, z[0])]
    rows = sampled(design.flanks[name], radius)[0]
    part = rows[:: rows.size // design.recipe.turns // PLACES]
    lines = np.column_stack([part.reshape(-1, PLACES), np.roll(part, -PLACES)[::PLACES]])
    return list(lines if design.recipe.rotation == "cw" else lines[:, ::-1])


def crossed(design: DrumDesign) -> list[tuple[float, float]]:
    """Places of crossings: their share of the chart's width, and the height of the roller's axis, mm."""
    if not design.crossings:
        return []
    at = np.array([crossing.first for crossing in design.crossings])
    share = np.mod(design.recipe.sense * at / TURN, 1.0)
    return list(zip(share.tolist(), design.flanks["lower"].pose(at).z.tolist(), strict=True))


def lost_from(design: DrumDesign, theta: Array) -> Array:
    """Distance along the roller (n,), mm, from which on all flanks carry it; from its inner end without undercut."""
    return np.asarray(np.max([carried_from(design, name, theta) for name in design.flanks], axis=0))


def flat_axis(design: DrumDesign, flank: Flank, theta: Array) -> tuple[Array, Array]:
    """Place where a roller's axis meets the blank: polar angle from the shaft angle, turns, and height, mm, (n,)."""
    pose = flank.pose(theta)
    return np.arcsin(pose.y / design.recipe.radius) / TURN, pose.z


def _section(design: DrumDesign, radius: float) -> Array:
    """The roller cut by a cylinder, unrolled, in px from the place of its axis."""
    if design.recipe.roller.shoe is not None:
        return outline(design.recipe.roller) * (flat_scale(design), -flat_scale(design))
    roller = design.recipe.roller.size(radius)
    t = np.arange(ROUND) * (TURN / ROUND)
    across = np.arcsin(np.minimum(roller / radius, 1.0) * np.sin(t)) * (FIELD / TURN)
    return np.column_stack([across, -flat_scale(design) * roller * np.cos(t)])


# --- map --------------------------------------------------------------------------------------------------------------


class AngleMap(NamedTuple):
    """Pressure angles, degrees, of cells (ROWS, COLUMNS) at shaft angles, rad, and distances along the roller, mm.

    nan beyond the end of contact; `short` where undercut takes the contact away.
    """

    theta: Array
    rho: Array
    angle: Array
    short: Mask


def angle_map(design: DrumDesign) -> AngleMap:
    """The map at the middles of its cells."""
    roller = design.recipe.roller
    theta = np.asarray((np.arange(COLUMNS) + 0.5) * (design.recipe.period / COLUMNS), dtype=np.float64)
    rho = np.asarray(roller.inner + (np.arange(ROWS) + 0.5) * (roller.outer - roller.inner) / ROWS, dtype=np.float64)
    angle = np.degrees([_steepness(design, theta, np.full_like(theta, place)) for place in rho])
    outer = np.min([outer_end(design, name, theta) for name in design.flanks], axis=0)
    short = rho[:, None] < lost_from(design, theta)
    return AngleMap(theta, rho, np.where(rho[:, None] > outer, np.nan, angle), short)


def _steepness(design: DrumDesign, theta: Array, rho: Array) -> Array:
    """Greater magnitude of the pressure angles of all flanks, rad (n,), at shaft angles and distances along."""
    return np.asarray(np.max([np.abs(flank.pressure(theta, rho)) for flank in design.flanks.values()], axis=0))


def greatest(design: DrumDesign) -> tuple[float, float, float]:
    """Greatest pressure angle of what carries and its shaft angle, degrees, and its distance along the roller, mm."""
    theta = np.linspace(0.0, design.recipe.period, COLUMNS * ROWS + 1)
    begin = lost_from(design, theta)
    outer = np.min([outer_end(design, name, theta) for name in design.flanks], axis=0)
    rho = np.concatenate([begin, outer])
    angle = np.where(np.tile(begin <= outer, 2), _steepness(design, np.tile(theta, 2), rho), 0.0)
    k = int(angle.argmax())
    return math.degrees(angle[k]), math.degrees(theta[k % theta.size]), float(rho[k])


def colour_step(most: float) -> float:
    """Degrees from colour to colour, so that few are needed up to an angle."""
    return next((step for step in STEPS_OF if most <= step * MOST_COLOURS), STEPS_OF[-1])


def pressure_map(design: DrumDesign) -> str:
    """The pressure angle over shaft angle and distance along the roller in colours, with their scale."""
    recipe, found = design.recipe, angle_map(design)
    most, at, rho = greatest(design)
    step = colour_step(most)
    number = np.where(np.isnan(found.angle) | found.short, -1, np.floor(np.nan_to_num(found.angle) / step)).astype(int)
    over = found.angle > min(limits(design), default=math.inf)
    count = max(math.ceil(most / step), 1)
    parts = []
    for k in range(count):
        low, high = f"{k * step:g}", f"{(k + 1) * step:g}"
        shade = f'fill-opacity="{opacity(k, count):.2f}"'
        for cells, look in ((number == k) & ~over, "cell"), ((number == k) & over, "cell over"):
            if cells.any():
                parts.append(
                    f'<path class="{look}" {shade} d="{_cells(cells)}"><title>{low}° to {high}°</title></path>'
                )
    if found.short.any():
        parts.append(f'<path class="cell none" d="{_cells(found.short)}"><title>undercut</title></path>')
    roller = recipe.roller
    whole = 360.0 * recipe.turns
    x = LEFT + FIELD * at / whole
    y = TOP + HIGH * (roller.outer - rho) / (roller.outer - roller.inner)
    side = "end" if at > 0.5 * whole else "start"
    shift = -8.0 if at > 0.5 * whole else 8.0
    mark = (
        f'<circle class="greatest" cx="{x:.1f}" cy="{y:.1f}" r="4"/>'
        f'<text class="told" x="{x + shift:.1f}" y="{y - 7.0:.1f}" text-anchor="{side}">{most:.2f}°</text>'
    )
    cursor = f'<g class="cursor" transform="translate({LEFT} 0)"><line y1="{TOP}" y2="{TOP + HIGH}"/></g>'
    ends = _lengths(design, roller.inner, roller.outer)
    frame = axes(HIGH, ends, "shaft angle, °", f"radius, {UNIT_NAMES[recipe.units]}", whole=whole)
    told = (
        f"pressure angle over shaft angle and radius, at most {most:.2f} degrees at a shaft angle of {at:.1f} degrees"
    )
    return chart(
        "map", HIGH, told, field(HIGH) + "".join(parts) + frame + cursor + mark, _scale(count, step), more=26.0
    )


def opacity(k: int, count: int) -> float:
    """Strength of the colour of a number of `count`."""
    return 0.1 + 0.85 * k / max(count - 1, 1)


def limits(design: DrumDesign) -> list[float]:
    """Limits of the pressure angle, degrees."""
    bounds = [bound.at_most for bound in design.recipe.limits if bound.figure == PRESSURE_ANGLE]
    return [math.degrees(bound) for bound in bounds if bound is not None]


def _scale(count: int, step: float) -> str:
    """Colours with their angles, below the map."""
    wide = FIELD / count
    y = TOP + HIGH + FOOT + 2.0
    parts = []
    for k in range(count):
        place = f'x="{LEFT + k * wide:.1f}" y="{y}" width="{wide:.1f}" height="9"'
        parts.append(f'<rect class="cell" {place} fill-opacity="{opacity(k, count):.2f}"/>')
    parts += [
        f'<text x="{LEFT + k * wide:.1f}" y="{y + 20.0}" text-anchor="middle">{k * step:g}°</text>'
        for k in range(count + 1)
    ]
    return "".join(parts)


def _cells(cells: Mask) -> str:
    """Path of the cells that hold, those beside one another as one."""
    wide, tall = FIELD / COLUMNS, HIGH / ROWS
    text = []
    for row, line in enumerate(cells):
        for run in runs(line):
            x, y = LEFT + wide * run[0], TOP + HIGH - tall * (row + 1)
            text.append(f"M{x:.1f} {y:.1f}h{wide * run.size:.1f}v{tall:.1f}h{-wide * run.size:.1f}z")
    return "".join(text)


# --- of both ----------------------------------------------------------------------------------------------------------


def _lengths(design: DrumDesign, *ends: float) -> tuple[float, float]:
    """Both ends of an upright axis, mm, in the recipe's unit."""
    low, high = (end / design.recipe.mm for end in ends)
    return low, high


def legend(design: DrumDesign) -> Sequence[str]:
    """Sentences that say what the lines of the development are."""
    mm, unit = design.recipe.mm, UNIT_NAMES[design.recipe.units]
    blank, inner = f"{design.recipe.radius / mm:.6g} {unit}", f"{design.recipe.roller.inner / mm:.6g} {unit}"
    found = [f"Metal and full lines: on the blank, {blank}; dashed: at {inner}, where the roller begins to bear."]
    if design.crossings:
        found.append("Rings: here tracks cross.")
    if (lost_from(design, np.linspace(0.0, design.recipe.period, LINES + 1)) > design.recipe.roller.inner).any():
        found.append("Thick: here undercut takes away a part of the line of contact.")
    return found
