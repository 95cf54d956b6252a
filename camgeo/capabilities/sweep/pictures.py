"""Pictures of a sweep: the map of its figure, and the output curves of the best designs. PNG and SVG, as bytes.

Drawn with matplotlib's own defaults, not the user's, and without a date, so the same sweep gives the same bytes.
Colours differ for the colour-blind too: viridis, and the set of Okabe and Ito.
"""

from __future__ import annotations

import io
import textwrap
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.sweep.gather import KEPT, NONE, OUTSIDE, STUCK
from kin.numeric.records import dataclass
from kin.read.home import prepare_home

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from camgeo.capabilities.sweep.gather import BestByCell
    from kin.numeric.arrays import Array

_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
_GREYS = {OUTSIDE: ("#d9d9d9", "breaks a limit"), STUCK: ("#8c8c8c", "does not turn")}
_DOTS = 150  # per inch, of the PNG
_TITLE, _NOTES = 75, 100  # letters in a line
_MOST_POINTS = 60  # values up to which a curve shows each as a point


@dataclass(frozen=True)
class OutputCurve:
    """A design's output over the shaft angle (degrees), and its longest dwell, (start, length) in degrees, if any."""

    label: str
    shaft: Array
    output: Array
    dwell: tuple[float, float] | None = None


def draw_map(
    title: str,
    cells: BestByCell,
    label: str,
    names: Sequence[str],
    best: Array,
    *,
    divisor: float = 1.0,
    notes: str = "",
) -> dict[str, bytes]:
    """Picture of the ranking's figure over the cells' one or two axes, as bytes: {"png": ..., "svg": ...}.

    The figure is divided by the `divisor` of its unit and labelled `label`; `names` label the axes. `best` (n, 2) are
    the coordinates of the best designs in the picture, best first; `notes` stand below the title. Raises
    ModuleNotFoundError without matplotlib.
    """
    flat, values = len(cells.axes) == 2, cells.best * (1.0 / divisor)
    with _blank() as (figure, axes):
        handles = _draw_cells(figure, axes, cells, values, label) if flat else _draw_curve(axes, cells, values[:, 0])
        if len(best):
            x, y = best.T
            ring: dict[str, Any] = {"linestyle": "", "markeredgecolor": "black"}
            if len(best) > 1:
                text = "best designs"
                handles += axes.plot(x[1:], y[1:], "o", markersize=5, markerfacecolor="white", label=text, **ring)
            handles += axes.plot(x[:1], y[:1], "*", markersize=15, markerfacecolor="#D55E00", label="the best", **ring)
        axes.set_xlabel(names[0])
        axes.set_ylabel(names[1] if flat else label)
        for axis, ticks in zip(cells.axes, (axes.set_xticks, axes.set_yticks), strict=False):
            if axis.words:
                ticks(list(axis.values), axis.words)
        _add_title(axes, title, notes)
        if handles:
            figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
        return _encoded(figure)


def draw_best(title: str, curves: Sequence[OutputCurve], label: str, *, notes: str = "") -> dict[str, bytes]:
    """Picture of the best designs' output over a turn, as bytes: {"png": ..., "svg": ...}.

    The first curve is boldest, its dwell shaded. `label` names the output's axis; `notes` stand below the title.
    Raises ModuleNotFoundError without matplotlib.
    """
    with _blank() as (figure, axes):
        for number, curve in enumerate(curves):
            axes.plot(
                curve.shaft,
                curve.output,
                "-" if number < len(_COLOURS) else "--",
                color=_COLOURS[number % len(_COLOURS)],
                linewidth=1.0 if number else 2.2,
                label=curve.label,
                zorder=2 if number else 3,
            )
        if curves and curves[0].dwell is not None:
            start, length = curves[0].dwell
            for turn in (-360.0, 0.0):  # a dwell may run through zero
                ends = np.clip((start % 360.0 + turn, start % 360.0 + turn + length), 0.0, 360.0)
                if ends[1] > ends[0]:
                    axes.axvspan(*ends, color=_COLOURS[0], alpha=0.13, linewidth=0, zorder=1)
        axes.set_xlim(0.0, 360.0)
        axes.set_xticks(range(0, 361, 45))
        axes.set_xlabel("shaft angle (deg)")
        axes.set_ylabel(label)
        axes.grid(color="#e6e6e6", linewidth=0.6)
        _add_title(axes, title, notes)
        figure.legend(loc="outside lower center", ncols=2, frameon=False, fontsize="small")
        return _encoded(figure)


