"""What every family of cams gives: a recipe's cam that knows its motion, its follower, its exact curve and its advice.

The rest of the package asks a cam by these names and never which family it is of. A cam is what a recipe says; an exact
cam is what it is once its motion is known, and keeps the law of that to itself.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, TypeAlias

from camgeo.common.rounding import upward
from camgeo.schema.fields import Field, Kind
from kin.numeric.angles import TURN
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.cams.follower import Follower
    from camgeo.cams.surface import Surface
    from camgeo.curve.extremes import Extreme
    from camgeo.curve.moving_frame import Displacement
    from camgeo.motions.motion import ByMotion, MotionSource, Open
    from camgeo.motions.position import Position
    from camgeo.schema.fields import Table
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.follower.base import Follower as Gauge
    from kin.law.contacts import Arrangement, Contact, Guide, Side, Touch
    from kin.law.frame_swing import FrameSwing
    from kin.law.joints import Joint
    from kin.law.piecewise import Piecewise
    from kin.law.sources.motion import Kept
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

Undercut: TypeAlias = Literal["refuse", "trim"]
Harmonics: TypeAlias = tuple[tuple[int, float], ...]  # (harmonic, coefficient), rising
SMALLER_SWING = "a smaller swing, or the same over a wider angle"

UNDERCUT = Field(
    "undercut",
    Kind.CHOICE,
    "what to do about undercut (trim reports the motion that is lost)",
    default="refuse",
    choices=("refuse", "trim"),
)


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


class GrownError(CamgeoError, ValueError):
    """A follower of which nothing would be left."""


class Proof(NamedTuple):
    """What holds of a motion, or not: value and limit in a unit, and the shaft angle in degrees."""

    ok: bool
    value: float
    limit: float
    unit: str
    at_deg: float


@dataclass(frozen=True)
class Advice(ABC):
    """What would help, in the words of a recipe; `mm` is always its unit of length.

    gain                  by how much the follower is off per mm of the contour's error, None where that differs
    least_pressure_angle  pressure angle without any motion, degrees: no smaller stroke stays below it
    larger                what size of the cam, made larger, makes the pressure angle less; empty where none does
    less_steep            what makes the motion less steep; empty where the recipe gives no stroke
    less_swing            how the follower comes to swing less
    radius_field          what the radius of the touch is called
    trims                 whether undercut may be cut off
    others                what would help on surfaces where that is something else, by their names
    """

    gain: float | None = field(default=None, kw_only=True)
    least_pressure_angle: float = field(default=0.0, kw_only=True)
    larger: str = field(default="", kw_only=True)
    less_steep: str = field(default=SMALLER_SWING, kw_only=True)
    radius_field: str = field(default="roller radius", kw_only=True)
    trims: bool = field(default=True, kw_only=True)
    others: Mapping[str, Advice] = field(default_factory=dict, kw_only=True)

    def on(self, surface: str) -> Advice:
        """What would help on a surface."""
        return self.others.get(surface, self)

    @property
    def radius(self) -> float:
        """Radius of a round touch, mm; 0 of others."""
        return 0.0

    @abstractmethod
    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Say what would be free of undercut; `free_at` (mm) is a roller's radius, or what radii must grow by."""

    @abstractmethod
    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Say what would raise the least radius of curvature from a value to a limit, in the recipe's unit."""

    def same_pitch(self, mm: float) -> str:  # noqa: ARG002
        """Say what else changes with the roller's radius, so that the pitch curve stays; empty where nothing does."""
        return ""

    @property
    def most_radius(self) -> float:
        """Radius of a touch, mm, that leaves no base circle on the same pitch curve; infinite where any does."""
        return math.inf

    def size_found(self, exact: ExactCam, mm: float) -> str:  # noqa: ARG002
        """Say what was found in place of a size that the recipe leaves open, and what bounds it; empty for none."""
        return ""

    def wider_face(self, width: float, mm: float) -> str:  # noqa: ARG002 - a round tappet's has lengths of its own
        """Say which face has a width, in the recipe's unit."""
        return f"a follower.width of {upward(width)}"

    def less_swing(self, mm: float) -> str:  # noqa: ARG002 - one family's words hang on the unit
        """Say how the follower comes to swing less."""
        return "a smaller swing"


