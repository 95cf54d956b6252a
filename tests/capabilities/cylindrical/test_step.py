"""STEP of drums: splines within their bound, solids that another kernel accepts, and files with planted faults.

Holds: camgeo.capabilities.cylindrical.bicubic, camgeo.capabilities.cylindrical.brep, kin.cylindrical.exact.
"""

from __future__ import annotations

import math
import re
import sys
from functools import cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import (
    ARM,
    BESIDE,
    BOTTOM,
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
)
from capabilities.cylindrical.positions import Lift, envelope, off_flank
from capabilities.cylindrical.test_files import demand_foreseen, exported
from capabilities.cylindrical.test_random_drums import rollers
from support.kernel import kernel

import camgeo
from camgeo.capabilities.cylindrical import brep
from camgeo.capabilities.cylindrical.bicubic import bicubics
from camgeo.capabilities.cylindrical.brep import drum_solid
from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.figures import volume
from camgeo.capabilities.cylindrical.making import foresee
from camgeo.capabilities.cylindrical.verdicts import intended, judged_file
from camgeo.common.clock import Clock
from camgeo.files.errors import MissingExtraError
from camgeo.fit.nodes import ToleranceError
from camgeo.formats.step import write_shape
from camgeo.schema.errors import RecipeErrors
from kin.cylindrical.exact import verify_surfaces
from kin.numeric.limits import Limits
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.cylindrical.bicubic import Bicubic
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from kin.turned.verdict import TurnedVerdict

TURN = 2.0 * math.pi
FINE = 0.003  # mm
ROWS = [("rise", 40.0, 120.0, "cycloidal"), ("dwell", 0.0, 60.0, ""), ("return", 40.0, 120.0, "polynomial-345")]
LIFT = Lift([*ROWS, ("dwell", 0.0, 60.0, "")])
STEP = changed(GROOVE, ("12.5}", "12.5, clearance: 0.03}"), ("[stl]", "[step]"))
C01 = changed(STEP, ("tolerance: 0.02", "tolerance: 0.001"))


# --- splines ----------------------------------------------------------------------------------------------------------


