"""Radii of a development: words and lengths, each once."""

import pytest

from camgeo.recipe.radii import radii_form
from camgeo.schema.fields import Field, FieldTable, Kind
from camgeo.schema.reader import Reader
from camgeo.schema.readers import READERS
from camgeo.schema.yaml_source import read_source

WORDS = {"outer": "for the blank", "pitch": "for the path"}


def read(text, words=WORDS):
    source = read_source(text.encode(), "r.yaml")
    table = FieldTable((Field("at", Kind.OWN, "radii", form=radii_form(words)),))
    reader = Reader(source, READERS, table)
    return reader, reader.table(table, source.root, "")


def test_words_and_lengths_in_their_order():
    reader, values = read("at: [pitch, 38, outer]")
    assert not reader.errors
    assert values == {"at": ("pitch", 38.0, "outer")}


@pytest.mark.parametrize(
    ("text", "words", "told"),
    [
        ("at: [38, 38]", WORDS, "the same radius twice"),
        ("at: [inner]", WORDS, ", outer for the blank, or pitch for the path"),
        ("at: [inner]", {"outer": "for the blank"}, ", or outer for the blank"),
        ("at: []", WORDS, "at"),
    ],
)
def test_a_fault_names_what_serves(text, words, told):
    reader, _ = read(text, words)
    assert told in str(reader.errors[0])
