"""The files of a sweep as bytes by name, and those left out, with the reason."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.gather import MOST_ROWS
from camgeo.capabilities.sweep.keys import sweep_figures
from camgeo.capabilities.sweep.pictures import draw_best, draw_map
from camgeo.capabilities.sweep.recipes import curve_of, recipe_text
from camgeo.capabilities.sweep.table import as_csv, as_parquet, columns, with_polished
from camgeo.files.errors import install
from camgeo.recipe.figures import FIGURES, OF_DWELL
from camgeo.recipe.loading import read
from camgeo.report.document import as_json, file_entry
from camgeo.version import __version__
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.sweep.gather import Certificate, Nearest, Selection
    from camgeo.capabilities.sweep.plan import Axis
    from camgeo.capabilities.sweep.recipes import Best
    from camgeo.capabilities.sweep.task import Task, Unit
    from camgeo.checks.remedies import Entry

REPORT = "sweep.json"
TABLES = ("sweep.csv", "sweep.parquet")
PICTURES = ("sweep-map.png", "sweep-map.svg", "sweep-best.png", "sweep-best.svg")
EXTRA = install("sweep")
_DRAWN = 10  # best designs in the picture of curves


@dataclass()
class Files:
    """Bytes of files by name, and entries `what`, `why` for those left out."""

    contents: dict[str, bytes] = field(default_factory=dict)
    skipped: list[dict[str, str]] = field(default_factory=list)

    def add(self, names: Sequence[str], write: Callable[[], Sequence[bytes]]) -> None:
        """Add files of these names, or, where a package is missing, an entry that says so."""
        try:
            self.contents.update(zip(names, write(), strict=True))
        except ModuleNotFoundError as error:
            why = f"the package {error.name} is missing: {EXTRA}"
            self.skipped.append({"what": ", ".join(names), "why": why})


def outputs(
    task: Task, designs: Selection, best: Sequence[Best], run: Entry, reasons: Sequence[str] = ()
) -> tuple[dict[str, bytes], Entry]:
    """All files of a sweep, `sweep.json` among them, and that report. Its `run` alone depends on how it was computed.

    `reasons` are the words for the codes of why a design has no figures.
    """
    files = Files()
    units = task.units(designs.figures)
    table, marks = with_polished(designs, best, task.ranking)
    if not task.sweep.refine:
        del marks["polished"]
    heads = columns(task.plan, table, units, marks)
    files.add(TABLES[:1], lambda: [as_csv(heads)])
    about = {"recipe": task.recipe.name, "camgeo": __version__, "units": task.recipe.units}
    files.add(TABLES[1:], lambda: [as_parquet(heads, about)])
    files.add(PICTURES[:2], lambda: _map_pictures(task, designs, best))
    for design in best:
        files.contents[design.file] = recipe_text(task, design).encode()
    if best:
        files.add(PICTURES[2:], lambda: _curve_pictures(task, best, files.contents))
    report = _report(task, designs, best, reasons)
    report["counts"]["rows"] = table.rows
    report["screen"] = None if task.recipe.linkage is not None else _screen(task, designs.certificate)
    for design in best:
        if design.why:
            files.skipped.append({"what": f"polishing {design.file}", "why": design.why})
    report["files"] = [file_entry(name, data) for name, data in files.contents.items()]
    report["skipped"] = files.skipped
    report["run"] = run
    files.contents[REPORT] = as_json(report).encode()
    return files.contents, report


def _label(name: str, unit: str) -> str:
    """Label of an axis: `name (unit)`."""
    return f"{name} ({unit})" if unit else name


def _map_pictures(task: Task, designs: Selection, best: Sequence[Best]) -> list[bytes]:
    """The map as PNG and SVG."""
    rank = task.sweep.rank
    unit = task.units([rank])[rank]
    paths = [axis.path for axis in task.plan.axes]
    flat = len(paths) > 1
    counts = designs.counts
    notes = f"{counts.kept:,} of {counts.computed:,} designs kept"
    if FIGURES[rank].needs is OF_DWELL:
        notes += f"; band of {_band(task)}"
    if len(paths) > 2:
        others = " and ".join(filter(None, (", ".join(paths[2:-1]), paths[-1])))
        notes += f"; each cell shows the best over {others}"
    cells = designs.cells.scaled(1.0 / unit.divisor)
    places = [[b.values[paths[0]], b.values[paths[1]] if flat else b.figures[rank] / unit.divisor] for b in best]
    pictures = draw_map(
        f"{task.recipe.name}: {FIGURES[rank].about.split(',')[0]}",
        cells,
        _label(rank, unit.name),
        [_label(path, task.axis_unit(path)) for path in paths[:2]],
        np.array(places).reshape(-1, 2),
        notes=notes,
    )
    return [pictures["png"], pictures["svg"]]


def _band(task: Task) -> str:
    """Band of the recipe's dwells, with its unit."""
    if task.recipe.dwell is None:
        raise ValueError(f"{task.recipe.name} has no dwell")
    unit = task.units(["swing"])["swing"]
    band = task.recipe.dwell.band
    return f"{(math.degrees(band) if unit.name == 'deg' else band / unit.divisor):.6g} {unit.name}"


