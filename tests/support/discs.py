"""Disc cams for tests: motions from short lists of segments, and one cam of every follower."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.curve.disc import StraightFace, SwingingFace, face_shape
from camgeo.curve.moving_frame import CentreShape, Displacement, Oscillating, Translating
from camgeo.curve.parallel import Parallel
from kin.law.sources.laws import named
from kin.law.sources.programme import Dwell, Matched, Move, programme

if TYPE_CHECKING:
    from kin.law.sources.motion import Motion

DEGREE = math.pi / 180
TURN = 2 * math.pi


def segments(*rows: tuple, scale: float = 1.0, total: float = TURN) -> Motion:
    """Dwells (degrees,) and strokes (stroke, degrees, law's name or degree to match) over a turn."""
    steps = []
    for row in rows:
        if len(row) == 1:
            steps.append(Dwell(row[0] * DEGREE))
        else:
            stroke, over, kind = row
            steps.append(
                Move(over * DEGREE, named(kind) if isinstance(kind, str) else Matched(kind), by=stroke * scale)
            )
    return programme(steps, total)


def displaced(*rows: tuple, scale: float = 1.0) -> Displacement:
    return Displacement.of(segments(*rows, scale=scale))


M01 = displaced((20, 120, "cycloidal"), (60,), (-20, 120, "polynomial-345"), (60,))
M02 = displaced((24, 100, "modified-sine"), (40,), (-24, 140, "modified-trapezoid"), (80,))
M03 = displaced((12, 100, "cycloidal"), (40,), (-12, 100, "modified-trapezoid"), (120,))
M05 = displaced((25, 180, "harmonic"), (-25, 180, "harmonic"))
M06 = displaced((10, 90, "polynomial-4567"), (30,), (-10, 90, "polynomial-4567"), (150,))
M07 = displaced((20, 110, "modified-sine"), (50,), (-20, 120, "cycloidal"), (80,), scale=DEGREE)
M08 = displaced((10, 120, "cycloidal"), (40,), (-10, 120, "polynomial-345"), (80,), scale=DEGREE)
M15 = displaced((20, 60, "cycloidal"), (10,), (-20, 60, "cycloidal"), (230,))


def inline():
    return CentreShape(M01, Translating.on(50.0))


def offset(e):
    return CentreShape(M02, Translating.on(45.0, e))


def knife():
    return CentreShape(M05, Translating.on(30.0))


def shoe():
    return CentreShape(M06, Translating.on(85.0))


def arm(side):
    return CentreShape(M07, Oscillating.on(42.0, 80.0, 65.0, side))


def flat():
    return face_shape(StraightFace(M03, 30.0))


def tilted():
    return face_shape(StraightFace(M03, 32.0, 8 * DEGREE, 5.0))


def swinging(side):
    return face_shape(SwingingFace.on(M08, 36.0, 90.0, 10.0, side))


# the contour that a file would hold
CONTOURS = {
    "roller": Parallel(inline(), 10.0),
    "roller, offset": Parallel(offset(10.0), 9.0),
    "roller, offset against": Parallel(offset(-10.0), 9.0),
    "knife edge": knife(),
    "shoe": Parallel(shoe(), 60.0),
    "trailing arm": Parallel(arm(1), 8.0),
    "leading arm": Parallel(arm(-1), 8.0),
    "ring": Parallel(inline(), -10.0),
    "flat": flat(),
    "flat, tilted": tilted(),
    "trailing face": swinging(1),
    "leading face": swinging(-1),
}

# points of those contours by shaft angle, and areas, as the worked cases print them
POINTS = {
    "roller": {
        0: (40.0, 0.0),
        40: (32.243284932, 30.407499400),
        75: (11.890638728, 53.809381760),
        200: (-56.016149448, -19.542165705),
    },
    "roller, offset": {
        0: (35.099857550, 8.0),
        50: (20.950512624, 43.972948837),
        100: (-18.796393123, 56.566348160),
        250: (-6.459547404, -37.273971964),
    },
    "roller, offset against": {
        0: (35.099857550, -8.0),
        50: (35.042806095, 33.514107951),
        100: (-1.683998590, 59.583725020),
        250: (-21.566813415, -31.107490082),
    },
    "flat": {
        0: (30.0, 0.0),
        30: (23.025349806, 23.686155976),
        75: (3.947033943, 41.295398337),
        200: (-35.751394420, -0.345556400),
    },
    "flat, tilted": {
        0: (31.688578200, 4.453539231),
        30: (21.121061105, 27.811768694),
        75: (-1.541374551, 43.314390519),
        200: (-37.034974844, -6.342082253),
    },
    "knife edge": {0: (30.0, 0.0), 60: (18.125, 31.393420887), 150: (-46.181079661, 26.662658774)},
    "shoe": {0: (25.0, 0.0), 45: (15.224559802, 28.199761484), 100: (-6.077686218, 34.468271355)},
    "trailing arm": {
        0: (19.929464286, -27.546623265),
        55: (45.778830200, 3.626315467),
        140: (2.098936374, 56.463058726),
        230: (-41.908102248, 6.193082243),
    },
    "leading arm": {
        0: (19.929464286, 27.546623265),
        55: (-17.753770919, 42.444185068),
        140: (-55.240781516, -11.871756067),
        230: (7.522189541, -41.644236643),
    },
    "trailing face": {
        0: (18.4, -30.942527369),
        50: (41.284472259, 5.821538215),
        120: (16.076865482, 46.005775068),
        190: (-31.907080462, 35.804798487),
    },
    "leading face": {
        0: (18.4, 30.942527369),
        50: (-24.277854745, 35.165235268),
        120: (-47.880602671, 9.079913614),
        190: (-28.391595394, -38.480361552),
    },
    "ring": {0: (60.0, 0.0), 40: (50.351660922, 38.897889203), 200: (-74.206685964, -27.855070207)},
}  # d01, d02, d03, d04, d05, d06, d07, d08, d10
AREAS = {"roller": 8033.402512156, "flat": 3735.255254814, "knife edge": 5919.938656608, "ring": 15665.460508015}
