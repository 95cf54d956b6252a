"""The catalogue of motion laws, and laws made to measure: SCCA, blends, points, rows, an unequal split.

SCCA (sine, constant, cosine acceleration): R. L. Norton, Cam Design and Manufacturing Handbook, chapter 4. Harmonics:
F. Freudenstein, On the dynamics of high-speed cam profiles, 1960; A. S. Gutman, 1961. Cubics, harmonics, trapezoids:
H. A. Rothbart, Cam Design Handbook, chapters 2 and 3.
"""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.law.normalised import IntentError, Law, Polynomial, mirrored, symmetric
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Stretch
from kin.law.sources.functions import Cosines, FromRest, Sines
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kin.law.sources.ring import Samples

Shape = Literal["sin", "cos", "flat"]

_PI = math.pi
_SAME = 4 * 2.0**-52  # shares that differ by less are equal
_LEAST_POINTS = 3
_END = 1e-9  # greatest error of u at the first and last rows of a law
_LEAST_SHARE = 1e-6  # of a segment: a shorter part is as good as a jump


def scca(sine: float, constant: float, velocity: float = 0.0, field: str = "law") -> Law:
    """Make the law of sine, constant and cosine acceleration, with constant velocity in the middle (SCCA).

    `sine`, b, and `constant`, c, are shares of the accelerating half; the cosine's is d = 1 - b - c. `velocity` is the
    share of the whole segment at constant velocity. A member of the catalogue is given as that law. Raises
    IntentError, at a field below `field`, for shares out of bounds.
    """
    b, c, x = float(sine), float(constant), float(velocity)
    d = 1.0 - b - c
    d = 0.0 if abs(d) <= _SAME else d
    for name, share in (("sine", b), ("constant", c), ("velocity", x)):
        if not (share == 0.0 or _LEAST_SHARE <= share <= 1.0):
            raise IntentError(f"`{name}` is a share: 0, or {_LEAST_SHARE:g} to 1, not {share:.9g}", f"{field}.{name}")
    if d and d < _LEAST_SHARE:
        raise IntentError(f"`sine` and `constant` together are at most 1, not {b + c:.9g}", field)
    if 1.0 - x < _LEAST_SHARE:
        raise IntentError("with `velocity: 1` nothing accelerates; the law is `constant-velocity`", f"{field}.velocity")
    for name, member in _MEMBERS.items():
        if max(abs(m - s) for m, s in zip(member, (b, c, x), strict=True)) <= _SAME:
            return named(name)
    return Law(f"scca (sine {b:.6g}, constant {c:.6g}, velocity {x:.6g})", scca_motion(b, c, x))


def scca_motion(b: float, c: float, x: float) -> Piecewise:
    """Displacement of the SCCA law, 0 to 1 over 0 to 1.

    b and c are the shares of sine and of constant acceleration in the accelerating half, of which the cosine has the
    rest; x is the share of the whole segment at constant velocity.
    """
    d = max(1.0 - b - c, 0.0) if b + c < 1.0 - _SAME else 0.0
    # Norton's Ca and Cv without constant velocity; with it V = Cv/(1 + x (Cv - 1)) and A = V Ca/(Cv (1 - x)).
    plain = 4 * _PI**2 / ((_PI**2 - 8) * (b * b - d * d) - 2 * _PI * (_PI - 2) * b + _PI**2)
    top = plain * ((b + d) / _PI + c / 2)
    peak = plain / ((1 + x * (top - 1)) * (1 - x))
    half = (1 - x) / 2
    if b == d and not c and not x:  # the cosine goes on as the sine does: a single run
        return symmetric([0.0, 1.0], [(peak, 2 * _PI, "sin")], centre=True)
    runs: list[tuple[float, float, Shape]] = []
    knots = [0.0]
    for share, shape in ((b, "sin"), (c, "flat"), (d, "cos")):
        if share:
            rate = 0.0 if shape == "flat" else _PI / (2 * share * half)
            runs.append((peak, rate, shape))  # type: ignore[arg-type]
            knots.append(knots[-1] + share * half)
    if x:
        runs.append((0.0, 0.0, "flat"))
        knots[-1] = half
        return symmetric([*knots, 1 - half], runs, centre=True)
    knots[-1] = 0.5
    if d:  # the cosine runs on over the middle
        knots[-1] = 1 - knots[-2]
        return symmetric(knots, runs, centre=True)
    return symmetric(knots, runs, centre=False)


