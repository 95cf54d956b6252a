"""Two surfaces on a shaft: the flanks of a groove and the discs of a pair, made by hand and found in files.

Flanks are offsets of a pitch curve in closed form, by numpy alone. What is left to the roller between them is held
against closed forms and against every point of both flanks; nothing here comes from camgeo.
"""

import dataclasses
import math

import numpy as np
import pytest
from support import followers
from support.camfiles import arcs_through, solid_triangles, write_stl
from support.heavy import ezdxf

from kin.follower.follower import followers_of
from kin.follower.guide import Arm, Line
from kin.judge.closure import judge_closures
from kin.judge.intent import ClosureIntent, Limits, PartIntent, SurfaceIntent
from kin.judge.verify import verify
from kin.law.contacts import Contact, Flat, Translating
from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula

TURN = 2 * math.pi
MEAN, ROLLER, CLEARANCE = 45.0, 9.0, 0.03
ECCENTRIC = "5*cos(t) + sqrt(2025 - 25*sin(t)**2)"  # a circle of MEAN about a point 5 mm off the shaft
WAVY = "45 + 4*cos(t) + 1.5*cos(2*t)"
LIMITS = Limits(1e-4)
GROOVE = ClosureIntent("inner", "outer")
MANY = 1200  # arcs of a flank


def law_of(text):
    return lift_from_formula(Formula(text)).law


def groove(law, clearance=CLEARANCE, guide=None, radius=ROLLER, **part):
    """The part, its flanks found by layer or by nesting; the outer one's gauge is wider by the clearance."""
    guide = Line() if guide is None else guide
    inner = SurfaceIntent(followers.roller(guide, radius, law), "inner", "GROOVE_INNER")
    outer = SurfaceIntent(
        followers.roller(guide, radius + clearance, law, side=-1),
        "outer",
        "GROOVE_OUTER",
        side=-1,
        follower=followers.roller(guide, radius, law, side=-1) if clearance else None,
    )
    return PartIntent((inner, outer), closures=(GROOVE,), **part)


def pitch(function, count=2 * MANY):
    """Points (n,) and outward normals (n,), complex, of a polar curve r(t)."""
    t, step = np.arange(count) * TURN / count, 1e-5
    r, slope = function(t), (function(t + step) - function(t - step)) / (2 * step)
    tangent = (slope + 1j * r) * np.exp(1j * t)
    return r * np.exp(1j * t), -1j * tangent / np.abs(tangent)


def wavy(t):
    return MEAN + 4 * np.cos(t) + 1.5 * np.cos(2 * t)


def eccentric(t):
    return 5 * np.cos(t) + np.sqrt(MEAN**2 - 25 * np.sin(t) ** 2)


def flank(function, offset, count=2 * MANY):
    point, normal = pitch(function, count)
    return point + offset * normal


def xy(points):
    return np.column_stack([points.real, points.imag])


