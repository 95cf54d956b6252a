"""Greatest motion error of rollers on splines, proved by their polynomials, against 30 digits on their pieces."""

import mpmath as mp
import numpy as np
import pytest
from support import followers
from support.cases import few
from support.disc_followers import FOLLOWERS
from support.heavy import interpolate

import kin.follower.roller
from kin.contour.arcs import unit
from kin.contour.bezier import Beziers
from kin.contour.closed_spline import closed_spline
from kin.contour.contour import Contour
from kin.contour.pieces import Pieces
from kin.follower.guide import Line
from kin.follower.on_spline import SplinePath
from kin.law.support_function import lift_from_fourier
from kin.law.transmission import from_delta
from kin.numeric.errors import UnsettledError

RADIUS = 8.0
PHI = np.arange(3600) * 2.0 * np.pi / 3600
FEW = PHI[::150]
LIFT = lift_from_fourier(40.0, {3: 3.0}, {5: 0.4}).law  # r = 40 + 3 cos 3 phi + 0.4 sin 5 phi
ROLLER = followers.roller(Line(0.0), RADIUS, LIFT)


def through(parameter, move=0.0) -> tuple[Contour, Beziers]:
    """Closed cubic spline through points of the exact contour, moved outwards by `move` (n,) mm; and its pieces."""
    points = ROLLER.envelope.points(parameter)
    tangent = np.gradient(points, axis=0)
    normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
    points = points + np.asarray(move)[..., None] * normal
    points[-1] = points[0]
    slope = interpolate.CubicSpline(parameter, points, bc_type="periodic")(parameter, 1)
    step = np.diff(parameter)[:, None] / 3.0
    start, end = points[:-1], points[1:]
    control = np.stack([start, start + step * slope[:-1], end - step * slope[1:], end], axis=1)
    beziers = Beziers(control, np.ones(control.shape[:2]))
    return Contour.from_pieces(Pieces.from_unrolled(beziers.unrolled().pieces)), beziers


def error(control, t):
    """Error of the roller that touches a cubic at t, mm, in 30 digits."""
    p = [[mp.mpf(float(x)) for x in row] for row in control]
    s = 1 - t
    x, y = (p[0][c] * s**3 + 3 * p[1][c] * s * s * t + 3 * p[2][c] * s * t * t + p[3][c] * t**3 for c in (0, 1))
    u, v = ((p[1][c] - p[0][c]) * s * s + 2 * (p[2][c] - p[1][c]) * s * t + (p[3][c] - p[2][c]) * t * t for c in (0, 1))
    size = mp.hypot(u, v)
    x, y = x + RADIUS * v / size, y - RADIUS * u / size
    phi = mp.atan2(y, x)
    return mp.hypot(x, y) - (40 + 3 * mp.cos(3 * phi) + mp.mpf("0.4") * mp.sin(5 * phi))


def greatest(beziers: Beziers) -> float:
    """Greatest absolute error over all pieces: a look along each, then thirds about the worst places."""
    shares = np.linspace(0.0, 1.0, 7)
    seen = sorted(
        ((abs(error(row, mp.mpf(float(t)))), i, float(t)) for i, row in enumerate(beziers.control) for t in shares),
        reverse=True,
    )
    best = mp.mpf(0)
    for _, i, t in seen[:4]:
        low, high = mp.mpf(max(t - 1 / 6, 0.0)), mp.mpf(min(t + 1 / 6, 1.0))
        for _ in range(40):
            a, b = low + (high - low) / 3, high - (high - low) / 3
            low, high = (a, high) if abs(error(beziers.control[i], a)) < abs(error(beziers.control[i], b)) else (low, b)
        best = max(best, abs(error(beziers.control[i], low)))
    return float(best)


@pytest.mark.thin(3)
@pytest.mark.parametrize("count", [12, 31, 121])
def test_bounds_are_above_the_true_error_and_near(count: int) -> None:
    contour, beziers = through(np.linspace(0.0, 2.0 * np.pi, count))
    true = greatest(beziers)
    motion = ROLLER.judge(contour, FEW).motion
    assert motion.extremes == "true"
    assert true - 1e-13 <= motion.bound <= true * (1.0 + 2e-6) + 1e-10
    assert motion.max == pytest.approx(true, rel=1e-9, abs=1e-13)


@pytest.mark.parametrize(
    ("depth", "step"),
    [
        (0.003, 0.012),
        (-0.003, 0.012),
        pytest.param(0.003, 5e-4, marks=pytest.mark.slow),
        pytest.param(-0.003, 5e-4, marks=pytest.mark.slow),
    ],
)
def test_a_fault_that_lies_between_all_samples_is_bounded(depth: float, step: float) -> None:
    """A bump or a dent midway between two shaft angles that are looked at; into the narrow one no roller fits."""
    middle = 0.5 * (FEW[5] + FEW[6])
    near = middle + np.linspace(-3.0, 3.0, 7) * step
    far = np.linspace(0.0, 2.0 * np.pi, 121)
    parameter = np.sort(np.concatenate([far[np.abs(far - middle) > 3.0 * step + 0.02], near]))
    contour, _ = through(parameter, np.where(np.abs(parameter - middle) < 1e-6, depth, 0.0))
    dense = middle + np.linspace(-0.02, 0.02, 4001)
    true = np.abs(followers.resting(ROLLER, contour.within(1e-9), dense) - ROLLER.intended(dense)).max()
    assert np.abs(followers.resting(ROLLER, contour, FEW) - ROLLER.intended(FEW)).max() < 0.01 * true
    proved = ROLLER.judge(contour, FEW).motion
    assert proved.extremes == "true"
    assert true <= proved.bound + 1e-12
    assert proved.bound <= true + 1e-8


