"""Sizes that a file cannot hold are refused with the least that it can, which then is made and judged."""

from __future__ import annotations

import math
import re

import pytest

import camgeo

CAM = "name: least\ncam: {kind: support, p: 25 + 2*cos(3*t)}\n"
FILES = "export: {tolerance: 0.001, files: [dxf, svg, {dxf: {as: spline}}, stl, 3mf, step]}\nverify: {angles: 60}\n"
PARTS = (
    "bore: SIZE",
    "bore: {hexagon: SIZE}",
    "bore: {square: SIZE}",
    "bore: 10, hub: {diameter: 20, height: SIZE}",
    "bore: 10, keyway: {width: SIZE, depth: 2}",
    "bore: 10, keyway: {width: 3, depth: SIZE}",
    "bolts: {count: 4, circle: 30, hole: SIZE}",
    "dowel: {circle: 30, hole: SIZE}",
    "bore: 10, mark: {as: cut, width: SIZE, length: 4}",
    "chamfer: SIZE",
    "bore: 10, hub: {diameter: 20, height: 10}, set_screw: {diameter: SIZE, height: 5}",
)


def refusal(text: str) -> str:
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.check(camgeo.load(text))
    (error,) = caught.value.errors
    return str(error)


@pytest.mark.parametrize("part", PARTS)
def test_a_feature_too_small_for_a_file_is_refused(part: str) -> None:
    text = f"{CAM}part: {{thickness: 8, {part}}}\n"
    for size in ("1e-9", "1e-6", "0.00099"):
        told = refusal(text.replace("SIZE", size))
        assert told.endswith(f"smaller than a file can hold, given {float(size):g}; give at least 0.001 mm")
        assert told.startswith("recipe:3:")
    least = refusal(f"units: inch\n{text}".replace("SIZE", "1e-9").replace("recipe:3", "recipe:4"))
    assert least.endswith("; give at least 3.93701e-05 inch")
    assert camgeo.load(text.replace("SIZE", "0.001")).part.thickness == 8.0


@pytest.mark.slow
@pytest.mark.parametrize("part", PARTS)
def test_the_least_feature_is_made(part: str) -> None:
    report = camgeo.check(camgeo.load(f"{CAM}part: {{thickness: 8, {part}}}\n{FILES}".replace("SIZE", "0.001")))
    assert report.ok, report.table()


@pytest.mark.slow
def test_a_hub_without_a_wall_is_refused() -> None:
    text = CAM + "part: {thickness: 8, bore: 10, wall: 1e-12, hub: {diameter: SIZE, height: 4}}\n"
    text += "export: {tolerance: 0.001, files: [stl, 3mf]}\n"
    told = refusal(text.replace("SIZE", "10.000000001"))
    assert told.endswith("part.hub.diameter: no wall round the bore, given 10 mm; give more than 10.002 mm")
    assert camgeo.check(camgeo.load(text.replace("SIZE", "10.0021"))).ok


@pytest.mark.thin(4)
@pytest.mark.parametrize("sides", [3, 99])
@pytest.mark.parametrize(("units", "mm"), [("mm", 1.0), ("inch", 25.4)])
def test_a_corner_too_small_for_a_file_is_refused_with_the_least(sides: int, units: str, mm: float) -> None:
    text = (
        f"name: reuleaux\nunits: {units}\n"
        f"cam: {{kind: support, reuleaux: {{sides: {sides}, breadth: {50 / mm}, rounding: SIZE}}}}\n"
        f"part: {{thickness: {8 / mm}}}\n"
        f"export: {{tolerance: {0.001 / mm}, files: [dxf, svg]}}\nverify: {{angles: 60}}\n"
    )
    told = refusal(text.replace("SIZE", "1e-13"))
    found = re.fullmatch(
        rf"recipe:3:\d+: cam.reuleaux.rounding: a corner smaller than a file can hold, given 1e-13; "
        rf"give at least (\S+) {units}",
        told,
    )
    assert found
    assert float(found[1]) * mm * 2.0 * math.sin(math.pi / (2 * sides)) == pytest.approx(1.001e-9, rel=1e-5)
    report = camgeo.check(camgeo.load(text.replace("SIZE", found[1])))
    assert report.ok, report.table()


@pytest.mark.slow
def test_the_pivot_of_an_arm_is_found_where_the_rows_cross_at_a_joint() -> None:
    """The nearest corner breaks a plane by rounding alone, however often that plane is added."""
    text = """
cam:
  kind: disc
  follower: {kind: knife-edge, arm: {length: 64.4, side: leading}}
  motion:
    - {rise: 5.5, over: 85, law: parabolic}
    - {dwell: 50}
    - {return: 5.5, over: 175, law: polynomial-345}
    - {dwell: 50}
  sizing: {pressure-angle: {at_most: 40}}
"""
    design = camgeo.design(camgeo.load(text))
    assert design.ok
    assert design.figures["pressure-angle"].value == pytest.approx(40.0, abs=1e-6)


def test_a_prime_circle_within_the_roller_is_told_what_does() -> None:
    text = (
        "cam: {kind: disc, sizing: {pressure-angle: {at_most: 40}}, follower: {kind: roller, radius: SIZE}, "
        "motion: [{rise: 34, over: 180, law: cubic}, {to: 0, over: 180, law: trapezoid}]}\npart: {thickness: 8}\n"
    )
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.design(camgeo.load(text.replace("SIZE", "18")))
    (error,) = caught.value.errors
    assert error.problem.endswith("lies within the roller: a smaller one would do")
    assert camgeo.design(camgeo.load(text.replace("SIZE", "4"))).ok
