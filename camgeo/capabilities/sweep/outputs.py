"""The files of a sweep as bytes by name, and those left out, with the reason.

They are the table of the designs kept, best first, as CSV and as Parquet; the best designs as complete recipes;
pictures of the map and of the best designs' output over the shaft angle; and the report.
"""

from __future__ import annotations

import csv
import io
import json
import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.gather import MOST_ROWS
from camgeo.capabilities.sweep.keys import sweep_figures
from camgeo.capabilities.sweep.pictures import OutputCurve, draw_best, draw_map
from camgeo.capabilities.sweep.single_designs import mechanism_in, text_with
from camgeo.files.errors import install
from camgeo.recipe.figures import FIGURES, OF_DWELL
from camgeo.recipe.loading import read
from camgeo.report.document import file_entry
from camgeo.schema.change import set_value
from camgeo.schema.edit import remove_section
from camgeo.schema.scalars import MOST_TEXT
from camgeo.schema.yaml_source import Mapping, Source, scalars
from camgeo.version import __version__
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.gather import Certificate, Nearest, Ranking, Selection
    from camgeo.capabilities.sweep.keys import Axis
    from camgeo.capabilities.sweep.plan import Plan
    from camgeo.capabilities.sweep.task import SweepTask, Unit
    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array, Mask

    Marks = dict[str, Mask]
    Columns = dict[str, Array | NDArray[np.int64] | NDArray[np.str_]]

REPORT = "sweep.json"
TABLES = ("sweep.csv", "sweep.parquet")
PICTURES = ("sweep-map.png", "sweep-map.svg", "sweep-best.png", "sweep-best.svg")
EXTRA = install("sweep")
_NO_VALUE = "no-value"  # why a design without a fault does not count: one of its figures has none
_DRAWN = 10  # best designs in the picture of curves
_POINTS = 720  # of a curve, over a turn


@dataclass(frozen=True)
class Best:
    """A best design: its `place`, counted from 1, and its `index` in the plan, which polishing leaves as it is.

    `values` are by path, in the recipe's units, words by their index; `figures` by name, in mm and degrees. `why` says
    why the design could not be polished, and is empty where it was, or polishing was not tried.
    """

    place: int
    index: int
    polished: bool
    values: dict[str, float]
    figures: dict[str, float]
    why: str = ""

    @property
    def file(self) -> str:
        """Name of the file of the design's recipe."""
        return f"best-{self.place}.yaml"


def recipe_text(task: SweepTask, best: Best) -> str:
    """Text of the user's recipe with the design's values, a name of its own, its figures in `about`, and no sweep.

    Raises RecipeErrors where the sweep cannot be cut out of the text.
    """
    text = text_with(task.recipe, best.values)
    for section in ("sweep", "name", "about"):
        text = remove_section(text, section)
    for path in task.recipe.tables:
        source = Source.of(text, str(task.recipe.path))  # as the best design's recipe is in another folder
        file = dict(scalars(source.root))[path].text
        text = set_value(source, path, (task.recipe.path.parent / file).resolve().as_posix())
    name = f"{task.recipe.name}-best-{best.place}"
    return _with_entries(text, {"name": name, "about": _about(task, best)})


def _about(task: SweepTask, best: Best) -> str:
    """The design's origin and ranking figure, then as much of the recipe's own note as fits."""
    origin = f"polished from design {best.index}" if best.polished else f"design {best.index}"
    rank = task.sweep.rank
    unit = task.units([rank])[rank]
    figure = f"{rank} {best.figures[rank] / unit.divisor:.6g} {unit.name}".rstrip() if rank in best.figures else ""
    text = f"{origin} of {task.plan.count} of the sweep of {task.recipe.name}: {figure}"
    if task.recipe.about:
        text += f". {task.recipe.about}"
    return text if len(text) <= MOST_TEXT else text[: MOST_TEXT - 3] + "..."


def _with_entries(text: str, entries: dict[str, str]) -> str:
    """Text of a recipe with entries put first, in flow or block style as the recipe is."""
    root = Source.of(text, "recipe").root
    if not isinstance(root, Mapping):
        raise TypeError("a recipe is a mapping")
    line, column = root.mark
    lines = text.splitlines(keepends=True)
    index = sum(map(len, lines[: line - 1])) + column - 1
    items = [f"{name}: {json.dumps(value, ensure_ascii=False)}" for name, value in entries.items()]
    if root.flow:
        return text[: index + 1] + ", ".join(items) + ", " + text[index + 1 :]
    indent = " " * (column - 1)
    return text[:index] + "".join(f"{item}\n{indent}" for item in items) + text[index:]


def curve_of(recipe: Recipe, label: str) -> tuple[OutputCurve, str]:
    """Output of a recipe's linkage over the shaft angle, or without one its cam's lift or swing; label of that axis.

    The output is in degrees or the recipe's unit of length. Raises PlaceError for a linkage that does not turn,
    TypeError for one on a cam without a lift, which no recipe has, and IntentError for a motion that no cam can have.
    """
    if recipe.linkage is None:
        from camgeo.synthesis.motion_table import motion_table

        at_points = replace(recipe, verify=replace(recipe.verify, angles=_POINTS))
        (_, name, *_), rows = motion_table(at_points, recipe.cam.exact().motion)
        word, _, unit = name.partition("_")
        return OutputCurve(label, rows[:, 0], rows[:, 1]), f"{word} ({unit})"
    mechanism = mechanism_in(recipe)
    shaft = np.linspace(0.0, 2.0 * math.pi, _POINTS + 1)
    output = mechanism.at(mechanism.relative(shaft), 0).output[0]
    swings = mechanism.unit == "deg"
    scale = math.degrees(1.0) if swings else 1.0 / recipe.mm
    unit = "deg" if swings else {"mm": "mm", "inch": "in"}[recipe.units]
    dwell = None
    if recipe.dwell is not None:
        longest = mechanism.dwells(recipe.dwell.band, most=1)[0]
        dwell = math.degrees(longest.start), math.degrees(longest.length)
    return OutputCurve(label, np.degrees(shaft), output * scale, dwell), f"output ({unit})"


