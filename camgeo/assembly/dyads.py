"""Further links of a linkage: bars, slides on rails and slotted rockers, each pair above what it hangs on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.assembly.assembly import Fit
from camgeo.assembly.base import BLOCK, BLOCK_COLOUR, Carrier, Mount, block, slotted
from camgeo.assembly.body import Plate
from camgeo.assembly.link_poses import jet
from camgeo.assembly.shapes import bars, eye, pin
from camgeo.assembly.sizes import BodyError
from kin.linkage.dyad import RRP, RRR

if TYPE_CHECKING:
    from camgeo.assembly.base import Site
    from kin.linkage.dyad import RPR


def hang(site: Site, carriers: dict[str, Carrier]) -> None:
    """Add the bodies of all dyads of a mechanism; `carriers` are its frame and its rocker.

    Raises BodyError where a dyad hangs on a block or a slide, or finds no room.
    """
    output = carriers.get("output")
    previous: Carrier | None = None
    for number, dyad in enumerate(site.links.mechanism.dyads):
        path = f"linkage.dyads[{number}]"
        carrier = {"coupler": carriers.get("coupler"), "output": output, "previous": previous}[dyad.on]
        if carrier is None:
            message = "is attached to a block or a slide, which has no room for it"
            raise BodyError(f"{path}.on", message, "attach it to the frame or to a rocker, or leave parts: all out")
        mount = Mount(carrier, carrier.reach(dyad.point, site.s, f"{path}.point"))
        if isinstance(dyad, RRR | RRP):
            previous = _rod(site, number, dyad, mount)
        else:
            previous = _slotted(site, number, dyad, mount)


def _rod(site: Site, number: int, dyad: RRR | RRP, mount: Mount) -> Carrier | None:
    """Add the bar PQ, and the rocker GQ above it or the slide on the base; give the rocker."""
    s, links, name = site.s, site.links, f"{number + 1}"
    low, high = site.level()
    mount.hold(site, f"p{name}", low, high)
    length = dyad.links[0] if isinstance(dyad, RRR) else dyad.link
    end = (length, 0.0)
    holes = ((0.0, 0.0),) if isinstance(dyad, RRR) else ((0.0, 0.0), end)
    rod = Carrier(f"rod-{name}", bars(s, [((0.0, 0.0), end)], holes, low, high), links.rod(number), low, high)
    site.add(rod)
    site.fits.append(Fit(f"rod {name} on its pins", s.clearance))
    place = links.link(links.dyad(number))
    if isinstance(dyad, RRP):
        slide = Carrier(f"slide-{name}", site.slide(low, high), place, 0.0, 0.0, BLOCK_COLOUR)
        site.add(slide)
        site.rails(place, dyad.through, dyad.direction)
        site.hold(f"q{name}", slide.name, (0.0, 0.0), high, place)
        site.fits.append(Fit(f"slide {name} between its rails", s.clearance))
        return None
    low, high = site.level()
    rod.plates += pin(s, end, rod.high, low, high)
    site.hold(f"q{name}", rod.name, end, high, rod.place)
    site.post(f"g{name}", dyad.ground, low, high)
    holes = ((0.0, 0.0), (dyad.links[1], 0.0))
    site.fits.append(Fit(f"rocker {name} on its pins", s.clearance))
    return site.add(Carrier(f"rocker-{name}", bars(s, [holes], holes, low, high), place, low, high, holes=holes))


def _slotted(site: Site, number: int, dyad: RPR, mount: Mount) -> Carrier:
    """Add the block on the pin P and the slotted rocker about G."""
    s, links, name = site.s, site.links, f"{number + 1}"
    place = links.link(links.dyad(number))
    low, high = site.level()
    mount.hold(site, f"p{name}", low, high)
    block_place = links.place(lambda motion: (*links.hung(number)(motion), jet(motion.outputs[number + 1])))
    site.add(Carrier(f"block-{name}", [Plate(block(s), (eye(s),), low, high)], block_place, low, high, BLOCK_COLOUR))
    at, turned = site.sampled(block_place), site.sampled(place)
    along = (at[:, 0] - dyad.ground[0]) * np.cos(turned[:, 2]) + (at[:, 1] - dyad.ground[1]) * np.sin(turned[:, 2])
    first, last = float(along.min()), float(along.max())
    start = first - 0.5 * BLOCK * s.bar - s.space - 0.5 * s.bar
    if start < 0.5 * s.bar:
        message = "the block comes too near to the pivot, by {short}"
        remedy = "move the pivot away, or give a smaller mechanism.bar"
        raise BodyError(f"linkage.dyads[{number}].ground", message, remedy, short=0.5 * s.bar - start)
    site.post(f"g{name}", dyad.ground, low, high)
    site.fits.append(Fit(f"block {name} in its slot and on its pin", s.clearance))
    holes = ((0.0, 0.0),)
    outer, slot = slotted(first, last, dyad.offset, s)
    plates = bars(s, [((0.0, 0.0), (start, dyad.offset))], holes, low, high)
    plates.append(Plate(outer, (slot,), low, high))
    return site.add(Carrier(f"rocker-{name}", plates, place, low, high, holes=holes))
