"""Limits of a recipe's own: each figure's check, its failure, what would do, and what a recipe may not limit.

Holds: camgeo.recipe.figures.
"""

from __future__ import annotations

import json
import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.starters import OF_CAMS
from support.sweepers import evaluate  # needs: sweep

from camgeo.capabilities.sweep.cams import REASONS  # needs: sweep
from camgeo.capabilities.sweep.figures import figure_names  # needs: sweep
from camgeo.checks.declared import CHECKS, LIMIT, declarations
from camgeo.checks.remedies import Missed, limit_remedy
from camgeo.cli.main import main
from camgeo.measures.figures import design_figures
from camgeo.measures.limits import limit_checks
from camgeo.output import pipeline
from camgeo.recipe import figures as needs
from camgeo.recipe.design_figure import NOTHING
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.limits import Limit
from camgeo.recipe.loading import load_text
from camgeo.recipe.starter import starter
from camgeo.report.document import as_json
from camgeo.report.failure import failure
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.json_schema import json_schema
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import Foreseen, foreseen

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe

VERIFY = "verify: {angles: 120}\nexport: {files: [dxf]}\n"
ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n" + VERIFY
WANTED = ROLLER.replace(
    "{cos: {1: 625}}",
    "{harmonics: 3, law: [{rise: 4, over: 20, law: cycloidal}, {return: 4, over: 25, law: cycloidal}]}",
)
PAIR = "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}\n" + VERIFY
FLAT = "cam: {kind: support, p: 30 + 3*cos(2*t) + cos(3*t)}\npart: {thickness: 8, bore: 10}\n" + VERIFY
YOKE = """\
cam:
  kind: constant-breadth
  base_radius: 40
  motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]
"""
TRAIN = "dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, preload: 150, rpm: 600}\n"
LOOSE = "dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, backlash: 0.05, rpm: 600}\n"
LINKED = """\
cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
dwell: {band: 0.1}
"""
SET = """\
cam: {kind: support, p: 25 + 1.5*cos(3*t), shaft: [3, 2]}
part: {thickness: 8, bore: {hexagon: 10}}
export: {tolerance: 0.01, files: [{stl: {parts: all}}]}
verify: {angles: 120}
"""
MOVE = (
    "motion: [{rise: 18, over: 110, law: cycloidal}, {dwell: 60}, {return: 18, over: 170, law: cycloidal}, {dwell: 20}]"
)
STEM = (
    f"cam: {{kind: disc, base_radius: 36, follower: {{kind: roller, radius: 9, offset: 6}}, {MOVE}}}\n"
    + VERIFY
    + "dynamics: {mass: 0.4, stiffness: 2.0e5, preload: 900, rpm: 300, "  # needs: dynamics
    + "guide: {overhang: 40, length: 60, friction: 0.2}}\n"  # needs: dynamics
)
ARM = (
    "cam: {kind: disc, base_radius: 36, "
    f"follower: {{kind: roller, radius: 8, arm: {{length: 65, pivot: 80}}}}, {MOVE}}}\n" + VERIFY
)
FACE = f"cam: {{kind: disc, base_radius: 36, follower: {{kind: flat, tilt: 8, offset: 5}}, {MOVE}}}\n" + VERIFY.replace(
    "dxf", "csv"
)
HELD = YOKE.replace("base_radius: 40", "base_radius: 40\n  preload: {interference: 0.02, stiffness: [1.0e7]}") + VERIFY
LOBE = (
    "cam: {kind: disc, base_radius: 18, follower: {kind: flat}, "
    "motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}}\n" + VERIFY
)
# needs: dynamics
COIL = (
    LOBE
    + "dynamics: {mass: 0.12, rpm: 2000, spring: {seat_length: 40, free_length: 48, rate: 30 N/mm, solid_length: 28}}\n"
)
RIGID = STEM.replace("stiffness: 2.0e5", "width: 10, material: steel")
SPLIT = (
    f"cam: {{kind: disc, base_radius: 36, follower: {{kind: roller, radius: 9}}, {MOVE}}}\n"
    + VERIFY
    + "budget: {permitted: 0.1, tolerances: {profile: 0.02, follower.radius: 0.01}}\n"  # needs: budget
)
# of each figure a recipe that has it
HAVE = {
    **dict.fromkeys(("pressure-angle", "velocity-ratio", "hollow-radius", "pitch-radius", "backlash"), ROLLER),
    **dict.fromkeys(("radius-of-curvature", "size", "swing", "peak-velocity", "peak-acceleration"), FLAT),
    **dict.fromkeys(("peak-jerk", "contact-travel", "wall", "contour-error", "motion-error", "pieces"), FLAT),
    # needs: dynamics
    **dict.fromkeys(("least-force", "peak-force"), YOKE + VERIFY + TRAIN),
    **dict.fromkeys(("pressure-angle-rise", "pressure-angle-return", "roller-speed"), STEM),
    "jam-margin": STEM,  # needs: dynamics
    **dict.fromkeys(("base-radius", "offset"), STEM),
    # needs: dynamics
    **dict.fromkeys(("peak-velocity-at-speed", "peak-acceleration-at-speed", "peak-jerk-at-speed"), STEM),
    **dict.fromkeys(("pivot-clearance", "pivot"), ARM),
    **dict.fromkeys(("preload-force-least", "preload-force-greatest"), HELD),
    # needs: dynamics
    **dict.fromkeys(("contact-force-least", "contact-force-greatest", "shaft-torque", "contact-pressure"), RIGID),
    # needs: dynamics
    **dict.fromkeys(("guide-force", "mean-roller-force"), RIGID),
    **dict.fromkeys(
        ("mass", "centre-of-mass", "inertia", "unbalance"), FLAT.replace("bore: 10", "bore: 10, density: 7850")
    ),
    **dict.fromkeys(("duration", "lobe-centre", "ramp-velocity", "lift-area"), LOBE),
    # needs: dynamics
    **dict.fromkeys(("spring-seat-load", "spring-open-load", "coil-bind"), COIL),
    "face-width": FACE,
    "law-error": WANTED,
    # needs: dynamics
    "least-backlash": YOKE + VERIFY + LOOSE,
    "dwell-error": YOKE + VERIFY,
    **dict.fromkeys(("dwell", "dwell-relative", "transmission-angle", "force-angle"), LINKED + VERIFY),
    **dict.fromkeys(("margin", "shaft-rate", "output-error"), LINKED + VERIFY),
    # needs: mechanism
    **dict.fromkeys(("clearance", "collision"), SET),
    **dict.fromkeys(("budget-worst", "budget-rss"), SPLIT),  # needs: budget
    # needs: valve
    **dict.fromkeys(
        ("valve-lift", "valve-duration", "valve-velocity", "valve-acceleration", "valve-seating"),
        LOBE + "valve: {ratio: 1.6, lash: 0.3}\n",
    ),
}


