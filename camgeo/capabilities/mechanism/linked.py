"""A cam in a square frame that is the coupler of a linkage: frame, rocker, block or slide, and the base with pivots.

Bodies that cross in plan lie one above another: the cam in its frame, the rocker above it, then whatever dyads hang on
them, each with room for the retainers below it. A slide runs under the frame, which then stands as much higher.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.assembly import Assembly, Fit
from camgeo.capabilities.mechanism.base import BLOCK, BLOCK_COLOUR, FRAME_COLOUR, Carrier, Mount, Site, block, slotted
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.dyads import rod_and_rocker, rod_and_slide, slotted_rocker
from camgeo.capabilities.mechanism.link_poses import Links
from camgeo.capabilities.mechanism.poses import Turning
from camgeo.capabilities.mechanism.shaft import base, base_radius, bearing, shaft_fits, turned
from camgeo.capabilities.mechanism.shapes import bar, bars, box, disc, eye, moved, pin
from camgeo.capabilities.mechanism.sizes import BodyError
from kin.linkage.dyad import RPR, RRP, RRR
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.capabilities.mechanism.sizes import Sizes
    from kin.linkage.mechanism import Mechanism


def linked(mechanism: Mechanism, drive: Drive) -> Assembly:
    """Return the bodies of a mechanism that turns. Raises BodyError where one of them finds no room."""
    s, disk = drive.sizes, drive.disk
    linkage = mechanism.linkage
    maker = MAKERS[type(linkage)]
    low = s.plate + s.gap + (s.link + s.gap if maker.under_frame else 0.0)
    low = max(low, s.plate + s.gap - disk.bottom)
    high = low + disk.thickness
    links = Links(mechanism)
    site = Site(s, links, high + s.gap, 2.0 * max(s.bar, base_radius(drive)))
    frame = site.add(Carrier("frame", _frame(mechanism.breadth, s, low, high), links.frame(), low, high))
    frame.colour = FRAME_COLOUR
    carriers = maker.make(site, frame, linkage)
    for loop, dyad in enumerate(mechanism.dyads, 1):
        carriers += MAKERS[type(dyad)].make(site, loop, dyad, _mount(site, carriers, loop))
    beneath = max(base_radius(drive), 0.5 * mechanism.breadth + s.wall)
    foot = bearing(drive, [disc(beneath), *site.pads], low + disk.bottom - s.gap)
    ground = base((*foot, *_support(beneath, drive, low - s.gap), *site.ground))
    fits = (
        Fit("the frame's faces about the cam", s.clearance),
        *shaft_fits(drive),
        *site.fits,
        Fit("retainers on pins", s.press, pressed=True),
    )
    members = (*site.closed(), ground)
    place = Turning(mechanism.start + 0.25 * TURN)
    return Assembly((*turned(drive, low, place, members), *members), fits, s)


def _mount(site: Site, carriers: tuple[Carrier, ...], loop: int) -> Mount:
    """Extend the carrier of a dyad to the point that it hangs on.

    Raises BodyError where the dyad hangs on a block or a slide, or finds no room.
    """
    mechanism, path = site.links.mechanism, f"linkage.dyads[{loop - 1}]"
    name = mechanism.chain.carrier(loop - 1).name
    for carrier in carriers:
        if carrier.name == name:
            return Mount(carrier, carrier.reach(mechanism.dyads[loop - 1].point, site.s, f"{path}.point"))
    message = "is attached to a block or a slide, which has no room for it"
    raise BodyError(f"{path}.on", message, "attach it to the frame or to a rocker, or leave parts: all out")


def _frame(breadth: float, s: Sizes, low: float, high: float) -> list[Plate]:
    """The square about its middle, each face half the clearance farther out than half the breadth."""
    inner = 0.5 * breadth + s.gap_each_side
    outer = inner + s.wall
    return [Plate(box(-outer, -outer, outer, outer), (box(-inner, -inner, inner, inner),), low, high)]


def _support(radius: float, drive: Drive, high: float) -> list[Plate]:
    """A ring on the base that the frame lies on, where the base itself is too low; a lower hub stands in it."""
    disk, shaft, s = drive.disk, drive.shaft, drive.sizes
    if high - s.plate < 0.5 * s.gap:
        return []
    inner = max(disk.hub if disk.bottom < 0.0 else 0.0, shaft.journal + s.gap_each_side + 0.5 * s.wall) + s.space
    return [Plate(disc(radius), (disc(inner),), s.plate, high)]


def _coupler(frame: Carrier, linkage: FourBar | SliderCrank, site: Site) -> None:
    """Add the bar from the frame to D, in which its own axes then have their origin.

    It runs along the frame, or slants from the end of the frame's side where D stands beyond that.
    """
    s, half = site.s, 0.5 * site.links.mechanism.breadth
    start, end = half + s.gap_each_side + 0.5 * s.bar, half + linkage.coupler
    y = linkage.joint_offset
    if end < start:
        least = s.gap_each_side + 0.5 * s.bar
        raise BodyError("linkage.coupler", "ends within the frame's side", "give at least {least}", least=least)
    frame.origin = (end, y)
    frame.plates.append(Plate(bar((start, max(-half, min(y, half))), frame.origin, s.bar), (), frame.low, frame.high))


def _four_bar(site: Site, frame: Carrier, linkage: FourBar) -> tuple[Carrier, ...]:
    s = site.s
    _coupler(frame, linkage, site)
    low, high = site.level()
    frame.plates += pin(s, frame.origin, frame.high, low, high)
    site.hold("d", frame.name, frame.origin, high, frame.place)
    return frame, _rocker(site, linkage, low, high)


def _rocker(site: Site, linkage: FourBar | InvertedSliderCrank, low: float, high: float) -> Carrier:
    """Add the rocker from its post B to D."""
    s = site.s
    holes = ((0.0, 0.0), (linkage.rocker, 0.0))
    if linkage.rocker < s.bar:
        remedy = "give at least {least}, or a smaller mechanism.bar"
        raise BodyError("linkage.rocker", "too short for two pins", remedy, least=s.bar)
    site.post("b", (linkage.ground, 0.0), low, high)
    site.fits += [Fit("rocker on the pivot B", s.clearance), Fit("rocker on the joint D", s.clearance)]
    plates = bars(s, [holes], holes, low, high)
    return site.add(Carrier("rocker", plates, site.links.output(0), low, high, holes=holes))


def _slider_crank(site: Site, frame: Carrier, linkage: SliderCrank) -> tuple[Carrier, ...]:
    s = site.s
    _coupler(frame, linkage, site)
    last = frame.plates.pop()
    frame.plates.append(Plate(last.outline, (eye(s, *frame.origin),), last.low, last.high))
    frame.holes = (frame.origin,)
    place = site.links.output(0)
    slide = Carrier("slide", site.slide(frame.low, frame.high), place, 0.0, 0.0, BLOCK_COLOUR)
    site.add(slide)
    site.rails(place, (0.0, linkage.offset), 0.0)
    site.hold("d", slide.name, (0.0, 0.0), frame.high, place)
    site.floor += s.gap + s.clip
    site.fits += [Fit("slide between its rails", s.clearance), Fit("coupler on the joint D", s.clearance)]
    return (frame,)


def _inverted(site: Site, frame: Carrier, linkage: InvertedSliderCrank) -> tuple[Carrier, ...]:
    """The block slides in a slot of the frame's bar; it turns on the post B, or carries the end of a rocker."""
    s = site.s
    place = site.links.joint(0, "D")
    _slot(site, frame, place, linkage.joint_offset)
    plates = [Plate(block(s), () if linkage.rocker else (eye(s),), frame.low, frame.high)]
    site.fits.append(Fit("block in the frame's slot", s.clearance))
    if linkage.rocker == 0.0:
        over = (
            0.5 * s.bar + s.gap_each_side + s.wall
        )  # nothing else holds the frame down: out to the slot's outer edges
        site.post("b", (linkage.ground, 0.0), frame.low, frame.high, radius=over)
        site.floor += s.gap + s.clip
        site.fits.append(Fit("block on the pivot B", s.clearance))
        site.add(Carrier("block", plates, place, frame.low, frame.high, BLOCK_COLOUR))
        return ()
    low, high = site.level()
    plates += pin(s, (0.0, 0.0), frame.high, low, high)
    site.add(Carrier("block", plates, place, frame.low, frame.high, BLOCK_COLOUR))
    site.hold("d", "block", (0.0, 0.0), high, place)
    return (_rocker(site, linkage, low, high),)


