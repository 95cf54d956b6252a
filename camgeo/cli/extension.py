"""What the command line asks of capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from camgeo.registry.slot import Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path


class Started(NamedTuple):
    """Text of a new recipe; `beside` has the texts of files beside it by name, `lines` are for the terminal."""

    text: str
    beside: Mapping[str, str]
    lines: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Terminal:
    """Answers of a capability with words for the terminal.

    shown    text on files that it judges: (report, whether all lines are wanted)
    started  recipe for `camgeo new` by an option of the label's `sources`: (files, path of a recipe, name of the new
             one); raises CallError for files of which none can be made, RecipeErrors for a faulty recipe, OSError for
             what cannot be read
    """

    shown: Callable[[dict[str, Any], bool], str] = always("")
    started: Callable[[Sequence[Path], Path, str], Started] | None = None


TERMINAL = Slot("cli", Terminal())
