"""Figures of a mechanism that turns: extremes of its motion over a whole turn, and where they are."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.monotone import between, cells, extremes_of_each, pieces
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

__all__ = ["ExtremePlace", "Figures", "Quantities", "figures"]

# Resolution of each row, as a part of its greatest value.
_SHARE = 1e-12
# Changes of the output below this part of it, or of 1 rad or mm, are rounding: an output may stand still but for that.
_ROUNDED = 64.0 * 2.0**-52


class ExtremePlace(NamedTuple):
    """A value, rad or mm or a derivative by rad, and its relative angle and shaft angle, rad in [0, 2 pi)."""

    value: float
    relative: float
    shaft: float


@dataclass(frozen=True)
class Figures:
    """Extremes over one turn; angles are radians, the output is rad or mm.

    least, greatest           of the output
    frame_least, frame_greatest                         of theta_3
    transmission_least, transmission_greatest           of the angle between frame and rocker, 0 to pi/2
    force_least               of the force angle, 0 to pi/2 (`kin.linkage.forces`)
    velocity, acceleration    of the output by the shaft angle: the greatest absolute value, with its sign
    velocity_relative, acceleration_relative            likewise by the relative angle
    dead_centres              where the line through the joint D along the frame passes through the shaft, Y = 0; where
                              it rests there, both ends of the rest. Each with the value 0
    """

    least: ExtremePlace
    greatest: ExtremePlace
    frame_least: ExtremePlace
    frame_greatest: ExtremePlace
    transmission_least: ExtremePlace
    transmission_greatest: ExtremePlace
    force_least: ExtremePlace
    velocity: ExtremePlace
    acceleration: ExtremePlace
    velocity_relative: ExtremePlace
    acceleration_relative: ExtremePlace
    dead_centres: tuple[ExtremePlace, ...]

    @property
    def swing(self) -> float:
        """Greatest less least output, rad or mm."""
        return self.greatest.value - self.least.value


class Quantities(NamedTuple):
    """Quantities at relative angles (n,) of which the figures are extremes; each (n,).

    output                        position of the output, in its unit
    velocity, acceleration        its derivatives by the shaft angle; ..._relative by the relative angle
    frame                         angle of the frame, rad
    transmission_*, force_*       sine and cosine of the angle between frame and rocker or slide, and of the force angle
    offset                        Y of D from the shaft, across the frame, mm
    """

    output: Array
    velocity_relative: Array
    acceleration_relative: Array
    velocity: Array
    acceleration: Array
    frame: Array
    transmission_sine: Array
    transmission_cosine: Array
    force_sine: Array
    force_cosine: Array
    offset: Array  # Y of D from the shaft, across the frame


_OF_OUTPUT = {"output", "velocity_relative", "acceleration_relative", "velocity", "acceleration"}


def figures(rows: Callable[[Array], Quantities], shaft: Callable[[Array], Array], breaks: Array) -> Figures:
    """Figures of a mechanism from `rows` at relative angles (n,), rad, smooth between breaks (k,).

    `shaft` gives the shaft angles (n,), rad, at relative angles (n,). Raises RoughError where no polynomials follow the
    rows to rounding.
    """
    # polynomials of all rows; an output below rounding counts as standing still
    places = between(0.0, TURN, breaks.tolist())
    size = max(1.0, float(np.abs(rows(0.5 * (places[:-1] + places[1:])).output).max()))
    rounded = np.array([_ROUNDED * size if name in _OF_OUTPUT else 0.0 for name in Quantities._fields])
    curves = cells(lambda theta: np.stack(rows(theta)), places, rounded, share=_SHARE)
    of = dict(zip(Quantities._fields, extremes_of_each(curves), strict=True))
    row = {name: k for k, name in enumerate(Quantities._fields)}

    def peak(name: str) -> tuple[float, float]:
        least, greatest = of[name]
        return max(greatest, least, key=lambda extreme: abs(extreme[0]))

    def nearest_zero(name: str) -> float:
        """Relative angle, rad, at which the absolute value of a quantity is least."""
        least, greatest = of[name]
        if least[0] >= 0:
            return least[1]
        return greatest[1] if greatest[0] <= 0 else float(pieces(curves, row[name]).crossings(0.0)[0])

    # acute angles are extreme where the sine or the cosine is nearest to 0
    acute = {
        "transmission_least": nearest_zero("transmission_sine"),
        "transmission_greatest": nearest_zero("transmission_cosine"),
        "force_least": nearest_zero("force_sine"),
    }
    at = rows(np.mod(list(acute.values()), TURN))
    transmission = np.arctan2(np.abs(at.transmission_sine), np.abs(at.transmission_cosine)).tolist()
    force = np.arctan2(np.abs(at.force_sine), np.abs(at.force_cosine)).tolist()
    extreme = {
        **dict(zip(("least", "greatest"), of["output"], strict=True)),
        **dict(zip(("frame_least", "frame_greatest"), of["frame"], strict=True)),
        **dict(zip(acute, zip([*transmission[:2], force[2]], acute.values(), strict=True), strict=True)),
        **{name: peak(name) for name in ("velocity", "acceleration", "velocity_relative", "acceleration_relative")},
    }
    # places of dead centres go on after the extremes, and the shaft angle of all is found at once
    still = [(0.0, angle) for angle in pieces(curves, row["offset"]).crossings(0.0).tolist()]
    values, angles = np.transpose([*extreme.values(), *still])
    angles = np.mod(angles, TURN)
    turned = np.mod(shaft(angles), TURN)
    turned[turned >= TURN] = 0.0
    marks = [ExtremePlace(*numbers) for numbers in zip(values.tolist(), angles.tolist(), turned.tolist(), strict=True)]
    return Figures(**dict(zip(extreme, marks, strict=False)), dead_centres=_once(marks[len(extreme) :]))


def _once(places: list[ExtremePlace]) -> tuple[ExtremePlace, ...]:
    """Places in rising order, each once: a place at 2 pi is left out where 0 is among them."""
    kept: list[ExtremePlace] = []
    for place in sorted(places, key=lambda place: place.relative):
        if not any(abs(math.remainder(place.relative - known.relative, TURN)) < 1e-9 for known in kept):
            kept.append(place)
    return tuple(kept)
