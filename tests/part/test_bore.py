"""Forms of a bore: what the other keys of a part take from them."""

import pytest

from camgeo.part.bore import build_bore, diameter_of, width_of


@pytest.mark.parametrize(
    ("bore", "diameter", "width"),
    [
        (12.0, 12.0, (12.0, "diameter")),
        ({"diameter": 20.0, "fit": "H7"}, 20.0, (20.0, "diameter")),
        ({"square": 10.0}, None, (10.0, "width")),
        ({"hexagon": 9.0, "at": 0.5}, None, (9.0, "width")),
        (None, None, (None, "diameter")),
    ],
)
def test_size_and_its_word(bore, diameter, width):
    part = {} if bore is None else {"bore": bore}
    assert diameter_of(part) == diameter
    assert width_of(part)[0] == width[0]
    if bore is not None:
        assert width_of(part)[1] == width[1]


def test_what_the_part_is_built_of():
    assert build_bore({"bore": {"hexagon": 9.0, "at": 0.5}}) == {"bore": 9.0, "sides": 6, "bore_at": 0.5, "fit": ""}
    assert build_bore({"bore": {"diameter": 20.0, "fit": "H7"}}) == {
        "bore": 20.0,
        "sides": 0,
        "bore_at": 0.0,
        "fit": "H7",
    }
    assert build_bore({})["bore"] is None
