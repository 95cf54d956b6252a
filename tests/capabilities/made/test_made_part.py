"""Measured points held against recipes: planted faults of every kind of follower, placings, verdicts, bad input.

Holds: camgeo.capabilities.made, camgeo.capabilities.made.checks, camgeo.capabilities.made.recipe,
camgeo.capabilities.made.output, camgeo.capabilities.made.cli, camgeo.capabilities.made.measures,
camgeo.capabilities.made.section, camgeo.capabilities.made.verify.
"""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
from support.measured import RECIPES, bump, disc, measured, points, surfaces, table, turned

import camgeo
from camgeo.cli.main import main

ROLLER = RECIPES["roller on a stem"]
LIMITS = "\nmade: {profile: 0.04, datum: part}"


def limited(text, profile=0.04, motion=0.02, datum="part"):
    text = text.replace("verify: {angles: 360}", f"verify: {{angles: 360, motion_error: {motion}}}")
    return f"{text}\nmade: {{profile: {profile}, datum: {datum}}}\n"


@pytest.mark.thin(8)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_a_clean_part_moves_as_meant(kind, tmp_path):
    recipe, files = measured(tmp_path, RECIPES[kind], noise=0.001)
    found = camgeo.verify(recipe, *files)
    assert found["ok"]
    made = found["made"]
    error = made["motion"]["error"]
    assert abs(error["max"]) < 3.0 * error["uncertainty"]
    assert error["uncertainty"] < 0.002
    for one in made["surfaces"]:
        scale = 1.0 if found["units"] == "mm" else 25.4
        assert scale * one["noise"] == pytest.approx(0.001, rel=0.1)
        assert one["outlier_count"] == 0


@pytest.mark.thin(16)
@pytest.mark.parametrize("kind", list(RECIPES))
def test_a_planted_fault_is_found_where_it_is(kind, tmp_path):
    """By far above its uncertainty, at the place of contact; on one of two contacts it moves the follower by half."""
    recipe, files = measured(tmp_path, RECIPES[kind], bump(0.02), noise=0.001)
    made = camgeo.verify(recipe, *files)["made"]
    error = made["motion"]["error"]
    assert abs(error["max"]) > 10.0 * error["uncertainty"]
    assert made["discs"][0]["greatest"] > 0.0
    (_, _, surface), *_ = surfaces(RECIPES[kind])
    frame = surface.gauge.envelope.frames(np.radians([50.0]))
    touched = [float(np.degrees(angle[0])) for angle, _ in surface.gauge.touching(frame.points, frame.normals)]
    assert min(abs(math.remainder(error["at_deg"] - at, 360.0)) for at in touched) < 2.0
    if "play" in made:
        assert made["play"]["least"] < -5.0 * made["play"]["uncertainty"]
    if "output" in made:
        assert made["output"]["max"] > 10.0 * made["output"]["uncertainty"]


def test_a_cam_too_large_all_round_is_told_so(tmp_path):
    """Chords are not the metal: points every two degrees of a cam 4 um too large are 4 um too large."""
    recipe, files = measured(tmp_path, ROLLER, lambda t: np.full_like(t, 0.004), count=180)
    made = camgeo.verify(recipe, *files)["made"]
    assert made["discs"][0]["profile"] == pytest.approx(0.008, abs=1e-6)
    assert made["motion"]["offset"] == pytest.approx(0.0041, abs=2e-4)


@pytest.mark.slow
def test_verdicts_count_the_uncertainty_in(tmp_path):
    """Of a zone of 0.04 a deviation of 0.018 is ok with 0.001, not proved with 0.003, and 0.024 fails with it."""
    for height, error, ok, word in (
        (0.018, "0.001", True, "ok"),
        (0.018, "0.003", False, "not proved"),
        (0.024, "0.003", False, "failed"),
    ):
        recipe, files = measured(tmp_path, limited(ROLLER, motion=0.05), bump(height))
        found = camgeo.verify(recipe, *files, probe_error=error)
        assert found["ok"] is ok
        assert found["made"]["verdicts"]["made-profile"] == word
    check = next(check for check in found["checks"] if check["name"] == "made-profile")
    assert check["value"] == pytest.approx(0.048, abs=1e-4)
    assert check["limit"] == 0.04
    assert check["at_deg"] == pytest.approx(50.0, abs=0.5)


