"""What every family of cams gives: a recipe's cam that knows its motion, its follower, its exact curve and its advice.

The rest of the package asks a cam by these names and never which family it is of.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, TypeAlias

from camgeo.recipe.schema.fields import Field, Kind

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.position import Position
    from camgeo.curve.curve import Curve
    from camgeo.recipe.schema.fields import Table
    from camgeo.recipe.schema.reader import Reader, Values
    from kin.follower.follower import Follower as Judged
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission

Intent: TypeAlias = "Lift | Transmission"
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
    `roller_radius` inside the base (0 for flat faces).
    """

    base: Curve
    curve: Curve
    roller_radius: float


@dataclass(frozen=True)
class Translating:
    """A guide along a line through the shaft."""


@dataclass(frozen=True)
class Oscillating:
    """An arm about a pivot: the distance of the pivot from the shaft, and from the pivot to what touches, mm."""

    pivot: float
    arm: float


@dataclass(frozen=True)
class Carried:
    """A frame that a linkage carries."""


@dataclass(frozen=True)
class Roller:
    """A roller of some radius, mm."""

    radius: float


@dataclass(frozen=True)
class Flat:
    """A flat face."""


Guide: TypeAlias = Translating | Oscillating | Carried
Touch: TypeAlias = Roller | Flat


@dataclass(frozen=True)
class Follower:
    """A guide, and what touches the disc.

    `name` is the one of reports; `checks` are those of its intended motion, in their order; `breadth` is how far two
    opposite faces are apart, mm, None for other followers.
    """

    name: str
    guide: Guide
    touches: tuple[Touch, ...]
    checks: tuple[str, ...]
    breadth: float | None = None


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


class GrownError(ValueError):
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
    undercut: Undercut

    less_steep: ClassVar[str] = SMALLER_SWING
    """What makes the motion less steep; empty where the recipe gives no stroke."""

    @property
    def touch_radius(self) -> float:
        """Radius of what touches the contour, mm: a roller's; 0 of a face."""
        return 0.0

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
    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:
        """What kin judges files by: the follower with its law; `breadth` is a yoke's, `face` that of a pair."""

    # --- advice -------------------------------------------------------------------------------------------------------

    @abstractmethod
    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Say what would be free of undercut; `free_at` (mm) is a roller's radius, or what radii must grow by."""

    @abstractmethod
    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Say what would raise the least radius of curvature from a value to a limit, in the recipe's unit."""

    def less_swing(self, mm: float) -> str:  # noqa: ARG002 - one family's words hang on the unit
        """Say how the follower comes to swing less; `mm` is the recipe's unit."""
        return "a smaller swing"

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
    unit of length in mm. `needs` are what figures may be taken of: roller, swings, plate.
    """

    cam: type[Cam]
    table: Table
    build: Callable[[Values, float], Cam]
    check: Callable[[Values, Reader], None]
    needs: frozenset[str]

    @property
    def kind(self) -> str:
        """Its name in a recipe."""
        return self.cam.kind
