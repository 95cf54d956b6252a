"""The command `camgeo budget`: its options, what it prints, its exit status."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cli.arguments import name_of
from camgeo.cli.exit_status import FAILED, OK, SURROUNDINGS
from camgeo.cli.progress import Progress
from camgeo.common.terminal import complain, say, say_json

if TYPE_CHECKING:
    import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `camgeo budget` to its parser."""
    parser.add_argument("recipe", metavar="RECIPE", help="a recipe's YAML file, with a section `budget`")
    text = "drawing or solid of the cam, or one of each disc: parts are simulated on its contour"
    parser.add_argument("files", nargs="*", type=name_of, metavar="FILE", help=text)
    parser.add_argument("--json", action="store_true", help="all figures, for machines")


def run(arguments: argparse.Namespace) -> int:
    """Work out one budget and print it; the exit status: 0 kept, 1 not kept, 3 where the disk refuses.

    Raises RecipeErrors for a wrong recipe, CallError for files that do not hold the cam's contours.
    """
    from camgeo.capabilities.budget.library import budget
    from camgeo.capabilities.budget.text import table
    from camgeo.recipe.loading import load

    try:
        recipe = load(arguments.recipe)
        progress = Progress(recipe.name)
        try:
            entry = budget(recipe, *arguments.files, progress=progress)
        finally:
            progress.clear()
    except OSError as error:
        complain(f"camgeo: {error}")
        return SURROUNDINGS
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(entry))
    else:
        say(table(recipe, entry))
    return OK if entry["ok"] else FAILED
