"""The keys of how a part is milled."""

from __future__ import annotations

from camgeo.recipe.spec import Field, Kind, Table, length

MOST_RPM = 1_000_000

MANUFACTURE = Table(
    (
        length("cutter", "diameter of the cutter that mills the contour", required=True),
        length("feed", "feed along the contour, a minute; needed by gcode"),
        length("plunge", "feed downwards, a minute; needed by gcode"),
        Field(
            "spindle",
            Kind.NUMBER,
            "speed of the spindle, turns a minute; needed by gcode",
            above=0,
            at_most=MOST_RPM,
        ),
        length("depth_of_cut", "greatest depth of one pass; needed by gcode"),
        length("safe_height", "height above the stock at which the cutter moves fast; needed by gcode"),
        length("lead_in", "radius of the arcs on which the cutter comes and leaves", default="half the cutter"),
        Field(
            "direction",
            Kind.CHOICE,
            "side on which a right-handed cutter that turns clockwise meets the metal",
            default="climb",
            choices=("climb", "conventional"),
        ),
        length("allowance", "metal that a last pass at full depth takes off all round", default="no such pass"),
        Field(
            "start",
            Kind.ANGLE,
            "direction in which the cutter is farthest out where it comes to the contour",
            default="0",
            at_least=-360,
            at_most=360,
        ),
        Field("holes", Kind.TRUTH, "whether round openings larger than the cutter are milled too", default="false"),
        length("unreached", "greatest depth of metal that may be left where the cutter does not reach", default="none"),
        Field("layer", Kind.TRUTH, "whether a DXF shows the path of the cutter's centre, on TOOLPATH", default="false"),
    ),
)
NEEDED = ("feed", "plunge", "spindle", "depth_of_cut", "safe_height")
"""Keys that a program for a machine cannot do without."""

SLOWEST, SHORTEST = 0.001, 1e-6
LEAST_TOLD = dict.fromkeys(("feed", "plunge", "spindle"), SLOWEST)
LEAST_TOLD |= dict.fromkeys(("cutter", "depth_of_cut", "safe_height", "lead_in", "allowance"), SHORTEST)
"""Least figures of a program, in the recipe's unit: bounds against slips, far below what any machine keeps to."""

COMPENSATION = (
    length("kerf", "width of the cut: the metal is drawn larger by half of it, openings smaller", default="0"),
    length("clearance", "what the metal stands back all round; openings become larger", default="0"),
    Field(
        "shrinkage",
        Kind.NUMBER,
        "percent by which the part shrinks: it is drawn larger by 1/(1 - s/100)",
        default="0",
        above=0,
        at_most=20,
    ),
)
"""By what the part of a file is made different from the nominal one."""
