"""Worked cases of general disc cams, nine digits, at the level of curves: each was computed by two separate programs.

Points within 1e-9 mm; other figures within one of their last printed digit. Of tied extremes either angle counts.
"""

import math

import numpy as np
import pytest
from support.discs import (
    DEGREE,
    M02,
    M07,
    M15,
    arm,
    flat,
    inline,
    knife,
    offset,
    segments,
    shoe,
    swinging,
    tilted,
)

from camgeo.curve.backwards import least_hollow
from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.disc import StraightFace, face_shape
from camgeo.curve.extremes import greatest, least
from camgeo.curve.moving_frame import CentreShape, Displacement, Translating
from camgeo.curve.parallel import Parallel
from camgeo.curve.rates import cut, stretches
from camgeo.curve.sizing import least_arm, least_face, least_stem, stem_needs
from camgeo.curve.undercut.trim import trimmed
from kin.law.sources.lobe import coefficients, lobe

NINE = 1.01e-9


def at(shape, degrees):
    """Point of a shape at a shaft angle."""
    return tuple(shape.sample(np.array([degrees * DEGREE])).point[0])


def passes(shape, table):
    for degrees, point in table.items():
        assert at(shape, degrees) == pytest.approx(point, abs=NINE), degrees


def angle(found):
    return math.degrees(math.atan(found.value)), math.degrees(found.at) % 360


def leans(shape, most, fewest):
    """Greatest and least pressure angle, each with the shaft angle at which it is reached."""
    top, bottom = greatest(shape.slope, stretches(shape)), least(shape.slope, stretches(shape))
    for found, (value, where) in ((top, most), (bottom, fewest)):
        assert found.room < 1e-11
        assert angle(found)[0] == pytest.approx(value, abs=NINE)
        assert angle(found)[1] == pytest.approx(where, abs=1.01e-5)


def bends(shape, value, where=None):
    """Least convex radius of curvature, and where."""
    radius, t = least_radius(Curve.whole(shape))
    assert radius == pytest.approx(value, abs=NINE)
    if where is not None:
        assert math.degrees(t) % 360 == pytest.approx(where, abs=2e-5)


def convex(shape):
    assert least_hollow(Curve.whole(shape))[0] == math.inf


def moments(shape):
    """Area, centroid and polar moment of area by Green's theorem, Gauss's rule on parts of each stretch."""
    node, weight = np.polynomial.legendre.leggauss(24)
    knots = np.concatenate([np.linspace(a, b, 13)[:-1] for a, b in stretches(shape)] + [[stretches(shape)[-1, 1]]])
    half, middle = np.diff(knots)[:, None] / 2, (knots[1:] + knots[:-1])[:, None] / 2
    frame = shape.sample((middle + half * node).ravel())
    x, y = frame.point.T
    swept = (x * frame.tangent[:, 1] - y * frame.tangent[:, 0]) * frame.speed * (half * weight).ravel()
    area = swept.sum() / 2
    return area, (x * swept).sum() / 3 / area, (y * swept).sum() / 3 / area, ((x * x + y * y) * swept).sum() / 4


def test_d01_roller_inline():
    pitch = inline()
    contour = Parallel(pitch, 10.0)
    passes(
        contour,
        {
            0: (40.0, 0.0),
            40: (32.243284932, 30.407499400),
            75: (11.890638728, 53.809381760),
            200: (-56.016149448, -19.542165705),
        },
    )
    leans(pitch, (17.846591833, 55.91628), (-16.811156327, 244.71652))
    bends(pitch, 47.774145953, 85.31561)
    convex(pitch)
    assert moments(contour)[:3] == pytest.approx((8033.402512156, -10.105583694, 5.851681657), abs=NINE)
    assert moments(contour)[3] == pytest.approx(11404218.772426, abs=1.01e-6)


D02 = {
    10.0: (
        [(35.099857550, 8.0), (20.950512624, 43.972948837), (-18.796393123, 56.566348160),
         (-6.459547404, -37.273971964)],
        (14.433626554, 46.60080),
        (-28.395362172, 216.15537),
        (40.661313990, 80.19275),
    ),
    0.0: (
        [(36.0, 0.0), (28.619761001, 39.578764062), (-10.418890660, 59.088465181), (-14.393930664, -35.048356246)],
        (23.443852354, 44.31670),
        (-19.224649073, 213.91811),
        (41.872302078, 84.14863),
    ),
    -10.0: (
        [(35.099857550, -8.0), (35.042806095, 33.514107951), (-1.683998590, 59.583725020),
         (-21.566813415, -31.107490082)],
        (32.277169661, 41.82876),
        (-9.850384833, 211.93806),
        (42.456119582, 87.55612),
    ),
}  # fmt: skip


