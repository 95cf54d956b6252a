"""The command `camgeo study`: its options, what it prints, its exit status."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from camgeo.cli.arguments import add_out, decimal
from camgeo.cli.exit_status import SURROUNDINGS, of_run
from camgeo.cli.progress import Progress
from camgeo.common.terminal import complain, say, say_json
from camgeo.files.errors import install

if TYPE_CHECKING:
    import argparse

    from camgeo.capabilities.study.tolerance_ladder import End, Rung
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

FORMS = ("polyline", "arcs", "spline", "stl")
REPORT, PICTURE = "study.json", "study.png"
PATIENCE = 2.0  # seconds of a run, fit, write and judge together, after which a ladder goes no further


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Give the command its options."""
    parser.add_argument("recipe", metavar="RECIPE", help="a recipe's YAML file")
    add_out(parser)
    parser.add_argument("--form", action="append", default=[], choices=FORMS, help="this form only; repeatable")
    text = "seconds of a run (fit, write and judge) after which a form's ladder goes no further (default: %(default)s)"
    parser.add_argument("--patience", type=_seconds, default=PATIENCE, metavar="S", help=text)
    parser.add_argument("--json", action="store_true", help="study.json, for machines")


def _seconds(text: str) -> float:
    """Seconds above 0 from a word of the call; raises ArgumentTypeError for another."""
    import argparse

    try:
        value = decimal(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value <= 1e5:
        raise argparse.ArgumentTypeError(f"a number of seconds above 0, not {text}")
    return value


def run(arguments: argparse.Namespace) -> int:
    """Study one recipe; return the exit status.

    0 if all checks of the exact cam and of every file hold, 1 if one fails, 3 if the disk refuses or a missing package
    leaves the picture out. Raises RecipeErrors for a wrong recipe, for which the command exits with 2.
    """
    from camgeo.capabilities.study.document import document, table
    from camgeo.capabilities.study.margins import margins
    from camgeo.recipe.loading import load
    from camgeo.synthesis.design import designed

    try:
        recipe = load(arguments.recipe)
        design = designed(recipe)
        progress = Progress(recipe.name)
        try:
            steps = _climb_all(recipe, design, arguments, progress)
        finally:
            progress.clear()
        failed = [check for check in design.checks if not check.ok]
        skipped = [] if design.contours else [("files", "a check of the exact contour fails")]
        if recipe.part.thickness is None:
            skipped.append(("stl", "part.thickness is not given"))
        names = [surface.name for surface in design.exact.surfaces if surface.name]
        study = document(recipe, steps, margins(recipe, design), skipped, failed=failed, names=names)
        ok = not failed and all(row["ok"] for row in study["rows"])
        _write(recipe, study, Path(arguments.out), ok=ok)
    except OSError as error:
        complain(f"camgeo: {error}")
        return SURROUNDINGS
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(study))
    else:
        say(f"{recipe.name}\n{table(study)}")
    left_out = any(entry.get("missing") for entry in study["skipped"])
    return of_run(ok=ok, left_out=left_out)


def _climb_all(recipe: Recipe, design: Design, arguments: argparse.Namespace, progress: Progress) -> list[Rung | End]:
    """Rungs and ends of the ladders of all forms; empty without a contour."""
    import tempfile

    from camgeo.capabilities.study.tolerance_ladder import climb

    if not design.contours:
        return []
    forms = [form for form in arguments.form or FORMS if form != "stl" or recipe.part.thickness is not None]
    steps: list[Rung | End] = []
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        for form in forms:
            steps += climb(recipe, design, form, Path(folder), patience=arguments.patience, listener=progress)
    return steps


def _write(recipe: Recipe, study: dict[str, Any], out: Path, *, ok: bool) -> None:
    """Write study.json and its picture beside the recipe's files, both or neither; a missing package is reported.

    A study in which a check fails, of the exact cam or of a file, goes to `out`/<name>.rejected and leaves the last
    good one. A ladder that ends at a refused tolerance, or for its time, is no failure.
    """
    from camgeo.output.output_folder import Family, RunFolder
    from camgeo.report.document import as_json, file_entry

    files: dict[str, bytes] = {}
    with RunFolder(out, recipe.name, Family(REPORT, ("study",), "study")) as run:
        try:
            from camgeo.capabilities.study.picture import picture

            if study["rows"]:
                files[PICTURE] = picture(study)
                (run.folder / PICTURE).write_bytes(files[PICTURE])
        except ModuleNotFoundError as error:
            why = f"the package {error.name} is missing: {install('study')}"
            study["skipped"].append({"what": PICTURE, "why": why, "missing": True})
        study["files"] = [file_entry(name, data) for name, data in files.items()]
        (run.folder / REPORT).write_text(as_json(study), encoding="utf-8", newline="\n")
        if ok:
            run.commit(files)
        else:
            run.reject()
