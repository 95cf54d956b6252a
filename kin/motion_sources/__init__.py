"""Motions from every source: segments with any law, a formula, a table, points, a lobe polynomial.

Each gives a `Motion` over an angle: displacement and exact derivatives, proved bounds, breaks, dwells, joints.
"""

from kin.motion_sources.laws import NAMES, boundary, named, scca, sines, split, trapezoid
from kin.motion_sources.lobe import lobe
from kin.motion_sources.motion import Joint, Motion, Rest
from kin.motion_sources.points import from_points
from kin.motion_sources.programme import Dwell, Given, Matched, Move, RiseAndFall, State, programme
from kin.motion_sources.ring import Samples
from kin.motion_sources.table import Smoothed, TableError, from_table
from kin.motion_sources.table_text import read_table
from kin.motion_sources.whole import from_formula

__all__ = [
    "NAMES",
    "Dwell",
    "Given",
    "Joint",
    "Matched",
    "Motion",
    "Move",
    "Rest",
    "RiseAndFall",
    "Samples",
    "Smoothed",
    "State",
    "TableError",
    "boundary",
    "from_formula",
    "from_points",
    "from_table",
    "lobe",
    "named",
    "programme",
    "read_table",
    "scca",
    "sines",
    "split",
    "trapezoid",
]
