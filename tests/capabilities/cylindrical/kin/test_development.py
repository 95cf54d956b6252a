"""Developments: lines of a drawing, each judged for the radius at which it is unrolled."""

import math

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Drum, Groove, Motion, replace

from kin.cylindrical import development
from kin.cylindrical.development import judged_line
from kin.cylindrical.judge import verify_development
from kin.numeric.limits import Limits
from kin.read.checks import UnitsError
from kin.turned.files import Developed

DRUM = Drum(track=Groove(12.5, 0.03))
THETA = np.linspace(-0.3, 2.0 * math.pi + 0.3, 2401)
LIMITS = Limits(0.01)


def line(radius, name, drum=DRUM, theta=THETA):
    """Points of a flank, or of the roller's axis, unrolled."""
    if name == "pitch":
        return np.stack([radius * theta, drum.level + drum.motion(theta)], axis=1)
    (flank,) = (own for own in drum.flanks if own[0] == name)
    phi, z = drum.touched(theta, np.array([radius]), *flank[1:])
    return np.stack([radius * phi[:, 0], z[:, 0]], axis=1)


def offset(radius, name):
    """The path of the roller's axis, offset by its radius in the drawing."""
    (_, side, roller, level) = next(own for own in DRUM.flanks if own[0] == name)
    a = np.arctan2(DRUM.motion(THETA, 1), radius)
    lift = level + DRUM.motion(THETA)
    return np.stack([radius * THETA - side * roller * np.sin(a), lift + side * roller * np.cos(a)], axis=1)


