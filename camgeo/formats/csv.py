"""Tables as CSV: their options; `tables` has a file for each."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from camgeo.common.on_demand import OnDemand
from camgeo.formats.extension import TABLES, Table, Tables
from camgeo.formats.options import RECIPE_UNITS, TOLERANCE
from camgeo.output.extension import Making
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.registry.formats import Format
from camgeo.registry.gathered import Gathered
from camgeo.schema.fields import Field, FieldTable, Kind, either, length
from camgeo.synthesis.intent import FileIntent, intended
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent

MODULES = {
    name: f"camgeo.formats.tables.{name}"
    for name in ("motion", "contacts", "polar", "inspection", "grinding", "lift", "trace", "controller", "points")
}
"""Module of each of the core's tables by its word."""
OF_SOME = ("step", "tolerance", "roller", "for", "joints", "velocity_error", "acceleration_error", "suffix")
"""Options that some tables have and others have not; `takes` of a form names those that it has."""


def _form(name: str) -> Table:
    record: Table = import_module(MODULES[name]).FORM
    return record


FORMS: Gathered[Tables, Table] = Gathered(OnDemand(MODULES, _form), TABLES, lambda answers: answers.tables)
"""Record of each table by its word."""


def _percent(name: str, of: str) -> Field:
    about = f"of controller, greatest error of the {of}, percent of the greatest {of}"
    return Field(name, Kind.NUMBER, about, default="reported", above=0, at_most=100)


def _check(file: Values, _: Values, reader: Reader) -> None:
    """Note options that the table of a file does not take."""
    taken_options = FORMAT.form(file.get("as")).takes
    for key in OF_SOME:
        if key in file and key not in taken_options:
            kinds = either(tuple(name for name, form in FORMS.items() if key in form.takes))
            reader.fault_at(f"{file['path']}.csv.{key}", f"belongs to a table as {kinds}", None, "leave it out")


def _make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    return FORMS[request.form.name].make(job, request, path)


def _intent(recipe: Recipe, design: Design) -> PartIntent:
    from camgeo.machining.grinding import grinding_intent

    return replace(intended(recipe, design), grinding=grinding_intent(recipe, design))


FORMAT = Format(
    name="csv",
    options=FieldTable(
        (
            Field("as", Kind.CHOICE, "which table it is", default="motion", choices=FORMS),
            Field(
                "step",
                Kind.ANGLE,
                "of grinding, lift, controller, points, inspection, between rows; 360 degrees are a whole number of it",
                default="the largest that holds the tolerance; of inspection by verify.angles",
                at_least=FINEST,
                at_most=COARSEST,
            ),
            Field(
                "for",
                Kind.CHOICE,
                "of controller, whose table it is",
                default="required for it",
                choices=(
                    *("codesys", "codesys-table", "twincat", "twincat-table", "rockwell", "rockwell-linear"),
                    *("siemens", "sew", "plain"),
                ),
            ),
            Field("joints", Kind.TRUTH, "of controller, rows also where segments join", default="false"),
            _percent("velocity_error", "velocity"),
            _percent("acceleration_error", "acceleration"),
            Field(
                "suffix",
                Kind.CHOICE,
                "of points, ending of the file's name; txt and xyz stand apart by blanks",
                default="csv",
                choices=("csv", "txt", "xyz"),
            ),
            length("roller", "of lift, diameter of the roller on a stem through the shaft whose lift it is"),
            RECIPE_UNITS,
            TOLERANCE,
        )
    ),
    forms=FORMS,
    named=("for",),
    check=_check,
    contour=False,
    part=False,
    turning=True,
)
INTENT = FileIntent(_intent)
MAKING = Making(make=_make)
