"""From points to checks, a section of the report and, where a folder is given, its files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.made.judge import checks_of, made_part
from camgeo.capabilities.made.reading import Call
from camgeo.capabilities.made.section import section
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.registry.capability import Results
from kin.follower.frame_contact import FrameError
from kin.follower.motion_error import ContactError
from kin.made.points import UnlikePointsError
from kin.made.smooth import GapError
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from camgeo.common.clock import Clock
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.capability import FileCall
    from camgeo.synthesis.design import Design


def judge(recipe: Recipe, design: Design, files: FileCall, clock: Clock) -> Results:
    """Judge points; see `FileJudge`."""
    paths, units, options = files
    call = Call.of(options, recipe, units)
    name = escaped(str(paths[0]))
    if not design.contours:
        raise CallError(f"{name}: there is no exact contour to hold it against: a check of the recipe fails")
    if design.trimmed:
        raise CallError(f"{name}: points of a cam whose undercut is cut off are not judged; give undercut: refuse")
    try:
        result = made_part(recipe, design, paths, call)
    except (UnlikePointsError, GapError, UnsettledError) as error:
        raise CallError(f"{', '.join(escaped(str(path)) for path in paths)}: {error}") from error
    except (ContactError, FrameError) as error:
        raise CallError(f"{name}: on the metal that these points tell, {error}") from error
    except ValueError as error:
        if isinstance(error, CallError):
            raise
        raise CallError(f"{name}: {error}") from error
    checks, verdicts = checks_of(recipe, result, call)
    report = section(recipe, paths, result, call, verdicts)
    if call.out is not None:
        from camgeo.capabilities.made.output import write  # most calls write nothing

        with clock.stage("write"):
            report["written"] = write(recipe, result, report, call)
    return Results({"made": report}, checks)
