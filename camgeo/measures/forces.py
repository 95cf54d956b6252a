"""Forces at a follower's contacts over the turn, as figures and as the report's sections.

Lengths are mm and forces N here; of a follower that swings positions are rad and moments N mm, reported in N m.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.measures.units import UNIT_NAMES
from kin.numeric.angles import TURN, degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import Preload
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.follower.contact_forces import Elastic
    from kin.follower.contact_lines import ContactLine
    from kin.numeric.arrays import Array
    from kin.numeric.monotone import MonotonePieces

SHARE = 1e-12  # of the greatest value, within which a force is approximated over the turn
ROUNDING = 1e-12  # rad, within which two places of the turn are one
PER_MM = 1e-3  # from N/m to N/mm, and from N mm to N m


class ExtremeAtAngle(NamedTuple):
    """A least or greatest value over the turn, and its shaft angle in degrees."""

    value: float
    at_deg: float


class Turn(ABC):
    """A mechanism over the turn, by a parameter, rad, that rises with the shaft angle from 0 to a whole turn.

    `corners` are shaft angles, rad, at which forces are not smooth though the motion is.
    """

    corners: tuple[float, ...]

    @property
    @abstractmethod
    def swings(self) -> bool:
        """Whether forces along the travel are moments."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Name of each contact in reports."""

    @abstractmethod
    def rows(self, t: Array) -> Array:
        """Position and two derivatives by the shaft angle at parameters t (n,): (3, n), mm or rad."""

    @property
    @abstractmethod
    def places(self) -> Array:
        """Parameters (k,), rising from 0 to a whole turn, between which the motion is smooth."""

    def shaft(self, t: Array) -> Array:
        """Shaft angles (n,), rad, at parameters t (n,), rad; equal to them unless overridden."""
        return t

    def parameter(self, phi: Array) -> Array:
        """Parameters (n,), rad, at shaft angles phi (n,), rad; equal to them unless overridden."""
        return phi

    @property
    def unit(self) -> str:
        """Unit of forces along the travel, as reported."""
        return "N m" if self.swings else "N"

    def pieces(
        self, values: Callable[[Array], Array], stretch: tuple[float, float] = (0.0, TURN)
    ) -> list[MonotonePieces]:
        """Monotone pieces of r functions of the parameter over a stretch of it; `values` maps t (n,) to (r, n).

        A stretch, rad, may go on into the next turn. Raises RoughError where a function changes too abruptly.
        """
        from kin.numeric.monotone import between

        corners = self.parameter(np.array(self.corners))
        # no sliver of rounding between a corner and a place that are one, nor at an end of the stretch
        apart = np.abs(corners[:, None] - self.places).min(axis=1, initial=TURN) > ROUNDING
        places = np.concatenate([self.places, corners[apart]])
        if stretch == (0.0, TURN):
            return self._pieces(values, between(0.0, TURN, places.tolist()))
        turned = np.concatenate([places - TURN, places, places + TURN])
        inside = turned[(turned > stretch[0] + ROUNDING) & (turned < stretch[1] - ROUNDING)]
        return self._pieces(lambda t: values(np.mod(t, TURN)), between(*stretch, inside.tolist()))

    @staticmethod
    def _pieces(values: Callable[[Array], Array], places: Array) -> list[MonotonePieces]:
        from kin.numeric.monotone import cells, pieces

        functions = cells(values, places, share=SHARE)
        return [pieces(functions, row) for row in range(len(functions.coefficients))]

    def degrees(self, t: float) -> float:
        """Shaft angle, degrees from 0 to less than 360, at a parameter t, rad."""
        return degrees(float(self.shaft(np.array([t]))[0]))

    def extremes(
        self, values: Callable[[Array], Array], stretch: tuple[float, float] = (0.0, TURN)
    ) -> list[tuple[ExtremeAtAngle, ExtremeAtAngle]]:
        """Least and greatest value of r functions of the parameter over a stretch of it, a turn unless it is given.

        `values` maps t (n,) to (r, n). Raises RoughError where a function changes too abruptly.
        """

        def placed(extreme: tuple[float, float]) -> ExtremeAtAngle:
            return ExtremeAtAngle(extreme[0], self.degrees(extreme[1]))

        return [(placed(piece.least()), placed(piece.greatest())) for piece in self.pieces(values, stretch)]


