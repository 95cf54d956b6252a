"""The command line: commands, exit status, progress. No mathematics."""

from __future__ import annotations

import argparse
import io
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from camgeo.cli.arguments import add_out, name_of, processes
from camgeo.cli.batch import BatchTask, failed_entry, folder_conflicts, result, results
from camgeo.cli.exit_status import FAILED, INTERRUPTED, OK, SURROUNDINGS, WRONG
from camgeo.cli.extension import TERMINAL
from camgeo.common.terminal import complain, escaped, open_streams, say, say_json, silence
from camgeo.common.units import UNIT_MM
from camgeo.output import claims
from camgeo.output.mixture import mixtures
from camgeo.registry import registry, root
from camgeo.registry.formats import FORMATS
from camgeo.schema.quantity import read_quantity
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Order

O = TypeVar("O", bound="Order")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status; `argv` are the words of the call, by default those of the process.

    0: every check holds; 1: a check fails; 2: the recipe or the call is wrong; 3: disk, permission or package; 130:
    interrupted. Raises SystemExit after help, the version or a fault of the call was written.
    """
    open_streams()
    try:
        words = sys.argv[1:] if argv is None else argv
        arguments = _arguments(words)
        command: Callable[[argparse.Namespace], int] = arguments.run
        status = command(arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED
    except CamgeoError as error:
        return _refusal(error)
    except OSError as error:
        # Errors of files are caught where files are written, so this is standard output. Where its reader has gone
        # nothing more can be written; nothing is wrong with the recipe.
        if not isinstance(error, BrokenPipeError):
            _complain(f"{error.filename or 'the output cannot be written'}: {error.strerror}")
        silence("stdout")
        return SURROUNDINGS
    return status


def _refusal(error: CamgeoError) -> int:
    """Print why a command cannot be carried out, and return the exit status.

    Raises the error itself where it is none of those that a call may cause.
    """
    from camgeo.common.errors import CallError, SurroundingsError
    from camgeo.schema.errors import RecipeErrors

    match error:
        case RecipeErrors():
            complain(str(error))
        case CallError():
            for fault in error.faults:
                _complain(fault)
        case SurroundingsError():
            _complain(str(error))
            return SURROUNDINGS
        case _:
            raise error
    return WRONG


def _arguments(words: Sequence[str]) -> argparse.Namespace:
    """Arguments of a call; raises SystemExit after help, the version or a fault of the call was written.

    argparse would hide a failure to write these, and would write the words of a call unescaped.
    """
    answer, complaint = io.StringIO(), io.StringIO()
    try:
        with redirect_stdout(answer), redirect_stderr(complaint):
            parser = _parser(words)
            if not words:
                parser.error("name a command: camgeo --help lists them, camgeo new the recipes to start from")
            arguments, others = parser.parse_known_args(words)
            if others:  # argparse would show how camgeo is used, not the command
                arguments.refuse(f"unrecognized arguments: {' '.join(others)}")
            return arguments
    except SystemExit:
        for text, write in ((answer.getvalue(), say), (complaint.getvalue(), complain)):
            if text:
                write(text.removesuffix("\n"))
        sys.stdout.flush()
        raise


def _parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Parser of the words of a call; of commands in modules only those among the words get their arguments."""
    from camgeo.version import __version__

    # the width of the terminal costs an import of 13 ms of 200: only help needs it
    help_form = partial(argparse.HelpFormatter, width=None if {"-h", "--help"} & {*words} else 78)
    parser = argparse.ArgumentParser(
        prog="camgeo",
        formatter_class=help_form,
        description="Cams from a short recipe to drawings, solids and milling programs, their motion judged from "
        "the files.",
        epilog="Exit status: 0 all checks hold; 1 a check fails; 2 the recipe or the call is wrong; 3 the surroundings "
        "(disk, missing extra); 130 interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}", help="the version")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=text, description=text, formatter_class=help_form)
        added.set_defaults(run=run, refuse=added.error)
        return added

    def add_module_command(name: str, text: str, module_name: str) -> None:
        """Add a command of a module, which is imported only for a call of the command."""
        added = commands.add_parser(name, help=text, description=text, formatter_class=help_form)
        if name in words:
            module = import_module(module_name)
            module.add_arguments(added)
            added.set_defaults(run=module.run, refuse=added.error)

    export = command("export", _export, "Write a recipe's files and judge them from what lies on disk.")
    _add_recipes(export)
    add_out(export)
    export.add_argument(
        "--only", action="append", default=[], choices=tuple(FORMATS), help="only files of this kind; repeatable"
    )
    export.add_argument(
        "--watch", action="store_true", help="export again each time the recipe is saved; a page reloads itself"
    )
    check = command("check", _check, "Every check of a recipe; nothing is written.")
    _add_recipes(check)
    add_out(check, "of earlier results, whose files are compared with their reports")
    verify = command("verify", _verify, "Judge drawings, solids and programs of any origin by a recipe's motion.")
    verify.add_argument("recipe", metavar="RECIPE")
    verify.add_argument("files", nargs="+", type=name_of, metavar="FILE")
    _add_options(verify, "for all the files, in the recipe's unit or with its own: 0.0005in")
    verify.add_argument("--units", choices=UNIT_MM, help="unit of files that state none (R12 drawings, STL)")
    text = "join ends of a drawing this near; added to the errors of contour and motion"
    verify.add_argument("--gap", type=_length, metavar="G", help=text)
    text = "a new file for the page that shows the files, with their errors round the contour"
    verify.add_argument("--page", type=name_of, metavar="HTML", help=text)
    for name, text in registry.options().items():
        verify.add_argument(f"--{name.replace('_', '-')}", action="store_true", help=text)
    if "verify" in words:
        for name, option in claims.options().items():
            choices, value = option.choices or None, option.metavar or None
            flag = f"--{name.replace('_', '-')}"
            verify.add_argument(flag, dest=name, choices=choices, metavar=value, help=option.about)
    new = command("new", _new, "A starter recipe, on the terminal or in a new file; without a KIND, the list of kinds.")
    new.add_argument("kind", nargs="?", metavar="KIND", help="what to start from, or a kind of cam: lists its starters")
    new.add_argument("file", nargs="?", type=name_of, metavar="FILE", help="a new file (default, and -: the terminal)")
    new.set_defaults(sources=[])
    for folder, label in registry.labels().items():
        for name, text in label.sources.items():
            source = partial(_source_argument, folder)
            new.add_argument(f"--{name}", dest="sources", type=source, action="append", metavar="FILE", help=text)
    add_module_command("report", "An HTML page: the animated mechanism, its curves, its checks.", "camgeo.cli.report")
    add_module_command("laws", "The motion laws with their peak velocity, acceleration and jerk.", "camgeo.cli.laws")
    schema = command("schema", _schema, "The recipe's JSON schema.")
    schema.add_argument(
        "order", nargs="?", choices=(root.CAM, *root.folders()), default=root.CAM, help="of which recipe"
    )
    for folder, label in registry.labels().items():
        for name, text in label.commands.items():
            add_module_command(name, text, f"{registry.PACKAGE}.{folder}.command")
    return parser