def _curve_pictures(task: Task, best: Sequence[Best], files: dict[str, bytes]) -> list[bytes]:
    """The best designs' curves as PNG and SVG."""
    rank = task.sweep.rank
    unit = task.units([rank])[rank]
    curves, name = [], ""
    for design in best[:_DRAWN]:
        recipe = read(files[design.file], design.file)
        value = f"{design.figures[rank] / unit.divisor:.5g} {unit.name}".rstrip()
        curve, name = curve_of(recipe, f"best-{design.place}: {rank} {value}")
        curves.append(curve)
    notes = f"shaded: the longest dwell of best-1, band of {_band(task)}" if curves[0].dwell is not None else ""
    count = "the best design" if len(curves) == 1 else f"the best {len(curves)} designs"
    pictures = draw_best(f"{task.recipe.name}: {count}", curves, name, notes=notes)
    return [pictures["png"], pictures["svg"]]


def _report(task: Task, designs: Selection, best: Sequence[Best], reasons: Sequence[str]) -> Entry:
    """The report: the sweep, its counts and its best designs, figures in the recipe's units."""
    sweep, counts, units = task.sweep, designs.counts, task.units(sweep_figures())
    bounds = {
        limit.figure: {
            name: value / units[limit.figure].divisor
            for name, value in (("at_least", limit.at_least), ("at_most", limit.at_most))
            if value is not None
        }
        for limit in sweep.limits
    }
    return {
        "recipe": task.recipe.name,
        "about": task.recipe.about,
        "camgeo": __version__,
        "units": task.recipe.units,
        "ok": counts.kept > 0,
        "sweep": {
            "vary": {axis.path: _axis(axis) for axis in task.plan.axes},
            "method": sweep.method,
            "count": task.plan.count,
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
            for name in sweep_figures()
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
        else _nearest(task, designs.nearest, units[designs.nearest.limit.figure]),
        "best": [
            {
                "file": design.file,
                "index": design.index,
                "polished": design.polished,
                "values": task.values_by_path(design.values.values()),
                "figures": {name: value / units[name].divisor for name, value in design.figures.items()},
            }
            for design in best
        ],
    }


def _screen(task: Task, certificate: Certificate | None) -> Entry:
    """Whether figures are estimates; if so, what was computed exactly, and the errors of the estimates."""
    if certificate is None:
        return {"used": False, "why": task.unscreened}
    from camgeo.capabilities.sweep.screen import DESIGNS, estimates

    return {
        "used": True,
        "estimates": "figures of designs that are not certified, from samples of their motion",
        "certified": certificate.designs,
        "fell": certificate.rejected,
        "greatest_error": {
            name: {
                "unit": "deg" if estimates()[name].in_degrees else "share of the value",
                f"of {DESIGNS} random designs": estimates()[name].error,
                "of the designs worked out here": error,
            }
            for name, error in certificate.errors.items()
        },
    }


def _nearest(task: Task, near: Nearest, unit: Unit) -> Entry:
    """The design that misses the limits by least where none keeps them, its figure in the recipe's unit."""
    return {
        "index": near.index,
        "values": task.values_by_path(near.values),
        "breaks": near.limit.figure,
        "value": near.value / unit.divisor,
        "unit": unit.name,
    }


def _axis(axis: Axis) -> Entry:
    if axis.words:
        return {"words": list(axis.words), "values": len(axis.words)}
    return {"from": axis.low, "to": axis.high, "values": len(axis.values) or None}
