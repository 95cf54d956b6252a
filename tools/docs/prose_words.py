"""Count the words of prose of each page of the docs: tables, code and comments do not count.

    python tools/docs/prose_words.py [PAGE...]

prints the words of each page, most first, and their sum; without names of all pages and of README.md.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CODE = re.compile(r"^ *```.*?^ *```", re.DOTALL | re.MULTILINE)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
TAG = re.compile(r"<[^>]+>")
TARGET = re.compile(r"\]\([^)]*\)")


def prose_words(text: str) -> int:
    """Words of a page that stand outside code, tables, comments, tags and the targets of links."""
    for pattern in (CODE, COMMENT, TAG):
        text = pattern.sub("", text)
    lines = (line for line in TARGET.sub("]", text).splitlines() if not line.lstrip().startswith("|"))
    return len(" ".join(lines).split())


def main() -> None:
    """Print a row for each page, and the sum."""
    pages = [Path(name) for name in sys.argv[1:]] or [*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md"]
    counts = sorted(((prose_words(page.read_text("utf-8")), page.name) for page in pages), reverse=True)
    for words, name in counts:
        print(f"{words:6d}  {name}")
    print(f"{sum(words for words, _ in counts):6d}  in all")


if __name__ == "__main__":
    main()
