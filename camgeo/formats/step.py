"""Parts as STEP files (ISO 10303-21, AP214): exact solids, written by Open CASCADE.

Numbers are written with 17 digits, which give back the same double; the kernel's own default of 13 would move a wall of
a large radius. Nothing in the file depends on when, where or by whom it was written.
"""

from __future__ import annotations

import io
from contextlib import contextmanager
from functools import reduce
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from camgeo.files.brep import Shape, need_kernel, raise_shape, solid_shape, stack_shape
from camgeo.files.curves import misfit
from camgeo.files.precision import conversion_error
from camgeo.fit.bound import Bound
from camgeo.fit.nodes import ToleranceError
from camgeo.formats.options import OF_SOLID
from camgeo.output.extension import Making
from camgeo.part.features import EDGE_KEYS
from camgeo.registry.formats import Form, Format
from camgeo.schema.fields import Field, FieldTable, Kind

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.solid import Solid
    from camgeo.fit.pieces import Outline
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values

TIME = "2000-01-01T00:00:00"  # in place of the time of writing
# The kernel's settings are its own for the whole process: set while a file is written, and set back.
TEXTS = {"write.step.schema": "AP214IS", "write.step.unit": "MM"}
NUMBERS = {"write.surfacecurve.mode": 0, "write.precision.mode": 0, "write.step.assembly": 0}
# A real of the format needs its decimal point. The kernel's suppression of zeros drops exponents as well.
REAL = "%.16E"


class StepBody(NamedTuple):
    """A solid in its outlines, outermost first, mm, its own name, and the z of its lower face, mm."""

    outlines: Sequence[LayerOutline]
    solid: Solid
    name: str = ""
    z: float = 0.0


def write_step(
    path: Path,
    bodies: Sequence[StepBody],
    *,
    tolerance: float,
    units: Literal["mm", "inch"] = "mm",
    name: str = "",
    about: str = "",
) -> Bound:
    """Write solids in a unit, each a product of its own; returns the proved bound of the written contours, mm.

    `name`, the file's in its header, begins the names of the products; `about` describes them and the file.

    Raises MissingExtraError without the kernel, ToleranceError where the bound is above the tolerance, RegionError
    where a piece is too short for the kernel, an arc is sharper than the chamfer, a cross hole divides a solid, or the
    kernel finds it unsound, TypeError for a polygon and for a chamfer along anything but arcs, ValueError for a
    periodic spline, OSError where the file cannot be written.
    """
    need_kernel()
    fitted = [layered.outline for body in bodies for layered in body.outlines if layered.circle is None]
    bound = reduce(Bound.wider, (outline.bound.widened(wall_error(outline, units)) for outline in fitted))
    if not bound.worst <= tolerance:
        raise ToleranceError(
            f"STEP: the contour would be off by {bound.worst:.6g} mm, more than {tolerance:.6g} mm: circles of nearly "
            "straight arcs are rounded",
            bound.worst,
        )
    shapes = [raise_shape(solid_shape(body.outlines, body.solid), body.z) for body in bodies]
    names = [f"{name} {body.name}".rstrip() for body in bodies]
    path.write_bytes(_text(shapes, names, units, name, about))
    return bound


def write_stack(
    path: Path,
    stretches: Sequence[tuple[Outline, float, float]],
    bore: Outline | None,
    *,
    units: Literal["mm", "inch"] = "mm",
    name: str = "",
    about: str = "",
) -> float:
    """Write one solid of prisms one above the other; returns the greatest distance of its walls from the outlines, mm.

    `stretches` are (outline, z below, z above), mm, from below; of two neighbouring outlines one has to lie within the
    other. `bore` goes through all of them. `name` is the product's and, in the header, the file's; `about` describes
    both.

    Raises MissingExtraError without the kernel, RegionError where a piece is too short for the kernel or the kernel
    finds the solid unsound, TypeError for a polygon, ValueError for a periodic spline, OSError where the file cannot be
    written.
    """
    need_kernel()
    path.write_bytes(_text([stack_shape(stretches, bore)], [name], units, name, about))
    return max(wall_error(outline, units) for outline, _, _ in stretches)


def write_shape(
    path: Path, shape: Shape, *, units: Literal["mm", "inch"] = "mm", name: str = "", about: str = ""
) -> None:
    """Write a solid of the kernel, mm, in a unit, under a name; raises OSError where the file cannot be written."""
    path.write_bytes(_text([shape], [name], units, name, about))


def wall_error(outline: Outline, units: str) -> float:
    """Greatest distance of written walls from an outline, mm: misfits of circles, and rounding in inches."""
    return misfit(outline) + (0.0 if units == "mm" else conversion_error(outline))


def _text(shapes: Sequence[Shape], names: Sequence[str], units: str, name: str, about: str) -> bytes:
    """Bytes of a STEP file with these solids, each under its name."""
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
    from OCP.StepData import StepData_StepWriter

    writer = STEPControl_Writer()  # brings the settings into being
    with _settings(Interface_Static, TEXTS | {"write.step.unit": units.upper()}), _quiet():
        model = writer.Model(True)
        for shape in shapes:
            writer.Transfer(shape, STEPControl_StepModelType.STEPControl_ManifoldSolidBrep)
        _set_names(model, names, name, about)
        out = StepData_StepWriter(model)
        out.FloatWriter().SetFormat(REAL)
        out.SendModel(writer.WS().Protocol())
        stream = io.BytesIO()
        out.Print(stream)
    return stream.getvalue()


