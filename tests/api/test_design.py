"""`camgeo.design`: motion, contour, edges and figures against other ways to have them.

Holds: camgeo.api.cam, camgeo.api.check, camgeo.api.json_value, camgeo.api.log.
"""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.cases import few
from support.groove import CAM, grooved

import camgeo

if TYPE_CHECKING:
    from camgeo.schema.change import Value

ROOT = Path(__file__).parents[2]
NAMES = ("shu-wu", "fourier", "w-law", "oscillating-yoke", "as-figure-1", "slider-crank", "reuleaux")


@pytest.fixture(scope="module", params=few(NAMES, 2))
def design(request: pytest.FixtureRequest) -> camgeo.Design:
    return camgeo.design(camgeo.load(ROOT / "recipes" / f"{request.param}.yaml"))


@pytest.mark.thin(4)
def test_the_motion_is_that_of_the_table(design: camgeo.Design, tmp_path: Path) -> None:
    recipe = design.recipe.replace({"verify.angles": 48, "export.files": ["csv"]})
    report = camgeo.export(recipe, tmp_path)
    assert report.path is not None
    table = np.genfromtxt(report.path / f"{recipe.name}.csv", delimiter=",", names=True)
    names = table.dtype.names or ()
    position = next(n for n in names if n.startswith(("lift_", "follower_", "output_")))
    unit = math.degrees(1.0) if design.unit == "rad" else 1.0 / recipe.mm
    theta = np.radians(table["shaft_deg"][:-1])
    for order, name in enumerate((position, "velocity", "acceleration")):
        shown = table[name][:-1]
        at = design.motion(theta, derivative=order) * unit
        assert np.abs(at - shown).max() <= 1e-6 * max(1.0, np.abs(shown).max())


@pytest.mark.thin(2)
def test_derivatives_are_those_of_the_motion(design: camgeo.Design) -> None:
    theta, step = np.array([0.31, 1.7, 2.9, 4.4]), 1e-5
    for order in range(2):
        slope = (design.motion(theta + step, derivative=order) - design.motion(theta - step, derivative=order)) / (
            2 * step
        )
        found = design.motion(theta, derivative=order + 1)
        assert np.allclose(slope, found, rtol=1e-5, atol=1e-5 * max(1.0, np.abs(found).max()))


def test_shapes_go_through(design: camgeo.Design) -> None:
    grid = np.array([[0.1, 0.2, 0.3], [4.0, 5.0, 6.0]])
    assert design.motion(grid).shape == (2, 3)
    one = design.motion(0.2)
    assert isinstance(one, float)
    assert one == design.motion(grid)[0, 1]
    assert design.motion([]).shape == (0,)
    assert design.motion(0.2 + 6 * math.pi) == pytest.approx(one, abs=1e-9)


def test_the_contour_is_that_of_the_edges(design: camgeo.Design) -> None:
    """Area within the points and within the arcs; each point within the proved bound of an arc."""
    points, edges = design.contour(4000), design.edges(0.01)
    x, y = points.T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    round_about = float(np.hypot(*(np.roll(points, -1, axis=0) - points).T).sum())
    assert area > 0.0
    assert abs(area - edges.area) <= round_about * edges.bound + 1e-4 * area
    assert edges.bound <= 0.01
    for point in points[::400]:
        assert min(distance(edge, point) for edge in edges) <= edges.bound * (1.0 + 1e-9)


def distance(edge: object, point: np.ndarray) -> float:
    """From an arc or a line, for a point beside it; else from its nearer end."""
    assert isinstance(edge, camgeo.Arc | camgeo.Line)
    ends = min(math.dist(edge.start, point), math.dist(edge.end, point))
    if isinstance(edge, camgeo.Line):
        (x0, y0), (x1, y1) = edge.start, edge.end
        length = math.dist(edge.start, edge.end)
        along = ((point[0] - x0) * (x1 - x0) + (point[1] - y0) * (y1 - y0)) / length
        across = ((point[0] - x0) * (y1 - y0) - (point[1] - y0) * (x1 - x0)) / length
        return abs(across) if 0.0 <= along <= length else ends
    angle = [math.atan2(p[1] - edge.center[1], p[0] - edge.center[0]) for p in (edge.start, point)]
    turned = math.remainder(angle[1] - angle[0] - 0.5 * edge.sweep, math.tau)
    if abs(turned) <= 0.5 * abs(edge.sweep):
        return abs(math.dist(edge.center, point) - edge.radius)
    return ends


