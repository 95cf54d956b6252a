"""Rollers that are in touch with the cam at shaft angles: along which part of each the flanks bear, and how."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.lines import Line
    from kin.numeric.arrays import Array

ALONG = 17  # places along a roller between which it is sought where the flank ends


@dataclass(frozen=True, eq=False)
class Engaged:
    """Lines of contact of one flank at shaft angles (n,), rad, each with the j rollers that may touch the cam."""

    design: IndexDesign
    name: str
    theta: Array

    @cached_property
    def angles(self) -> Array:
        """Angles (n, j), rad, at which the roller of no turn stands as each of the rollers does."""
        return self.theta[:, None] + TURN * np.array(self.design.turns)

    def at(self, rho: Array) -> Line:
        """Contacts at places (n, j) along the rollers."""
        return self.design.lines[self.name].along(self.angles, rho)

    def _margin(self, rho: Array) -> Array:
        """Distance, mm (n, j), above 0 of contacts within the blank, and below 0 beside it."""
        recipe, line = self.design.recipe, self.at(rho)
        _, w, _ = line.place
        z, form = line.points[..., 2], recipe.form
        within = np.minimum(np.minimum(z, recipe.length - z), np.sign(form.blank - form.floor) * (form.blank - w))
        low, high = self.design.spanned
        psi = recipe.start + self.design.law.derivatives(self.angles.ravel(), 0)[0].reshape(self.angles.shape)
        return np.where((psi > low) & (psi < high), within, -1.0)

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """Places (n, j), mm, along the rollers between which the flank bears; equal where it does not."""
        roller = self.design.recipe.roller
        rho = np.linspace(roller.inner, roller.outer, ALONG)
        margin = np.stack([self._margin(np.full(self.angles.shape, each)) for each in rho.tolist()])
        inside = margin > 0.0
        some = inside.any(axis=0)
        first, last = np.argmax(inside, axis=0), ALONG - 1 - np.argmax(inside[::-1], axis=0)
        before, behind = np.maximum(first - 1, 0), np.minimum(last + 1, ALONG - 1)
        step, pick = float(rho[1] - rho[0]), np.take_along_axis

        def crossing(out: Array, within: Array) -> Array:
            here, there = (pick(margin, each[None], axis=0)[0] for each in (within, out))
            share = np.where(there < here, here / np.maximum(here - there, 1e-300), 0.0)
            return np.asarray(rho[within] + np.clip(share, 0.0, 1.0) * step * np.sign(out - within))

        begin, end = crossing(before, first), crossing(behind, last)
        return np.where(some, begin, roller.inner), np.where(some, end, roller.inner)

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

    def pressure(self, rho: Array) -> Array:
        """Magnitudes (n, j), rad, of pressure angles; nan of rollers that the flank does not bear on."""
        return np.where(self.bears, np.abs(self.at(rho).pressure), np.nan)

    @cached_property
    def levers(self) -> Array:
        """Moments (n, j), mm, about the turret's axis of a force of 1 at the middle of each line, along its normal."""
        return np.asarray(self.design.recipe.turret.lever(self.middle) * np.cos(self.at(self.middle).pressure))

    @cached_property
    def best(self) -> tuple[Array, Array]:
        """Indices (n,) of the roller that a torque loads least by the mm of its line, and those least loads, 1/mm^2.

        The load is infinite where no roller is borne.
        """
        with np.errstate(divide="ignore"):
            load = np.where(self.bears, 1.0 / (self.levers * self.length), np.inf)
        index = np.argmin(load, axis=1)
        return index, load[np.arange(index.size), index]

    @cached_property
    def curvature(self) -> Array:
        """Greatest sum of curvatures (n, j), 1/mm, along each line; 0 of a roller that the flank does not bear on."""
        rows = [self.at(rho).curvature for rho in (self.ends[0], self.middle, self.ends[1])]
        return np.where(self.bears, np.max(rows, axis=0), 0.0)
