"""What a run leaves out, with the reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declared import CHECKS, OUTPUT, STANDS, Scene
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

Skipped = tuple[str, str]


def left_out(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> tuple[Skipped, ...]:
    """Name what was left out of a run that was asked for these files, and say why."""
    found = _files(recipe, requests, design)
    absent = ((name, label.absent) for name, label in registry.labels().items() if name not in recipe.uses)
    found += [(name, why) for name, why in absent if why]
    for capability in registry.in_order(recipe.uses):
        found += capability.left_out(recipe, requests, design)
    found += _of_linkage(recipe, design)
    scene = scene_of(recipe, design)
    checks = CHECKS.among(recipe.uses).values()
    found += [(one.name, why) for one in checks if one.why_not is not None and (why := one.why_not(scene))]
    if recipe.linkage is not None:
        files = recipe.export.files
        names = [request.filename(recipe.name, files) for request in requests if request.compensation is not None]
        found += [(OUTPUT.name, f"{name}: the part is not the nominal one") for name in names]
    return tuple(found)


def _files(recipe: Recipe, requests: tuple[FileRequest, ...], design: Design) -> list[Skipped]:
    asked = {request.kind for request in recipe.export.files}
    wanted = {request.kind for request in requests}
    found: list[Skipped] = []
    for kind in FORMATS:
        if kind not in asked:
            found.append((kind, "the recipe's export.files does not list it"))
        elif kind not in wanted:
            found.append((kind, "left out by --only"))
    if not design.contours:
        found.append(("files", "a check of the exact contour fails"))
        return found
    for kind in FORMATS:
        if kind in wanted:
            found += FORMATS[kind].unmade(recipe, design)
    return found


def scene_of(recipe: Recipe, design: Design) -> Scene:
    """What of a run decides which checks are made."""
    turns = design.driven is None or design.driven.turns
    return Scene(recipe, design.follower, design.trimmed, turns)


def _of_linkage(recipe: Recipe, design: Design) -> list[Skipped]:
    if design.driven is None:
        return [("linkage", "linkage is not given")]
    if design.driven.turns:
        return []
    files = recipe.export.files
    return [(kind, STANDS) for kind in dict.fromkeys(request.kind for request in files if request.format.turning)]