def basis(knots: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Cubic B-splines (n, 2 k) over k knots that count twice within, four times at both ends, by the recursion."""
    every = np.concatenate([[knots[0]] * 2, np.repeat(knots, 2), [knots[-1]] * 2])
    found = ((every[:-1] <= t[:, None]) & (t[:, None] < every[1:])).astype(float)
    found[t == knots[-1], np.flatnonzero(np.diff(every) > 0.0)[-1]] = 1.0
    for degree in range(1, 4):
        width = every[degree:] - every[:-degree]
        with np.errstate(divide="ignore", invalid="ignore"):
            rise = np.where(width > 0.0, (t[:, None] - every[:-degree]) / width, 0.0)
        found = rise[:, :-1] * found[:, :-1] + (1.0 - rise[:, 1:]) * (width[1:] > 0.0) * found[:, 1:]
    return found


def on_spline(part: Bicubic, share: np.ndarray) -> np.ndarray:
    """Places (n, m, 3) on a spline at shares of both parameters."""
    theta = part.theta[0] + share * (part.theta[-1] - part.theta[0])
    r = part.r[0] + share[::7] * (part.r[-1] - part.r[0])
    return np.einsum("ia,jb,abx->ijx", basis(part.theta, theta), basis(part.r, r), part.control)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.1, 0.002])
def test_splines_are_as_near_all_rollers_as_is_proved(tolerance: float) -> None:
    design = design_of(GROOVE)
    share = np.random.default_rng(5).uniform(0.0, 1.0, 61)
    for name, flank in design.flanks.items():
        parts, off = bicubics(flank, (37.5, 50.0), tolerance, (0.0, 0.5 * TURN))
        assert 0.5 * tolerance < off <= tolerance
        assert [part.theta[[0, -1]].tolist() for part in parts] == [[0.0, 0.5 * TURN], [0.5 * TURN, TURN]]
        worst = 0.0
        for part in parts:
            places = on_spline(part, share).reshape(-1, 3)
            r, phi = np.hypot(places[:, 0], places[:, 1]), np.arctan2(places[:, 1], places[:, 0])
            side = -1 if name == "lower" else 1
            z, at = envelope(LIFT, side, 10.0, r, phi)
            lean = np.sqrt(np.maximum(100.0 - (r * np.sin(phi - at)) ** 2, 0.0)) / 10.0
            worst = max(worst, float(np.abs((places[:, 2] - 20.0 - z) * lean).max()))
        # of what is proved most lies along the flank
        assert 0.01 * off < worst < off


def test_two_parts_go_on_smoothly_and_end_on_their_cylinders() -> None:
    design = design_of(GROOVE)
    (first, second), off = bicubics(design.flanks["lower"], (37.5, 50.0), 0.01, (0.3, 2.0))
    assert first.theta[0] == 0.3
    assert first.theta[-1] == second.theta[0] == 2.0
    assert second.theta[-1] == pytest.approx(0.3 + TURN, abs=1e-15)
    for before, behind in ((first, second), (second, first)):
        assert before.control[-1] == pytest.approx(behind.control[0], abs=1e-12)
        ways = [
            (part.control[a] - part.control[b]) / np.diff(part.theta)[k]
            for part, a, b, k in ((before, -1, -2, -1), (behind, 1, 0, 0))
        ]
        assert ways[0] == pytest.approx(ways[1], abs=1e-9)
    for row, radius in ((0, 37.5), (-1, 50.0)):
        t = np.linspace(first.theta[0], first.theta[-1], 300)
        line = basis(first.theta, t) @ first.control[:, row]
        assert np.abs(np.hypot(line[:, 0], line[:, 1]) - radius).max() < off


def test_splines_end_where_the_acceleration_jumps() -> None:
    design = design_of(GROOVE.replace("cycloidal", "harmonic"))
    parts, _ = bicubics(design.flanks["lower"], (37.5, 50.0), 0.01, (0.0, 0.5 * TURN))
    # the harmonic rise begins and ends with a jump; the return of a polynomial does not
    assert [part.theta[0] for part in parts] == pytest.approx(np.radians([0.0, 120.0, 180.0]), abs=1e-12)


def test_a_tolerance_that_is_too_small_names_one_that_serves() -> None:
    flank, ends = design_of(GROOVE).flanks["lower"], (37.5, 50.0)
    with pytest.raises(ToleranceError, match="too many control points; give at least") as caught:
        bicubics(flank, ends, 1e-9, (0.0, 3.0))
    least = caught.value.reached
    assert bicubics(flank, ends, 1.01 * least, (0.0, 3.0))[1] <= 1.01 * least
    with pytest.raises(ToleranceError, match="double precision"):
        bicubics(flank, ends, 1e-15, (0.0, 3.0))


@pytest.mark.costly("the lowest of all rollers at places of flanks of each follower")
@pytest.mark.thin(2)
@pytest.mark.parametrize("led", LED[1:])
def test_splines_of_other_followers_are_as_near_all_rollers_as_is_proved(led: str) -> None:
    seed = 60 + LED.index(led)
    text, lift = random_drum(Random(seed), ("groove", "rib")[seed % 2], inch=False, ccw=False, undercut=False, led=led)
    design = design_of(text)
    recipe, share = design.recipe, np.random.default_rng(seed).uniform(0.0, 1.0, 61)
    for flank, roller in zip((design.flanks[name] for name in ("lower", "upper")), rollers(recipe, lift), strict=True):
        parts, off = bicubics(flank, (recipe.floor, recipe.radius), 0.02, (0.0, 0.5 * TURN))
        assert off <= 0.02
        places = np.concatenate([on_spline(part, share).reshape(-1, 3) for part in parts])
        worst = float(np.abs(off_flank(*roller, recipe.level, places)).max())
        assert 0.01 * off < worst < off


# --- the recipe -------------------------------------------------------------------------------------------------------


@pytest.mark.costly("undercut is sought")
def test_a_shortened_flank_is_refused() -> None:
    recipe = recipe_of(changed(UNDERCUT, ("[stl]", "[step]")))
    with pytest.raises(RecipeErrors, match=r"export.files\[0\]: a flank that an undercut shortens") as caught:
        foresee(cut_short(recipe), recipe.export.files[0])
    assert "give stl, 3mf or ply" in str(caught.value)


def test_without_the_kernel_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    recipe = recipe_of(STEP)
    monkeypatch.setitem(sys.modules, "OCP", None)
    with pytest.raises(MissingExtraError, match=r"pip install '.\[step\]'"):
        foresee(designed(recipe, Clock()), recipe.export.files[0])


# --- solids, by the kernel --------------------------------------------------------------------------------------------


def solids_of(path: Path) -> tuple[bool, float]:
    """Whether the kernel finds what it reads sound, and its volume, mm^3."""
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    shape = read_by_kernel(path)
    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, found, 1e-6)
    return BRepCheck_Analyzer(shape).IsValid(), found.Mass()


def read_by_kernel(path: Path) -> object:
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return reader.OneShape()


def resaved(path: Path, other: Path) -> Path:
    """The file as the kernel writes what it read."""
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    writer = STEPControl_Writer()
    writer.Transfer(read_by_kernel(path), STEPControl_StepModelType.STEPControl_AsIs)
    writer.Write(str(other))
    return other


def written(folder: Path, text: str, tolerance: float) -> tuple[Path, DrumDesign, float]:
    design = design_of(text)
    solid = drum_solid(design, tolerance)
    write_shape(folder / "drum.step", solid.shape, name="drum")
    return folder / "drum.step", design, solid.off


def judged(path: Path, design: DrumDesign, tolerance: float) -> TurnedVerdict:
    return judged_file(design, path, None, tolerance)


def refused(verdict: TurnedVerdict) -> set[tuple[str, str]]:
    return {(check.name, check.surface) for check in verdict.checks if not check.ok}


# a cut at the first break of the motion lies just beside a jump of the acceleration on the upper flank
NARROW = """cam:
  kind: cylindrical
  radius: 60
  track: {rib: {distance: 36, depth: 12}}
  follower: {radius: 9, taper: 5, arm: {length: 90, offset: -88.6, pivot: 50, side: leading}}
  pitch_height: 34.4
  motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}, {return: 20, over: 120, law: harmonic}, {dwell: 60}]