def _add_recipes(command: argparse.ArgumentParser) -> None:
    """Add the arguments of a command of several recipes."""
    command.add_argument("recipes", nargs="+", metavar="RECIPE", help="a recipe's YAML file")
    _add_options(command, "in place of export.tolerance, in the recipe's unit or with its own: 0.0005in")
    command.add_argument(
        "--jobs", type=processes, metavar="N", help="processes at once (default: as many as are worthwhile)"
    )


def _add_options(command: argparse.ArgumentParser, tolerance: str) -> None:
    """Add the options of a command that makes reports; `tolerance` is the help of that option."""
    command.add_argument("--tolerance", type=_length, metavar="E", help=tolerance)
    command.add_argument("-v", "--verbose", action="store_true", help="every check and file as a table")
    command.add_argument("--json", action="store_true", help="the reports as JSON, for machines")


def _source_argument(folder: str, text: str) -> tuple[str, str]:
    """Pair of the capability's folder that makes a recipe out of a file, and the file's name."""
    return folder, name_of(text)


def _length(text: str) -> str:
    """Text of a length above 0, with a unit or in the recipe's; raises ArgumentTypeError for any other text."""
    from camgeo.schema.fields import MOST
    from camgeo.schema.scalars import Complaint

    try:
        value = read_quantity(text, "mm")
    except Complaint:
        value = 0.0
    if not 0.0 < value <= MOST:
        raise argparse.ArgumentTypeError(f"a length above 0 and up to {MOST:.10g} is expected, not {text}")
    return text


