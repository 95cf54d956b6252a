"""Turrets of both forms of indexing cams: their names and pictures, and rollers that meet what they must not."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from camgeo.curve.ring import Ring, box, disc
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.forms import Barrel, Globoid
    from kin.indexing.forms import Form

ARC = 24  # chords of an arc in a drawing
HUB = 0.6  # of the pitch radius: a barrel's turret's hub in a drawing
INSIDE = 0.95  # of the place where rollers begin: a globoid's
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
    """A turret beside a cam of its form, in words and pictures."""

    word: ClassVar[str]  # its name in reports
    about: ClassVar[str]  # whose axis the layers are about
    unrolls: ClassVar[bool]  # whether its layers are cylinders, which have developments
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
    def intended(self) -> Form:
        """The form in kin's words."""


@dataclass(frozen=True)
class BarrelTurret(Turret):
    """A turret with rollers parallel to its axis, beside a barrel."""

    word: ClassVar[str] = "barrel"
    about: ClassVar[str] = "the cam"
    unrolls: ClassVar[bool] = True
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
            most = 2.0 * (pitch * math.sin(steepest) - radius)
            problem = "the rollers stand past the floor's edge before they leave the cam at its ends"
            remedy = f"give less than {shown(most * LESS)}, with the turret's axis in the middle of it"
            return "part.length", problem, remedy if most > 0.0 else "give a smaller roller"
        # a roller comes back between the end faces at the angle pi - end, and then moves farther off
        if not away + pitch * math.cos(end) - radius > form.radius:
            problem = "the rollers meet the cam on their way back, behind the turret's axis"
            return "cam.turret.radius", problem, "give a larger one with an offset that is larger by as much"
        return None

    def drawn(self, roller: Roller, stops: int, sense: float) -> Drawn:
        """The barrel as a rectangle, ends of rollers as discs."""
        form, angles = self.form, TURN * np.arange(stops) / stops
        places = form.pitch * np.column_stack([np.cos(angles), np.sin(angles)])
        return Drawn(
            box(-form.radius, 0.0, form.radius, form.length),
            (sense * form.offset, form.height),
            disc(0.0, 0.0, HUB * form.pitch),
            tuple(disc(x, y, roller.radius) for x, y in places.tolist()),
            -form.side * round(sense),
        )

    def intended(self) -> Form:
        """Kin's barrel."""
        from kin.indexing.intent import Barrel as Intended

        form = self.form
        return Intended(form.radius, form.depth, form.offset, form.pitch, form.side)


@dataclass(frozen=True)
class GloboidTurret(Turret):
    """A turret with radial rollers, beside a globoid."""

    word: ClassVar[str] = "globoid"
    about: ClassVar[str] = "the turret"
    unrolls: ClassVar[bool] = False
    form: Globoid

    @property
    def sizes(self) -> dict[str, float]:
        """Distance of both axes."""
        return {"distance": self.form.distance}

    def fault(self, radius: float, shown: Callable[[float], str]) -> tuple[str, str, str] | None:  # noqa: ARG002
        """No problem: rollers leave a globoid outwards, and are far from it behind the turret's axis."""
        return None

    def drawn(self, roller: Roller, stops: int, sense: float) -> Drawn:  # noqa: ARG002 - both ways look alike
        """The globoid as its outline, rollers from the side."""
        form = self.form
        z = np.linspace(0.0, form.length, ARC + 1)
        r = form.distance - np.sqrt(form.radius * form.radius - (z - form.height) ** 2)
        outline = np.concatenate([np.column_stack([r, z]), np.column_stack([-r[::-1], z[::-1]])])
        low, high, half = roller.inner, roller.outer, roller.radius
        corners = np.array([(low, -half), (high, -half), (high, half), (low, half)])
        rollers = []
        for angle in (TURN * np.arange(stops) / stops).tolist():
            c, s = math.cos(angle), math.sin(angle)
            rollers.append(Ring.through(corners @ np.array([[c, s], [-s, c]])))
        hub = disc(0.0, 0.0, INSIDE * roller.inner)
        return Drawn(Ring.through(outline), (form.distance, form.height), hub, tuple(rollers), -1)

    def intended(self) -> Form:
        """Kin's globoid."""
        from kin.indexing.intent import Globoid as Intended

        return Intended(self.form.radius, self.form.depth, self.form.distance)
