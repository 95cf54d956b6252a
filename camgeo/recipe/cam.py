"""The cam of a recipe, kind by kind: its keys, what they are checked for, what they become."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

from camgeo.recipe.motion import MotionSegment, build_motion, check_filled, motion_field
from camgeo.recipe.schema.fields import Field, Form, Kind, Table, length, mapping
from camgeo.recipe.schema.json_schema import one_of_schema

if TYPE_CHECKING:
    from camgeo.recipe.schema.reader import Reader, Values
    from camgeo.recipe.schema.yaml_source import Node


Undercut: TypeAlias = Literal["refuse", "trim"]
Harmonics: TypeAlias = tuple[tuple[int, float], ...]  # (harmonic, coefficient), rising


@dataclass(frozen=True)
class FormulaShape:
    """A support function p(t), t in radians, as text; `scale` times its value is in mm."""

    text: str
    scale: float


@dataclass(frozen=True)
class FourierShape:
    """A support function mean + sum of cos[j] cos(j t) + sin[j] sin(j t), in mm."""

    mean: float
    cos: Harmonics
    sin: Harmonics


@dataclass(frozen=True)
class ReuleauxShape:
    """A regular Reuleaux polygon with an odd number of sides and rounded corners, in mm."""

    sides: int
    breadth: float
    rounding: float


@dataclass(frozen=True)
class HypocycloidShape:
    """The parallel curve of an odd hypocycloid, p = breadth/2 + size cos(cusps t), in mm."""

    cusps: int
    size: float
    breadth: float


Shape: TypeAlias = FormulaShape | FourierShape | ReuleauxShape | HypocycloidShape


@dataclass(frozen=True)
class SupportCam:
    """A cam given by its support function; `shaft` is the camshaft's place in the axes of that function, mm."""

    shape: Shape
    shaft: tuple[float, float]
    undercut: Undercut


@dataclass(frozen=True)
class ConstantBreadthCam:
    """A cam between two parallel faces, from the motion over one half turn (Shu and Wu)."""

    base_radius: float
    motion: tuple[MotionSegment, ...]
    undercut: Undercut


@dataclass(frozen=True)
class DeltaRoute:
    """D(t) = sum over odd j of cos[j] cos(j lambda t) + sin[j] sin(j lambda t), in mm^2 (Wunderlich 6.5)."""

    cos: Harmonics
    sin: Harmonics


@dataclass(frozen=True)
class LawRoute:
    """The follower's swing over delta = pi/lambda of shaft angle; of a flat pair the swing is psi/2."""

    motion: tuple[MotionSegment, ...]


@dataclass(frozen=True)
class ArcRoute:
    """A circular first arc of the pitch curve, radius in mm, symmetric about its bisector."""

    radius: float
    side: Literal["convex", "concave"]


@dataclass(frozen=True)
class RosetteRoute:
    """One leaf of the path of the third arm's tip: |OQ| as text in x, 0 to 1; `scale` times its value is in mm."""

    text: str
    scale: float


Route: TypeAlias = DeltaRoute | LawRoute | ArcRoute | RosetteRoute


@dataclass(frozen=True)
class DoubleRollerCam:
    """A single disk that works two rollers on one arm (Wunderlich); pi/alpha = lam/mu in lowest terms, mu odd."""

    lam: int
    mu: int
    arm: float
    roller_radius: float
    route: Route
    undercut: Undercut


@dataclass(frozen=True)
class FlatPairCam:
    """A single disk that works a rigid pair of flat faces, its pivot at 2 arm from the shaft (Wunderlich, 5)."""

    lam: int
    mu: int
    arm: float
    route: Route
    undercut: Undercut


Cam: TypeAlias = SupportCam | ConstantBreadthCam | DoubleRollerCam | FlatPairCam


CAM_KINDS: dict[type[Cam], str] = {
    SupportCam: "support",
    ConstantBreadthCam: "constant-breadth",
    DoubleRollerCam: "double-roller",
    FlatPairCam: "flat-pair",
}


def cam_kind(cam: Cam) -> str:
    """Name the kind of a cam as recipes do."""
    return CAM_KINDS[type(cam)]


def _odd(name: str, about: str) -> Field:
    return Field(name, Kind.INTEGER, about, required=True, at_least=3, at_most=99, odd=True)


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
        Field(
            "shaft",
            Kind.POINT,
            "place [x, y] of the shaft in the axes in which p is written",
            default="[0, 0]",
            formerly="pivot",
        ),
        _UNDERCUT,
    ),
    alternatives=(("p", ()), ("fourier", ()), ("reuleaux", ()), ("hypocycloid", ())),
)


