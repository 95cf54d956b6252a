"""Assertions for one's own tests of cams: on any DXF, SVG, STL, 3MF or STEP file, and on recipes.

Each function returns the figure it has measured and raises AssertionError with figure, limit and place. A file that
cannot be read as a contour fails. A file that does not exist raises OSError where no recipe is given, else CallError; a
recipe with faults raises RecipeErrors, a wrong type TypeError, a value that makes no sense CallError. Drawings and
solids are told apart by the suffix of the path. Lengths are in mm where a function takes no recipe, else in the
recipe's units, as in its report.
"""

from __future__ import annotations

import math
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec, TypeAlias, TypeVar

from camgeo.api.loading import order_of, recipe_of
from camgeo.checks.declared import (
    BENT,
    CHECKS,
    CLOSED,
    CONTOUR,
    MOTION,
    READABLE,
    UNDERCUT_GLOBAL,
    UNDERCUT_LOCAL,
    WATERTIGHT,
)
from camgeo.common.arguments import number_of, path_of, short_repr, whole_of
from camgeo.common.errors import CallError
from camgeo.recipe.keys import MOST_ANGLES
from kin.numeric.errors import CamgeoError
from kin.numeric.places import place_text
from kin.numeric.records import dataclass, replace
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from os import PathLike
    from pathlib import Path

    from camgeo.api.loading import OrderSource, RecipeSource
    from camgeo.api.report import Report
    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Order
    from kin.contour.contour import Contour

    AnyPath: TypeAlias = str | PathLike[str]

__all__ = [
    "Breadth",
    "Motion",
    "assert_closed",
    "assert_constant_breadth",
    "assert_contour",
    "assert_motion",
    "assert_no_undercut",
    "assert_recipe",
    "assert_verified",
    "assert_watertight",
]

GAP = 1e-6  # mm between ends of entities: far above the rounding of coordinates, far below any tolerance
MOST_NAMED = 5  # faults named in a message
UNREAD = frozenset(
    {CLOSED.name, READABLE.name, WATERTIGHT.name}
)  # one of them alone stands for a file that is no contour
BACKLASH = frozenset(one.name for one in CHECKS.values() if one.backlash)


@dataclass(frozen=True)
class Breadth:
    """Least and greatest distance between parallel tangents, mm.

    The directions of their normals are in degrees, from 0 to less than 360.
    """

    least: float
    least_at_deg: float
    greatest: float
    greatest_at_deg: float


@dataclass(frozen=True)
class Motion:
    """A follower's motion error over one turn, measured less intended, in `unit`.

    `rms` is taken over the recipe's `verify.angles` steps, `max` over the whole turn; it is at the shaft angle
    `at_deg`, degrees, of a plate at that place of its travel. `dwell_flatness` is the range of the measured position
    over a dwell, None where the motion has none.
    """

    max: float
    rms: float
    unit: str
    at_deg: float
    dwell_flatness: float | None


P = ParamSpec("P")
R = TypeVar("R")


def _ends_traceback(assertion: Callable[P, R]) -> Callable[P, R]:
    """Decorator by which a file that cannot be read fails, and a failure's traceback ends at the line of the test."""

    @wraps(assertion)
    def asserted(*arguments: P.args, **named: P.kwargs) -> R:
        __tracebackhide__ = True
        try:
            return assertion(*arguments, **named)
        except ReadError as error:
            raise AssertionError(str(error)) from None
        except (AssertionError, CamgeoError, OSError, TypeError) as error:
            raise error.with_traceback(None) from None

    return asserted


# --- any file ---------------------------------------------------------------------------------------------------------


@_ends_traceback
def assert_closed(path: AnyPath, *, gap: float = GAP) -> float:
    """Assert that the cut contour closes, without crossing itself and without anything drawn twice or without length.

    Returns the widest gap between two entities, mm; at most `gap`, mm, is permitted. The surface of a solid has to be
    watertight, and its gap is 0. Raises CallError for a file that is neither a drawing nor a solid, and for a gap below
    0.
    """
    from kin.read.files import read_drawing

    path = path_of("path", path)
    if _is_solid(path):
        assert_watertight(path)
        return 0.0
    drawing = read_drawing(path, _length("gap", gap))
    faults = [f"{fault.kind} {fault.entity} at {place_text(fault.x, fault.y)} mm" for fault in drawing.faults]
    _no_faults(path, faults + _crossings(drawing.contour))
    return drawing.widest_gap


