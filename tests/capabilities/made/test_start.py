"""`camgeo new --from`: recipes of cams that were measured, exported and verified against the points."""

from __future__ import annotations

import itertools
import os
import re

import numpy as np
import pytest
from support.measured import ARM, MOTION, RECIPES, SWING, bump, disc, measured, nothing, points, surfaces, table, turned

import camgeo
from camgeo.capabilities.made.start import _verified
from camgeo.cli import progress
from camgeo.cli.main import main
from camgeo.common.errors import CallError

KINDS = [
    "roller on a stem",
    "knife edge on a stem",
    "roller on a leading arm",
    "ring",
    "tilted flat",
    "flat on an arm",
]


def framed(kind, more=""):
    motion = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 60}]"
    cam = f"kind: {kind}, base_radius: 40, {more}motion: {motion}"
    return f"part: {{bore: 12}}\nverify: {{angles: 360}}\ncam: {{{cam}}}"


def two_rollers(ratio, arm, law):
    cam = f"kind: double-roller, ratio: {ratio}, arm: {arm}, roller_radius: 8, law: {law}"
    return f"part: {{bore: 12}}\nverify: {{angles: 360}}\ncam: {{{cam}}}"


BELL_CRANK = "conjugate: {radius: 12, length: 70, angle: 70}, "
TWO_CONTACTS = {
    "groove": RECIPES["groove"],
    "groove on an arm": disc(f"kind: roller, radius: 10, {ARM}", SWING, "track: {groove: {clearance: 0.03}}, "),
    "conjugate rollers": RECIPES["conjugate discs"],
    "conjugate faces": disc("kind: flat", MOTION, "conjugate: {distance: 100}, "),
    "bell crank": disc(f"kind: roller, radius: 10, {ARM}", SWING, BELL_CRANK),
    "yoke": framed("constant-breadth"),
    "roller yoke": framed("constant-diameter", "roller_radius: 10, "),
    "double roller": two_rollers(
        2, 40, "[{rise: 8, over: 35, law: cycloidal}, {dwell: 15}, {return: 8, over: 40, law: cycloidal}]"
    ),
    "double roller of ratio 3": two_rollers(
        3, 60, "[{rise: 4, over: 25, law: cycloidal}, {dwell: 10}, {return: 4, over: 25, law: cycloidal}]"
    ),
}


def flat_pair(ratio, arm, law):
    cam = f"kind: flat-pair, ratio: {ratio}, arm: {arm}, law: {law}"
    return f"part: {{bore: 12}}\nverify: {{angles: 360}}\ncam: {{{cam}}}"


TWO_CONTACTS["flat pair"] = flat_pair(
    2, 40, "[{rise: 2, over: 40, law: cycloidal}, {dwell: 10}, {return: 2, over: 40, law: cycloidal}]"
)
TWO_CONTACTS["flat pair of ratio 3"] = flat_pair(
    3, 60, "[{rise: 1, over: 30, law: cycloidal}, {return: 1, over: 30, law: cycloidal}]"
)
SUPPORT = "part: {bore: 6}\nverify: {angles: 360}\ncam: {kind: support"
LINKAGE = "\nlinkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}"
THIRD_AND_FIFTH = (25.0, {3: 1.5}, {5: 0.3})
SERIES = {  # a cam, what the recipe says of it beside the points, the series that is expected, what it leaves at most
    "odd": (", fourier: {mean: 25, cos: {3: 1.5}, sin: {5: 0.3}}}", "}", THIRD_AND_FIFTH, 0.001),
    "even": (
        ", fourier: {mean: 25, cos: {2: 1.5}, sin: {5: 0.3}}}",
        "}",
        (25.0, {2: 1.5}, {5: 0.3}),
        0.001,
    ),
    "a shaft that is known": (
        ", fourier: {mean: 25, cos: {3: 1.5}, sin: {5: 0.3}}, shaft: [8, -3]}",
        ", shaft: [8, -3]}",
        THIRD_AND_FIFTH,
        0.001,
    ),
    "a shaft that is not": (
        ", fourier: {mean: 25, cos: {3: 1.5}, sin: {5: 0.3}}, shaft: [8, -3]}",
        "}",
        (25.0, {1: -8.0, 3: 1.5}, {1: 3.0, 5: 0.3}),
        0.001,
    ),
    "other keys give way": (
        ", hypocycloid: {cusps: 3, size: 2, breadth: 50}}",
        ", reuleaux: {sides: 5, breadth: 40, rounding: 5}}",
        (25.0, {3: 2.0}, {}),
        0.001,
    ),
    "jumps of curvature": (", reuleaux: {sides: 3, breadth: 50, rounding: 5}}", "}", (25.0, None, None), 0.01),
    "in a linkage": (
        f", fourier: {{mean: 25, cos: {{3: 2}}}}, shaft: [18, 8.5]}}{LINKAGE}",
        f", shaft: [18, 8.5]}}{LINKAGE}",
        (25.0, {3: 2.0}, {}),
        0.001,
    ),
}


