"""Figures of a valve: lift, duration, velocity, acceleration, and how fast it leaves and meets its seat."""

from __future__ import annotations

from functools import partial

from camgeo.recipe.design_figure import DesignFigure, Need
from camgeo.recipe.figures import lift_key
from camgeo.schema.fields import Kind

LIFT, DURATION, SEATING = "valve-lift", "valve-duration", "valve-seating"
VELOCITY, ACCELERATION = "valve-velocity", "valve-acceleration"
OF_VALVE = Need("valve", lambda _, paths: "valve" in paths)
AT, SEAT = 1.0, 0.0  # mm of valve lift at which durations are given, and at which the valve is on its seat

_of_valve = partial(DesignFigure, needs=OF_VALVE, dear=True)

FIGURES: dict[str, DesignFigure] = {
    LIFT: _of_valve("greatest lift of the valve", Kind.LENGTH, "most"),
    DURATION: _of_valve(
        "crank degrees for which the valve is above a lift of 1 mm",
        Kind.ANGLE,
        "most",
        at_lift=AT,
        keys=lift_key(AT),
    ),
    VELOCITY: _of_valve("greatest velocity of the open valve, per radian of the cam", Kind.LENGTH, "least", per="/rad"),
    ACCELERATION: _of_valve(
        "greatest acceleration of the open valve, per radian squared", Kind.LENGTH, "least", per="/rad^2"
    ),
    SEATING: _of_valve(
        "velocity with which the valve leaves or meets its seat, the greater, a cam degree",
        Kind.LENGTH,
        "least",
        per="/deg",
        at_lift=SEAT,
        keys=lift_key(SEAT),
    ),
}