@dataclass(frozen=True, eq=False)
class FollowerTurn(Turn):
    """A design's follower over the turn, by the shaft angle: its position and the lines of its contacts."""

    design: Design
    corners: tuple[float, ...] = ()

    @cached_property
    def swings(self) -> bool:
        """Whether forces along the travel are moments."""
        return self.design.follower.arrangement.unit == "deg"

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each contact in reports: its surface's, or its touch's with a letter where there are two."""
        contacts = self.design.follower.contacts
        letters = "AB" if len(contacts) > 1 else ("",)
        return tuple(
            contact.surface or f"{contact.touch.word} {letter}".rstrip()
            for contact, letter in zip(contacts, letters, strict=True)
        )

    def rows(self, t: Array) -> Array:
        """Position from the zero of the contacts and two derivatives by the shaft angle (3, n), mm or rad."""
        return self.design.motion.travel(t, 2)

    def lines(self, rows: Array) -> tuple[ContactLine, ...]:
        """Line of each contact's force for the motion `rows` (3, n), position and two derivatives, mm or rad."""
        from kin.follower.contact_lines import contact_line

        return tuple(contact_line(contact, rows) for contact in self.design.follower.contacts)

    @cached_property
    def places(self) -> Array:
        """Shaft angles (k,), rad, rising from 0 to a whole turn, between which the motion is smooth."""
        from kin.numeric.monotone import between

        shaft_deg = self.design.motion.shaft_deg
        return between(
            0.0, TURN, sorted(math.radians(shaft_deg(float(parameter))) for parameter in self.design.exact.breaks)
        )


# --- preload by interference ------------------------------------------------------------------------------------------


def elastic_contacts(turn: FollowerTurn, preload: Preload, rows: Array) -> Elastic:
    """Preload and stiffness of both contacts along the travel (n,): N and N/mm, or N mm and N mm/rad.

    `rows` (3, n) are position and two derivatives, mm or rad. Raises ValueError for a preload without stiffness, and
    for a follower without two contacts.
    """
    from kin.follower.contact_forces import preloaded

    if preload.stiffness is None:
        raise ValueError("a preload without stiffness has no force")
    first, second = turn.lines(rows)
    k1, k2 = (PER_MM * stiffness for stiffness in preload.stiffness)
    return preloaded((first.lever, second.lever), preload.overlaps, (k1, k2))


def preload_force(design: Design, preload: Preload) -> tuple[ExtremeAtAngle, ExtremeAtAngle]:
    """Least and greatest force of the preload along the travel over the turn, N, or N m about a pivot.

    Raises ValueError for a preload without stiffness, RoughError for too abrupt a motion.
    """
    turn = FollowerTurn(design)
    scale = PER_MM if turn.swings else 1.0
    ((least, greatest),) = turn.extremes(lambda t: scale * elastic_contacts(turn, preload, turn.rows(t)).preload[None])
    return least, greatest


def preload_section(recipe: Recipe, design: Design) -> dict[str, object] | None:
    """Section of the report on the preload: its force, and the load along the travel at which each contact is lost.

    None without a preload; without a stiffness the section has only the interference. Raises RoughError for too abrupt
    a motion.
    """
    preload = design.exact.preload
    if preload is None:
        return None
    section: dict[str, object] = {"interference": preload.interference / recipe.mm, "unit": UNIT_NAMES[recipe.units]}
    if preload.stiffness is None:
        return section
    turn = FollowerTurn(design)
    scale = PER_MM if turn.swings else 1.0

    def forces(t: Array) -> Array:
        contacts = elastic_contacts(turn, preload, turn.rows(t))
        return scale * np.array([contacts.preload, contacts.loses_second, contacts.loses_first])

    (least, most), (second, _), (_, first) = turn.extremes(forces)
    lost = zip(turn.names, (first, second), strict=True)
    return section | {
        "stiffness": list(preload.stiffness),
        "force": {
            "min": least.value,
            "max": most.value,
            "unit": turn.unit,
            "min_at_deg": least.at_deg,
            "max_at_deg": most.at_deg,
        },
        "lost": [
            {"contact": name, "load": load.value, "unit": turn.unit, "at_deg": load.at_deg} for name, load in lost
        ],
    }
