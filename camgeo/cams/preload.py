"""What a recipe says of a preload by interference: by how much contacts overlap the metal, and how stiff they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, Field, Kind, length, mapping
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.reader import Values


@dataclass(frozen=True)
class Preload:
    """What both contacts together overlap the metal by, mm, and the stiffness of each along its normal, N/m.

    `stiffness` is None where no force is asked for.
    """

    interference: float
    stiffness: tuple[float, float] | None = None

    @property
    def overlaps(self) -> tuple[float, float]:
        """By how much each contact overlaps the metal that it touches, mm, the follower being where it is meant to."""
        half = 0.5 * self.interference
        return half, half


PRELOAD = mapping(
    "preload",
    "a preload by interference, for a follower that two contacts hold",
    length("interference", "what both contacts together overlap the metal by, along their normals", required=True),
    Field(
        "stiffness",
        Kind.NUMBERS,
        "stiffness of the first contact and the second along their normals, N/m, for the force alone",
        default="no force",
        unit=Kind.NUMBER,
        at_least=1.0,
        at_most=MOST**2,
        most=2,
    ),
)


def build_preload(cam: Values) -> Preload | None:
    """Make the preload of a cam's values in which there is no fault, None where they have none."""
    given = cam.get("preload")
    if given is None:
        return None
    first, *second = given.get("stiffness") or (None,)
    return Preload(given["interference"], None if first is None else (first, *(second or [first])))
