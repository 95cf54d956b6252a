"""Faults of motions and limits that are one line each, with a remedy that is tried here."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

DISC = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 5}, motion: MOTION}\n"
ARM = DISC.replace("radius: 5}", "radius: 5, arm: {length: 60, pivot: 70}}")
BREADTH = "cam: {kind: constant-breadth, base_radius: 30, motion: MOTION}\n"
PAIR = "cam: {kind: double-roller, ratio: 3, arm: 60, roller_radius: 8, arc: {radius: 75}}\n"
RISE = "{rise: 10, over: 180, law: cycloidal}"
BACK = "{return: 10, over: 180, law: cycloidal}"
SOUND = DISC.replace("MOTION", f"[{RISE}, {BACK}]")


def faults(text: str) -> list[str]:
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.design(camgeo.load(text))
    return [str(error).partition(": ")[2] for error in caught.value.errors]


@pytest.mark.parametrize(
    ("cam", "motion", "told", "better"),
    [
        (
            DISC,
            "[{rise: 10, over: 360, law: match}]",
            "cam.motion[0]: a matched segment that stands alone has no neighbour to match: add one, such as a dwell",
            f"[{{dwell: 100}}, {{rise: 10, over: 80, law: match}}, {BACK}]",
        ),
        (
            BREADTH,
            "[{rise: 10, over: 180, law: match}]",
            (
                "cam.motion[0]: a matched segment that stands alone has no neighbour to match: "
                "add one, or give it `at_end: {v: 0, a: 0}`"
            ),
            "[{rise: 10, over: 180, law: match, at_end: {v: 0, a: 0}}]",
        ),
        (
            DISC,
            f"[{RISE}, {{return: 8, over: 180, law: cycloidal}}]",
            (
                "cam.motion: the motion does not join: S jumps from 2 to 0 mm at 0 degrees; "
                "let the motion end where it begins"
            ),
            f"[{RISE}, {BACK}]",
        ),
        (
            DISC,
            f"[{{rise: 10, over: 180, law: constant-velocity}}, {BACK}]",
            (
                "cam.motion: the motion does not join: S' jumps from 0 to 3.1831 mm/rad at 0 degrees; let both sides "
                "meet at one velocity, as laws from rest to rest and law: {uniform: {blend: 10}} do, or give one of "
                "them law: match"
            ),
            "[{rise: 10, over: 180, law: constant-velocity}, {return: 10, over: 180, law: match}]",
        ),
        (
            DISC,
            f"[{{rise: 10, over: 180, law: constant-velocity}}, {BACK}]",
            (
                "cam.motion: the motion does not join: S' jumps from 0 to 3.1831 mm/rad at 0 degrees; let both sides "
                "meet at one velocity, as laws from rest to rest and law: {uniform: {blend: 10}} do, or give one of "
                "them law: match"
            ),
            f"[{{rise: 10, over: 180, law: {{uniform: {{blend: 10}}}}}}, {BACK}]",
        ),
        (
            DISC,
            "[{rise: 10, over: 1e-9, law: cycloidal}, {return: 10, over: 359.999999999, law: cycloidal}]",
            "cam.motion[0]: the angle of a segment, 1e-09 degrees, is as good as none; give 6e-08 or more",
            "",
        ),
        (
            DISC,
            "{points: [[0, 0], [90, 5], [180, 9], [360, 2]]}",
            (
                "cam.motion.points[3]: the motion does not close: it is 0 at the first point, 2 a turn later; "
                "give both the same displacement"
            ),
            "{points: [[0, 0], [90, 5], [180, 9], [360, 0]]}",
        ),
        (
            "units: inch\n" + DISC,
            "{points: [[0, 0], [90, 5], [180, 9], [360, 2]]}",
            (
                "cam.motion.points[3]: the motion does not close: it is 0 at the first point, 2 a turn later; "
                "give both the same displacement"
            ),
            "{points: [[0, 0], [90, 5], [180, 9], [360, 0]]}",
        ),
        (
            ARM,
            "{points: [[0, 0], [90, 5], [180, 9], [360, 2]]}",
            (
                "cam.motion.points[3]: the motion does not close: it is 0 at the first point, 2 a turn later; "
                "give both the same displacement"
            ),
            "{points: [[0, 0], [90, 5], [180, 9], [360, 0]]}",
        ),
        (
            ARM,
            "[{rise: 10, over: 180, law: cycloidal}, {return: 8, over: 180, law: cycloidal}]",
            (
                "cam.motion: the motion does not join: S jumps from 2 to 0 deg at 0 degrees; "
                "let the motion end where it begins"
            ),
            f"[{RISE}, {BACK}]",
        ),
    ],
)
def test_a_motion_that_is_none_says_what_would_do(cam: str, motion: str, told: str, better: str) -> None:
    assert faults(cam.replace("MOTION", motion)) == [told]
    if better:
        camgeo.design(camgeo.load(cam.replace("MOTION", better)))


def test_a_table_that_does_not_close_says_what_would_do(tmp_path: Path) -> None:
    rows = [(angle, 5.0 - 5.0 * math.cos(math.radians(angle))) for angle in range(0, 360, 10)]
    table, recipe = tmp_path / "lift.csv", tmp_path / "cam.yaml"
    recipe.write_text(DISC.replace("MOTION", "{table: lift.csv, reading: 0.05}"))
    lines = "".join(f"{angle};{s}\n" for angle, s in rows)
    table.write_text(f"{lines}360;3\n")
    with pytest.raises(camgeo.RecipeErrors, match=r"line 37: .*; give this row the displacement of the first one"):
        camgeo.design(camgeo.load(recipe))
    table.write_text(f"{lines}360;0\n")
    camgeo.design(camgeo.load(recipe))


@pytest.mark.parametrize(
    ("cam", "limits", "told"),
    [
        (
            SOUND,
            "pressure-angle: {at_least: 3, on_return: 40}",
            "limits.pressure-angle.at_least: cannot be combined with on_return; leave one of the two out",
        ),
        (
            PAIR,
            "pressure-angle: {at_most: 40, on_return: 45}",
            (
                "limits.pressure-angle.on_return: on_return needs a cam of kind disc or constant-diameter; "
                "give at_most alone, which holds on the return too"
            ),
        ),
        (
            SOUND,
            "pressure-angle: {at_most: 30, on_return: 40}, pressure-angle-rise: {at_most: 20}",
            "limits.pressure-angle-rise: limits.pressure-angle with on_return bounds it too; leave one of the two out",
        ),
    ],
)
def test_limits_in_each_other_s_way_are_one_line(cam: str, limits: str, told: str) -> None:
    assert faults(f"{cam}limits: {{{limits}}}\n") == [told]


def test_these_limits_do() -> None:
    for cam, limits in (
        (SOUND, "pressure-angle: {on_return: 60}"),
        (SOUND, "pressure-angle: {at_least: 3, at_most: 60}"),
        (SOUND, "pressure-angle: {at_most: 60, on_return: 60}, pressure-angle-rise: {at_least: 1}"),
        (PAIR, "pressure-angle: {at_most: 80}"),
    ):
        camgeo.load(f"{cam}limits: {{{limits}}}\n")


def test_a_ring_with_holes_and_no_wall_says_what_would_do() -> None:
    ring = SOUND.replace("base_radius: 30", "base_radius: 60, track: internal")
    part = "part: {thickness: 8, outer: SIZE, dowel: {circle: 100, hole: 4}}\n"
    export = "export: {tolerance: 0.01, files: [dxf]}\nverify: {angles: 60}\n"
    report = camgeo.check(camgeo.load(ring + part.replace("SIZE", "100") + export))
    (wall,) = (check for check in report.checks if check.name == "wall")
    assert not wall.ok
    assert "remedy   a part.outer larger by more than 40 mm" in report.explain(wall)


def test_a_pivot_beside_the_pressure_angle_that_finds_it_says_what_would_do() -> None:
    asked = ARM.replace("base_radius: 30", "sizing: {pressure-angle: {at_most: 30}}").replace(
        "MOTION", f"[{RISE}, {BACK}]"
    )
    (told,) = faults(asked)
    remedy = "leave it out, or give base_radius in place of sizing"
    assert told == f"cam.follower.arm.pivot: the pivot is found with the pressure angle; {remedy}"
    assert camgeo.design(camgeo.load(asked.replace(", pivot: 70", ""))).ok
