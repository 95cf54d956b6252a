"""A roller on smooth surfaces: bounds against positions alone, on surfaces made here, sound and bent by chance.

Holds: kin.cylindrical.exact, kin.cylindrical.smooth.
"""

import math
from itertools import pairwise, product

import numpy as np
import pytest
from capabilities.cylindrical.kin.drums import Arm, Drum, End, Groove, Motion, Rib, distances, replace, resting

from kin.cylindrical import smooth
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.smooth import Smooth, demand_regular, look
from kin.numeric.errors import UnsettledError

TURN = 2.0 * math.pi
THIRDS = np.linspace(0.0, 1.0, 4)
BERNSTEIN = np.stack([math.comb(3, k) * THIRDS**k * (1.0 - THIRDS) ** (3 - k) for k in range(4)], axis=1)
INVERSE = np.linalg.inv(BERNSTEIN)
COARSE = Drum(track=Groove(12.5, 0.05))


def fitted(drum, flank, columns=60, rows=3, *, breaks=True, own=slice(None)):
    """A flank as bicubic patches through 4 by 4 exact places each, with columns at breaks unless these are left out.

    `own` chooses from the patches, which go on by rows in each column.
    """
    more = drum.motion.breaks if breaks else []
    knots = np.unique(np.concatenate([np.arange(columns) * (TURN / columns), more]))
    knots = np.append(knots[np.append(np.diff(knots) > 1e-6, True)], TURN)
    r = np.linspace(drum.floor, drum.radius, rows + 1)
    nets, lines = [], []
    for (low, high), k in list(product(pairwise(knots), range(rows)))[own]:
        theta = low + (high - low) * THIRDS
        radii = r[k] + (r[k + 1] - r[k]) * THIRDS
        phi, z = drum.touched(theta, radii, *flank[1:])
        places = np.stack([radii * np.cos(phi), radii * np.sin(phi), z], axis=-1)
        nets.append(np.einsum("ai,bj,ijx->abx", INVERSE, INVERSE, places))
        lines.append((k / rows, (k + 1) / rows))
    return Smooth(np.array(nets), np.array(lines))


def places_on(surface, count, chance):
    """Places (n, 3) on all patches, on their edges and within."""
    share = np.concatenate([[0.0, 1.0], chance.uniform(0.0, 1.0, count - 2)])
    basis = np.stack([math.comb(3, k) * share**k * (1.0 - share) ** (3 - k) for k in range(4)], axis=1)
    return np.einsum("ia,jb,nabx->nijx", basis, basis, surface.nets).reshape(-1, 3)


UNLIKE = ((25.0, 100.0, "harmonic"), (-25.0, 150.0, "polynomial-4567"), (0.0, 110.0, ""))
DRUMS = {
    "groove": COARSE,
    "rib": Drum(track=Rib(12.0, 50.0), level=40.0, length=125.0, inner=38.5),
    "top": Drum(Motion(UNLIKE), track=End("top", 12.5)),
}
SWING = math.radians(30.0)
LOW = 80.0 * math.sin(0.5 * SWING)
ARM = replace(
    COARSE,
    motion=Motion(((SWING, 120.0, "cycloidal"), (0.0, 60.0, ""), (-SWING, 120.0, "polynomial-345"), (0.0, 60.0, ""))),
    level=40.0 - LOW,
    arm=Arm(80.0, 78.0, 40.0, 1),
)
LED = {
    "arm": ARM,
    "cone on an arm": replace(ARM, arm=Arm(80.0, -78.0, 40.0, -1), taper=math.radians(6.0)),
    "cone beside the axis": replace(COARSE, offset=-5.0, taper=math.atan(10.0 / 44.0)),
    "rib on an arm": replace(
        ARM, track=Rib(12.0, 36.0), level=52.0 - LOW, length=104.0, arm=Arm(80.0, 78.0, 52.0, 1), inner=38.5
    ),
    "beside": replace(DRUMS["top"], offset=6.0),
}
DRUMS |= LED


