# needs: milling
"""Programs of drums: written, read by a few lines of their own, held against brute force, judged, refused.

Holds: camgeo.capabilities.cylindrical.program, camgeo.capabilities.cylindrical.ways,
camgeo.fit.parted, camgeo.capabilities.cylindrical.bends.
"""

from __future__ import annotations

import contextlib
import functools
import math
import re
from random import Random
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import (
    ARM,
    BESIDE,
    CONE,
    CONE_ON_ARM,
    GROOVE,
    LEADING,
    LED,
    RIB,
    RIB_ON_ARM,
    TOP,
    UNDERCUT,
    changed,
    cut_short,
    design_of,
    random_drum,
    recipe_of,
    shared_design,
)
from capabilities.cylindrical.positions import Lift, envelope
from support.cases import few
from support.programmes import Segment, law, programme

import camgeo
from camgeo.api.root import root_of
from camgeo.capabilities.cylindrical.bends import contact_turns
from camgeo.capabilities.cylindrical.design import DrumDesign
from camgeo.capabilities.cylindrical.making import make
from camgeo.capabilities.cylindrical.program import write_program
from camgeo.capabilities.cylindrical.tracks import Rib
from camgeo.capabilities.cylindrical.verdicts import judged_file
from camgeo.capabilities.cylindrical.ways import Cutter, Way, radially_off, set_beside, set_radially
from camgeo.cli.main import main
from camgeo.common.clock import Clock
from camgeo.machining import turned
from camgeo.schema.errors import RecipeErrors
from kin.numeric.records import replace
from kin.turned import cutters

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.output.own_kind import Made
    from kin.turned.verdict import TurnedVerdict

OPTIONS = "axes: [X, A], cutter: 20, feed: 300, plunge: 60, spindle: 2500, depth_of_cut: 7, safe_height: 5"
TURN = 2.0 * math.pi
RISE, RETURN = ("rise", 40.0, 120.0, "cycloidal"), ("return", 40.0, 120.0, "polynomial-345")
REST = ("dwell", 0.0, 60.0, "")
LIFT = Lift([RISE, REST, RETURN, REST])


def program(text: str = GROOVE, *pairs: tuple[str, str]) -> str:
    """Text of a recipe whose file is a program, with changes."""
    return changed(changed(text, ("[stl]", f"[{{gcode: {{{OPTIONS}}}}}]")), *pairs)


def exported(folder: Path, text: str) -> camgeo.Report:
    (folder / "drum.yaml").write_text(text, encoding="utf-8")
    return camgeo.export(folder / "drum.yaml", folder / "out")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Path, camgeo.Report]]:
    """Exports a text once for all tests that look at what comes of it: the folder, and the report."""

    @functools.cache
    def of(text: str) -> tuple[Path, camgeo.Report]:
        folder = tmp_path_factory.mktemp("made")
        return folder, exported(folder, text)

    return of


def words(folder: Path) -> str:
    return (folder / "out" / "drum" / "drum.ngc").read_text("ascii")


def failing(report: camgeo.Report) -> set[str]:
    return {check.name for check in report.checks if not check.ok}


def positions(text: str) -> list[np.ndarray]:
    """Points (n, 4) of X, Y, Z and A, mm and degrees, of the feed moves between rapid ones, by their letters alone."""
    at, runs, rapid = dict.fromkeys("XYZA", 0.0), list[list[list[float]]](), True
    for line in re.sub(r"\([^)]*\)", "", text).splitlines():
        if not line.startswith(("G0 ", "G1 ")):
            continue
        before = list(at.values())
        at |= {letter: float(value) for letter, value in re.findall(r"([XYZA])(-?[\d.]+)", line)}
        if line.startswith("G1"):
            if rapid:
                runs.append([before])
            runs[-1].append(list(at.values()))
        rapid = line.startswith("G0")
    return [np.array(run) for run in runs]


