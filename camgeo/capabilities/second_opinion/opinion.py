"""A second opinion on files: checks by ezdxf, shapely, trimesh and manifold3d, beside the judge's own.

Other programs open files with these libraries. They are imported here alone, when a second opinion is requested:
reading and judging do without them (docs/architecture.md). The contour comes from kin's reader, the exact one from the
design as a polygon with a proved bound; meshes are read by trimesh itself.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.capabilities.second_opinion.checks import (
    AUDIT,
    CONTOUR_AREA,
    CONTOUR_DISTANCE,
    CONTOUR_VALID,
    MESH_BODIES,
    MESH_STATUS,
    MESH_VOLUME,
    MESH_WATERTIGHT,
    MESH_WINDING,
    SECOND_OPINIONS,
    reason_without,
)
from camgeo.checks.declared import READABLE
from camgeo.common.errors import SurroundingsError
from camgeo.files.errors import demand_uninterrupted, install
from camgeo.fit.nodes import MOST_PIECES, ToleranceError
from camgeo.fit.pieces import Polygon
from camgeo.measures.extension import Results
from camgeo.output.file_intent import shaft_of_file
from camgeo.output.job import Job
from camgeo.output.skipped import scene_of
from kin.numeric.check import Check, about, as_drawn, at_most, failed
from kin.numeric.lengths import UNIT, place_words
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.common.clock import Clock
    from camgeo.fit.cache import Fits
    from camgeo.measures.file_result import FileResult
    from camgeo.output.skipped import Skipped
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour
    from kin.judge.intent import PartIntent
    from kin.numeric.arrays import Array

MOST_NAMED = 5  # faults named in a message
MOST_TRIANGLES = 200_000  # with more, trimesh and manifold3d take many seconds
SHARE = 0.1  # of the tolerance: distance of the polygons from the exact contour and from that of the file
NOTHING = "there is nothing to measure, or to hold it against"
UNMADE = "a check of the exact contour fails"
LIBRARIES = ("shapely", "trimesh", "scipy.sparse", "networkx", "lxml", "manifold3d")


class _Skip(Exception):  # noqa: N818 - no error: a row that is left out, with the reason
    """A library's rows on one file are left out, for the reason in its message."""


def demand_libraries(recipe: Recipe) -> None:
    """Import all libraries of a second opinion, whatever the recipe asks for.

    Raises SurroundingsError, with the recipe's path and the command that installs them, where one is missing.
    """
    from importlib import import_module

    from kin.read.home import prepare_home

    prepare_home()
    for name in LIBRARIES:
        try:
            import_module(name)
        except ImportError as error:
            demand_uninterrupted(error)
            missing = name.partition(".")[0]
            raise SurroundingsError(f"a second opinion needs {missing}: {install('check')}", recipe.path) from error


def look(recipe: Recipe, design: Design, files: Sequence[FileResult], checks: Sequence[Check], clock: Clock) -> Results:
    """Checks of `files` by other libraries, and in `skipped` the files and single checks left out, with the reasons.

    `checks` are those of kin on the same files. A file that kin refuses to read is left out, since kin refuses files
    whose reading would have no bound. Without an exact contour all files are left out.
    """
    if not design.contours:
        return Results(skipped=[(f"second opinion[{file.path.name}]", UNMADE) for file in files])
    job = Job.of(recipe, design, clock)
    unread = {check.file for check in checks if check.name == READABLE.name and not check.ok}
    scene = scene_of(recipe, design)
    opinions: list[Check] = []
    skipped: list[Skipped] = []
    for file in files:
        name = file.path.name
        why = reason_without(file.request.format)
        if file.body != "cam" or file.request.holds_other_bodies:
            why = "it holds other bodies than the cam"
        elif name in unread:
            why = "the file cannot be read"
        if why:
            skipped.append((f"second opinion[{name}]", why))
            continue
        # each library gives the checks that are declared for this file
        due = [row.name for row in SECOND_OPINIONS if row.of_file is not None and row.of_file(scene, file.request)]
        with clock.stage("second opinion"):
            for libraries, judge in JUDGES:
                rows = [row for row in due if row.partition(":")[0] in libraries]
                why = NOTHING
                try:
                    with warnings.catch_warnings():  # of a volume of 0 and the like, which the rows report
                        warnings.simplefilter("ignore")
                        verdicts = judge(job, file) if rows else []
                except _Skip as skip:
                    verdicts, why = [], str(skip)
                opinions += [about(check, name) for check in verdicts]
                skipped += [(f"{row}[{name}]", why) for row in rows if row not in {check.name for check in verdicts}]
    return Results(checks=opinions, skipped=skipped)


