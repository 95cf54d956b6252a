"""Transmission laws of a single-disk cam with an oscillating double follower (W), by every route.

The follower's two arms of length l include 2 alpha, alpha = pi mu/lam, its pivot stands at distance l from the shaft.
phi is the shaft angle, psi the follower's (positive clockwise). The law has period 2 delta = 2 pi/lam and maps onto
itself by (phi, psi) -> (phi - psi + delta, -psi) (W 4.9). A law is held over a parameter tau in which psi just changes
its sign, psi(tau + delta) = -psi(tau), and

    phi = tau + w psi + c.

Polar routes: tau is the polar angle t of roller A, w = 1/2, c = alpha/2 (W 4.4). A given law: tau is phi itself on
[0, delta], w = c = 0, and w = 1 on the next delta, which is W 4.9.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from kin.bounding import highest, undecided
from kin.expression import FormulaError
from kin.jet import Ball, BallJet, DomainError, Jet, cos
from kin.law import IntentError, Programme
from kin.piecewise import Affine, Constant, Harmonics, Piecewise, Series, Stretch
from kin.routes import FromArc, FromDelta, FromLeaf, steepness

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kin.formula import Formula


__all__ = ["IntentError", "Transmission", "from_arc", "from_delta", "from_law", "from_rosette"]

Array = NDArray[np.float64]

_TURN = 2 * math.pi
_JOIN = 1e-11  # rad: a jump in psi that is a formula's rounding
_SLOPE_JOIN = 1e-9  # a jump in psi'(phi), likewise


@dataclass(frozen=True, eq=False)
class Transmission:
    """psi and phi over the parameter tau; see the module. `arm` is l, mm.

    `psi` has period 2 delta; `lean` holds w for each of its stretches, `offset` is c. `arc` is, for routes that give
    roller A a circular arc, (x, y, signed radius) for the first stretch of psi, the arc standing as at its first place.

    Over the whole turn, stretch i runs from breaks[i] to the next break, the last one over 2 pi; without breaks there
    is one stretch.
    """

    lam: int
    mu: int
    arm: float
    psi: Piecewise
    lean: tuple[float, ...]
    offset: float
    arc: tuple[float, float, float] | None = None

    @property
    def alpha(self) -> float:
        """Half the angle between the arms, rad."""
        return math.pi * self.mu / self.lam

    @property
    def delta(self) -> float:
        """Half the period of the law, rad."""
        return math.pi / self.lam

    @cached_property
    def breaks(self) -> Array:
        """Parameters tau in [0, 2 pi) at which the second or a higher derivative may jump, rising."""
        turns = np.arange(self.lam) * (_TURN / self.lam)
        return np.sort((self.psi.breaks[None, :] + turns[:, None]).ravel())

    @property
    def level(self) -> Array:
        """For each stretch the value of psi if it is exactly constant there, a dwell, else nan."""
        functions = [self.psi.functions[i] for i in self._stretches()]
        return np.array([f.value if isinstance(f, Constant) else math.nan for f in functions])

    @property
    def steady(self) -> NDArray[np.bool_]:
        """For each stretch whether psi is exactly constant: the pitch curve is an arc about the shaft."""
        return ~np.isnan(self.level)

    @property
    def radius(self) -> Array:
        """For each stretch the radius of the pitch curve about the shaft, mm, if psi is constant there, else nan."""
        return 2 * self.arm * np.cos((self.level + self.alpha) / 2)

    @property
    def pitch_arcs(self) -> Array:
        """For each stretch the arc that the pitch curve exactly is: centre x, y and radius, mm, else nan; (m, 3).

        The radius is negative where the arc is hollow. Dwells count, and the given arcs of that route.
        """
        stretches, at = self._stretches(), self.breaks if len(self.breaks) else np.zeros(1)
        arcs = np.column_stack((np.zeros((len(at), 2)), self.radius))
        arcs[~self.steady] = math.nan
        if self.arc is not None:
            x, y, radius = self.arc
            given = np.flatnonzero(stretches == 0)
            turn = np.round((at[given] - self.psi.knots[0]) / (2 * self.delta)) * (2 * self.delta)
            c, s = np.cos(turn), np.sin(turn)
            arcs[given] = np.column_stack((x * c - y * s, x * s + y * c, np.full(len(given), radius)))
        return arcs

    def _stretches(self) -> NDArray[np.intp]:
        at = self.breaks if len(self.breaks) else np.zeros(1)
        return self.psi.locate(at, 1)[0]

    @cached_property
    def _lead(self) -> Piecewise:
        """The angle phi - tau."""
        pairs = zip(self.psi.functions, self.lean, strict=True)
        functions = tuple(Affine(f, self.offset, w) if w else Constant(self.offset) for f, w in pairs)
        return Piecewise(self.psi.knots, functions, self.psi.period, self.psi.smooth_seam)

    def jets(self, tau: Series, side: int = 1) -> tuple[Series, Series]:
        """Give phi and psi of a jet or ball jet tau; `side` decides at breaks."""
        psi = self.psi.on(tau, side)
        if len(set(self.lean)) == 1:
            return tau + psi * self.lean[0] + self.offset, psi
        return tau + self._lead.on(tau, side), psi

    def at(self, tau: float | Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Give phi and psi with their derivatives by tau at tau (n,), (order + 1, n) each."""
        phi, psi = self.jets(Jet.variable(tau, order), side)
        return phi.derivatives(), psi.derivatives()

    def enclosure(
        self, lower: float | Array, upper: float | Array, order: int
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Enclose phi, and psi, with their derivatives by tau over [lower, upper]: (mid, rad), (order + 1, n) each."""
        balls = [Ball.between(*jet.bounds()) for jet in self.jets(BallJet.variable(lower, upper, order))]
        return (balls[0].mid, balls[0].rad), (balls[1].mid, balls[1].rad)

    def pitch(self, tau: float | Array, order: int, side: int = 1) -> tuple[Array, Array]:
        """Give r and t of roller A's centre with their derivatives by tau, (order + 1, n) each (W 4.10)."""
        phi, psi = self.jets(Jet.variable(tau, order), side)
        half = psi * 0.5 + self.alpha / 2
        return (cos(half) * (2 * self.arm)).derivatives(), (phi - half).derivatives()

    def psi_of_shaft(self, phi: float | Array, order: int, side: int = 1) -> Array:
        """Give psi and its derivatives by phi at shaft angles phi (n,), (order + 1, n); at a break by side."""
        tau = self.parameter(phi, side)
        shaft, psi = self.jets(Jet.variable(tau, order), side)
        out = np.empty((order + 1, len(tau)))
        out[0] = psi.c[0]
        for k in range(1, order + 1):
            psi = psi.derivative() / Jet(shaft.derivative().c[: order + 1 - k])
            out[k] = psi.c[0]
        return out

    def parameter(self, phi: float | Array, side: int = 1) -> Array:
        """Solve phi(tau) = phi for tau, (n,): Newton's steps inside the stretch, halving where they leave it."""
        phi = np.atleast_1d(np.asarray(phi, dtype=float))
        knots, period = self.psi.knots, 2 * self.delta
        ends = np.append(self.at(knots[:-1], 0)[0][0], 0.0)
        ends[-1] = ends[0] + period
        shaft = Piecewise(ends, (Constant(0.0),) * (len(ends) - 1), period)
        index, x = shaft.locate(phi, side)
        low, high = knots[index], knots[index + 1]
        tau = low + (x - ends[index]) * (high - low) / (ends[index + 1] - ends[index])
        for _ in range(80):
            (value, slope), _psi = self.at(tau, 1, 1)
            miss = value - x
            low, high = np.where(miss < 0, tau, low), np.where(miss > 0, tau, high)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = tau - miss / slope
            better = np.where((step > low) & (step < high), step, 0.5 * (low + high))
            better = np.where(miss == 0, tau, better)
            settled = np.abs(better - tau) <= 2 * np.spacing(np.maximum(np.abs(tau), period))
            tau = better
            if settled.all():
                break
        tau = np.where(x == ends[index], knots[index], np.where(x == ends[index + 1], knots[index + 1], tau))
        turns = np.round((phi - x) / period)
        return tau + turns * period


def _too_wide(law: Transmission, at: float, swing: float, field: str) -> IntentError:
    limit = min(law.alpha, math.pi - law.alpha)
    end = "2l" if law.alpha < math.pi / 2 else "0"
    return IntentError(
        f"the follower would swing {math.degrees(swing):.6g} degrees to each side; below {math.degrees(limit):.6g} is "
        f"possible with lam/mu = {law.lam}/{law.mu}, there roller A's distance from the shaft reaches {end}",
        field,
        _shaft_deg(law, at),
    )


def _shaft_deg(law: Transmission, tau: float) -> float:
    return math.degrees(float(law.at(tau, 0)[0][0, 0])) % 360


def _demand_possible(law: Transmission, knots: Sequence[float], functions: Sequence[Stretch], field: str) -> None:
    """Prove 0 < r < 2l and psi'(phi) < 1 over the whole period, or refuse with the angle and the figure.

    With W 4.9 all of it shows in the stretches over delta. |psi| must stay below alpha and pi - alpha. psi'(phi) < 1 is
    psi' < 1 by phi on the given stretch (w = 0; the image has -psi'/(1 - psi') there), and |psi'| < 2 by t on a polar
    one (w = 1/2). It also makes phi rise with tau all round.
    """
    limit = min(law.alpha, math.pi - law.alpha)
    steep = (-2.0, 2.0) if law.lean[0] == 0.5 else (-math.inf, 1.0)
    for function, begin, end in zip(functions, knots[:-1], knots[1:], strict=True):
        if isinstance(function, Constant) and abs(function.value) < limit:
            continue
        found = undecided(function, begin, end, {0: (-limit, limit), 1: steep})
        if found is None:
            continue
        if found[0] == 1:
            raise _too_steep(law, field)
        at, swing = highest(law.psi, [1.0] * len(law.lean), 0)
        raise _too_wide(law, at, swing, field)


def _too_steep(law: Transmission, field: str) -> IntentError:
    weights = [1 - w for w in law.lean]
    at, slope = highest(law.psi, weights, 1)
    weight = weights[int(law.psi.locate(np.array([at]))[0][0])]
    slope /= weight
    figure = slope / (1 + (1 - weight) * slope)
    degrees = _shaft_deg(law, at)
    return IntentError(
        f"psi'(phi) must stay below 1, else the cam cannot be turned through; it reaches {figure:.9g} at a shaft angle "
        f"of {degrees:.6g} degrees",
        field,
        degrees,
    )


def _demand_joined(law: Transmission, field: str) -> None:
    """Refuse a jump of psi, or of its slope psi'(phi), between stretches."""
    knots = law.psi.knots[:-1]
    (phi, psi), (phi_left, psi_left) = (law.at(knots, 1, side) for side in (1, -1))
    slope, slope_left = psi[1] / phi[1] + 0.0, psi_left[1] / phi_left[1] + 0.0  # no -0 in a message
    for i in range(len(knots)):
        at = math.degrees(phi[0, i]) % 360
        if abs(psi[0, i] - psi_left[0, i]) > _JOIN:
            before, after = math.degrees(psi_left[0, i]), math.degrees(psi[0, i])
            raise IntentError(f"psi jumps from {before:.9g} to {after:.9g} degrees at {at:.6g} degrees", field, at)
        if abs(slope[i] - slope_left[i]) > _SLOPE_JOIN * (1 + abs(slope[i])):
            raise IntentError(
                f"psi'(phi) jumps from {slope_left[i]:.9g} to {slope[i]:.9g} at a shaft angle of {at:.6g} degrees: the "
                "pitch curve would have a corner",
                field,
                at,
            )


# --- the routes -------------------------------------------------------------------------------------------------------


def _demand_ratio(lam: int, mu: int, arm: float) -> None:
    if not (math.isfinite(arm) and arm > 0):
        raise IntentError(f"the arm must be above 0, not {arm:.6g} mm", "arm")
    if mu < 1 or lam <= mu:
        raise IntentError(f"pi/alpha = lam/mu must be above 1, not {lam}/{mu} (W 2.2)", "ratio")
    common = math.gcd(lam, mu)
    if common > 1:
        raise IntentError(f"{lam}/{mu} is not in lowest terms; write {lam // common}/{mu // common}", "ratio")
    if mu % 2 == 0:
        raise IntentError(f"the denominator of {lam}/{mu} is even: the pitch curve would cross itself (W 3)", "ratio")


def _over_period(
    delta: float, knots: Sequence[float], functions: Sequence[Stretch], lean: tuple[float, float]
) -> tuple[Piecewise, tuple[float, ...]]:
    """Complete psi over 2 delta, with w for each stretch, from delta; rests at psi = 0 run on over the joints."""
    begin = knots[0]
    images = [
        Constant(-f.value) if isinstance(f, Constant) else Affine.of(f, scale=-1.0, start=delta) for f in functions
    ]
    all_knots = [*knots[:-1], *(k + delta for k in knots)]
    all_knots[-1] = begin + 2 * delta
    stretches: list[Stretch] = [*functions, *images]
    leans = [lean[0]] * len(functions) + [lean[1]] * len(images)
    count = len(functions)
    if isinstance(functions[0], Constant) and isinstance(functions[-1], Constant):
        if count == 1:
            rest = Piecewise(np.array([begin, begin + 2 * delta]), (Constant(0.0),), 2 * delta, smooth_seam=True)
            return rest, lean[:1]
        del stretches[count], leans[count], all_knots[count]
        del stretches[-1], leans[-1], all_knots[-1]
        all_knots[0] = all_knots[-1] - 2 * delta
    return Piecewise(np.array(all_knots), tuple(stretches), 2 * delta), tuple(leans)


def from_delta(lam: int, mu: int, arm: float, cos: Mapping[int, float], sin: Mapping[int, float]) -> Transmission:
    """Make the law of D = sum of cos[j] cos(j lam t) + sin[j] sin(j lam t), mm^2, j odd (W 5.10, 6.5).

    Raises IntentError for a ratio that W's conditions exclude, an even j, |D| not below l^2 or so large that an arm
    meets the shaft, and psi'(phi) not below 1. The last is proved as 4 D^2 + D'^2 < 4 l^4, with psi' = -D'/sqrt(l^4 -
    D^2) and |psi'| < 2 by t: a Fourier series, sharp also where |D| comes close to l^2.
    """
    _demand_ratio(lam, mu, arm)
    for name, series in (("cos", cos), ("sin", sin)):
        for j in series:
            if j < 1 or j % 2 == 0:
                raise IntentError(f"D(t + delta) = -D(t) allows odd harmonics only, not {j}", f"delta.{name}")
    found = [(j * lam, float(cos.get(j, 0.0)), float(sin.get(j, 0.0))) for j in sorted({*cos, *sin})]
    terms = tuple(term for term in found if term[1] or term[2])
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
        if reached < square:
            raise _too_wide(law, at, math.asin(reached / square), "delta")
        degrees = math.degrees(at + offset - math.pi / 4) % 360
        raise IntentError(f"|D| must stay below l^2 = {square:.9g} mm^2; it reaches {reached:.9g}", "delta", degrees)
    limit = 4 * square * square * (1 - 1e-14)  # the series' own rounding left out
    if undecided(steepness(terms), 0.0, period, {0: (-math.inf, limit)}) is not None:
        raise _too_steep(law, "delta")
    return law


def from_law(
    lam: int, mu: int, arm: float, programme: Programme, swing_of: Literal["arm", "pair"] = "arm"
) -> Transmission:
    """Make the law that a programme prescribes over the first delta of shaft angle, from psi = 0 (W 4.9, 4.10).

    With `swing_of` "pair" the programme gives the swing of a flat pair, psi/2. Raises IntentError if the ratio is
    excluded, psi does not end at 0, its slopes do not join (psi' at delta must be -psi'(0)/(1 - psi'(0))), an arm would
    meet the shaft, or psi'(phi) is not below 1; ValueError unless the programme covers delta.
    """
    _demand_ratio(lam, mu, arm)
    delta = math.pi / lam
    if abs(programme.total - delta) > 4 * math.ulp(delta):
        raise ValueError(f"the programme covers {programme.total!r} rad, not delta = {delta!r}")
    scale = 2.0 if swing_of == "pair" else 1.0
    end = scale * float(programme.at_end(0)[0])
    if abs(end) > _JOIN:
        raise IntentError(f"psi must come back to 0 at the end of the law; it is {math.degrees(end):.9g} deg", "law")
    functions = [_scaled(f, scale) for f in programme.motion.functions]
    psi, lean = _over_period(delta, programme.motion.knots.tolist(), functions, (0.0, 1.0))
    return _checked(Transmission(lam, mu, arm, psi, lean, 0.0), programme.motion.knots.tolist(), functions, "law")


def _scaled(function: Stretch, scale: float) -> Stretch:
    if isinstance(function, Constant):
        value = function.value * scale
        return Constant(0.0 if abs(value) <= _JOIN else value)
    return Affine.of(function, scale=scale) if scale != 1 else function


def _checked(law: Transmission, knots: Sequence[float], functions: Sequence[Stretch], field: str) -> Transmission:
    """Return the law, given its stretches over delta, if psi exists and it is possible and joins; else IntentError."""
    try:
        _demand_possible(law, knots, functions, field)
        _demand_joined(law, field)
    except DomainError as error:
        raise IntentError(f"there is no such law: {error.operation}", field) from error
    return law


def from_arc(
    lam: int, mu: int, arm: float, radius: float, side: Literal["convex", "concave"] = "convex"
) -> Transmission:
    """Make the law of a pitch curve that begins with a circular arc over t in [0, delta] (W sections 3, 7a; Figure 5).

    The arc joins two mean positions, psi = 0 and r = R = 2 l cos(alpha/2), bulging outwards (convex) or inwards. Being
    symmetric about its bisector it meets its image with a common tangent. Raises IntentError for an excluded ratio, a
    radius below half the chord (concave: below the radius at which the arc is tangent to a ray from the shaft), and a
    law that swings too far or turns the cam back.
    """
    _demand_ratio(lam, mu, arm)
    alpha, delta = math.pi * mu / lam, math.pi / lam
    mean = 2 * arm * math.cos(alpha / 2)
    chord, height = mean * math.sin(delta / 2), mean * math.cos(delta / 2)
    least = chord if side == "convex" else chord / math.cos(delta / 2)
    if not (math.isfinite(radius) and (radius >= least if side == "convex" else radius > least)):
        raise IntentError(
            f"a {side} arc needs a radius of at least {least:.9g} mm to join the mean positions, not {radius:.9g} mm",
            "arc.radius",
        )
    sagitta = math.sqrt((radius - chord) * (radius + chord))  # from the centre to the chord
    if side == "convex":
        centre, power = height - sagitta, chord**2 - height**2 + 2 * height * sagitta
    else:
        centre, power = height + sagitta, height**2 - chord**2 + 2 * height * sagitta
    top = centre + radius if side == "convex" else centre - radius
    if not 0 < top < 2 * arm:
        where = f"the middle of the arc is {top:.9g} mm from the shaft"
        raise IntentError(f"{where}; it must lie between 0 and 2 l = {2 * arm:.9g} mm", "arc.radius")
    arc = FromArc(arm, alpha, delta, centre, radius, power, side == "convex")
    psi, lean = _over_period(delta, [0.0, delta], [arc], (0.5, 0.5))
    place = (centre * math.cos(delta / 2), centre * math.sin(delta / 2), radius if side == "convex" else -radius)
    return _checked(Transmission(lam, mu, arm, psi, lean, alpha / 2, place), [0.0, delta], [arc], "arc")


def from_rosette(lam: int, mu: int, arm: float, leaf: Formula, scale: float = 1.0) -> Transmission:
    """Make the law from one leaf of the third arm's path: |OQ| as `scale` times a formula in x, mm, 0 <= x <= 1.

    The third arm PQ, of length l, lies on the bisector and points to the shaft while psi = 0, so Q = 2 l sin(psi/2)
    n(phi - psi/2). As phi - psi/2 = t + alpha/2, x is (t + alpha/2)/delta: the first leaf begins at phi = 0 and has psi
    above 0 (W section 5). Raises IntentError if the leaf does not begin and end in the shaft with slopes that join
    (leaf'(1) = -leaf'(0)), has no value somewhere, falls below 0 or makes no possible law.
    """
    _demand_ratio(lam, mu, arm)
    alpha, delta, field = math.pi * mu / lam, math.pi / lam, "rosette.leaf"
    start = -alpha / 2
    try:
        places, pieces = leaf.pieces(0.0, 1.0)
        most = 2 * arm * math.sin(min(alpha, math.pi - alpha) / 2)
        for begin, end, piece in zip(places[:-1], places[1:], pieces, strict=True):
            x = np.linspace(begin, end, 257)
            _demand_leaf(x, piece.jet(x, 1).c[0] * scale, arm, most)
    except FormulaError as error:
        raise IntentError(error.message, field) from error
    knots = [start + float(x) * delta for x in places]
    functions = [_leaf_stretch(FromLeaf(piece, scale / (2 * arm), start, delta)) for piece in pieces]
    psi, lean = _over_period(delta, knots, functions, (0.5, 0.5))
    return _checked(Transmission(lam, mu, arm, psi, lean, alpha / 2), knots, functions, field)


def _leaf_stretch(stretch: FromLeaf) -> Stretch:
    """Return the stretch, or the rest that it is if the leaf does not depend on x there."""
    enclosed = stretch.leaf.ball(0.0, 1.0, 1)
    if enclosed.mid[1].any() or enclosed.rad[1].any():
        return stretch
    psi = 2 * math.asin(float(enclosed.mid[0, 0]) * stretch.scale)
    return Constant(0.0 if abs(psi) <= _JOIN else psi)


def _demand_leaf(x: Array, distance: Array, arm: float, most: float) -> None:
    """Refuse |OQ| below 0, not 0 where the leaf begins and ends, or so long that no swing leads there."""
    field = "rosette.leaf"
    ends = np.flatnonzero(((x == 0) | (x == 1)) & (np.abs(distance) > _JOIN * arm))
    low, high = int(np.argmin(distance)), int(np.argmax(distance))
    if len(ends):
        at, found = x[ends[0]], distance[ends[0]]
        raise IntentError(f"the leaf must begin and end in the shaft; |OQ| is {found:.9g} mm at x = {at:.6g}", field)
    if distance[low] < -_JOIN * arm:
        raise IntentError(f"|OQ| is a distance; it is {distance[low]:.9g} mm at x = {x[low]:.6g}", field)
    if distance[high] >= most:
        raise IntentError(
            f"|OQ| must stay below {most:.9g} mm, where an arm would meet the shaft or stretch out; it is "
            f"{distance[high]:.9g} mm at x = {x[high]:.6g}",
            field,
        )
