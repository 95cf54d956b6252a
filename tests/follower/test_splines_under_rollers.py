"""Greatest motion error of rollers on splines, proved by arcs in place of them, against 30 digits on their pieces."""

import mpmath as mp
import numpy as np
import pytest
from support import followers
from support.heavy import interpolate

import kin.follower.roller
from kin.contour.bezier import Beziers
from kin.contour.contour import Contour
from kin.contour.pieces import Pieces
from kin.follower.guide import Line
from kin.law.support_function import lift_from_fourier

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


@pytest.mark.parametrize("within", [1e-5, 1e-7, None])
def test_bounds_are_above_the_true_error_and_near(within: float | None) -> None:
    contour, beziers = through(np.linspace(0.0, 2.0 * np.pi, 31))
    contour, true = contour.within(within), greatest(beziers)
    motion = ROLLER.judge(contour, FEW).motion
    assert motion.extremes == "true"
    assert true <= motion.bound <= true + 4.0 * contour.spread + 1e-10
    assert motion.max == pytest.approx(true, abs=2.0 * contour.spread + 1e-10)


@pytest.mark.parametrize("depth", [0.003, -0.003])
def test_a_fault_that_lies_between_all_samples_is_bounded(depth: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """A bump or a dent over a tenth of a degree, midway between two of the shaft angles that are looked at."""
    middle = 0.5 * (FEW[5] + FEW[6])
    near = middle + np.linspace(-1.5e-3, 1.5e-3, 7)
    far = np.linspace(0.0, 2.0 * np.pi, 121)
    parameter = np.sort(np.concatenate([far[np.abs(far - middle) > 2e-2], near]))
    contour, _ = through(parameter, np.where(np.abs(parameter - middle) < 1e-6, depth, 0.0))
    dense = middle + np.linspace(-0.02, 0.02, 4001)
    true = np.abs(followers.resting(ROLLER, contour, dense) - ROLLER.intended(dense)).max()
    coarse = contour.within(1e-6)
    assert np.abs(followers.resting(ROLLER, coarse, FEW) - ROLLER.intended(FEW)).max() < 0.01 * true
    proved = ROLLER.judge(coarse, FEW).motion
    assert proved.extremes == "true"
    assert true <= proved.bound <= true + 4e-6
    monkeypatch.setattr(kin.follower.roller, "MOST_PIECES", 0)
    assert ROLLER.judge(coarse, FEW).motion.extremes == "sampled"
