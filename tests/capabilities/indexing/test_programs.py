# needs: milling
"""Programs of barrels: read by a few lines of their own, held against rollers by positions, judged, refused.

Holds: camgeo.capabilities.indexing.program, camgeo.machining.turned, camgeo.formats.turned, camgeo.fit.parted,
kin.indexing.program, kin.turned.checks, kin.turned.cutters, kin.turned.guide, kin.turned.moves.
"""

from __future__ import annotations

import functools
import math
import re
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import GLOBOID, advance, changed, design_of, random_indexer, window
from support.cases import few

import camgeo
from camgeo.capabilities.indexing.checks_of import design_checks
from camgeo.capabilities.indexing.figures import figures_of
from camgeo.capabilities.indexing.making import foresee, make
from camgeo.capabilities.indexing.program import write_program
from camgeo.capabilities.indexing.verdicts import intended, judged_file
from camgeo.cli.main import main
from camgeo.common.clock import Clock
from camgeo.machining.turned import cutting_of
from camgeo.schema.errors import RecipeErrors
from kin.indexing.program import verify_program
from kin.numeric.limits import Limits
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.design import IndexDesign
    from kin.turned.verdict import TurnedVerdict

OPTIONS = "axes: [X, Y, A], cutter: 18, feed: 300, plunge: 60, spindle: 2500, depth_of_cut: 7, safe_height: 5"
EIGHT = f"""cam:
  kind: indexing
  barrel: {{radius: 50}}
  depth: 13
  turret: {{stops: 8, radius: 60, roller: 9}}
  motion: [{{rise: 45, over: 180, law: cycloidal}}, {{dwell: 180}}]
part: {{length: 80, bore: 24}}
export: {{tolerance: 0.01, files: [{{gcode: {{{OPTIONS}}}}}]}}
"""
QUICK = changed(
    EIGHT,
    ("stops: 8", "stops: 6"),
    ("rise: 45, over: 180", "rise: 60, over: 150"),
    ("dwell: 180", "dwell: 210"),
    ("tolerance: 0.01", "tolerance: 0.002"),
)


@functools.cache
def written(text: str) -> tuple[IndexDesign, str]:
    """Design of a text, and its program."""
    design = design_of(text)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "index.ngc"
        made = make(design, Clock(), design.recipe.export.files[0], path)
        assert made.verdict is not None
        assert made.verdict.ok, [str(check) for check in made.verdict.checks if not check.ok]
        return design, path.read_text("ascii")


def judged(folder: Path, text: str, words: str) -> TurnedVerdict:
    """Verdict on a program by the recipe of a text."""
    design, path = written(text)[0], folder / "index.ngc"
    path.write_text(words, "ascii")
    return judged_file(design, path, design.recipe.export.files[0], design.recipe.export.tolerance)


def failing(verdict: TurnedVerdict) -> set[str]:
    return {check.name for check in verdict.checks if not check.ok}


def blocks(words: str) -> np.ndarray:
    """Rows (n, 2, 4) of X, Y, Z and A, mm and degrees, before and after each feed move, by their letters alone."""
    at, rows = dict.fromkeys("XYZA", 0.0), []
    for line in re.sub(r"\([^)]*\)", "", words).splitlines():
        if line.startswith(("G0 ", "G1 ")):
            before = list(at.values())
            at |= {letter: float(value) for letter, value in re.findall(r"([XYZA])(-?[\d.]+)", line)}
            if line.startswith("G1"):
                rows.append([before, list(at.values())])
    return np.array(rows)


def altered(words: str, axis: str, change: Callable[[float], float]) -> str:
    """A program with another word of an axis in each block."""
    return re.sub(
        rf"^(G[01] .*?{axis})(-?[\d.]+)",
        lambda found: f"{found[1]}{change(float(found[2])):.9f}",
        words,
        flags=re.MULTILINE,
    )


