"""A cam in a square frame that is the coupler of a linkage: frame, rocker, block or slide, and the base with pivots.

Bodies that cross in plan lie one above another: the cam in its frame, the rocker above it, then the links of dyads,
each above the retainers below it. A slide runs under the frame, which then is higher by a link and a gap. Loop 0 is the
linkage's, loop k that of the k-th dyad, with joints P on the link that carries it, Q and a pivot G. Lengths in mm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.assembly import Assembly, BodyFit, Plate
from camgeo.capabilities.mechanism.body_stack import (
    BLOCK,
    BLOCK_COLOUR,
    FRAME_COLOUR,
    BodyStack,
    Carrier,
    Mount,
    block,
    slotted_bar,
)
from camgeo.capabilities.mechanism.poses import Links, Turning
from camgeo.capabilities.mechanism.shaft import base, bearing, least_pad_radius, shaft_fits, shaft_members
from camgeo.capabilities.mechanism.shapes import bar, bars, box, disc, eye, pin, transformed
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


def linkage_assembly(mechanism: Mechanism, drive: Drive) -> Assembly:
    """All bodies of a linkage that turns right round; raises BodyError where a body does not fit."""
    s, disk = drive.sizes, drive.disk
    linkage = mechanism.linkage
    maker = MAKERS[type(linkage)]
    # heights of the frame and the cam in it, over the base, a slide and a hub below the disc
    low = s.plate + s.gap + (s.link + s.gap if maker.under_frame else 0.0)
    low = max(low, s.plate + s.gap - disk.bottom)
    high = low + disk.thickness
    links = Links(mechanism)
    site = BodyStack(s, links, high + s.gap, 2.0 * max(s.bar, least_pad_radius(drive)))
    frame = site.add(Carrier("frame", _frame(mechanism.breadth, s, low, high), links.frame(), low, high))
    frame.colour = FRAME_COLOUR
    carriers = maker.make(site, frame, linkage)
    for loop, dyad in enumerate(mechanism.dyads, 1):
        carriers += MAKERS[type(dyad)].make(site, loop, dyad, _mount(site, carriers, loop))
    # the base: bearing of the shaft, a support of the frame, posts and rails
    support = max(least_pad_radius(drive), 0.5 * mechanism.breadth + s.wall)
    foot = bearing(drive, [disc(support), *site.pads], low + disk.bottom - s.gap)
    ground = base((*foot, *_support(support, drive, low - s.gap), *site.ground))
    fits = (
        BodyFit("the frame's faces about the cam", s.clearance),
        *shaft_fits(drive),
        *site.fits,
        BodyFit("retainers on pins", s.press, pressed=True),
    )
    members = (*site.all_members(), ground)
    # the cam's x axis is the normal of the face whose lift is given, a quarter turn ahead of the frame
    place = Turning(mechanism.start + 0.25 * TURN)
    return Assembly((*shaft_members(drive, low, place, members), *members), fits, s)


def _mount(site: BodyStack, carriers: tuple[Carrier, ...], loop: int) -> Mount:
    """Point to which the dyad of a loop, from 1, is attached, with a bar of its carrier that reaches there.

    Raises BodyError where the carrier is a block or a slide, or the bar would cut a hole.
    """
    mechanism, path = site.links.mechanism, f"linkage.dyads[{loop - 1}]"
    name = mechanism.chain.carrier(loop - 1).name
    for carrier in carriers:
        if carrier.name == name:
            return Mount(carrier, carrier.extend(mechanism.dyads[loop - 1].point, site.s, f"{path}.point"))
    message = "is attached to a block or a slide, which has no room for it"
    raise BodyError(f"{path}.on", message, "attach it to the frame or to a rocker, or leave parts: all out")


def _frame(breadth: float, s: Sizes, low: float, high: float) -> list[Plate]:
    """The square frame about its middle, each face half the clearance farther out than half the breadth."""
    inner = 0.5 * breadth + s.gap_each_side
    outer = inner + s.wall
    return [Plate(box(-outer, -outer, outer, outer), (box(-inner, -inner, inner, inner),), low, high)]


def _support(radius: float, drive: Drive, high: float) -> list[Plate]:
    """The ring on the base on which the frame lies, round a lower hub; none where the base is high enough."""
    disk, shaft, s = drive.disk, drive.shaft, drive.sizes
    if high - s.plate < 0.5 * s.gap:
        return []
    inner = max(disk.hub if disk.bottom < 0.0 else 0.0, shaft.journal + s.gap_each_side + 0.5 * s.wall) + s.space
    return [Plate(disc(radius), (disc(inner),), s.plate, high)]


def _coupler(frame: Carrier, linkage: FourBar | SliderCrank, site: BodyStack) -> None:
    """Add the bar from the frame to joint D, which becomes the origin of the link's axes.

    The bar is parallel to the frame's sides, or slants from the end of a side where D is beyond it. Raises BodyError
    for a coupler that ends within the frame's side.
    """
    s, half = site.s, 0.5 * site.links.mechanism.breadth
    start, end = half + s.gap_each_side + 0.5 * s.bar, half + linkage.coupler
    y = linkage.joint_offset
    if end < start:
        least = s.gap_each_side + 0.5 * s.bar
        raise BodyError("linkage.coupler", "ends within the frame's side", "give at least {least}", least=least)
    frame.origin = (end, y)
    frame.plates.append(Plate(bar((start, max(-half, min(y, half))), frame.origin, s.bar), (), frame.low, frame.high))


def _four_bar(site: BodyStack, frame: Carrier, linkage: FourBar) -> tuple[Carrier, ...]:
    """Add the coupler to the frame, and the rocker; return frame and rocker."""
    s = site.s
    _coupler(frame, linkage, site)
    low, high = site.level()
    frame.plates += pin(s, frame.origin, frame.high, low, high)
    site.add_retainer("d", frame.name, frame.origin, high, frame.place)
    return frame, _rocker(site, linkage, low, high)


def _rocker(site: BodyStack, linkage: FourBar | InvertedSliderCrank, low: float, high: float) -> Carrier:
    """Add the rocker from its post B to joint D, and return it; raises BodyError where it is too short for two pins."""
    s = site.s
    holes = ((0.0, 0.0), (linkage.rocker, 0.0))
    if linkage.rocker < s.bar:
        remedy = "give at least {least}, or a smaller mechanism.bar"
        raise BodyError("linkage.rocker", "too short for two pins", remedy, least=s.bar)
    site.add_post("b", (linkage.ground, 0.0), low, high)
    site.fits += [BodyFit("rocker on the pivot B", s.clearance), BodyFit("rocker on the joint D", s.clearance)]
    plates = bars(s, [holes], holes, low, high)
    return site.add(Carrier("rocker", plates, site.links.output(0), low, high, holes=holes))


def _slider_crank(site: BodyStack, frame: Carrier, linkage: SliderCrank) -> tuple[Carrier, ...]:
    """Add the coupler to the frame, and the slide between its rails; return the frame."""
    s = site.s
    _coupler(frame, linkage, site)
    # the coupler's bar, which was added last, gets the hole for the pin of joint D
    coupler = frame.plates.pop()
    frame.plates.append(Plate(coupler.outline, (eye(s, *frame.origin),), coupler.low, coupler.high))
    frame.holes = (frame.origin,)
    place = site.links.output(0)
    slide = Carrier("slide", site.slide(frame.low, frame.high), place, 0.0, 0.0, BLOCK_COLOUR)
    site.add(slide)
    site.add_rails(place, (0.0, linkage.offset), 0.0)
    site.add_retainer("d", slide.name, (0.0, 0.0), frame.high, place)
    site.next_low += s.gap + s.clip
    site.fits += [BodyFit("slide between its rails", s.clearance), BodyFit("coupler on the joint D", s.clearance)]
    return (frame,)


def _inverted(site: BodyStack, frame: Carrier, linkage: InvertedSliderCrank) -> tuple[Carrier, ...]:
    """Add the slotted bar to the frame, and the block in it, which turns on the post B or carries a rocker's end.

    The result has the rocker, or is empty without one. Raises BodyError for too short a rocker, and a block that would
    run into the frame.
    """
    s = site.s
    place = site.links.joint(0, "D")
    _slot(site, frame, place, linkage.joint_offset)
    plates = [Plate(block(s), () if linkage.rocker else (eye(s),), frame.low, frame.high)]
    site.fits.append(BodyFit("block in the frame's slot", s.clearance))
    if linkage.rocker == 0.0:
        # its retainer alone keeps the frame down, and so reaches to the slot's outer edges
        radius = 0.5 * s.bar + s.gap_each_side + s.wall
        site.add_post("b", (linkage.ground, 0.0), frame.low, frame.high, radius=radius)
        site.next_low += s.gap + s.clip
        site.fits.append(BodyFit("block on the pivot B", s.clearance))
        site.add(Carrier("block", plates, place, frame.low, frame.high, BLOCK_COLOUR))
        return ()
    low, high = site.level()
    plates += pin(s, (0.0, 0.0), frame.high, low, high)
    site.add(Carrier("block", plates, place, frame.low, frame.high, BLOCK_COLOUR))
    site.add_retainer("d", "block", (0.0, 0.0), high, place)
    return (_rocker(site, linkage, low, high),)


def _slot(site: BodyStack, frame: Carrier, block_place: Place, offset: float) -> None:
    """Add the slotted bar on the side of the frame where the block is, with ties to the frame.

    `offset` is the distance of the slot's middle line from the frame's. Raises BodyError where the block would run into
    the frame.
    """
    s, half = site.s, 0.5 * site.links.mechanism.breadth
    # travel of the block along the frame's x axis, over a turn
    blocks, frames = site.sample(block_place), site.sample(frame.place)
    c, n = np.cos(frames[:, 2]), np.sin(frames[:, 2])
    x = (blocks[:, 0] - frames[:, 0]) * c + (blocks[:, 1] - frames[:, 1]) * n
    side = 1.0 if x.mean() > 0.0 else -1.0
    first, last = float((side * x).min()), float((side * x).max())
    least = half + s.gap_each_side + s.wall + s.space + 0.5 * BLOCK * s.bar
    if first < least:
        message = "the block would run into the frame, by {short}"
        remedy = "give a longer ground, or a smaller mechanism.bar"
        raise BodyError("linkage.ground", message, remedy, short=least - first)
    # outlines for a block on the right; for one on the left they are turned by half a turn
    y, inner = side * offset, half + s.gap_each_side
    outer, slot = slotted_bar(first, last, y, s)
    ties = [box(inner, y - 0.5 * s.bar, outer.box()[0] + 0.5 * s.wall, y + 0.5 * s.bar)]
    if abs(y) > half:
        ties.append(box(inner, min(0.0, y - 0.5 * s.bar), inner + s.wall, max(0.0, y + 0.5 * s.bar)))
    angle = 0.0 if side > 0.0 else 0.5 * TURN
    outer, slot, *ties = (transformed(outline, 0.0, 0.0, angle) for outline in (outer, slot, *ties))
    frame.plates += [Plate(outer, (slot,), frame.low, frame.high)]
    frame.plates += [Plate(tie, (), frame.low, frame.high) for tie in ties]


def rod_and_rocker(site: BodyStack, loop: int, dyad: RRR, mount: Mount) -> tuple[Carrier]:
    """Add the bar PQ from `mount` and the rocker GQ above it, of the dyad `loop`, from 1; the result has the rocker."""
    s = site.s
    rod = _rod(site, loop, dyad.links[0], mount)
    low, high = site.level()
    end = (dyad.links[0], 0.0)
    rod.plates += pin(s, end, rod.high, low, high)
    site.add_retainer(f"q{loop}", rod.name, end, high, rod.place)
    site.add_post(f"g{loop}", dyad.ground, low, high)
    holes = ((0.0, 0.0), (dyad.links[1], 0.0))
    site.fits.append(BodyFit(f"rocker {loop} on its pins", s.clearance))
    place = site.links.output(loop)
    return (site.add(Carrier(f"rocker-{loop}", bars(s, [holes], holes, low, high), place, low, high, holes=holes)),)


def rod_and_slide(site: BodyStack, loop: int, dyad: RRP, mount: Mount) -> tuple[()]:
    """Add the bar PQ from `mount` and the slide on the base, of the dyad `loop`, from 1; the result is empty."""
    rod = _rod(site, loop, dyad.link, mount, (dyad.link, 0.0))
    place = site.links.joint(loop, "Q")
    slide = Carrier(f"slide-{loop}", site.slide(rod.low, rod.high), place, 0.0, 0.0, BLOCK_COLOUR)
    site.add(slide)
    site.add_rails(place, dyad.through, dyad.direction)
    site.add_retainer(f"q{loop}", slide.name, (0.0, 0.0), rod.high, place)
    site.fits.append(BodyFit(f"slide {loop} between its rails", site.s.clearance))
    return ()


def _rod(site: BodyStack, loop: int, length: float, mount: Mount, *holes: tuple[float, float]) -> Carrier:
    """Add the bar PQ of a dyad from its mount, `length` mm, with a hole at P and at `holes`; return the bar."""
    s = site.s
    low, high = site.level()
    mount.add_pin(site, f"p{loop}", low, high)
    start = (0.0, 0.0)
    plates = bars(s, [(start, (length, 0.0))], (start, *holes), low, high)
    site.fits.append(BodyFit(f"rod {loop} on its pins", s.clearance))
    return site.add(Carrier(f"rod-{loop}", plates, site.links.rod(loop), low, high))


def slotted_rocker(site: BodyStack, loop: int, dyad: RPR, mount: Mount) -> tuple[Carrier]:
    """Add the block on a pin at `mount` and the slotted rocker about G, of the dyad `loop`, from 1.

    The result has the rocker. Raises BodyError where the block comes too near to the pivot G.
    """
    s, place = site.s, site.links.output(loop)
    low, high = site.level()
    mount.add_pin(site, f"p{loop}", low, high)
    block_place = site.links.joint(loop, "P")
    site.add(Carrier(f"block-{loop}", [Plate(block(s), (eye(s),), low, high)], block_place, low, high, BLOCK_COLOUR))
    # travel of the block along the rocker, over a turn
    blocks, angle = site.sample(block_place), site.sample(place)[:, 2]
    along = (blocks[:, 0] - dyad.ground[0]) * np.cos(angle) + (blocks[:, 1] - dyad.ground[1]) * np.sin(angle)
    first, last = float(along.min()), float(along.max())
    # place along the rocker at which the arm from G ends: half its breadth before the slot, which its round end touches
    arm_end = first - 0.5 * BLOCK * s.bar - s.space - 0.5 * s.bar
    if arm_end < 0.5 * s.bar:
        message = "the block comes too near to the pivot, by {short}"
        remedy = "move the pivot away, or give a smaller mechanism.bar"
        raise BodyError(f"linkage.dyads[{loop - 1}].ground", message, remedy, short=0.5 * s.bar - arm_end)
    site.add_post(f"g{loop}", dyad.ground, low, high)
    site.fits.append(BodyFit(f"block {loop} in its slot and on its pin", s.clearance))
    holes = ((0.0, 0.0),)
    outer, slot = slotted_bar(first, last, dyad.offset, s)
    plates = bars(s, [((0.0, 0.0), (arm_end, dyad.offset))], holes, low, high)
    plates.append(Plate(outer, (slot,), low, high))
    return (site.add(Carrier(f"rocker-{loop}", plates, place, low, high, holes=holes)),)


class Maker(NamedTuple):
    """Function that adds the bodies of a loop, and returns the bodies to which dyads may be attached."""

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