def _complain(text: str) -> None:
    complain(f"camgeo: {text}")


# --- export and check -------------------------------------------------------------------------------------------------


def _export(arguments: argparse.Namespace) -> int:
    if arguments.watch:
        return _watch(arguments)
    recipes, refused = _load_recipes(arguments.recipes, arguments.tolerance, arguments.only)
    faults = folder_conflicts(recipes)
    for fault in faults:
        _complain(fault)
    if faults:
        return WRONG
    return _run_recipes(recipes, refused, BatchTask(Path(arguments.out), tuple(arguments.only)), arguments)


def _check(arguments: argparse.Namespace) -> int:
    recipes, refused = _load_recipes(arguments.recipes, arguments.tolerance, ())
    return _run_recipes(recipes, refused, BatchTask(None), arguments)


def _watch(arguments: argparse.Namespace) -> int:
    """Export one recipe at each saving until interrupted; a server on 127.0.0.1 shows its page."""
    from camgeo.cli.watch import watch
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.loading import load_order
    from camgeo.schema.errors import RecipeErrors

    if len(arguments.recipes) != 1 or arguments.json:
        _complain("--watch takes one recipe, and no --json")
        return WRONG
    if not arguments.recipes[0]:
        _complain("RECIPE: an empty name")
        return WRONG
    path, out = Path(arguments.recipes[0]), Path(arguments.out)
    only = (*arguments.only, "html") if arguments.only else ()
    files = [path]

    def export_page() -> tuple[str | None, str]:
        try:
            recipe = load_order(path)
            files[:] = [path, *recipe.parts]
            requests = [request for request in recipe.export.files if not request.format.summary]
            page = FileRequest("html")
            recipe = replace(recipe, export=replace(recipe.export, files=(*requests, page)))
            _demand_listed(recipe, only)
        except RecipeErrors as errors:
            complain(str(errors))
            return None, str(errors)
        outcome = result(_with_tolerance(recipe, arguments.tolerance), BatchTask(out, only))
        if outcome.report is None:
            complain(outcome.message)
            return None, outcome.message
        _show(dict(outcome.report), outcome.report.recipe, verbose=arguments.verbose, folder=outcome.report.path)
        sys.stdout.flush()  # a pipe hears of each saving too
        assert outcome.report.path is not None
        return (outcome.report.path / page.filename(recipe.name, (page,))).read_text("utf-8"), ""

    watch(
        files,
        export_page,
        lambda address: say(f"watching {escaped(str(path))}: {address}  (ctrl-c ends)", at_once=True),
    )
    return OK


def _load_recipes(
    paths: Sequence[str], tolerance: str | None, only: Sequence[str]
) -> tuple[list[Order], dict[int, Entry]]:
    """Recipes without fault that list a file of each kind in `only`, and an entry of the report for each other path.

    The entries are by the places of the paths in the call; the faults are written to the terminal.
    """
    from camgeo.recipe.loading import load_order
    from camgeo.schema.errors import RecipeErrors

    recipes: list[Order] = []
    refused: dict[int, Entry] = {}
    for i, path in enumerate(paths):
        try:
            recipe = load_order(path)
            _demand_listed(recipe, only)
        except RecipeErrors as errors:
            complain(str(errors))
            refused[i] = failed_entry(path, str(errors), errors.errors)
            continue
        recipes.append(_with_tolerance(recipe, tolerance))
    return recipes, refused


def _demand_listed(recipe: Order, only: Sequence[str]) -> None:
    """Raise RecipeErrors, at `export.files`, for kinds in `only` of which the recipe lists no file."""
    listed = {request.kind for request in recipe.export.files}
    if missing := [kind for kind in dict.fromkeys(only) if kind not in listed]:
        problem = f"lists no {' or '.join(missing)}, which --only requests"
        raise recipe.error("export.files", problem, None, f"add {' and '.join(missing)}")


