"""The cam as plates, the shaft that drives it, and its bearing in the base.

The shaft goes down through the cam and the base, thinner from section to section, so that it is printed standing on
its knob; under the base it is held by a disc that turns in a sink.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import GROUND, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.shapes import disc, retainer
from camgeo.capabilities.mechanism.sizes import THIN, BodyError, require_thickness
from camgeo.fit.pieces import ArcSpline
from camgeo.part.flat import Flat
from camgeo.part.keyway import Keyway
from camgeo.part.shapes import flattened, keyed, polygonal
from kin.contour.contour import Contour
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.sizes import Sizes
    from camgeo.fit.pieces import Polygon
    from camgeo.part.body import Body
    from camgeo.part.part import Part

CAM = "cam"
KNOB_SIDES = 8
LEAST_EXCESS = 0.1  # mm by which a shaft is at least too wide to turn in the bore, after the files' errors
PLACES = 180  # of a turn, at which bodies that may pass under the knob are placed
CAM_COLOUR, SHAFT_COLOUR, CLIP_COLOUR, GROUND_COLOUR = "#d08a3c", "#5b6b7f", "#33404f", "#a9b4c0"


@dataclass(frozen=True, eq=False)
class Disk:
    """The cam as plates: its disc from z = 0 to `thickness`, with its hubs from `bottom` to `top`; mm.

    `hub` is the radius of the hubs, 0 without. `pocket` is the depth of a groove from the top face, None without.
    """

    plates: tuple[Plate, ...]
    thickness: float
    bottom: float
    top: float
    hub: float = 0.0
    pocket: float | None = None

    def raised(self, z: float) -> tuple[Plate, ...]:
        """The plates with the lower face of the disc at `z`, mm."""
        return tuple(Plate(p.outline, p.holes, p.low + z, p.high + z) for p in self.plates)


def cam_disk(part: Part, body: Body, contours: Sequence[ArcSpline | Polygon]) -> Disk:
    """The cam as plates: disc and hubs with the openings that go right through them.

    A groove has two contours, the inner one first. A chamfer, a set screw and an engraved mark are left out. Raises
    ValueError without thickness or bore, BodyError for too thin a disc, TypeError for a groove whose outer contour is
    a polygon.
    """
    if part.thickness is None or part.bore is None:
        raise ValueError("a cam for a mechanism needs thickness and bore")
    require_thickness("part.thickness", part.thickness)
    through = tuple(opening for opening in body.openings if opening.depth is None)
    holes = tuple(opening.outline for opening in through)
    plates = [Plate(contours[0], holes, 0.0, part.thickness)]
    # a groove: its floor, and above that the island within it and the metal round it
    if body.pocket is not None and body.rim is not None:
        blank, floor, (inner, outer) = body.rim.outline, part.thickness - body.pocket, contours
        island = tuple(opening.outline for opening in through if opening.island)
        outside = tuple(opening.outline for opening in through if not opening.island)
        plates = [
            Plate(blank, holes, 0.0, floor),
            Plate(inner, island, floor, part.thickness),
            Plate(blank, (_arcs(outer), *outside), floor, part.thickness),
        ]
    # hubs below and above the disc, with the openings within them
    boss = part.boss
    if boss is None:
        return Disk(tuple(plates), part.thickness, 0.0, part.thickness, pocket=body.pocket)
    radius = 0.5 * boss.diameter
    inside = tuple(opening.outline for opening in through if math.hypot(*opening.middle) < radius)
    if body.bottom < 0.0:
        plates.append(Plate(disc(radius), inside, body.bottom, 0.0))
    if body.top > part.thickness:
        plates.append(Plate(disc(radius), inside, part.thickness, body.top))
    return Disk(tuple(plates), part.thickness, body.bottom, body.top, radius, body.pocket)


def _arcs(outline: ArcSpline | Polygon) -> ArcSpline:
    """The outline as one of arcs; raises TypeError for a polygon."""
    if not isinstance(outline, ArcSpline):
        raise TypeError("an opening is made of arcs and lines")
    return outline


@dataclass(frozen=True, eq=False)
class Shaft:
    """Sections of a shaft: the outline `drive` in the cam's bore, and a circle of radius `journal` in the base; mm.

    `across` is the greatest radius of the drive. `excess` is by how much the drive is wider than the opening in which
    it would turn if it slipped; None for a round bore, into which the shaft is pressed.
    """

    drive: ArcSpline
    across: float
    journal: float
    excess: float | None

    @property
    def pressed(self) -> bool:
        """Whether the press alone turns the cam."""
        return self.excess is None


def shaft_in(part: Part, s: Sizes) -> Shaft:
    """Shaft that fits the bore of a part, with the bore's sides, key or flat, half the clearance smaller all round.

    For a round bore it is wider by the press. Raises BodyError where the bore is too narrow for a shaft.
    """
    bore = part.bore or 0.0
    radius = 0.5 * bore - s.gap_each_side
    journal, across = radius, radius
    if part.sides:
        drive = polygonal(part.sides, bore - s.clearance, part.bore_at)
        across = radius / math.cos(math.pi / part.sides)
    elif (key := part.of(Keyway)) is not None:
        drive = keyed(radius, key.width - s.clearance, key.depth, key.at)
        across = math.hypot(radius + key.depth, 0.5 * key.width)
    elif (flat := part.of(Flat)) is not None:
        drive = flattened(radius, flat.across - s.clearance, flat.at)
        journal = flat.across - s.clearance - radius
    else:
        across = 0.5 * (bore + s.press)
        drive = disc(across)
    if journal < 1.0:  # mm: a thinner journal breaks
        message, remedy = "leaves a journal of {thick} in the base", "give a bore of {such} or more"
        raise BodyError(
            "part.bore", message, remedy, thick=max(2.0 * journal, 0.0), such=max(4.0, bore + 2.0 * (1.0 - journal))
        )
    widths = _turning_widths(part, s.clearance)
    return Shaft(drive, across, journal, widths and widths[0] - widths[1])


def require_drive(part: Part, clearance: float, off: float) -> None:
    """Raise BodyError for a bore with sides, a keyway or a flat in which the shaft may slip round.

    A plain round bore passes, as the shaft is pressed into it. `clearance`, mm, is the running clearance; each of the
    four sides of bore and shaft may be off by up to `off`, mm, the files' error. A key on the shaft that is too thin to
    be printed is refused too.
    """
    widths = _turning_widths(part, clearance)
    if widths is None:
        return
    keyway = part.of(Keyway)
    if keyway is not None:
        key = keyway.width - clearance
        if key < THIN:
            message, remedy = "leaves a key of {key} on the shaft", "give a width of {least} or more"
            lengths = {"key": max(key, 0.0), "least": clearance + THIN}
            raise BodyError("part.keyway.width", message, remedy, **lengths)
    wide, opening = widths
    least = LEAST_EXCESS + 4.0 * off
    if wide - opening >= least:
        return
    # the size of the part that would be wide enough, and the clearance that would be small enough
    bore = part.bore or 0.0
    if part.sides:
        corner = 1.0 / math.cos(math.pi / part.sides)
        such = (least + clearance * corner) / (corner - 1.0)
        field, remedy, most = "part.bore", "give a bore of {such} or more", bore - (bore + least) / corner
    elif keyway is not None:
        radius = 0.5 * (bore - clearance)
        such = math.sqrt((bore + least - radius) ** 2 - 0.25 * (keyway.width - clearance) ** 2) - radius
        field, remedy, most = "part.keyway.depth", "give a depth of {such} or more", keyway.depth - least
    else:
        field, remedy, such = "part.flat.across", "give at most {such}", bore - clearance - least
        most = bore - opening - least
        if such <= 0.5 * bore:
            remedy = "give a larger bore"
    if most > 0.0:
        remedy += ", or a mechanism.clearance of at most {most}"
    message = "the shaft slips in it: it is {wide} wide, the opening {opening}, which must be smaller by {least}"
    raise BodyError(field, message, remedy, wide=wide, opening=opening, least=least, such=such, most=most)


def _turning_widths(part: Part, clearance: float) -> tuple[float, float] | None:
    """Greatest width of the shaft, and the width of the opening in which it would turn, mm; None for a pressed shaft.

    The shaft's width is measured across its corners, over its key, or along its flat.
    """
    bore = part.bore or 0.0
    if part.sides:
        return (bore - clearance) / math.cos(math.pi / part.sides), bore
    if (keyway := part.of(Keyway)) is not None:
        radius = 0.5 * (bore - clearance)
        return radius + math.hypot(radius + keyway.depth, 0.5 * (keyway.width - clearance)), bore
    if (flat := part.of(Flat)) is not None:
        return bore - clearance, flat.across
    return None


@dataclass(frozen=True, eq=False)
class Drive:
    """Data common to all mechanisms: the cam and its greatest radius `reach`, mm, the shaft, and the sizes."""

    disk: Disk
    reach: float
    shaft: Shaft
    sizes: Sizes


def bearing(drive: Drive, pads: Sequence[ArcSpline], high: float) -> tuple[Plate, ...]:
    """Plates of the base about the shaft: pads with the hole and the retainer's sink, and a boss up to z = `high`, mm.

    The boss is left out where it would be lower than half the axial gap.
    """
    shaft, s = drive.shaft, drive.sizes
    sink, hole = disc(_sink(drive)), disc(shaft.journal + s.gap_each_side)
    plates = [Plate(pad, (sink,), 0.0, s.sunk) for pad in pads]
    plates += [Plate(pad, (hole,), s.sunk, s.plate) for pad in pads]
    if high - s.plate > 0.5 * s.gap:
        plates.append(Plate(disc(shaft.journal + s.gap_each_side + s.wall), (hole,), s.plate, high))
    return tuple(plates)


def least_pad_radius(drive: Drive) -> float:
    """Least radius, mm, of the base's pad about the shaft."""
    return _sink(drive) + drive.sizes.wall


