"""Whether a contour that is wrong is the exact one elsewhere: turned, moved, mirrored, scaled, or larger all round.

The exact contour is taken as points p with outward normals n. About the middles of both areas the distances at equal
directions are compared for every turn at once, by their correlation; from the turns that fit best Newton's method goes
on by least squares over the turn, the shift and, where these are not enough, an offset all round: the distance of a
placed point from the file's contour changes by n per shift, by the moment of n per turn. The result is words alone: the
contour stays wrong.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross
from kin.contour.nearest import signed_distance
from kin.numeric.angles import TURN
from kin.numeric.lengths import UNIT, length_words, place_words, turn_words

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array

POINTS = 720  # directions in which distances are compared
LOOKS = 8  # points on each piece of the file's contour
MOST_PIECES = 20_000  # of the file's contour: beyond, no placement is looked for
STARTS = 6  # turns from which the fit goes on
STEPS = 12  # of Newton's method
NEAR = 2.0  # tolerances within which a placed contour fits
FACTORS = (1.0, 25.4, 1.0 / 25.4, 10.0, 0.1, 1000.0, 1e-3)  # mixed-up units: inches, centimetres, metres
SAME_SIZE = 0.1  # share by which the size may differ from a factor: as much as an offset


def placement(contour: Contour, exact: Array, tolerance: float) -> str:
    """Marked words for how the exact contour is placed, turned, mirrored, scaled or offset to fit a file's contour.

    `exact` are some hundred points (n, 2) of the exact contour, mm, in order; `tolerance` is in mm. Empty where no
    turn, shift, mirror image, change of unit or offset makes it fit, where none is needed, and for a contour that is
    clockwise or of more than 20,000 pieces.
    """
    if len(contour) > MOST_PIECES or not contour.area > 0.0:
        return ""
    if float(cross(exact, np.roll(exact, -1, axis=0)).sum()) < 0.0:
        exact = exact[::-1]
    large = np.sqrt(contour.area / _area(exact))
    factor = min(FACTORS, key=lambda unit: abs(np.log(large / unit)))
    if not abs(large / factor - 1.0) <= SAME_SIZE:
        return ""
    same_size = contour.scaled(1.0 / factor)
    for mirrored in (False, True):
        placed = _fitted(same_size.mirrored() if mirrored else same_size, exact, tolerance)
        if placed is not None:
            return _words(placed, factor, exact, tolerance, mirrored=mirrored)
    return ""


def _words(placed: Array, factor: float, exact: Array, tolerance: float, *, mirrored: bool) -> str:
    turn, x, y, offset = placed.tolist()
    if mirrored:  # the fit is to the mirrored contour; the words mirror the exact one first
        turn, y = -turn, -y
    fine = tolerance / float(np.abs(exact).max())
    turn = _rounded(float(np.degrees(np.pi - np.mod(np.pi - turn, TURN))), float(np.degrees(fine)))
    turn = abs(turn) if turn == -180.0 else turn
    # the fit is to the file's contour in the exact one's size; its lengths are given as they are in the file
    x, y, offset = (_rounded(factor * length, factor * tolerance) for length in (x, y, offset))
    words = (
        [] if factor == 1.0 else [f"{max(factor, 1.0 / factor):.6g} times as {'large' if factor > 1.0 else 'small'}"]
    )
    words += ["mirrored in the x axis"] if mirrored else []
    words += [f"turned by {turn_words(turn)} degrees"] if turn else []
    words += [f"moved by {place_words(x, y, digits=9)} {UNIT}"] if x or y else []
    words += (
        [f"{length_words(abs(offset), '.9g')} {UNIT} {'larger' if offset > 0.0 else 'smaller'} all round"]
        if offset
        else []
    )
    return f"it is the exact one {', '.join(words)}" if words else ""


def _rounded(value: float, accuracy: float) -> float:
    """The value to as many decimals as an accuracy has; 0 for a value no larger than the accuracy."""
    return round(value, max(0, int(np.ceil(-np.log10(accuracy))))) if abs(value) > accuracy else 0.0


def _fitted(contour: Contour, exact: Array, tolerance: float) -> Array | None:
    """Turn, rad, shift and offset, mm, as (4,), that fit the exact contour, of the least turn; None where none does."""
    chain, _ = contour.as_arcs()
    normal = _normals(exact)
    fits = []
    for start in _starts(contour.sample(LOOKS), exact):
        for columns in (3, 4):  # without an offset, with one
            placed, off = start.copy(), np.inf
            for _ in range(STEPS):
                points, outward = _turned(exact, placed[0]), _turned(normal, placed[0])
                apart = signed_distance(chain, points + placed[1:3]) + placed[3]
                off = float(np.abs(apart).max())
                # least squares for the changes of turn, shift and offset that bring all distances to 0
                moment = cross(points, outward)
                slope = np.column_stack([moment, outward, np.ones(len(points))])[:, :columns]
                step = np.linalg.lstsq(slope, -apart, rcond=1e-9)[0]
                placed[:columns] += step
                if float(np.abs(step).max()) < 1e-9:
                    break
            if off <= NEAR * tolerance:
                fits.append(placed)
                break
    return min(fits, key=lambda fit: abs(np.angle(np.exp(1j * fit[0])))) if fits else None


def _starts(points: Array, exact: Array) -> list[Array]:
    """Placements (4,) to begin with: turns at which the distances about the middles of both areas agree best, and 0."""
    middles = [_middle(points), _middle(exact)]
    of_file, own = (_radii(outline - middle) for outline, middle in zip((points, exact), middles, strict=True))
    fit = np.fft.irfft(np.fft.rfft(of_file - of_file.mean()) * np.conj(np.fft.rfft(own - own.mean())), POINTS)
    peaks = np.flatnonzero((fit >= np.roll(fit, 1)) & (fit >= np.roll(fit, -1)))
    best = peaks[np.argsort(-fit[peaks], kind="stable")][:STARTS]
    turns = [*(best * TURN / POINTS).tolist(), 0.0]
    return [np.array([turn, *(middles[0] - _turned(middles[1][None], turn)[0]), 0.0]) for turn in turns]


def _radii(points: Array) -> Array:
    """Distances from the origin at equal directions (POINTS,), of points (n, 2) round it."""
    angle = np.mod(np.arctan2(points[:, 1], points[:, 0]), TURN)
    order = np.argsort(angle, kind="stable")
    at = np.arange(POINTS) * TURN / POINTS
    radii: Array = np.interp(at, angle[order], np.hypot(*points[order].T), period=TURN)
    return radii


def _area(points: Array) -> float:
    return 0.5 * float(cross(points, np.roll(points, -1, axis=0)).sum())


def _middle(points: Array) -> Array:
    """Middle of the area of a polygon (n, 2)."""
    after = np.roll(points, -1, axis=0)
    share = cross(points, after)
    middle: Array = ((points + after) * share[:, None]).sum(axis=0) / (3.0 * share.sum())
    return middle


def _normals(points: Array) -> Array:
    """Outward normals of a counter-clockwise polygon (n, 2) at its corners."""
    along = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    length = np.maximum(np.hypot(*along.T), np.finfo(float).tiny)
    outward: Array = np.column_stack([along[:, 1], -along[:, 0]]) / length[:, None]
    return outward


def _turned(points: Array, turn: float) -> Array:
    c, s = np.cos(turn), np.sin(turn)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned
