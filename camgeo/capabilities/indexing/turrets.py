"""Turrets of both forms of indexing cams: their names and pictures, and rollers that meet what they must not."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.keys import FLOOR_GAP
from camgeo.curve.ring import Ring, bar, disc
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.forms import Barrel, Globoid
    from kin.indexing.forms import Form

RIM = 1.5  # radii of a roller from its axis to the rim of a dial, in a drawing
HUB, SPOKE = 0.25, 0.4  # of the pitch radius, and of a roller's radius: hub and half width of spokes of a dial
GAP = 0.2  # radii of a roller between a blank and the plate before it
STUD, INNER_END = 0.7, 0.97  # of a roller's radius, and of the hub's: half width and inner end of the stud of a roller
LESS, MORE = 0.999, 1.01  # of a greatest or a least length, in a remedy
LEAST = 1e-3  # mm by which a remedy moves an axis at least


def reaching(layer: float, roller: float) -> float:
    """Distance of a roller's flat end from a globoid's turret, mm, whose rim reaches a layer, mm; 0 where none does."""
    return math.sqrt(max(layer * layer - roller * roller, 0.0))


class Drawn(NamedTuple):
    """A turret seen along its axis, mm: its centre, its body, its rim, and its rollers.

    Body, rim and rollers are in the turret's own axes, which turn with its angle where `way` is 1, against it where -1.
    """

    centre: tuple[float, float]
    body: tuple[Ring, ...]
    rim: Ring
    rollers: tuple[Ring, ...]
    way: int


@dataclass(frozen=True)
class Roller:
    """A cylindrical roller that bears from `inner` to `outer` along its axis, mm.

    These are distances from the axis of a barrel; of a globoid from that of its turret.
    """

    radius: float
    inner: float
    outer: float


class Bar(NamedTuple):
    """A round bar between two places (3,), mm, of a radius, mm."""

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    radius: float


class Standing(NamedTuple):
    """A turret as round bars: its body and its rollers, and its axis towards who looks along it, a unit vector.

    Bars are in the turret's own axes: to the right and up as it is seen, and towards the viewer.
    """

    body: tuple[Bar, ...]
    rollers: tuple[Bar, ...]
    axis: tuple[float, float, float]
    right: tuple[float, float, float]


@dataclass(frozen=True)
class Turret(ABC):
    """A turret beside a cam of its form, in words and pictures."""

    word: ClassVar[str]  # its name in reports
    about: ClassVar[str]  # whose axis the layers are about
    unrolls: ClassVar[bool]  # whether its layers are cylinders, which have developments
    facing: ClassVar[float]  # polar angle beside the shaft angle, rad, that faces who looks along the turret's axis
    form: Barrel | Globoid

    @property
    def height(self) -> float:
        """Height of its axis over the cam's lower face, mm."""
        return self.form.height

    @property
    @abstractmethod
    def sizes(self) -> dict[str, float]:
        """Sizes that place it, mm, by their names in reports."""

    @abstractmethod
    def fault(self, radius: float, shown: Callable[[float], str]) -> tuple[str, str, str] | None:
        """Field, problem and remedy where rollers do not leave the cam at its ends, or meet it on their way back.

        The rollers have a radius, mm. `shown` writes a length, mm, in the recipe's unit. None without such a problem.
        """

    @abstractmethod
    def drawn(self, roller: Roller, stops: int, sense: float) -> Drawn:
        """Shapes to look at, with so many rollers; `sense` -1 of a cam that is mirrored."""

    @abstractmethod
    def standing(self, roller: Roller, stops: int) -> Standing:
        """Bars to look at, of so many rollers."""

    @abstractmethod
    def usual(self, radius: float) -> tuple[float, float]:
        """Defaults of `from` and `to`, mm, between which rollers of a radius, mm, bear."""

    @abstractmethod
    def intended(self) -> Form:
        """Form of the intended cam, by which kin judges files."""