def bare(text):
    """A recipe that says neither base radius nor motion."""
    return re.sub(r", (motion|law): \[.*\]", "", text.replace("base_radius: 40, ", ""))


def new_from(folder, files):
    words = [word for file in files for word in ("--from", str(file))]
    return main(["new", *words, str(folder / "bare.yaml"), str(folder / "new.yaml")])


def start_all(folder, text, deviation=nothing, noise=0.0005, count=720):
    """Measure all surfaces of a recipe, the first with a deviation, and make a recipe of the points."""
    _, files = measured(folder, text, deviation, noise, count)
    (folder / "bare.yaml").write_text(bare(text), "utf-8")
    return new_from(folder, files)


def start(folder, text, deviation=nothing, noise=0.0005, recipe=None):
    ((_, part, surface),) = surfaces(text)
    (folder / "points.csv").write_text(table(points(part, surface, deviation, noise)), "utf-8")
    (folder / "bare.yaml").write_text(bare(text) if recipe is None else recipe, "utf-8")
    return main(["new", "--from", str(folder / "points.csv"), str(folder / "bare.yaml"), str(folder / "new.yaml")])


@pytest.mark.costly("laws are told apart by fits of each")
@pytest.mark.thin(9)
@pytest.mark.parametrize("kind", KINDS)
def test_the_recipe_of_a_clean_cam_comes_back(kind, tmp_path, capsys):
    assert start(tmp_path, RECIPES[kind]) == 0
    lines = capsys.readouterr().out
    ((_, _, meant),) = surfaces(RECIPES[kind])
    assert "verified against the points: profile 0.00" in lines
    assert "cycloidal leaves" in lines
    text = (tmp_path / "new.yaml").read_text("utf-8")
    assert text.count("law: cycloidal") == 2
    (base,) = re.findall(r"base_radius: ([0-9.]+)", text)
    assert float(base) == pytest.approx(40.0, abs=0.001)
    ((_, _, surface),) = surfaces(text)
    t = np.linspace(0.0, 2.0 * np.pi, 500)
    assert surface.gauge.envelope.points(t) == pytest.approx(meant.gauge.envelope.points(t), abs=0.002)
    assert camgeo.export(tmp_path / "new.yaml", tmp_path / "out").ok
    assert camgeo.verify(tmp_path / "new.yaml", tmp_path / "points.csv")["made"]["discs"][0]["profile"] < 0.007


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in TWO_CONTACTS if kind not in {"groove", "yoke", "double roller"}])
def test_the_recipe_of_a_clean_cam_with_two_contacts_comes_back(kind, tmp_path, capsys):
    text = TWO_CONTACTS[kind]
    assert start_all(tmp_path, text) == 0
    lines = capsys.readouterr().out
    assert "verified against the points: profile 0.00" in lines
    new = (tmp_path / "new.yaml").read_text("utf-8")
    assert new.count("law: cycloidal") == text.count("law: cycloidal")
    if "base_radius" in text:
        (base,) = re.findall(r"base_radius: ([0-9.]+)", new)
        assert float(base) == pytest.approx(40.0, abs=0.001)
    t = np.linspace(0.0, 2.0 * np.pi, 500)
    for (_, _, meant), (_, _, surface) in zip(surfaces(text), surfaces(new), strict=True):
        assert surface.gauge.envelope.points(t) == pytest.approx(meant.gauge.envelope.points(t), abs=0.002)
    assert camgeo.export(tmp_path / "new.yaml", tmp_path / "out").ok