def test_the_motion_is_judged_by_its_own_limit(tmp_path):
    recipe, files = measured(tmp_path, limited(ROLLER, profile=1.0, motion=0.01), bump(0.02), noise=0.001)
    found = camgeo.verify(recipe, *files)
    assert found["made"]["verdicts"] == {"made-profile": "ok", "made-motion": "failed"}
    recipe, files = measured(tmp_path, limited(ROLLER, profile=1.0, motion=0.04), bump(0.02), noise=0.001)
    assert camgeo.verify(recipe, *files)["ok"]


@pytest.mark.slow
def test_a_datum_leaves_the_profile_to_turn_and_the_motion_where_it_is(tmp_path):
    text = limited(ROLLER, motion=1.0, datum="bore")
    recipe, (file,) = measured(tmp_path, text)
    ((_, part, surface),) = surfaces(text)
    file.write_text(table(turned(points(part, surface), 0.2)))
    made = camgeo.verify(recipe, file)["made"]
    told = made["discs"][0]
    assert told["profile"] < 1e-5
    assert told["turned_deg"] == pytest.approx(0.2, abs=1e-4)
    assert made["motion"]["phase_deg"] == pytest.approx(0.2, rel=0.02)
    assert abs(made["motion"]["error"]["max"]) > 0.01
    aligned = camgeo.verify(recipe, file, align="rotation")["made"]
    assert abs(aligned["motion"]["error"]["max"]) < 1e-5
    assert any("shows no phase" in text for text in aligned["remarks"])


@pytest.mark.slow
def test_the_default_datum_is_what_the_bore_fixes(tmp_path):
    for part, datum in (("bore: 12", "bore"), ("bore: 12, keyway: din6885", "part"), ("wall: 1", "none")):
        recipe, files = measured(tmp_path, ROLLER.replace("bore: 12", part))
        assert camgeo.verify(recipe, *files)["made"]["discs"][0]["datum"] == datum


def test_an_outlier_is_named_counted_and_left_out_of_the_motion(tmp_path):
    recipe, (file,) = measured(tmp_path, limited(ROLLER), noise=0.001)
    rows = file.read_text().splitlines()
    x, y = (float(cell) for cell in rows[101].split(","))
    rows[101] = f"{x * 1.002:.7f},{y * 1.002:.7f}"
    file.write_text("\n".join(rows))
    found = camgeo.verify(recipe, file, probe_error=0.001)
    assert found["made"]["verdicts"]["made-profile"] == "failed"
    assert found["made"]["discs"][0]["line"] == 102
    one = found["made"]["surfaces"][0]
    assert [each["line"] for each in one["outliers"]] == [102]
    assert abs(found["made"]["motion"]["error"]["max"]) < 0.002


@pytest.mark.costly("places of 360 lifts on the metal")
def test_lifts_of_an_indicator(tmp_path):
    """Its zero is free; a roller of another radius is told by --probe-radius."""
    recipe, _ = measured(tmp_path, limited(ROLLER, profile=1.0, motion=1.0))
    ((_, _, surface),) = surfaces(ROLLER)
    shaft = np.radians(np.arange(0.0, 360.0, 1.0))
    fault = 0.02 * np.exp(-0.5 * ((shaft - np.radians(50.0)) / np.radians(6.0)) ** 2)
    file = tmp_path / "lift.csv"

    def write(lift, angle=shaft):
        rows = [f"{math.degrees(a):.4f};{s:.6f}".replace(".", ",") for a, s in zip(angle, lift, strict=True)]
        file.write_text("\n".join(["Angle [deg];Lift [mm]", *rows]))

    write(surface.gauge.intended(shaft) - 30.0 + fault)
    made = camgeo.verify(recipe, file)["made"]
    mean = fault.mean()
    assert made["lifts"]["zero"] == pytest.approx(-30.0 + mean, abs=1e-5)
    assert made["motion"]["error"]["max"] == pytest.approx(0.02 - mean, abs=2e-4)
    write(surface.gauge.intended(shaft + np.radians(12.3)) - 30.0)
    with pytest.raises(camgeo.CallError, match=r"turned by -12\.3 degrees: `--align rotation`"):
        camgeo.verify(recipe, file)
    made = camgeo.verify(recipe, file, align="rotation")["made"]
    assert made["lifts"]["turned_deg"] == pytest.approx(-12.3, abs=1e-4)
    assert abs(made["motion"]["error"]["max"]) < 1e-4
    write(surface.gauge.intended(-shaft))
    with pytest.raises(camgeo.CallError, match="run in the other sense"):
        camgeo.verify(recipe, file)


