"""Files on a measured part in a folder: a page, the deviation round the contour as a drawing, every point as a table.

Of a shaft each cam has these files, and the shaft a page that leads to theirs.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.made.made_part import motion_uncertainty
from camgeo.capabilities.made.part_points import label_of
from camgeo.capabilities.made.section_text import shaft_rows, table_rows
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
    word,
    write_whole,
)
from kin.follower.recognised import COVERAGE
from kin.numeric.feet import equal_steps
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.made.made_part import PartMade, SurfaceMade
    from camgeo.capabilities.made.options import PointOptions
    from camgeo.capabilities.made.shaft import ShaftMade
    from camgeo.recipe.recipe import Recipe, ShaftOrder
    from kin.numeric.arrays import Array

LOOKS = 1440  # places at which a curve is drawn, round the contour or over the shaft angle
SHARE = 0.12  # of the cam's greatest radius: how long the greatest deviation is drawn
MARKS = 30  # degrees of the shaft between two marks round the contour
WITHIN, LEAST_WITHIN = 0.2, 0.45  # of the cam's size: how far marks stand within the contour; of the radius: at least
LETTER = 0.035  # of the reach of the drawing: its letters
MOST_DOTS = 4000  # of points in a plot: more hide one another


def write_part(recipe: Recipe, result: PartMade, section: dict[str, Any], options: PointOptions) -> list[str]:
    """Write page, drawing and table of points into the folder `options.out`; returns their paths in this order.

    Raises SurroundingsError where the file system refuses.
    """
    folder = Path(options.out or "")
    drawing = _drawing(recipe, result)
    page = _page(recipe, result, section, options, drawing)
    table, html, svg = (folder / f"{recipe.name}-made{suffix}" for suffix in (".csv", ".html", ".svg"))
    write_whole(table, lambda path: _write_points(recipe, result, path))
    write_whole(html, lambda path: path.write_bytes(page.encode()))
    write_whole(svg, lambda path: path.write_bytes(drawing.encode()))
    return [str(html), str(svg), str(table)]


def write_shaft(recipe: ShaftOrder, result: ShaftMade, section: dict[str, Any], options: PointOptions) -> list[str]:
    """Write the page of a shaft and the files of each cam into the folder `options.out`; returns their paths.

    Raises SurroundingsError where the file system refuses.
    """
    written, pages = [], []
    for lobe, entry in zip(result.cams, section["lobes"], strict=True):
        cam = lobe.points.cam
        named = replace(cam.recipe, name=f"{recipe.name}-{label_of(cam.name)}")
        written += write_part(named, lobe.result, entry, options)
        pages.append((cam.name, f"{named.name}-made.html"))
    path = Path(options.out or "") / f"{recipe.name}-made.html"
    page = _shaft_page(recipe.name, section, pages)
    write_whole(path, lambda partial: partial.write_bytes(page.encode()))
    return [str(path), *written]


# --- the table --------------------------------------------------------------------------------------------------------


def _write_points(recipe: Recipe, result: PartMade, path: Path) -> None:
    """Write a table of every place with its foot, deviation and residual, as drawn, in the recipe's unit."""
    unit, sign = UNIT_NAMES[recipe.units], -1.0 if recipe.rotation == "ccw" else 1.0
    names = ["surface", "file", "line", f"x_{unit}", f"y_{unit}", "shaft_deg", f"foot_x_{unit}", f"foot_y_{unit}"]
    names += [f"deviation_{unit}", f"residual_{unit}", "outlier"]
    blocks = []
    for rank, surface in enumerate(result.surfaces):
        points, deviations = surface.measured.points, surface.measured.deviations
        feet = surface.gauge.envelope.points(deviations.parameter)
        shaft = np.mod(np.degrees(surface.gauge.shaft_angle(deviations.parameter)), 360.0)
        columns = [np.full(len(points), rank + 1.0), surface.measured.files + 1.0, surface.measured.lines.astype(float)]
        columns += [points.places[:, 0] / recipe.mm, sign * points.places[:, 1] / recipe.mm, shaft]
        columns += [feet[:, 0] / recipe.mm, sign * feet[:, 1] / recipe.mm]
        columns += [deviations.e / recipe.mm, surface.fit.residuals / recipe.mm, surface.fit.outliers.astype(float)]
        blocks.append(np.column_stack(columns))
    write_table(path, names, np.concatenate(blocks))


# --- the drawing round the contour ------------------------------------------------------------------------------------