def _with_tolerance(recipe: O, tolerance: str | None) -> O:
    """Recipe with the tolerance of the call, the text of a length with or without a unit; None leaves it as it is."""
    if tolerance is None:
        return recipe
    within = read_quantity(tolerance, recipe.units) * recipe.mm
    return replace(recipe, export=replace(recipe.export, tolerance=within))


def _run_recipes(
    recipes: Sequence[Order], refused: dict[int, Entry], task: BatchTask, arguments: argparse.Namespace
) -> int:
    """Run recipes, write their reports, and return the highest exit status.

    In JSON the entries `refused`, of recipes with faults, stand at their places in the call.
    """
    status = WRONG if refused else OK
    entries: list[Entry] = []
    for outcome in results(recipes, task, arguments.jobs):
        status = max(status, outcome.status)
        if outcome.report is not None:
            report: Entry = dict(outcome.report)
            if task.out is None:
                _tell_of_mixture(report, mixtures(Path(arguments.out) / outcome.report.recipe.name))
            entries.append(report)
            if not arguments.json:
                if arguments.verbose and len(entries) > 1:
                    say("")
                _show(report, outcome.report.recipe, verbose=arguments.verbose, folder=outcome.report.path)
        if outcome.message:
            complain(outcome.message)
        if outcome.report is None:
            entries.append(failed_entry(recipes[len(entries)].name, outcome.message, outcome.errors))
    if arguments.json:
        from camgeo.report.document import as_json

        for place in sorted(refused):
            entries.insert(place, refused[place])
        say_json(as_json(entries))
    return status


def _tell_of_mixture(report: Entry, mixed: Sequence[str]) -> None:
    """Write the messages `mixed` on files that differ from their reports, and add them to the report.

    The verdict of the report stays as it is.
    """
    if mixed:
        report["mixed"] = [*report.get("mixed", ()), *mixed]
    for text in mixed:
        _complain(text)


def _show(report: Entry, recipe: Order, *, verbose: bool, folder: Path | None = None) -> None:
    """Print the report on a recipe.

    Where a check fails, its remedy follows, and the `folder` that the files of this run went to, if there is one.
    """
    from camgeo.report.document import summary, table, verdict

    told = _remedies(report, recipe)
    if folder is not None and not report["ok"]:
        kept = escaped(str(folder.with_name(report["recipe"])))
        told.append(f"  the files of this run are in {escaped(str(folder))}; {kept} is left as it was")
    if verbose:  # the verdict is the last line
        *lines, last = f"{table(report)}\n\n{verdict(report)}".split("\n")
        say("\n".join([*lines, *told, last]))
    else:
        say("\n".join([summary(report), *told]))


def _remedies(report: Entry, recipe: Order) -> list[str]:
    """Lines of what would let the failed checks of a report hold, each remedy once."""
    failed = [check for check in report["checks"] if not check["ok"]]
    if not failed:
        return []
    from camgeo.api.report import explanation
    from camgeo.report.failure import remedy_in

    known: dict[str, str] = {}
    for check in failed:
        if words := remedy_in(explanation(check, report, recipe)):
            known.setdefault(words, check["name"])
    return [f"  remedy for {name}: {escaped(words)}" for words, name in known.items()]


# --- the other commands -----------------------------------------------------------------------------------------------