def test_centres_of_a_ball_and_their_normals(tmp_path):
    recipe, (file,) = measured(tmp_path, limited(ROLLER, motion=1.0))
    ((_, _, surface),) = surfaces(ROLLER)
    t = np.radians(np.arange(0.0, 360.0, 0.5))
    frame = surface.gauge.envelope.frames(t)
    metal = frame.points + 0.01 * np.cos(4 * t)[:, None] * frame.normals
    centres = metal + 2.0 * frame.normals
    file.write_text(table(centres))
    told = camgeo.verify(recipe, file, probe_radius=2)["made"]["discs"][0]
    assert told["profile"] == pytest.approx(0.02, abs=1e-5)
    rows = [f"{x:.7f} {y:.7f} 5.0 {i:.7f} {j:.7f} 0" for (x, y), (i, j) in zip(centres, frame.normals, strict=True)]
    file.write_text("\n".join(rows))
    told = camgeo.verify(recipe, file, probe_radius=2)["made"]["discs"][0]
    assert told["profile"] == pytest.approx(0.02, abs=1e-5)


def test_repeats_are_averaged_and_their_spread_is_told(tmp_path):
    recipe, (file,) = measured(tmp_path, limited(ROLLER))
    ((_, part, surface),) = surfaces(ROLLER)
    draw = np.random.default_rng(4)
    exact = points(part, surface)
    normal = surface.gauge.envelope.frames(np.arange(720) * np.pi / 360).normals
    turns = [exact + 0.002 * draw.normal(size=720)[:, None] * normal for _ in range(4)]
    file.write_text(table(np.concatenate(turns)))
    made = camgeo.verify(recipe, file)["made"]
    one = made["surfaces"][0]
    assert (one["points"], one["places"]) == (2880, 720)
    assert one["noise"] == pytest.approx(0.001, rel=0.1)
    assert any("2880 points are 720 places, measured again within 0.002" in text for text in made["remarks"])


