"""Lifts of an indicator whose zero of the angle is anywhere, in degrees of the crank, or radians."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from support.measured import disc, surfaces

import camgeo
from camgeo.cli.main import main
from camgeo.common.errors import CallError

ROLLER = disc("kind: roller, radius: 10, offset: 6")
ARM = disc(
    "kind: roller, radius: 10, arm: {length: 65, pivot: 80}",
    "[{rise: 12, over: 120, law: cycloidal}, {return: 12, over: 240, law: cycloidal}]",
)
LIMIT = "\nmade: {profile: 0.02}"


def lifts(folder, text, late=0.0, *, heading="angle_deg,lift_mm", angles=(1.0,), lift=1.0, turns=1):
    """A recipe and the lifts of its cam, late by degrees, with a fault of 5 um; angles and lifts are multiplied."""
    recipe, file = folder / "part.yaml", folder / "lift.csv"
    recipe.write_text(text, "utf-8")
    ((_, _, surface),) = surfaces(text)
    shaft = np.arange(0.0, 360.0 * turns, 0.5)
    at = np.radians(shaft - late)
    fault = 0.005 * np.exp(-0.5 * (np.degrees(np.mod(at, 2.0 * np.pi) - 2.0) / 6.0) ** 2) * (surface.gauge.unit == "mm")
    rows = zip(angles[0] * shaft, lift * (surface.gauge.intended(at) + fault + 2.0), strict=True)
    file.write_text("\n".join([heading, *(f"{a:.6f},{s:.8f}" for a, s in rows)]), "utf-8")
    return recipe, file


@pytest.mark.slow
@pytest.mark.parametrize("late", [12.3, -90.0, 180.0, 154.3])
def test_lifts_from_any_zero_are_told_and_judged(late, tmp_path, capsys):
    recipe, file = lifts(tmp_path, ROLLER + LIMIT, late)
    assert main(["verify", str(recipe), str(file)]) == 2
    told = re.search(r"they look turned by (\S+) degrees: `--align rotation`\n", capsys.readouterr().err)
    assert told is not None
    assert math.remainder(float(told[1]) - late, 360.0) == pytest.approx(0.0, abs=0.6)
    made = camgeo.verify(recipe, file, align="rotation")["made"]
    assert math.remainder(made["lifts"]["turned_deg"] - late, 360.0) == pytest.approx(0.0, abs=0.01)
    assert made["motion"]["error"]["max"] == pytest.approx(0.005, abs=4e-4)
    assert made["verdicts"] == {"made-profile": "ok"}


@pytest.mark.slow
@pytest.mark.parametrize("late", [0.1, 1.5, -3.0])
def test_lifts_that_are_a_little_late_show_their_phase(late, tmp_path):
    """As they stand the motion is that of the turned cam, by contact: a phase and the fault, and nothing else."""
    recipe, file = lifts(tmp_path, ROLLER, late)
    made = camgeo.verify(recipe, file)["made"]
    assert made["motion"]["phase_deg"] == pytest.approx(late, abs=0.005)
    assert made["motion"]["without_phase"] == pytest.approx(0.005, abs=4e-4)
    assert made["lifts"]["turned_deg"] == 0.0
    looks = [text for text in made["remarks"] if "look turned" in text]
    assert looks == ([] if late == 0.1 else [f"the lifts look turned by {late:.3g} degrees: `--align rotation`"])


@pytest.mark.slow
def test_the_sense_of_lifts_is_told_with_their_turn(tmp_path, capsys):
    recipe, file = lifts(tmp_path, ROLLER, 200.0, angles=(-1.0,))
    assert main(["verify", str(recipe), str(file), "--align", "rotation"]) == 2
    assert "run in the other sense, turned by -160 degrees: let angles grow as the shaft" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("heading", ["crank_deg,lift_mm", "Crank angle [deg],lift_mm", "angle (deg) CA,lift_mm"])
def test_crank_degrees_of_a_heading_are_halved(heading, tmp_path):
    recipe, file = lifts(tmp_path, ROLLER, heading=heading, angles=(2.0,))
    made = camgeo.verify(recipe, file)["made"]
    assert made["motion"]["error"]["max"] == pytest.approx(0.005, abs=4e-4)
    assert abs(made["motion"]["phase_deg"]) < 0.005


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wrong", "factor", "right"),
    [
        ("angle_deg", 2.0, "crank_deg"),  # nothing says that these are the crank's
        ("crank_deg", 1.0, "cam_deg"),
    ],
)
def test_angles_of_the_other_shaft_are_told_and_the_remedy_helps(wrong, factor, right, tmp_path, capsys):
    recipe, file = lifts(tmp_path, ROLLER, heading=f"{wrong},lift_mm", angles=(factor,))
    assert main(["verify", str(recipe), str(file)]) == 2
    assert f"head their column {right}\n" in capsys.readouterr().err
    file.write_text(file.read_text("utf-8").replace(wrong, right), "utf-8")
    assert abs(camgeo.verify(recipe, file)["made"]["motion"]["phase_deg"]) < 0.005


@pytest.mark.slow
def test_two_turns_are_repeats(tmp_path):
    recipe, file = lifts(tmp_path, ROLLER, turns=2)
    made = camgeo.verify(recipe, file)["made"]
    assert any("1440 points are 720 places" in text for text in made["remarks"])


def test_radii_over_crank_degrees_are_refused(tmp_path, capsys):
    recipe, file = lifts(tmp_path, ROLLER, heading="crank_deg,radius_mm")
    assert main(["verify", str(recipe), str(file)]) == 2
    assert "crank degrees, crank_deg; a polar angle is the part's own: head it polar_deg" in capsys.readouterr().err


@pytest.mark.slow
def test_swings_in_radians(tmp_path, capsys):
    recipe, file = lifts(tmp_path, ARM, heading="angle_deg,lift_rad")
    assert abs(camgeo.verify(recipe, file)["made"]["motion"]["error"]["max"]) < 1e-5
    file.write_text(file.read_text("utf-8").replace("lift_rad", "lift"), "utf-8")
    assert main(["verify", str(recipe), str(file)]) == 2
    assert "they look like radians read as degrees: head their column lift_rad" in capsys.readouterr().err


@pytest.mark.slow
def test_lifts_of_another_cam(tmp_path):
    recipe, file = lifts(tmp_path, ROLLER)
    recipe.write_text(
        disc(
            "kind: roller, radius: 10",
            "[{rise: 8, over: 30, law: cycloidal}, {dwell: 10}, {return: 8, over: 30, law: cycloidal}, {dwell: 290}]",
        ),
        "utf-8",
    )
    with pytest.raises(CallError, match=r"however they are turned: they look like those of another cam"):
        camgeo.verify(recipe, file)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"lift": -1.0}, "to fall as the follower rises: turn their sign round"),
        ({"angles": (math.pi / 180.0,)}, "to have angles in radians: head their column angle_rad"),
        ({"lift": 1.0 / 25.4, "heading": "angle_deg,lift"}, "25.4 times too small: `--units inch`"),
    ],
)
def test_what_lifts_look_like(change, told, tmp_path, capsys):
    recipe, file = lifts(tmp_path, ROLLER, **change)
    assert main(["verify", str(recipe), str(file)]) == 2
    assert f"they look {told}\n" in capsys.readouterr().err


def test_columns_by_their_first_words(tmp_path, capsys):
    """`X pos` is x; of two that may be, the one whose name is known counts, and else none is guessed."""
    recipe, file = tmp_path / "part.yaml", tmp_path / "points.csv"
    recipe.write_text(ROLLER, "utf-8")
    ((_, _, surface),) = surfaces(ROLLER)
    places = surface.gauge.envelope.points(np.radians(np.arange(0.0, 360.0, 5.0)))
    rows = [f"{x + 9:.7f},{y:.7f},{x:.7f},{y:.7f}" for x, y in places]
    for heading, code in (
        ("X nom [mm],Y nom [mm],X act [mm],Y act [mm]", 0),
        ("X nom [mm],Y nom [mm],x_mm,y_mm", 0),
        ("other,more,X pos [mm],Y pos [mm]", 0),
        ("X set [mm],Y set [mm],X found [mm],Y found [mm]", 2),
    ):
        file.write_text("\n".join([heading, *rows]), "utf-8")
        assert main(["verify", str(recipe), str(file)]) == code
    assert (
        "columns X set [mm] and X found [mm] may both be x; head those that were measured x" in capsys.readouterr().err
    )
