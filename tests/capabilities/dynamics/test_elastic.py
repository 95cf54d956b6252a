"""Recipes that ask for dynamics, from text to report: checks, runs, spoilt files, and what is refused.

Holds: camgeo.capabilities.dynamics.declared, camgeo.capabilities.dynamics.recipe,
camgeo.capabilities.dynamics.measures.
"""

from __future__ import annotations

import json
import math
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.report.document import as_json
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.expected_checks import foreseen

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe

CAM = """\
name: train
cam:
  kind: constant-breadth
  base_radius: 40
  motion:
    - {rise: 20, over: 120, law: modified-sine}
    - {dwell: 60}
export: {files: [dxf]}
verify: {angles: 120}
"""
TRAIN = "dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, preload: 150, rpm: 600}\n"
FOLLOWED = TRAIN.replace("rpm: 600", "rpm: 600, transient: true")
PAIR = """\
name: pair
cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}
export: {files: [dxf]}
verify: {angles: 120}
"""


def recipe(train: str = TRAIN, cam: str = CAM) -> Recipe:
    return read((cam + train).encode(), "train.yaml")


def section(recipe: Recipe) -> dict[str, Any]:
    report = pipeline.check(recipe).report
    found: dict[str, Any] = json.loads(as_json(report))["dynamics"]
    return found


def test_what_a_recipe_says_of_its_train() -> None:
    assert recipe().of(Dynamics) == Dynamics(0.4, 2e5, 600.0, 20.0, 150.0, 0.0, None)
    play = recipe(
        "units: inch\ndynamics: {mass: 1, stiffness: 1e6, backlash: 0.001, rpm: 60}\n",
        CAM.replace("rise: 20", "rise: 1"),
    )
    assert play.of(Dynamics) == Dynamics(1.0, 1e6, 60.0, 0.0, None, 0.0, pytest.approx(0.0254))
    assert recipe("").of(Dynamics) is None


def test_the_report_of_a_train_under_a_spring() -> None:
    outcome = pipeline.check(recipe(FOLLOWED))
    found = outcome.report["dynamics"]
    assert outcome.ok
    assert found["natural_ratio"] == pytest.approx(math.sqrt(0.5e6) / (20.0 * math.pi))
    assert found["damping_ratio"] == pytest.approx(20.0 / (2.0 * math.sqrt(0.8e5)))
    assert (found["unit"], found["force_unit"], found["rpm"]) == ("mm", "N", 600.0)
    intended, cut = found["runs"]
    assert intended["from"] == "intended"
    assert cut["from"] == "train.dxf"
    for key in ("peak_force", "least_force"):
        assert cut["steady"][key] == pytest.approx(intended["steady"][key], rel=1e-2)
        assert cut["steady"][key] != intended["steady"][key]
    assert [round(rest["dwell_from_deg"]) for rest in intended["steady"]["residual"]] == [120, 300]
    assert intended["steady"]["residual"][0]["amplitude"] == pytest.approx(0.1145, rel=1e-2)
    assert intended["float_rpm"] == pytest.approx(755.31, abs=0.01)
    assert intended["float_rigid_rpm"] == pytest.approx(1164.79, abs=0.01)
    assert intended["impacts"]["count"] == 0
    assert intended["transient"]["settled"]
    assert intended["transient"]["peak_force"] >= intended["steady"]["peak_force"] * (1 - 1e-9)
    checks = [check for check in outcome.report["checks"] if check["name"] == "float"]
    assert [check.get("file") for check in checks] == [None, "train.dxf"]
    assert checks[0]["value"] == intended["steady"]["least_force"]
    assert (checks[0]["limit"], checks[0]["unit"], checks[0]["sense"]) == (0.0, "N", "at_least")


def test_the_speed_at_which_a_rigid_follower_floats_lies_between_any_places() -> None:
    """Norton's modified sine by mpmath, (F + k s)/(m s'') over 110 degrees to 20 digits."""
    disc = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 9}
  motion:
    - {rise: 18, over: 110, law: modified-sine}
    - {dwell: 40}
    - {return: 18, over: 130, law: modified-sine}
    - {dwell: 80}