def _slot(site: Site, frame: Carrier, block_place: Place, offset: float) -> None:
    """Add the slotted bar on the side of the frame where the block is; the side itself reaches to a bar beyond it."""
    s, half = site.s, 0.5 * site.links.mechanism.breadth
    found, middle = site.sampled(block_place), site.sampled(frame.place)
    c, n = np.cos(middle[:, 2]), np.sin(middle[:, 2])
    x = (found[:, 0] - middle[:, 0]) * c + (found[:, 1] - middle[:, 1]) * n
    side = 1.0 if x.mean() > 0.0 else -1.0
    first, last = float((side * x).min()), float((side * x).max())
    least = half + s.gap_each_side + s.wall + s.space + 0.5 * BLOCK * s.bar
    if first < least:
        message, remedy = (
            "the block would run into the frame, by {short}",
            "give a longer ground, or a smaller mechanism.bar",
        )
        raise BodyError("linkage.ground", message, remedy, short=least - first)
    y, inner = side * offset, half + s.gap_each_side
    outer, slot = slotted(first, last, y, s)
    ties = [box(inner, y - 0.5 * s.bar, outer.box()[0] + 0.5 * s.wall, y + 0.5 * s.bar)]
    if abs(y) > half:
        ties.append(box(inner, min(0.0, y - 0.5 * s.bar), inner + s.wall, max(0.0, y + 0.5 * s.bar)))
    outer, slot, *ties = (moved(one, 0.0, 0.0, 0.0 if side > 0.0 else 0.5 * TURN) for one in (outer, slot, *ties))
    frame.plates += [Plate(outer, (slot,), frame.low, frame.high)]
    frame.plates += [Plate(tie, (), frame.low, frame.high) for tie in ties]


class Maker(NamedTuple):
    """What makes the bodies of a loop, and gives those that dyads may hang on."""

    make: Callable[..., tuple[Carrier, ...]]
    under_frame: bool = False
    """Whether a slide runs under the frame."""


MAKERS: dict[type, Maker] = {
    FourBar: Maker(_four_bar),
    InvertedSliderCrank: Maker(_inverted),
    SliderCrank: Maker(_slider_crank, under_frame=True),
    RRR: Maker(rod_and_rocker),
    RRP: Maker(rod_and_slide),
    RPR: Maker(slotted_rocker),
}
