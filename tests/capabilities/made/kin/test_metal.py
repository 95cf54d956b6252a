"""Contact on metal that is not the exact contour, against brute force on polygons of 400 000 corners.

The digits are those of worked cases which share no code with this: bumps and dents e(t) = A exp(-((t - 60 deg)/w)^2/2)
along the normal, a bore that is not on the profile's centre, a frame whose opposite faces meet different metal.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from support.disc_followers import FOLLOWERS
from support.measured import RECIPES, surfaces

from kin.made.metal import Metal
from kin.made.smooth import fit

AT = np.radians(60.0)


def bump(height, width, at=AT):
    w = np.radians(width)

    def deviation(t):
        d = np.mod(t - at + np.pi, 2.0 * np.pi) - np.pi
        e = height * np.exp(-0.5 * (d / w) ** 2)
        return np.stack([e, -d / w**2 * e])

    return deviation


def error(follower, deviation, degrees, **fine):
    shaft = np.radians(np.asarray(degrees, dtype=float))
    metal = Metal.of(follower, 1, deviation, **fine)
    return metal.positions(shaft)[0][0] - follower.intended(shaft)


def extreme(follower, deviation, **fine):
    """Greatest error of the motion about 60 degrees, looked for ever more closely: leaping contacts make a corner."""
    at, reach = 60.0, 1.0
    for _ in range(4):
        degrees = np.linspace(at - reach, at + reach, 2001)
        off = error(follower, deviation, degrees, **fine)
        at, reach = degrees[int(np.argmax(np.abs(off)))], reach / 100.0
    return off[int(np.argmax(np.abs(off)))], at


BUMPS = {  # follower, height, width in degrees: greatest error of the motion, at, and errors elsewhere
    ("roller, offset", 0.010, 3.0): (0.0102190730, 59.98606, {58.0: 0.008222701, 59.5: 0.010087194, 62.0: 0.008173545}),
    ("roller, offset", 0.010, 0.3): (0.0102189940, 59.99779, {58.0: 0.0, 59.5: 0.004141212, 62.0: 0.0}),
    ("roller, offset", -0.010, 3.0): (-0.0102191186, 59.99024, {58.0: -0.008184274, 62.0: -0.008147692}),
    ("roller, offset", -0.010, 0.3): (-0.0101824710, 60.00199, {58.0: 0.0, 59.5: -0.001894651, 62.0: 0.0}),
    ("roller, offset", -0.010, 0.15): (-0.0057933744, 60.00123, {58.0: 0.0, 59.5: -0.000036332, 62.0: 0.0}),
    ("flat", 0.010, 3.0): (0.0100000000, 60.0, {}),
    ("flat", 0.010, 1.0): (0.0100000000, 60.0, {}),
    ("flat", -0.010, 3.0): (-0.0100000000, 60.0, {}),
    ("flat", -0.010, 1.0): (-0.0095763406, 59.99056, {}),
    ("flat", -0.010, 0.5): (-0.0049039692, 59.98753, {}),
}
FLAT = {
    (0.010, 3.0): (0.002606832, 0.008196069, 0.009529414),
    (0.010, 1.0): (0.000000037, 0.002402469, 0.007972056),
    (-0.010, 3.0): (-0.002392826, -0.007796420, -0.009367247),
    (-0.010, 1.0): (-0.000000037, -0.001042566, -0.003999688),
    (-0.010, 0.5): (0.0, -0.000003310, -0.000647070),
}


@pytest.mark.thin(6)
@pytest.mark.parametrize("case", list(BUMPS))
def test_bumps_and_dents_move_the_follower_as_contact_has_it(case):
    kind, height, width = case
    follower, deviation, fine = FOLLOWERS[kind], bump(height, width), {"finest": round(360.0 / width)}
    worst, at, elsewhere = BUMPS[case]
    found, where = extreme(follower, deviation, **fine)
    leaps = height < 0.0 and kind.startswith("roller") and width < 1.0  # its corner was sampled, 1e-7 degrees beside it
    assert found == pytest.approx(worst, abs=1e-8 if leaps else 1e-9)
    assert where == pytest.approx(at, abs=2e-4)
    if elsewhere:
        assert error(follower, deviation, list(elsewhere), **fine) == pytest.approx([*elsewhere.values()], abs=1e-9)


@pytest.mark.parametrize("case", list(FLAT))
def test_a_flat_face_bridges_dents(case):
    deviation = bump(*case)
    found = error(FOLLOWERS["flat"], deviation, [55.0, 58.0, 61.0], finest=round(360.0 / case[1]))
    assert found == pytest.approx(FLAT[case], abs=1e-9)


SHIFTED = {  # metal shifted by 20 um along +x: error at 45.5 and 135.5 degrees, greatest and least, at
    "roller, offset": (0.0176826835, -0.0163317878, 0.0205123188, 347.5, -0.0206558464, 168.5),
    "trailing arm": (0.0002919128, 0.0000365081, 0.0003422028, 68.5, -0.0003186216, 218.5),
    "flat, tilted": (0.0120133690, -0.0162351364, 0.0201957824, 351.5, -0.0201957824, 171.5),
    "trailing face": (0.0002989677, 0.0000192382, 0.0003178172, 60.5, -0.0002333899, 250.5),
}


@pytest.mark.parametrize("kind", list(SHIFTED))
def test_a_bore_off_the_profile_moves_every_follower(kind):
    """The shifted contour is written as deviation along the normals of the one that is meant: by its own feet."""
    follower = FOLLOWERS[kind]
    tau = np.radians(np.arange(0.0, 360.0, 0.125))
    moved = follower.envelope.points(tau) + np.array([0.020, 0.0])
    feet = follower.envelope.feet(moved)
    curve = fit(feet.parameter, feet.excess, 576).curve
    shaft = np.radians(np.arange(360) + 0.5)
    off = Metal.of(follower, 1, lambda t: curve.rows(t, 1), curve.spans).positions(shaft)[0][0] - follower.intended(
        shaft
    )
    first, second, most, most_at, least, least_at = SHIFTED[kind]
    assert (off[45], off[135]) == pytest.approx((first, second), abs=1e-8)
    assert (off.max(), off.min()) == pytest.approx((most, least), abs=1e-8)
    assert (np.argmax(off) + 0.5, np.argmin(off) + 0.5) == pytest.approx((most_at, least_at), abs=1.0)


@pytest.mark.parametrize("kind", list(FOLLOWERS))
def test_metal_as_meant_moves_every_follower_as_meant(kind):
    follower = FOLLOWERS[kind]
    side = -1 if kind.startswith("ring") else 1
    shaft = np.radians(np.linspace(0.0, 360.0, 321))
    metal = Metal.of(follower, side, lambda t: np.zeros((2, len(t))))
    positions, _ = metal.positions(shaft)
    assert positions[0] == pytest.approx(follower.intended(shaft), abs=1e-11)


def all_round(off, t):
    return np.stack([np.full_like(t, off), np.zeros_like(t)])


@pytest.mark.thin(2)
@pytest.mark.parametrize("kind", list(FOLLOWERS))
def test_metal_too_much_lifts_every_follower_by_what_first_order_says(kind):
    """Greater deviation e moves a follower away from the metal by e/K, K the rate of the normal over the motion."""
    follower, e = FOLLOWERS[kind], 1e-4
    side = -1 if kind.startswith("ring") else 1
    shaft = np.radians(np.linspace(3.0, 363.0, 200, endpoint=False))
    each = []
    for off in (e, 0.0, -e):
        metal = Metal.of(follower, side, partial(all_round, off))
        each.append(metal.positions(shaft)[0][0])
    up, down = each[0] - each[1], each[2] - each[1]
    assert (side * up > 0.0).all()
    assert up == pytest.approx(-down, rel=1e-3)
    limit = follower.motion_limit(e)
    assert np.abs(up).max() <= (np.radians(limit) if follower.unit == "deg" else limit) * (1.0 + 1e-6)


@pytest.mark.slow
def test_a_face_turns_on_the_corner_that_a_jump_of_curvature_leaves() -> None:
    """Radii of 45 and 5 mm meet: a smooth deviation makes a corner, on which the face stays for a tenth of a degree."""
    ((_, _, surface),) = surfaces(RECIPES["yoke"])
    follower = surface.gauge
    breaks = follower.envelope.breaks
    metal = Metal.of(follower, 1, lambda t: np.stack([0.02 * np.sin(3.0 * t + 0.4), 0.06 * np.cos(3.0 * t + 0.4)]))
    dense = np.concatenate([np.linspace(0.0, 2.0 * np.pi, 400_001), breaks])
    points = metal.surface(dense)[0]
    shaft = (breaks[:, None] + np.radians(np.linspace(-0.4, 0.4, 41))).ravel()
    turns = []
    for contact, positions in enumerate(metal.positions(shaft)[0]):
        (first, second), base = follower.touching(np.zeros((2, 2)), np.eye(2))[contact]
        outwards = follower.touching(np.eye(2), np.eye(2))[contact][1] - base
        normal = round(np.sin(second - first)) * (shaft - first)
        reach = [(points @ np.array([np.cos(angle), np.sin(angle)])).max() for angle in normal]
        assert np.abs(positions - base[0] - outwards[0] * np.array(reach)).max() < 1e-8
        before, after = (follower.touching(metal.corners.points, side)[contact][0] for side in metal.corners[2:])
        turns.append(np.abs(np.degrees(after - before)).max())
    assert min(turns) > 0.1