def loaded(text: str, limits: str = "") -> Recipe:
    return load_text(text + (f"limits: {limits}\n" if limits else ""), "cam.yaml")


@cache
def report_of(text: str, limits: str = "") -> dict[str, Any]:
    report: dict[str, Any] = pipeline.check(loaded(text, limits)).report
    return report


def held(text: str, limits: str) -> list[dict[str, Any]]:
    return [check for check in report_of(text, limits)["checks"] if check["name"].startswith(LIMIT)]


# every figure of a recipe in one run, bounds wide open
def wide(text: str) -> str:
    names = [name for name, own in HAVE.items() if own == text]
    return "{" + ", ".join(f"{name}: {{at_least: -1e9, at_most: 1e9}}" for name in names) + "}"


def value_of(name: str) -> tuple[float, str]:
    """Value and unit, the nearest to its limit of those of several files or runs."""
    first = next(one for one in held(HAVE[name], wide(HAVE[name])) if one["name"] == LIMIT + name)
    return first["value"], first["unit"]


def test_every_figure_has_a_recipe_here() -> None:
    assert set(HAVE) == set(FIGURES)


@pytest.mark.thin(12)
@pytest.mark.parametrize(
    ("text", "sign", "sense"),
    few([(text, *side) for side in ((1.0, "at_most"), (-1.0, "at_least")) for text in sorted(set(HAVE.values()))], 4),
)
def test_limits_hold_and_fail_at_the_figure_itself(text: str, sign: float, sense: str) -> None:
    """A little either side of each figure's value, and at it; all figures of a recipe at once."""
    names = [name for name, own in HAVE.items() if own == text]
    values = {name: value_of(name)[0] for name in names}
    assert all(math.isfinite(value) for value in values.values())
    for step, ok in ((-1e-6, False), (0.0, True), (1e-6, True)):
        bounds = {name: value + sign * step * max(abs(value), 1e-9) for name, value in values.items()}
        said = "{" + ", ".join(f"{name}: {{{sense}: {bound!r}}}" for name, bound in bounds.items()) + "}"
        found = {check["name"]: [] for check in held(text, said)}
        for check in held(text, said):
            found[check["name"]].append(check)
        for name, value in values.items():
            checks = [one for one in found[LIMIT + name] if one["value"] == value]
            assert checks, name
            assert {one["ok"] for one in checks} == {ok}, (name, sense, step)
            assert {one["sense"] for one in checks} == {sense}
            assert all(one["limit"] == pytest.approx(bounds[name], rel=1e-12) for one in checks)
        alone = len(held(text, said)) == len(names)  # not of several files or runs, of which others are farther off
        assert not report_of(text, said)["ok"] if not ok else report_of(text, said)["ok"] or not alone


@pytest.mark.thin(8)
@pytest.mark.parametrize("text", sorted(set(HAVE.values())))
def test_limits_are_foreseen(text: str) -> None:
    recipe = loaded(text, wide(text))
    made = {Foreseen(one["name"], one.get("file")) for one in held(text, wide(text))}
    assert {one for one in foreseen(recipe) if one.name.startswith(LIMIT)} == made


def test_what_a_figure_is_against_the_motion_itself() -> None:
    limits = wide(FLAT)
    values = {check["name"].removeprefix(LIMIT): check for check in held(FLAT, limits)}
    t = np.linspace(0, 2 * math.pi, 100_001)
    p = loaded(FLAT).cam.exact().law.derivatives(t, 3)
    wanted = {
        "swing": np.ptp(p[0]),
        "peak-velocity": np.abs(p[1]).max(),
        "peak-acceleration": np.abs(p[2]).max(),
        "peak-jerk": np.abs(p[3]).max(),
        "contact-travel": np.ptp(p[1]),
        "radius-of-curvature": (p[0] + p[2]).min(),
        "size": np.hypot(p[0], p[1]).max(),
        "wall": p[0].min() - 5,
    }
    for name, value in wanted.items():
        assert values[name]["value"] == pytest.approx(value, rel=1e-5), name
    places = {"peak-velocity": p[1], "peak-acceleration": p[2], "peak-jerk": p[3]}
    for name, row in places.items():
        at = np.interp(math.radians(values[name]["at_deg"]), t, np.abs(row))
        assert at == pytest.approx(values[name]["value"], rel=1e-6), name


@pytest.mark.slow
def test_a_roller_s_figures_against_the_pitch_curve() -> None:
    values = {one["name"].removeprefix(LIMIT): one["value"] for one in held(ROLLER, wide(ROLLER))}
    checks = {one["name"]: one["value"] for one in report_of(ROLLER)["checks"]}
    assert values["pitch-radius"] == checks["pitch-radius"]
    for name in ("pressure-angle", "velocity-ratio"):
        assert values[name] == checks[name]
    assert values["backlash"] == pytest.approx(checks["form-closure"], rel=1e-9)
    profile = designed(loaded(ROLLER)).only_surface.surface
    at = profile.curve.sample(np.linspace(0, profile.curve.shape.period, 40_001)[:-1])
    radii = at.speed / at.turn
    assert values["hollow-radius"] == pytest.approx(-radii[radii < 0].max(), rel=1e-4)
    convex = held(ROLLER, "{radius-of-curvature: {at_least: 1}}")[0]["value"]
    assert convex == pytest.approx(radii[radii > 0].min(), rel=1e-5)
    assert convex == pytest.approx(values["pitch-radius"] - 8, abs=1e-9)


@pytest.mark.slow
def test_a_roller_s_motion_is_that_of_the_table() -> None:
    from camgeo.synthesis.motion_table import motion_table

    recipe = loaded(ROLLER.replace("angles: 120", "angles: 20000"))
    _, table = motion_table(recipe, recipe.cam.exact().motion)
    said = (
        "{swing: {at_most: 1}, peak-velocity: {at_most: 1}, peak-acceleration: {at_most: 1}, peak-jerk: {at_most: 1}}"
    )
    values = [one["value"] for one in held(ROLLER, said)]
    assert values == pytest.approx([np.ptp(table[:, 1]), *np.abs(table[:, 2:]).max(axis=0)], rel=1e-5)


@pytest.mark.slow
def test_flat_faces_have_no_pressure_angle() -> None:
    for text in (FLAT, PAIR):
        (one,) = held(text, "{pressure-angle: {at_most: 0}}")
        assert (one["ok"], one["value"], one["unit"]) == (True, 0.0, "deg")


