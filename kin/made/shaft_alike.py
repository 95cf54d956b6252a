"""Explanations of points or lifts of a shaft's cams that lie far off, found by rows over equal angles.

All cams are looked at together, so that a shaft turned as one, mirrored, or with cams that stand for one another is
known from a cam that alone is turned. Rows are radii over the polar angle, or lifts over the shaft angle, and are
correlated. A contour that turns back about the shaft has several radii at one angle, of which any is taken: these are
looks, and nothing rests on them.
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
SMALL = math.radians(0.05)  # a turn that is not named
ODD = 0.5  # of what lies far off: from which on a cam may stand off the others
NEAR = 1.2  # ratio of sizes within which rows may be of these cams


class OutlierWords(NamedTuple):
    """Words for rows that lie far off: the share of their size from which on they do, the problem, and remedies.

    `turned_over` is the remedy of a shaft that is counted from its other end, None where rows do not show that.
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
    """Rows over LOOKS equal angles, mm or rad: of what was measured of each cam (m, k), and of every cam (n, k).

    `owner` (m,) is which cam each is of, `names` those of the cams, `sizes` (n,) of their rows and `measured_sizes`
    (m,) of those measured, mm or rad, `other_end` (n,) which cam stands at the place of each where the shaft is counted
    from its other end.
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
    """Values (n,) at angles (n,), rad, in any order, over equal steps of the angle (k,)."""
    order = np.argsort(np.mod(angle, TURN), kind="stable")
    interpolated: Array = np.interp(equal_steps(LOOKS), np.mod(angle, TURN)[order], value[order], period=TURN)
    return interpolated


def radii(places: Array) -> Array:
    """Radii (k,) of places (n, 2) in any order over equal steps of the polar angle, mm."""
    return row(np.arctan2(places[:, 1], places[:, 0]), np.hypot(*places.T))


def lone_turns(rows: LobeRows, *, aligned: bool) -> dict[int, float]:
    """Turns, rad, of cams that are turned on their own against the shaft, by their index.

    Of those that a turn explains.

    `aligned` says that the shaft as a whole is turned back already. Raises UnlikePointsError for rows that look like
    those of a shaft that is turned, mirrored, in another unit, or has cams for one another.
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
    """Mask (m,) of the cams that stand in the same turn of the shaft, if these are more than half of them.

    Else of all.
    """
    return _together(rows, rows.measured, rows.nominal[rows.owner])[1]


def _together(rows: LobeRows, measured: Array, nominal: Array) -> tuple[float, Mask]:
    """Turn of the shaft, rad, in which most cams stand, and which those are (m,): all where none has most of them."""
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
    """Raise UnlikePointsError for rows that lie far off as those of another shaft do."""
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
    """A likeness of points: how far off they are under it, on average, and its words."""

    left: float
    words: str


def _shaft_looks(rows: LobeRows, nominal: Array, *, aligned: bool) -> Iterator[_Look]:
    """The shaft as one turned, mirrored, or measured from its other end, by the cams that stand together."""
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
    """Cams that stand for one another."""
    each = np.stack(
        [rows.off(rows.measured, np.broadcast_to(nominal, rows.measured.shape)) for nominal in rows.nominal], axis=1
    )
    far = off > rows.words.far
    like = np.where(far, np.argmin(each, axis=1), rows.owner)
    pairs = zip(rows.owner[far].tolist(), like[far].tolist(), strict=True)
    words = ", ".join(f"those of {rows.names[own]} look like {rows.names[other]}" for own, other in pairs)
    yield _Look(_mean(each[np.arange(len(like)), like]), f"{words}: look at the column that tells them")


def _mean(off: Array) -> float:
    return float(np.sqrt(np.mean(off**2)))


def _turn(measured: Array, nominal: Array) -> float:
    """Turn of all cams as one, rad, from -pi to pi, by the correlation of their rows (m, k)."""
    count = measured.shape[1]
    spectrum = (np.fft.rfft(measured) * np.conj(np.fft.rfft(nominal))).sum(axis=0)
    spectrum[0] = 0.0
    likeness = np.fft.irfft(spectrum, count)
    best = int(np.argmax(likeness))
    low, here, high = likeness[best - 1], likeness[best], likeness[(best + 1) % count]
    bend = low - 2.0 * here + high
    between = 0.5 * float((low - high) / bend) if bend < 0.0 else 0.0
    return math.remainder((best + between) * (TURN / count), TURN)
