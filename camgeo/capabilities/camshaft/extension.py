"""What a camshaft asks of other capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from camgeo.registry.slot import EMPTY, Slot
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.common.clock import Clock
    from camgeo.measures.extension import Results
    from camgeo.output.extension import FileCall
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import ShaftOrder
    from camgeo.synthesis.shaft_cam import ShaftCam

    Write: TypeAlias = Callable[[ShaftOrder, Sequence[ShaftCam], FileRequest, Path], None]


@dataclass(frozen=True, kw_only=True)
class OnShaft:
    """Answers of a capability that makes or judges files of several cams on one shaft.

    judge  checks and sections on files that it claims: (recipe of the shaft, its cams, call, clock); raises what
           `judge` of `Output` raises
    write  by the word of a format, writes a file that nothing judges: (recipe of the shaft, its cams, request, path)
    """

    judge: Callable[[ShaftOrder, Sequence[ShaftCam], FileCall, Clock], Results] | None = None
    write: Mapping[str, Write] = EMPTY


ON_SHAFT = Slot("camshaft", OnShaft())


def writers() -> dict[str, Write]:
    """Writer of files that nothing judges, by the word of its format."""
    return {kind: write for answers in ON_SHAFT.of(ON_SHAFT.answering()) for kind, write in answers.write.items()}
