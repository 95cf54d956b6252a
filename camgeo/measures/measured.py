"""The value of a figure, with its unit and place."""

from __future__ import annotations

from typing import NamedTuple

ABRUPT = "the motion changes too abruptly to be resolved"


class Measured(NamedTuple):
    """Value of a figure in its unit, None for the reason in `detail`.

    `at` is the input at its place in `at_unit`, such as the shaft angle, None without one. `surface` names the surface
    or contact that has the value where there are several, else it is empty.
    """

    value: float | None
    unit: str
    at: float | None = None
    detail: str = ""
    surface: str = ""
    at_unit: str = "deg"

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of its place, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None