def drawn(path, inner, outer, *, layers=("GROOVE_INNER", "GROOVE_OUTER"), bore=5.0, blank=None):
    """A DXF of flanks given as complex points, each as arcs; None for one that is missing."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    for points, layer in zip((inner, outer), layers, strict=True):
        if points is not None:
            vertices, bulges = arcs_through(xy(points))
            rows = [(x, y, b) for (x, y), b in zip(vertices.tolist(), bulges.tolist(), strict=True)]
            space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": layer})
    for radius, layer in ((bore, "BORE"), (blank, "CUT")):
        if radius:
            space.add_circle((0, 0), radius, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def sound(function, clearance=CLEARANCE):
    return flank(function, -ROLLER), flank(function, ROLLER + clearance)


def failures(verdict):
    return {(check.surface, check.name) for check in verdict.checks if not check.ok}


def brute(inner, outer, radius, theta):
    """How far a roller on a stem through the shaft may travel from flank to flank, by all their points."""
    there, far = inner * np.exp(-1j * theta), outer * np.exp(-1j * theta)
    near, wide = np.abs(there.imag) <= radius, np.abs(far.imag) <= radius
    held = (there.real + np.sqrt(radius**2 - np.minimum(there.imag**2, radius**2)))[near].max()
    stopped = far.real - np.sqrt(radius**2 - np.minimum(far.imag**2, radius**2))
    return stopped[wide & (far.real > held)].min() - held


@pytest.mark.slow
@pytest.mark.parametrize("layers", [("GROOVE_INNER", "GROOVE_OUTER"), ("CUT", "CUT")])
@pytest.mark.parametrize("blank", [None, 80.0])
def test_a_sound_groove_is_found_by_layer_and_by_nesting(tmp_path, layers, blank):
    path = drawn(tmp_path / "groove.dxf", *sound(wavy), layers=layers, blank=blank)
    part = groove(law_of(WAVY), bore=10.0, outline=None if blank is None else 2 * blank)
    verdict = verify(path, part, 180, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert [surface.name for surface in verdict.surfaces] == ["inner", "outer"]
    assert verdict.surfaces[0].perimeter < verdict.surfaces[1].perimeter
    by_surface = {(check.surface, check.name) for check in verdict.checks}
    assert by_surface >= {(name, figure) for name in ("inner", "outer") for figure in ("contour", "motion")}
    assert ("", "form-closure") in by_surface
    assert ("", "outer") in by_surface or blank is None


@pytest.mark.slow
@pytest.mark.parametrize("clearance", [1e-6, 0.03, 1.0])
def test_what_is_left_between_two_circles_in_closed_form(tmp_path, clearance):
    """Both flanks are circles about a point 5 mm off the shaft, and so is the path of a roller on either."""
    path = drawn(tmp_path / "groove.dxf", *sound(eccentric, clearance), bore=None)
    verdict = verify(path, groove(law_of(ECCENTRIC), clearance), 90, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    (closure,) = verdict.closures
    across = 5 * np.sin(np.linspace(0, TURN, 100_001))
    meant = np.sqrt((MEAN + clearance) ** 2 - across**2) - np.sqrt(MEAN**2 - across**2)
    assert closure.play.least == pytest.approx(meant.min(), abs=2e-9)
    assert closure.play.most == pytest.approx(meant.max(), abs=2e-9)
    assert closure.play.least_at_deg % 180 == pytest.approx(0.0, abs=1.0) or closure.play.least_at_deg % 180 > 179.0
    assert closure.play.most_at_deg % 180 == pytest.approx(90.0, abs=1.0)
    assert abs(closure.gauges.least) < 2e-9
    assert abs(closure.gauges.most) < 2e-9


def dented(count):
    """Flanks with a bump that takes from what is left, and a dent that adds to it."""
    t = np.arange(count) * TURN / count
    bump, dent = (by * np.exp(-(((t - at) / 0.2) ** 2)) * np.exp(1j * t) for by, at in ((0.004, 1.0), (0.006, 4.0)))
    return flank(wavy, -ROLLER, count) + bump, flank(wavy, ROLLER + CLEARANCE, count) + dent


@pytest.mark.slow
def test_what_is_left_between_two_flanks_by_every_point_of_them(tmp_path):
    path = drawn(tmp_path / "groove.dxf", *dented(2 * MANY), bore=None)
    (closure,) = verify(path, groove(law_of(WAVY)), 36, Limits(0.01)).closures
    worst = np.radians([closure.play.least_at_deg, closure.play.most_at_deg])
    fine = dented(200_000)  # a chord between two of them lies 4e-9 mm inside its arc
    left = np.array([brute(fine[0], fine[1], ROLLER, theta) for theta in (*np.linspace(0, TURN, 181), *worst)])
    assert closure.play.least == pytest.approx(left.min(), abs=1e-7)
    assert closure.play.most == pytest.approx(left.max(), abs=1e-7)
    assert left[-2:] == pytest.approx([closure.play.least, closure.play.most], abs=1e-7)


def _spoilt(fault):
    inner, outer = sound(wavy)
    return {
        "swapped": (outer, inner),
        "the outer flank under the roller itself": (inner, flank(wavy, ROLLER)),
        "the clearance of the wrong sign": (inner, flank(wavy, ROLLER - CLEARANCE)),
        "wide": (inner, flank(wavy, ROLLER + CLEARANCE + 1.5e-4)),
        "tight": (flank(wavy, -ROLLER + 1.5e-4), outer),
        "turned": (inner, outer * np.exp(1j * math.radians(0.02))),
    }[fault]


@pytest.mark.thin(6)
@pytest.mark.parametrize(
    ("fault", "caught"),
    [
        ("swapped", {("inner", "contour"), ("outer", "contour")}),
        ("the outer flank under the roller itself", {("outer", "contour"), ("outer", "motion"), ("", "form-closure")}),
        ("the clearance of the wrong sign", {("outer", "contour"), ("outer", "motion"), ("", "form-closure")}),
        ("wide", {("outer", "contour"), ("outer", "motion")}),
        ("tight", {("inner", "contour"), ("inner", "motion")}),
        ("turned", {("outer", "contour"), ("outer", "motion"), ("", "form-closure")}),
    ],
)
def test_planted_faults_are_caught(tmp_path, fault, caught):
    path = drawn(tmp_path / "groove.dxf", *_spoilt(fault))
    assert failures(verify(path, groove(law_of(WAVY), bore=10.0), 90, LIMITS)) >= caught


@pytest.mark.slow
@pytest.mark.parametrize("by", [0.9, 1.1])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_the_closure_has_two_sides(tmp_path, by, sign):
    """Both flanks within their tolerance, and the groove wider or narrower by nearly twice that."""
    off = sign * by * LIMITS.tolerance
    path = drawn(tmp_path / "groove.dxf", flank(wavy, -ROLLER - off), flank(wavy, ROLLER + CLEARANCE + off), bore=None)
    found = {check.name for check in verify(path, groove(law_of(WAVY)), 90, LIMITS).checks if not check.ok}
    assert found == (set() if by < 1.0 else {"contour", "motion", "form-closure"})
    strict = dataclasses.replace(LIMITS, play=1e-4)
    assert "form-closure" in {
        check.name for check in verify(path, groove(law_of(WAVY)), 90, strict).checks if not check.ok
    }


@pytest.mark.parametrize("missing", [0, 1])
@pytest.mark.parametrize("layers", [("GROOVE_INNER", "GROOVE_OUTER"), ("CUT", "CUT")])
def test_a_flank_that_is_missing(tmp_path, layers, missing):
    flanks = list(sound(wavy))
    flanks[missing] = None
    verdict = verify(
        drawn(tmp_path / "groove.dxf", *flanks, layers=layers, bore=None), groove(law_of(WAVY)), 90, LIMITS
    )
    (check,) = verdict.checks
    assert not check.ok
    named = ("inner", "outer")[missing] if layers[0] != "CUT" else "inner"
    assert check.detail == f"the {named} flank is missing, on which its follower runs"
    assert not verdict.surfaces
    assert not verdict.closures


@pytest.mark.slow
def test_the_flanks_of_an_arm(tmp_path):
    """In a circular groove about the shaft an arm does not move, and has j/(L cos alpha) to move in."""
    arm, radius = Arm(60.0, 75.0), 50.0
    lean = math.acos((60.0**2 + 75.0**2 - radius**2) / (2 * 60.0 * 75.0))
    part = groove(law_of(f"{lean!r} + 0*t"), guide=arm)
    circle = np.exp(1j * np.arange(2 * MANY) * TURN / (2 * MANY))
    path = drawn(tmp_path / "a.dxf", (radius - ROLLER) * circle, (radius + ROLLER + CLEARANCE) * circle, bore=None)
    verdict = verify(path, part, 90, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    (closure,) = verdict.closures
    wider = math.acos((60.0**2 + 75.0**2 - (radius + CLEARANCE) ** 2) / (2 * 60.0 * 75.0))
    assert closure.play.unit == "deg"
    assert (closure.play.least, closure.play.most) == pytest.approx((math.degrees(wider - lean),) * 2, abs=1e-9)


@pytest.mark.parametrize("back", [0.0, 0.02])
def test_two_discs_in_two_files(tmp_path, back):
    """Two flat faces D apart on two eccentric discs: p2(t + pi) = D - p1(t), and disc 2 may stand back."""
    apart = 100.0
    one = lift_from_formula(Formula("45 + 5*cos(t)"))
    contacts = (
        Contact(Translating(), Flat(), surface="disc 1"),
        Contact(Translating(), Flat(), apart, -1, turned=math.pi, surface="disc 2"),
    )
    gauges = followers_of(contacts, one.law, {"disc 1": 1, "disc 2": 1})
    first, second = (SurfaceIntent(gauge, name) for name, gauge in gauges.items())
    read = []
    for surface, radius in ((first, 45.0), (second, 55.0 - back)):
        document = ezdxf.new("R2010")
        document.header["$INSUNITS"] = 4
        document.modelspace().add_circle((5.0, 0.0), radius)
        document.saveas(tmp_path / "disc.dxf")
        verdict = verify(tmp_path / "disc.dxf", PartIntent((surface,)), 90, Limits(0.05))
        assert verdict.ok
        read.append((surface, verdict.contour))
    closures = (ClosureIntent("disc 1", "disc 2"), ClosureIntent("disc 1", "disc 3"))
    (closure,), (check,) = judge_closures(read, closures, LIMITS)
    assert (closure.play.least, closure.play.most) == pytest.approx((back, back), abs=1e-9)
    assert closure.gauges == closure.play
    assert check.ok is (back == 0.0)
    assert check.limit == pytest.approx(2e-4)


@pytest.mark.slow
def test_a_surface_in_a_section_of_its_own(tmp_path):
    """Two lobes of one solid, each judged at its height."""
    count = 720
    lobes = [xy(flank(lambda t, by=by: 30.0 + by * np.cos(t), 0.0, count)) for by in (2.0, 4.0)]
    bore = 5.0 * np.column_stack([np.cos(np.arange(count) * TURN / count), np.sin(np.arange(count) * TURN / count)])
    solid = np.concatenate(
        [solid_triangles(lobe, bore, z, z + 10.0) for lobe, z in zip(lobes, (0.0, 10.0), strict=True)]
    )
    path = write_stl(tmp_path / "lobes.stl", solid)
    # a knife edge on a stem feels the polar curve itself
    laws = [law_of(f"30 + {by}*cos(t)") for by in (2.0, 4.0)]
    surfaces = tuple(
        SurfaceIntent(followers.roller(Line(), 0.0, law), name, z=z)
        for law, name, z in zip(laws, ("low", "high"), (5.0, 15.0), strict=True)
    )
    verdict = verify(path, PartIntent(surfaces, bore=10.0), 36, Limits(0.01))
    assert {name for surface, name in failures(verdict) if surface} == set()
    swapped = tuple(dataclasses.replace(one, z=other.z) for one, other in zip(surfaces, surfaces[::-1], strict=True))
    assert failures(verify(path, PartIntent(swapped, bore=10.0), 36, Limits(0.01))) >= {
        (name, figure) for name in ("low", "high") for figure in ("contour", "motion")
    }
