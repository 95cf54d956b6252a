"""The page of a measured part: verdicts and figures as a table, plots over the turn; files written whole."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.common.errors import SurroundingsError
from camgeo.files.markup import one_line

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array

WIDE, HIGH, LEFT, FOOT, RIGHT = 860.0, 240.0, 70.0, 40.0, 26.0  # px of a plot, and of its margins
MOST_DOTS = 4000  # of points in a plot: more hide one another
INK, METAL, BAND, ZONE, DOT = "#1a1a1a", "#b3261e", "#f3c4bf", "#3b6ea5", "#8a8a8a"
NO_LIMIT = "measured, no limit given"
STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;max-width:900px;margin:2em auto;padding:0 1em;color:#1a1a1a}"
    "table{border-collapse:collapse}td,th{padding:.15em .8em .15em 0;text-align:left;vertical-align:top}"
    "svg{max-width:100%;height:auto}h2{font-size:1.1em;margin:1.6em 0 .4em}"
)


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file under another name, then rename it; raises SurroundingsError where the file system refuses."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(partial)
        partial.replace(path)
    except OSError as error:
        raise SurroundingsError(error.strerror or str(error), path.parent) from error


def heading(name: str, section: dict[str, Any]) -> str:
    """Name of the recipe and the files of points."""
    return f"<h1>{one_line(name)}</h1><p>{one_line(', '.join(section['files']))}</p>"


def findings(section: dict[str, Any], rows: Sequence[tuple[str, str]]) -> str:
    """Verdicts, a table of rows (label, value), and remarks."""
    words = [f"{key}: {word}" for key, word in section["verdicts"].items()] or [NO_LIMIT]
    verdicts = "".join(f"<p><b>{one_line(word)}</b></p>" for word in words)
    cells = "".join(f"<tr><td>{one_line(label)}</td><td>{one_line(value)}</td></tr>" for label, value in rows)
    remarks = "".join(f"<li>{one_line(text)}</li>" for text in section["remarks"])
    return f"{verdicts}<table>{cells}</table><ul>{remarks}</ul>"


def document(name: str, body: str) -> str:
    """Whole HTML page round a body, titled with the recipe's name."""
    return (
        '<!doctype html>\n<html lang="en"><meta charset="utf-8">'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">"
        f"<title>{one_line(name)}: as made</title><style>{STYLE}</style>\n<body>{body}</body></html>\n"
    )


def word(x: float, y: float, words: str, size: float, anchor: str) -> str:
    """Words in SVG, the foot of their letters at a place, in units of the drawing."""
    font = 'font-family="system-ui,sans-serif"'
    place = f'x="{x:.5g}" y="{y:.5g}" font-size="{size:.5g}" text-anchor="{anchor}"'
    return f'<text {place} {font} fill="{INK}">{words}</text>'


def pair(point: Array) -> str:
    """A place (2,) as coordinates of a path in SVG."""
    return f"{point[0]:.5g},{point[1]:.5g}"


def plot(x: Array, y: Array, band: Array, *, dots: tuple[Array, Array] | None = None, zone: float | None = None) -> str:
    """SVG of a curve over 360 degrees, (n,) each, with its uncertainty as a band, `dots` behind it, and +- `zone`."""
    reach = max(float(np.abs(y).max() + band.max()), _reach(dots, zone))
    # the turn is closed: from 0 on, and up to 360
    ends = [np.interp([0.0], x, row, period=360.0) for row in (y, band)]
    x, (y, band) = (
        np.array([0.0, *x, 360.0]),
        (np.concatenate([end, row, end]) for end, row in zip(ends, (y, band), strict=True)),
    )
    upper, lower, line = (
        [f"{a:.2f},{b:.2f}" for a, b in zip(_across(x), _up(row, reach), strict=True)]
        for row in (y + band, y - band, y)
    )
    parts = [
        f'<path d="M{"L".join(upper + lower[::-1])}Z" fill="{BAND}"/>',
        *_dotted(dots, reach),
        *_levels(zone, reach),
    ]
    parts.append(f'<path d="M{"L".join(line)}" stroke="{METAL}" stroke-width="1.6" fill="none"/>')
    return _framed([*parts, *_scales(zone, reach)])


def plot_points(dots: tuple[Array, Array], *, zone: float | None = None) -> str:
    """SVG of points over 360 degrees: degrees and values, (n,) each; with lines at +- `zone`."""
    reach = _reach(dots, zone)
    return _framed([*_dotted(dots, reach), *_levels(zone, reach), *_scales(zone, reach)])


def _reach(dots: tuple[Array, Array] | None, zone: float | None) -> float:
    """Greatest magnitude that a plot shows of its points and its zone."""
    return max(0.0 if dots is None else float(np.abs(dots[1]).max()), 1.1 * (zone or 0.0), 1e-9)


def _across(degrees: Array) -> Array:
    return LEFT + degrees * ((WIDE - LEFT - RIGHT) / 360.0)


def _up(value: Array, reach: float) -> Array:
    return np.asarray(0.5 * (HIGH - FOOT) - value * (0.46 * (HIGH - FOOT) / reach))


def _dotted(dots: tuple[Array, Array] | None, reach: float) -> list[str]:
    """Points, MOST_DOTS of them at most."""
    if dots is None:
        return []
    chosen = np.linspace(0, len(dots[0]) - 1, min(MOST_DOTS, len(dots[0]))).astype(np.intp)
    places = zip(_across(dots[0][chosen]), _up(dots[1][chosen], reach), strict=True)
    ticks = "".join(f"M{a:.1f},{b:.1f}h.01" for a, b in places)
    return [f'<path d="{ticks}" stroke="{DOT}" stroke-width="2" stroke-linecap="round"/>']


def _levels(zone: float | None, reach: float) -> list[str]:
    """Lines at 0 and at the ends of a zone, with their values."""
    parts = []
    for value, colour in ((zone, ZONE), (None if zone is None else -zone, ZONE), (0.0, INK)):
        if value is not None:
            height = float(_up(np.array(value), reach))
            dashes = ' stroke-dasharray="6 4"' if value else ""
            parts.append(f'<path d="M{LEFT},{height:.2f}H{WIDE - RIGHT}" stroke="{colour}" stroke-width="1"{dashes}/>')
            parts.append(
                f'<text x="{LEFT - 6}" y="{height + 4:.2f}" text-anchor="end" font-size="12">{value:.3g}</text>'
            )
    return parts


def _scales(zone: float | None, reach: float) -> list[str]:
    """Degrees below, and without a zone the greatest value beside."""
    parts = []
    for degrees in range(0, 361, 60):
        at = float(_across(np.array(float(degrees))))
        parts.append(f'<text x="{at:.1f}" y="{HIGH - 20.0}" text-anchor="middle" font-size="12">{degrees}</text>')
    if zone is None:
        top = float(_up(np.array(reach), reach))
        parts.append(f'<text x="{LEFT - 6}" y="{top + 10:.2f}" text-anchor="end" font-size="12">{reach:.3g}</text>')
    return parts


def _framed(parts: Sequence[str]) -> str:
    return f'<svg viewBox="0 0 {WIDE} {HIGH}" role="img" font-family="system-ui,sans-serif">{"".join(parts)}</svg>'