CASES = {
    "as large as the roller": (EIGHT, 0.0, 1.0),
    "smaller, with a clearance": (
        changed(EIGHT, ("roller: 9}", "roller: 9, clearance: 0.04}"), ("cutter: 18", "cutter: 16")),
        0.04,
        1.0,
    ),
    "with a preload, mirrored": (
        "rotation: ccw\n"
        + changed(EIGHT, ("roller: 9}", "roller: 9, preload: 0.02}"), ("cutter: 18", "cutter: 17.96")),
        -0.02,
        -1.0,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_the_cutter_takes_what_rollers_take(case: str) -> None:
    """Random places of the blank are as far from the cutter at all its positions as from the rollers of a flank."""
    text, clearance, sense = CASES[case]
    rows = blocks(written(text)[1])
    cutter = 0.5 * float(re.findall(r"cutter: ([\d.]+)", text)[0])
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[:, None, None]
    x, y, z, a = (rows[:, 0] + share * (rows[:, 1] - rows[:, 0])).reshape(-1, 4).T
    rng = np.random.default_rng(3)
    offset, pitch = 30.0 * (1.0 + math.cos(math.pi / 8.0)), 60.0
    theta = window(8)
    psi = advance(theta, 8, 180.0) - math.pi / 8.0
    found = []
    for _ in range(250):
        r, phi, height = rng.uniform(40.0, 50.0), rng.uniform(0.0, math.tau), rng.uniform(1.0, 79.0)
        turn = phi - theta
        across = r * np.sin(turn) - offset + pitch * np.cos(psi)
        up = height - 40.0 - pitch * np.sin(psi)
        radius = 9.0 + np.where(up > 0.0, clearance, 0.0)
        there = (r * np.cos(turn) >= 37.5) & (np.abs(psi) < 0.5 * math.pi)
        off = np.min(np.hypot(across, up)[there] - radius[there], initial=9.0)
        turn = sense * phi - np.radians(a)
        there = (r * np.cos(turn) >= np.maximum(z, 37.5)) & (z < 50.0)
        own = np.min(np.hypot(r * np.sin(turn) - y, height - x)[there] - cutter, initial=9.0)
        if abs(off) < 1.5:
            found.append((off, own))
    off, own = np.array(found).T
    assert len(off) > 20
    assert np.abs(off - own)[off > 0.0].max() < 0.02  # outside both
    assert own[off < -0.05].max() < 0.0


def test_a_program_says_how_it_is_meant() -> None:
    lines = written(EIGHT)[1].splitlines()
    for told in (
        "(cutter: diameter 18, its axis square to the barrel's)",
        "(X zero: the lower face; X grows along the barrel's axis, towards the upper face)",
        "(A zero: the radius that faces the turret at shaft angle 0, from which the keyway's angle counts)",
        "(A grows as the cutter goes round the barrel counter-clockwise, seen from the upper face)",
        "(the turret goes round it counter-clockwise)",
        "(Z zero: the barrel's axis; blank 50, floor 37)",
        "(groove, pass 2 of 2)",
    ):
        assert told in lines
    rows = blocks(written(EIGHT)[1])
    down = rows[:, 0, 2] != rows[:, 1, 2]
    # it goes down beside the end faces, and cuts out through the other one
    assert all(x <= -9.0 or x >= 89.0 for x in rows[down, 0, 0])
    assert {rows[-1, 1, 0] >= 89.0, rows[-1, 1, 0] <= -9.0} == {True, False}
    # it is where the roller is at the angle 0 and after four turns' worth of stops on the way
    at = rows[np.argmin(np.abs(rows[:, 1, 3])), 1]
    psi = advance(np.radians(at[3:]), 8, 180.0)[0] - math.pi / 8.0
    offset = 30.0 * (1.0 + math.cos(math.pi / 8.0))
    np.testing.assert_allclose(at[:2], [40.0 + 60.0 * math.sin(psi), offset - 60.0 * math.cos(psi)], atol=2e-4)
    # each block takes its length at the blank over 300 mm a minute
    feeds = [float(feed) for feed in re.findall(r"^G1 X\S+ Y\S+ A\S+ F(\S+)$", written(EIGHT)[1], re.MULTILINE)]
    way = (rows[:, 1] - rows[:, 0])[~down]
    far = np.sqrt(way[:, 0] ** 2 + way[:, 1] ** 2 + (50.0 * np.radians(way[:, 3])) ** 2)
    np.testing.assert_allclose(np.array(feeds) * far, 300.0, rtol=1e-5)


@pytest.mark.slow
def test_an_allowance_is_left_by_all_but_the_last_pass() -> None:
    words = written(changed(EIGHT, ("cutter: 18", "cutter: 16, allowance: 0.3")))[1]
    names = [line for line in words.splitlines() if " pass " in line]
    assert [name.split(",")[0] for name in names[:2]] == ["(lower flank", "(upper flank"]
    assert "rough" in names[3]
    assert "last" in names[4]
    # in the dwell, where a flank is square to X, the first cut is 0.3 mm less than the last
    rows = blocks(words)
    deep = {
        z: rows[(rows[:, 1, 2] == z) & (np.abs(rows[:, 1, 3] + 90.0) < 0.3), 1, 0] for z in np.unique(rows[:, 1, 2])
    }
    first, last = deep[43.5], deep[37.0]
    assert last.max() - first.max() == pytest.approx(0.3, abs=0.02)
    assert first.min() - last.min() == pytest.approx(0.3, abs=0.02)


def _without(words: str, count: int) -> str:
    lines = words.splitlines()
    middle = (len(lines) + next(k for k, line in enumerate(lines) if "pass 2" in line)) // 2
    return "\n".join(lines[:middle] + lines[middle + count :]) + "\n"


def _half(words: str) -> str:
    lines = words.splitlines()
    middle = (len(lines) + next(k for k, line in enumerate(lines) if "pass 2" in line)) // 2
    return "\n".join([*lines[:middle], "G0 Z55", "M5", "M30"]) + "\n"


FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "blocks left out": (lambda words: _without(words, 40), "ways"),
    "a block left out": (lambda words: _without(words, 1), "feed"),
    "Y the other way": (lambda words: altered(words, "Y", lambda y: -y), "ways"),
    "A the other way": (lambda words: altered(words, "A", lambda a: -a), "ways"),
    "X beside its place": (lambda words: altered(words, "X", lambda x: x + 0.012), "contour"),
    "a depth left out": (lambda words: words[: words.index("(groove, pass 2")] + "M5\nM30\n", "depth"),
    "the way of a stop left out": (_half, "contour"),
    "down in the metal": (lambda words: words.replace("X-9.9", "X19.9", 1), "ways"),
    "fast in the metal": (lambda words: words.replace("G1 Z", "G0 Z", 1), "rapid"),
}


@pytest.mark.thin(3)
@pytest.mark.costly("what is left is looked at for each fault")
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(tmp_path: Path, fault: str) -> None:
    words, (plant, check) = written(EIGHT)[1], FAULTS[fault]
    planted = plant(words)
    assert planted != words
    assert check in failing(judged(tmp_path, EIGHT, planted))


@pytest.mark.slow
def test_whole_turns_cut_the_same(tmp_path: Path) -> None:
    """A barrel that is turned on by whole turns, at each depth by more of them, is the same barrel."""
    words = written(EIGHT)[1]
    head, *passes = re.split(r"(?m)^(?=\(.*pass \d)", words)
    assert len(passes) > 1
    turned = [altered(one, "A", (1080.0 * k - 720.0).__add__) for k, one in enumerate(passes)]
    verdict = judged(tmp_path, EIGHT, "".join([head, *turned]))
    assert not failing(verdict), [str(check) for check in verdict.checks if not check.ok]


@pytest.mark.slow
def test_words_too_coarse_and_a_smaller_cutter_are_refused(tmp_path: Path) -> None:
    """What rounding A to 0.01 degrees may take moves the cutter by 4 um where the turret is fast; 2 are permitted."""
    words = written(QUICK)[1]
    assert judged(tmp_path, QUICK, words).ok
    assert failing(judged(tmp_path, QUICK, altered(words, "A", lambda a: a + 0.005))) & {"contour", "ways"}
    design, path = written(QUICK)[0], tmp_path / "small.ngc"
    path.write_text(words.replace("diameter 18", "diameter 17.95"), "ascii")
    cutting = cutting_of(design.recipe.export.files[0], 13.0)
    verdict = verify_program(path, intended(design), replace(cutting, radius=8.975), Limits(0.01))
    assert failing(verdict) >= {"contour", "form-closure"}
    contours = [check.value for check in verdict.checks if check.name == "contour"]
    assert contours == pytest.approx([0.025, 0.025], abs=0.003)


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    "row",
    [
        ([("[X, Y, A]", "[X, A]")], "and so does the cutter", ("[X, A]", "[X, Y, A]")),
        ([("cutter: 18", "cutter: 18.1")], "a cutter wider than the smaller roller", ("18.1", "18")),
        (
            [("roller: 9}", "roller: 9, preload: 0.01}")],
            "give at most 17.98 mm",
            ("cutter: 18", "cutter: 17.98"),
        ),
        ([("cutter: 18", "cutter: 8")], "does not clear the groove along both flanks", ("cutter: 8", "cutter: 9.02")),
        ([("cutter: 18", "cutter: 18, allowance: 0.2")], "give at most 17.6 mm", ("cutter: 18", "cutter: 17.6")),
        (
            [("cutter: 18", "cutter: 18, allowance: 6")],
            "give an allowance below 4.49",
            ("cutter: 18, allowance: 6", "cutter: 18"),
        ),
        ([("cutter: 18, ", "")], "gcode.cutter: missing", ("A],", "A], cutter: 18,")),
        (
            [(f"{{gcode: {{{OPTIONS}}}}}", "gcode")],
            "a program needs its machine and cutter",
            ("[gcode]", f"[{{gcode: {{{OPTIONS}}}}}]"),
        ),
        (
            [("cutter: 18", "cutter: 18, decimals: 2"), ("0.01", "0.004")],
            "give at least 3",
            ("decimals: 2", "decimals: 3"),
        ),
        ([("safe_height: 5", "safe_height: 1e6")], "give at most 9.999e+05 mm", ("1e6", "9.999e+05")),
        ([("feed: 300", "feed: 1e-6")], "too little for a program", ("feed: 1e-6", "feed: 300")),
        (
            [("depth_of_cut: 7", "depth_of_cut: 1e-3")],
            "makes more than 2000 passes",
            ("depth_of_cut: 1e-3", "depth_of_cut: 7"),
        ),
        (
            [("tolerance: 0.01", "tolerance: 1e-5")],
            "what a program of this barrel leaves is not judged so finely",
            ("1e-5", "0.01"),
        ),
        (
            [("part:", "manufacture: {cutter: 8}\npart:")],
            "a program of a barrel has its cutter",
            ("manufacture: {cutter: 8}\n", ""),
        ),
    ],
)
def test_what_no_program_is_made_of_has_a_remedy(tmp_path: Path, row: tuple) -> None:
    pairs, problem, remedy = row
    text = changed(EIGHT, *pairs)

    def made(text: str) -> None:
        design = design_of(text)
        request = design.recipe.export.files[0]
        foresee(design, request)
        write_program(design, request, tmp_path / "index.ngc", design.recipe.tolerance(request), 1.0)

    with pytest.raises(RecipeErrors, match=re.escape(problem)):
        made(text)
    made(changed(text, remedy))


