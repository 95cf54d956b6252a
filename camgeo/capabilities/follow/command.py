"""The command `camgeo follow`: its options, what it prints, its exit status."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.follow.extension import OTHER_INPUTS
from camgeo.capabilities.follow.follower import TRACKS
from camgeo.cli.arguments import decimal, length, lengths, name_of
from camgeo.cli.exit_status import OK
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped, say, say_json
from camgeo.common.units import UNIT_MM
from kin.follower.measured import LEAST_DWELL
from kin.numeric.angles import TURN
from kin.numeric.records import replace

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from camgeo.capabilities.follow.extension import FollowedOver
    from camgeo.capabilities.follow.library import Followed, Rest
    from kin.numeric.arrays import Array


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
    from camgeo.capabilities.follow.library import follow, judged_by_recipe
    from camgeo.cli.new_file import demand_new, write_new

    _demand_own(arguments)
    for name in OTHER_INPUTS.answering():
        answers = OTHER_INPUTS[name]
        if answers.follow is not None and getattr(arguments, answers.option) is not None:
            return _print_other(arguments, answers.follow(arguments))
    lifts = _lifts_beside(arguments)
    writers = {"--table": arguments.table, "--recipe": arguments.recipe, "--page": arguments.page}
    demand_new({**writers, "the lifts of --recipe": lifts})
    followed = follow(
        arguments.file,
        roller=arguments.roller,
        shoe=arguments.shoe,
        flat=arguments.flat,
        width=arguments.width,
        offset=arguments.offset,
        arm=arguments.arm,
        leading=arguments.leading,
        yoke=arguments.yoke,
        track=arguments.track,
        units=arguments.units,
        gap=arguments.gap,
        across=arguments.across,
        mirror=arguments.mirror,
        turn=arguments.turn,
        body=arguments.body,
        at=arguments.at,
        rotation=arguments.rotation,
        reading=arguments.reading,
    )
    # files are written together, when all texts are made
    texts: dict[str, str] = {}
    if arguments.table is not None:
        texts[arguments.table] = followed.table()
    if arguments.recipe is not None and lifts is not None:
        texts[arguments.recipe] = followed.recipe(Path(lifts).name, laws=True)
        texts[lifts] = followed.lifts()
    if arguments.page is not None:
        texts[arguments.page] = judged_by_recipe(followed).page or ""
    write_new(texts)
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(document(followed)))
    else:
        say("\n".join([summary(followed), *([] if lifts is None else followed.law_lines(Path(lifts).name))]))
    return OK


def _demand_own(arguments: argparse.Namespace) -> None:
    """Raise CallError for an option that goes with another one, such as --drum, which is not given."""
    for name in OTHER_INPUTS.answering():
        answers = OTHER_INPUTS[name]
        if answers.option and getattr(arguments, answers.option) is None:
            for option, (attribute, unset) in answers.alone.items():
                if getattr(arguments, attribute) != unset:
                    raise CallError(f"{option} goes with --{answers.option}: give both, or leave {option} out")


def _lifts_beside(arguments: argparse.Namespace) -> str | None:
    """Path of the table of lifts beside the recipe that is asked for; None without one."""
    return None if arguments.recipe is None else str(Path(arguments.recipe).with_suffix(".csv"))


def _print_other(arguments: argparse.Namespace, followed: FollowedOver) -> int:
    """Print a motion of another cam than a disc, write its table, recipe and page; returns the exit status 0."""
    from camgeo.cli.new_file import demand_new, write_new

    lifts = _lifts_beside(arguments)
    writers = {"--table": arguments.table, "--recipe": arguments.recipe, "--page": arguments.page}
    demand_new({**writers, "the lifts of --recipe": lifts})
    texts = {} if arguments.table is None else {arguments.table: followed.table()}
    if arguments.recipe is not None and lifts is not None:
        texts[arguments.recipe] = followed.recipe(Path(lifts).name)
        if (rows := followed.lifts()) is not None:
            texts[lifts] = rows
    if arguments.page is not None:
        texts[arguments.page] = followed.page()
    write_new(texts)
    if arguments.json:
        from camgeo.report.document import as_json

        say_json(as_json(followed.document()))
    else:
        say(followed.summary())
    return OK


def document(followed: Followed) -> dict[str, Any]:
    """The motion's figures as plain data for JSON; lengths in mm, angles in degrees."""
    scale, unit = (1.0, "mm") if followed.unit == "mm" else (math.degrees(1.0), "deg")
    travel, radius, known = followed.contact_travel, followed.radius, followed.known
    least, greatest, smoothed = followed.least, followed.greatest, None
    if not known.all():
        low, high = np.where(known, followed.position, np.inf), np.where(known, followed.position, -np.inf)
        least = float(low.min()), float(followed.theta[low.argmin()])
        greatest = float(high.max()), float(followed.theta[high.argmax()])
    if followed.facets is not None:  # what a polygon says of radii and accelerations is of its corners
        radius = np.full(len(radius), math.inf)
        if followed.smoothed is not None and known.any():
            kept = scale * followed.smoothed[known]
            smoothed = [float(kept.min()), float(kept.max())]
    return {
        "file": followed.path.name,
        "follower": followed.follower.words,
        "unit": unit,
        "base_radius": followed.follower.base_radius(least[0]),
        "lift": scale * (greatest[0] - least[0]),
        "least": {"position": scale * least[0], "at_deg": math.degrees(least[1])},
        "greatest": {"position": scale * greatest[0], "at_deg": math.degrees(greatest[1])},
        "dwells": [
            {
                "start_deg": math.degrees(rest.begin),
                "length_deg": math.degrees(rest.end - rest.begin),
                "position": scale * rest.level,
                "flatness": scale * rest.flatness,
            }
            for rest in known_rests(followed.rests, followed.unknown)
        ],
        # the greatest magnitude, as the least of the negative ones
        "pressure_angle": _least(followed, -math.degrees(1.0) * abs(followed.pressure_angle)),
        "radius_of_curvature": _least(followed, np.where(radius < 0.0, math.inf, radius)),
        "hollow_radius": _least(followed, np.where(radius < 0.0, -radius, math.inf)),
        "facets": followed.facets,
        "smoothed_acceleration": smoothed,
        "breadth": None if followed.breadth is None else list(followed.breadth),
        "play": None if followed.play is None else [scale * value for value in followed.play],
        "contact_travel": None if travel is None else list(travel),
        "across": [_across(followed, begin, end, scale) for begin, end in followed.unknown],
        "openings": followed.openings,
        "remarks": list(followed.remarks),
    }


