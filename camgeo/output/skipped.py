"""Files, checks and capabilities that a run leaves out, with the reasons."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declaration import CheckFacts
from camgeo.checks.declared import CHECKS, OUTPUT, STANDS
from camgeo.output.extension import MAKING, OUTPUTS
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

Skipped = tuple[str, str]


def skipped_items(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> tuple[Skipped, ...]:
    """Pairs (name, reason) of the formats, checks and capabilities that a run for these files leaves out."""
    skipped = _skipped_files(recipe, requests, design)
    absent = ((name, label.absent) for name, label in registry.labels().items() if name not in recipe.uses)
    skipped += [(name, why) for name, why in absent if why]
    for answers in OUTPUTS.of(recipe.uses):
        skipped += answers.left_out(recipe, requests, design)
    skipped += _skipped_of_linkage(recipe, design)
    scene = scene_of(recipe, design)
    checks = CHECKS.among(recipe.uses).values()
    skipped += [
        (declared.name, why) for declared in checks if declared.why_not is not None and (why := declared.why_not(scene))
    ]
    if recipe.linkage is not None:
        files = recipe.export.files
        names = [request.filename(recipe.name, files) for request in requests if request.compensation is not None]
        skipped += [(OUTPUT.name, f"{name}: the part is not the nominal one") for name in names]
    return tuple(skipped)


def _skipped_files(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> list[Skipped]:
    listed = {request.kind for request in recipe.export.files}
    requested = {request.kind for request in requests}
    skipped: list[Skipped] = []
    for kind in FORMATS:
        if kind not in listed:
            skipped.append((kind, "the recipe's export.files does not list it"))
        elif kind not in requested:
            skipped.append((kind, "left out by --only"))
    if not design.contours:
        skipped.append(("files", "a check of the exact contour fails"))
        return skipped
    for kind in FORMATS:
        if kind in requested:
            skipped += MAKING[kind].unmade(recipe, design)
    return skipped


def scene_of(recipe: Recipe, design: Design) -> CheckFacts:
    """Facts of a run by which declared checks decide whether they are made."""
    turns = design.driven is None or design.driven.turns
    return CheckFacts(recipe, design.follower, design.trimmed, turns)


def _skipped_of_linkage(recipe: Recipe, design: Design) -> list[Skipped]:
    if design.driven is None:
        return [("linkage", "linkage is not given")]
    if design.driven.turns:
        return []
    files = recipe.export.files
    return [(kind, STANDS) for kind in dict.fromkeys(request.kind for request in files if request.format.turning)]
