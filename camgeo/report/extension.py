"""What the page and the text of a report ask of capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.registry.slot import Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.report.plot import Plot
    from camgeo.synthesis.design import Design


@dataclass(frozen=True, kw_only=True)
class Page:
    """Answers of a capability that has something to show.

    panel  HTML on the page, from the report; empty for none
    plots  on the page, over a turn
    lines  a table for the terminal beside those of checks and files, from a report with a section of the capability's
           name; empty for none
    """

    panel: Callable[[dict[str, Any]], str] = always("")
    plots: Callable[[Recipe, Design], Sequence[Plot]] = always(())
    lines: Callable[[dict[str, Any]], str] = always("")


PAGE = Slot("page", Page())
