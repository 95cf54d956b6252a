"""What a measuring machine is to measure, as DMIS (ISO 22093): a point of each contact with its normal, and the zone.

Each point is a feature F(Pn) with place and normal of the exact contour, as the part is drawn, half as high as the
part; a MEAS with the same as PTMEAS has it approached along its normal, and OUTPUT asks for the actual FA(Pn), which
`camgeo verify` reads.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.terminal import escaped
from camgeo.files.markup import one_line
from camgeo.formats.options import RECIPE_UNITS
from camgeo.formats.tables.tabled import check_step
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.registry.formats import Format
from camgeo.schema.fields import Field, Kind, Table
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design

WORDS = {"mm": "MM", "inch": "INCH"}
SAME = 1e-9  # mm: places that two contacts have in common are measured once


def _check(file: Values, _: Values, reader: Reader) -> None:
    check_step(file, reader)


def _make(job: Job, request: FileRequest, path: Path) -> Made:
    from camgeo.output.job import looked_at

    recipe = job.recipe.told_for(request)
    with job.clock.stage("dmis"):
        text = "\n".join(program(recipe, job.design, request.own.get("step"))) + "\n"
        path.write_bytes(text.encode("ascii", "replace"))
    return looked_at(path, request, recipe.mm)


def program(recipe: Recipe, design: Design, step: float | None = None) -> Iterator[str]:
    """Lines of the program, by a step of the shaft, rad, or that of `verify.angles`."""
    name = one_line(escaped(recipe.name)).replace("'", " ")
    yield f"DMISMN/'{name}'"
    yield f"UNITS/{WORDS[recipe.units]},ANGDEC"
    zone = recipe.profile
    if zone is not None:
        half = f"{0.5 * zone / recipe.mm:.12g}"
        yield f"T(ZONE)=TOL/PROFP,-{half},{half}"
    z = 0.5 * (recipe.part.thickness or 0.0)
    rank = 0
    for disc in design.discs:
        height = f"{(disc.z + z) / recipe.mm:.12g}"
        for place, normal in _places(recipe, design, disc.name, step):
            rank += 1
            numbers = [*(f"{value / recipe.mm + 0.0:.12g}" for value in place), height]
            numbers += [f"{value + 0.0:.12g}" for value in normal] + ["0"]
            cells = ",".join(numbers)
            yield f"F(P{rank})=FEAT/POINT,CART,{cells}"
            yield f"MEAS/POINT,F(P{rank}),1"
            yield f"PTMEAS/CART,{cells}"
            yield "ENDMES"
            yield f"OUTPUT/FA(P{rank})" + (",TA(ZONE)" if zone is not None else "")
    yield "ENDFIL"


def _places(recipe: Recipe, design: Design, disc: str, step: float | None) -> Iterator[tuple[list[float], list[float]]]:
    """Places, mm, and outward normals of what is touched on a disc over a turn, as the part is drawn; each once."""
    from camgeo.curve.measures import touched

    count = recipe.verify.angles if step is None else round(TURN / step)
    shaft = equal_steps(count)
    relative = shaft if design.driven is None else design.driven.mechanism.relative(shaft)
    drawn = np.array([1.0, -1.0 if recipe.rotation == "ccw" else 1.0])
    seen: set[tuple[float, ...]] = set()
    (own,) = [one for one in design.discs if one.name == disc]
    for parameter in design.motion.parameters(shaft, relative).values():
        for surface, contour in own.contours:
            frame = contour.sample(parameter)
            there = touched(contour, parameter)
            for place, normal in zip(
                (frame.point * drawn)[there], (surface.side * frame.normal * drawn)[there], strict=True
            ):
                key = tuple(np.round(place / SAME).tolist())
                if key not in seen:
                    seen.add(key)
                    yield place.tolist(), normal.tolist()


FORMAT = Format(
    name="dmis",
    suffix="dmi",
    options=Table(
        (
            Field(
                "step",
                Kind.ANGLE,
                "of the shaft between points; 360 degrees are a whole number of it",
                default="by verify.angles",
                at_least=FINEST,
                at_most=COARSEST,
            ),
            RECIPE_UNITS,
        )
    ),
    check=_check,
    contour=False,
    part=False,
    turning=True,
    make=_make,
)
