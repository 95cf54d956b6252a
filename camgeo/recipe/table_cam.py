"""The keys of a cam, kind by kind."""

from __future__ import annotations

from dataclasses import replace

from camgeo.recipe.spec import MOST, Field, Kind, Table, length, mapping


def _odd(name: str, about: str) -> Field:
    return Field(name, Kind.INTEGER, about, required=True, at_least=3, at_most=99, odd=True)


_LAW = Table(
    (
        Field("polynomial", Kind.NUMBERS, "coefficients c0, c1, ... of u, from 0 to 1 as u does"),
        mapping(
            "scca",
            "sine, constant and cosine acceleration by their shares, and constant velocity",
            Field("sine", Kind.NUMBER, "share of sine in the accelerating half", default="0", at_least=0, at_most=1),
            Field("constant", Kind.NUMBER, "share of constant acceleration", default="0", at_least=0, at_most=1),
            Field(
                "velocity", Kind.NUMBER, "share of the segment at constant velocity", default="0", at_least=0, at_most=1
            ),
        ),
    ),
    alternatives=(("polynomial", ()), ("scca", ())),
)


def _motion(name: str, stroke: Kind, about: str) -> Field:
    """Make the field of a motion programme whose strokes are lengths or angles."""
    most = MOST if stroke is Kind.LENGTH else 180
    strokes = [Field(key, stroke, f"stroke of the {key}", above=0, at_most=most) for key in ("rise", "return")]
    angle = Field("over", Kind.ANGLE, "shaft angle of the segment", above=0, at_most=180)
    segment = Table(
        (
            *strokes,
            Field("to", stroke, "displacement at the end of the segment", at_least=-most, at_most=most),
            Field("rise_fall", stroke, "height of a rise and fall by 64 u³ (1 - u)³", above=0, at_most=most),
            Field(
                "displacement",
                Kind.FORMULA,
                "displacement from the segment's start, u from 0 to 1 over the segment",
                variable="u",
                unit=stroke,
            ),
            replace(angle, name="dwell", about="shaft angle of a rest"),
            angle,
            Field("law", Kind.LAW, "motion law by name, match, {polynomial: [c0, c1, ...]} or {scca: ...}", table=_LAW),
            Field(
                "split",
                Kind.NUMBER,
                "share of the segment that accelerates",
                default="0.5",
                at_least=0.01,
                at_most=0.99,
            ),
            mapping(
                "at_end",
                "state at the end of a segment with law match",
                Field("v", stroke, "velocity there, per radian", default="0", at_least=-MOST, at_most=MOST),
                Field("a", stroke, "acceleration there, per radian²", default="0", at_least=-MOST, at_most=MOST),
            ),
        ),
        alternatives=(
            *((key, ("over", "law")) for key in ("rise", "return", "to")),
            ("rise_fall", ("over",)),
            ("displacement", ("over",)),
            ("dwell", ()),
        ),
        later=("table",),
    )
    return Field(name, Kind.SEGMENTS, about, table=segment)


_UNDERCUT = Field(
    "undercut",
    Kind.CHOICE,
    "what to do about undercut (trim reports the motion that is lost)",
    default="refuse",
    choices=("refuse", "trim"),
)

_FOURIER = mapping(
    "fourier",
    "support function as a Fourier series",
    length("mean", "mean of the support function", required=True),
    Field("cos", Kind.HARMONICS, "coefficients of cos(k t)", default="none", unit=Kind.LENGTH),
    Field("sin", Kind.HARMONICS, "coefficients of sin(k t)", default="none", unit=Kind.LENGTH),
)
_REULEAUX = mapping(
    "reuleaux",
    "a regular Reuleaux polygon with rounded corners",
    _odd("sides", "number of sides"),
    length("breadth", "constant breadth", required=True),
    length("rounding", "radius of the corners, below half the breadth", required=True),
)
_HYPOCYCLOID = mapping(
    "hypocycloid",
    "the parallel curve of a hypocycloid, p = breadth/2 + size*cos(cusps*t)",
    _odd("cusps", "number of cusps"),
    length("size", "radius of the circle inscribed in the hypocycloid", required=True),
    length("breadth", "constant breadth", required=True),
)

SUPPORT = Table(
    (
        Field("p", Kind.FORMULA, "support function p(t), t in radians, its value a length"),
        _FOURIER,
        _REULEAUX,
        _HYPOCYCLOID,
        Field("pivot", Kind.POINT, "the shaft [x, y] in the axes in which p is written", default="[0, 0]"),
        _UNDERCUT,
    ),
    alternatives=(("p", ()), ("fourier", ()), ("reuleaux", ()), ("hypocycloid", ())),
)

CONSTANT_BREADTH = Table(
    (
        length("base_radius", "radius of the base circle", required=True),
        replace(
            _motion("motion", Kind.LENGTH, "motion over one half turn, 180 degrees; the other half follows from it"),
            required=True,
        ),
        _UNDERCUT,
    ),
)

_DELTA = mapping(
    "delta",
    "D(t), the sum of cos[j]*cos(j*lambda*t) + sin[j]*sin(j*lambda*t), j odd",
    Field("cos", Kind.HARMONICS, "coefficients of the cosines", default="none", unit=Kind.AREA, odd=True),
    Field("sin", Kind.HARMONICS, "coefficients of the sines", default="none", unit=Kind.AREA, odd=True),
)
_ARC = mapping(
    "arc",
    "first arc of the pitch curve, symmetric about its bisector",
    length("radius", "radius of the arc", required=True),
    Field("side", Kind.CHOICE, "how the arc bulges", default="convex", choices=("convex", "concave")),
)
_ROSETTE = mapping(
    "rosette",
    "one leaf of the path of the third arm's tip",
    Field(
        "leaf",
        Kind.FORMULA,
        "distance of the tip from the shaft, x from 0 to 1 over the leaf, its value a length",
        required=True,
        variable="x",
    ),
)


def _swinging(law: str, roller: tuple[Field, ...]) -> Table:
    """Make the table of a double roller or a flat pair, which differ in the roller and in what swings."""
    routes = (_DELTA, _motion("law", Kind.ANGLE, law), _ARC, _ROSETTE)
    return Table(
        (
            Field("ratio", Kind.RATIO, "pi/alpha = lambda/mu in lowest terms, mu odd", required=True),
            length("arm", "arm length, the distance l of the closing equation", required=True),
            *roller,
            *routes,
            _UNDERCUT,
        ),
        alternatives=tuple((route.name, ()) for route in routes),
    )


DOUBLE_ROLLER = _swinging(
    "swing psi of the follower, over 180/lambda degrees of shaft angle from psi = 0",
    (length("roller_radius", "radius of both rollers", required=True),),
)
FLAT_PAIR = _swinging("swing of the pair, psi/2, over 180/lambda degrees of shaft angle from 0", ())

CAMS: dict[str, Table] = {
    "support": SUPPORT,
    "constant-breadth": CONSTANT_BREADTH,
    "double-roller": DOUBLE_ROLLER,
    "flat-pair": FLAT_PAIR,
}
MADE = (
    "made are cams for a flat face (support), for a yoke of two parallel faces (constant-breadth, support), for two "
    "rollers on one oscillating arm (double-roller) and for two faces on one (flat-pair); cams for a single roller, a "
    "knife edge or a curved shoe, cylindrical cams and grooves are not made"
)
"""Which followers there are cams for, in the error of a kind that is none."""
SWINGING = ("double-roller", "flat-pair")  # their motion errors are angles
