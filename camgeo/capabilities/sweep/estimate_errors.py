"""What estimates of the screen were off by: the greatest error on 1,000 random designs (`benchmarks/sweep.py screen`).

The designs are of every follower on a stem and on an arm, in a disc and in a ring, of constant breadth and by a support
function, with each law of the catalogue, at 360 angles.
"""

from camgeo.recipe.figures import (
    CONTACT_TRAVEL,
    FACE_WIDTH,
    HOLLOW_RADIUS,
    ON_RETURN,
    ON_RISE,
    PEAKS,
    PITCH_RADIUS,
    PIVOT_CLEARANCE,
    PRESSURE_ANGLE,
    RADIUS,
    ROLLER_SPEED,
    SIZE,
)

DESIGNS = 1000

DEGREES = frozenset({PRESSURE_ANGLE, ON_RISE, ON_RETURN})
"""Figures whose errors are told in degrees; those of others are shares of the value."""

_PEAKS = (1.3e-5, 5.5e-5, 6.3e-6)

ERRORS: dict[str, float] = {
    "swing": 8.3e-6,
    **dict(zip(PEAKS, _PEAKS, strict=True)),
    PRESSURE_ANGLE: 3.7e-4,
    ON_RISE: 3.7e-4,
    ON_RETURN: 3.7e-4,
    ROLLER_SPEED: 2.5e-6,
    RADIUS: 3.2e-4,
    HOLLOW_RADIUS: 1.2e-3,
    PITCH_RADIUS: 3.2e-4,
    SIZE: 1.6e-6,
    CONTACT_TRAVEL: 1.0e-5,
    FACE_WIDTH: 4.2e-6,
    PIVOT_CLEARANCE: 3.1e-5,
}
"""By figure; sizes of the recipe, such as the base radius, are exact."""