@pytest.mark.parametrize("eccentricity", D02)
def test_d02_roller_offset(eccentricity):
    points, most, fewest, radius = D02[eccentricity]
    pitch = offset(eccentricity)
    passes(Parallel(pitch, 9.0), dict(zip((0, 50, 100, 250), points, strict=True)))
    leans(pitch, most, fewest)
    bends(pitch, *radius)
    convex(pitch)


def test_d03_flat():
    shape = flat()
    passes(
        shape,
        {
            0: (30.0, 0.0),
            30: (23.025349806, 23.686155976),
            75: (3.947033943, 41.295398337),
            200: (-35.751394420, -0.345556400),
        },
    )
    bends(shape, 16.078192337, 73.66772)
    most = greatest(lambda tau, side=1: rho(shape, tau, side), stretches(shape))
    assert most.value == pytest.approx(55.921807663, abs=NINE)
    assert math.degrees(most.at) == pytest.approx(26.33228, abs=1e-5)
    assert least_face(shape.law, 5.0) == pytest.approx(18.921807663, abs=NINE)
    contact_within(shape, -13.750987083, 13.750987083)
    assert moments(shape)[:3] == pytest.approx((3735.255254814, -3.417610329, 5.881369194), abs=NINE)


def rho(shape, tau, side=1):
    s = shape.law.motion.on(tau, side)
    return s.derivative().derivative() + cut(s, tau.order - 2) + shape.law.base


def contact_within(shape, low, high):
    assert least(shape.law.contact, stretches(shape)).value == pytest.approx(low, abs=NINE)
    assert greatest(shape.law.contact, stretches(shape)).value == pytest.approx(high, abs=NINE)


def test_d04_flat_tilted():
    shape = tilted()
    passes(
        shape,
        {
            0: (31.688578200, 4.453539231),
            30: (21.121061105, 27.811768694),
            75: (-1.541374551, 43.314390519),
            200: (-37.034974844, -6.342082253),
        },
    )
    bends(shape, 18.213678412, 73.66772)
    contact_within(shape, -13.347296574, 13.921113620)


def test_d05_knife_edge():
    shape = knife()
    passes(shape, {0: (30.0, 0.0), 60: (18.125, 31.393420887), 150: (-46.181079661, 26.662658774)})
    leans(shape, (17.104635177, 72.89536), (-17.104635177, 287.10463))
    bends(shape, 40.620192023)
    convex(shape)
    assert moments(shape)[0] == pytest.approx(5919.938656608, abs=NINE)
    assert moments(shape)[0] == pytest.approx(math.pi * (42.5**2 + 12.5**2 / 2), rel=1e-13)


def test_d06_shoe():
    pitch = shoe()
    contour = Parallel(pitch, 60.0)
    passes(contour, {0: (25.0, 0.0), 45: (15.224559802, 28.199761484), 100: (-6.077686218, 34.468271355)})
    leans(pitch, (8.806525542, 44.08779), (-8.806525542, 165.91221))
    bends(pitch, 70.950026472, 63.92119)
    convex(pitch)
    most = greatest(pitch.slope, stretches(pitch)).value
    assert 60.0 * math.sin(math.atan(most)) == pytest.approx(9.185903208, abs=NINE)
    bends(contour, 10.950026472)


D07 = {
    1: (
        [(19.929464286, -27.546623265), (45.778830200, 3.626315467), (2.098936374, 56.463058726),
         (-41.908102248, 6.193082243)],
        (26.412053026, 61.43970),
        (-20.131074515, 233.47143),
        (39.474535506, 195.65896),
    ),
    -1: (
        [(19.929464286, 27.546623265), (-17.753770919, 42.444185068), (-55.240781516, -11.871756067),
         (7.522189541, -41.644236643)],
        (19.736540186, 38.91812),
        (-27.072856175, 215.14439),
        (40.590983394, 86.38714),
    ),
}  # fmt: skip


@pytest.mark.parametrize("side", D07)
def test_d07_arm(side):
    points, most, fewest, radius = D07[side]
    pitch = arm(side)
    assert math.degrees(pitch.guide.rest) == pytest.approx(31.568024019, abs=NINE)
    passes(Parallel(pitch, 8.0), dict(zip((0, 55, 140, 230), points, strict=True)))
    leans(pitch, most, fewest)
    bends(pitch, *radius)


