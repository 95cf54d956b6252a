"""The command `camgeo sweep`: its options, what it prints, its exit status."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from camgeo.cli.arguments import add_out, name_of, processes
from camgeo.cli.exit_status import FAILED, INTERRUPTED, OK, SURROUNDINGS, WRONG
from camgeo.cli.progress import Progress
from camgeo.common.terminal import complain, say, say_json
from camgeo.files.errors import install

if TYPE_CHECKING:
    import argparse

    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.capabilities.sweep.run import Listener
    from camgeo.capabilities.sweep.search import Means, Outcome
    from camgeo.checks.remedies import Entry

EXTRAS = {"distributed": "dask"}  # of packages that are not in the extra `sweep`
_EVERY = 10.0  # seconds between lines of progress where there is no terminal
_SAID = 5  # best designs that -v lists
Number = TypeVar("Number", int, float)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Give the command its options."""
    parser.add_argument("recipe", metavar="RECIPE", help="a recipe's YAML file, with a section `sweep`")
    add_out(parser)
    engine = parser.add_mutually_exclusive_group()
    text = "processes at once (default: as many as are worthwhile)"
    engine.add_argument("--jobs", type=processes, metavar="N", help=text)
    engine.add_argument(
        "--scheduler", type=name_of, metavar="ADDRESS", help="a Dask scheduler, such as tcp://host:8786"
    )
    parser.add_argument("--fresh", action="store_true", help="compute again what earlier runs have computed")
    parser.add_argument("-v", "--verbose", action="store_true", help="the best designs and the counts")
    parser.add_argument("--json", action="store_true", help="sweep.json, for machines")


def run(arguments: argparse.Namespace) -> int:
    """Sweep one recipe: 0 found, 1 nothing keeps the limits, 2 a wrong recipe, 3 the surroundings, 130 interrupted."""
    from camgeo.capabilities.sweep.ask import EXACT, Ask
    from camgeo.recipe.loading import load
    from camgeo.schema.errors import RecipeErrors

    try:
        ask = Ask.of(load(arguments.recipe))
        outcome, problem, status = _searched(ask, arguments)
    except RecipeErrors as errors:
        complain(str(errors))
        return WRONG
    if outcome is None:
        _complain(ask, problem)
        return status
    report = outcome.report
    if outcome.work.damaged:
        _complain(ask, f"{outcome.work.damaged} damaged chunks were computed again")
    for left_out in report["skipped"]:
        _complain(ask, f"without {left_out['what']}: {left_out['why']}")
    if report["screen"] and report["screen"].get("why") and ask.plan.count > EXACT:
        _complain(ask, f"every design was worked out exactly, as none can be estimated: {report['screen']['why']}")
    if arguments.json:
        from camgeo.report.document import encoded

        say_json(encoded(report))
    else:
        say(summary(report, outcome.folder))
        if arguments.verbose:
            say(_table(report))
    return status


def _searched(ask: Ask, arguments: argparse.Namespace) -> tuple[Outcome | None, str, int]:
    """Outcome, or what went wrong, and the exit status."""
    from camgeo.capabilities.sweep.engines import EngineError
    from camgeo.capabilities.sweep.job import VersionsError
    from camgeo.capabilities.sweep.run import How
    from camgeo.capabilities.sweep.search import search
    from camgeo.common.errors import SurroundingsError

    progress = Progress(ask.recipe.name, _EVERY)
    how = How(arguments.jobs, arguments.scheduler)
    resume = "what was computed is kept; the same command continues from there"
    try:
        outcome = search(ask, Path(arguments.out), how, means(), fresh=arguments.fresh, listener=_teller(progress))
    except KeyboardInterrupt:
        return None, f"interrupted; {resume}", INTERRUPTED
    except ModuleNotFoundError as error:
        extra = EXTRAS.get(error.name or "", "sweep")
        return None, f"the package {error.name} is missing: {install(extra)}", SURROUNDINGS
    except (EngineError, VersionsError) as error:
        return None, f"{error}; {resume}", SURROUNDINGS
    except SurroundingsError as error:
        return None, str(error), SURROUNDINGS
    except OSError as error:
        where = error.filename or Path(arguments.out) / ask.recipe.name
        return None, f"{where}: {error.strerror or error}; {resume}", SURROUNDINGS
    finally:
        progress.clear()
    return outcome, "", OK if outcome.report["ok"] else FAILED


