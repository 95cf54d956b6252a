"""A radial hole for a set screw, from the hub's outside into the bore."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.bore import width_of
from camgeo.part.feature import Callout, Feature, angle, check_below, narrowed, optional
from camgeo.part.hub import Hub
from camgeo.schema.fields import length
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.feature import View
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class SetScrew:
    """A radial hole from the hub's outside into the bore, `height` above the face of the disc (None: half the hub)."""

    diameter: float
    at: float = 0.0
    height: float | None = None


def _check(part: Values, reader: Reader) -> None:
    screw, hub, path = part.get("set_screw", {}), part.get("hub", {}), "part.set_screw.diameter"
    width, word = width_of(part)
    if width is not None:
        check_below(reader, path, screw.get("diameter"), width, f"the bore's {word}")
    if "height" in hub:
        check_below(reader, path, screw.get("diameter"), hub["height"], "the hub's height")
        check_below(reader, "part.set_screw.height", screw.get("height"), hub["height"], "the hub's height")


def _grown(screw: SetScrew, out: float, scale: float) -> SetScrew:
    height = None if screw.height is None else scale * screw.height
    return replace(screw, diameter=narrowed(screw.diameter, out, scale), height=height)


def _callouts(screw: SetScrew, view: View) -> tuple[Callout, ...]:
    hub = view.part.of(Hub)
    if hub is None:
        return ()
    note = f"at {view.degrees(screw.at)}, {view.number(screw.height or 0.5 * hub.height)} up"
    text = f"Ø{view.number(screw.diameter)} set screw"
    return (Callout(text, note, (0.0, 0.0), 0.5 * hub.diameter, view.direction(screw.at)),)


FEATURE = Feature(
    SetScrew,
    optional(
        "set_screw",
        "hole for a set screw, through the hub",
        length("diameter", "diameter of the radial hole from the hub's outside into the bore", required=True),
        angle("at", "direction of the hole"),
        length("height", "height of its axis above the face of the disc", default="half the hub"),
    ),
    needs=(("hub", "its hole goes through the hub"), ("bore", "its hole leads into the bore")),
    of_ring=False,
    of_pair=False,
    check=_check,
    grown=_grown,
    remark=lambda screw, mm: f"set screw: radial hole through the hub, diameter {screw.diameter / mm:.9g}",
    unmilled="it runs across the shaft",
    callouts=_callouts,
)
