"""From a judged run to the shop drawing of each disc: its notes, its pages, its PDF and its DXF."""

from __future__ import annotations

import hashlib
import math
from functools import reduce
from typing import TYPE_CHECKING, NamedTuple

from camgeo.capabilities.sheet.dxf import annotation
from camgeo.capabilities.sheet.frame import Facts, LongTextError, footer, framed_page, free_area, notes_at, title_block
from camgeo.capabilities.sheet.lettering import unknown, wrap
from camgeo.capabilities.sheet.options import Sheet, build_sheet
from camgeo.capabilities.sheet.pages import (
    LINE,
    SHARE,
    SheetTable,
    Zone,
    contour_table,
    full_size,
    motion_pages,
    table_pages,
)
from camgeo.capabilities.sheet.part import DrawnDisc, disc_loops, number
from camgeo.capabilities.sheet.pdf import write_pdf
from camgeo.capabilities.sheet.views import NoRoomError, Tolerance, disc_sizes, draw_views, lay_out
from camgeo.fit.bound import Bound
from camgeo.formats.dxf import write_dxf
from camgeo.measures.file_result import FileResult
from camgeo.output.job import MadeFiles
from camgeo.output.part_geometry import contours_of, openings_of, remarks, rim_of
from camgeo.part.keyway import Keyway
from camgeo.recipe.export import FileRequest, disc_filename
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.sheet.marks import Page
    from camgeo.output.extension import RunResults
    from camgeo.output.job import Job
    from camgeo.recipe.recipe import Recipe

ARCS = FileRequest("dxf", "arcs", units="mm")


def make_sheets(run: RunResults, request: FileRequest, path: Path) -> MadeFiles:
    """Write the drawing of each disc as PDF and as DXF; return the files, and the checks of the DXF, which is judged.

    A single disc's PDF is at `path`; of several each has its number in the name. No files are made where no cam is
    made. Raises RecipeErrors for characters that the font lacks, a text that does not fit into its cell, two tolerances
    that differ, views that do not fit on the paper, and a tolerance that the contour cannot hold.
    """
    if run.job is None:
        return MadeFiles(())
    jobs = run.job.single
    paths = [path.with_name(disc_filename(path.name, k)) for k in range(len(jobs))] if len(jobs) > 1 else [path]
    pairs = enumerate(zip(jobs, paths, strict=True))
    sheet = build_sheet(request.own)
    drawings = [_make_sheet(run, job, request, there, sheet=sheet, rank=rank) for rank, (job, there) in pairs]
    judged = drawings[0] if len(drawings) == 1 else run.job.combine_discs(ARCS, drawings)
    return MadeFiles((*(FileResult(there, request) for there in paths), *judged.files), judged.checks)


def _make_sheet(run: RunResults, job: Job, request: FileRequest, path: Path, *, sheet: Sheet, rank: int) -> MadeFiles:
    recipe, field = run.recipe, f"{run.recipe.field_of(request)}.sheet"
    name = recipe.name if len(run.design.discs) == 1 else f"{recipe.name}, disc {rank + 1}"
    sheet = sheet if sheet.title else replace(sheet, words=tuple({**sheet.texts, "title": name}.items()))
    for option, text in sheet.texts.items():
        if missing := unknown(text):
            raise recipe.error(f"{field}.{option}", "characters that the font lacks", repr(missing), "leave them out")
    tolerance = _tolerance(recipe, sheet, field)
    with job.refusals(ARCS), job.clock.stage("sheet"):
        contours = job.outlines("arcs", job.tolerance(ARCS))
        outlines = [*contours_of(job.design, contours), *rim_of(job.body), *openings_of(job.body)]
        drawn = DrawnDisc(
            disc_loops(outlines, job.body, len(contours)), job.body, recipe.part, recipe.rotation == "ccw"
        )
        pages = _pages(run, job, sheet, drawn, tolerance=tolerance, field=field, rank=rank)
        write_pdf(path, pages.all, sheet.title)
        drawing = path.with_suffix(".dxf")
        write_dxf(
            drawing,
            outlines,
            remarks=remarks(job.body, 1.0),
            name=recipe.name,
            about=recipe.about,
            annotate=annotation(pages.annotated, pages.origin, pages.scale),
        )
    bound = reduce(Bound.wider, (outline.bound for outline in contours))
    return job.judge(ARCS, drawing, bound, sum(outline.count for outline in contours))


def _tolerance(recipe: Recipe, sheet: Sheet, field: str) -> Tolerance:
    """The contour's profile tolerance and its datums; raises RecipeErrors where two sections state different widths."""
    own = sheet.profile
    for other, width in recipe.zones:
        if own is not None and not math.isclose(width, own, rel_tol=1e-9):
            what = f"{other} in line {recipe.locate(other)[0]} makes it {number(width / recipe.mm)}"
            raise recipe.error(f"{field}.profile", what, number(own / recipe.mm), "leave it out, or make them the same")
    part = recipe.part
    turning = not part.sides and not part.round_bore
    datums = {"A": part.bore is not None, "B": part.bore is not None and turning}
    return Tolerance(recipe.profile, tuple(letter for letter, there in datums.items() if there))


# --- its pages --------------------------------------------------------------------------------------------------------


