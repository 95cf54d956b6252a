"""Wunderlich's single-disk cams: the routes from a recipe to their law of transmission, and its checks (W 1984)."""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, ClassVar, Literal, TypeAlias

import numpy as np

from camgeo.cams.family import UNDERCUT, Advice, Cam, ExactCam, Harmonics, Margin, Preload, Proof
from camgeo.cams.flat_faced import spread
from camgeo.cams.preload import PRELOAD, with_preload
from camgeo.common.rounding import downward
from camgeo.motions.motion import MotionSource, check_filled, motion_field
from camgeo.motions.position import Position, SwingPosition
from camgeo.schema.fields import Field, FieldTable, Kind, length, mapping
from kin.law.contacts import Flat
from kin.numeric.angles import degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.cams.follower import Follower
    from camgeo.cams.surface import Surface
    from camgeo.schema.reader import Reader, Values
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Kept
    from kin.law.transmission import Transmission
    from kin.law.wanted import Nearest

EXACT = 1e-9  # of the arm: to this the closing equation must hold
HARMONICS = 7  # highest harmonic of a wanted law, where a recipe gives none
LOOKS = 1440  # parameters of a law at which its margins are taken
_OTHER_PARTS = "both sides of the follower touch the cam at once, so the motion after that follows"


@dataclass(frozen=True)
class DeltaRoute:
    """Route by harmonics: D(t) = sum over odd j of cos[j] cos(j lambda t) + sin[j] sin(j lambda t), in mm^2.

    t is the polar angle of a roller; the pair swings by asin(D/arm^2) to each side (Wunderlich 6.5).
    """

    cos: Harmonics
    sin: Harmonics


@dataclass(frozen=True)
class DeltaFormulaRoute:
    """Route by D(t) as text in t, the polar angle of a roller in rad; `scale` times its value is in mm^2.

    The pair swings by asin(D/arm^2) to each side (Wunderlich 6.5).
    """

    text: str
    scale: float


@dataclass(frozen=True)
class LawRoute:
    """Route by the follower's swing over delta = pi/lambda of shaft angle; of a flat pair the swing is psi/2."""

    motion: MotionSource


@dataclass(frozen=True)
class WantedRoute:
    """Route by the series D whose law is nearest to a wanted swing, of odd harmonics up to `harmonics` (W 6.5)."""

    motion: MotionSource
    harmonics: int


@dataclass(frozen=True)
class ArcRoute:
    """Route by a circular first arc of the pitch curve, radius in mm, symmetric about its bisector."""

    radius: float
    side: Literal["convex", "concave"]


@dataclass(frozen=True)
class CurveRoute:
    """Route by any first arc of the pitch curve: r as text in t, the polar angle in rad.

    `scale` times the value of the text is in mm.
    """

    text: str
    scale: float


@dataclass(frozen=True)
class RosetteRoute:
    """Route by one leaf of the rosette that the third arm's tip Q traces: |OQ| as text in x, 0 to 1.

    `scale` times the value of the text is in mm.
    """

    text: str
    scale: float


Route: TypeAlias = DeltaRoute | DeltaFormulaRoute | LawRoute | WantedRoute | ArcRoute | CurveRoute | RosetteRoute
SwingOf: TypeAlias = Literal["arm", "pair"]


@lru_cache(maxsize=32)
def _nearest(
    lam: int, mu: int, swing_of: SwingOf, route: WantedRoute, share: float = 1.0
) -> tuple[Nearest, Transmission]:
    """Nearest series for arms of length 1, and the wanted law, both with this share of the wanted strokes."""
    from kin.law.transmission import from_law
    from kin.law.wanted import nearest

    motion = route.motion.motion(math.pi / lam, "delta.law", None)
    wanted = from_law(lam, mu, 1.0, motion, swing_of, share=share, corners=True, field="delta.law")
    return nearest(wanted, route.harmonics), wanted


