"""From a recipe to files on disk and a verdict on them: the plan, its stages, the report.

Each stage runs only where something asks for it, and imports what it needs when it runs; what nothing asks for is
listed as skipped, with the reason. Files are written into a private folder, read back there by kin, and put in their
place only when every check holds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from camgeo.curve import CurveError
from camgeo.design import Clock, Design, designed, intended, permitted
from camgeo.fit.bound import FormError
from camgeo.fit.nodes import ToleranceError
from camgeo.outlines import Outlines, formula_rounding
from camgeo.recipe.model import NO_CONTOUR, ConstantBreadthCam, DoubleRollerCam, FlatPairCam, SupportCam
from camgeo.report.document import FileResult, Findings, document, encoded

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.files.dxf import Reference
    from camgeo.fit.pieces import Bound, Outline, Polygon
    from camgeo.page.content import Content
    from camgeo.part.body import Body
    from camgeo.recipe.errors import RecipeErrors
    from camgeo.recipe.model import FileRequest, Recipe
    from kin.check import Check

REPORT = "report.json"
COARSE = 1e-2  # mm: tolerance of the pitch curve drawn for reference, which nothing is cut by


@dataclass(frozen=True)
class Outcome:
    """What became of one recipe: its report, whether every check held, and the folder with its files (None if none)."""

    report: dict[str, Any]
    ok: bool
    folder: Path | None


def export(
    recipe: Recipe, out: Path, *, only: tuple[str, ...] = (), told: Callable[[str], None] | None = None
) -> Outcome:
    """Write and judge a recipe's files under `out`/<name>; see the module.

    Raises RecipeErrors where no such curve exists or a tolerance cannot be held, SurroundingsError where the disk does
    not do what it should. A failed check raises nothing: the set goes to `out`/<name>.rejected.
    """
    from camgeo.store import Run

    clock = Clock(told)
    requests = tuple(r for r in recipe.export.files if not only or r.kind in only)
    with Run(out, recipe.name) as run:
        _, found = _produced(recipe, requests, run.folder, clock)
        kept = run.kept() if only else ()
        report = document(recipe, replace(found, kept=kept))
        (run.folder / REPORT).write_text(encoded(report), encoding="utf-8")
        names = [file.path.name for file in found.files]
        folder = run.commit(names, keep=kept) if found.ok else run.reject()
    return Outcome(report, found.ok, folder)


def check(recipe: Recipe, *, told: Callable[[str], None] | None = None) -> Outcome:
    """Make and judge everything in a temporary folder that is gone afterwards; raises as `export` does."""
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        _, found = _produced(recipe, recipe.export.files, Path(folder), Clock(told))
        return Outcome(document(recipe, found), found.ok, None)


def shown(recipe: Recipe, *, told: Callable[[str], None] | None = None) -> tuple[Outcome, Content]:
    """Make and judge everything as `check` does; also what a page shows of it. Raises as `export` does."""
    import tempfile
    from pathlib import Path

    clock = Clock(told)
    requests = tuple(request for request in recipe.export.files if request.kind != "html")
    with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
        design, found = _produced(recipe, requests, Path(folder), clock)
        return Outcome(document(recipe, found), found.ok, None), _content(recipe, design, found, clock)


def judged(recipe: Recipe, paths: list[Path]) -> dict[str, Any]:
    """Report on files of any origin, held against a recipe's motion; raises RecipeErrors as `export` does."""
    from camgeo.recipe.model import FileRequest
    from kin.verify import verify

    clock = Clock()
    design = designed(recipe, clock)
    checks, files = list(design.checks), []
    for path in paths:
        with clock.stage("judge"):
            tolerance = _tolerance_of(recipe, path)
            verdict = verify(path, intended(recipe, design), recipe.verify.angles, permitted(recipe, tolerance))
        request = FileRequest(verdict.kind)
        measured = verdict.measured_error
        files.append(
            FileResult(path, request, tolerance, verdict.pieces, None, measured, verdict.motion, verdict.linkage)
        )
        checks += verdict.checks
    return document(recipe, _findings(recipe, design, checks, files, clock))


