"""What a motion of a recipe runs over: an angle of the shaft, or a length of travel."""

from __future__ import annotations

from typing import NamedTuple

from camgeo.schema.fields import Kind
from kin.numeric.records import dataclass


@dataclass(frozen=True)
class Input:
    """Input of a motion, as the grammar of motions takes it.

    kind      kind of its values in a recipe, an angle or a length
    noun      words for it, such as `shaft angle`
    most      greatest extent of a segment, degrees or the recipe's unit
    variable  letter of the input in formulas: an angle in rad, a length in the recipe's unit
    turn      whether the motion fills a whole turn, so that it may repeat, leave angles open, or follow a contour; a
              lobe has a turn or a part of one
    """

    kind: Kind = Kind.ANGLE
    noun: str = "shaft angle"
    most: float = 180
    variable: str = "t"
    turn: bool = False


class Axes(NamedTuple):
    """Kind of a motion's displacements, lengths or angles, and its input."""

    stroke: Kind
    over: Input


PART, WHOLE_PART, TURN = Input(), Input(most=360), Input(most=360, turn=True)
"""A part of a turn whose segments take half a turn at most, or a whole one; and a whole turn."""
