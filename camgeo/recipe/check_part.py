"""Faults between the fields of a part that show without its contour."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.recipe.din6885 import LEAST, MOST, key_for

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values


def check_part(part: Values, reader: Reader) -> None:
    """Note the faults between the fields of `part` that were read."""
    _needs(reader, "keyway", "bore", "a keyway is cut into a bore")
    _needs(reader, "flat", "bore", "a flat is left in a bore")
    _needs(reader, "hub", "thickness", "a hub stands on the disc")
    _needs(reader, "chamfer", "thickness", "a chamfer runs along the edges of the disc")
    _needs(reader, "set_screw", "hub", "its hole goes through the hub")
    _needs(reader, "set_screw", "bore", "its hole leads into the bore")
    bore = part.get("bore")
    if isinstance(bore, float):
        _round(part, bore, reader)
    elif bore is not None:
        across = bore.get("square", bore.get("hexagon"))
        if across is not None:
            screw = part.get("set_screw", {}).get("diameter")
            _below(reader, "part.set_screw.diameter", screw, across, "the bore's width")
        for name in ("keyway", "flat"):
            if name in part:
                reader.fault_at(f"part.{name}", "needs a round bore", None, "give the bore's diameter, or leave it out")
    _disc(part, reader)
    _holes(part, reader)


def _needs(reader: Reader, name: str, other: str, why: str) -> None:
    if f"part.{name}" in reader.marks and f"part.{other}" not in reader.marks:
        reader.fault_at(f"part.{name}", f"needs part.{other}: {why}", None, f"give part.{other}, or leave it out")


def _round(part: Values, bore: float, reader: Reader) -> None:
    keyway, flat = part.get("keyway"), part.get("flat")
    if keyway is not None and flat is not None:
        reader.fault_at("part.flat", "cannot stand beside keyway", None, "give one of them")
    if keyway is not None and "standard" in keyway and key_for(bore) is None:
        low, high = LEAST / reader.mm, MOST / reader.mm
        remedy = f"the standard has bores from {low:.6g} to {high:.6g} {reader.units}; give width and depth"
        reader.fault_at("part.keyway", "no key of DIN 6885 for this bore", _told(bore, reader), remedy)
    if keyway is not None:
        _below(reader, "part.keyway.width", keyway.get("width"), bore, "the bore's diameter")
    if flat is not None and "across" in flat:
        _below(reader, "part.flat.across", flat["across"], bore, "the bore's diameter")
        if flat["across"] <= 0.5 * bore:
            remedy = f"give more than {_told(0.5 * bore, reader)}"
            reader.fault_at("part.flat.across", "not above half the bore", _told(flat["across"], reader), remedy)
    screw = part.get("set_screw", {})
    _below(reader, "part.set_screw.diameter", screw.get("diameter"), bore, "the bore's diameter")


def _disc(part: Values, reader: Reader) -> None:
    thickness, hub, screw = part.get("thickness"), part.get("hub", {}), part.get("set_screw", {})
    bore = part.get("bore")
    if isinstance(bore, float) and "diameter" in hub and hub["diameter"] <= bore:
        remedy = f"give more than {_told(bore, reader)}"
        reader.fault_at("part.hub.diameter", "not above the bore", _told(hub["diameter"], reader), remedy)
    if thickness is not None:
        chamfer = part.get("chamfer")
        _below(reader, "part.chamfer", chamfer, 0.5 * thickness, "half the thickness")
        _below(reader, "part.mark.depth", part.get("mark", {}).get("depth"), thickness, "the thickness")
    if "height" in hub:
        _below(reader, "part.set_screw.diameter", screw.get("diameter"), hub["height"], "the hub's height")
        _below(reader, "part.set_screw.height", screw.get("height"), hub["height"], "the hub's height")
    mark = part.get("mark", {})
    if "width" in mark and "length" in mark:
        _below(reader, "part.mark.width", mark["width"], mark["length"], "its length")
    if mark.get("as") == "cut" and "depth" in mark:
        reader.fault_at("part.mark.depth", "a mark that is cut through has no depth", None, "leave it out")


def _holes(part: Values, reader: Reader) -> None:
    bolts = part.get("bolts", {})
    if bolts.keys() >= {"count", "circle", "hole"} and bolts["count"] > 1:
        apart = bolts["circle"] * math.sin(math.pi / bolts["count"])
        _below(reader, "part.bolts.hole", bolts["hole"], apart, "the distance between two of them")
    if "largest" in part.get("lightening", {}) and "start" in part["lightening"]:
        reader.fault_at("part.lightening.start", "needs a ring", None, "leave it out")


def _below(reader: Reader, path: str, value: float | None, bound: float, what: str) -> None:
    if value is not None and value >= bound:
        reader.fault_at(path, f"not below {what}", _told(value, reader), f"give less than {_told(bound, reader)}")


def _told(value: float, reader: Reader) -> str:
    return f"{value / reader.mm:.6g} {reader.units}"
