"""Spoilt files, each with one fault: every one must be caught by the check that is named here.

The sound files come from formulas by numpy alone (`camfiles`). A fault that moves the follower must be felt by contact,
one that contact cannot feel must be seen in the contour.
"""

import numpy as np
import pytest
from support import followers
from support.camfiles import (
    arcs_through,
    circle_points,
    roller_points,
    solid_triangles,
    support_points,
    write_dxf,
    write_lines,
    write_stl,
)
from support.cases import few
from support.heavy import ezdxf
from support.intent import gauge_of, part_of

from kin.follower.flat import Yoke
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.support_function import lift_from_fourier
from kin.law.transmission import from_delta

ANGLES = 120
EDGES = 2000  # of the polygons
ARCS = 600  # points, two for each arc
LIMITS = Limits(tolerance=1e-3)
HOLLOW = (4, 3, 60.0, {1: 625.0})
YOKE = followers.yoke(lift_from_fourier(25.0, {3: 2.0}, {5: 0.3}), 50.0)
ROLLERS = followers.double_roller(from_delta(*HOLLOW, {}), 8.0)
FRAME = followers.roller_yoke(8.0, lift_from_fourier(40.0, {3: 2.0}, {5: 0.3}).law, 80.0)


def opposite_roller_points(count):
    """Points at 8 mm inside the pitch curve r(theta) = 40 + 2 cos 3 theta + 0.3 sin 5 theta."""
    t = np.arange(count) * 2 * np.pi / count
    r, slope = 40 + 2 * np.cos(3 * t) + 0.3 * np.sin(5 * t), -6 * np.sin(3 * t) + 1.5 * np.cos(5 * t)
    along = (slope + 1j * r) * np.exp(1j * t)
    points = r * np.exp(1j * t) + 8.0 * 1j * along / np.abs(along)
    return np.stack([points.real, points.imag], axis=-1)


CAMS = {
    "yoke": (part_of(YOKE, bore=10.0, thickness=8.0), support_points),
    "double roller": (
        part_of(ROLLERS, bore=10.0, thickness=8.0),
        lambda count: roller_points(count, HOLLOW, 8.0),
    ),
    "roller yoke": (part_of(FRAME, bore=10.0, thickness=8.0), opposite_roller_points),
}


@pytest.fixture(params=CAMS)
def cam(request):
    return CAMS[request.param]


def failures(path, intent, limits=LIMITS):
    return {check.name for check in verify(path, intent, ANGLES, limits).checks if not check.ok}


def turned(points, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, s], [-s, c]])


def outward(points, k):
    """Unit normal at corner k, outward."""
    chord = points[(k + 1) % len(points)] - points[k - 1]
    return np.array([chord[1], -chord[0]]) / np.hypot(*chord)


# --- sound files ------------------------------------------------------------------------------------------------------