def _draw_cells(figure: Figure, axes: Axes, cells: BestByCell, values: Array, label: str) -> list[Artist]:
    """Draw cells of two axes in colour, those without a kept design in grey; return the legend's entries."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    x, y = cells.edges
    handles: list[Artist] = []
    for state, (colour, text) in _GREYS.items():
        where = np.where(cells.state == state, 1.0, np.nan).T
        if np.isfinite(where).any():
            axes.pcolormesh(x, y, where, cmap=ListedColormap([colour]), rasterized=True)
            handles.append(Patch(facecolor=colour, label=text))
    if (cells.state == KEPT).any():
        mesh = axes.pcolormesh(x, y, values.T, cmap="viridis", rasterized=True)
        figure.colorbar(mesh, ax=axes, label=label, pad=0.02)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    return handles


def _draw_curve(axes: Axes, cells: BestByCell, values: Array) -> list[Artist]:
    """Draw the figure over one axis, where no design is kept a grey band; return the legend's entries."""
    x, state = cells.centres[0], cells.state[:, 0]
    filled = state != NONE
    marker = "." if len(x) <= _MOST_POINTS else ""
    axes.plot(x[filled], values[filled], "-", marker=marker, color=_COLOURS[0], linewidth=1.6)
    handles: list[Artist] = []
    for kind, (colour, text) in _GREYS.items():
        bands = [(cells.edges[0][i], cells.edges[0][i + 1] - cells.edges[0][i]) for i in np.flatnonzero(state == kind)]
        if bands:
            across = axes.get_xaxis_transform()
            handles.append(
                axes.broken_barh(bands, (0.0, 1.0), color=colour, linewidth=0, transform=across, zorder=0, label=text)
            )
    axes.set_xlim(cells.edges[0][0], cells.edges[0][-1])
    axes.grid(color="#e6e6e6", linewidth=0.6)
    return handles


@contextmanager
def _blank() -> Iterator[tuple[Figure, Axes]]:
    """An empty figure and its axes, under matplotlib's defaults."""
    prepare_home()
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams["svg.hashsalt"] = "camgeo"
        mpl.rcParams["axes.formatter.useoffset"] = False
        figure = Figure(figsize=(8.0, 5.8), layout="constrained")
        yield figure, figure.add_subplot()


def _add_title(axes: Axes, title: str, notes: str) -> None:
    """Write the title above the axes, and the notes below it in small letters."""
    # in several lines, as the layout leaves space for the longest
    title = textwrap.fill(title, _TITLE)
    lines = textwrap.wrap(notes, _NOTES)
    axes.set_title(title + "\n" * len(lines), loc="left", fontweight="bold", fontsize="medium")
    if lines:
        axes.text(0.0, 1.02, "\n".join(lines), transform=axes.transAxes, fontsize="small", color="#404040")


def _encoded(figure: Figure) -> dict[str, bytes]:
    """The picture as PNG and SVG, without date or program, by kind."""
    leave_out: dict[str, Mapping[str, None]] = {
        "png": {"Software": None},
        "svg": {"Date": None, "Creator": None},
    }
    files = {}
    for kind, metadata in leave_out.items():
        stream = io.BytesIO()
        figure.savefig(stream, format=kind, dpi=_DOTS, metadata=metadata)
        files[kind] = stream.getvalue()
    return files
