"""Interfaces of every family of cams: the cam of a recipe, its exact form, and advice.

The rest of the package uses these names alone, whatever the family. `Cam` holds the data of a recipe; `ExactCam` is
that cam with its motion worked out. A parameter `mm` is the recipe's unit of length in mm, in which words show lengths.
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
    from camgeo.motions.by_motion import ByMotion
    from camgeo.motions.motion import MotionSource, Open
    from camgeo.motions.position import Position
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.follower.base import Follower as Gauge
    from kin.law.contacts import Arrangement, Contact, Guide, Side, Touch
    from kin.law.frame_swing import FrameSwing
    from kin.law.joints import DerivativeJump
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
    """A reference circle about the shaft in drawings, radius in mm; None for the curve's least distance from it."""

    name: str
    radius: float | None = None


class Margin(NamedTuple):
    """A distance from a limit of what is possible: name, value (0 at the limit), unit, and what happens there."""

    name: str
    value: float
    unit: str
    event: str


class GrownError(CamgeoError, ValueError):
    """Metal growth that leaves nothing of a follower's radius; its arguments are the radius's name and value, mm."""


class Proof(NamedTuple):
    """Result of a check of the motion: whether it holds, value and limit in a unit, and the shaft angle in degrees."""

    ok: bool
    value: float
    limit: float
    unit: str
    at_deg: float


