"""Numbers that carry their unit, such as `15 mm`, `3/4 in` and `30 deg`, as numbers in the unit of their field."""

from __future__ import annotations

import re

from camgeo.schema.scalars import Complaint, read_number, within_range

LENGTHS = {"mm": 10, "cm": 100, "in": 254, "inch": 254}
"""The units that a length may carry, in tenths of a millimetre."""
ANGLES = {"deg": 1}
"""The units that an angle may carry, in degrees."""
LBF = 44482216152605  # 1e-13 N: 0.45359237 kg by 9.80665 m/s^2
FORCES = {"N": 10**13, "lbf": LBF}
MOMENTS = {"Nm": 10**17, "lbf*in": 254 * LBF, "lbf-in": 254 * LBF}
RATES = {"N/m": 254 * 10**9, "N/mm": 254 * 10**12, "lbf/in": LBF}
PSI = LBF  # by 25.4 mm squared
NEWTONS = 64516 * 10**11  # an N/mm^2 in the same
PRESSURES = {"N/mm^2": NEWTONS, "N/mm²": NEWTONS, "MPa": NEWTONS, "GPa": 1000 * NEWTONS, "psi": PSI, "ksi": 1000 * PSI}
MASSES = {"kg": 10**8, "lb": 45359237}
"""The units that forces, moments, rates of springs, pressures and masses may carry, as whole multiples of one."""

_QUANTITY = r"(.*(?:[0-9.)]|\bpi)) *((?!pi)[A-Za-zµ°\"'%][A-Za-zµ°\"'%/²³*-]*(?:\^[0-9])?)"
_WITHIN = rf"[0-9.)] *(?:{'|'.join((*LENGTHS, *ANGLES, *FORCES, 'Nm', *MASSES))})\b"
_MOST = 80  # characters; a number of them has fewer
_RATIONAL = r"[+-]?(?:[0-9]+/[0-9]+|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
_TAKEN = {
    "degrees": (ANGLES, "deg", "an angle"),
    "mm": (LENGTHS, "mm", "a length"),
    "inch": (LENGTHS, "inch", "a length"),
    "N": (FORCES, "N", "a force"),
    "N m": (MOMENTS, "Nm", "a moment"),
    "N/m": (RATES, "N/m", "a spring rate"),
    "N/mm^2": (PRESSURES, "N/mm^2", "a pressure"),
    "kg": (MASSES, "kg", "a mass"),
}  # with the own one's name, and what carries them


def units_for(own: str) -> tuple[str, ...]:
    """Name the units that a number may carry where the own one is such as `degrees`, `mm` or `N/m`; none elsewhere."""
    return tuple(_TAKEN[own][0]) if own in _TAKEN else ()


def quantity_in(own: str) -> str:
    """Say what is measured in a unit: `a length`."""
    return _TAKEN[own][2]


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
    known = any(unit in units for units, *_ in _TAKEN.values())
    return (number, unit) if known or _is_number(number) else (text, "")


def _is_number(text: str) -> bool:
    try:
        read_number(text)
    except Complaint:
        return False
    return True


def read_quantity(text: str, own: str) -> float:
    """Read a number, with a unit or without, as one in the field's `own` unit; raises Complaint.

    A unit turns the number as written, a decimal or a fraction, into the own unit and rounds it once: `0.75 in` where
    mm are meant is 19.05. Arithmetic is worked out first. `own` is `degrees`, `mm`, `inch`, `N`, `N m`, `N/m`,
    `N/mm^2` or `kg`; other fields take none.
    """
    number, unit = parted(text)
    value = read_number(number)
    if not unit:
        return value
    if unit not in units_for(own):
        raise UnitComplaint(unit)
    known, same, _ = _TAKEN[own]
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
