"""`camgeo verify` with points of a shaft: checks, a section of the report and, where a folder is given, files in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.made.events import events_section
from camgeo.capabilities.made.made_part import checks_of
from camgeo.capabilities.made.options import read_options
from camgeo.capabilities.made.refusal import as_call_errors
from camgeo.capabilities.made.section import add_figures, section, shaft_section
from camgeo.capabilities.made.shaft import made_shaft
from camgeo.measures.extension import Results
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.common.clock import Clock
    from camgeo.output.extension import FileCall
    from camgeo.recipe.recipe import ShaftOrder
    from camgeo.synthesis.shaft_cam import ShaftCam


def judge_shaft(recipe: ShaftOrder, cams: Sequence[ShaftCam], call: FileCall, clock: Clock) -> Results:
    """Checks and the section `made` of a report on points of several cams on one shaft.

    Raises CallError for points that cannot be judged, RecipeErrors of capabilities that have figures of the motion, and
    SurroundingsError where the folder of the call cannot be written.
    """
    paths, options = call.paths, read_options(call.options, cams[0].recipe, call.units)
    result = made_shaft(cams, paths, options)
    checks, entries = [], []
    for lobe in result.cams:
        cam = lobe.points.cam
        with as_call_errors(lobe.points.paths, cam.name):
            own, verdicts = checks_of(cam.recipe, lobe.result, options)
            events = events_section(cam.recipe, cam.design, lobe.result, options, (cam.events, cam.zero))
            entries.append(section(cam.recipe, lobe.points.paths, lobe.result, options, verdicts) | events)
        checks += [replace(check, surface=cam.name) for check in own]
        add_figures(entries[-1], cam.recipe, cam.design, lobe.result)
    report = shaft_section(recipe, paths, result, entries)
    if options.out is not None:
        from camgeo.capabilities.made.out_folder import write_shaft

        with clock.stage("write"):
            report["written"] = write_shaft(recipe, result, report, options)
    return Results({"made": report}, checks)