def _sink(drive: Drive) -> float:
    shaft, s = drive.shaft, drive.sizes
    return max(0.5 * s.bar, shaft.journal + s.wall) + s.space


def shaft_members(drive: Drive, z: float, place: Place, others: Sequence[Member]) -> tuple[Member, Member, Member]:
    """Cam, shaft and the shaft's retainer, in this order, which move with `place`.

    The disc's lower face is at `z`, mm. The knob is above all bodies `others` that pass under it.
    """
    disk, shaft, s = drive.disk, drive.shaft, drive.sizes
    foot, head = z + disk.bottom, z + disk.top + s.gap
    plates = [Plate(disc(shaft.journal), (), s.gap, foot), Plate(shaft.drive, (), foot, head)]
    within = 0.5 * s.knob / math.cos(math.pi / KNOB_SIDES) + s.space
    knob = max((top for member in others for top in _passing(member, head, within)), default=head)
    knob = head if knob == head else knob + s.gap
    if knob > head:
        plates.append(Plate(disc(shaft.across + s.wall), (), head, knob))
        head = knob
    plates.append(Plate(polygonal(KNOB_SIDES, s.knob, 0.0), (), head, head + s.link))
    clip = retainer(s, (0.0, 0.0), 0.0, 2.0 * shaft.journal)
    return (
        Member(CAM, disk.raised(z), CAM, place, CAM_COLOUR),
        Member("shaft", tuple(plates), CAM, place, SHAFT_COLOUR),
        Member("retainer-shaft", clip, CAM, place, CLIP_COLOUR),
    )


