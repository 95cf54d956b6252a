"""Intended parts and permitted errors: all that the judge takes beside the file itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.follower.base import Follower
    from kin.judge.grinding import Grinding
    from kin.law.contacts import Side
    from kin.law.frame_swing import FrameSwing
    from kin.linkage.mechanism import Mechanism
    from kin.read.layers import CrossHole, Layer


@dataclass(frozen=True)
class SurfaceIntent:
    """A surface of a disc that a follower runs on.

    gauge     the follower that judges it, with its motion law, in mm and radians
    name      name in checks and closures; empty where there is no other surface
    layer     layer of a drawing on which it lies; without such a layer the nesting of the chains decides
    z         height of the section of a solid in which it lies, mm; None for the section of the plain disc
    side      side of the contour on which the metal lies: 1 inside, -1 outside
    trimmed   an undercut is cut off: the motion lost is reported, and judged only against limits that are given
    follower  follower that runs on it, where the gauge is larger by a clearance, or has room for an interference; None
              for the gauge itself
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
    """A follower between two surfaces, by name: the surface that pushes it out and the surface that stops it.

    `name` is the name of the check. The intended play of the gauges is 0.
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
    dwell   dwell of its output, which is reported of each file and, if it must last, judged
    overlap intended interference at each face of the frame, mm
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
    standing      metal that may stand outside the contour where the cutter does not reach
    hub           radius and height of the metal about the shaft that stands on the stock; None without
    outline       the outline is milled; of round stock, as of a ring, it is not
    pocket        depth of the pocket between two surfaces; None where contours are cut through
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

    surfaces    surfaces that followers run on, in any order; two of them differ in name
    mirrored    the file is drawn mirrored about the x axis (the shaft turns counter-clockwise)
    mm          mm in one drawing unit of a DXF or SVG file or a program (solids are always in mm)
    bore        diameter, mm; None for no hole at all
    thickness   of a solid, mm, z from 0; None where only contours are judged
    closed      whether it has no further opening; where False any others in a file are passed over
    outline     diameter of its round outline, mm, such as a ring's; None where the outermost surface is the outline
    holes       all openings, the bore among them, of a part that has more than a round bore; `bore` is None then
    layers      of its solid, from below, and radial holes through layers with an outline of their own
    milling     how a program mills it
    grinding    meaning of a grinder's tables
    linkage     mechanism that it drives; None for a plain follower
    closures    followers between two of its surfaces
    name        name among the discs on its shaft, for checks; empty where there is no other
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
    closures  followers between surfaces of two of them
    """

    parts: tuple[PartIntent, ...]
    levels: tuple[float, ...] = (0.0,)
    closures: tuple[ClosureIntent, ...] = ()


@dataclass(frozen=True)
class Limits:
    """Permitted errors: `tolerance` of the contour, mm; greatest motion error, and greatest play or interference.

    Motion and play are in mm or degrees, by the follower; `output`, the greatest error of a mechanism's output,
    likewise by the mechanism. None stands for the most that a contour within the tolerance can cause. Ends in drawings
    within `gap`, mm, are joined by lines, which is counted into contour and motion; None for the readers' own gap.
    """

    tolerance: float
    motion: float | None = None
    play: float | None = None
    output: float | None = None
    gap: float | None = None
