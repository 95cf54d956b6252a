# needs: follow
"""The motion that a drum of unknown origin gives a roller: `camgeo follow --drum`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.capabilities.cylindrical.followed_recipe import Drawn
from camgeo.capabilities.cylindrical.keys import MOST_TURNS
from camgeo.capabilities.follow.extension import OtherInputs
from camgeo.cli.arguments import decimal, length
from camgeo.common.arguments import number_of, path_of, text_of, whole_of
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from kin.cylindrical.follower import Arm
from kin.cylindrical.running import StatedRoller, run
from kin.cylindrical.unknown import Placed, UnknownError, read_drum
from kin.numeric.errors import UnsettledError
from kin.read.errors import ReadError
from kin.read.formats import FORMATS, format_of, oversize, suffixes

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from kin.cylindrical.running import Kind

_KINDS: dict[str, Kind | None] = {"auto": None, "groove": "groove", "rib": "rib", "top": "top", "bottom": "bottom"}
KINDS = tuple(_KINDS)
OF_DISCS = "--flat, --shoe, --yoke, --track, --across, --mirror, --gap and --body"
FLANKS = ("lower", "upper", "middle")
APEX: Literal["axis"] = "axis"
STEEPEST = 45.0  # degrees, of a cone's half angle
UNMOVED = 1e-6  # mm of a lower face that lies at 0
ACROSS = 2  # coordinates of the place of a drum's axis in its file
ON_ARM = ("length", "offset", "pivot")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    text = "a drum: what leads the roller, its end face towards the top or bottom, or auto for what the file shows"
    parser.add_argument("--drum", choices=KINDS, help=text)
    text = "where the roller on a drum begins to bear, mm from the drum's axis (default: the floor and 0.5 mm)"
    parser.add_argument("--from", type=length, dest="bears_from", metavar="R", help=text)
    text = "where it ends (default: radius of the drum); --arm is its length, y and height of its pivot"
    parser.add_argument("--to", type=length, dest="bears_to", metavar="R", help=text)
    text = (
        "half angle in degrees of a conical roller, or axis; and where it has its radius, mm (default: half way): 5,44"
    )
    parser.add_argument("--taper", type=_taper, metavar="DEG[,AT]", help=text)
    parser.add_argument("--distance", type=length, metavar="D", help="of both rollers' axes about a rib, mm")
    text = "flank of a groove by which the roller is held, or middle for midway between both (default: lower)"
    parser.add_argument("--flank", choices=FLANKS, default="lower", help=text)
    parser.add_argument(
        "--axis", choices=("x", "y", "z"), default="z", help="axis of the drum in the file (default: z)"
    )
    text = "height over the lower face, mm, of the track of a drum with several, or of its turn, at angle 0"
    parser.add_argument("--height", type=length, metavar="Z", help=text)
    text = "turns after which a groove on a drum closes (default: as the file shows)"
    parser.add_argument("--turns", type=int, metavar="N", help=text)
    text = "of a shoe on a drum in place of a roller, mm: --width is its width, as wide as its groove"
    parser.add_argument("--length", type=length, metavar="L", help=text)


def _taper(text: str) -> tuple[float | Literal["axis"], float | None]:
    import argparse

    angle, _, at = text.partition(",")
    try:
        return "axis" if angle == APEX else decimal(angle), decimal(at) if at else None
    except ValueError:
        problem = f"an angle in degrees or axis, and perhaps a length in mm, is expected, not {escaped(text)}"
        raise argparse.ArgumentTypeError(problem) from None


def _follow(arguments: argparse.Namespace) -> Drawn:
    """Motion of a roller on a drum; raises CallError for a wrong call or file, and where it touches nothing."""
    path = path_of("file", arguments.file)
    stated = _stated(arguments)
    of_discs = (arguments.flat, arguments.yoke, arguments.track != "external", arguments.across, arguments.mirror)
    given = (arguments.shoe, arguments.gap, arguments.body)
    if any(of_discs) or any(value is not None for value in given):
        raise CallError("--flat, --shoe, --yoke, --track, --across, --mirror, --gap and --body are not of drums")
    _demand_solid(path)
    record = format_of(path)
    if record.units and arguments.units is not None:
        remedy = "leave units out, or save the file with its right unit"
        raise CallError(f"{escaped(str(path))}: the file states its unit itself: {remedy}")
    if len(arguments.at) != ACROSS:
        raise CallError("at is the place of the drum's axis in the file: two lengths in mm")
    for name, choices in (("axis", ("x", "y", "z")), ("flank", FLANKS)):
        text_of(name, getattr(arguments, name), choices, f"{name} of a drum")
    placed = Placed(arguments.axis, arguments.at, math.radians(arguments.turn), mirrored=arguments.rotation == "ccw")
    name = escaped(str(path))
    try:
        drum = read_drum(path, placed, None if arguments.units is None else UNIT_MM[arguments.units])
        moved = run(drum, stated)
    except ReadError as error:
        raise CallError(f"{name}: {error.message}") from error
    except UnknownError as error:
        raise CallError(f"{name}: {error}{f'; {error.remedy}' if error.remedy else ''}") from error
    except (UnsettledError, ValueError) as error:
        raise CallError(f"{name}: {error}") from error
    except OSError as error:
        raise CallError(f"{name}: {error.strerror or error}") from error
    unjudged = ""
    if placed._replace(mirrored=False) != Placed() or abs(drum.below) > UNMOVED:
        unjudged = "a page judges a file as it lies, its lower face at z = 0: leave axis, at and turn out, or page"
    said = arguments.flank, arguments.rotation, arguments.reading, arguments.turn, arguments.units
    shoe = (_number("length", arguments.length) or 0.0) if stated.shoe else None
    return Drawn(path, drum, moved, *said, unjudged, shoe)


def _demand_solid(path: Path) -> None:
    """Raise CallError for a file that is no solid, or too large."""
    kinds = [suffix for suffix, kind in suffixes().items() if FORMATS[kind].contents == "solid"]
    if path.suffix.lower() not in kinds:
        raise CallError(f"{escaped(str(path))}: a drum is followed in a solid: give one of {', '.join(kinds)}")
    try:
        large = oversize(path, format_of(path).name)
    except OSError as error:
        raise CallError(f"{escaped(str(path))}: {error.strerror or error}") from error
    if large:
        raise CallError(f"{escaped(str(path))}: {large}")


def _stated(arguments: argparse.Namespace) -> StatedRoller:
    """The roller and its guide; raises CallError for what does not go together, TypeError for another type."""
    kind = text_of("drum", arguments.drum, KINDS, "what leads the roller")
    of_drums = ("bears_from", "bears_to", "distance", "height")
    inner, outer, distance, height = (_number(name, getattr(arguments, name)) for name in of_drums)
    taper, at = _cone(arguments.taper)
    radius = arguments.roller if arguments.width is None else 0.5 * arguments.width
    if radius is None or not radius > 0.0:
        raise CallError("a drum is followed by a roller: give --roller with its radius, or --width of a shoe")
    shoe, long = arguments.width is not None, _number("length", arguments.length)
    _demand_shoe(arguments, long)
    if arguments.turns is not None and whole_of("turns", arguments.turns) not in range(1, MOST_TURNS + 1):
        raise CallError(f"a groove closes after 1 to {MOST_TURNS} turns, not {arguments.turns}")
    for name, value in (("from", inner), ("to", outer), ("distance", distance), ("taper's place", at)):
        if value is not None and not value > 0.0:
            raise CallError(f"{name} is a length above 0, not {value:.6g}")
    if not arguments.reading > 0.0:
        raise CallError(f"a reading is a length above 0, not {arguments.reading:.6g}")
    if inner is not None and outer is not None and not inner < outer:
        raise CallError(f"the roller bears from {inner:.6g} to {outer:.6g} mm: give from below to")
    arm = None
    if arguments.arm is not None:
        if len(arguments.arm) != len(ON_ARM) or not arguments.arm[0] > 0.0:
            raise CallError("the arm of a drum has its length, and y and height of its pivot, mm: --arm 90,88.6,50")
        along, offset, pivot = arguments.arm
        arm = Arm(along, offset, pivot, -1 if arguments.leading else 1)
        if arguments.offset:
            raise CallError("an arm has its own offset: leave --offset out")
    elif arguments.leading:
        raise CallError("only an arm leads: give --arm, or leave --leading out")
    return StatedRoller(
        radius,
        _KINDS[kind],
        inner,
        outer,
        arguments.offset,
        taper if taper == APEX else math.radians(taper),
        at,
        arm,
        height,
        distance,
        arguments.turns,
        shoe,
    )


def _demand_shoe(arguments: argparse.Namespace, long: float | None) -> None:
    """Raise CallError for a shoe together with a roller or what does not lead one, and for one that is too short."""
    if arguments.width is None:
        if long is not None:
            raise CallError("only a shoe has a length: give --width, or leave --length out")
        return
    if arguments.roller is not None:
        raise CallError("a shoe takes the place of a roller: give --roller or --width")
    if arguments.arm is not None or arguments.offset or arguments.taper is not None:
        raise CallError(
            "a shoe is on a carriage, and its pin is a radius of the drum: leave --arm, --offset and --taper out"
        )
    if long is not None and not long > arguments.width:
        raise CallError(f"a shoe is longer than it is wide: give --length above {arguments.width:.6g}")


def _number(name: str, value: object) -> float | None:
    """A length of the call, mm; None where it is not given."""
    return None if value is None else number_of(name, value)


def _cone(value: object) -> tuple[float | Literal["axis"], float | None]:
    """Half angle, degrees, of a roller, or "axis", and where it has its radius, mm; 0 and None for a cylinder.

    It is given as an angle or "axis", or as a tuple of that and a length.
    """
    if value is None:
        return 0.0, None
    angle, at = value if isinstance(value, tuple) and len(value) == len(("angle", "at")) else (value, None)
    place = _number("taper's place", at)
    if angle == APEX:
        return APEX, place
    half = number_of("taper", angle)
    if not 0.0 < half < STEEPEST:
        raise CallError(f"a taper lies above 0 and below {STEEPEST:g} degrees")
    return half, place


ANSWERS = OtherInputs(
    option="drum",
    add_arguments=_add_arguments,
    follow=_follow,
    alone={
        "--from": ("bears_from", None),
        "--to": ("bears_to", None),
        "--taper": ("taper", None),
        "--distance": ("distance", None),
        "--flank": ("flank", "lower"),
        "--axis": ("axis", "z"),
        "--height": ("height", None),
        "--turns": ("turns", None),
        "--length": ("length", None),
    },
    solids="follow a drum by --drum auto and --roller with its radius",
)