@pytest.mark.slow
@pytest.mark.parametrize("bend", [0.0, 4e-3], ids=["sound", "bent"])
@pytest.mark.parametrize("kind", DRUMS)
def test_what_stands_out_is_missing_and_holds(kind, bend):
    """Nothing found by positions is beyond what is proved, and what is reached is found by positions nearly so."""
    drum, chance, tolerance = DRUMS[kind], np.random.default_rng(7), 0.01
    for gauge, flank in list(zip(gauges_of(drum.intent()), drum.flanks, strict=True))[-1:]:
        surface = fitted(drum, flank)
        nets = surface.nets.copy()
        nets[:, 1:3, 1:3, 2] += bend * chance.uniform(-1.0, 1.0, nets[:, 1:3, 1:3, 2].shape)
        surface = Smooth(nets, surface.lines)
        seen = look(gauge, [surface], tolerance, 720)
        points = places_on(surface, 4, chance)
        away, height = distances(drum, points, flank)
        height = height * gauge.lever
        assert seen.bare.value - 0.15 * tolerance <= away.max() <= seen.bare.value + seen.bare.remainder + 1e-9
        assert seen.proud.value - 0.15 * tolerance <= -away.min() <= seen.proud.value + seen.proud.remainder + 1e-9
        for peak in (seen.bare, seen.proud, seen.out):
            assert peak.remainder < 0.1 * tolerance
        # the roller reaches with its length what is so far out
        inside = np.hypot(*points[:, :2].T) >= drum.inner + (1.0 if drum.plain else 3.0)
        assert height[inside].max() <= seen.out.value + seen.out.remainder + 1e-9
        theta = np.linspace(0.0, TURN, 9)[:-1]
        held = resting(drum, places_on(surface, 40, chance), theta, flank) * gauge.lever
        # places so close to one another are lower than the surface by their distance squared over the roller's diameter
        assert seen.least.value - seen.least.remainder <= held.min() + 1e-3
        assert np.abs(held - seen.holds[::90]).max() < 1e-3


@pytest.mark.costly("positions at all angles of places within cells")
@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("kind", "shaken"),
    [("groove", 0.03), ("top", 0.03), ("groove", 0.002), ("top", 0.0)]
    + [(kind, shaken) for kind in LED for shaken in (0.03, 0.002)]
    + [("beside", 0.0)],
)
def test_bounds_hold_within_cells_and_are_not_idle(kind, shaken):
    """H and K leave the bilinear by no more than is said, F rises above H and the depth above -K by no more either.

    The way that the roller gives along its path lies between bounds that follow from H.
    """
    drum = DRUMS[kind]
    flank, gauge = drum.flanks[0], gauges_of(drum.intent())[0]
    side, level, cosine = flank[1], flank[3], math.cos(drum.taper)
    finer, own = (1, slice(None, None, 11)) if drum.plain else (4, slice(None, None, 89))
    if not shaken:  # about 100 degrees, where the acceleration jumps between two columns
        own = slice(92, 112)
    surface = fitted(drum, flank, columns=90 * finer if shaken else 91, rows=4, breaks=shaken > 0.0, own=own)
    chance = np.random.default_rng(2)
    nets = surface.nets + shaken * chance.uniform(-1.0, 1.0, surface.nets.shape)
    cells = smooth._measured(gauge, nets, surface.lines)
    bounds = smooth._bounds(gauge, cells, 0.01 + 6.0 * shaken)
    share = np.array([0.0, 0.15, 0.4, 0.5, 0.6, 0.85, 1.0])
    count = len(share)
    basis = np.stack([math.comb(3, k) * share**k * (1.0 - share) ** (3 - k) for k in range(4)], axis=1)
    places = np.einsum("ia,jb,nabx->nijx", basis, basis, nets)
    linear = np.stack([1.0 - share, share], axis=1)
    theta, height, distance = (
        np.einsum("ia,jb,nab->nij", linear, linear, part) for part in (cells.theta, cells.height, cells.distance)
    )
    x, y, z = np.moveaxis(places, 3, 0)
    along, across = x * np.cos(theta) + y * np.sin(theta), y * np.cos(theta) - x * np.sin(theta)
    y0, z0 = drum.axis(theta, level)
    beside, v, size = across - y0, side * (z0 - z), drum.size(flank[2], along)
    upright, away = v + np.sqrt(size**2 - beside**2), (np.hypot(beside, v) - size) * cosine
    for found, said, bound in ((upright, height, bounds.height), (away, distance, bounds.distance)):
        off = np.abs(found - said).max(axis=(1, 2))
        assert (off <= bound + 1e-9).all()
        assert (off > 0.05 * bound).mean() > 0.5 or shaken < 0.01
    assert (bounds.along[0] <= along.min(axis=(1, 2)) + 1e-9).all()
    assert (along.max(axis=(1, 2)) <= bounds.along[1] + 1e-9).all()
    points = places.reshape(-1, 3)
    nearest, most = (row.reshape(len(nets), count, count) for row in distances(drum, points, flank))
    # F: how far the roller would give way along z
    risen = distances(drum, points, flank, highest=True) - side * points[:, 2]
    risen = risen.reshape(len(nets), count, count)
    given = drum.gives(theta, (along, across, z), flank[2], side, level) * gauge.lever
    known = np.isfinite(bounds.gap) & (bounds.path[0] > 0.0)
    assert known.mean() > 0.3 or shaken > 0.01
    low = bounds.given(upright.min(axis=(1, 2)))[0]
    high = bounds.given(risen.max(axis=(1, 2)))[1]
    assert (low <= given.min(axis=(1, 2)) + 1e-9).all()
    assert (most.max(axis=(1, 2)) * gauge.lever <= high + 1e-9).all()
    if known.any():
        assert (high - most.max(axis=(1, 2)) * gauge.lever)[known].max() < 0.1 * np.abs(given).max() + 1e-9
    for over, bound in ((risen - upright, bounds.gap), (away - nearest, bounds.under)):
        assert (over.max(axis=(1, 2)) <= bound + 1e-9).all()
        assert np.isfinite(bound).mean() > 0.3 or shaken > 0.01