def _audit(_: Job, file: FileResult) -> list[Check]:
    """Check by ezdxf's auditor on a DXF: the number of faults that it reports, those that it would mend included."""
    from kin.read.drawing.dxf import damage_reported, parsed

    try:
        with damage_reported(file.path):
            auditor = parsed(file.path.read_bytes(), file.path).audit()
    except ReadError as error:
        return [failed(AUDIT.name, error.message)]
    messages = [entry.message for entry in (*auditor.errors, *auditor.fixes)]
    more = [f"and {len(messages) - MOST_NAMED} more"] if len(messages) > MOST_NAMED else []
    return [at_most(AUDIT.name, len(messages), 0, "faults", detail="; ".join([*messages[:MOST_NAMED], *more]))]


# --- shapely ----------------------------------------------------------------------------------------------------------


def _compare_contours(job: Job, file: FileResult) -> list[Check]:
    """Checks of each contour of a file against the exact one, both as polygons: valid, area, distance.

    Raises _Skip where the file or the recipe has no contour, and where no polygon is within a tenth of the tolerance.
    """
    read = {surface.name: surface.contour for surface in file.surfaces if surface.contour is not None}
    if not read or file.tolerance is None:
        raise _Skip("no contour could be read from the file")
    job, failures = job.of_file(file.request)
    if failures:
        raise _Skip("there is no exact contour to compare with")
    fits = {surface.name: fit for (surface, _), fit in zip(job.design.contours, job.fits, strict=True)}
    checks: list[Check] = []
    for name, contour in read.items():
        try:
            rows = _compare_polygons(fits[name], contour, file.tolerance)
        except (ToleranceError, ValueError) as error:
            raise _Skip(f"no polygon within a tenth of the tolerance: {error}") from error
        mirrored = job.recipe.rotation == "ccw"
        checks += [as_drawn(replace(check, surface=name), mirrored=mirrored) for check in rows]
    return checks


def _compare_polygons(fit: Fits, contour: Contour, tolerance: float) -> list[Check]:
    """Checks by shapely of a contour as read against a polygon of the exact one; raises ToleranceError, ValueError."""
    import shapely

    exact = fit.within("polyline", SHARE * tolerance)
    if not isinstance(exact, Polygon):
        raise TypeError("the exact contour is compared as a polygon")
    drawn = polygon_of(contour, SHARE * tolerance)
    shape, nominal = shapely.Polygon(drawn), shapely.Polygon(exact.vertices)
    area, length = float(nominal.area), float(nominal.length)
    # area: twice the tolerance all round; distance: the tolerance, and the errors of both polygons
    reason = "" if shape.is_valid else str(shapely.is_valid_reason(shape))
    error = abs(float(shape.area) - area)
    areas = f"{float(shape.area):.9g} mm^2, of the exact contour {area:.9g}"
    farthest = max(_farthest(drawn, exact.vertices), _farthest(exact.vertices, drawn))
    place = f"at {place_words(farthest.x, farthest.y)} {UNIT}; both as polygons, each within a tenth of the tolerance"
    return [
        at_most(CONTOUR_VALID.name, 0 if shape.is_valid else 1, 0, "faults", detail=reason),
        at_most(CONTOUR_AREA.name, error, 2.0 * length * tolerance, "mm^2", detail=areas),
        at_most(CONTOUR_DISTANCE.name, farthest.distance, (1.0 + 2.0 * SHARE) * tolerance, "mm", detail=place),
    ]


def polygon_of(contour: Contour, tolerance: float) -> Array:
    """Vertices (n, 2) of a polygon within `tolerance` mm of a contour: splines as arcs, arcs as equal chords.

    Half of the tolerance is for each. Raises ValueError where more than MOST_PIECES chords are needed, or where
    rounding exceeds the tolerance.
    """
    arcs, _ = contour.as_arcs(0.5 * tolerance) if contour.beziers.count else contour.as_arcs()
    bent = np.abs(arcs.curvature)
    # the sagitta of a chord over a length s of an arc is at most s^2 kappa/8; no chord spans more than 1 rad
    parts = np.ceil(arcs.length * np.sqrt(bent / (4.0 * tolerance)))
    parts = np.maximum(parts, np.ceil(arcs.length * bent))
    if not parts.sum() <= MOST_PIECES:
        raise ValueError(f"{parts.sum():.3g} chords are needed, more than {MOST_PIECES}")
    vertices: Array = arcs.cut(np.maximum(parts, 1.0).astype(np.intp))[0].start
    return vertices


class _Distance(NamedTuple):
    """Distance from a polygon of the point x, y; all mm."""

    distance: float
    x: float
    y: float


