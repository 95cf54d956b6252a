"""Explanations of points or lifts of a shaft's cams that lie far off, found by rows over equal angles.

All cams are looked at together, so that a shaft turned as one, mirrored, or with cams that stand for one another is
known from a cam that alone is turned. Rows are radii over the polar angle, or lifts over the shaft angle, and are
correlated. A contour that turns back about the shaft has several radii at one angle, of which any is taken: the rows
serve for explanations alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.made.points import BETTER, FACTORS, FAR, MIRRORED, UNLIKE, UnlikePointsError
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kin.numeric.arrays import Array, Indices, Mask

LOOKS = 1440  # angles of a row
SMALL = math.radians(0.05)  # turns up to this are not named
ODD = 0.5  # share of "far" from which on a cam may stand off the others
NEAR = 1.2  # ratio of sizes within which rows may be of these cams


class OutlierWords(NamedTuple):
    """Words for rows that lie far off: the problem, and remedies.

    `far` is the share of their size from which on they are far off, `unit` that of the distance in the problem, empty
    for a share. `turned_over` is the remedy of a shaft that is counted from its other end, None where rows do not show
    that.
    """

    far: float
    problem: str
    unit: str
    mirrored: str
    mirrored_remedy: str
    turned_over: str | None


OF_POINTS = OutlierWords(
    FAR,
    "the points lie {0:.3g} mm off the contours on average",
    "mm",
    "mirrored",
    "measure it with the upper end up, as the file is drawn, or turn y round",
    "count z from the recipe's end, and turn y round",
)
OF_LIFTS = OutlierWords(
    UNLIKE,
    "the lifts are off by {0:.2g} of their strokes on average",
    "",
    "run in the other sense",
    "let angles grow as the shaft turns in the motion",
    None,
)


class LobeRows(NamedTuple):
    """Rows over k = LOOKS equal angles, mm or rad: `measured` (m, k) of m measured cams, `nominal` (n, k) of all n.

    `owner` (m,) has the index of the cam of each measured row, `names` the names of the cams. `sizes` (n,) are those of
    the nominal rows and `measured_sizes` (m,) those of the measured ones, mm or rad. `other_end` (n,) has the cam that
    stands at the place of each where the shaft is counted from its other end.
    """

    measured: Array
    nominal: Array
    owner: Indices
    names: Sequence[str]
    sizes: Array
    measured_sizes: Array
    other_end: Indices
    words: OutlierWords

    def off(self, measured: Array, nominal: Array, turns: dict[int, float] | None = None) -> Array:
        """Root mean square (m,) of measured less nominal rows, each as a share of the size of its cam.

        `turns` are angles, rad, by which the rows of these ranks are turned back first.
        """
        back = measured.copy()
        every = equal_steps(LOOKS)
        for rank, turn in (turns or {}).items():
            back[rank] = np.interp(every + turn, every, measured[rank], period=TURN)
        off: Array = np.sqrt(np.mean((back - nominal) ** 2, axis=1)) / self.sizes[self.owner]
        return off


def row(angle: Array, value: Array) -> Array:
    """Values (n,) at angles (n,), rad, in any order, interpolated at LOOKS equal steps of a turn (k,)."""
    order = np.argsort(np.mod(angle, TURN), kind="stable")
    interpolated: Array = np.interp(equal_steps(LOOKS), np.mod(angle, TURN)[order], value[order], period=TURN)
    return interpolated


def radii(places: Array) -> Array:
    """Radii (k,), mm, of places (n, 2) in any order, at LOOKS equal steps of the polar angle."""
    return row(np.arctan2(places[:, 1], places[:, 0]), np.hypot(*places.T))


def lone_turns(rows: LobeRows, *, aligned: bool) -> dict[int, float]:
    """Turns, rad, of cams that are turned on their own against the shaft, by the index of the measured row.

    Only cams whose distance a turn explains are among them. `aligned` is whether the shaft as a whole is turned back
    already. Raises UnlikePointsError for rows that look turned as one, mirrored, in another unit, or interchanged.
    """
    nominal = rows.nominal[rows.owner]
    off = rows.off(rows.measured, nominal)
    alone = {
        rank: _turn(rows.measured[rank : rank + 1], nominal[rank : rank + 1])
        for rank in np.flatnonzero(off > ODD * rows.words.far).tolist()
    }
    if off.max() > rows.words.far:
        _demand_shaft(rows, nominal, off, aligned=aligned)
    left = rows.off(rows.measured, nominal, alone)
    near = np.maximum(BETTER * off, ODD * rows.words.far)
    return {rank: turn for rank, turn in alone.items() if left[rank] <= near[rank]}


def standing_together(rows: LobeRows) -> Mask:
    """Mask (m,) of the measured cams that agree on one turn of the shaft, if they are more than half; else of all."""
    return _together(rows, rows.measured, rows.nominal[rows.owner])[1]


def _together(rows: LobeRows, measured: Array, nominal: Array) -> tuple[float, Mask]:
    """Turn of the shaft, rad, on which more than half of the cams agree, and their mask (m,); else that of all."""
    count = len(measured)
    turns = [_turn(measured / rows.sizes[rows.owner, None], nominal / rows.sizes[rows.owner, None])]
    turns += [_turn(measured[[rank]], nominal[[rank]]) for rank in range(count)]
    standing = [
        rows.off(measured, nominal, dict.fromkeys(range(count), turn)) <= ODD * rows.words.far for turn in turns
    ]
    best = max(range(len(turns)), key=lambda k: int(standing[k].sum()))
    if 2 * int(standing[best].sum()) <= count:
        return turns[0], np.ones(count, dtype=bool)
    return turns[best], standing[best]


def _demand_shaft(rows: LobeRows, nominal: Array, off: Array, *, aligned: bool) -> None:
    """Raise UnlikePointsError for rows far off that another unit, turn, sense or order of the cams explains.

    `nominal` (m, k) are the intended rows of the measured cams, `off` (m,) how far the measured rows are off them, as
    shares of the sizes of the cams. `aligned` is whether the shaft as a whole is turned back already.
    """
    far = _mean(off * rows.sizes[rows.owner]) if rows.words.unit else _mean(off)
    problem = rows.words.problem.format(far)
    ratio = float(np.median(rows.sizes[rows.owner] / rows.measured_sizes))
    factor = next((value for value in FACTORS if 1.0 / NEAR < value / ratio < NEAR), None)
    if factor is not None:
        large, word = max(factor, 1.0 / factor), "small" if factor > 1.0 else "large"
        raise UnlikePointsError(f"{problem}: they look {large:.6g} times too {word}: `--units {FACTORS[factor]}`")
    looks = [*_shaft_looks(rows, nominal, aligned=aligned), *_swap_looks(rows, off)]
    explained = [look for look in looks if look.left <= BETTER * _mean(off)]
    if explained:
        raise UnlikePointsError(f"{problem}: {min(explained).words}")


class _Look(NamedTuple):
    """An explanation of rows: how far off they are by it on average, as a share of their size, and its words."""

    left: float
    words: str


def _shaft_looks(rows: LobeRows, nominal: Array, *, aligned: bool) -> Iterator[_Look]:
    """Explanations by a shaft that is turned as one, mirrored, or measured from its other end."""
    words = rows.words
    candidates = [(False, nominal, "", ""), (True, nominal, words.mirrored, words.mirrored_remedy)]
    if words.turned_over is not None:
        other = rows.nominal[rows.other_end[rows.owner]]
        candidates.append((True, other, "measured from its other end", words.turned_over))
    for mirrored, contours, looks, remedy in candidates:
        measured = np.roll(rows.measured[:, ::-1], 1, axis=1) if mirrored else rows.measured
        turn, together = _together(rows, measured, contours)
        turned = abs(turn) > SMALL
        if not mirrored and not turned:
            continue
        left = _mean(rows.off(measured, contours, dict.fromkeys(range(len(measured)), turn))[together])
        described = [*([looks] if looks else []), *([f"turned by {math.degrees(turn):.3g} degrees"] if turned else [])]
        remedies = [*([remedy] if remedy else []), *(["`--align rotation`"] if turned and not aligned else [])]
        text = f"the shaft looks {', '.join(described)}: {', then '.join(remedies)}"
        yield _Look(left * (MIRRORED if mirrored else 1.0), text)


def _swap_looks(rows: LobeRows, off: Array) -> Iterator[_Look]:
    """Explanation by cams that are interchanged."""
    each = np.stack(
        [rows.off(rows.measured, np.broadcast_to(nominal, rows.measured.shape)) for nominal in rows.nominal], axis=1
    )
    far = off > rows.words.far
    like = np.where(far, np.argmin(each, axis=1), rows.owner)
    pairs = zip(rows.owner[far].tolist(), like[far].tolist(), strict=True)
    words = ", ".join(f"those of {rows.names[own]} look like {rows.names[other]}" for own, other in pairs)
    yield _Look(_mean(each[np.arange(len(like)), like]), f"{words}: look at the column that tells them")


def _mean(off: Array) -> float:
    """Root mean square of values (n,)."""
    return float(np.sqrt(np.mean(off**2)))


def _turn(measured: Array, nominal: Array) -> float:
    """Turn of all cams as one, rad, from -pi to pi, by the correlation of their rows (m, k)."""
    count = measured.shape[1]
    spectrum = (np.fft.rfft(measured) * np.conj(np.fft.rfft(nominal))).sum(axis=0)
    spectrum[0] = 0.0
    likeness = np.fft.irfft(spectrum, count)
    # vertex of the parabola through the greatest correlation and its neighbours
    best = int(np.argmax(likeness))
    low, here, high = likeness[best - 1], likeness[best], likeness[(best + 1) % count]
    bend = low - 2.0 * here + high
    between = 0.5 * float((low - high) / bend) if bend < 0.0 else 0.0
    return math.remainder((best + between) * (TURN / count), TURN)
