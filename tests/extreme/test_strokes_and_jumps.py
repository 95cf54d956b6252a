"""Strokes far smaller and larger than the base, rises over a hundredth of a degree, jumps of acceleration and jerk."""

import math
from functools import partial

import numpy as np
import pytest
from accuracy import ANGLES, Row, made, names, off_file, off_motion, off_profile, recipe, shown_as_measured
from extreme_oracle import constant_breadth

from camgeo.synthesis.design import designed
from kin.law.support_function import Circle

FORMS = "{dxf: {as: arcs}}, {dxf: {as: polyline}}, stl"


def cam(base_radius, segments):
    motion = ", ".join(
        f"{{rise: {stroke:.15f}, over: {over}, law: {law}}}" if law else f"{{dwell: {over}}}"
        for stroke, over, law in segments
    )
    return f"kind: constant-breadth\nbase_radius: {base_radius!r}\nmotion: [{motion}]"


SLOW = ()


def cases():
    """What finds the rows of each case, by name, in the order of the page."""
    return {
        **{f"low-{law}": partial(low, law) for law in ("cycloidal", "parabolic")},
        "tall-polynomial-345": tall,
        **{f"narrow-{law}": partial(narrow, law) for law in ("cycloidal", "harmonic", "parabolic", "polynomial-345")},
        "steep-cycloidal": steep,
        **{f"jump-{law}": partial(jump, law) for law in ("parabolic", "harmonic", "cycloidal")},
        "eccentric": eccentric,
    }


def low(law):
    return case(f"{law} stroke of 1e-9 of the base radius", 40.0, [(4e-8, 90, law), (0.0, 90, None)])


def tall():
    segments = [(4e4, 180, "polynomial-345")]
    return case("polynomial-345 stroke of 1e9 times the base radius", 4e-5, segments, tolerance=0.1)


def narrow(law):
    segments = [(0.0, 179, None), (1e-7, 0.01, law), (0.0, 0.99, None)]
    return case(f"{law} rise of 1e-7 mm over 0.01 degree", 40.0, segments, near=179.0, width=0.01)


def jump(law):
    return case(f"{law} rise of 20 mm over 120 degrees", 40.0, [(20.0, 120, law), (0.0, 60, None)])


def case(what, base_radius, segments, *, near=None, width=None, tolerance=1e-3):
    asked = recipe(cam(base_radius, segments), files=FORMS, thickness=10, tolerance=tolerance)
    oracle = constant_breadth(base_radius, segments)
    angles = ANGLES
    if near is not None:  # where it moves, too
        rise = np.radians(near + width * np.linspace(0.013, 0.987, 12))
        angles = np.concatenate([ANGLES, rise, rise + math.pi])
    files = made(asked)
    profile = off_profile(asked, oracle, angles)
    times = 1.0 if width is None else 180.0 / width
    yield Row(what, "profile", profile, 1e-14 * times, "angles are doubles: their rounding over the width of the rise")
    motion = off_motion(designed(asked).exact.law, oracle, angles)
    yield Row(what, "p to p'''", motion, 2e-14 * times, "the same")
    most = max(off_file(contour, oracle, tolerance, angles) for contour in files.contours.values())
    yield Row(what, f"files within {tolerance:g} mm", max(most, files.used()), 1.0, "share of the tolerance")


def steep():
    """Ten times the stroke over the same hundredth of a degree is no cam: the figure, from the law's own peak."""
    found = made(recipe(cam(40.0, [(1e-6, 0.01, "cycloidal"), (0.0, 179.99, None)])))
    width = math.radians(0.01)
    exact = 40.0 + 1e-6 * (0.75 + 1.0 / (2.0 * math.pi)) - 2.0 * math.pi * 1e-6 / width**2
    off = abs(found.check("radius-of-curvature")["value"] / exact - 1.0)
    assert not found.check("undercut-local")["ok"]
    yield Row("cycloidal rise of 1e-6 mm over 0.01 degree", "least radius, undercut reported", off, 1e-10, "as above")


def eccentric():
    asked = recipe(cam(40.0, [(20.0, 180, "harmonic")]), files=FORMS, thickness=10, tolerance=1e-3)
    oracle = constant_breadth(40.0, [(20.0, 180, "harmonic")])
    files = made(asked)
    (function,) = designed(asked).exact.law.law.functions
    assert isinstance(function, Circle)
    assert files.report["files"][0]["pieces"] == 2
    what = "harmonic rise of 20 mm over 180 degrees: an eccentric"
    profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
    yield Row(what, "profile, p to p'''", profile, 2e-15, "known for a circle")
    off = max(files.report["files"][0][name] for name in ("geometry_error", "measured_error"))
    yield Row(what, "two arcs, mm", off, 1e-12, "rounding of the file's coordinates")


@pytest.mark.thin(16)
@pytest.mark.parametrize("name", names(cases(), SLOW))
def test_it_holds_and_the_page_shows_it(name):
    shown_as_measured(__name__, name)