D08 = {
    1: (
        [(18.4, -30.942527369), (41.284472259, 5.821538215), (16.076865482, 46.005775068),
         (-31.907080462, 35.804798487)],
        (25.986558731, 194.90677),
        (61.897303035, 87.342340440),
        9.177290294,
        12.013441269,
    ),
    -1: (
        [(18.4, 30.942527369), (-24.277854745, 35.165235268), (-47.880602671, 9.079913614),
         (-28.391595394, -38.480361552)],
        (22.452191379, 81.60162),
        (62.354139715, 88.329867246),
        9.111184849,
        15.547808621,
    ),
}  # fmt: skip


@pytest.mark.parametrize("side", D08)
def test_d08_arm_flat(side):
    points, radius, reach, lean, base = D08[side]
    shape = swinging(side)
    assert math.degrees(shape.law.rest) == pytest.approx(30.737868672, abs=NINE)
    passes(shape, dict(zip((0, 50, 120, 190), points, strict=True)))
    bends(shape, *radius)
    contact_within(shape, *reach)
    assert angle(greatest(shape.law.slope, stretches(shape)))[0] == pytest.approx(lean, abs=NINE)
    assert least_face(shape.law, 2.0) == pytest.approx(base, abs=NINE)


def test_d10_internal():
    opening = Parallel(inline(), -10.0)
    passes(opening, {0: (60.0, 0.0), 40: (50.351660922, 38.897889203), 200: (-74.206685964, -27.855070207)})
    assert moments(opening)[0] == pytest.approx(15665.460508015, abs=NINE)


def test_d13_matched():
    motion = segments((6, 40, 5), (18, 60, "constant-velocity"), (6, 40, 5), (40,), (-30, 120, "polynomial-345"), (60,))
    s = Displacement.of(motion)
    rows = {
        10: (0.164062500, 2.685739665, 27.698678578),
        20: (1.125, 8.594366927, 36.931571438),
        30: (3.164062500, 14.502994189, 27.698678578),
        70: (15.0, 17.188733854, 0.0),
        120: (28.875, 8.594366927, -36.931571438),
    }
    for degrees, row in rows.items():
        assert tuple(s.derivatives(np.array([degrees * DEGREE]), 2)[:, 0]) == pytest.approx(row, abs=NINE)
    bend = greatest(lambda tau, side=1: s.on(tau, side).derivative().derivative(), stretches(s))
    assert bend.value == pytest.approx(39.486023539, abs=NINE)
    assert math.degrees(bend.at) == pytest.approx(274.64102, abs=1e-5)
    assert greatest(lambda tau, side=1: s.on(tau, side).derivative(), stretches(s)).value == pytest.approx(
        17.188733854, abs=NINE
    )
    pitch = CentreShape(s, Translating.on(60.0))
    passes(Parallel(pitch, 10.0), {20: (47.657108427, 18.827461984), 70: (20.218549394, 62.081535258)})
    leans(pitch, (14.637030515, 38.74881), (-20.030553560, 245.67548))
    bends(pitch, 60.0)
    convex(pitch)


def test_d14_valve_flat():
    powers = (2, 8, 14, 20, 26)
    assert coefficients(powers) == pytest.approx(
        (-1.872427984, 1.872427984, -1.604938272, 0.748971193, -0.144032922), abs=NINE
    )
    s = Displacement.of(lobe(8.0, 68 * DEGREE, powers))
    for degrees, value in {0: 8.0, 20: 6.705040433, 45: 1.952853268}.items():
        assert s.derivatives(np.array([degrees * DEGREE]), 0)[0, 0] == pytest.approx(value, abs=NINE)
    for height, crank in {0.1524: 231.385517089, 1.27: 194.148296112}.items():
        low, high = 1e-3, 68 * DEGREE
        for _ in range(60):
            middle = 0.5 * (low + high)
            above = s.derivatives(np.array([middle]), 0)[0, 0] > height
            low, high = (middle, high) if above else (low, middle)
        assert math.degrees(4 * low) == pytest.approx(crank, abs=NINE)
    shape = face_shape(StraightFace(s, 18.0))
    most = greatest(shape.law.contact, stretches(shape))
    assert (most.value, math.degrees(most.at) % 360) == pytest.approx((12.538158514, 320.23336), abs=1e-5)
    assert 2 * most.value == pytest.approx(25.076317029, abs=NINE)
    radius, where = least_radius(Curve.whole(shape))
    assert radius == pytest.approx(3.816408204, abs=NINE)
    assert min(math.degrees(where) % 360, -math.degrees(where) % 360) == pytest.approx(20.58289, abs=2e-5)
    widest = greatest(lambda tau, side=1: rho(shape, tau, side), stretches(shape))
    assert widest.value == pytest.approx(66.003869437, abs=NINE)
    pitch = CentreShape(s, Translating.on(27.0))
    passes(
        Parallel(pitch, 9.0),
        {0: (26.0, 0.0), 20: (24.072694423, 6.706515286), 45: (16.971749157, 12.181623197)},
    )
    leans(pitch, (22.761742699, 318.51946), (-22.761742699, 41.48054))
    bends(pitch, 20.996320969)
    hollow, where = least_hollow(Curve.whole(pitch))
    assert hollow == pytest.approx(42.609351862, abs=NINE)
    assert min(math.degrees(where) % 360, -math.degrees(where) % 360) == pytest.approx(55.95494, abs=2e-5)
    assert least_hollow(Curve.whole(Parallel(pitch, 9.0)))[0] == pytest.approx(51.609351862, abs=NINE)
    wheel = complex(*at(Parallel(pitch, 9.0 - 40.0), 20))
    assert (abs(wheel), math.degrees(np.angle(wheel))) == pytest.approx((64.327771035, 25.935624732), abs=NINE)


