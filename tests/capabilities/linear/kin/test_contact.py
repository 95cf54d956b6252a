"""A follower set down on lines and arcs of a file, and the greatest error over all inputs that is proved."""

import math

import numpy as np
import pytest
from capabilities.linear.kin.contours import arcs, closed, endless, groove, intent, on_arm, on_stem, polygon
from support.cases import few

from kin.contour.contour import Contour
from kin.law.motion_error import MotionError
from kin.linear.contact import Held, RestError
from kin.linear.flanks import Metal, held_by, judged_motion, judged_play
from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.intent import Ends
from kin.linear.judge import positions
from kin.linear.motion import errors, intended
from kin.linear.outline import Flank, plate_strayed
from kin.numeric.records import replace

FOLLOWERS = {
    "upright": on_stem(),
    "lean 20": on_stem(lean=20.0),
    "lean -30": on_stem(lean=-30.0, radius=5.0),
    "trailing": on_arm(1),
    "leading": on_arm(-1),
    "knife edge": on_stem(radius=0.0, level=32.0),
    "shoe": on_stem(radius=15.0, level=60.0),
}


def held(contour, follower):
    return Held.of(contour.as_arcs()[0], follower, follower.span)


def rough(seed, low=0.0, high=120.0):
    """A plate of lines and arcs, up and down at random."""
    rng = np.random.default_rng(seed)
    x = np.linspace(low - 60.0, high + 60.0, 41)
    y = 30.0 + 3.0 * rng.standard_normal(41).cumsum() / 4.0
    points = np.concatenate([[[x[0], 0.0], [x[-1], 0.0]], np.stack([x, y], axis=-1)[::-1]])
    bulges = np.concatenate([[0.0, 0.0], rng.uniform(-0.3, 0.3, 40), [0.0]])
    return Contour.from_bulges(points, bulges)


def lowest(follower, point, u):
    """Lift with the roller on a point, by the circle about it."""
    radius, guide = follower.radius, follower.guide
    with np.errstate(invalid="ignore"):
        if isinstance(guide, Stem):
            sine, cosine = math.sin(guide.gamma), math.cos(guide.gamma)
            x, y = point[:, 0] - u, point[:, 1] - follower.level
            return x * sine + y * cosine + np.sqrt(radius**2 - (x * cosine - y * sine) ** 2)
        x, y = guide.side * (u - point[:, 0]), point[:, 1] - guide.pivot
        away = np.hypot(x, y)
        share = (away**2 + guide.length**2 - radius**2) / (2.0 * away * guide.length)
        return np.arctan2(y, x) + np.arccos(share) - follower.psi0


@pytest.mark.parametrize("name", [name for name in FOLLOWERS if name != "knife edge"])
def test_a_follower_on_lines_and_arcs_is_one_on_all_their_points(name):
    follower, contour = FOLLOWERS[name], rough(7)
    points = contour.sample(2000)
    u = np.linspace(10.0, 100.0, 23)
    found = positions(contour, follower, u)
    wanted = np.array([np.nanmax(lowest(follower, points, at)) for at in u])
    # the points are a fraction of a hundredth apart, which counts by its square over the radius
    np.testing.assert_allclose(found, wanted, atol=3e-6 / follower.lever)
    assert (found >= wanted - 1e-12).all()


def test_an_upright_stem_on_one_arc_is_on_a_circle():
    """z + sqrt((rho + R)^2 - (u - y)^2) on a crest, z - sqrt((rho - R)^2 - (u - y)^2) in a hollow."""
    follower, u = on_stem(level=0.0), np.array([-9.0, 0.0, 12.0])
    crest = Contour.from_bulges(np.array([[-40.0, 0.0], [40.0, 0.0], [40.0, 10.0], [-40.0, 10.0]]), [0, 0, 0.3, 0])
    rho = 40.0 * (1.0 + 0.09) / 0.6
    top = 10.0 + 40.0 * 0.3 - rho
    np.testing.assert_allclose(positions(crest, follower, u), top + np.sqrt((rho + 8.0) ** 2 - u**2), rtol=1e-13)
    hollow = Contour.from_bulges(np.array([[-40.0, 0.0], [40.0, 0.0], [40.0, 30.0], [-40.0, 30.0]]), [0, 0, -0.3, 0])
    low = 30.0 - 40.0 * 0.3 + rho
    np.testing.assert_allclose(positions(hollow, follower, u), low - np.sqrt((rho - 8.0) ** 2 - u**2), rtol=1e-13)