@dataclass(frozen=True)
class Preload:
    """What both contacts together overlap the metal by, mm, and the stiffness of each along its normal, N/m.

    `stiffness` is None where no force is asked for; `shares` of the interference stand on the metal of each contact.
    """

    interference: float
    stiffness: tuple[float, float] | None = None
    shares: tuple[float, float] = (0.5, 0.5)

    @property
    def overlaps(self) -> tuple[float, float]:
        """By how much each contact overlaps the metal that it touches, mm, the follower being where it is meant to."""
        first, second = self.shares
        return first * self.interference, second * self.interference


class Linear(ABC):
    """A cam that is linear in harmonics of its support function and in the shaft's place."""

    @property
    @abstractmethod
    def shaft(self) -> tuple[float, float]:
        """The shaft in the axes in which the cam is given, mm."""

    @abstractmethod
    def about_origin(self) -> Cam:
        """The same cam with its shaft at the origin of those axes."""

    @abstractmethod
    def harmonic(self, path: str) -> tuple[int, bool, float] | None:
        """Order, whether of a sine, and scale of the harmonic whose size stands at a path; order 0 for the mean."""

    @abstractmethod
    def silent(self, orders: set[tuple[int, bool]]) -> Cam:
        """The same cam without these harmonics (order, whether of a sine)."""


class ExactCam(ABC):
    """What a cam is once its motion is known; figures are found where they are asked for, and once.

    Raises IntentError, with the field below `cam` that is at fault, where a guide or a face cannot follow the motion.
    """

    if TYPE_CHECKING:  # fields, which abstract properties would be the defaults of

        @property
        def cam(self) -> Cam:
            """The cam as far as its own lengths are drawn."""

        @property
        def law(self) -> Lift | Displacement | Transmission:
            """The law of the motion: nobody asks of which kind it is."""

    @property
    @abstractmethod
    def follower(self) -> Follower:
        """The follower that the motion calls for."""

    @property
    @abstractmethod
    def motion(self) -> Position:
        """The follower's position and the parameters of its contacts over the shaft angle."""

    @property
    @abstractmethod
    def surfaces(self) -> tuple[Surface, ...]:
        """Every surface that the follower touches, in the order of reports."""

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """What kin judges surfaces by, each by its name: a follower made of the same contacts by kin's own means."""
        return self._followers(self.follower.contacts)

    @cached_property
    def running(self) -> dict[str, Gauge]:
        """The follower itself on each surface, where gauges are wider; empty where they are not."""
        follower = self.follower
        contacts = [replace(contact, touch=follower.running(contact)) for contact in follower.contacts]
        return {} if tuple(contacts) == follower.contacts else self._followers(contacts)

    def _followers(self, contacts: Sequence[Contact[Guide, Touch]]) -> dict[str, Gauge]:
        from kin.follower.follower import followers_of

        return followers_of(contacts, self.judged_law, {surface.name: surface.side for surface in self.surfaces})

    @property
    def gauge(self) -> Gauge:
        """What kin judges the first surface by."""
        return self.gauges[self.surfaces[0].name]

    @property
    @abstractmethod
    def judged_law(self) -> Piecewise | Transmission:
        """The law as kin's followers take it."""

    @property
    def breaks(self) -> Array:
        """Parameters of the law at which a derivative may jump, rising."""
        return self.law.breaks

    @property
    def rounding(self) -> float:
        """By how much the law may be off through the rounding of a recipe's own formula; 0 where there is none."""
        return self.law.rounding

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Where derivatives of the motion that a recipe gives jump; displacements in mm or rad."""
        return ()

    @property
    def kept(self) -> Kept | None:
        """How the motion keeps the rows of the recipe's table, mm or rad; None without a table."""
        return self.cam.kept()

    def circles(self, surface: str) -> tuple[Circle, ...]:  # noqa: ARG002 - most have one disc
        """Circles about the shaft for a drawing of the disc with a surface."""
        return self.cam.circles()

    def steepest(self, surface: Surface) -> tuple[Extreme, Extreme] | None:
        """Greatest tangents of a surface's pressure angle on the follower's rise and return; None of none proved."""
        slope = surface.extremes("slope")
        if slope is None:
            return None
        least, most = slope
        down = replace(least, value=-least.value)
        return (most, down) if self.follower.sense(surface.name) > 0 else (down, most)

    @property
    def gap(self) -> float:
        """Axial gap between discs on the shaft, mm."""
        return 0.0

    @property
    def margins(self) -> list[Margin]:
        """How far the motion is from where it would not exist."""
        return []

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """How checks of the motion that hang on its law are made, by their names."""
        return {}

    @property
    def free(self) -> bool:
        """Whether nothing undercuts it, whatever the motion: a parallel outside a convex surface."""
        return False

    @property
    def preload(self) -> Preload | None:
        """The interference that its contacts have, None of those that have none."""
        return None

    @property
    def plate(self) -> Lift | None:
        """Support function of a plate that a linkage can carry, None of other cams."""
        return None

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:  # noqa: ARG002
        """Say which size keeps the pressure angle below two angles, rad, with the cam; None where none is known."""
        return None

    def rounder_pitch(self, surface: str, mm: float) -> str:  # noqa: ARG002
        """Say what makes a surface's roller half the pitch curve's least convex radius; empty where nothing rolls."""
        return ""

    @abstractmethod
    def grown(self, out: float, scale: float) -> ExactCam:
        """The cam with its metal grown by `out` mm and then scaled, by the motion that its follower then feels.

        Raises GrownError where the follower would be nothing.
        """