@dataclass(frozen=True)
class Advice(ABC):
    """Remedies for failed checks, in the words of a recipe; the parameter `mm` is its unit of length, mm.

    gain                  ratio of the follower's error to the contour's, None where it varies
    least_pressure_angle  pressure angle without any motion, degrees: no smaller stroke stays below it
    larger                words for the size that lowers the pressure angle when it grows; empty without one
    less_steep            words for a motion that is less steep; empty where the recipe gives no stroke
    radius_field          name of the touch's radius in the words
    trims                 whether undercut may be cut off
    others                advice for surfaces that need their own, by the surfaces' names
    """

    gain: float | None = field(default=None, kw_only=True)
    least_pressure_angle: float = field(default=0.0, kw_only=True)
    larger: str = field(default="", kw_only=True)
    less_steep: str = field(default=SMALLER_SWING, kw_only=True)
    radius_field: str = field(default="roller radius", kw_only=True)
    trims: bool = field(default=True, kw_only=True)
    others: Mapping[str, Advice] = field(default_factory=dict, kw_only=True)

    def on(self, surface: str) -> Advice:
        """Advice for the surface of this name: its own among `others`, else this advice."""
        return self.others.get(surface, self)

    @property
    def radius(self) -> float:
        """Radius of a round touch, mm; 0 for other touches."""
        return 0.0

    @abstractmethod
    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a change of the cam that leaves no undercut.

        `free_at`, mm, is the largest roller radius without undercut, or under a flat face the growth of all radii of
        curvature that removes undercut.
        """

    @abstractmethod
    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Words for a change that brings the least radius of curvature to a limit; empty where no change is known.

        `value` is the least radius and `limit` its bound, both in `unit`, the recipe's. The least radius of a pitch
        curve has the roller's radius as its limit: a roller with a radius below `value` keeps it.
        """

    def same_pitch(self, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Words for what must change with the roller's radius to keep the pitch curve; empty where nothing must."""
        return ""

    @property
    def most_radius(self) -> float:
        """Least radius of a touch, mm, at which the same pitch curve has no base circle; infinite without one."""
        return math.inf

    def chosen_size(self, exact: ExactCam, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Words for the size that was chosen, and what bounds it; empty where the recipe gives the size."""
        return ""

    def wider_face(self, width: float, mm: float) -> str:  # noqa: ARG002 - a round tappet's has lengths of its own
        """Words for a follower.width of at least `width`, in the recipe's unit."""
        return f"a follower.width of {upward(width)}"

    def less_swing(self, mm: float) -> str:  # noqa: ARG002 - one family's words hang on the unit
        """Words for a smaller swing of the follower."""
        return "a smaller swing"


@dataclass(frozen=True)
class Preload:
    """Preload of two contacts: `interference`, mm, by which both together overlap the metal.

    `shares` are the first and the second contact's parts of the interference, with the sum 1. `stiffness`, N/m, is that
    of the first and the second contact along their normals; None where no force is wanted.
    """

    interference: float
    stiffness: tuple[float, float] | None = None
    shares: tuple[float, float] = (0.5, 0.5)

    @property
    def overlaps(self) -> tuple[float, float]:
        """Overlap of the first and the second contact with the metal, mm, at the follower's intended position."""
        first, second = self.shares
        return first * self.interference, second * self.interference


class Linear(ABC):
    """A cam as a linear function of harmonics of its support function and of the shaft's place."""

    @property
    @abstractmethod
    def shaft(self) -> tuple[float, float]:
        """Place of the shaft (x, y) in the axes of the support function, mm."""

    @abstractmethod
    def about_origin(self) -> Cam:
        """Copy of the cam with its shaft at the origin of the axes of the support function."""

    @abstractmethod
    def harmonic(self, path: str) -> tuple[int, bool, float] | None:
        """Harmonic that a field sets, by its path such as `cam.fourier.cos.3`; None for a field that sets none.

        It is the order (0 for the mean), whether it is a sine, and its coefficient per unit of the field's value.
        """

    @abstractmethod
    def without_harmonics(self, orders: set[tuple[int, bool]]) -> Cam:
        """Copy of the cam with the harmonics `orders`, (order, whether a sine), set to 0; the mean radius stays."""


class ExactCam(ABC):
    """A cam with its motion worked out; figures are computed on first use.

    Raises IntentError, with the field below `cam` that is at fault, where a guide or a face cannot follow the motion.
    """

    if TYPE_CHECKING:  # fields, which abstract properties would be the defaults of

        @property
        def cam(self) -> Cam:
            """The cam of the recipe; of grown metal a copy with the lengths that drawings show."""

        @property
        def law(self) -> Lift | Displacement | Transmission:
            """The law of the motion."""

    @property
    @abstractmethod
    def follower(self) -> Follower:
        """The follower for this motion."""

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
        """Followers by which kin judges files, by the name of the surface; made from the contacts alone."""
        return self._followers(self.follower.contacts)

    @cached_property
    def running(self) -> dict[str, Gauge]:
        """The real follower on each surface, where the gauges are wider than it; empty where they are not."""
        follower = self.follower
        contacts = [replace(contact, touch=follower.running(contact)) for contact in follower.contacts]
        return {} if tuple(contacts) == follower.contacts else self._followers(contacts)

    def _followers(self, contacts: Sequence[Contact[Guide, Touch]]) -> dict[str, Gauge]:
        from kin.follower.follower import followers_of

        return followers_of(contacts, self.judged_law, {surface.name: surface.side for surface in self.surfaces})

    @property
    def gauge(self) -> Gauge:
        """Follower by which kin judges files on the first surface."""
        return self.gauges[self.surfaces[0].name]

    @property
    @abstractmethod
    def judged_law(self) -> Piecewise | Transmission:
        """Law of the follower's motion over the shaft angle, by which kin judges the files."""

    @property
    def breaks(self) -> Array:
        """Parameters of the law, rad (n,), at which a derivative may jump, rising."""
        return self.law.breaks

    @property
    def rounding(self) -> float:
        """Rounding error of the law through a recipe's own formula, mm or rad; 0 without one."""
        return self.law.rounding

    @property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the recipe's motion, angles at which derivatives jump; displacements in mm or rad."""
        return ()

    @property
    def kept(self) -> Kept | None:
        """Record of how the motion keeps the rows of the recipe's table, mm or rad; None without a table or cam card.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        return self.cam.kept()

    def circles(self, surface: str) -> tuple[Circle, ...]:  # noqa: ARG002 - most have one disc
        """Reference circles in drawings of the disc with a surface."""
        return self.cam.circles()

    def steepest(self, surface: Surface) -> tuple[Extreme, Extreme] | None:
        """Greatest tangents of the pressure angle on the follower's rise and on its return, at shaft angles in rad.

        None for a surface without a series of the tangent.
        """
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
        """Distances of the motion from the limits beyond which it does not exist; empty for a family without them."""
        return []

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """Checks of the motion that depend on its law, by their names."""
        return {}

    @property
    def never_undercut(self) -> bool:
        """Whether no motion can make the contour undercut."""
        return False

    @property
    def preload(self) -> Preload | None:
        """Preload of the contacts, None without one."""
        return None

    @property
    def plate(self) -> Lift | None:
        """Support function of a plate that a linkage can carry; None for other cams."""
        return None

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:  # noqa: ARG002
        """A size in words and the cam of that size, whose pressure angle keeps both limits; None if unknown.

        The limits are `rising` on the rise and `falling` on the return, rad.
        """
        return None

    def rounder_pitch(self, surface: str, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Words for the size at which a surface's roller is half the pitch curve's least convex radius; else empty."""
        return ""

    @abstractmethod
    def grow(self, out: float, scale: float) -> ExactCam:
        """The cam with its metal grown by `out` mm along the normal, then all lengths times `scale`, with its motion.

        Raises GrownError where the growth leaves nothing of a roller or shoe.
        """


@dataclass(frozen=True, eq=False)
class AlteredCam(ExactCam):
    """A cam with other metal than the cam `nominal`, whose law, follower and intended motion it keeps."""

    nominal: ExactCam

    @property
    def cam(self) -> Cam:
        """The cam of the nominal exact cam."""
        return self.nominal.cam

    @property
    def law(self) -> Lift | Displacement | Transmission:
        """Law of the nominal motion."""
        return self.nominal.law

    @property
    def judged_law(self) -> Piecewise | Transmission:
        """Law of the nominal motion over the shaft angle, by which kin judges the files."""
        return self.nominal.judged_law

    @property
    def follower(self) -> Follower:
        """Follower of the nominal cam."""
        return self.nominal.follower

    @property
    def motion(self) -> Position:
        """Position of the follower in the nominal motion, over the shaft angle."""
        return self.nominal.motion

    @property
    def gap(self) -> float:
        """Axial gap between the discs of the nominal cam, mm."""
        return self.nominal.gap


class Cam(ABC):
    """A cam of a recipe, checked and converted: lengths in mm, angles in rad; each family has fields of its own."""

    kind: ClassVar[str]
    undercut: Undercut

    @property
    @abstractmethod
    def arrangement(self) -> Arrangement:
        """Guide, touch and greatest number of contacts; they decide units and figures."""

    if TYPE_CHECKING:  # a field of some families, which an abstract property would be the default of

        @property
        def touch(self) -> Touch:
            """The touch of the follower: a roller, shoe, knife edge or flat face."""

    @property
    def side(self) -> Side:
        """Side of the contour on which the metal lies: 1 inside, -1 outside (a ring)."""
        return 1

    @abstractmethod
    def exact(self, *, framed: bool = False) -> ExactCam:
        """The cam with its motion worked out; `framed` says that a linkage carries the follower.

        Raises kin's IntentError, with the field below `cam` that is at fault, for a motion that the cam cannot have.
        """

    @property
    @abstractmethod
    def advice(self) -> Advice:
        """Remedies in the words of the recipe."""

    def kept(self) -> Kept | None:
        """Record of how the motion keeps the rows of the recipe's table, mm or rad; None without a table or cam card.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        return None

    @property
    def stated_motion(self) -> MotionSource | None:
        """Motion as the recipe has it over `motion_span`; None where the recipe gives none."""
        return None

    @property
    def motion_span(self) -> float:
        """Shaft angle, rad, over which a recipe gives the motion; the rest of the turn follows from it."""
        return TURN

    @property
    def linear(self) -> Linear | None:
        """The cam as a linear function of harmonics; None for a cam that is no such function."""
        return None

    @property
    def by_linkage(self) -> bool:
        """Whether the lengths of the linkage shape the cam."""
        return False

    def in_frame(self, ground: float, rocker: float, side: float) -> Cam:  # noqa: ARG002 - the protocol's
        """The cam with the links on which its square frame slides; the cam itself where they do not shape it.

        `ground` is the distance of the fixed pivots and `rocker` the rocker's length less the offset of the slide's
        line, mm; `side` is 1 for the open assembly, -1 for the crossed one.
        """
        return self

    @property
    def frame_swing(self) -> FrameSwing | None:
        """The law by which the frame swings over the shaft angle; None where the recipe gives none."""
        return None

    @property
    def sizes(self) -> Mapping[str, float]:
        """Sizes chosen where the recipe leaves them open, mm, by their keys below `cam`."""
        return {}

    @property
    def open(self) -> Open | None:
        """Angles that the motion leaves open, to be settled before `exact`; None where all are given."""
        return None

    def with_motion(self, motion: MotionSource) -> Cam:
        """Copy of the cam with another motion; raises TypeError for a family that leaves no angle open."""
        raise TypeError(f"{self.kind}: no {motion}")

    def circles(self) -> tuple[Circle, ...]:
        """Reference circles about the shaft in drawings."""
        return ()

    def refusing_undercut(self) -> Cam:
        """Copy of the cam under which undercut is a failed check and is not cut off."""
        return replace(self, undercut="refuse")  # type: ignore[type-var]  # every family is a dataclass


@dataclass(frozen=True)
class Family:
    """A family in a recipe.

    `table` has its keys; `check` notes the faults between them, `build` makes the cam of values without fault and the
    unit of length in mm. `variant` gives the arrangement of a cam as written, where that decides. `by_motion` has the
    keys by which a recipe gives size and motion.
    """

    kind: str
    arrangement: Arrangement
    table: FieldTable
    build: Callable[[Values, float], Cam]
    check: Callable[[Values, Reader], None]
    by_motion: ByMotion
    variant: Callable[[Node], Arrangement] | None = None

    def of(self, node: Node | None) -> Arrangement:
        """Arrangement of the cam at a node of the recipe; the family's usual one for None or without `variant`."""
        return self.variant(node) if self.variant and node is not None else self.arrangement
