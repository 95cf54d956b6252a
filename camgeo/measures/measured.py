"""The value of a figure, with its unit and place."""

from __future__ import annotations

from typing import NamedTuple

ABRUPT = "the motion changes too abruptly to be resolved"


class Measured(NamedTuple):
    """Value of a figure in its unit, None for the reason in `detail`; `at_deg` is its shaft angle, None without one.

    `surface` names the surface or contact that has the value where there are several, else it is empty.
    """

    value: float | None
    unit: str
    at_deg: float | None = None
    detail: str = ""
    surface: str = ""
