"""The files of a sweep as bytes by name, and what is left out of them and why."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.gather import MOST_ROWS
from camgeo.capabilities.sweep.keys import swept
from camgeo.capabilities.sweep.pictures import draw_best, draw_map
from camgeo.capabilities.sweep.recipes import curve_of, loaded, recipe_text
from camgeo.capabilities.sweep.table import as_csv, as_parquet, columns, with_polished
from camgeo.files.errors import install
from camgeo.recipe.figures import FIGURES, OF_DWELL
from camgeo.report.document import encoded
from camgeo.report.listed import listed
from camgeo.version import __version__
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.sweep.ask import Ask, Unit
    from camgeo.capabilities.sweep.gather import Certificate, Gathered, Nearest
    from camgeo.capabilities.sweep.plan import Axis
    from camgeo.capabilities.sweep.recipes import Best
    from camgeo.checks.remedies import Entry

REPORT = "sweep.json"
TABLES = ("sweep.csv", "sweep.parquet")
PICTURES = ("sweep-map.png", "sweep-map.svg", "sweep-best.png", "sweep-best.svg")
EXTRA = install("sweep")
_DRAWN = 10  # best designs in the picture of curves


@dataclass()
class Files:
    """Files made so far, and those left out with the reason."""

    made: dict[str, bytes] = field(default_factory=dict)
    skipped: list[dict[str, str]] = field(default_factory=list)

    def make(self, names: Sequence[str], write: Callable[[], Sequence[bytes]]) -> None:
        """Add files, unless a package is missing: then say so."""
        try:
            self.made.update(zip(names, write(), strict=True))
        except ModuleNotFoundError as error:
            why = f"the package {error.name} is missing: {EXTRA}"
            self.skipped.append({"what": ", ".join(names), "why": why})


def outputs(
    ask: Ask,
    designs: Gathered,
    best: Sequence[Best],
    run: Entry,
    reasons: Sequence[str] = (),
) -> tuple[dict[str, bytes], Entry]:
    """All files of a sweep, `sweep.json` among them, and what that says. Only its `run` depends on how it was run.

    `reasons` are the words for the numbers of why a design does not turn.
    """
    files = Files()
    units = ask.units(designs.figures)
    table, marks = with_polished(designs, best, ask.ranking)
    told = {name: mark for name, mark in marks.items() if ask.sweep.refine or name != "polished"}
    heads = columns(ask.plan, table, units, told)
    files.make(TABLES[:1], lambda: [as_csv(heads)])
    about = {"recipe": ask.recipe.name, "camgeo": __version__, "units": ask.recipe.units}
    files.make(TABLES[1:], lambda: [as_parquet(heads, about)])
    files.make(PICTURES[:2], lambda: _map(ask, designs, best))
    for design in best:
        files.made[design.file] = recipe_text(ask, design).encode()
    if best:
        files.make(PICTURES[2:], lambda: _curves(ask, best, files.made))
    report = _report(ask, designs, best, reasons)
    report["counts"]["rows"] = table.rows
    report["screen"] = None if ask.recipe.linkage is not None else _screen(ask, designs.certificate)
    for design in best:
        if design.why:
            files.skipped.append({"what": f"polishing {design.file}", "why": design.why})
    report["files"] = [listed(name, data) for name, data in files.made.items()]
    report["skipped"] = files.skipped
    report["run"] = run
    files.made[REPORT] = encoded(report).encode()
    return files.made, report


def _named(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def _map(ask: Ask, designs: Gathered, best: Sequence[Best]) -> list[bytes]:
    """The map as PNG and SVG."""
    rank = ask.sweep.rank
    unit = ask.units([rank])[rank]
    paths = [axis.path for axis in ask.plan.axes]
    flat = len(paths) > 1
    counts = designs.counts
    notes = f"{counts.kept:,} of {counts.computed:,} designs kept"
    if FIGURES[rank].needs is OF_DWELL:
        notes += f"; band of {_band(ask)}"
    if len(paths) > 2:
        notes += f"; each cell shows the best over {_and(paths[2:])}"
    cells = designs.cells.scaled(1.0 / unit.divisor)
    places = [[b.values[paths[0]], b.values[paths[1]] if flat else b.figures[rank] / unit.divisor] for b in best]
    pictures = draw_map(
        f"{ask.recipe.name}: {FIGURES[rank].about.split(',')[0]}",
        cells,
        _named(rank, unit.name),
        [_named(path, ask.axis_unit(path)) for path in paths[:2]],
        np.array(places).reshape(-1, 2),
        notes=notes,
    )
    return [pictures["png"], pictures["svg"]]


def _band(ask: Ask) -> str:
    """Band of the recipe's dwells, in words."""
    if ask.recipe.dwell is None:
        raise ValueError(f"{ask.recipe.name} has no dwell")
    unit = ask.units(["swing"])["swing"]
    band = ask.recipe.dwell.band
    return f"{(math.degrees(band) if unit.name == 'deg' else band / unit.divisor):.6g} {unit.name}"


