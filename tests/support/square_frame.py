"""A polygonal cam in a rigid square frame that drives a linkage, by plain geometry on vertices: nothing comes from kin.

The cam stands turned clockwise by the shaft angle in the plane of A = (0, 0) and B = (ground, 0). A trial direction
th3 of the frame tells how far the vertices reach towards its four faces, hence where the frame lies and with it the
joint D; the direction at which D fits the linkage is found by bisection.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from support.heavy import optimize

SCAN = 720  # directions between which the roots are looked for
RESTS = {"1 and 2": (1.0, 1.0), "1 and 4": (1.0, 0.0), "3 and 2": (0.0, 1.0), "3 and 4": (0.0, 0.0)}
CENTRED = (0.5, 0.5)


def axes(th3):
    """u and n of the frame."""
    return np.array([np.cos(th3), np.sin(th3)]), np.array([-np.sin(th3), np.cos(th3)])


@dataclass(frozen=True)
class Bars:
    """kind: four-bar (ground, coupler, rocker), inverted (ground, rocker) or slider (coupler, offset); side +1 open.

    `aside` is how far the joint, or the line of the slide, stands from the frame's mid-line towards face 1.
    """

    kind: str
    ground: float = 0.0
    coupler: float = 0.0
    rocker: float = 0.0
    offset: float = 0.0
    side: int = 1
    aside: float = 0.0

    def miss(self, joint, th3, lift, breadth):
        """How far the joint D is from where the linkage wants it, for a trial direction of the frame."""
        if self.kind == "four-bar":
            return np.hypot(joint[0] - self.ground, joint[1]) - self.rocker
        if self.kind == "slider":
            return joint[1] - self.offset
        # the pivot B carries a rocker at right angles to the frame's slide, which lies at -Y from the shaft's line
        return self.ground * np.sin(th3) - self.rocker + lift - breadth / 2 + self.aside

    def length(self, breadth, along):
        """X, the distance of the joint from the shaft along the frame."""
        return breadth + self.coupler - along

    def fits(self, joint, th3):
        """Whether the root belongs to the assembly."""
        if self.kind == "inverted":
            return self.side * np.cos(th3) > 0  # th4 = pi/2 - th3 between 0 and pi, or between -pi and 0
        return self.side * (joint[1] if self.kind == "four-bar" else joint[0]) > 0

    def output(self, joint, th3):
        """Angle of the rocker from B's side towards A, or the slide."""
        if self.kind == "slider":
            return joint[0]
        if self.kind == "four-bar":
            return np.arctan2(joint[1], self.ground - joint[0])
        return self.side * np.arccos(np.sin(th3))


def placed(bars, breadth, lift, along, th3):
    """The joint D of a frame with faces 1 and 2 at these distances from the shaft."""
    u, n = axes(th3)
    return bars.length(breadth, along) * u + (lift - breadth / 2 + bars.aside) * n


def solve(bars, breadth, reach, near=None):
    """Direction of the frame, output; `reach(th3)` gives the distances of faces 1 and 2 from the shaft."""

    def miss(th3):
        lift, along = reach(th3)
        return bars.miss(placed(bars, breadth, lift, along, th3), th3, lift, breadth)

    if near is None:
        grid = np.linspace(-np.pi, np.pi, SCAN + 1)
        values = np.array([miss(x) for x in grid])
        roots = [
            optimize.brentq(miss, a, b, xtol=1e-15, rtol=1e-15)
            for a, b, va, vb in zip(grid[:-1], grid[1:], values[:-1], values[1:], strict=True)
            if (va < 0) != (vb < 0)
        ]
    else:
        roots = [optimize.brentq(miss, near - 0.03, near + 0.03, xtol=1e-15, rtol=1e-15)]
    found = []
    for th3 in roots:
        lift, along = reach(th3)
        joint = placed(bars, breadth, lift, along, th3)
        if bars.fits(joint, th3):
            found.append((th3, bars.output(joint, th3)))
    assert len(found) == 1, f"{len(found)} positions"
    return found[0]


@dataclass(frozen=True)
class Bench:
    """A linkage, the frame's breadth, and p(theta) of the exact cam, by which the zero of the shaft is set."""

    bars: Bars
    breadth: float
    p: object

    def start(self):
        """Direction of the frame at shaft angle 0, where the relative angle is 0 too."""
        return solve(self.bars, self.breadth, lambda _: (self.p(0.0), self.p(np.pi / 2)))[0]

    def intended(self, phi):
        """Outputs (n,) of the exact cam at shaft angles (n,)."""
        start, near, outputs = self.start(), None, []
        for shaft in phi:

            def reach(th3, shaft=shaft):
                theta = shaft + th3 - start
                return self.p(theta), self.p(theta + np.pi / 2)

            near, output = solve(self.bars, self.breadth, reach, near)
            outputs.append(output)
        return np.array(outputs)

    def measured(self, vertices, phi, rest):
        """Outputs (n,) of a polygon at shaft angles (n,), rising by 0.02 at most; rest: shares of faces 1 and 2."""
        start, near, outputs = self.start(), None, []
        across, along = rest
        for shaft in phi:
            turn = start + np.pi / 2 - shaft
            c, s = np.cos(turn), np.sin(turn)
            here = vertices @ np.array([[c, s], [-s, c]])

            def reach(th3, here=here):
                u, n = axes(th3)
                one, two = (here @ n).max(), (here @ -u).max()
                three, four = (here @ -n).max(), (here @ u).max()
                lift = across * one + (1 - across) * (self.breadth - three)
                return lift, along * two + (1 - along) * (self.breadth - four)

            near, output = solve(self.bars, self.breadth, reach, near)
            outputs.append(output)
        return np.array(outputs)

    def clearances(self, vertices, theta):
        """Play across and along the frame (2, n) at relative angles (n,)."""
        u = np.stack([np.cos(theta), np.sin(theta)])
        n = np.stack([-np.sin(theta), np.cos(theta)])
        wide = [(vertices @ d).max(axis=0) - (vertices @ d).min(axis=0) for d in (u, n)]
        return self.breadth - np.stack(wide)
