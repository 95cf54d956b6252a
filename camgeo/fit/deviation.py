"""Deviation of a chain of lines and arcs from the exact curve: proved, not sampled.

Each piece covers a parameter interval of the curve. With f the curve's distance outside the piece (along the piece's
normal), beta the angle from the piece's tangent to the curve's and k the piece's curvature,

    f' = -sigma sin beta,    beta' = omega - k sigma cos beta / (1 + k f),

so f'' is known at every node and, through the curve's proved bounds on the second derivatives of sigma and omega,
everywhere between two nodes: f lies within a parabola's sagitta of the straight line between its end values. Nodes
are added until that sagitta no longer matters.

Between nodes beta and f are confined first. No place is farther than half a step from a node, so as long as |beta| <= B
and |f| <= F the bound of beta' that follows keeps |beta| below its node's value plus half a step times that bound; if
this sum is less than B, and likewise for F, neither can ever leave (continuity). With B below a right angle the curve's
foot runs forward along the piece from where it starts to where it ends. So, where the first foot is the piece's own
beginning and the last its end, every point of the curve has its foot on the piece and every point of the piece has a
point of the curve over it: the range of f bounds both distances, from the curve to the piece and back.

The curve is taken to run forward, sigma > 0; `camgeo.curve.curvature.reversals` proves that of a contour before it is
fitted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Bounds, Curve
    from kin.numeric.arrays import Array, Mask

SLACK = 0.004  # nodes are doubled until the proof exceeds what the nodes show by less than this share of the tolerance
FIRST_NODES = 4
FOOT_STEPS = 25
FORWARD = 1.5  # radians, below a right angle: as long as beta stays below it the foot moves forward along the piece
MOST_NODES = 512  # of a piece
BLOCK = 16_384  # places at a time, whose arrays stay in a processor's cache
FEW = 1000  # pieces, up to which a proof is sharpened further to decide whether the tolerance is held


@dataclass(frozen=True)
class Chain:
    """Lines and arcs along a curve: n pieces, each over the curve's parameters from `low` to `high` (n,).

    `start` (n, 2), mm, is a point of the piece's own circle or line, `tangent` (n, 2) its unit direction there,
    `curvature` (n,), 1/mm, its signed curvature, above 0 where it turns left, 0 for a line.
    """

    start: Array
    tangent: Array
    curvature: Array
    low: Array
    high: Array


@dataclass(frozen=True)
class Deviation:
    """Proved range of the curve's signed distance f from each piece (n,), mm, above 0 outside the piece.

    `inside` <= f <= `outside` along the piece, so `inside` is below 0 where the curve runs inside it. Where nothing is
    proved they are infinite.
    """

    inside: Array
    outside: Array

    @property
    def worst(self) -> Array:
        """Greatest proved distance of each piece from the curve to either side, mm (n,)."""
        return np.maximum(self.outside, -self.inside)


def chain_deviation(
    curve: Curve, chain: Chain, tolerance: float, nodes: int = FIRST_NODES, *, decide: bool = False
) -> Deviation:
    """Proved deviation of each piece of a chain; pieces must not span a break of the curve.

    Bounds are sharpened until they exceed the samples by at most `SLACK` times the tolerance, mm, with `MOST_NODES`
    nodes a piece at the most; a piece whose samples break the tolerance is not proved sharply. `nodes` is the number of
    steps at first. In a chain of at most `FEW` pieces `decide` sharpens further where the tolerance is held by the
    samples, but not yet by the bounds. The time grows with the nodes used.
    """
    count = chain.low.size
    inside, outside = np.empty(count), np.empty(count)
    todo = np.arange(count)
    while todo.size:
        part = Chain(*(getattr(chain, name)[todo] for name in ("start", "tangent", "curvature", "low", "high")))
        low, high, node_low, node_high = _ranges(curve, part, nodes)
        inside[todo], outside[todo] = low, high
        seen = np.maximum(node_high, -node_low)
        loose = np.maximum(high - node_high, node_low - low) > SLACK * tolerance
        if decide and count <= FEW:
            loose |= (np.maximum(high, -low) > tolerance) & (seen <= tolerance)
        # a piece whose samples break the tolerance needs no sharper bound
        hopeless = seen > 1.05 * tolerance
        todo = todo[loose & ~hopeless]
        nodes *= 2
        if nodes > MOST_NODES:
            break
    return Deviation(inside, outside)


def sampled_deviation(curve: Curve, chain: Chain, nodes: int) -> Array:
    """Greatest sampled distance of each piece from the curve at `nodes` equal steps (n,), mm: a lower bound.

    It is infinite where the curve runs backwards along the piece, or the steps are too wide for any proof.
    """
    low, high, seen_low, seen_high = _ranges(curve, chain, nodes)
    seen = np.maximum(seen_high, -seen_low)
    return np.where(np.isfinite(low) & np.isfinite(high), seen, np.inf)


def radial(start: Array, tangent: Array, curvature: Array, point: Array) -> tuple[Array, Array]:
    """Signed distance (n,), mm, of points (n, 2) from circles or lines, and unit directions (n, 2) in which it grows.

    A circle or line passes `start` (n, 2) in the direction `tangent` (n, 2) with a signed `curvature` (n,), 1/mm, above
    0 where it turns left. The distance is above 0 to its right: outside a circle that turns left, inside one that turns
    right. No digit is lost where the radius is large beside the distance.
    """
    normal = np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)
    offset = point - start
    x, y = offset[..., 0], offset[..., 1]
    height = 2.0 * (x * normal[..., 0] + y * normal[..., 1]) + curvature * (x * x + y * y)
    root = np.sqrt(np.maximum(1.0 + curvature * height, 0.0))
    away = curvature[..., None] * offset + normal
    return height / (1.0 + root), away / np.maximum(root, 1e-300)[..., None]


def _ranges(curve: Curve, chain: Chain, nodes: int) -> tuple[Array, Array, Array, Array]:
    """Least and greatest f, mm, as proved and then at the nodes, for each piece (n,) with `nodes` equal steps."""
    rows = (chain.start, chain.tangent, chain.curvature, chain.low, chain.high)
    step = max(1, BLOCK // nodes)
    blocks = [slice(first, first + step) for first in range(0, chain.low.size, step)]
    if len(blocks) < 2:
        return _ranges_of(curve, chain, nodes)
    ranges = [_ranges_of(curve, Chain(*(row[block] for row in rows)), nodes) for block in blocks]
    low, high, seen_low, seen_high = (np.concatenate(parts) for parts in zip(*ranges, strict=True))
    return low, high, seen_low, seen_high


class _Samples(NamedTuple):
    """Samples at the nodes on n pieces, nodes + 1 on each: (n, nodes + 1).

    `distance` is f and `angle` beta; `speed` and `turn` are the curve's. `forward` (n,) says whether the curve runs
    forward along the piece at every node.
    """

    t: Array
    distance: Array
    angle: Array
    speed: Array
    turn: Array
    forward: Mask

    @staticmethod
    def of(curve: Curve, chain: Chain, nodes: int) -> _Samples:
        """Sample the ends of `nodes` equal steps of each piece."""
        t = chain.low[:, None] + (chain.high - chain.low)[:, None] * np.linspace(0.0, 1.0, nodes + 1)
        t[:, -1] = chain.high
        side = np.ones(t.shape, dtype=np.intp)
        side[:, -1] = -1
        frames = curve.sample(t.ravel(), side.ravel())
        points, tangents = frames.point.reshape(*t.shape, 2), frames.tangent.reshape(*t.shape, 2)
        f, away = radial(chain.start[:, None], chain.tangent[:, None], chain.curvature[:, None], points)
        sine = -(tangents[..., 0] * away[..., 0] + tangents[..., 1] * away[..., 1])
        cosine = tangents[..., 1] * away[..., 0] - tangents[..., 0] * away[..., 1]
        forward = np.asarray((cosine > 0.0).all(axis=1))
        return _Samples(
            t, f, np.arctan2(sine, cosine), frames.speed.reshape(t.shape), frames.turn.reshape(t.shape), forward
        )


def _ranges_of(curve: Curve, chain: Chain, nodes: int) -> tuple[Array, Array, Array, Array]:
    seen = _Samples.of(curve, chain, nodes)
    bounds = curve.cells.over(seen.t[:, :-1].ravel(), seen.t[:, 1:].ravel())
    low_bend, high_bend, confirmed = _bends(seen, bounds, np.repeat(chain.curvature, nodes))
    step, (fa, fb) = np.diff(seen.t).ravel(), _ends(seen.distance)
    top = peak(fa, fb, step, -low_bend)
    bottom = -peak(-fa, -fb, step, high_bend)
    shape = chain.low.size, nodes
    top = np.where(confirmed, top, np.inf).reshape(shape).max(axis=1)
    bottom = np.where(confirmed, bottom, -np.inf).reshape(shape).min(axis=1)
    top[~seen.forward], bottom[~seen.forward] = np.inf, -np.inf
    return bottom, top, seen.distance.min(axis=1), seen.distance.max(axis=1)


def _bends(samples: _Samples, bounds: Bounds, k: Array) -> tuple[Array, Array, Mask]:
    """Bounds of f'' over each step (n * nodes,), and whether they are proved; `k` is the curvature of its piece."""
    step = np.diff(samples.t).ravel()
    fa, fb = _ends(samples.distance)
    angle = np.maximum(*_ends(np.abs(samples.angle)))
    speed_a, speed_b = _ends(samples.speed)
    turn_a, turn_b = _ends(samples.turn)
    square = step**2 / 8.0
    speed = np.maximum(np.abs(speed_a), np.abs(speed_b)) + square * bounds.speed_bend
    speed = np.minimum(speed, np.maximum(np.abs(bounds.speed_low), np.abs(bounds.speed_high)))
    # m = omega - k sigma, how much faster the curve turns than the piece
    ma, mb = turn_a - k * speed_a, turn_b - k * speed_b
    m_bend = bounds.turn_bend + np.abs(k) * bounds.speed_bend
    m_slope = bounds.turn_slope + np.abs(k) * bounds.speed_slope
    m = np.maximum(np.abs(ma), np.abs(mb)) + square * m_bend
    # beta and f inside the step: beta' differs from m by about `lag`; limits are assumed for twice that, and confirmed
    # if the bound `extra` that follows from them is no more
    size = np.abs(k)
    furthest = np.maximum(np.abs(fa), np.abs(fb))
    first = angle + 0.5 * step * m
    lag = size * speed * (0.5 * first**2 + size * (furthest + 0.5 * step * speed * first))
    beta_limit = angle + 0.5 * step * (m + 2.0 * lag) + 1e-15
    kf = size * (furthest + 0.5 * step * speed * beta_limit)
    with np.errstate(divide="ignore", invalid="ignore"):
        extra = size * speed * (0.5 * beta_limit**2 + kf) / (1.0 - kf)
        confirmed = (kf < 0.5) & (extra <= 2.0 * lag + 1e-15) & (beta_limit < FORWARD)
    # f'' = -sigma m up to `correction`; sigma m itself by its end values and its second derivative
    product_bend = bounds.speed_bend * m + 2.0 * bounds.speed_slope * m_slope + speed * m_bend
    correction = bounds.speed_slope * beta_limit + speed * (extra + 0.5 * m * beta_limit**2) + square * product_bend
    high_bend = np.maximum(-speed_a * ma, -speed_b * mb) + correction
    low_bend = np.minimum(-speed_a * ma, -speed_b * mb) - correction
    return low_bend, high_bend, confirmed


def _ends(values: Array) -> tuple[Array, Array]:
    """Values (n, nodes + 1) at the left and right node of every step (n * nodes,)."""
    return values[:, :-1].ravel(), values[:, 1:].ravel()


def peak(fa: Array, fb: Array, step: Array, bend: Array) -> Array:
    """Upper bound (n,) over steps of a function with end values `fa`, `fb` and second derivative at least -`bend`."""
    bend = np.maximum(bend, 0.0)
    sag = bend * step**2
    rise = np.abs(fb - fa)
    top = np.maximum(fa, fb)
    with np.errstate(divide="ignore", invalid="ignore"):
        over = (0.5 * sag - rise) ** 2 / (2.0 * sag)
    return top + np.where(0.5 * sag > rise, over, 0.0)


def foot(curve: Curve, low: Array, high: Array, point: Array, across: Array, *, enough: float) -> tuple[Array, Array]:
    """Parameters (n,) in [low, high] at which the curve meets lines through `point` (n, 2) square to `across` (n, 2).

    `across` are unit vectors that point forward along the curve: for a joint of arcs the common tangent of both arcs.
    With the parameters come the remaining distances (n,) from the lines, mm, >= 0. Newton's method begins in the middle
    of an interval, which each step narrows, and ends where all distances are at most `enough`, mm; a distance stays
    greater where the curve does not meet the line in the interval.
    """
    t = 0.5 * (low + high)
    frames = curve.sample(t)
    miss = np.sum((frames.point - point) * across, axis=1)
    for _ in range(FOOT_STEPS):
        with np.errstate(divide="ignore", invalid="ignore"):
            move = miss / (frames.speed * np.sum(frames.tangent * across, axis=1))
        # the side of the foot is known, as the curve runs forward
        low, high = np.where(miss < 0.0, t, low), np.where(miss > 0.0, t, high)
        moved = t - np.where(np.isfinite(move), move, 0.0)
        moved = np.where((moved > low) & (moved < high), moved, 0.5 * (low + high))
        open_ = np.abs(miss) > enough
        if not open_.any():
            break
        t = np.where(open_, moved, t)
        frames = curve.sample(t)
        miss = np.sum((frames.point - point) * across, axis=1)
    return t, np.abs(miss)
