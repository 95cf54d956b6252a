"""Curves in closed form for tests: polar pitch curves by jets, and shapes moved about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Frame, Shape
from kin.numeric import elementary
from kin.numeric.elementary import BallJet, Jet

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(frozen=True)
class Polar:
    """r(t) about the origin: sigma^2 = r^2 + r'^2, omega sigma^2 = r^2 + 2 r'^2 - r r''."""

    radius: Callable

    period = 2.0 * np.pi
    repeats = 1

    @property
    def breaks(self):
        return np.empty(0)

    @property
    def steady(self):
        return np.array([[np.nan, np.nan]])

    @property
    def radii(self):
        return np.array([np.nan])

    def rates(self, t):
        r = self.radius(t)
        slope = r.derivative()
        bend = slope.derivative()
        r, slope = (cut(x, bend.order) for x in (r, slope))
        square = r * r + slope * slope
        return elementary.sqrt(square), (square + slope * slope - r * bend) / square

    def sample(self, t, side=1):  # noqa: ARG002
        r, slope = self.radius(Jet.variable(t, 1)).derivatives()
        u, n = np.column_stack([np.cos(t), np.sin(t)]), np.column_stack([-np.sin(t), np.cos(t)])
        velocity = slope[:, None] * u + r[:, None] * n
        speed, turn = (x.derivatives() for x in self.rates(Jet.variable(t, 3)))
        return Frame(r[:, None] * u, velocity / speed[0][:, None], speed[0], turn[0], speed[1], turn[1])

    def series(self, t, order, side=1):  # noqa: ARG002
        speed, turn = self.rates(Jet.variable(t, order + 2))
        return speed.c, turn.c

    def bounds(self, low, high):
        (a, b), (c, d) = (x.bounds() for x in self.rates(BallJet.variable(low, high, 4)))
        speed, turn = np.maximum(np.abs(a), np.abs(b)), np.maximum(np.abs(c), np.abs(d))
        return Bounds(a[0], b[0], c[0], d[0], speed[1], turn[1], speed[2], turn[2])


@dataclass(frozen=True)
class Moved:
    """A shape seen from another origin."""

    shape: Shape
    origin: tuple[float, float]

    period = 2.0 * np.pi
    repeats = 1

    @property
    def breaks(self):
        return self.shape.breaks

    @property
    def steady(self):
        return self.shape.steady

    @property
    def radii(self):
        return self.shape.radii

    def sample(self, t, side=1):
        f = self.shape.sample(t, side)
        return Frame(f.point - np.array(self.origin), f.tangent, f.speed, f.turn, f.speed_slope, f.turn_slope)

    def series(self, t, order, side=1):
        return self.shape.series(t, order, side)

    def bounds(self, low, high):
        return self.shape.bounds(low, high)


def cut(x, order):
    return Jet(x.c[: order + 1]) if isinstance(x, Jet) else BallJet(x.mid[: order + 1], x.rad[: order + 1])


def booth(length, m):
    """Booth's lemniscate r^2 = 2 (l^2 + m^2 cos 2t) (W section 6): a waist at t = pi/2 where 3 m^2 > l^2."""
    return Polar(lambda t: elementary.sqrt((elementary.cos(t * 2.0) * m**2 + length**2) * 2.0))


def waves(mean, *terms):
    """r = mean + sum of a cos(k t - b) over terms (k, a, b)."""

    def radius(t):
        total = t.constant(mean)
        for k, a, b in terms:
            total = total + elementary.cos(t * float(k) - b) * a
        return total

    return Polar(radius)


# a bulb on a body, the shaft in the body: the neck between them is 27.885 mm wide
PEAR = Moved(
    Polar(lambda t: elementary.sqrt((elementary.cos(t * 2.0) * 300.0 + 400.0) * 2.0 + elementary.cos(t) * 150.0)),
    (15.0, 0.0),
)
# radius 4.42 to 3.80 mm at its five lobes
STAR = waves(20.0, (5, 5.0, 0.0), (2, 2.0, np.pi / 2))