@pytest.fixture(scope="module")
def sound():
    """The gauge of c01's lower flank, and its surface."""
    return gauges_of(COARSE.intent())[0], fitted(COARSE, COARSE.flanks[0], columns=45)


def test_patches_may_run_either_way_and_in_any_order(sound):
    gauge, surface = sound
    seen = look(gauge, [surface], 0.02, 360)
    order = np.random.default_rng(3).permutation(len(surface.nets))
    turned = Smooth(surface.nets[order, ::-1, ::-1], 1.0 - surface.lines[order, ::-1])
    other = look(gauge, [turned], 0.02, 360)
    for name in ("out", "least", "proud", "bare"):
        assert getattr(other, name)[:2] == pytest.approx(getattr(seen, name)[:2], abs=1e-9)
    assert other.holds == pytest.approx(seen.holds, abs=1e-9)


def test_a_surface_with_a_gap_holds_no_roller_all_the_way(sound):
    gauge, surface = sound
    assert look(gauge, [surface], 0.02, 360).least.remainder < 0.02
    turned = np.arctan2(surface.nets[:, 0, 0, 1], surface.nets[:, 0, 0, 0])
    kept = ~((turned > 1.0) & (turned < 1.2))
    gone = look(gauge, [Smooth(surface.nets[kept], surface.lines[kept])], 0.02, 360)
    assert math.isinf(gone.least.remainder)


@pytest.mark.parametrize(("lift", "off"), [(0.01, 0.01), (-0.01, 0.01), (0.3, 0.3)])
def test_a_surface_that_is_shifted_along_the_axis(sound, lift, off):
    gauge, surface = sound
    seen = look(gauge, [Smooth(surface.nets + np.array([0.0, 0.0, lift]), surface.lines)], 0.001, 360)
    stands, lacks = (seen.proud, seen.bare) if lift > 0.0 else (seen.bare, seen.proud)
    # in dwells the flank is level
    assert stands.value == pytest.approx(off, abs=2e-3)
    assert lacks.value < 2e-3
    assert seen.holds == pytest.approx(np.full(360, lift), abs=2e-3)


def test_a_flank_is_proved_regular_as_far_as_it_is():
    """In c05 the lower flank is undercut below rho = 29.1005 mm, which is r = 30 on the roller's ray."""
    parts = ((15.0, 60.0, "cycloidal"), (0.0, 120.0, ""), (-15.0, 60.0, "cycloidal"), (0.0, 120.0, ""))
    drum = Drum(Motion(parts), roller=12.0, radius=40.0, inner=20.5, outer=40.0, track=Groove(20.0))
    gauge = gauges_of(drum.intent())[0]
    demand_regular(gauge, 30.6, 40.0)
    with pytest.raises(UnsettledError, match="not proved regular"):
        demand_regular(gauge, 28.0, 40.0)
