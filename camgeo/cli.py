"""The command line: commands, exit status, progress. No mathematics."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from camgeo.page import command as page_command
from camgeo.progress import Progress
from camgeo.recipe.model import KINDS
from camgeo.study import command as study_command
from camgeo.sweep import command as sweep_command

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from camgeo.recipe.model import Recipe

OK, FAILED, WRONG, SURROUNDINGS, INTERRUPTED = 0, 1, 2, 3, 130
PARALLEL_FROM = 3  # recipes; below that starting a second process costs more than it saves
COLLECT_AFTER = 300_000  # new objects; one recipe makes about a third as many


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status (0 every check holds, 1 a check fails, 2 wrong, 3 surroundings, 130)."""
    _open_streams()
    arguments = _parser().parse_args(argv)
    command: Callable[[argparse.Namespace], int] = arguments.run
    try:
        with _rare_collections():
            status = command(arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED
    except OSError as error:
        # Files are seen to where they are written, so this is our own output. Where its reader went away nothing more
        # can be said; nothing is wrong with the recipe.
        if not isinstance(error, BrokenPipeError):
            _complain(f"{error.filename or 'the output cannot be written'}: {error.strerror}")
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return SURROUNDINGS
    return status


@contextmanager
def _rare_collections() -> Iterator[None]:
    """Let Python's search for cycles wait until there is something to find.

    By default it goes again and again over what the imports make, ezdxf's above all: a tenth of a short run.
    """
    usual = gc.get_threshold()
    gc.set_threshold(COLLECT_AFTER)
    try:
        yield
    finally:
        gc.set_threshold(*usual)


def _open_streams() -> None:
    """Let what is said go nowhere where the caller closed the stream (`>&-`), which Python shows as None."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115 - open while we run


def _parser() -> argparse.ArgumentParser:
    from camgeo import __version__

    parser = argparse.ArgumentParser(
        prog="camgeo",
        description="Disc cams from a short recipe to drawings, solids and milling programs, their motion judged from "
        "the files.",
        epilog="Exit status: 0 all checks hold; 1 a check fails; 2 the recipe or the call is wrong; 3 the surroundings "
        "(disk, missing extra); 130 interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"camgeo {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=text, description=text)
        added.set_defaults(run=run)
        return added

    def recipes(to: argparse.ArgumentParser) -> None:
        to.add_argument("recipes", nargs="+", metavar="RECIPE", help="a recipe's YAML file")
        tolerance(to)
        output(to)

    def tolerance(to: argparse.ArgumentParser) -> None:
        text = "in place of export.tolerance, in the recipe's unit"
        to.add_argument("--tolerance", type=_length, metavar="E", help=text)

    def output(to: argparse.ArgumentParser) -> None:
        to.add_argument("-v", "--verbose", action="store_true", help="every check and file as a table")
        to.add_argument("--json", action="store_true", help="the reports as JSON, for machines")

    export = command("export", _export, "Write a recipe's files and judge them from what lies on disk.")
    recipes(export)
    export.add_argument("--out", default="out", metavar="DIR", help="folder of the results (default: out)")
    export.add_argument(
        "--only", action="append", default=[], choices=KINDS, help="only files of this kind; repeatable"
    )
    export.add_argument("--jobs", type=_jobs, metavar="N", help="processes at once (default: as many as pay)")
    export.add_argument("--watch", action="store_true", help="export again at each saving; a page reloads itself")
    check = command("check", _check, "Every check of a recipe; nothing is written.")
    recipes(check)
    check.add_argument("--jobs", type=_jobs, metavar="N", help="processes at once (default: as many as pay)")
    verify = command("verify", _verify, "Judge drawings, solids and programs of any origin by a recipe's motion.")
    verify.add_argument("recipe", metavar="RECIPE")
    verify.add_argument("files", nargs="+", metavar="FILE")
    tolerance(verify)
    output(verify)
    sweep = command("sweep", sweep_command.run, "Many designs of one recipe, ranked; the best become recipes.")
    sweep_command.add_arguments(sweep, _jobs)
    new = command("new", _new, "A starter recipe, on the terminal or in a new file.")
    new.add_argument("kind", metavar="KIND")
    new.add_argument("file", nargs="?", metavar="FILE")
    study = command("study", study_command.run, "Error against run time of each output form; a recipe's margins.")
    study_command.add_arguments(study)
    report = command("report", page_command.run, "A page to look at: the mechanism turning, its curves, its checks.")
    page_command.add_arguments(report)
    laws = command("laws", _laws, "The motion laws with their peak velocity, acceleration and jerk.")
    laws.add_argument("--json", action="store_true", help="as JSON, for machines")
    command("schema", _schema, "The recipe's JSON schema.")
    return parser


def _length(text: str) -> float:
    from camgeo.recipe.spec import MOST

    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value <= MOST:
        raise argparse.ArgumentTypeError(f"a tolerance is a length above 0 and up to {MOST:.10g}, not {text}")
    return value


def _jobs(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text[:9]) > 0):
        raise argparse.ArgumentTypeError(f"a number of processes is a whole number from 1, not {text}")
    return int(text[:9])


def _complain(text: str) -> None:
    print(f"camgeo: {text}", file=sys.stderr)


# --- export and check -------------------------------------------------------------------------------------------------


def _export(arguments: argparse.Namespace) -> int:
    if arguments.watch:
        return _watch(arguments)
    return _several(arguments, "export")


def _watch(arguments: argparse.Namespace) -> int:
    """Export one recipe at each saving until interrupted; its page, asked for or not, is shown on 127.0.0.1."""
    from pathlib import Path

    from camgeo.page.watch import watch
    from camgeo.recipe.errors import RecipeErrors
    from camgeo.recipe.load import load
    from camgeo.recipe.model import FileRequest

    if len(arguments.recipes) != 1 or arguments.json:
        _complain("--watch takes one recipe, and no --json")
        return WRONG
    path = Path(arguments.recipes[0])
    only = (*arguments.only, "html") if arguments.only else ()

    def exported() -> tuple[str | None, str]:
        try:
            recipe = load(path)
        except RecipeErrors as errors:
            print(errors, file=sys.stderr)
            return None, str(errors)
        asked = [request for request in recipe.export.files if request.kind != "html"]
        page = FileRequest("html")
        export = replace(recipe.export, files=(*asked, page))
        if arguments.tolerance is not None:
            export = replace(export, tolerance=arguments.tolerance * recipe.mm)
        recipe = replace(recipe, export=export)
        report, message, _ = _one(recipe, "export", {"out": arguments.out, "only": only}, None)
        if report is None:
            print(message, file=sys.stderr)
            return None, message
        _show(report, verbose=arguments.verbose)
        folder = Path(arguments.out) / (recipe.name if report["ok"] else f"{recipe.name}.rejected")
        return (folder / page.filename(recipe.name, (page,))).read_text("utf-8"), ""

    watch(path, exported, lambda address: print(f"watching {path}: {address}  (ctrl-c ends)", flush=True))
    return OK


def _check(arguments: argparse.Namespace) -> int:
    return _several(arguments, "check")


def _several(arguments: argparse.Namespace, command: str) -> int:
    """Load every recipe, run those that are sound, print what came of each; the highest status."""
    from camgeo.recipe.errors import RecipeErrors
    from camgeo.recipe.load import load

    status = OK
    recipes: list[Recipe] = []
    for path in arguments.recipes:
        try:
            recipe = load(path)
        except RecipeErrors as errors:
            print(errors, file=sys.stderr)
            status = WRONG
            continue
        only = getattr(arguments, "only", ())
        if only and not any(request.kind in only for request in recipe.export.files):
            line, column = recipe.locate("export.files")
            _complain(f"{path}:{line}:{column}: export.files lists no {' or '.join(only)}, which --only asks for")
            status = WRONG
            continue
        if arguments.tolerance is not None:
            recipe = replace(recipe, export=replace(recipe.export, tolerance=arguments.tolerance * recipe.mm))
        recipes.append(recipe)
    if command == "export":
        names = [recipe.name.casefold() for recipe in recipes]
        twice = {recipe.name: recipe.path for recipe in recipes if names.count(recipe.name.casefold()) > 1}
        if twice:
            for name, path in twice.items():
                _complain(f"{path}: the name {name} is used by several recipes of this call; give each its own `name:`")
            return WRONG
    options = {"out": getattr(arguments, "out", "out"), "only": tuple(getattr(arguments, "only", ()))}
    reports: list[dict[str, Any]] = []
    for report, message, code in _results(recipes, command, options, arguments.jobs):
        status = max(status, code)
        if report is not None:
            reports.append(report)
            if not arguments.json:
                _show(report, verbose=arguments.verbose)
        if message:
            print(message, file=sys.stderr)
    if arguments.json:
        _print_json(reports)
    return status


Result = tuple["dict[str, Any] | None", str, int]


def _results(recipes: list[Recipe], command: str, options: dict[str, Any], jobs: int | None) -> Iterator[Result]:
    """Result of each recipe in order, several processes at once where that pays."""
    workers = jobs or (min(os.cpu_count() or 1, len(recipes)) if len(recipes) >= PARALLEL_FROM else 1)
    if workers <= 1 or len(recipes) < 2:
        for recipe in recipes:
            yield _one(recipe, command, options, Progress(recipe.name))
        return
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool

    progress = Progress(f"{len(recipes)} recipes")
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    with ProcessPoolExecutor(workers, context) as pool:
        futures = [pool.submit(_one, recipe, command, options, None) for recipe in recipes]
        try:
            for number, future in enumerate(futures):
                progress(f"{number} of {len(futures)} done")
                try:
                    result = future.result()
                except BrokenProcessPool:
                    # one process was killed, and takes with it what the others had in hand
                    text = "a process was killed before this recipe was done, for want of memory perhaps; see --jobs"
                    result = None, f"camgeo: {recipes[number].name}: {text}", SURROUNDINGS
                progress.clear()
                yield result
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _one(recipe: Recipe, command: str, options: dict[str, Any], progress: Progress | None) -> Result:
    """Run one recipe; the report, a message for standard error, and the status."""
    from pathlib import Path

    from camgeo import pipeline
    from camgeo.recipe.errors import RecipeErrors
    from camgeo.store import SurroundingsError

    try:
        if command == "check":
            outcome = pipeline.check(recipe, told=progress)
        else:
            outcome = pipeline.export(recipe, Path(options["out"]), only=options["only"], told=progress)
    except RecipeErrors as errors:
        return None, str(errors), WRONG
    except (SurroundingsError, OSError) as error:
        return None, f"camgeo: {recipe.name}: {error}", SURROUNDINGS
    except ModuleNotFoundError as error:
        return None, f"camgeo: {recipe.name}: the package {error.name} is missing", SURROUNDINGS
    finally:
        if progress is not None:
            progress.clear()
    return outcome.report, "", OK if outcome.ok else FAILED


def _show(report: dict[str, Any], *, verbose: bool) -> None:
    from camgeo.report.document import summary, table

    print(summary(report))
    if verbose:
        print(table(report) + "\n")


def _print_json(data: object) -> None:
    from camgeo.report.document import encoded

    print(encoded(data), end="")


# --- the other commands -----------------------------------------------------------------------------------------------


def _verify(arguments: argparse.Namespace) -> int:
    """Judge files of any origin by a recipe's motion."""
    from pathlib import Path

    from camgeo import pipeline
    from camgeo.recipe.errors import RecipeErrors
    from camgeo.recipe.load import load
    from kin.read import SUFFIXES

    try:
        recipe = load(arguments.recipe)
        if arguments.tolerance is not None:
            recipe = replace(recipe, export=replace(recipe.export, tolerance=arguments.tolerance * recipe.mm))
        paths = [Path(name) for name in arguments.files]
        files = [path for path in paths if path.is_file()]
        faults = [f"{p}: {_no_file(p)}" for p in paths if p not in files]
        known = ", ".join(SUFFIXES)
        faults += [f"{p}: none of {known}" for p in files if p.suffix.lower() not in SUFFIXES]
        if faults:
            for fault in faults:
                _complain(fault)
            return WRONG
        report = pipeline.judged(recipe, paths)
    except RecipeErrors as errors:
        print(errors, file=sys.stderr)
        return WRONG
    if arguments.json:
        _print_json(report)
    else:
        _show(report, verbose=arguments.verbose)
    return OK if report["ok"] else FAILED


def _no_file(path: Path) -> str:
    if path.is_dir():
        return "a folder; name the files in it"
    return "not a regular file" if path.exists() else "there is no such file"


def _new(arguments: argparse.Namespace) -> int:
    """Print a starter recipe, or write it where no file is yet."""
    from camgeo.recipe.starter import KINDS as STARTERS
    from camgeo.recipe.starter import starter

    if arguments.kind not in STARTERS:
        _complain(f"no recipe is called {arguments.kind}; there are: {', '.join(STARTERS)}")
        return WRONG
    text = starter(arguments.kind)
    if arguments.file is None:
        print(text, end="")
        return OK
    try:
        with open(arguments.file, "x", encoding="utf-8") as stream:  # noqa: PTH123 - pathlib has no mode "x" on 3.11
            stream.write(text)
    except FileExistsError:
        _complain(f"{arguments.file} exists already and is left as it is")
        return WRONG
    except OSError as error:
        _complain(f"{arguments.file}: {error.strerror}")
        return SURROUNDINGS
    return OK


def _laws(arguments: argparse.Namespace) -> int:
    """Print the laws' peaks for unit stroke over unit time."""
    from kin.law import LAWS

    if arguments.json:
        from camgeo.report.document import finite

        _print_json(
            finite(
                [
                    {"law": law.name, "velocity": p.velocity, "acceleration": p.acceleration, "jerk": p.jerk}
                    for law in LAWS.values()
                    for p in (law.peaks,)
                ]
            )
        )
        return OK
    width = max(map(len, LAWS))
    print(f"{'law'.ljust(width)}  velocity  acceleration      jerk   (peaks for unit stroke over unit time)")
    for law in LAWS.values():
        p = law.peaks
        print(f"{law.name.ljust(width)}  {p.velocity:8.6f}  {p.acceleration:12.6f}  {p.jerk:8.6g}")
    print("\nalso: {polynomial: [c0, c1, ...]} in u, from 0 to 1")
    return OK


def _schema(_arguments: argparse.Namespace) -> int:
    """Print the JSON schema."""
    from camgeo.recipe.schema import json_schema

    _print_json(json_schema())
    return OK


if __name__ == "__main__":
    sys.exit(main())
