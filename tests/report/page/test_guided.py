"""The drawing of followers on a stem or an arm: where they stand, where they touch the drawn cam, and what is plotted.

All is looked at in the drawing itself, turned back into the cam's axes, by means of its own."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import numpy as np
import pytest
from support.heavy import shapely

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.report.page import curves
from camgeo.report.page.content import DRAWN, content
from camgeo.report.page.scene import STEPS
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour

if TYPE_CHECKING:
    from camgeo.report.page.content import Content
    from camgeo.report.page.scene import MovingBody

DRAWN_TO = 1e-3  # mm: an exact contour is drawn by 1440 points
MOTION = (
    "  motion: [{dwell: 40}, {rise: %s, over: 110, law: modified-sine}, {dwell: 60},"
    " {return: %s, over: 100, law: cycloidal}, {dwell: 50}]\n"
)
ROUND = {
    "roller": ("kind: roller, radius: 9, offset: 8", 15, 9.0),
    "knife edge": ("kind: knife-edge, offset: -4", 12, 0.0),
    "shoe": ("kind: shoe, radius: 60, offset: 3", 15, 60.0),
    "arm": ("kind: roller, radius: 8, arm: {length: 65, pivot: 80}", 15, 8.0),
    "leading arm": ("kind: roller, radius: 8, arm: {length: 40, pivot: 75, side: leading}", 15, 8.0),
    "knife edge on an arm": ("kind: knife-edge, arm: {length: 60, pivot: 80}", 12, 0.0),
    "shoe on an arm": ("kind: shoe, radius: 25, arm: {length: 65, pivot: 90, side: leading}", 15, 25.0),
    "ring": ("kind: roller, radius: 9}\n  track: internal\n  x: {", 12, 9.0),
}
FLAT = {
    "face": ("kind: flat, offset: 5", 10),
    "tilted face": ("kind: flat, tilt: 8, offset: -5, width: 60", 10),
    "face on an arm": ("kind: flat, arm: {pivot: 90, face: 5}", 8),
    "face on a leading arm": ("kind: flat, arm: {pivot: 90, face: -4, side: leading}", 8),
}
YOKE = (
    "cam:\n  kind: constant-diameter\n  base_radius: 30\n  roller_radius: 8\n"
    "  motion: [{dwell: 40}, {rise: 12, over: 100, law: modified-sine}, {dwell: 40}]\n"
)
BOTH = pytest.mark.parametrize("rotation", ["cw", "ccw"])


@cache
def drawn(name: str, rotation: str) -> tuple[Any, Content]:
    """Recipe and what its page shows, without files: the cam is the exact contour."""
    follower, stroke = {**ROUND, **FLAT}.get(name, ("", 0))[:2]
    text = f"cam:\n  kind: disc\n  base_radius: 36\n  follower: {{{follower}}}\n{MOTION % (stroke, stroke)}"
    text = YOKE if name == "yoke" else text.replace("\n  x: {}", "")
    text += "part: {outer: 140}\n" if name == "ring" else ""
    recipe = load_text(f"rotation: {rotation}\n{text}", "guided.yaml")
    # dwells are found by what judges the files
    with patch.object(curves, "rests", return_value=[]):
        return recipe, content(recipe, designed(recipe), [])


def body(found: Content, name: str) -> MovingBody:
    (one,) = (each for each in found.scene.bodies if each.name == name)
    return one


def back(found: Content, at: np.ndarray) -> np.ndarray:
    """Places (STEPS + 1,) in the ground's frame as complex numbers, in the axes of the cam as drawn, (n, 2)."""
    turned = at * np.exp(-1j * body(found, "cam").pose[:, 2])
    return np.column_stack([turned.real, turned.imag])


def places(one: MovingBody) -> np.ndarray:
    return one.pose[:, 0] + 1j * one.pose[:, 1]


def contour(found: Content) -> Contour:
    """The contour as drawn: of a ring its opening."""
    rings = body(found, "cam").shapes[0].rings
    ring = rings[1] if len(rings) > 1 else rings[0]
    return Contour.from_bulges(ring.points, ring.bulges)


def touching(found: Content) -> MovingBody:
    return next(b for b in found.scene.bodies if b.name in {"roller", "knife edge", "shoe", "flat face"})


def plotted(found: Content, title: str) -> np.ndarray:
    (plot,) = (p for p in found.plots if p.title == title)
    return plot.series[0].values


@pytest.mark.thin(8)
@BOTH
@pytest.mark.parametrize("name", ROUND)
def test_a_centre_stays_its_radius_from_the_cam_and_the_contact_lies_between(name: str, rotation: str) -> None:
    _, found = drawn(name, rotation)
    radius, cam = ROUND[name][2], contour(found)
    centre, touch = places(touching(found)), body(found, "contact")
    assert np.abs(cam.distance(back(found, centre)) - radius).max() < DRAWN_TO
    point, push = places(touch), np.exp(1j * touch.pose[:, 2])
    assert cam.distance(back(found, point)).max() < DRAWN_TO
    assert np.abs(point + radius * push - centre).max() < 1e-9
    # the cam pushes away from its metal
    within = shapely.contains_xy(shapely.Polygon(cam.vertices), back(found, point + 0.01 * push))
    assert (within == (name == "ring")).all()


