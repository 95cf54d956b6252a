"""Intended plates: all that the judge of linear cams takes beside the file itself and permitted errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.linear.follower import LinearFollower
    from kin.read.layers import Layer


@dataclass(frozen=True)
class Ends:
    """How the flank goes on beyond the contacts at the first and the last input.

    overrun  lengths along x, mm, at the first and the last input: metal reaches so far beyond the contact there
    tangent  along the flank's end tangent; else as a dwell: the follower stays where it is, its centre on a line along
             the travel, so that the flank is an arc of the roller, where it comes down to its end, and then level
    """

    overrun: tuple[float, float]
    tangent: bool = True


@dataclass(frozen=True)
class Groove:
    """A groove: the follower runs between a lower and an upper flank, which are one closed chain.

    The lower flank is that of the follower's roller, the upper flank that of a roller larger by `clearance`, mm, on the
    same pitch curve. Each reaches from its contact at the first input to that at the last, and by the overrun further
    on; what joins the two beyond is free, as far as the roller has room. `layer` is the chain's in a drawing; `depth`,
    mm, is that in a solid, from the upper face, None where it goes through.
    """

    clearance: float = 0.0
    layer: str = "GROOVE"
    depth: float | None = None


@dataclass(frozen=True, eq=False)
class PlateIntent:
    """Intended linear cam in a file.

    follower   gauge that judges the flank below it
    ends       beyond the contacts; None for an endless motion, whose plate reaches from x = 0 over `periods` periods
    groove     None for a flank that is the upper edge of the plate
    outline    intended outline of a plate with a groove; None where the flank, ends and y = 0 are the outline
    trimmed    an undercut is cut off: the motion lost is reported, and judged only against limits that are given
    mirrored   the file is drawn mirrored in the y axis (travel to the right), holes too
    mm         mm in one drawing unit of a DXF or SVG (solids are always in mm)
    holes      all openings; of a plate that is not `closed` others in a file are passed over
    thickness  of a solid, mm, z from 0; None where contours alone are judged
    layers     of a solid with chamfers, pockets or marks, from below; their outline None is the plate's
    """

    follower: LinearFollower
    ends: Ends | None = None
    periods: int = 1
    groove: Groove | None = None
    outline: Hole | None = None
    trimmed: bool = False
    mirrored: bool = False
    mm: float = 1.0
    holes: tuple[Hole, ...] = ()
    closed: bool = True
    thickness: float | None = None
    layers: tuple[Layer, ...] = ()
