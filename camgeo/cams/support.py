"""Cams by their support function: a formula, a Fourier series, a Reuleaux polygon or a hypocycloid (AS 2023)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, TypeAlias

import numpy as np

from camgeo.cams.family import UNDERCUT, Cam, Circle, Family, Harmonics, Linear, Preload, Undercut
from camgeo.cams.flat_faced import FlatFacedCam, SizeAdvice
from camgeo.cams.preload import PRELOAD, build_preload
from camgeo.cams.surface import Surface
from camgeo.common.rounding import NOISE, upward
from camgeo.motions.by_motion import ByMotion
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, length, mapping
from kin.law.contacts import Arrangement, Flat, Translating
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from camgeo.schema.reader import Reader, Values
    from kin.law.support_function import Lift

FREE = 3  # angles of a Reuleaux polygon that follow from the others
LOOKS = 72  # angles at which the size of p is sampled
CLOSE_LOOKS = 14_400  # angles at which radii of curvature are sampled, to find by how much p must grow
SPARE = 1e-3  # of the range of these radii: between two samples a radius may be less
LEAST_PART = 1e-9  # of the farthest point's distance from the shaft: a smaller mean radius is lost in rounding
LEAST_ANGLE = 0.1  # degrees: on a cam of 50 mm an arc of 0.09 mm
ROUNDING = 1e-15  # of the farthest point's distance from the shaft: a mean radius below it is 0
LEAST_PIECE = 1e-9  # mm: shortest chord of an arc in a drawing; STEP, whose kernel needs more, refuses for itself


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
    """A Reuleaux polygon with an odd number of sides, mm; its corners sharp at rounding 0.

    `angles`, rad, are the turns of the cam about its first corners, sides - 3 in number; without them the polygon is
    regular.
    """

    sides: int
    breadth: float
    rounding: float = 0.0
    angles: tuple[float, ...] = ()


@dataclass(frozen=True)
class HypocycloidShape:
    """The parallel curve of an odd hypocycloid, p = breadth/2 + size cos(cusps t), in mm."""

    cusps: int
    size: float
    breadth: float


Shape: TypeAlias = FormulaShape | FourierShape | ReuleauxShape | HypocycloidShape


@dataclass(frozen=True)
class SupportCam(FlatFacedCam):
    """A cam given by its support function; `shaft` is the camshaft's place in the axes of that function, mm."""

    kind: ClassVar[str] = "support"
    shape: Shape
    shaft: tuple[float, float]
    undercut: Undercut
    preload: Preload | None = None

    def lift(self) -> Lift:
        """The support function about the shaft, mm (AS 2023).

        Raises IntentError for a function that no cam has, and for a mean radius that is not above 0 by more than
        rounding.
        """
        from kin.law import support_function

        shape = self.shape
        if isinstance(shape, FormulaShape):
            return _with_size(_formula(shape, self.shaft), "p", shape.scale)
        if isinstance(shape, FourierShape):
            lift = support_function.lift_from_fourier(shape.mean, dict(shape.cos), dict(shape.sin), self.shaft)
            return _with_size(lift, "fourier.mean")
        if isinstance(shape, ReuleauxShape):
            parameters = shape.sides, shape.breadth, shape.rounding, self.shaft, shape.angles
            lift = support_function.lift_reuleaux(*parameters)
            return _with_size(lift, "reuleaux.breadth")
        lift = support_function.lift_hypocycloid(shape.cusps, shape.size, shape.breadth, self.shaft)
        return _with_size(lift, "hypocycloid.breadth")

    def surface(self, whole: Curve) -> Surface:
        """Surface of the disc for a whole curve; sharp corners of a Reuleaux polygon are corners of the contour."""
        if not isinstance(self.shape, ReuleauxShape):
            return super().surface(whole)
        from camgeo.curve.support import with_corners

        return Surface(whole, with_corners(whole))

    @property
    def advice(self) -> SizeAdvice:
        """Advice: a larger mean radius, by the key that sets it, without words for a stroke."""
        if isinstance(self.shape, ReuleauxShape):
            return ReuleauxAdvice(shape=self.shape, gain=1.0, less_steep="", size="reuleaux.rounding")
        if isinstance(self.shape, HypocycloidShape):
            return SizeAdvice(gain=1.0, less_steep="", size="hypocycloid.breadth", share=2.0)
        return SizeAdvice(gain=1.0, less_steep="", size="fourier.mean" if isinstance(self.shape, FourierShape) else "p")

    @property
    def linear(self) -> LinearSupport:
        """The cam as a linear function of its harmonics and its shaft's place."""
        return LinearSupport(self)

    def grow(self, out: float, scale: float) -> SupportCam:  # noqa: ARG002 - the protocol's
        """The cam itself, as drawings show none of its own lengths."""
        return self

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, at the curve's least distance from the shaft."""
        return (Circle("base circle"),)


