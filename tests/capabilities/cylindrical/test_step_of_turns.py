"""STEP of grooves of several turns: splines between corners, solids that another kernel accepts, planted faults.

Holds: camgeo.capabilities.cylindrical.trimmed, camgeo.capabilities.cylindrical.sides.
"""

from __future__ import annotations

import math
import re
from functools import cache
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import changed, design_of
from capabilities.cylindrical.test_files import demand_foreseen
from capabilities.cylindrical.test_step import (
    basis,
    judged,
    moved,
    on_spline,
    refused,
    resaved,
    solids_of,
    surface_points,
    with_a_bound,
    written,
)
from capabilities.cylindrical.test_turns import SHORT, SHORT_ROWS
from capabilities.cylindrical.wound_drums import SCREW, SCREW_ROWS, SPIRAL, SPIRAL_ROWS, Pins, random_track
from support.kernel import kernel

import camgeo
from camgeo.capabilities.cylindrical import trimmed as made
from camgeo.capabilities.cylindrical.figures import volume
from camgeo.capabilities.cylindrical.patches import kept_of, lines_of
from camgeo.capabilities.cylindrical.sides import Sides
from camgeo.capabilities.cylindrical.trimmed import trimmed
from camgeo.files.errors import RegionError
from camgeo.fit.nodes import ToleranceError
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.capabilities.cylindrical.bicubic import Bicubic
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.trimmed import Trimmed

TURN = 2.0 * math.pi
FINE = 0.003  # mm
SHARE = np.random.default_rng(3).uniform(0.0, 1.0, 29)
TRACKS = {"short": (SHORT, SHORT_ROWS), "screw": (SCREW, SCREW_ROWS), "spiral": (SPIRAL, SPIRAL_ROWS)}


@cache
def designed(name: str) -> DrumDesign:
    """A drum, made once."""
    return design_of(TRACKS[name][0])


@cache
def splines(name: str, tolerance: float) -> Trimmed:
    """Splines of a drum, parted at 1 rad and half a turn on on both cylinders."""
    return trimmed(designed(name), tolerance, lambda *_: [1.0, 1.0 + 0.5 * TURN])


def pins_of(name: str) -> Pins:
    """Where the pin of a drum has been."""
    return Pins(TRACKS[name][1], designed(name).recipe.roller.radius)


# --- splines ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "tolerance"),
    [*((name, 0.05) for name in TRACKS), *((name, 0.002) for name in TRACKS if name != "screw")],
)
def test_splines_are_as_near_all_pins_as_is_proved(name: str, tolerance: float) -> None:
    """Every place is as near the pin of one turn as is proved, and no farther within that of any other."""
    found, design = splines(name, tolerance), designed(name)
    assert found.off <= tolerance
    parts = [part for stretch in found.stretches for part in stretch.parts]
    places = np.concatenate([on_spline(part, SHARE).reshape(-1, 3) for part in parts])
    away = pins_of(name).away(places, design.recipe.level).min(axis=1)
    assert 0.005 * found.off < np.abs(away).max() < found.off + 1e-9


def border(part: Bicubic, column: int) -> np.ndarray:
    """Places (n, 3) along the first or the last line of a spline."""
    t = np.linspace(part.r[0], part.r[-1], 23)
    return basis(part.r, t) @ part.control[column]


@pytest.mark.slow
@pytest.mark.parametrize("name", TRACKS)
def test_both_flanks_of_a_corner_end_in_one_curve_that_is_near_both(name: str) -> None:
    found, design = splines(name, 0.05), designed(name)
    lines: dict[int, list[np.ndarray]] = {}
    for stretch in found.stretches:
        lines.setdefault(id(stretch.begin), []).append(border(stretch.parts[0], 0))
        lines.setdefault(id(stretch.end), []).append(border(stretch.parts[-1], -1))
    assert len(lines) == 4 * len(design.crossings)
    for one, other in lines.values():
        assert one == pytest.approx(other, abs=1e-10)
        away = np.sort(np.abs(pins_of(name).away(one, design.recipe.level)), axis=1)
        assert away[:, 1].max() < found.off + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("name", TRACKS)
def test_the_parts_of_a_stretch_follow_one_another_down_to_the_last_digits(name: str) -> None:
    for stretch in splines(name, 0.05).stretches:
        for before, behind in zip(stretch.parts[:-1], stretch.parts[1:], strict=True):
            assert before.control[-1] == pytest.approx(behind.control[0], abs=1e-12)
            assert before.theta[-1] == behind.theta[0]
        for part in stretch.parts:
            assert np.diff(part.theta).min() > 1e-6


