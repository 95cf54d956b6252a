"""Causes of deviations, fitted together: what is turned, shifted, round, regular or local, each with its uncertainty.

Turned and shifted metal adds `Deviations.columns`, a size that is off a constant, a vibrating machine a wave. What is
left after them is itself a form, not noise: its scatter, with as many independent values as the smooth curve has spans,
gives the covariance, which is wide rather than narrow. A cause is named above its expanded uncertainty (k = 2) alone;
causes whose estimates hang together are named as one sum.
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
LOOKS = 1440
SHARE = 0.25  # of the variance that is left: a wave that explains less is none
STANDS_OUT = 4.0  # standard deviations of the curve: what is local


class Cause(NamedTuple):
    """A cause: its words, value and expanded uncertainty, mm or rad, and the greatest deviation that it makes, mm.

    `at` is the parameter of a local one, `waves` the number a turn of a regular one; else None. A sum of causes has
    several names, and as value the greatest deviation that they make together.
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
    deviations. `turned` is the angle, rad, by which the metal is turned and that was taken out of the deviations.
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
    """Shift (2,) of one part's metal, mm, beside a turn and a size, and its covariance (2, 2), mm^2."""
    free, _, x, covariance, _ = _explained(deviations, curves)
    first = free.index(1)
    return x[first : first + 2], covariance[first : first + 2, first : first + 2]


class _Explained(NamedTuple):
    """Least squares of turn (0), shifts (1, 2) and size (3) over n points, of the k that are independent.

    columns (n, k), x (k,) their values, covariance (k, k) and the residual `left` (n,), mm and rad.
    """

    free: list[int]
    columns: Array
    x: Array
    covariance: Array
    left: Array


def _explained(deviations: Sequence[Deviations], curves: Sequence[Smooth]) -> _Explained:
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

    Any two estimates of a group are joined by a chain of estimates, each correlated with the next by more than ALIKE.
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
    """A wave in what is left on a surface, and the place where the rest stands out the most."""
    smooth = fit(deviations.parameter, rest, curve.spans).curve
    t = equal_steps(LOOKS)
    form = smooth.rows(t)[0]
    sd = smooth.standard_deviations(t)
    waves = np.fft.rfft(form - form.mean()) * (2.0 / LOOKS)
    named = []
    k = int(np.argmax(np.abs(waves[2:])) + 2)
    height = float(np.abs(waves[k]))
    error = curve.sigma * curve.widened * float(np.sqrt(2.0 / len(deviations.e)))
    stands_out = height > STANDS_OUT * error and 2 * k <= curve.spans  # the highest of many waves of noise is no wave
    if stands_out and 0.5 * height**2 > SHARE * float(np.var(form)):
        named.append(Cause(("waves",), height, COVERAGE * error, height, waves=k))
        form = form - np.real(waves[k] * np.exp(1j * k * t))
    worst = int(np.argmax(np.abs(form) - STANDS_OUT * sd))
    if abs(form[worst]) > STANDS_OUT * sd[worst]:
        value = float(form[worst])
        named.append(Cause(("local",), value, COVERAGE * float(sd[worst]), abs(value), at=float(t[worst])))
    return named
