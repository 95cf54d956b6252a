"""The command `camgeo follow`: its options, what it prints, its exit status."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.follow.extension import OTHER_INPUTS
from camgeo.capabilities.follow.follower import TRACKS
from camgeo.cli.arguments import decimal, length, lengths, name_of
from camgeo.cli.exit_status import OK
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped, say, say_json
from camgeo.common.units import UNIT_MM

if TYPE_CHECKING:
    import argparse

DISC = (
    *("roller", "shoe", "flat", "width", "offset", "arm", "leading", "yoke", "track", "units", "gap", "across"),
    *("mirror", "turn", "body", "at", "rotation", "reading"),
)
"""Arguments of `follow` that are options of the command for every cam."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `camgeo follow` to its parser."""
    parser.add_argument(
        "file", type=name_of, metavar="FILE", help="a drawing, a solid, or points x, y round the contour"
    )
    text = "radius of the roller, mm or with its unit, 0.375in; 0 for a knife edge"
    parser.add_argument("--roller", type=length, metavar="R", help=text)
    parser.add_argument("--shoe", type=length, metavar="R", help="radius of a curved shoe, mm, in place of a roller")
    parser.add_argument("--flat", action="store_true", help="a flat face in place of a roller")
    parser.add_argument("--width", type=length, metavar="W", help="width of that face, centred on the stem's axis, mm")
    parser.add_argument("--offset", type=length, default=0.0, metavar="E", help="of the line of travel, mm")
    text = "an arm: distance of its pivot from the shaft, and with a round touch its length, mm: 80,65"
    parser.add_argument("--arm", type=lengths, metavar="D[,L]", help=text)
    parser.add_argument("--leading", action="store_true", help="the arm leads (default: it trails)")
    parser.add_argument("--yoke", action="store_true", help="a second contact stands opposite")
    text = "where a roller runs: outside, in the opening of a ring, or between two flanks (default: external)"
    parser.add_argument("--track", choices=TRACKS, default="external", help=text)
    parser.add_argument("--units", choices=UNIT_MM, help="unit of a file that states none (R12 drawings, STL)")
    parser.add_argument("--gap", type=length, metavar="G", help="join ends of a drawing this near, mm")
    parser.add_argument("--body", type=_body, metavar="N", help="number or name of a body, of a solid with several")
    text = "close a contour that is open, or has a slot that reaches the shaft: by an arc about it, or a chord"
    parser.add_argument("--across", choices=("arc", "chord"), help=text)
    parser.add_argument("--mirror", choices=("x", "y"), help="mirror the contour in this axis through the shaft")
    text = "degrees by which to turn the contour counter-clockwise, after that; --turn=-12 where it begins with a minus"
    parser.add_argument("--turn", type=_angle, default=0.0, metavar="A", help=text)
    text = "place of the shaft in the file, mm (default: 0,0); write --at=-3,2 where it begins with a minus"
    parser.add_argument("--at", type=lengths, default=(0.0, 0.0), metavar="X,Y", help=text)
    parser.add_argument("--rotation", choices=("cw", "ccw"), default="cw", help="of the shaft (default: cw)")
    text = "mm within which a dwell rests, and a recipe keeps to the motion (default: 0.01)"
    parser.add_argument("--reading", type=length, default=0.01, metavar="E", help=text)
    parser.add_argument("--table", type=name_of, metavar="CSV", help="a new file for the motion over the turn")
    text = "a new file for the recipe of a cam with this motion; its lifts stand in a table beside it"
    parser.add_argument("--recipe", type=_recipe, metavar="YAML", help=text)
    parser.add_argument("--page", type=name_of, metavar="HTML", help="a new file for the page of that recipe and FILE")
    parser.add_argument("--json", action="store_true", help="what is printed as JSON, for machines")
    for name in OTHER_INPUTS.answering():
        OTHER_INPUTS[name].add_arguments(parser)


def _recipe(text: str) -> str:
    import argparse

    if Path(text).suffix not in {".yaml", ".yml"}:
        raise argparse.ArgumentTypeError(f"a file whose name ends in .yaml is expected, not {escaped(text)}")
    return text


def _body(text: str) -> int | str:
    return int(text) if text.isascii() and text.isdecimal() else text


def _angle(text: str) -> float:
    import argparse

    try:
        return decimal(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"an angle in degrees is expected, not {text}") from None


def run(arguments: argparse.Namespace) -> int:
    """Follow one contour, print its figures and write the files of the call; returns the exit status 0.

    Raises CallError for a wrong call or file, and for a recipe or page of a motion that makes no recipe; RecipeErrors
    where the recipe of a page is refused; SurroundingsError where a file cannot be written or a package is missing.
    """
    from camgeo.capabilities.follow.library import follow
    from camgeo.cli.new_file import demand_new, write_new

    lifts = _lifts_beside(arguments)
    demand_new(
        {
            "--table": arguments.table,
            "--recipe": arguments.recipe,
            "--page": arguments.page,
            "the lifts of --recipe": lifts,
        }
    )
    followed = follow(arguments.file, **_asked(arguments))
    # files are written together, when all texts are made
    texts: dict[str, str] = {}
    told: list[str] = []
    if arguments.table is not None:
        texts[arguments.table] = followed.table()
    if arguments.recipe is not None and lifts is not None:
        texts[arguments.recipe], told = followed.told_recipe(Path(lifts).name)
        if (rows := followed.lifts()) is not None:
            texts[lifts] = rows
    if arguments.page is not None:
        texts[arguments.page] = followed.page()
    write_new(texts)
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(followed.document()))
    else:
        say("\n".join([followed.summary(), *told]))
    return OK


def _lifts_beside(arguments: argparse.Namespace) -> str | None:
    """Path of the table of lifts beside the recipe that is asked for; None without one."""
    return None if arguments.recipe is None else str(Path(arguments.recipe).with_suffix(".csv"))


def _asked(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `follow` but its file; raises CallError for an option that goes with one that is not given."""
    given = {name: value for name, value in vars(arguments).items() if name in DISC}
    for name in OTHER_INPUTS.answering():
        answers = OTHER_INPUTS[name]
        chosen = getattr(arguments, answers.option, None)
        if chosen is not None:
            given[answers.option] = chosen
        for option, (attribute, unset) in answers.alone.items():
            if (value := getattr(arguments, attribute)) == unset:
                continue
            if chosen is None:
                raise CallError(f"{option} goes with --{answers.option}: give both, or leave {option} out")
            given[attribute] = value
    return given