@pytest.mark.slow
def test_a_jump_of_the_jerk_beneath_an_edge_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The break lies between the ends of a line; as if it were not there fewer columns would be proved."""
    design, r = designed("short"), np.linspace(25.0, 30.0, 9)
    flank, at = design.flanks["lower"], math.radians(190.3)
    kept = kept_of(design.crossings, "lower", flank.period)
    lines = [line for ends in kept for line in lines_of(ends, r, flank.period)]
    (line,) = [each for each in lines if each.min() + 1e-3 < at < each.max() - 1e-3]

    def columns(found: Trimmed) -> int:
        parts = [part for s in found.stretches if s.name == "lower" for part in (s.parts[0], s.parts[-1])]
        (own,) = [part for part in parts if part.theta[0] - 1e-9 <= line.mean() <= part.theta[-1] + 1e-9]
        return len(own.theta)

    with_jump = columns(splines("short", 0.002))
    monkeypatch.setattr(made, "SECOND", 1e9)
    monkeypatch.setattr(made, "MIXED", 0.0)
    assert columns(trimmed(design, 0.002, lambda *_: [1.0, 1.0 + 0.5 * TURN])) < with_jump


@pytest.mark.slow
def test_a_tolerance_that_is_too_small_names_one_that_serves(monkeypatch: pytest.MonkeyPatch) -> None:
    design = designed("short")
    with pytest.raises(ToleranceError, match="control points; give at least"):
        trimmed(design, 1e-8, lambda *_: [1.0, 4.0])
    with pytest.raises(ToleranceError, match="double precision"):
        trimmed(design, 1e-15, lambda *_: [1.0, 4.0])
    monkeypatch.setattr(made, "MOST_NODES", 50)
    with pytest.raises(ToleranceError, match=r"flanks that cross within 0\.005 mm .* control points; give") as caught:
        trimmed(design, 0.005, lambda *_: [1.0, 4.0])
    least = caught.value.reached
    assert 0.005 < least < 1.0
    assert trimmed(design, least, lambda *_: [1.0, 4.0]).off <= least
    monkeypatch.setattr(made, "COARSER", 1e6)
    with pytest.raises(ToleranceError, match="no surface is proved"):
        trimmed(design, 0.005, lambda *_: [1.0, 4.0])


# --- faces of cylinders -----------------------------------------------------------------------------------------------


@kernel
def test_lines_that_do_not_follow_one_another_bound_no_face() -> None:
    """A vertex on the line that parts the cylinder has nothing above it; an edge ends where none begins."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex
    from OCP.gp import gp_Pnt

    def vertex(angle: float, z: float) -> Any:
        return BRepBuilderAPI_MakeVertex(gp_Pnt(math.cos(angle), math.sin(angle), z)).Vertex()

    for angles in ((0.0, 1.0), (0.5, 1.0)):
        sides = Sides(1.0, 0.0)
        ends = tuple(vertex(angle, 0.0) for angle in angles)
        points = np.array([[math.cos(angle), math.sin(angle), 0.0] for angle in angles])
        sides.add(BRepBuilderAPI_MakeEdge(*ends).Edge(), (ends[0], ends[1]), points, forward=True)
        with pytest.raises(RegionError, match="cross"):
            list(sides.faces())


# --- solids -----------------------------------------------------------------------------------------------------------


@kernel
@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in TRACKS if name != "screw"])  # random ones are made below
def test_another_kernel_takes_the_solid_and_kin_both_files(tmp_path: Path, name: str) -> None:
    tolerance = {"screw": 0.02, "spiral": 0.005, "short": 0.05}[name]
    path, design, off = written(tmp_path, TRACKS[name][0], tolerance)
    sound, measured = solids_of(path)
    assert sound
    assert measured == pytest.approx(volume(design), abs=0.1 * tolerance * 10_000)
    for file in (path, resaved(path, tmp_path / "again.step")) if name == "spiral" else (path,):
        verdict = judged(file, design, tolerance)
        assert verdict.ok, [check for check in verdict.checks if not check.ok]
        for flank in verdict.flanks:
            assert flank.measured_error is not None
            assert flank.measured_error <= off
            assert len(flank.free) == 2 * len(design.crossings)
        names = {check.name for check in verdict.checks}
        assert {"watertight", "contour", "motion", "form-closure", "crossings", "shoe", "volume"} <= names