def _tolerance_of(recipe: Recipe, path: Path) -> float:
    """Tolerance in mm that the recipe gives a file of this name; that of the export for any other."""
    files = recipe.export.files
    own = [request.tolerance for request in files if request.filename(recipe.name, files) == path.name]
    return next((tolerance for tolerance in own if tolerance is not None), recipe.export.tolerance)


def _produced(recipe: Recipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> tuple[Design, Findings]:
    """All stages: design, fits, files, verdicts, page."""
    design = designed(recipe, clock)
    checks = list(design.checks)
    files: list[FileResult] = []
    if design.contour is not None:
        outlines = Outlines(design.contour, clock, formula_rounding(design.intent, design.contour))
        for request in requests:  # an STL that single precision cannot hold is refused before anything is fitted
            if request.kind == "stl":
                _aim(recipe, request, design)
        for request in requests:
            path = folder / request.filename(recipe.name, recipe.export.files)
            if request.kind == "html":
                continue  # it tells of all the others
            if request.kind == "csv":
                if design.driven is not None and not design.driven.turns:
                    continue  # told as skipped: over the shaft angle there is no motion
                with clock.stage("table"):
                    _write_table(recipe, design, path)
                files.append(FileResult(path, request, None, None, None, None, None))
                continue
            file, verdicts = drawn(recipe, design, request, path, outlines)
            files.append(file)
            checks += verdicts
    found = _findings(recipe, design, checks, files, clock, skipped=_skipped(recipe, requests, design))
    for request in requests:
        if request.kind == "html":
            path = folder / request.filename(recipe.name, recipe.export.files)
            found = _with_page(recipe, design, found, FileResult(path, request, None, None, None, None, None), clock)
    return design, found


def _with_page(recipe: Recipe, design: Design, found: Findings, file: FileResult, clock: Clock) -> Findings:
    """Write the page on everything that was found; it is there also where no cam is made."""
    from camgeo.page.page import page

    gathered = _content(recipe, design, found, clock)
    with clock.stage("write html"):
        file.path.write_bytes(page(recipe, gathered, document(recipe, found)).encode("utf-8"))
    return replace(found, files=(*found.files, file), stages=tuple(clock.stages))


def _content(recipe: Recipe, design: Design, found: Findings, clock: Clock) -> Content:
    from camgeo.page.content import content

    with clock.stage("page"):
        return content(recipe, design, [file.path for file in found.files if file.request.kind not in NO_CONTOUR])


def _findings(
    recipe: Recipe,
    design: Design,
    checks: list[Check],
    files: list[FileResult],
    clock: Clock,
    *,
    skipped: tuple[tuple[str, str], ...] = (),
) -> Findings:
    """Everything that a run found."""
    linkage = None
    if design.driven is not None:
        from camgeo.report.linkage import linkage_section

        with clock.stage("figures of the linkage"):
            linkage = linkage_section(recipe, design.driven, files)
    train = None
    if recipe.dynamics is not None:
        from camgeo.dynamics import dynamics_of

        with clock.stage("dynamics"):
            train = dynamics_of(recipe, design, [file.path for file in files])
        checks = [*checks, *train.checks]
    return Findings(
        tuple(checks),
        tuple(files),
        tuple(clock.stages),
        skipped,
        design.follower,
        linkage=linkage,
        dynamics=None if train is None else train.section,
    )


def drawn(
    recipe: Recipe,
    design: Design,
    request: FileRequest,
    path: Path,
    outlines: Outlines,
) -> tuple[FileResult, list[Check]]:
    """Fit, write, read back and judge one drawing or solid."""
    from camgeo.files.triangulate import RegionError

    clock = outlines.clock
    tolerance = request.tolerance or recipe.export.tolerance
    aim = _aim(recipe, request, design)
    try:
        outline = outlines.within(request.as_ or "polyline", aim)
        drawn = outline.mirrored() if recipe.rotation == "ccw" else outline
        with clock.stage(f"write {request.kind}"):
            if request.kind == "stl":
                bound, pieces = _write_stl(recipe, design, drawn, path, tolerance)
            else:
                _write_drawing(recipe, design, drawn, request, path)
                bound, pieces = outline.bound, outline.count
    except ToleranceError as error:
        raise _refused(recipe, request, error) from error
    except FormError as error:
        where = f"export.files[{recipe.export.files.index(request)}].{request.kind}.as"
        raise recipe.error(where, str(error), f"'{request.as_}'", "give spline or arcs") from error
    except RegionError as error:
        field_path = "part" if design.body else "cam" if recipe.part.bore is None else "part.bore"
        raise recipe.error(field_path, f"within the tolerance, {error}") from error
    except CurveError as error:
        raise recipe.error("cam", str(error)) from error
    with clock.stage(f"judge {request.kind}"):
        from kin.verify import verify

        verdict = verify(path, intended(recipe, design), recipe.verify.angles, permitted(recipe, tolerance))
    return (
        FileResult(path, request, tolerance, pieces, bound, verdict.measured_error, verdict.motion, verdict.linkage),
        list(verdict.checks),
    )


def _refused(recipe: Recipe, request: FileRequest, error: ToleranceError) -> RecipeErrors:
    """Turn a tolerance that cannot be held into an error at the field that asks for it."""
    index = recipe.export.files.index(request)
    where = f"export.files[{index}]" if request.tolerance is not None else "export.tolerance"
    reached = f"{error.reached:.3g} mm are {error.reached / recipe.mm:.3g} in" if recipe.units == "inch" else ""
    return recipe.error(where, str(error), None, reached)


def _aim(recipe: Recipe, request: FileRequest, design: Design) -> float:
    """Tolerance left to the fit: all of it, or what rounding to single precision and a chamfer leave of it.

    Raises RecipeErrors where that is nothing.
    """
    tolerance = request.tolerance or recipe.export.tolerance
    contour = design.contour
    if request.kind != "stl" or contour is None:
        return tolerance
    import numpy as np

    from camgeo.files.stl import fit_tolerance

    size = float(np.abs(contour.sample(contour.cells.low).point).max())
    # between two samples the contour reaches a little farther
    try:
        return fit_tolerance(tolerance, 1.01 * size) * (design.body.fineness if design.body else 1.0)
    except ToleranceError as error:
        raise _refused(recipe, request, error) from error


def _write_stl(recipe: Recipe, design: Design, polygon: Outline, path: Path, tolerance: float) -> tuple[Bound, int]:
    from camgeo.files.stl import write_stl
    from camgeo.fit.pieces import Polygon

    if not isinstance(polygon, Polygon):
        raise TypeError("a solid is made of a polygon")
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "an STL needs a thickness")
    if design.body is not None:
        return _write_part(recipe, design.body, polygon, path, tolerance)
    facts = write_stl(
        path,
        polygon,
        bore=recipe.part.bore,
        thickness=recipe.part.thickness,
        tolerance=tolerance,
        about=recipe.name,
    )
    return facts.bound, facts.vertices