@_ends_traceback
def assert_watertight(path: AnyPath) -> float:
    """Assert that a solid is closed, with faces whose normals point outward, none of them without area or twice there.

    Returns the enclosed volume, mm^3. Raises CallError for a file that is no solid.
    """
    from kin.read.files import read_solid
    from kin.read.formats import FORMATS

    path = path_of("path", path)
    if not _is_solid(path):
        solids = [record.suffixes[0] for record in FORMATS.values() if record.contents == "solid"]
        raise CallError(f"{path.name}: not a {', '.join(solids[:-1])} or {solids[-1]} file")
    solid = read_solid(path)
    _no_faults(path, [*(f"{fault}, none allowed" for fault in solid.faults), *_crossings(solid.contour)])
    return solid.volume


@_ends_traceback
def assert_constant_breadth(
    path: AnyPath, breadth: float | None = None, tolerance: float = 1e-3, *, mm: float | None = None
) -> Breadth:
    """Assert that a contour has the same breadth in all directions: a yoke of two parallel faces fits it all round.

    The breadth may differ from `breadth`, by default the mean of its extremes, by twice the `tolerance` of the contour,
    as both sides may be off by that. All in mm; `mm` is the length of a drawing unit, for a DXF that states none.
    Returns the extremes, those of the whole turn and not of samples. Raises CallError for a file that is neither a
    drawing nor a solid, and for a tolerance or `mm` below 0.
    """
    path = path_of("path", path)
    measured = _breadth(_contour(path, None if mm is None else _length("mm", mm)))
    nominal = 0.5 * (measured.least + measured.greatest) if breadth is None else number_of("breadth", breadth)
    tolerance = _length("tolerance", tolerance)
    for value, at_deg in ((measured.greatest, measured.greatest_at_deg), (measured.least, measured.least_at_deg)):
        if not abs(value - nominal) <= 2.0 * tolerance:
            named = "the mean" if breadth is None else "the nominal"
            span = f"breadth from {measured.least:.9g} to {measured.greatest:.9g} mm"
            raise AssertionError(
                f"{path}: breadth {value:.9g} at {at_deg:.4f} deg, {value - nominal:+.6g} from {named} "
                f"{nominal:.9g} mm, at most {2.0 * tolerance:.6g} mm allowed ({span})"
            )
    return measured


def _breadth(contour: Contour) -> Breadth:
    """Extremes of the breadth over the whole turn, from the play of the contour in a yoke of two faces."""
    import numpy as np

    from kin.follower.follower import follower_of
    from kin.law.contacts import Flat, opposite
    from kin.law.support_function import lift_from_fourier

    # the play, breadth of the yoke less that of the contour, is the same for any intended motion
    frame = float(contour.support(np.array([0.0, math.pi])).q.sum())
    play = (
        follower_of(opposite(Flat(), frame), lift_from_fourier(0.5 * frame, {}, {}).law)
        .judge(contour, np.zeros(1))
        .play
    )
    assert play is not None
    return Breadth(frame - play.most, play.most_at_deg, frame - play.least, play.least_at_deg)


# --- a file against a recipe ------------------------------------------------------------------------------------------


@_ends_traceback
def assert_motion(
    recipe: RecipeSource,
    path: AnyPath,
    *,
    limit: float | None = None,
    tolerance: float | None = None,
    gap: float | None = None,
    angles: int | None = None,
    **options: bool,
) -> Motion:
    """Assert that a file moves the recipe's follower as intended: position by contact, and play where it is held twice.

    `limit` of the motion error is in the recipe's units, in degrees for a follower that swings; without one it is that
    of the recipe, or what `tolerance` implies. `tolerance` of the contour is by default the recipe's for a file of that
    name, else `export.tolerance`. Ends in drawings within `gap` of one other are joined. `options` are those of
    capabilities, as in `camgeo.verify`, whose checks are asserted too. `angles` replaces `verify.angles`. Returns the
    motion error, of several surfaces the greatest. Raises CallError for no file of a known kind and for a limit,
    tolerance, gap or number of angles that makes no sense.
    """
    names = {MOTION.name, *BACKLASH}
    rows = _judge(recipe, path, names, options, limit=limit, tolerance=tolerance, gap=gap, angles=angles)
    if any(row["motion"] is None for row in rows):
        raise AssertionError(f"{path}: the follower's motion cannot be measured")
    motion = max((row["motion"] for row in rows), key=lambda error: float(error["max"]))
    place = motion.get("at_deg", motion.get("at"))
    return Motion(motion["max"], motion["rms"], motion["unit"], place, motion.get("dwell_flatness"))


