"""Lettering: the font of the drawings and how wide its texts are. Heights are those of capitals, mm."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fpdf import FPDF

FAMILY = "DejaVu"
FONT = Path(__file__).with_name("DejaVuSans.ttf")
CAPITALS = 1493.0 / 2048.0  # height of capitals as a share of the font's size
MM = 25.4 / 72.0  # of a point
SMALL, PLAIN, LARGE = 2.5, 3.5, 5.0  # mm: heights of ISO 3098, none below 2.5


def new_pdf() -> FPDF:
    """An empty PDF without pages, in mm, with the font; raises ModuleNotFoundError without fpdf2."""
    from fpdf import FPDF

    pdf = FPDF(unit="mm")
    pdf.set_auto_page_break(auto=False)
    pdf.add_font(FAMILY, fname=FONT)
    return pdf


def font_points(height: float) -> float:
    """Size of the font, points, whose capitals are `height` mm high."""
    return height / CAPITALS / MM


@cache
def _measuring() -> FPDF:
    pdf = new_pdf()
    pdf.set_font(FAMILY, size=1000.0)
    return pdf


@cache
def width(text: str, height: float) -> float:
    """Width, mm, of a text whose capitals are `height` mm high."""
    return float(_measuring().get_string_width(text)) * font_points(height) / 1000.0


def unknown(text: str) -> str:
    """Characters of a text that the font does not have, each once."""
    known = _measuring().fonts[FAMILY.lower()].cmap  # type: ignore[union-attr]
    return "".join(dict.fromkeys(c for c in text if ord(c) not in known))


def wrap(text: str, wide: float) -> list[str]:
    """Lines of a text in the height SMALL, no wider than `wide` mm, but for a longer word, which has its own line."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and width(longer, SMALL) > wide:
            lines.append(line)
            longer = word
        line = longer
    return [*lines, line]
