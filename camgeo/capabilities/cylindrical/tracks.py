"""Tracks of a drum: a groove, a rib or an end face, each with the flanks that it has and the metal between them.

A flank `lower` has the metal below it and holds a roller from below, a flank `upper` has it above.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from typing import ClassVar

    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.cylindrical import intent


class Track:
    """What leads a roller, cut from the blank down to its floor.

    noun       its word in messages
    depth      of the floor below the blank, mm
    figures    names of the figures that drums with such a track alone have
    unmilled   what of the drum a program along the flanks does not mill, in words; empty for nothing
    clearance  by which the roller of its upper flank is larger, mm
    distance   of the axes of two rollers, mm; 0 of one roller
    """

    noun: ClassVar[str] = "flank"
    figures: ClassVar[tuple[str, ...]] = ()
    unmilled: ClassVar[str] = ""
    depth: float
    clearance: float = 0.0
    distance: float = 0.0

    @property
    def rising(self) -> tuple[str, ...]:
        """Names of its flanks, from the lower face to the upper one: between neighbours lies metal, or the groove."""
        raise NotImplementedError

    @property
    def carrying(self) -> tuple[str, ...]:
        """Names of the flanks that are asked for the pressure of a load."""
        return self.rising

    @property
    def closed(self) -> bool:
        """Whether two flanks hold the follower to both sides; else a spring presses it on one."""
        return len(self.rising) > 1

    @property
    def same_roller(self) -> bool:
        """Whether both flanks are those of one and the same roller."""
        return False

    def meets_lower_face(self, name: str) -> bool:
        """Whether the wall behind a flank, by its name, ends at the lower face of the drum; else at the upper one."""
        return name == "lower"

    def flanks(self, lower: Flank) -> dict[str, Flank]:
        """Flanks by name, of the drum whose roller would leave the flank `lower` below it."""
        both = {"lower": lower, "upper": replace(lower, side=1)}
        return {name: flank for name, flank in both.items() if name in self.rising}

    def intended(self) -> intent.Track:
        """Track of the intended drum, by which kin judges files."""
        raise NotImplementedError


@dataclass(frozen=True)
class Groove(Track):
    """A groove of a depth with a clearance on its upper flank, square to it, mm."""

    noun: ClassVar[str] = "groove"
    figures: ClassVar[tuple[str, ...]] = ("play",)
    depth: float
    clearance: float

    @property
    def rising(self) -> tuple[str, ...]:
        """Names of its flanks, from the lower face to the upper one."""
        return ("lower", "upper")

    @property
    def carrying(self) -> tuple[str, ...]:
        """The lower flank, which stands for both: they are those of one roller, but for the clearance."""
        return ("lower",)

    @property
    def same_roller(self) -> bool:
        """Whether both flanks are those of one and the same roller: without a clearance."""
        return not self.clearance

    def flanks(self, lower: Flank) -> dict[str, Flank]:
        """Flanks by name; the upper one is that of a roller larger by the clearance."""
        return {"lower": lower, "upper": replace(lower, side=1, radius=lower.radius + self.clearance)}

    def intended(self) -> intent.Track:
        """Kin's groove."""
        from kin.cylindrical import intent

        return intent.Groove(self.depth, self.clearance)


@dataclass(frozen=True)
class Rib(Track):
    """A rib of a depth between two rollers, whose axes are a distance apart along the cam's axis, mm."""

    noun: ClassVar[str] = "rib"
    figures: ClassVar[tuple[str, ...]] = ("rib-thickness",)
    unmilled: ClassVar[str] = "beside the rib"
    depth: float
    distance: float

    @property
    def rising(self) -> tuple[str, ...]:
        """Names of its flanks, from the lower face to the upper one: its lower face is the flank above a roller."""
        return ("upper", "lower")

    def meets_lower_face(self, name: str) -> bool:
        """Whether a flank lies next to the lower face of the drum: the lower one of the rib, above a roller."""
        return name == "upper"

    def flanks(self, lower: Flank) -> dict[str, Flank]:
        """Flanks by name, each of a roller half of the distance beside the middle."""
        half, guide = 0.5 * self.distance, lower.guide
        return {
            "lower": replace(lower, guide=guide.beside(half)),
            "upper": replace(lower, side=1, guide=guide.beside(-half)),
        }

    def intended(self) -> intent.Track:
        """Kin's rib."""
        from kin.cylindrical import intent

        return intent.Rib(self.depth, self.distance)


@dataclass(frozen=True)
class End(Track):
    """An end face towards the top, with the metal below, or towards the bottom, to a depth below the blank, mm."""

    unmilled: ClassVar[str] = "within the flank"
    facing: Literal["top", "bottom"]
    depth: float

    @property
    def rising(self) -> tuple[str, ...]:
        """Name of its one flank."""
        return ("lower",) if self.facing == "top" else ("upper",)

    def intended(self) -> intent.Track:
        """Kin's end face."""
        from kin.cylindrical import intent

        return intent.End(self.facing, self.depth)
