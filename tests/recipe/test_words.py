"""Words by which a recipe uses capabilities: keys, formats, options; whatever the text holds else."""

import pytest

from camgeo.recipe.words import words_of
from camgeo.schema.yaml_source import Source


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cam: {kind: disc}\nsweep: {}\n", {"cam", "sweep"}),
        (
            "export: {files: [dxf, {csv: {as: forces, step: 0.5}}]}\n",
            {"export", "dxf", "csv", "as: forces", "step: 0.5"},
        ),
        ("export: {files: [{stl: }, 3]}\n", {"export", "stl", "3"}),
        ("export: [dxf]\n", {"export"}),
        ("- a\n", set()),
    ],
)
def test_words(text, words):
    assert words_of(Source.of(text, "cam.yaml").root) == words
