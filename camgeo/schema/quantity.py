"""Numbers that carry their unit, such as `15 mm`, `3/4 in` and `30 deg`, as numbers in the unit of their field."""

from __future__ import annotations

import re

from camgeo.schema.scalars import Complaint, read_number, within_range

LENGTHS = {"mm": 10, "cm": 100, "in": 254, "inch": 254}
"""The units that a length may carry, in tenths of a millimetre."""
ANGLES = {"deg": 1}
"""The units that an angle may carry, in degrees."""

_QUANTITY = r"(.*(?:[0-9.)]|\bpi)) *((?!pi)[A-Za-zµ°\"'%][A-Za-zµ°\"'%/²³]*(?:\^[0-9])?)"
_WITHIN = rf"[0-9.)] *(?:{'|'.join((*LENGTHS, *ANGLES))})\b"
_MOST = 80  # characters; a number of them has fewer
_RATIONAL = r"[+-]?(?:[0-9]+/[0-9]+|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
_TAKEN = {"degrees": (ANGLES, "deg"), "mm": (LENGTHS, "mm"), "inch": (LENGTHS, "inch")}  # with the own one's name


def units_for(own: str) -> tuple[str, ...]:
    """Name the units that a number may carry where the field's own is `degrees`, `mm` or `inch`; none elsewhere."""
    return tuple(_TAKEN[own][0]) if own in _TAKEN else ()


def holds_unit(text: str) -> bool:
    """Tell whether a known unit stands behind a number anywhere in a text."""
    return re.search(_WITHIN, text) is not None


def is_metric(text: str) -> bool:
    """Tell whether a number carries a metric unit of length."""
    return parted(text)[1] in {"mm", "cm"}


def parted(text: str) -> tuple[str, str]:
    """Part a text into its number and the unit behind it, which is empty where there is none.

    What no number stands before is no unit: `0x1F` and `true` stay whole.
    """
    found = re.fullmatch(_QUANTITY, text) if len(text) <= _MOST else None
    if found is None:
        return text, ""
    number, unit = found.groups()
    return (number, unit) if unit in LENGTHS or unit in ANGLES or _is_number(number) else (text, "")


def _is_number(text: str) -> bool:
    try:
        read_number(text)
    except Complaint:
        return False
    return True


def read_quantity(text: str, own: str) -> float:
    """Read a number, with a unit or without, as one in the field's `own` unit; raises Complaint.

    A unit turns the number as written, a decimal or a fraction, into the own unit and rounds it once: `0.75 in` where
    mm are meant is 19.05. Arithmetic is worked out first. `own` is `degrees`, `mm` or `inch`; other fields take none.
    """
    number, unit = parted(text)
    value = read_number(number)
    if not unit:
        return value
    if unit not in units_for(own):
        raise UnitComplaint(unit)
    known, same = _TAKEN[own]
    if value == 0.0 or known[unit] == known[same]:
        return value
    from fractions import Fraction

    exact = Fraction(number) if re.fullmatch(_RATIONAL, number) else Fraction(value)
    try:
        return within_range(float(exact * Fraction(known[unit], known[same])))
    except OverflowError:
        raise Complaint("too large") from None


class UnitComplaint(Complaint):
    """A unit that a field does not take."""

    def __init__(self, unit: str) -> None:
        super().__init__(f"'{unit}' is no unit of it")
        self.unit = unit