def _drawing(recipe: Recipe, result: PartMade) -> str:
    """SVG of the exact contours, with the smoothed deviation magnified along their normals, red for too much metal."""
    sign = np.array([1.0, 1.0 if recipe.rotation == "ccw" else -1.0])  # of a drawing whose y axis points down
    t = equal_steps(LOOKS)
    size, most = 0.0, 0.0
    curves = []
    for surface in result.surfaces:
        frame = surface.gauge.envelope.frames(t)
        e = surface.fit.curve.rows(t)[0]
        size, most = max(size, float(np.abs(frame.points).max())), max(most, float(np.abs(e).max()))
        curves.append((frame.points * sign, surface.measured.points.side * frame.normals * sign, e))
    # scale, rounded to one digit, by which the greatest deviation is drawn as SHARE of the size
    magnified = float(f"{SHARE * size / max(most, 1e-9):.1g}")
    reach = size * (1.0 + 1.3 * SHARE)
    thin = reach / 400.0
    parts = []
    for points, normals, e in curves:
        moved = points + magnified * e[:, None] * normals
        for over, colour in ((True, METAL), (False, ZONE)):
            ticks = [
                f"M{pair(points[i])}L{pair(moved[i])}" for i in range(0, LOOKS, 4) if bool(e[i] > 0.0) is over and e[i]
            ]
            parts.append(f'<path d="{"".join(ticks)}" stroke="{colour}" stroke-width="{thin:.5g}" fill="none"/>')
        parts.append(f'<path d="{_path(points)}Z" stroke="{INK}" stroke-width="{2 * thin:.5g}" fill="none"/>')
        parts.append(f'<path d="{_path(moved)}Z" stroke="{METAL}" stroke-width="{1.5 * thin:.5g}" fill="none"/>')
    parts += _marks(result.surfaces[0], size, reach, sign)
    unit = UNIT_NAMES[recipe.units]
    bar = float(f"{max(most, 1e-9) / recipe.mm:.1g}")
    foot, long = 1.06 * reach, bar * recipe.mm * magnified
    parts.append(
        f'<path d="M{-0.95 * reach:.5g},{foot:.5g}v{-0.02 * reach:.5g}v{0.01 * reach:.5g}h{long:.5g}'
        f'v{-0.01 * reach:.5g}v{0.02 * reach:.5g}" stroke="{INK}" stroke-width="{thin:.5g}" fill="none"/>'
    )
    words = f"{bar:.6g} {unit}; deviation magnified {magnified:.6g} times; angles of the shaft, degrees"
    parts.append(word(-0.95 * reach + long + 0.02 * reach, foot, words, LETTER * reach, "start"))
    arm = 0.03 * reach
    cross = f"M{-arm:.5g},0h{2.0 * arm:.5g}M0,{-arm:.5g}v{2.0 * arm:.5g}"
    parts.append(f'<path d="{cross}" stroke="{INK}" stroke-width="{thin:.5g}"/>')
    caption = f"{one_line(recipe.name)}: deviation magnified {magnified:.6g} times; outwards of the metal is too much"
    box = f"{-reach:.6g} {-reach:.6g} {2 * reach:.6g} {2.1 * reach:.6g}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="640" height="672">'
        f"<title>{caption}</title>{''.join(parts)}</svg>\n"
    )


def _marks(surface: SurfaceMade, size: float, reach: float, sign: Array) -> list[str]:
    """Marks in SVG every MARKS degrees of the shaft, within the contour of a surface where it is touched then."""
    t = equal_steps(LOOKS)
    shaft = np.mod(np.degrees(surface.gauge.shaft_angle(t)), 360.0)
    points = surface.gauge.envelope.frames(t).points * sign
    marks = []
    for degree in range(0, 360, MARKS):
        k = int(np.argmin(np.abs(np.mod(shaft - degree + 180.0, 360.0) - 180.0)))
        point, radius = points[k], float(np.hypot(*points[k]))
        inner = max(radius - WITHIN * size, LEAST_WITHIN * radius) / max(radius, 1e-9)
        tick = f"M{pair(point)}L{pair(point * (1.0 + 2.0 * inner) / 3.0)}"
        marks.append(f'<path d="{tick}" stroke="{DOT}" stroke-width="{reach / 500.0:.5g}"/>')
        x, y = (point * inner).tolist()
        marks.append(word(x, y + 0.35 * LETTER * reach, f"{degree}", LETTER * reach, "middle"))
    return marks


