"""Linear cams as kin takes them, and contours of plates and grooves through points of their flanks."""

from __future__ import annotations

import math

import numpy as np
from support.programmes import Segment, law, programme

from kin.contour.contour import Contour
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Harmonics
from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.frame import frame
from kin.linear.intent import Ends, PlateIntent
from kin.linear.outline import Flank

OVERRUN = 6.0
LENGTH, LENGTH_ON_ARM = 120.0, 130.0
TILT = math.radians(24.0)


def flank(follower, u, side=-1, clearance=0.0):
    """Points (n, 2), mm, touched at inputs u (n,), mm, by a roller larger by `clearance`, mm: untrimmed envelope."""
    rows = frame(follower, u)
    return rows.centre + side * (follower.radius + clearance) * rows.normal


def moved(stroke=20.0, rise=50.0, back=40.0, dwell=20.0, laws=("cycloidal", "polynomial-345")):
    """Dwell 10, rise, dwell, return to the length's end."""
    segments = [
        Segment("dwell", 10.0),
        Segment("rise", rise, stroke, law(laws[0])),
        Segment("dwell", dwell),
        Segment("return", back, stroke, law(laws[1])),
    ]
    return programme(segments, 10.0 + rise + dwell + back).motion


def on_stem(radius=8.0, lean=0.0, level=40.0, motion=None):
    """A roller on a stem; lean in degrees, above 0 towards -x."""
    return LinearFollower(Stem(math.radians(-lean)), radius, level, moved() if motion is None else motion)


def on_arm(side=1, radius=8.0):
    """A roller on an arm of 60 about a pivot at 50, 20 degrees below it at lift 0."""
    motion = moved(TILT, 60.0, 50.0, 10.0)
    return LinearFollower(Arm(60.0, 50.0, side), radius, 50.0 + 60.0 * math.sin(math.radians(-20.0)), motion)


def wave(amplitude=5.0, period=40.0):
    """Lift amplitude (1 - cos(2 pi u/period)), without an end."""
    stretch = AffineStretch(Harmonics(amplitude, ((1, -amplitude, 0.0),)), width=period / (2.0 * math.pi))
    return Piecewise(np.array([0.0, period]), (stretch,), period, smooth_seam=True)


def endless(guide=None, radius=6.0, amplitude=5.0):
    """A roller on an endless plate."""
    return LinearFollower(guide or Stem(), radius, 26.0 if guide is None else 35.0, wave(amplitude))


def intent(follower, **more):
    """Intent of a plate with an overrun of 6 at both ends, or of two periods of an endless one."""
    if follower.endless:
        return PlateIntent(follower, None, 2, **more)
    return PlateIntent(follower, Ends((OVERRUN, OVERRUN)), **more)


def top_of(follower, u, clearance=0.0, side=-1):
    """Points of a flank at inputs u (n,), with its straight runs beyond both."""
    points, rows = flank(follower, u, side, clearance), frame(follower, u[[0, -1]], np.array([1, -1]))
    steps = OVERRUN / rows.tangent[:, :1] * rows.tangent
    return np.concatenate([points[:1] - steps[:1], points, points[-1:] + steps[1:]])


def closed(top):
    """Polygon of a plate with the given upper edge (n, 2), from left to right, on y = 0."""
    low, high = top[0, 0], top[-1, 0]
    return Contour.from_vertices(np.concatenate([top[::-1], [[low, 0.0], [high, 0.0]]]))


def polygon(follower, count=300):
    """Plate whose flank is a polygon through points at equal steps of the input."""
    first, last = follower.span
    if not follower.endless:
        return closed(top_of(follower, np.linspace(first, last, count + 1)))
    exact = Flank(follower, None, 2)
    low, high = exact.reach
    u = np.linspace(-4.0 * last, 6.0 * last, 10 * count + 1)
    points = flank(follower, u)
    inside = (points[:, 0] > low + 1e-9) & (points[:, 0] < high - 1e-9)
    return closed(np.concatenate([exact.corners[:1], points[inside], exact.corners[1:]]))


def arcs(follower, count=200, spoil=None):
    """Plate whose flank is arcs through three points each; `spoil` changes the points and bulges, left to right."""
    first, last = follower.span
    top = top_of(follower, np.linspace(first, last, 2 * count + 1))
    ends, middles = np.concatenate([top[:1], top[1:-1:2], top[-1:]]), top[2:-1:2]
    chord = np.diff(ends[1:-1], axis=0)
    half = 0.5 * np.hypot(chord[:, 0], chord[:, 1])
    off = middles - 0.5 * (ends[1:-2] + ends[2:-1])
    height = (chord[:, 1] * off[:, 0] - chord[:, 0] * off[:, 1]) / (2.0 * half)  # to the right of the chord
    bulges = np.concatenate([[0.0], height / half, [0.0]])
    if spoil is not None:
        ends, bulges = spoil(ends.copy(), bulges.copy())
    low, high = ends[0, 0], ends[-1, 0]
    # counter-clockwise the flank runs to -x, each arc the other way round
    points = np.concatenate([[[low, 0.0], [high, 0.0]], ends[::-1]])
    return Contour.from_bulges(points, np.concatenate([[0.0, 0.0], -bulges[::-1], [0.0]]))


def groove(follower, clearance=0.05, count=400, beyond=12.0):
    """Polygon of a groove, its ends upright beyond the flanks."""
    u = np.linspace(*follower.span, count + 1)
    flanks = [flank(follower, u, -1), flank(follower, u, 1, clearance)]
    aside = np.array([beyond, 0.0])
    low, high = (np.concatenate([row[:1] - aside, row, row[-1:] + aside]) for row in flanks)
    return Contour.from_vertices(np.concatenate([low, high[::-1]]))
