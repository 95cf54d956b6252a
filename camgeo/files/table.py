"""Tables as CSV: comma, point, one header line, every number with as many digits as give back the same double."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def write_table(path: Path, columns: Sequence[str], rows: Array) -> None:
    """Write rows (n, m) under m column names; lines end with a line feed on every system.

    Raises ValueError where the shapes do not agree or a number is not finite; OSError as the file system does.
    """
    if rows.ndim != 2 or rows.shape[1] != len(columns):
        raise ValueError(f"table: {len(columns)} columns do not head rows of shape {rows.shape}")
    if not bool(np.isfinite(rows).all()):
        raise ValueError("table: every number must be finite")
    lines = [",".join(columns)]
    lines += [",".join(map(repr, row)) for row in (rows + 0.0).tolist()]
    path.write_bytes(("\n".join(lines) + "\n").encode("ascii"))
