"""Milling and grinding of the part, and compensation of files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple

from camgeo.recipe.extension import KEYS
from camgeo.schema.fields import Field, FieldTable, Kind, length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.extension import Alteration
    from camgeo.schema.reader import Reader, Values

INVERSE, BY_MINUTE = "inverse-time", "per-minute"  # feeds of a program for a machine that turns its work
LEAST_PLACES, MOST_PLACES = 2, 9  # decimals that a recipe may ask of such a program


@dataclass(frozen=True)
class Manufacture:
    """How the contour is milled: mm and rad. Fields that only a milling program needs may be None.

    cutter        diameter of the cutter
    feed, plunge  along the contour and downwards, mm a minute
    spindle       turns a minute
    depth_of_cut  greatest depth of a pass
    safe_height   above the stock, for fast moves
    lead_in       radius of the arcs of lead-in and lead-out; None for the cutter's radius
    allowance     metal left all round by all passes before a last one at full depth; None without such a pass
    start         direction in which the cutter is farthest out where it reaches the contour
    holes         whether round openings larger than the cutter are milled too
    unreached     greatest depth of metal that may remain where the cutter does not reach
    layer         whether a DXF shows the path of the cutter's centre
    """

    cutter: float
    feed: float | None = None
    plunge: float | None = None
    spindle: float | None = None
    depth_of_cut: float | None = None
    safe_height: float | None = None
    lead_in: float | None = None
    direction: Literal["climb", "conventional"] = "climb"
    allowance: float | None = None
    start: float = 0.0
    holes: bool = False
    unreached: float = 0.0
    layer: bool = False

    @property
    def radius(self) -> float:
        """Radius of the cutter, mm."""
        return 0.5 * self.cutter

    @property
    def lead(self) -> float:
        """Radius of the arcs of lead-in and lead-out, mm."""
        return self.radius if self.lead_in is None else self.lead_in


class Altered(NamedTuple):
    """A number other than its default that a file gives for the option `key` of a capability's `Alteration`.

    `beside` is the key and the word of the choice that goes with it, where that is not its default.
    """

    capability: str
    key: str
    value: float
    beside: tuple[str, str] | None = None


@dataclass(frozen=True)
class Compensation:
    """Compensation of a file's part: `kerf` (a cut's whole width) and `clearance` in mm, `shrinkage` as a share.

    A cut along the drawn lines takes half its width from the part, so the metal is drawn larger by that; clearance is
    taken from the metal all round. A part that shrinks is drawn larger by 1/(1 - shrinkage) about the shaft. `altered`
    has the changes that capabilities make to the contour, with their keys and values.
    """

    kerf: float = 0.0
    clearance: float = 0.0
    shrinkage: float = 0.0
    altered: tuple[Altered, ...] = ()

    @property
    def out(self) -> float:
        """Outward movement of the metal's edges, mm, before the part is scaled; below 0 inward."""
        return 0.5 * self.kerf - self.clearance

    @property
    def scale(self) -> float:
        """Factor by which the part is drawn larger."""
        return 1.0 / (1.0 - self.shrinkage)

    @property
    def tags(self) -> str:
        """Keys of the compensation as they stand in the name of a file, such as `clearance-shrinkage`."""
        own = [name for name in ("kerf", "clearance", "shrinkage") if getattr(self, name)]
        return "-".join([*own, *(altered.key for altered in self.altered)])

    def words(self, mm: float) -> str:
        """The compensation in words, such as `kerf 0.2, shrinkage 0.5 percent`, with lengths in a unit of `mm` mm."""
        parts = [f"{name} {value / mm:.9g}" for name in ("kerf", "clearance") if (value := getattr(self, name))]
        if self.shrinkage:
            parts.append(f"shrinkage {100.0 * self.shrinkage:.9g} percent")
        for altered in self.altered:
            parts += [f"{altered.key} {altered.value:.9g}", *([" ".join(altered.beside)] if altered.beside else ())]
        return ", ".join(parts)

    def entry(self, mm: float) -> dict[str, float | str]:
        """Compensation for a report, by key: lengths in a unit of `mm` mm, the shrinkage in percent.

        Besides the given keys, `outward` is the movement of the edges and `scale` the factor of the drawing, if finite.
        """
        amounts: dict[str, float | str] = {
            name: getattr(self, name) / mm for name in ("kerf", "clearance") if getattr(self, name)
        }
        if self.shrinkage:
            amounts["shrinkage"] = 100.0 * self.shrinkage
        for altered in self.altered:
            amounts |= {altered.key: altered.value, **dict([altered.beside] if altered.beside else ())}
        moved = {"outward": self.out / mm, "scale": self.scale}
        return {**amounts, **{key: value for key, value in moved.items() if math.isfinite(value)}}