_MEMBERS: dict[str, tuple[float, float, float]] = {
    "parabolic": (0.0, 1.0, 0.0),
    "harmonic": (0.0, 0.0, 0.0),
    "cycloidal": (0.5, 0.0, 0.0),
    "modified-trapezoid": (0.25, 0.5, 0.0),
    "modified-sine": (0.25, 0.0, 0.0),
    "modified-constant-velocity": (0.25, 0.0, 0.5),
    "scca-20": (0.25, 0.0, 0.2),
    "scca-33": (0.25, 0.0, 1 / 3),
    "scca-66": (0.25, 0.0, 2 / 3),
    "cycloidal-cv50": (0.5, 0.0, 0.5),
}


def _trapezoid() -> Law:
    """Law of trapezoidal acceleration: straight ramps over an eighth of the segment, constant between them."""
    ramp = 0.125
    # velocity at the middle 2 = A (1/2 - ramp)
    peak = 2 / (0.5 - ramp)
    ramps = [(0.0, peak / ramp), (peak, 0.0), (peak, -peak / ramp)]
    knots = [0.0, ramp, 0.5 - ramp, 0.5]
    half: list[Stretch] = []
    s = v = 0.0
    for (begin, end), (a, j) in zip(pairwise(knots), ramps, strict=True):
        half.append(Polynomial((s, v, a / 2, j / 6), begin))
        x = end - begin
        s, v = s + x * (v + x * (a / 2 + x * j / 6)), v + x * (a + x * j / 2)
    return Law("trapezoid", _symmetric(knots, half))


def blended(first: float, last: float, field: str = "law") -> Law:
    """Make the law of constant velocity between blends from rest and to rest, shares `first` and `last` of the segment.

    A blend is 2 u**3 - u**4 over its own share, so that acceleration is 0 at its ends and has no step; where the share
    is 0 the law moves at that end. Raises IntentError for shares that are out of bounds or together above 1.
    """
    for share in (first, last):
        if not (share == 0.0 or _LEAST_SHARE <= share <= 1.0):
            raise IntentError(
                f"a blend takes a share of the segment: 0, or {_LEAST_SHARE:g} to 1, not {share:.9g}", field
            )
    if first + last > 1.0 + _SAME:
        raise IntentError("both blends are longer than their segment", field)
    velocity = 1.0 / (1.0 - 0.5 * (first + last))
    knots, functions = [0.0], list[Stretch]()
    if first:
        functions.append(AffineStretch(FromRest(), scale=0.5 * velocity * first, width=first))
        knots.append(first)
    if 1.0 - first - last > _LEAST_SHARE:
        functions.append(Polynomial((0.5 * velocity * first, velocity), first))
        knots.append(1.0 - last)
    if last:
        functions.append(AffineStretch(FromRest(), offset=1.0, scale=-0.5 * velocity * last, start=1.0, width=-last))
        knots.append(1.0)
    knots[-1] = 1.0
    return Law(f"uniform (blends {first:.6g} and {last:.6g})", Piecewise(np.array(knots), tuple(functions)))


def through_points(points: Sequence[tuple[float, float]], field: str = "law") -> Law:
    """Make the law of a spline through points (u, s) from (0, 0) to (1, 1), at rest at both ends.

    Raises IntentError for fewer than three points or more than 1000, and for points that are not finite, do not rise in
    u, or do not lead from (0, 0) to (1, 1).
    """
    from kin.law.sources.points import MOST_POINTS, from_points

    if len(points) > MOST_POINTS:
        raise IntentError(f"a law has at most {MOST_POINTS} points, not {len(points)}", field)
    for k, point in enumerate(points):
        if not all(map(math.isfinite, point)):
            raise IntentError("both numbers of a point are finite", f"{field}[{k}]")
    if len(points) < _LEAST_POINTS or points[0] != (0.0, 0.0) or points[-1] != (1.0, 1.0):
        raise IntentError("the points of a law lead from [0, 0] to [1, 1] by one or more between", field)
    u, s = zip(*points, strict=True)
    try:
        made = from_points(u, s, 1.0, around=None, field=field)
    except IntentError as error:
        raise IntentError("the points of a law rise in u, its first number", field) from error
    return Law(f"points ({len(points)})", made.motion, reverses=True)


