"""Where an intended motion rests: its dwells."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

INSIDE = np.array([0.07, 0.25, 0.43, 0.6, 0.78, 0.94])  # of a stretch: places at which a dwell has no slope


def dwells(lift: Lift) -> Iterator[tuple[float, float]]:
    """Dwells of a lift, stretches of constant p: pairs (from, to) of shaft angles, rad, to > from."""
    ends = lift.breaks if len(lift.breaks) else np.zeros(1)
    begin, width = ends[lift.steady], np.diff(ends, append=ends[0] + TURN)[lift.steady]
    # on a steady stretch rho is constant: a dwell if p has no slope at two places of it, else an eccentric arc
    places = begin + width * np.array([[0.25], [0.6]])
    p, slope = lift.derivatives(places.ravel(), 1).reshape(2, *places.shape)
    still = (np.abs(slope) <= 1e-12 * np.abs(p)).all(axis=0)
    return zip(begin[still].tolist(), (begin + width)[still].tolist(), strict=True)


def dwells_of_law(law: Piecewise) -> Iterable[tuple[float, float]]:
    """Dwells of a law, its constant stretches: pairs (from, to) of shaft angles, rad, to > from."""
    ends = law.breaks if len(law.breaks) else np.zeros(1)
    width = np.diff(ends, append=ends[0] + TURN)
    rates = law.derivatives((ends[:, None] + width[:, None] * INSIDE).ravel(), 2)[1:]
    still = ~rates.reshape(2, len(ends), -1).any(axis=(0, 2))
    return zip(ends[still].tolist(), (ends + width)[still].tolist(), strict=True)


def dwells_of_transmission(transmission: Transmission) -> Iterator[tuple[float, float]]:
    """Dwells of a transmission, stretches of constant psi: pairs (from, to) of shaft angles, rad, to > from."""
    ends = transmission.breaks if len(transmission.breaks) else np.zeros(1)
    shaft = transmission.at(np.append(ends, ends[0] + TURN), 0)[0][0].tolist()
    return ((a, b) for a, b, steady in zip(shaft[:-1], shaft[1:], transmission.steady, strict=True) if steady)


def dwell_angles(rests: Iterable[tuple[float, float]], phi: Array) -> Iterator[Array]:
    """For each dwell (from, to), rad, its ends and those of the shaft angles phi (n,) within it, rising."""
    for begin, end in rests:
        inside = begin + np.mod(phi - begin, TURN)
        yield np.concatenate([[begin], np.sort(inside[inside < end]), [end]])
