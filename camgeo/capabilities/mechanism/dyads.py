"""Further links of a linkage: bars, slides on rails and slotted rockers, each pair above what it hangs on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import Fit
from camgeo.capabilities.mechanism.base import BLOCK, BLOCK_COLOUR, Carrier, block, slotted
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.shapes import bars, eye, pin
from camgeo.capabilities.mechanism.sizes import BodyError

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.base import Mount, Site
    from kin.linkage.dyad import RPR, RRP, RRR


def rod_and_rocker(site: Site, loop: int, dyad: RRR, mount: Mount) -> tuple[Carrier]:
    """Add the bar PQ and the rocker GQ above it."""
    s = site.s
    rod = _rod(site, loop, dyad.links[0], mount)
    low, high = site.level()
    end = (dyad.links[0], 0.0)
    rod.plates += pin(s, end, rod.high, low, high)
    site.hold(f"q{loop}", rod.name, end, high, rod.place)
    site.post(f"g{loop}", dyad.ground, low, high)
    holes = ((0.0, 0.0), (dyad.links[1], 0.0))
    site.fits.append(Fit(f"rocker {loop} on its pins", s.clearance))
    place = site.links.output(loop)
    return (site.add(Carrier(f"rocker-{loop}", bars(s, [holes], holes, low, high), place, low, high, holes=holes)),)


def rod_and_slide(site: Site, loop: int, dyad: RRP, mount: Mount) -> tuple[()]:
    """Add the bar PQ and the slide on the base."""
    rod = _rod(site, loop, dyad.link, mount, (dyad.link, 0.0))
    place = site.links.joint(loop, "Q")
    slide = Carrier(f"slide-{loop}", site.slide(rod.low, rod.high), place, 0.0, 0.0, BLOCK_COLOUR)
    site.add(slide)
    site.rails(place, dyad.through, dyad.direction)
    site.hold(f"q{loop}", slide.name, (0.0, 0.0), rod.high, place)
    site.fits.append(Fit(f"slide {loop} between its rails", site.s.clearance))
    return ()


def _rod(site: Site, loop: int, length: float, mount: Mount, *holes: tuple[float, float]) -> Carrier:
    """Add the bar PQ, with a hole at P and those given."""
    s = site.s
    low, high = site.level()
    mount.hold(site, f"p{loop}", low, high)
    at = (0.0, 0.0)
    plates = bars(s, [(at, (length, 0.0))], (at, *holes), low, high)
    site.fits.append(Fit(f"rod {loop} on its pins", s.clearance))
    return site.add(Carrier(f"rod-{loop}", plates, site.links.rod(loop), low, high))


def slotted_rocker(site: Site, loop: int, dyad: RPR, mount: Mount) -> tuple[Carrier]:
    """Add the block on the pin P and the slotted rocker about G. Raises BodyError."""
    s, place = site.s, site.links.output(loop)
    low, high = site.level()
    mount.hold(site, f"p{loop}", low, high)
    block_place = site.links.joint(loop, "P")
    site.add(Carrier(f"block-{loop}", [Plate(block(s), (eye(s),), low, high)], block_place, low, high, BLOCK_COLOUR))
    at, turned = site.sampled(block_place), site.sampled(place)
    along = (at[:, 0] - dyad.ground[0]) * np.cos(turned[:, 2]) + (at[:, 1] - dyad.ground[1]) * np.sin(turned[:, 2])
    first, last = float(along.min()), float(along.max())
    start = first - 0.5 * BLOCK * s.bar - s.space - 0.5 * s.bar
    if start < 0.5 * s.bar:
        message = "the block comes too near to the pivot, by {short}"
        remedy = "move the pivot away, or give a smaller mechanism.bar"
        raise BodyError(f"linkage.dyads[{loop - 1}].ground", message, remedy, short=0.5 * s.bar - start)
    site.post(f"g{loop}", dyad.ground, low, high)
    site.fits.append(Fit(f"block {loop} in its slot and on its pin", s.clearance))
    holes = ((0.0, 0.0),)
    outer, slot = slotted(first, last, dyad.offset, s)
    plates = bars(s, [((0.0, 0.0), (start, dyad.offset))], holes, low, high)
    plates.append(Plate(outer, (slot,), low, high))
    return (site.add(Carrier(f"rocker-{loop}", plates, place, low, high, holes=holes)),)