@_ends_traceback
def assert_contour(
    recipe: RecipeSource, path: AnyPath, *, tolerance: float | None = None, gap: float | None = None, **options: bool
) -> float:
    """Assert that a file's contour lies within the tolerance of the recipe's exact one, in both directions.

    It fails for faults that no follower feels, too: a dent, a spike, a wrong unit. `tolerance` is by default the
    recipe's for a file of that name, else `export.tolerance`. Ends in drawings within `gap` of one other are joined.
    `options` are those of capabilities, as in `camgeo.verify`, whose checks are asserted too. Returns the greatest
    distance between both contours, in the recipe's units. Raises CallError for no file of a known kind and for a
    tolerance or gap that makes no sense.
    """
    rows = _judge(recipe, path, {CONTOUR.name}, options, tolerance=tolerance, gap=gap)
    return max(float(row["measured_error"]) for row in rows)


def _judge(
    recipe: RecipeSource,
    path: AnyPath,
    names: set[str],
    options: dict[str, Any],
    *,
    limit: float | None = None,
    tolerance: float | None,
    gap: float | None,
    angles: int | None = None,
) -> list[Entry]:
    """Judge a file and assert its checks with these names; returns the report's entries of its surfaces.

    Raises CallError for a number of `angles` at which no file is judged, and for a limit below 0.
    """
    from camgeo import verify as judged

    # limit and angles replace those of the recipe
    path, recipe = path_of("path", path), recipe_of(recipe)
    swings = recipe.cam.arrangement.unit == "deg"
    verify = recipe.verify
    if limit is not None:
        limit = _length("limit", limit)
        verify = replace(verify, motion_error=math.radians(limit) if swings else limit * recipe.mm)
    if angles is not None:
        angles = whole_of("angles", angles)
        if not 1 <= angles <= MOST_ANGLES:
            raise CallError(f"a file is judged at 1 angle at least and {MOST_ANGLES} at most, not {short_repr(angles)}")
        verify = replace(verify, angles=angles)
    recipe = replace(recipe, verify=verify)
    # of a file that is no contour there is one check alone, whatever its name
    report: Entry = dict(judged(recipe, path, tolerance=tolerance, gap=gap, **options))
    file_checks = [check for check in report["checks"] if check.get("file") == path.name]
    if len(file_checks) == 1 and file_checks[0]["name"] in UNREAD:
        _all_hold(file_checks, report, recipe, str(path))
    # the checks of capabilities that the call uses are asserted beside those of `names`
    names = names | {name for name in CHECKS if options.get(CHECKS.owner(name), False)}
    wanted_checks = [check for check in file_checks if check["name"] in names]
    if not wanted_checks:
        raise AssertionError(f"{path}: the judge has made no check of {', '.join(sorted(names))}")
    _all_hold(wanted_checks, report, recipe, str(path))
    entry: Entry = report["files"][0]
    surfaces: list[Entry] = entry.get("surfaces", [entry])
    return surfaces


# --- a recipe ---------------------------------------------------------------------------------------------------------


@_ends_traceback
def assert_recipe(recipe: OrderSource, **options: Any) -> Report:  # noqa: ANN401 - bool, as those of camgeo.check
    """Assert that a recipe has no faults, and that every check of its exact curves and of its files holds.

    The recipe may be of any kind. Its files are made and judged in a temporary folder; `options` are those of
    `camgeo.check`. Returns the report, which as a mapping has the content of report.json. Faults of the recipe raise
    AssertionError here; raises SurroundingsError where the disk refuses or a package is missing.
    """
    from camgeo import check
    from camgeo.schema.errors import RecipeErrors

    try:
        recipe = order_of(recipe)
        report = check(recipe, **options)
    except RecipeErrors as errors:
        raise AssertionError(f"the recipe has faults:\n{errors}") from None
    entry: Entry = dict(report)
    _all_hold(entry["checks"], entry, recipe, recipe.name)
    return report


