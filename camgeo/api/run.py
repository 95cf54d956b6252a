"""Functions that design the cam of a recipe, write and judge its files, or judge files of any origin by it."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.api.loading import order_of
from camgeo.api.log import library_log, log_failures, stage_reporter
from camgeo.api.report import Report
from camgeo.api.root import root_of
from camgeo.common.arguments import demand_callable, demand_type, number_of, path_of, short_repr, texts_of
from camgeo.common.errors import CallError, SurroundingsError, with_packages
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.output import claims
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS
from camgeo.registry.root import reading
from camgeo.schema.errors import suggestion
from camgeo.schema.fields import MOST
from camgeo.schema.file_bytes import FOLDER, path_fault

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
    from os import PathLike
    from pathlib import Path

    from camgeo.api.loading import OrderSource
    from camgeo.common.units import Units
    from camgeo.recipe.recipe import Order


@with_packages()
def export(
    recipe: OrderSource,
    out: str | PathLike[str],
    *,
    only: Sequence[str] = (),
    progress: Callable[[str], None] | None = None,
    **options: bool,
) -> Report:
    """Write a recipe's files into the folder `out`/<name>, read them back and judge them.

    The folder has whole sets only: a set in which a check fails goes to `out`/<name>.rejected. `recipe` is a recipe or
    the path of its file. `only` names kinds of files, such as "dxf"; files of other kinds stay as they are. `progress`
    is called with the name of each stage as it begins. `options` are those of capabilities, as `camgeo verify --help`
    lists them; True adds further checks. A check that fails raises nothing: `ok` of the report is False then. Raises
    RecipeErrors where there is no such cam or a tolerance cannot be held, SurroundingsError where the disk refuses or a
    package is missing, BusyError where another run of this name is at work, CallError where the recipe lists no file of
    one of the kinds `only`, TypeError for an unknown option.
    """
    recipe = order_of(recipe)
    demand_callable("progress", progress)
    used = _with_options("export", recipe, options)
    only, folder = texts_of("only", only), path_of("out", out)
    listed = {request.kind for request in recipe.export.files}
    faults = [_fault_of_kind(kind, listed) for kind in dict.fromkeys(only) if kind not in listed]
    if faults:
        raise CallError(*faults)
    progress_log = stage_reporter(recipe, progress)
    outcome = root_of(used).export(used, folder, only, progress_log)
    return _log(Report(recipe, outcome.report, outcome.folder))


@with_packages()
def check(recipe: OrderSource, *, progress: Callable[[str], None] | None = None, **options: bool) -> Report:
    """Make and judge all of a recipe's files, and keep none of them.

    `recipe` is a recipe or the path of its file. `progress` is called with the name of each stage as it begins.
    `options` are those of capabilities, as `camgeo verify --help` lists them; True adds further checks. A check that
    fails raises nothing: `ok` of the report is False then. Raises RecipeErrors where there is no such cam or a
    tolerance cannot be held, SurroundingsError where the disk refuses or a package is missing, TypeError for an unknown
    option.
    """
    recipe = order_of(recipe)
    demand_callable("progress", progress)
    used = _with_options("check", recipe, options)
    progress_log = stage_reporter(recipe, progress)
    outcome = root_of(used).check(used, progress_log)
    return _log(Report(recipe, outcome.report))


@with_packages()
def verify(
    recipe: OrderSource,
    file: str | PathLike[str],
    *files: str | PathLike[str],
    tolerance: float | None = None,
    units: Units | None = None,
    gap: float | None = None,
    page: bool = False,
    **options: object,
) -> Report:
    """Judge drawings, solids, milling programs and measured points of any origin by a recipe's motion.

    `recipe` is a recipe or the path of its file. `tolerance`, in the recipe's unit, is by default that of the recipe's
    file of the same name, or of its export. `units` is the unit of files that state none. Ends in drawings within `gap`
    of one other, in the recipe's unit, are joined; the gap is added to the errors of contour and motion, which one
    above the tolerance fails, with its figure. With `page` the report has the page that shows the files, `Report.page`.
    `options` are those of capabilities, as `camgeo verify --help` lists them: further checks, and how files that a
    capability judges are to be read, such as points. A file whose content is faulty raises nothing: the check
    `readable` fails.

    Raises RecipeErrors where there is no such cam, CallError for a path that is no file of a known kind, for a file
    given twice, points that cannot be judged, and a tolerance, gap or unit that makes no sense; UnitsError where a file
    states another unit than `units`, SurroundingsError where a file cannot be read or a package is missing, TypeError
    for an unknown option.
    """
    recipe = order_of(recipe)
    paths = [path_of("file" if i == 0 else f"files[{i - 1}]", name) for i, name in enumerate((file, *files))]
    within = None if tolerance is None else number_of("tolerance", tolerance)
    gap_width = None if gap is None else number_of("gap", gap)
    if units is not None:
        demand_type("units", units, str, "a str")
    demand_type("page", page, bool, "a bool")
    known_options = claims.options()
    judge_options = {name: value for name, value in options.items() if name in known_options}
    used = _with_options(
        "verify", recipe, {name: value for name, value in options.items() if name not in judge_options}
    )
    with _with_readable(paths[0]):
        report = _verify(recipe, used, paths, judge_options, within=within, gap_width=gap_width, units=units, page=page)
    return _log(report)


def _verify(
    recipe: Order,
    used: Order,
    paths: list[Path],
    judge_options: Mapping[str, object],
    *,
    within: float | None,
    gap_width: float | None,
    units: Units | None,
    page: bool,
) -> Report:
    """Report on files by a recipe; `used` is the recipe with the capabilities of the call.

    `within` is the tolerance, in the recipe's unit as is the gap; `judge_options` are those of capabilities that claim
    files. Raises what `verify` does, and OSError where a file cannot be read.
    """
    from kin.read.formats import suffixes

    # files that a capability claims, such as measured points, are judged by it in a call of their own
    path_faults = {path: path_fault(path) for path in paths}
    claimed = [path for path in paths if not path_faults[path] and claims.judge_of(path, judge_options)]
    if claimed:
        has_file_bounds = within is not None or gap_width is not None or page
        return _judge_claimed(recipe, paths, claimed, units, judge_options, has_file_bounds=has_file_bounds)
    # all faults of the call are collected, and raised together
    path_faults |= {path: _size_fault(path) for path in paths if not path_faults[path]}
    path_faults |= {path: f"{FOLDER}; name the files in it" for path in paths if path_faults[path] == FOLDER}
    readable = [path for path in paths if not path_faults[path]]
    faults = [f"{escaped(str(path))}: {path_faults[path]}" for path in paths if path_faults[path]]
    repeated = [path for path in dict.fromkeys(readable) if readable.count(path) > 1]
    faults += [
        f"{escaped(str(path))}: it is given {readable.count(path)} times; give each file once" for path in repeated
    ]
    known_suffixes = [suffix for suffix, name in suffixes().items() if name in FORMATS]
    faults += [
        f"{escaped(str(path))}: none of {', '.join(known_suffixes)}"
        for path in readable
        if path.suffix.lower() not in known_suffixes
    ]
    if within is not None and not 0.0 < within <= MOST:
        faults.append(f"a tolerance is a length above 0 and up to {MOST:.10g}, not {within!r}")
    if gap_width is not None and not 0.0 < gap_width <= MOST:
        faults.append(f"a gap is a length above 0, not {gap_width!r}")
    if gap_width is not None and not any(_is_drawing(path) for path in paths):
        faults.append("a gap is one between ends in a drawing: leave it out, as none of the files is one")
    if units is not None and units not in UNIT_MM:
        faults.append(f"a unit is one of {', '.join(UNIT_MM)}, not {short_repr(units)}")
    if faults:
        raise CallError(*faults)
    within = None if within is None else within * recipe.mm
    gap_width = None if gap_width is None else gap_width * recipe.mm
    unit = None if units is None else UNIT_MM[units]
    kind = root_of(used)
    if not page:
        return Report(recipe, kind.judge(used, paths, within, unit, gap_width), None, tuple(paths))
    if kind.show is None:
        raise CallError(
            f"{recipe.name}: a page shows the files of one cam; give {reading(used.root).instead}, or leave page out"
        )
    report, text = kind.show(used, paths, within, unit, gap_width)
    return Report(recipe, report, None, tuple(paths), page=text)


def _judge_claimed(
    recipe: Order,
    paths: Sequence[Path],
    claimed: Sequence[Path],
    units: Units | None,
    options: Mapping[str, object],
    *,
    has_file_bounds: bool,
) -> Report:
    """Report on files that a capability judges; raises CallError for other files among them and for a bound of files.

    `has_file_bounds` is whether the call gives a tolerance, a gap or a page.
    """
    from camgeo.output.extension import FileCall

    faults = [f"{escaped(str(path))}: give it in a call of its own" for path in paths if path not in claimed]
    repeated = [path for path in dict.fromkeys(paths) if paths.count(path) > 1]
    faults += [f"{escaped(str(path))}: it is given {paths.count(path)} times; give each file once" for path in repeated]
    if units is not None and units not in UNIT_MM:
        faults.append(f"a unit is one of {', '.join(UNIT_MM)}, not {short_repr(units)}")
    name = escaped(str(claimed[0]))
    if has_file_bounds:
        faults.append(f"{name}: measured points have no tolerance, gap and page of files: give made.profile, and out")
    if faults:
        raise CallError(*faults)
    unit = None if units is None else UNIT_MM[units]
    judge = claims.judge_of(claimed[0], options)
    report = root_of(recipe).claimed(recipe, judge, FileCall(paths, unit, options))
    return Report(recipe, report, None, tuple(paths))


def _with_options(function: str, recipe: Order, options: Mapping[str, object]) -> Order:
    """Recipe that uses the capabilities whose options are True; raises TypeError for an unknown option or no bool."""
    known_options = registry.options()
    for name, value in options.items():
        if name not in known_options:
            raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
        demand_type(name, value, bool, "a bool")
    return recipe.using(*(name for name, value in options.items() if value))


def _log(report: Report) -> Report:
    """Log files and checks of a report; returns the report itself."""
    name = report.recipe.name
    if log := library_log():
        for file in report.files if report.path is not None else ():
            log.info("%s: wrote %s", name, file.path)
        log_failures(name, report.checks)
        log.info("%s: %s", name, "ok" if report.ok else "FAILED")
    return report


def _fault_of_kind(kind: str, listed: Collection[str]) -> str:
    """Message on a kind of file that is none, with the nearest one, or that is not among those `listed`."""
    if kind not in FORMATS:
        near = suggestion(kind, FORMATS)
        return f"a kind of file is one of {', '.join(FORMATS)}, not {short_repr(kind)}{near and f'; {near}'}"
    return f"export.files lists no {kind}; it lists {', '.join(name for name in FORMATS if name in listed)}"


@contextmanager
def _with_readable(path: Path) -> Iterator[None]:
    """Turn an OSError into a SurroundingsError with the name of its file; `path` stands for one that has none."""
    try:
        yield
    except OSError as error:
        refused = path if error.filename is None else path_of("file", error.filename)
        raise SurroundingsError(f"cannot be read: {error.strerror or error}", refused) from error


def _is_drawing(path: Path) -> bool:
    from kin.read.formats import FORMATS as READ
    from kin.read.formats import suffixes

    name = suffixes().get(path.suffix.lower())
    return name is not None and READ[name].contents == "drawing"


def _size_fault(path: Path) -> str:
    """Message on a file that is larger than the reader of its kind allows; empty for others."""
    from kin.read.formats import oversize, suffixes

    kind = suffixes().get(path.suffix.lower())
    return "" if kind is None else oversize(path, kind)
