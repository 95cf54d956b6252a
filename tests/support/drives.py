"""Motions in closed form that drive a follower train."""

import math

import numpy as np

TURN = 2.0 * math.pi


class Harmonic:
    """cos(order phi)."""

    breaks = np.empty(0)
    smooth = True

    def __init__(self, order, size=1.0):
        self.order, self.size = order, size

    def rows(self, phi):
        k = self.order
        return self.size * np.stack([np.cos(k * phi), -k * np.sin(k * phi), -k * k * np.cos(k * phi)])


class Saw:
    """Up with slope 1 over half a turn, and down again: corners at 0 and pi."""

    breaks = np.array([0.0, np.pi])
    smooth = False

    def rows(self, phi):
        up = phi < np.pi
        return np.stack([np.where(up, phi, TURN - phi), np.where(up, 1.0, -1.0), np.zeros_like(phi)])


class Still:
    """A face that does not move."""

    breaks = np.empty(0)
    smooth = True

    def __init__(self, position=0.0):
        self.position = position

    def rows(self, phi):
        return np.stack([np.full_like(phi, self.position), np.zeros_like(phi), np.zeros_like(phi)])
