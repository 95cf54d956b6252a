"""Numbers and text in XML."""

from __future__ import annotations


def number(value: float) -> str:
    """Shortest text that reads back as the same double."""
    return repr(value + 0.0).removesuffix(".0")


def one_line(text: str) -> str:
    """Text on one line, escaped for an element or an attribute of XML."""
    from xml.sax.saxutils import escape  # the formats of a recipe are read, most of them not written

    plain = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return escape(plain, {'"': "&quot;"})