def _write_part(recipe: Recipe, body: Body, polygon: Polygon, path: Path, tolerance: float) -> tuple[Bound, int]:
    """Write the solid of a part that has more than a round bore."""
    from camgeo.files.missing import MissingExtraError
    from camgeo.part.files import write_part
    from camgeo.store import SurroundingsError

    drawn = body.mirrored() if recipe.rotation == "ccw" else body
    try:
        facts = write_part(path, polygon, drawn, tolerance=tolerance, about=recipe.name)
    except MissingExtraError as error:
        raise SurroundingsError(str(error), recipe.path) from error
    return facts.bound, facts.vertices


def _write_drawing(recipe: Recipe, design: Design, outline: Outline, request: FileRequest, path: Path) -> None:
    bore, cut, remarks = recipe.part.bore, [], []
    if design.body is not None:
        from camgeo.part import files

        body = design.body.mirrored() if recipe.rotation == "ccw" else design.body
        bore, cut, remarks = None, files.cutouts(body), files.remarks(body, recipe.mm)
    if request.kind == "svg":
        from camgeo.files.svg import write_svg

        write_svg(
            path,
            outline,
            bore=bore,
            cutouts=cut,
            remarks=remarks,
            mm=recipe.mm,
            name=recipe.name,
            about=recipe.about,
        )
        return
    from camgeo.files.dxf import write_dxf

    write_dxf(
        path,
        outline,
        bore=bore,
        cutouts=cut,
        remarks=remarks,
        reference=_reference(recipe, design),
        mm=recipe.mm,
        version=request.version or "R2010",
        name=recipe.name,
        about=recipe.about,
    )