def with_polished(designs: Selection, best: Sequence[Best], ranking: Ranking) -> tuple[Selection, Marks]:
    """The designs kept and the polished ones, best first, at most MOST_ROWS; and marks (n,) of the designs by name.

    The mark `polished` is of a polished design; its index is the index of its start, whose own row stays. The mark
    `certified`, there only where figures are estimates, is of a design with exact figures; such designs come first.
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


def columns(plan: Plan, designs: Selection, units: dict[str, Unit], marks: Marks | None = None) -> Columns:
    """Columns (n,) by their heads: place from 1, index, the varied fields by their paths, figures in their units.

    `units` are by the figures' names; `marks` (n,) become the last columns, 0 or 1.
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
    """The columns as CSV below their heads, every number with as few digits as read back exactly."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(zip(*(column.tolist() for column in heads.values()), strict=True))
    return stream.getvalue().encode()


def as_parquet(heads: Columns, about: dict[str, str]) -> bytes:
    """The columns as Parquet, with `about` in the schema's metadata. Raises ModuleNotFoundError without pyarrow."""
    import pyarrow as pa
    from pyarrow import parquet

    table = pa.table({name: pa.array(column) for name, column in heads.items()})
    sink = pa.BufferOutputStream()
    parquet.write_table(table.replace_schema_metadata(dict(about)), sink, compression="zstd")
    return bytes(sink.getvalue().to_pybytes())


@dataclass()
class Files:
    """Bytes of files by name, and entries `what`, `why` for those left out; with `missing` for want of a package."""

    contents: dict[str, bytes] = field(default_factory=dict)
    skipped: list[dict[str, str | bool]] = field(default_factory=list)

    def add(self, names: Sequence[str], write: Callable[[], Sequence[bytes]]) -> None:
        """Add files with the contents that `write` returns in the order of `names`; skip them without a package."""
        try:
            self.contents.update(zip(names, write(), strict=True))
        except ModuleNotFoundError as error:
            why = f"the package {error.name} is missing: {EXTRA}"
            self.skipped.append({"what": ", ".join(names), "why": why, "missing": True})


def outputs(
    task: SweepTask, designs: Selection, best: Sequence[Best], reasons: Sequence[str] = ()
) -> tuple[dict[str, bytes], Entry]:
    """Contents of all files of a sweep by name but `sweep.json`, and the report that it holds, but for its `run`.

    `reasons` are words for the codes of why a design has no figures. Raises RecipeErrors where a best design's recipe
    cannot be written.
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
    # the report comes last, as it lists the files and those left out
    report = _report(task, designs, best, reasons)
    report["counts"]["rows"] = table.rows
    report["screen"] = None if task.recipe.linkage is not None else _screen(task, designs.certificate)
    for design in best:
        if design.why:
            files.skipped.append({"what": f"polishing {design.file}", "why": design.why})
    report["files"] = [file_entry(name, data) for name, data in files.contents.items()]
    report["skipped"] = files.skipped
    return files.contents, report


def _label(name: str, unit: str) -> str:
    """Label of an axis: `name (unit)`."""
    return f"{name} ({unit})" if unit else name


def _map_pictures(task: SweepTask, designs: Selection, best: Sequence[Best]) -> list[bytes]:
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
        axes = " and ".join(filter(None, (", ".join(paths[2:-1]), paths[-1])))
        notes += f"; each cell shows the best over {axes}"
    places = [[b.values[paths[0]], b.values[paths[1]] if flat else b.figures[rank] / unit.divisor] for b in best]
    pictures = draw_map(
        f"{task.recipe.name}: {FIGURES[rank].about.split(',')[0]}",
        designs.cells,
        _label(rank, unit.name),
        [_label(path, task.axis_unit(path)) for path in paths[:2]],
        np.array(places).reshape(-1, 2),
        divisor=unit.divisor,
        notes=notes,
    )
    return [pictures["png"], pictures["svg"]]


def _band(task: SweepTask) -> str:
    """Band of the recipe's dwells, with its unit."""
    if task.recipe.dwell is None:
        raise ValueError(f"{task.recipe.name} has no dwell")
    unit = task.units(["swing"])["swing"]
    band = task.recipe.dwell.band
    return f"{(math.degrees(band) if unit.name == 'deg' else band / unit.divisor):.6g} {unit.name}"


def _curve_pictures(task: SweepTask, best: Sequence[Best], files: dict[str, bytes]) -> list[bytes]:
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


def _report(task: SweepTask, designs: Selection, best: Sequence[Best], reasons: Sequence[str]) -> Entry:
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
            "reasons": {reasons[number] or _NO_VALUE: count for number, count in counts.reasons},
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


def _screen(task: SweepTask, certificate: Certificate | None) -> Entry:
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


def _nearest(task: SweepTask, near: Nearest, unit: Unit) -> Entry:
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