@pytest.mark.thin(6)
@BOTH
@pytest.mark.parametrize("name", ROUND)
def test_the_pressure_angle_is_that_between_the_arrow_and_the_way_of_the_centre(name: str, rotation: str) -> None:
    _, found = drawn(name, rotation)
    sense = 1.0 if rotation == "cw" else -1.0
    arrow, travel = body(found, "contact").pose[:, 2], touching(found).pose[:, 2]
    if name == "ring":
        arrow = arrow + math.pi
    angle = np.angle(np.exp(1j * (travel - arrow))) * sense
    assert np.abs(np.degrees(angle) - plotted(found, "Pressure angle")).max() < 1e-6
    # the centre moves along its travel
    step = np.diff(places(touching(found)))
    moved = np.abs(step) > 1e-3
    middle = np.exp(1j * 0.5 * (travel[1:] + travel[:-1]))[moved]
    assert np.abs(np.imag(step[moved] * middle.conj())).max() < 1e-3 * np.abs(step).max()
    if name != "ring":  # the cam drives the rise, at the same height with a greater angle than the return
        velocity = plotted(found, "Velocity")
        angles = plotted(found, "Pressure angle")
        assert angles[np.argmax(velocity)] > angles[np.argmin(velocity)]


@pytest.mark.thin(6)
@BOTH
@pytest.mark.parametrize("name", FLAT)
def test_a_face_is_tangent_to_the_cam_where_it_is_touched(name: str, rotation: str) -> None:
    _, found = drawn(name, rotation)
    face, touch, cam = touching(found), body(found, "contact"), contour(found)
    point, normal = places(touch), np.exp(1j * touch.pose[:, 2])
    assert cam.distance(back(found, point)).max() < DRAWN_TO
    corners = face.shapes[0].rings[0].points
    rim = cam.vertices[:, 0] + 1j * cam.vertices[:, 1]
    for step in range(0, STEPS, 60):
        # the edge of the face that looks at the cam
        ends = face.placed(corners[:2], step) @ np.array([1.0, 1j])
        along = (ends[1] - ends[0]) / abs(ends[1] - ends[0])
        place = np.real((point[step] - ends[0]) * np.conj(along))
        assert abs(np.imag((point[step] - ends[0]) * np.conj(along))) < 1e-9
        assert 0.0 < place < abs(ends[1] - ends[0])
        assert abs(np.real(along * np.conj(normal[step]))) < 1e-9
        seen = rim * np.exp(1j * body(found, "cam").pose[step, 2])
        assert np.real((seen - point[step]) * np.conj(normal[step])).max() < DRAWN_TO


@pytest.mark.thin(4)
@BOTH
@pytest.mark.parametrize("name", [name for name in (*ROUND, *FLAT) if "arm" in name])
def test_an_arm_keeps_its_pivot_and_swings_as_the_motion_says(name: str, rotation: str) -> None:
    recipe, found = drawn(name, rotation)
    arm, touch = body(found, "arm"), places(touching(found))
    assert np.ptp(arm.pose[:, :2], axis=0) == pytest.approx([0.0, 0.0])
    assert arm.pose[0, :2] == pytest.approx([recipe.cam.guide.pivot, 0.0])
    assert np.ptp(np.abs(touch - recipe.cam.guide.pivot)) < 1e-9
    if name in ROUND:
        assert abs(touch[0] - recipe.cam.guide.pivot) == pytest.approx(recipe.cam.guide.length)
    swing = np.degrees(arm.pose[:, 2] - arm.pose[0, 2])
    assert np.abs(np.abs(swing) - np.abs(plotted(found, "Swing"))).max() < 1e-9
    # trailing: clockwise of the pivot as drawn for cw, so below the line to the shaft
    below = ("leading" not in name and name != "shoe on an arm") == (rotation == "cw")
    assert (touch.imag < 0.0).all() == below


@pytest.mark.slow
def test_an_arm_whose_face_lies_beyond_its_pivot_does_not_cross_the_cam() -> None:
    recipe = load_text(
        "cam:\n  kind: disc\n  base_radius: 27\n  follower: {kind: flat, arm: {pivot: 45, face: -3}}\n"
        "  motion: {lobe: {lift: 9, half: 65, powers: [2, 8, 14, 20, 26]}}\n",
        "beyond.yaml",
    )
    with patch.object(curves, "rests", return_value=[]):
        found = content(recipe, designed(recipe), [])
    arm, cam = body(found, "arm"), shapely.Polygon(contour(found).vertices)
    outline = arm.shapes[0].rings[0].points @ np.array([1.0, 1j])
    shared = [
        cam.intersection(shapely.Polygon(np.column_stack([at.real, at.imag]))).area
        for turned, place, by in zip(places(arm), arm.pose, body(found, "cam").pose, strict=True)
        for at in [(turned + outline * np.exp(1j * place[2])) * np.exp(-1j * by[2])]
    ]
    assert max(shared) < 0.01


