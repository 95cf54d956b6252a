"""The picture of a study: error over run time and over pieces, logarithmic, with the slopes that theory gives."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

from kin.read.home import prepare_home

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from camgeo.checks.declaration import Entry

COLOURS = {"polyline": "#0072B2", "arcs": "#D55E00", "spline": "#009E73", "stl": "#CC79A7"}
MARKS = {"polyline": "o", "arcs": "s", "spline": "^", "stl": "D"}
SLOPES = {"polyline": 2, "arcs": 3, "spline": 5}  # error falls as pieces to the minus this
DOTS = 150  # per inch


def picture(study: Entry) -> bytes:
    """Bytes of a PNG of `study`, the content of study.json; raises ModuleNotFoundError without matplotlib."""
    prepare_home()
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context():
        mpl.rcdefaults()
        figure = Figure(figsize=(11.0, 4.8), layout="constrained")
        time, pieces = figure.subplots(1, 2, sharey=True)
        every_error = [row["geometry_error"] for row in study["rows"] if row["geometry_error"]]
        for form, colour in COLOURS.items():
            rows = [row for row in study["rows"] if row["form"] == form and row["geometry_error"]]
            if not rows:
                continue
            errors = [row["geometry_error"] for row in rows]
            style: dict[str, Any] = {"color": colour, "marker": MARKS[form], "markersize": 4, "linewidth": 1.2}
            writing = [1e3 * (row["stages"]["fit"] + row["stages"]["write"]) for row in rows]
            time.plot(writing, errors, label=form, **style)
            judging = [1e3 * row["seconds"] for row in rows]
            time.plot(judging, errors, **{**style, "linestyle": ":", "markerfacecolor": "none"})
            pieces.plot([row["pieces"] for row in rows], errors, label=form, **style)
            if form in SLOPES:
                _draw_slope(pieces, rows, SLOPES[form], colour)
        unit = "mm" if study["units"] == "mm" else "in"
        time.set_ylabel(f"geometry error of the file read back, {unit}")
        time.set_xlabel("run time, warm, ms (solid: fit and write; dotted: and judged)")
        pieces.set_xlabel("pieces (dashed: the slope of theory)")
        for axes in (time, pieces):
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_ylim(0.3 * min(every_error, default=1.0), 3.0 * max(every_error, default=1.0))
            axes.grid(visible=True, which="major", color="#e0e0e0")
        pieces.legend(frameon=False)
        figure.suptitle(f"{study['recipe']}: error against run time and pieces", fontsize="medium", fontweight="bold")
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=DOTS, metadata={"Software": None})
    return stream.getvalue()


def _draw_slope(axes: Axes, rows: list[Entry], order: int, colour: str) -> None:
    """Draw error ~ pieces^-order through the last row's error at theory's count of pieces."""
    last = rows[-1]
    count = last["least_pieces"]
    ends = [max(min(row["pieces"] for row in rows), 2), count]
    errors = [last["geometry_error"] * (count / n) ** order for n in ends]
    axes.plot(ends, errors, "--", color=colour, linewidth=0.8, alpha=0.7)