@pytest.mark.thin(6)
@pytest.mark.parametrize("form", ["polyline", "arcs", "lines", "stl"])
def test_a_sound_file_passes_every_check(tmp_path, cam, form):
    intent, points = cam
    if form == "polyline":
        path = write_dxf(tmp_path / "cam.dxf", points(EDGES))
    elif form == "arcs":
        path = write_dxf(tmp_path / "cam.dxf", *arcs_through(points(ARCS)))
    elif form == "lines":
        path = write_lines(tmp_path / "cam.dxf", points(1200), backwards=(3, 4, 500))
    else:
        path = stl(tmp_path, points(EDGES))
    verdict = verify(path, intent, ANGLES, LIMITS)
    assert verdict.ok, [check for check in verdict.checks if not check.ok]
    names = {"contour", "motion", "bore"}
    names |= {"constant-breadth", "breadth-max"} if isinstance(gauge_of(intent), Yoke) else {"form-closure"}
    names |= {"watertight", "thickness", "volume"} if form == "stl" else {"units", "closed"}
    assert {check.name for check in verdict.checks} == names
    assert {check.file for check in verdict.checks} == {path.name}
    assert verdict.pieces == {"polyline": EDGES, "arcs": ARCS // 2, "lines": 1200, "stl": EDGES}[form]
    assert 0 < verdict.measured_error < 1e-3
    assert verdict.motion.max > 0


# --- drawings ---------------------------------------------------------------------------------------------------------


@pytest.mark.thin(6)
@pytest.mark.parametrize("depth", [0.02, -0.02])
@pytest.mark.parametrize("k", [0, EDGES - 1])
def test_a_vertex_moved(tmp_path, cam, depth, k):
    """Outward it lifts the follower; inward on fine edges no follower feels it, and only the contour tells."""
    intent, points = cam
    spoilt = points(EDGES)
    spoilt[k] += depth * outward(spoilt, k)
    found = failures(write_dxf(tmp_path / "cam.dxf", spoilt), intent)
    assert "contour" in found
    assert ("motion" in found) == (depth > 0)


@pytest.mark.thin(3)
def test_a_vertex_moved_along_the_contour_until_it_turns_back(tmp_path, cam):
    intent, points = cam
    spoilt = points(EDGES)
    spoilt[40] += 1.5 * (spoilt[41] - spoilt[40])
    assert failures(write_dxf(tmp_path / "cam.dxf", spoilt), intent) & {"contour", "closed"}


@pytest.mark.slow
@pytest.mark.parametrize("factor", [-1.0, 0.0, 2.0])
@pytest.mark.parametrize("rank", [0, 10])
def test_one_bulge_flipped_or_left_out_or_doubled(tmp_path, cam, factor, rank):
    intent, points = cam
    vertices, bulges = arcs_through(points(ARCS))
    sagitta = np.abs(bulges) * np.hypot(*(np.roll(vertices, -1, axis=0) - vertices).T) / 2
    k = np.argsort(-sagitta)[rank]
    limits = Limits(tolerance=0.5 * sagitta[k])
    assert failures(write_dxf(tmp_path / "sound.dxf", vertices, bulges), intent, limits) == set()
    bulges[k] *= factor
    assert "contour" in failures(write_dxf(tmp_path / "cam.dxf", vertices, bulges), intent, limits)


@pytest.mark.thin(3)
def test_a_missing_segment(tmp_path, cam):
    intent, points = cam
    assert failures(write_lines(tmp_path / "cam.dxf", points(400), leave_out=(123,)), intent) == {"closed"}


@pytest.mark.slow
def test_a_reversed_segment(tmp_path, cam):
    """Two vertices of a polyline in the wrong order: within the tolerance everywhere, yet it runs back on itself."""
    intent, points = cam
    spoilt = points(EDGES)
    spoilt[[200, 201]] = spoilt[[201, 200]]
    verdict = verify(write_dxf(tmp_path / "cam.dxf", spoilt), intent, ANGLES, LIMITS)
    contour = next(check for check in verdict.checks if check.name == "contour")
    assert not contour.ok
    assert "turns back on itself" in contour.detail


@pytest.mark.thin(3)
def test_a_stretch_drawn_backwards(tmp_path, cam):
    intent, points = cam
    spoilt = points(EDGES)
    spoilt[200:240] = spoilt[200:240][::-1]
    assert {"contour", "closed"} & failures(write_dxf(tmp_path / "cam.dxf", spoilt), intent)


def test_an_open_contour(tmp_path, cam):
    intent, points = cam
    path = write_dxf(tmp_path / "cam.dxf", points(EDGES)[:-5], closed=False)
    assert failures(path, intent) == {"closed"}


@pytest.mark.slow
def test_a_contour_that_is_closed_by_a_chord(tmp_path, cam):
    """Twenty vertices left out: closed, but flat where it should be curved."""
    intent, points = cam
    assert "contour" in failures(write_dxf(tmp_path / "cam.dxf", points(EDGES)[:-40]), intent)


@pytest.mark.thin(6)
@pytest.mark.parametrize("scale", [1.001, 0.999])
def test_scale(tmp_path, cam, scale):
    intent, points = cam
    assert {"contour", "motion"} <= failures(write_dxf(tmp_path / "cam.dxf", scale * points(EDGES)), intent)


@pytest.mark.thin(6)
@pytest.mark.parametrize("degrees", [0.2, -0.2, 45.0])
def test_a_turn(tmp_path, cam, degrees):
    intent, points = cam
    assert {"contour", "motion"} <= failures(write_dxf(tmp_path / "cam.dxf", turned(points(EDGES), degrees)), intent)


@pytest.mark.thin(6)
@pytest.mark.parametrize("shift", [(0.01, 0.0), (0.0, -0.01)])
def test_a_shift(tmp_path, cam, shift):
    intent, points = cam
    assert {"contour", "motion"} <= failures(write_dxf(tmp_path / "cam.dxf", points(EDGES) + shift), intent)


@pytest.mark.thin(9)
@pytest.mark.parametrize(("units", "stated"), [(1, 25.4), (5, 10.0), (6, 1000.0)])
def test_wrong_units(tmp_path, cam, units, stated):
    intent, points = cam
    verdict = verify(write_dxf(tmp_path / "cam.dxf", points(EDGES), units=units), intent, ANGLES, LIMITS)
    check = next(check for check in verdict.checks if check.name == "units")
    assert not check.ok
    assert check.value == pytest.approx(stated - 1.0)
    assert check.limit == 1e-9
    assert f"{stated:g} mm, 1 mm is expected" in check.detail
    assert not verdict.ok


@pytest.mark.thin(3)
def test_no_units(tmp_path, cam):
    """Only the units are at fault: the rest is judged in those that were meant."""
    intent, points = cam
    assert failures(write_dxf(tmp_path / "cam.dxf", points(EDGES), units=0), intent) == {"units"}


@pytest.mark.thin(3)
def test_inches_meant_and_inches_drawn(tmp_path, cam):
    intent, points = cam
    inches = part_of(gauge_of(intent), mm=25.4, bore=10.0)
    path = write_dxf(tmp_path / "cam.dxf", points(EDGES) / 25.4, bores=[(0, 0, 5 / 25.4)], units=1)
    assert failures(path, inches) == set()
    # what the file states counts: mm are as good, as long as they are mm
    assert failures(write_dxf(tmp_path / "mm.dxf", points(EDGES)), inches) == set()
    inch = points(EDGES) / 25.4
    assert "units" in failures(write_dxf(tmp_path / "not.dxf", inch, bores=[(0, 0, 5 / 25.4)]), inches)


@pytest.mark.thin(3)
def test_everything_drawn_twice(tmp_path, cam):
    intent, points = cam
    assert "closed" in failures(write_dxf(tmp_path / "cam.dxf", points(EDGES), twice=True), intent)


@pytest.mark.thin(3)
def test_one_segment_drawn_twice(tmp_path, cam):
    intent, points = cam
    vertices = points(EDGES)

    def once_more(space):
        space.add_line(vertices[7], vertices[8], dxfattribs={"layer": "CUT"})

    assert "closed" in failures(write_dxf(tmp_path / "cam.dxf", vertices, extra=once_more), intent)


@pytest.mark.thin(3)
def test_a_segment_of_no_length(tmp_path, cam):
    intent, points = cam
    vertices = points(EDGES)
    doubled = np.insert(vertices, 50, vertices[50], axis=0)
    assert "closed" in failures(write_dxf(tmp_path / "cam.dxf", doubled), intent)


@pytest.mark.slow
def test_a_mirrored_cam(tmp_path, cam):
    intent, points = cam
    mirrored = points(EDGES) * [1.0, -1.0]
    path = write_dxf(tmp_path / "cam.dxf", mirrored)
    meant = part_of(gauge_of(intent), mirrored=True, bore=10.0)
    assert failures(path, meant) == set()
    if gauge_of(intent) is YOKE:  # which is not its own mirror image
        assert {"contour", "motion"} <= failures(path, intent)
        assert {"contour", "motion"} <= failures(write_dxf(tmp_path / "straight.dxf", points(EDGES)), meant)


@pytest.mark.thin(12)
@pytest.mark.parametrize(
    "bores",
    [
        pytest.param((), id="missing"),
        pytest.param(((0, 0, 5.0), (12, 0, 1.0)), id="one too many"),
        pytest.param(((0.01, 0, 5.0),), id="beside the shaft"),
        pytest.param(((0, 0, 5.01),), id="too wide"),
        pytest.param(((0, 0, 4.99),), id="too narrow"),
        pytest.param(((10, 0, 5.0),), id="elsewhere"),
    ],
)
def test_the_bore(tmp_path, cam, bores):
    intent, points = cam
    assert failures(write_dxf(tmp_path / "cam.dxf", points(EDGES), bores=bores), intent) == {"bore"}


@pytest.mark.thin(3)
def test_a_bore_where_none_is_meant(tmp_path, cam):
    intent, points = cam
    none = part_of(gauge_of(intent))
    assert failures(write_dxf(tmp_path / "cam.dxf", points(EDGES)), none) == {"bore"}
    assert failures(write_dxf(tmp_path / "plain.dxf", points(EDGES), bores=()), none) == set()


@pytest.mark.thin(9)
@pytest.mark.parametrize(("bore", "faults"), [(None, set()), (10.0, set()), (10.1, {"bore"}), ("elsewhere", {"bore"})])
def test_openings_that_are_passed_over(tmp_path, cam, bore, faults):
    """A part that is not closed has its own bore, whatever else there is."""
    intent, points = cam
    bores = ((12, 0, 1.0),) if bore == "elsewhere" else ((0, 0, 5.0), (12, 0, 1.0), (0, 0, 2.0))
    meant = part_of(gauge_of(intent), bore=10.0 if bore == "elsewhere" else bore, closed=False)
    assert failures(write_dxf(tmp_path / "cam.dxf", points(EDGES), bores=bores), meant) == faults


def test_an_angular_bore(tmp_path):
    """A square as large as the bore: right area at most, wrong everywhere."""
    intent, points = CAMS["yoke"]

    def square(space):
        side = 5.0 * np.sqrt(np.pi) / 2
        corners = [(side, side), (-side, side), (-side, -side), (side, -side)]
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "BORE"})

    path = write_dxf(tmp_path / "cam.dxf", points(EDGES), bores=(), extra=square)
    assert failures(path, intent) == {"bore"}


