"""Two conjugate discs on one shaft: features of a part that they exclude."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.features import FEATURES

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values


def is_pair(values: Values) -> bool:
    """Whether the values of a recipe are of conjugate discs."""
    return "conjugate" in values.get("cam", {})


def check_discs(values: Values, reader: Reader) -> None:
    """Note features of the part that conjugate discs cannot have; silent for other cams."""
    if not is_pair(values):
        return
    part = values.get("part", {})
    for feature in FEATURES:
        if not feature.of_pair and feature.name in part:
            reader.fault_at(
                f"part.{feature.name}", "belongs to a cam of one disc", None, "leave it out, or cam.conjugate"
            )
