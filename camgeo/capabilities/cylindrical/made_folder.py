"""Files on points of a made drum in a folder: a page, the flanks unrolled with their deviations, a table of points."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.files.markup import one_line
from camgeo.files.table import write_table
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.report.measured_page import (
    DOT,
    INK,
    METAL,
    ZONE,
    document,
    findings,
    heading,
    pair,
    plot,
    plot_points,
    word,
    write_whole,
)
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from kin.cylindrical.measured_flanks import MadeDrum, Measured, Ring
    from kin.numeric.arrays import Array

SHARE = 0.06  # of the drum's length or girth, the lesser: how long the greatest deviation is drawn
MARKS = 30  # degrees between two marks along the girth
MOST_DRAWN = 20_000  # points: more hide one another
FARTHEST = 10  # points of a flank that the page lists
MARGIN, LETTER = 0.08, 0.022  # of the drawing's width: round it, and its letters


def write_drum(
    recipe: DrumRecipe, made: MadeDrum, section: dict[str, Any], where: Sequence[tuple[Path, int]], folder: str
) -> list[str]:
    """Write page, drawing and table of points into a folder; returns their paths in this order.

    `where` has the file and the line of each point, in the order of the points. Raises SurroundingsError where the file
    system refuses.
    """
    drawing = _drawing(recipe, made)
    page = _page(recipe, made, section, where, drawing)
    table, html, svg = (Path(folder) / f"{recipe.name}-made{suffix}" for suffix in (".csv", ".html", ".svg"))
    write_whole(table, lambda path: _write_points(recipe, made, where, path))
    write_whole(html, lambda path: path.write_bytes(page.encode()))
    write_whole(svg, lambda path: path.write_bytes(drawing.encode()))
    return [str(html), str(svg), str(table)]


def _in_file(recipe: DrumRecipe, places: Array) -> Array:
    """Places (n, 3), mm, in the axes of the file, as they were placed."""
    return np.asarray(places * [1.0, recipe.sense, 1.0])


def _feet(recipe: DrumRecipe, flank: Measured) -> Array:
    """Places (n, 3), mm, on the exact flank nearest to the points, in the axes of the file."""
    return _in_file(recipe, flank.places - flank.e[:, None] * flank.normal)


def _outliers(made: MadeDrum) -> Array:
    """Numbers (k,) of points that were left out of the motion."""
    return np.concatenate([np.empty(0, dtype=np.intp), *(ring.outliers for ring in made.rings)])


# --- the table --------------------------------------------------------------------------------------------------------


def _write_points(recipe: DrumRecipe, made: MadeDrum, where: Sequence[tuple[Path, int]], path: Path) -> None:
    """Write a table of all points as placed, their feet on the exact flank and their deviations; recipe's unit."""
    unit, mm = UNIT_NAMES[recipe.units], recipe.mm
    names = ["surface", "file", "line", *(f"{axis}_{unit}" for axis in "xyz"), "shaft_deg"]
    names += [*(f"foot_{axis}_{unit}" for axis in "xyz"), f"deviation_{unit}", "outlier"]
    files = list(dict.fromkeys(file for file, _ in where))
    number = np.array([[files.index(file) + 1.0, line] for file, line in where])
    out, blocks = _outliers(made), []
    for flank in made.flanks:
        columns = [np.full(len(flank.e), 1.0 if flank.gauge.side < 0 else 2.0), *number[flank.rows].T]
        columns += [*(_in_file(recipe, flank.places) / mm).T, np.degrees(flank.theta % TURN)]
        columns += [*(_feet(recipe, flank) / mm).T, flank.e / mm, np.isin(flank.rows, out).astype(float)]
        blocks.append(np.column_stack(columns))
    write_table(path, names, np.concatenate(blocks))


# --- the flanks unrolled ----------------------------------------------------------------------------------------------


