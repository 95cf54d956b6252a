"""What the points of a shaft's cams look like, where they lie far from the contours: told by radii over polar angles.

All cams are looked at together, so that a shaft turned as one, mirrored, or with cams that stand for one another is
told from a cam that alone is turned. Radii over equal steps of the polar angle are correlated; a contour that turns
back about the shaft has several radii at one angle, of which any is taken: these are looks, and nothing rests on them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.made.points import BETTER, FACTORS, FAR, UnlikePointsError
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kin.numeric.arrays import Array, Indices

LOOKS = 1440  # polar angles
SMALL = math.radians(0.05)  # a turn that is not named
MIRRORED = "measure it with the upper end up, as the file is drawn, or turn y round"
TURNED_OVER = "count z from the recipe's end, and turn y round"
ODD = 0.5  # of what lies far off: from which on a cam may stand off the others
NEAR = 1.2  # ratio of mean radii within which points may be of these cams


class Radii(NamedTuple):
    """Radii over equal steps of the polar angle, mm: of the points of each cam (m, k), and of every contour (n, k).

    `owner` (m,) is which contour each is of, `names` those of the contours, `other_end` (n,) which contour
    stands at the place of each where the shaft is counted from its other end.
    """

    measured: Array
    contours: Array
    owner: Indices
    names: Sequence[str]
    other_end: Indices

    @property
    def size(self) -> float:
        """Mean radius of the contours, mm."""
        return float(self.contours.mean())


def radii(places: Array) -> Array:
    """Radii (k,) of places (n, 2) in any order over equal steps of the polar angle, mm."""
    angle = np.mod(np.arctan2(places[:, 1], places[:, 0]), TURN)
    order = np.argsort(angle, kind="stable")
    interpolated: Array = np.interp(equal_steps(LOOKS), angle[order], np.hypot(*places[order].T), period=TURN)
    return interpolated


def lone_turns(shaft: Radii, *, aligned: bool) -> dict[int, float]:
    """Turn, rad, of each cam that alone is turned, by its place among those measured; empty where none is far off.

    `aligned` says that the shaft as one is turned back already. Raises UnlikePointsError for points that look like
    those of a shaft that is turned, mirrored, in another unit, or has cams for one another.
    """
    nominal = shaft.contours[shaft.owner]
    off = _off(shaft.measured, nominal)
    alone = {
        rank: _turn(shaft.measured[rank : rank + 1], nominal[rank : rank + 1])
        for rank in np.flatnonzero(off > ODD * FAR * nominal.mean(axis=1)).tolist()
    }
    if off.max() > FAR * shaft.size:
        _demand_shaft(shaft, nominal, off, aligned=aligned)
    return alone if _mean(_off(shaft.measured, nominal, alone)) <= BETTER * _mean(off) else {}


def _demand_shaft(shaft: Radii, nominal: Array, off: Array, *, aligned: bool) -> None:
    """Raise UnlikePointsError for points that lie far off as those of another shaft do."""
    problem = f"the points lie {_mean(off):.3g} mm off the contours on average"
    ratio = float(nominal.mean() / shaft.measured.mean())
    factor = next((value for value in FACTORS if 1.0 / NEAR < value / ratio < NEAR), None)
    if factor is not None:
        large, word = max(factor, 1.0 / factor), "small" if factor > 1.0 else "large"
        raise UnlikePointsError(f"{problem}: they look {large:.6g} times too {word}: `--units {FACTORS[factor]}`")
    looks = [*_shaft_looks(shaft, nominal, aligned=aligned), *_swap_looks(shaft, off)]
    explained = [look for look in looks if look.left <= BETTER * _mean(off)]
    if explained:
        raise UnlikePointsError(f"{problem}: {min(explained).words}")


class _Look(NamedTuple):
    """A likeness of points: how far off they are under it, mm on average, and its words."""

    left: float
    words: str


def _shaft_looks(shaft: Radii, nominal: Array, *, aligned: bool) -> Iterator[_Look]:
    """The shaft as one turned, mirrored, or measured from its other end."""
    turned_over = shaft.contours[shaft.other_end[shaft.owner]]
    for mirrored, contours, looks, remedy in (
        (False, nominal, "", ""),
        (True, nominal, "mirrored", MIRRORED),
        (True, turned_over, "measured from its other end", TURNED_OVER),
    ):
        measured = np.roll(shaft.measured[:, ::-1], 1, axis=1) if mirrored else shaft.measured
        turn = _turn(measured, contours)
        left = _mean(_off(measured, contours, dict.fromkeys(range(len(measured)), turn)))
        turned = abs(turn) > SMALL
        words = [*([looks] if looks else []), *([f"turned by {math.degrees(turn):.3g} degrees"] if turned else [])]
        remedies = [*([remedy] if remedy else []), *(["`--align rotation`"] if turned and not aligned else [])]
        yield _Look(left, f"the shaft looks {', '.join(words)}: {', then '.join(remedies)}")


def _swap_looks(shaft: Radii, off: Array) -> Iterator[_Look]:
    """Cams that stand for one another."""
    each = np.stack(
        [_off(shaft.measured, np.broadcast_to(contour, shaft.measured.shape)) for contour in shaft.contours], axis=1
    )
    far = off > FAR * shaft.size
    like = np.where(far, np.argmin(each, axis=1), shaft.owner)
    pairs = zip(shaft.owner[far].tolist(), like[far].tolist(), strict=True)
    words = ", ".join(f"those of {shaft.names[own]} look like {shaft.names[other]}" for own, other in pairs)
    yield _Look(_mean(each[np.arange(len(like)), like]), f"{words}: look at the column that tells them")


def _mean(off: Array) -> float:
    return float(np.sqrt(np.mean(off**2)))


def _off(measured: Array, nominal: Array, turns: dict[int, float] | None = None) -> Array:
    """Root mean square (m,) of the radii's difference, mm, those of some cams turned back."""
    back = measured.copy()
    for rank, turn in (turns or {}).items():
        every = equal_steps(LOOKS)
        back[rank] = np.interp(every + turn, every, measured[rank], period=TURN)
    off: Array = np.sqrt(np.mean((back - nominal) ** 2, axis=1))
    return off


def _turn(measured: Array, nominal: Array) -> float:
    """Turn of all cams as one, rad, from -pi to pi, by the correlation of their radii (m, k)."""
    count = measured.shape[1]
    spectrum = (np.fft.rfft(measured) * np.conj(np.fft.rfft(nominal))).sum(axis=0)
    spectrum[0] = 0.0
    likeness = np.fft.irfft(spectrum, count)
    best = int(np.argmax(likeness))
    low, here, high = likeness[best - 1], likeness[best], likeness[(best + 1) % count]
    bend = low - 2.0 * here + high
    between = 0.5 * float((low - high) / bend) if bend < 0.0 else 0.0
    return math.remainder((best + between) * (TURN / count), TURN)
