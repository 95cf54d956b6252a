"""From a recipe to files on disk and a verdict on them: the plan, its stages, the report.

Each stage runs only where something asks for it, and imports what it needs when it runs; what nothing asks for is
listed as skipped, with the reason. Files are written into a private folder, read back there by kin, and put in their
place only when every check holds.
"""

from __future__ import annotations

import math
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from camgeo.curve import CurveError
from camgeo.fit.nodes import ToleranceError
from camgeo.profile.build import Profile, intent_of, profile_of
from camgeo.recipe.model import ConstantBreadthCam, DoubleRollerCam, FlatPairCam, SupportCam
from camgeo.report.document import FileResult, Findings, document, encoded
from kin.check import Check, degrees

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from camgeo.curve import Curve
    from camgeo.files.dxf import Reference
    from camgeo.fit.pieces import Outline, Polygon
    from camgeo.recipe.model import FileRequest, Recipe
    from kin.lift import Lift
    from kin.transmission import Transmission
    from kin.verify import Intent, Limits

REPORT = "report.json"
COARSE = 1e-2  # mm: tolerance of the pitch curve drawn for reference, which nothing is cut by


@dataclass(frozen=True)
class Outcome:
    """What became of one recipe: its report, whether every check held, and the folder with its files (None if none)."""

    report: dict[str, Any]
    ok: bool
    folder: Path | None


@dataclass
class Clock:
    """Seconds of each stage in order; `told` hears of each as it begins."""

    told: Callable[[str], None] | None = None
    stages: list[tuple[str, float]] = field(default_factory=list)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time one stage."""
        if self.told is not None:
            self.told(name)
        start = time.perf_counter()
        try:
            yield
        finally:
            self.stages.append((name, time.perf_counter() - start))


@dataclass(frozen=True)
class Design:
    """The exact cam of a recipe: intent, profile, the contour to be made, and the checks that need no file."""

    intent: Lift | Transmission
    profile: Profile
    contour: Curve | None
    checks: tuple[Check, ...]
    follower: str
    yoke_breadth: float | None
    trimmed: bool


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
        found = _produced(recipe, requests, run.folder, clock)
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
        found = _produced(recipe, recipe.export.files, Path(folder), Clock(told))
        return Outcome(document(recipe, found), found.ok, None)


def judged(recipe: Recipe, paths: list[Path]) -> dict[str, Any]:
    """Report on files of any origin, held against a recipe's motion; raises RecipeErrors as `export` does."""
    from camgeo.recipe.model import FileRequest
    from kin.check import about
    from kin.verify import verify

    clock = Clock()
    design = designed(recipe, clock)
    checks, files = list(design.checks), []
    for path in paths:
        with clock.stage("judge"):
            limits = _limits(recipe, recipe.export.tolerance)
            verdict = verify(path, intended(recipe, design), recipe.verify.angles, limits)
        request = FileRequest("stl" if verdict.kind == "stl" else "dxf")
        files.append(
            FileResult(
                path, request, recipe.export.tolerance, verdict.pieces, None, verdict.measured_error, verdict.motion
            )
        )
        checks += [about(check, path.name) for check in verdict.checks]
    return document(recipe, Findings(tuple(checks), tuple(files), tuple(clock.stages), (), design.follower))


def _produced(recipe: Recipe, requests: tuple[FileRequest, ...], folder: Path, clock: Clock) -> Findings:
    """All stages: design, fits, files, verdicts."""
    design = designed(recipe, clock)
    checks = list(design.checks)
    files: list[FileResult] = []
    contour = design.contour
    if contour is not None:
        outlines: dict[tuple[str, float], Outline] = {}
        for request in requests:
            path = folder / request.filename(recipe.name, recipe.export.files)
            if request.kind == "csv":
                with clock.stage("table"):
                    _write_table(recipe, design, path)
                files.append(FileResult(path, request, None, None, None, None, None))
                continue
            file, verdicts = _drawn(recipe, design, contour, request, path, outlines, clock)
            files.append(file)
            checks += verdicts
    return Findings(
        tuple(checks), tuple(files), tuple(clock.stages), _skipped(recipe, requests, design), design.follower
    )


def designed(recipe: Recipe, clock: Clock | None = None) -> Design:
    """Intent, curve and exact checks of a recipe; raises RecipeErrors where there is no such motion or curve."""
    from kin.law import IntentError

    clock = clock or Clock()
    cam = recipe.cam
    with clock.stage("motion"):
        try:
            intent = intent_of(cam)
        except IntentError as error:
            raise recipe.error(f"cam.{error.field}", error.message) from error
    try:
        with clock.stage("profile"):
            profile = profile_of(cam, intent)
        with clock.stage("undercut"):
            checks, contour = _sound(recipe, profile, intent)
    except CurveError as error:
        raise recipe.error("cam", str(error)) from error
    with clock.stage("figures"):
        breadth, follower, more = _figures(recipe, intent, profile)
    if contour is not None:
        more += _wall(recipe, contour, intent)
    trimmed = contour is not None and not contour.closed
    return Design(intent, profile, contour, (*checks, *more), follower, breadth, trimmed)