@dataclass(frozen=True)
class ReuleauxAdvice(SizeAdvice):
    """Advice for a Reuleaux polygon: a larger rounding of its corners, below half its breadth."""

    shape: ReuleauxShape = field(kw_only=True)

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a larger rounding of the corners, and a larger breadth where that would reach half the breadth."""
        sentence = super().free_of_undercut(free_at, mm)
        if self.shape.rounding + free_at < 0.5 * self.shape.breadth:
            return sentence
        breadth = 2.0 * (self.shape.rounding + free_at) / mm
        return sentence.replace(" would", f" and a reuleaux.breadth of more than {upward(breadth)} would")


@dataclass(frozen=True)
class LinearSupport(Linear):
    """A cam by its support function as a linear function of harmonics."""

    cam: SupportCam

    @property
    def shaft(self) -> tuple[float, float]:
        """Place of the shaft in the axes of p, mm."""
        return self.cam.shaft

    def about_origin(self) -> SupportCam:
        """The cam with its shaft at the origin of p."""
        return replace(self.cam, shaft=(0.0, 0.0))

    def harmonic(self, path: str) -> tuple[int, bool, float] | None:
        """Order, whether a sine, coefficient per unit of a field of a Fourier series or a hypocycloid; else None."""
        if isinstance(self.cam.shape, HypocycloidShape):
            own = {
                "cam.hypocycloid.size": (self.cam.shape.cusps, False, 1.0),
                "cam.hypocycloid.breadth": (0, False, 0.5),
            }
            return own.get(path)
        if not isinstance(self.cam.shape, FourierShape):
            return None
        if path == "cam.fourier.mean":
            return 0, False, 1.0
        kind, _, order = path.removeprefix("cam.fourier.").partition(".")
        return (int(order), kind == "sin", 1.0) if kind in {"cos", "sin"} and order.isdigit() else None

    def without_harmonics(self, orders: set[tuple[int, bool]]) -> SupportCam:
        """Copy of the cam with the harmonics `orders`, (order, whether a sine), set to 0; the mean radius stays."""
        shape = self.cam.shape
        if isinstance(shape, FourierShape):
            shape = FourierShape(
                shape.mean,
                tuple((k, 0.0 if (k, False) in orders else a) for k, a in shape.cos),
                tuple((k, 0.0 if (k, True) in orders else a) for k, a in shape.sin),
            )
        elif isinstance(shape, HypocycloidShape):
            shape = replace(shape, size=0.0 if (shape.cusps, False) in orders else shape.size)
        return replace(self.cam, shape=shape)


def _with_size(lift: Lift, field: str, scale: float = 1.0) -> Lift:
    """The lift itself, if its mean radius is above the share `LEAST_PART` of the greatest |p|, or p is 0 throughout.

    2 pi times the mean radius is the perimeter, wherever the shaft is. Otherwise raises IntentError for a field, with
    lengths in a unit of `scale` mm.
    """
    from kin.law.normalised import IntentError

    p = lift.derivatives(np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False), 0)[0]
    mean, farthest = float(np.mean(p)), float(np.abs(p).max())
    least = LEAST_PART * farthest
    if mean > least or not farthest:  # of p = 0 the radius of curvature is held against 0 like any other
        return lift
    mean = 0.0 if abs(mean) < ROUNDING * farthest else mean
    # the mean must pass its least, and every radius of curvature p + p'' must be above 0
    rows = lift.derivatives(np.linspace(0.0, 2.0 * math.pi, CLOSE_LOOKS, endpoint=False), 2)
    radii = rows[0] + rows[2]  # what is added to p is added to each (AS eq. 3)
    more = max(least - mean, SPARE * float(np.ptp(radii)) - float(radii.min()))
    remedy = f"add more than {upward(more / scale)} to p" if field == "p" else "give a larger one"
    raise IntentError(
        f"the mean radius is {mean / scale:.6g}, not above {least / scale:.3g}: a cam's perimeter is 2 pi times it, "
        f"and this one's points lie up to {farthest / scale:.6g} from the shaft; {remedy}",
        field,
    )


def _formula(shape: FormulaShape, shaft: tuple[float, float]) -> Lift:
    from kin.law.formula.formula import Formula
    from kin.law.from_formula import lift_from_formula
    from kin.law.normalised import IntentError

    lift = lift_from_formula(Formula(shape.text), shaft, shape.scale)
    t = np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False)
    size = np.abs(lift.derivatives(t, 0)[0]) / shape.scale
    largest = int(np.argmax(size))
    if size[largest] > MOST:  # other lengths are bounded as they are read
        at_deg = math.degrees(t[largest])
        raise IntentError(
            f"p reaches {size[largest]:.6g} at {at_deg:.6g} degrees, above {MOST:.0f}; give a p of smaller values",
            "p",
            at_deg,
        )
    return lift


def _odd(name: str, about: str) -> Field:
    return Field(name, Kind.INTEGER, about, required=True, at_least=3, at_most=99, odd=True)


_FOURIER = mapping(
    "fourier",
    "support function as a Fourier series",
    length("mean", "mean of the support function", required=True),
    Field("cos", Kind.HARMONICS, "coefficients of cos(k t)", default="none", unit=Kind.LENGTH),
    Field("sin", Kind.HARMONICS, "coefficients of sin(k t)", default="none", unit=Kind.LENGTH),
)


_REULEAUX = mapping(
    "reuleaux",
    "a Reuleaux polygon, regular or by its angles, with rounded or sharp corners",
    _odd("sides", "number of sides"),
    length("breadth", "constant breadth", required=True),
    Field(
        "rounding",
        Kind.LENGTH,
        "radius of the corners, below half the breadth; at 0 they are sharp",
        default="0",
        at_least=0,
        at_most=MOST,
    ),
    Field(
        "angles",
        Kind.NUMBERS,
        "angles for which the cam turns about its corners, in order; all but the last three",
        default="all equal",
        unit=Kind.ANGLE,
        at_least=LEAST_ANGLE,
        at_most=180,
        most=96,
    ),
)


_HYPOCYCLOID = mapping(
    "hypocycloid",
    "the parallel curve of a hypocycloid, p = breadth/2 + size*cos(cusps*t)",
    _odd("cusps", "number of cusps"),
    length("size", "radius of the circle inscribed in the hypocycloid", required=True),
    length("breadth", "constant breadth", required=True),
)


TABLE = FieldTable(
    (
        Field("p", Kind.FORMULA, "support function p(t), t in radians, its value a length"),
        _FOURIER,
        _REULEAUX,
        _HYPOCYCLOID,
        Field("shaft", Kind.POINT, "place [x, y] of the shaft in the axes in which p is written", default="[0, 0]"),
        UNDERCUT,
        PRELOAD,
    ),
    alternatives=(("p", ()), ("fourier", ()), ("reuleaux", ()), ("hypocycloid", ())),
)


def check(cam: Values, reader: Reader) -> None:
    """Note corners that are too large or too small for a file, and a wrong number of angles."""
    reuleaux = cam.get("reuleaux", {})
    if {"sides", "angles"} <= reuleaux.keys():
        sides, count = reuleaux["sides"], len(reuleaux["angles"])
        remedy = f"give {sides - FREE}; the last three follow" if sides > FREE else "leave it out: it is regular"
        if count != sides - FREE:
            reader.fault_at("cam.reuleaux.angles", f"not as many as {sides} sides leave open", str(count), remedy)
    if {"breadth", "rounding"} <= reuleaux.keys() and reuleaux["rounding"] >= reuleaux["breadth"] / 2:
        remedy = f"give less than {reuleaux['breadth'] / 2 / reader.mm:g} {reader.units}"
        value = f"{reuleaux['rounding'] / reader.mm:g}"
        reader.fault_at("cam.reuleaux.rounding", "not below half the breadth", value, remedy)
    if {"sides", "rounding"} <= reuleaux.keys() and reuleaux["rounding"] > 0.0:
        arc = 2.0 * math.sin(0.5 * _least_angle(**reuleaux))  # chord of a corner's arc of radius 1
        if arc * reuleaux["rounding"] < LEAST_PIECE * (1.0 - NOISE):
            least = 1.001 * LEAST_PIECE / arc  # clear of rounding
            remedy = f"give at least {upward(least / reader.mm)} {reader.units}"
            value = f"{reuleaux['rounding'] / reader.mm:g}"
            reader.fault_at("cam.reuleaux.rounding", "a corner smaller than a file can hold", value, remedy)


def _least_angle(sides: int, angles: tuple[float, ...] = (), **_: float) -> float:
    """Least angle, rad, by which the cam turns about a corner; the regular polygon's where no polygon has `angles`."""
    from kin.law.normalised import IntentError
    from kin.law.reuleaux import closed_angles

    try:
        return min(closed_angles(sides, angles)) if angles else math.pi / sides
    except IntentError:
        return math.pi / sides


def build(cam: Values, mm: float) -> Cam:
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    return SupportCam(_shape(cam, mm), cam.get("shaft", (0.0, 0.0)), cam.get("undercut", "refuse"), build_preload(cam))


def _shape(cam: Values, mm: float) -> Shape:
    if "fourier" in cam:
        return FourierShape(**{"cos": (), "sin": (), **cam["fourier"]})
    if "reuleaux" in cam:
        return ReuleauxShape(**cam["reuleaux"])
    if "hypocycloid" in cam:
        return HypocycloidShape(**cam["hypocycloid"])
    return FormulaShape(cam["p"], mm)


BY_MOTION = ByMotion(
    motion="fourier",
    base="fourier.mean",
    instead=("p", "reuleaux", "hypocycloid"),
    still=("fourier", {"mean": 40.0}),
    opposed=True,
    series=True,
)
FAMILY = Family(SupportCam.kind, Arrangement(Translating, Flat, 2), TABLE, build, check, BY_MOTION)
