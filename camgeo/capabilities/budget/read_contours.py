"""Contours on which parts are simulated in place of exact curves: those of files, and those with trimmed undercut."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.budget.contact import LostError
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour

LOOKS = 36  # shaft angles at which the judge examines a file here; only its contour is used
TRIMMED_WITHIN = 1e-6  # mm: distance of fitted arcs from a trimmed contour


def read_contours(recipe: Recipe, design: Design, paths: Sequence[Path]) -> dict[str, Contour]:
    """Contour of each surface of a cam, by its name, from one drawing or solid of each disc, or one of all discs.

    Raises CallError for a file that cannot be read, is no drawing or solid, is compensated for a kerf or a shrinkage,
    or lacks a contour, and for files that were not made together.
    """
    from camgeo.output.file_intent import shaft_of_file
    from camgeo.output.sets import sets_of
    from camgeo.synthesis.intent import permitted
    from kin.judge.together import DiscFile, verify_set
    from kin.numeric.errors import CamgeoError
    from kin.read.errors import ReadError
    from kin.read.formats import format_of

    # the suffix of each file must be that of a drawing or a solid
    try:
        for path in paths:
            format_of(path)
    except ValueError as error:
        raise CallError(escaped(str(error))) from error
    # the judge assigns the contours of the files to the cam's surfaces
    shown = ", ".join(escaped(str(path)) for path in paths)
    try:
        first, *further = sets_of(recipe, paths, recipe.export.tolerance)
        intent = shaft_of_file(recipe, design, first.requirement.kind)
        files = [DiscFile(path, disc, recipe.unstated_unit(path)) for _, path, disc in first.files]
        verdicts = verify_set(files, intent, LOOKS, permitted(recipe, recipe.export.tolerance))
    except ReadError as error:
        raise CallError(f"{escaped(str(error.path))}: {error.message}") from error
    except (OSError, CamgeoError, ValueError) as error:
        raise CallError(f"{shown}: {getattr(error, 'strerror', None) or error}") from error
    if further:
        raise CallError(f"{shown}: give one file, or one of each disc that were made together")
    request = first.requirement.request
    if request is not None and request.compensation is not None:
        raise CallError(f"{shown}: its contour is not the cam's ({request.compensation.tags}); give a nominal file")
    # all surfaces of the cam must have a contour
    surfaces = [surface for verdict in verdicts for surface in verdict.surfaces]
    contours = {surface.name: surface.contour for surface in surfaces if surface.contour is not None}
    missing = [surface.name for part in intent.parts for surface in part.surfaces if surface.name not in contours]
    if missing or not contours:
        checks = (check for verdict in verdicts for check in verdict.checks)
        lack = f"it holds no contour {missing[0]}; give a file of each disc" if contours else "it holds no contour"
        raise CallError(f"{shown}: {next((check.detail for check in checks if not check.ok), lack)}")
    return contours


def trimmed_contours(design: Design) -> dict[str, Contour]:
    """Contour of each surface of a design with trimmed undercut, by its name, as arcs within 1e-6 mm of it.

    Raises LostError where no arcs hold that tolerance.
    """
    from camgeo.fit.arcs import fit_arcs
    from camgeo.fit.nodes import ToleranceError
    from kin.contour.contour import Contour

    try:
        fits = {surface.name: fit_arcs(curve, TRIMMED_WITHIN) for surface, curve in design.contours}
    except ToleranceError as error:
        raise LostError(f"parts are not simulated on the trimmed contour: {error}") from error
    return {name: Contour.from_bulges(fit.points, fit.bulges) for name, fit in fits.items()}