def _and(paths: Sequence[str]) -> str:
    return paths[0] if len(paths) == 1 else f"{', '.join(paths[:-1])} and {paths[-1]}"


def _curves(ask: Ask, best: Sequence[Best], files: dict[str, bytes]) -> list[bytes]:
    """The best designs' curves as PNG and SVG."""
    rank = ask.sweep.rank
    unit = ask.units([rank])[rank]
    curves, name = [], ""
    for design in best[:_DRAWN]:
        recipe = loaded(files[design.file].decode(), design)
        value = f"{design.figures[rank] / unit.divisor:.5g} {unit.name}".rstrip()
        curve, name = curve_of(recipe, f"best-{design.place}: {rank} {value}")
        curves.append(curve)
    notes = f"shaded: the longest dwell of best-1, band of {_band(ask)}" if curves[0].dwell is not None else ""
    count = "the best design" if len(curves) == 1 else f"the best {len(curves)} designs"
    pictures = draw_best(f"{ask.recipe.name}: {count}", curves, name, notes=notes)
    return [pictures["png"], pictures["svg"]]


def _report(ask: Ask, designs: Gathered, best: Sequence[Best], reasons: Sequence[str]) -> Entry:
    """What was asked and what came of it, figures in the recipe's units."""
    sweep, counts, units = ask.sweep, designs.counts, ask.units(swept())
    bounds = {
        limit.figure: {
            name: value / units[limit.figure].divisor
            for name, value in (("at_least", limit.at_least), ("at_most", limit.at_most))
            if value is not None
        }
        for limit in sweep.limits
    }
    return {
        "recipe": ask.recipe.name,
        "about": ask.recipe.about,
        "camgeo": __version__,
        "units": ask.recipe.units,
        "ok": counts.kept > 0,
        "sweep": {
            "vary": {axis.path: _axis(axis) for axis in ask.plan.axes},
            "method": sweep.method,
            "count": ask.plan.count,
            "seed": None if sweep.method == "grid" else sweep.seed,
            "angles": sweep.angles,
            "limits": bounds,
            "rank": sweep.rank,
            "best": FIGURES[sweep.rank].best,
            "keep": sweep.keep,
            "refine": sweep.refine,
        },
        "figures": {
            name: {"unit": units[name].name, "about": FIGURES[name].about, "in_table": name in designs.figures}
            for name in swept()
            if name in designs.figures or any(name in design.figures for design in best)
        },
        "counts": {
            "computed": counts.computed,
            "not_turning": counts.not_turning,
            "reasons": {reasons[number]: count for number, count in counts.reasons},
            "failing": dict(counts.failing),
            "kept": counts.kept,
            "rows": designs.rows,
            "most_rows": MOST_ROWS,
        },
        "nearest": None
        if designs.nearest is None
        else _nearest(ask, designs.nearest, units[designs.nearest.limit.figure]),
        "best": [
            {
                "file": design.file,
                "index": design.index,
                "polished": design.polished,
                "values": ask.told(design.values),
                "figures": {name: value / units[name].divisor for name, value in design.figures.items()},
            }
            for design in best
        ],
    }


def _screen(ask: Ask, certificate: Certificate | None) -> Entry:
    """Whether figures are estimates, and if so what was worked out exactly and what estimates may be off by."""
    if certificate is None:
        return {"used": False, "why": ask.unscreened}
    from camgeo.capabilities.sweep.estimate_errors import DESIGNS
    from camgeo.capabilities.sweep.screen import estimates

    return {
        "used": True,
        "estimates": "figures of designs that are not certified, from samples of their motion",
        "certified": certificate.designs,
        "fell": certificate.fell,
        "greatest_error": {
            name: {
                "unit": "deg" if estimates()[name].in_degrees else "share of the value",
                f"of {DESIGNS} random designs": estimates()[name].error,
                "of the designs worked out here": off,
            }
            for name, off in certificate.off.items()
        },
    }


def _nearest(ask: Ask, near: Nearest, unit: Unit) -> Entry:
    """The design that comes nearest to the limits where none keeps them, its figure in the recipe's unit."""
    return {
        "index": near.index,
        "values": {axis.path: axis.told(float(v)) for axis, v in zip(ask.plan.axes, near.values, strict=True)},
        "breaks": near.limit.figure,
        "value": near.value / unit.divisor,
        "unit": unit.name,
    }


def _axis(axis: Axis) -> Entry:
    if axis.words:
        return {"words": list(axis.words), "values": len(axis.words)}
    return {"from": axis.low, "to": axis.high, "values": len(axis.values) or None}
