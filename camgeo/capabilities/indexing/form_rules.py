"""Rules between the keys of a recipe that differ from one form of indexing cam to the other, and its turret.

Values are those of a recipe whose single keys are without fault; lengths in mm, angles in rad.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from camgeo.capabilities.indexing.forms import LEAST_ROLLER, Barrel, Globoid
from camgeo.capabilities.indexing.keys import FLOOR_GAP
from camgeo.capabilities.indexing.turrets import LESS, BarrelTurret, GloboidTurret, Roller, reaching
from camgeo.common.rounding import downward, upward

if TYPE_CHECKING:
    from typing import Literal

    from camgeo.capabilities.indexing.turrets import Turret
    from camgeo.schema.reader import Reader, Values

NOTHING = 1e-9  # mm: a length below it is none
APART = 0.8  # of the distance in a globoid's throat from a roller's axis to the next one, that a roller may fill
STEEPEST_END = math.sin(math.radians(80.0))  # of a globoid's end face, seen from the turret's axis


def rules_of(values: Values, reader: Reader) -> FormRules:
    """Rules of the form of cam that a recipe gives."""
    return next(rules for rules in (BarrelRules, GloboidRules) if rules.key in values["cam"])(values, reader)


class FormRules(ABC):
    """Rules of one form of cam; faults are noted in the reader."""

    key: ClassVar[str]  # of the form, in `cam`
    size: ClassVar[str]  # size of the cam by which the least roller is judged, in messages
    larger: ClassVar[str]  # key whose increase makes room for larger rollers

    def __init__(self, values: Values, reader: Reader) -> None:
        self.reader = reader
        self.cam, self.length = values["cam"], values["part"]["length"]
        self.form, self.turret = self.cam[self.key], self.cam["turret"]

    @abstractmethod
    def check_keys(self) -> None:
        """Note keys of the turret that this form lacks or needs."""

    @abstractmethod
    def built(self) -> Turret:
        """The turret, with the form of the cam beside it; after `check_keys` has found no fault."""

    @abstractmethod
    def check_form(self) -> None:
        """Note a floor that the rollers do not pass, and ends of the cam beyond its form."""

    @abstractmethod
    def _reaches_floor(self, roller: Roller, turret: Turret) -> bool:
        """Whether a roller reaches the floor, which is then noted."""

    @abstractmethod
    def _room(self, roller: Roller) -> float:
        """Radius, mm, at which neighbouring rollers touch one another."""

    def roller(self, turret: Turret) -> Roller:
        """The roller, which bears from `from` to `to`, or as far as is usual for the turret."""
        given = self.turret
        inner, outer = turret.usual(given["roller"])
        return Roller(given["roller"], given.get("from", inner), given.get("to", outer))

    def check_roller(self) -> None:
        """Note rollers that reach the floor, bear nowhere, are too small, or stand in one another's way."""
        reader, given, path, turret = self.reader, self.turret, "cam.turret", self.built()
        roller, (low, high) = self.roller(turret), self._reach(turret)
        if not self._reaches_floor(roller, turret) and not min(roller.outer, high) > max(roller.inner, low):
            last, begin = high if "to" in given else roller.outer, max(low, roller.inner)
            if "from" in given and low < last and not low <= roller.inner < last:
                at, remedy = f"{path}.from", _bearing(low, last, reader)
            elif "to" in given and begin < high:
                at, remedy = f"{path}.to", _bearing(begin, high, reader)
            else:
                at, remedy = "cam.depth", f"give more than {more(FLOOR_GAP + self._rim(roller), reader)}"
            reader.fault_at(at, "the roller bears nowhere", None, remedy)
        room = self._room(roller)
        if not roller.radius < room:
            problem = "neighbouring rollers of the turret touch one another"
            remedy = f"give less than {less(room, reader)}, or fewer stops"
            reader.fault_at(f"{path}.roller", problem, reader.shown(roller.radius), remedy)
        least = turret.form.least_roller
        if roller.radius < least:
            problem = f"too small beside the cam: it is less than {100.0 * LEAST_ROLLER:g} percent of {self.size}"
            remedy = f"give at least {more(least, reader)}" + ("" if least < room else f", with a larger {self.larger}")
            reader.fault_at(f"{path}.roller", problem, reader.shown(roller.radius), remedy)

    @abstractmethod
    def _reach(self, turret: Turret) -> tuple[float, float]:
        """Least and greatest place along a roller, mm, between which it may touch the metal."""

    def _rim(self, roller: Roller) -> float:  # noqa: ARG002 - of a globoid alone
        """By how much the rim of a roller that begins at the blank reaches deeper than the blank, mm."""
        return 0.0

    @property
    def _largest(self) -> float:
        """The larger radius of a roller, mm, of those of both flanks."""
        return float(self.turret["roller"] + self.turret.get("clearance", 0.0))

    @property
    def _common(self) -> dict[str, Any]:
        """Sizes that both forms have."""
        height = float(self.turret.get("height", 0.5 * self.length))
        return {"radius": self.form["radius"], "depth": self.cam["depth"], "height": height, "length": self.length}