@pytest.mark.thin(8)
@pytest.mark.parametrize("name", SERIES)
def test_a_support_function_comes_back_as_its_series(name, tmp_path, capsys):
    """Harmonics within 0.2 um, and none besides; of jumps of curvature the low ones, by what they leave."""
    cam, said, series, most = SERIES[name]
    _, files = measured(tmp_path, SUPPORT + cam, nothing, 0.0005)
    (tmp_path / "bare.yaml").write_text(SUPPORT + said, "utf-8")
    assert new_from(tmp_path, files) == 0
    told = capsys.readouterr().out
    (left,) = re.findall(r"the harmonics leave ([0-9.e-]+) mm at most", told)
    assert float(left) < most
    assert "verified against the points: profile 0.00" in told
    shape = camgeo.load(tmp_path / "new.yaml").cam.shape
    mean, *parts = series
    assert shape.mean == pytest.approx(mean, abs=0.0005)
    for coefficients, expected in zip((shape.cos, shape.sin), parts, strict=True):
        assert expected is None or dict(coefficients) == pytest.approx(expected, abs=0.0002)
    assert camgeo.export(tmp_path / "new.yaml", tmp_path / "out").ok


def test_a_support_function_that_its_harmonics_miss_is_refused(tmp_path, capsys):
    """Sharp corners call for more harmonics than points of a half degree tell of a zone of 2 um."""
    text = f"made: {{profile: 0.002}}\n{SUPPORT}, reuleaux: {{sides: 3, breadth: 50, rounding: 5}}}}"
    _, files = measured(tmp_path, text, nothing, 0.0005)
    (tmp_path / "bare.yaml").write_text(text, "utf-8")
    assert new_from(tmp_path, files) == 2
    error = capsys.readouterr().err
    assert "the harmonics that stand out of the noise leave 0.00" in error
    assert "more than 0.001: " in error
    assert not (tmp_path / "new.yaml").exists()


@pytest.mark.slow
def test_a_frame_under_a_linkage_comes_back(tmp_path):
    linkage = "\nlinkage: {kind: inverted-slider-crank, ground: 90, rocker: 0}"
    assert start_all(tmp_path, framed("constant-breadth") + linkage) == 0
    new = (tmp_path / "new.yaml").read_text("utf-8")
    assert "{rise: 8, over: 120, law: cycloidal}, {dwell: 60}" in new
    assert "base_radius: 40," in new
    assert camgeo.export(tmp_path / "new.yaml", tmp_path / "out").ok


# the three whose acceleration jumps, and three of the others, which tests of kin tell
LAWS = ["cubic", "polynomial-345", "parabolic", "polynomial-23", "scca-33", "polynomial-4567"]


@pytest.mark.slow
@pytest.mark.parametrize(  # each law of one kind, in turn
    ("law", "kind"), list(zip(LAWS, itertools.cycle(["groove", "yoke", "double roller"]), strict=False))
)
def test_each_law_of_two_contacts_is_told(kind, law, tmp_path):
    text = TWO_CONTACTS[kind].replace("cycloidal", law).replace("roller_radius: 8", "roller_radius: 6")  # no undercut
    assert start_all(tmp_path, text) == 0
    new = (tmp_path / "new.yaml").read_text("utf-8")
    assert new.count(f"law: {law}") == text.count(f"law: {law}")


@pytest.mark.slow
def test_play_is_told_and_halved_between_both_sides(tmp_path, capsys):
    """Both discs 0.01 mm too small: the motion is the one midway, and the contacts have 0.02 mm of play."""
    text = RECIPES["conjugate discs"]
    files = []
    for number, (_, part, surface) in enumerate(surfaces(text), start=1):
        files.append(tmp_path / f"points-{number}.csv")
        files[-1].write_text(table(points(part, surface, lambda t: np.full_like(t, -0.01))), "utf-8")
    (tmp_path / "bare.yaml").write_text(bare(text), "utf-8")
    assert new_from(tmp_path, files) == 0
    assert "base_radius: 40," in (tmp_path / "new.yaml").read_text("utf-8")
    assert "the contacts have +0.02 mm more play than the recipe says, from +0.02 to +0.02" in capsys.readouterr().out


