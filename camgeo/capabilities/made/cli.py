"""What the terminal shows of points, and recipes made of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.made.section_text import shown
from camgeo.cli.extension import Terminal

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.cli.extension import Started


def _shown(report: dict[str, Any], everything: bool) -> str:
    return shown(report, everything=everything)


def _started(paths: Sequence[Path], recipe: Path, name: str) -> Started:
    from camgeo.capabilities.made.start import started

    return started(paths, recipe, name)


ANSWERS = Terminal(shown=_shown, started=_started)
