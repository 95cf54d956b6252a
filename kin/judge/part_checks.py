"""The checks on a part with more than a bore: openings on a drawing, and a solid's faces and sections in layers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.contour.holes import FINE, Tallies, Tally, apart, tally
from kin.follower.deviation import deviation
from kin.numeric.check import Check, less_sure
from kin.numeric.lengths import UNIT, length_words
from kin.read.layers import between_sections, faces, heights, leans, slotted, tally_faces, told

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.judge.intent import PartIntent
    from kin.judge.surfaces import SortedChains
    from kin.read.formats import AnySolid
    from kin.read.layers import Layer


def drawn_checks(
    holes: Sequence[Contour], engraved: Sequence[Contour], part: PartIntent, tolerance: float
) -> list[Check]:
    """Check the openings of a drawing, in mm and no longer mirrored: each once at its place, and none besides."""
    through = [hole for hole in part.holes if hole.depth is None]
    tallies: Tallies = {}
    tally(tallies, holes, through, tolerance, settled=part.holes, closed=part.closed)
    shallow = [hole for hole in part.holes if hole.depth is not None]
    if shallow:
        tally(tallies, engraved, shallow, tolerance, where=", engraved", settled=part.holes, closed=part.closed)
    return told(tallies, tolerance)


def levels_of(part: PartIntent) -> list[float]:
    """Heights z, mm, of the sections of a solid that are judged, the plain disc's first."""
    return [z for z, _ in heights(part.layers, part.cross_holes)]


def solid_checks(solid: AnySolid, sections: Sequence[SortedChains], part: PartIntent, tolerance: float) -> list[Check]:
    """Check the openings, faces and sections of a solid, in mm and no longer mirrored.

    `sections` are those at the heights of `levels_of(part)`, in their order. The plain disc's surfaces are judged
    elsewhere; here its sections need only be the same all along, but for rounding of the file's own numbers, which is
    counted. Raises UnsettledError where the deviation of a section is not found.
    """
    layers, cross_holes = part.layers, part.cross_holes
    kinds = ["thickness", *(layer.outline.kind for layer in layers if layer.outline is not None)]
    kinds += ["chamfer" for layer in layers if layer.inset != (0.0, 0.0)] + ["set-screw" for _ in cross_holes]
    tallies: Tallies = {kind: Tally() for kind in kinds}
    tally_faces(tallies, solid, layers, tolerance)
    levels = [z for _, z in faces(layers)]
    for kind, fault in between_sections(solid, levels, leans(layers, cross_holes), tolerance):
        tallies[kind].faults.append(fault)
    for (z, layer), section in zip(heights(layers, cross_holes), sections, strict=True):
        _section(tallies, (z, layer), section, part, tolerance)
    return [less_sure(check, solid.uneven) for check in told(tallies, tolerance)]


def _section(
    tallies: Tallies, level: tuple[float, Layer], section: SortedChains, part: PartIntent, tolerance: float
) -> None:
    """Compare one section with the intended one at its level."""
    z, layer = level
    where = f" at z = {length_words(z)} {UNIT}"
    if layer.outline is None:
        tally(tallies, section.holes, layer.holes, tolerance, where=where, settled=part.holes)
        for chain, surface in zip(section.surfaces, part.surfaces, strict=True):
            kind, envelope = "chamfer", surface.gauge.envelope
            if layer.inset != (0.0, 0.0):
                envelope = envelope.inset(layer.inset_at(z))
            elif surface.trimmed or not envelope.regular:
                continue
            else:
                kind = "thickness"
            strayed = deviation(chain.contour, envelope)
            if strayed.rounds != 1:
                tallies[kind].faults.append(f"the section{where} goes {strayed.rounds} times round the exact one")
            off = strayed.worst[0]
            tallies[kind].measured(max(off, 0.0), f"the section{where} is off by {length_words(off, '.3g')} {UNIT}")
        return
    (chain,) = section.surfaces
    bored = next((hole for hole in part.cross_holes if hole.half_width(z) > 0.0), None)
    if bored is None:
        tally(tallies, section.holes, layer.holes, tolerance, where=where, settled=part.holes)
        off = apart(chain.contour, layer.outline.contour, FINE * tolerance)
        tallies[layer.outline.kind].measured(
            off, f"{layer.outline.name}{where} is off by {length_words(off, '.3g')} {UNIT}"
        )
        return
    # the ring is cut open: its outline runs in along one side of the slot, round the bore and out along the other
    bore, *others = layer.holes
    screw_tally = tallies["set-screw"]
    if len(section.holes) != len(others):
        fault = f"the section has {len(section.holes)} holes, {len(others)} are expected"
        screw_tally.faults.append(f"{bored.name}{where}: {fault}")
        return
    outline = slotted(layer.outline, bore, bored.at, bored.half_width(z))
    off = apart(chain.contour, outline, FINE * tolerance)
    screw_tally.measured(off, f"{bored.name}{where} is off by {length_words(off, '.3g')} {UNIT}")
