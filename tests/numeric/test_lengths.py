"""Words with marked lengths and inputs, shown in a unit."""

import math

from kin.numeric.lengths import INPUT, Words, in_unit, input_number, input_words, shown


def test_an_input_is_an_angle_unless_it_is_shown_for_a_travel():
    words = f"the {INPUT} of a segment, {input_words(math.pi)}, follows {input_number(math.pi / 2, '.3g')}"
    assert shown(words) == "the angle of a segment, 180 degrees, follows 90"
    assert in_unit(Words(words), 25.4, "in", travel=True) == "the length of a segment, 0.123685 in, follows 0.0618"
