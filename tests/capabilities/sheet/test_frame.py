"""Where notes and the title block stand on each size of paper, and what they leave free."""

from __future__ import annotations

import pytest

from camgeo.capabilities.sheet.frame import BLOCK, EDGE, ROW, ROWS, SIZES, free_area, notes_at


@pytest.mark.parametrize("paper", SIZES)
def test_notes_stand_beside_the_block_but_on_a4_above_it(paper: str) -> None:
    bare, noted = (free_area(paper, block=True, notes=notes) for notes in (0.0, 20.0))
    left, lowest, width = notes_at(paper)
    block = SIZES[paper][0] - EDGE - BLOCK  # its left edge
    if paper.lower().startswith("a4"):
        assert noted.low - bare.low == pytest.approx(20.0)
        assert lowest > EDGE + ROWS * ROW
        assert left + width <= SIZES[paper][0] - EDGE
    else:
        assert noted == bare
        assert free_area(paper, block=True, notes=300.0).low == pytest.approx(EDGE + 303.0)
        assert lowest < EDGE + ROW
        assert left + width <= block
    assert bare.low > EDGE + ROWS * ROW
    assert free_area(paper, block=False).low < bare.low
    # on each side of the middle as far from the paper's edge as the frame, or farther
    assert SIZES[paper][0] - noted.right >= EDGE
    assert SIZES[paper][1] - noted.high >= EDGE