def test_a_globoid_has_no_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "globoid.yaml"
    path.write_text(changed(GLOBOID, ("[stl]", f"[{{gcode: {{{OPTIONS}}}}}]")), encoding="utf-8")
    assert main(["export", str(path)]) == 2
    told = capsys.readouterr().err
    assert "no program is made of a globoid: its rollers swing" in told
    assert "export.files[0]" in told
    assert "give stl, 3mf or ply" in told
    path.write_text(GLOBOID, encoding="utf-8")
    (tmp_path / "globoid.ngc").write_text(written(EIGHT)[1], "ascii")
    assert main(["verify", str(path), str(tmp_path / "globoid.ngc")]) == 2
    assert "no program is made of a globoid" in capsys.readouterr().err


@pytest.mark.slow
def test_a_program_of_another_origin_needs_a_cutter(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, program = tmp_path / "index.yaml", tmp_path / "other.ngc"
    program.write_text(written(EIGHT)[1], "ascii")
    path.write_text(changed(EIGHT, (f"{{gcode: {{{OPTIONS}}}}}", "stl")), encoding="utf-8")
    assert main(["verify", str(path), str(program)]) == 2
    assert "a program is judged by its cutter" in capsys.readouterr().err
    path.write_text(EIGHT, encoding="utf-8")
    assert main(["verify", str(path), str(program)]) == 0


@pytest.mark.costly("an export in inches")
def test_inches_and_a_feed_by_the_minute(tmp_path: Path) -> None:
    text = "units: inch\n" + changed(EIGHT, ("18, feed", "18, feed_mode: per-minute, feed"), ("0.01", "0.05"))
    named = "radius|depth|roller|length|bore|cutter|feed|plunge|depth_of_cut|safe_height|tolerance"
    (tmp_path / "index.yaml").write_text(re.sub(rf"\b({named}): ([\d.]+)", r"\1: \2 mm", text), encoding="utf-8")
    report = camgeo.export(tmp_path / "index.yaml", tmp_path / "out")
    assert report.ok, [str(check) for check in report.checks if not check.ok]
    lines = (tmp_path / "out" / "index" / "index.ngc").read_text("ascii").splitlines()
    assert "G20" in lines
    assert "G17 G90 G94" in lines
    assert sum(" F11.8110" in line for line in lines) == 2


@pytest.mark.slow
@pytest.mark.parametrize("seed", few(range(12, 22), 10))
def test_random_barrels_are_milled(tmp_path: Path, seed: int) -> None:
    """A random barrel on which a roller always bears has a program that leaves it; the judge sees where none does."""
    rng = Random(seed)
    text = random_indexer(rng, "barrel", inch=False, ccw=rng.random() < 0.5)
    roller = float(re.findall(r"roller: ([\d.]+)", text)[0])
    preload = 0.01 if "preload" in text else 0.0
    cutter = 2.0 * (roller - preload) * rng.choice([1.0, 1.0, 0.95, 0.8])
    own = f"axes: [X, Y, A], cutter: {cutter!r}, feed: 300, plunge: 60, spindle: 2500, safe_height: 5"
    own += rng.choice(["", ", feed_mode: per-minute"])
    text = changed(text, ("[stl]", f"[{{gcode: {{{own}}}}}]"))
    try:
        design = design_of(text)
    except RecipeErrors:
        return  # no sound cam
    made = make(design, Clock(), design.recipe.export.files[0], tmp_path / "index.ngc")
    assert made.verdict is not None
    (bears,) = [check.value for check in design_checks(design, figures_of(design)) if check.name == "contact-length"]
    assert made.verdict.ok == (bears > 0.0), (text, [str(check) for check in made.verdict.checks if not check.ok])