def test_arcs_hold_together(design: camgeo.Design) -> None:
    edges = design.edges(0.01)
    for i, edge in enumerate(edges):
        assert isinstance(edge, camgeo.Arc | camgeo.Line)
        assert edge.end == edges[(i + 1) % len(edges)].start
        if isinstance(edge, camgeo.Arc):
            size = edge.radius + math.dist(edge.center, (0.0, 0.0))
            for p in (edge.start, edge.middle, edge.end):
                assert math.dist(edge.center, p) == pytest.approx(edge.radius, abs=1e-14 * size * size)
            a, b = ((p[0] - edge.center[0], p[1] - edge.center[1]) for p in (edge.start, edge.end))
            turned = math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
            assert turned == pytest.approx(edge.sweep, abs=1e-6)


def test_it_is_drawn_as_the_shaft_turns() -> None:
    recipe = camgeo.load(ROOT / "recipes" / "shu-wu.yaml")
    cw, ccw = (camgeo.design(recipe.replace("rotation", way)) for way in ("cw", "ccw"))
    assert np.array_equal(ccw.contour(50)[0], cw.contour(50)[0] * [1.0, -1.0])
    assert np.array_equal(ccw.contour(50)[1], cw.contour(50)[-1] * [1.0, -1.0])
    assert ccw.edges(0.01).area == pytest.approx(cw.edges(0.01).area)


def test_polyline_and_spline() -> None:
    design = camgeo.design(camgeo.load(ROOT / "recipes" / "fourier.yaml"))
    lines, spline = design.edges(0.01, "polyline"), design.edges(1e-5, "spline")
    assert all(isinstance(edge, camgeo.Line) for edge in lines)
    (one,) = spline
    assert isinstance(one, camgeo.Spline)
    assert len(one.knots) == len(one.control) + one.degree + 1
    assert spline.area == pytest.approx(design.edges(1e-5).area, rel=1e-6)
    assert lines.area == pytest.approx(spline.area, rel=1e-3)


def test_figures_and_checks_are_in_the_recipe_s_unit() -> None:
    mm = camgeo.load(ROOT / "recipes" / "shu-wu.yaml").replace("limits", {"radius-of-curvature": {"at_least": 30}})
    numbers: dict[str, Value] = {
        "cam.base_radius": 40 / 25.4,
        "cam.motion[0].rise": 20 / 25.4,
        "part": {"thickness": 8 / 25.4, "bore": 20 / 25.4},
    }
    inch = mm.replace({"units": "inch", **numbers, "limits": {"radius-of-curvature": {"at_least": 30 / 25.4}}})
    a, b = camgeo.design(mm), camgeo.design(inch)
    for name, unit in (("radius-of-curvature", "mm"), ("peak-velocity", "mm/rad"), ("size", "mm")):
        one, other = a.figures[name], b.figures[name]
        assert (one.unit, other.unit) == (unit, unit.replace("mm", "in"))
        assert one.value == pytest.approx(25.4 * (other.value or 0.0))
        assert str(one).endswith(f"{unit} at {one.at_deg:.2f} deg")
    limits = [next(check for check in d.checks if check.name == "limit:radius-of-curvature") for d in (a, b)]
    assert [check.unit for check in limits] == ["mm", "in"]
    assert limits[0].value == pytest.approx(25.4 * (limits[1].value or 0.0))
    assert a.motion(1.0) == pytest.approx(b.motion(1.0))
    assert np.allclose(a.contour(9), b.contour(9))