@dataclass(frozen=True)
class BarrelTurret(Turret):
    """A turret with rollers parallel to its axis, beside a barrel."""

    word: ClassVar[str] = "barrel"
    about: ClassVar[str] = "the cam"
    unrolls: ClassVar[bool] = True
    facing: ClassVar[float] = 0.0
    form: Barrel

    @property
    def sizes(self) -> dict[str, float]:
        """Pitch radius of the rollers, and offset."""
        return {"pitch_radius": self.form.pitch, "offset": self.form.offset}

    def fault(self, radius: float, shown: Callable[[float], str]) -> tuple[str, str, str] | None:
        """Problem of rollers that turn back within the cam, stand far off its radius, or meet it behind the turret."""
        form = self.form
        pitch, room, away = form.pitch, LESS * form.floor, form.side * form.offset
        near = pitch - away  # how far the roller in the middle stands off a radius
        if not abs(near) < room:
            low, high = pitch - room, pitch + room
            sides = sorted((form.side * low, form.side * high))
            problem = f"the roller's axis stands {shown(abs(near))} off a radius of the cam, past the floor's edge"
            return "cam.barrel.offset", problem, f"give one between {shown(sides[0])} and {shown(sides[1])}"
        farthest = (away - room) / pitch  # the least cosine up to which a roller may be led
        steepest = math.acos(max(farthest, 0.0)) if farthest < 1.0 else 0.0
        low, high = form.spanned(radius)
        end = max(-low, high)
        if not end < steepest:
            reach = pitch * math.sin(steepest)
            most = LESS * (reach - radius)  # half of a length
            problem = "the rollers stand past the floor's edge before they leave the cam at its ends"
            if not most > 0.0:
                return "cam.turret.roller", problem, f"give less than {shown(LESS * reach)}, and a short cam"
            lowest = form.length - most
            if lowest < most:  # as long as it is, with the turret's axis elsewhere
                return "cam.turret.height", problem, f"give one between {shown(lowest)} and {shown(most)}"
            remedy = f"give less than {shown(2.0 * LESS * most)}, with the turret's axis in the middle of it"
            return "part.length", problem, remedy
        # a roller comes back between the end faces at the angle pi - end, and then moves farther off
        lacking = form.radius + radius - away - pitch * math.cos(end)
        if not lacking < 0.0:
            problem = "the rollers meet the cam on their way back, behind the turret's axis"
            more = MORE * lacking / (1.0 + math.cos(end)) + MORE * LEAST
            offset = shown(form.side * (away + more))
            remedy = f"give {shown(pitch + more)}, and a barrel.offset of {offset}"
            return "cam.turret.radius", problem, remedy
        return None

    def drawn(self, roller: Roller, stops: int, sense: float) -> Drawn:
        """A dial with spokes, and the ends of its rollers as discs."""
        angles = TURN * np.arange(stops) / stops
        ways = np.column_stack([np.cos(angles), np.sin(angles)])
        places = (self.form.pitch * ways).tolist()
        ends = ((self.form.pitch - (1.0 + SPOKE) * roller.radius) * ways).tolist()
        spokes = tuple(bar((0.0, 0.0), (x, y), 2.0 * SPOKE * roller.radius) for x, y in ends)
        return Drawn(
            (sense * self.form.offset, self.height),
            (*spokes, disc(0.0, 0.0, HUB * self.form.pitch)),
            disc(0.0, 0.0, self.form.pitch + RIM * roller.radius),
            tuple(disc(x, y, roller.radius) for x, y in places),
            -self.form.side * round(sense),
        )

    def standing(self, roller: Roller, stops: int) -> Standing:
        """A plate before the cam, from which the rollers' studs reach towards its axis."""
        angles = TURN * np.arange(stops) / stops
        places = (self.form.pitch * np.column_stack([np.cos(angles), np.sin(angles)])).tolist()
        near = max(roller.outer, self.form.blank) + GAP * roller.radius
        plate = Bar((0.0, 0.0, near), (0.0, 0.0, near + roller.radius), self.form.pitch + RIM * roller.radius)
        studs = tuple(Bar((x, y, roller.outer), (x, y, near), STUD * roller.radius) for x, y in places)
        rollers = tuple(Bar((x, y, roller.inner), (x, y, roller.outer), roller.radius) for x, y in places)
        return Standing((plate, *studs), rollers, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))

    def usual(self, radius: float) -> tuple[float, float]:
        """From just over the floor to the blank."""
        del radius
        return self.form.floor + FLOOR_GAP, self.form.blank

    def intended(self) -> Form:
        """Kin's barrel."""
        from kin.indexing.forms import Barrel as Intended

        form = self.form
        return Intended(form.radius, form.depth, form.offset, form.pitch, form.side)


@dataclass(frozen=True)
class GloboidTurret(Turret):
    """A turret with radial rollers, beside a globoid."""

    word: ClassVar[str] = "globoid"
    about: ClassVar[str] = "the turret"
    unrolls: ClassVar[bool] = False
    facing: ClassVar[float] = -0.5 * math.pi
    form: Globoid

    @property
    def sizes(self) -> dict[str, float]:
        """Distance of both axes."""
        return {"distance": self.form.distance}

    def fault(self, radius: float, shown: Callable[[float], str]) -> tuple[str, str, str] | None:  # noqa: ARG002
        """No problem: rollers leave a globoid outwards, and are far from it behind the turret's axis."""
        return None

    def drawn(self, roller: Roller, stops: int, sense: float) -> Drawn:  # noqa: ARG002 - it is its own mirror image
        """A wheel with studs, and its rollers from the side."""

        def across(low: float, high: float, half: float, angle: float) -> Ring:
            corners = np.array([(low, -half), (high, -half), (high, half), (low, half)])
            c, s = math.cos(angle), math.sin(angle)
            return Ring.through(corners @ np.array([[c, s], [-s, c]]))

        angles = (TURN * np.arange(stops) / stops).tolist()
        low, high, half = roller.inner, roller.outer, roller.radius
        hub = low - half
        studs = tuple(across(INNER_END * hub, low, STUD * half, angle) for angle in angles)
        return Drawn(
            (self.form.distance, self.height),
            (*studs, disc(0.0, 0.0, hub)),
            disc(0.0, 0.0, 0.5 * hub),
            tuple(across(low, high, half, angle) for angle in angles),
            -1,
        )

    def standing(self, roller: Roller, stops: int) -> Standing:
        """A wheel that stands in the throat, with radial studs."""
        half = roller.radius
        hub = min(roller.inner, self.form.blank) - half
        angles = (TURN * np.arange(stops) / stops).tolist()

        def radial(low: float, high: float, radius: float, angle: float) -> Bar:
            c, s = math.cos(angle), math.sin(angle)
            return Bar((low * c, low * s, 0.0), (high * c, high * s, 0.0), radius)

        wheel = Bar((0.0, 0.0, -half), (0.0, 0.0, half), hub)
        studs = tuple(radial(INNER_END * hub, roller.inner, STUD * half, angle) for angle in angles)
        rollers = tuple(radial(roller.inner, roller.outer, half, angle) for angle in angles)
        return Standing((wheel, *studs), rollers, (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))

    def usual(self, radius: float) -> tuple[float, float]:
        """From the blank to where the rim of the roller's end stands just off the floor."""
        return self.form.blank, reaching(self.form.floor - FLOOR_GAP, radius)

    def intended(self) -> Form:
        """Kin's globoid."""
        from kin.indexing.forms import Globoid as Intended

        return Intended(self.form.radius, self.form.depth, self.form.distance)
