"""`camgeo laws`: the motion laws with their peaks, as a table, as JSON, or as a picture."""

from __future__ import annotations

import io
import json
import math
import sys
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.cli.arguments import name_of
from camgeo.cli.exit_status import OK, SURROUNDINGS, WRONG
from camgeo.files.errors import install
from kin.law.sources.peaks import peaks

if TYPE_CHECKING:
    import argparse

    from kin.law.normalised import Law
    from kin.numeric.arrays import Array


_CURVES = ("displacement", "velocity", "acceleration", "jerk")
_COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73")
_POINTS = 65  # of a curve on each stretch of a law
_WIDTH, _HEIGHT = 220, 130  # of a law's frame in an SVG
_MARGIN, _HEAD = 14, 30  # about the frame, and height of the two lines of text above it
_COLUMNS = 4  # laws side by side in a picture


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    command.add_argument("names", nargs="*", metavar="LAW", help="only these laws (default: all)")
    command.add_argument("--picture", type=name_of, metavar="FILE", help="draw the laws too, as FILE.svg or FILE.png")
    command.add_argument("--json", action="store_true", help="as JSON, for machines")


def run(arguments: argparse.Namespace) -> int:
    """Print the laws' peaks for unit stroke over unit time, draw the laws with `--picture`, return the exit status."""
    from kin.law.normalised import IntentError
    from kin.law.sources.laws import NAMES, named

    try:
        laws = [named(name) for name in arguments.names or NAMES]
    except IntentError as error:
        print(f"camgeo: {error.message}", file=sys.stderr)
        return WRONG
    if arguments.picture and (status := _draw(laws, Path(arguments.picture))) != OK:
        return status
    print(_json(laws) if arguments.json else _table(laws))
    return OK


def _json(laws: list[Law]) -> str:
    from camgeo.report.document import finite
    from kin.law.sources.laws import formula

    rows: list[dict[str, Any]] = [
        {
            "law": law.name,
            "velocity": top.velocity,
            "acceleration": top.acceleration,
            "jerk": top.jerk,
            "formula": formula(law.name),
        }
        for law, top in ((law, peaks(law.motion)) for law in laws)
    ]
    return json.dumps(finite(rows), indent=2)


def _table(laws: list[Law]) -> str:
    from kin.law.sources.laws import formula

    width = max(len(law.name) for law in laws)
    lines = [
        f"{'law'.ljust(width)}  velocity  acceleration      jerk  displacement (peaks for unit stroke over unit time)"
    ]
    for law in laws:
        p = peaks(law.motion)
        figures = f"{p.velocity:8.6f}  {p.acceleration:12.6f}  {p.jerk:8.6g}"
        lines.append(f"{law.name.ljust(width)}  {figures}  {formula(law.name)}")
    return "\n".join([*lines, "", "also: {polynomial: [c0, c1, ...]} in u, from 0 to 1"])


def _draw(laws: list[Law], path: Path) -> int:
    if path.suffix.lower() not in (".svg", ".png"):
        print(f"camgeo: {path}: a picture is .svg or .png", file=sys.stderr)
        return WRONG
    try:
        content = _svg(laws).encode() if path.suffix.lower() == ".svg" else _png(laws)
        path.write_bytes(content)
    except ModuleNotFoundError as error:
        print(f"camgeo: the package {error.name} is missing: {install('picture')}", file=sys.stderr)
        return SURROUNDINGS
    except OSError as error:
        print(f"camgeo: {path}: {error.strerror}", file=sys.stderr)
        return SURROUNDINGS
    return OK


def _curves(law: Law) -> list[tuple[Array, Array]]:
    """Pairs of u (n,) and of displacement, velocity, acceleration and jerk (4, n) on each stretch of a law.

    At the knots they are the limits from within the stretch, so that no step is drawn slanted.
    """
    curves = []
    for begin, end in pairwise(law.motion.knots.tolist()):
        u = np.linspace(begin, end, _POINTS)
        side = np.where(np.arange(_POINTS) == _POINTS - 1, -1, 1)
        curves.append((u, law.motion.derivatives(u, 3, side)))
    return curves