def _sound(recipe: Recipe, profile: Profile, intent: Lift | Transmission) -> tuple[list[Check], Curve | None]:
    """Checks of curvature and undercut, and the contour to be made: None where undercut refuses it."""
    from camgeo.radius import least_radius
    from camgeo.trim import UndercutError, trimmed
    from camgeo.undercut import undercuts

    trim = recipe.cam.undercut == "trim"
    radius, at = least_radius(profile.base)
    checks = [
        Check(
            "radius-of-curvature",
            trim or radius > profile.roller_radius,
            radius,
            profile.roller_radius,
            "mm",
            _shaft_deg(intent, at),
            "at_least",
        )
    ]
    try:
        found = undercuts(profile.curve)
        contour = trimmed(profile.curve) if trim and found else profile.curve
    except UndercutError as error:
        checks.append(Check("undercut-local", False, None, 0.0, "mm", None, detail=str(error)))
        return checks, None
    for kind in ("local", "global"):
        cuts = [cut for cut in found if cut.kind == kind]
        if kind == "global" and profile.roller_radius == 0.0 and not cuts:
            continue
        worst = max(cuts, key=lambda cut: cut.depth, default=None)
        if worst is None:
            checks.append(Check(f"undercut-{kind}", True, 0.0, 0.0, "mm"))
            continue
        mm = recipe.mm
        free = (
            f"a roller radius of {worst.free_at / mm:.6g} would be free of it"
            if profile.roller_radius
            else f"a base radius larger by {worst.free_at / mm:.6g} would be free of it"
        )
        first, last = _shaft_deg(intent, worst.start), _shaft_deg(intent, worst.end)
        detail = f"from {first:.6g} to {last:.6g} deg; {free}" + ("; trimmed" if trim else "")
        depth = worst.depth if math.isfinite(worst.depth) else None
        checks.append(Check(f"undercut-{kind}", trim, depth, 0.0, "mm", _shaft_deg(intent, worst.at), detail=detail))
    sound = trim or not found
    return checks, contour if sound else None


def _shaft_deg(intent: Lift | Transmission, parameter: float) -> float:
    """Shaft angle in degrees of a parameter of the profile."""
    at = getattr(intent, "at", None)
    phi = parameter if at is None else float(at(parameter, 0)[0][0, 0])
    found = degrees(phi)
    return 0.0 if found is None else found


def _figures(
    recipe: Recipe, intent: Lift | Transmission, profile: Profile
) -> tuple[float | None, str, list[Check]]:
    """Breadth of the yoke if there is one, the follower's name, and the checks of the intended motion."""
    from camgeo.figures import breadth_of, flat_face_checks, is_constant_breadth, pressure_angle, transmission_checks

    cam = recipe.cam
    if isinstance(cam, DoubleRollerCam):
        return None, "double roller", [*transmission_checks(intent), pressure_angle(profile, intent)]
    if isinstance(cam, FlatPairCam):
        return None, "flat pair", transmission_checks(intent)
    yoke = isinstance(cam, ConstantBreadthCam) or is_constant_breadth(intent)
    breadth = breadth_of(intent)[0] if yoke else None
    return breadth, "yoke" if yoke else "flat face", flat_face_checks(intent, yoke=yoke)


def _wall(recipe: Recipe, contour: Curve, intent: Lift | Transmission) -> list[Check]:
    """Least wall between bore and contour, where there is a bore."""
    if recipe.part.bore is None:
        return []
    from camgeo.part import least_wall

    wall, at = least_wall(contour, recipe.part.bore)
    at_deg = _shaft_deg(intent, at)
    return [Check("wall", wall > 0.0, wall, 0.0, "mm", at_deg, "at_least")]


def _drawn(
    recipe: Recipe,
    design: Design,
    contour: Curve,
    request: FileRequest,
    path: Path,
    outlines: dict[tuple[str, float], Outline],
    clock: Clock,
) -> tuple[FileResult, list[Check]]:
    """Fit, write, read back and judge one DXF or STL."""
    tolerance = request.tolerance or recipe.export.tolerance
    field_path = f"export.files[{recipe.export.files.index(request)}]"
    try:
        aim = _aim(request, contour, tolerance)
        form = request.as_ or "polyline"
        if (form, aim) not in outlines:
            with clock.stage(f"fit {form}"):
                outlines[form, aim] = _fitted(form, contour, aim)
        outline = outlines[form, aim]
        drawn = outline.mirrored() if recipe.rotation == "ccw" else outline
        with clock.stage(f"write {request.kind}"):
            if request.kind == "stl":
                bound, pieces = _write_stl(recipe, drawn, path, tolerance)
            else:
                _write_dxf(recipe, design, drawn, request, path)
                bound, pieces = outline.bound, outline.count
    except ToleranceError as error:
        where = field_path if request.tolerance is not None else "export.tolerance"
        raise recipe.error(where, str(error), None, f"at least {error.reached / recipe.mm:.3g}") from error
    with clock.stage(f"judge {request.kind}"):
        from kin.check import about
        from kin.verify import verify

        verdict = verify(path, intended(recipe, design), recipe.verify.angles, _limits(recipe, tolerance))
    return (
        FileResult(path, request, tolerance, pieces, bound, verdict.measured_error, verdict.motion),
        [about(check, path.name) for check in verdict.checks],
    )