@_ends_traceback
def assert_verified(
    recipe: OrderSource,
    path: AnyPath,
    *paths: AnyPath,
    **options: Any,  # noqa: ANN401 - those of camgeo.verify
) -> Report:
    """Assert that every check of `camgeo.verify` holds for these files, of any kind that it takes, such as points.

    `options` are the further arguments of `camgeo.verify`. Returns its report. Raises CallError for files that cannot
    be judged.
    """
    from camgeo import verify

    recipe = order_of(recipe)
    report = verify(recipe, path, *paths, **options)
    entry: Entry = dict(report)
    _all_hold(entry["checks"], entry, recipe, ", ".join(str(file) for file in (path, *paths)))
    return report


@_ends_traceback
def assert_no_undercut(recipe: RecipeSource) -> float:
    """Assert that the exact contour of a recipe has no undercut, local or global, also where the recipe would trim it.

    Returns the least radius of curvature, in the recipe's units: of the contour for a flat face or a knife edge, of the
    pitch curve for a roller or a shoe; of several surfaces the first one's. Raises RecipeErrors where there is no such
    motion or curve.
    """
    from camgeo.report.document import Findings, document
    from camgeo.synthesis.design import designed

    recipe = recipe_of(recipe)
    recipe = replace(recipe, cam=recipe.cam.refusing_undercut())
    design = designed(recipe)
    report = document(recipe, Findings(design.checks, (), (), (), design.follower.name, joints=design.exact.joints))
    names = {*BENT, UNDERCUT_LOCAL.name, UNDERCUT_GLOBAL.name}
    checks = [check for check in report["checks"] if check["name"] in names]
    _all_hold(checks, report, recipe, recipe.name)
    radius: float = next(check["value"] for check in checks if check["name"] in BENT)
    return radius


def _length(name: str, value: float) -> float:
    """Argument that must be a number of 0 or above; raises CallError for another number, TypeError for no number."""
    length = number_of(name, value)
    if not 0.0 <= length < math.inf:
        raise CallError(f"{name} is a number of 0 or above, not {length!r}")
    return length


# --- all of them ------------------------------------------------------------------------------------------------------


def _all_hold(checks: Iterable[Entry], report: Entry, recipe: Order, title: str) -> None:
    from camgeo.api.report import explanation

    failed = [explanation(check, report, recipe) for check in checks if not check["ok"]]
    if failed:
        raise AssertionError(f"{title}: " + "\n".join(failed))


def _no_faults(path: Path, faults: list[str]) -> None:
    if faults:
        more = f"; and {len(faults) - MOST_NAMED} more" if len(faults) > MOST_NAMED else ""
        raise AssertionError(f"{path}: {'; '.join(faults[:MOST_NAMED])}{more}")


def _crossings(contour: Contour) -> list[str]:
    from kin.contour.intersections import crossings

    return [f"the contour crosses or touches itself at {place_text(x, y)} mm" for x, y in crossings(contour).point]


def _contour(path: Path, mm: float | None) -> Contour:
    """Outer contour of a file, mm."""
    from kin.read.files import read_drawing, read_solid

    if _is_solid(path):
        return read_solid(path).contour
    drawing = read_drawing(path, GAP)
    if drawing.units_mm is not None:
        return drawing.contour
    if mm is None:
        raise AssertionError(f"{path}: the drawing states no unit; give mm=, the length of a drawing unit in mm")
    return drawing.contour.scaled(mm)


def _is_solid(path: Path) -> bool:
    """Whether a file is a solid, not a drawing; raises CallError for one that is neither."""
    from kin.read.formats import FORMATS, suffixes

    contents = {suffix: FORMATS[name].contents for suffix, name in suffixes().items()}
    readable = [suffix for suffix, contents in contents.items() if contents in {"drawing", "solid"}]
    if path.suffix.lower() not in readable:
        raise CallError(f"{path.name}: a contour is read from one of {', '.join(readable)}")
    return contents[path.suffix.lower()] == "solid"
