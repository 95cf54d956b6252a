"""Curve point tables of SEW-EURODRIVE's MOVI-C controllers, in the layout of `kin.read.curve_points`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array

PLACES = 9  # decimals: of a millimetre the last is 1e-6 micrometres


def fixed(value: float) -> str:
    """Text of a number without an exponent, which the manual does not mention, to nine decimals."""
    text = f"{value:.{PLACES}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_curve_points(path: Path, _columns: Sequence[str], rows: Array, _head: Sequence[str]) -> None:
    """Write the number of rows, then master and slave of each (n, 2); the layout has no heading and no remarks."""
    lines = [str(len(rows)), *(f"{fixed(master)};{fixed(slave)}" for master, slave in rows.tolist())]
    path.write_bytes("".join(f"{line}\n" for line in lines).encode("ascii"))
