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


class Law(Protocol):
    """A motion over the shaft angle."""

    def derivatives(self, theta: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Position and its derivatives at theta (n,), (order + 1, n)."""
        ...


class _Turn(ABC):
    """What follows from `rows`."""

    @abstractmethod
    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Position and its derivatives by the shaft angle."""

    def turn(self, shaft: Array, order: int) -> Array:
        """The same over one turn whose last angle is its end: there the derivatives are those that precede."""
        return np.concatenate([self.rows(shaft[:-1], order), self.rows(shaft[-1:], order, -1)], axis=1)


class _Swing:
    """How an angle about a pivot is shown."""

    title: ClassVar[str] = "swing"
    unit: ClassVar[str] = "deg"

    def column(self, units: str) -> str:  # noqa: ARG002
        """Name of its column."""
        return "follower_deg"

    def shown(self, mm: float) -> float:  # noqa: ARG002
        """Degrees."""
        return math.degrees(1.0)

    def converted(self, value: Array, mm: float) -> Array:  # noqa: ARG002
        """Degrees."""
        return np.degrees(value)


@dataclass(frozen=True)
class LiftPosition(_Turn):
    """Along a line, by a law whose parameter is the shaft angle; `datum` is the law's value at lift 0, mm."""

    law: Law
    datum: float = 0.0
    title: ClassVar[str] = "lift"
    unit: ClassVar[str] = "mm"

    def column(self, units: str) -> str:
        """Name of its column in a table, in a recipe's unit of length."""
        return "lift_in" if units == "inch" else "lift_mm"

    def shown(self, mm: float) -> float:
        """Factor from `rows` to what tables and plots show: lengths in units of `mm` mm."""
        return 1.0 / mm

    def converted(self, value: Array, mm: float) -> Array:
        """Positions (n,) in units of `mm` mm; `shown` may differ from it by a last digit."""
        return value / mm

    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Lift from its datum, mm, and its derivatives by the shaft angle, (order + 1, n); at a break of a side."""
        found = np.array(self.law.derivatives(shaft, order, side))
        found[0] -= self.datum
        return found

    def travel(self, shaft: Array, order: int) -> Array:
        """Position from the zero of the contacts, not from the datum, and its derivatives, (order + 1, n)."""
        return self.law.derivatives(shaft, order)

    def parameters(self, shaft: Array, relative: Array) -> dict[str, Array]:  # noqa: ARG002
        """Parameters of the contour (n,) at which the first contact touches, by the label of its columns: none.

        `relative` is the cam's angle against the frame that carries the follower, the shaft's without one. A second
        contact, opposite, is not tabled.
        """
        return {"": relative}

    def shaft_deg(self, parameter: float) -> float:
        """Shaft angle in degrees, from 0 to less than 360, at which the contour is touched at a parameter: the same."""
        return degrees(parameter)

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Stroke in mm, looked at at parameters, and what works it: 1."""
        return float(np.ptp(self.law.derivatives(parameter, 0)[0])), 1.0

    def by_parameter(self, parameter: Array, order: int) -> Array:
        """Lift, mm, without datum, and its derivatives by the shaft angle at parameters of the law, (order + 1, n)."""
        return self.law.derivatives(parameter, order)


@dataclass(frozen=True)
class ArmPosition(_Swing, LiftPosition):
    """About a pivot, by a law whose parameter is the shaft angle, rad; `arm` is what it works at, mm."""

    arm: float = 1.0

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Swing in rad, and the arm in mm."""
        return super().stroke(parameter)[0], self.arm


@dataclass(frozen=True)
class SwingPosition(_Swing, _Turn):
    """About a pivot, by a law of transmission; `share` of its angle psi is the follower's own swing."""

    law: Transmission
    share: float = 1.0

    def rows(self, shaft: Array, order: int, side: Literal[-1, 1] = 1) -> Array:
        """Swing, rad, and its derivatives."""
        return self.share * self.law.psi_of_shaft(shaft, order, side)

    def travel(self, shaft: Array, order: int) -> Array:
        """The same as `rows`."""
        return self.rows(shaft, order)

    def parameters(self, shaft: Array, relative: Array) -> dict[str, Array]:  # noqa: ARG002
        """Of A and B. The law repeats itself with phi - psi + delta in place of phi and -psi in place of psi (W 4.9).

        Done mu times, mu odd, that puts A where B is, at phi - psi + alpha.
        """
        psi = self.law.psi_of_shaft(shaft, 0)[0]
        return {"a_": self.law.parameter(shaft), "b_": self.law.parameter(shaft - psi + self.law.alpha)}

    def shaft_deg(self, parameter: float) -> float:
        """Shaft angle of a parameter of the law."""
        return degrees(float(self.law.at(parameter, 0)[0][0, 0]))

    def stroke(self, parameter: Array) -> tuple[float, float]:
        """Swing in rad, and the arm in mm."""
        return float(np.ptp(self.law.at(parameter, 0)[1][0])) * self.share, self.law.arm

    def by_parameter(self, parameter: Array, order: int) -> Array:
        """Swing, rad: derivatives by the shaft angle as quotients of series, where phi' and psi' nearly meet too."""
        from kin.numeric.elementary import Jet

        shaft, psi = self.law.jets(Jet.variable(parameter, order))
        found = [psi.c[0]]
        for k in range(1, order + 1):
            psi = psi.derivative() / Jet(shaft.derivative().c[: order + 1 - k])
            found.append(psi.c[0])
        return self.share * np.array(found)


Position: TypeAlias = LiftPosition | SwingPosition
"""Where the follower stands, from its datum: mm, or radians of its own swing."""
