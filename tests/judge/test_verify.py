"""The verdict as a whole: splines and ellipses, trimmed undercut, figures at the edge of their limits, what is said."""

import numpy as np
import pytest
from support import followers
from support.camfiles import circle_points, roller_points, solid_triangles, support_points, write_dxf, write_stl
from support.heavy import ezdxf, interpolate, shapely
from support.intent import findings, part_of

from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.follower.deviation import deviation
from kin.follower.envelope import RollerEnvelope, TransmissionPitch
from kin.follower.guide import Arm
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.judge.volume import volume_check
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import lift_from_fourier, lift_hypocycloid, lift_reuleaux
from kin.law.transmission import from_delta
from kin.numeric.check import Check, about, at_most, failed

PHI = np.arange(360) * 2 * np.pi / 360
HOLLOW = (4, 3, 60.0, {1: 625.0})
ROLLERS = followers.double_roller(from_delta(*HOLLOW, {}), 8.0)


def named(verdict):
    return {check.name: check for check in verdict.checks}


def spline_file(path, points_at, count, layer="CUT"):
    """One closed cubic SPLINE through exact points, its slopes exact to the differences' sixth order."""
    t = np.linspace(0.0, 2 * np.pi, count + 1)
    h = 1e-3
    slope = sum(w * (points_at(t + k * h) - points_at(t - k * h)) / h for k, w in ((1, 0.75), (2, -0.15), (3, 1 / 60)))
    points = points_at(t)
    points[-1], slope[-1] = points[0], slope[0]
    step = t[1]
    after, before = points[:-1] + slope[:-1] * step / 3, points[1:] - slope[1:] * step / 3
    control = np.concatenate([np.stack([points[:-1], after, before], axis=1).reshape(-1, 2), points[-1:]])
    knots = np.concatenate([[t[0]], np.repeat(t, 3), [t[-1]]])
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    spline = document.modelspace().add_spline(dxfattribs={"layer": layer, "degree": 3})
    spline.control_points, spline.knots = [(*p, 0.0) for p in control.tolist()], knots.tolist()
    document.modelspace().add_circle((0, 0), 5.0, dxfattribs={"layer": "BORE"})
    document.saveas(path)
    return path


def supported(t, mean=25.0, amplitude=2.0):
    p, slope = mean + amplitude * np.cos(3 * t), -3 * amplitude * np.sin(3 * t)
    return p[:, None] * unit(t) + slope[:, None] * unit(t + np.pi / 2)


# --- curves of other kinds --------------------------------------------------------------------------------------------


@pytest.mark.thin(4)
@pytest.mark.parametrize(("count", "expected"), [(30, 1e-2), (120, 1e-4), (480, 1e-6)])
def test_a_cubic_spline_in_a_yoke(tmp_path, count, expected):
    """Error measured by the verdict against the spline evaluated by scipy at 100 000 places."""
    path = spline_file(tmp_path / "cam.dxf", supported, count)
    yoke = followers.yoke(lift_hypocycloid(3, 2.0, 50.0), 50.0)
    verdict = verify(path, part_of(yoke, bore=10.0), 360, Limits(expected))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.pieces == count
    t = np.linspace(0.0, 2 * np.pi, count + 1)
    p2 = -18.0 * np.cos(3 * t)
    velocity = (25.0 + 2.0 * np.cos(3 * t) + p2)[:, None] * unit(t + np.pi / 2)
    fine = interpolate.CubicHermiteSpline(t, supported(t), velocity)(np.linspace(0.0, 2 * np.pi, 100_001))
    envelope = yoke.envelope
    seen = np.abs(envelope.feet(fine).excess).max()
    assert verdict.measured_error == pytest.approx(seen, rel=1e-3, abs=3e-9)
    assert verdict.motion.max == pytest.approx(seen, rel=1e-3, abs=3e-9)


def test_a_cubic_spline_under_rollers(tmp_path):
    def hollow(t):
        return ROLLERS.envelope.points(t)

    verdict = verify(spline_file(tmp_path / "cam.dxf", hollow, 400), part_of(ROLLERS, bore=10.0), 360, Limits(1e-5))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.motion.unit == "deg"
    assert verdict.play.unit == "mm"


def test_a_spoilt_control_point_of_a_spline(tmp_path):
    path = spline_file(tmp_path / "cam.dxf", supported, 120)
    document = ezdxf.readfile(path)
    spline = document.modelspace().query("SPLINE")[0]
    points = [tuple(p) for p in spline.control_points]
    points[100] = (points[100][0] + 0.02, *points[100][1:])
    spline.control_points = points
    document.saveas(path)
    verdict = verify(path, part_of(followers.yoke(lift_hypocycloid(3, 2.0, 50.0), 50.0), bore=10.0), 360, Limits(1e-3))
    assert not named(verdict)["contour"].ok


