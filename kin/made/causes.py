"""Causes of deviations, fitted together: turn, shift, size, waves and local faults, each with its uncertainty.

Turned and shifted metal adds `Deviations.columns`, a size that is off a constant, a vibrating machine a wave. What is
left after them is itself a form, not noise: its scatter, with as many independent values as the smooth curve has spans,
gives the covariance, which is wide rather than narrow. A cause is named only above its expanded uncertainty (k = 2);
causes whose estimates are correlated are named as one sum.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.made.motion import COVERAGE
from kin.made.placing import ILL, conditions, least_squares
from kin.made.smooth import fit
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.made.points import Deviations
    from kin.made.smooth import Smooth
    from kin.numeric.arrays import Array

ALIKE = 0.95  # correlation of two estimates, from which on they are one sum
LOOKS = 1440  # places of the turn at which curves are evaluated
SHARE = 0.25  # of the remaining variance: a wave that explains less is not named
STANDS_OUT = 4.0  # standard deviations of the curve: a wave or a local fault is higher


class Cause(NamedTuple):
    """A cause: its names, value and expanded uncertainty, mm or rad, and the greatest deviation that it makes, mm.

    `at` is the parameter, rad, of a local fault, `waves` the number of waves a turn of a regular cause; else None. A
    sum of causes has several names, and its value is the greatest deviation that they make together.
    """

    names: tuple[str, ...]
    value: float
    uncertainty: float
    effect: float
    at: float | None = None
    waves: int | None = None


def causes(deviations: Sequence[Deviations], curves: Sequence[Smooth], turned: float = 0.0) -> list[Cause]:
    """Certain causes of the deviations of one part's surfaces, by falling effect.

    A cause is certain if its size is larger than its uncertainty. `curves` are the smooth curves through the
    deviations. `turned` is the known turn of the metal, rad, that was taken out of the deviations; it is added again.
    """
    names = ["turned", "shifted along x", "shifted along y", "size"]
    free, chosen, x, covariance, left = _explained(deviations, curves)
    if 0 in free:
        x[free.index(0)] += turned
    sds = np.sqrt(np.diag(covariance))
    named = []
    for group in correlated_groups(covariance / np.outer(sds, sds)):
        part = chosen[:, group] @ x[group]
        effect = float(np.abs(part).max())
        if len(group) == 1:
            (k,) = group
            named.append(Cause((names[free[k]],), float(x[k]), COVERAGE * float(sds[k]), effect))
        else:
            own = chosen[:, group]
            spread = np.sqrt(np.einsum("ij,jk,ik->i", own, covariance[np.ix_(group, group)], own))
            joint = tuple(names[free[k]] for k in group)
            named.append(Cause(joint, effect, COVERAGE * float(spread[int(np.argmax(np.abs(part)))]), effect))
    for deviation, curve, rest in zip(deviations, curves, _split(left, deviations), strict=True):
        named += _regular_and_local(deviation, curve, rest)
    certain = [cause for cause in named if abs(cause.value) > cause.uncertainty]
    return sorted(certain, key=lambda cause: -cause.effect)


def shift_of(deviations: Sequence[Deviations], curves: Sequence[Smooth]) -> tuple[Array, Array]:
    """Shift (2,) of one part's metal, mm, and its covariance (2, 2), mm^2, by a fit with turn and size.

    `curves` are the smooth curves through the deviations, one for each surface.
    """
    free, _, x, covariance, _ = _explained(deviations, curves)
    first = free.index(1)
    return x[first : first + 2], covariance[first : first + 2, first : first + 2]


class _Explained(NamedTuple):
    """Fit of turn, shifts and size to n points by least squares, with the k of them that are independent.

    free           which these are: 0 the turn, 1 and 2 the shifts along x and y, 3 the size
    columns (n, k) deviations by each, mm per rad or mm per mm
    x, covariance  values (k,), rad and mm, and their covariance (k, k)
    left (n,)      residual, mm
    """

    free: list[int]
    columns: Array
    x: Array
    covariance: Array
    left: Array


def _explained(deviations: Sequence[Deviations], curves: Sequence[Smooth]) -> _Explained:
    """Fit turn, shifts and size; the turn is left out where it cannot be told from a shift."""
    columns = np.concatenate(
        [np.column_stack([deviation.columns("gxy"), np.ones(len(deviation.e))]) for deviation in deviations]
    )
    e = np.concatenate([deviation.e for deviation in deviations])
    spans = sum(curve.spans for curve in curves)
    size = np.sqrt(np.mean(columns**2, axis=0))
    free = [0, 1, 2, 3] if size[0] > 1e-6 else [1, 2, 3]
    while conditions(columns[:, free] / size[free]).min() < ILL and 0 in free:
        free.remove(0)  # nearly round: a turn is a shift
    chosen = columns[:, free]
    x = least_squares(chosen, e)
    left = e - chosen @ x
    variance = float(left @ left) / max(spans - len(free), 1)  # of a mean over a span, times the points in it
    return _Explained(free, chosen, x, variance * np.linalg.inv(chosen.T @ chosen), left)


def correlated_groups(correlation: Array) -> list[list[int]]:
    """Groups of the n estimates whose correlations are given, (n, n), by their indices.

    Any two estimates of a group are joined by a chain of estimates, each correlated with the next by more than ALIKE,
    above or below 0.
    """
    groups: list[list[int]] = []
    for k in range(len(correlation)):
        joined = [group for group in groups if np.abs(correlation[k, group]).max() > ALIKE]
        groups = [group for group in groups if group not in joined] + [sorted(sum(joined, [k]))]
    return groups


def _split(rows: Array, deviations: Sequence[Deviations]) -> list[Array]:
    parts: list[Array] = np.split(rows, np.cumsum([len(deviation.e) for deviation in deviations])[:-1])
    return parts


def _regular_and_local(deviations: Deviations, curve: Smooth, rest: Array) -> list[Cause]:
    """The strongest wave in the residual `rest` (n,), mm, on a surface, and a local fault, where they stand out."""
    # amplitudes of all waves from two a turn on: turn, shift and size explain those below
    smooth = fit(deviations.parameter, rest, curve.spans).curve
    t = equal_steps(LOOKS)
    form = smooth.rows(t)[0]
    sd = smooth.standard_deviations(t)
    waves = np.fft.rfft(form - form.mean()) * (2.0 / LOOKS)
    named = []
    k = int(np.argmax(np.abs(waves[2:])) + 2)
    height = float(np.abs(waves[k]))
    error = curve.sigma * curve.widened * float(np.sqrt(2.0 / len(deviations.e)))
    # the highest of many waves of noise is not named, nor a wave that the spans do not resolve
    stands_out = height > STANDS_OUT * error and 2 * k <= curve.spans
    if stands_out and 0.5 * height**2 > SHARE * float(np.var(form)):
        named.append(Cause(("waves",), height, COVERAGE * error, height, waves=k))
        form = form - np.real(waves[k] * np.exp(1j * k * t))
    worst = int(np.argmax(np.abs(form) - STANDS_OUT * sd))
    if abs(form[worst]) > STANDS_OUT * sd[worst]:
        value = float(form[worst])
        named.append(Cause(("local",), value, COVERAGE * float(sd[worst]), abs(value), at=float(t[worst])))
    return named