@pytest.mark.slow
def test_the_breadth_of_a_yoke_is_that_of_its_points(tmp_path, capsys):
    """A cam 0.03 mm too large all round has a larger base circle; a bump on one side shows in the breadth."""
    text = TWO_CONTACTS["yoke"]
    assert start_all(tmp_path, text, lambda t: 0.03 + bump(0.01, 10.0)(t), noise=0.0) == 0
    told = capsys.readouterr().out
    (base,) = re.findall(r"base radius ([0-9.]+) ", told)
    assert float(base) == pytest.approx(40.03, abs=0.003)
    assert re.search(r"the part is -0\.001\d* to \+0\.008\d* mm off a constant distance", told)


@pytest.mark.slow
def test_a_long_wave_moves_what_is_found_as_far_as_is_told(tmp_path, capsys):
    """A cosine of one wave a turn, 0.02 mm high, is eccentricity as much as motion."""
    text = RECIPES["roller on a stem"]
    moves = []
    for phase in np.radians([0.0, 60.0, 120.0]):
        folder = tmp_path / f"{phase:.2f}"
        folder.mkdir()
        assert start(folder, text, lambda t, phase=phase: 0.02 * np.cos(t - phase)) == 0
        told = capsys.readouterr().out
        (base,) = re.findall(r"base radius ([0-9.]+) ", told)
        wave = "a form of 1 wave a turn, 0.02 mm high, is taken for motion by "
        ((share, most),) = re.findall(rf"{wave}(\d+) % and moves the base radius by ([0-9.]+)", told)
        moves.append(abs(float(base) - 40.0))
        assert int(share) >= 95
        assert moves[-1] <= 1.1 * float(most)
    assert max(moves) > 0.8 * float(most)


@pytest.mark.slow
def test_round_numbers_are_written_where_the_points_let_them_be(tmp_path):
    start(tmp_path, RECIPES["roller on a stem"])
    recipe = camgeo.load(tmp_path / "new.yaml")
    assert recipe.cam.base_radius == 40.0
    assert (
        "[{rise: 8, over: 120, law: cycloidal}, {dwell: 40}, {return: 8, over: 140, law: cycloidal}, {dwell: 60}]"
        in (tmp_path / "new.yaml").read_text("utf-8")
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (SUPPORT + SERIES["odd"][0], SUPPORT + SERIES["odd"][1]),
        pytest.param(RECIPES["flat"], bare(RECIPES["flat"]), marks=pytest.mark.slow),
    ],
)
def test_comments_and_other_keys_stay(text, said, tmp_path):
    recipe = f"# my cam\n{said}\nexport: {{tolerance: 0.002}}  # as asked\n"
    assert start(tmp_path, text, recipe=recipe) == 0
    new = (tmp_path / "new.yaml").read_text("utf-8")
    assert new.startswith("# my cam\n")
    assert "# as asked" in new


@pytest.mark.slow
def test_what_a_recipe_says_of_motion_and_base_gives_way(tmp_path):
    other = RECIPES["roller on a stem"].replace("base_radius: 40", "base_radius: 35").replace("rise: 8", "rise: 3")
    assert start(tmp_path, RECIPES["roller on a stem"], recipe=other.replace("return: 8", "return: 3")) == 0
    assert "rise: 8, over: 120" in (tmp_path / "new.yaml").read_text("utf-8")


