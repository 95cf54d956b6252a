"""What a part is meant to be, and what is permitted of it: all that the judge is told beside the file itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.follower.base import Follower
    from kin.judge.grinding import Grinding
    from kin.judge.holes import Hole
    from kin.judge.layers import CrossHole, Layer
    from kin.law.contacts import Side
    from kin.law.frame_swing import FrameSwing
    from kin.linkage.mechanism import Mechanism


@dataclass(frozen=True)
class SurfaceIntent:
    """A surface of a disc that a follower runs on.

    gauge     the follower that judges it, with its motion law, in mm and radians
    name      by which checks and closures tell it; empty where there is no other
    layer     of a drawing on which it stands; where there is no such layer it is told by how chains lie in one another
    z         height of the section of a solid in which it is looked for, mm; None for that of the plain disc
    side      on which the metal lies: 1 within the contour, -1 round it
    trimmed   an undercut is cut off: what motion is lost is reported, and judged only against limits that are given
    follower  that runs on it, where the gauge is larger by a clearance, or has room for an interference; None for the
              gauge itself
    """

    gauge: Follower
    name: str = ""
    layer: str = ""
    z: float | None = None
    side: Side = 1
    trimmed: bool = False
    follower: Follower | None = None


@dataclass(frozen=True)
class ClosureIntent:
    """A follower between two surfaces, by name: the one that pushes it out and the one that stops it.

    `name` is that of the check. The play of the gauges is meant to be 0.
    """

    pushes: str
    stops: str
    name: str = "form-closure"


@dataclass(frozen=True)
class DwellAsked:
    """A dwell of the output: it stays within `band`, rad or mm, over an angle of `at_least`, rad, if that is set.

    `over` says whether the angle is the shaft's or the relative one.
    """

    band: float
    at_least: float | None = None
    over: Literal["shaft", "relative"] = "shaft"


@dataclass(frozen=True)
class LinkageIntent:
    """The mechanism that the yoke's frame drives as a coupler.

    swing   law over the shaft angle that its frame has to follow; None where the exact cam's own lift moves the frame
    dwell   of its output, which is found in each file and, if it must last, judged
    overlap by which the metal is to overlap each face of the frame, mm
    """

    mechanism: Mechanism
    swing: FrameSwing | None = None
    dwell: DwellAsked | None = None
    overlap: float = 0.0


@dataclass(frozen=True)
class Milling:
    """Intended milling of a part, mm.

    radius        of the cutter
    thickness     of the stock, which is cut through
    depth_of_cut  that one pass may have at most
    climb         a right-handed cutter meets the metal climbing
    standing      how far metal may stand outside the contour where the cutter does not reach
    hub           radius and height of the metal about the shaft that stands on the stock; None without
    outline       the outline is milled; of round stock, as of a ring, it is not
    pocket        depth of what lies between two surfaces; None where contours are cut through
    """

    radius: float
    thickness: float
    depth_of_cut: float
    climb: bool = True
    standing: float = 0.0
    hub: tuple[float, float] | None = None
    outline: bool = True
    pocket: float | None = None


@dataclass(frozen=True)
class PartIntent:
    """Intended disc in a file.

    surfaces    those that followers run on, in any order; two of them differ in name
    mirrored    the file is drawn mirrored about the x axis (the shaft turns counter-clockwise)
    mm          mm in one drawing unit of a DXF or SVG file or a program (solids are always in mm)
    bore        diameter, mm; None for no hole at all
    thickness   of a solid, mm, z from 0; None where only contours are judged
    closed      whether it has no opening besides; where False any others in a file are passed over
    outline     diameter of its round outline, mm, such as a ring's; None where the outermost surface is the outline
    holes       all openings, the bore among them, of a part that has more than a round bore; `bore` is None then
    layers      of its solid, from below, and radial holes through layers with an outline of their own
    milling     how a program mills it
    grinding    how a grinder's table is meant
    linkage     that it drives; None for a plain follower
    closures    followers between two of its surfaces
    name        by which checks tell it from other discs on its shaft; empty where there is no other
    """

    surfaces: tuple[SurfaceIntent, ...]
    mirrored: bool = False
    mm: float = 1.0
    bore: float | None = None
    thickness: float | None = None
    outline: float | None = None
    closed: bool = True
    holes: tuple[Hole, ...] = ()
    layers: tuple[Layer, ...] = ()
    cross_holes: tuple[CrossHole, ...] = ()
    milling: Milling | None = None
    grinding: Grinding | None = None
    linkage: LinkageIntent | None = None
    closures: tuple[ClosureIntent, ...] = ()
    name: str = ""

    @property
    def featured(self) -> bool:
        """Whether the part has more than a round bore."""
        return bool(self.holes or self.layers)


@dataclass(frozen=True)
class ShaftIntent:
    """Discs on one shaft, in a file each or together in one.

    parts     the discs, the lowest first; alone in a file each stands on z = 0
    levels    height of the lower face of each in a file that holds all of them, mm
    closures  what is left between surfaces of two of them
    """

    parts: tuple[PartIntent, ...]
    levels: tuple[float, ...] = (0.0,)
    closures: tuple[ClosureIntent, ...] = ()


@dataclass(frozen=True)
class Limits:
    """Permitted errors: `tolerance` of the contour, mm; greatest motion error, and greatest play or interference.

    Motion and play are in mm or degrees as the follower has them, `output`, the greatest error of a mechanism's output,
    as the mechanism has it; None is the most that a contour within the tolerance can cause. Ends in drawings within
    `gap`, mm, are joined by lines, which is counted into contour and motion; None for the readers' own.
    """

    tolerance: float
    motion: float | None = None
    play: float | None = None
    output: float | None = None
    gap: float | None = None