def test_an_ellipse_entity_works_a_right_angled_pair_exactly(tmp_path):
    """W section 5: lambda = 2, D = m^2 cos 2t. The ELLIPSE is exact, so is the motion."""
    a, b = np.sqrt(2 * (60.0**2 + 900.0)), np.sqrt(2 * (60.0**2 - 900.0))
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_ellipse((0, 0), (a, 0), b / a, dxfattribs={"layer": "CUT"})
    document.saveas(tmp_path / "ellipse.dxf")
    pair = followers.flat_pair(from_delta(2, 1, 60.0, {1: 900.0}, {}))
    verdict = verify(tmp_path / "ellipse.dxf", part_of(pair), 360, Limits(1e-8))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert set(named(verdict)) == {"units", "closed", "contour", "motion", "form-closure"}
    assert verdict.motion.max < 1e-9
    assert named(verdict)["form-closure"].unit == "deg"


def test_a_circle_entity_under_one_roller(tmp_path):
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((0, 0), 30.0, dxfattribs={"layer": "CUT"})
    document.saveas(tmp_path / "circle.dxf")
    lean = np.arccos((75.0**2 + 50.0**2 - 38.0**2) / (2 * 75.0 * 50.0))
    still = Piecewise(np.array([0.0, 2 * np.pi]), (Constant(lean),), 2 * np.pi, smooth_seam=True)
    verdict = verify(tmp_path / "circle.dxf", part_of(followers.roller(Arm(50.0, 75.0), 8.0, still)), 90, Limits(1e-9))
    assert verdict.ok
    assert verdict.play is None
    assert set(named(verdict)) == {"units", "closed", "contour", "motion"}


# --- on the edge ------------------------------------------------------------------------------------------------------


@pytest.mark.thin(3)
@pytest.mark.parametrize("e", [1e-1, 1e-3, 1e-6])
def test_a_contour_that_uses_the_whole_tolerance_just_holds(tmp_path, e):
    """A polygon with its corners outside a circle by exactly e, its edges inside by less."""
    radius, count = 30.0, 8 * int(np.ceil(np.pi * np.sqrt(30.0 / e) / 8))
    path = write_dxf(tmp_path / "cam.dxf", (radius + e) * circle_points(count), bores=())
    yoke = followers.yoke(lift_from_fourier(radius, {}, {}), 2 * radius)
    assert verify(path, part_of(yoke), 36, Limits(e)).ok
    less = named(verify(path, part_of(yoke), 36, Limits(e * (1 - 1e-4))))
    assert {name for name, check in less.items() if not check.ok} == {
        "contour",
        "motion",
        "constant-breadth",
        "breadth-max",
    }
    assert less["contour"].value == pytest.approx(e, rel=1e-6)
    assert less["breadth-max"].value == pytest.approx(2 * e, rel=1e-6)


@pytest.mark.slow
def test_default_limits_are_told(tmp_path):
    path = write_dxf(tmp_path / "cam.dxf", roller_points(3000, HOLLOW, 8.0))
    checks = named(verify(path, part_of(ROLLERS, bore=10.0), 90, Limits(2e-3)))
    assert checks["motion"].limit == ROLLERS.motion_limit(2e-3)
    assert checks["form-closure"].limit == ROLLERS.play_limit(2e-3)
    assert checks["contour"].limit == 2e-3
    assert checks["bore"].limit == 2e-3
    assert 0.0 <= checks["motion"].at_deg < 360.0


@pytest.mark.slow
def test_the_worst_place_is_told_as_a_shaft_angle(tmp_path):
    """A bump at polar angle 70 degrees of a circle under double rollers: contact there at phi = t + acos(r/2l)."""
    transmission = from_delta(3, 1, 60.0, {}, {})
    rollers = followers.double_roller(transmission, 8.0)
    pitch = 60.0 * np.sqrt(3.0)
    vertices = (pitch - 8.0) * circle_points(3600)
    vertices[700] *= 1.001
    path = write_dxf(tmp_path / "cam.dxf", vertices)
    checks = named(verify(path, part_of(rollers, bore=10.0), 360, Limits(1e-3)))
    assert not checks["contour"].ok
    assert checks["contour"].at_deg == pytest.approx(70.0 + 30.0, abs=1e-6)
    faces = followers.yoke(lift_from_fourier(pitch - 8.0, {}, {}), 2 * pitch - 16.0)
    checks = named(verify(path, part_of(faces, bore=10.0), 360, Limits(1e-3)))
    assert checks["contour"].at_deg == pytest.approx(70.0, abs=1e-6)


# --- trimmed ----------------------------------------------------------------------------------------------------------


