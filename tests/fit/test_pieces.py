"""The outline types: area, extremes and mirror image against dense samples, and what they refuse."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import interpolate
from support.splines import closed_spline, periodic_spline

from camgeo.fit.pieces import ArcSpline, Bound, BSpline, Polygon

NONE = Bound(0.0, 0.0)


def arc_points(arcs, per_piece):
    """Dense points of an arc chain, from the centre and the angles rather than from the sagitta."""
    out = []
    for (x0, y0), (x1, y1), b in zip(arcs.points, np.roll(arcs.points, -1, axis=0), arcs.bulges, strict=True):
        s, e = complex(x0, y0), complex(x1, y1)
        t = np.linspace(0.0, 1.0, per_piece, endpoint=False)
        if b == 0.0:
            out.append(s + (e - s) * t)
            continue
        sweep = 4.0 * math.atan(b)
        centre = s + (e - s) * 1j * np.exp(-0.5j * sweep) / (2.0 * math.sin(0.5 * sweep))
        out.append(centre + (s - centre) * np.exp(1j * sweep * t))
    z = np.concatenate(out)
    return np.column_stack((z.real, z.imag))


def area_of(points):
    x, y = points.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


rounded = st.builds(
    lambda r, b: ArcSpline(
        np.array([[x * k, y * k] for (x, y), k in zip([(1, 0), (0, 1), (-1, 0), (0, -1)], r, strict=True)]),
        np.array(b),
        NONE,
    ),
    st.lists(st.floats(1.0, 50.0), min_size=4, max_size=4),
    st.lists(st.just(0.0) | st.floats(1e-6, 1.6) | st.floats(-0.2, -1e-6), min_size=4, max_size=4),
)


class TestBound:
    def test_worst_scaled_widened(self):
        bound = Bound(0.25, 0.5)
        assert bound.worst == 0.5
        assert bound.scaled(2.0) == Bound(0.5, 1.0)
        assert bound.widened(0.125) == Bound(0.375, 0.625)

    @pytest.mark.parametrize("value", [-1e-9, math.nan, math.inf])
    def test_refuses_what_is_no_bound(self, value):
        with pytest.raises(ValueError, match=r"bound: inward must be finite and >= 0, not "):
            Bound(0.0, value)


class TestPolygon:
    def test_square(self):
        square = Polygon(np.array([[1.0, 2.0], [4.0, 2.0], [4.0, 5.0], [1.0, 5.0]]), Bound(0.1, 0.2))
        assert (square.count, square.area, square.box()) == (4, 9.0, (1.0, 2.0, 4.0, 5.0))
        mirrored = square.mirrored()
        assert mirrored.vertices.tolist() == [[1.0, -2.0], [1.0, -5.0], [4.0, -5.0], [4.0, -2.0]]
        assert mirrored.area == 9.0
        assert np.array_equal(mirrored.mirrored().vertices, square.vertices)
        assert square.scaled(2.0).area == 36.0
        assert square.scaled(2.0).bound == Bound(0.2, 0.4)

    def test_area_keeps_its_digits_far_from_the_origin(self):
        square = Polygon(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) + 2.0**40, NONE)
        assert square.area == 1.0

    @pytest.mark.parametrize(
        ("vertices", "message"),
        [
            (np.zeros((2, 2)), r"polygon: vertices must be float64 of shape (3, 2), not float64 (2, 2)"),
            (np.zeros((3, 3)), r"polygon: vertices must be float64 of shape (3, 2), not float64 (3, 3)"),
            (np.zeros((3, 2), np.float32), r"polygon: vertices must be float64 of shape (3, 2), not float32 (3, 2)"),
            ([[0.0, 0.0]] * 3, r"polygon: vertices must be float64 of shape (3, 2), not list"),
            (np.array([[0.0, 0.0], [1.0, 0.0], [0.0, np.nan]]), "polygon: vertices must be finite"),
            (np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]), "polygon: vertices: piece 1 has no length"),
            (np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]), "polygon: vertices: piece 2 has no length"),
        ],
    )
    def test_refuses(self, vertices, message):
        with pytest.raises(ValueError) as caught:
            Polygon(vertices, NONE)
        assert str(caught.value) == message


class TestArcs:
    def test_two_half_circles(self):
        circle = ArcSpline(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.array([1.0, 1.0]), NONE)
        assert circle.count == 2
        assert circle.area == pytest.approx(math.pi, rel=1e-15)
        assert circle.box() == (-1.0, -1.0, 1.0, 1.0)

    @given(rounded)
    def test_box_and_area_against_dense_points(self, arcs):
        points = arc_points(arcs, 2000)
        x_min, y_min, x_max, y_max = arcs.box()
        box = np.array([[x_min, y_min], [x_max, y_max]])
        size = np.abs(points).max()
        longest = np.hypot(*(np.roll(arcs.points, -1, axis=0) - arcs.points).T).max()
        # the samples stay inside to rounding, which a distant centre makes large, and miss the extremes by the
        # sagitta of one step
        distant = 1e-15 * longest / np.abs(arcs.bulges[arcs.bulges != 0.0]).min(initial=1.0)
        slack = 1e-12 * size + distant
        assert np.all(points.min(axis=0) >= box[0] - slack)
        assert np.all(points.max(axis=0) <= box[1] + slack)
        step = 3.0 * longest * max(1.0, np.abs(arcs.bulges).max()) * 1e-5
        assert np.all(points.min(axis=0) <= box[0] + step)
        assert np.all(points.max(axis=0) >= box[1] - step)
        assert arcs.area == pytest.approx(area_of(points), abs=1e-5 * size * size + distant * size)

    def test_box_of_a_nearly_straight_arc_keeps_the_sagitta(self):
        # an arc along x from (0, 0) to (2, 0) that bends down by 2^-40, and two lines back
        arcs = ArcSpline(np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]]), np.array([2.0**-40, 0.0, 0.0]), NONE)
        assert arcs.box() == (0.0, -(2.0**-40), 2.0, 1.0)

    def test_box_with_a_bulge_below_all_normal_numbers(self):
        arcs = ArcSpline(np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]]), np.array([5e-324, 5e-324, 0.0]), NONE)
        assert arcs.box() == (0.0, -5e-324, 2.0, 1.0)

    @given(rounded)
    def test_mirror(self, arcs):
        mirrored = arcs.mirrored()
        assert mirrored.area == pytest.approx(arcs.area, rel=1e-12, abs=1e-12 * np.abs(arcs.points).max() ** 2)
        x_min, y_min, x_max, y_max = arcs.box()
        assert mirrored.box() == pytest.approx((x_min, -y_max, x_max, -y_min), rel=1e-14, abs=1e-14)
        assert np.array_equal(mirrored.points[0], arcs.points[0] * [1.0, -1.0])
        again = mirrored.mirrored()
        assert np.array_equal(again.points, arcs.points)
        assert np.array_equal(again.bulges, arcs.bulges)

    def test_refuses(self):
        with pytest.raises(ValueError, match=r"^arcs: bulges must be float64 of shape \(2,\), not float64 \(3,\)$"):
            ArcSpline(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.ones(3), NONE)
        with pytest.raises(ValueError, match=r"^arcs: points: piece 0 has no length$"):
            ArcSpline(np.zeros((2, 2)), np.ones(2), NONE)


class TestSpline:
    @pytest.mark.thin(2)
    @pytest.mark.parametrize(
        "spline", [closed_spline(), periodic_spline(), periodic_spline(8, 2), periodic_spline(11, 5)]
    )
    def test_beziers_box_and_area_against_scipy(self, spline):
        p, m = spline.degree, len(spline.control)
        curve = interpolate.BSpline(spline.knots, spline.control, p)
        starts = spline.knots[p : m + 1]
        starts = starts[np.append(np.diff(starts) > 0.0, True)]
        pieces = spline.beziers()
        assert pieces.shape == (spline.count, p + 1, 2)
        assert pieces[:, 0] == pytest.approx(curve(starts[:-1]), abs=1e-13)
        for u in (0.3, 0.8):
            point = pieces
            while point.shape[1] > 1:
                point = (1.0 - u) * point[:, :-1] + u * point[:, 1:]
            assert point[:, 0] == pytest.approx(curve(starts[:-1] + u * np.diff(starts)), abs=1e-12)
        dense = curve(np.linspace(starts[0], starts[-1], 400_001)[:-1])
        assert spline.area == pytest.approx(area_of(dense), rel=1e-8)
        expected = [*dense.min(axis=0), *dense.max(axis=0)]
        assert spline.box() == pytest.approx(expected, abs=1e-8)
        assert np.all(np.array(spline.box()[:2]) <= dense.min(axis=0) + 1e-14)
        assert np.all(np.array(spline.box()[2:]) >= dense.max(axis=0) - 1e-14)

    def test_box_is_not_that_of_the_control_polygon(self):
        spline = periodic_spline()
        assert spline.box()[2] < spline.control[:, 0].max() - 0.1

    def test_closing(self):
        assert closed_spline().clamped
        assert not closed_spline().periodic
        assert periodic_spline().periodic
        assert not periodic_spline().clamped

    @pytest.mark.parametrize("spline", [closed_spline(), periodic_spline()])
    def test_mirror_and_scale(self, spline):
        mirrored = spline.mirrored()
        assert mirrored.area == pytest.approx(spline.area, rel=1e-13)
        x_min, y_min, x_max, y_max = spline.box()
        assert mirrored.box() == pytest.approx((x_min, -y_max, x_max, -y_min), rel=1e-13)
        assert spline.scaled(2.0).area == pytest.approx(4.0 * spline.area, rel=1e-13)

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"degree": 0}, "spline: degree must be >= 1, not 0"),
            ({"spans": 99}, "spline: spans is 99, but the knots make "),
            ({"knots": closed_spline().knots[::-1].copy()}, "spline: knots must not fall"),
            ({"knots": closed_spline().knots[:-1]}, "spline: knots must be float64 of shape "),
            ({"control": closed_spline().control + np.linspace(0, 1, 25)[:, None]}, "spline: does not close, "),
        ],
    )
    def test_refuses(self, change, message):
        good = closed_spline()
        fields = {"degree": 3, "control": good.control, "knots": good.knots, "spans": good.spans, "bound": NONE}
        with pytest.raises(ValueError, match=f"^{message}"):
            BSpline(**(fields | change))


@settings(max_examples=examples(20))
@given(st.floats(max_value=0.0) | st.sampled_from([math.inf, math.nan]))
def test_scale_must_be_positive(k):
    for outline in (
        Polygon(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), NONE),
        ArcSpline(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.array([1.0, 1.0]), NONE),
        closed_spline(),
    ):
        with pytest.raises(ValueError, match="scale must be finite and > 0"):
            outline.scaled(k)