def from_rows(samples: Samples, reading: float | None, field: str = "law") -> Law:
    """Make the law of least mean square jerk within `reading` of each row (u, s) from (0, 0) to (1, 1), at rest there.

    For None the reading of each row is its own rounding. Raises IntentError for rows that do not lead from (0, 0) to
    (1, 1) or give no motion, as TableError where a line is at fault.
    """
    from kin.law.sources.table import from_table

    u, s = samples.theta, samples.s
    within = reading or float(np.max(samples.rounding))
    ends = len(u) > 1 and max(abs(u[0]), abs(u[-1] - 1.0)) <= _END
    if not ends or max(abs(s[0]), abs(s[-1] - 1.0)) > within:
        raise IntentError("the rows of a law lead from 0;0 to 1;1", field)
    made = from_table(samples, reading, 1.0, around=None, field=field)
    rise = made.at_end(0)[0] - made.at_start(0)[0]
    functions = tuple(
        AffineStretch.of(f, offset=-made.at_start(0)[0] / rise, scale=1.0 / rise) for f in made.motion.functions
    )
    return Law(f"table ({len(u)} rows)", Piecewise(made.motion.knots, functions), reverses=True)


def split(law: Law, share: float, field: str = "law") -> Law:
    """Make of a symmetric law one that accelerates over `share` of the segment and decelerates over the rest.

    Each part is half the law, stretched alike in time and stroke: velocities keep their values and meet, accelerations
    are 1/(2 share) and 1/(2 - 2 share) of the law's. Raises IntentError for a share outside 0.01 to 0.99, and for a law
    that is not symmetric.
    """
    if not (math.isfinite(share) and 0.01 <= share <= 0.99):
        raise IntentError(f"`split` lies between 0.01 and 0.99, not {share:.9g}", f"{field}.split")
    u = np.linspace(0.0, 1.0, 33)
    s = law.motion.derivatives(u, 0)[0]
    if np.abs(s + s[::-1] - 1.0).max() > 1e-12:
        raise IntentError(
            f"{law.name} is not symmetric: its acceleration cannot be split; leave split out", f"{field}.split"
        )
    if share == 0.5:
        return law
    # the first half stretched about (0, 0), the second about (1, 1)
    before, after = 2 * share, 2 * (1 - share)
    knots, functions = [0.0], []
    pieces = list(zip(law.motion.functions, pairwise(law.motion.knots.tolist()), strict=True))
    for function, (begin, end) in pieces:
        if begin < 0.5:
            functions.append(AffineStretch.of(function, scale=before, width=before))
            knots.append(before * min(end, 0.5))
    knots[-1] = share
    for function, (_, end) in pieces:
        if end > 0.5:
            functions.append(AffineStretch.of(function, offset=1 - after, scale=after, start=1 - after, width=after))
            knots.append(1 - after * (1 - end))
    knots[-1] = 1.0
    return Law(f"{law.name} (split {share:.6g})", Piecewise(np.array(knots), tuple(functions)))


def sines(weights: Mapping[int, float], name: str) -> Law:
    """Make s = u - sum of w_k sin(2 pi k u)/(2 pi k), by weights w_k that sum to 1: at rest at both ends."""
    terms = tuple((2 * _PI * k, w / (2 * _PI * k)) for k, w in weights.items())
    return _single(name, Sines(terms))


def _symmetric(knots: Sequence[float], half: Sequence[Stretch]) -> Piecewise:
    """A symmetric law from its first half."""
    images = [mirrored(function) for function in reversed(half)]
    return Piecewise(np.array([*knots, *(1 - u for u in reversed(knots[:-1]))]), (*half, *images))


def _single(name: str, function: Stretch, *, reverses: bool = False) -> Law:
    return Law(name, Piecewise(np.array([0.0, 1.0]), (function,)), reverses)


@dataclass(frozen=True)
class _Entry:
    """A law of the catalogue: the function that makes it, and its displacement in a line of text."""

    make: Callable[[], Law]
    formula: str


def _member(name: str, formula: str) -> _Entry:
    """Entry of a member of the SCCA family."""
    return _Entry(lambda: Law(name, scca_motion(*_MEMBERS[name])), formula)


