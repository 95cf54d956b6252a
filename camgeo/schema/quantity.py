"""Numbers that carry their unit, such as `15 mm`, `3/4 in` and `30 deg`, as numbers in the unit of their field."""

from __future__ import annotations

import re

from camgeo.schema.scalars import Complaint, read_number, within_range

LENGTHS = {"mm": 10, "cm": 100, "in": 254, "inch": 254}
"""The units that a length may carry, in tenths of a millimetre."""
ANGLES = {"deg": 1}
"""The units that an angle may carry, in degrees."""
LBF = 44482216152605  # 1e-13 N: 0.45359237 kg by 9.80665 m/s^2
FORCES = {"N": 10**13, "lbf": LBF}  # in 1e-13 N
MOMENTS = {"Nm": 10**17, "lbf*in": 254 * LBF, "lbf-in": 254 * LBF}  # in 1e-17 N m
RATES = {"N/m": 254 * 10**9, "N/mm": 254 * 10**12, "lbf/in": LBF}  # in 1e-13 N by 25.4 mm
PSI = LBF  # in 1e-13 N by a square of 25.4 mm
NEWTONS = 64516 * 10**11  # an N/mm^2 in the same unit
PRESSURES = {"N/mm^2": NEWTONS, "N/mm²": NEWTONS, "MPa": NEWTONS, "GPa": 1000 * NEWTONS, "psi": PSI, "ksi": 1000 * PSI}
MASSES = {"kg": 10**8, "lb": 45359237}
"""The units that forces, moments, rates of springs, pressures and masses may carry, as whole multiples of one."""

_QUANTITY = r"(.*(?:[0-9.)]|\bpi)) *((?!pi)[A-Za-zµ°\"'%][A-Za-zµ°\"'%/²³*-]*(?:\^[0-9])?)"
_WITHIN = rf"[0-9.)] *(?:{'|'.join((*LENGTHS, *ANGLES, *FORCES, 'Nm', *MASSES))})\b"
_MOST = 80  # characters; a number of them has fewer
_RATIONAL = r"[+-]?(?:[0-9]+/[0-9]+|(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
_TAKEN = {
    "degrees": (ANGLES, "deg", "an angle"),
    "mm": (LENGTHS, "mm", "a length"),
    "inch": (LENGTHS, "inch", "a length"),
    "N": (FORCES, "N", "a force"),
    "N m": (MOMENTS, "Nm", "a moment"),
    "N/m": (RATES, "N/m", "a spring rate"),
    "N/mm^2": (PRESSURES, "N/mm^2", "a pressure"),
    "kg": (MASSES, "kg", "a mass"),
}  # by the unit of a field: the units that may be written, its own name among them, and the quantity


def units_for(own_unit: str) -> tuple[str, ...]:
    """Units that a number may carry in a field whose own unit is `degrees`, `mm`, `N/m`; empty for other units."""
    return tuple(_TAKEN[own_unit][0]) if own_unit in _TAKEN else ()


def quantity_in(own_unit: str) -> str:
    """Quantity of a field whose own unit is `degrees`, `mm`, `N/m`, for messages: `a length`.

    Raises KeyError for another unit: for `deg` or `psi`, which only numbers carry, and where numbers carry none.
    """
    return _TAKEN[own_unit][2]


def holds_unit(text: str) -> bool:
    """Whether a unit of length, angle, force, moment or mass stands behind a number anywhere in a text.

    Of spring rates and pressures those count that begin with a unit of force, such as N/mm; MPa and psi do not.
    """
    return re.search(_WITHIN, text) is not None


def is_metric(text: str) -> bool:
    """Whether a number carries a metric unit of length."""
    return split_unit(text)[1] in {"mm", "cm"}


def split_unit(text: str) -> tuple[str, str]:
    """Split a text into its number and the unit behind it; the unit is empty where no number stands before it.

    `0x1F` and `true` stay whole.
    """
    match = re.fullmatch(_QUANTITY, text) if len(text) <= _MOST else None
    if match is None:
        return text, ""
    number, unit = match.groups()
    is_known = any(unit in units for units, *_ in _TAKEN.values())
    return (number, unit) if is_known or _is_number(number) else (text, "")


def _is_number(text: str) -> bool:
    try:
        read_number(text)
    except Complaint:
        return False
    return True


def read_quantity(text: str, own_unit: str) -> float:
    """Number in the field's own unit, written with a unit or without.

    A number with another unit, a decimal or a fraction, is converted exactly and rounded once: `0.75 in` in a field of
    mm is 19.05. Arithmetic is worked out first. `own_unit` is `degrees`, `mm`, `inch`, `N`, `N m`, `N/m`, `N/mm^2` or
    `kg`; in fields of other units a number carries none. Raises Complaint for a text that is no number or out of range,
    and for a unit that the field does not take.
    """
    number, unit = split_unit(text)
    value = read_number(number)
    if not unit:
        return value
    if unit not in units_for(own_unit):
        raise UnitComplaint(unit)
    factors, own_name, _ = _TAKEN[own_unit]
    if value == 0.0 or factors[unit] == factors[own_name]:
        return value
    from fractions import Fraction

    exact = Fraction(number) if re.fullmatch(_RATIONAL, number) else Fraction(value)
    try:
        return within_range(float(exact * Fraction(factors[unit], factors[own_name])))
    except OverflowError:
        raise Complaint("too large") from None


class UnitComplaint(Complaint):
    """A unit that a field does not take."""

    def __init__(self, unit: str) -> None:
        super().__init__(f"'{unit}' is no unit of it")
        self.unit = unit
