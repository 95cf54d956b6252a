"""Cams that are made, held against the judge: sound ones pass at any tolerance, planted faults are refused.

The maker has closed forms of its flanks, the judge has positions of rollers alone: they share no curve.

Holds: camgeo.capabilities.indexing.verdicts, camgeo.capabilities.indexing.solid, kin.indexing.holding,
kin.indexing.contour, kin.indexing.faces.
"""

from __future__ import annotations

import functools
import json
import math
import random
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import BARREL, GLOBOID, changed, random_indexer, shared_design
from capabilities.indexing.rollers import Indexed, barrel_away, globoid_away, nearest
from support.heavy import manifold3d

from camgeo.capabilities.indexing import solid
from camgeo.capabilities.indexing.checks_of import design_checks
from camgeo.capabilities.indexing.figures import figures_of
from camgeo.capabilities.indexing.sheet import sheet_of
from camgeo.capabilities.indexing.verdicts import intended
from camgeo.cli.main import main
from camgeo.output.extension import numbers_of
from kin.indexing import contour
from kin.indexing.contour import Known, bare
from kin.indexing.faces import Body
from kin.indexing.judge import judge_mesh
from kin.indexing.rollers import Rollers
from kin.numeric.limits import Limits
from kin.numeric.records import replace
from kin.read.mesh.checked import Triangles, checked

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.flank import Flank
    from camgeo.capabilities.indexing.sheet import Sheet
    from kin.turned.verdict import TurnedVerdict

TOLERANCE = 0.01
FORMS = pytest.mark.parametrize("text", [BARREL, GLOBOID], ids=["barrel", "globoid"])
Solid = tuple[np.ndarray, np.ndarray]


@functools.cache
def made(text: str, tolerance: float = TOLERANCE) -> Solid:
    """Points and triangles of the cam of a text."""
    mesh, _ = solid.index_mesh(shared_design(text), tolerance, numbers_of("stl", 1.0))
    return mesh.points, mesh.triangles


def judged(body: Solid, text: str, tolerance: float = TOLERANCE) -> TurnedVerdict:
    """Verdict on a body by the cam of a text."""
    points, corners = body
    read = checked(Triangles(points[corners].astype(np.float32), "binary"), Path("cam.stl"))
    return judge_mesh(read, intended(shared_design(text)), Limits(tolerance))


def refused(body: Solid, text: str) -> set[str]:
    """Names of the checks that do not hold."""
    return {check.name for check in judged(body, text).checks if not check.ok}


@pytest.mark.slow
@FORMS
@pytest.mark.parametrize("tolerance", [0.05, 0.01, 0.001])
def test_what_is_made_is_accepted(text: str, tolerance: float) -> None:
    """Down to a thousandth of a millimetre, where the angles that are asked lie on the seams of triangles."""
    verdict = judged(made(text, tolerance), text, tolerance)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]


LAWS = {
    BARREL: Indexed([("rise", 60.0, 150.0, "cycloidal"), ("dwell", 0.0, 210.0, "")], -30.0),
    GLOBOID: Indexed([("rise", 45.0, 120.0, "cycloidal"), ("dwell", 0.0, 240.0, "")], -22.5),
}
AWAY = {
    BARREL: barrel_away(30.0 * (1.0 + math.cos(math.radians(30.0))), 60.0, 1, 40.0),
    GLOBOID: globoid_away(90.0, 30.0),
}
LONGEST = 120  # triangles whose inside is held against all positions


@functools.cache
def simplified(text: str) -> Solid:
    """The same cam with fewer triangles, as programs for meshes make them: its faces move by 0.001 mm at most."""
    points, corners = made(text)
    mesh = manifold3d.Manifold(manifold3d.Mesh64(points, corners.astype(np.uint64))).simplify(0.001).to_mesh64()
    return np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(np.int64)


@pytest.mark.slow
@FORMS
def test_a_sound_cam_is_accepted_with_fewer_triangles(text: str) -> None:
    """In a dwell few slender triangles are left of a flank: along them the worst angle is uneven."""
    verdict = judged(simplified(text), text)
    assert len(simplified(text)[1]) < len(made(text)[1])
    assert verdict.ok, [check for check in verdict.checks if not check.ok]