@pytest.mark.thin(3)
def test_a_contour_that_crosses_itself(tmp_path, cam):
    intent, points = cam
    vertices = points(EDGES)
    loop = vertices[100] + 0.0004 * np.array([[0.0, 0], [1, 0], [1, 1], [0.5, -1.0]])
    path = write_dxf(tmp_path / "cam.dxf", np.insert(vertices, 100, loop, axis=0))
    assert "closed" in failures(path, intent, Limits(tolerance=5e-3))


@pytest.mark.thin(3)
def test_a_drawing_cut_short(tmp_path, cam):
    intent, points = cam
    path = write_dxf(tmp_path / "cam.dxf", points(EDGES))
    path.write_bytes(path.read_bytes()[:-2000])
    assert failures(path, intent) == {"readable"}


def test_text_that_is_no_drawing(tmp_path, cam):
    path = tmp_path / "cam.dxf"
    path.write_text("a cam, drawn from memory\n")
    assert failures(path, cam[0]) == {"readable"}


def test_an_empty_drawing(tmp_path, cam):
    document = ezdxf.new("R2010")
    document.saveas(tmp_path / "cam.dxf")
    assert failures(tmp_path / "cam.dxf", cam[0]) == {"readable"}


@pytest.mark.slow
@pytest.mark.parametrize("depth", few([0.002, 0.3], 2))
def test_a_dent_in_a_hollow_that_neither_roller_feels(tmp_path, depth):
    """A scratch narrower than the roller, at the bottom of a hollow: both rollers pass over it."""
    intent, points = CAMS["double roller"]
    vertices = points(20_000)
    r = np.hypot(*vertices.T)
    k = int(r.argmin())
    vertices[k] -= depth * outward(vertices, k)
    assert failures(write_dxf(tmp_path / "cam.dxf", vertices), intent) == {"contour"}


