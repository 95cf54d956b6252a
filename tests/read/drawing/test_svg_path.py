"""Path data of SVG: letters, repeated numbers, flags without a space, arcs as bulges, and what is refused."""

import math

import pytest

from kin.read.drawing.shapes import Affine, UnfitError
from kin.read.drawing.svg_path import path_of


def chords(text, to=Affine()):  # noqa: B008 - it does not change
    (shape,) = path_of(text, to)
    return [pytest.approx(row) for row in shape.chords.tolist()]


def test_letters_absolute_and_relative_are_the_same_square():
    square = [[0, 0, 2, 0, 0], [2, 0, 2, 1, 0], [2, 1, 0, 1, 0], [0, 1, 0, 0, 0]]
    for text in ("M0 0 L2 0 2 1 0 1Z", "m0,0l2,0 0,1-2,0z", "M0 0H2V1H0Z", "m0 0h2v1h-2z", "M0 0 2 0 2 1 0 1z"):
        assert chords(text) == square


@pytest.mark.parametrize(
    ("flags", "bulge"), [("01", 1.0), ("00", -1.0), ("0 1", 1.0), ("11", 1.0)], ids=["cw", "ccw", "apart", "large"]
)
def test_half_a_circle_by_its_flags(flags, bulge):
    assert chords(f"M0 0A1 1 0 {flags} 2 0") == [[0, 0, 2, 0, bulge]]
    assert chords(f"M0 0A1 1 0 {flags} 2 0", Affine(d=-1.0)) == [[0, 0, 2, 0, -bulge]]


def test_a_quarter_and_three_quarters_of_a_circle():
    quarter = math.tan(math.pi / 8)
    assert chords("M1 0A1 1 0 0 1 0 1") == [[1, 0, 0, 1, quarter]]
    assert chords("M1 0A1 1 0 1 0 0 1") == [[1, 0, 0, 1, -1.0 / quarter]]


def test_cubics_are_bezier_pieces_of_their_own():
    line, curve = path_of("M0 0L1 0C2 0 3 1 3 2", Affine(e=10.0))
    assert line.chords.tolist() == [[10, 0, 11, 0, 0]]
    assert curve.beziers.control.tolist() == [[[11, 0], [12, 0], [13, 1], [13, 2]]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("L1 1", "its path does not begin with M"),
        ("M0 0Q1 1 2 0", "its path has Q; M, L, H, V, A, C and Z are read"),
        ("M0 0L1", "its path has '' where a number of L belongs"),
        ("M0 0L1 x", "its path has ' x' where a number|its path has 'x' where a number of L belongs"),
        ("M0 0Z5", "its path has the number 5 where a letter belongs"),
        ("M0 0A2 1 0 0 1 2 0", "an arc has the radii 2 and 1; arcs of circles are read"),
        ("M0 0A1 1 0 0 1 4 0", "an arc of radius 1 does not reach across its chord of 4"),
        ("M0 0L1e999 0", "beyond all numbers of a drawing"),
    ],
)
def test_what_is_no_path_is_refused(text, message):
    with pytest.raises(UnfitError) as caught:
        path_of(text, Affine())
    assert any(part in caught.value.args[1] for part in message.split("|"))
