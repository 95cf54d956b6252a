"""Disc cams: the moving frame against mpmath, its bounds against dense samples, the contour against its follower.

Holds: camgeo.curve.face.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.discs import CONTOURS, DEGREE, TURN, displaced, inline, offset, segments
from support.places import RECIPES

from camgeo.cams.least_size import least_prime, least_stem
from camgeo.curve.backwards import Backwards, backwards, least_hollow
from camgeo.curve.curvature import least_radius, reversals
from camgeo.curve.curve import Curve
from camgeo.curve.disc import StraightFace, SwingingFace, face_shape
from camgeo.curve.extremes import both, greatest, least
from camgeo.curve.moving_frame import CentreShape, Displacement, Oscillating, Translating
from camgeo.curve.parallel import Parallel
from camgeo.curve.rates import stretches
from camgeo.curve.undercut.causes import causes
from camgeo.curve.undercut.trim import trimmed
from camgeo.curve.undercut.undercut import undercuts
from camgeo.recipe.loading import load
from kin.law.normalised import IntentError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Shape

RISE = (0.3, 1.1, 1.9)  # rad: inside the rise of 120 degrees of each oracle


def cycloid(stroke: float) -> Callable[[mp.mpf], mp.mpf]:
    """Rise by a cycloid over 120 degrees from 0."""

    def lift(theta: mp.mpf) -> mp.mpf:
        u = theta * 3 / (2 * mp.pi)
        return stroke * (u - mp.sin(2 * mp.pi * u) / (2 * mp.pi))

    return lift


def motion(stroke: float) -> Displacement:
    return displaced((stroke, 120, "cycloidal"), (60,), (-stroke, 120, "cycloidal"), (60,))


def unit(angle: mp.mpf) -> mp.mpc:
    return mp.expjpi(angle / mp.pi)


def rolled(centre: Callable[[mp.mpf], mp.mpc], radius: float) -> Callable[[mp.mpf], mp.mpc]:
    """Point that a roller touches: its centre less the radius along the normal of its path."""

    def point(theta: mp.mpf) -> mp.mpc:
        velocity = mp.diff(centre, theta)
        return centre(theta) + radius * 1j * velocity / abs(velocity)

    return point


def faced(distance: Callable[[mp.mpf], mp.mpf], normal: Callable[[mp.mpf], mp.mpf]) -> Callable[[mp.mpf], mp.mpc]:
    """Point of a face's line that stands still along the normal."""

    def point(theta: mp.mpf) -> mp.mpc:
        return unit(normal(theta)) * (distance(theta) + 1j * mp.diff(distance, theta) / mp.diff(normal, theta))

    return point


def oracles() -> dict[str, tuple[Shape, Callable[[mp.mpf], mp.mpc]]]:
    s, swing = cycloid(20.0), cycloid(0.3)
    found: dict[str, tuple[Shape, Callable[[mp.mpf], mp.mpc]]] = {}
    stem = CentreShape(motion(20.0), Translating.on(50.0, 30.0))
    found["roller"] = Parallel(stem, 10.0), rolled(lambda t: unit(t) * (40 + s(t) + 30j), 10.0)
    found["ring"] = Parallel(stem, -10.0), rolled(lambda t: unit(t) * (40 + s(t) + 30j), -10.0)
    found["knife edge"] = stem, lambda t: unit(t) * (40 + s(t) + 30j)
    for side in (1, -1):
        guide = Oscillating.on(42.0, 80.0, 65.0, side)
        rest = mp.acos((mp.mpf(80) ** 2 + 65**2 - 42**2) / (2 * 80 * 65))
        centre = lambda t, side=side, rest=rest: unit(t) * (80 - 65 * unit(side * (rest + swing(t))))  # noqa: E731
        found[f"arm {side:+}"] = Parallel(CentreShape(motion(0.3), guide), 8.0), rolled(centre, 8.0)
        face = SwingingFace.on(motion(0.3), 36.0, 90.0, 10.0, side)
        low = mp.asin(mp.mpf(46) / 90)
        distance = lambda t, low=low: 90 * mp.sin(low + swing(t)) - 10  # noqa: E731
        normal = lambda t, side=side, low=low: t + side * (low + swing(t) - mp.pi / 2)  # noqa: E731
        found[f"face {side:+}"] = face_shape(face), faced(distance, normal)
    tilt = mp.mpf(0.2)
    straight = StraightFace(motion(20.0), 30.0, 0.2)
    found["tilted"] = face_shape(straight), faced(lambda t: 30 + s(t) * mp.cos(tilt), lambda t: t + tilt)
    return found