def _path(points: Array) -> str:
    return "M" + "L".join(pair(point) for point in points)


# --- the page ---------------------------------------------------------------------------------------------------------


def _page(recipe: Recipe, result: PartMade, section: dict[str, Any], options: PointOptions, drawing: str) -> str:
    unit, mm = UNIT_NAMES[recipe.units], recipe.mm
    scale, moved = report_unit(recipe, result.motion_unit)
    parts = [heading(recipe.name, section), findings(section, table_rows(section, everything=True))]
    parts.append(f"<h2>Deviation round the contour, magnified</h2>{drawing}")
    for surface in result.surfaces:
        name = f" of {one_line(surface.measured.intent.name)}" if surface.measured.intent.name else ""
        parts.append(f"<h2>Deviation{name} over the shaft angle, {unit}</h2>{_over_shaft(recipe, surface)}")
    errors, uncertain = result.motion, motion_uncertainty(result, options)
    limit = recipe.verify.motion_error
    zone = None if limit is None else math.degrees(limit) if moved == "deg" else limit / mm
    parts.append(f"<h2>Error of the motion less its constant offset, {moved}</h2>")
    parts.append(plot(np.degrees(errors.shaft), scale * errors.remaining, scale * uncertain, zone=zone))
    parts.append("<h2>What to take off</h2>" + _take_off(result, mm, unit))
    return document(recipe.name, "\n".join(parts))


def _shaft_page(name: str, section: dict[str, Any], pages: Sequence[tuple[str, str]]) -> str:
    links = "".join(f'<li><a href="{one_line(page)}">{one_line(title)}</a></li>' for title, page in pages)
    found = heading(name, section) + findings(section, shaft_rows(section, everything=False))
    return document(name, f"{found}\n<h2>Each lobe</h2><ul>{links}</ul>")


def _over_shaft(recipe: Recipe, surface: SurfaceMade) -> str:
    t = equal_steps(LOOKS)
    gauge, mm, deviations = surface.gauge, recipe.mm, surface.measured.deviations
    shaft = np.mod(np.degrees(gauge.shaft_angle(t)), 360.0)
    order = np.argsort(shaft, kind="stable")
    dots = np.mod(np.degrees(gauge.shaft_angle(deviations.parameter)), 360.0), deviations.e / mm
    zone = recipe.profile
    half = None if zone is None else 0.5 * zone / mm
    e, band = surface.fit.curve.rows(t)[0] / mm, COVERAGE * surface.fit.curve.standard_deviations(t) / mm
    return plot(shaft[order], e[order], band[order], dots=dots, zone=half)


def _excesses(surface: SurfaceMade) -> list[tuple[float, float, float, float]]:
    """Stretches of a surface with certainly too much metal, as (begin, end, greatest excess, its angle).

    Angles are degrees of the shaft; the excess, mm, is above twice its standard deviation all along.
    """
    t = equal_steps(LOOKS)
    e, band = surface.fit.curve.rows(t)[0], COVERAGE * surface.fit.curve.standard_deviations(t)
    over = e > np.maximum(band, 1e-6)
    if not over.any():
        return []
    turn = 0 if over.all() else int(np.flatnonzero(~over)[0])
    over, e, t = np.roll(over, -turn), np.roll(e, -turn), np.roll(t, -turn)
    edges = np.flatnonzero(np.diff(over.astype(np.intp), prepend=0, append=0))
    shaft = np.mod(np.degrees(surface.gauge.shaft_angle(t)), 360.0)
    excesses = []
    for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        worst = a + int(np.argmax(e[a:b]))
        excesses.append((float(shaft[a]), float(shaft[b - 1]), float(e[worst]), float(shaft[worst])))
    return excesses


def _take_off(result: PartMade, mm: float, unit: str) -> str:
    rows: list[Sequence[str]] = []
    for surface in result.surfaces:
        for begin, end, most, at in _excesses(surface):
            rows.append((surface.measured.intent.name, f"{begin:.1f}", f"{end:.1f}", f"{most / mm:.4g}", f"{at:.1f}"))
    if not rows:
        return "<p>Nowhere is metal too much beyond its uncertainty.</p>"
    head = "".join(f"<th>{text}</th>" for text in ("surface", "from, deg", "to, deg", f"most, {unit}", "at, deg"))
    body = "".join("<tr>" + "".join(f"<td>{one_line(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"
