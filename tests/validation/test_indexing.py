# needs: indexing
"""Indexing cams against worked cases of 50 digits, computed without camgeo, and against rollers at all positions.

c15 is a barrel, measured on the lines of its exported development. c16 is a globoid, whose flank the library gives.
"""

import math
from functools import cache

import numpy as np
import pytest
from capabilities.indexing.rollers import Indexed, globoid_away, nearest
from support.page_tables import Row

import camgeo
from kin.read.drawing.straight import read_lines

C15 = """
cam:
  kind: indexing
  barrel: {radius: 50, offset: 60}
  depth: 14
  turret: {stops: 6, radius: 60, roller: 9}
  motion: [{rise: 60, over: 150, law: cycloidal}, {dwell: 210}]
part: {length: 72}
export: {tolerance: 0.001, files: [{dxf: {as: development, at: [45.1822706308, 36.7129404979, 44.0195752172]}}]}
"""
C16 = """
cam:
  kind: indexing
  globoid: {distance: 90, radius: 49}
  depth: 14
  turret: {stops: 8, roller: 8}
  motion: [{rise: 45, over: 120, law: cycloidal}, {dwell: 240}]
part: {length: 60}
export: {tolerance: 0.01, files: [stl]}
"""
ON_LINES = [  # radius, mm, and polar angle, deg, flank, height over the turret's axis, mm
    (45.1822706308, 53.1360149742, "LOWER", "-31.2009649506"),
    (36.7129404979, 63.690067526, "UPPER", "5.4"),
    (44.0195752172, 111.708771914, "UPPER", "32.1431223568"),
]
TOUCHED = [  # shaft angle, deg, distance from the cam's axis, mm, polar angle, deg, upper flank, height
    (40.0, 31.586482771, 51.1074062696, False, "-19.7321477863"),
    (60.0, 40.372486051, 52.2109522658, True, "5.83629763312"),
]
WITHIN = 1.5e-3  # mm: chords of the file along a line that rises


@cache
def globoid(text=C16):
    return camgeo.design(camgeo.load(text))


def flank_at(theta, r, upper, z):
    """Point (3,) of the globoid's flank that is touched at a shaft angle, deg, in the layer of a place of radius r."""
    return globoid().flank(math.radians(theta), math.hypot(90.0 - r, float(z)), upper=upper)[0]


def rows(workshop):
    layers = {f"R{r:.9g}_{name}": (r, phi, z) for r, phi, name, z in ON_LINES}
    path = workshop.out / "c15"
    camgeo.export(camgeo.load(C15), path)
    _, lines = read_lines(next(path.rglob("*.dxf")), list(layers))
    found = []
    for layer, (r, phi, z) in layers.items():
        x = math.radians(phi) * r
        heights = np.concatenate([np.interp([x], *np.array(part).T, np.nan, np.nan) for part in lines[layer]])
        ours = float(heights[np.nanargmin(np.abs(heights - float(z) - 36.0))]) - 36.0
        what = f"height of the line {layer} of c15 at {phi:g}°, mm"
        found.append(Row(what, "worked case, 50 digits", z, float(z), ours, WITHIN, ".9g"))
    for theta, r, phi, upper, z in TOUCHED:
        x, y, height = flank_at(theta, r, upper, z)
        case, source = f"c16, touched at {theta:g}°", "worked case, 50 digits"
        angle = math.degrees(math.atan2(y, x))
        found += [
            Row(f"height of the flank of {case}, mm", source, z, float(z), height - 30.0, 1e-9, ".12g"),
            Row(f"polar angle of the flank of {case}, deg", source, f"{phi}", phi, angle, 1e-9, ".12g"),
        ]
    motion = Indexed([("rise", 45.0, 120.0, "cycloidal"), ("dwell", 0.0, 240.0, "")], -22.5)
    points = np.array([flank_at(theta, r, upper, z) for theta, r, _, upper, z in TOUCHED])
    least = nearest(globoid_away(90.0, 30.0), motion, points, 2)
    what = "least distance of these points of c16 from the axes of all rollers at all positions, mm"
    return [*found, Row(what, "brute force over positions", "8", 8.0, float(least.min()), 1e-9, ".10g")]


@pytest.mark.slow
def test_a_roller_that_is_larger_is_told_apart():
    """A thousandth of a millimetre more is far outside what the rows of c16 may differ by."""
    theta, r, _, upper, z = TOUCHED[0]
    other = globoid(C16.replace("roller: 8", "roller: 8.001"))
    layer = math.hypot(90.0 - r, float(z))
    moved = other.flank(math.radians(theta), layer, upper=upper)[0]
    assert np.linalg.norm(moved - flank_at(theta, r, upper, z)) > 5e-4