ORACLES = oracles()


@pytest.mark.thin(9)
@pytest.mark.parametrize("name", ORACLES)
def test_frame_is_that_of_forty_digits(name: str) -> None:
    shape, point = ORACLES[name]
    at = shape.sample(np.array(RISE))
    coefficients = shape.series(np.array(RISE), 2)

    def speed(theta: mp.mpf) -> mp.mpf:
        return mp.re(mp.diff(point, theta) / unit_tangent(theta))

    def unit_tangent(theta: mp.mpf) -> mp.mpc:
        velocity = mp.diff(point, theta)
        return velocity / abs(velocity)

    def turn(theta: mp.mpf) -> mp.mpf:
        return mp.im(mp.diff(unit_tangent, theta) / unit_tangent(theta))

    for i, theta in enumerate(map(mp.mpf, RISE)):
        size = 60.0
        assert complex(*at.point[i]) == pytest.approx(complex(point(theta)), abs=1e-14 * size)
        assert complex(*at.tangent[i]) == pytest.approx(complex(unit_tangent(theta)), abs=1e-14)
        expected = float(speed(theta)), float(turn(theta))
        slopes = float(mp.diff(speed, theta)), float(mp.diff(turn, theta))
        assert (at.speed[i], at.turn[i]) == pytest.approx(expected, rel=1e-13)
        assert (at.speed_slope[i], at.turn_slope[i]) == pytest.approx(slopes, rel=1e-10, abs=1e-10)
        for k, row in enumerate(coefficients):
            figures = (expected[k], slopes[k])
            assert row[:2, i] == pytest.approx(figures, rel=1e-10, abs=1e-10)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", CONTOURS)
def test_bounds_hold_dense_samples(name: str) -> None:
    shape = CONTOURS[name]
    rng = np.random.default_rng(5)
    for low, high in stretches(shape):
        ends = np.sort(rng.uniform(low, high, (40, 2)), axis=1)
        ends[::2, 1] = ends[::2, 0] + np.minimum(1e-3, 0.5 * (high - ends[::2, 0]))
        bounds = shape.bounds(ends[:, 0], ends[:, 1])
        inside = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * np.linspace(0.0, 1.0, 33)
        at = shape.sample(inside.ravel())
        speed, turn, rises, bends = (row.reshape(inside.shape) for row in at.rows[2:])
        second = [2.0 * row[2].reshape(inside.shape) for row in shape.series(inside.ravel(), 2)]
        one = np.ones((1, inside.shape[1]))
        slack = 1e-12 * np.abs(speed).max()
        for value, least_, most in (
            (speed, bounds.speed_low, bounds.speed_high),
            (turn, bounds.turn_low, bounds.turn_high),
        ):
            assert (value >= least_[:, None] * one - slack).all()
            assert (value <= most[:, None] * one + slack).all()
        for value, most in (
            (rises, bounds.speed_slope),
            (bends, bounds.turn_slope),
            (second[0], bounds.speed_bend),
            (second[1], bounds.turn_bend),
        ):
            assert (np.abs(value) <= most[:, None] * one * (1.0 + 1e-12) + slack).all()
        # over a short interval a bound is no cruder than what a quadratic there asks for, or the proof is empty
        bare = shape.base if isinstance(shape, Parallel) else shape
        bounds = bare.bounds(*ends[::2].T)
        seen = np.ptp(bare.sample(inside[::2].ravel()).speed.reshape(-1, 33), axis=1)
        assert (bounds.speed_high - bounds.speed_low <= 10.0 * seen + 1e-10).all()


def test_dwells_are_exact_circles_about_the_shaft() -> None:
    for eccentricity in (0.0, 10.0, -30.0):
        pitch = CentreShape(motion(20.0), Translating.on(50.0, eccentricity))
        top = math.hypot(math.sqrt(2500.0 - eccentricity**2) + 20.0, eccentricity)
        assert pitch.radii[[1, 3]] == pytest.approx([top, 50.0], rel=1e-15)
        assert np.isnan(pitch.radii[[0, 2]]).all()
        assert pitch.steady[[1, 3], 1] == pytest.approx(1.0, abs=0.0)


