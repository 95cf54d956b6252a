"""Files of points in `camgeo verify`: which they are, their options, their judging."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.made.options import claims
from camgeo.output.extension import CallOption, Output

if TYPE_CHECKING:
    from camgeo.common.clock import Clock
    from camgeo.measures.extension import Results
    from camgeo.output.extension import FileCall
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

_OPTIONS = {
    "as": CallOption("what a table of numbers is: by its heading if not given", choices=("measured", "grinding")),
    "align": CallOption(
        "place the points by least squares before the motion is judged too; height is of drums (default: none)",
        choices=("none", "rotation", "height", "rotation-height", "best-fit"),
    ),
    "probe_radius": CallOption("points are centres of a ball of this radius; of a lift, that of its roller", "R"),
    "probe_face": CallOption("of a lift, the indicator has a flat face of this width on the stem's line", "W"),
    "probe_error": CallOption("expanded uncertainty (k = 2) of a point along its normal", "U"),
    "axes_error": CallOption("that of the part's axes: a length and an angle in degrees, 0.005,0.02", "L,DEG"),
    "spans": CallOption("spans of the smoothed deviation (default: by cross-validation)", "N"),
    "out": CallOption("write a page, a drawing and a table of measured points into this folder", "DIR"),
}


def _judge(recipe: Recipe, design: Design, call: FileCall, clock: Clock) -> Results:
    from camgeo.capabilities.made.verify import judge

    return judge(recipe, design, call, clock)


ANSWERS = Output(claims=claims, options=_OPTIONS, judge=_judge)
