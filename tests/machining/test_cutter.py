"""The cutter's path: at its distance from kin's envelope all round; what it leaves, against a second library."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from support.cases import few
from support.heavy import ezdxf, shapely

from camgeo.curve.backwards import Backwards, least_hollow
from camgeo.curve.curve import Curve, SmoothRun
from camgeo.curve.undercut.causes import UndercutError
from camgeo.machining.cutter import cutter_path
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.read.files import read_drawing

ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
DEEP = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 4, delta: {cos: {1: 1500}}}\n"
DWELLS = """\
cam:
  kind: double-roller
  ratio: 2
  arm: 60
  roller_radius: 8
  law: [{dwell: 10}, {rise: 12, over: 30, law: cycloidal}, {dwell: 15}, {return: 12, over: 35, law: cycloidal}]
"""
SHU_WU = """\
cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]}
"""
REULEAUX = "cam: {kind: support, reuleaux: {sides: 3, breadth: 50, rounding: 5}, shaft: [3, 2]}\n"
TRIMMED = "cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\n"


def design_of(body):
    recipe = read(body.encode(), Path("c.yaml"))
    design = designed(recipe)
    assert design.only_surface.contour is not None
    return recipe, design


def points_of(arcs, per_piece=12):
    return Contour.from_bulges(arcs.points, arcs.bulges).sample(per_piece)


@pytest.mark.thin(2)
@pytest.mark.parametrize("body", [DWELLS, SHU_WU, REULEAUX, ROLLER])
def test_a_shape_run_backwards_is_the_same_shape(body):
    _, design = design_of(body)
    shape = design.only_surface.contour.shape
    back = Backwards(shape)
    breaks = back.breaks if len(back.breaks) else np.zeros(1)
    assert len(back.steady) == len(back.radii) == len(breaks)
    ends = np.append(breaks, breaks[0] + back.period)
    for i, (low, high) in enumerate(pairwise(ends)):
        t = low + (high - low) * np.array([0.1, 0.5, 0.83])
        here, there = back.sample(t), shape.sample(-t)
        assert np.allclose(here.point, there.point, rtol=0.0, atol=1e-12)
        assert np.allclose(here.normal, -there.normal, rtol=0.0, atol=1e-13)
        step = 1e-6
        for k, x in enumerate(t):
            near = back.sample(np.array([x - step, x + step]))
            slope = (near.point[1] - near.point[0]) / (2 * step)
            assert slope == pytest.approx(here.speed[k] * here.tangent[k], rel=1e-6, abs=1e-6)
            turned = (near.tangent[1] - near.tangent[0]) / (2 * step)
            assert turned == pytest.approx(-here.turn[k] * here.normal[k], rel=1e-6, abs=1e-6)
            assert (near.speed[1] - near.speed[0]) / (2 * step) == pytest.approx(
                here.speed_slope[k], rel=1e-5, abs=1e-4
            )
            assert (near.turn[1] - near.turn[0]) / (2 * step) == pytest.approx(here.turn_slope[k], rel=1e-5, abs=1e-4)
        if not np.isnan(back.steady[i, 0]):
            assert here.speed == pytest.approx(back.steady[i, 0])
            assert here.turn == pytest.approx(back.steady[i, 1])
        if not np.isnan(back.radii[i]):
            assert here.speed / here.turn == pytest.approx(back.radii[i])
        bounds = back.bounds(t[:1], t[2:])
        assert (bounds.turn_low <= here.turn).all()
        assert (here.turn <= bounds.turn_high).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "radius"),
    [(ROLLER, 3.0), (ROLLER, 8.0), (ROLLER, 18.0), (DWELLS, 5.0), (SHU_WU, 10.0), (REULEAUX, 1.0), (TRIMMED, 4.0)],
)
def test_the_path_keeps_its_distance_all_round(body, radius):
    _, design = design_of(body)
    path = cutter_path(design.only_surface.contour, radius)
    assert path.lost == ()
    arcs = path.arcs(0.001)
    feet = design.exact.gauge.envelope.feet(points_of(arcs))
    if body != TRIMMED:  # a trimmed cam's envelope is that of the motion, whose face would touch beside the corner
        assert np.abs(feet.excess - radius).max() <= arcs.bound.worst
        assert np.abs(feet.excess - radius).max() > 1e-4 or body == REULEAUX
    exact = shapely.Polygon(design.only_surface.contour.sample(_all(design.only_surface.contour)).point)
    apart = shapely.distance(exact.exterior, shapely.points(points_of(arcs)))
    assert apart == pytest.approx(radius, abs=1.1e-3)


def _all(contour):
    return np.concatenate([np.linspace(run.low, run.high, 8001)[:-1] for run in contour.runs])


@pytest.mark.slow
@pytest.mark.parametrize("radius", few([5.2, 9.0, 40.0], 3))
def test_what_a_cutter_leaves_in_a_hollow(radius):
    _, design = design_of(DEEP)
    path = cutter_path(design.only_surface.contour, radius)
    exact = shapely.Polygon(design.only_surface.contour.sample(_all(design.only_surface.contour)).point)
    closing = exact.buffer(radius, quad_segs=1000).buffer(-radius, quad_segs=1000)
    left = shapely.distance(closing.exterior, shapely.points(np.array(exact.exterior.coords))).max()
    assert max(cut.depth for cut in path.lost) == pytest.approx(left, abs=2e-4)
    assert len(path.lost) == 4
    hollow, at = least_hollow(design.only_surface.contour)
    assert all(cut.free_at == pytest.approx(hollow, rel=1e-9) for cut in path.lost)
    assert any(cut.start <= at + k * 2 * np.pi <= cut.end for cut in path.lost for k in (-1, 0, 1))
    arcs = path.arcs(0.01)
    apart = shapely.distance(exact.exterior, shapely.points(points_of(arcs)))
    assert apart.min() == pytest.approx(radius, abs=0.011), "the cutter never cuts into the contour"


@pytest.mark.slow
@pytest.mark.parametrize("top", few(["", "rotation: ccw\n"], 2))
def test_the_path_on_a_layer_of_its_own(tmp_path, top):
    body = top + ROLLER + "name: c\nexport: {files: [dxf, {dxf: {as: spline}}]}\nverify: {angles: 36}\n"
    body += "manufacture: {cutter: 8, layer: true}\n"
    outcome = pipeline.export(read(body.encode(), Path("c.yaml")), tmp_path)
    assert outcome.ok
    assert [c["file"] for c in outcome.report["checks"] if c["name"] == "cutter-reach"] == [
        "c.dxf",
        "c-spline.dxf",
    ]
    space = ezdxf.readfile(outcome.folder / "c.dxf").modelspace()
    (path,) = space.query("LWPOLYLINE[layer=='TOOLPATH']")
    rows = np.array(path.get_points("xyb"))
    drawing = read_drawing(outcome.folder / "c.dxf")
    apart = drawing.contour.distance(Contour.from_bulges(rows[:, :2], rows[:, 2]).sample(5))
    assert apart == pytest.approx(4.0, abs=2e-3)
    assert ("TOOLPATH", "LWPOLYLINE", 1) in drawing.aside
    outcome = pipeline.check(read(body.replace("cutter: 8", "cutter: 40").encode(), Path("c.yaml")))
    assert [c["name"] for c in outcome.report["checks"] if not c["ok"]] == ["cutter-reach"] * 2


@pytest.mark.slow
def test_a_hollow_is_reached_by_a_cutter_just_small_enough():
    _, design = design_of(DEEP)
    hollow, _ = least_hollow(design.only_surface.contour)
    assert hollow == pytest.approx(5.09385, abs=1e-5)
    assert cutter_path(design.only_surface.contour, hollow - 1e-6).lost == ()
    assert len(cutter_path(design.only_surface.contour, hollow + 1e-3).lost) == 4


def test_no_hollow_and_none_trimmed():
    _, design = design_of(SHU_WU)
    assert least_hollow(design.only_surface.contour)[0] == np.inf
    _, design = design_of(DEEP)
    low = design.only_surface.contour.runs[0].low
    part = Curve(design.only_surface.contour.shape, (SmoothRun(low, low + 6.0, (), closed=False),))
    assert cutter_path(part, 4.0).corners
    with pytest.raises(UndercutError, match="no wider than its roller, 8 mm"):
        cutter_path(part, 4.1)