def test_the_eccentric_is_one_circle_under_a_flat_face() -> None:
    """Harmonic rise and return of 50 mm over half turns, base 25: a circle of 50 mm at (-25, 0), face 50 mm."""
    face = StraightFace(displaced((50, 180, "harmonic"), (-50, 180, "harmonic")), 25.0)
    shape = face_shape(face)
    assert shape.radii == pytest.approx([50.0, 50.0], rel=1e-15)
    points = shape.sample(np.linspace(0.0, TURN, 97)).point
    assert np.hypot(points[:, 0] + 25.0, points[:, 1]) == pytest.approx(50.0, abs=1e-13)
    low, high = least(face.contact, stretches(face)).value, greatest(face.contact, stretches(face)).value
    assert (low, high) == pytest.approx((-25.0, 25.0), abs=1e-10)


def test_a_motion_repeated_is_one_part_turned() -> None:
    rows = ((5, 50, "cycloidal"), (20,), (-5, 40, "polynomial-345"), (10,))
    third = segments(*rows, total=TURN / 3)
    pitch = CentreShape(Displacement.of(third), Translating.on(40.0, 6.0))
    whole = CentreShape(Displacement.of(segments(*rows, *rows, *rows)), Translating.on(40.0, 6.0))
    assert (pitch.repeats, pitch.breaks.size, len(pitch.steady)) == (3, 12, 12)
    t = np.linspace(0.0, TURN, 301)
    assert pitch.sample(t).point == pytest.approx(whole.sample(t).point, abs=1e-13)
    first = pitch.sample(t[:100]).point @ [1.0, 1.0j]
    assert pitch.sample(t[:100] + TURN / 3).point @ [1.0, 1.0j] == pytest.approx(first * cmath.exp(1j * TURN / 3))
    assert Curve.whole(pitch).cells.rows.shape[1] % 3 == 0


LAWS = ("cycloidal", "modified-sine", "polynomial-345", "polynomial-4567", "modified-trapezoid", "harmonic")


@st.composite
def motions(draw: st.DrawFn) -> tuple[tuple, ...]:
    """A rise of 1, a dwell, a return and a dwell, by any laws."""
    rise, dwell, fall = draw(st.integers(60, 140)), draw(st.integers(10, 60)), draw(st.integers(60, 140))
    up, down = draw(st.sampled_from(LAWS)), draw(st.sampled_from(LAWS))
    return (1.0, rise, up), (dwell,), (-1.0, fall, down), (360 - rise - dwell - fall,)


FOLLOWERS = ("roller", "ring", "knife edge", "shoe", "arm", "ring on an arm", "flat", "tilted", "face on an arm")
DENSE = 40_000
ANGLES = np.linspace(0.0, TURN, 49)[:-1] + 0.0123


@pytest.mark.costly("random cams of each follower")
@settings(max_examples=examples(50), deadline=None)
@given(motions(), st.sampled_from(FOLLOWERS), st.floats(0.05, 1.0), st.floats(-0.6, 0.6), st.sampled_from([1, -1]))
def test_the_follower_touches_and_never_cuts(
    rows: tuple[tuple, ...], follower: str, stroke: float, aside: float, side: int
) -> None:
    """Against brute force: at each shaft angle the nearest of 40,000 points of the contour is where the follower is."""
    shape: Any
    shape, line = made(rows, follower, stroke, aside, side)
    radius = line[1]
    curve = Curve.whole(shape)
    if math.isinf(radius):
        assume(least_radius(curve)[0] > 0.5)
    elif radius >= 0.0:
        assume(not reversals(curve))
        if radius > 0.0:
            assume(causes(curve).none)
    else:
        assume(causes(Curve.whole(Parallel(Backwards(shape.base), -radius))).none)
    points = shape.sample(np.sort(np.append(np.linspace(0.0, TURN, DENSE), ANGLES))).point @ [1.0, 1.0j]
    for theta in ANGLES:
        at = line[0](theta)
        if math.isinf(radius):
            normal, distance = at
            over = (points * np.conj(normal)).real.max() - distance
            assert -1e-6 < over < 1e-10
        elif radius == 0.0:
            assert np.abs(points - at).min() < 1e-10
        else:
            gap = np.abs(points - at).min() - abs(radius)
            assert -1e-10 < gap < 1e-6