class BarrelRules(FormRules):
    """Rules of a barrel."""

    key, size, larger = "barrel", "the blank's radius", "turret.radius"

    def check_keys(self) -> None:
        """Note a missing radius of the turret."""
        if "radius" not in self.turret:
            mark, remedy = self.reader.marks["cam.turret"], "give the distance of the rollers' axes from the turret's"
            self.reader.fault(mark, "cam.turret.radius", "missing, needed with a barrel", None, remedy)

    def built(self) -> Turret:
        """A turret beside a barrel."""
        side: Literal[-1, 1] = -1 if self.turret.get("side") == "leading" else 1
        pitch = self.turret["radius"]
        usual = 0.5 * side * pitch * (1.0 + math.cos(math.pi / self.turret["stops"]))
        return BarrelTurret(Barrel(offset=self.form.get("offset", usual), pitch=pitch, side=side, **self._common))

    def check_form(self) -> None:
        """Note a floor that is too near to the axis."""
        reader, depth, most = self.reader, self.cam["depth"], self.form["radius"] - self._largest
        if not depth < most:
            problem = "the floor is no farther from the axis than the radius of the roller"
            remedy = f"give less than {less(most, reader)}, or a smaller roller"
            remedy = remedy if most > NOTHING else "give a smaller roller, or a larger blank"
            reader.fault_at("cam.depth", problem, reader.shown(depth), remedy)

    def _reach(self, turret: Turret) -> tuple[float, float]:
        return turret.form.floor, turret.form.blank

    def _reaches_floor(self, roller: Roller, turret: Turret) -> bool:
        floor = turret.form.floor
        if roller.inner > floor:
            return False
        reader, problem = self.reader, "the roller's end stands on the floor"
        remedy = f"give more than {reader.shown(floor)}, or a greater depth"
        reader.fault_at("cam.turret.from", problem, reader.shown(roller.inner), remedy)
        return True

    def _room(self, roller: Roller) -> float:
        del roller
        return float(self.turret["radius"] * math.sin(math.pi / self.turret["stops"]))


class GloboidRules(FormRules):
    """Rules of a globoid."""

    key, size, larger = "globoid", "the distance of both axes", "globoid.radius"

    def check_keys(self) -> None:
        """Note keys of a barrel's turret."""
        for key, why in (("radius", "its rollers are radial"), ("side", "it has no side")):
            if key in self.turret:
                remedy = f"leave it out: {why}"
                self.reader.fault_at(f"cam.turret.{key}", "does not go with a globoid", None, remedy)

    def built(self) -> Turret:
        """A turret beside a globoid."""
        return GloboidTurret(Globoid(distance=self.form["distance"], **self._common))

    def check_form(self) -> None:
        """Note a globoid without a core, and one whose ends lie beside its throat."""
        reader, form, height = self.reader, self.form, self._common["height"]
        least = form["radius"] + self.cam["depth"] + self._largest
        if not form["distance"] > least:
            problem = "the floor is no farther from the cam's axis than the radius of the roller"
            remedy = f"give more than {more(least, reader)}, or a smaller globoid.radius or depth"
            reader.fault_at("cam.globoid.distance", problem, reader.shown(form["distance"]), remedy)
        most = STEEPEST_END * form["radius"]
        if self.length < 2.0 * most and not max(height, self.length - height) < most:
            problem = "an end of the cam lies beside the throat, which is an arc about the turret's axis"
            remedy = f"give one between {reader.shown(self.length - LESS * most)} and {reader.shown(LESS * most)}"
            reader.fault_at("cam.turret.height", problem, reader.shown(height), remedy)
        elif not self.length < 2.0 * most:
            problem = "the ends of the cam lie beside the throat, which is an arc about the turret's axis"
            remedy = f"give less than {less(2.0 * most, reader)}, with the turret's axis in the middle of it"
            reader.fault_at("part.length", problem, reader.shown(self.length), remedy)

    def _reach(self, turret: Turret) -> tuple[float, float]:
        return turret.form.blank, reaching(turret.form.floor, self.turret["roller"])

    def _reaches_floor(self, roller: Roller, turret: Turret) -> bool:
        _, floor = self._reach(turret)
        if "to" not in self.turret or roller.outer < floor:
            return False
        reader, problem = self.reader, "the rim of the roller's end stands on the floor"
        remedy = f"give less than {less(floor, reader)}, or a greater depth"
        reader.fault_at("cam.turret.to", problem, reader.shown(roller.outer), remedy)
        return True

    def _room(self, roller: Roller) -> float:
        half = math.pi / self.turret["stops"]
        throat = APART * self.form["radius"] * math.sin(min(2.0 * half, 0.5 * math.pi))
        return float(min(roller.inner * math.sin(half), throat))

    def _rim(self, roller: Roller) -> float:
        blank = self.form["radius"]
        return float(math.hypot(max(blank, roller.inner), roller.radius) - blank)


def _bearing(low: float, high: float, reader: Reader) -> str:
    return f"let it bear between {reader.shown(low)} and {less(high, reader)}"


def less(value: float, reader: Reader) -> str:
    """A length a little below a bound, mm, in the recipe's unit."""
    return f"{downward(value / reader.mm, 5)} {reader.units}"


def more(value: float, reader: Reader) -> str:
    """A length a little above a bound, mm, in the recipe's unit."""
    return f"{upward(value / reader.mm, 5)} {reader.units}"
