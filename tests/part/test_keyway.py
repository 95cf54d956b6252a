"""A keyway: sizes by the bore or its own, the outline that it makes of the bore, and what is refused."""

import math

import pytest
from support.parts import recipe_of

from camgeo.part.keyway import FEATURE, Keyway
from camgeo.part.part import build_part
from camgeo.schema.errors import RecipeErrors


def test_the_standard_gives_the_sizes_of_the_bore():
    part = build_part({"bore": 20.0, "keyway": {"standard": "din6885", "at": 0.5}})
    assert part.of(Keyway) == Keyway(6.0, 2.8, 0.5, standard=True)
    own = build_part({"bore": 20.0, "keyway": {"width": 5.0, "depth": 2.0}})
    assert own.of(Keyway) == Keyway(5.0, 2.0)


def test_it_reaches_its_depth_beyond_the_bore():
    outline = FEATURE.bore(Keyway(6.0, 2.8, math.pi / 2), 10.0)
    _, _, x_max, y_max = outline.box()
    assert [x_max, y_max] == pytest.approx([10.0, 12.8])


@pytest.mark.parametrize(
    ("part", "problem"),
    [
        ("{keyway: din6885}", r"part\.keyway: needs part\.bore"),
        ("{bore: 5, keyway: din6885}", r"part\.keyway: no key of DIN 6885 for this bore"),
        ("{bore: 12, keyway: {width: 12, depth: 2}}", r"part\.keyway\.width: not below the bore's diameter"),
        ("{bore: 12, keyway: din6886}", r"part\.keyway: unknown keyway"),
    ],
)
def test_what_is_no_keyway_is_refused(part, problem):
    with pytest.raises(RecipeErrors, match=problem):
        recipe_of(part)


def test_a_standard_one_is_said_to_be_metric():
    assert FEATURE.metric(Keyway(6.0, 2.8, standard=True)).startswith("metric keyway of DIN 6885, 6 mm wide")
    assert FEATURE.metric(Keyway(6.0, 2.8)) == ""
