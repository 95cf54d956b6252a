"""Rounding of the numbers of a file: what its last digit leaves open of the ends of what it draws."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kin.numeric.arrays import Array

# Numbers that are no round ones end at the last digit where the file is rounded; below this share they do by chance.
MOST_END = 0.5
EVERY_DIGIT = 14  # significant ones; a file that shows more is not rounded
LEAST_DIGITS, FEW = 5, 3  # and numbers, of fewer of which nothing can be told
DIAGONAL = float(np.sqrt(2.0))  # a point is off by half a digit along x and along y


class Digits(NamedTuple):
    """The digits to which the numbers of a file are rounded: decimals, and significant ones; numbers have the fewer."""

    decimals: int
    significant: int

    def half(self, number: float) -> float:
        """Half the last digit of a number of this size."""
        before = math.floor(math.log10(number)) + 1 if number else 0
        return float(0.5 * 10.0 ** max(-self.decimals, before - self.significant))


def digits_of(numbers: Iterable[float]) -> Digits | None:
    """Digits to which numbers are rounded; None where they show all that a computer has, or too few to tell."""
    decimals, significant = [], []
    for number in set(numbers):
        mantissa, _, power = repr(abs(number)).partition("e")
        whole, _, behind = mantissa.partition(".")
        behind = behind.rstrip("0")
        places = len(behind) - int(power or 0)
        if places > 0:
            decimals.append(places)
            significant.append(len((whole + behind).lstrip("0")))
    if len(decimals) < FEW or not LEAST_DIGITS <= max(significant) <= EVERY_DIGIT:
        return None
    most = Digits(max(decimals), max(significant))
    ending = sum(
        places >= most.decimals or digits >= most.significant
        for places, digits in zip(decimals, significant, strict=True)
    )
    return most if ending > MOST_END * len(decimals) else None


class Written(NamedTuple):
    """An entity's numbers as a file has them: lengths, and what is multiplied by its radius, such as angles.

    `radius` is its greatest, `turn` rad in the unit of the angles, `scale` the factor of the blocks round it.
    """

    lengths: Sequence[float]
    angles: Sequence[float] = ()
    radius: float = 0.0
    turn: float = 1.0
    scale: float = 1.0


def rounding(entities: Sequence[Written]) -> Array:
    """How far rounding may put the ends of each entity off, in the drawing's unit (n,); 0 where no digits show it."""
    digits = digits_of(number for one in entities for number in (*one.lengths, *one.angles))
    if digits is None:
        return np.zeros(len(entities))
    off = []
    for one in entities:
        ends = DIAGONAL * digits.half(max(map(abs, one.lengths), default=0.0))
        if one.angles:  # a centre, a radius and angles
            ends = 2.0 * ends + one.radius * one.turn * digits.half(max(map(abs, one.angles)))
        off.append(one.scale * ends)
    return np.array(off)