def _farthest(points: Array, polygon: Array) -> _Distance:
    """Greatest distance of a closed polygon `points` (n, 2) from the edges of `polygon` (m, 2), with its point, mm.

    It is measured at the vertices and at the middles of the edges of `points`.
    """
    import shapely

    candidates = np.concatenate([points, 0.5 * (points + np.roll(points, -1, axis=0))])
    edges = shapely.STRtree(shapely.linestrings(np.stack([polygon, np.roll(polygon, -1, axis=0)], axis=1)))
    (place, _), distance = edges.query_nearest(shapely.points(candidates), return_distance=True, all_matches=False)
    k = int(np.argmax(distance))
    return _Distance(float(distance[k]), *map(float, candidates[place[k]]))


# --- trimesh and manifold3d -------------------------------------------------------------------------------------------


def _judge_mesh(job: Job, file: FileResult) -> list[Check]:
    """Checks by trimesh on a mesh, watertight, winding, bodies and volume, and the status by manifold3d.

    A mesh that trimesh does not read has one failed check. Raises _Skip for a file that cannot be read or has too many
    triangles.
    """
    import trimesh

    from kin.read.files import read_meshes

    try:
        count = sum(len(mesh.corners) for mesh in read_meshes(file.path))  # kin's reader is quick
    except ReadError as error:
        raise _Skip(f"the file cannot be read: {error.message}") from error
    if count > MOST_TRIANGLES:
        raise _Skip(f"{count} triangles are more than {MOST_TRIANGLES}")

    try:
        read = trimesh.load_mesh(file.path)
        closed, turned, bodies = bool(read.is_watertight), bool(read.is_winding_consistent), int(read.body_count)
        status = _status(read)
    except Exception as error:  # noqa: BLE001 - its readers raise whatever their own libraries do
        return [failed(MESH_WATERTIGHT.name, f"trimesh does not read it: {str(error) or type(error).__name__}")]
    inward = turned and float(read.volume) <= 0.0
    return [
        _no_fault(MESH_WATERTIGHT.name, closed, "not every edge has two triangles"),
        _no_fault(MESH_WINDING.name, turned and not inward, "the triangles face inward" if inward else "they differ"),
        at_most(MESH_BODIES.name, bodies, len(_discs_of(job, file)), "bodies"),
        *_volume(job, file, read),
        _no_fault(MESH_STATUS.name, status == "NoError", status),
    ]


def _status(read: Any) -> str:  # noqa: ANN401 - trimesh has no types
    """Status of a mesh by manifold3d: NoError, or its word for the fault."""
    import manifold3d

    points, triangles = np.asarray(read.vertices, np.float64), np.asarray(read.faces, np.uint64)
    return str(manifold3d.Manifold(manifold3d.Mesh64(points, triangles)).status()).rpartition(".")[2]


def _no_fault(name: str, holds: bool, why: str) -> Check:
    """Check that there is no fault: 0 faults where it `holds`, else 1, with `why` as its detail."""
    return at_most(name, 0 if holds else 1, 0, "faults", detail="" if holds else why)


def _volume(job: Job, file: FileResult, read: Any) -> list[Check]:  # noqa: ANN401 - trimesh has no types
    """Checks of the volume by trimesh against the exact one, for each disc that has a contour and a thickness.

    The list is empty for a file without a unit or a tolerance, or where a mesh of several discs has another number of
    bodies than discs.
    """
    from kin.judge.volume import layers_volume_check, volume_check

    mm, tolerance = file.units, file.tolerance
    parts = _discs_of(job, file)
    bodies = [read]
    # bodies of several discs are told apart by their lowest z
    if len(parts) > 1:
        bodies = sorted(read.split(only_watertight=False), key=lambda body: body.bounds[0][2])
    if mm is None or tolerance is None or len(bodies) != len(parts):
        return []
    checks = []
    for body, part in zip(bodies, parts, strict=True):
        names, volume = {surface.name for surface in part.surfaces}, mm**3 * float(body.volume)
        contours = [s.contour for s in file.surfaces if s.name in names and s.contour is not None]
        if not contours or part.thickness is None:
            continue
        if part.layers:
            check = layers_volume_check(volume, contours, part, tolerance)
        else:
            check = volume_check(volume, part.thickness, contours, part, tolerance)
        checks.append(replace(check, name=MESH_VOLUME.name, surface=part.name))
    return checks


def _discs_of(job: Job, file: FileResult) -> tuple[PartIntent, ...]:
    """Intents of the discs that a file holds: one for a file of one disc, else all."""
    job, _ = job.of_file(file.request)
    parts = shaft_of_file(job.recipe, job.design, file.request.kind).parts
    return parts if file.disc is None else (parts[file.disc],)


JUDGES: tuple[tuple[frozenset[str], Callable[[Job, FileResult], list[Check]]], ...] = (
    (frozenset({"ezdxf"}), _audit),
    (frozenset({"shapely"}), _compare_contours),
    (frozenset({"trimesh", "manifold3d"}), _judge_mesh),
)
"""Libraries, and the function that gives their checks of a file."""
