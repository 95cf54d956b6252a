"""Rows of docs/validation.md, and the files they are measured on: recipe, pipeline, file, read back.

`python tests/validation/ledger.py` writes the tables anew; `test_document.py` holds the page against them.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from camgeo.output import pipeline
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load, read
from camgeo.synthesis.design import designed
from kin.read.files import read_drawing

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "tests"))  # where pytest has it; the page is written without pytest

from support.once import once  # noqa: E402
from support.page_tables import HEAD, cells, write  # noqa: E402

PAGE = ROOT / "docs" / "validation.md"
TOPICS = (
    "test_support_functions",
    "test_rabinowitz",
    "test_least_polygon",
    "test_motion_laws",
    "test_shu_wu",
    "test_disc_formulas",
    "test_wunderlich",
    "test_linkages",
    "test_frame_forces",  # needs: dynamics
    "test_indexing",  # needs: indexing
)
MISPRINT_HEAD = "| where | printed | right | measured | printed is off by |\n| --- | --- | --- | --- | --- |"


def shown(mark):
    """Rows of a table of the page, as lists of cells."""
    return cells(PAGE, mark)


@dataclass(frozen=True)
class Made:
    """A recipe exported to a folder, as its files give it."""

    recipe: Any
    report: dict
    folder: Path

    @cached_property
    def design(self):
        return designed(self.recipe)

    @cached_property
    def drawing(self):
        return read_drawing(self.folder / f"{self.recipe.name}.dxf")

    @cached_property
    def contour(self):
        """Outer contour in mm as if the shaft turned clockwise."""
        contour = self.drawing.contour
        return contour.mirrored() if self.recipe.rotation == "ccw" else contour

    @cached_property
    def motion(self):
        """The motion table by column."""
        return np.genfromtxt(self.folder / f"{self.recipe.name}.csv", delimiter=",", names=True)

    def value(self, check):
        return next(c["value"] for c in self.report["checks"] if c["name"] == check)

    @cached_property
    def normal_samples(self):
        """Points of the contour of lines and arcs, with outward normals: (n, 2) each, some 200 to a piece."""
        arcs = self.contour.as_arcs()[0]
        piece = np.repeat(np.arange(len(arcs)), 200)
        s = np.tile((np.arange(200) + 0.5) / 200, len(arcs)) * arcs.length[piece]
        chosen = arcs.take(piece)
        tangent = chosen.tangents(s)
        return chosen.points(s), np.column_stack([tangent[:, 1], -tangent[:, 0]])


class Workshop:
    """Exports each recipe once, for all processes of a run of the tests."""

    def __init__(self, out):
        self.out = Path(out)
        self._made = {}

    def shipped(self, name, as_="arcs", tolerance=None):
        """A shipped recipe as a DXF of one form and a motion table."""
        key = (name, as_, tolerance)
        if key not in self._made:
            recipe = load(ROOT / "recipes" / f"{name}.yaml")
            self._made[key] = self._export(recipe, as_, tolerance, self.out / f"{as_}-{tolerance}")
        return self._made[key]

    def written(self, name, text, as_="arcs"):
        """A recipe written out in a test."""
        if name not in self._made:
            self._made[name] = self._export(read(text.encode(), f"{name}.yaml"), as_, None, self.out / "written")
        return self._made[name]

    def _export(self, recipe, as_, tolerance, out):
        files = (FileRequest("dxf", as_, tolerance), FileRequest("csv"))
        recipe = replace(recipe, export=replace(recipe.export, files=files))

        def fill(folder):
            outcome = pipeline.export(recipe, folder)
            assert outcome.ok, [c for c in outcome.report["checks"] if not c["ok"]]

        folder = once(out / f"of-{recipe.name}", fill) / recipe.name
        return Made(recipe, json.loads((folder / "report.json").read_text(encoding="utf-8")), folder)


def measured(topic, workshop):
    """Rows of a topic, by the name of its module."""
    return import_module(topic).rows(workshop)


def misprints(workshop):
    return import_module("test_misprints").misprints(workshop)


def main():
    with TemporaryDirectory() as folder:
        workshop = Workshop(folder)
        found = {topic: measured(topic, workshop) for topic in TOPICS}
        wrong = [MISPRINT_HEAD, *(one.line() for one in misprints(workshop))]
    for row in (row for rows in found.values() for row in rows if not row.holds):
        print(f"{row.line()}  allowed {row.within}")
    for topic, rows in found.items():
        write(PAGE, topic, [HEAD, *(row.line() for row in rows)])
    write(PAGE, "misprints", wrong)


if __name__ == "__main__":
    main()
