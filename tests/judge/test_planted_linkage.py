"""Spoilt files of a cam that drives a linkage: each fault must be caught, by the checks that are named here.

The sound files come from formulas by numpy alone (`camfiles`); what drives the output falsely must be reported by the
output's own error, from DXF and from STL.

Holds: kin.judge.linkage_checks.
"""

import dataclasses

import numpy as np
import pytest
from support import followers
from support.camfiles import arcs_through, circle_points, solid_triangles, support_points, write_dxf, write_stl
from support.cases import few
from support.intent import linked, part_of

from kin.judge.intent import DwellAsked, Limits
from kin.judge.verify import verify
from kin.law.support_function import lift_from_fourier
from kin.linkage.dyad import RRR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.linkage.mechanism import Mechanism

ANGLES = 120
EDGES = 1200
E = 1e-3  # mm, the tolerance
LIMITS = Limits(E)
# AS Figure 9: cam 2a about (18, 8.5)
HARMONICS = ((1, -18.0, 13 / 30 - 8.5), (3, 0.0, 1.0), (5, 0.0, 13 / 30))
LIFT = lift_from_fourier(25.0, {1: -18.0}, {1: 13 / 30 - 8.5, 3: 1.0, 5: 13 / 30})
YOKE = followers.yoke(LIFT, 50.0)
FOUR_BAR = Mechanism(FourBar(80.0, 70.0, 105.0), LIFT, 50.0)
DWELL = DwellAsked(np.radians(0.1), np.radians(37.0))  # 37.05 degrees of the shaft are intended
INTENT = part_of(YOKE, bore=10.0, thickness=8.0, mechanism=FOUR_BAR, dwell=DWELL)
PLAIN = {"contour", "motion", "constant-breadth", "breadth-max"}
LINKED = {"linkage-error", "dwell"}
FORMS = ["dxf", "stl"]


def cam(count=EDGES, mean=25.0, harmonics=HARMONICS):
    return support_points(count, mean, harmonics)


def written(folder, form, points):
    if form == "dxf":
        return write_dxf(folder / "cam.dxf", points)
    return write_stl(folder / "cam.stl", solid_triangles(points, 5.0 * circle_points(len(points)), 0.0, 8.0))


def judged(path, intent=INTENT, limits=LIMITS):
    """Verdict, and its checks by name."""
    verdict = verify(path, intent, ANGLES, limits)
    return verdict, {check.name: check for check in verdict.checks}


def failures(path, intent=INTENT, limits=LIMITS):
    return {check.name for check in verify(path, intent, ANGLES, limits).checks if not check.ok}


def turned(points, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, s], [-s, c]])


def outward(points):
    """Unit normals at the corners (n, 2)."""
    chord = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    return np.column_stack([chord[:, 1], -chord[:, 0]]) / np.hypot(*chord.T)[:, None]


# --- sound files ------------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@pytest.mark.parametrize("form", FORMS)
def test_a_sound_file_passes_every_check(tmp_path, form):
    verdict, checks = judged(written(tmp_path, form, cam()))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert set(checks) >= PLAIN | LINKED | {"bore"}
    assert {check.file for check in verdict.checks} == {f"cam.{form}"}
    error, dwell = checks["linkage-error"], checks["dwell"]
    assert (error.unit, error.sense, error.value) == ("deg", "at_most", verdict.linkage.error.max)
    assert 0.0 < error.value < 0.2 * error.limit
    assert error.limit == verdict.linkage.limit
    assert (dwell.unit, dwell.sense, dwell.value) == ("deg", "at_least", verdict.linkage.dwells[0].length_deg)
    assert dwell.limit == pytest.approx(37.0)
    assert dwell.value == pytest.approx(37.049, abs=5e-3)


def test_without_a_mechanism_nothing_is_said_of_one(tmp_path):
    plain = dataclasses.replace(INTENT, linkage=None)
    verdict, checks = judged(written(tmp_path, "dxf", cam()), plain)
    assert verdict.ok
    assert verdict.linkage is None
    assert not LINKED & set(checks)


@pytest.mark.slow
def test_a_dwell_that_need_not_last_is_told_and_not_judged(tmp_path):
    intent = linked(INTENT, dwell=DwellAsked(np.radians(0.1), over="relative"))
    verdict, checks = judged(written(tmp_path, "dxf", cam()), intent)
    assert "dwell" not in checks
    assert verdict.linkage.dwells[0].length_deg == pytest.approx(45.17, abs=0.01)
    verdict, _ = judged(written(tmp_path, "dxf", cam()), linked(INTENT, dwell=None))
    assert verdict.linkage.dwells == ()
    assert verdict.linkage.error.dwell_flatness is None


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.0, -1.0])
def test_a_file_that_uses_its_whole_tolerance_passes(tmp_path, share):
    """Arcs all round outside or inside by the tolerance: the implied limit is reached and holds."""
    vertices, bulges = arcs_through(cam(3000, 25.0 + share * E))
    verdict, checks = judged(write_dxf(tmp_path / "cam.dxf", vertices, bulges), limits=Limits(E + 2e-7))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert checks["linkage-error"].value == pytest.approx(checks["linkage-error"].limit, rel=1e-3)


