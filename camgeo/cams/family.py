"""What every family of cams gives: a recipe's cam that knows its motion, its follower, its exact curve and its advice.

The rest of the package asks a cam by these names and never which family it is of.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, TypeAlias

from camgeo.schema.fields import Field, Kind
from kin.law.contacts import Arrangement, Flat
from kin.numeric.errors import KinError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.position import Position
    from camgeo.curve.curve import Curve
    from camgeo.curve.extremes import Extreme, Figure
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.fields import Table
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.frame_swing import FrameSwing
    from kin.law.joints import Joint
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

Intent: TypeAlias = "Lift | Transmission | Displacement"
Undercut: TypeAlias = Literal["refuse", "trim"]
Harmonics: TypeAlias = tuple[tuple[int, float], ...]  # (harmonic, coefficient), rising
Unit: TypeAlias = Literal["mm", "deg"]
SMALLER_SWING = "a smaller swing, or the same over a wider angle"

UNDERCUT = Field(
    "undercut",
    Kind.CHOICE,
    "what to do about undercut (trim reports the motion that is lost)",
    default="refuse",
    choices=("refuse", "trim"),
)


@dataclass(frozen=True)
class Profile:
    """The exact curve of a cam.

    `base` is what the motion describes, the pitch curve of a roller or the contour itself; `curve` is the contour,
    `roller_radius` inside the base (0 for flat faces). `extremes` keeps what `Cam.extremes` found.
    """

    base: Curve
    curve: Curve
    roller_radius: float
    extremes: dict[str, tuple[Extreme, Extreme]] = field(default_factory=dict, init=False, repr=False, compare=False)


@dataclass(frozen=True)
class Follower:
    """What follows the disc: the name in reports, its contacts, the checks of its intended motion in their order.

    `closure` is the name of the check of files on what is left between the cam and a follower that is held from both
    sides, empty for other followers.
    """

    name: str
    contacts: tuple[Contact[Guide, Touch], ...]
    checks: tuple[str, ...]
    closure: str = ""

    @property
    def arrangement(self) -> Arrangement:
        """Guide and touch of its contacts, and how many they are."""
        first = self.contacts[0]
        return Arrangement(type(first.guide), type(first.touch), len(self.contacts))

    @property
    def breadth(self) -> float | None:
        """How far two opposite faces are apart, mm; None for other followers."""
        *_, last = self.contacts
        return last.datum if last.sense < 0 and isinstance(last.touch, Flat) and last.guide.unit == "mm" else None


class Circle(NamedTuple):
    """A circle about the shaft that a drawing shows for reference; `radius` None for that of the curve's least one."""

    name: str
    radius: float | None = None


class Margin(NamedTuple):
    """A distance from trouble, at which it is 0: its name, value, unit, and what happens there."""

    name: str
    value: float
    unit: str
    of: str


class GrownError(KinError, ValueError):
    """A follower of which nothing would be left."""


