"""The checks on a part with more than a bore: openings on a drawing, and a solid's faces and sections in layers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.follower.deviation import deviation
from kin.judge.check import Check, at_most, less_sure
from kin.judge.contour_checks import exact_area
from kin.judge.holes import FINE, Tallies, Tally, apart, tally
from kin.judge.layers import faces, heights, slotted, volume, wall_area

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.follower.envelope import Envelope
    from kin.judge.contour_checks import Intent
    from kin.judge.layers import Layer
    from kin.read.files import AnySolid
    from kin.read.mesh.stl import Section

ORDER = ("bore", "holes", "mark", "thickness", "hub", "chamfer", "set-screw")
ROUNDING = 1e-12
SAME = 1e-9  # mm: heights this close are one


def drawn_checks(
    holes: Sequence[Contour], engraved: Sequence[Contour], intent: Intent, tolerance: float
) -> list[Check]:
    """Check the openings of a drawing, in mm and no longer mirrored: each once at its place, and none besides."""
    through = [hole for hole in intent.holes if hole.depth is None]
    tallies: Tallies = {}
    tally(tallies, holes, through, tolerance, known=intent.holes)
    shallow = [hole for hole in intent.holes if hole.depth is not None]
    if shallow:
        tally(tallies, engraved, shallow, tolerance, where=", engraved", known=intent.holes)
    return _told(tallies, tolerance)


def levels(intent: Intent) -> list[float]:
    """Heights at which a solid is looked at, the plain disc's first; empty where it is not meant to be in layers."""
    return [z for z, _ in heights(intent.layers, intent.cross_holes)] if intent.layers else []


def solid_checks(solid: AnySolid, sections: Sequence[Section], intent: Intent, tolerance: float) -> list[Check]:
    """Check the openings, faces and sections of a solid, in mm and no longer mirrored, and its volume.

    The plain disc's contour is judged elsewhere; here its sections need only be the same all along,
    but for what the rounding of the file's own numbers makes of them, which is counted.
    """
    layers, cross_holes = intent.layers, intent.cross_holes
    tallies: Tallies = {"thickness": Tally()}
    for kind, when in (
        ("hub", any(layer.outline is not None for layer in layers)),
        ("chamfer", any(layer.inset != (0.0, 0.0) for layer in layers)),
        ("set-screw", bool(cross_holes)),
    ):
        if when:
            tallies[kind] = Tally()
    _faces(tallies, solid, layers, tolerance)
    if len(layers) == 1 and not solid.prism:
        tallies["thickness"].faults.append("the sections at different heights differ")
    for (z, layer), section in zip(heights(layers, cross_holes), sections, strict=True):
        _section(tallies, (z, layer), section, intent, tolerance)
    told = [less_sure(check, solid.uneven) for check in _told(tallies, tolerance)]
    return [*told, layers_volume_check(solid.volume, sections[0].contour, intent, tolerance)]


def _told(tallies: Tallies, tolerance: float) -> list[Check]:
    return [tallies[name].check(name, tolerance) for name in ORDER if name in tallies]


def _faces(tallies: Tallies, solid: AnySolid, layers: Sequence[Layer], tolerance: float) -> None:
    """Hold the horizontal faces against those that are meant."""
    meant = faces(layers)
    found = np.array(solid.faces)
    for kind, z in meant:
        told = tallies.setdefault(kind, Tally())
        if not found.size:
            told.faults.append(f"no horizontal face at z = {z:.9g} mm")
            continue
        nearest = float(found[np.abs(found - z).argmin()])
        told.measured(abs(nearest - z), f"a face at z = {nearest:.9g} mm, where {z:.9g} mm is expected")
    places = np.array([z for _, z in meant])
    for z in solid.faces:
        k = int(np.abs(places - z).argmin())
        if abs(float(places[k]) - z) > tolerance + SAME:
            kind = meant[k][0]
            tallies[kind].faults.append(f"a horizontal face at z = {z:.9g} mm, where none is expected")


def _section(tallies: Tallies, level: tuple[float, Layer], section: Section, intent: Intent, tolerance: float) -> None:
    """Hold one section against what is meant at its level."""
    z, layer = level
    where = f" at z = {z:.6g} mm"
    exact: Envelope = intent.follower.envelope
    if layer.outline is None:
        tally(tallies, section.holes, layer.holes, tolerance, where=where, known=intent.holes)
        if layer.inset == (0.0, 0.0):
            kind, envelope = "thickness", exact
            if intent.trimmed or not envelope.regular:
                return
        else:
            kind, envelope = "chamfer", exact.inset(layer.inset_at(z))
        strayed = deviation(section.contour.as_arcs()[0], envelope)
        if strayed.rounds != 1:
            tallies[kind].faults.append(f"the section{where} goes {strayed.rounds} times round the exact one")
        tallies[kind].measured(max(strayed.worst[0], 0.0), f"the section{where} is off by {strayed.worst[0]:.3g} mm")
        return
    bored = next((one for one in intent.cross_holes if one.half_width(z) > 0.0), None)
    if bored is None:
        tally(tallies, section.holes, layer.holes, tolerance, where=where, known=intent.holes)
        off_hub = apart(section.contour, layer.outline.contour, FINE * tolerance)
        tallies["hub"].measured(off_hub, f"{layer.outline.name}{where} is off by {off_hub:.3g} mm")
        return
    # the ring is cut open: its outline runs in along one side of the slot, round the bore and out along the other
    bore, *others = layer.holes
    told = tallies["set-screw"]
    if len(section.holes) != len(others):
        fault = f"the section has {len(section.holes)} holes, {len(others)} are expected"
        told.faults.append(f"{bored.name}{where}: {fault}")
        return
    meant = slotted(layer.outline, bore, bored.at, bored.half_width(z))
    off = apart(section.contour, meant, FINE * tolerance)
    told.measured(off, f"{bored.name}{where} is off by {off:.3g} mm")


def layers_volume_check(measured: float, contour: Contour, intent: Intent, tolerance: float) -> Check:
    """Check the volume of a part in layers, mm^3, against closed forms: within the tolerance times the walls' area."""
    area, perimeter, source = exact_area(contour, intent)
    expected = volume(intent.layers, intent.cross_holes, area, perimeter)
    limit = tolerance * wall_area(intent.layers, intent.cross_holes, perimeter)
    detail = f"{measured:.9g} mm^3, by the {source} {expected:.9g}"
    return at_most("volume", abs(measured - expected), limit, "mm^3", detail=detail, slack=ROUNDING * expected)