def _limits(recipe: Recipe, tolerance: float) -> Limits:
    """What kin permits: the tolerance, and the recipe's own limit of the motion error (degrees for a swing)."""
    from kin.verify import Limits

    motion = recipe.verify.motion_error
    if motion is not None and isinstance(recipe.cam, DoubleRollerCam | FlatPairCam):
        motion = math.degrees(motion)
    return Limits(tolerance, motion)


def intended(recipe: Recipe, design: Design) -> Intent:
    """What kin is told of the part: the follower with its law, and how the part is drawn."""
    from kin import follower
    from kin.verify import Intent

    cam = recipe.cam
    held: follower.Follower
    if isinstance(cam, DoubleRollerCam):
        held = follower.DoubleRoller(design.intent, cam.roller_radius)
    elif isinstance(cam, FlatPairCam):
        held = follower.FlatPair(design.intent)
    elif design.yoke_breadth is not None:
        held = follower.Yoke(design.intent, breadth=design.yoke_breadth)
    else:
        held = follower.FlatFace(design.intent)
    return Intent(
        follower=held,
        mm=recipe.mm,
        mirrored=recipe.rotation == "ccw",
        bore=recipe.part.bore,
        thickness=recipe.part.thickness,
        trimmed=design.trimmed,
    )


def _aim(request: FileRequest, contour: Curve, tolerance: float) -> float:
    """Tolerance left to the fit: all of it, or what rounding to single precision leaves of it."""
    if request.kind != "stl":
        return tolerance
    import numpy as np

    from camgeo.files.stl import fit_tolerance

    size = float(np.abs(contour.sample(contour.cells.low).point).max())
    # between two samples the contour reaches a little farther
    return fit_tolerance(tolerance, 1.01 * size)


def _fitted(form: str, contour: Curve, tolerance: float) -> Outline:
    if form == "arcs":
        from camgeo.fit.arcs import fit_arcs

        return fit_arcs(contour, tolerance)
    if form == "spline":
        from camgeo.fit.spline import fit_spline

        return fit_spline(contour, tolerance)
    from camgeo.fit.polygon import fit_polygon

    return fit_polygon(contour, tolerance)


def _write_stl(recipe: Recipe, polygon: Polygon, path: Path, tolerance: float) -> tuple[Any, int]:
    from camgeo.files.stl import write_stl

    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "an STL needs a thickness")
    facts = write_stl(
        path,
        polygon,
        bore=recipe.part.bore,
        thickness=recipe.part.thickness,
        tolerance=tolerance,
        about=recipe.name,
    )
    return facts.bound, facts.vertices


def _write_dxf(recipe: Recipe, design: Design, outline: Outline, request: FileRequest, path: Path) -> None:
    from camgeo.files.dxf import write_dxf

    write_dxf(
        path,
        outline,
        bore=recipe.part.bore,
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
    base = design.profile.base.sample(design.profile.base.cells.low).point
    if isinstance(cam, ConstantBreadthCam):
        found.append(Circle("base circle", (0.0, 0.0), cam.base_radius))
    elif isinstance(cam, SupportCam):
        found.append(Circle("base circle", (0.0, 0.0), float(np.hypot(base[:, 0], base[:, 1]).min())))
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
    from camgeo.motion import motion_table

    columns, rows = motion_table(recipe, design.intent)
    write_table(path, columns, rows)


def _skipped(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> tuple[tuple[str, str], ...]:
    """What was left out, with the reason."""
    found = []
    asked = {request.kind for request in recipe.export.files}
    wanted = {request.kind for request in requests}
    for kind in ("dxf", "stl", "csv"):
        if kind not in asked:
            found.append((kind, "the recipe's export.files does not list it"))
        elif kind not in wanted:
            found.append((kind, "left out by --only"))
    if design.contour is None:
        found.append(("files", "the contour undercuts and undercut is refuse"))
    if recipe.part.bore is None:
        found.append(("bore", "part.bore is not given"))
    if design.follower == "flat face":
        found.append(("constant-breadth", "the breadth is not constant: a single flat face follows"))
    if design.follower in {"flat face", "yoke"}:
        found.append(("pressure-angle", "a flat face moves along its normal"))
        found.append(("undercut-global", "a convex profile meets itself nowhere else"))
    else:
        found.append(("face-length", "the follower's faces are not parallel plates"))
    return tuple(found)
