"""The command `camgeo report`: its options, what it prints, its exit status."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.cli.arguments import add_out, decimal
from camgeo.cli.exit_status import FAILED, OK, SURROUNDINGS, WRONG
from camgeo.cli.progress import Progress
from camgeo.common.terminal import complain, say, say_json
from camgeo.files.errors import install

if TYPE_CHECKING:
    import argparse

    from camgeo.checks.declaration import Entry
    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.content import Content
    from camgeo.schema.errors import RecipeErrors

REPORT, PAGE, PICTURE = "page.json", "page.html", "page"
FORMS = ("svg", "png")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("recipes", nargs="+", metavar="RECIPE", help="a recipe's YAML file")
    add_out(parser)
    parser.add_argument(
        "--picture", action="append", default=[], choices=FORMS, help="a still picture as well; repeatable"
    )
    text = "shaft angle of the picture, degrees (default: %(default)g)"
    parser.add_argument("--at", type=_angle, default=0.0, metavar="DEG", help=text)
    parser.add_argument("--json", action="store_true", help="page.json, for machines")


def _angle(text: str) -> float:
    import argparse
    import math

    try:
        value = decimal(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= 1e6:
        raise argparse.ArgumentTypeError(f"a shaft angle is a number of degrees, not {text}")
    return value


def run(arguments: argparse.Namespace) -> int:
    """Write the page of each recipe and return the highest exit status.

    0: every check holds; 1: a check fails; 2: a recipe is wrong; 3: disk or package. With `--json` the page.json of one
    recipe is printed, of several recipes the list of them.
    """
    from camgeo.cli.batch import folder_conflicts
    from camgeo.recipe.loading import load
    from camgeo.report.document import as_json
    from camgeo.schema.errors import RecipeErrors

    recipes: list[Recipe | RecipeErrors] = []
    for path in arguments.recipes:
        try:
            recipes.append(load(path))
        except RecipeErrors as errors:
            recipes.append(errors)
    if faults := folder_conflicts([recipe for recipe in recipes if not isinstance(recipe, RecipeErrors)]):
        complain("\n".join(f"camgeo: {fault}" for fault in faults))
        return WRONG
    status, entries = OK, []
    for path, recipe in zip(arguments.recipes, recipes, strict=True):
        code, entry = _page(path, recipe, arguments)
        status = max(status, code)
        entries.append(entry)
    if arguments.json and len(entries) > 1:
        say_json(as_json(entries))
    elif arguments.json and status <= FAILED:
        say_json(as_json(entries[0]))
    return status


def _page(path: str, recipe: Recipe | RecipeErrors, arguments: argparse.Namespace) -> tuple[int, Entry]:
    """Write the page of one recipe; returns its exit status, and page.json or, with faults, an entry in its place."""
    from camgeo.cli.batch import failed_entry
    from camgeo.common.errors import SurroundingsError
    from camgeo.output.pipeline import check_and_show
    from camgeo.report.page.page import page
    from camgeo.schema.errors import RecipeErrors

    progress = Progress(Path(path).name)
    try:
        if isinstance(recipe, RecipeErrors):
            raise recipe
        outcome, contents = check_and_show(recipe, progress=progress)
        files = {PAGE: page(recipe, contents, outcome.report).encode("utf-8")}
        files |= _pictures(recipe, contents, arguments.picture, arguments.at)
        report = _write_page(recipe, files, Path(arguments.out), ok=outcome.ok)
    except RecipeErrors as errors:
        progress.clear()
        complain(str(errors))
        return WRONG, failed_entry(path, str(errors), errors.errors)
    except ModuleNotFoundError as error:
        progress.clear()
        text = f"the package {error.name} is missing: {install('picture')}"
        complain(f"camgeo: {text}")
        return SURROUNDINGS, failed_entry(path, text, ())
    except (SurroundingsError, OSError) as error:
        progress.clear()
        complain(f"camgeo: {error}")
        return SURROUNDINGS, failed_entry(path, str(error), ())
    progress.clear()
    if not arguments.json:
        folder = Path(arguments.out) / recipe.name
        verdict = "ok" if outcome.ok else "FAILED"
        sizes = ", ".join(f"{folder / name} {len(data) / 1000:.0f} kB" for name, data in files.items())
        say(f"{recipe.name}: {verdict}  {sizes}")
    return OK if outcome.ok else FAILED, report


def _pictures(recipe: Recipe, content: Content, forms: list[str], at_deg: float) -> dict[str, bytes]:
    """Pictures by file name, as `svg` or `png`, at the step of the turn nearest to a shaft angle, degrees."""
    from camgeo.report.page import svg
    from camgeo.report.page.scene import STEPS

    step = round(at_deg / 360.0 * STEPS) % STEPS
    pictures = {}
    if "svg" in forms:
        pictures[f"{PICTURE}.svg"] = svg.still(content.scene, step, recipe.name).encode("utf-8")
    if "png" in forms:
        from camgeo.report.page.png import png

        pictures[f"{PICTURE}.png"] = png(content.scene, step)
    return pictures


def _write_page(recipe: Recipe, files: dict[str, bytes], out: Path, *, ok: bool) -> Entry:
    """Write page and pictures beside the recipe's files, all or none; returns the report that lists them.

    Pictures of an earlier call stay as they are, and are listed too.
    """
    from camgeo.output.output_folder import Family, RunFolder
    from camgeo.report.document import as_json, file_entry

    report: Entry = {"recipe": recipe.name, "ok": ok, "files": [file_entry(*item) for item in files.items()]}
    with RunFolder(out, recipe.name, Family(REPORT, ("page",), "page")) as run_:
        for name, data in files.items():
            (run_.folder / name).write_bytes(data)
        kept_names = run_.kept_names()
        report["files"] += [{"path": name, "stale": True} for name in kept_names]
        (run_.folder / REPORT).write_text(as_json(report), encoding="utf-8", newline="\n")
        run_.commit(list(files), keep=kept_names)
    return report
