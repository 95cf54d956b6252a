"""The table of a sweep: the designs kept, best first, as CSV and as Parquet."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.gather import MOST_ROWS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.gather import Ranking, Selection
    from camgeo.capabilities.sweep.plan import Plan
    from camgeo.capabilities.sweep.recipes import Best
    from camgeo.capabilities.sweep.task import Unit
    from kin.numeric.arrays import Array, Mask

    Marks = dict[str, Mask]
    Columns = Mapping[str, Array | NDArray[np.int64] | NDArray[np.str_]]


def with_polished(designs: Selection, best: Sequence[Best], ranking: Ranking) -> tuple[Selection, Marks]:
    """The designs kept and the polished ones, best first, at most MOST_ROWS; and marks of each (n,) by their names.

    `polished`: the design has the index of that from which it was polished, whose own row stays. `certified`, where
    figures are estimates: those of this design are exact; such designs come first.
    """
    new = [design for design in best if design.polished]
    index = np.append([design.index for design in new], designs.index).astype(np.int64)
    values = np.vstack([*(list(design.values.values()) for design in new), designs.values])
    figures = {
        name: np.append([design.figures[name] for design in new], column) for name, column in designs.figures.items()
    }
    polished = np.arange(len(index)) < len(new)
    certified = len(index) if designs.certificate is None else designs.certificate.designs
    exact = np.arange(len(index)) < len(new) + certified
    order = np.lexsort((index, ~polished, -ranking.score(figures), ~exact))[:MOST_ROWS]
    rows = {name: column[order] for name, column in figures.items()}
    marks = {"polished": polished[order]} | ({} if designs.certificate is None else {"certified": exact[order]})
    return replace(designs, index=index[order], values=values[order], figures=rows), marks


def columns(plan: Plan, designs: Selection, units: Mapping[str, Unit], marks: Marks | None = None) -> Columns:
    """Columns (n,) by their heads: place from 1, index, the varied fields by their paths, figures with units.

    Marks are the last, 0 or 1.
    """
    figures = {name: values / units[name].divisor for name, values in designs.figures.items()}
    return {
        "place": np.arange(1, designs.rows + 1),
        "index": designs.index,
        **{
            axis.path: np.array(axis.words)[designs.values[:, i].astype(np.int64)]
            if axis.words
            else designs.values[:, i]
            for i, axis in enumerate(plan.axes)
        },
        **{_head(name, units[name].name): values for name, values in figures.items()},
        **{name: mark.astype(np.int64) for name, mark in (marks or {}).items()},
    }


def _head(figure: str, unit: str) -> str:
    """Head of a figure's column: `dwell_deg`, `size_mm`; without a unit the figure's name."""
    suffix = unit.replace("/", "_per_").replace("^", "")
    return f"{figure}_{suffix}" if suffix else figure


def as_csv(heads: Columns) -> bytes:
    """The table as CSV, every number with as few digits as read back exactly."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(zip(*(column.tolist() for column in heads.values()), strict=True))
    return stream.getvalue().encode()


def as_parquet(heads: Columns, about: Mapping[str, str]) -> bytes:
    """The table as Parquet, with `about` in the metadata of its schema. Raises ModuleNotFoundError without pyarrow."""
    import pyarrow as pa
    from pyarrow import parquet

    table = pa.table({name: pa.array(column) for name, column in heads.items()})
    sink = pa.BufferOutputStream()
    parquet.write_table(table.replace_schema_metadata(dict(about)), sink, compression="zstd")
    return bytes(sink.getvalue().to_pybytes())
