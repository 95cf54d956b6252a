"""The measured tables of the pages on the three papers: `python tests/docs/paper_pages.py` writes them anew."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path += [str(ROOT / "tests"), str(ROOT / "tools" / "docs")]  # where pytest has the one, and the scripts the other

import aygahoglu_rows  # noqa: E402
import shu_wu_rows  # noqa: E402
import wunderlich_rows  # noqa: E402
from support.page_tables import HEAD, PAPER_HEAD, PaperRow, write  # noqa: E402

DOCS = ROOT / "docs"
# page and mark of each table, and what measures its rows
TABLES = {
    ("constant-breadth.md", "extremes of the motion"): shu_wu_rows.motion_extremes,
    ("constant-breadth.md", "extremes of the radius of curvature"): shu_wu_rows.radius_extremes,
    ("double-roller.md", "wunderlich"): wunderlich_rows.figures,
    ("validation.md", "paper AS"): aygahoglu_rows.paper,
    ("validation.md", "paper SW"): shu_wu_rows.paper,
    ("validation.md", "paper W"): wunderlich_rows.paper,
}


def main() -> None:
    """Write every table; say which rows do not hold."""
    for (page, mark), measure in TABLES.items():
        rows = measure()
        head = PAPER_HEAD if isinstance(rows[0], PaperRow) else HEAD
        write(DOCS / page, mark, [head, *(row.line() for row in rows)])
        for row in rows:
            if not row.holds:
                print(f"{row.line()}  allowed {row.within}")


if __name__ == "__main__":
    main()