def test_lengths_are_in_the_recipe_s_unit() -> None:
    inch = "units: inch\ncam: {kind: support, p: 1 + 0.1*cos(2*t)}\n" + VERIFY
    checks = held(inch, "{size: {at_most: 1.0999}, peak-velocity: {at_most: 0.2001}, pressure-angle: {at_most: 45}}")
    assert [(one["ok"], one["unit"]) for one in checks] == [(False, "in"), (True, "in/rad"), (True, "deg")]
    assert [one["value"] for one in checks] == pytest.approx([1.1, 0.2, 0])


def test_both_bounds_are_a_check_each() -> None:
    found = held(FLAT, "{size: {at_least: 40, at_most: 50}}")
    assert [(one["name"], one["sense"], one["ok"]) for one in found] == [
        ("limit:size", "at_least", False),
        ("limit:size", "at_most", True),
    ]


# --- what there is not ------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("text", "name", "why"),
    [
        (FLAT, "dwell-error", "the motion has no dwell"),
        (FLAT, "backlash", "a single flat face has no backlash, and of a trimmed contour it is not judged"),
    ],
)
def test_a_figure_that_cannot_be_had_fails(text: str, name: str, why: str) -> None:
    (one,) = held(text, f"{{{name}: {{at_most: 1}}}}")
    assert (one["ok"], one["value"], one["detail"]) == (False, None, why)


@pytest.mark.slow
def test_a_contour_without_a_hollow_keeps_any_least_radius_of_one() -> None:
    ellipse = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 10}}}\n" + VERIFY
    least, most = held(ellipse, "{hollow-radius: {at_least: 5, at_most: 6}}")
    assert least["ok"]
    assert not most["ok"]
    assert json.loads(json.dumps(as_json(report_of(ellipse, "{hollow-radius: {at_least: 5}}"))))


def told(text: str, limits: str) -> list[str]:
    with pytest.raises(RecipeErrors) as caught:
        loaded(text, limits)
    return [str(error) for error in caught.value.errors]


def test_an_unknown_figure_is_told_with_its_line_and_those_there_are() -> None:
    (one,) = told(FLAT, "{weight: {at_most: 1}}")
    line = FLAT.count("\n") + 1
    assert one.startswith(f"cam.yaml:{line}:10: limits.weight: unknown figure; the figures are swing, ")
    assert "transmission-angle" not in one
    assert "pressure-angle" in one
    assert told(FLAT, "{presure-angle: {at_most: 1}}")[0].endswith("did you mean pressure-angle?")


@pytest.mark.slow
def test_a_figure_that_a_recipe_has_not() -> None:
    missing = {
        needs.OF_FOLLOWER: LINKED,
        needs.OF_FACE: ROLLER,
        needs.OF_WALL: ROLLER,
        needs.OF_GUIDED: ROLLER,
        needs.OF_ROLLING: ROLLER,
        needs.OF_ARM: STEM,
        needs.OF_STEM: ARM,
        needs.OF_WANTED_LAW: ROLLER,
    }
    offered: dict[str, set[str]] = {}
    for name, figure in FIGURES.items():
        if figure.needs is not NOTHING:
            (one,) = told(missing.get(figure.needs, FLAT), f"{{{name}: {{at_most: 1}}}}")
            assert f"limits.{name}: {name} needs " in one
            assert "; the figures of this recipe are " in one
            offered.setdefault(missing.get(figure.needs, FLAT), set()).update(
                re.split(r", | and ", one.partition("recipe are ")[2])
            )
    for recipe, figures in offered.items():
        assert all(loaded(recipe, f"{{{figure}: {{at_most: 1}}}}") for figure in figures)


def test_all_that_a_recipe_has_not_is_told_at_once() -> None:
    """What each figure needs, in one reading; exactly those that the recipe offers are taken."""
    said = told(FLAT, "{" + ", ".join(f"{name}: {{at_most: 1}}" for name in FIGURES) + "}")
    words = dict(re.findall(r": limits\.(\S+): (.*); the figures of this recipe are", "\n".join(said)))
    offered = re.split(r", | and ", said[0].partition("recipe are ")[2])
    assert {*words} | {*offered} == set(FIGURES)
    assert not {*words} & {*offered}
    assert {*offered} >= {name for name, recipe in HAVE.items() if recipe == FLAT}
    for name, need in {
        "dwell": "dwell.band",
        "pressure-angle-rise": "a cam of kind disc or constant-diameter",
        "velocity-ratio": "a cam of kind double-roller or flat-pair",
        "law-error": "cam.delta.law",
        "face-width": "a flat face on a stem",
        "roller-speed": "a roller that a cam of kind disc or constant-diameter turns",
        "pivot-clearance": "an arm that a cam of kind disc works",
        "preload-force-least": "cam.preload.stiffness",
        "transmission-angle": "a linkage",
        "hollow-radius": "a cam for rollers",
        "mass": "part.density, and in a sweep no linkage",
        "lobe-centre": "a stem that a cam of kind disc works",
        "output-error": "a linkage",
    }.items():
        assert words[name] == f"{name} needs {need}"


def test_bounds_that_contradict_each_other() -> None:
    for text, limits, words in (
        (FLAT, "3", ": limits: not a mapping, given 3; give a mapping from figures to bounds"),
        (FLAT, "{size: {at_least: 2, at_most: 1}}", ".size.at_most: below at_least, so nothing is accepted; exchange"),
        (FLAT, "{size: {}}", ": limits.size: no bound; give at_least, at_most or both"),
        (FLAT, "{pressure-angle: {on_return: 40}}", ".on_return: on_return needs a cam of kind disc or constant-diam"),
        (
            STEM,
            "{pressure-angle: {at_least: 1, at_most: 30, on_return: 40}}",
            ".pressure-angle.at_least: cannot be combined with on_return; leave one of the two out",
        ),
        (
            STEM,
            "{pressure-angle: {on_return: 40}, pressure-angle-return: {at_most: 45}}",
            ".pressure-angle-return: limits.pressure-angle with on_return bounds it too; leave one of the two out",
        ),
        (
            LOBE,
            "{duration: [{at_most: 90}, {at_most: 80, at_lift: 1.27}]}",
            ".duration[1]: limits.duration[0] at the same lift bounds it too; leave one of the two out",
        ),
    ):
        (one,) = told(text, limits)
        assert words in one, one
    assert len(loaded(FLAT, "{size: {at_least: 2, at_most: 2}}").limits) == 1
    lifts = loaded(LOBE, "{duration: [{at_most: 90}, {at_least: 80, at_lift: 2}]}").limits
    assert [(one.lift, one.field("at_most")) for one in lifts] == [
        (1.27, "limits.duration[0].at_most"),
        (2.0, "limits.duration[1].at_most"),
    ]
    rise, back = loaded(STEM, "{pressure-angle: {at_most: 30, on_return: 40}}").limits
    assert (rise.figure, rise.at_most, rise.field("at_most")) == (
        "pressure-angle-rise",
        30.0,
        "limits.pressure-angle.at_most",
    )
    assert (back.figure, back.at_most, back.field("at_most")) == (
        "pressure-angle-return",
        40.0,
        "limits.pressure-angle.on_return",
    )