@pytest.mark.slow
def test_inches_and_a_shaft_that_turns_the_other_way(tmp_path):
    text = disc(
        "kind: roller, radius: 0.4",
        "[{rise: 0.3, over: 120, law: modified-sine}, {dwell: 60}, "
        "{return: 0.3, over: 110, law: modified-sine}, {dwell: 70}]",
    ).replace("base_radius: 40", "base_radius: 1.5")
    text = f"units: inch\nrotation: ccw\n{text.replace('bore: 12', 'bore: 0.5')}"
    assert start(tmp_path, text, recipe=re.sub(r", motion: \[.*\]", "", text.replace("base_radius: 1.5, ", ""))) == 0
    new = (tmp_path / "new.yaml").read_text("utf-8")
    assert "base_radius: 1.5" in new
    assert new.count("law: modified-sine") == 2


@pytest.mark.slow
def test_a_worn_cam_becomes_a_table(tmp_path, capsys):
    """A groove worn 0.2 mm deep beside the top of the rise: no law has it."""
    assert start(tmp_path, RECIPES["roller on a stem"], bump(-0.2, 5.0)) == 0
    lines = capsys.readouterr().out
    assert re.search(
        r"the motion is a table, new-lift\.csv, within 0\.02 mm: the laws that fit best leave 0\.[0-9]+ mm", lines
    )
    rows = (tmp_path / "new-lift.csv").read_text("utf-8").splitlines()
    assert rows[0] == "angle,lift"
    assert len(rows) == 722
    assert camgeo.export(tmp_path / "new.yaml", tmp_path / "out").ok
    assert camgeo.verify(tmp_path / "new.yaml", tmp_path / "points.csv")["made"]["discs"][0]["profile"] < 0.06


@pytest.mark.slow
def test_a_turn_that_begins_within_a_stroke_becomes_a_table(tmp_path, capsys):
    text = RECIPES["roller on a stem"]
    ((_, part, surface),) = surfaces(text)
    places = points(part, surface)
    c, s = np.cos(np.radians(50.0)), np.sin(np.radians(50.0))
    (tmp_path / "points.csv").write_text(table(places @ np.array([[c, -s], [s, c]])), "utf-8")
    (tmp_path / "bare.yaml").write_text(bare(text), "utf-8")
    assert (
        main(["new", "--from", str(tmp_path / "points.csv"), str(tmp_path / "bare.yaml"), str(tmp_path / "new.yaml")])
        == 0
    )
    assert "the turn begins within a stroke: turn the points" in capsys.readouterr().out


@pytest.mark.slow
def test_laws_that_fit_alike_are_named(tmp_path, capsys):
    """Noise of 20 um leaves the laws of two cosines and of a trapezoid alike."""
    text = RECIPES["roller on a stem"].replace("cycloidal", "gutman-13")
    assert start(tmp_path, text, noise=0.02) == 0
    assert re.search(
        r", .*(freudenstein|modified-trapezoid).* hardly more: look at which it was", capsys.readouterr().out
    )


