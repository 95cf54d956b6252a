"""A curve point table of SEW-EURODRIVE's MOVI-C controllers, as `kin.read.curve_points` says what stands in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array

PLACES = 9  # decimals: of a millimetre the last is 1e-6 micrometres


def fixed(value: float) -> str:
    """Write a number without an exponent, of which the manual says nothing."""
    text = f"{value:.{PLACES}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_curve_points(path: Path, _columns: Sequence[str], rows: Array, _head: Sequence[str]) -> None:
    """Write how many rows there are, and master and slave (n, 2) of each; a heading and remarks have no place."""
    lines = [str(len(rows)), *(f"{fixed(master)};{fixed(slave)}" for master, slave in rows.tolist())]
    path.write_bytes("".join(f"{line}\n" for line in lines).encode("ascii"))
