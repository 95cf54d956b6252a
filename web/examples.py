"""Examples for a lecture: cams of the papers and of trades, each at a place, beside a design that differs from it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping


class Example(NamedTuple):
    """A shipped recipe as a lecture shows it.

    recipe  its path below the folder of recipes, without its suffix
    title   what it is
    see     what the place and the comparison show
    at      place of the shaft, degrees, or of the plate, in the recipe's unit
    figure  name of the figure that is compared
    kept    values, by their paths, in which the design that is kept to compare differs
    called  its name
    """

    recipe: str
    title: str
    see: str
    at: float
    figure: str
    kept: Mapping[str, Any]
    called: str


EXAMPLES = (
    Example(
        "disc-roller",
        "A roller on a stem beside the shaft",
        "Where the rise is steepest, the stem beside the shaft is pressed sideways less than one that points at it.",
        44,
        "pressure-angle-rise",
        {"cam.follower.offset": 0},
        "stem-through-the-shaft",
    ),
    Example(
        "shu-wu",
        "One disc between two parallel faces",
        "Shu and Wu 2012, section 5: half a turn is given, the other follows. A smaller disc has sharper bends.",
        60,
        "radius-of-curvature",
        {"cam.base_radius": 32},
        "smaller-disc",
    ),
    Example(
        "as-figure-9-1",
        "A cam in a frame that drives a four-bar",
        "Aygahoğlu and Şaka 2023, Figure 9a: where the shaft stands in the cam decides how far the rocker swings.",
        270,
        "swing",
        {"cam.shaft": [14, 8.5]},
        "shaft-elsewhere",
    ),
    Example(
        "w-figure-9",
        "One disc for two rollers on one arm",
        "Wunderlich 1984, Figure 9: a right-angled follower, its ratio 4/3. A smaller swing has rounder bends.",
        45,
        "radius-of-curvature",
        {"cam.delta.cos.1": 400},
        "smaller-swing",
    ),
    Example(
        "reuleaux",
        "A Reuleaux triangle",
        "Sharp or round, it is as broad in every direction, and so as long (Barbier); only its corners differ.",
        30,
        "radius-of-curvature",
        {"cam.reuleaux.rounding": 1},
        "sharper-corners",
    ),
    Example(
        "valve-lobe",
        "A valve lobe under a flat tappet",
        "An engine's lobe by the polynomial 2-8-14-20-26. A shorter one takes more acceleration, and is undercut.",
        340,
        "peak-acceleration",
        {"cam.motion.lobe.half": 60},
        "shorter-lobe",
    ),
    Example(
        "disc-packaging",
        "A pusher that keeps pace with a belt",
        "A packaging machine: 18 mm at constant velocity, joined smoothly. A plain rise is never in step, and steeper.",
        70,
        "pressure-angle-rise",
        {
            "cam.motion": [
                {"rise": 30, "over": 140, "law": "modified-sine"},
                {"dwell": 40},
                {"return": 30, "over": 120, "law": "polynomial-345"},
                {"dwell": 60},
            ]
        },
        "plain-rise",
    ),
    Example(
        "disc-knife-edge",
        "The heart cam of a winder",
        "Thread is laid at constant velocity, turned round within 20 degrees. A modified sine is gentler and piles it.",
        180,
        "peak-acceleration",
        {
            "cam.motion": [
                {"rise": 30, "over": 180, "law": "modified-sine"},
                {"return": 30, "over": 180, "law": "modified-sine"},
            ]
        },
        "modified-sine",
    ),
    Example(
        "linear/plate-feed",
        "A plate on a slide that lifts against a load",
        "A stem that leans into the rise is pressed sideways less than an upright one, and more on the return.",
        45,
        "pressure-angle-rise",
        {"cam.follower.lean": 0},
        "upright-stem",
    ),
    Example(
        "cylindrical/drum-groove",
        "A drum that leads a carriage",
        "The same motion on a larger drum is less steep; along the roller it is steepest at its inner end.",
        60,
        "pressure-angle",
        {"cam.radius": 62, "cam.follower.from": 50, "cam.follower.to": 61, "export.files": ["stl"]},
        "larger-drum",
    ),
)