ROLLERS = TWO_CONTACTS["double roller"]
OTHERS = {  # the cam, as what it is told, and by how many degrees its points are turned
    "a disc in a yoke": (RECIPES["flat"], TWO_CONTACTS["yoke"], 0.0, "of no cam of kind constant-breadth with these"),
    "another ratio": (
        ROLLERS,
        ROLLERS.replace("ratio: 2", "ratio: 3"),
        0.0,
        "of no cam of kind double-roller with these",
    ),
    "turned": (ROLLERS, ROLLERS, 20.0, "the swing begins at 0, and these points' is 0 and rises at 19."),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", OTHERS)
def test_points_that_keep_from_the_symmetry_of_a_kind_are_refused(name, tmp_path, capsys):
    cam, told_as, turn, told = OTHERS[name]
    ((_, part, surface),) = surfaces(cam)
    (tmp_path / "points.csv").write_text(table(turned(points(part, surface), turn)), "utf-8")
    (tmp_path / "bare.yaml").write_text(bare(told_as), "utf-8")
    assert new_from(tmp_path, [tmp_path / "points.csv"]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "new.yaml").exists()


BAD = {
    "one of two discs": (RECIPES["conjugate discs"], None, "points of disc 2 are missing: give a file for each disc"),
    "an unknown kind": (bare(RECIPES["flat"]).replace("kind: disc", "kind: dics"), None, "cam.kind: "),
    "lifts": (
        bare(RECIPES["flat"]),
        "angle,lift\n" + "\n".join(f"{k},{k % 7}" for k in range(360)),
        "lifts tell no base",
    ),
    "few points": (bare(RECIPES["flat"]), "x,y\n1,2\n3,4\n", "points"),
    "a fault": (bare(RECIPES["flat"]).replace("bore: 12", "bore: x"), None, "part.bore: "),
    "no cam": ("part: {bore: 12}\n", None, "cam"),
    "bytes that are not UTF-8": ("part: {bore: \udcff12}\n", None, "bare.yaml:1:14: not UTF-8"),
}


@pytest.mark.parametrize("name", list(BAD))
def test_bad_input_is_told_and_nothing_is_written(name, tmp_path, capsys):
    recipe, data, told = BAD[name]
    ((_, part, surface),) = surfaces(RECIPES["flat"])
    (tmp_path / "points.csv").write_text(data or table(points(part, surface)), "utf-8")
    (tmp_path / "bare.yaml").write_text(recipe, "utf-8", errors="surrogateescape")
    before = set(tmp_path.iterdir())
    assert (
        main(["new", "--from", str(tmp_path / "points.csv"), str(tmp_path / "bare.yaml"), str(tmp_path / "new.yaml")])
        == 2
    )
    assert told in capsys.readouterr().err
    assert set(tmp_path.iterdir()) == before


@pytest.mark.slow
def test_files_that_are_there_or_not_there(tmp_path, capsys):
    assert start(tmp_path, RECIPES["flat"]) == 0
    assert start(tmp_path, RECIPES["flat"]) == 2
    assert "exists already" in capsys.readouterr().err
    for source, recipe in (("none.csv", "bare.yaml"), ("points.csv", "none.yaml")):
        words = ["new", "--from", str(tmp_path / source), str(tmp_path / recipe), str(tmp_path / "other.yaml")]
        assert main(words) == 2
        assert f"{tmp_path / next(each for each in (source, recipe) if 'none' in each)}: the file does not exist" in (
            capsys.readouterr().err
        )
    assert main(["new", "--from", str(tmp_path / "points.csv")]) == 2
    assert "give a recipe that says what follows the cam" in capsys.readouterr().err
    assert not (tmp_path / "other.yaml").exists()


# needs: follow
def test_a_drawing_has_no_points(tmp_path, capsys):
    (tmp_path / "cam.dxf").write_text("0\nEOF\n")
    (tmp_path / "bare.yaml").write_text(bare(RECIPES["flat"]), "utf-8")
    words = ["new", "--from", *(str(tmp_path / name) for name in ("cam.dxf", "bare.yaml", "new.yaml"))]
    assert main(words) == 2
    problem = "a drawing, and no points: its recipe is made by camgeo follow with --recipe"
    assert f"cam.dxf: {problem}" in capsys.readouterr().err


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_pipes_are_not_waited_for(tmp_path, capsys):
    os.mkfifo(tmp_path / "pipe.csv")
    os.mkfifo(tmp_path / "pipe.yaml")
    (tmp_path / "bare.yaml").write_text(bare(RECIPES["flat"]), "utf-8")
    for source, recipe in (("pipe.csv", "bare.yaml"), ("pipe.csv", "pipe.yaml")):
        words = ["new", "--from", str(tmp_path / source), str(tmp_path / recipe), str(tmp_path / "new.yaml")]
        assert main(words) == 2
        assert "a pipe, a socket or a device, not a file" in capsys.readouterr().err


@pytest.mark.slow
def test_what_takes_long_is_said(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(progress, "LONG", 0.01)
    assert start(tmp_path, RECIPES["flat"]) == 0
    assert capsys.readouterr().err == "new.yaml: make the recipe ...\n"


def test_a_cam_that_fails_is_not_made_of_points():
    text = "cam: {kind: support, p: 30}\npart: {bore: 58, wall: 5}\n"  # it has a contour
    with pytest.raises(CallError, match="the cam of these points cannot be made: wall: "):
        _verified(text, {}, "cam.yaml", [])