def closed(follower, count: int, corner: float = 0.0) -> Contour:
    """The closed cubic spline through `count` points of a follower's exact contour, one handle turned by `corner`."""
    control = closed_spline(follower.envelope.points(np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)))
    step, turn = (
        control[0, 1] - control[0, 0],
        np.array([[np.cos(corner), -np.sin(corner)], [np.sin(corner), np.cos(corner)]]),
    )
    control[0, 1] = control[0, 0] + turn @ step
    return Contour.from_pieces(Pieces.from_unrolled(Beziers(control, np.ones(control.shape[:2])).unrolled().pieces))


def unsettled(*_: object) -> None:
    raise UnsettledError("not tried")


ROUND = [name for name in FOLLOWERS if not {"flat", "flat, tilted", "trailing face", "leading face"} & {name}]
OTHERS = {
    "double roller": followers.double_roller(from_delta(2, 1, 40.0, {1: 400.0}, {}), RADIUS),
    "yoke of rollers": followers.roller_yoke(RADIUS, lift_from_fourier(40.0, {3: 3.0}, {5: 0.4}).law, 80.0),
} | {name: FOLLOWERS[name] for name in ROUND}


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", few(OTHERS, 6))
def test_splines_and_the_arcs_in_their_place_agree(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    follower = OTHERS[name]
    contour = closed(follower, 150)
    on_spline = follower.judge(contour, FEW)
    monkeypatch.setattr(SplinePath, "of", unsettled)
    on_arcs = follower.judge(contour.within(1e-9), FEW)
    assert on_spline.motion.extremes == on_arcs.motion.extremes == "true"
    near = follower.motion_limit(4e-9)
    assert on_spline.motion.max == pytest.approx(on_arcs.motion.max, abs=near)
    assert on_spline.motion.rms == pytest.approx(on_arcs.motion.rms, abs=near)
    assert on_spline.motion.increment == pytest.approx(on_arcs.motion.increment, abs=4.0 * near)
    assert (on_spline.motion.dwell_flatness or 0.0) == pytest.approx(
        on_arcs.motion.dwell_flatness or 0.0, abs=4.0 * near
    )
    assert on_spline.motion.remainder <= on_arcs.motion.remainder + 2e-6 * on_spline.motion.max
    if on_spline.play is not None:
        # the ends and middles at which both are looked at besides are not the same
        size = on_arcs.play.most - on_arcs.play.least
        assert on_spline.play.least == pytest.approx(on_arcs.play.least, abs=0.02 * size)
        assert on_spline.play.most == pytest.approx(on_arcs.play.most, abs=0.02 * size)


@pytest.mark.thin(2)
@pytest.mark.parametrize("corner", [1e-3, -1e-3])
def test_a_spline_with_a_corner_is_followed_by_arcs_and_proved(corner: float, monkeypatch: pytest.MonkeyPatch) -> None:
    contour = closed(ROLLER, 60, corner)
    with pytest.raises(UnsettledError, match="the contour has corners"):
        SplinePath.of(contour, RADIUS, Line(0.0), ROLLER.contacts[0])
    motion = ROLLER.judge(contour, FEW).motion
    dense = np.linspace(-0.05, 0.05, 4001)
    true = np.abs(followers.resting(ROLLER, contour.within(1e-9), dense) - ROLLER.intended(dense)).max()
    assert motion.extremes == "true"
    assert true <= motion.bound
    assert motion.max >= true - 1e-8
    assert motion.remainder == pytest.approx(ROLLER.motion_limit(contour.spread), rel=0.1, abs=2e-6 * motion.max)
    monkeypatch.setattr(kin.follower.roller, "MOST_ARCS", 0)
    assert ROLLER.judge(contour, FEW).motion.extremes == "sampled"


def test_paths_that_are_no_graph_of_a_position_are_left_to_arcs() -> None:
    """A hollow that the roller does not fit into, a contour that goes round twice, and one beside a line."""
    t = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    wavy = closed_spline((30.0 + 3.0 * np.cos(8.0 * t))[:, None] * unit(t))
    twice = closed_spline((30.0 + np.cos(t))[:, None] * unit(2.0 * t))
    for control, why in ((wavy, "the shaft angle falls"), (twice, "does not go once round")):
        contour = Contour.from_pieces(
            Pieces.from_unrolled(Beziers(control, np.ones(control.shape[:2])).unrolled().pieces)
        )
        with pytest.raises(UnsettledError, match=why):
            SplinePath.of(contour, RADIUS, Line(0.0), ROLLER.contacts[0])
    with pytest.raises(UnsettledError, match="not all of the contour are polynomials"):
        SplinePath.of(
            Contour.from_bulges(np.array([[5.0, 0.0], [-5.0, 0.0]]), np.ones(2)), RADIUS, Line(0.0), ROLLER.contacts[0]
        )
