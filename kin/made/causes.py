"""Causes of deviations, fitted together: turn, shift, size, waves and local faults, each with its uncertainty.

Turned and shifted metal adds `Deviations.columns`, a size that is off a constant, a vibrating machine a wave. Local
faults are no part of any of these: the points within them are left out of the fit, which is made anew until it leaves
the same ones. What is left after the causes is itself a form, not noise: its scatter, with as many independent values
as the smooth curve has spans, gives the covariance, which is wide rather than narrow. A cause is named only above its
expanded uncertainty (k = 2); causes whose estimates are correlated are named as one sum.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.follower.recognised import COVERAGE
from kin.made.local_faults import STANDS_OUT, local_faults, within
from kin.made.placing import ILL, conditions, least_squares
from kin.made.smooth import fit
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.made.local_faults import LocalFault
    from kin.made.points import Deviations
    from kin.made.smooth import Smooth, SmoothFit
    from kin.numeric.arrays import Array, Mask

ALIKE = 0.95  # correlation of two estimates, from which on they are one sum
LOOKS = 1440  # places of the turn at which curves are evaluated
SHARE = 0.25  # of the remaining variance: a wave that explains less is not named
MOST_WAVES = 4  # of a surface
FIRST_ORDER = 0.0025  # of what turn, shift and size make: what they leave to second order, as a standard deviation
ROUNDS = 8  # of leaving local faults out
ROBUST = 12  # steps of least absolute deviations, by weights, before the first round


class Cause(NamedTuple):
    """A cause: its names, value and expanded uncertainty, mm or rad, and the greatest deviation that it makes, mm.

    `fault` is the place of a local fault, on the surface of index `surface`, `waves` the number of waves a turn of a
    regular cause; else None. A sum of causes has several names, and its value is the greatest deviation that they make
    together.
    """

    names: tuple[str, ...]
    value: float
    uncertainty: float
    effect: float
    fault: LocalFault | None = None
    surface: int = 0
    waves: int | None = None


def causes(deviations: Sequence[Deviations], fits: Sequence[SmoothFit], turned: float = 0.0) -> list[Cause]:
    """Certain causes of the deviations of one part's surfaces, by falling effect.

    A cause is certain if its size is larger than its uncertainty. `fits` are the smooth curves through the deviations,
    with the outliers, which count for no cause. `turned` is the known turn of the metal, rad, that was taken out of the
    deviations; it is added again.
    """
    names = ["turned", "shifted along x", "shifted along y", "size"]
    found = _found(deviations, fits)
    free, chosen, x, covariance, *_ = found.explained
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
    for surface, (waves, faults) in enumerate(found.forms):
        for wave in waves:
            height = abs(wave.amplitude)
            named.append(Cause(("waves",), height, COVERAGE * wave.error, height, surface=surface, waves=wave.number))
        named += [
            Cause(("local",), own.height, COVERAGE * own.sd, abs(own.height), fault=own, surface=surface)
            for own in faults
        ]
    certain = [cause for cause in named if abs(cause.value) > cause.uncertainty]
    return sorted(certain, key=lambda cause: -cause.effect)


class LocalForm(NamedTuple):
    """Local faults of a surface, the highest first, and what the deviations (n,), mm, are by its causes."""

    deviations: Deviations
    fitted: SmoothFit
    explained: Array
    faults: list[LocalFault]

    def without(self, faults: Sequence[LocalFault]) -> Smooth:
        """The smooth curve as it were without some faults, on the spans of the one that was fitted.

        In their places the points lie on what the causes make, and on straight lines between the ends of what these
        leave.
        """
        if not faults:
            return self.fitted.curve
        e, spans, kept = self.deviations.e, self.fitted.curve.spans, ~self.fitted.outliers
        t = self.deviations.parameter
        rest = fit(t[kept], (e - self.explained)[kept], spans).curve
        bridged = e.copy()
        for fault in faults:
            inside = fault.holds(t)
            begin, end = rest.rows(np.array([fault.begin, fault.end]))[0]
            share = np.mod(t[inside] - fault.begin, TURN) / (fault.end - fault.begin)
            bridged[inside] = self.explained[inside] + begin + share * (end - begin)
        return fit(t[kept], bridged[kept], spans).curve


def local_form(deviations: Deviations, fitted: SmoothFit) -> LocalForm:
    """Local faults of a surface with the smooth curve through its deviations, told from its other causes."""
    found = _found([deviations], [fitted])
    ((_, faults),) = found.forms
    return LocalForm(deviations, fitted, deviations.e - found.explained.left, faults)


def shift_of(deviations: Sequence[Deviations], fits: Sequence[SmoothFit]) -> tuple[Array, Array]:
    """Shift (2,) of one part's metal, mm, and its covariance (2, 2), mm^2, by a fit with turn and size.

    `fits` are the smooth curves through the deviations, one for each surface, with the outliers, which are left out, as
    local faults are.
    """
    free, _, x, covariance, *_ = _found(deviations, fits).explained
    first = free.index(1)
    return x[first : first + 2], covariance[first : first + 2, first : first + 2]


class _Wave(NamedTuple):
    """A regular wave: its number a turn, its complex amplitude and standard deviation, mm."""

    number: int
    amplitude: complex
    error: float

    def at(self, t: Array) -> Array:
        """Its deviation, mm, at parameters (n,), rad."""
        wave: Array = np.real(self.amplitude * np.exp(1j * self.number * t))
        return wave


class _Explained(NamedTuple):
    """Fit of turn, shifts, size and waves to n points by least squares, with the k of the first that are independent.

    free           which these are: 0 the turn, 1 and 2 the shifts along x and y, 3 the size
    columns (n, k) deviations by each, mm per rad or mm per mm
    x, covariance  values (k,), rad and mm, and their covariance (k, k)
    left (n,)      residual, mm, also of the waves
    waves          waves of each surface that were fitted
    """

    free: list[int]
    columns: Array
    x: Array
    covariance: Array
    left: Array
    waves: list[list[_Wave]]


class _Form(NamedTuple):
    """Regular waves and local faults of a surface."""

    waves: list[_Wave]
    faults: list[LocalFault]


class _Found(NamedTuple):
    """Causes as fitted together: of all surfaces, and the waves and the local faults of each of them."""

    explained: _Explained
    forms: list[_Form]


def _found(deviations: Sequence[Deviations], fits: Sequence[SmoothFit]) -> _Found:
    """Fit causes, waves among them, and find local faults in turn, until the same waves and points are left.

    The first fit is one of least absolute deviations, which no local fault bends. Faults that move to and fro after
    ROUNDS are those of the last round.
    """
    columns = np.concatenate(
        [np.column_stack([deviation.columns("gxy"), np.ones(len(deviation.e))]) for deviation in deviations]
    )
    e = np.concatenate([deviation.e for deviation in deviations])
    whole = ~np.concatenate([fitted.outliers for fitted in fits])
    spans = sum(fitted.curve.spans for fitted in fits)
    forms = [_Form([], []) for _ in deviations]
    weights = _robust_weights(columns, e, whole)
    for _ in range(ROUNDS):
        share = float((weights > 0.0).sum() / whole.sum())
        explained = _explained(columns, e, weights, spans * share, _waves_of(forms, deviations))
        before, forms = forms, _forms(deviations, fits, explained, [form.faults for form in forms])
        inside = [within(form.faults, own.parameter) for form, own in zip(forms, deviations, strict=True)]
        kept = (whole & ~np.concatenate(inside)).astype(float)
        if _counts(before) == _counts(forms) and (kept == weights).all():
            break
        weights = kept
    return _Found(explained, forms)


def _counts(forms: Sequence[_Form]) -> list[list[int]]:
    """Numbers a turn of the waves of each surface."""
    return [sorted(wave.number for wave in form.waves) for form in forms]


def _waves_of(forms: Sequence[_Form], deviations: Sequence[Deviations]) -> list[tuple[list[_Wave], Array]]:
    """Waves of each surface, and their columns at the points of all surfaces (n, 2 k), 0 on other surfaces."""
    ends = np.cumsum([0, *(len(own.e) for own in deviations)])
    waves = []
    for k, (form, own) in enumerate(zip(forms, deviations, strict=True)):
        rows = np.zeros((ends[-1], 2 * len(form.waves)))
        rows[ends[k] : ends[k + 1]] = _columns(form.waves, own.parameter)
        waves.append((form.waves, rows))
    return waves


def _columns(waves: Sequence[_Wave], t: Array) -> Array:
    """Columns (n, 2 k) of waves at parameters (n,), rad: by the real and the imaginary part of their amplitudes."""
    angles = t[:, None] * np.array([wave.number for wave in waves], dtype=float)
    columns: Array = np.stack([np.cos(angles), -np.sin(angles)], axis=2).reshape(len(t), -1)
    return columns


def _robust_weights(columns: Array, e: Array, kept: Mask) -> Array:
    """Weights (n,) of points by which least squares give least absolute deviations; 0 for points that are not kept."""
    weights = kept.astype(float)
    size = np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-12)
    for _ in range(ROBUST):
        root = np.sqrt(weights)
        off = np.abs(e - (columns / size) @ least_squares(columns / size * root[:, None], e * root))
        middle = float(np.median(off[kept]))
        weights = np.where(kept, middle / np.maximum(off, middle), 0.0) if middle > 0.0 else kept.astype(float)
    return weights


def _explained(
    columns: Array, e: Array, weights: Array, spans: float, waves: Sequence[tuple[list[_Wave], Array]]
) -> _Explained:
    """Fit turn, shifts, size and the waves by weights (n,); the turn is left out where a shift does the same.

    `spans` is the number of independent values in the points that count, `waves` has the waves of each surface with
    their columns (n, 2 k).
    """
    size = np.sqrt(np.mean(columns**2, axis=0))
    free, root = [0, 1, 2, 3] if size[0] > 1e-6 else [1, 2, 3], np.sqrt(weights)
    while conditions(columns[:, free] / size[free]).min() < ILL and 0 in free:
        free.remove(0)  # nearly round: a turn is a shift
    chosen = columns[:, free]
    every = np.column_stack([chosen, *(rows for _, rows in waves)])
    own = every * root[:, None]
    x = least_squares(own, e * root)
    left = e - every @ x
    square = float((weights * left) @ left)
    variance = square / max(spans - every.shape[1], 1.0)  # of a mean over a span, times the points in it
    count = len(free)
    amplitudes = iter(x[count:].reshape(-1, 2).tolist())
    fitted = [[wave._replace(amplitude=complex(*next(amplitudes))) for wave in own] for own, _ in waves]
    covariance = variance * np.linalg.inv(own.T @ own)[:count, :count]
    return _Explained(free, chosen, x[:count], covariance, left, fitted)


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


def _forms(
    deviations: Sequence[Deviations],
    fits: Sequence[SmoothFit],
    explained: _Explained,
    faults: Sequence[Sequence[LocalFault]],
) -> list[_Form]:
    """Waves and local faults of each surface beside turn, shift and size; no wave is of the known `faults`."""
    columns = np.split(explained.columns, np.cumsum([len(deviation.e) for deviation in deviations])[:-1])
    each = zip(deviations, fits, columns, explained.waves, faults, strict=True)
    forms, t = [], equal_steps(LOOKS)
    for own, fitted, rows, together, known in each:
        # causes change so little between two points that straight lines do between them
        turn = np.mod(own.parameter, TURN)
        causing = np.column_stack([np.interp(t, turn, column, period=TURN) for column in rows.T])
        made = causing @ explained.x
        rest = fitted.curve.rows(t)[0] - made
        sd = np.maximum(fitted.curve.standard_deviations(t), FIRST_ORDER * float(np.abs(made).max()))
        waves, local = list[_Wave](), local_faults(rest, sd, fitted.curve.spans)
        while len(waves) < MOST_WAVES:  # what stands out already is no part of a wave
            sound = np.where(within([*known, *local], t), 0.0, 1.0)
            wave = _wave(fitted.curve, len(turn), np.column_stack([causing, _columns(waves, t)]), sound)
            if wave is None:
                break
            waves.append(next((fit_one for fit_one in together if fit_one.number == wave.number), wave))
            rest = rest - waves[-1].at(t)
            local = local_faults(rest, sd, fitted.curve.spans)
        forms.append(_Form(waves, local))
    return forms


def _wave(curve: Smooth, points: int, causing: Array, weights: Array) -> _Wave | None:
    """The wave that explains most of a curve beside others (LOOKS, k), mm; None where it does not stand out.

    It is one of two a turn or more, as turn, shift and size explain those below, and of two spans or more. The curve is
    one through so many `points`; `weights` are 0 in local faults, 1 elsewhere.
    """
    form, counts = curve.rows(equal_steps(LOOKS))[0], np.arange(2, curve.spans // 2 + 1)
    angles = equal_steps(LOOKS)[:, None] * counts
    basis = np.linalg.qr(causing * weights[:, None])[0]

    def beside(rows: Array) -> Array:
        own: Array = rows * weights.reshape(-1, *[1] * (rows.ndim - 1))
        return own - basis @ (basis.T @ own)

    rest, cosines, sines = beside(form), beside(np.cos(angles)), beside(-np.sin(angles))
    # two unknowns for each number of waves, by Cramer's rule
    aa, bb, ab = (cosines**2).sum(axis=0), (sines**2).sum(axis=0), (cosines * sines).sum(axis=0)
    a, b = rest @ cosines, rest @ sines
    determinant = aa * bb - ab**2
    told = determinant > ILL**2 * LOOKS**2 / 4.0  # a wave that was found already is not told from the others
    amplitudes = np.where(told, (bb * a - ab * b) + 1j * (aa * b - ab * a), 0.0) / np.where(told, determinant, 1.0)
    gains = np.real(amplitudes) * a + np.imag(amplitudes) * b
    k = int(np.argmax(gains))
    least = 0.5 * (aa[k] + bb[k]) - np.hypot(
        0.5 * (aa[k] - bb[k]), ab[k]
    )  # eigenvalue: how well it is told from causes
    error = curve.sigma * curve.widened * float(np.sqrt(LOOKS / points / least))
    # the highest of many waves of noise is not named
    if abs(amplitudes[k]) > STANDS_OUT * error and gains[k] > SHARE * float(rest @ rest):
        return _Wave(int(counts[k]), complex(amplitudes[k]), error)
    return None