def means() -> Means:
    """What computes, measures and polishes designs of a recipe."""
    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.capabilities.sweep.figures import REASONS, figures
    from camgeo.capabilities.sweep.refine import polish
    from camgeo.capabilities.sweep.search import Means

    return Means(figures, Ask.measured, polish, REASONS)


def _complain(ask: Ask, text: str) -> None:
    complain(f"camgeo: {ask.recipe.name}: {text}")


def _teller(progress: Progress) -> Listener:
    """Progress with the time left, from the speed so far."""

    def tell(what: str, count: int, total: int, seconds: float) -> None:
        left = f", {duration(seconds / count * (total - count))} left" if count else ""
        speed = f", {count / seconds:,.0f} a second" if count > seconds > 0.0 else ""
        progress(f"{count:,} of {total:,} {what}{speed}{left}")

    return tell


def duration(seconds: float) -> str:
    """Time left, as coarse as it is uncertain: 40 s, 12 min, 3 h 20 min."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def summary(report: Entry, folder: Path) -> str:
    """What was found, or why nothing was, in a line; `failing` overlap, as a design may break several limits."""
    counts, rank, run = report["counts"], report["sweep"]["rank"], report["run"]
    speed = f", {run['designs_per_second']:,.0f} a second" if run["designs_per_second"] else ""
    looked = f"{counts['computed']:,} designs{speed}"
    if report["ok"]:
        best = report["best"][0]
        value = _value(report, rank, best["figures"][rank])
        return f"{report['recipe']}: {rank} {value}, the best of {counts['kept']:,} kept of {looked}; {folder}"
    reasons = [_stuck(report)] if counts["not_turning"] else []
    reasons += [f"{number:,} break the limit of {figure}" for figure, number in counts["failing"].items() if number]
    near = _nearest(report) if report["nearest"] is not None else ""
    return f"{report['recipe']}: no design is within the limits, of {looked}: {', '.join(reasons)}{near}; {folder}"


def _nearest(report: Entry) -> str:
    """The design that misses the limits by least, as a share of each, and what it misses."""
    near = report["nearest"]
    bounds = report["sweep"]["limits"][near["breaks"]]
    least = "at_least" in bounds and near["value"] < bounds["at_least"]
    asked = f"at least {bounds['at_least']:.6g}" if least else f"at most {bounds['at_most']:.6g}"
    values = ", ".join(f"{path} {_as_told(value)}" for path, value in near["values"].items())
    figure = f"{near['breaks']} {near['value']:.6g} {near['unit']}".rstrip()
    return f"; nearest: {values}, with {figure} where {asked} is required"


def _stuck(report: Entry) -> str:
    """How many designs have no figures, and why."""
    counts = report["counts"]
    why = ", ".join(f"{reason} {number:,}" for reason, number in counts["reasons"].items())
    return f"{counts['not_turning']:,} do not turn" + (f" ({why})" if why else "")


def _as_told(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def _value(report: Entry, figure: str, value: float) -> str:
    return f"{value:.6g} {report['figures'][figure]['unit']}".rstrip()


def _table(report: Entry) -> str:
    """The counts and the first of the best designs."""
    counts = report["counts"]
    lines = [f"  {_stuck(report)}"]
    lines += [f"  {number:,} break the limit of {figure}" for figure, number in counts["failing"].items()]
    if counts["rows"] < counts["kept"]:
        lines.append(f"  the table holds the best {counts['rows']:,} of {counts['kept']:,}")
    for design in report["best"][:_SAID]:
        values = ", ".join(f"{path} {_as_told(value)}" for path, value in design["values"].items())
        figures = ", ".join(f"{name} {_value(report, name, value)}" for name, value in design["figures"].items())
        lines.append(f"  {design['file']}: {values}\n    {figures}")
    return "\n".join(lines)
