"""Turrets of both forms of indexing cams: where their rollers are in touch with the cam, and what they take out."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

import numpy as np

from camgeo.curve.ring import Ring, box, disc
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.indexing.forms import Form
    from kin.numeric.arrays import Array

ARC = 24  # chords of an arc in a drawing
HUB = 0.6  # of the pitch radius: a turret's hub in a drawing
LESS = 0.999  # of a greatest length, in a remedy


class Drawn(NamedTuple):
    """A turret before its cam, seen along the turret's axis, mm: the blank, the turret's centre, hub and rollers.

    Hub and rollers are in the turret's own axes, which turn with its angle where `way` is 1, against it where -1.
    """

    blank: Ring
    centre: tuple[float, float]
    hub: Ring
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


@dataclass(frozen=True)
class Turret(ABC):
    """A turret whose axis stands at a `height`, mm, over the cam's lower face."""

    word: ClassVar[str]  # its name in reports
    about: ClassVar[str]  # whose axis the layers are about
    unrolls: ClassVar[bool]  # whether its layers are cylinders, which have developments
    height: float

    @property
    @abstractmethod
    def sizes(self) -> dict[str, float]:
        """Sizes that place it, mm, by their names in reports."""

    @abstractmethod
    def core(self, floor: float) -> float:
        """Radius about the cam's axis, mm, of what is left within a floor where that is thinnest."""

    @abstractmethod
    def across(self, w: Array, h: Array) -> Array:
        """Area below a height h in a layer w by the radian of the polar angle, mm^2, up to a constant of the layer."""

    @abstractmethod
    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:
        """Angles, rad, between which a roller of a radius, mm, touches a cam of a `length`, mm.

        They are nan where a roller never leaves it at an end.
        """

    @abstractmethod
    def misled(
        self, radius: float, inner: float, layers: tuple[float, float], length: float, shown: Callable[[float], str]
    ) -> tuple[str, str, str] | None:
        """Field, problem and remedy where rollers do not leave the cam at its ends, or meet it on their way back.

        The rollers have a radius and begin at `inner`; the track lies between two layers, all mm. `shown` writes a
        length, mm, in the recipe's unit. None where there is no such problem.
        """

    @abstractmethod
    def whole(self, blank: float, length: float) -> float:
        """Volume, mm^3, of a blank of a layer and a length, mm."""

    @abstractmethod
    def drawn(self, blank: float, length: float, roller: Roller, stops: int, sense: float) -> Drawn:
        """Shapes to look at, of a blank, mm, and so many rollers; `sense` -1 of a cam that is mirrored."""

    @abstractmethod
    def intended(self, radius: float, depth: float) -> Form:
        """The form in kin's words, of a blank of a radius with a track of a depth, mm."""


@dataclass(frozen=True)
class BarrelTurret(Turret):
    """A turret with rollers parallel to its axis at the distance `pitch`, mm, from it.

    Its axis is parallel to a radius of the cam, at the distance `offset`, mm, along e_t from it. `side` is 1 for a
    trailing turret, -1 for a leading one: the roller stands at offset - side pitch cos psi.
    """

    word: ClassVar[str] = "barrel"
    about: ClassVar[str] = "the cam"
    unrolls: ClassVar[bool] = True
    pitch: float
    offset: float
    side: Literal[-1, 1]

    @property
    def sizes(self) -> dict[str, float]:
        """Pitch radius of the rollers, and offset."""
        return {"pitch_radius": self.pitch, "offset": self.offset}

    def core(self, floor: float) -> float:
        """The floor's own radius."""
        return floor

    def across(self, w: Array, h: Array) -> Array:
        """Area of a cylinder."""
        return np.asarray(w * h)

    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:  # noqa: ARG002
        """Angles at which a whole roller is beyond either face."""
        low, high = -self.height - radius, length - self.height + radius
        if not max(-low, high) < self.pitch:
            return math.nan, math.nan
        return math.asin(low / self.pitch), math.asin(high / self.pitch)

    def misled(
        self, radius: float, inner: float, layers: tuple[float, float], length: float, shown: Callable[[float], str]
    ) -> tuple[str, str, str] | None:
        """Problem of rollers that turn back within the cam, stand far off its radius, or meet it behind the turret."""
        floor, blank = layers
        room, away = LESS * floor, self.side * self.offset
        ends = self.spanned(radius, blank, length)
        near = self.pitch - away  # how far the roller in the middle stands off a radius
        if not abs(near) < room:
            low, high = self.pitch - room, self.pitch + room
            sides = sorted((self.side * low, self.side * high))
            problem = f"the roller's axis stands {shown(abs(near))} off a radius of the cam, past the floor's edge"
            return "cam.barrel.offset", problem, f"give one between {shown(sides[0])} and {shown(sides[1])}"
        farthest = (away - room) / self.pitch  # the least cosine up to which a roller may be led
        steepest = math.acos(max(farthest, 0.0)) if farthest < 1.0 else 0.0
        if not max(-ends[0], ends[1]) < steepest:  # nor where it is nan
            most = 2.0 * (self.pitch * math.sin(steepest) - radius)
            problem = "the rollers stand past the floor's edge before they leave the cam at its ends"
            lowest, highest = length - 0.5 * most * LESS, 0.5 * most * LESS
            if lowest < highest:  # as long as it is, with the turret's axis elsewhere
                return "cam.turret.height", problem, f"give one between {shown(lowest)} and {shown(highest)}"
            remedy = f"give less than {shown(most * LESS)}, with the turret's axis in the middle of it"
            return "part.length", problem, remedy if most > 0.0 else "give a smaller roller"
        behind = away + self.pitch * math.cos(max(-ends[0], ends[1])) - radius
        if not behind > math.sqrt(max(blank * blank - inner * inner, 0.0)):
            problem = "the rollers meet the cam on their way back, behind the turret's axis"
            return "cam.turret.radius", problem, "give a larger one with an offset that is larger by as much"
        return None

    def whole(self, blank: float, length: float) -> float:
        """Volume of a cylinder."""
        return math.pi * blank * blank * length

    def drawn(self, blank: float, length: float, roller: Roller, stops: int, sense: float) -> Drawn:
        """The barrel as a rectangle, ends of rollers as discs."""
        angles = TURN * np.arange(stops) / stops
        places = self.pitch * np.column_stack([np.cos(angles), np.sin(angles)])
        return Drawn(
            box(-blank, 0.0, blank, length),
            (sense * self.offset, self.height),
            disc(0.0, 0.0, HUB * self.pitch),
            tuple(disc(x, y, roller.radius) for x, y in places.tolist()),
            -self.side * round(sense),
        )

    def intended(self, radius: float, depth: float) -> Form:
        """Kin's barrel."""
        from kin.indexing.intent import Barrel

        return Barrel(radius, depth, self.offset, self.pitch, self.side)


