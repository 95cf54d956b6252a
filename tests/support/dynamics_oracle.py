"""Closed forms of the damped oscillator at 60 digits, by other formulas than the product's.

The response from rest to a force e^(mu t) is the divided difference of exp(t x) over both roots and mu; coinciding
roots are moved apart by 1e-25, which changes nothing that a double could show.
"""

from mpmath import MPContext

mp = MPContext()  # its digits are nobody else's
mp.dps = 60
mpf, mpc, pi, sqrt, exp, cos, sin = mp.mpf, mp.mpc, mp.pi, mp.sqrt, mp.exp, mp.cos, mp.sin
APART = mpf(10) ** -25


class Oracle:
    """z'' + 2 zeta r z' + r^2 z = sum of c e^(mu t), pieces one after the other."""

    def __init__(self, r, zeta):
        self.r, self.zeta = mpf(r), mpf(zeta)
        root = sqrt(mpc(self.zeta**2 - 1))
        if abs(root) < APART:
            root = mpc(APART)
        self.first, self.second = self.r * (-self.zeta + root), self.r * (-self.zeta - root)

    def free(self, z, v, t):
        """State after time t of the free motion from (z, v)."""
        a, b = self.first, self.second
        one, two = exp(a * t), exp(b * t)
        p, q = (v - b * z) / (a - b), (a * z - v) / (a - b)
        return (p * one + q * two).real, (p * a * one + q * b * two).real

    def driven(self, terms, t):
        """State after time t from rest under the force sum of c e^(mu t), c and mu complex; real part."""
        a, b = self.first, self.second
        z, v = mpc(0), mpc(0)
        for c, mu in terms:
            m = mpc(mu) if min(abs(mpc(mu) - a), abs(mpc(mu) - b)) > APART else mpc(mu) + APART
            for x, y, w in ((m, a, b), (a, m, b), (b, m, a)):
                part = c * exp(x * t) / ((x - y) * (x - w))
                z += part
                v += x * part
        return z.real, v.real

    def run(self, z, v, terms, t):
        """State after time t from (z, v) under that force."""
        (a, b), (c, d) = self.free(z, v, t), self.driven(terms, t)
        return a + c, b + d

    def periodic(self, pieces):
        """State at the start of a turn that `pieces` (terms, duration) bring back to itself."""
        total = sum(duration for _, duration in pieces)

        def turn(z, v):
            for terms, duration in pieces:
                z, v = self.run(z, v, terms, duration)
            return z, v

        gz, gv = turn(mpf(0), mpf(0))
        (a, c), (b, d) = self.free(mpf(1), mpf(0), total), self.free(mpf(0), mpf(1), total)
        det = (1 - a) * (1 - d) - b * c
        return ((1 - d) * gz + b * gv) / det, (c * gz + (1 - a) * gv) / det


class Cycloid:
    """Rise over `beta`, dwell to pi, the same back, dwell: s = h (x - sin(2 pi x)/(2 pi)), in mp and as a Motion."""

    def __init__(self, beta, stroke):
        import numpy as np

        self.beta, self.stroke = float(beta), float(stroke)
        self.breaks = np.array([0.0, self.beta, np.pi, np.pi + self.beta])
        self.smooth = True

    def rows(self, phi):
        import numpy as np

        back = phi >= np.pi
        t = np.where(back, phi - np.pi, phi)
        x = np.minimum(t / self.beta, 1.0)
        inside = t < self.beta
        w = 2.0 * np.pi / self.beta
        s = self.stroke * (x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi))
        v = np.where(inside, self.stroke / self.beta * (1.0 - np.cos(w * t)), 0.0)
        a = np.where(inside, self.stroke / self.beta * w * np.sin(w * t), 0.0)
        sign = np.where(back, -1.0, 1.0)
        return np.stack([np.where(back, self.stroke - s, s), sign * v, sign * a])

    def pieces(self):
        """Forces -s'' with their durations, at 60 digits."""
        import math

        beta, half = mpf(self.beta), mpf(math.pi)
        size = mpf(self.stroke) / beta * 2 * pi / beta
        wave = [(mpc(0, size), mpc(0, 2 * pi / beta))]  # -size sin = Re(i size e^(i w t))
        back = [(mpc(0, -size), mpc(0, 2 * pi / beta))]
        return [(wave, beta), ([], half - beta), (back, beta), ([], 2 * mpf(math.pi) - half - beta)]


def harmonic(r, zeta, order, phi):
    """Steady z and z' of the drive cos(order phi), at 60 digits."""
    r, zeta, k = mpf(r), mpf(zeta), mpf(order)
    gain = k**2 / (r**2 - k**2 + 2j * zeta * r * k)
    turned = gain * (cos(k * mpf(phi)) + 1j * sin(k * mpf(phi)))
    return turned.real, (1j * k * turned).real
