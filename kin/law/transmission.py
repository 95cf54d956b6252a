"""Transmission laws by every route: from D, a programme, a first arc of the pitch curve, or a leaf of the rosette.

Each builder gives a `Transmission` (`kin.law.transmission_law`) that a cam can have, or raises IntentError. lam/mu is
the ratio pi/alpha, which must be above 1, in lowest terms and of odd mu; `arm` is l, mm; delta = pi/lam. W is W.
Wunderlich, Single-disk cam mechanisms with oscillating double roller follower, 1984.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.law.bounds import highest, undecided
from kin.law.feasibility import JOIN, checked, demand_leaf, demand_ratio, too_steep, too_wide
from kin.law.formula.expression import FormulaError
from kin.law.normalised import IntentError
from kin.law.piecewise import Piecewise
from kin.law.routes import FromArc, FromDelta, FromLeaf, steepness
from kin.law.segment import Constant, Harmonics, Stretch, moved
from kin.law.transmission_law import Transmission

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kin.law.formula.formula import Formula
    from kin.law.sources.motion import Motion

__all__ = [
    "IntentError",
    "Transmission",
    "from_arc",
    "from_delta",
    "from_law",
    "from_rosette",
]


_ABOVE = 1 + 1e-9  # times a least radius: its figure in nine digits is not below it


def over_period(
    delta: float, knots: Sequence[float], functions: Sequence[Stretch], lean: tuple[float, float]
) -> tuple[Piecewise, tuple[float, ...]]:
    """Psi over its period 2 delta, from stretches over delta, and w for each stretch.

    Stretch i lies between knots i and i + 1, rad; psi(t + delta) = -psi(t) gives the second half. `lean` holds w of the
    given stretches and of their images. Constants at both ends of the given half, psi = 0, become one stretch over each
    joint.
    """
    begin = knots[0]
    images = [moved(f, scale=-1.0, start=delta) for f in functions]
    all_knots = [*knots[:-1], *(k + delta for k in knots)]
    all_knots[-1] = begin + 2 * delta
    stretches: list[Stretch] = [*functions, *images]
    leans = [lean[0]] * len(functions) + [lean[1]] * len(images)
    count = len(functions)
    if isinstance(functions[0], Constant) and isinstance(functions[-1], Constant):
        if count == 1:
            standing = Piecewise(np.array([begin, begin + 2 * delta]), (Constant(0.0),), 2 * delta, smooth_seam=True)
            return standing, lean[:1]
        del stretches[count], leans[count], all_knots[count]
        del stretches[-1], leans[-1], all_knots[-1]
        all_knots[0] = all_knots[-1] - 2 * delta
    return Piecewise(np.array(all_knots), tuple(stretches), 2 * delta), tuple(leans)


def from_delta(lam: int, mu: int, arm: float, cos: Mapping[int, float], sin: Mapping[int, float]) -> Transmission:
    """Make the law of D = sum of cos[j] cos(j lam t) + sin[j] sin(j lam t), mm^2, j odd (W 5.10, 6.5).

    Raises IntentError for an excluded ratio or arm, a j that is even or below 1, |D| not below l^2 or so large that an
    arm meets the shaft, and psi'(phi) not below 1. The last is proved as 4 D^2 + D'^2 < 4 l^4, with psi' = -D'/sqrt(l^4
    - D^2) and |psi'| < 2 by t: a Fourier series, sharp also where |D| comes close to l^2.
    """
    demand_ratio(lam, mu, arm)
    for name, series in (("cos", cos), ("sin", sin)):
        for j in series:
            if j < 1 or j % 2 == 0:
                raise IntentError(f"D(t + delta) = -D(t) allows odd harmonics only, not {j}", f"delta.{name}")
    harmonics = [(j * lam, float(cos.get(j, 0.0)), float(sin.get(j, 0.0))) for j in sorted({*cos, *sin})]
    terms = tuple(term for term in harmonics if term[1] or term[2])
    period, offset, square = 2 * math.pi / lam, math.pi * mu / lam / 2, arm * arm
    knots = np.array([0.0, period])
    if not terms:
        return Transmission(lam, mu, arm, Piecewise(knots, (Constant(0.0),), period, smooth_seam=True), (0.5,), offset)
    wave = Harmonics(0.0, terms)
    law = Transmission(
        lam, mu, arm, Piecewise(knots, (FromDelta(wave, square),), period, smooth_seam=True), (0.5,), offset
    )
    most = square * math.sin(min(law.alpha, math.pi - law.alpha))
    if undecided(wave, 0.0, period, {0: (-math.inf, most)}) is not None:
        at, reached = highest(Piecewise(knots, (wave,), period), [1.0], 0)
        if reached < square and most < square:
            raise too_wide(law, at, math.asin(reached / square), "delta")
        # phi = t + (psi + alpha)/2 where D would be l^2, so psi = -pi/2
        degrees = math.degrees(at + offset - math.pi / 4) % 360
        close = f", {square - reached:.3g} below it, which rounding does not tell apart" if reached < square else ""
        message = f"|D| must stay below l^2 = {square:.9g} mm^2; it reaches {reached:.9g}{close}"
        raise IntentError(message, "delta", degrees)
    limit = 4 * square * square * (1 - 1e-14)  # the series' own rounding left out
    if undecided(steepness(terms), 0.0, period, {0: (-math.inf, limit)}) is not None:
        raise too_steep(law, "delta")
    return law


def from_law(
    lam: int,
    mu: int,
    arm: float,
    programme: Motion,
    swing_of: Literal["arm", "pair"] = "arm",
    *,
    share: float = 1.0,
    corners: bool = False,
    field: str = "law",
) -> Transmission:
    """Make the law that a programme, rad, prescribes over the first delta of shaft angle, from psi = 0 (W 4.9, 4.10).

    With `swing_of` "pair" the programme gives the swing of a flat pair, psi/2; it is multiplied by `share`. Raises
    IntentError if the ratio or the arm is excluded, psi does not end at 0, its slopes do not join (psi' at delta must
    be -psi'(0)/(1 - psi'(0))), an arm would meet the shaft, or psi'(phi) is not below 1; ValueError unless the
    programme covers delta. With `corners` slopes need not join: no cam follows such a law, but it can be approximated.
    """
    demand_ratio(lam, mu, arm)
    delta = math.pi / lam
    if abs(programme.total - delta) > 4 * math.ulp(delta):
        raise ValueError(f"the programme covers {programme.total!r} rad, not delta = {delta!r}")
    scale = share * (2.0 if swing_of == "pair" else 1.0)
    end = scale * float(programme.at_end(0)[0])
    if abs(end) > JOIN:
        raise IntentError(f"psi must come back to 0 at the end of the law; it is {math.degrees(end):.9g} deg", field)
    functions = [_scaled(f, scale) for f in programme.motion.functions]
    psi, lean = over_period(delta, programme.motion.knots.tolist(), functions, (0.0, 1.0))
    knots = programme.motion.knots.tolist()
    return checked(Transmission(lam, mu, arm, psi, lean, 0.0), knots, functions, field, corners=corners)


def _scaled(function: Stretch, scale: float) -> Stretch:
    if isinstance(function, Constant) and abs(function.value * scale) <= JOIN:
        return Constant(0.0)
    return moved(function, scale=scale) if scale != 1 else function


def from_arc(
    lam: int, mu: int, arm: float, radius: float, side: Literal["convex", "concave"] = "convex"
) -> Transmission:
    """Make the law of a pitch curve that begins with a circular arc over t in [0, delta] (W sections 3, 7a; Figure 5).

    The arc, of `radius`, mm, joins two mean positions, psi = 0 and r = R = 2 l cos(alpha/2), bulging outwards (convex)
    or inwards. Being symmetric about its bisector it meets its image with a common tangent. Raises IntentError for an
    excluded ratio or arm, a radius too small for the chord or, if concave, for psi'(phi) < 1, any concave radius with
    mu = 1, and a law that swings too far or turns the cam back.
    """
    demand_ratio(lam, mu, arm)
    alpha, delta = math.pi * mu / lam, math.pi / lam
    mean = 2 * arm * math.cos(alpha / 2)
    chord, height = mean * math.sin(delta / 2), mean * math.cos(delta / 2)
    least = chord if side == "convex" else _least_concave(lam, mu, mean)
    # the middle of a convex arc must lie within 2 l of the shaft: at 2 l the radius is l for mu = 1
    highest_sagitta = 2 * arm - height
    if side == "convex" and highest_sagitta * _ABOVE < chord:
        short = (chord**2 + highest_sagitta**2) / (2 * highest_sagitta)
        if radius <= short * _ABOVE:
            message = f"a convex arc needs a radius above {short:.9g} mm, not {radius:.9g} mm"
            raise IntentError(f"{message}: its middle would lie 2 l or farther from the shaft", "arc.radius")
    if not (math.isfinite(radius) and (radius >= least if side == "convex" else radius > least)):
        raise IntentError(
            f"a {side} arc needs a radius of at least {least:.9g} mm to join the mean positions, not {radius:.9g} mm"
            if side == "convex"
            else f"a concave arc needs a radius above {least * _ABOVE:.9g} mm, not {radius:.9g} mm: below, psi'(phi) "
            "reaches 1 where the arc begins, and the cam cannot be turned through",
            "arc.radius",
        )
    depth = math.sqrt((radius - chord) * (radius + chord))  # from the centre to the chord
    if side == "convex":
        centre, power = height - depth, chord**2 - height**2 + 2 * height * depth
    else:
        centre, power = height + depth, height**2 - chord**2 + 2 * height * depth
    top = centre + radius if side == "convex" else centre - radius
    if not 0 < top < 2 * arm:
        where = f"the middle of the arc is {top:.9g} mm from the shaft"
        raise IntentError(f"{where}; it must lie between 0 and 2 l = {2 * arm:.9g} mm", "arc.radius")
    arc = FromArc(arm, alpha, delta, centre, radius, power, side == "convex")
    psi, lean = over_period(delta, [0.0, delta], [arc], (0.5, 0.5))
    place = (centre * math.cos(delta / 2), centre * math.sin(delta / 2), radius if side == "convex" else -radius)
    return checked(Transmission(lam, mu, arm, psi, lean, alpha / 2, place), [0.0, delta], [arc], "arc")


def _least_concave(lam: int, mu: int, mean: float) -> float:
    """Radius, mm, at which psi'(phi) is 1 where a concave arc begins; it must be larger. IntentError for mu = 1.

    With the centre at c on the bisector and R, `mean`, the mean distance, the slope by t is 2 a/(a + b) there, where a
    = c R sin(delta/2) and b = (c cos(delta/2) - R) R tan(alpha/2); it is 2, psi'(phi) 1, for c = R sin(alpha/2)/
    sin((alpha - delta)/2). With mu = 1, alpha = delta, that is a straight line, and only convex arcs are less steep.
    """
    alpha, delta = math.pi * mu / lam, math.pi / lam
    if mu == 1:
        raise IntentError(
            f"psi'(phi) must stay below 1, else the cam cannot be turned through; with a whole ratio such as {lam} a "
            "straight first line reaches 1 where it begins, and a concave arc of any radius more; a convex arc would "
            "satisfy it, or a ratio such as 5/3",
            "arc.side",
            math.degrees(alpha / 2),
        )
    centre = mean * math.sin(alpha / 2) / math.sin((alpha - delta) / 2)
    return math.hypot(centre - mean * math.cos(delta / 2), mean * math.sin(delta / 2))


def from_rosette(lam: int, mu: int, arm: float, leaf: Formula, scale: float = 1.0) -> Transmission:
    """Make the law from one leaf of the third arm's path: |OQ| as `scale` times a formula in x, mm, 0 <= x <= 1.

    The third arm PQ, of length l, lies on the bisector and points to the shaft while psi = 0, so Q = 2 l sin(psi/2)
    n(phi - psi/2). As phi - psi/2 = t + alpha/2, x is (t + alpha/2)/delta: the first leaf begins at phi = 0 and has psi
    above 0 (W section 5). Raises IntentError if the ratio or the arm is excluded, if the leaf does not begin and end in
    the shaft with slopes that join (leaf'(1) = -leaf'(0)), has no value somewhere, falls below 0 or makes no possible
    law.
    """
    demand_ratio(lam, mu, arm)
    alpha, delta, field = math.pi * mu / lam, math.pi / lam, "rosette.leaf"
    start = -alpha / 2
    try:
        places, pieces = leaf.pieces(0.0, 1.0)
        most = 2 * arm * math.sin(min(alpha, math.pi - alpha) / 2)
        for begin, end, piece in zip(places[:-1], places[1:], pieces, strict=True):
            x = np.linspace(begin, end, 257)
            demand_leaf(x, piece.jet(x, 1).c[0] * scale, arm, most)
    except FormulaError as error:
        raise IntentError(error.message, field) from error
    knots = [start + float(x) * delta for x in places]
    functions = [
        _leaf_stretch(FromLeaf(piece, scale / (2 * arm), start, delta), x)
        for piece, x in zip(pieces, places[:-1].tolist(), strict=True)
    ]
    psi, lean = over_period(delta, knots, functions, (0.5, 0.5))
    return checked(Transmission(lam, mu, arm, psi, lean, alpha / 2), knots, functions, field)


def _leaf_stretch(stretch: FromLeaf, x: float) -> Stretch:
    """Return the stretch, or a constant if the leaf is constant from `x` on; psi within rounding of 0 becomes 0."""
    distance = stretch.leaf.constant_value(x)
    if distance is None:
        return stretch
    psi = 2 * math.asin(distance * stretch.scale)
    return Constant(0.0 if abs(psi) <= JOIN else psi)