BAD = {
    "turned": (lambda q: turned(q, 12.3), r"turned by 12\.3 degrees: `--align rotation`"),
    "turned half round": (lambda q: turned(q, 180.0), "turned by (-)?180 degrees: `--align rotation`"),
    "mirrored": (lambda q: q * [1.0, -1.0], "they look mirrored"),
    "inches": (lambda q: q / 25.4, "25.4 times too small: `--units inch`"),
    "shifted": (lambda q: q + np.array([3.0, 1.0]), "`--align best-fit`"),
    "another cam": (
        lambda q: q * (1.0 + 0.2 * np.cos(3 * np.arctan2(q[:, 1], q[:, 0])))[:, None],
        "those of another cam",
    ),
    "one place": (lambda q: 0.0 * q + 30.0, "measure all round the cam"),
    "half of it": (lambda q: q[: len(q) // 2], "seen from the shaft, no point lies from"),
    "centres of a ball": (lambda q: q * (1.0 + 3.0 / np.hypot(*q.T))[:, None], "`--probe-radius` of the ball"),
    "the bore": (lambda q: 6.0 * q / np.hypot(*q.T)[:, None], "the points lie on the bore"),
}


@pytest.mark.thin(10)
@pytest.mark.parametrize("wrong", list(BAD))
def test_points_that_are_not_of_this_cam_are_told_what_they_look_like(wrong, tmp_path, capsys):
    recipe, (file,) = measured(tmp_path, ROLLER)
    ((_, part, surface),) = surfaces(ROLLER)
    alter, words = BAD[wrong]
    file.write_text(table(alter(points(part, surface)), "x,y"))
    with pytest.raises(camgeo.CallError, match=words):
        camgeo.verify(recipe, file)
    assert main(["verify", str(recipe), str(file)]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert re.search(words, told)


@pytest.mark.slow
@pytest.mark.parametrize(
    "remedy", [("turned", "--align", "rotation"), ("inches", "--units", "inch"), ("shifted", "--align", "best-fit")]
)
def test_remedies_help(remedy, tmp_path):
    recipe, (file,) = measured(tmp_path, ROLLER)
    ((_, part, surface),) = surfaces(ROLLER)
    file.write_text(table(BAD[remedy[0]][0](points(part, surface)), "x,y"))
    assert main(["verify", str(recipe), str(file), *remedy[1:]]) == 0


OPTIONS = {
    "--align": ("sideways", "invalid choice"),
    "--probe-radius": ("-1", "a length such as"),
    "--probe-error": ("much", "a length such as"),
    "--axes-error": ("0.005", "a length and an angle"),
    "--spans": ("few", "a whole number from 12"),
}


@pytest.mark.parametrize("option", list(OPTIONS))
def test_options_that_make_no_sense(option, tmp_path, capsys):
    recipe, (file,) = measured(tmp_path, ROLLER)
    value, words = OPTIONS[option]
    if option == "--align":
        with pytest.raises(SystemExit, match="2"):
            main(["verify", str(recipe), str(file), f"{option}={value}"])
    else:
        assert main(["verify", str(recipe), str(file), f"{option}={value}"]) == 2
    assert words in capsys.readouterr().err


def test_other_files_and_tolerances_are_refused_beside_points(tmp_path, capsys):
    recipe, (file,) = measured(tmp_path, ROLLER)
    other = tmp_path / "other.dxf"
    other.write_text("0\nEOF\n")
    assert main(["verify", str(recipe), str(file), str(other)]) == 2
    assert "give it in a call of its own" in capsys.readouterr().err
    assert main(["verify", str(recipe), str(file), "--tolerance", "0.01"]) == 2
    assert "give made.profile" in capsys.readouterr().err


def test_metal_that_lacks_asks_for_a_smaller_cam(tmp_path, capsys):
    recipe, files = measured(tmp_path, limited(ROLLER), bump(-0.03))
    assert main(["verify", str(recipe), *map(str, files)]) == 1
    assert "good if reground smaller by" in capsys.readouterr().out
    cure = camgeo.verify(recipe, *files)["made"]["discs"][0]["reduction"]
    assert cure["size"] == pytest.approx(0.01, abs=1e-5)
    assert cure["offset"] == pytest.approx(-0.0102, abs=5e-4)
    assert 0.0 < cure["change"] < 0.002


def test_json_has_the_section(tmp_path, capsys):
    recipe, files = measured(tmp_path, ROLLER)
    assert main(["verify", str(recipe), *map(str, files), "--json"]) == 0
    made = json.loads(capsys.readouterr().out)["made"]
    assert made["discs"][0]["profile"] < 1e-6
    assert "no limit is given, so nothing fails: made.profile, verify.motion_error" in made["remarks"]


def test_a_mirrored_drawing_has_mirrored_points(tmp_path):
    text = f"rotation: ccw\n{ROLLER}"
    recipe, files = measured(tmp_path, text, bump(0.02))
    told = camgeo.verify(recipe, *files)["made"]["motion"]["error"]
    assert told["at_deg"] == pytest.approx(50.0, abs=1.0)


def test_the_grinders_table_stays_a_grinders(tmp_path, capsys):
    recipe = tmp_path / "part.yaml"
    recipe.write_text(ROLLER)
    file = tmp_path / "ground.csv"
    file.write_text("c_deg,x_mm\n0,1\n")
    assert main(["verify", str(recipe), str(file)]) == 1
    assert "readable" in capsys.readouterr().out
    assert main(["verify", str(recipe), str(file), "--as", "measured"]) == 2
    assert "a column y is missing in its heading c_deg, x_mm" in capsys.readouterr().err


def test_lifts_of_an_indicator_with_a_flat_face(tmp_path):
    """It stands on the support of the metal: waves are found where they are, a face too narrow is refused."""
    text = disc("kind: roller, radius: 10, offset: 6")
    recipe = tmp_path / "part.yaml"
    recipe.write_text(text, "utf-8")
    ((_, _, surface),) = surfaces(text)
    t = np.linspace(0.0, 2.0 * np.pi, 7_201)[:-1]
    frame = surface.gauge.envelope.frames(t)
    metal = frame.points + (0.01 * np.sin(3.0 * t))[:, None] * frame.normals
    angle = np.arange(360) * np.pi / 180.0
    lift = np.array([(metal @ [np.cos(a), np.sin(a)]).max() for a in angle])
    rows = "\n".join(f"{math.degrees(a):.4f},{s:.7f}" for a, s in zip(angle, lift, strict=True))
    (tmp_path / "lift.csv").write_text(f"angle_deg,lift_mm\n{rows}\n", "utf-8")
    made = camgeo.verify(recipe, tmp_path / "lift.csv", probe_face="60mm")["made"]
    assert abs(made["motion"]["error"]["max"]) == pytest.approx(0.0102, abs=3e-4)
    wave = next(cause for cause in made["discs"][0]["causes"] if cause["cause"] == "waves")
    assert wave["waves"] == 3
    assert wave["value"] == pytest.approx(0.01, abs=4e-4)
    with pytest.raises(camgeo.CallError, match=r"the contact would leave the probe's face, 5 mm wide: it goes 1"):
        camgeo.verify(recipe, tmp_path / "lift.csv", probe_face=5)
    with pytest.raises(camgeo.CallError, match="a probe has a face or a radius"):
        camgeo.verify(recipe, tmp_path / "lift.csv", probe_face=5, probe_radius=2)
    (tmp_path / "points.csv").write_text(table(frame.points[::20]), "utf-8")
    with pytest.raises(camgeo.CallError, match="a face is of an indicator, and these are places"):
        camgeo.verify(recipe, tmp_path / "points.csv", probe_face=5)


def test_points_in_tests_of_ones_own(tmp_path):
    from camgeo.testing import assert_verified

    recipe, (file,) = measured(tmp_path, limited(ROLLER), noise=0.001)
    report = assert_verified(recipe, file, probe_error=0.001)
    assert report["made"]["verdicts"] == {"made-profile": "ok", "made-motion": "ok"}
    recipe, (file,) = measured(tmp_path, limited(ROLLER), bump(0.05))
    with pytest.raises(AssertionError, match=r"made-profile: 0\.1 mm, at most 0\.04 mm"):
        assert_verified(recipe, file, probe_error=0.001)
    file.write_text("x,y\n1,2\n", "utf-8")
    with pytest.raises(camgeo.CallError, match="at least 36 are needed"):
        assert_verified(recipe, file)


def test_the_scatter_of_the_points_makes_the_offset_uncertain(tmp_path):
    """Under a flat face the offset is the mean deviation: of n even points sigma/sqrt(n), and an error of the probe."""
    recipe, files = measured(tmp_path, RECIPES["flat"], noise=0.002)
    made = camgeo.verify(recipe, *files)["made"]
    surface = made["surfaces"][0]
    scatter = 2.0 * surface["noise"] * surface["widened"] / math.sqrt(720)
    assert surface["noise"] == pytest.approx(0.002, rel=0.1)
    assert made["motion"]["offset_uncertainty"] == pytest.approx(scatter, rel=1e-3)
    probed = camgeo.verify(recipe, *files, probe_error=0.0003)["made"]
    assert probed["motion"]["offset_uncertainty"] == pytest.approx(math.hypot(scatter, 0.0003), rel=1e-3)


def test_a_shift_of_the_axes_moves_the_offset_by_its_mean_effect(tmp_path):
    """Over the turn of a flat face the normals of a shift cancel out: a shift of the axes moves no offset."""
    recipe, files = measured(tmp_path, RECIPES["flat"], noise=0.002)
    plain, shifted = (
        camgeo.verify(recipe, *files, **options)["made"]["motion"]["offset_uncertainty"]
        for options in ({}, {"axes_error": "0.05,0"})
    )
    assert shifted == pytest.approx(plain, rel=1e-3)


STRAY = 40.0  # mm off the contour, along its normal


def stray_points(text, lines):
    """Points (n, 2) of the only surface, those at some lines of their file strays."""
    ((_, part, surface),) = surfaces(text)

    def off(t):
        away = np.zeros_like(t)
        away[np.array(lines) - 2] = STRAY
        return away

    return points(part, surface, off, 0.001)


@pytest.mark.thin(6)
@pytest.mark.parametrize("datum", ["part", "bore", "none"])
@pytest.mark.parametrize("lines", [(102,), (12, 300, 301, 500), tuple(range(200, 212))])
def test_a_few_strays_are_judged_and_named(lines, datum, tmp_path):
    """The worst line is named; the others place the part as without it."""
    text = limited(ROLLER, datum=datum)
    recipe, (file,) = measured(tmp_path, text)
    file.write_text(table(stray_points(text, lines)))
    made = camgeo.verify(recipe, file)["made"]
    assert made["verdicts"]["made-profile"] == "failed"
    disc = made["discs"][0]
    assert disc["line"] in lines
    assert disc["profile"] == pytest.approx(2.0 * STRAY, abs=0.02)
    assert abs(disc["turned_deg"]) < 0.01
    assert np.hypot(*np.array(disc["shifted"])) < 0.002
    if len(lines) < 12:
        assert {outlier["line"] for outlier in made["surfaces"][0]["outliers"]} == set(lines)
        assert abs(made["motion"]["error"]["max"]) < 0.002
        assert not disc["causes"]


@pytest.mark.thin(2)
@pytest.mark.parametrize("align", ["rotation", "best-fit"])
def test_a_stray_turns_no_part(align, tmp_path):
    recipe, (file,) = measured(tmp_path, ROLLER)
    file.write_text(table(turned(stray_points(ROLLER, (102,)), 3.0)))
    made = camgeo.verify(recipe, file, align=align)["made"]
    assert made["discs"][0]["aligned"]["turned_deg"] == pytest.approx(3.0, abs=0.003)
    assert abs(made["motion"]["error"]["max"]) < 0.002


@pytest.mark.slow
def test_a_stray_among_lifts_is_judged_and_named(tmp_path):
    recipe, (file,) = measured(tmp_path, limited(ROLLER))
    ((_, _, surface),) = surfaces(ROLLER)
    angle = np.arange(720) * 0.5
    lift = surface.gauge.motion.derivatives(np.radians(angle), 0)[0]
    lift += 0.0005 * np.random.default_rng(1).normal(size=720)
    lift[[200, 201, 400]] += [50.0, 3.0, -7.0]
    file.write_text("angle_deg,lift_mm\n" + "\n".join(f"{a:.2f},{s:.6f}" for a, s in zip(angle, lift, strict=True)))
    for align in ("none", "rotation"):
        made = camgeo.verify(recipe, file, align=align)["made"]
        assert [outlier["line"] for outlier in made["surfaces"][0]["outliers"]] == [202, 402, 203]
        assert made["discs"][0]["line"] == 202
        assert abs(made["motion"]["error"]["max"]) < 0.001
        assert abs(made["motion"]["offset"]) < 1e-4


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("more", "zone", "verdict"),
    [
        ("", None, None),
        # needs: sheet
        ("export: {files: [{sheet: {profile: 0.05}}]}", "export.files[0].sheet.profile", "ok"),
        # needs: budget
        ("budget: {permitted: 0.1, tolerances: {profile: 0.019}}", "budget.tolerances.profile", "failed"),
        ("made: {profile: 0.041}", "made.profile", "not proved"),
    ],
)
def test_the_profile_is_judged_by_the_zone_that_the_recipe_states(more, zone, verdict, tmp_path, capsys):
    """A part 0.02 too large all round has a profile of 0.04 +- 0.002; of a budget the zone is twice plus and minus."""
    recipe, (file,) = measured(tmp_path, f"{ROLLER}\n{more}\n", lambda t: np.full_like(t, 0.02))
    status = main(["verify", str(recipe), str(file), "--probe-error", "0.001"])
    made = camgeo.verify(recipe, file, probe_error=0.001)["made"]
    assert made["discs"][0]["profile"] == pytest.approx(0.04, abs=1e-6)
    assert made["discs"][0]["uncertainty"] == pytest.approx(0.002)
    assert made["verdicts"] == ({"made-profile": verdict} if verdict else {})
    head = {"ok": "ok", "failed": "FAILED", "not proved": "NOT PROVED", None: "measured, no limit given"}[verdict]
    assert capsys.readouterr().out.startswith(f"part: {head}  points-1.csv\n")
    assert status == (0 if verdict in {"ok", None} else 1)
    assert any("no limit is given" in remark for remark in made["remarks"]) is (verdict is None)
    assert any(f"wide by {zone}" in remark for remark in made["remarks"]) is (zone not in {None, "made.profile"})