def known_rests(rests: Sequence[Rest], unknown: Sequence[tuple[float, float]]) -> list[Rest]:
    """Dwells without what of them lies in unknown stretches, (begin, end), rad; parts below ten degrees go."""
    left = list(rests)
    for begin, end in unknown:
        parts = []
        for rest in left:
            first = begin + TURN * math.ceil((rest.begin - end) / TURN)  # the stretch that ends beyond its beginning
            last = first + end - begin
            sides = [(rest.begin, min(rest.end, first)), (max(rest.begin, last), rest.end)]
            cut = first < rest.end
            parts += [replace(rest, begin=a, end=b) for a, b in sides if b - a >= LEAST_DWELL] if cut else [rest]
        left = parts
    return left


def _across(followed: Followed, begin: float, end: float, scale: float) -> dict[str, float]:
    """Figures of the motion over a stretch of shaft angles, rad, in which nothing is known of the contour."""
    within = (followed.theta - begin) % TURN <= end - begin
    position, pressure = scale * followed.position[within], followed.pressure_angle[within]
    return {
        "start_deg": math.degrees(begin),
        "end_deg": math.degrees(end) % 360.0,
        "least": float(position.min()),
        "greatest": float(position.max()),
        "pressure_angle": math.degrees(float(np.abs(pressure).max())),
    }


def _least(followed: Followed, values: Array) -> dict[str, float] | None:
    """Magnitude of the least of values (n,) where the contour is known, and its shaft angle; None if not finite."""
    values = np.where(followed.known, values, math.inf)
    place = int(values.argmin())
    if not math.isfinite(values[place]):
        return None
    return {"value": abs(float(values[place])), "at_deg": math.degrees(float(followed.theta[place]))}


def summary(followed: Followed) -> str:
    """The motion's figures in lines of text."""
    figures = document(followed)
    unit, least, most = figures["unit"], figures["least"], figures["greatest"]
    ends = f"least at {least['at_deg']:.2f} degrees, greatest at {most['at_deg']:.2f}"
    lines = [
        f"{escaped(figures['file'])}: {figures['follower']}",
        f"  lift {figures['lift']:.6g} {unit}, {ends}; base radius {figures['base_radius']:.6g} mm",
    ]
    for dwell in figures["dwells"]:
        end = (dwell["start_deg"] + dwell["length_deg"]) % 360.0
        height = round(dwell["position"] - least["position"], 7) + 0.0  # no more than rounding on a large roller
        lines.append(
            f"  dwell at {height:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
            f"flat within {dwell['flatness']:.2g} {unit}"
        )
    angle = figures["pressure_angle"]
    lines.append(f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}")
    radii = {"least radius of curvature": "radius_of_curvature", "least radius of a hollow": "hollow_radius"}
    for words, key in radii.items():
        if (radius := figures[key]) is not None:
            corner = "" if radius["value"] else ", a corner,"
            lines.append(f"  {words} {radius['value']:.4g} mm{corner} at {radius['at_deg']:.1f} degrees")
    if (facets := figures["facets"]) is not None:
        lines.append(f"  a polygon: its edges stand {facets:.2g} mm off a curve, and say nothing of radii of curvature")
        if (pair := figures["smoothed_acceleration"]) is not None:
            lines.append(f"  acceleration of the smoothed motion from {pair[0]:.4g} to {pair[1]:.4g} {unit}/rad²")
    for words, key, scale in (("breadth", "breadth", "mm"), ("play in the groove", "play", unit)):
        if (pair := figures[key]) is not None:
            lines.append(f"  {words} from {pair[0]:.6g} to {pair[1]:.6g} {scale}")
    if (travel := figures["contact_travel"]) is not None:
        width = "" if unit == "deg" else f", a centred face is {2.0 * max(map(abs, travel)):.6g} mm wide"
        lines.append(f"  contact on the face from {travel[0]:.6g} to {travel[1]:.6g} mm{width}")
    if count := figures["openings"]:
        contours = "1 other closed contour is" if count == 1 else f"{count} other closed contours are"
        lines.append(f"  {contours} passed over: a bore that is not round, holes, or what is drawn in them")
    for part in figures["across"]:
        low, high = (round(part[key] - least["position"], 7) + 0.0 for key in ("least", "greatest"))
        lines.append(
            f"  where it is closed, from {part['start_deg']:.1f} to {part['end_deg']:.1f} degrees: at {low:.6g} to "
            f"{high:.6g} {unit}, pressure angle up to {part['pressure_angle']:.2f} degrees"
        )
    lines += [f"  {escaped(remark)}" for remark in figures["remarks"]]
    return "\n".join(lines)
