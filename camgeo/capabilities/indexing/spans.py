"""Where the flanks of an indexing cam meet its end faces, layer by layer, and whether the track is sound there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.forms import QUARTER
from camgeo.curve.curve import CurveError
from kin.numeric.angles import TURN
from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.indexing.flank import Flank
    from kin.numeric.arrays import Array, Mask

SEEK = 720  # shaft angles of a turn at which ends are sought
LAYERS = 9  # at which a cam is looked at
SETTLED = 1e-12  # rad: the last step to an end
MARGIN = 0.1  # rad on the turret beyond the ends of the cam, over which a track is sought


class TrackError(CurveError):
    """A track that does not go from one end face of the cam to the other, with a shaft angle, rad, in `parameter`.

    `remedy` says what serves.
    """

    def __init__(self, message: str, parameter: float, remedy: str) -> None:
        super().__init__(message, parameter)
        self.remedy = remedy


class Span(NamedTuple):
    """Where a flank is within the cam in layers w (m,), mm: shaft angles (2, m), rad, where it enters and leaves."""

    w: Array
    theta: Array


def layers_of(flank: Flank, count: int = LAYERS) -> Array:
    """Layers from the floor to the blank, mm (count,)."""
    return np.linspace(flank.form.floor, flank.form.blank, count)


def angles_of(flank: Flank) -> Array:
    """Shaft angles, rad, over which the motion is known and the roller may touch the cam, or is a little beyond it."""
    first, last = flank.law.turns
    theta = np.linspace(TURN * first, TURN * (last + 1), SEEK * (last + 1 - first) + 1)
    return np.asarray(theta[_near(flank, theta)])


def _near(flank: Flank, theta: Array) -> Mask:
    """Whether the roller may touch the cam at shaft angles (n,), rad, or is a little beyond it (n,)."""
    low, high = flank.form.spanned(flank.radius)
    psi = flank.psi(theta)
    return np.asarray((psi > max(low - MARGIN, -QUARTER)) & (psi < min(high + MARGIN, QUARTER)))


def span_of(flank: Flank, w: Array) -> Span:
    """Where a flank enters at the lower end face and leaves at the upper one, in layers (m,), mm.

    Raises TrackError where it does not.
    """
    low, high = _brackets(flank, w)
    theta = np.stack([_end(flank, w, low[k], high[k], k * flank.form.length) for k in range(2)])
    return Span(w, theta)


def _brackets(flank: Flank, w: Array) -> tuple[Array, Array]:
    """Shaft angles, rad (2, m) each, between which a flank enters, and leaves, in layers (m,); as `span_of` raises."""
    theta = angles_of(flank)
    pose = flank.pose(theta)
    length = flank.form.length
    found = np.empty((2, 2, w.size))
    for j, layer in enumerate(w.tolist()):
        rho = flank.reached(pose, layer)
        z = np.where(np.isfinite(rho), flank.contact(theta, pose, rho).z, np.nan)
        inside = (z > 0.0) & (z < length)
        if not inside.any():
            problem = f"the {flank.name} flank does not pass between the end faces"
            middle = float(theta[theta.size // 2]) if theta.size else 0.0
            raise TrackError(problem, middle, "set the turret to the middle of the cam")
        run = np.flatnonzero(inside)
        first, last = int(run[0]), int(run[-1])
        enters = first > 0 and bool(z[first - 1] <= 0.0)
        leaves = last + 1 < theta.size and bool(z[last + 1] >= length)
        if not (enters and leaves):
            raise _missed(flank, float(theta[last if enters else first]), "upper" if enters else "lower")
        if run.size != last - first + 1:
            gap = int(run[np.argmax(np.diff(run) > 1)])
            problem = f"the {flank.name} flank leaves the cam and comes back"
            raise TrackError(problem, float(theta[gap]), "let the turret advance without turning back")
        found[:, 0, j] = theta[first - 1], theta[first]
        found[:, 1, j] = theta[last], theta[last + 1]
    return found[0], found[1]


def _missed(flank: Flank, theta: float, name: str) -> TrackError:
    return TrackError(
        f"the {flank.name} flank does not reach the {name} end face: the roller leaves the cam at its side",
        theta,
        "give a shorter part.length",
    )


def _end(flank: Flank, w: Array, low: Array, high: Array, z: float) -> Array:
    """Shaft angles (m,), rad, between two, at which a flank meets the plane of height z, mm, in layers (m,), mm."""

    def off(theta: Array) -> tuple[Array, Array]:
        pose = flank.pose(theta)
        rho = flank.reached(pose, w)
        touch = flank.touch(pose, rho)
        w1, w2 = flank.rising(touch, flank.outwards(pose, rho, touch)[1])
        g, tau, _ = flank.form.axes(pose, touch.sine, touch.cosine)
        z1 = touch.along * tau[2] + touch.beside * g[2]
        z2 = g[2] - flank.side * flank.radius * touch.a2 * tau[2]
        return flank.place(pose, rho, touch.sine, touch.cosine)[2] - z, z1 - z2 * w1 / w2

    return zeros(off, low, high, 0.5 * (low + high), SETTLED)


def breaks_within(flank: Flank) -> Array:
    """Shaft angles, rad, rising, at which a derivative of the motion may jump, where the roller is near."""
    theta = flank.law.breaks_over(*flank.law.turns)
    return np.asarray(theta[_near(flank, theta)])


def layers_at(flank: Flank, theta: Array, z: float) -> Array:
    """Layers (n,), mm, in which a flank meets the plane of height z, mm, at shaft angles (n,), rad.

    They are between floor and blank, and the nearer of these where it does not.
    """
    ends = flank.on(theta, flank.form.floor).z, flank.on(theta, flank.form.blank).z
    pose = flank.pose(theta)
    low, high = np.full_like(theta, flank.form.floor), np.full_like(theta, flank.form.blank)
    sense = np.where(ends[1] > ends[0], 1.0, -1.0) * (1.0 if flank.form.blank > flank.form.floor else -1.0)

    def off(w: Array) -> tuple[Array, Array]:
        rho = flank.reached(pose, w)
        touch = flank.touch(pose, rho)
        w2 = flank.rising(touch, flank.outwards(pose, rho, touch)[1])[1]
        g, tau, _ = flank.form.axes(pose, touch.sine, touch.cosine)
        z2 = g[2] - flank.side * flank.radius * touch.a2 * tau[2]
        return sense * (flank.place(pose, rho, touch.sine, touch.cosine)[2] - z), sense * z2 / w2

    return zeros(off, np.minimum(low, high), np.maximum(low, high), 0.5 * (low + high), SETTLED)


def demand_ends(flanks: Mapping[str, Flank]) -> None:
    """Raise TrackError where the rib between two turns of the groove does not reach an end face, and as `span_of` does.

    Flanks are `lower` and `upper`. It is looked at on the floor and on the blank.
    """
    lower, upper = (
        (flank, span_of(flank, np.array([flank.form.floor, flank.form.blank])))
        for flank in (flanks["lower"], flanks["upper"])
    )
    for k, name in enumerate(("lower", "upper")):
        (one, ends), (other, others) = lower, upper
        open_ = one.on(ends.theta[k], ends.w).phi - other.on(others.theta[k], others.w).phi
        if not bool(((open_ > 0.0) & (open_ < TURN)).all()):
            problem = f"the track is open over a whole turn at the {name} end face: the rib does not reach it"
            raise TrackError(problem, float(ends.theta[k][0]), "give another part.length, or turret.start")
