"""The schema of the part round the contour, as data."""

from __future__ import annotations

from camgeo.recipe.spec import Field, Kind, Table, length, mapping

MOST_HOLES = 60


def _angle(name: str, about: str, default: str = "0") -> Field:
    return Field(name, Kind.ANGLE, about, default=default, at_least=-360, at_most=360)


def _count(name: str, about: str, *, least: int = 1, required: bool = False) -> Field:
    return Field(name, Kind.INTEGER, about, required, at_least=least, at_most=MOST_HOLES)


BORE = Table(
    (
        length("square", "width across flats of a square bore"),
        length("hexagon", "width across flats of a hexagonal bore"),
        _angle("at", "direction of one flat's normal"),
    ),
    alternatives=(("square", ()), ("hexagon", ())),
)
STANDARD = "din6885"
KEYWAY = Table(
    (
        Field("standard", Kind.CHOICE, "width and depth by the bore, from DIN 6885-1", choices=(STANDARD,)),
        length("width", "width b of the key"),
        length("depth", "depth t2 into the hub, from the bore's circle to the floor"),
        _angle("at", "direction of the keyway's middle"),
    ),
    alternatives=(("standard", ()), ("width", ("depth",))),
)
_BOLTS = (
    _count("count", "number of holes", required=True),
    length("circle", "diameter of the circle about the shaft that their centres lie on", required=True),
    length("hole", "diameter of each hole", required=True),
    _angle("start", "direction of the first hole"),
)
_DOWEL = (
    length("circle", "diameter of the circle about the shaft that its centre lies on", required=True),
    length("hole", "diameter of the hole", required=True),
    _angle("at", "direction of the hole"),
)
_HUB = (
    length("diameter", "diameter of the hub", required=True),
    length("height", "height beyond the face of the disc", required=True),
    Field(
        "side",
        Kind.CHOICE,
        "which side of the disc: top is the side that the drawing shows",
        default="top",
        choices=("top", "bottom", "both"),
    ),
)
_SCREW = (
    length("diameter", "diameter of the radial hole from the hub's outside into the bore", required=True),
    _angle("at", "direction of the hole"),
    length("height", "height of its axis above the face of the disc", default="half the hub"),
)
_LIGHTENING = Field(
    "lightening",
    Kind.TABLE,
    "round holes placed where there is room",
    default="none",
    table=Table(
        (
            _count("ring", "that many equal holes at equal angles about the shaft", least=2),
            _count("largest", "up to that many holes, each the largest that still fits"),
            length("wall", "wall left to every edge", required=True),
            length("least", "least diameter of a hole", default="twice the wall"),
            _angle("start", "direction of the first hole of a ring"),
        ),
        alternatives=(("ring", ()), ("largest", ())),
    ),
)
_MARK = (
    Field(
        "as",
        Kind.CHOICE,
        "engraved into the upper face, or cut through",
        default="engrave",
        choices=("engrave", "cut"),
    ),
    length("width", "width of the slot", default="0.5 mm"),
    length("length", "length of the slot along the ray", default="4 mm"),
    length("depth", "depth of an engraved slot", default="0.3 mm"),
    length("radius", "distance of the slot's outer end from the shaft", default="as far out as the wall lets it"),
)


def _optional(name: str, about: str, *fields: Field) -> Field:
    return Field(name, Kind.TABLE, about, default="none", table=Table(fields))


PART = mapping(
    "part",
    "the part round the contour",
    length("thickness", "thickness of the disc along the shaft; solids need it"),
    Field("bore", Kind.BORE, "diameter of the bore around the shaft, or its form", default="none", table=BORE),
    Field("keyway", Kind.KEYWAY, "keyway in a round bore", default="none", table=KEYWAY),
    _optional(
        "flat",
        "flat of a D-shaped bore",
        length("across", "width from the flat to the opposite side of the bore", required=True),
        _angle("at", "direction of the flat's normal"),
    ),
    _optional("hub", "hub about the shaft", *_HUB),
    _optional("set_screw", "hole for a set screw, through the hub", *_SCREW),
    _optional("bolts", "bolt circle", *_BOLTS),
    _optional("dowel", "dowel hole", *_DOWEL),
    _LIGHTENING,
    length("chamfer", "chamfer of 45 degrees along both edges of the contour, its height", default="none"),
    _optional("mark", "timing mark on the ray where the shaft angle is 0", *_MARK),
    length("wall", "least wall between any two edges", default="told, and above 0"),
    later=("follower",),
)