# --- failures in words ------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_exit_status_and_the_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "roller.yaml"
    path.write_text(ROLLER + "limits: {pressure-angle: {at_most: 45}}\n")
    assert main(["check", str(path)]) == 1
    out = capsys.readouterr().out
    assert re.search(r"limit:pressure-angle: 62\.5453 deg, at most 45 allowed, at 134\.30 deg: a smaller swing", out)
    assert "remark" not in out
    path.write_text(ROLLER + "limits: {pressure-angle: {at_most: 65}}\n")
    assert main(["check", str(path)]) == 0
    recipe = loaded(ROLLER, "{pressure-angle: {at_most: 45}}")
    (check,) = held(ROLLER, "{pressure-angle: {at_most: 45}}")
    text = failure(check, report_of(ROLLER), recipe)
    assert "at       134.30" in text
    assert "limits.pressure-angle.at_most" in text
    assert "would satisfy it" in text


SLIGHT = ROLLER.replace("625", "20")
FINE = "export: {tolerance: 0.0001, "


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "name", "bound", "said", "change"),
    [
        (ROLLER, "pressure-angle", "at_most: 45", "a smaller swing", ("625", "300")),
        (SLIGHT, "pressure-angle", "at_most: 20", "stays below 22.5 deg", ("4/3", "6/5")),
        (ROLLER, "velocity-ratio", "at_most: 0.4", "a smaller swing", ("625", "300")),
        (WANTED, "law-error", "at_most: 0.05", "a higher delta.harmonics", ("harmonics: 3", "harmonics: 7")),
        (
            ROLLER,
            "radius-of-curvature",
            "at_least: 8.5",
            "a roller radius of 6.43756 mm",
            ("radius: 8", "radius: 6.43756"),
        ),
        (ROLLER, "hollow-radius", "at_least: 19", "a roller radius of 8.60", ("radius: 8", "radius: 8.7")),
        (FLAT, "radius-of-curvature", "at_least: 14", "a p larger by more than", ("30 +", "36 +")),
        (FLAT, "wall", "at_least: 22", "a bore smaller by", ("bore: 10", "bore: 7")),
        (YOKE + VERIFY, "radius-of-curvature", "at_least: 45", "a base radius larger by more than", ("40", "70")),
        (YOKE + VERIFY, "peak-acceleration", "at_most: 20", "a smaller swing", ("rise: 20", "rise: 5")),
        (
            FLAT,
            "motion-error",
            "at_most: 0.0001",
            "a tolerance of 0.0001",
            ("export: {", "export: {tolerance: 0.0001, "),
        ),
    ],
)
def test_what_would_do_does(text: str, name: str, bound: str, said: str, change: tuple[str, str]) -> None:
    limits = f"{{{name}: {{{bound}}}}}"
    failed = [one for one in held(text, limits) if not one["ok"]]
    assert failed
    assert said in failed[0]["detail"]
    assert change[0] in text
    assert all(one["ok"] for one in held(text.replace(*change), limits))
    assert "limits." not in failed[0]["detail"]


DRIVEN = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  motion: [{rise: 20, over: 110, law: modified-sine}, {dwell: 50}, {return: 20, over: 120, law: cycloidal}, {dwell: 80}]
part: {thickness: 10, bore: 20, density: 7850}
"""
# needs: dynamics
DRIVEN += (
    "dynamics: {mass: 1, rpm: 300, preload: 800, material: steel, guide: {overhang: 40, length: 50, friction: 0.1}}\n"
)
DISCS = DRIVEN.replace("roller, radius: 9}", "roller, radius: 9}\n  conjugate: {radius: 9, distance: 110}").replace(
    "preload: 800", "load: 40"
)
PRESSED = DISCS.replace("  motion", "  preload: {interference: 0.02, stiffness: [4e7]}\n  motion")
PRESSED += "export: {tolerance: 1e-3}\n"
VALVE = """
cam: {kind: disc, base_radius: 18, follower: {kind: flat}, motion: {lobe: {lift: 8.25, half: 66, powers: [2, 8, 14, 20, 26]}}}
"""  # noqa: E501
NOSED = VALVE.replace("lift: 8.25", "nose: 100, lift: 8.25")
SIZED = DRIVEN.replace("  base_radius: 36\n", "").replace(
    "  motion", "  sizing: {pressure-angle: {at_most: 20}}\n  motion"
)
LONGER = (
    "longer links, all in one proportion",
    ("ground: 80, coupler: 70, rocker: 105", "ground: 160, coupler: 140, rocker: 210"),
)
SWUNG = """
cam:
  kind: disc
  base_radius: 34
  follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80}}
  motion: [{rise: 15, over: 120, law: cycloidal}, {return: 15, over: 120, law: modified-sine}, {dwell: 120}]
