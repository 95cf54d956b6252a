"""The command `camgeo follow`: its options, what it prints, its exit status."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from camgeo.cli.arguments import decimal, name_of
from camgeo.cli.exit_status import OK, SURROUNDINGS, WRONG
from camgeo.common.terminal import complain, escaped, say, say_json
from camgeo.common.units import UNIT_MM

if TYPE_CHECKING:
    import argparse

    from camgeo.capabilities.follow.library import Followed
    from kin.numeric.arrays import Array


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Give the command its options."""
    parser.add_argument("file", type=name_of, metavar="FILE", help="a drawing or a solid")
    parser.add_argument("--roller", type=_length, metavar="R", help="radius of the roller, mm; 0 for a knife edge")
    parser.add_argument("--flat", action="store_true", help="a flat face in place of a roller")
    parser.add_argument("--offset", type=_length, default=0.0, metavar="E", help="of the line of travel, mm")
    text = "an arm: distance of its pivot from the shaft, and with a roller its length, mm: 80,65"
    parser.add_argument("--arm", type=_lengths, metavar="D[,L]", help=text)
    parser.add_argument("--leading", action="store_true", help="the arm leads (default: it trails)")
    parser.add_argument("--yoke", action="store_true", help="a second contact stands opposite")
    parser.add_argument("--units", choices=UNIT_MM, help="unit of a file that states none (R12 drawings, STL)")
    text = "place of the shaft in the file, mm (default: 0,0); write --at=-3,2 where it begins with a minus"
    parser.add_argument("--at", type=_lengths, default=(0.0, 0.0), metavar="X,Y", help=text)
    parser.add_argument("--rotation", choices=("cw", "ccw"), default="cw", help="of the shaft (default: cw)")
    text = "mm within which a dwell rests, and a recipe keeps to the motion (default: 0.01)"
    parser.add_argument("--reading", type=_length, default=0.01, metavar="E", help=text)
    parser.add_argument("--table", type=name_of, metavar="CSV", help="a new file for the motion over the turn")
    text = "a new file for the recipe of a cam with this motion; its lifts stand in a table beside it"
    parser.add_argument("--recipe", type=_recipe, metavar="YAML", help=text)
    parser.add_argument("--page", type=name_of, metavar="HTML", help="a new file for the page of that recipe and FILE")
    parser.add_argument("--json", action="store_true", help="what is printed as JSON, for machines")


def _recipe(text: str) -> str:
    import argparse

    if Path(text).suffix not in {".yaml", ".yml"}:
        raise argparse.ArgumentTypeError(f"a file whose name ends in .yaml is expected, not {escaped(text)}")
    return text


def _length(text: str) -> float:
    import argparse

    try:
        return decimal(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"a length in mm is expected, not {text}") from None


def _lengths(text: str) -> tuple[float, ...]:
    return tuple(_length(part) for part in text.split(","))


def run(arguments: argparse.Namespace) -> int:
    """Follow one contour: 0 it is followed, 2 wrong, 3 surroundings."""
    from camgeo.capabilities.follow.library import follow, shown
    from camgeo.cli.new_file import demand_new, write_new
    from camgeo.common.errors import CallError, SurroundingsError
    from camgeo.schema.errors import RecipeErrors

    lifts = None if arguments.recipe is None else str(Path(arguments.recipe).with_suffix(".csv"))
    try:
        demand_new(arguments.table, arguments.recipe, lifts, arguments.page)
        followed = follow(
            arguments.file,
            roller=arguments.roller,
            flat=arguments.flat,
            offset=arguments.offset,
            arm=arguments.arm,
            leading=arguments.leading,
            yoke=arguments.yoke,
            units=arguments.units,
            at=arguments.at,
            rotation=arguments.rotation,
            reading=arguments.reading,
        )
        texts: dict[str, str] = {}
        if arguments.table is not None:
            texts[arguments.table] = followed.table()
        if arguments.recipe is not None and lifts is not None:
            texts[arguments.recipe] = followed.recipe(Path(lifts).name)
            texts[lifts] = followed.lifts()
        if arguments.page is not None:
            texts[arguments.page] = shown(followed).page or ""
        write_new(texts)
    except CallError as error:
        for fault in error.faults:
            complain(f"camgeo: {fault}")
        return WRONG
    except RecipeErrors as errors:
        complain(str(errors))
        return WRONG
    except SurroundingsError as error:
        complain(f"camgeo: {error}")
        return SURROUNDINGS
    if arguments.json:
        from camgeo.report.document import encoded

        say_json(encoded(document(followed)))
    else:
        say(summary(followed))
    return OK


def document(followed: Followed) -> dict[str, Any]:
    """What was found as plain data; lengths in mm, angles in degrees."""
    scale, unit = (1.0, "mm") if followed.unit == "mm" else (math.degrees(1.0), "deg")
    return {
        "file": followed.path.name,
        "follower": followed.follower.words,
        "unit": unit,
        "base_radius": followed.base_radius,
        "lift": scale * followed.lift,
        "least": {"position": scale * followed.least[0], "at_deg": math.degrees(followed.least[1])},
        "greatest": {"position": scale * followed.greatest[0], "at_deg": math.degrees(followed.greatest[1])},
        "dwells": [
            {
                "start_deg": math.degrees(rest.begin),
                "length_deg": math.degrees(rest.end - rest.begin),
                "position": scale * rest.level,
                "flatness": scale * rest.flatness,
            }
            for rest in followed.rests
        ],
        "pressure_angle": _peak(followed, math.degrees(1.0) * abs(followed.pressure_angle), largest=True),
        "radius_of_curvature": _peak(followed, followed.radius, largest=False),
        "breadth": None if followed.breadth is None else list(followed.breadth),
    }


def _peak(followed: Followed, values: Array, *, largest: bool) -> dict[str, float]:
    """The greatest or the least of values over the turn, and its shaft angle."""
    place = int(values.argmax() if largest else values.argmin())
    return {"value": float(values[place]), "at_deg": math.degrees(float(followed.theta[place]))}


def summary(followed: Followed) -> str:
    """What was found, in lines."""
    found = document(followed)
    unit = found["unit"]
    least, most = found["least"], found["greatest"]
    ends = f"least at {least['at_deg']:.2f} degrees, greatest at {most['at_deg']:.2f}"
    lines = [
        f"{escaped(found['file'])}: {found['follower']}",
        f"  lift {found['lift']:.6g} {unit}, {ends}; base radius {found['base_radius']:.6g} mm",
    ]
    for dwell in found["dwells"]:
        end = (dwell["start_deg"] + dwell["length_deg"]) % 360.0
        height = dwell["position"] - least["position"]
        lines.append(
            f"  dwell at {height:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
            f"flat within {dwell['flatness']:.2g} {unit}"
        )
    angle, radius = found["pressure_angle"], found["radius_of_curvature"]
    lines.append(
        f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}; "
        f"least radius of curvature {radius['value']:.4g} mm at {radius['at_deg']:.1f}"
    )
    if found["breadth"] is not None:
        low, high = found["breadth"]
        lines.append(f"  breadth from {low:.6g} to {high:.6g} mm")
    return "\n".join(lines)