def made(
    rows: tuple[tuple, ...], follower: str, stroke: float, aside: float, side: int
) -> tuple[Shape, tuple[Callable, float]]:
    """A contour, and where its follower is: the centre and the radius, or the face's normal and distance."""
    arm = follower in {"arm", "ring on an arm", "face on an arm"}
    scale = 0.35 * stroke if arm else 15.0 * stroke
    law = displaced(*rows, scale=scale)
    lift = lambda theta: float(law.derivatives(np.array([theta]), 0)[0, 0])  # noqa: E731
    if follower in {"flat", "tilted"}:
        tilt = 0.5 * aside if follower == "tilted" else 0.0
        return face_shape(StraightFace(law, 35.0, tilt)), (
            lambda t: (np.exp(1j * (t + tilt)), 35.0 + lift(t) * math.cos(tilt)),
            math.inf,
        )
    if follower == "face on an arm":
        face = SwingingFace.on(law, 36.0, 90.0, 10.0 * aside, side)
        rest = math.asin((36.0 + 10.0 * aside) / 90.0)
        return face_shape(face), (
            lambda t: (
                np.exp(1j * (t + side * (rest + lift(t) - math.pi / 2))),
                90.0 * math.sin(rest + lift(t)) - 10.0 * aside,
            ),
            math.inf,
        )
    if arm:
        pitch = CentreShape(law, Oscillating.on(42.0, 80.0, 65.0, side))
        rest = math.acos((80.0**2 + 65.0**2 - 42.0**2) / (2 * 80.0 * 65.0))
        centre = lambda t: np.exp(1j * t) * (80.0 - 65.0 * np.exp(1j * side * (rest + lift(t))))  # noqa: E731
    else:
        prime = 85.0 if follower == "shoe" else 45.0
        e = 45.0 * aside
        pitch = CentreShape(law, Translating.on(prime, e))
        centre = lambda t: np.exp(1j * t) * (math.sqrt(prime**2 - e**2) + lift(t) + 1j * e)  # noqa: E731
    radius = {"knife edge": 0.0, "shoe": 60.0, "ring": -9.0, "ring on an arm": -9.0}.get(follower, 9.0)
    return (Parallel(pitch, radius) if radius else pitch), (centre, radius)


def hollow_pitch() -> CentreShape:
    """A pitch curve with two hollows of 26.56 mm."""
    return CentreShape(displaced((14, 60, "cycloidal"), (-14, 60, "cycloidal"), (240,)), Translating.on(30.0))


@pytest.mark.slow
@pytest.mark.parametrize("radius", [27.0, 40.0, 80.0])
def test_a_ring_undercuts_where_its_pitch_curve_is_hollow(radius: float) -> None:
    """Speed sigma + R omega: what is left of the ring meets in corners, and is nowhere nearer than R to the pitch."""
    pitch = hollow_pitch()
    ring = Curve.whole(Parallel(pitch, -radius))
    cuts = undercuts(ring)
    assert [cut.kind for cut in cuts] == ["local", "local"]
    for cut in cuts:
        assert cut.start < cut.at < cut.end
        assert 0.0 <= cut.start < TURN
        assert cut.free_at == pytest.approx(least_hollow(Curve.whole(pitch))[0], abs=1e-9)
        assert ring.sample(np.array([cut.at])).speed[0] < 0.0
    kept = trimmed(ring)
    assert len(kept.runs) == 2
    after = (*kept.runs[1:], kept.runs[0])
    for one, other in zip(kept.runs, after, strict=True):
        assert kept.sample(np.array([one.high])).point == pytest.approx(kept.sample(np.array([other.low])).point)
    centres = pitch.sample(np.linspace(0.0, TURN, 6_001)).point @ [1.0, 1.0j]
    for run in kept.runs:
        points = kept.sample(np.linspace(run.low, run.high, 301)).point @ [1.0, 1.0j]
        assert np.abs(points[:, None] - centres).min() > radius - 1e-9


def test_a_ring_larger_than_its_hollows_is_sound() -> None:
    ring = Curve.whole(Parallel(hollow_pitch(), -26.5))
    assert undercuts(ring) == ()
    assert trimmed(ring) is ring


def test_a_knife_edge_never_undercuts_by_bending() -> None:
    """Hollow or not: its contour is its own path, and runs forward everywhere."""
    assert undercuts(Curve.whole(Parallel(hollow_pitch(), 0.0))) == ()


