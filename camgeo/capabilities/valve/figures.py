"""Figures of a valve: lift, duration, velocity, acceleration, and how fast it leaves and meets its seat."""

from __future__ import annotations

from camgeo.recipe.figures import Figure, Need, lift_key
from camgeo.schema.fields import Kind

LIFT, DURATION, SEATING = "valve-lift", "valve-duration", "valve-seating"
VELOCITY, ACCELERATION = "valve-velocity", "valve-acceleration"
OF_VALVE = Need("valve", lambda _, paths: "valve" in paths)
AT, SEAT = 1.0, 0.0  # mm of valve lift at which durations are told, and of the seat

FIGURES: dict[str, Figure] = {
    LIFT: Figure("greatest lift of the valve", Kind.LENGTH, "most", OF_VALVE, dear=True),
    DURATION: Figure(
        "crank degrees for which the valve is above a lift of 1 mm",
        Kind.ANGLE,
        "most",
        OF_VALVE,
        dear=True,
        at_lift=AT,
        keys=lift_key(AT),
    ),
    VELOCITY: Figure(
        "greatest velocity of the open valve, per radian of the cam",
        Kind.LENGTH,
        "least",
        OF_VALVE,
        "/rad",
        dear=True,
    ),
    ACCELERATION: Figure(
        "greatest acceleration of the open valve, per radian squared",
        Kind.LENGTH,
        "least",
        OF_VALVE,
        "/rad^2",
        dear=True,
    ),
    SEATING: Figure(
        "velocity with which the valve leaves or meets its seat, the greater, a cam degree",
        Kind.LENGTH,
        "least",
        OF_VALVE,
        "/deg",
        dear=True,
        at_lift=SEAT,
        keys=lift_key(SEAT),
    ),
}