class Cam(ABC):
    """A cam of a recipe, checked and converted: lengths in mm, angles in radians. Its fields are its family's own."""

    kind: ClassVar[str]
    unit: ClassVar[Unit] = "mm"
    """Of the follower's position and of motion errors."""
    backlash_unit: ClassVar[Unit] = "mm"
    """Of the backlash of a follower that is held from both sides."""
    gain: ClassVar[float | None] = 1.0
    """By how much at most the follower is off per mm of the contour's error, None where that depends on the place."""
    offers: ClassVar[frozenset[str]] = frozenset()
    """What figures may be taken of it: roller, swings (two on one arm), face, plate (that a linkage can carry), guided
    (on a stem or arm), stem, arm, rolling (one roller that it turns), stem-face."""
    undercut: Undercut

    less_steep: ClassVar[str] = SMALLER_SWING
    """What makes the motion less steep; empty where the recipe gives no stroke."""

    @property
    def touch_radius(self) -> float:
        """Radius of what touches the contour, mm: a roller's; 0 of a face."""
        return 0.0

    @property
    def roller_field(self) -> str:
        """What that radius is called in advice."""
        return "roller radius"

    @property
    def metal(self) -> Side:
        """On which side of the contour the metal lies: 1 inside, -1 outside, as of a ring."""
        return 1

    # --- motion and curve ---------------------------------------------------------------------------------------------

    @abstractmethod
    def intent(self) -> Intent:
        """Motion that is intended; raises kin's IntentError with the field below `cam` that is at fault."""

    @abstractmethod
    def position(self, intent: Intent) -> Position:
        """The follower's position and contacts over the shaft angle, by that motion."""

    @abstractmethod
    def profile(self, intent: Intent) -> Profile:
        """Exact curve that gives a motion; raises TypeError for one of another family."""

    @abstractmethod
    def follower(self, intent: Intent, *, framed: bool) -> Follower:
        """The follower that the motion calls for; `framed` where a linkage carries it."""

    @abstractmethod
    def law(self, intent: Intent) -> Piecewise | Transmission:
        """The motion as kin judges files by it: the follower's position over the shaft angle, or a transmission."""

    @property
    def by_linkage(self) -> bool:
        """Whether the lengths of the linkage shape the cam."""
        return False

    def in_frame(self, ground: float, rocker: float, side: float) -> Cam:  # noqa: ARG002
        """The cam told of the links that its square frame slides on (`kin.law.frame_swing`), mm."""
        return self

    def frame_swing(self) -> FrameSwing | None:
        """The law by which a recipe lets the frame swing over the shaft angle, if it gives one."""
        return None

    def pressure_angle(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:  # noqa: ARG002
        """Angle between the contact's normal and the follower's way, rad, over parameters of the contour (n,).

        Above 0 where the cam drives a rise; a flat face at right angles to its way has none.
        """
        return lambda t: 0.0 * t

    def contact_place(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:
        """Where a flat face is touched, mm along it, over parameters of the contour (n,)."""
        raise NotImplementedError

    def joints(self, intent: Intent) -> tuple[Joint, ...]:  # noqa: ARG002
        """Where derivatives of the motion that a recipe gives jump; displacements in mm or rad."""
        return ()

    def series(self, intent: Intent, profile: Profile) -> dict[str, Figure]:  # noqa: ARG002
        """Figures over the shaft angle whose extremes are proved, by name.

        slope: tangent of the pressure angle; contact: place on a flat face, mm; spin: turns of the roller per turn of
        the shaft.
        """
        return {}

    def extremes(self, name: str, intent: Intent, profile: Profile) -> tuple[Extreme, Extreme] | None:
        """Least and greatest value of one of `series`, found once of a profile; None of one that there is not."""
        from camgeo.curve.extremes import greatest, least
        from camgeo.curve.rates import stretches

        if name not in profile.extremes:
            figure = self.series(intent, profile).get(name)
            if figure is None:
                return None
            over = stretches(profile.base.shape)
            profile.extremes[name] = least(figure, over), greatest(figure, over)
        return profile.extremes[name]

    # --- advice -------------------------------------------------------------------------------------------------------

    @abstractmethod
    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Say what would be free of undercut; `free_at` (mm) is a roller's radius, or what radii must grow by."""

    @abstractmethod
    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Say what would raise the least radius of curvature from a value to a limit, in the recipe's unit."""

    def same_pitch(self, mm: float) -> str:  # noqa: ARG002
        """Say what else changes with the roller's radius, so that the pitch curve stays; empty where nothing does."""
        return ""

    def found(self, mm: float) -> str:  # noqa: ARG002
        """What was found in place of a size that the recipe leaves open, in words; `mm` is the recipe's unit."""
        return ""

    def less_swing(self, mm: float) -> str:  # noqa: ARG002 - one family's words hang on the unit
        """Say how the follower comes to swing less; `mm` is the recipe's unit."""
        return "a smaller swing"

    def less_pressure(self, intent: Intent, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:  # noqa: ARG002
        """Say which size keeps the pressure angle below two angles, rad, with the cam; None where none is known."""
        return None

    def rounder_pitch(self, intent: Intent, radius: float, mm: float) -> str:  # noqa: ARG002
        """Say what makes the roller half the pitch curve's least convex radius (mm); empty where nothing rolls."""
        return ""

    @property
    def least_pressure_angle(self) -> float:
        """Pressure angle without any motion, degrees: no smaller stroke stays below it."""
        return 0.0

    # --- drawings, other sizes ----------------------------------------------------------------------------------------

    def circles(self) -> tuple[Circle, ...]:
        """Circles about the shaft for a drawing to show."""
        return ()

    def grown(self, out: float, scale: float) -> Cam:  # noqa: ARG002
        """The cam as far as its own lengths are drawn, the metal grown by `out` mm and then scaled.

        Raises GrownError where the follower would be nothing.
        """
        return self

    @abstractmethod
    def grown_intent(self, intent: Intent, out: float, scale: float) -> Intent:
        """The motion of the cam so made, as its follower feels it."""

    def face_beyond(self, out: float, scale: float) -> float:  # noqa: ARG002
        """How far faces then stand beside the lines through their pivot, mm."""
        return 0.0

    def refusing(self) -> Cam:
        """The same cam with undercut refused."""
        return replace(self, undercut="refuse")  # type: ignore[type-var]  # every family is a dataclass

    # --- study and sweep ----------------------------------------------------------------------------------------------

    def margins(self, intent: Intent) -> list[Margin]:  # noqa: ARG002
        """How far the motion is from where it would not exist."""
        return []

    @property
    def shaft_at(self) -> tuple[float, float]:
        """The shaft in the axes in which the cam is given, mm."""
        return (0.0, 0.0)

    def about_origin(self) -> Cam:
        """The same cam with its shaft at the origin of those axes."""
        return self

    def harmonic(self, path: str) -> tuple[int, bool, float] | None:  # noqa: ARG002
        """Order, whether of a sine, and scale of the harmonic whose size stands at a path; order 0 for the mean."""
        return None

    def silent(self, orders: set[tuple[int, bool]]) -> Cam:  # noqa: ARG002
        """The same cam without these harmonics (order, whether of a sine)."""
        return self


@dataclass(frozen=True)
class Family:
    """How a family stands in a recipe.

    `table` has its keys; `check` notes the faults between them, `build` makes the cam of values without fault and the
    unit of length in mm. `variant` looks, where that decides, at the cam as written for the class that it will be of.
    """

    cam: type[Cam]
    table: Table
    build: Callable[[Values, float], Cam]
    check: Callable[[Values, Reader], None]
    variant: Callable[[Node], type[Cam]] | None = None

    def of(self, node: Node | None) -> type[Cam]:
        """Give the class of a cam as written, which says its units and what figures may be taken of it."""
        return self.variant(node) if self.variant and node is not None else self.cam

    @property
    def kind(self) -> str:
        """Its name in a recipe."""
        return self.cam.kind