export: {files: [csv]}
"""
    train = "dynamics: {mass: 0.8, stiffness: 3e5, damping: 60, preload: 900, rate: 4000, rpm: 420}\n"
    (run,) = section(recipe(train, disc))["runs"]
    assert run["float_rigid_rpm"] == pytest.approx(2024.3360245290977644, rel=2e-15)


@pytest.mark.slow
def test_lengths_in_inches() -> None:
    def residual(text: str) -> float:
        value: float = section(recipe(TRAIN, text))["runs"][0]["steady"]["residual"][0]["amplitude"]
        return value

    inches = CAM.replace("base_radius: 40", "base_radius: 40/25.4").replace("rise: 20,", "rise: 20/25.4,")
    inches = inches.replace("40/25.4", repr(40 / 25.4)).replace("20/25.4", repr(20 / 25.4)) + "units: inch\n"
    assert residual(inches) == pytest.approx(residual(CAM) / 25.4, rel=1e-6)


@pytest.mark.slow
def test_beyond_the_speed_at_which_float_begins_the_check_fails() -> None:
    fast = recipe(FOLLOWED.replace("600", "900"))
    outcome = pipeline.check(fast)
    assert not outcome.ok
    failed = {(check["name"], check.get("file")) for check in outcome.report["checks"] if not check["ok"]}
    assert failed == {("float", None), ("float", "train.dxf")}
    (intended,) = (check for check in outcome.report["checks"] if check["name"] == "float" and "file" not in check)
    assert re.match(r"float begins at 755\.3\d* rpm of the shaft, and 900 are asked for; greatest ", intended["detail"])
    run = outcome.report["dynamics"]["runs"][0]
    assert not run["steady"]["holds"]
    assert run["transient"]["least_force"] == 0.0
    assert run["impacts"]["count"] > 0
    assert run["impacts"]["greatest_velocity"] > 0.0
    assert run["impacts"]["free_deg"] > 0.0


def test_play_makes_impacts() -> None:
    outcome = pipeline.check(recipe(FOLLOWED.replace("preload: 150", "backlash: 0.02")))
    assert outcome.ok
    intended, cut = outcome.report["dynamics"]["runs"]
    assert intended["impacts"]["count"] == 10
    assert intended["impacts"]["settled"]
    assert cut["impacts"]["greatest_velocity"] == pytest.approx(intended["impacts"]["greatest_velocity"], rel=0.05)
    assert "steady" not in intended
    play = [check for check in outcome.report["checks"] if check["name"] == "least-backlash"]
    assert play[0]["value"] == pytest.approx(0.02, abs=1e-9)
    assert 0.018 <= play[1]["value"] <= 0.02


@pytest.mark.slow
def test_turns_that_do_not_settle_are_told_by_their_range() -> None:
    cam = (
        "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}\n"
    )
    train = "dynamics: {mass: 0.4, damping: 25, stiffness: 6.0e+6, backlash: 0.05, rpm: 300, transient: true}\n"
    impacts = pipeline.check(recipe(train, cam)).report["dynamics"]["runs"][0]["impacts"]
    assert not impacts["settled"]
    found = impacts["of_turns"]
    assert found["turns"] == 10
    for key in ("count", "greatest_velocity", "peak_force"):
        least, most = found[key]
        assert 0 < least <= impacts[key] <= most
    assert found["peak_force"][1] > 1.01 * found["peak_force"][0]


def test_play_that_the_file_takes_up_fails() -> None:
    tight = TRAIN.replace("preload: 150", "backlash: 0.000001")
    outcome = pipeline.check(recipe(tight))
    failed = [check for check in outcome.report["checks"] if not check["ok"]]
    assert [(check["name"], check["file"]) for check in failed] == [("least-backlash", "train.dxf")]
    assert failed[0]["value"] < 0.0


@pytest.mark.slow
def test_a_dwell_that_ends_with_the_turn_ends_at_360() -> None:
    rests = section(recipe())["runs"][0]["steady"]["residual"]
    assert [(rest["dwell_from_deg"], rest["dwell_to_deg"]) for rest in rests] == [(120.0, 180.0), (300.0, 360.0)]


@pytest.mark.slow
def test_in_flight_nothing_is_said_of_how_fast_a_free_motion_dies_away() -> None:
    holds, flies = (section(recipe(FOLLOWED.replace("600", rpm)))["runs"][0] for rpm in ("600", "900"))
    assert holds["transient"]["turns_to_one_percent"] > 0.0
    assert flies["impacts"]["free_deg"] > 0.0
    assert "turns_to_one_percent" not in flies["transient"]


@pytest.mark.thin(2)
@pytest.mark.parametrize(("play", "faces"), [("0.02", ["lower", "upper"]), ("50", [])])
def test_which_faces_bear(play: str, faces: list[str]) -> None:
    report = pipeline.check(recipe(FOLLOWED.replace("preload: 150", f"backlash: {play}"))).report
    assert report["dynamics"]["runs"][0]["impacts"]["faces"] == faces
    check = next(check for check in report["checks"] if check["name"] == "least-backlash")
    assert ("touches neither face" in check.get("detail", "")) == (not faces)


@pytest.mark.slow
def test_a_course_that_cannot_be_followed_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    from kin.dynamics import events, impacts

    class Little(events.Work):
        def __init__(self, most: int) -> None:
            super().__init__(min(most, 1000))

    monkeypatch.setattr(impacts, "Work", Little)
    run = section(recipe(FOLLOWED))["runs"][0]
    assert run["steady"]["holds"]
    assert (run["transient"], run["impacts"]) == (None, None)
    assert "degrees of turn 1 and no further" in run["transient_why"]
    with pytest.raises(RecipeErrors, match=r"dynamics: followed from rest to .* degrees of turn 1 and no further"):
        pipeline.check(recipe(FOLLOWED.replace("preload: 150", "backlash: 0.02")))


@pytest.mark.slow
@pytest.mark.parametrize("held", ["preload: 150", "backlash: 0.02"])
def test_nothing_is_followed_that_was_not_asked_for(held: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from kin.dynamics import impacts

    followed = pipeline.check(recipe(FOLLOWED.replace("preload: 150", held))).report
    monkeypatch.delattr(impacts, "course")
    plain = pipeline.check(recipe(TRAIN.replace("preload: 150", held))).report
    assert plain["checks"] == followed["checks"]
    for before, after in zip(plain["dynamics"]["runs"], followed["dynamics"]["runs"], strict=True):
        assert before == {key: value for key, value in after.items() if key not in {"transient", "impacts"}}
        assert (after["transient"]["turns"], after["transient"]["turns_most"]) > (1, 19)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", ["2.0e5", "1.0e12"])
def test_all_runs_together_look_at_a_bounded_number_of_places(stiffness: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from camgeo.capabilities.dynamics import elastic as dynamics
    from kin.dynamics import impacts

    monkeypatch.setattr(dynamics, "MOST_PLACES", 300_000)
    places = []

    def counted(*given: Any, **named: Any) -> impacts.Course:
        course = real(*given, **named)
        places.append(course.places)
        return course

    real = impacts.course
    monkeypatch.setattr(impacts, "course", counted)
    train = FOLLOWED.replace("2.0e5", stiffness).replace("preload: 150", "backlash: 0.02").replace("damping: 20, ", "")
    with suppress(RecipeErrors):
        for run in section(recipe(train))["runs"]:
            reached = 0 if run["transient"] is None else run["transient"]["turns"]
            assert reached == 20 or f"of turn {reached + 1} and no further" in run["transient_why"]
    assert sum(places) < 1.1 * 300_000


@pytest.mark.slow
@pytest.mark.parametrize("held", ["preload: 8", "backlash: 0.02"])
def test_a_follower_that_swings_has_figures_of_turning(held: str) -> None:
    train = f"dynamics: {{mass: 2.0e-3, damping: 5, stiffness: 3.0e4, {held}, rpm: 400}}\n"
    outcome = pipeline.check(recipe(train, PAIR))
    assert outcome.ok
    found = outcome.report["dynamics"]
    assert (found["unit"], found["force_unit"]) == ("deg", "N m")
    if "backlash" in held:
        play = next(check for check in outcome.report["checks"] if check["name"] == "least-backlash")
        assert play["value"] == pytest.approx(math.degrees(0.02 / 30.0), rel=1e-6)
        assert play["unit"] == "deg"


@pytest.mark.slow
def test_the_springs_force_is_given_at_the_lowest_place() -> None:
    slow = TRAIN.replace("600", "0.01")
    stiff = slow.replace("preload: 150", "preload: 150, rate: 1000")
    run = section(recipe(stiff))["runs"][0]["steady"]
    share = 2e5 / (2e5 + 1000.0)
    assert run["least_force"] == pytest.approx(150.0 * share, rel=1e-6)
    assert run["peak_force"] == pytest.approx((150.0 + 1000.0 * 0.02) * share, rel=1e-6)


@pytest.mark.slow
def test_swings_without_number_are_refused_with_the_damping_that_helps() -> None:
    stiff = TRAIN.replace("damping: 20, ", "").replace("2.0e5", "8.0e11").replace("rpm: 600", "rpm: 5.03")
    with pytest.raises(RecipeErrors, match="the swings of a turn are too many") as refused:
        pipeline.check(recipe(stiff))
    damping = str(refused.value).partition("a damping of ")[2].split()[0]
    runs = pipeline.check(recipe(stiff.replace("mass:", f"damping: {damping}, mass:"))).report["dynamics"]["runs"]
    assert all(run["steady"]["least_force"] is not None for run in runs)


def test_a_linkage_is_driven_as_intended() -> None:
    four_bar = """\
