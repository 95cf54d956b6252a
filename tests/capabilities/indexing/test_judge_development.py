"""Developments of a barrel: lines of a drawing, each judged for the radius at which it is unrolled.

Holds: kin.indexing.development, kin.read.drawing.straight.
"""

import math

import numpy as np
import pytest
from capabilities.indexing.turrets import GLOBOID, TURN, Barrel, Turret, changed

from kin.indexing.development import judged_line
from kin.indexing.judge import verify_development
from kin.numeric.limits import Limits
from kin.turned.files import Developed

LIMITS = Limits(0.01)
THETA = np.arange(-2.0 * TURN, 2.0 * TURN, 0.005)
BARREL = Turret()
LEADING = changed(BARREL, form=Barrel(50.0, 13.0, -57.0, 60.0, -1), start=0.2)


def line(turret, radius, name, theta=THETA):
    """Runs of points of a flank, unrolled, from face to face of the cam."""
    theta = theta[np.abs(turret.psi(theta)) < 1.1]
    side = {"lower": -1, "upper": 1}[name]
    more = turret.clearance if side > 0 else 0.0
    points = turret.on_layer(theta, turret.form.radius - radius, side, more)
    phi, z = np.unwrap(np.arctan2(points[:, 1], points[:, 0])), points[:, 2]
    flat = np.stack([radius * phi, z], axis=1)
    within = (z >= 0.0) & (z <= turret.length)
    heads = np.flatnonzero(np.diff(np.concatenate([[0], within.astype(int), [0]])))
    return [flat[a:b] for a, b in heads.reshape(-1, 2)]


def drawn(path, layers, insunits=4):
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = insunits
    space = document.modelspace()
    for layer, parts in layers.items():
        for part in parts:
            space.add_lwpolyline(part, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def judged(parts, radius, name, turret=BARREL, limits=LIMITS):
    flank, checks = judged_line(parts, turret.intent, Developed("L", radius, name), limits)
    return flank, {check.name: check for check in checks}


@pytest.mark.slow
@pytest.mark.parametrize("turret", [BARREL, LEADING, changed(BARREL, clearance=0.04)])
@pytest.mark.parametrize("name", ["lower", "upper"])
def test_a_line_is_right_at_its_radius_alone(turret, name):
    flank, checks = judged(line(turret, 48.0, name), 48.0, name, turret)
    assert all(check.ok for check in checks.values()), checks
    assert "at a radius of 48 mm alone" in checks["contour"].detail
    # chords of 0.3 mm leave h^2/8 of the curvature
    assert flank.measured_error < 1.5e-3
    assert flank.motion.max < math.degrees(1.5e-3 / 60.0) * 3.0
    _, elsewhere = judged([part * [44.0 / 48.0, 1.0] for part in line(turret, 48.0, name)], 44.0, name, turret)
    assert not elsewhere["contour"].ok


def test_a_line_of_the_other_flank():
    _, checks = judged(line(BARREL, 48.0, "upper"), 48.0, "lower")
    assert not checks["contour"].ok


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["lower", "upper"])
@pytest.mark.parametrize("by", [0.02, -0.02])
def test_a_bump_and_a_dent(name, by):
    parts = line(BARREL, 48.0, name)
    parts[0][np.abs(np.remainder(parts[0][:, 0] / 48.0, TURN) - 4.2).argmin(), 1] += by
    flank, checks = judged(parts, 48.0, name)
    assert not checks["contour"].ok
    # square to the line, and by its neighbours a little less
    assert 0.4 * abs(by) < flank.measured_error <= abs(by) + 1e-4
    if (by > 0.0) == (name == "lower"):  # in the rest the turret stands at 30 degrees
        assert flank.motion.most == pytest.approx(math.degrees(abs(by) / (60.0 * math.cos(math.pi / 6.0))), rel=0.03)


@pytest.mark.parametrize("name", ["lower", "upper"])
def test_a_line_across_a_track_whose_ends_are_right(name):
    """From a line up to itself a turn later: all of its points are at one angle, and both ends are on the flank."""
    radius = 48.0
    (whole,) = line(BARREL, radius, name)
    before = whole[whole[:, 0] + TURN * radius <= whole[-1, 0]]
    start = before[len(before) // 2]
    end = [start[0], np.interp(start[0] + TURN * radius, *whole.T)]
    flank, checks = judged([whole, np.array([start, end])], radius, name, limits=Limits(0.1))
    assert not checks["contour"].ok
    assert flank.measured_error > 10.0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lower", "upper"])
def test_a_line_that_is_missing(name):
    parts = line(BARREL, 48.0, name)
    _, checks = judged([part[:-200] for part in parts], 48.0, name)
    assert "missing" in checks["contour"].detail
    whole = parts[0]
    _, checks = judged([whole[:300], whole[305:]], 48.0, name)
    assert "missing" in checks["contour"].detail
    # runs in any order and direction that meet are one, and may go on beyond a turn
    _, checks = judged([whole[299:][::-1], whole[:300] + np.array([TURN * 48.0, 0.0])], 48.0, name)
    assert all(check.ok for check in checks.values()), checks


def test_a_file(tmp_path):
    lines = [Developed("LOWER_R50", 50.0, "lower"), Developed("UPPER_R40", 40.0, "upper")]
    layers = {one.layer: line(BARREL, one.radius, one.flank) for one in lines}
    path = drawn(tmp_path / "dev.dxf", {**layers, "OVERLAP": [np.array([[0.0, 0.0], [0.0, 70.0]])]})
    verdict = verify_development(path, BARREL.intent, lines, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert [flank.name for flank in verdict.flanks] == ["LOWER_R50", "UPPER_R40"]
    named = [("units", ""), *((name, own.layer) for own in lines for name in ("contour", "motion"))]
    assert [(check.name, check.surface) for check in verdict.checks] == named

    mirrored = changed(BARREL, mirrored=True).intent
    turned = drawn(tmp_path / "ccw.dxf", {name: [part * [-1.0, 1.0] for part in own] for name, own in layers.items()})
    assert verify_development(turned, mirrored, lines, LIMITS).ok
    assert not verify_development(turned, BARREL.intent, lines, LIMITS).ok
    assert not verify_development(path, BARREL.intent, [Developed("NONE", 50.0, "lower")], LIMITS).ok
    with pytest.raises(ValueError, match="globoid"):
        verify_development(path, GLOBOID.intent, lines, LIMITS)
    with pytest.raises(ValueError, match="no DXF"):
        verify_development(tmp_path / "dev.stl", BARREL.intent, lines, LIMITS)