def test_d15_undercut():
    pitch = CentreShape(M15, Translating.on(26.0))
    radius, where = least_radius(Curve.whole(pitch))
    assert radius == pytest.approx(14.113168077, abs=NINE)
    around = {math.degrees(where) % 360, (130 - math.degrees(where)) % 360}
    assert min(around) == pytest.approx(47.02197, abs=2e-5)
    kept = trimmed(Curve.whole(Parallel(pitch, 18.0)))
    ends = np.array(
        [(run.high, after.low) for run, after in zip(kept.runs, (*kept.runs[1:], kept.runs[0]), strict=True)]
    )
    ends = np.degrees(ends) % 360
    ends = ends[np.argsort(ends[:, 0])]
    cuts = np.array([[32.610239345, 59.535503075], [70.464496925, 97.389760655]])
    assert ends == pytest.approx(cuts, abs=NINE)
    corners = {0: (14.188473171, 24.138848564), 1: (9.371256051, 26.385153798)}
    for row, place in corners.items():
        assert at(kept, cuts[row, 0]) == pytest.approx(place, abs=1e-8)  # the angle is printed with nine digits
        lost, theta = lost_lift(complex(*place), np.linspace(*(cuts[row] * DEGREE), 200_001))
        assert lost == pytest.approx(0.517693640, abs=1e-8)
        assert math.degrees(theta) == pytest.approx((45.8265, 84.1735)[row], abs=2e-4)
    # the raw offset with its swallowtail lifts the roller
    raw = Parallel(pitch, 18.0).sample(np.linspace(0, 130, 130_001) * DEGREE).point
    corner = raw[:, 0] + 1j * raw[:, 1]
    theta = 29.5513 * DEGREE
    seen = corner * np.exp(-1j * theta)
    high = (seen.real + np.sqrt(18.0**2 - np.minimum(seen.imag**2, 18.0**2))).max()
    assert high - 26.0 - M15.derivatives(np.array([theta]), 0)[0, 0] == pytest.approx(1.737170, abs=1e-5)


def lost_lift(corner, theta):
    """Greatest lift that a roller of 18 mm sitting on a corner lacks over shaft angles, and where."""
    seen = corner * np.exp(-1j * theta)
    lost = 26.0 + M15.derivatives(theta, 0)[0] - (seen.real + np.sqrt(18.0**2 - seen.imag**2))
    return lost.max(), theta[np.argmax(lost)]


def test_d16_sizing():
    limits = (30 * DEGREE, 45 * DEGREE)
    assert stem_needs(M02, *limits) == pytest.approx((31.499209525, 9.603238312), abs=NINE)
    stem = least_stem(M02, *limits)
    assert (stem.prime, stem.offset, stem.foot) == pytest.approx((19.354998723, 8.014481704, 17.617720017), abs=NINE)
    assert least_stem(M02, *limits, offset=0.0).prime == pytest.approx(31.499209525, abs=NINE)
    leans_of(CentreShape(M02, stem), 30.0, -45.0, 1e-9)
    sizes = {1: (16.727263336, 72.169575733, 12.668363853), -1: (16.273179510, 66.057520228, 14.235604064)}
    for side, (prime, pivot, rest) in sizes.items():
        found = least_arm(M07, 65.0, side, 35 * DEGREE, 45 * DEGREE)
        assert found.prime == pytest.approx(prime, abs=1e-6)
        assert (found.pivot, math.degrees(found.rest)) == pytest.approx((pivot, rest), abs=1e-6)
        leans_of(CentreShape(M07, found), 35.0, -45.0, 1e-6)


def leans_of(pitch, most, fewest, within):
    assert angle(greatest(pitch.slope, stretches(pitch)))[0] == pytest.approx(most, abs=within)
    assert angle(least(pitch.slope, stretches(pitch)))[0] == pytest.approx(fewest, abs=within)
