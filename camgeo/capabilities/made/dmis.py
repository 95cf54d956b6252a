"""Measuring program for a coordinate measuring machine in DMIS (ISO 22093): contact points with normals, and the zone.

Each point is a feature F(Pn) with place and normal of the exact contour, as the part is drawn, at half the height of
the part. A MEAS with the same data as its PTMEAS has it approached along its normal, and OUTPUT asks for the actual
FA(Pn), which `camgeo verify` reads.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.terminal import escaped
from camgeo.files.markup import one_line
from camgeo.formats.options import RECIPE_UNITS
from camgeo.formats.tables.tabled import check_step
from camgeo.measures.contact_points import contact_points
from camgeo.output.extension import Making
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.registry.formats import Format
from camgeo.schema.fields import Field, FieldTable, Kind
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest, Length
    from camgeo.recipe.recipe import Recipe, ShaftOrder
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.shaft_cam import ShaftCam
    from kin.numeric.arrays import Array

WORDS, MM = {"mm": "MM", "inch": "INCH"}, {"mm": 1.0, "inch": 25.4}
SAME = 1e-9  # mm: places nearer to each other are one, such as those that two contacts share


def _check(file: Values, _: Values, reader: Reader) -> None:
    check_step(file, reader)


def _make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    from camgeo.output.job import unjudged

    recipe = job.recipe.in_units_of(request)
    with job.clock.stage("dmis"):
        text = "\n".join(program(recipe, job.design, request.own.get("step"))) + "\n"
        path.write_bytes(text.encode("ascii", "replace"))
    return unjudged(path, request, recipe.mm)


class _Disc(NamedTuple):
    """A disc to be measured.

    `zone` is the width of its profile's zone, mm, None without one; `height` the z of the points, mm; `turned` the
    angle by which the disc is turned, rad counter-clockwise as drawn for `cw`.
    """

    zone: float | None
    height: float
    design: Design
    contours: Sequence[tuple[Surface, Curve]]
    turned: float = 0.0


def program(recipe: Recipe, design: Design, step: float | None = None) -> Iterator[str]:
    """Lines of a DMIS program that measures a part at places a `step` of the shaft, rad, apart, in the recipe's unit.

    Without a step there are as many places a turn as the recipe's `verify.angles` says.
    """
    z = 0.5 * (recipe.part.thickness or 0.0)
    return _program(
        recipe, [_Disc(recipe.profile, disc.z + z, design, disc.contours) for disc in design.discs], step, recipe.units
    )


def shaft_program(
    recipe: ShaftOrder, cams: Sequence[ShaftCam], step: float | None = None, units: Length | None = None
) -> Iterator[str]:
    """Lines of a DMIS program for all cams of a shaft, each turned to its angle and measured halfway along its length.

    Places are a `step` of the shaft, rad, apart; without it `verify.angles` says how many there are a turn. Lengths are
    in `units`, by default those of the recipe.
    """
    discs = [
        _Disc(cam.recipe.profile, 0.5 * (cam.low + cam.high), cam.design, cam.design.contours, cam.at) for cam in cams
    ]
    return _program(recipe, discs, step, units or recipe.units)


def _program(recipe: ShaftOrder, discs: Iterable[_Disc], step: float | None, units: Length) -> Iterator[str]:
    # header, and a tolerance for each width of zone: plus and minus half of it
    name, mm = one_line(escaped(recipe.name)).replace("'", " "), MM[units]
    yield f"DMISMN/'{name}'"
    yield f"UNITS/{WORDS[units]},ANGDEC"
    discs = list(discs)
    widths = dict.fromkeys(disc.zone for disc in discs if disc.zone is not None)
    zones = {zone: "ZONE" if rank == 1 else f"ZONE{rank}" for rank, zone in enumerate(widths, 1)}
    for zone, label in zones.items():
        half = f"{0.5 * zone / mm:.12g}"
        yield f"T({label})=TOL/PROFP,-{half},{half}"
    # each place: nominal feature, measurement, and output with its tolerance; + 0.0 turns -0.0 into 0
    shaft = equal_steps(recipe.verify.angles if step is None else round(TURN / step))
    rank = 0
    for disc in discs:
        height, own = f"{disc.height / mm:.12g}", f",TA({zones[disc.zone]})" if disc.zone is not None else ""
        for place, normal in _places(recipe, disc, shaft):
            rank += 1
            numbers = [*(f"{value / mm + 0.0:.12g}" for value in place), height]
            numbers += [f"{value + 0.0:.12g}" for value in normal] + ["0"]
            cells = ",".join(numbers)
            yield f"F(P{rank})=FEAT/POINT,CART,{cells}"
            yield f"MEAS/POINT,F(P{rank}),1"
            yield f"PTMEAS/CART,{cells}"
            yield "ENDMES"
            yield f"OUTPUT/FA(P{rank}){own}"
    yield "ENDFIL"


def _places(recipe: ShaftOrder, disc: _Disc, shaft: Array) -> Iterator[tuple[list[float], list[float]]]:
    """Places [x, y], mm, and outward unit normals where a disc is touched over a turn, as drawn, each once."""
    known: set[tuple[float, ...]] = set()
    for points in contact_points(disc.design, shaft, disc.contours):
        drawn = points.as_drawn(disc.turned, recipe.rotation)
        for place, normal in zip(drawn.places, drawn.normals, strict=True):
            key = tuple(np.round(place / SAME).tolist())
            if key not in known:
                known.add(key)
                yield place.tolist(), normal.tolist()


FORMAT = Format(
    name="dmis",
    suffix="dmi",
    options=FieldTable(
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
)
MAKING = Making(make=_make)
