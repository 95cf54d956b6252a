"""What was measured of a figure."""

from __future__ import annotations

from typing import NamedTuple

ABRUPT = "the motion changes too abruptly to be resolved"


class Measured(NamedTuple):
    """A figure, None where there is none, which `detail` then explains; `at_deg` is the shaft angle of its place.

    `surface` is the name of the one that it is of, the worst of several; empty where the cam has one.
    """

    value: float | None
    unit: str
    at_deg: float | None = None
    detail: str = ""
    surface: str = ""
