"""A flat of a D-shaped bore."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.bore import diameter_of
from camgeo.part.feature import Feature, angle, check_below, optional, size_words
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.fit.pieces import ArcSpline
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Flat:
    """Flat of a D-shaped bore, `across` mm from the opposite side of the bore; its normal has direction `at`, rad."""

    across: float
    at: float = 0.0


def _check(part: Values, reader: Reader) -> None:
    across, bore = part["flat"].get("across"), diameter_of(part)
    if across is None or bore is None:
        return
    check_below(reader, "part.flat.across", across, bore, "the bore's diameter")
    if across <= 0.5 * bore:
        remedy = f"give more than {size_words(0.5 * bore, reader)}"
        reader.fault_at("part.flat.across", "not above half the bore", size_words(across, reader), remedy)


def _bore(flat: Flat, radius: float) -> ArcSpline:
    from camgeo.part.shapes import flattened

    return flattened(radius, flat.across, flat.at)


FEATURE = Feature(
    Flat,
    optional(
        "flat",
        "flat of a D-shaped bore",
        length("across", "width from the flat to the opposite side of the bore", required=True),
        angle("at", "direction of the flat's normal"),
    ),
    needs=(("bore", "a flat is left in a bore"),),
    of_ring=False,
    locates=True,
    check=_check,
    bore=_bore,
)
