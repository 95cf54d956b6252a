# needs: camshaft
"""Points of several cams on one shaft in `camgeo verify`, and the program that measures them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.camshaft.extension import OnShaft
from camgeo.capabilities.made.dmis import shaft_program

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.common.clock import Clock
    from camgeo.measures.extension import Results
    from camgeo.output.extension import FileCall
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import ShaftOrder
    from camgeo.synthesis.shaft_cam import ShaftCam


def _write(recipe: ShaftOrder, cams: Sequence[ShaftCam], request: FileRequest, path: Path) -> None:
    text = "\n".join(shaft_program(recipe, cams, request.own.get("step"), request.units)) + "\n"
    path.write_bytes(text.encode("ascii", "replace"))


def _judge(recipe: ShaftOrder, cams: Sequence[ShaftCam], call: FileCall, clock: Clock) -> Results:
    from camgeo.capabilities.made.verify_shaft import judge_shaft

    return judge_shaft(recipe, cams, call, clock)


ANSWERS = OnShaft(judge=_judge, write={"dmis": _write})
