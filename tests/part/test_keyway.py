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


@pytest.mark.parametrize(
    ("bore", "fit", "wider", "deeper"),
    [
        # widths 2, 5, 6, 8, 20, 36 and 50 mm: ISO 286-2, micrometres; depths t2 of DIN 6885-1
        (7.0, "P9", (-31, -6), 0.1),
        (16.0, "P9", (-42, -12), 0.1),
        (16.0, "JS9", (-15, 15), 0.1),
        (22.0, "P9", (-42, -12), 0.1),
        (22.5, "P9", (-51, -15), 0.2),
        (70.0, "JS9", (-26, 26), 0.2),
        (140.0, "P9", (-88, -26), 0.3),
        (230.0, "JS9", (-31, 31), 0.3),
    ],
)
def test_a_class_gives_the_deviations_of_width_and_depth(bore, fit, wider, deeper):
    keyway = build_part({"bore": bore, "keyway": {"standard": "din6885", "fit": fit}}).of(Keyway)
    assert [1000.0 * deviation for deviation in keyway.wider] == pytest.approx(wider)
    assert keyway.deeper == deeper


def test_files_have_the_nominal_size_of_a_keyway_with_a_class():
    plain, fitted = (recipe_of(f"{{bore: 16, keyway: {{standard: din6885{fit}}}}}") for fit in ("", ", fit: P9"))
    assert (
        FEATURE.bore(fitted.part.of(Keyway), 8.0).points.tolist()
        == FEATURE.bore(plain.part.of(Keyway), 8.0).points.tolist()
    )


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
        ("{bore: 12, keyway: {standard: din6885, fit: p9}}", r"part\.keyway\.fit: not one of the choices.*P9"),
        (
            "{bore: 12, keyway: {width: 4, depth: 2, fit: P9}}",
            r"part\.keyway\.fit: cannot be combined with width; leave",
        ),
        ("{bore: 12, keyway: din6886}", r"part\.keyway: unknown keyway"),
    ],
)
def test_what_is_no_keyway_is_refused(part, problem):
    with pytest.raises(RecipeErrors, match=problem):
        recipe_of(part)


def test_bores_of_the_standard_are_told_in_the_recipe_s_unit():
    with pytest.raises(RecipeErrors, match=r"bores from 0\.23622 to 9\.05512 in"):
        recipe_of("{bore: 0.1, keyway: din6885}", more="units: inch\n")


def test_a_standard_one_is_said_to_be_metric():
    assert FEATURE.metric(Keyway(6.0, 2.8, standard=True)).startswith("metric keyway of DIN 6885, 6 mm wide")
    assert FEATURE.metric(Keyway(6.0, 2.8)) == ""