def test_a_limit_that_fails_makes_a_design_that_is_not_ok(caplog: pytest.LogCaptureFixture) -> None:
    recipe = camgeo.load(ROOT / "recipes" / "shu-wu.yaml").replace("limits", {"size": {"at_most": 59}})
    design = camgeo.design(recipe)
    assert not design.ok
    assert "limit:size: FAILED, 60 mm, at most 59" in str(design)
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert "limit:size: FAILED" in caplog.text


def test_a_cam_that_is_not_made_has_no_contour() -> None:
    design = camgeo.design(camgeo.load(ROOT / "recipes" / "shu-wu.yaml").replace("cam.base_radius", 1))
    assert not design.ok
    for ask in (design.contour, lambda: design.edges(0.01)):
        with pytest.raises(camgeo.CallError, match="no contour is made: radius-of-curvature: FAILED"):
            ask()
    assert "FAILED" in design._repr_html_()
    assert design.figures["size"].value is None


def test_what_makes_no_sense_is_refused() -> None:
    design = camgeo.design(camgeo.load(ROOT / "recipes" / "shu-wu.yaml"))
    for ask, message in (
        (lambda: design.contour(2), "3 points at least"),
        (lambda: design.motion(math.nan), "finite"),
        (lambda: design.motion(0.0, derivative=7), "order 0 to 6"),
        (lambda: design.edges(0.0), "a length above 0"),
        (lambda: design.edges(math.nan), "a length above 0"),
        (lambda: design.edges(0.01, "exact"), "arcs, spline, polyline"),
    ):
        with pytest.raises(camgeo.CallError, match=message):
            ask()
    with pytest.raises(camgeo.CamgeoError, match="at least"):
        design.edges(1e-16)


def test_a_pickle_is_the_same_design(design: camgeo.Design) -> None:
    assert design.figures
    again = pickle.loads(pickle.dumps(design))
    assert np.array_equal(again.contour(60), design.contour(60))
    assert again.recipe.text == design.recipe.text
    assert dict(again.figures) == dict(design.figures)
    assert again.checks == design.checks


@pytest.mark.thin(3)
def test_it_shows_itself(design: camgeo.Design) -> None:
    svg, html = design._repr_svg_(), design._repr_html_()
    assert svg.startswith("<svg")
    assert design.recipe.name in html
    assert f"all {len(design.checks)} checks hold" in html
    assert all(check.name in html for check in design.checks)
    assert "<script" not in html
    assert "<style" not in html
    assert all(check._repr_html_().startswith("<p") for check in design.checks)


def test_what_a_design_hands_out_can_be_pickled_alone(design: camgeo.Design) -> None:
    figures = pickle.loads(pickle.dumps(design.figures))
    assert figures == design.figures
    with pytest.raises(TypeError):
        figures["size"] = None
    for part in (design.checks, design.edges(0.01), design.recipe):
        assert pickle.loads(pickle.dumps(part)) is not None


def test_a_path_stands_for_its_recipe(tmp_path: Path) -> None:
    path = tmp_path / "best.yaml"
    path.write_text("cam: {kind: support, p: 25 + cos(3*t)}\nexport: {tolerance: 0.05, files: [dxf]}\n", "utf-8")
    assert camgeo.design(path).ok
    assert camgeo.check(str(path)).ok
    report = camgeo.export(path, tmp_path)
    assert camgeo.verify(str(path), tmp_path / "best" / "best.dxf").ok
    assert report.recipe.text == camgeo.load(path).text
    with pytest.raises(camgeo.RecipeErrors, match=r"none\.yaml: the file does not exist"):
        camgeo.verify("none.yaml", tmp_path / "best" / "best.dxf")
    with pytest.raises(camgeo.CallError, match="recipe is no path: it is empty"):
        camgeo.design("")


def test_a_cam_of_two_surfaces_has_no_one_contour(tmp_path: Path) -> None:
    path = tmp_path / "groove.yaml"
    path.write_text(grooved(CAM).text)
    design = camgeo.design(camgeo.load(path))
    with pytest.raises(camgeo.CallError, match="several surfaces has no one contour"):
        design.contour()
    with pytest.raises(camgeo.CallError, match="several surfaces has no one contour"):
        design.edges(0.01)