@dataclass(frozen=True)
class GloboidTurret(Turret):
    """A turret with radial rollers, whose axis is square to the cam's at the distance `distance`, mm."""

    word: ClassVar[str] = "globoid"
    about: ClassVar[str] = "the turret"
    unrolls: ClassVar[bool] = False
    distance: float

    @property
    def sizes(self) -> dict[str, float]:
        """Distance of both axes."""
        return {"distance": self.distance}

    def core(self, floor: float) -> float:
        """What is left in the plane through both axes."""
        return self.distance - floor

    def across(self, w: Array, h: Array) -> Array:
        """Area of a torus: w (C h - w sin h)."""
        return np.asarray(w * (self.distance * h - w * np.sin(h)))

    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:
        """Angles at which the near side of a whole roller is beyond either face."""
        reach, more = math.hypot(blank, radius), math.atan(radius / blank)
        return math.asin(-self.height / reach) - more, math.asin((length - self.height) / reach) + more

    def misled(
        self,
        radius: float,  # noqa: ARG002 - all matter for a barrel
        inner: float,  # noqa: ARG002
        layers: tuple[float, float],  # noqa: ARG002
        length: float,  # noqa: ARG002
        shown: Callable[[float], str],  # noqa: ARG002
    ) -> tuple[str, str, str] | None:
        """No problem: rollers leave a globoid outwards, and are far from it behind the turret's axis."""
        return None

    def whole(self, blank: float, length: float) -> float:
        """Volume of a body between two planes, hollowed out by a torus."""

        def upto(z: float) -> float:
            root = math.sqrt(blank * blank - z * z)
            half = 0.5 * (z * root + blank * blank * math.asin(z / blank))
            c = self.distance
            return math.pi * ((c * c + blank * blank) * z - z**3 / 3.0 - 2.0 * c * half)

        return upto(length - self.height) - upto(-self.height)

    def drawn(self, blank: float, length: float, roller: Roller, stops: int, sense: float) -> Drawn:  # noqa: ARG002
        """The globoid as its outline, rollers from the side."""
        z = np.linspace(0.0, length, ARC + 1)
        r = self.distance - np.sqrt(blank * blank - (z - self.height) ** 2)
        outline = np.concatenate([np.column_stack([r, z]), np.column_stack([-r[::-1], z[::-1]])])
        low, high, half = roller.inner, roller.outer, roller.radius
        corners = np.array([(low, -half), (high, -half), (high, half), (low, half)])
        rollers = []
        for angle in (TURN * np.arange(stops) / stops).tolist():
            c, s = math.cos(angle), math.sin(angle)
            rollers.append(Ring.through(corners @ np.array([[c, s], [-s, c]])))
        hub = disc(0.0, 0.0, 0.95 * roller.inner)
        return Drawn(Ring.through(outline), (self.distance, self.height), hub, tuple(rollers), -1)

    def intended(self, radius: float, depth: float) -> Form:
        """Kin's globoid."""
        from kin.indexing.intent import Globoid

        return Globoid(radius, depth, self.distance)
