"""Reading the recipe of an axis: its faults between keys, and its value."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.axis.keys import DEFAULT, FILES, RECIPE, ROTARY, AxisRecipe, Bound
from camgeo.formats.tables.controller import OPTIONS, check_options
from camgeo.formats.tables.tabled import check_step
from camgeo.motions.motion import check_filled
from camgeo.recipe.export import build_export, check_files
from camgeo.recipe.own_kind import begin, entry_at, finish
from camgeo.recipe.recipe import Verify
from camgeo.schema.fields import Kind
from camgeo.schema.yaml_source import Scalar
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.document import Document
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source


def read_axis(source: Source, path: Path) -> AxisRecipe:
    """Read the recipe of an axis; raises RecipeErrors with all its faults."""
    kind = entry_at(source.root, "axis", "kind")
    swings = isinstance(kind, Scalar) and kind.text == ROTARY
    return finish(*begin(source, "axis", RECIPE, swings=swings), path, _check, _built)


def _check(values: Values, reader: Reader) -> None:
    why = "the next cycle begins there"
    check_filled(values["axis"]["motion"], "axis.motion", TURN, "the whole turn, 360 degrees", reader, why=why)
    check_files(values, reader, FILES)
    for file in values.get("export", {}).get("files", []):
        if file["kind"] != "csv":
            continue
        if file.get("as") == "controller":
            check_options(file, reader)
            continue
        check_step(file, reader)
        for option in OPTIONS:
            if option in file and option != "step":
                at = f"{file['path']}.csv.{option}"
                reader.fault_at(at, "belongs to a table as controller", None, "leave it out, or give as: controller")


def _built(values: Values, document: Document, reader: Reader) -> AxisRecipe:
    """Make the recipe of values in which there is no fault."""
    axis, export = values["axis"], dict(values.get("export", {}))
    export.setdefault("tolerance", DEFAULT * (reader.scale(Kind.STROKE) if axis.get("kind") == ROTARY else 1.0))
    export.setdefault("files", [{"kind": "csv"}])
    return AxisRecipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=reader.mm,
        export=build_export(export),
        verify=Verify(angles=1),
        kind=axis.get("kind", "linear"),
        motion=axis["motion"],
        rpm=axis["rpm"],
        index=axis.get("index", False),
        modulo=axis.get("modulo"),
        limits=tuple(Bound(name, bound["at_most"]) for name, bound in values.get("limits", {}).items()),
        **vars(document),
    )