name: linkage
cam: {kind: support, p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25, shaft: [18, 8.5]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
verify: {angles: 120}
"""
    train = "dynamics: {mass: 2.0e-3, damping: 0.5, stiffness: 3.0e4, preload: 8, rpm: 300}\n"
    asked = recipe(train, four_bar)
    outcome = pipeline.check(asked)
    assert [run["from"] for run in outcome.report["dynamics"]["runs"]] == ["intended"]
    assert outcome.report["dynamics"]["force_unit"] == "N m"
    with pytest.raises(RecipeErrors, match=r"dynamics\.backlash: backlash at the cam under a linkage"):
        recipe(train.replace("preload: 8", "backlash: 0.1"), four_bar)


@pytest.mark.thin(3)
@pytest.mark.parametrize("train", [TRAIN, TRAIN.replace("preload: 150", "backlash: 0.02"), ""])
def test_the_checks_are_foreseen(train: str) -> None:
    asked = recipe(train)
    made = [(check["name"], check.get("file")) for check in pipeline.check(asked).report["checks"]]
    assert sorted(map(str, map(tuple, foreseen(asked)))) == sorted(map(str, made))


@pytest.mark.slow
def test_what_is_not_asked_for_is_skipped() -> None:
    report = pipeline.check(recipe("")).report
    assert "dynamics" not in report
    assert {"what": "dynamics", "why": "dynamics is not given"} in report["skipped"]
    assert "dynamics" in {stage["name"] for stage in pipeline.check(recipe()).report["stages"]}


@pytest.mark.parametrize(
    ("train", "cam", "message"),
    [
        (
            TRAIN.replace("damping: 20", "damping: 0").replace("2.0e5", repr(0.4 * (6 * 20 * math.pi) ** 2)),
            CAM,
            "no steady",
        ),
        (
            TRAIN.replace("preload: 150", "backlash: 0.02"),
            "cam: {kind: support, p: 25 + 2*cos(2*t)}\n",
            "a single translating flat face has no backlash",
        ),
        (
            TRAIN.replace("preload: 150", "backlash: 0.02"),
            "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, motion: {formula: 5*sin(t)**2}}\n",
            "a single translating roller has no backlash",
        ),
    ],
)
def test_what_has_no_dynamics_is_refused_at_its_field(train: str, cam: str, message: str) -> None:
    with pytest.raises(RecipeErrors, match=message) as caught:
        pipeline.check(recipe(train, cam))
    (error,) = caught.value.errors
    assert error.path.startswith("dynamics")
    assert error.line > 1


ROUND = "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, motion: {formula: 5*sin(t)**2}}\n"
STIFF = "dynamics: {mass: 1.0e-30, stiffness: 1.0e5, preload: 1, rpm: 300}\n"
SOFT = "dynamics: {mass: 1, stiffness: 1.0e-30, preload: 1, rpm: 300}\n"
SLOW = "dynamics: {mass: 1, stiffness: 1.0e5, damping: 2, preload: 1, rpm: 1.0e-30}\n"
HIGH = "rounding does not tell it from a whole multiple"
LOW = "nothing holds the follower to the cam"


@pytest.mark.thin(6)
@pytest.mark.parametrize(
    ("train", "message", "change"),
    [
        (STIFF, f"1.00658424e+16 times the shaft's, and {HIGH}", ("stiffness: 1.0e5, ", "")),
        (STIFF.replace("preload: 1,", "preload: 1.0e-30,"), HIGH, ("stiffness: 1.0e5, ", "")),
        (SLOW, HIGH, ("stiffness: 1.0e5, damping: 2, ", "")),
        (SLOW, HIGH, ("rpm: 1.0e-30", "rpm: 300")),
        (SOFT, f"3.18309886e-17 times the shaft's, so that {LOW}", ("1.0e-30", "{}")),
        (SOFT.replace("mass: 1", "mass: 7"), LOW, ("1.0e-30", "{}")),
    ],
)
def test_a_train_at_the_edge_of_arithmetic_gets_its_reason(train: str, message: str, change: tuple[str, str]) -> None:
    """No resonance is blamed where none is; what the message says to do lets the train be found."""
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(train, ROUND))
    said = str(caught.value)
    assert message in said
    before, after = change
    if after == "{}":
        after = said.rpartition("give a stiffness above ")[2]
    report = pipeline.check(recipe(train.replace(before, after), ROUND)).report
    assert {"dynamics", "forces"} & report.keys()


@pytest.mark.parametrize("stiffness", ["2.0e5", "2.1e5", "2.2e5", "2.3e5"])
def test_too_much_damping_is_told_with_what_will_do(stiffness: str) -> None:
    train = TRAIN.replace("2.0e5", stiffness)
    with pytest.raises(RecipeErrors, match="times critical; give less than") as caught:
        recipe(train.replace("damping: 20", "damping: 50000"))
    (error,) = caught.value.errors
    most = float(str(error).rsplit("less than ", 1)[1])
    recipe(train.replace("damping: 20", f"damping: {most * (1.0 - 1e-8)!r}"))
    assert most == pytest.approx(20.0 * math.sqrt(0.4 * float(stiffness)), rel=1e-5)


@pytest.mark.slow
def test_a_spoilt_file_shows_in_its_own_run(tmp_path: Path) -> None:
    """A corner that stands out by 0.03 mm shortly before the dwell: the train of the file rings on, the other not."""
    import ezdxf

    asked = recipe(TRAIN.replace("rpm: 600", "rpm: 200"))
    folder = pipeline.export(asked, tmp_path).folder
    assert folder is not None
    path = folder / "train.dxf"
    drawing = ezdxf.readfile(path)
    (outline,) = (e for e in drawing.modelspace().query("LWPOLYLINE") if len(e) > 20)
    points = np.array([tuple(point) for point in outline.get_points("xyb")])
    angle = np.degrees(np.arctan2(points[:, 1], points[:, 0])) % 360.0
    points[np.argmin(np.abs(angle - 112.0)), :2] *= 1.0005
    outline.set_points(points.tolist(), format="xyb")
    spoilt = tmp_path / "spoilt.dxf"
    drawing.saveas(spoilt)
    whole, bent = (pipeline.judge_files(asked, [file])["dynamics"]["runs"][1] for file in (path, spoilt))
    amplitudes = [run["steady"]["residual"][0]["amplitude"] for run in (whole, bent)]
    assert bent["from"] == "spoilt.dxf"
    assert amplitudes[1] > 3.0 * amplitudes[0]


@pytest.mark.slow
def test_two_rollers_rattle_as_two_faces_of_the_same_motion_do() -> None:
    train = FOLLOWED.replace("preload: 150", "backlash: 0.05")
    motion = "motion: [{rise: 12, over: 80, law: modified-sine}, {dwell: 100}]}\n"
    found = []
    for cam in ("constant-breadth, base_radius: 28", "constant-diameter, base_radius: 28, roller_radius: 8"):
        report = pipeline.check(recipe(train, f"cam: {{kind: {cam}, {motion}")).report
        runs = report["dynamics"]["runs"]
        checks = {one.get("file"): one["value"] for one in report["checks"] if one["name"] == "least-backlash"}
        found.append((runs[0]["impacts"], checks))
    (faces, of_faces), (rollers, of_rollers) = found
    assert rollers["count"] == faces["count"] > 0
    assert rollers["greatest_velocity"] == pytest.approx(faces["greatest_velocity"], rel=1e-9)
    assert of_rollers[None] == pytest.approx(of_faces[None], abs=1e-12) == pytest.approx(0.05, abs=1e-9)
    (of_file,) = (value for file, value in of_rollers.items() if file)
    assert 0.05 - 2e-3 < of_file < 0.05 + 2e-3  # its own tolerance on either side
