"""`camgeo verify` with points: checks, a section of the report and, where a folder is given, files in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.made.events import events_section
from camgeo.capabilities.made.made_part import checks_of, made_part
from camgeo.capabilities.made.options import read_options
from camgeo.capabilities.made.refusal import as_call_errors
from camgeo.capabilities.made.section import add_figures, section
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.measures.extension import Results

if TYPE_CHECKING:
    from camgeo.common.clock import Clock
    from camgeo.output.extension import FileCall
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def judge(recipe: Recipe, design: Design, call: FileCall, clock: Clock) -> Results:
    """Checks and the section `made` of a report on points of a part.

    Raises CallError for points that cannot be judged, RecipeErrors of capabilities that have figures of the motion, and
    SurroundingsError where the folder of the call cannot be written.
    """
    paths, options = call.paths, read_options(call.options, recipe, call.units)
    name = escaped(str(paths[0]))
    if not design.contours:
        raise CallError(f"{name}: there is no exact contour to hold it against: a check of the recipe fails")
    if design.trimmed:
        raise CallError(f"{name}: points of a cam whose undercut is cut off are not judged; give undercut: refuse")
    with as_call_errors(paths):
        result = made_part(recipe, design, paths, options)
        checks, verdicts = checks_of(recipe, result, options)
        report = section(recipe, paths, result, options, verdicts) | events_section(recipe, design, result, options)
    add_figures(report, recipe, design, result)
    if options.out is not None:
        from camgeo.capabilities.made.out_folder import write_part  # most calls write nothing

        with clock.stage("write"):
            report["written"] = write_part(recipe, result, report, options)
    return Results({"made": report}, checks)
