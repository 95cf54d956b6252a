"""Sizes of a printable mechanism, mm: as a recipe gives them, or as they follow from the cam."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.rounding import downward, upward
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.keys import RequestedSizes

ROUNDING = 1.0 - 1e-9  # so that a least size that was reported, rounded, is not refused
STEP = 0.5  # mm: sizes that follow from the cam are multiples of it
LEAST_PIN = 3.0  # mm: a thinner pin breaks between its layers
MOST_PIN = 12.0  # mm: thick enough for any cam
THIN = 0.8  # mm: two lines of a common nozzle, the least wall that stands by itself
LINE = 0.4  # mm: one line of a nozzle, the least thickness of any body
LEAST_CLEARANCE = 1e-3  # mm: bodies are not made more finely


class BodyError(CamgeoError, ValueError):
    """A body that cannot be made, with the `field` of the recipe that is the cause, a message and a remedy.

    Message and remedy have names of `lengths`, mm, in braces, which are reported in the recipe's unit.
    """

    def __init__(self, field: str, message: str, remedy: str, **lengths: float) -> None:
        self.field, self._texts, self._lengths = field, (message, remedy), lengths
        super().__init__(self.texts()[0])

    def texts(self, mm: float = 1.0, units: str = "mm") -> tuple[str, str]:
        """Message and remedy, with lengths in the unit `units` of `mm` mm."""
        message, remedy = self._texts
        lengths = {name: f"{length / mm:.4g} {units}" for name, length in self._lengths.items()}
        bounds = dict(lengths)  # a remedy's bound is rounded to the side on which it helps
        for name, length in self._lengths.items():
            most = name == "most" or f"at most {{{name}}}" in remedy
            bounds[name] = f"{(downward if most else upward)(length / mm, 4)} {units}"
        return message.format(**lengths), remedy.format(**bounds)


@dataclass(frozen=True)
class Sizes:
    """The sizes that bodies share, mm, each as described for the same field of `RequestedSizes`."""

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
        """Diameter of a hole that runs on a pin, mm."""
        return self.pin + self.clearance

    @property
    def gap_each_side(self) -> float:
        """Half the running clearance, mm: the gap on either side of a body in the middle."""
        return 0.5 * self.clearance

    @property
    def boss(self) -> float:
        """Radius of the shoulder of a pin, mm."""
        return 0.5 * self.pin + self.wall

    @property
    def sunk(self) -> float:
        """Depth of the sink under the base in which the shaft's retainer turns, mm."""
        return self.clip + 2.0 * self.gap


def derive_sizes(
    request: RequestedSizes, reach: float, bore: float, roller: float | None = None, field: str = "cam.roller_radius"
) -> Sizes:
    """All sizes, mm; sizes that the recipe leaves open follow from the cam.

    `reach` is the cam's greatest radius, `bore` the bore's diameter, `roller` the rollers' radius, None without
    rollers, and `field` the recipe's key of that. Raises BodyError for sizes that are too small or do not fit together.
    """
    most = MOST_PIN if roller is None else roller  # the roller's wall is then a quarter of its diameter
    pin = request.pin or _round_up(min(max(0.11 * reach, LEAST_PIN), most))
    wall = request.wall or _round_up(max(2.0, 0.7 * pin))
    clip = request.clip or _round_up(max(2.0, 0.4 * pin))
    sizes = Sizes(
        clearance=request.clearance,
        gap=request.gap,
        press=request.press,
        space=request.space,
        pin=pin,
        bar=request.bar or pin + max(2.0 * wall, request.clearance + 2.0 * THIN),
        plate=request.plate or _round_up(clip + 2.0 * request.gap + max(3.0, 0.8 * pin)),
        link=request.link or max(pin, 4.0),
        wall=wall,
        clip=clip,
        knob=request.knob or _round_up(max(0.9 * reach, 1.6 * bore + 2.0 * wall)),
    )
    _check_sizes(sizes, bore)
    if roller is not None and roller - 0.5 * sizes.hole < THIN:
        most = 2.0 * (roller - THIN) - sizes.clearance
        remedy = "give a pin of at most {most}, or larger rollers" if most >= LEAST_PIN else "give larger rollers"
        cause = field if request.pin is None else "mechanism.pin"
        message = "a pin of {pin} leaves no wall in rollers of radius {roller}"
        raise BodyError(cause, message, remedy, pin=pin, roller=roller, most=most)
    return sizes


def require_clearance(clearance: float, field: str, off: float, own: str = "mechanism.clearance") -> None:
    """Raise BodyError for a clearance, mm, that is too fine, or that files with errors up to `off` mm may close.

    `own` is the recipe's key of the clearance, `field` the key of the files' tolerance. Facets of a hole and of its pin
    may each be `off` nearer to the other body, which is half the clearance away.
    """
    if clearance < LEAST_CLEARANCE:
        message, remedy = "{clearance} is finer than bodies are made", "give at least {least}"
        raise BodyError(own, message, remedy, clearance=clearance, least=LEAST_CLEARANCE)
    if 2.0 * off >= 0.5 * clearance:
        message = "two facing bodies, each within {off}, may come {both} nearer, and stand {play} apart"
        remedy = f"give a tolerance below {{most}}, or a {own} above {{such}}"
        lengths = {"off": off, "both": 2.0 * off, "play": 0.5 * clearance}
        raise BodyError(field, message, remedy, **lengths, most=0.25 * clearance, such=4.0 * off)


def _round_up(length: float) -> float:
    """The length rounded up to a multiple of STEP, mm."""
    return STEP * math.ceil(length / STEP - 1e-9)


def _check_sizes(s: Sizes, bore: float) -> None:
    """Raise BodyError for sizes that are too small by themselves or for one another; `bore` is a diameter, mm."""
    require_thickness("mechanism.pin", s.pin, THIN)
    for name, length in (("link", s.link), ("wall", s.wall), ("clip", s.clip)):
        require_thickness(f"mechanism.{name}", length)
    least = s.hole + 2.0 * THIN
    if s.bar < least * ROUNDING:
        raise BodyError("mechanism.bar", "too narrow for the hole of a pin", "give at least {least}", least=least)
    least = s.sunk + 2.0 * THIN
    if s.plate < least * ROUNDING:
        message = "too thin for the sink of the shaft's retainer"
        raise BodyError("mechanism.plate", message, "give at least {least}, or a thinner clip", least=least)
    if s.press >= min(s.pin, bore):
        raise BodyError("mechanism.press", "no hole is left", "give less, such as {such}", such=0.1)
    least = 1.2 * bore + 2.0 * THIN  # a square's corners reach farther than its width
    if s.knob < least * ROUNDING:
        raise BodyError("mechanism.knob", "does not reach beyond the bore", "give at least {least}", least=least)


def require_thickness(field: str, length: float, least: float = LINE) -> None:
    """Raise BodyError, at `field`, for a length below `least`, mm, which is too thin to be printed."""
    if length < least:
        message, remedy = "{length} is too thin to be printed", "give at least {least}"
        raise BodyError(field, message, remedy, length=length, least=least)