"""


REMEDIES = [
    (
        DRIVEN,
        "contact-pressure",
        "at_most: 600",
        r"contacts (\S+) times as wide",
        ("thickness: 10", "thickness: {}0"),
    ),
    (DRIVEN, "contact-pressure", "at_most: 600", "a smaller dynamics.preload", ("preload: 800", "preload: 400")),
    (DRIVEN, "contact-pressure", "at_most: 600", "a larger radius", ("radius: 9", "radius: 40")),
    (
        DRIVEN,
        "contact-pressure",
        "at_least: 900",
        r"contacts (\S+) times as wide",
        ("thickness: 10", "thickness: {}0"),
    ),
    (DRIVEN, "contact-pressure", "at_least: 900", "a smaller radius", ("radius: 9", "radius: 3")),
    (DRIVEN, "contact-pressure", "at_least: 900", "a greater dynamics.preload", ("preload: 800", "preload: 2000")),
    (DRIVEN, "contact-pressure", "at_least: 900", "more mass or load", ("mass: 1", "mass: 60")),
    (DRIVEN, "contact-force-greatest", "at_least: 1200", "a greater dynamics.preload", ("800", "1500")),
    (DRIVEN, "shaft-torque", "at_least: 20", "more mass or load", ("mass: 1", "mass: 60")),
    (DRIVEN, "guide-force", "at_least: 900", "a shorter guide", ("length: 50", "length: 12")),
    (DRIVEN, "mean-roller-force", "at_least: 900", "a greater dynamics.preload", ("800", "1200")),
    (DRIVEN, "contact-force-greatest", "at_most: 900", "a smaller dynamics.preload", ("800", "500")),
    (DRIVEN, "contact-force-least", "at_least: 780", "a greater dynamics.preload", ("800", "950")),
    (DRIVEN, "contact-force-least", "at_least: 776", "a lower dynamics.rpm", ("rpm: 300", "rpm: 20")),
    (DRIVEN, "shaft-torque", "at_most: 8", "a smaller dynamics.preload", ("800", "300")),
    (DRIVEN, "guide-force", "at_most: 400", "a longer guide", ("length: 50", "length: 150")),
    (DRIVEN, "mean-roller-force", "at_most: 700", "less mass or load", ("800", "500")),
    (DRIVEN, "roller-speed", "at_most: 4", "a larger roller", ("radius: 9", "radius: 30")),
    (DRIVEN, "size", "at_most: 50", "a smaller cam", ("base_radius: 36", "base_radius: 28")),
    (DRIVEN, "mass", "at_most: 0.4", "a thinner or a smaller part", ("thickness: 10", "thickness: 5")),
    (DISCS, "contact-force-greatest", "at_most: 50", "less mass or load", ("mass: 1", "mass: 0.1")),
    (
        PRESSED,
        "preload-force-least",
        "at_least: 600",
        r"a cam.preload.interference (\S+) times as large",
        ("interference: 0.02", "interference: {}e-2 "),
    ),
    (VALVE, "duration", "at_least: 200", r"lift of 1.27 mm: a cam.motion.lobe.half (\S+) times", ("66", "{}*66")),
    (VALVE, "duration", "at_most: 180", r"a cam.motion.lobe.half (\S+) times as large", ("66", "{}*66")),
    (VALVE, "lift-area", "at_least: 560", r"a cam.motion.lobe.half (\S+) times as large", ("66", "{}*66")),
    (VALVE, "ramp-velocity", "at_most: 0.05", r"a larger cam.motion.lobe.half", ("66", "160")),
    (
        DRIVEN,
        "duration",
        "at_most: 400",
        "a return over less of the turn",
        ("120, law: cycloidal}, {dwell: 8", "50, law: cycloidal}, {dwell: 15"),
    ),
    (SWUNG, "pivot-clearance", "at_least: 40", "a pivot farther from the shaft", ("pivot: 80", "pivot: 100")),
    (LINKED + VERIFY, "dwell", "at_least: 50", "a wider dwell.band", ("band: 0.1", "band: 0.5")),
    (LINKED + VERIFY, "dwell-relative", "at_least: 50", "a wider dwell.band", ("band: 0.1", "band: 0.5")),
    (LINKED + VERIFY, "transmission-angle", "at_least: 36", LONGER[0], LONGER[1]),
    (LINKED + VERIFY, "force-angle", "at_least: 36", LONGER[0], LONGER[1]),
    (LINKED + VERIFY, "margin", "at_least: 60", LONGER[0], LONGER[1]),
    (LINKED + VERIFY, "shaft-rate", "at_least: 0.8", LONGER[0], LONGER[1]),
    (
        LINKED + VERIFY,
        "output-error",
        "at_most: 0.0002",
        "a tolerance of about 0.0003 ",
        ("export: {", "export: {tolerance: 0.0002, "),
    ),
    (
        DRIVEN,
        "centre-of-mass",
        "at_most: 10",
        "a higher part.hub",
        ("bore: 20", "bore: 20, hub: {diameter: 50, height: 20}"),
    ),
    (DRIVEN, "unbalance", "at_most: 4", "a thinner or a smaller part", ("thickness: 10", "thickness: 6")),
    (
        DRIVEN,
        "base-radius",
        "at_most: 30",
        "a cam.base_radius of 30 mm or less",
        ("base_radius: 36", "base_radius: 30"),
    ),
    (
        DRIVEN,
        "base-radius",
        "at_least: 40",
        "a cam.base_radius of 40 mm or more",
        ("base_radius: 36", "base_radius: 40"),
    ),
    (SIZED, "base-radius", "at_most: 20", "a greater pressure-angle under sizing", ("at_most: 20", "at_most: 40")),
    (SIZED, "base-radius", "at_least: 90", "a smaller pressure-angle under sizing", ("at_most: 20", "at_most: 5")),
    (
        DRIVEN,
        "offset",
        "at_least: 4",
        "a cam.follower.offset of 4 mm or more",
        ("radius: 9", "radius: 9, offset: 4"),
    ),
    (
        SIZED,
        "offset",
        "at_least: 4",
        "a cam.follower.offset of 4 mm or more",
        ("radius: 9", "radius: 9, offset: 4"),
    ),
    (SWUNG, "pivot", "at_most: 75", "a cam.follower.arm.pivot of 75 mm or less", ("pivot: 80", "pivot: 75")),
    (DRIVEN, "jam-margin", "at_least: 60", "a longer guide", ("length: 50", "length: 150")),
    (DRIVEN, "jam-margin", "at_least: 60", "less overhang", ("overhang: 40", "overhang: 10")),
    (DRIVEN, "jam-margin", "at_least: 60", "friction of it", ("friction: 0.1", "friction: 0.05")),
    (DRIVEN, "jam-margin", "at_least: 60", "a larger base radius", ("base_radius: 36", "base_radius: 60")),
    (NOSED, "lobe-centre", "at_least: 110", "lobe.nose larger by 10", ("nose: 100", "nose: 110.001")),
    (NOSED, "lobe-centre", "at_most: 80", "lobe.nose smaller by 20", ("nose: 100", "nose: 79.999")),
    (FLAT, "pieces", "at_most: 20", "a larger tolerance", ("export: {", "export: {tolerance: 0.1, ")),
    (FLAT, "pieces", "at_least: 60", "a smaller tolerance", ("export: {", "export: {tolerance: 0.0001, ")),
    (
        FLAT,
        "contour-error",
        "at_most: 0.0002",
        "a tolerance of 0.0002 ",
        ("export: {", "export: {tolerance: 0.0002, "),
    ),
    (
        ROLLER,
        "backlash",
        "at_most: 0.0004",
        "a tolerance of about 0.00024 ",
        ("export: {", "export: {tolerance: 0.0002, "),
    ),
    (ROLLER, "pitch-radius", "at_least: 15.5", "a smaller swing", ("625", "500")),
    (
        YOKE + VERIFY + LOOSE,
        "least-backlash",
        "at_least: 0.06",
        "a greater dynamics.backlash",
        ("backlash: 0.05", "backlash: 0.07"),
    ),
    (
        SET,
        "clearance",
        "at_least: 0.3",
        "a larger mechanism.clearance",
        ("export", "mechanism: {clearance: 0.3}\nexport"),
    ),
    (
        SET,
        "collision",
        "at_least: 0.12",
        "a larger mechanism.clearance",
        ("export", "mechanism: {clearance: 0.4}\nexport"),
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "name", "bound", "said", "change"),
    [row for row in REMEDIES if row[1] in FIGURES],  # those of a capability are where it is
)
def test_a_remedy_is_to_be_done_to_the_cam(
    text: str, name: str, bound: str, said: str, change: tuple[str, str]
) -> None:
    """What it names helps; where it says by how much, exactly that does."""
    limits = f"{{{name}: {{{bound}}}}}"
    failed, *_ = [one for one in held(text, limits) if not one["ok"]]
    found = re.search(said, failed["detail"])
    assert found, failed["detail"]
    assert "limits." not in failed["detail"]
    before, after = change
    if "{}" in after:
        share = float(found[1])
        number = share * float(re.findall(r"[\d.]+", before)[-1])
        after = re.sub(r"[\d.]+$", "", before) + repr(number)
    assert before in text
    assert all(one["ok"] for one in held(text.replace(before, after), limits))


BOTH = SIZED.replace("at_most: 20", "at_most: 20, on_return: 30")
ROUND = SIZED.replace("roller, radius: 9", "flat").replace(
    "pressure-angle: {at_most: 20}", "radius-of-curvature: {at_least: 30}"
)
RING = SIZED.replace("  motion", "  track: internal\n  motion").replace("bore: 20", "outer: 400")
INCHES = "units: inch\n" + YOKE.replace("40", "2").replace("20", "1", 1)
IN_INCHES = "units: inch\ncam: {kind: support, p: 1 + cos(2*t)/10}\npart: {thickness: 0.3, bore: 0.4}\n"
SEGMENTED = DRIVEN.replace("roller, radius: 9", "flat")
SWING = "a smaller swing, or the same over a wider angle"
STROKE = "a smaller stroke, or the same over a wider angle"
LINKS = "longer links, all in one proportion, about the same cam"

# a figure's value, its bound, lengths in mm, and what is said of it; a file's tolerance is 0.001
SAID = [
    (ROLLER, "pressure-angle", 60, 45, SWING),
    (ROLLER, "pressure-angle", 60, 22.75, SWING),
    # without any motion it is half the angle between the rollers, 45 degrees at 4/3
    (ROLLER, "pressure-angle", 60, 22.5, "a ratio nearer to 1 (at this one no swing, however small, stays below 22.5 "),
    (ROLLER, "pressure-angle", 60, 0, "limits.pressure-angle.at_most of 60"),
    (ROLLER, "velocity-ratio", 0.5, 0.4, SWING),
    (ROLLER, "radius-of-curvature", 7, 8.5, "a roller radius of 6.5 mm"),
    (ROLLER, "radius-of-curvature", 1, 8.5, "a roller radius of 0.5 mm"),
    (ROLLER, "radius-of-curvature", 1, 9, "limits.radius-of-curvature.at_least of 1"),
    (ROLLER, "hollow-radius", 18, 19, "a roller radius of 9 mm"),
    (ROLLER, "motion-error", 0.002, 0.001, "a tolerance of about 0.0005"),
    (ROLLER, "backlash", 0.002, 0.001, "a tolerance of about 0.0005"),
    (ROLLER, "backlash", 0.002, 0.003, "limits.backlash.at_least of 0.002"),
    (ROLLER, "pitch-radius", 12, 15, SWING),
    (WANTED, "law-error", 0.1, 0.05, "a higher delta.harmonics, up to 31, or the same motion as cam.law"),
    (ARM, "pressure-angle", 30, 20, f"a larger base radius, {STROKE}"),
    (ARM, "peak-jerk", 30, 20, STROKE),
    (ARM, "roller-speed", 5, 4, "a larger roller"),
    (ARM, "radius-of-curvature", 7, 8.5, "a roller radius of 6.5 mm with a base radius of 44 less that radius"),
    (ARM, "hollow-radius", 7, 8.5, "a roller radius of 9.5 mm with a base radius of 44 less that radius"),
    (ARM, "hollow-radius", 7, 42.9, "a roller radius of 43.9 mm with a base radius of 44 less that radius"),
    (ARM, "hollow-radius", 7, 43, "limits.hollow-radius.at_least of 7"),  # the roller would be the whole base circle
    (ARM, "pitch-radius", 12, 15, f"a larger base radius, {STROKE}"),
    (ARM, "pivot-clearance", 32, 40, "a pivot farther from the shaft"),
    (ARM, "pivot", 80, 75, "a cam.follower.arm.pivot of 75 mm or less"),
    (ARM, "pivot", 75, 80, "a cam.follower.arm.pivot of 80 mm or more"),
    (DRIVEN, "offset", 1, 4, "a cam.follower.offset of 4 mm or more"),
    (DRIVEN, "base-radius", 36, 30, "a cam.base_radius of 30 mm or less"),
    (DRIVEN, "base-radius", 36, 40, "a cam.base_radius of 40 mm or more"),
    (DRIVEN, "size", 60, 50, "a smaller cam"),
    (DRIVEN, "mass", 0.5, 0.4, "a thinner or a smaller part"),
    (DRIVEN, "inertia", 0.5, 0.4, "a thinner or a smaller part"),
    (DRIVEN, "unbalance", 5, 4, "a thinner or a smaller part"),
    (DRIVEN, "centre-of-mass", 12, 10, "a wider or a higher part.hub, or a smaller bore"),
    (FLAT, "radius-of-curvature", 13, 14, "a p larger by more than 1 mm"),
    (FLAT, "wall", 21, 22, "a bore smaller by more than 2 mm"),
    (FLAT, "wall", 21, 25.9, "a bore smaller by more than 9.8 mm"),
    (FLAT, "wall", 21, 26, "limits.wall.at_least of 21"),  # the whole bore
    (FLAT, "motion-error", 0.002, 0.001, "a tolerance of 0.001"),
    (FLAT, "motion-error", 0.002, 0, "limits.motion-error.at_most of 0.002"),
    (FLAT, "contour-error", 0.002, 0.0005, "a tolerance of 0.0005"),
    (FLAT, "contour-error", 0.002, 0, "limits.contour-error.at_most of 0.002"),
    (FLAT, "dwell-error", 0.002, 0.001, "a tolerance of about 0.0005"),
    (FLAT, "pieces", 25, 20, "a larger tolerance"),
    (FLAT, "pieces", 25, 30, "a smaller tolerance"),
    (FLAT, "swing", -3, 1, "limits.swing.at_least of -3"),
    (FLAT, "swing", -3, -4, "limits.swing.at_most of -3"),
    (FLAT, "swing", 0, -4, "limits.swing.at_most of 0"),
    # to the side on which the figure keeps it
    (FLAT, "swing", 1 / 3, 1, "limits.swing.at_least of 0.333333"),
    (FLAT, "swing", -1 / 3, 1, "limits.swing.at_least of -0.333334"),
    (FLAT, "swing", -1 / 3, -1, "limits.swing.at_most of -0.333333"),
    # 0.1 in of a wall, and a little more than 0.2, which is the whole bore
    (IN_INCHES, "wall", 17.78, 20.32, "a bore smaller by more than 0.2 in"),
    (IN_INCHES, "wall", 17.78, 22.9, "limits.wall.at_least of 0.7"),
    (YOKE, "radius-of-curvature", 43, 45, "a base radius larger by more than 2 mm"),
    (YOKE, "peak-acceleration", 25, 20, SWING),
    (INCHES, "radius-of-curvature", 38.1, 50.8, "a base radius larger by more than 0.5 in"),
    (INCHES, "base-radius", 50.8, 25.4, "a cam.base_radius of 1 in or less"),
    (INCHES, "swing", 50.8, 76.2, "limits.swing.at_least of 2"),
    (INCHES, "contour-error", 0.0508, 0.0254, "a tolerance of 0.001"),
    (INCHES, "dwell-error", 0.002, 0.001, f"a tolerance of about {0.0005 / 25.4:.2g}"),
    (HELD, "preload-force-least", 480, 600, "a cam.preload.interference 1.25 times as large"),
    (HELD, "preload-force-greatest", 900, 600, "a cam.preload.interference 0.666666 times as large"),
    (HELD, "preload-force-greatest", 600, 900, "a cam.preload.interference 1.5 times as large"),
    (HELD, "preload-force-greatest", 600, 0, "limits.preload-force-greatest.at_most of 600"),
    (VALVE, "duration", 160, 200, "a cam.motion.lobe.half 1.25 times as large"),
    (VALVE, "duration", 240, 180, "a cam.motion.lobe.half 0.75 times as large"),
    (VALVE, "lift-area", 160, 200, "a cam.motion.lobe.half 1.25 times as large"),
    (VALVE, "ramp-velocity", 0.06, 0.05, "a larger cam.motion.lobe.half"),
    (VALVE, "ramp-velocity", 0.05, 0.06, "limits.ramp-velocity.at_least of 0.05"),
    (VALVE, "lobe-centre", 100, 110, "a cam.motion.lobe.nose larger by 10 deg"),
    (VALVE, "lobe-centre", 100, 80, "a cam.motion.lobe.nose smaller by 20 deg"),
    (SEGMENTED, "duration", 160, 200, "a rise and a return over more of the turn"),
    (SEGMENTED, "duration", 240, 180, "a rise and a return over less of the turn"),
    (SEGMENTED, "ramp-velocity", 0.06, 0.05, "a rise and a return over more of the turn"),
    (SEGMENTED, "ramp-velocity", 0.05, 0.06, "a rise and a return over less of the turn"),
    (SEGMENTED, "duration", 160, 0, "limits.duration.at_most of 160"),
    (LINKED, "dwell", 40, 50, "a wider dwell.band"),
    (LINKED, "dwell-relative", 40, 50, "a wider dwell.band"),
    (LINKED, "dwell", 60, 50, "limits.dwell.at_most of 60"),
    (LINKED, "transmission-angle", 30, 36, LINKS),
    (LINKED, "shaft-rate", 0.6, 0.8, LINKS),
    (LINKED, "output-error", 0.002, 0.001, "a tolerance of about 0.0005"),
    (LINKED, "size", 60, 50, "limits.size.at_most of 60"),  # links are about the same cam
    (SIZED, "pressure-angle", 30, 20, "at_most of 20 under sizing"),
    (SIZED, "pressure-angle-return", 30, 20, "on_return of 20 under sizing"),
    (SIZED, "pressure-angle-rise", 30, 20, "at_most of 20 under sizing"),
    (BOTH, "pressure-angle", 30, 20, "at_most and on_return of 20 under sizing"),
    (BOTH, "pressure-angle-rise", 30, 20, "at_most of 20 under sizing"),
    (SIZED, "radius-of-curvature", 30, 40, "radius-of-curvature: {at_least: 40} under sizing"),
    (SIZED, "hollow-radius", 8, 9, "a roller radius of 10 mm"),
    (SIZED, "pitch-radius", 30, 40, "limits.pitch-radius.at_least of 30"),
    (SIZED, "base-radius", 30, 20, "a greater pressure-angle under sizing"),
    (SIZED, "base-radius", 30, 90, "a smaller pressure-angle under sizing"),
    (ROUND, "base-radius", 30, 20, "limits.base-radius.at_most of 30"),
    (ROUND, "pressure-angle", 30, 20, STROKE),
    (ROUND, "radius-of-curvature", 30, 40, "radius-of-curvature: {at_least: 40} under sizing"),
    (RING, "radius-of-curvature", 30, 34, "a roller radius of 5 mm"),
    (RING, "hollow-radius", 8, 9, "limits.hollow-radius.at_least of 8"),
    (RING, "wall", 8, 9, "a part.outer larger by more than 2 mm"),
]


def test_what_is_said_of_a_missed_limit() -> None:
    """All in one pass, without a design: of the recipe, the figure and its bound alone."""
    recipes = {text: loaded(text) for text in {row[0] for row in SAID}}
    for text, name, value, bound, words in SAID:
        limit = Limit(name, **{"at_most" if value > bound else "at_least": bound})
        unit = "deg" if "angle" in name or name == "law-error" else "mm"
        told = limit_remedy(recipes[text], limit, Missed(value, bound, unit, 0.001))
        assert told.startswith(words) if words.endswith(" ") else told == words, (name, value, bound)


def test_a_lobe_s_limit_says_its_lift_where_it_holds() -> None:
    (found,) = held(VALVE, "{duration: {at_least: 100}}")
    assert (found["ok"], found["detail"]) == (True, "at a lift of 1.27 mm")


# --- schema, starters, sweeps -----------------------------------------------------------------------------------------


def test_the_schema_knows_every_limit() -> None:
    schema = json_schema(recipe_table())["properties"]["limits"]
    assert set(schema["properties"]) == set(FIGURES)
    assert schema["additionalProperties"] is False
    more = {"pressure-angle": {"on_return"}}
    more |= {f"peak-{one}-at-speed": {"rpm"} for one in ("velocity", "acceleration", "jerk")}
    more |= {name: {"at_lift"} for name in ("duration", "lobe-centre", "ramp-velocity", "lift-area")}
    more |= {name: {"at_lift"} for name in ("valve-duration", "valve-seating")}  # needs: valve
    for name, bounds in schema["properties"].items():
        assert set(bounds["properties"]) == {"at_least", "at_most"} | more.get(name, set())
        assert bounds["minProperties"] == 1
    lifts = schema["properties"]["duration"]  # one mapping, or a list of them
    assert lifts["type"] == ["object", "array"]
    assert lifts["items"] == {key: lifts[key] for key in lifts["items"]} | {"type": "object"}
    assert "items" not in lifts["items"]
    assert json.loads(json.dumps(schema)) == schema


@pytest.mark.parametrize("kind", OF_CAMS)
def test_each_starter_tells_of_limits(kind: str) -> None:
    assert re.search(r"^(# )?limits: .*# figures that must keep within bounds", starter(kind), re.MULTILINE)


def test_limits_reach_verify(tmp_path: Path) -> None:
    (tmp_path / "cam.yaml").write_text(FLAT)
    assert main(["export", str(tmp_path / "cam.yaml"), "--out", str(tmp_path / "out")]) == 0
    (tmp_path / "tight.yaml").write_text(FLAT + "limits: {motion-error: {at_most: 1e-9}}\n")
    made = str(tmp_path / "out" / "cam" / "cam.dxf")
    assert main(["verify", str(tmp_path / "tight.yaml"), made]) == 1
    assert main(["verify", str(tmp_path / "cam.yaml"), made]) == 0


SWEEP = """\
sweep:
  vary: {cam.delta.cos.1: {from: 200, to: 600, steps: 5}}
  limits: {pressure-angle: {at_most: 50}}
  rank: pressure-angle
