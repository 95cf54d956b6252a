"""The command `camgeo sweep`: its options, what it prints, its exit status."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.cli.arguments import add_out, name_of, processes
from camgeo.cli.exit_status import INTERRUPTED, SURROUNDINGS, of_run
from camgeo.cli.progress import Progress
from camgeo.common.terminal import complain, say, say_json
from camgeo.files.errors import install

if TYPE_CHECKING:
    import argparse

    from camgeo.capabilities.sweep.chunks import Listener
    from camgeo.capabilities.sweep.search import SweepOutcome
    from camgeo.capabilities.sweep.task import SweepTask
    from camgeo.checks.declaration import Entry

_LISTED = 5  # best designs that -v lists


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
    """Sweep one recipe; return the exit status.

    0 if a design keeps the limits, 1 if none does, 3 if the surroundings fail or a missing package leaves files out,
    130 if interrupted. Raises RecipeErrors for a wrong recipe, for which the command exits with 2.
    """
    from camgeo.capabilities.sweep.task import EXACT, SweepTask
    from camgeo.recipe.loading import load

    task = SweepTask.from_recipe(load(arguments.recipe))
    outcome, problem, status = _search(task, arguments)
    if outcome is None:
        _complain(task, problem)
        return status
    report = outcome.report
    if outcome.work.damaged:
        _complain(task, f"{outcome.work.damaged} damaged chunks were computed again")
    for left_out in report["skipped"]:
        _complain(task, f"without {left_out['what']}: {left_out['why']}")
    if report["screen"] and report["screen"].get("why") and task.plan.count > EXACT:
        _complain(task, f"every design was worked out exactly, as none can be estimated: {report['screen']['why']}")
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(report))
    else:
        say(summary(report, outcome.folder))
        if arguments.verbose:
            say(_table(report))
    return status


def _search(task: SweepTask, arguments: argparse.Namespace) -> tuple[SweepOutcome | None, str, int]:
    """Outcome, None where the run failed; the message of the failure, else empty; and the exit status."""
    from camgeo.capabilities.sweep.chunks import EngineError
    from camgeo.capabilities.sweep.engines import Workers
    from camgeo.capabilities.sweep.search import search
    from camgeo.common.errors import SurroundingsError

    progress = Progress(task.recipe.name)
    engine = Workers(arguments.jobs, arguments.scheduler, progress)
    resume = "what was computed is kept; the same command continues from there"
    try:
        out, listener = Path(arguments.out), _progress_listener(progress)
        outcome = search(task, out, engine, fresh=arguments.fresh, listener=listener)
    except KeyboardInterrupt:
        return None, f"interrupted; {resume}", INTERRUPTED
    except ModuleNotFoundError as error:
        return None, missing_package(error), SURROUNDINGS
    except EngineError as error:
        return None, f"{error}; {resume}", SURROUNDINGS
    except SurroundingsError as error:
        return None, str(error), SURROUNDINGS
    except OSError as error:
        path = error.filename or Path(arguments.out) / task.recipe.name
        return None, f"{path}: {error.strerror or error}; {resume}", SURROUNDINGS
    finally:
        progress.clear()
    left_out = any(entry.get("missing") for entry in outcome.report["skipped"])
    return outcome, "", of_run(ok=outcome.report["ok"], left_out=left_out)


def missing_package(error: ModuleNotFoundError) -> str:
    """Message that names a missing package, and the command that installs it."""
    return f"the package {error.name} is missing: {install('dask' if error.name == 'distributed' else 'sweep')}"


def _complain(task: SweepTask, text: str) -> None:
    complain(f"camgeo: {task.recipe.name}: {text}")


def _progress_listener(progress: Progress) -> Listener:
    """Listener that shows progress, with speed and time left by the speed so far."""

    def show(what: str, count: int, total: int, seconds: float) -> None:
        left = f", {duration(seconds / count * (total - count))} left" if count else ""
        speed = f", {count / seconds:,.0f} a second" if count > seconds > 0.0 else ""
        progress(f"{count:,} of {total:,} {what}{speed}{left}")

    return show


def duration(seconds: float) -> str:
    """Time of `seconds` s in words, coarser the longer it is: 40 s, 12 min, 3 h 20 min."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def summary(report: Entry, folder: Path) -> str:
    """Best design of a report (`sweep.json`), or why there is none, in a line with the folder of its files.

    The numbers of designs that break a limit overlap, as one may break several.
    """
    counts, rank, run = report["counts"], report["sweep"]["rank"], report["run"]
    speed = f", {run['designs_per_second']:,.0f} a second" if run["designs_per_second"] else ""
    computed = f"{counts['computed']:,} designs{speed}"
    if report["ok"]:
        value = _with_unit(report, rank, report["best"][0]["figures"][rank])
        return f"{report['recipe']}: {rank} {value}, the best of {counts['kept']:,} kept of {computed}; {folder}"
    reasons = [_not_turning(report)] if counts["not_turning"] else []
    reasons += [f"{number:,} break the limit of {figure}" for figure, number in counts["failing"].items() if number]
    near = "" if report["nearest"] is None else _nearest(report)
    return f"{report['recipe']}: no design is within the limits, of {computed}: {', '.join(reasons)}{near}; {folder}"


def _nearest(report: Entry) -> str:
    """Text on the design that misses the limits by least: its values, and the limit that it misses most."""
    near = report["nearest"]
    bounds = report["sweep"]["limits"][near["breaks"]]
    least = "at_least" in bounds and near["value"] < bounds["at_least"]
    bound = f"at least {bounds['at_least']:.6g}" if least else f"at most {bounds['at_most']:.6g}"
    figure = f"{near['breaks']} {near['value']:.6g} {near['unit']}".rstrip()
    return f"; nearest: {_values(near)}, with {figure} where {bound} is required"


def _not_turning(report: Entry) -> str:
    """Number of designs without figures, and the reasons."""
    counts = report["counts"]
    reasons = ", ".join(f"{reason} {number:,}" for reason, number in counts["reasons"].items())
    return f"{counts['not_turning']:,} do not turn" + (f" ({reasons})" if reasons else "")


def _values(design: Entry) -> str:
    """Values of a design by their paths, in a line."""
    return ", ".join(
        f"{path} {value if isinstance(value, str) else f'{value:.6g}'}" for path, value in design["values"].items()
    )


def _with_unit(report: Entry, figure: str, value: float) -> str:
    """Value of a figure with its unit; `infinite` without one for a radius that the design does not have."""
    return "infinite" if math.isinf(value) else f"{value:.6g} {report['figures'][figure]['unit']}".rstrip()


def _table(report: Entry) -> str:
    """The counts and the first of the best designs, in lines."""
    counts = report["counts"]
    lines = [f"  {_not_turning(report)}"]
    lines += [f"  {number:,} break the limit of {figure}" for figure, number in counts["failing"].items()]
    if counts["rows"] < counts["kept"]:
        lines.append(f"  the table holds the best {counts['rows']:,} of {counts['kept']:,}")
    for design in report["best"][:_LISTED]:
        figures = ", ".join(f"{name} {_with_unit(report, name, value)}" for name, value in design["figures"].items())
        lines.append(f"  {design['file']}: {_values(design)}\n    {figures}")
    return "\n".join(lines)
