"""An indexing cam as thin layers about its axis, for pictures: the rib on each, and how it looks from the side.

The rib is the metal between one turn of the track and the next. In one layer it is one band that winds from the lower
end face to the upper one. A layer is seen square to the cam's axis: x to the right, y up, both mm, that axis at x = 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.spans import span_of
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Iterator

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.flank import Flank
    from kin.numeric.arrays import Array

PLACES = 120  # of a turn, at which heights are known
LOOKS = 720  # shaft angles of a turn at which flanks are computed
DEEP = 6  # layers from the floor to the blank, of which the blank is the last
RISE = 64  # parts of the length, between which a layer's distance from the cam's axis is known
UPRIGHT = 6  # parts of an edge from the bottom of a rib to its top
HALF = 0.5 * math.pi


class Layer(NamedTuple):
    """The rib in a layer.

    radius       distance from the cam's axis, mm (RISE + 1,), at equal steps of the height over the lower face
    length       of the cam, mm
    first        place of the unrolled turn from which on heights are known
    bottom, top  heights of the rib over the lower face, mm (n,), at whole places, by rising polar angle
    """

    radius: Array
    length: float
    first: int
    bottom: Array
    top: Array

    def out(self, z: Array) -> Array:
        """Distances from the cam's axis, mm (n,), at heights (n,), mm."""
        return np.asarray(np.interp(z * (RISE / self.length), np.arange(RISE + 1), self.radius))

    def heights(self, place: Array) -> tuple[Array, Array]:
        """Bottom and top of the rib, mm (n,) each, at places of the unrolled turn (n,) where it is."""
        own = place - self.first, np.arange(self.bottom.size)
        return np.interp(*own, self.bottom), np.interp(*own, self.top)

    def spans(self, low: float, high: float) -> Iterator[tuple[int, float, float]]:
        """Whole turns in which the rib passes between two places, and between which places of the unrolled turn."""
        last = self.first + self.bottom.size - 1
        for turn in range(math.floor((self.first - high) / PLACES), math.ceil((last - low) / PLACES) + 1):
            begin, end = max(low + turn * PLACES, self.first), min(high + turn * PLACES, last)
            if end > begin or (low == high and end == begin):
                yield turn, begin, end


def layer(design: IndexDesign, w: float) -> Layer:
    """The rib in a layer w, mm, of the cam as it is computed; raises TrackError where a flank does not cross it."""
    length = design.recipe.length
    (phi, z), (over_phi, over_z) = (line_in(design.flanks[name], w) for name in ("upper", "lower"))
    first, last = math.floor((over_phi[0] - TURN) / TURN * PLACES), math.ceil(phi[-1] / TURN * PLACES)
    at = np.arange(first, last + 1) * (TURN / PLACES)
    bottom = np.interp(at, phi, z, left=0.0, right=length)
    top = np.interp(at + TURN, over_phi, over_z, left=0.0, right=length)
    z = np.linspace(0.0, length, RISE + 1)
    return Layer(design.recipe.form.beside(w, z), length, first, bottom, np.maximum(bottom, top))


def line_in(flank: Flank, w: float) -> tuple[Array, Array]:
    """Polar angles, unrolled and rising, rad (n,), and heights over the lower face, mm, of a flank in a layer, mm."""
    begin, end = span_of(flank, np.array([w])).theta[:, 0].tolist()
    contact = flank.on(np.linspace(begin, end, max(2, math.ceil(LOOKS * (end - begin) / TURN)) + 1), w)
    z = np.clip(contact.z, 0.0, flank.form.length)
    z[0], z[-1] = 0.0, flank.form.length
    return contact.phi, z


def layers(design: IndexDesign, deep: int = DEEP) -> list[Layer]:
    """Layers at equal steps from the floor to the blank, `deep` + 1 in all."""
    form = design.recipe.form
    return [layer(design, w) for w in np.linspace(form.floor, form.blank, deep + 1).tolist()]


# --- as they are seen -------------------------------------------------------------------------------------------------


def seen(of: Layer, turn: float, low: float, high: float, sense: float) -> list[Array]:
    """Outlines (n, 2) of the rib in a layer between two angles to the right of the viewer, rad.

    `turn` is the polar angle that faces the viewer, rad, of the cam as it is computed; `sense` -1 shows it mirrored.
    """
    scale = PLACES / TURN
    ends = sorted((turn + sense * low, turn + sense * high))
    found = []
    for whole, begin, end in of.spans(ends[0] * scale, ends[1] * scale):
        place = np.concatenate([[begin], np.arange(math.floor(begin) + 1, math.ceil(end)), [end]])
        bottom, top = of.heights(place)
        up = np.arange(1, UPRIGHT) / UPRIGHT
        places = np.concatenate([place, np.full(up.size, end), place[::-1], np.full(up.size, begin)])
        z = np.concatenate([bottom, _steps(bottom[-1], top[-1], up), top[::-1], _steps(top[0], bottom[0], up)])
        x = of.out(z) * np.sin(sense * ((places - whole * PLACES) / scale - turn))
        found.append(np.column_stack([x, z]))
    return found


def _steps(begin: float, end: float, share: Array) -> Array:
    return begin + share * (end - begin)


def near(of: Layer, turn: float, sense: float) -> list[Array]:
    """Outlines of the near half of a layer."""
    return seen(of, turn, -HALF, HALF, sense)


def far(of: Layer, turn: float, sense: float, core: float) -> list[Array]:
    """Outlines of the far half of a layer beside a core, whose share of the layer's radius is given."""
    edge = math.pi - math.asin(min(core, 1.0))
    return [outline for low, high in ((HALF, edge), (-edge, -HALF)) for outline in seen(of, turn, low, high, sense)]


def rims(of: list[Layer], turn: float, sense: float) -> list[Array]:
    """Outlines (n, 2) of the rib between the first layer and the last, cut across the line of sight."""
    found = []
    up = np.arange(UPRIGHT + 1) / UPRIGHT
    for side in (-1.0, 1.0):
        at = (turn + sense * side * HALF) * (PLACES / TURN)
        turns = [{whole for whole, _, _ in each.spans(at, at)} for each in of]
        for whole in sorted(set.intersection(*turns)):
            rows = [each.heights(np.array([at + whole * PLACES])) for each in of]
            bottom, top = (np.array([row[k][0] for row in rows]) for k in range(2))
            outer = _steps(bottom[-1], top[-1], up)
            inner = _steps(top[0], bottom[0], up)
            x = [each.out(z[None])[0] for ends in (bottom, top) for each, z in zip(of, ends, strict=True)]
            low, high = np.array(x[: len(of)]), np.array(x[len(of) :])
            found.append(
                np.column_stack(
                    [
                        side * np.concatenate([low, of[-1].out(outer), high[::-1], of[0].out(inner)]),
                        np.concatenate([bottom, outer, top[::-1], inner]),
                    ]
                )
            )
    return found