def _scales(curves: list[tuple[Array, Array]]) -> list[float]:
    """Greatest absolute value of each of the four curves, for drawing it within -1 to 1; 1 where it is 0 throughout."""
    tops = np.max([np.abs(rows).max(axis=1) for _, rows in curves], axis=0)
    return [float(top) or 1.0 for top in tops]


def _svg(laws: list[Law]) -> str:
    rows = math.ceil(len(laws) / _COLUMNS)
    columns = min(_COLUMNS, len(laws))
    cell_x, cell_y = _WIDTH + 2 * _MARGIN, _HEIGHT + _HEAD + 2 * _MARGIN
    size = f"{columns * cell_x} {rows * cell_y + 2 * _MARGIN}"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" font-family="sans-serif" font-size="11">',
        "<title>Motion laws: each curve against its own peak</title>",
    ]
    parts += [
        f'<text x="{_MARGIN + 90 * k}" y="{_MARGIN + 4}" fill="{colour}">{word}</text>'
        for k, (word, colour) in enumerate(zip(_CURVES, _COLOURS, strict=True))
    ]
    for i, law in enumerate(laws):
        x, y = (i % _COLUMNS) * cell_x + _MARGIN, (i // _COLUMNS) * cell_y + 2 * _MARGIN
        parts.append(f'<g transform="translate({x} {y})">{_frame(law)}</g>')
    return "\n".join([*parts, "</svg>", ""])


def _frame(law: Law) -> str:
    """SVG group of one law: its name, its peaks, and its four curves, each drawn within its own peak."""
    curves, p = _curves(law), peaks(law.motion)
    scales = _scales(curves)
    figures = ", ".join(f"{value:.5g}" for value in (p.velocity, p.acceleration, p.jerk))
    middle = _HEAD + _HEIGHT / 2
    parts = [
        f'<text y="10" font-weight="bold">{law.name}</text><text y="24" fill="#555555">{figures}</text>',
        f'<rect y="{_HEAD}" width="{_WIDTH}" height="{_HEIGHT}" fill="none" stroke="#cccccc"/>',
        f'<path d="M0 {middle:g}H{_WIDTH}" stroke="#cccccc"/>',
    ]
    for k in (3, 2, 1, 0):
        path = ""
        for u, rows in curves:
            x, y = u * _WIDTH, middle - rows[k] / scales[k] * _HEIGHT / 2
            path += "M" + "L".join(f"{a:.2f} {b:.2f}" for a, b in zip(x.tolist(), y.tolist(), strict=True))
        parts.append(f'<path d="{path}" fill="none" stroke="{_COLOURS[k]}"><title>{_CURVES[k]}</title></path>')
    return "".join(parts)


def _png(laws: list[Law]) -> bytes:
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context():
        mpl.rcdefaults()
        rows, columns = math.ceil(len(laws) / _COLUMNS), min(_COLUMNS, len(laws))
        figure = Figure(figsize=(2.8 * columns, 2.1 * rows + 0.4), layout="constrained")
        axes = np.atleast_1d(figure.subplots(rows, columns, sharex=True, sharey=True)).ravel()
        for axis, law in zip(axes, laws, strict=False):
            curves, p = _curves(law), peaks(law.motion)
            for k, scale in enumerate(_scales(curves)):
                for i, (u, values) in enumerate(curves):
                    label = _CURVES[k] if i == 0 else None
                    axis.plot(u, values[k] / scale, color=_COLOURS[k], linewidth=1.0, label=label)
            axis.set_title(f"{law.name}\n{p.velocity:.5g}, {p.acceleration:.5g}, {p.jerk:.5g}", fontsize=8)
        for axis in axes[len(laws) :]:
            axis.set_axis_off()
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
        stream = io.BytesIO()
        figure.savefig(stream, format="png", dpi=110, metadata={"Software": None})
    return stream.getvalue()