def _greatest_share(law: Callable[[float], Transmission]) -> float:
    """Greatest share of the swing, below 1 and to a thousandth, with which a law is possible; 0 if none is found."""
    from kin.law.normalised import IntentError

    low, high = 0.0, 1.0
    # a possible share first, then halving between it and the least impossible one
    for share in (0.5, 0.25, 0.05):
        try:
            law(share)
        except IntentError:
            high = share
        else:
            low = share
            break
    while low and high - low > 5e-4:
        middle = 0.5 * (low + high)
        try:
            law(middle)
        except IntentError:
            high = middle
        else:
            low = middle
    return low


class PairCam(Cam):
    """A single disk that works a rigid pair of contacts about one pivot; pi/alpha = lam/mu in lowest terms, mu odd.

    `swing_of` tells which swing a recipe gives: an arm's, psi, or the pair's, psi/2. `arm` is the length l, mm.
    """

    swing_of: ClassVar[SwingOf]
    lam: int
    mu: int
    arm: float
    route: Route
    preload: Preload | None

    def exact(self, *, framed: bool = False) -> ExactCam:  # noqa: ARG002 - the protocol's
        """The cam with Wunderlich's law of transmission, and its preload.

        Raises IntentError where the route gives no law, and for a preload that leaves nothing of the rollers.
        """
        return with_preload(ExactPair(self, self.transmission()), self.preload)

    @abstractmethod
    def follower(self, law: Transmission, out: float) -> Follower:
        """The follower; faces stand `out` mm beside the lines through their pivot, on rollers it is of no effect."""

    @abstractmethod
    def surface(self, law: Transmission, out: float) -> Surface:
        """Surface of the disc for a law; faces stand `out` mm beside the lines through their pivot."""

    @abstractmethod
    def grow(self, out: float, scale: float) -> PairCam:
        """Copy for metal grown by `out` mm, then lengths times `scale`; raises GrownError where no roller is left."""

    @property
    def motion_span(self) -> float:
        """The section of the turn that repeats, pi/lambda, rad."""
        return math.pi / self.lam

    @property
    def mean_distance(self) -> float:
        """Distance R = 2 l cos(alpha/2) of the arms' ends from the shaft without a swing, mm."""
        return 2.0 * self.arm * math.cos(0.5 * math.pi * self.mu / self.lam)

    def transmission(self) -> Transmission:
        """Wunderlich's law of transmission, by the recipe's route; raises IntentError where the route gives no law.

        For routes by D or by a swing its message has the share of D or swing with which a law is possible.
        """
        from kin.law.normalised import IntentError

        try:
            return self._law()
        except IntentError as error:
            if not isinstance(self.route, DeltaRoute | DeltaFormulaRoute | LawRoute | WantedRoute):
                raise
            share = _greatest_share(self._law)
            if not share:
                raise
            factor = "stroke" if isinstance(self.route, LawRoute | WantedRoute) else "value of D"
            message = (
                f"{error.message}; with each {factor} multiplied by {downward(share, 3)} such a motion is possible"
            )
            raise IntentError(message, error.field, error.at, error.at_unit) from error

    def _law(self, share: float = 1.0) -> Transmission:
        """The law with this share of the recipe's D or strokes."""
        from kin.law import transmission

        route = self.route
        if isinstance(route, DeltaRoute):
            cos, sin = ({j: share * c for j, c in terms} for terms in (route.cos, route.sin))
            return transmission.from_delta(self.lam, self.mu, self.arm, cos, sin)
        if isinstance(route, LawRoute):
            motion = route.motion.motion(math.pi / self.lam, "law", None)
            return transmission.from_law(self.lam, self.mu, self.arm, motion, self.swing_of, share=share)
        if isinstance(route, WantedRoute):
            # the nearest series is that of arms of length 1: D grows as the square of the length
            series, square = _nearest(self.lam, self.mu, self.swing_of, route, share)[0], self.arm * self.arm
            cos, sin = ({j: square * c for j, c in part.items()} for part in (series.cos, series.sin))
            return transmission.from_delta(self.lam, self.mu, self.arm, cos, sin)
        if isinstance(route, ArcRoute):
            return transmission.from_arc(self.lam, self.mu, self.arm, route.radius, route.side)
        from kin.law import polar_formula
        from kin.law.formula.formula import Formula

        if isinstance(route, DeltaFormulaRoute):
            return polar_formula.from_delta_formula(
                self.lam, self.mu, self.arm, Formula(route.text), share * route.scale
            )
        if isinstance(route, CurveRoute):
            return polar_formula.from_curve(self.lam, self.mu, self.arm, Formula(route.text), route.scale)
        leaf = Formula(route.text, ("x",))
        return transmission.from_rosette(self.lam, self.mu, self.arm, leaf, route.scale)

    @property
    def law_checks(self) -> tuple[str, ...]:
        """Names of the checks of the law."""
        return ("closing-equation", "velocity-ratio", *(("law-error",) if isinstance(self.route, WantedRoute) else ()))

    def law_error(self) -> Proof:
        """Proved error of the swing against the wanted swing, degrees; the limit is the error of no swing at all.

        Raises TypeError for a route without a wanted swing, and IntentError where no bound is proved.
        """
        from kin.law.wanted import proved_error

        if not isinstance(self.route, WantedRoute):
            raise TypeError("no law is wanted")
        series, wanted = _nearest(self.lam, self.mu, self.swing_of, self.route)
        share = math.degrees(0.5 if self.swing_of == "pair" else 1.0)
        error = share * proved_error(series, wanted)
        psi = wanted.at(spread(wanted.breaks, 2.0 * math.pi), 0)[1][0]
        still = share * float(np.abs(psi).max())
        return Proof(error < still or not still, error, still, "deg", degrees(float(wanted.at(series.at, 0)[0][0, 0])))

    def kept(self) -> Kept | None:
        """Record of how the swing over 360/lambda degrees keeps the rows of its table, rad; None without one.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        if isinstance(self.route, LawRoute | WantedRoute):
            field = "law" if isinstance(self.route, LawRoute) else "delta.law"
            return self.route.motion.motion(math.pi / self.lam, field, None).kept
        return None

    def joints(self, law: Transmission) -> tuple[DerivativeJump, ...]:
        """Joints of the swing over 360/lambda degrees, of a route by a swing or by a formula of D or the first arc.

        Empty for other routes.
        """
        if not isinstance(self.route, LawRoute | DeltaFormulaRoute | CurveRoute):
            return ()
        share = 0.5 if self.swing_of == "pair" else 1.0
        return tuple(joint.scaled(share) for joint in law.joints)


@dataclass(frozen=True)
class PairAdvice(Advice):
    """Advice for a pair of contacts on one arm."""

    cam: PairCam

    @property
    def radius(self) -> float:
        """Radius of the rollers, mm; 0 for faces."""
        return self.cam.touch.radius

    def less_swing(self, mm: float) -> str:
        """Words for a smaller swing; for the route by an arc, for a radius nearer to `mean_distance`."""
        if not isinstance(self.cam.route, ArcRoute):
            return super().less_swing(mm)
        return f"an arc.radius nearer to {self.cam.mean_distance / mm:.6g}"


@dataclass(frozen=True, eq=False)
class ExactPair(ExactCam):
    """A pair cam with its law of transmission; faces stand `out` mm beside the lines through the pivot."""

    cam: PairCam
    law: Transmission
    out: float = 0.0

    @cached_property
    def follower(self) -> Follower:
        """The follower for this motion."""
        return self.cam.follower(self.law, self.out)

    @cached_property
    def motion(self) -> Position:
        """The swing psi of the first arm, or the pair's own psi/2."""
        return SwingPosition(self.law, 0.5 if self.cam.swing_of == "pair" else 1.0)

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of the disc, in a tuple of one: both contacts touch it."""
        return (self.cam.surface(self.law, self.out),)

    @property
    def judged_law(self) -> Transmission:
        """Law of transmission, by which kin judges the files."""
        return self.law

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the recipe's motion."""
        return self.cam.joints(self.law)

    def grow(self, out: float, scale: float) -> ExactPair:
        """Cam with `out` mm more metal along the normal, then scaled by `scale`; the swing stays.

        The pivot's distance is scaled, and flat faces stand farther out by the growth.
        """
        return ExactPair(self.cam.grow(out, scale), self.law.scaled(scale), scale * (self.out + out))

    @property
    def never_undercut(self) -> bool:
        """Whether no motion undercuts it: flat faces that stand outside the lines through the pivot."""
        return self.out > 0.0 and self.cam.arrangement.touch is Flat

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """Checks of the law, by their names."""
        proofs = (self._closing_equation, self._velocity_ratio, self.cam.law_error)
        return dict(zip(self.cam.law_checks, proofs, strict=False))

    def _closing_equation(self) -> Proof:
        """Check that the second arm's end runs on the same curve (W 1984, 4.6 and 7.1).

        Both arms' ends are held against each other at the same polar angle, t = phi - (psi + alpha)/2 of the first and
        phi - (psi - alpha)/2 of the second: over it |psi'| < 2, while over the shaft angle psi may rise as steeply as
        it likes, and rounding with it.
        """
        law = self.law
        tau = spread(law.breaks, 2.0 * math.pi)
        phi, psi = law.at(tau, 0)
        image = law.at(law.polar_parameter(law.pitch(tau, 0)[1][0] + law.alpha), 0)[1][0]
        gap = law.arm * np.abs(image + psi[0])
        worst = int(np.argmax(gap))
        limit, at_deg = EXACT * law.arm, degrees(float(phi[0, worst]))
        return Proof(bool(gap[worst] <= limit), float(gap[worst]), limit, "mm", at_deg)

    def _velocity_ratio(self) -> Proof:
        """Check that the greatest velocity ratio, psi' by the shaft angle, is below 1: the cam does not turn back."""
        from kin.law.feasibility import steepest

        place, value = steepest(self.law)
        return Proof(value < 1.0, value, 1.0, "", degrees(float(self.law.at(place, 0)[0][0, 0])))

    @property
    def margins(self) -> list[Margin]:
        """How far the cam is from a velocity ratio of 1, where it cannot be turned through, and from three more limits.

        They are a swing of 90 degrees, where the square root of the analytic route ends, and, in mm, a pitch curve that
        passes the shaft and one that passes the point which the stretched arm reaches.
        """
        from kin.law.feasibility import steepest

        law = self.law
        tau = np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False)
        tau = np.sort(np.concatenate([tau, law.breaks]))
        psi = law.at(tau, 0)[1]
        rate = steepest(law)[1]
        widest = float(np.abs(psi[0]).max())
        # the roots of the analytic route are of l^4 - D^2, D = -l^2 sin psi
        edge = Margin("square-root", math.degrees(0.5 * math.pi - widest), "deg", "D reaches l^2: psi = 90 degrees")
        # the arms' ends are r = 2 l cos((psi + alpha)/2) from the shaft
        reach = float(np.cos(0.5 * (psi[0] + law.alpha)).min())
        pivot = float(1.0 - np.cos(0.5 * (psi[0] + law.alpha)).max())
        return [
            Margin("turning-through", 1.0 - rate, "", "the cam cannot be turned through: psi' = 1"),
            edge,
            Margin("shaft", 2.0 * law.arm * reach, "mm", "the pitch curve reaches the shaft: r = 0"),
            Margin("stretched", 2.0 * law.arm * pivot, "mm", "the arm is stretched: r = 2 l"),
        ]