def _reference(recipe: Recipe, design: Design) -> list[Reference]:
    """Centre, base or prime circle, and the pitch curve: to look at, not to cut."""
    import numpy as np

    from camgeo.files.dxf import Circle, Point, Trace
    from camgeo.fit.arcs import fit_arcs

    cam = recipe.cam
    found: list[Reference] = [Point("shaft", (0.0, 0.0))]
    if recipe.part.hub is not None:
        found.append(Circle("hub", (0.0, 0.0), 0.5 * recipe.part.hub.diameter))
    base = design.profile.base.sample(design.profile.base.cells.low).point
    if isinstance(cam, ConstantBreadthCam):
        found.append(Circle("base circle", (0.0, 0.0), cam.base_radius))
    elif isinstance(cam, SupportCam):
        radius = float(np.hypot(base[:, 0], base[:, 1]).min())
        if radius > 0.0:  # the shaft may stand on the contour itself
            found.append(Circle("base circle", (0.0, 0.0), radius))
    elif isinstance(cam, DoubleRollerCam):
        found.append(Circle("prime circle", (0.0, 0.0), float(np.hypot(base[:, 0], base[:, 1]).min())))
        pitch = fit_arcs(design.profile.base, COARSE)
        found.append(Trace("pitch curve", pitch.mirrored() if recipe.rotation == "ccw" else pitch))
        found.append(Circle("pivot circle", (0.0, 0.0), cam.arm))
    elif isinstance(cam, FlatPairCam):
        found.append(Circle("pivot circle", (0.0, 0.0), 2.0 * cam.arm))
    return found


def _write_table(recipe: Recipe, design: Design, path: Path) -> None:
    from camgeo.files.table import write_table

    if design.driven is not None:
        from camgeo import linkage

        columns, rows = linkage.motion_table(recipe, design.driven.mechanism)
    else:
        from camgeo.motion import motion_table

        columns, rows = motion_table(recipe, design.intent)
    write_table(path, columns, rows)


def _skipped(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> tuple[tuple[str, str], ...]:
    """What was left out, with the reason."""
    found = []
    asked = {request.kind for request in recipe.export.files}
    wanted = {request.kind for request in requests}
    for kind in ("dxf", "svg", "stl", "csv", "html"):
        if kind not in asked:
            found.append((kind, "the recipe's export.files does not list it"))
        elif kind not in wanted:
            found.append((kind, "left out by --only"))
    if design.contour is None:
        found.append(("files", "a check of the exact contour fails"))
    if recipe.part.bore is None:
        found.append(("bore", "part.bore is not given"))
    swings = design.follower in {"double roller", "flat pair"}
    if design.follower == "flat face":
        found.append(("constant-breadth", "the breadth is not constant: a single flat face follows"))
    if recipe.dynamics is None:
        found.append(("dynamics", "dynamics is not given"))
    if design.follower != "double roller":
        found.append(("pressure-angle", "a flat face is pushed along its normal"))
        found.append(("undercut-global", "a convex profile meets itself nowhere else"))
    if swings:
        found.append(("face-length", "the follower has no plate that moves along its normal"))
    else:
        found += [(name, "the follower does not swing") for name in ("closing-equation", "transmission")]
    found += _skipped_of_linkage(recipe, design)
    if design.trimmed and recipe.verify.motion_error is None:
        found.append(("motion", "the contour is trimmed and verify.motion_error is not given: told, not judged"))
    return tuple(found)


def _skipped_of_linkage(recipe: Recipe, design: Design) -> list[tuple[str, str]]:
    """What was left out of a linkage's motion."""
    if design.driven is None:
        return [("linkage", "linkage is not given")]
    if not design.driven.turns:
        why = "the mechanism does not turn: it has no motion over the shaft angle"
        asked = ["csv"] if any(request.kind == "csv" for request in recipe.export.files) else []
        return [(what, why) for what in ("linkage-error", *asked)]
    found = [("dwell", "dwell is not given")] if recipe.dwell is None else []
    if design.trimmed and recipe.verify.output_error is None:
        found.append(("linkage-error", "the contour is trimmed and verify.output_error is not given: told, not judged"))
    return found