part: {length: 90, bore: 30}
export: {tolerance: 0.005, files: [step]}
"""
TRACKS = {
    "groove": STEP,
    "rib": RIB,
    "top": "rotation: ccw\n" + TOP,
    "bottom": BOTTOM,
    "jump": "rotation: ccw\n" + GROOVE.replace("cycloidal", "harmonic").replace(", keyway: din6885", ""),
    "no bore": TOP.replace(", bore: 24, keyway: din6885", ""),
    "arm": ARM,
    "leading": "rotation: ccw\n" + LEADING.replace("cycloidal", "harmonic"),
    "cone on an arm": CONE_ON_ARM,
    "rib on an arm": RIB_ON_ARM,
    "cone": "rotation: ccw\n" + CONE,
    "beside": BESIDE,
    "narrow": NARROW,
}
RESAVED = "groove", "rib", "bottom", "cone on an arm"  # as the kernel writes what it has read


@kernel
@pytest.mark.slow
@pytest.mark.parametrize("track", TRACKS)
def test_another_kernel_takes_the_solid_and_kin_both_files(tmp_path: Path, track: str) -> None:
    tolerance = 0.05 if track == "groove" else 0.005
    path, design, off = written(tmp_path, TRACKS[track], tolerance)
    sound, measured = solids_of(path)
    assert sound
    exact = volume(design)
    assert measured == pytest.approx(exact, abs=0.1 * tolerance * 50_000)
    for file in (path, resaved(path, tmp_path / "again.step")) if track in RESAVED else (path,):
        verdict = judged(file, design, tolerance)
        assert verdict.ok, [check for check in verdict.checks if not check.ok]
        assert all(flank.measured_error <= off for flank in verdict.flanks)
        assert all(flank.motion.remainder < 0.2 * tolerance for flank in verdict.flanks)


@kernel
@pytest.mark.slow
def test_a_part_that_is_narrower_than_deep_is_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(brep, "APART", 0.0)
    path, design, _ = written(tmp_path, NARROW, 0.001)
    verdict = judged(path, design, 0.001)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]


@kernel
@pytest.mark.slow  # solids by the kernel, and whole verdicts
@pytest.mark.parametrize("seed", range(6))
def test_random_drums_of_other_followers(tmp_path: Path, seed: int) -> None:
    chance, led = Random(seed), LED[1 + seed % 6]
    track = ("groove", "rib", "top", "bottom")[(seed // 6 + seed) % 4]
    tolerance = (0.1, 0.02, 0.005)[seed % 3]
    while True:  # drawn again where the drum is undercut
        text, _ = random_drum(chance, track, inch=seed % 3 == 0, ccw=seed % 2 == 1, undercut=False, led=led)
        try:
            path, design, off = written(tmp_path, text, tolerance)
            break
        except RecipeErrors as error:
            if "undercut" not in str(error):
                raise
    sound, measured = solids_of(path)
    assert sound
    assert measured == pytest.approx(volume(design), abs=0.1 * tolerance * 50_000)
    verdict = judged(path, design, tolerance)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert max(flank.measured_error for flank in verdict.flanks) <= off


@kernel
@pytest.mark.slow
def test_a_recipe_with_a_step_file(tmp_path: Path) -> None:
    report = exported(tmp_path, C01)
    assert report.ok
    demand_foreseen(tmp_path, report)
    path = tmp_path / "out" / "drum" / "drum.step"
    assert path.stat().st_size < 2_000_000
    found: Any = dict(report)
    (file,) = found["files"]
    assert file["pieces"] > 100
    assert file["geometry_error"] <= 0.001
    assert max(surface["measured_error"] for surface in file["surfaces"]) <= file["geometry_error"]
    (play,) = file["play"]
    # the clearance over cos a at the outer end, where S' is 38.2 at most
    assert play["min"] == pytest.approx(0.03, abs=1e-3)
    assert play["max"] == pytest.approx(0.03 * math.hypot(1.0, 38.2 / 50.0), abs=1e-3)
    assert camgeo.verify(tmp_path / "drum.yaml", path).ok


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, DrumDesign, Path]:
    """Text of a sound file of c01's end cam, its design, and a folder."""
    pytest.importorskip("OCP")
    folder = tmp_path_factory.mktemp("step")
    path, design, _ = written(folder, TOP, FINE)
    return path.read_text(encoding="latin-1"), design, folder