def _verify(arguments: argparse.Namespace) -> int:
    """Judge files of any origin by a recipe's motion; return the exit status."""
    from camgeo.api.run import verify
    from camgeo.cli.new_file import demand_new, write_new
    from camgeo.cli.progress import Progress
    from camgeo.recipe.loading import load_order
    from camgeo.report.document import as_json
    from kin.read.checks import UnitsError

    try:
        recipe = _with_tolerance(load_order(arguments.recipe), arguments.tolerance)
        paths = [Path(name) for name in arguments.files]
        within = None if arguments.tolerance is None else read_quantity(arguments.tolerance, recipe.units)
        gap = None if arguments.gap is None else read_quantity(arguments.gap, recipe.units)
        options: dict[str, Any] = {name: getattr(arguments, name) for name in registry.options()}
        own = {name: getattr(arguments, name) for name in claims.options()}
        options |= {name: value for name, value in own.items() if value is not None}
        demand_new({"--page": arguments.page})
        with_page = arguments.page is not None
        progress = Progress(recipe.name)
        progress("judge")
        try:
            verdict = verify(
                recipe, *paths, tolerance=within, units=arguments.units, gap=gap, page=with_page, **options
            )
        finally:
            progress.clear()
        report = dict(verdict)
        if verdict.page is not None:
            write_new({arguments.page: verdict.page})
        for folder in dict.fromkeys(path.parent for path in paths):
            _tell_of_mixture(report, mixtures(folder, [path.name for path in paths if path.parent == folder]))
    except UnitsError as error:
        _complain(f"{error}; leave --units out, or save the file with its right unit")
        return WRONG
    if arguments.json:
        say_json(as_json(report))
    elif name := claims.judge_of(paths[0], options):
        say(TERMINAL[name].shown(report, arguments.verbose))
    else:
        _show(report, recipe, verbose=arguments.verbose)
    return OK if report["ok"] else FAILED


def _new(arguments: argparse.Namespace) -> int:
    """Print a starter recipe or write it into a new file; without a kind, or for a kind of cam, print the starters."""
    from camgeo.cli.new_file import write_new
    from camgeo.recipe.starter import STARTERS, starter, starters_for

    sources: list[tuple[str, str]] = arguments.sources
    for folder in dict.fromkeys(folder for folder, _ in sources):
        files = [name for source_folder, name in sources if source_folder == folder]
        return _new_from(folder, files, arguments.kind, arguments.file)
    kind: str | None = arguments.kind
    if kind is None or (arguments.file is None and kind not in STARTERS and starters_for(kind)):
        names = tuple(STARTERS) if kind is None else starters_for(kind)
        say("\n".join(f"{name:<{max(map(len, names))}}  {STARTERS[name].title}" for name in names))
        return OK
    try:
        text = starter(kind)
    except ValueError as error:
        _complain(str(error))
        return WRONG
    if arguments.file in {None, "-"}:
        say(text.removesuffix("\n"))
        return OK
    write_new({arguments.file: text})
    return OK


def _new_from(folder: str, sources: Sequence[str], recipe: str | None, name: str | None) -> int:
    """Write a recipe made of files and of another recipe; return the exit status.

    The capability of this folder makes it.
    """
    from camgeo.cli.new_file import demand_new, write_new
    from camgeo.cli.progress import Progress
    from camgeo.common.errors import CallError
    from camgeo.schema.errors import RecipeErrors

    if recipe is None or name is None or name == "-":
        call = f"camgeo new --{next(iter(registry.labels()[folder].sources))} FILE RECIPE FILE"
        _complain(f"give a recipe that says what follows the cam, and a new file: {call}")
        return WRONG
    try:
        demand_new({"the recipe": name})
        start = TERMINAL[folder].started
        if start is None:
            raise KeyError(folder)
        progress = Progress(Path(name).name)
        progress("make the recipe")
        try:
            starter = start([Path(source) for source in sources], Path(recipe), name)
        finally:
            progress.clear()
        write_new(
            {
                name: starter.text,
                **{str(Path(name).with_name(beside_name)): text for beside_name, text in starter.beside.items()},
            }
        )
    except (CallError, RecipeErrors) as error:
        for line in str(error).splitlines():
            _complain(line)
        return WRONG
    except OSError as error:
        _complain(f"{escaped(str(error.filename))}: {error.strerror}")
        return SURROUNDINGS
    say("\n".join([f"{escaped(name)}:", *(f"  {line}" for line in starter.lines)]))
    return OK


def _schema(arguments: argparse.Namespace) -> int:
    """Print the JSON schema."""
    from camgeo.report.document import as_json
    from camgeo.schema.json_schema import json_schema

    say_json(as_json(json_schema(root.reading(arguments.order).table())))
    return OK


if __name__ == "__main__":
    sys.exit(main())