class Pages(NamedTuple):
    """Pages of one disc: those that the DXF repeats as annotation, and the last at 1 : 1, None where no paper holds it.

    `origin` is the place of the shaft on the first page, mm, and `scale` the scale of its views.
    """

    annotated: list[Page]
    last: Page | None
    origin: tuple[float, float]
    scale: float

    @property
    def all(self) -> list[Page]:
        """Every page in order."""
        return self.annotated if self.last is None else [*self.annotated, self.last]


def _pages(
    run: RunResults, job: Job, sheet: Sheet, drawn: DrawnDisc, *, tolerance: Tolerance, field: str, rank: int
) -> Pages:
    recipe, contours = run.recipe, job.design.contours
    # contents before places: what the notes take decides how large the views may be
    sizes = disc_sizes(drawn, _base(job), tolerance, dict(sheet.rough))
    names = [(surface.name if len(contours) > 1 else "", contour) for surface, contour in contours]
    table = contour_table(names, sheet.step, _zone(recipe, tolerance), ccw=drawn.ccw)
    last = full_size(drawn)
    notes = _notes(drawn, recipe, table, wide=notes_at(sheet.paper)[2], full=last is not None)
    area = free_area(sheet.paper, block=True, notes=LINE * len(notes) + 6.0)
    sense = 1.0 if sheet.projection == "first" else -1.0
    try:
        layout = lay_out(drawn, sizes, area, sheet.scale, sense)
    except NoRoomError as error:
        raise _no_room(recipe, sheet, field, error) from error
    first = framed_page("Part", sheet.paper)
    draw_views(first, drawn, sizes, layout)
    left, low, _ = notes_at(sheet.paper)
    for k, note in enumerate(reversed(notes)):
        first.text((left, low + LINE * k), note)
    sources = [(file.path.name, hashlib.sha256(file.path.read_bytes()).hexdigest()) for file in run.findings.files]
    pages = [
        first,
        *table_pages(table, sheet.paper),
        *motion_pages(job.design, drawn, run.findings, sheet.paper, sources),
    ]
    # title block and footers last, as they state the number of pages
    count = len(pages) + (0 if last is None else 1)
    facts = Facts(layout.word, _mass(run, rank), 1, count)
    try:
        title_block(first, sheet, facts)
    except LongTextError as error:
        remedy = f"give about {error.fits} characters"
        raise recipe.error(f"{field}.{error.option}", "does not fit into the title block", None, remedy) from error
    for k, page in enumerate([*pages[1:], *([] if last is None else [last])]):
        footer(page, sheet, facts._replace(page=k + 2))
    return Pages(pages, last, layout.face, layout.scale)


def _no_room(recipe: Recipe, sheet: Sheet, field: str, error: NoRoomError) -> Exception:
    if sheet.scale is not None:
        remedy = f"give {error.largest}, or leave it out" if error.largest else "give paper: A3, or leave it out"
        return recipe.error(f"{field}.scale", f"the views do not fit on {sheet.paper}", f"{sheet.scale}", remedy)
    remedy = "give A3" if sheet.paper == "A4" else "ask for fewer lightening holes"
    return recipe.error(f"{field}.paper", "the dimensions of the part do not fit", sheet.paper, remedy)


def _base(job: Job) -> tuple[str, float] | None:
    """Name and radius, mm, of the base circle, else of the circle of the contour's least distance from the shaft.

    None where that distance is no more than the tolerance.
    """
    from camgeo.curve.measures import nearest

    surface, contour = job.design.contours[0]
    for name, radius in job.design.exact.circles(surface.name):
        if name == "base circle" and radius is not None:
            return name, radius
    least = nearest(contour).value
    return ("least circle", least) if least > job.recipe.export.tolerance else None


def _mass(run: RunResults, rank: int) -> str:
    """Mass of a disc in words, empty where no density is given."""
    balances = run.findings.balances
    if len(balances) != len(run.design.discs):
        return ""
    mass = balances[rank].mass
    return f"{1000.0 * mass:.4g} g" if mass < 1.0 else f"{mass:.4g} kg"


def _zone(recipe: Recipe, tolerance: Tolerance) -> Zone:
    """Permitted error of a spline through the table: a tenth of the profile's zone, else the files' tolerance."""
    if tolerance.width is None:
        return Zone(recipe.export.tolerance, stated=False)
    return Zone(SHARE * tolerance.width, stated=True)


def _notes(drawn: DrawnDisc, recipe: Recipe, table: SheetTable, *, wide: float, full: bool) -> list[str]:
    """Notes on the first page, in words."""
    body, part = drawn.body, drawn.part
    clockwise = recipe.rotation == "cw"
    sense, count = ("clockwise", "the other way") if clockwise else ("counter-clockwise", "the same way")
    by = "the table, or " if table.exact else ""
    notes = [
        f"The contour is theoretically exact by {by}the DXF of this drawing: layer CUT, 1 : 1.",
        f"0° marks the start of the motion. The shaft turns {sense}, as drawn; angles count {count}.",
    ]
    if body.edge:
        notes.append(f"Edges of the contour: chamfer {number(body.edge)} × 45°, both sides.")
    if body.thickness is None:
        notes.append("The thickness is not stated.")
    keyway = part.of(Keyway)
    if keyway is not None and keyway.standard:
        notes.append("Keyway: width and depth of DIN 6885-1.")
    if body.pocket is not None:
        notes.append("The groove is milled from the upper face; both flanks are contours of the table.")
    if not full:
        notes.append("No page at 1 : 1: the part is larger than A0.")
    return [line for note in notes for line in wrap(note, wide)]
