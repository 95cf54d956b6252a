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
