# needs: dynamics
"""Draw docs/pictures/dynamics-train.png: `python tools/docs/make_dynamics_pictures.py`."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import matplotlib as mpl
import numpy as np

from kin.contour.contour import Contour
from kin.dynamics.drive import drives
from kin.dynamics.excitation import intended_faces, measured_faces
from kin.dynamics.response import ResponsePlaces
from kin.dynamics.separation import float_speed
from kin.dynamics.train import Steady, Train, steady
from kin.follower.follower import follower_of
from kin.law.contacts import Contact, Flat, Translating
from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.support_function import lift_constant_breadth

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

ROOT = Path(__file__).parents[2]
INK, ACCENT, PALE = "#26323f", "#c8442c", "#7d93ab"
TURN = 2.0 * math.pi
TRAIN = Train(0.4, 20.0, 2e5, 150.0)


def force(found: Steady, rpm: float, phi: np.ndarray) -> np.ndarray:
    """Contact force of a steady state at shaft angles."""
    response = found.response
    stretch = np.minimum(np.searchsorted(response.drive.knots, phi, side="right") - 1, len(response) - 1)
    at = ResponsePlaces(stretch, phi - response.drive.knots[stretch])
    return TRAIN.at(rpm).force(response).at(found.starts, at)


def main() -> None:
    """Contact force over a turn, as intended and as cut, and the least force over the speed."""
    segments = (Move(math.radians(120.0), named("modified-sine"), by=20.0), Dwell(math.radians(60.0)))
    lift = lift_constant_breadth(40.0, programme(segments, math.pi, around=-1))
    follower = follower_of([Contact(Translating(), Flat())], lift.law)
    (intended,) = drives([intended_faces(follower, None).lower])
    t = TURN / 48 * np.arange(48)
    p, slope = lift.derivatives(t, 1)
    points = np.stack([p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)], axis=-1)
    (coarse,) = drives([measured_faces(follower, Contour.from_vertices(points), None).lower])

    figure, axes = plt.subplots(1, 3, figsize=(11, 3.2), constrained_layout=True)
    phi = np.linspace(0.0, TURN, 4001)[:-1]
    for rpm, colour in ((300.0, PALE), (600.0, INK), (750.0, ACCENT)):
        found = steady(TRAIN, intended, rpm)
        axes[0].plot(np.degrees(phi), force(found, rpm, phi), color=colour, lw=1.2, label=f"{rpm:.0f} rpm")
    axes[0].set_title("contact force as intended, N", fontsize=9)
    axes[0].legend(fontsize=7, frameon=False)
    for drive, colour, name in ((coarse, ACCENT, "polygon of 48 edges"), (intended, INK, "intended")):
        found = steady(TRAIN, drive, 300.0)
        axes[1].plot(np.degrees(phi), force(found, 300.0, phi), color=colour, lw=1.0, label=name)
    axes[1].set_title("300 rpm, as cut: flats of the polygon ring", fontsize=9)
    axes[1].legend(fontsize=7, frameon=False)
    speeds = np.linspace(200.0, 1000.0, 400)
    least = [steady(TRAIN, intended, float(rpm)).force.least for rpm in speeds]
    begin = float_speed(TRAIN, intended)
    axes[2].plot(speeds, least, color=INK, lw=1.2)
    axes[2].axhline(0.0, color=PALE, lw=0.8)
    axes[2].plot([begin.rpm], [0.0], "o", color=ACCENT, ms=5)
    axes[2].annotate(
        f"float begins at {begin.rpm:.1f} rpm", (begin.rpm, 0.0), (250.0, -120.0), fontsize=8, color=ACCENT
    )
    axes[2].set_ylim(-250.0, 160.0)
    axes[2].set_title("least contact force over the speed, N", fontsize=9)
    for axis, label in zip(axes, ("shaft angle, deg", "shaft angle, deg", "rpm"), strict=True):
        axis.set_xlabel(label, fontsize=8)
        axis.tick_params(labelsize=7)
        axis.grid(alpha=0.25)
    figure.savefig(ROOT / "docs" / "pictures" / "dynamics-train.png", dpi=85)
    print(f"float begins at {begin.rpm:.6f} rpm, rigid {begin.rigid_rpm:.6f}")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
