"""Records of formats: a made-up one is asked for, written, read and judged; one that is taken out is unknown.

Holds: camgeo.formats.csv, camgeo.formats.meshes.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import pytest

import camgeo
from camgeo.checks.extension import Holes
from camgeo.formats import csv
from camgeo.formats.meshes import mesh_format, mesh_making
from camgeo.formats.tables import polar
from camgeo.output.extension import MAKING, Making, numbers_of
from camgeo.registry import formats, registry
from camgeo.registry.formats import FORMATS, MODULES, Format
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.intent import FileIntent
from kin.numeric.records import replace
from kin.read import formats as read

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from camgeo.files.mesh import Item

CAM = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 12}\nmanufacture: {wheel: 400}\n"
MANY = [name for name in MODULES if name != "step"]  # which needs a package of its own


@pytest.fixture(autouse=True)
def in_order() -> Iterator[None]:
    """Put back what a test takes out in its place: monkeypatch adds it behind all others."""
    tables: list[dict] = [MODULES, csv.MODULES, read.FORMATS]
    kept = [dict(table) for table in tables]
    yield
    for table, entries in zip(tables, kept, strict=True):
        table.clear()
        table.update(entries)


def recipe(files: str) -> camgeo.Recipe:
    return camgeo.load(f"{CAM}export: {{tolerance: 0.01, files: [{files}]}}\nverify: {{angles: 36}}\n")


def test_every_record_has_an_entry_where_its_files_are_read() -> None:
    judged = {
        name for name, record in FORMATS.items() if record.contour or any(f.ground for f in record.forms.values())
    }
    assert judged <= set(read.FORMATS)
    assert [record.name for record in FORMATS.values()] == [*MODULES, *registry.formats()]
    for name in judged:
        record, entry = FORMATS[name], read.FORMATS[name]
        assert f".{record.ending}" in entry.suffixes
        assert record.units == entry.units
        assert record.solid == (entry.contents == "solid")
        assert record.program == (entry.contents == "program")


@pytest.mark.slow
@pytest.mark.parametrize("name", MANY)
def test_without_a_format_all_others_are_made(name: str, tmp_path: Path) -> None:
    del MODULES[name]
    others = [other for other in MANY if other != name]
    with pytest.raises(RecipeErrors) as caught:
        recipe(name)
    assert f"export.files[0]: unknown file format, given '{name}'; give " in str(caught.value)
    assert f"{name}," not in str(caught.value).partition("; give ")[2]
    report = camgeo.export(recipe(", ".join(others)), tmp_path)
    assert report.ok
    assert {file.kind for file in report.files} == set(others)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["motion", "polar", "inspection", "grinding"])
def test_without_a_table_its_word_is_unknown(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = tuple(other for other in csv.MODULES if other != name)
    table = csv.FORMAT.options
    fields = tuple(replace(item, choices=kept) if item.name == "as" else item for item in table.fields)
    changed = replace(csv.FORMAT, options=replace(table, fields=fields), forms={k: csv.FORMS[k] for k in kept})
    monkeypatch.setattr(csv, "FORMAT", changed)
    monkeypatch.setattr(FORMATS, "_values", {})
    with pytest.raises(RecipeErrors, match=f"not one of the choices, given '{name}'"):
        recipe(f"{{csv: {{as: {name}}}}}")
    assert camgeo.export(recipe("{csv: {as: contacts}}, dxf"), tmp_path).ok


@pytest.mark.slow
def test_a_made_up_format_is_one_of_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Triangles as plain numbers: a record with a writer, an entry with a reader, and nothing else."""

    def write(path: Path, items: Sequence[Item], _title: str, mm: float, _about: str) -> None:
        (item,) = items
        np.savetxt(path, (item.mesh.points[item.mesh.triangles] / mm).reshape(-1, 9), fmt="%.17g")

    def triangles(raw: bytes, _path: Path):
        return np.array(raw.split(), dtype=np.float64).reshape(-1, 3, 3), "text"

    module = ModuleType("made_up")
    vars(module)["FORMAT"] = mesh_format("raw", units=False)
    vars(module)["MAKING"] = mesh_making(MAKING["ply"].numbers, write)
    monkeypatch.setitem(sys.modules, "made_up", module)
    MODULES["raw"] = "made_up"
    read.FORMATS["raw"] = read.mesh("raw", 10**8, (".raw", ".tri"), triangles, units=False)
    asked = recipe("raw, {raw: {kerf: 0.2}}, {raw: {units: inch}}, dxf")
    report = camgeo.export(asked, tmp_path)
    assert report.ok
    paths = [file.path for file in report.files]
    assert [path.suffix for path in paths] == [".raw", ".raw", ".raw", ".dxf"]
    assert camgeo.verify(asked, *paths).ok
    other = paths[0].with_suffix(".tri")
    other.write_bytes(paths[0].read_bytes())
    assert camgeo.verify(asked, other, units="mm").ok
    lines = paths[0].read_text().splitlines()
    other.write_text("\n".join(lines[1:]))
    assert not camgeo.verify(asked, other, units="mm").ok


def test_a_made_up_table_is_one_of_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("made_up_table")
    vars(module)["FORM"] = replace(polar.FORM, name="round")
    monkeypatch.setitem(sys.modules, "made_up_table", module)
    csv.MODULES["round"] = "made_up_table"
    report = camgeo.export(recipe("{csv: {as: round}}"), tmp_path)
    assert report.files[0].path.read_text().startswith("polar_deg,radius_mm\n")


def test_a_format_that_makes_nothing_says_so() -> None:
    with pytest.raises(ValueError, match="html holds no mesh"):
        numbers_of("html", 1.0)


def test_what_layers_ask_of_formats_bears_the_name_by_which_they_ask() -> None:
    names = {Format: "FORMAT", Making: "MAKING", Holes: "HOLES", FileIntent: "INTENT"}
    for path in (MODULES | registry.formats()).values():
        stated = {name: names[type(value)] for name, value in vars(import_module(path)).items() if type(value) in names}
        assert all(name == asked for name, asked in stated.items())
        assert {"FORMAT", "MAKING"} <= stated.keys()


def test_a_summary_and_a_mesh_are_made_as_such() -> None:
    for name, record in FORMATS.items():
        making = MAKING[name]
        assert record.summary == (making.summarise is not None) == (making.make is None)
        assert record.mesh == (making.numbers is not None)


def test_what_a_format_states_of_another_class_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "HOLES", "all", raising=False)
    with pytest.raises(TypeError, match=r"camgeo\.formats\.csv: HOLES is no Holes"):
        formats.of_formats("HOLES", Holes())["csv"]