@pytest.mark.costly("rollers at all angles against the inside of triangles")
@FORMS
@pytest.mark.parametrize("body", [made, simplified])
def test_how_bare_triangles_are_agrees_with_positions(
    text: str, body: Callable[[str], Solid], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A flank that bulges is barest within triangles; what the proof leaves open there is a fifth of the tolerance.

    So it is where a file has more triangles than are divided at a time.
    """
    points, corners = body(text)
    intent, roller = intended(shared_design(text)), 9.0 if text == BARREL else 8.0
    read = checked(Triangles(points[corners], "binary"), Path("cam.stl"))
    own, rollers = Body.of(read.mesh, intent), Rollers(intent, TOLERANCE)
    depth, z = own.depth[own.corners], own.points[own.corners][..., 2]
    flanks = np.flatnonzero(
        (np.ptp(depth, axis=1) > 0.5) & (depth.max(axis=1) < 14.0) & (np.abs(z).min(axis=1) < 0.5 * intent.length - 1.0)
    )
    sides = np.roll(own.points[own.corners[flanks]], -1, axis=1) - own.points[own.corners[flanks]]
    which = flanks[np.argsort(np.linalg.norm(sides, axis=2).max(axis=1))[-LONGEST:]]
    known = Known.of(rollers, own, np.unique(own.corners[which]))
    peaks = [bare(rollers, own, known, which)]
    monkeypatch.setattr(contour, "MOST_AT_ONCE", LONGEST // 30)
    monkeypatch.setattr(contour, "MOST_PARTS", 10 * LONGEST)
    peaks.append(bare(rollers, own, known, which))
    shares = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8.0
    places = np.einsum("wc,tcx->twx", shares, own.points[own.corners[which]]).reshape(-1, 3)
    places[:, 2] += intent.height
    found = float(nearest(AWAY[text], LAWS[text], places, 2, 25).max()) - roller
    for peak in peaks:
        assert found <= peak.value + peak.remainder
        assert peak.value <= found + 0.1 * TOLERANCE
        assert peak.value + peak.remainder <= max(found + 0.3 * TOLERANCE, 0.5 * TOLERANCE)


@pytest.mark.costly("a verdict on a solid")
@pytest.mark.parametrize("tolerance", [0.05, pytest.param(TOLERANCE, marks=pytest.mark.slow)])
@FORMS
def test_layers_are_told_within_the_tolerance(text: str, tolerance: float) -> None:
    """A polygon about a cylinder fills the tolerance: neither the proof nor single precision shows in what is told."""
    points, corners = made(text, tolerance)
    verdict = judged((points, corners), text, tolerance)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    checks = {check.name: check for check in verdict.checks}
    told = {name: checks[name].value or math.inf for name in ("blank", "floor", "ends", "bore")}
    assert max(told.values()) <= tolerance
    # places all over the triangles of the blank, by the circle that turns about the cam's axis
    shares = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8.0
    places = np.einsum("wc,tcx->twx", shares, points[corners])
    r = np.hypot(places[..., 0], places[..., 1])
    off = np.abs(r - 50.0 if text == BARREL else np.hypot(90.0 - r, places[..., 2] - 30.0) - 49.0).max(axis=1)
    assert told["blank"] >= float(off[off < 1.1 * tolerance].max())


def turned(body: Solid) -> Solid:
    points, corners = body
    cosine, sine = math.cos(math.radians(0.1)), math.sin(math.radians(0.1))
    return points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]), corners


def dented(body: Solid) -> Solid:
    """A corner in the middle of a flank, moved by 0.05 mm along its normal."""
    points, corners = body
    points = points.copy()
    r = np.hypot(points[:, 0], points[:, 1])
    middle = 0.5 * float(points[:, 2].max())
    # between the layers of both forms: of a barrel 37 and 50, of a globoid 90 - 62.5 and 90 - 49 at this height
    within = (r > 31.0) & (r < 36.0) if r.min() < 11.0 and math.isclose(middle, 30.0) else (r > 40.0) & (r < 47.0)
    k = int(np.flatnonzero(within & (abs(points[:, 2] - middle) < 3.0))[0])
    own = corners[(corners == k).any(axis=1)]
    normal = np.cross(points[own[:, 1]] - points[own[:, 0]], points[own[:, 2]] - points[own[:, 0]]).sum(axis=0)
    points[k] += 0.05 * normal / np.linalg.norm(normal)
    return points, corners


FAULTS: dict[str, tuple[Callable[[Solid], Solid], str]] = {
    "mirrored": (lambda body: (body[0] * [1.0, -1.0, 1.0], body[1][:, ::-1]), "contour"),
    "scaled": (lambda body: (1.001 * body[0], body[1]), "blank"),
    "turned": (turned, "contour"),
    "dented": (dented, "contour"),
    "flipped": (lambda body: (body[0], body[1][:, ::-1]), "watertight"),
    "open": (lambda body: (body[0], body[1][1:]), "watertight"),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "fault"),
    [*((BARREL, fault) for fault in FAULTS), *((GLOBOID, fault) for fault in ("scaled", "dented"))],
)
def test_a_planted_fault_is_refused(text: str, fault: str) -> None:
    how, name = FAULTS[fault]
    assert name in refused(how(made(text)), text)


OTHERS = [
    (BARREL, ("stops: 6", "stops: 7"), "contour"),
    (BARREL, ("depth: 13", "depth: 12.95"), "floor"),
    (BARREL, ("roller: 9", "roller: 9.02"), "contour"),
    (BARREL, ("length: 80", "length: 79.9"), "ends"),
    (BARREL, ("bore: 24", "bore: 24.1"), "bore"),
    (BARREL, ("over: 150, law: cycloidal}, {dwell: 210}", "over: 150.5, law: cycloidal}, {dwell: 209.5}"), "contour"),
    (GLOBOID, ("stops: 8", "stops: 9"), "contour"),
    (GLOBOID, ("depth: 13.5", "depth: 13.45"), "floor"),
    (GLOBOID, ("roller: 8", "roller: 8.02"), "contour"),
    (GLOBOID, ("distance: 90", "distance: 90.05"), "contour"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "change", "name"), OTHERS)
def test_a_cam_that_is_a_little_another_is_refused(text: str, change: tuple[str, str], name: str) -> None:
    stops = changed(text, change)
    if "stops" in change[0]:  # the pitch goes with it
        stops = changed(stops, ("rise: 60", f"rise: {360 / 7!r}") if text == BARREL else ("rise: 45", "rise: 40"))
    assert name in refused(made(stops), text)


@pytest.mark.slow
@FORMS
def test_walls_cut_radially_are_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each place between floor and blank stands as the roller touches the blank at that shaft angle."""

    def radial(flank: Flank, tolerance: float, wide: tuple[float, float]) -> Sheet:
        sheet = sheet_of(flank, tolerance, wide)
        theta = sheet.phi.copy()
        for _ in range(80):
            pose = flank.pose(theta)
            theta += 0.5 * np.nan_to_num(sheet.phi - flank.contact(theta, pose, flank.reached(pose, sheet.w)).phi)
        edge = flank.on(theta, flank.form.blank)
        inside = np.ones(theta.size, dtype=bool)
        inside[np.concatenate([*sheet.ends, sheet.floor, sheet.blank])] = False
        z = flank.form.points(edge.phi, edge.h, sheet.w)[:, 2]
        phi, h, z = (
            np.where(inside, one, two) for one, two in ((edge.phi, sheet.phi), (edge.h, sheet.h), (z, sheet.z))
        )
        return replace(sheet, phi=phi, h=h, z=z)

    monkeypatch.setattr(solid, "sheet_of", radial)
    mesh, _ = solid.index_mesh(shared_design(text), TOLERANCE, numbers_of("stl", 1.0))
    verdict = judged((mesh.points, mesh.triangles), text)
    assert "contour" in {check.name for check in verdict.checks if not check.ok}
    assert max(flank.measured_error or 0.0 for flank in verdict.flanks) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("form", ["barrel", "globoid"])
@pytest.mark.parametrize("seed", range(2))
def test_random_cams_from_the_recipe_to_the_verdict(form: str, seed: int, tmp_path: Path) -> None:
    """A cam that is made passes; one that cannot be, or would leave the turret free, is not made."""
    rng = random.Random(f"{form}-{seed}")
    path = tmp_path / "index.yaml"
    while True:
        path.write_text(random_indexer(rng, form, inch=seed % 2 == 1, ccw=seed % 3 == 1), "utf-8")
        status = main(["export", str(path), "--out", str(tmp_path / "out")])
        if (tmp_path / "out" / "index" / "report.json").exists():
            break
        assert status in {1, 2}
    report = json.loads((tmp_path / "out" / "index" / "report.json").read_text("utf-8"))
    assert [check for check in report["checks"] if not check["ok"]] == []
    assert status == 0


SHORT = [
    (changed(BARREL, ("length: 80", "length: 60")), ("length: 60", "length: 66")),
    (changed(GLOBOID, ("length: 60", "length: 34")), ("length: 34", "length: 44")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "remedy"), SHORT, ids=["barrel", "globoid"])
def test_a_cam_that_holds_the_turret_on_one_flank_alone_is_told_as_the_judge_does(
    text: str, remedy: tuple[str, str]
) -> None:
    """Somewhere one roller has left before the next one bears: a longer cam serves."""
    for longer in (False, True):
        own = changed(text, remedy) if longer else text
        design = shared_design(own)
        (check,) = (each for each in design_checks(design, figures_of(design)) if each.name == "contact-length")
        assert check.ok is longer
        assert longer or check.detail.endswith("give more stops, or a longer cam")
        assert judged(made(own), own).ok is longer
