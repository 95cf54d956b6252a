"""Outlines as curves of Open CASCADE: lines, circles and splines at a height; lengths in mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.curve.ring import centre_of, radius_of
from camgeo.files.errors import RegionError
from camgeo.fit.pieces import ArcSpline, BSpline, Outline, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array

CONFUSION = 1e-7  # mm: points this close are one to the kernel
SHORTEST = 1e-6  # mm, of a piece of an outline
FLATTEST = 1e-7  # rad: an arc that turns by less is a line here
UNIT = float(np.finfo(np.float64).eps)

# shapes and curves of the kernel have no types
Shape = Any


def misfit(outline: Outline) -> float:
    """Greatest distance, mm, of an outline's wall from it: by rounding, and where an arc is too flat for a cylinder.

    A circle's centre and radius are rounded where its ends and bulge were not.
    """
    if not isinstance(outline, ArcSpline):
        return 0.0
    length, radius, flat = measures(outline)
    sagitta = 0.5 * length * np.abs(outline.bulges)
    return float(np.where(flat, sagitta, 8.0 * UNIT * (radius + np.abs(outline.points).max())).max())


def curves_of(outline: Outline, z: float) -> list[tuple[Shape, tuple[float, float]]]:
    """Curves of the CAD kernel for each piece of an outline at height z, mm, each with its start (x, y), mm.

    A full circle is one curve. Raises RegionError for a piece that is too short for the kernel, ValueError for a
    periodic spline, TypeError for a polygon.
    """
    from OCP.gp import gp_Ax2, gp_Circ, gp_Dir

    if isinstance(outline, BSpline):
        return _splines(outline, z)
    if isinstance(outline, Polygon):
        raise TypeError("a solid has no polygons")
    up = gp_Dir(0.0, 0.0, 1.0)
    whole = outline.circle
    if whole is not None:
        (x, y), radius = whole
        circle = gp_Circ(gp_Ax2(point((x, y), z), up, gp_Dir(1.0, 0.0, 0.0)), radius)
        return [(circle, (x + radius, y))]
    # a circle of the kernel begins at its x axis, so that axis is turned to the start of the arc, and its normal down
    # for a clockwise arc
    length, radii, flat = measures(outline)
    _demand_long(length)
    curves = []
    for k, (start, end, bulge) in enumerate(outline.pieces()):
        place = (float(start[0]), float(start[1]))
        if flat[k]:
            curves.append((_line(start, end, z), place))
            continue
        centre = centre_of(start, end, bulge)
        axis = up if bulge > 0.0 else up.Reversed()
        towards = gp_Dir(*((start - centre) / radii[k]).tolist(), 0.0)
        curves.append((gp_Circ(gp_Ax2(point(centre.tolist(), z), axis, towards), float(radii[k])), place))
    return curves


def _line(start: Array, end: Array, z: float) -> Shape:
    from OCP.gp import gp_Dir, gp_Lin

    return gp_Lin(point(start.tolist(), z), gp_Dir(*(end - start).tolist(), 0.0))


def _splines(outline: BSpline, z: float) -> list[tuple[Shape, tuple[float, float]]]:
    """Curves of a spline, one for each polynomial: quadratures over a face have points enough for one polynomial alone.

    Each has its start (x, y), mm. Raises ValueError for a periodic spline, RegionError for a piece that is too short.
    """
    from OCP.Geom import Geom_BSplineCurve
    from OCP.TColgp import TColgp_Array1OfPnt
    from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

    if not outline.clamped:
        raise ValueError("a spline must begin and end at its first control point")
    degree, beziers = outline.degree, outline.beziers()
    _demand_long(np.hypot(*(beziers[:, -1] - beziers[:, 0]).T))
    ends, whole = TColStd_Array1OfReal(1, 2), TColStd_Array1OfInteger(1, 2)
    for i in (1, 2):
        ends.SetValue(i, i - 1.0)
        whole.SetValue(i, degree + 1)
    curves = []
    for control in beziers.tolist():
        poles = TColgp_Array1OfPnt(1, degree + 1)
        for i, place in enumerate(control, 1):
            poles.SetValue(i, point(place, z))
        x, y = control[0]
        curves.append((Geom_BSplineCurve(poles, ends, whole, degree), (x, y)))
    return curves


def _demand_long(length: Array) -> None:
    """Raise RegionError where a piece is too short for the kernel; `length` (n,) from end to end, mm."""
    if float(length.min()) < SHORTEST:
        raise RegionError(
            f"a piece of the contour is {float(length.min()):.3g} mm long, and Open CASCADE takes points within "
            f"{CONFUSION:g} mm as one: give a larger tolerance"
        )


def inset(outline: ArcSpline, distance: float) -> ArcSpline:
    """Parallel `distance` mm inside an outline: of each arc an arc about the same centre; lines may meet in corners.

    Raises RegionError where an arc meets another piece at an angle, the radius of a convex arc is not above the
    distance, or nothing is left of a line between corners.
    """
    length, radius, flat = measures(outline)
    half = 2.0 * np.arctan(np.where(flat, 0.0, outline.bulges))
    c, s = np.cos(half), np.sin(half)
    # tangents at both ends lie half the sweep to either side of the chord
    along = outline.chords / length[:, None]
    first = np.column_stack([along[:, 0] * c + along[:, 1] * s, along[:, 1] * c - along[:, 0] * s])
    last = np.column_stack([along[:, 0] * c - along[:, 1] * s, along[:, 1] * c + along[:, 0] * s])
    before = np.roll(last, 1, axis=0)
    corner = np.hypot(*(first - before).T)
    turned = distance * corner > 0.1 * CONFUSION
    bent = turned & ~(flat & np.roll(flat, 1))
    if bool(bent.any()):
        raise RegionError(
            f"the arcs meet at {math.degrees(float(corner[bent].max())):.3g} degrees, where no chamfer runs: "
            "leave it out"
        )
    sharp = (outline.bulges > 0.0) & ~flat & (radius <= distance)
    if bool(sharp.any()):
        least = float(radius[sharp].min())
        raise RegionError(f"an arc is sharper than the chamfer of {distance:.6g} mm: give less than {least:.6g} mm")
    inward = np.column_stack([-first[:, 1], first[:, 0]])
    # between two lines the parallels meet on the bisector of their corner
    other = np.column_stack([-before[:, 1], before[:, 0]])
    share = 1.0 + np.sum(inward * other, axis=1)
    meeting = (inward + other) / np.where(turned, share, 2.0)[:, None]
    points = outline.points + distance * np.where(turned[:, None], meeting, inward)
    left = np.sum((np.roll(points, -1, axis=0) - points) * along, axis=1)
    if bool((flat & (left <= SHORTEST)).any()):
        raise RegionError(f"nothing is left of an edge within a chamfer of {distance:.6g} mm")
    return ArcSpline(points, outline.bulges, outline.bound)


def measures(outline: ArcSpline) -> tuple[Array, Array, Any]:
    """Chord, mm, radius, mm, and whether it counts as a straight line, of each piece of an arc spline, (n,) each.

    The radius of a piece that counts as a line is 0.
    """
    length = np.hypot(*outline.chords.T)
    flat = 4.0 * np.abs(outline.bulges) < FLATTEST
    bulge = np.where(flat, 1.0, np.abs(outline.bulges))
    radius = np.where(flat, 0.0, radius_of(length, bulge))
    return length, radius, flat


def point(place: Sequence[float], z: float) -> Shape:
    """Return the kernel's point at a place (x, y) and a height z, mm."""
    from OCP.gp import gp_Pnt

    return gp_Pnt(float(place[0]), float(place[1]), z)