@BOTH
def test_both_rollers_of_a_frame_stay_on_the_cam(rotation: str) -> None:
    recipe, found = drawn("yoke", rotation)
    cam = contour(found)
    first, second = (places(body(found, f"roller {name}")) for name in "AB")
    assert np.abs(first - second - sum(one.datum for one in designed(recipe).follower.contacts)).max() < 1e-9
    for name, centre in zip("AB", (first, second), strict=True):
        touch = body(found, f"contact of roller {name}")
        assert np.abs(cam.distance(back(found, centre)) - 8.0).max() < DRAWN_TO
        assert np.abs(places(touch) + 8.0 * np.exp(1j * touch.pose[:, 2]) - centre).max() < 1e-9
    # the slot never reaches the shaft
    slot = body(found, "roller yoke").shapes[0].rings[1].flattened()
    for step in range(0, STEPS, 60):
        assert np.hypot(*(body(found, "roller yoke").placed(slot, step)).T).min() > 1.0
    (plot,) = (p for p in found.plots if p.title == "Pressure angle")
    assert [series.name for series in plot.series] == ["roller A", "roller B"]
    a, b = (series.values for series in plot.series)
    assert np.abs(a[: STEPS // 2] - b[STEPS // 2 : STEPS]).max() < 1e-9


def test_a_ring_has_its_metal_outside_up_to_its_outline() -> None:
    _, found = drawn("ring", "cw")
    outer, opening = body(found, "cam").shapes[0].rings
    assert np.hypot(*outer.points.T) == pytest.approx(70.0)
    assert np.hypot(*opening.points.T).max() == pytest.approx(48.0, abs=1e-3)
    assert not found.scene.note
    zero = np.concatenate([r.points for s in body(found, "cam").shapes if s.role == "zero" for r in s.rings])
    assert zero[:, 0].min() > 0.5 * opening.points[:, 0].max()
    assert zero[:, 0].max() == pytest.approx(70.0, abs=1e-3)
    assert not zero[:, 1].any()
    guide = body(found, "guide").shapes[0].rings[0].points
    assert guide[:, 0].min() > outer.points[:, 0].max()


def test_a_ring_s_file_is_held_against_its_opening() -> None:
    text = "cam:\n  kind: disc\n  base_radius: 36\n  track: internal\n  follower: {kind: roller, radius: 9}\n"
    text += MOTION % (12, 12)
    text += "name: ring\npart: {outer: 140, bolts: {count: 3, circle: 120, hole: 6}}\nexport: {files: [dxf]}\n"
    recipe = load_text(text, "ring.yaml")
    _, found = pipeline.check_and_show(recipe)
    (error,) = found.errors
    assert max(-error.low.min(), error.high.max()) < 0.001
    rings = body(found, "cam").shapes[0].rings
    assert len(rings) == 5
    assert np.hypot(*rings[0].points.T) == pytest.approx(70.0)


@pytest.mark.parametrize(
    ("name", "limit", "margin"),
    [("shoe", (1.0 / 60.0, "undercut by the shoe"), True), ("ring", (-1.0 / 9.0, "undercut by the roller"), False)],
)
def test_the_curvature_is_held_against_that_of_what_touches(name: str, limit: tuple[float, str], margin: bool) -> None:
    _, found = drawn(name, "cw")
    (plot,) = (p for p in found.plots if p.title == "Curvature of the pitch curve")
    ((value, touch),) = plot.limits
    assert value == pytest.approx(limit[0])
    assert touch == limit[1]
    assert ("from undercut" in plot.note) == margin


@pytest.mark.parametrize(
    ("rounding", "note"), [("", "radius 0 about sharp corners"), (", rounding: 4", "from undercut")]
)
def test_a_sharp_corner_is_no_undercut(rounding: str, note: str) -> None:
    recipe = load_text(f"cam: {{kind: support, reuleaux: {{sides: 3, breadth: 40{rounding}}}}}\n", "corners.yaml")
    with patch.object(curves, "rests", return_value=[]):
        found = content(recipe, designed(recipe), [])
    (plot,) = (p for p in found.plots if p.title == "Radius of curvature")
    assert note in plot.note
    assert ("undercut" in plot.note) == bool(rounding)


@pytest.mark.parametrize("name", ["roller", "shoe", "tilted face", "ring", "yoke"])
def test_a_guide_stands_clear_of_what_it_guides(name: str) -> None:
    _, found = drawn(name, "cw")
    start = body(found, "guide").shapes[0].rings[0].points[:, 0].min()
    for each in found.scene.bodies:
        if each.name in {"roller", "roller A", "roller B", "shoe", "flat face"}:
            for step in range(0, STEPS, 24):
                points = np.concatenate([each.placed(s.rings[0].flattened(), step) for s in each.shapes])
                assert points[:, 0].max() < start


@pytest.mark.slow
def test_every_follower_of_a_family_is_drawn() -> None:
    drawn_as = {designed(drawn(name, "cw")[0]).follower.arrangement for name in (*ROUND, *FLAT, "yoke")}
    assert len(drawn_as) == 9
    assert drawn_as <= set(DRAWN)
