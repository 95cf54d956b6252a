"""The keys of a sweep and of a dwell."""

from __future__ import annotations

from camgeo.recipe.spec import MOST, MOST_DESIGNS, MOST_STEPS, Field, Kind, Table
from camgeo.recipe.table_figures import FIGURES as EVERY

FIGURES = {name: figure for name, figure in EVERY.items() if figure.swept}
"""The figures that a sweep knows."""

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
    Field(
        "limits",
        Kind.LIMITS,
        "figures that a design must keep within bounds",
        default="none",
        choices=tuple(FIGURES),
    ),
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
