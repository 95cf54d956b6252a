"""Disc cams with a groove: one roller between two flanks, which lead it out and back; both are parallels of one path.

The metal lies within the inner flank, as of a disc, and round the outer one, as of a ring. The groove is wider than the
roller by its clearance, all of it on the outer flank, whose gauge is a roller that much larger.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.guided import Flank, Holding, RoundAdvice
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, coordinate, length
from camgeo.schema.json_schema import table_schema
from camgeo.schema.read_scalar import read_choice
from camgeo.schema.yaml_source import Mapping
from kin.law.contacts import Roller
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.family import Advice
    from camgeo.cams.guided import GuidedCam
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.contacts import Contact, Guide, Side, Touch


@dataclass(frozen=True)
class Groove(Holding):
    """A groove: `clearance`, its width less the roller's diameter, and `depth` from the top face if given, mm."""

    closure: ClassVar[str] = "form-closure"
    trims: ClassVar[bool] = False
    clearance: float = 0.0
    depth: float | None = None

    def flanks(self, touch: Touch, side: Side) -> tuple[Flank, ...]:  # noqa: ARG002 - the metal lies on both
        """The inner flank, which pushes the roller out, and the outer one, which pulls it back."""
        inner, outer = touch.radius, touch.radius + self.clearance
        return (
            Flank("inner", 1, inner, "GROOVE_INNER", self.depth),
            Flank("outer", -1, outer, "GROOVE_OUTER", self.depth),
        )

    def contacts(self, first: Contact[Guide, Touch]) -> tuple[Contact[Guide, Touch], ...]:
        """Contacts on the inner and the outer flank, each with a roller of its gauge's radius."""
        flanks = self.flanks(first.touch, 1)
        return tuple(replace(first, touch=Roller(flank.radius), surface=flank.name) for flank in flanks)

    def grow(self, out: float, scale: float, *, flat: bool) -> Groove:  # noqa: ARG002 - the protocol's
        """Copy of the groove with clearance and depth times `scale`; growth of the metal leaves both as they are."""
        return Groove(clearance=scale * self.clearance, depth=None if self.depth is None else scale * self.depth)

    def advice(self, cam: GuidedCam, own: Advice) -> Advice:
        """Advice with a roller smaller by the clearance; `own` itself where `sizing` gives the size."""
        if not isinstance(own, RoundAdvice):
            return own
        return GrooveAdvice(cam, self.clearance, larger=own.larger, less_steep=own.less_steep, trims=own.trims)


@dataclass(frozen=True)
class GrooveAdvice(RoundAdvice):
    """Advice for a roller between flanks: that for the outer flank's gauge, less the clearance."""

    clearance: float = 0.0

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a roller radius without undercut: below `free_at`, mm, less the clearance."""
        return super().free_of_undercut(free_at - self.clearance, mm)

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """Words for a roller radius below `value` less the clearance; empty unless that is above 0."""
        return super().rounder(value - self.clearance / (25.4 if unit == "in" else 1.0), limit, unit)


# --- in a recipe ------------------------------------------------------------------------------------------------------

GROOVE = Field(
    "groove",
    Kind.TABLE,
    "a groove with a flank on either side of the roller",
    required=True,
    table=FieldTable(
        (
            coordinate(
                "clearance",
                "width of the groove less the roller's diameter, all of it on the outer flank, 0 or more",
                default="0",
            ),
            length("depth", "depth of the groove from the top face, below the thickness"),
        )
    ),
)


def read_track(reader: Reader, field: Field, node: Node, path: str) -> str | Values | None:
    """Read the word for a side of the metal, or a mapping with the groove; None where a fault was noted."""
    return reader.mapping(field, node, path) if isinstance(node, Mapping) else read_choice(reader, field, node, path)


TRACK = Field(
    "track",
    Kind.OWN,
    "which side of the metal is followed: internal is the opening of a ring, a groove has both",
    default="external",
    choices=("external", "internal"),
    table=FieldTable((GROOVE,)),
    form=OwnForm(
        "a track",
        "external, internal or a mapping such as {groove: {clearance: 0.03, depth: 6}}",
        read_track,
        lambda field: {"anyOf": [{"enum": list(field.choices)}, table_schema(field.inner)]},
    ),
)
