"""Sizes of a printable mechanism: what a recipe gives, and what follows from the cam where it gives nothing; mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.rounding import downward, upward
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.keys import MechanismAsked

JUST = 1.0 - 1e-9  # a least size as it is reported, rounded, is not too small
HALF = 0.5  # mm: what follows from the cam is a multiple of it
LEAST_PIN = 3.0  # mm: a thinner one breaks between its layers
MOST_PIN = 12.0
THIN = 0.8  # mm: two lines of a common nozzle, the least wall that stands by itself
LINE = 0.4  # mm: one line of it, the least that any size of a body may be
LEAST_CLEARANCE = 1e-3  # mm: no body is made finer


class BodyError(CamgeoError, ValueError):
    """A body that cannot be made as asked: `field` of the recipe to blame, what is wrong, and what would do.

    Message and remedy name lengths, mm, in braces: they are reported in the recipe's unit.
    """

    def __init__(self, field: str, message: str, remedy: str, **lengths: float) -> None:
        self.field, self._texts, self._lengths = field, (message, remedy), lengths
        super().__init__(self.told()[0])

    def told(self, mm: float = 1.0, units: str = "mm") -> tuple[str, str]:
        """Give message and remedy in a unit of so many mm."""
        message, remedy = self._texts
        lengths = {name: f"{length / mm:.4g} {units}" for name, length in self._lengths.items()}
        bounds = dict(lengths)  # of a remedy, rounded to the side on which it helps
        for name, length in self._lengths.items():
            most = name == "most" or f"at most {{{name}}}" in remedy
            bounds[name] = f"{(downward if most else upward)(length / mm, 4)} {units}"
        return message.format(**lengths), remedy.format(**bounds)


@dataclass(frozen=True)
class Sizes:
    """Every size that bodies share, as `MechanismAsked` has them, and none of them None."""

    clearance: float
    gap: float
    press: float
    space: float
    pin: float
    bar: float
    plate: float
    link: float
    wall: float
    clip: float
    knob: float

    @property
    def hole(self) -> float:
        """Diameter of a hole that turns on a pin."""
        return self.pin + self.clearance

    @property
    def gap_each_side(self) -> float:
        """Half the running clearance: the gap on either side of a body that stands in the middle."""
        return 0.5 * self.clearance

    @property
    def boss(self) -> float:
        """Radius of what carries a pin where it is not a bar."""
        return 0.5 * self.pin + self.wall

    @property
    def sunk(self) -> float:
        """Depth of the sink under the base in which the shaft's retainer turns."""
        return self.clip + 2.0 * self.gap


def sizes_of(
    request: MechanismAsked, reach: float, bore: float, roller: float | None = None, field: str = "cam.roller_radius"
) -> Sizes:
    """Fill in what a recipe leaves open, for a cam of this reach from the shaft and this bore, and such rollers.

    `field` is where the recipe gives the rollers' radius.

    Raises BodyError where sizes do not go together.
    """
    most = MOST_PIN if roller is None else roller  # its wall is then a quarter of its diameter
    pin = request.pin or _half(min(max(0.11 * reach, LEAST_PIN), most))
    wall = request.wall or _half(max(2.0, 0.7 * pin))
    clip = request.clip or _half(max(2.0, 0.4 * pin))
    sizes = Sizes(
        clearance=request.clearance,
        gap=request.gap,
        press=request.press,
        space=request.space,
        pin=pin,
        bar=request.bar or pin + max(2.0 * wall, request.clearance + 2.0 * THIN),
        plate=request.plate or _half(clip + 2.0 * request.gap + max(3.0, 0.8 * pin)),
        link=request.link or max(pin, 4.0),
        wall=wall,
        clip=clip,
        knob=request.knob or _half(max(0.9 * reach, 1.6 * bore + 2.0 * wall)),
    )
    _go_together(sizes, bore)
    if roller is not None and roller - 0.5 * sizes.hole < THIN:
        most = 2.0 * (roller - THIN) - sizes.clearance
        remedy = "give a pin of at most {most}, or larger rollers" if most >= LEAST_PIN else "give larger rollers"
        blamed = field if request.pin is None else "mechanism.pin"
        message = "a pin of {pin} leaves no wall in rollers of radius {roller}"
        raise BodyError(blamed, message, remedy, pin=pin, roller=roller, most=most)
    return sizes


def runs(clearance: float, field: str, off: float, own: str = "mechanism.clearance") -> None:
    """Refuse a clearance, `own` in the recipe, that files within `off` mm would eat up; `field` asks for that.

    Facets of a hole and of its pin may each be `off` nearer to the other, which stands half the clearance away.
    Raises BodyError.
    """
    if clearance < LEAST_CLEARANCE:
        message, remedy = "{clearance} is finer than bodies are made", "give at least {least}"
        raise BodyError(own, message, remedy, clearance=clearance, least=LEAST_CLEARANCE)
    if 2.0 * off >= 0.5 * clearance:
        message = "two facing bodies, each within {off}, may come {both} nearer, and stand {play} apart"
        remedy = f"give a tolerance below {{most}}, or a {own} above {{such}}"
        lengths = {"off": off, "both": 2.0 * off, "play": 0.5 * clearance}
        raise BodyError(field, message, remedy, **lengths, most=0.25 * clearance, such=4.0 * off)


def _half(length: float) -> float:
    """Round up to whole halves of a millimetre."""
    return HALF * math.ceil(length / HALF - 1e-9)


def _go_together(s: Sizes, bore: float) -> None:
    for name, length, least in (
        ("pin", s.pin, THIN),
        ("link", s.link, LINE),
        ("wall", s.wall, LINE),
        ("clip", s.clip, LINE),
    ):
        thick(f"mechanism.{name}", length, least)
    least = s.hole + 2.0 * THIN
    if s.bar < least * JUST:
        raise BodyError("mechanism.bar", "too narrow for the hole of a pin", "give at least {least}", least=least)
    least = s.sunk + 2.0 * THIN
    if s.plate < least * JUST:
        message = "too thin for the sink of the shaft's retainer"
        raise BodyError("mechanism.plate", message, "give at least {least}, or a thinner clip", least=least)
    if s.press >= min(s.pin, bore):
        raise BodyError("mechanism.press", "no hole is left", "give less, such as {such}", such=0.1)
    least = 1.2 * bore + 2.0 * THIN  # a square's corners reach farther than its width
    if s.knob < least * JUST:
        raise BodyError("mechanism.knob", "does not reach beyond the bore", "give at least {least}", least=least)


def thick(field: str, length: float, least: float = LINE) -> None:
    """Refuse what is too thin to be printed. Raises BodyError."""
    if length < least:
        raise BodyError(
            field, "{length} is too thin to be printed", "give at least {least}", length=length, least=least
        )
