"""Tables of docs/ that benchmarks write anew."""

from __future__ import annotations

from pathlib import Path

PERFORMANCE = Path(__file__).parents[1] / "docs" / "performance.md"


def rewrite(heading: str, rows: list[str]) -> None:
    """Put rows in the place of those under a heading, two lines and their ends, in docs/performance.md."""
    before, after = PERFORMANCE.read_text(encoding="utf-8").split(heading, 1)
    _, rest = after.split("\n\n", 1)
    lines = "\n".join(rows)
    PERFORMANCE.write_text(f"{before}{heading}{lines}\n\n{rest}", encoding="utf-8")
