"""What a program for a machine needs of a recipe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.features import boss_of, values_read
from camgeo.schema.fields import either

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values

NEEDED = ("feed", "plunge", "spindle", "depth_of_cut", "safe_height")
"""Keys that a program for a machine cannot do without."""


SLOWEST, SHORTEST = 0.001, 1e-6


LEAST_TOLD = dict.fromkeys(("feed", "plunge", "spindle"), SLOWEST)
LEAST_TOLD |= dict.fromkeys(("cutter", "depth_of_cut", "safe_height", "lead_in", "allowance"), SHORTEST)
"""Least figures of a program, in the recipe's unit: bounds against slips, far below what any machine keeps to."""


def check_milling(path: str, reader: Reader) -> None:
    """Add faults, some at the file's `path`, for what a program needs and the recipe lacks."""
    if "manufacture" not in reader.marks:
        remedy = f"give manufacture with cutter, {', '.join(NEEDED[:-1])} and {NEEDED[-1]}, or leave gcode out"
        reader.fault_at(path, "gcode needs manufacture", None, remedy)
    elif missing := [name for name in NEEDED if f"manufacture.{name}" not in reader.marks]:
        remedy = f"give {either(tuple(missing), 'and')}, or leave gcode out"
        reader.fault_at("manufacture", f"gcode needs {missing[0]}", None, remedy)
    if "part.thickness" not in reader.marks:
        reader.fault_at(path, "gcode needs a thickness", None, "give part.thickness, or leave gcode out")


def check_slight(values: Values, reader: Reader) -> None:
    """Add faults for machine settings, and a thickness, below the least that the decimals of a program can state."""
    for table, least_told in (("manufacture", LEAST_TOLD), ("part", {"thickness": SHORTEST})):
        for name, least in least_told.items():
            unit, mm = ("turns a minute", 1.0) if name == "spindle" else (reader.units, reader.mm)
            value = values.get(table, {}).get(name)
            if value is not None and value < least * mm:
                remedy = f"give at least {least:.6g} {unit}"
                reader.fault_at(f"{table}.{name}", "too little for a program", f"{value / mm:.6g} {unit}", remedy)


def check_boss(values: Values, reader: Reader) -> None:
    """Add a fault for a safe height at which rapid moves would run into a boss on the upper side."""
    boss, safe = boss_of(values_read(values.get("part", {}))), values.get("manufacture", {}).get("safe_height")
    if boss is None or not boss.above or safe is None or safe > boss.above:
        return
    remedy = f"give more than {boss.above / reader.mm:.6g} {reader.units}"
    height_words = f"{safe / reader.mm:.6g} {reader.units}"
    reader.fault_at("manufacture.safe_height", f"not above the {boss.name}'s top", height_words, remedy)