CONSTANT_BREADTH = Table(
    (
        length("base_radius", "radius of the base circle", required=True),
        replace(
            motion_field(
                "motion", Kind.LENGTH, "motion over one half turn, 180 degrees; the other half follows from it"
            ),
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
    routes = (_DELTA, motion_field("law", Kind.ANGLE, law), _ARC, _ROSETTE)
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
    "cams are made for a flat face (support), for a yoke of two parallel faces (constant-breadth, support), for two "
    "rollers on one oscillating arm (double-roller) and for two faces on one (flat-pair); cams for a single roller, a "
    "knife edge or a curved shoe, cylindrical cams and grooves are not made"
)
"""Which followers there are cams for, in the error of a kind that is none."""


SWINGING = ("double-roller", "flat-pair")  # their motion errors are angles


def read_cam(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the cam by the table of its kind."""
    return reader.one_of(field, node, path)


CAM = Form(
    "a cam",
    "a mapping with the kind of cam and its fields",
    read_cam,
    lambda _: one_of_schema("cam", CAMS),
    tables=CAMS,
    group="cam of kind",
    others=MADE,
)


_OTHER_HALF = "two parallel faces hold the cam, so the other half turn's motion follows: S(t + 180) = S(180) - S(t)"


_OTHER_PARTS = "both sides of the follower touch the cam at once, so the motion after that follows"


def check_cam(cam: Values, reader: Reader) -> None:
    """Note the faults between the fields of a cam."""
    _corners(cam.get("reuleaux", {}), reader)
    _harmonics(cam, reader)
    if "motion" in cam:
        check_filled(cam["motion"], "cam.motion", math.pi, "one half turn, 180 degrees", reader, why=_OTHER_HALF)
    if "law" in cam and "ratio" in cam:
        lam, _ = cam["ratio"]
        check_filled(cam["law"], "cam.law", math.pi / lam, f"180/{lam} degrees", reader, why=_OTHER_PARTS)


def _corners(reuleaux: Values, reader: Reader) -> None:
    if {"breadth", "rounding"} <= reuleaux.keys() and reuleaux["rounding"] >= reuleaux["breadth"] / 2:
        remedy = f"give less than {reuleaux['breadth'] / 2 / reader.mm:g} {reader.units}"
        value = f"{reuleaux['rounding'] / reader.mm:g}"
        reader.fault_at("cam.reuleaux.rounding", "not below half the breadth", value, remedy)


def _harmonics(cam: Values, reader: Reader) -> None:
    delta = cam.get("delta")
    faulty = any(error.path.startswith("cam.delta") for error in reader.errors)
    if delta is not None and not faulty and not (delta.get("cos") or delta.get("sin")):
        reader.fault_at("cam.delta", "no harmonics, so no motion", None, "give some, such as {cos: {1: 625}}")


def build_cam(cam: Values, mm: float) -> Cam:
    """Make the cam of values in which there is no fault."""
    undercut = cam.get("undercut", "refuse")
    match cam["kind"]:
        case "support":
            return SupportCam(_shape(cam, mm), cam.get("shaft", (0.0, 0.0)), undercut)
        case "constant-breadth":
            return ConstantBreadthCam(cam["base_radius"], build_motion(cam["motion"], mm), undercut)
        case "double-roller":
            lam, mu = cam["ratio"]
            return DoubleRollerCam(lam, mu, cam["arm"], cam["roller_radius"], _route(cam, mm), undercut)
        case _:
            lam, mu = cam["ratio"]
            return FlatPairCam(lam, mu, cam["arm"], _route(cam, mm), undercut)


def _shape(cam: Values, mm: float) -> Shape:
    if "fourier" in cam:
        return FourierShape(**{"cos": (), "sin": (), **cam["fourier"]})
    if "reuleaux" in cam:
        return ReuleauxShape(**cam["reuleaux"])
    if "hypocycloid" in cam:
        return HypocycloidShape(**cam["hypocycloid"])
    return FormulaShape(cam["p"], mm)


def _route(cam: Values, mm: float) -> Route:
    if "delta" in cam:
        return DeltaRoute(**{"cos": (), "sin": (), **cam["delta"]})
    if "law" in cam:
        return LawRoute(build_motion(cam["law"], math.pi / 180))
    if "arc" in cam:
        return ArcRoute(**{"side": "convex", **cam["arc"]})
    return RosetteRoute(cam["rosette"]["leaf"], mm)
