"""The contours of a file by the surfaces of a cam, as the judge reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour

LOOKS = 36  # shaft angles at which the judge looks at a file here: `verify` judges it


def read_contours(recipe: Recipe, design: Design, path: Path) -> dict[str, Contour]:
    """Contour of each surface of a cam on one disc, by its name, from a drawing or a solid.

    Raises CallError for a file that is none, has another suffix or lacks a contour, and for a cam of several discs.
    """
    from camgeo.synthesis.intent import intended, permitted
    from kin.judge.verify import verify
    from kin.numeric.errors import CamgeoError

    shown = escaped(str(path))
    if len(design.discs) > 1:
        raise CallError(f"{shown}: parts of a cam of several discs are simulated on the exact contours; give no file")
    meant, limits = intended(recipe, design), permitted(recipe, recipe.export.tolerance)
    try:
        verdict = verify(path, meant, LOOKS, limits, recipe.unstated(path))
    except (OSError, CamgeoError, ValueError) as error:
        raise CallError(f"{shown}: {getattr(error, 'strerror', None) or error}") from error
    contours = {surface.name: surface.contour for surface in verdict.surfaces if surface.contour is not None}
    missing = [surface.name for surface in meant.surfaces if surface.name not in contours]
    if missing or not contours:
        why = next((check.detail for check in verdict.checks if not check.ok), "it holds no contour")
        raise CallError(f"{shown}: {why}")
    return contours
