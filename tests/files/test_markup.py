"""Numbers and text in XML."""

import math

from hypothesis import given
from hypothesis import strategies as st

from camgeo.files.markup import number, one_line


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_reads_back_as_itself(value):
    assert float(number(value)) == value
    assert not number(value).endswith(".0")


def test_nothing_is_plain():
    assert (number(-0.0), number(2.0), number(math.pi)) == ("0", "2", "3.141592653589793")


def test_text_cannot_leave_its_element():
    assert one_line('a\n <b> & "c"\x00') == "a &lt;b&gt; &amp; &quot;c&quot;"