@pytest.mark.parametrize("name", ["disc-roller", "disc-knife-edge"])
def test_bounds_of_a_curve_run_the_other_way_are_those_of_the_curve(name: str) -> None:
    curve = load(RECIPES / f"{name}.yaml").cam.exact().surfaces[0].curve
    turned = backwards(curve)
    cells, made = turned.cells, Curve(turned.shape, turned.runs).cells
    assert cells.low[0] == turned.runs[0].low
    assert np.array_equal(cells.high[:-1], cells.low[1:])
    assert cells.rows == pytest.approx(made.rows, rel=1e-6, abs=1e-9)
    share = np.linspace(1e-6, 1.0 - 1e-6, 7)
    at = turned.sample((cells.low[:, None] + (cells.high - cells.low)[:, None] * share).ravel())
    speed, turn = at.speed.reshape(-1, 7).T, at.turn.reshape(-1, 7).T
    assert ((cells.rows[0] - 1e-9 <= speed) & (speed <= cells.rows[1] + 1e-9)).all()
    assert ((cells.rows[2] - 1e-9 <= turn) & (turn <= cells.rows[3] + 1e-9)).all()


def test_extremes_are_proved_and_reached() -> None:
    """A figure with a top of its own height at a place known: 3 sin t + 0.1 sin 30 t, and its enclosure."""
    from kin.numeric import elementary

    figure = lambda tau, side=1: elementary.sin(tau) * 3.0 + elementary.sin(tau * 30.0) * 0.1  # noqa: E731, ARG005
    grid = np.linspace(0.0, TURN, 2_000_001)
    values = 3.0 * np.sin(grid) + 0.1 * np.sin(30.0 * grid)
    for found, seen in (
        (greatest(figure, np.array([[0.0, TURN]])), values.max()),
        (least(figure, np.array([[0.0, 1.0], [1.0, TURN]])), values.min()),
    ):
        assert found.value == pytest.approx(seen, abs=1e-10)
        assert abs(found.value) >= abs(seen)
        assert found.excess < 1e-12
    turn = np.array([[0.0, TURN]])
    assert both(figure, turn) == (least(figure, turn), greatest(figure, turn))
    assert greatest(lambda tau, side=1: tau * 0.0 + 2.0, np.array([[0.0, 1.0]])).value == 2.0  # noqa: ARG005


def test_a_top_is_proved_where_the_figure_bends_down() -> None:
    """Division alone goes on to a millionth of a turn about the top; f'^2/(2 m) ends it where f'' is below 0."""
    from kin.numeric import elementary
    from kin.numeric.jet import BallJet

    passes = 0

    def figure(tau: Any, side: object = 1) -> Any:  # noqa: ARG001
        nonlocal passes
        passes += isinstance(tau, BallJet)
        return elementary.sin(tau) * 3.0 + elementary.sin(tau * 30.0) * 0.1

    found = greatest(figure, np.array([[0.0, 2.0], [2.0, TURN]]))
    assert found.value == pytest.approx(3.0960211722302637, abs=1e-14)
    assert passes <= 4


@pytest.mark.parametrize("bend", [1.0, 1e-6, 1e-12])
def test_a_flat_top_beside_a_break_is_not_passed_over(bend: float) -> None:
    """However little it bends, and where the top is that of an end: nothing is above the value and its room."""
    from kin.numeric import elementary

    figure = lambda tau, side=1: elementary.sin(tau) + (tau - 1.0) ** 2 * bend  # noqa: E731, ARG005
    for low, high in ((0.3, 1.5), (1.0, 2.4), (1.5707, 1.5708)):
        grid = np.linspace(low, high, 200_001)
        found = greatest(figure, np.array([[low, high]]))
        assert found.value + found.excess >= (np.sin(grid) + bend * (grid - 1.0) ** 2).max()
        assert found.excess < 1e-12


def test_a_figure_is_found_once_of_a_profile() -> None:
    cam = load(RECIPES / "disc-roller.yaml").cam
    surface = cam.exact().surfaces[0]
    assert surface.extremes("slope") is surface.extremes("slope")
    assert cam.exact().surfaces[0].extremes("slope") == surface.extremes("slope")


def test_a_kink_inside_a_stretch_is_bounded_by_values_alone() -> None:
    from kin.numeric import elementary

    found = greatest(lambda tau, side=1: -elementary.abs_(tau - 0.3), np.array([[0.0, 1.0]]))  # noqa: ARG005
    assert found.value == pytest.approx(0.0, abs=1e-12)
    assert found.value + found.excess >= 0.0
    assert found.excess < 1e-9