@pytest.mark.slow
def test_any_contour_within_the_tolerance_passes(tmp_path):
    """Corners scattered within the tolerance, by chance: whatever they do together, no check fails."""
    rng = np.random.default_rng(7)
    inside = 1.5e-4  # the edges of the sound polygon are that far inside, or less
    intent = linked(INTENT, dwell=None)
    for _ in range(5):
        t = np.arange(EDGES) * 2 * np.pi / EDGES
        waves = sum(rng.normal() * np.cos(k * t + rng.uniform(0, 6.28)) / k for k in range(1, 6))
        points = cam() + (E - inside) * 0.999 * (waves / np.abs(waves).max())[:, None] * np.column_stack(
            [np.cos(t), np.sin(t)]
        )
        verdict, checks = judged(write_dxf(tmp_path / "cam.dxf", points), intent)
        assert verdict.ok, [check for check in verdict.checks if not check.ok]
        assert checks["linkage-error"].value > 0.2 * checks["linkage-error"].limit


@pytest.mark.slow
def test_a_limit_of_the_callers_own(tmp_path):
    path = written(tmp_path, "dxf", cam())
    reached = judged(path)[0].linkage.error.max
    assert failures(path, limits=Limits(E, output=1.01 * reached)) == set()
    assert failures(path, limits=Limits(E, output=0.99 * reached)) == {"linkage-error"}
    short = linked(INTENT, dwell=dataclasses.replace(DWELL, at_least=np.radians(37.06)))
    assert failures(path, short) == {"dwell"}


def test_mirrored_drawings(tmp_path):
    """A shaft that turns counter-clockwise: drawn mirrored, judged alike."""
    path = written(tmp_path, "dxf", cam() * [1.0, -1.0])
    assert failures(path, dataclasses.replace(INTENT, mirrored=True)) == set()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("linkage", "dyads", "unit"),
    [
        (InvertedSliderCrank(60.0, 20.0), (), "deg"),
        (SliderCrank(90.0, 15.0), (), "mm"),
        (FourBar(80.0, 70.0, 105.0, "crossed"), (), "deg"),
        (FourBar(80.0, 70.0, 105.0), (RRR("output", (60.0, 20.0), (150.0, 30.0), (90.0, 80.0), "open"),), "deg"),
    ],
)
def test_other_mechanisms(tmp_path, linkage, dyads, unit):
    intent = linked(INTENT, mechanism=Mechanism(linkage, LIFT, 50.0, dyads), dwell=None)
    vertices, bulges = arcs_through(cam(3000, 25.0 + E))
    verdict, checks = judged(write_dxf(tmp_path / "cam.dxf", vertices, bulges), intent, Limits(E + 2e-7))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert checks["linkage-error"].unit == unit
    assert checks["linkage-error"].value == pytest.approx(checks["linkage-error"].limit, rel=1e-3)
    assert "linkage-error" in failures(written(tmp_path, "stl", turned(cam(), 0.2)), intent)


# --- spoilt files -----------------------------------------------------------------------------------------------------


def moved_vertex(points, depth=0.01, k=700):
    spoilt = points.copy()
    spoilt[k] += depth * outward(points)[k]
    return spoilt


FAULTS = {
    "a vertex moved outward": (lambda: moved_vertex(cam()), {"contour", "motion", "linkage-error"}),
    "turned by 0.2 degrees": (lambda: turned(cam(), 0.2), {"contour", "motion", "linkage-error"}),
    "turned by -0.2 degrees": (lambda: turned(cam(), -0.2), {"contour", "motion", "linkage-error"}),
    "scaled by 1.001": (lambda: 1.001 * cam(), PLAIN | {"linkage-error"}),
    "scaled by 0.999": (lambda: 0.999 * cam(), {"contour", "motion", "constant-breadth", "linkage-error"}),
    "mirrored": (lambda: cam()[::-1] * [1.0, -1.0], {"contour", "motion", "linkage-error"}),
    "the wrong pivot": (
        lambda: cam(harmonics=((1, -18.02, 13 / 30 - 8.5), *HARMONICS[1:])),
        {"contour", "motion", "linkage-error"},
    ),
    "0.05 mm too broad": (lambda: cam(mean=25.025), PLAIN | {"linkage-error"}),
    "on one side outside by 1.5 tolerances": (
        lambda: cam() + 1.5 * E * outward(cam()) * (np.abs(np.arange(EDGES) - 900) < 200)[:, None],
        {"contour", "motion"},
    ),
}


