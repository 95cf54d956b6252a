"""The keys of a sweep and of a dwell, and the figures of a design that a sweep knows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from camgeo.recipe.spec import MOST, MOST_DESIGNS, MOST_STEPS, Field, Kind, Table


@dataclass(frozen=True)
class Figure:
    """One figure of a design.

    `kind` is that of its values: degrees for an angle, the recipe's unit for a length, and for an output either, as
    the last link of the linkage swings or slides. `best` says which values a ranking puts first, `needs` which section
    of a recipe the figure is taken from, besides the cam.
    """

    about: str
    kind: Kind
    best: Literal["most", "least"]
    needs: Literal["", "linkage", "dwell"] = "linkage"


FIGURES: dict[str, Figure] = {
    "dwell": Figure("longest dwell over the shaft angle, at the band of `dwell`", Kind.ANGLE, "most", "dwell"),
    "dwell-relative": Figure("longest dwell over the relative angle, at that band", Kind.ANGLE, "most", "dwell"),
    "swing": Figure("swing or stroke of the output", Kind.OUTPUT, "most"),
    "peak-velocity": Figure("greatest velocity of the output, per radian of shaft angle", Kind.OUTPUT, "least"),
    "peak-acceleration": Figure("greatest acceleration of the output, per radian squared", Kind.OUTPUT, "least"),
    "transmission-angle": Figure("least transmission angle", Kind.ANGLE, "most"),
    "force-angle": Figure("least angle between the force at the joint and the rocker", Kind.ANGLE, "most"),
    "margin": Figure("least distance from binding", Kind.LENGTH, "most"),
    "shaft-rate": Figure("least turn of the shaft per turn of the cam against the frame", Kind.NUMBER, "most"),
    "radius-of-curvature": Figure("least radius of curvature of the contour", Kind.LENGTH, "most", ""),
    "size": Figure("greatest distance of the contour from the shaft", Kind.LENGTH, "least", ""),
}


def bounds(figure: Figure) -> Table:
    """Give the table of the limits of a figure."""
    return Table(
        tuple(
            Field(name, Kind.NUMBER, about, at_least=-(MOST**2), at_most=MOST**2, unit=figure.kind)
            for name, about in (("at_least", "least value that will do"), ("at_most", "greatest value that will do"))
        )
    )


RANGE = Table(
    (
        Field("from", Kind.NUMBER, "first value, as the recipe writes it", required=True),
        Field("to", Kind.NUMBER, "last value", required=True),
        Field(
            "steps", Kind.INTEGER, "number of values, both ends included; for a grid", at_least=2, at_most=MOST_STEPS
        ),
    )
)

DWELL = (
    Field(
        "band",
        Kind.OUTPUT,
        "greatest less least output within a dwell, in degrees, or a length where it slides",
        required=True,
        above=0,
        at_most=MOST,
    ),
    Field("at_least", Kind.ANGLE, "a check: least length of the longest dwell", default="none", above=0, at_most=360),
    Field(
        "over",
        Kind.CHOICE,
        "the angle that the check takes: the shaft's, or the cam's against the frame",
        default="shaft",
        choices=("shaft", "relative"),
    ),
)

SWEEP = (
    Field("vary", Kind.VARY, "numbers of cam and linkage by their paths, each with its range or values", required=True),
    Field("method", Kind.CHOICE, "how the designs are chosen", default="grid", choices=("grid", "random", "sobol")),
    Field("count", Kind.INTEGER, "number of designs; not for a grid", at_least=1, at_most=MOST_DESIGNS),
    Field("seed", Kind.INTEGER, "seed of random and sobol", default="0", at_least=0, at_most=2**32 - 1),
    Field("limits", Kind.LIMITS, "figures that a design must keep within bounds", default="none"),
    Field("rank", Kind.CHOICE, "the figure to be best in", required=True, choices=tuple(FIGURES)),
    Field("keep", Kind.INTEGER, "number of best designs that become recipes", default="10", at_least=1, at_most=1000),
    Field(
        "angles",
        Kind.INTEGER,
        "number of angles at which a design is sampled",
        default="360",
        at_least=24,
        at_most=36_000,
    ),
    Field("refine", Kind.TRUTH, "whether the best designs are polished, off the grid", default="false"),
)
