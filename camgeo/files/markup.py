"""What XML formats share: numbers and text as they stand there."""

from __future__ import annotations


def number(value: float) -> str:
    """The shortest text that gives back the same double."""
    return repr(value + 0.0).removesuffix(".0")


def one_line(text: str) -> str:
    """One line that XML takes, in an attribute too."""
    from xml.sax.saxutils import escape  # the formats of a recipe are read, most of them not written

    plain = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return escape(plain, {'"': "&quot;"})
