"""What the shop drawing adds to a recipe: the tolerance zone that it states."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.recipe.extension import Keys

if TYPE_CHECKING:
    from camgeo.schema.reader import Values


class SheetZone(NamedTuple):
    """Zone of the profile that a drawing of the recipe states: the path of its field, and its width, mm."""

    path: str
    width: float


def _build(values: Values) -> SheetZone | None:
    """First zone that a drawing of the recipe states; None without one."""
    files = values.get("export", {}).get("files", [])
    stated = [file for file in files if file["kind"] == "sheet" and "profile" in file]
    return SheetZone(f"{stated[0]['path']}.sheet.profile", stated[0]["profile"]) if stated else None


ANSWERS = Keys(build=_build, profile=tuple)
