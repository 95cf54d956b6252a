"""Disc cams with a groove: one roller between two flanks, which lead it out and back; both are parallels of one path.

The metal lies within the inner flank, as of a disc, and round the outer one, as of a ring. The groove is wider than the
roller by its clearance, all of it on the outer flank, whose gauge is a roller that much larger.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.disc_cams import DiscCam
from camgeo.cams.family import Surface
from camgeo.cams.guided import LARGER_BASE, ExactGuided, RoundAdvice, Spin
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.schema.fields import Field, Form, Kind, Table, coordinate, length
from camgeo.schema.json_schema import table_schema
from camgeo.schema.read_scalar import read_choice
from camgeo.schema.yaml_source import Mapping
from kin.law.contacts import Roller

if TYPE_CHECKING:
    from camgeo.cams.family import Follower
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.contacts import Side

INNER, OUTER = "inner", "outer"


@dataclass(frozen=True)
class Groove:
    """A groove: its width less the roller's diameter, and its depth from the top face, None where none is given; mm."""

    clearance: float = 0.0
    depth: float | None = None


@dataclass(frozen=True)
class GrooveAdvice(RoundAdvice):
    """Of a roller between flanks: what frees the outer one's gauge frees it of a roller smaller by the clearance."""

    clearance: float = 0.0
    trims: ClassVar[bool] = False

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A smaller roller on the same pitch curve."""
        return super().free_of_undercut(free_at - self.clearance, mm)

    def rounder(self, value: float, limit: float, unit: str) -> str:
        """A smaller roller on the same pitch curve."""
        return super().rounder(value - self.clearance / (25.4 if unit == "in" else 1.0), limit, unit)


@dataclass(frozen=True, kw_only=True)
class GrooveCam(DiscCam):
    """A disc cam whose roller runs in a groove; `base_radius` is that of the inner flank."""

    groove: Groove

    @property
    def flanks(self) -> tuple[tuple[str, Side, float], ...]:
        """Name, side of the metal, and the radius of the roller that judges it, mm, of each flank."""
        radius = self.touch.radius
        return (INNER, 1, radius), (OUTER, -1, radius + self.groove.clearance)

    def exact(self, *, framed: bool = False) -> ExactGroove:  # noqa: ARG002
        """By the displacement over a whole turn, 0 where it is lowest."""
        return ExactGroove(self, self._displacement())

    def follower(self, law: Displacement) -> Follower:
        """One roller, which the inner flank pushes out and the outer one stops."""
        alone = super().follower(law)
        (contact,) = alone.contacts
        contacts = tuple(replace(contact, touch=Roller(gauge), surface=name) for name, _, gauge in self.flanks)
        return replace(alone, closure="form-closure", contacts=contacts)

    @property
    def advice(self) -> GrooveAdvice:
        """In the words of the roller."""
        return GrooveAdvice(self, self.groove.clearance, less_steep=LARGER_BASE)

    def grown(self, out: float, scale: float) -> GrooveCam:
        """A smaller roller on the same pitch curve: the metal of either flank grows towards it."""
        grown = super().grown(out, scale)
        return replace(self, **vars(grown) | {"groove": replace(self.groove, clearance=scale * self.groove.clearance)})


@dataclass(frozen=True, eq=False)
class ExactGroove(ExactGuided):
    """The roller's path, and a flank on either side of it."""

    cam: GrooveCam

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The inner flank under the roller, the outer one under a roller wider by the clearance."""
        from camgeo.curve.moving_frame import CentreShape

        pitch, radius = CentreShape(self.law, self.cam.led), self.cam.touch.radius
        path = Curve.whole(pitch)
        return tuple(
            Surface(
                path,
                Curve.whole(Parallel(pitch, side * gauge)),
                gauge,
                side,
                pitch.pressure_angle,
                series={"slope": pitch.slope, "spin": Spin(pitch, radius, float(side))},
                name=name,
                layer=f"GROOVE_{name.upper()}",
            )
            for name, side, gauge in self.cam.flanks
        )


# --- in a recipe ------------------------------------------------------------------------------------------------------

GROOVE = Field(
    "groove",
    Kind.TABLE,
    "a groove with a flank on either side of the roller",
    required=True,
    table=Table(
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
    """Read the word for a side of the metal, or a mapping with the groove."""
    return reader.mapping(field, node, path) if isinstance(node, Mapping) else read_choice(reader, field, node, path)


TRACK = Field(
    "track",
    Kind.OWN,
    "which side of the metal is followed: internal is the opening of a ring, a groove has both",
    default="external",
    choices=("external", "internal"),
    table=Table((GROOVE,)),
    form=Form(
        "a track",
        "external, internal or a mapping such as {groove: {clearance: 0.03, depth: 6}}",
        read_track,
        lambda field: {"anyOf": [{"enum": list(field.choices)}, table_schema(field.inner)]},
    ),
)


def is_groove(cam: Values) -> bool:
    """Whether the values of a cam are of a groove."""
    return isinstance(cam.get("track"), dict)
