"""The value of a figure, with its unit and place."""

from __future__ import annotations

from typing import NamedTuple

ABRUPT = "the motion changes too abruptly to be resolved"


class Measured(NamedTuple):
    """Value of a figure, None for the reason in `detail`; `at_deg` is the shaft angle of its place.

    `surface` names the surface of the value where the cam has several; empty where it has one.
    """

    value: float | None
    unit: str
    at_deg: float | None = None
    detail: str = ""
    surface: str = ""