def halfplanes(lift, count):
    """The body that every face position leaves: a polygon cut by shapely from the half-planes x.u <= p."""
    t = np.arange(count) * 2 * np.pi / count
    p = lift.derivatives(t, 0)[0]
    # its corners are the hull of the dual points u/p
    dual = shapely.MultiPoint(unit(t) / p[:, None]).convex_hull
    corners = np.array(dual.exterior.coords)[:-1]
    corners = corners if dual.exterior.is_ccw else corners[::-1]
    a, b = corners, np.roll(corners, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.column_stack([b[:, 1] - a[:, 1], a[:, 0] - b[:, 0]]) / cross[:, None]


@pytest.mark.slow
def test_a_trimmed_undercut_of_a_yoke(tmp_path):
    """p = 25 + 4 cos 3t has rho down to -7: three corners remain; the lift lost there is reported, not judged."""
    lift = lift_hypocycloid(3, 4.0, 50.0)
    points = halfplanes(lift, 6000)
    path = write_dxf(tmp_path / "cam.dxf", points)
    yoke = followers.yoke(lift, 50.0)
    verdict = verify(path, part_of(yoke, bore=10.0, trimmed=True), 3600, Limits(1e-3))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert set(named(verdict)) == {"units", "closed", "contour", "bore"}
    t = np.arange(6000) * 2 * np.pi / 6000
    lost = lift.derivatives(t, 0)[0] - (unit(t) @ points.T).max(axis=1)
    assert verdict.motion.max == pytest.approx(lost.max(), abs=1e-4)
    assert verdict.motion.max >= lost.max() - 1e-11
    assert verdict.motion.max > 0.05
    judged = named(verify(path, part_of(yoke, bore=10.0, trimmed=True), 3600, Limits(1e-3, motion=0.01)))
    assert not judged["motion"].ok
    assert not named(verify(path, part_of(yoke, bore=10.0), 3600, Limits(1e-3)))["motion"].ok


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("fault", [0.02, -0.02])
def test_a_fault_on_a_trimmed_contour(tmp_path, fault):
    lift = lift_hypocycloid(3, 4.0, 50.0)
    points = halfplanes(lift, 6000)
    points[1234] += fault * points[1234] / np.hypot(*points[1234])
    path = write_dxf(tmp_path / "cam.dxf", points)
    checks = named(verify(path, part_of(followers.yoke(lift, 50.0), bore=10.0, trimmed=True), 90, Limits(1e-3)))
    assert not checks["contour"].ok


@pytest.mark.slow
def test_a_corner_cut_off_a_sharp_reuleaux():
    """Cut by 0.9 e on either side of the corner, which itself is then missing by more than e."""
    breadth, e = 50.0, 0.01
    side = breadth / np.sqrt(3)
    corner = side * circle_points(3)
    t = np.linspace(-np.pi / 6, np.pi / 6, 1001)[1:-1]
    arcs = [corner[k] + breadth * unit(t + np.pi + 2 * np.pi * k / 3) for k in (2, 0, 1)]
    cut = side - 1.1 * e
    half = np.tan(np.pi / 3) * 1.1 * e  # the sides meet at 120 degrees
    pieces = []
    for k, arc in enumerate(arcs):
        pieces += [np.array([unit(2 * np.pi * k / 3)]) * side if k else np.array([[cut, -half], [cut, half]])]
        pieces += [arc]
    vertices = np.concatenate([pieces[0], *pieces[1:]])
    vertices = vertices[np.argsort(np.mod(np.arctan2(vertices[:, 1], vertices[:, 0]), 2 * np.pi))]
    contour = Contour.from_vertices(vertices)
    face = followers.flat_face(lift_reuleaux(3, breadth, 0.0))
    found = deviation(contour, face.envelope)
    assert found.outside < e
    assert found.inside < e
    assert found.bare == pytest.approx(1.1 * e, rel=1e-6)
    assert found.worst[0] == found.bare
    check = findings(contour, part_of(face), PHI, Limits(e)).checks[0]
    assert (check.name, check.ok) == ("contour", False)
    assert check.value == pytest.approx(1.1 * e, rel=1e-6)


@pytest.mark.slow
def test_a_trimmed_undercut_of_rollers(tmp_path):
    """A roller of 30 mm in hollows that are tighter: the contour is the pitch curve shrunk by shapely."""
    transmission = from_delta(*HOLLOW, {})
    rollers = followers.double_roller(transmission, 30.0)
    assert not RollerEnvelope(TransmissionPitch(transmission), 30.0).regular
    r, t = transmission.pitch(np.arange(40_000) * 2 * np.pi / 40_000, 0)
    shrunk = shapely.Polygon(r[0][:, None] * unit(t[0])).buffer(-30.0, quad_segs=4000)
    assert shrunk.geom_type == "Polygon"
    points = np.array(shrunk.exterior.coords)[:-1]
    points = points if shrunk.exterior.is_ccw else points[::-1]
    path = write_dxf(tmp_path / "cam.dxf", points, bores=())
    verdict = verify(path, part_of(rollers, trimmed=True), 360, Limits(1e-4))
    assert named(verdict)["contour"].ok
    assert verdict.motion.max > 0.01
    assert "motion" not in named(verdict)


# --- checks -----------------------------------------------------------------------------------------------------------


def test_checks_carry_their_figures():
    check = at_most("motion", 0.002, 0.001, "mm", angle=-np.pi / 2, detail="why")
    assert check == Check("motion", False, 0.002, 0.001, "mm", 270.0, "at_most", None, "why")
    assert about(check, "cam.dxf").file == "cam.dxf"
    assert at_most("x", 1.0 + 1e-12, 1.0, "mm", slack=1e-11).ok
    assert not at_most("x", 1.0 + 1e-10, 1.0, "mm", slack=1e-11).ok
    assert at_most("x", float("nan"), 1.0, "mm") == Check("x", False, None, 1.0, "mm")
    assert at_most("x", 0.0, 1.0, "mm", angle=float("nan")).at_deg is None
    assert failed("closed", "open").value is None
    assert at_most("x", 0.0, 1.0, "mm", angle=-1e-18).at_deg == 0.0


def test_no_contact_is_a_motion_that_fails(tmp_path):
    path = write_dxf(tmp_path / "cam.dxf", circle_points(100) + np.array([200.0, 0.0]), bores=())
    verdict = verify(path, part_of(ROLLERS), 90, Limits(1e-3))
    assert verdict.motion is None
    assert "does not touch the contour" in named(verdict)["motion"].detail
    assert not named(verdict)["contour"].ok


@pytest.mark.slow
def test_volume_from_the_intent_in_closed_form(tmp_path):
    """Rabinowitz's curve p = 9 + cos 3t: area 77 pi (Rabinowitz 1997); a plate of 4 mm with a bore of 4 mm."""
    yoke = followers.yoke(lift_from_fourier(9.0, {3: 1.0}, {}), 18.0)
    points = support_points(20_000, mean=9.0, harmonics=((3, 1.0, 0.0),))
    contour = Contour.from_vertices(points)
    expected = (77 * np.pi - 4 * np.pi) * 4.0
    check = volume_check(expected, 4.0, [contour], part_of(yoke, bore=4.0), 1e-6)
    assert check.ok
    assert check.value == pytest.approx(0.0, abs=1e-9)
    assert check.limit == pytest.approx(1e-6 * (18 * np.pi + 4 * np.pi) * 4.0, rel=1e-6)
    assert not volume_check(expected + 1.01 * check.limit, 4.0, [contour], part_of(yoke, bore=4.0), 1e-6).ok
    solid = solid_triangles(points, 2.0 * circle_points(20_000), 0.0, 4.0)
    path = write_stl(tmp_path / "cam.stl", solid)
    verdict = verify(path, part_of(yoke, bore=4.0, thickness=4.0), 90, Limits(1e-5))
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    assert verdict.kind == "stl"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("unit", "mm", "word"), [("inches", 25.4, "inch"), ("centimetres", 10.0, "cm"), ("mm", 1.0, "mm")]
)
def test_a_drawing_that_states_no_unit_tells_by_its_size(tmp_path, unit, mm, word):
    """Of a recipe in mm; what its size suggests is what judges it."""
    path = write_dxf(tmp_path / "cam.dxf", support_points(4000) / mm, units=0, bores=((0.0, 0.0, 5.0 / mm),))
    yoke = followers.yoke(lift_from_fourier(25.0, {3: 2.0}, {5: 0.3}), 50.0)
    part = part_of(yoke, bore=10.0)
    check = named(verify(path, part, 90, Limits(1e-3)))["units"]
    by_size = "" if mm == 1.0 else f"; by its size it is drawn in {unit}"
    assert check.detail.endswith(f", 1 mm{by_size}; give it by --units, such as --units {word}")
    assert verify(path, part, 90, Limits(1e-3), units=mm).ok


@pytest.mark.parametrize(("unit", "mm"), [("inches", 25.4), ("metres", 1000.0)])
def test_a_solid_that_is_too_small_by_a_unit_is_told_as_that(tmp_path, unit, mm):
    points = support_points(200, mean=9.0, harmonics=((3, 0.5, 0.0),))
    path = write_stl(tmp_path / "cam.stl", solid_triangles(points, 2.0 * circle_points(200), 0.0, 4.0) / mm)
    yoke = followers.yoke(lift_from_fourier(9.0, {3: 0.5}, {}), 18.0)
    checks = named(verify(path, part_of(yoke, bore=4.0, thickness=4.0), 90, Limits(1e-3)))
    assert not checks["thickness"].ok
    assert checks["thickness"].detail.endswith(f"as if drawn in {unit} and stated as mm")
