"""The keys by which recipes of a family give size and motion are keys of its table."""

import pytest

from camgeo.cams.families import FAMILIES
from camgeo.motions.by_motion import ByMotion


@pytest.mark.parametrize("kind", FAMILIES)
def test_keys_by_motion_are_keys_of_the_family(kind):
    family = FAMILIES[kind]
    keys, by_motion = {field.name for field in family.table.fields}, family.by_motion
    assert isinstance(by_motion, ByMotion)
    paths = {by_motion.motion, by_motion.base, by_motion.still[0]} - {""}
    assert {path.partition(".")[0] for path in paths} <= keys
    assert by_motion.motion not in by_motion.instead
    assert 0.0 <= by_motion.lag <= 1.0