def surface_points(text: str, which: int) -> list[str]:
    """Numbers of the control points of a B-spline surface, row by row."""
    return re.findall(
        r"#\d+", re.findall(r"B_SPLINE_SURFACE_WITH_KNOTS\('',3,3,\((.*?)\),\.UNSPEC", text, re.DOTALL)[which]
    )


def moved(text: str, numbers: list[str], along: tuple[float, float, float]) -> str:
    """The text with points moved."""
    wanted = set(numbers)

    def shift(found: re.Match[str]) -> str:
        if found[1] not in wanted:
            return found[0]
        x, y, z = (float(part) + by for part, by in zip(found[2].split(","), along, strict=True))
        return f"{found[1]} = CARTESIAN_POINT('',({x!r},{y!r},{z!r}))"

    return re.sub(r"(#\d+) = CARTESIAN_POINT\('',\(([^)]*)\)\)", shift, text)


def without_a_face(text: str) -> str:
    return changed_once(text, r"(CLOSED_SHELL\('',\(#\d+),#\d+", r"\1")


def with_a_sense(text: str) -> str:
    return changed_once(text, r"(ADVANCED_FACE\('',\(#\d+(?:,\s*#\d+)*\),#\d+,)\.T\.", r"\1.F.")


def with_a_bound(text: str) -> str:
    return changed_once(text, r"(FACE_BOUND\('',#\d+,)\.F\.", r"\1.T.")


def changed_once(text: str, pattern: str, replacement: str) -> str:
    found, number = re.subn(pattern, replacement, text, count=1)
    assert number == 1, pattern
    return found