@pytest.mark.slow
@pytest.mark.parametrize("depth", few([0.0005, 0.002], 2))
def test_a_dent_that_no_flat_face_feels_counts_with_its_depth(tmp_path, depth):
    """A face passes over a dent of any depth; it is metal missing, measured as such and held against the tolerance."""
    intent, points = CAMS["yoke"]
    vertices = points(20_000)
    vertices[7] -= depth * outward(vertices, 7)
    verdict = verify(write_dxf(tmp_path / "cam.dxf", vertices), intent, 360, LIMITS)
    assert verdict.measured_error == pytest.approx(depth, rel=0.01)
    assert verdict.motion.max < 1e-5
    assert [check.name for check in verdict.checks if not check.ok] == ["contour"] * (depth > LIMITS.tolerance)


@pytest.mark.slow
def test_metal_left_in_a_hollow_is_felt_and_seen(tmp_path):
    intent, points = CAMS["double roller"]
    vertices = points(20_000)
    k = int(np.hypot(*vertices.T).argmin())
    vertices[k] += 0.005 * outward(vertices, k)
    verdict = verify(write_dxf(tmp_path / "cam.dxf", vertices), intent, 3600, LIMITS)
    assert {check.name for check in verdict.checks if not check.ok} == {"contour", "motion", "form-closure"}
    assert verdict.measured_error == pytest.approx(0.005, rel=0.01)


