"""Limits in words and as signs: a limit that itself fails is said otherwise."""

import pytest

from camgeo.report.limit_words import sign, title, unit_text, verb, words


@pytest.mark.parametrize(
    ("name", "sense", "limit", "told"),
    [
        ("radius-of-curvature", "at_least", 0.0, ("more than", ">", "needed")),
        ("wall", "at_least", 0.0, ("more than", ">", "needed")),
        ("wall", "at_least", 2.0, ("at least", ">=", "allowed")),
        ("pressure-angle", "at_most", 90.0, ("less than", "<", "needed")),
        ("pressure-angle", "at_most", 45.0, ("at most", "<=", "allowed")),
    ],
)
def test_a_limit_at_which_a_figure_fails_is_strict(name, sense, limit, told):
    check = {"name": name, "sense": sense, "limit": limit}
    assert (words(check), sign(check), verb(check)) == told


def test_a_check_of_a_file_is_never_strict():
    assert words({"name": "chamfer", "sense": "at_most", "limit": 0.01, "file": "cam.stl"}) == "at most"


def test_title_and_unit():
    assert title({"name": "motion", "surface": "outer"}) == "motion, outer"
    assert title({"name": "motion", "surface": ""}) == "motion"
    assert unit_text({"unit": "N", "pounds": {"value": 115.24, "unit": "lbf"}}) == "N (115.24 lbf)"
    assert unit_text({"unit": "mm"}) == "mm"