def _passing(member: Member, low: float, within: float) -> list[float]:
    """Upper faces z, mm, of a member's plates above z = `low` that come nearer than `within` mm to the shaft's axis."""
    poses = member.poses(PLACES)
    faces = []
    for plate in member.plates:
        if plate.high <= low:
            continue
        if not isinstance(plate.outline, ArcSpline):
            raise TypeError(f"{member.name}: a body is made of arcs and lines")
        chain = Contour.from_bulges(plate.outline.points, plate.outline.bulges)
        c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        x, y = poses[:, 0], poses[:, 1]
        shaft = np.column_stack([-x * c - y * s, x * s - y * c])  # in the member's axes
        if float(chain.distance(shaft).min()) < within:
            faces.append(plate.high)
    return faces


def shaft_fits(drive: Drive) -> tuple[BodyFit, ...]:
    """Fits of the shaft in base, cam and retainer, in this order."""
    s, name = drive.sizes, "shaft in the cam's bore"
    pressed, running = BodyFit(name, s.press, pressed=True), BodyFit(name, s.clearance, excess=drive.shaft.excess)
    in_cam = pressed if drive.shaft.pressed else running
    return (BodyFit("shaft in the base", s.clearance), in_cam, BodyFit("retainer on the shaft", s.press, pressed=True))


def base(plates: Sequence[Plate]) -> Member:
    """The base as one body of these plates."""
    return Member("base", tuple(plates), GROUND, colour=GROUND_COLOUR)
