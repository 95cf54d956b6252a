"""What would keep a limit of printed bodies."""

from __future__ import annotations

import pytest

from camgeo.capabilities.mechanism.checks import ANSWERS
from camgeo.recipe.loading import load_text

RECIPE = load_text(
    "cam: {kind: disc, base_radius: 20, follower: {kind: roller, radius: 5}, motion: [{rise_fall: 8, over: 360}]}\n"
    "part: {thickness: 8, bore: {hexagon: 10}}\nmechanism: {wall: 4}\n",
    "cam.yaml",
)


@pytest.mark.parametrize(
    ("figure", "value", "bound", "words"),
    [
        ("clearance", 0.1, 0.2, "a larger mechanism.clearance"),
        ("clearance", 0.3, 0.2, "a smaller mechanism.clearance"),
        ("collision", -1.0, 0.2, "a smaller mechanism.wall"),
        ("mass", 1.0, 0.2, ""),
    ],
)
def test_what_would_keep_a_limit(figure, value, bound, words):
    assert ANSWERS.remedy(RECIPE, figure, value, bound) == words