_DELTA = mapping(
    "delta",
    "D(t), the sum of cos[j]*cos(j*lambda*t) + sin[j]*sin(j*lambda*t), j odd",
    Field("cos", Kind.HARMONICS, "coefficients of the cosines", default="none", unit=Kind.AREA, odd=True),
    Field("sin", Kind.HARMONICS, "coefficients of the sines", default="none", unit=Kind.AREA, odd=True),
    Field("formula", Kind.FORMULA, "or D itself, with D(t + 180°/lambda) = -D(t)", default="none", unit=Kind.AREA),
    motion_field(
        "law", Kind.ANGLE, "or the swing, as in cam.law, to which the follower comes as near as the harmonics let it"
    ),
    Field(
        "harmonics",
        Kind.INTEGER,
        "highest harmonic of the D that is found for `law`, one of 1, 3, 5, ..",
        default=str(HARMONICS),
        at_least=1,
        at_most=31,
        odd=True,
    ),
)


_ARC = Field(
    "arc",
    Kind.TABLE,
    "first arc of the pitch curve",
    table=FieldTable(
        (
            length("radius", "radius of a circular arc, symmetric about its bisector"),
            Field("side", Kind.CHOICE, "how that bulges", default="convex", choices=("convex", "concave")),
            Field("formula", Kind.FORMULA, "distance from the shaft at the polar angle t, from 0 to 180°/lambda"),
        ),
        alternatives=(("radius", ()), ("formula", ())),
    ),
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


def pair_table(law: str, roller: tuple[Field, ...]) -> FieldTable:
    """Table of keys of a double roller or a flat pair; `law` describes its swing, `roller` are keys of the rollers."""
    routes = (_DELTA, motion_field("law", Kind.ANGLE, law), _ARC, _ROSETTE)
    return FieldTable(
        (
            Field("ratio", Kind.RATIO, "pi/alpha = lambda/mu in lowest terms, mu odd", required=True),
            length("arm", "arm length, the distance l of the closing equation", required=True),
            *roller,
            *routes,
            UNDERCUT,
            PRELOAD,
        ),
        alternatives=tuple((route.name, ()) for route in routes),
    )


_APART = (
    ("delta.cos", ("formula", "law")),
    ("delta.sin", ("formula", "law")),
    ("delta.formula", ("law",)),
    ("arc.side", ("formula",)),
)


def check(cam: Values, reader: Reader) -> None:
    """Note harmonics without motion, keys that exclude each other, and segments that do not fill their angle."""
    _harmonics(cam, reader)
    for path, excluded in _APART:
        for key in excluded:
            if f"cam.{path}" in reader.marks and f"cam.{path.partition('.')[0]}.{key}" in reader.marks:
                reader.fault_at(f"cam.{path}", f"cannot stand beside {key}", None, "leave one of them out")
    if "cam.delta.harmonics" in reader.marks and "cam.delta.law" not in reader.marks:
        reader.fault_at("cam.delta.harmonics", "cannot stand without a law", None, "leave it out, or give delta.law")
    for path, values in (("cam.law", cam), ("cam.delta.law", cam.get("delta") or {})):
        if "law" in values and "ratio" in cam:
            lam, _ = cam["ratio"]
            check_filled(values["law"], path, math.pi / lam, f"180/{lam} degrees", reader, why=_OTHER_PARTS)


def _harmonics(cam: Values, reader: Reader) -> None:
    delta = cam.get("delta")
    faulty = any(error.path.startswith("cam.delta") for error in reader.errors)
    if delta is not None and not faulty and not any(map(delta.get, ("cos", "sin", "formula", "law", "harmonics"))):
        reader.fault_at("cam.delta", "no harmonics, so no motion", None, "give some, such as {cos: {1: 625}}")


def build_route(cam: Values, mm: float) -> Route:
    """Build the route from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    if "formula" in cam.get("delta", ()):
        return DeltaFormulaRoute(cam["delta"]["formula"], mm * mm)
    if "law" in cam.get("delta", ()):
        return WantedRoute(cam["delta"]["law"], cam["delta"].get("harmonics", HARMONICS))
    if "formula" in cam.get("arc", ()):
        return CurveRoute(cam["arc"]["formula"], mm)
    if "delta" in cam:
        return DeltaRoute(**{"cos": (), "sin": (), **cam["delta"]})
    if "law" in cam:
        return LawRoute(cam["law"])
    if "arc" in cam:
        return ArcRoute(**{"side": "convex", **cam["arc"]})
    return RosetteRoute(cam["rosette"]["leaf"], mm)
