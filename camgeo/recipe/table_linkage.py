"""The keys of a linkage and of the dyads that are hung on it, kind by kind."""

from __future__ import annotations

from dataclasses import replace

from camgeo.recipe.spec import MOST, Field, Kind, Table, coordinate, length

_ASSEMBLY = Field(
    "assembly",
    Kind.CHOICE,
    "which of the two ways to put the links together; open is Figure 7 of AS 2023",
    default="open",
    choices=("open", "crossed"),
)
_DYADS = Field("dyads", Kind.DYADS, "further links; the last dyad's output is the linkage's", default="none")
_GROUND = length("ground", "distance r1 of the fixed pivot from the shaft, along +x", required=True)
_COUPLER = length("coupler", "length r3 from the middle of the frame's side to the joint", required=True)

LINKAGES: dict[str, Table] = {
    "four-bar": Table(
        (_GROUND, _COUPLER, length("rocker", "length r4 of the rocker", required=True), _ASSEMBLY, _DYADS)
    ),
    "inverted-slider-crank": Table(
        (
            _GROUND,
            Field(
                "rocker",
                Kind.LENGTH,
                "length r4 of the rocker, from its pivot square to the slide; 0 makes an oscillating yoke",
                required=True,
                at_least=0,
                at_most=MOST,
            ),
            _ASSEMBLY,
            _DYADS,
        )
    ),
    "slider-crank": Table(
        (
            _COUPLER,
            coordinate("offset", "distance of the slide's line from the shaft, along +y", required=True),
            _ASSEMBLY,
            _DYADS,
        )
    ),
}

_ON = Field(
    "on",
    Kind.CHOICE,
    "the link that carries the dyad's first joint; previous is the output link of the dyad before",
    default="output",
    choices=("output", "coupler", "previous"),
)
_POINT = Field("point", Kind.POINT, "the first joint [x, y] in the axes of that link", required=True)
_PIVOT = Field("ground", Kind.POINT, "the fixed pivot [x, y] in the fixed axes, the shaft at [0, 0]", required=True)

DYADS: dict[str, Table] = {
    "rrr": Table(
        (
            _ON,
            _POINT,
            _PIVOT,
            Field("links", Kind.PAIR, "lengths of the two links, the one on the fixed pivot last", required=True),
            replace(
                _ASSEMBLY, about="open: seen from the fixed pivot towards the first joint, the second lies to the left"
            ),
        )
    ),
    "rrp": Table(
        (
            _ON,
            _POINT,
            length("link", "length of the link from the first joint to the slide", required=True),
            Field(
                "through", Kind.POINT, "a point [x, y] of the slide's line, from which it is measured", required=True
            ),
            Field("direction", Kind.ANGLE, "direction of the slide's line", required=True, at_least=-360, at_most=360),
            replace(_ASSEMBLY, about="open: of two places on the line the slide takes the one farther along it"),
        )
    ),
    "rpr": Table(
        (
            _ON,
            _POINT,
            _PIVOT,
            coordinate(
                "offset",
                "distance of the slot's line from the fixed pivot, positive where the block lies to its left",
                default="0",
            ),
        )
    ),
}

SLIDING = ("slider-crank", "rrp")  # kinds of linkage and of dyad whose output is a length