@pytest.mark.parametrize("name", few(FOLLOWERS, 2))
@pytest.mark.parametrize("made", [polygon, arcs])
def test_the_proved_error_is_the_greatest_of_any_sample(name, made):
    follower = FOLLOWERS[name]
    contour = made(follower, 40)
    own = held(contour, follower)
    found = errors(own, follower.span)
    first, last = follower.span
    u = np.sort(np.concatenate([np.linspace(first, last, 20001), own.ends[(own.ends > first) & (own.ends < last)]]))
    off = own.reached(u) - intended(follower, u)
    fine = 1e-3 * max(found.most.error, -found.least.error)
    assert found.most.error >= off.max() - 1e-14
    assert found.least.error <= off.min() + 1e-14
    assert found.most.error == pytest.approx(off.max(), abs=fine)
    assert found.least.error == pytest.approx(off.min(), abs=fine)
    assert max(found.most.remainder, found.least.remainder) <= 1e-6 * fine * 1e3 + 1e-11


def test_the_error_is_proved_where_the_velocity_jumps():
    from support.programmes import Segment, law, programme

    segments = [
        Segment("dwell", 20.0),
        Segment("rise", 50.0, 12.0, law("constant-velocity")),
        Segment("dwell", 20.0),
        Segment("return", 30.0, 12.0, law("parabolic")),
    ]
    follower = on_stem(motion=programme(segments, 120.0).motion, radius=4.0, level=36.0)
    assert follower.corners.tolist() == [20.0, 70.0]
    contour = polygon(follower, 240)
    own = held(contour, follower)
    found, u = errors(own, follower.span), np.linspace(0.0, 120.0, 40001)
    off = own.reached(u) - intended(follower, u)
    assert found.least.error <= off.min() + 1e-13
    assert found.least.error == pytest.approx(off.min(), rel=1e-3)
    assert found.most.error == pytest.approx(off.max(), rel=1e-3)


def spoiled(contour, edge, share, height):
    """The polygon with a corner 0.002 wide and this high out of, or into, one of its edges."""
    corners = contour.vertices
    start, end = corners[edge], corners[(edge + 1) % len(corners)]
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    out = np.array([along[1], -along[0]])
    place = start + share * (end - start)
    new = [place - 0.001 * along, place + height * out, place + 0.001 * along]
    return Contour.from_vertices(np.concatenate([corners[: edge + 1], new, corners[edge + 1 :]]))


def spots(follower, contour, count, seed):
    """Edges of the flank, and shares of them, whose places are touched within the motion."""
    rng, pitch = np.random.default_rng(seed), Flank(follower, intent(follower).ends).pitch
    found = []
    while len(found) < count:
        edge, share = int(rng.integers(0, len(contour) - 2)), float(rng.uniform(0.05, 0.95))
        corners = contour.vertices
        place = corners[edge] + share * (corners[(edge + 1) % len(corners)] - corners[edge])
        u = float(pitch.feet(place[None]).input[0])
        if follower.span[0] + 0.1 < u < follower.span[1] - 0.1:
            found.append((edge, share))
    return found


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("upright", 3),
        ("trailing", 3),
        *(pytest.param(name, 12, marks=pytest.mark.slow) for name in ("lean 20", "leading")),
    ],
)
def test_a_bump_between_any_two_positions_is_found_by_contact_and_a_notch_by_distance(name, count):
    follower = FOLLOWERS[name]
    contour = polygon(follower, 400)
    flank = Flank(follower, intent(follower).ends)
    chords = plate_strayed(contour, flank, 1e-3)
    for edge, share in spots(follower, contour, count, 5):
        raised = errors(held(spoiled(contour, edge, share, 0.01), follower), follower.span)
        assert raised.most.error * follower.lever > 0.009 - chords.inside
        sunk = plate_strayed(spoiled(contour, edge, share, -0.01), flank, 1e-3)
        assert 0.01 - chords.outside - 1e-6 <= sunk.inside <= 0.01 + chords.inside + 1e-6