def inside(text: str, which: int) -> str:
    """A control point within a surface, off its borders."""
    points = surface_points(text, which)
    return points[len(points) // 2 + 5]


FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "a surface shifted by 0.01 along the axis": (lambda t: moved(t, surface_points(t, 0), (0.0, 0.0, 0.01)), "contour"),
    "a surface shifted by 0.01 across": (lambda t: moved(t, surface_points(t, 0), (0.01, 0.0, 0.0)), "contour"),
    "a control point moved by 0.05": (lambda t: moved(t, [inside(t, 1)], (0.0, 0.0, 0.05)), "contour"),
    "a face left out": (without_a_face, "watertight"),
    "a face that looks inward": (with_a_sense, "watertight"),
    "a bound that runs the other way": (with_a_bound, "watertight"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(sound: tuple[str, DrumDesign, Path], fault: str) -> None:
    text, design, folder = sound
    spoil, name = FAULTS[fault]
    path = folder / "spoilt.step"
    path.write_text(spoil(text), encoding="latin-1")
    assert name in {each for each, _ in refused(judged(path, design, FINE))}


STEEP = """
cam:
  kind: cylindrical
  radius: 70
  track: {rib: {distance: 42, depth: 14}}
  follower: {radius: 11, arm: {length: 110, offset: 108.5, pivot: 60}}
  pitch_height: 43
  motion:
    - {rise: 18, over: 110, law: modified-sine}
    - {dwell: 70}
    - {return: 18, over: 130, law: cycloidal}
    - {dwell: 50}
part: {length: 110, bore: 32}
export: {tolerance: 1, files: [step]}
"""


@pytest.mark.slow
def test_a_coarse_solid_of_a_rib_on_an_arm_is_told(tmp_path: Path) -> None:
    """Its rollers stand so aslant that those shifted by half of the tolerance touch it otherwise."""
    pytest.importorskip("OCP")
    path, design, _ = written(tmp_path, STEEP, 1.0)
    verdict = judged(path, design, 1.0)
    assert verdict.ok, verdict.checks
    assert all(0.01 < flank.measured_error < 0.2 for flank in verdict.flanks)


STEEPER = """
cam:
  kind: cylindrical
  radius: 42
  track: {rib: {distance: 58, depth: 5}}
  follower: {radius: 4.3, arm: {length: 59, offset: -58.6, pivot: 75, side: leading}}
  pitch_height: 65
  motion:
    - {rise: 29, over: 116, law: polynomial-4567}
    - {dwell: 80}
    - {return: 29, over: 115, law: cycloidal}
    - {dwell: 49}
part: {length: 160, bore: 30}
export: {tolerance: 0.02, files: [step]}
"""


@pytest.mark.slow
def test_a_steep_rib_on_an_arm_is_told(tmp_path: Path) -> None:
    """Its pressure angle is above 60 degrees; metal for a roller that is 0.1 larger is not taken for it."""
    pytest.importorskip("OCP")
    path, design, _ = written(tmp_path, STEEPER, 0.02)
    verdict = judged(path, design, 0.02)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert all(flank.measured_error < 0.02 for flank in verdict.flanks)
    assert all(flank.motion.remainder < 0.01 for flank in verdict.flanks)
    other = design_of(changed(STEEPER, ("radius: 4.3,", "radius: 4.4,")))
    assert {("contour", "lower"), ("contour", "upper")} <= refused(judged(path, other, 0.02))


def test_a_solid_whose_faces_enclose_nothing_is_not_read(sound: tuple[str, DrumDesign, Path]) -> None:
    """All of its points are mirrored, and its faces and bounds are not."""
    text, design, folder = sound

    def mirror(found: re.Match[str]) -> str:
        x, y, z = found[2].split(",")
        return f"{found[1]}({x},{-float(y)!r},{z})"

    path = folder / "mirrored.step"
    points = re.sub(r"(CARTESIAN_POINT\('',)\(([^(),]*,[^(),]*,[^(),]*)\)", mirror, text)
    assert points != text
    path.write_text(points, encoding="latin-1")
    found = judged(path, design, FINE)
    assert not found.ok
    (check,) = found.checks
    assert (check.name, "its bounds do not enclose" in check.detail) == ("readable", True)


@pytest.mark.slow
def test_a_drum_for_another_roller_is_refused(sound: tuple[str, DrumDesign, Path]) -> None:
    text, design, folder = sound
    path = folder / "drum.step"
    path.write_text(text, encoding="latin-1")
    assert judged(path, design, FINE).ok
    larger = design_of(changed(TOP, ("radius: 10,", "radius: 10.01,")))
    assert {("contour", "lower"), ("motion", "lower")} <= refused(judged(path, larger, FINE))


@pytest.mark.slow  # six whole verdicts
def test_drums_of_another_size_are_refused(sound: tuple[str, DrumDesign, Path]) -> None:
    text, _, folder = sound
    path = folder / "drum.step"
    path.write_text(text, encoding="latin-1")
    for pairs, names in (
        ([("bore: 24", "bore: 24.01")], {("bore", "")}),
        ([("length: 80", "length: 80.01")], {("ends", "")}),
        ([("radius: 50", "radius: 50.01")], {("blank", "")}),
        ([("from: 38", "from: 38.01")], {("floor", "")}),
        ([("pitch_height: 20", "pitch_height: 20.01")], {("contour", "lower"), ("motion", "lower")}),
    ):
        found = refused(judged(path, design_of(changed(TOP, *pairs)), FINE))
        assert names <= found
        assert found - names <= {("volume", "")}
    mirrored = refused(judged(path, design_of("rotation: ccw\n" + TOP), FINE))
    assert {("contour", "lower"), ("motion", "lower")} <= mirrored


ENDS = {
    name: changed(text, ("groove: {depth: 12.5}", "end: top"), ("length: 80, bore", "length: 90, bore"))
    for name, text in {
        "trailing": ARM,
        "leading": LEADING,
        "cone": CONE.replace("taper: axis", "taper: 9"),
        "apex": CONE,
        "cone on an arm": CONE_ON_ARM,
        "beside": BESIDE,
    }.items()
}
CHANGES = {
    "trailing": [("length: 80,", "length: 80.05,"), ("offset: 78", "offset: 78.05"), ("arm: {", "taper: 0.2, arm: {")],
    "leading": [("length: 80,", "length: 80.05,"), ("pivot: 40,", "pivot: 41,")],
    "cone": [("taper: 9", "taper: 9.1"), ("at: 44", "at: 44.2")],
    "apex": [("taper: axis", "taper: 12.6"), ("taper: axis, at: 44, ", "")],
    "cone on an arm": [("length: 80,", "length: 80.05,"), ("taper: 6", "taper: 6.1")],
    "beside": [("offset: 6", "offset: -6"), ("offset: 6", "offset: 6.05"), ("offset: 6, ", "")],
}
SIZES = [  # no matter of the follower
    (("bore: 24", "bore: 24.01"), "bore"),
    (("length: 90, bore", "length: 90.01, bore"), "ends"),
    (("radius: 50", "radius: 50.01"), "blank"),
    (("from: 38", "from: 38.01"), "floor"),
]


@cache
def made_end(led: str) -> str:
    """Text of a sound file of an end cam of a follower."""
    from tempfile import TemporaryDirectory

    pytest.importorskip("OCP")
    with TemporaryDirectory() as folder:
        path, *_ = written(Path(folder), ENDS[led], FINE)
        return path.read_text(encoding="latin-1")


def scaled(text: str) -> str:
    """The text with all lengths larger by 1.001."""

    def larger(found: re.Match[str]) -> str:
        return found[1] + ",".join(repr(1.001 * float(part)) for part in found[2].split(",")) + found[3]

    text = re.sub(r"(CARTESIAN_POINT\('',\()([^)]*)(\))", larger, text)
    return re.sub(r"((?:CYLINDRICAL_SURFACE|CIRCLE)\('',#\d+,)([^)]*)(\))", larger, text)


@pytest.mark.slow
@pytest.mark.parametrize("led", ENDS)
def test_drums_for_another_follower_are_refused(tmp_path: Path, led: str) -> None:
    path = tmp_path / "drum.step"
    path.write_text(made_end(led), encoding="latin-1")
    assert judged(path, design_of(ENDS[led]), FINE).ok
    changes = [*CHANGES[led], ("radius: 10,", "radius: 10.01,")]
    for other in (changed(ENDS[led], change) for change in changes):
        assert {("contour", "lower"), ("motion", "lower")} <= refused(judged(path, design_of(other), FINE)), other
    mirrored = refused(judged(path, design_of("rotation: ccw\n" + ENDS[led]), FINE))
    assert "contour" in {name for name, _ in mirrored}  # far off not only on the one flank
    change, name = SIZES[list(ENDS).index(led) % len(SIZES)]
    assert (name, "") in refused(judged(path, design_of(changed(ENDS[led], change)), FINE))


@pytest.mark.slow
@pytest.mark.parametrize("led", ENDS)
def test_planted_faults_of_other_followers_are_refused(tmp_path: Path, led: str) -> None:
    """Every second fault, turn by turn, so that three followers have each."""
    path, design = tmp_path / "spoilt.step", design_of(ENDS[led])
    spoilt = [(spoil, {name}) for spoil, name in FAULTS.values()]
    for spoil, names in [*spoilt[list(ENDS).index(led) % 2 :: 2], (scaled, {"contour", "blank"})]:
        text = spoil(made_end(led))
        assert text != made_end(led)
        path.write_text(text, encoding="latin-1")
        assert names <= {each for each, _ in refused(judged(path, design, FINE))}


def test_what_is_not_judged_says_so(sound: tuple[str, DrumDesign, Path]) -> None:
    text, design, folder = sound
    path = folder / "drum.step"
    path.write_text(text, encoding="latin-1")
    shortened = verify_surfaces(path, replace(intended(design), shortened=True), Limits(FINE))
    assert "give an STL" in next(check.detail for check in shortened.checks if check.name == "contour")
    path.write_text(text[:-300], encoding="latin-1")
    (cut,) = judged(path, design, FINE).checks
    assert not cut.ok
    assert "cut short" in cut.detail
    with pytest.raises(ValueError, match="no exact surfaces"):
        verify_surfaces(folder / "drum.stl", intended(design), Limits(FINE))
