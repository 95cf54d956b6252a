"""Places in messages."""

from kin.numeric.places import place_text


def test_a_place_is_told_to_its_digits():
    assert place_text(1.0, -2.5) == "(1, -2.5)"
    assert place_text(1 / 3, 0.0, 2e6, digits=3) == "(0.333, 0, 2e+06)"
