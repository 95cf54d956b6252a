"""Lines of contact between rollers and flanks at shaft angles: where they begin and end, and how they bear."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from kin.numeric.arrays import Array, Indices

ALONG = 9  # places along a roller between which it is sought where the flank ends


@dataclass(frozen=True, eq=False)
class Engaged:
    """Lines of contact of one flank at shaft angles (n,), rad, each with the j rollers that may touch the cam."""

    design: IndexDesign
    name: str
    theta: Array

    @cached_property
    def angles(self) -> Array:
        """Shaft angles (n, j), rad, at which the roller that is at `start` at 0 takes the place of each roller."""
        return self.theta[:, None] + TURN * np.array(self.design.turns)

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """Places (n, j), mm, along the rollers between which the flank bears; equal where it does not."""
        recipe, flank, theta = self.design.recipe, self.design.flanks[self.name], self.angles.ravel()
        form, (low, high), bearing = recipe.form, self.design.spanned, self.design.bearing
        rho = np.linspace(*bearing, ALONG)
        contact = flank.contact(theta, flank.pose(theta), rho[:, None])
        beside = np.minimum(contact.z, form.length - contact.z)
        margin = np.minimum(beside, np.sign(form.blank - form.floor) * (form.blank - contact.w))
        psi = flank.psi(theta)
        margin = np.where((psi > low) & (psi < high), margin, -1.0).reshape(ALONG, *self.angles.shape)
        inside = margin > 0.0
        some = inside.any(axis=0)
        first, last = np.argmax(inside, axis=0), ALONG - 1 - np.argmax(inside[::-1], axis=0)
        before, behind = np.maximum(first - 1, 0), np.minimum(last + 1, ALONG - 1)

        def crossing(out: Indices, within: Indices) -> Array:
            here, there = (np.take_along_axis(margin, each[None], axis=0)[0] for each in (within, out))
            share = np.where(there < here, here / np.maximum(here - there, 1e-300), 0.0)
            return np.asarray(rho[within] + np.clip(share, 0.0, 1.0) * (rho[out] - rho[within]))

        begin, end = crossing(before, first), crossing(behind, last)
        return np.where(some, begin, bearing[0]), np.where(some, end, bearing[0])

    @cached_property
    def length(self) -> Array:
        """Length (n, j), mm, of each line; 0 of a roller that the flank does not bear on."""
        return np.asarray(self.ends[1] - self.ends[0])

    @cached_property
    def middle(self) -> Array:
        """Places (n, j), mm, in the middle of the lines."""
        return 0.5 * (self.ends[0] + self.ends[1])

    @property
    def bears(self) -> Array:
        """Whether the flank bears on each roller, (n, j)."""
        return np.asarray(self.length > 0.0)

    def angle(self, rho: Array) -> Array:
        """Pressure angles (n, j), rad, at places along the rollers."""
        found = self.design.flanks[self.name].pressure(self.angles.ravel(), rho.ravel())
        return found.reshape(self.angles.shape)

    def pressure(self, rho: Array) -> Array:
        """Magnitudes (n, j), rad, of pressure angles; nan of rollers that the flank does not bear on."""
        return np.where(self.bears, np.abs(self.angle(rho)), np.nan)

    def lever(self, rho: Array) -> Array:
        """Lever arms (n, j), mm, of the contact force about the turret's axis, at places along the rollers."""
        return np.asarray(self.design.recipe.form.lever(rho) * np.cos(self.angle(rho)))

    @cached_property
    def levers(self) -> Array:
        """Lever arms (n, j), mm, of the contact force about the turret's axis, in the middle of each line."""
        return self.lever(self.middle)

    @cached_property
    def best(self) -> tuple[Array, Array]:
        """Indices (n,) of the roller with the least line load under a torque, and this load by that torque, 1/mm^2.

        The load is infinite where the flank bears on no roller.
        """
        with np.errstate(divide="ignore"):
            load = np.where(self.bears, 1.0 / (self.levers * self.length), np.inf)
        index = np.argmin(load, axis=1)
        return index, load[np.arange(index.size), index]

    @cached_property
    def curvature(self) -> Array:
        """Greatest sum of curvatures (n, j), 1/mm, along each line; 0 of a roller that the flank does not bear on."""
        flank, theta = self.design.flanks[self.name], self.angles.ravel()
        rows = [flank.curvature(theta, rho.ravel()) for rho in (self.ends[0], self.middle, self.ends[1])]
        return np.where(self.bears, np.max(rows, axis=0).reshape(self.angles.shape), 0.0)