@pytest.mark.thin(20)
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault(tmp_path, fault, form):
    points, caught = FAULTS[fault]
    assert caught <= failures(written(tmp_path, form, points()))


@pytest.mark.thin(6)
@pytest.mark.parametrize("form", few(FORMS, 3))
@pytest.mark.parametrize("k", range(0, EDGES, 200))
def test_metal_left_on_anywhere_is_felt_by_the_output(tmp_path, form, k):
    """Ten tolerances at one corner: the output tells wherever it is, unless it hardly moves there at all."""
    verdict, checks = judged(written(tmp_path, form, moved_vertex(cam(), 10 * E, k)))
    assert {"contour", "motion"} <= {check.name for check in verdict.checks if not check.ok}
    assert checks["linkage-error"].value > checks["linkage-error"].limit


@pytest.mark.slow
@pytest.mark.parametrize("factor", [-1.0, 0.0, 2.0])
def test_one_bulge_flipped_or_left_out_or_doubled(tmp_path, factor):
    """Metal on is felt by contact, metal off over a short chord is not: the contour tells of either."""
    vertices, bulges = arcs_through(cam(600))
    k = int(np.argmax(np.abs(bulges)))
    sagitta = abs(bulges[k]) * np.hypot(*(vertices[k + 1] - vertices[k])) / 2
    limits = Limits(0.2 * sagitta)
    intent = linked(INTENT, dwell=None)
    assert failures(write_dxf(tmp_path / "sound.dxf", vertices, bulges), intent, limits) == set()
    bulges[k] *= factor
    found = failures(write_dxf(tmp_path / "cam.dxf", vertices, bulges), intent, limits)
    assert found >= {"contour", "motion", "linkage-error"}


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("form", FORMS)
def test_a_dwell_spoilt_by_a_bump_within_it(tmp_path, form):
    """Metal on where the output should stand still, which lifts it out of the band."""
    k = round(20.0 / 360.0 * EDGES)  # where face 2 bears at a relative angle of 290 degrees, amid the dwell
    intent = linked(INTENT, dwell=DwellAsked(np.radians(0.02), np.radians(17.0)))
    _, sound = judged(written(tmp_path, form, cam()), intent)
    assert sound["dwell"].ok
    found, checks = judged(written(tmp_path, form, moved_vertex(cam(), 0.03, k)), intent)
    assert not checks["dwell"].ok
    assert checks["dwell"].at_deg is not None
    assert found.linkage.error.dwell_flatness > 0.03


@pytest.mark.slow
def test_a_cam_that_the_mechanism_cannot_follow(tmp_path):
    """The checks say that, and where; the plain frame's are judged as ever."""
    spoilt = cam()
    k = int(LIFT.derivatives(np.arange(EDGES) * 2 * np.pi / EDGES, 0)[0].argmax())
    spoilt[k] *= 1.0 + 45.0 / np.hypot(*spoilt[k])
    intent = linked(INTENT, mechanism=Mechanism(InvertedSliderCrank(60.0, 0.0), LIFT, 50.0))
    verdict, checks = judged(write_dxf(tmp_path / "cam.dxf", spoilt), intent)
    assert verdict.linkage is None
    for name in LINKED:
        assert not checks[name].ok
        assert checks[name].value is None
        assert "binds at a relative angle of" in checks[name].detail
    assert not checks["motion"].ok
    assert checks["motion"].value > 1.0


def test_an_intended_mechanism_that_does_not_turn(tmp_path):
    """An inverted slider-crank of ground 20 turns the shaft back. No file can do what cannot be done."""
    intent = linked(INTENT, mechanism=Mechanism(InvertedSliderCrank(20.0, 0.0), LIFT, 50.0))
    _, checks = judged(written(tmp_path, "dxf", cam()), intent)
    for name in LINKED:
        assert not checks[name].ok
        assert "relative angle" in checks[name].detail


@pytest.mark.slow
def test_a_trimmed_cam_is_told_of_and_judged_by_given_limits_alone(tmp_path):
    path = written(tmp_path, "dxf", turned(cam(), 0.2))
    whole = linked(INTENT, dwell=None)
    trimmed = dataclasses.replace(whole, surfaces=(dataclasses.replace(whole.surfaces[0], trimmed=True),))
    verdict, checks = judged(path, trimmed)
    assert "linkage-error" not in checks
    assert verdict.linkage.error.max > verdict.linkage.limit
    assert "linkage-error" in failures(path, trimmed, Limits(E, output=0.01))