@pytest.mark.slow
def test_least_sizes_leave_nothing_to_gain() -> None:
    """A hair below the least stem or the least prime circle the limit is broken."""
    law = displaced((24, 100, "modified-sine"), (40,), (-24, 140, "modified-trapezoid"), (80,))
    for rising, falling in ((30, 45), (60, 20)):
        stem = least_stem(law, rising * DEGREE, falling * DEGREE)
        assert (worst(law, stem) <= np.array([rising, falling]) + 1e-9).all()
        for turn in np.linspace(0.0, TURN, 7):
            e = stem.offset + 0.01 * stem.prime * math.cos(turn)
            prime = stem.prime * (1.0 - 1e-6)
            if abs(e) < prime:
                assert (worst(law, Translating.on(prime, e)) > np.array([rising, falling])).any()
    size = least_prime(lambda prime: CentreShape(law, Translating.on(prime, 4.0)), 35.0, 20.0)
    radii = [least_radius(Curve.whole(CentreShape(law, Translating.on(p, 4.0))))[0] for p in (size, 0.999 * size)]
    assert radii[0] == pytest.approx(35.0, abs=1e-9)
    assert radii[1] < 35.0


def worst(law: Displacement, stem: Translating) -> np.ndarray:
    pitch = CentreShape(law, stem)
    over = stretches(pitch)
    return np.degrees([math.atan(greatest(pitch.slope, over).value), -math.atan(least(pitch.slope, over).value)])


def test_signs() -> None:
    """A positive offset lessens the pressure angle of the rise; the angle is above 0 where the cam drives a rise."""
    theta = np.array([50.0, 210.0]) * DEGREE
    assert np.sign(inline().pressure_angle(theta)).tolist() == [1.0, -1.0]
    assert (offset(10.0).pressure_angle(theta) < offset(0.0).pressure_angle(theta)).all()


@pytest.mark.parametrize("side", [1, -1])
def test_a_face_may_swing_nearly_as_fast_as_the_cam_turns(side: int) -> None:
    """A cycloid of stroke h over 120 degrees swings back by 3 h/pi per turn of the cam at the most."""
    limit = math.pi / 3.0
    SwingingFace.on(motion(limit * (1.0 - 1e-9)), 10.0, 90.0, 5.0, side)
    with pytest.raises(IntentError, match=r"1(\.0+\d*)? times as fast as the cam turns"):
        SwingingFace.on(motion(limit * (1.0 + 1e-9)), 10.0, 90.0, 5.0, side)


def test_a_slow_swing_needs_no_search_for_its_fastest(monkeypatch: pytest.MonkeyPatch) -> None:
    def searched(*_: object) -> None:
        raise AssertionError("searched")

    monkeypatch.setattr("camgeo.curve.disc.least", searched)
    SwingingFace.on(motion(0.2), 10.0, 90.0, 5.0, 1)
    with pytest.raises(AssertionError, match="searched"):
        SwingingFace.on(motion(1.2), 10.0, 90.0, 5.0, 1)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Translating.on(40.0, 40.0), "the offset, 40 mm, must be below the prime circle's radius, 40 mm"),
        (lambda: Oscillating.on(10.0, 80.0, 65.0, 1), "does not reach a prime circle of 10 mm: it reaches 15 to 145"),
        (lambda: CentreShape(motion(3.0), Oscillating.on(42.0, 80.0, 65.0, 1)), "swings from 31.568 to 203.455"),
        (lambda: SwingingFace.on(motion(0.1), 90.0, 90.0, 5.0, 1), "must lie between 0 and the pivot's distance"),
        (lambda: SwingingFace.on(motion(1.2), 10.0, 90.0, 5.0, -1), "times as fast as the cam turns"),
        (
            lambda: SwingingFace.on(motion(1.5), 10.0, 90.0, 5.0, 1),
            "at 90 the contact reaches the pivot",
        ),
        (lambda: StraightFace(motion(20.0), 30.0, 1.6), "below 90 it is"),
        (lambda: least_stem(motion(20.0), 0.0, 1.0), "lies between 0 and 90 degrees, not 0"),
    ],
)
def test_what_cannot_be_made_is_refused(make: Callable[[], object], said: str) -> None:
    with pytest.raises(IntentError, match=said):
        make()