def drawn(path, layers, insunits=4, scale=1.0, curved=False):
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = insunits
    space = document.modelspace()
    for layer, points in layers.items():
        space.add_lwpolyline(points / scale, dxfattribs={"layer": layer})
        if curved:
            space.add_arc((0.0, 0.0), 1.0, 0.0, 90.0, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def judged(points, radius, name, limits=LIMITS, drum=DRUM):
    flank, checks = judged_line([points], drum.intent(), Developed("L", radius, name), limits)
    return flank, {check.name: check for check in checks}


@pytest.mark.parametrize("name", ["lower", "upper", "pitch"])
def test_a_line_is_right_at_its_radius_alone(name):
    flank, checks = judged(line(50.0, name), 50.0, name)
    assert all(check.ok for check in checks.values())
    assert "at a radius of 50 mm alone" in checks["contour"].detail
    # 2,400 chords leave 1e-4 mm
    assert flank.measured_error < 1e-4
    assert flank.motion.max < 5e-4
    _, elsewhere = judged(line(50.0, name) * [44.0 / 50.0, 1.0], 44.0, name)
    assert elsewhere["contour"].ok == (name == "pitch")


@pytest.mark.parametrize(("radius", "error"), [(50.0, 0.00918), (38.0, 0.0300)])
def test_an_offset_line_is_off_by_what_the_theory_says(radius, error):
    flank, checks = judged(offset(radius, "lower"), radius, "lower")
    # R sin a asin(R sin a2/r) + ... at the steepest place, of which R^3 sin^4 a/(6 r^2) is the leading term
    assert flank.measured_error == pytest.approx(error, rel=2e-3)
    steep = math.hypot(1.0, np.abs(DRUM.motion(THETA, 1)).max() / radius)
    assert flank.motion.max == pytest.approx(error * steep, rel=5e-3)
    assert checks["contour"].ok == (radius == 50.0)


def test_a_bump_and_a_dent_between_points():
    for by, key in ((0.02, "most"), (-0.02, "least")):
        theta = np.sort(np.append(THETA, [1.2346, 1.2348, 1.2350]))
        points = line(50.0, "lower", theta=theta)
        points[np.searchsorted(theta, 1.2348), 1] += by
        flank, checks = judged(points, 50.0, "lower")
        assert not checks["contour"].ok
        if by > 0.0:
            assert not checks["motion"].ok
            assert getattr(flank.motion, key) == pytest.approx(by, rel=0.01)


@pytest.mark.parametrize("name", ["lower", "pitch"])
def test_what_too_few_points_leave_open_counts(name, monkeypatch):
    monkeypatch.setattr(development, "MOST", 100)
    points = line(50.0, name, theta=np.linspace(-0.3, 2.0 * math.pi + 0.3, 100))
    flank, checks = judged(points, 50.0, name, Limits(0.05))
    assert flank.motion.remainder > 0.005
    assert checks["contour"].value == pytest.approx(flank.measured_error + flank.motion.remainder)
    assert checks["motion"].value == flank.motion.bound


def test_lines_that_do_not_go_round():
    points = line(50.0, "lower")
    _, checks = judged(points[:2000], 50.0, "lower")
    assert "does not go round" in checks["contour"].detail
    flank, checks = judged_line([points[:1000], points[1010:]], DRUM.intent(), Developed("L", 50.0, "lower"), LIMITS)
    assert "does not go round" in checks[0].detail
    assert flank.motion is None
    # lines in any order and direction, that meet, are one
    _, checks = judged_line([points[999:][::-1], points[:1000]], DRUM.intent(), Developed("L", 50.0, "lower"), LIMITS)
    assert all(check.ok for check in checks)


def test_what_an_undercut_loses_at_one_radius_is_told_and_not_judged():
    sharp = Motion(((15.0, 60.0, "cycloidal"), (0.0, 120.0, ""), (-15.0, 60.0, "cycloidal"), (0.0, 120.0, "")))
    drum = Drum(sharp, 12.0, 22.0, 40.0, 30.0, Groove(18.5), 40.0, 60.0, 8.0, shortened=True)
    phi = np.linspace(0.0, 2.0 * math.pi + 0.1, 4000)
    from capabilities.cylindrical.kin.drums import distances

    points = np.stack([22.0 * np.cos(phi), 22.0 * np.sin(phi), np.zeros_like(phi)], axis=1)
    z = -distances(drum, points, drum.flanks[0])[1]
    flank, checks = judged(np.stack([22.0 * phi, z], axis=1), 22.0, "lower", drum=drum)
    assert set(checks) == {"contour"}
    assert -0.43 < flank.motion.least < -0.386  # at 50 degrees 0.386911 is lost, and a little more beside it


@pytest.mark.slow
def test_a_file(tmp_path):
    lines = [Developed("R50_LOWER", 50.0, "lower"), Developed("R44_PITCH", 44.0, "pitch")]
    layers = {own.layer: line(own.radius, own.flank) for own in lines}
    path = drawn(tmp_path / "dev.dxf", {**layers, "OVERLAP": np.array([[0.0, 0.0], [0.0, 80.0]])})
    verdict = verify_development(path, DRUM.intent(), lines, LIMITS)
    assert verdict.ok, verdict.checks
    assert [flank.name for flank in verdict.flanks] == ["R50_LOWER", "R44_PITCH"]
    named = [("units", ""), *((name, own.layer) for own in lines for name in ("contour", "motion"))]
    assert [(check.name, check.surface) for check in verdict.checks] == named
    np.testing.assert_allclose(dict(verdict.lines)["R50_LOWER"], layers["R50_LOWER"])

    mirrored = replace(DRUM, mirrored=True).intent()
    turned = drawn(tmp_path / "ccw.dxf", {name: points * [-1.0, 1.0] for name, points in layers.items()})
    assert verify_development(turned, mirrored, lines, LIMITS).ok
    assert not verify_development(turned, DRUM.intent(), lines, LIMITS).ok

    inches = drawn(tmp_path / "inch.dxf", layers, insunits=1, scale=25.4)
    assert verify_development(inches, DRUM.intent(mm=25.4), lines, LIMITS).ok
    with pytest.raises(UnitsError):
        verify_development(inches, DRUM.intent(mm=25.4), lines, LIMITS, 1.0)
    bare = drawn(tmp_path / "bare.dxf", layers, insunits=0, scale=25.4)
    assert verify_development(bare, DRUM.intent(mm=25.4), lines, LIMITS, 25.4).ok
    assert not verify_development(bare, DRUM.intent(mm=25.4), lines, LIMITS).ok


def test_files_that_are_no_development(tmp_path):
    lines = [Developed("R50_LOWER", 50.0, "lower")]
    missing = drawn(tmp_path / "other.dxf", {"OTHER": line(50.0, "lower")})
    (_, check) = verify_development(missing, DRUM.intent(), lines, LIMITS).checks
    assert check.detail == "nothing is drawn on the layer R50_LOWER"
    curved = drawn(tmp_path / "arc.dxf", {"R50_LOWER": line(50.0, "lower")}, curved=True)
    (check,) = verify_development(curved, DRUM.intent(), lines, LIMITS).checks
    assert check.name == "readable"
    assert "is no straight line of a development" in check.detail
    with pytest.raises(ValueError, match="no DXF"):
        verify_development(tmp_path / "dev.stl", DRUM.intent(), lines, LIMITS)