@kernel
@pytest.mark.thin(2)
@pytest.mark.costly("an export and its verification")
@pytest.mark.parametrize("text", ["rotation: ccw\n" + SHORT, SPIRAL], ids=["short", "spiral"])
def test_a_recipe_of_several_turns_with_a_step_file(tmp_path: Path, text: str) -> None:
    text = changed(text, ("[stl]", "[step]"))
    (tmp_path / "drum.yaml").write_text(text, encoding="utf-8")
    report = camgeo.export(str(tmp_path / "drum.yaml"), str(tmp_path / "out"))
    assert report.ok, str(report)
    demand_foreseen(tmp_path, report)
    path = tmp_path / "out" / "drum" / "drum.step"
    assert path.stat().st_size < 600_000
    found: Any = dict(report)
    (file,) = found["files"]
    assert file["geometry_error"] <= 0.05
    assert max(surface["measured_error"] for surface in file["surfaces"]) <= file["geometry_error"]
    assert camgeo.verify(tmp_path / "drum.yaml", path).ok


@kernel
@pytest.mark.slow  # solids by the kernel, and whole verdicts
@pytest.mark.parametrize("seed", [9, 4, 11])
def test_random_tracks(tmp_path: Path, seed: int) -> None:
    """Screws and spirals; a shoe that does not serve is given the length that its error names."""
    chance, tolerance = Random(700 + seed), (0.05, 0.01, 0.002)[seed % 3]
    for _ in range(60):
        _, text = random_track(chance)
        try:
            design_of(text)
            break
        except RecipeErrors as error:
            named = re.search(r"(?:give a shoe of|give at most) ([\d.]+) mm", str(error))
            if named is not None:
                text = re.sub(r"length: [\d.]+}", f"length: {named[1]}}}", text, count=1)
                break
    path, design, off = written(tmp_path, text, tolerance)
    sound, measured = solids_of(path)
    assert sound
    assert measured == pytest.approx(volume(design), abs=0.1 * tolerance * 10_000)
    verdict = judged(path, design, tolerance)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert all(flank.measured_error is not None and flank.measured_error <= off for flank in verdict.flanks)


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, DrumDesign, Path]:
    """Text of a sound file of the spiral, its design, and a folder."""
    pytest.importorskip("OCP")
    folder = tmp_path_factory.mktemp("step")
    path, design, _ = written(folder, SPIRAL, FINE)
    return path.read_text(encoding="latin-1"), design, folder


def widest(text: str) -> list[str]:
    """Numbers of the control points of the surface that has the most of them."""
    count = text.count("B_SPLINE_SURFACE_WITH_KNOTS(")
    return max((surface_points(text, k) for k in range(count)), key=len)


def within(text: str) -> str:
    """A control point within that surface, off its borders."""
    listed = re.findall(r"B_SPLINE_SURFACE_WITH_KNOTS\('',3,3,\((.*?)\),\.UNSPEC", text, re.DOTALL)
    rows = [re.findall(r"#\d+", row) for row in max(listed, key=len).split("),")]
    middle = rows[len(rows) // 2]
    return middle[len(middle) // 2]


FAULTS: dict[str, tuple[Callable[[str], str], str]] = {
    "a surface shifted by 0.01 along the axis": (lambda t: moved(t, widest(t), (0.0, 0.0, 0.01)), "contour"),
    # flanks of a slow feed are all but level: along them a shift shows at the edges
    "a surface shifted by 0.01 across": (lambda t: moved(t, widest(t), (0.01, 0.01, 0.0)), "watertight"),
    "a control point moved by 0.05": (lambda t: moved(t, [within(t)], (0.0, 0.0, 0.05)), "contour"),
    "a bound that runs the other way": (with_a_bound, "watertight"),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults_are_refused(sound: tuple[str, DrumDesign, Path], fault: str) -> None:
    text, design, folder = sound
    spoil, name = FAULTS[fault]
    path = folder / "spoilt.step"
    path.write_text(spoil(text), encoding="latin-1")
    assert name in {each for each, _ in refused(judged(path, design, FINE))}


@pytest.mark.slow
def test_the_solid_of_another_spiral_is_refused(sound: tuple[str, DrumDesign, Path]) -> None:
    """A return with other blends, mirrored, a narrower groove."""
    text, _, folder = sound
    path = folder / "drum.step"
    path.write_text(text, encoding="latin-1")
    flanks = {("contour", "lower"), ("motion", "lower"), ("contour", "upper"), ("motion", "upper")}
    for pair, least in (
        (("blend: [80.0, 60.0]", "blend: [70.0, 70.0]"), flanks),
        (("rotation: ccw\n", ""), {("contour", "lower")}),
        (("width: 8.0", "width: 7.9"), {("contour", "lower"), ("contour", "upper")}),
    ):
        assert least <= refused(judged(path, design_of(changed(SPIRAL, pair)), FINE)), pair