MOST_RPM = 1_000_000
COARSEST, FINEST = 10.0, 1e-3  # degrees between rows of a grinder's table: with finer steps it is too large to read


MANUFACTURE = FieldTable(
    (
        length("cutter", "diameter of the cutter that mills the contour"),
        length("feed", "feed along the contour, a minute; needed by a milling program"),
        length("plunge", "feed downwards, a minute; needed by a milling program"),
        Field(
            "spindle",
            Kind.NUMBER,
            "speed of the spindle, turns a minute; needed by a milling program",
            above=0,
            at_most=MOST_RPM,
        ),
        length("depth_of_cut", "greatest depth of one pass; needed by a milling program"),
        length("safe_height", "height above the stock at which the cutter moves fast; needed by a milling program"),
        length("lead_in", "radius of the arcs on which the cutter comes and leaves", default="half the cutter"),
        Field(
            "direction",
            Kind.CHOICE,
            "side on which a right-handed cutter that turns clockwise enters the metal",
            default="climb",
            choices=("climb", "conventional"),
        ),
        length("allowance", "metal that a last pass at full depth takes off all round", default="no such pass"),
        Field(
            "start",
            Kind.ANGLE,
            "direction in which the cutter is farthest out where it comes to the contour",
            default="0",
            at_least=-360,
            at_most=360,
        ),
        Field("holes", Kind.TRUTH, "whether round openings larger than the cutter are milled too", default="false"),
        length("unreached", "greatest depth of metal that may be left where the cutter does not reach", default="none"),
        Field("layer", Kind.TRUTH, "whether a DXF shows the path of the cutter's centre, on TOOLPATH", default="false"),
        length("wheel", "diameter of the grinding wheel that finishes the contour, which its hollows must take"),
    )
)


COMPENSATION = (
    length("kerf", "width of the cut: the metal is drawn larger by half of it, openings smaller", default="0"),
    length("clearance", "distance by which the metal is reduced all round; openings become larger", default="0"),
    Field(
        "shrinkage",
        Kind.NUMBER,
        "percent by which the part shrinks: it is drawn larger by 1/(1 - s/100)",
        default="0",
        above=0,
        at_most=20,
    ),
)
"""Options of a file whose part differs from the nominal one."""


def check_cutter(reader: Reader) -> None:
    """Note keys of milling without a cutter; a grinding wheel needs none."""
    milled = any(f"manufacture.{field.name}" in reader.marks for field in MANUFACTURE.fields if field.name != "wheel")
    if milled and "manufacture.cutter" not in reader.marks:
        field = MANUFACTURE.field("cutter")
        remedy = f"{reader.wanted(field)}: {field.about}"
        reader.fault(reader.marks["manufacture"], "manufacture.cutter", "missing", None, remedy)


def check_allowance(milling: Values, reader: Reader) -> None:
    """Note an allowance of a quarter of the cutter's diameter or more; `milling` are the values of `manufacture`."""
    if {"allowance", "cutter"} <= milling.keys() and milling["allowance"] >= 0.25 * milling["cutter"]:
        remedy = f"give less than {0.25 * milling['cutter'] / reader.mm:.6g} {reader.units}"
        value = f"{milling['allowance'] / reader.mm:.6g} {reader.units}"
        reader.fault_at("manufacture.allowance", "not below a quarter of the cutter", value, remedy)


def build_manufacture(values: Values) -> tuple[Manufacture | None, float | None]:
    """Milling, and the radius of the grinding wheel, mm, from values of `manufacture`; each None where not given."""
    milling = {name: value for name, value in values.items() if name != "wheel"}
    wheel = values.get("wheel")
    return Manufacture(**milling) if milling else None, None if wheel is None else 0.5 * wheel


def build_compensation(file: Values) -> Compensation | None:
    """Compensation of a file from its values, in which the shrinkage is in percent; None for a nominal file."""
    own = {name: file[name] for name in ("kerf", "clearance", "shrinkage") if name in file}
    if "shrinkage" in own:
        own["shrinkage"] /= 100.0
    altered = []
    for name, alteration in alterations().items():
        value = alteration.chosen(file)
        if value is not None:
            altered.append(Altered(name, alteration.option.name, value, alteration.word(file)))
    return Compensation(**own, altered=tuple(altered)) if own or altered else None


def alterations() -> dict[str, Alteration]:
    """Alterations by their capability, of the loaded capabilities; a recipe that uses another would have loaded it."""
    return {name: option for name in KEYS.loaded() if (option := KEYS[name].alteration) is not None}
