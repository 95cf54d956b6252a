"""Tables as text: a header, then a row a line, each number with at most 12 digits, or fewer; CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

DIGITS = 12
"""Of a number: of a metre the last is 1e-9 mm. What a double has beyond is its own rounding."""


def write_table(
    path: Path,
    columns: Sequence[str],
    rows: NDArray[np.float64],
    *,
    gaps: bool = False,
    head: Sequence[str] = (),
    digits: int = DIGITS,
) -> None:
    """Write rows (n, k) under k column names, numbers with that many digits; lines end in a line feed on every system.

    Lines of the `head` stand first, behind a #. With `gaps` a nan becomes an empty cell. Raises ValueError where the
    shapes disagree, a name would need quoting or a number is not finite; OSError where the file cannot
    be written.
    """
    if rows.ndim != 2 or rows.shape[1] != len(columns):
        raise ValueError(f"table: rows of shape {rows.shape} under {len(columns)} columns")
    for name in columns:
        if not name.isidentifier():
            raise ValueError(f"table: {name!r} is not a plain column name")
    bad = np.isinf(rows) if gaps else ~np.isfinite(rows)
    if bool(bad.any()):
        row, column = np.argwhere(bad)[0].tolist()
        raise ValueError(f"table: {columns[column]} is not finite in row {row}")
    # one format for the whole table: a tenth of the time of a csv writer
    line = ",".join([f"%.{digits}g"] * len(columns)) + "\n"
    numbers = (rows + 0.0).ravel().tolist()  # + 0.0 makes -0.0 a plain zero
    text = (line * len(rows)) % tuple(numbers)
    if gaps:
        text = text.replace("nan", "")
    text = "".join(f"# {line}\n" for line in head) + ",".join(columns) + "\n" + text
    path.write_bytes(text.encode("ascii", "replace"))