"""


# needs: sweep
@pytest.mark.slow
def test_a_sweep_limits_and_ranks_by_the_pressure_angle() -> None:
    recipe = loaded(ROLLER + SWEEP)
    values = np.array([[200.0], [300.0], [400.0], [500.0], [600.0]])
    found = evaluate(recipe, ("cam.delta.cos.1",), values)
    angles = found.figures["pressure-angle"]
    assert (np.diff(angles) > 0).all()
    assert [REASONS[code] == "limits" for code in found.reason] == list(angles > 50)
    assert 0 < (angles > 50).sum() < 5
    one = loaded(ROLLER.replace("625", "300"), "{pressure-angle: {at_most: 1}}")
    check = next(one for one in designed(one).checks if one.name == "pressure-angle")
    assert angles[1] == check.value


# needs: sweep
def test_a_sweep_has_the_figures_of_its_limits() -> None:
    recipe = loaded(ROLLER + SWEEP)
    own = {name: value_of(name)[0] for name in figure_names(recipe) if HAVE.get(name) == ROLLER}
    found = evaluate(recipe, ("cam.delta.cos.1",), np.array([[625.0]])).figures
    assert len(own) == 4
    for name, value in own.items():
        assert found[name][0] == pytest.approx(value, rel=1e-12), name


def test_every_limit_is_declared() -> None:
    assert {one.name for one in declarations()} == {*CHECKS, *(LIMIT + name for name in FIGURES)}


COEFFICIENTS = st.lists(st.integers(-30, 30), min_size=3, max_size=3)


@settings(deadline=None, max_examples=examples(10))
@given(COEFFICIENTS, COEFFICIENTS, st.floats(-2, 2), st.sampled_from(["at_least", "at_most"]))
def test_any_cam_s_figures_are_those_of_its_motion(cos: list[int], sin: list[int], share: float, sense: str) -> None:
    """Figures against dense samples of the support function, and each limit held as plain arithmetic has it."""
    both = enumerate(zip(cos, sin, strict=True), 1)
    terms = [f"{c / 100}*cos({k}*t) + {s / 100}*sin({k}*t)" for k, (c, s) in both]
    text = f"cam: {{kind: support, p: 30 + {' + '.join(terms)}}}\n".replace("+ -", "- ")
    names = [
        "swing",
        "peak-velocity",
        "peak-acceleration",
        "peak-jerk",
        "contact-travel",
        "radius-of-curvature",
        "size",
    ]
    recipe = loaded(text)
    design = designed(recipe)
    t = np.linspace(0, 2 * math.pi, 20_001)
    p = recipe.cam.exact().law.derivatives(t, 3)
    peaks = np.abs(p[1:]).max(axis=1)
    wanted = [np.ptp(p[0]), *peaks, np.ptp(p[1]), (p[0] + p[2]).min(), np.hypot(p[0], p[1]).max()]
    figures = design_figures(recipe, design, design.checks, names)
    for name, value in zip(names, wanted, strict=True):
        assert figures[name].value == pytest.approx(value, rel=1e-5, abs=1e-9), name
    bounds = {name: float(value) * (1 + share) + 1e-3 * share for name, value in zip(names, wanted, strict=True)}
    said = "{" + ", ".join(f"{name}: {{{sense}: {bound!r}}}" for name, bound in bounds.items()) + "}"
    checks = limit_checks(loaded(text, said), design, design.checks, [], None)
    assert [check.name for check in checks] == [LIMIT + name for name in names]
    values = [figures[name].value or 0.0 for name in names]
    sign = 1.0 if sense == "at_least" else -1.0
    if abs(share) > 1e-4:  # else rounding decides
        assert [check.ok for check in checks] == [
            sign * (v - bounds[n]) >= 0.0 for n, v in zip(names, values, strict=True)
        ]


def test_the_backlash_of_a_groove_without_a_flank(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It could not be judged; nothing is said of flat faces."""
    recipe = tmp_path / "groove.yaml"
    motion = "[{rise: 18, over: 180, law: modified-sine}, {return: 18, over: 180, law: cycloidal}]"
    recipe.write_text(
        "cam: {kind: disc, base_radius: 38, follower: {kind: roller, radius: 11}, track: {groove: {clearance: 0.03}}, "
        f"motion: {motion}}}\nlimits: {{backlash: {{at_most: 0.1}}}}\nexport: {{tolerance: 0.005, files: [dxf]}}\n",
        encoding="utf-8",
    )
    assert main(["export", str(recipe), "--out", str(tmp_path)]) == 0
    drawing = tmp_path / "groove" / "groove.dxf"
    drawing.write_text(drawing.read_text(encoding="utf-8").replace("GROOVE_OUTER", "REFERENCE"), encoding="utf-8")
    assert main(["verify", str(recipe), str(drawing)]) == 1
    out = capsys.readouterr().out
    assert "limit:backlash (groove.dxf): the file could not be judged" in out
    assert "flat face" not in out