def _catalogue() -> dict[str, _Entry]:
    half = (0.0, 0.5)
    double = Cosines(((_PI, 0.5), (2 * _PI, -0.125)))
    square = Cosines(((4 * _PI, -1 / (4 * _PI**2)),), square=2.0)
    return {
        "constant-velocity": _Entry(lambda: _single("constant-velocity", Polynomial((0.0, 1.0))), "u"),
        "parabolic": _member("parabolic", "2 u^2, and its image"),
        "harmonic": _member("harmonic", "(1 - cos pi u)/2"),
        "cycloidal": _member("cycloidal", "u - sin 2 pi u/(2 pi)"),
        "modified-trapezoid": _member("modified-trapezoid", "scca: sine 0.25, constant 0.5"),
        "modified-sine": _member("modified-sine", "scca: sine 0.25, constant 0"),
        "modified-constant-velocity": _member(
            "modified-constant-velocity", "scca: sine 0.25, constant 0, velocity 0.5"
        ),
        # both about the middle: no cancellation at u = 1
        "polynomial-345": _Entry(
            lambda: _single("polynomial-345", Polynomial((0.5, 15 / 8, 0.0, -5.0, 0.0, 6.0), 0.5)),
            "10 u^3 - 15 u^4 + 6 u^5",
        ),
        "polynomial-4567": _Entry(
            lambda: _single("polynomial-4567", Polynomial((0.5, 35 / 16, 0.0, -35 / 4, 0.0, 21.0, 0.0, -20.0), 0.5)),
            "35 u^4 - 84 u^5 + 70 u^6 - 20 u^7",
        ),
        "scca-20": _member("scca-20", "scca: sine 0.25, constant 0, velocity 0.2"),
        "scca-33": _member("scca-33", "scca: sine 0.25, constant 0, velocity 0.333"),
        "scca-66": _member("scca-66", "scca: sine 0.25, constant 0, velocity 0.667"),
        "cycloidal-cv50": _member("cycloidal-cv50", "scca: sine 0.5, constant 0, velocity 0.5"),
        "double-harmonic": _Entry(
            lambda: _single("double-harmonic", double, reverses=True), "(1 - cos pi u)/2 - (1 - cos 2 pi u)/8"
        ),
        "trapezoid": _Entry(_trapezoid, "acceleration a trapezoid, ramps of 1/8"),
        "sine-squared": _Entry(
            lambda: Law("sine-squared", _symmetric(half, [square])), "acceleration 8 sin^2 2 pi u, and its image"
        ),
        "polynomial-23": _Entry(
            lambda: _single("polynomial-23", Polynomial((0.5, 1.5, 0.0, -2.0), 0.5)), "3 u^2 - 2 u^3"
        ),
        "cubic": _Entry(
            lambda: Law("cubic", _symmetric(half, [Polynomial((0.0, 0.0, 0.0, 4.0))])), "4 u^3, and its image"
        ),
        "freudenstein-13": _Entry(
            lambda: sines({1: 27 / 28, 3: 1 / 28}, "freudenstein-13"), "u - 27/(56 pi) (sin 2 pi u + sin 6 pi u/81)"
        ),
        "freudenstein-135": _Entry(
            lambda: sines({1: 1125 / 1192, 3: 1125 / 1192 / 18, 5: 1125 / 1192 / 250}, "freudenstein-135"),
            "u - 1125/(2384 pi) (sin 2 pi u + sin 6 pi u/54 + sin 10 pi u/1250)",
        ),
        "gutman-13": _Entry(
            lambda: sines({1: 15 / 16, 3: 1 / 16}, "gutman-13"), "u - 15/(32 pi) sin 2 pi u - sin 6 pi u/(96 pi)"
        ),
    }


_ENTRIES = _catalogue()

NAMES: tuple[str, ...] = tuple(_ENTRIES)


def formula(name: str) -> str:
    """The displacement of a law of the catalogue, in a line of text; KeyError for another name."""
    return _ENTRIES[name].formula


@cache
def named(name: str, field: str = "motion") -> Law:
    """Law of the catalogue by its name, made at first use.

    Raises IntentError, at `field`, for another name; it lists the names.
    """
    if name not in _ENTRIES:
        from difflib import get_close_matches  # for the message alone

        close = get_close_matches(name, NAMES, 1)
        hint = f"; did you mean {close[0]}?" if close else ""
        raise IntentError(f"no law is called {name!r}{hint} (laws: {', '.join(NAMES)})", field)
    return _ENTRIES[name].make()
