"""The same curves and motions in 50 digits, by other means than the program's: mpmath, closed forms, no jets.

Angles come in as doubles and are taken exactly; what comes out is compared in mpmath and only then rounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import mpmath as mp
import numpy as np

DIGITS = 50
mp.mp.dps = DIGITS


def derivatives(f, t, order):
    """Give f and its derivatives at t, where f is smooth about t."""
    return [c * mp.factorial(k) for k, c in enumerate(mp.taylor(f, t, order))]


@dataclass(frozen=True)
class Support:
    """A support function p given as a function of t; derivatives(t) gives p .. p'''."""

    derivatives: object

    def frame(self, t):
        """Point, outward normal, radius of curvature at the normal direction t."""
        t = mp.mpf(float(t))
        p = self.derivatives(t)
        c, s = mp.cos(t), mp.sin(t)
        return (p[0] * c - p[1] * s, p[0] * s + p[1] * c), (c, s), p[0] + p[2]


def fourier(mean, cos, sin, pivot=(0.0, 0.0)):
    """p = mean + sum a cos kt + b sin kt - x cos t - y sin t."""
    cos, sin = dict(cos), dict(sin)
    cos[1] = mp.mpf(cos.get(1, 0.0)) - mp.mpf(pivot[0])
    sin[1] = mp.mpf(sin.get(1, 0.0)) - mp.mpf(pivot[1])

    def rows(t):
        out = []
        for n in range(4):
            quarter = n * mp.pi / 2
            total = mp.mpf(mean) if n == 0 else mp.mpf(0)
            total += mp.fsum(mp.mpf(a) * mp.mpf(k) ** n * mp.cos(k * t + quarter) for k, a in cos.items())
            total += mp.fsum(mp.mpf(b) * mp.mpf(k) ** n * mp.sin(k * t + quarter) for k, b in sin.items())
            out.append(total)
        return out

    return Support(rows)


def formula(f):
    """p = f(t), an mpmath function that is smooth wherever it is asked for."""
    return Support(lambda t: derivatives(f, t, 3))


def reuleaux(sides, breadth, rounding):
    """The regular Reuleaux polygon of Lift's convention: a corner on the +x axis, normals within pi/2n of it on it."""
    n, w, r = sides, mp.mpf(breadth), mp.mpf(rounding)
    circumradius = (w - 2 * r) / (2 * mp.cos(mp.pi / (2 * n)))

    def rows(t):
        i = int(mp.nint(t / (mp.pi / n)))
        corner = (i if i % 2 == 0 else i + n) * mp.pi / n
        radius = r if i % 2 == 0 else w - r
        x = [circumradius * mp.cos(t - corner + k * mp.pi / 2) for k in range(4)]
        return [radius + x[0], *x[1:]]

    return Support(rows)


LAWS = {
    "parabolic": [(0.0, 0.5, lambda u: 2 * u * u), (0.5, 1.0, lambda u: 1 - 2 * (1 - u) ** 2)],
    "harmonic": [(0.0, 1.0, lambda u: mp.sin(mp.pi * u / 2) ** 2)],
    "cycloidal": [(0.0, 1.0, lambda u: u - mp.sin(2 * mp.pi * u) / (2 * mp.pi))],
    "polynomial-345": [(0.0, 1.0, lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5)],
}


def constant_breadth(base_radius, segments):
    """p = r_b + S on [0, pi], d - p half a turn before on the rest; segments are (stroke, degrees, law or None)."""
    r_b = mp.mpf(base_radius)
    pieces, at, level = [], mp.mpf(0), mp.mpf(0)
    for stroke, over, name in segments:
        width, h = mp.mpf(over) * mp.pi / 180, mp.mpf(stroke)
        for a, b, law in LAWS[name] if name else [(0.0, 1.0, None)]:
            pieces.append((at + a * width, at + b * width, at, width, level, h, law))
        at, level = at + width, level + h
    breadth = 2 * r_b + level

    def lift(t):
        _, _, begin, width, low, h, law = next(p for p in pieces if t <= p[1] or p is pieces[-1])
        if law is None:
            return [r_b + low, mp.mpf(0), mp.mpf(0), mp.mpf(0)]
        s = derivatives(law, (t - begin) / width, 3)
        return [r_b + low + h * s[0], *(h * s[k] / width**k for k in (1, 2, 3))]

    def rows(t):
        t = t - 2 * mp.pi * mp.floor(t / (2 * mp.pi))
        if t < mp.pi:
            return lift(t)
        first, *more = lift(t - mp.pi)
        return [breadth - first, *(-x for x in more)]

    return Support(rows)


@dataclass(frozen=True)
class Pitch:
    """W's analytic route: r = sqrt2 (a sqrt(l^2 + D) + b sqrt(l^2 - D)), D of cosines alone; `radius` of the roller."""

    lam: int
    mu: int
    arm: float
    cos: dict
    radius: float

    @cached_property
    def _constants(self):
        alpha = mp.pi * self.mu / self.lam
        return alpha, mp.cos(mp.pi / 4 - alpha / 2), mp.sin(mp.pi / 4 - alpha / 2)

    def distance(self, t):
        _, a, b = self._constants
        square = mp.mpf(self.arm) ** 2
        d = mp.fsum(mp.mpf(x) * mp.cos(j * self.lam * t) for j, x in self.cos.items())
        return mp.sqrt(2) * (a * mp.sqrt(square + d) + b * mp.sqrt(square - d))

    def frame(self, t):
        """Contour's point, outward normal and radius of curvature where roller A stands at polar angle t."""
        t = mp.mpf(float(t))
        r, slope, bend = derivatives(self.distance, t, 2)
        c, s = mp.cos(t), mp.sin(t)
        x, y = slope * c - r * s, slope * s + r * c
        speed = mp.hypot(x, y)
        normal = (y / speed, -x / speed)
        rho = speed**3 / (r * r + 2 * slope * slope - r * bend)
        e = mp.mpf(self.radius)
        return (r * c - e * normal[0], r * s - e * normal[1]), normal, rho - e

    def motion(self, t):
        """Shaft angle and psi where roller A stands at polar angle t (W 4.4)."""
        t = mp.mpf(float(t))
        alpha, _, _ = self._constants
        lead = mp.acos(self.distance(t) / (2 * mp.mpf(self.arm)))
        return t + lead, 2 * lead - alpha


def worst(found, exact):
    """Greatest difference of arrays of doubles and mpmath numbers, as a double."""
    pairs = zip(np.ravel(found).tolist(), [x for row in exact for x in row], strict=True)
    return float(max(abs(mp.mpf(a) - b) for a, b in pairs))
