"""The follower's position over the shaft angle, by either law of kin: a lift along a line, or a swing about a pivot."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, Literal, Protocol, TypeAlias

import numpy as np

from kin.numeric.angles import degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array


class PositionLaw(Protocol):
    """Protocol of a motion over the shaft angle."""

    def derivatives(self, theta: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Position, mm or rad, and its derivatives by rad at theta (n,), (order + 1, n).

        With `side` -1 they are the limits from below at a break.
        """
        ...


class _Turn(ABC):
    """Positions of the follower over one turn."""

    @abstractmethod
    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Position, mm or rad, and its derivatives by the shaft angle at `shaft` (n,), rad: (order + 1, n).

        With `side` -1 they are the limits from below at a break.
        """

    def turn(self, shaft: Array, order: int) -> Array:
        """Position, mm or rad, and derivatives by the shaft angle over one turn, (order + 1, n).

        At the last angle, the turn's end, the derivatives are those before it.
        """
        return np.concatenate([self.rows(shaft[:-1], order), self.rows(shaft[-1:], order, -1)], axis=1)


class _Swing:
    """Column, unit and factor by which an angle about a pivot is reported: in degrees."""

    title: ClassVar[str] = "swing"
    unit: ClassVar[str] = "deg"

    def column(self, units: str) -> str:  # noqa: ARG002 - the protocol's
        """Heading of the column of positions in a table."""
        return "follower_deg"

    def factor(self, mm: float) -> float:  # noqa: ARG002 - the protocol's
        """Factor from rad to degrees."""
        return math.degrees(1.0)

    def convert(self, value: Array, mm: float) -> Array:  # noqa: ARG002 - the protocol's
        """Positions (n,), rad, in degrees."""
        return np.degrees(value)


@dataclass(frozen=True)
class LiftPosition(_Turn):
    """Lift along a line, by a law whose parameter is the shaft angle; `datum` is the law's value at lift 0, mm.

    A subclass reports the same law as a swing, mm read as rad.
    """

    law: PositionLaw
    datum: float = 0.0
    title: ClassVar[str] = "lift"
    unit: ClassVar[str] = "mm"

    def column(self, units: str) -> str:
        """Heading of the column of positions in a table, in a recipe's unit of length."""
        return "lift_in" if units == "inch" else "lift_mm"

    def factor(self, mm: float) -> float:
        """Factor from mm to the unit of tables and plots, of `mm` mm."""
        return 1.0 / mm

    def convert(self, value: Array, mm: float) -> Array:
        """Positions (n,), mm, in a unit of `mm` mm, by division: a product with `factor` may end in another digit."""
        return value / mm

    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Lift above the datum, mm, and derivatives by the shaft angle, (order + 1, n); `side` -1 before breaks."""
        rows = np.array(self.law.derivatives(shaft, order, side))
        rows[0] -= self.datum
        return rows

    def travel(self, shaft: Array, order: int) -> Array:
        """The law's position, not less the datum, mm or rad, and derivatives at shaft angles (n,): (order + 1, n)."""
        return self.law.derivatives(shaft, order)

    def parameters(self, shaft: Array, relative: Array) -> dict[str, Array]:  # noqa: ARG002 - the protocol's
        """Parameter of the contour, rad (n,), of each contact, by the prefix of the contact's columns in tables.

        A lift has one entry, that of the first contact, with an empty prefix. `relative` is the cam's angle, rad (n,),
        against the frame that carries the follower, the shaft's without one.
        """
        return {"": relative}

    def shaft_deg(self, parameter: float) -> float:
        """Shaft angle, degrees from 0 to less than 360, at which the contour is touched at a parameter, rad."""
        return degrees(parameter)

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Stroke over parameters (n,), mm, and 1 in place of the length of an arm."""
        return float(np.ptp(self.law.derivatives(parameter, 0)[0])), 1.0

    def by_parameter(self, parameter: Array, order: int) -> Array:
        """The law's position, not less the datum, mm, and derivatives by the shaft angle at parameters (n,) of the law.

        The shape is (order + 1, n).
        """
        return self.law.derivatives(parameter, order)


@dataclass(frozen=True)
class ArmPosition(_Swing, LiftPosition):
    """Swing about a pivot, rad, by a law whose parameter is the shaft angle; `arm` is the arm's length, mm."""

    arm: float = 1.0

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Swing over parameters (n,), rad, and the length of the arm, mm."""
        return super().stroke(parameter)[0], self.arm


@dataclass(frozen=True)
class SwingPosition(_Swing, _Turn):
    """Swing about a pivot, by Wunderlich's law of transmission; the follower swings by `share` times its psi."""

    law: Transmission
    share: float = 1.0

    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Swing, rad, and derivatives by the shaft angle at `shaft` (n,), (order + 1, n); `side` -1 before breaks."""
        return self.share * self.law.psi_of_shaft(shaft, order, side)

    def travel(self, shaft: Array, order: int) -> Array:
        """Swing, rad, and its derivatives by the shaft angle, (order + 1, n), at shaft angles (n,)."""
        return self.rows(shaft, order)

    def parameters(self, shaft: Array, relative: Array) -> dict[str, Array]:  # noqa: ARG002 - the protocol's
        """Parameters of the contour, rad (n,), at contacts A and B, by the prefixes of their columns, `a_` and `b_`.

        The law repeats itself with phi - psi + delta for phi and -psi for psi (W 1984, 4.9). Repeated mu times, mu odd,
        that puts A where B is, at phi - psi + alpha.
        """
        psi = self.law.psi_of_shaft(shaft, 0)[0]
        return {"a_": self.law.parameter(shaft), "b_": self.law.parameter(shaft - psi + self.law.alpha)}

    def shaft_deg(self, parameter: float) -> float:
        """Shaft angle, degrees from 0 to less than 360, at a parameter of the law."""
        return degrees(float(self.law.at(parameter, 0)[0][0, 0]))

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Swing over parameters (n,), rad, and the length of the arm, mm."""
        return float(np.ptp(self.law.at(parameter, 0)[1][0])) * self.share, self.law.arm

    def by_parameter(self, parameter: Array, order: int) -> Array:
        """Swing, rad, and derivatives by the shaft angle at parameters (n,) of the law, (order + 1, n).

        They are quotients of series, which also hold where phi' and psi' nearly meet.
        """
        from kin.numeric.elementary import Jet

        shaft, psi = self.law.jets(Jet.variable(parameter, order))
        derivatives = [psi.c[0]]
        for k in range(1, order + 1):
            psi = psi.derivative() / Jet(shaft.derivative().c[: order + 1 - k])
            derivatives.append(psi.c[0])
        return self.share * np.array(derivatives)


Position: TypeAlias = LiftPosition | SwingPosition
"""Position of the follower from its datum: mm, or radians of its own swing."""