def test_two_contours_each_within_the_tolerance_can_jam_a_yoke(tmp_path):
    """All corners outside by 0.9 e: within the tolerance, and the breadth 1.8 e too large; a play limit of e tells."""
    intent, _ = CAMS["yoke"]
    path = write_dxf(tmp_path / "cam.dxf", support_points(EDGES, mean=25.0009))
    assert failures(path, intent) == set()
    assert failures(path, intent, Limits(1e-3, play=1e-3)) == {"constant-breadth", "breadth-max"}
    narrow = write_dxf(tmp_path / "narrow.dxf", support_points(EDGES, mean=24.9992))
    assert failures(narrow, intent, Limits(1e-3, play=1e-3)) == {"constant-breadth"}


@pytest.mark.thin(3)
def test_a_motion_limit_of_the_callers_own(tmp_path, cam):
    intent, points = cam
    path = write_dxf(tmp_path / "cam.dxf", points(EDGES))
    reached = verify(path, intent, ANGLES, LIMITS).motion.max
    assert failures(path, intent, Limits(1e-3, motion=1.01 * reached)) == set()
    assert failures(path, intent, Limits(1e-3, motion=0.99 * reached)) == {"motion"}


# --- solids -----------------------------------------------------------------------------------------------------------


def triangles_of(points, low=0.0, high=8.0, bore=5.0):
    return solid_triangles(points, bore * circle_points(len(points)), low, high)


def moved(triangles, x, z):
    return triangles + np.array([x, 0.0, z])


def stl(folder, points, **shape):
    return write_stl(folder / "cam.stl", triangles_of(points, **shape))


def test_a_solid_with_a_triangle_missing(tmp_path, cam):
    intent, points = cam
    found = failures(write_stl(tmp_path / "cam.stl", triangles_of(points(EDGES))[1:]), intent)
    assert "watertight" in found


@pytest.mark.thin(6)
@pytest.mark.parametrize("which", [0, 5, -1])
def test_a_solid_with_one_triangle_flipped(tmp_path, cam, which):
    intent, points = cam
    triangles = triangles_of(points(EDGES))
    triangles[which] = triangles[which][::-1]
    assert "watertight" in failures(write_stl(tmp_path / "cam.stl", triangles), intent)


@pytest.mark.thin(3)
def test_a_solid_turned_inside_out(tmp_path, cam):
    intent, points = cam
    assert "watertight" in failures(write_stl(tmp_path / "cam.stl", triangles_of(points(EDGES))[:, ::-1]), intent)


def test_a_solid_with_a_triangle_twice(tmp_path, cam):
    intent, points = cam
    triangles = triangles_of(points(EDGES))
    doubled = np.concatenate([triangles, triangles[:1]])
    assert "watertight" in failures(write_stl(tmp_path / "cam.stl", doubled), intent)


@pytest.mark.parametrize("lost", [1, 50, 10_000])
def test_a_solid_cut_short(tmp_path, cam, lost):
    intent, points = cam
    path = stl(tmp_path, points(EDGES))
    path.write_bytes(path.read_bytes()[:-lost])
    assert failures(path, intent) == {"readable"}