class Cam(ABC):
    """A cam of a recipe, checked and converted: lengths in mm, angles in radians. Its fields are its family's own."""

    kind: ClassVar[str]
    undercut: Undercut

    @property
    @abstractmethod
    def arrangement(self) -> Arrangement:
        """Guide, touch and greatest number of contacts: units, and what figures may be taken."""

    if TYPE_CHECKING:  # a field of some families, which an abstract property would be the default of

        @property
        def touch(self) -> Touch:
            """What touches the cam."""

    @property
    def side(self) -> Side:
        """On which side of the contour the metal lies: 1 inside, -1 outside, as of a ring."""
        return 1

    @abstractmethod
    def exact(self, *, framed: bool = False) -> ExactCam:
        """The cam by its motion, `framed` where a linkage carries it.

        Raises kin's IntentError with the field below `cam` that is at fault.
        """

    @property
    @abstractmethod
    def advice(self) -> Advice:
        """What would help."""

    def kept(self) -> Kept | None:
        """How the motion keeps the rows of the recipe's table, mm or rad; None without a table."""
        return None

    @property
    def motion_span(self) -> float:
        """Shaft angle, rad, over which a recipe gives the motion; that of the rest of the turn follows from it."""
        return TURN

    @property
    def linear(self) -> Linear | None:
        """The harmonics that the cam is linear in, None where it is given otherwise."""
        return None

    @property
    def by_linkage(self) -> bool:
        """Whether the lengths of the linkage shape the cam."""
        return False

    def in_frame(self, ground: float, rocker: float, side: float) -> Cam:  # noqa: ARG002
        """The cam told of the links that its square frame slides on (`kin.law.frame_swing`), mm."""
        return self

    @property
    def frame_swing(self) -> FrameSwing | None:
        """The law by which a recipe lets the frame swing over the shaft angle, if it gives one."""
        return None

    @property
    def sizes(self) -> Mapping[str, float]:
        """What was found in place of a size that the recipe leaves open, mm, by the keys below `cam` that take it."""
        return {}

    @property
    def open(self) -> Open | None:
        """Angles of its motion that are yet to be found, before there is an exact cam; None where all are given."""
        return None

    def with_motion(self, motion: MotionSource) -> Cam:
        """Give the same cam with another motion; raises TypeError for one that has no angle to be found."""
        raise TypeError(f"{self.kind}: no {motion}")

    def circles(self) -> tuple[Circle, ...]:
        """Circles about the shaft for a drawing to show."""
        return ()

    def refusing(self) -> Cam:
        """The same cam with undercut refused."""
        return replace(self, undercut="refuse")  # type: ignore[type-var]  # every family is a dataclass


@dataclass(frozen=True)
class Family:
    """How a family stands in a recipe.

    `table` has its keys; `check` notes the faults between them, `build` makes the cam of values without fault and the
    unit of length in mm. `variant` looks, where that decides, at the cam as written for the arrangement of it.
    `by_motion` are the keys by which it is given by a motion, None where it is not.
    """

    kind: str
    arrangement: Arrangement
    table: Table
    build: Callable[[Values, float], Cam]
    check: Callable[[Values, Reader], None]
    variant: Callable[[Node], Arrangement] | None = None
    by_motion: ByMotion | None = None

    def of(self, node: Node | None) -> Arrangement:
        """Give the arrangement of a cam as written, which says its units and what figures may be taken of it."""
        return self.variant(node) if self.variant and node is not None else self.arrangement
