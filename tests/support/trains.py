# needs: dynamics
"""Oscillators and follower trains by their ratios, and states of a response at places."""

import math

import numpy as np

from kin.dynamics.oscillator import Oscillator
from kin.dynamics.peaks import ResponseFigure
from kin.dynamics.train import Train


def oscillator(r, zeta):
    """Oscillator of natural frequency r and damping ratio zeta."""
    return Oscillator(zeta * r, r * r)


def stiff(ratio, zeta, rpm=300.0, preload=0.0, mass=0.4):
    """Train whose natural frequency is `ratio` times the shaft's at `rpm`."""
    natural = ratio * rpm * 2.0 * math.pi / 60.0
    return Train(mass, 2.0 * zeta * mass * natural, mass * natural**2, preload)


def states(response, starts, samples):
    """States z and z' (2, n) at samples, from those (2, m) at the starts of all stretches."""
    return np.stack([ResponseFigure.of(response, *weights).at(starts, samples) for weights in ((1.0, 0.0), (0.0, 1.0))])


def moved(free, state, time):
    """States (2, n) of the free motion of an oscillator after times (n,), from states (2, n)."""
    zz, zv, vz, vv = free.propagator(time)
    z, v = state
    return np.stack([zz * z + zv * v, vz * z + vv * v])