def _drawing(recipe: DrumRecipe, made: MadeDrum) -> str:
    """SVG of the feet of all points, unrolled at the blank, with deviations magnified along the axis.

    A deviation points out of the metal where there is too much of it, red; else into it, blue.
    """
    girth, length = TURN * recipe.radius, recipe.part.thickness or 0.0
    most = max(float(np.abs(flank.e).max()) for flank in made.flanks)
    magnified = float(f"{SHARE * min(girth, length) / max(most, 1e-9):.1g}")
    thin, letter = girth / 1000.0, LETTER * girth
    every = [_feet(recipe, flank) for flank in made.flanks]
    ends = f"M0,0H{girth:.5g}M0,{-length:.5g}H{girth:.5g}"
    parts = [f'<path d="{ends}" stroke="{INK}" stroke-width="{thin:.5g}"/>']
    for flank, own in zip(made.flanks, every, strict=True):
        chosen = np.linspace(0, len(flank.e) - 1, min(MOST_DRAWN, len(flank.e))).astype(np.intp)
        feet, e = own[chosen], flank.e[chosen]
        at = np.stack([recipe.radius * (np.arctan2(feet[:, 1], feet[:, 0]) % TURN), -feet[:, 2]], axis=1)
        # out of the metal: up from a lower flank, down from an upper one
        moved = at + np.stack([np.zeros_like(e), flank.gauge.side * magnified * e], axis=1)
        dots = "".join(f"M{pair(place)}h.001" for place in at)
        parts.append(
            f'<path d="{dots}" stroke="{DOT}" stroke-width="{2 * thin:.5g}" stroke-linecap="round" fill="none"/>'
        )
        for over, colour in ((True, METAL), (False, ZONE)):
            ticks = [f"M{pair(at[i])}L{pair(moved[i])}" for i in np.flatnonzero((e > 0.0) == over).tolist() if e[i]]
            parts.append(f'<path d="{"".join(ticks)}" stroke="{colour}" stroke-width="{thin:.5g}" fill="none"/>')
    for degree in range(0, 361, MARKS):
        x = girth * degree / 360.0
        parts.append(f'<path d="M{x:.5g},0v{0.5 * letter:.5g}" stroke="{INK}" stroke-width="{thin:.5g}"/>')
        parts.append(word(x, 1.8 * letter, f"{degree}", letter, "middle"))
    unit = UNIT_NAMES[recipe.units]
    bar = float(f"{max(most, 1e-9) / recipe.mm:.1g}")
    foot, long = 4.2 * letter, bar * recipe.mm * magnified
    parts.append(
        f'<path d="M0,{foot:.5g}h{long:.5g}M0,{foot - 0.3 * letter:.5g}v{0.6 * letter:.5g}'
        f'M{long:.5g},{foot - 0.3 * letter:.5g}v{0.6 * letter:.5g}" stroke="{INK}" stroke-width="{thin:.5g}"/>'
    )
    words = f"{bar:.6g} {unit}; deviation magnified {magnified:.6g} times; polar angles of the drum, degrees"
    parts.append(word(long + letter, foot + 0.35 * letter, words, letter, "start"))
    margin, high = MARGIN * girth, max(length, *(float(feet[:, 2].max()) for feet in every))
    caption = f"{one_line(recipe.name)}: deviation magnified {magnified:.6g} times; out of the metal is too much"
    box = f"{-margin:.6g} {-high - margin:.6g} {girth + 2.0 * margin:.6g} {high + margin + 6.0 * letter:.6g}"
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"><title>{caption}</title>{"".join(parts)}</svg>\n'


# --- the page ---------------------------------------------------------------------------------------------------------


def _page(
    recipe: DrumRecipe, made: MadeDrum, section: dict[str, Any], where: Sequence[tuple[Path, int]], drawing: str
) -> str:
    unit, mm = UNIT_NAMES[recipe.units], recipe.mm
    parts = [heading(recipe.name, section), findings(section, section["rows"])]
    parts.append(f"<h2>Deviation of the flanks, unrolled and magnified</h2>{drawing}")
    half = None if recipe.profile is None else 0.5 * recipe.profile / mm
    for flank in made.flanks:
        dots = np.degrees(flank.theta % TURN), flank.e / mm
        parts.append(f"<h2>Deviation of the {flank.gauge.name} flank over the shaft angle, {unit}</h2>")
        parts.append(plot_points(dots, zone=half))
        parts.append(_farthest(recipe, flank, where))
    parts += [_motion(recipe, made, ring) for ring in made.rings]
    return document(recipe.name, "\n".join(parts))


def _farthest(recipe: DrumRecipe, flank: Measured, where: Sequence[tuple[Path, int]]) -> str:
    """Table of the points that are farthest off."""
    unit, mm = UNIT_NAMES[recipe.units], recipe.mm
    chosen = np.argsort(-np.abs(flank.e), kind="stable")[:FARTHEST]
    places = _in_file(recipe, flank.places)
    head = ["deviation", "shaft, deg", f"x, {unit}", "y", "z", "file", "line"]
    rows = []
    for k in chosen.tolist():
        file, line = where[int(flank.rows[k])]
        cells = [f"{flank.e[k] / mm:+.4g}", f"{math.degrees(flank.theta[k] % TURN):.2f}"]
        cells += [*(f"{value / mm:.4f}" for value in places[k]), file.name, str(line)]
        rows.append("".join(f"<td>{one_line(cell)}</td>" for cell in cells))
    top = "".join(f"<th>{one_line(text)}</th>" for text in head)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f"<table><tr>{top}</tr>{body}</table>"


def _motion(recipe: DrumRecipe, made: MadeDrum, ring: Ring) -> str:
    """Heading and plot of the error of the motion by the points of a ring."""
    scale, unit = report_unit(recipe, recipe.guide.unit)
    scale = 1.0 if unit == "deg" else scale  # a ring tells mm, or degrees
    limit = recipe.verify.motion_error
    zone = None if limit is None else math.degrees(limit) if unit == "deg" else limit / recipe.mm
    name = next(flank.gauge.name for flank in made.flanks if flank.number == ring.flank)
    radius = f"{ring.radius / recipe.mm:.6g} {UNIT_NAMES[recipe.units]}"
    degrees = np.degrees(equal_steps(len(ring.error)))
    drawn = plot(degrees, scale * ring.error, scale * ring.uncertain, zone=zone)
    return f"<h2>Error of the motion by the {name} flank at a radius of {radius}, {unit}</h2>{drawn}"