CASES = {
    "as large as the roller": program(),
    "beside": program(
        GROOVE, ("12.5}", "12.5, clearance: 0.04}"), ("[X, A]", "[X, Y, A]"), ("cutter: 20", "cutter: 16")
    ),
    "rib": program(RIB, ("[X, A]", "[X, Y, A]"), ("cutter: 20", "cutter: 17")),
    "end": program(TOP, ("cutter: 20", "cutter: 19.8")),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_the_cutter_leaves_the_flanks_that_rollers_leave(
    made: Callable[[str], tuple[Path, camgeo.Report]], case: str
) -> None:
    """At random places of each flank no position of the cutter takes metal, and one takes all in front of it."""
    text = CASES[case]
    folder, report = made(text)
    assert report.ok, [str(check) for check in report.checks if not check.ok]
    cutter = 0.5 * float(re.findall(r"cutter: ([\d.]+)", text)[0])
    runs = positions(words(folder))
    share = np.linspace(0.0, 1.0, 120, endpoint=False)
    rows = np.concatenate(
        [(run[:-1, None] + share[:, None] * np.diff(run, axis=0)[:, None]).reshape(-1, 4) for run in runs]
    )
    rng = np.random.default_rng(5)
    for name, side, roller, level in flanks_of(text):
        r, phi = rng.uniform(39.0, 50.0, 25), rng.uniform(0.0, 2.0 * math.pi, 25)
        z, _ = envelope(LIFT, side, roller, r, phi)
        for radius, angle, height in zip(r, phi, z + level, strict=True):
            turn = angle - np.radians(rows[:, 3])
            stands = (radius * np.cos(turn) >= rows[:, 2]) & (np.cos(turn) > 0.0)
            far = np.hypot(radius * np.sin(turn) - rows[:, 1], height - rows[:, 0])[stands] - cutter
            assert abs(far.min()) < 0.02, (name, radius, math.degrees(angle))


def flanks_of(text: str) -> list[tuple[str, int, float, float]]:
    if "rib" in text:
        return [("lower", -1, 10.0, 65.0), ("upper", 1, 10.0, 15.0)]
    if "end: top" in text:
        return [("lower", -1, 10.0, 20.0)]
    return [("lower", -1, 10.0, 20.0), ("upper", 1, 10.04 if "clearance" in text else 10.0, 20.0)]


def test_a_program_says_how_it_is_meant(made: Callable[[str], tuple[Path, camgeo.Report]]) -> None:
    folder, report = made(program())
    assert report.ok
    lines = words(folder).splitlines()
    for told in (
        "(cutter: diameter 20, its axis square to the drum's)",
        "(X zero: the lower face; X grows along the drum's axis, towards the upper face)",
        "(A zero: the roller's place at shaft angle 0, from which the keyway's angle counts)",
        "(A grows as the cutter goes round the drum counter-clockwise, seen from the upper face)",
        "(Z zero: the drum's axis; blank 50, floor 37.5)",
        "(feed: G93, the inverse of the minutes of a block, 300 a minute at a radius of 50)",
    ):
        assert told in lines
    assert lines[lines.index("G21") + 1] == "G17 G90 G93"
    assert not any("Y" in line for line in lines if line.startswith("G1"))
    # every block takes its length at the blank over 300 mm a minute
    for run in positions(words(folder)):
        assert run[:, 0].min() > 19.99
        assert np.diff(run[1:, 3]).min() > 0.0
    feeds = [float(f) for f in re.findall(r"^G1 X\S+ A\S+ F(\S+)$", "\n".join(lines), re.MULTILINE)]
    (first, *_) = positions(words(folder))
    far = np.hypot(np.diff(first[1:, 0]), 50.0 * np.radians(np.diff(first[1:, 3])))
    np.testing.assert_allclose(feeds[: len(far)] * far, 300.0, rtol=1e-5)
    recipe = camgeo.load(folder / "drum.yaml")
    found = {(check.name, check.file) for check in report.checks}
    assert {(each.name, each.file) for each in root_of(recipe).foresee(recipe)} <= found


@pytest.mark.slow
def test_a_drum_that_turns_the_other_way_has_the_mirrored_program(tmp_path: Path) -> None:
    text = program(GROOVE, ("[X, A]", "[X, Y, A]"), ("cutter: 20", "cutter: 18"))
    plain, mirrored = tmp_path / "a", tmp_path / "b"
    for folder, own in ((plain, text), (mirrored, "rotation: ccw\n" + text)):
        folder.mkdir()
        assert exported(folder, own).ok
    # it climbs all the same, and so goes the other way along each flank
    pairs = zip(positions(words(plain)), positions(words(mirrored)), strict=True)
    for first, second in pairs:
        back = second[1:][::-1] * np.array([1.0, -1.0, 1.0, -1.0])
        np.testing.assert_allclose(first[1:], back, atol=1e-9)
        assert np.sign(first[-1, 3] - first[1, 3]) == (1.0 if first[3, 0] < 20.0 else -1.0)


def test_inches_and_a_feed_by_the_minute(tmp_path: Path) -> None:
    text = "units: inch\n" + program(GROOVE, ("cutter: 20", "cutter: 20, feed_mode: per-minute"))
    named = (
        "radius|depth|from|pitch_height|rise|return|length|bore|cutter|feed|plunge|depth_of_cut|safe_height|tolerance"
    )
    text = re.sub(rf"\b({named}): ([\d.]+)", r"\1: \2 mm", text)
    report = exported(tmp_path, text)
    assert report.ok, failing(report)
    lines = words(tmp_path).splitlines()
    assert "G20" in lines
    assert "G17 G90 G94" in lines
    assert f"G1 Z{43.75 / 25.4:.5f} F2.36220" in lines
    assert sum(" F11.8110" in line for line in lines) == 2
    assert max(run[:, 0].max() for run in positions(words(tmp_path))) == pytest.approx(60.0 / 25.4, abs=1e-4)


@pytest.mark.slow
def test_an_allowance_is_left_by_all_but_the_last_pass(tmp_path: Path) -> None:
    text = program(GROOVE, ("[X, A]", "[X, Y, A]"), ("cutter: 20", "cutter: 18, allowance: 0.3"))
    assert exported(tmp_path, text).ok
    lines = words(tmp_path).splitlines()
    assert [line for line in lines if " pass " in line] == [
        "(lower flank, rough, pass 1 of 6)",
        "(upper flank, rough, pass 2 of 6)",
        "(lower flank, rough, pass 3 of 6)",
        "(upper flank, rough, pass 4 of 6)",
        "(lower flank, last, pass 5 of 6)",
        "(upper flank, last, pass 6 of 6)",
    ]
    runs = positions(words(tmp_path))
    # in the dwell at lift 0 the cutter stands 1 mm off the roller's path, and 0.3 mm less before
    at = [float(run[2:-2][np.argmin(np.abs(run[2:-2, 3] - 350.0)), 0]) for run in runs]
    np.testing.assert_allclose(at, [19.3, 20.7, 19.3, 20.7, 19.0, 21.0], atol=1e-3)
    assert [run[3, 2] for run in runs] == [43.75, 43.75, 37.5, 37.5, 37.5, 37.5]


@pytest.mark.slow
def test_a_cut_flank_takes_a_cutter_of_the_roller_s_size(tmp_path: Path) -> None:
    def program_of(cutter: str) -> Made[TurnedVerdict]:
        recipe = recipe_of(program(UNDERCUT, ("cutter: 20", f"cutter: {cutter}")))
        return make(cut_short(recipe), Clock(), recipe.export.files[0], tmp_path / "drum.ngc")

    assert program_of("24").verdict.ok
    with pytest.raises(camgeo.RecipeErrors, match="with an undercut, only a cutter as large as the roller"):
        program_of("23")


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "row",
    [
        ([("cutter: 20", "cutter: 20.5")], "a cutter wider than the roller cuts the flanks away", ("20.5", "20")),
        ([("cutter: 20", "cutter: 9")], "does not clear the groove", ("[X, A], cutter: 9", "[X, Y, A], cutter: 10.02")),
        ([("cutter: 20", "cutter: 16")], "it is right at one radius alone", ("[X, A]", "[X, Y, A]")),
        ([("cutter: 20", "cutter: 16")], "give a cutter of at least 19.7", ("16", "19.78")),
        (
            [("cutter: 20", "cutter: 16")],
            "or give a tolerance of at least 0.355 mm",
            ("tolerance: 0.02", "tolerance: 0.355"),
        ),
        (
            [("cutter: 20", "cutter: 20, decimals: 2"), ("0.02", "0.002")],
            "give at least 3",
            ("decimals: 2", "decimals: 3"),
        ),
        ([("cutter: 20, ", "")], "gcode.cutter: missing", ("[X, A],", "[X, A], cutter: 20,")),
        (
            [(f"{{gcode: {{{OPTIONS}}}}}", "gcode")],
            "a program needs its machine and cutter; give axes, cutter, feed",
            ("[gcode]", f"[{{gcode: {{{OPTIONS}}}}}]"),
        ),
        (
            [("safe_height: 5", "safe_height: 1e6")],
            "safe_height: lies higher than a program tells; give at most 9.999e+05 mm",
            ("1e6", "9.999e+05"),
        ),
        ([("[X, A]", "[X, B]")], "not the axes of such a machine", ("[X, B]", "[X, Z, A]")),
        (
            [("cutter: 20", "cutter: 20, allowance: 0.2"), ("[X, A]", "[X, Y, A]")],
            "give at most 19.6 mm",
            ("cutter: 20", "cutter: 19.6"),
        ),
        (
            [("cutter: 20", "cutter: 20, allowance: 6")],
            "give an allowance below 4.99 mm",
            ("cutter: 20, allowance: 6", "cutter: 20"),
        ),
        (
            [("radius: 10,", "radius: 10, offset: 6,")],
            "and the roller's beside it, the cutter may be off by 0.968 mm",
            ("[X, A]", "[X, Y, A]"),
        ),
        (
            [("radius: 10,", "radius: 10, offset: 0.2,")],
            "or give a tolerance of at least 0.0756 mm",
            ("tolerance: 0.02", "tolerance: 0.0756"),
        ),
        (
            [("radius: 10,", "radius: 10, offset: 6,"), ("cutter: 20", "cutter: 19")],
            "only a cutter as large as the roller leaves such a flank",
            ("[X, A]", "[X, Y, A]"),
        ),
        (
            [("radius: 10,", "radius: 10, taper: axis, at: 44,")],
            "a cutter wider than the roller at the floor cuts the flanks away",
            ("cutter: 20", "cutter: 17.04545, taper: 12.8043"),
        ),
        (
            [("radius: 10,", "radius: 10, taper: axis, at: 44,"), ("cutter: 20", "cutter: 16")],
            "or give cutter: 17.04545, taper: 12.8043",
            ("cutter: 16", "cutter: 17.04545, taper: 12.8043"),
        ),
        (
            [
                ("radius: 10,", "radius: 10, taper: axis, at: 44,"),
                ("cutter: 20", "cutter: 16"),
                ("[X, A]", "[X, Y, A]"),
            ],
            "in as many depths as are made it still leaves more than the tolerance",
            ("cutter: 16", "cutter: 17.04545, taper: 12.8043"),
        ),
        (
            [("radius: 10,", "radius: 10, taper: 5,"), ("cutter: 20", "cutter: 18, taper: 6")],
            "a cutter tapers at most as its roller, given 6 degrees; give at most 5 degrees",
            ("[X, A], cutter: 18, taper: 6", "[X, Y, A], cutter: 18, taper: 5"),
        ),
        (
            [("cutter: 20", "cutter: 20, taper: 6")],
            "a cutter tapers at most as its roller, given 6 degrees; leave it out: the roller is a cylinder",
            (", taper: 6", ""),
        ),
        (
            [("cutter: 20", "cutter: 20, taper: axis")],
            "gcode.taper: not a number",
            (", taper: axis", ""),
        ),
        ([("depth_of_cut: 7", "depth_of_cut: 0.001")], "makes more than 2000 passes", ("0.001", "6")),
    ],
    ids=lambda row: row[1],
)
def test_what_is_refused_says_what_to_give(
    row: tuple[list[tuple[str, str]], str, tuple[str, str]],
    tmp_path: Path,
    made: Callable[[str], tuple[Path, camgeo.Report]],
    capsys: pytest.CaptureFixture[str],
) -> None:
    pairs, problem, remedy = row
    text = program(GROOVE, *pairs)
    (tmp_path / "drum.yaml").write_text(text, encoding="utf-8")
    assert main(["export", str(tmp_path / "drum.yaml"), "--out", str(tmp_path / "out")]) == 2
    assert problem in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    _, report = made(changed(text, remedy))
    assert report.ok


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pairs", "named", "option"),
    [
        ([("12.5}", "12.5, clearance: 0.02}"), ("cutter: 20", "cutter: 16")], "cutter of at least", "cutter: 16"),
        (
            [("cutter: 20", "cutter: 18, allowance: 0.3"), ("[X, A]", "[X, Y, A]"), ("cut: 7", "cut: 0.001")],
            "passes; give at least",
            "cut: 0.001",
        ),
    ],
    ids=["both flanks", "last passes"],
)
def test_what_an_error_names_is_enough(
    pairs: list[tuple[str, str]], named: str, option: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The cutter serves for the flank that asks for more, the depth for the passes that none of it makes fewer."""
    monkeypatch.setattr(turned, "MOST_PASSES", 20)
    text = program(GROOVE, *pairs)

    def write(text: str) -> None:
        design = design_of(text)
        request = design.recipe.export.files[0]
        write_program(design, request, tmp_path / "drum.ngc", design.recipe.tolerance(request), 1.0)

    with pytest.raises(RecipeErrors) as refused:
        write(text)
    found = re.search(rf"{named} ([\d.]+) mm", str(refused.value))
    assert found is not None
    write(changed(text, (option, f"{option.partition(':')[0]}: {found[1]}")))


def test_no_cutter_is_named_that_the_allowance_refuses(tmp_path: Path) -> None:
    design = design_of(program(GROOVE, ("cutter: 20", "cutter: 16, allowance: 0.3")))
    request = design.recipe.export.files[0]
    with pytest.raises(RecipeErrors, match=r"\[X, Y, A\], or give a tolerance of at least"):
        write_program(design, request, tmp_path / "drum.ngc", 0.005, 1.0)


def test_an_allowance_of_a_cone_takes_y(tmp_path: Path) -> None:
    text = program(
        TOP,
        ("radius: 10,", "radius: 10, taper: axis, at: 44,"),
        ("cutter: 20", "cutter: 17.04545, taper: 12.8043, allowance: 0.2"),
    )
    with pytest.raises(camgeo.RecipeErrors, match="no pass leaves any of a roller that is a cone or beside it"):
        exported(tmp_path, text)
    for remedy in (("[X, A]", "[X, Y, A]"), (", allowance: 0.2", "")):
        assert exported(tmp_path, changed(text, remedy)).ok


@pytest.mark.costly("a program is made, and judged twice")
def test_a_program_is_read_again(
    made: Callable[[str], tuple[Path, camgeo.Report]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, report = made(program())
    assert report.ok
    path, recipe = tmp_path / "other.nc", str(folder / "drum.yaml")
    path.write_text(words(folder), "ascii")
    assert main(["verify", recipe, str(path)]) == 0
    path.write_text(words(folder).replace("X20.000", "X20.200"), "ascii")
    assert main(["verify", recipe, str(path)]) == 1
    assert "contour" in capsys.readouterr().out
    path.write_text(words(folder).replace("M30", "G2 X1"), "ascii")
    assert main(["verify", recipe, str(path)]) == 1
    (tmp_path / "drum.yaml").write_text(GROOVE, encoding="utf-8")
    assert main(["verify", str(tmp_path / "drum.yaml"), str(path)]) == 2
    assert "no program is asked for" in capsys.readouterr().err


# --- rollers on arms, beside the axis, conical ------------------------------------------------------------------------


def cutting(text: str, share: float = 1.0, allowance: float | None = None) -> str:
    """Text of a drum whose file is a program of a cutter of the roller's cone, or smaller by a share, at its floor."""
    recipe = recipe_of(text)
    mm, roller = recipe.mm, recipe.roller
    cone = f", taper: {math.degrees(roller.taper)!r}" if roller.taper else ""
    more = f", allowance: {allowance / mm!r}" if allowance else ""
    size = 2.0 * roller.size(recipe.floor) * share
    options = (
        f"axes: [X, Y, A], cutter: {size / mm!r}{cone}{more}, feed: {300 / mm!r}, plunge: {60 / mm!r}, spindle: 2500, "
        f"safe_height: {5 / mm!r}"
    )
    return changed(text, ("[stl]", f"[{{gcode: {{{options}}}}}]"))


def stands_off(folder: Path, text: str, lift: Lift, places: int) -> float:
    """Greatest metal, mm, that positions of the cutter leave or take too deep at random places of each flank."""
    recipe = recipe_of(text)
    mm, mirrored, worst = recipe.mm, recipe.rotation == "ccw", 0.0
    own = recipe.export.files[0].own
    runs = [run * [mm, mm, mm, 1.0] for run in positions((folder / "drum.ngc").read_text("ascii"))]
    share = np.linspace(0.0, 1.0, 60, endpoint=False)
    rows = np.concatenate(
        [(run[:-1, None] + share[:, None] * np.diff(run, axis=0)[:, None]).reshape(-1, 4) for run in runs]
    )
    if mirrored:
        rows *= [1.0, -1.0, 1.0, -1.0]
    grows, rng = math.tan(own.get("taper", 0.0)), np.random.default_rng(places)
    for name, flank in shared_design(text).flanks.items():
        half = {"lower": 0.5, "upper": -0.5}[name] * getattr(recipe.track, "distance", 0.0)
        r, phi = rng.uniform(recipe.roller.inner, recipe.radius, places), rng.uniform(0.0, 6.28, places)
        z, at = envelope(lift.second(half), flank.side, flank.radius, r, phi)
        borne = r * np.cos(phi - at) >= recipe.roller.inner
        assert np.count_nonzero(borne) > 0.4 * places
        for radius, angle, height in zip(r[borne], phi[borne], z[borne] + recipe.level, strict=True):
            turn = angle - np.radians(rows[:, 3])
            along = radius * np.cos(turn)
            stands = (along >= rows[:, 2]) & (along > 0.0)
            size = 0.5 * own["cutter"] + (along - rows[:, 2]) * grows
            far = np.hypot(radius * np.sin(turn) - rows[:, 1], height - rows[:, 0])[stands] - size[stands]
            worst = max(worst, abs(float(far.min())) / math.hypot(1.0, grows))
    return worst


@pytest.mark.costly("brute force over the positions of a cutter")
@pytest.mark.parametrize("seed", few(range(len(LED)), 7, first=4))
def test_random_led_drums_are_milled_as_rollers_leave_them(tmp_path: Path, seed: int) -> None:
    rng = Random(seed)
    led, track = LED[(seed + seed // 7) % len(LED)], ("groove", "rib", "top", "bottom")[seed % 4]
    while True:
        inch, ccw = rng.random() < 0.5, rng.random() < 0.5
        text, lift = random_drum(rng, track, inch=inch, ccw=ccw, undercut=False, led=led)
        text = cutting(text, rng.choice([1.0, 0.98, 0.9]), rng.choice([None, 0.2]) if track != "groove" else None)
        with contextlib.suppress(camgeo.RecipeErrors):  # an arm that swings too far for its drum
            shared_design(text)
            break
    recipe = recipe_of(text)
    made = make(shared_design(text), Clock(), recipe.export.files[0], tmp_path / "drum.ngc")
    assert made.verdict is not None
    assert made.verdict.ok, (led, track, [str(check) for check in made.verdict.checks if not check.ok])
    assert stands_off(tmp_path, text, lift, 20) < recipe.export.tolerance + 2e-4


@pytest.mark.slow
@pytest.mark.parametrize("text", [ARM, LEADING, CONE, CONE_ON_ARM, BESIDE, RIB_ON_ARM], ids=lambda text: text[60:130])
def test_a_cutter_like_the_roller_stands_in_its_place(tmp_path: Path, text: str) -> None:
    """Of each position Y and X are those of the roller's axis at the angle A, within the tolerance between blocks."""
    text = cutting(text)
    design, recipe = shared_design(text), recipe_of(text)
    made = make(design, Clock(), recipe.export.files[0], tmp_path / "drum.ngc")
    assert made.verdict is not None
    assert made.verdict.ok, [str(check) for check in made.verdict.checks if not check.ok]
    words = (tmp_path / "drum.ngc").read_text("ascii")
    runs = positions(words)
    assert len(runs) == (2 if isinstance(recipe.track, Rib) else 1)
    for run, flank in zip(runs, design.flanks.values(), strict=False):
        pose = flank.pose(np.radians(run[2:-1, 3]))
        np.testing.assert_allclose(run[2:-1, 0], pose.z, atol=2e-4)
        np.testing.assert_allclose(run[2:-1, 1], pose.y, atol=2e-4)
        assert run[2, 2] == pytest.approx(recipe.floor, abs=1e-3)
    told = "at its end, half angle" in words
    assert told == bool(recipe.roller.taper)


@pytest.mark.slow
def test_a_cylinder_leaves_a_cone_in_steps(tmp_path: Path) -> None:
    """It takes as many depths as the tolerance asks for, each of which touches at its end."""
    text = changed(
        cutting(changed(CONE_ON_ARM, ("taper: 6", "taper: 2"), ("0.02", "0.1")), 0.95), (f", taper: {2.0!r}", "")
    )
    recipe = recipe_of(text)
    assert "taper" not in recipe.export.files[0].own
    made = make(shared_design(text), Clock(), recipe.export.files[0], tmp_path / "drum.ngc")
    assert made.verdict is not None
    assert made.verdict.ok
    depths = {float(run[1, 2]) for run in positions((tmp_path / "drum.ngc").read_text("ascii"))}
    assert 8 < len(depths) < 30
    steps = -np.diff(sorted(depths, reverse=True))
    most = max(flank.measured_error or 0.0 for flank in made.verdict.flanks)
    assert 0.8 * steps.max() * math.tan(math.radians(2.0)) < most < 0.05


# --- several turns ----------------------------------------------------------------------------------------------------


def several(text: str) -> DrumDesign:
    """A drum whose motion goes out in one turn and back in another."""
    segments = [Segment("rise", TURN, 40.0, law("cycloidal")), Segment("return", TURN, 40.0, law("polynomial-345"))]
    motion = programme(segments, 2.0 * TURN)
    return DrumDesign(replace(recipe_of(text), turns=2), motion, motion.periodic())


@pytest.mark.slow
@pytest.mark.parametrize("ccw", ["cw", "ccw"])
def test_a_program_goes_over_all_turns_of_the_motion(tmp_path: Path, ccw: str) -> None:
    design = several(f"rotation: {ccw}\n" + program())
    request = design.recipe.export.files[0]
    path = tmp_path / "drum.ngc"
    made = make(design, Clock(), request, path)
    assert made.verdict is not None
    assert made.verdict.ok, made.verdict.checks
    words = path.read_text("ascii")
    assert "(A goes on over all 2 turns of the motion)" in words
    for run in positions(words):
        turned = run[1:, 3]
        assert np.ptp(turned) == pytest.approx(725.0)
        assert (np.diff(turned) > 0.0).all()
        assert (turned.max() if ccw == "cw" else -turned.min()) == pytest.approx(725.0)
    # the second turn left out, one block left out, and the whole moved along
    lines = words.split("\n")
    cuts = [k for k, line in enumerate(lines) if line.startswith("G1 X")]
    beyond = [k for k in cuts if abs(float(lines[k].split("A")[1].split()[0])) > 366.0]
    for gone in (set(beyond), {beyond[len(beyond) // 4]}):
        path.write_text("\n".join(line for k, line in enumerate(lines) if k not in gone), "ascii")
        assert not judged_file(design, path, request, 1e-3).ok
    mirrored = re.sub(r" A(-?)", lambda found: " A" if found[1] else " A-", words)
    path.write_text(mirrored, "ascii")
    assert not judged_file(design, path, request, 0.02).ok


# --- ways -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [ARM, CONE_ON_ARM, BESIDE], ids=["arm", "cone on an arm", "beside"])
@pytest.mark.parametrize("share", [1.0, 0.8], ids=["alike", "smaller"])
def test_a_led_way_bends_no_more_than_its_bound(text: str, share: float) -> None:
    for flank in shared_design(text).flanks.values():
        own = Cutter(share * float(flank.size(37.5)), flank.taper)
        for way in (Way(flank, own, 44.0, beside=True, end=37.5), Way(flank, own, 44.0, beside=False, end=37.5)):
            if not (way.beside or way.alike):
                continue
            look, bound = way.bends(50.0)
            h = 1e-4
            for theta in np.linspace(0.01, 2.0, 60):
                a, x, y = way.places(np.array([theta - h, theta, theta + h]))
                second = [(row[0] - 2.0 * row[1] + row[2]) / h**2 for row in (a * 50.0, x, y)]
                k = int(np.searchsorted(look, theta)) - 1
                assert math.hypot(*second) <= bound[k - 1 : k + 2].max() * 1.01 + 1e-4
            assert bound.max() < 400.0


@pytest.mark.parametrize("text", [GROOVE, ARM, CONE_ON_ARM], ids=["radius", "arm", "cone on an arm"])
def test_a_contact_turns_no_faster_than_its_bound(text: str) -> None:
    flank, rho = shared_design(text).flanks["lower"], np.linspace(38.0, 50.0, 7)
    theta = np.linspace(0.0, TURN, 2001)
    angles = np.stack([flank.along(theta, np.full_like(theta, each)).angle for each in rho])
    found = np.abs(np.diff(angles, axis=0)).max(axis=1) / np.diff(rho)
    bound = contact_turns(flank, rho)
    assert (found <= bound).all()
    assert (bound < 1.3 * found).all()


@pytest.mark.parametrize("beside", [False, True])
@pytest.mark.parametrize("side", ["lower", "upper"])
def test_a_way_bends_no_more_than_its_bound(beside: bool, side: str) -> None:
    way = Way(design_of(GROOVE).flanks[side], Cutter(7.0), 42.0, beside)
    look, bound = way.bends(50.0)
    h = 1e-4
    for theta in np.linspace(0.01, 2.0, 60):
        a, x, y = way.places(np.array([theta - h, theta, theta + h]))
        second = [(row[0] - 2.0 * row[1] + row[2]) / h**2 for row in (a * 50.0, x, y)]
        k = int(np.searchsorted(look, theta)) - 1
        assert math.hypot(*second) <= bound[k - 1 : k + 2].max() * 1.01 + 1e-4
    assert bound.max() < 300.0


def test_a_smaller_cutter_is_off_as_brute_force_finds() -> None:
    """A helix of 30 degrees at 50: positions of the cutter along it, as near as they come to points of the flank."""
    flank, v = design_of(GROOVE).flanks["lower"], 50.0 * math.tan(math.radians(30.0))
    t = np.linspace(-0.4, 0.4, 400_001)

    def left(r: float, at: float) -> float:
        def of(radius: float, on: float) -> tuple[float, float]:
            apart = on**2 - v**2
            rho = math.sqrt(0.5 * (apart + math.sqrt(apart**2 + 4.0 * v * v * (on**2 - radius**2))))
            w = math.hypot(rho, v)
            return math.atan2(radius * v / w, rho), -radius * rho / w

        (f, g), (less, lower), (phi, z) = of(10.0, at), of(8.0, at), of(10.0, r)
        return float(np.hypot(r * np.sin(phi - (f - less) - t), z - (g - lower) - v * t).min()) - 8.0

    for at in (38.0, 44.0, 50.0):
        off = radially_off(flank, 8.0, v, at, (38.0, 50.0))
        inner, outer = left(38.0, at), left(50.0, at)
        for bound, true in ((off.left, inner), (off.deep, -outer)):
            assert max(true, 0.0) - 1e-9 <= bound <= 1.12 * max(true, 0.0) + 1e-9
    way, off = set_radially(flank, Cutter(8.0), v, (38.0, 50.0))
    assert off.left == pytest.approx(off.deep, rel=1e-3)
    assert 38.0 < way.at < 50.0


def test_depths_are_as_many_as_the_tolerance_asks_for() -> None:
    flank = design_of(GROOVE).flanks["lower"]
    counts = []
    for most in (0.02, 0.005, 0.0004):
        ways, off = set_beside(flank, Cutter(8.0), 37.5, (38.0, 50.0), most)
        assert off.left <= most
        assert ways[-1].end == 37.5
        assert [way.end for way in ways] == sorted((way.end for way in ways), reverse=True)
        counts.append(len(ways))
    assert counts == sorted(counts)
    assert counts[0] < counts[2] < 8


@pytest.mark.slow
@pytest.mark.parametrize("text", [GROOVE, ARM], ids=["carriage", "arm"])
def test_a_tolerance_that_is_not_judged(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused before anything is written, and the one that is told is made and judged; 4e6 points are many."""
    monkeypatch.setattr(cutters, "MOST_POINTS", 40_000)
    text = program(text, ("tolerance: 0.02", "tolerance: 0.001"))
    text = text if "arm:" not in text else changed(text, ("[X, A]", "[X, Y, A]"))
    with pytest.raises(
        RecipeErrors, match=r"export\.tolerance: what a program of this drum leaves is not judged"
    ) as told:
        exported(tmp_path, text)
    assert not (tmp_path / "out").exists()
    (finest,) = re.findall(r"given 0\.001 mm; give at least ([\d.]+) mm$", str(told.value))
    assert exported(tmp_path, changed(text, ("tolerance: 0.001", f"tolerance: {finest}"))).ok
    with pytest.raises(RecipeErrors, match="is not judged so finely"):
        exported(tmp_path, changed(text, ("tolerance: 0.001", f"tolerance: {0.9 * float(finest)}")))


@pytest.mark.parametrize("tolerance", ["0.00001", "0.0000001"])
def test_a_fine_tolerance_is_refused_at_once(
    tolerance: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drum.yaml").write_text(program(GROOVE, ("tolerance: 0.02", f"tolerance: {tolerance}")), "utf-8")
    assert main(["export", str(tmp_path / "drum.yaml"), "--out", str(tmp_path / "out")]) == 2
    assert "give at least 6.1e-05 mm" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