@contextmanager
def _settings(static: Any, chosen: Mapping[str, str]) -> Iterator[None]:  # noqa: ANN401 - the kernel has no types
    texts = {key: static.CVal_s(key) for key in TEXTS}
    numbers = {key: static.IVal_s(key) for key in NUMBERS}
    try:
        for key, text in chosen.items():
            static.SetCVal_s(key, text)
        for key, number in NUMBERS.items():
            static.SetIVal_s(key, number)
        yield
    finally:
        for key, text in texts.items():
            static.SetCVal_s(key, text)
        for key, number in numbers.items():
            static.SetIVal_s(key, number)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the kernel's statistics from the standard output; its failures are still written."""
    from OCP.Message import Message, Message_Gravity

    printers = list(Message.DefaultMessenger_s().Printers())
    levels = [printer.GetTraceLevel() for printer in printers]
    try:
        for printer in printers:
            printer.SetTraceLevel(Message_Gravity.Message_Fail)
        yield
    finally:
        for printer, level in zip(printers, levels, strict=True):
            printer.SetTraceLevel(level)


def _set_names(model: Any, names: Sequence[str], name: str, about: str) -> None:  # noqa: ANN401 - the kernel has no types
    """Name each product and its solid, in the order in which they were transferred, and fill in the header."""
    from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
    from OCP.StepBasic import StepBasic_Product
    from OCP.StepShape import StepShape_ManifoldSolidBrep

    products, solids = iter(names), iter(names)
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepBasic_Product):
            own_name = _string(next(products))
            entity.SetId(own_name)
            entity.SetName(own_name)
            entity.SetDescription(_string(about))
        elif isinstance(entity, StepShape_ManifoldSolidBrep):
            entity.SetName(_string(next(solids)))
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(_string(f"{name}.step"))
    header.SetTimeStamp(_string(TIME))
    header.SetAuthorValue(1, _string(""))
    header.SetOrganizationValue(1, _string(""))
    header.SetOriginatingSystem(_string("camgeo"))
    header.SetAuthorisation(_string(""))
    header.SetDescriptionValue(1, _string(about or "disc cam"))


def _string(text: str) -> Any:  # noqa: ANN401 - the kernel has no types
    """Text of a STEP file: characters beyond ASCII in hexadecimal form (ISO 10303-21, 6.4.3)."""
    from OCP.TCollection import TCollection_HAsciiString

    parts = []
    for letter in text:
        if 32 <= ord(letter) < 127:
            parts.append(letter)
        else:
            wide = ord(letter) > 0xFFFF
            parts.append(f"\\X{4 if wide else 2}\\{ord(letter):0{8 if wide else 4}X}\\X0\\")
    return TCollection_HAsciiString("".join(parts))


# --- its files --------------------------------------------------------------------------------------------------------


def make_step(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Fit, write, read back and judge one STEP file with all discs; without the kernel nothing is fitted.

    Raises RecipeErrors for a part without thickness, a tolerance that cannot be held, and outlines that make no sound
    solid; SurroundingsError without the kernel, OSError where the file cannot be written.
    """
    from camgeo.output.part_geometry import contours_of, rim_of, solid_of

    recipe, tolerance = job.recipe.in_units_of(request), job.tolerance(request)
    with job.refusals(request):
        need_kernel()
        form = request.as_ or "arcs"
        discs = job.design.discs
        names = [disc.name if len(discs) > 1 else "" for disc in discs]
        # the tolerance holds for the written walls, so that the fit is finer by what writing moves them
        contours_of_discs = [
            single_job.written_outlines(form, tolerance, lambda fit: wall_error(fit, recipe.units))
            for single_job in job.single
        ]
        with job.clock.stage("write step"):
            if recipe.part.thickness is None:
                raise recipe.error("part.thickness", "a solid needs a thickness")
            bodies = [
                StepBody(
                    [*rim_of(single_job.body), *contours_of(single_job.design, contours)],
                    solid_of(single_job.body),
                    name,
                    disc.z,
                )
                for single_job, contours, name, disc in zip(job.single, contours_of_discs, names, discs, strict=True)
            ]
            bound = write_step(
                path,
                bodies,
                tolerance=tolerance,
                units=recipe.units,
                name=recipe.name,
                about=recipe.about,
            )
    judged = job.judge if len(discs) == 1 else job.judge_together
    return judged(request, path, bound, sum(outline.count for contours in contours_of_discs for outline in contours))


def _foresee(_job: Job, _request: FileRequest) -> None:
    """Raise MissingExtraError without the kernel."""
    need_kernel()


def _check(file: Values, _: Values, reader: Reader) -> None:
    edges = [key for key in EDGE_KEYS if key in reader.marks]
    if file.get("as", "arcs") != "arcs" and edges:
        remedy = f"give arcs, whose chamfers are exact cones, or leave {edges[0]} out"
        field_path = f"{file['path']}.step.as"
        reader.fault_at(field_path, "the chamfer of a spline is not a spline", f"'{file['as']}'", remedy)


FORMAT = Format(
    name="step",
    options=FieldTable(
        (
            Field(
                "as",
                Kind.CHOICE,
                "what the contour is made of: cylinders and planes, or the surface that a spline sweeps",
                default="arcs",
                choices=("arcs", "spline"),
            ),
            *OF_SOLID,
        ),
    ),
    forms={
        name: Form(name=name, surfaces=2, discs=2, pieces=pieces)
        for name, pieces in (("arcs", "arcs"), ("spline", "spans"))
    },
    check=_check,
    solid=True,
)
MAKING = Making(make=make_step, foresee=_foresee)