def test_a_parallel_of_a_long_plate_is_as_long_as_that():
    """A chamfer is held against it; it ended 4 radii of the roller and a length of the motion past that."""
    parallel = Flank(on_stem(), Ends((400.0, 400.0))).inset(0.5)
    assert parallel.reach == (-399.5, 519.5)
    assert parallel.pitch.feet(parallel.corners).excess == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_bump_lifts_a_knife_edge_where_no_sample_looks():
    follower = FOLLOWERS["knife edge"]
    contour = spoiled(polygon(follower, 400), 150, 0.4, 0.01)
    found = errors(held(contour, follower), follower.span)
    near = np.linspace(found.most.at - 2e-3, found.most.at + 2e-3, 400001)
    off = held(contour, follower).reached(near) - intended(follower, near)
    assert found.most.error == pytest.approx(off.max(), rel=1e-4)
    coarse = np.linspace(0.0, 120.0, 721)
    missed = held(contour, follower).reached(coarse) - intended(follower, coarse)
    assert missed.max() < 0.2 * found.most.error


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    "follower",
    [endless(), endless(Stem(math.radians(12.0))), endless(Arm(60.0, 50.0, 1), amplitude=0.08)],
    ids=["upright", "leaning", "arm"],
)
def test_an_endless_plate_goes_on_into_its_next_copy(follower):
    contour, flank = polygon(follower, 200), Flank(follower, None, 2)
    assert flank.span == (0.0, 80.0)
    own = held_by(contour, flank, Metal(outside=False), 1e-3)
    motion = judged_motion(own, flank.span)
    u = np.linspace(0.0, 80.0, 16001)
    off = own.reached(u) - intended(follower, u)
    scale = math.degrees(1.0) if motion.unit == "deg" else 1.0
    assert motion.most == pytest.approx(scale * off.max(), rel=1e-3)
    assert motion.most < scale * 2e-3 / follower.lever
    assert plate_strayed(contour, flank, 1e-3).worst < 2e-3


def test_the_play_of_a_groove_between_its_two_flanks():
    follower = on_stem()
    lower, upper = (
        Flank(follower, intent(follower).ends),
        Flank(follower.reflected().larger(0.05), intent(follower).ends),
    )
    chain, metal = groove(follower, count=2000), Metal(outside=True)
    below = held_by(chain, lower, metal, 1e-3)
    above = held_by(chain.mirrored(), upper, metal, 1e-3, follower.radius)
    u = np.array([35.0])
    assert float((-above.reached(u) - below.reached(u))[0]) == pytest.approx(0.0640312102939, abs=1e-4)
    play = judged_play(below, above, follower.span)
    assert play.least == pytest.approx(0.05, abs=1e-4)
    assert play.most == pytest.approx(0.06853654, abs=1e-4)
    gauges = judged_play(below, held_by(chain.mirrored(), upper, metal, 1e-3), follower.span)
    assert max(-gauges.least, gauges.most) < 1e-4


def test_a_follower_over_no_metal_touches_nothing():
    follower = on_stem()
    short = closed(np.array([[-5.0, 32.0], [60.0, 32.0]]))
    with pytest.raises(RestError, match="touches nothing at an input of"):
        errors(held(short, follower), follower.span)
    assert np.isnan(positions(short, follower, np.array([20.0, 100.0]))).tolist() == [False, True]


def test_the_follower_may_have_another_level():
    follower, contour = on_stem(), polygon(on_stem(), 100)
    higher = replace(follower, level=41.0)
    u = np.linspace(5.0, 115.0, 12)
    np.testing.assert_allclose(positions(contour, higher, u), positions(contour, follower, u) - 1.0, atol=1e-12)
    assert isinstance(higher, LinearFollower)


def test_an_error_is_wider_by_what_its_contour_may_be_off():
    error = MotionError(max=0.3, at=20.0, remainder=0.01, least=-0.3, most=0.2, rms=0.1, unit="mm")
    assert error.less_sure(0.0) is error
    wide = error.less_sure(0.5)
    assert [wide.max, wide.least, wide.most, wide.rms] == pytest.approx([0.8, -0.8, 0.7, 0.6])
    assert (wide.at, wide.remainder, wide.bound) == pytest.approx((20.0, 0.01, 0.81))
