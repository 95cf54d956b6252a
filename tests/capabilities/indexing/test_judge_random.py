"""Random indexing cams: the volume that rollers leave, by stretches of heights and by the distance of points."""

import math

import numpy as np
import pytest
from capabilities.indexing.turrets import GLOBOID, Barrel, Globoid, Turret, changed
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from kin.indexing.rollers import Rollers
from kin.indexing.volume import exact_volume


@st.composite
def turrets(draw):
    """Barrels and globoids of 7 to 10 rollers that leave a rib between them, long enough that two of them are led."""
    stops = draw(st.integers(7, 10))
    over = math.radians(draw(st.floats(150.0, 240.0)))
    start = draw(st.floats(-1.0, 1.0))
    arm = draw(st.floats(50.0, 70.0))
    roller = arm * math.sin(math.pi / stops) * draw(st.floats(0.35, 0.5))
    clearance = draw(st.sampled_from([0.0, 0.02, -0.02]))
    if draw(st.booleans()):
        turret = changed(
            GLOBOID, form=Globoid(arm, 10.0, arm + 35.0), roller=0.8 * roller, length=arm, height=0.5 * arm
        )
        turret = changed(turret, inner=arm, outer=arm + 9.5)
    else:
        sense = draw(st.sampled_from([1, -1]))
        offset = sense * arm * 0.5 * (1.0 + math.cos(math.pi / stops))
        turret = changed(Turret(), form=Barrel(45.0, 10.0, offset, arm, sense), roller=roller, length=1.3 * arm)
        turret = changed(turret, inner=35.5, outer=45.0, height=0.67 * arm)
    return changed(turret, stops=stops, over=over, start=start, clearance=clearance)


@pytest.mark.slow
@settings(max_examples=3, deadline=None, suppress_health_check=list(HealthCheck))
@given(turrets(), st.integers(0, 10**6))
def test_what_is_swept_is_what_rollers_reach(turret, seed):
    """The volume's stretches of heights against the distance of points from all rollers."""
    rollers = Rollers(turret.intent, 1e-3)
    rng = np.random.default_rng(seed)
    count = 4000
    low, high = turret.intent.ends
    z, phi = rng.uniform(low, high, count), rng.uniform(0.0, 2.0 * math.pi, count)
    r = rng.uniform(0.0, rollers.farthest, count)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    depth = turret.form.depth_of(r, z)
    metal = (depth > 0.0) & ((depth > turret.form.depth) | (rollers.worst(points).excess > 0.0))
    # points are as dense as 1/r: each counts for r
    whole = 2.0 * math.pi * rollers.farthest * turret.length
    found = whole * float((metal * r).mean())
    spread = whole * float((metal * r).std()) / math.sqrt(count)
    bore = math.pi * 0.25 * turret.bore**2 * turret.length
    assert abs(exact_volume(rollers).value - (found - bore)) < 4.5 * spread