@pytest.mark.thin(3)
def test_a_solid_moved(tmp_path, cam):
    intent, points = cam
    aside = write_stl(tmp_path / "aside.stl", moved(triangles_of(points(EDGES)), 0.02, 0.0))
    assert {"contour", "motion", "bore"} <= failures(aside, intent)
    raised = write_stl(tmp_path / "up.stl", moved(triangles_of(points(EDGES)), 0.0, 0.02))
    assert failures(raised, intent) == {"thickness"}


@pytest.mark.thin(3)
def test_a_solid_too_thick(tmp_path, cam):
    intent, points = cam
    assert failures(stl(tmp_path, points(EDGES), high=8.01), intent) == {"thickness"}


@pytest.mark.thin(3)
def test_a_solid_in_inches(tmp_path, cam):
    intent, points = cam
    path = write_stl(tmp_path / "cam.stl", triangles_of(points(EDGES)) / 25.4)
    assert {"contour", "motion", "thickness"} <= failures(path, intent)


@pytest.mark.slow
def test_a_solid_whose_top_differs_from_its_bottom(tmp_path, cam):
    """One corner of the top moved: the walls lean, and the section halfway up tells half of it."""
    intent, points = cam
    triangles = triangles_of(points(EDGES))
    corner = np.append(points(EDGES)[33], 8.0)
    at = (np.abs(triangles - corner) < 1e-9).all(axis=2)
    assert at.sum() >= 3
    triangles[at] += [0.02, 0.0, 0.0]
    assert "thickness" in failures(write_stl(tmp_path / "cam.stl", triangles), intent)


@pytest.mark.thin(2)
def test_a_solid_without_its_bore(tmp_path, cam):
    intent, points = cam
    vertices = points(EDGES)
    # a bore that shrinks to nothing: fans about the shaft instead of the ring
    fan = triangles_of(vertices, bore=0.0)
    flat = np.cross(fan[:, 1] - fan[:, 0], fan[:, 2] - fan[:, 0])
    fan = fan[np.abs(flat).max(axis=1) > 0]
    assert failures(write_stl(tmp_path / "cam.stl", fan), intent) == {"bore", "volume"}


@pytest.mark.thin(3)
def test_a_solid_with_a_wide_bore(tmp_path, cam):
    intent, points = cam
    assert {"bore", "volume"} <= failures(stl(tmp_path, points(EDGES), bore=5.05), intent)


@pytest.mark.slow
def test_a_solid_scaled_or_turned(tmp_path, cam):
    intent, points = cam
    assert {"contour", "motion", "volume"} <= failures(stl(tmp_path, 1.001 * points(EDGES)), intent)
    assert {"contour", "motion"} <= failures(stl(tmp_path, turned(points(EDGES), 0.2)), intent)


@pytest.mark.slow
def test_a_solid_with_a_corner_moved(tmp_path, cam):
    intent, points = cam
    spoilt = points(EDGES)
    spoilt[5] -= 0.02 * outward(spoilt, 5)
    found = failures(stl(tmp_path, spoilt), intent)
    assert "contour" in found
    assert "motion" not in found


# --- the file itself --------------------------------------------------------------------------------------------------


def test_a_missing_file_and_another_suffix_are_the_callers_affair(tmp_path, cam):
    with pytest.raises(FileNotFoundError):
        verify(tmp_path / "cam.dxf", cam[0], ANGLES, LIMITS)
    (tmp_path / "cam.png").write_text("<svg/>")
    with pytest.raises(ValueError, match=r"cam\.png: none of \.dxf, \.svg, \.stl"):
        verify(tmp_path / "cam.png", cam[0], ANGLES, LIMITS)
    with pytest.raises(ValueError, match="one shaft angle at least, not 0"):
        verify(tmp_path / "cam.dxf", cam[0], 0, LIMITS)


@pytest.mark.thin(3)
def test_the_suffix_may_be_in_capitals(tmp_path, cam):
    intent, points = cam
    path = write_dxf(tmp_path / "CAM.DXF", points(EDGES))
    assert verify(path, intent, ANGLES, LIMITS).ok
