"""Content of the page of one recipe, from the design and the files: scene, plots, dwells, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from camgeo.curve.ring import Ring, disc
from camgeo.report.extension import PAGE
from camgeo.report.page import curves, guided, outline
from camgeo.report.page.followers import SHAFT, cam, double_roller, faces, flat, flat_pair
from camgeo.report.page.overlays import Stage, overlay_bodies
from camgeo.report.page.scene import CONTACTS, STEPS, FilledShape, MovingBody, Scene, pivot
from camgeo.synthesis.view import Drawer, Round, View, entry, view_of
from kin.law.contacts import Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.report.plot import Plot
    from camgeo.synthesis.design import Design, Disc
    from kin.law.contacts import Arrangement, Guide, Touch
    from kin.numeric.arrays import Array

JOINT = 0.045  # of the cam's greatest radius: the size of a joint, a pin of which is still seen on a page
EXACT = "exact"
SIGN = "above 0 where the cam drives a rise"
PUSHED = "above 0 where a disc pushes its own contact outwards"


@dataclass(frozen=True, eq=False)
class FileError:
    """Distance of a file's contour from the exact one, in the recipe's unit, above 0 outside.

    `low` and `high` (STEPS,) are the least and the greatest distance in each step of the shaft, nan where the contour
    is cut away. `surface` is the contour's name, empty where the cam has one. Files with the same error share an entry,
    whose name lists them. `tolerance` is the file's, in the recipe's unit.
    """

    name: str
    surface: str
    low: Array
    high: Array
    tolerance: float

    def like(self, other: FileError) -> bool:
        """Whether another file's error is the same within what a picture shows."""
        alike = curves.equal(self.low, other.low) and curves.equal(self.high, other.high)
        return (self.surface, self.tolerance) == (other.surface, other.tolerance) and alike


@dataclass(frozen=True, eq=False)
class Traced:
    """Points and outward normals (STEPS, 2) of an exact contour in the cam's axes, at one place in each step.

    That of step k is at the shaft angle ``(k + share) / STEPS`` of a turn, the share from 0 to 1/2.
    """

    point: Array
    normal: Array
    share: float

    def at(self, angle: float) -> tuple[float, float]:
        """The point (x, y) nearest to a shaft angle, degrees."""
        x, y = self.point[round(angle / 360.0 * STEPS - self.share) % STEPS].tolist()
        return x, y


@dataclass(frozen=True, eq=False)
class Content:
    """Drawing, plots and errors of a page; lengths in the recipe's unit, the scene for the recipe's sense of rotation.

    `rests` are the dwells. `relative` (STEPS + 1,) is the angle between cam and frame, rad, at the steps of the shaft
    angle; without a linkage it is the shaft angle. `contours` are the exact ones by the names of their surfaces;
    `errors` are of the files' contours.
    """

    scene: Scene
    plots: tuple[Plot, ...]
    rests: tuple[curves.DwellBand, ...]
    relative: Array
    contours: Mapping[str, Traced]
    errors: tuple[FileError, ...]


def content(recipe: Recipe, design: Design, results: Sequence[FileResult]) -> Content:
    """Content of a page; `results` are the judged files, of which those with a contour are drawn."""
    files = [file for result in results if (file := outline.contours_of(recipe, result)) is not None]
    per = outline.Exact.looks(files)
    exacts = {profile.surface.name: outline.Exact.of(design, profile, per) for profile in design.surfaces}
    # the drawing: one for each group of files that show the whole cam
    groups = outline.group_files(files, len(design.discs))
    drawings = [_drawing_of(group) for group in groups]
    scene, plots, relative = mechanism(recipe, design, drawings)
    plots += curves.preload(recipe, design)
    for answers in PAGE.of(recipe.uses):
        plots += answers.plots(recipe, design)
    plots += [curves.curvature(recipe, design, profile, exacts[profile.surface.name]) for profile in design.surfaces]
    plots += [plot for group in groups for plot in curves.backlash(recipe, design, group)]
    # the distances from the exact contours; equal ones are listed once, as files of one tolerance often agree
    measured = ((file, surface, exacts[surface].error(arcs)) for file in files for surface, arcs in file.arcs.items())
    errors = [
        FileError(file.name, surface, low / recipe.mm, high / recipe.mm, file.tolerance / recipe.mm)
        for file, surface, (low, high) in measured
    ]
    merged = tuple(
        replace(alike[0], name=", ".join(error.name for error in alike))
        for alike in curves.group_alike(errors, FileError.like)
    )
    # the exact contours as they are drawn, at one of the `per` places in each step: the middle, or the last before it
    flip = np.array([1.0, -1.0 if recipe.rotation == "ccw" else 1.0])
    middle = slice(per // 2, None, per)
    contours = {
        name: Traced(exact.point[middle] * flip / recipe.mm, exact.normal[middle] * flip, per // 2 / per)
        for name, exact in exacts.items()
    }
    rests = tuple(curves.rests(recipe, design))
    return Content(scene, tuple(curves.merge_alike(plots)), rests, relative, contours, merged)


def mechanism(recipe: Recipe, design: Design, drawn: list[Drawn] | None = None) -> tuple[Scene, list[Plot], Array]:
    """Return scene, plots of the motion, and the angle between cam and frame (STEPS + 1,), rad.

    The scene is in the recipe's unit and for the recipe's sense of rotation. It shows the contours `drawn`, by default
    the exact ones.
    """
    scene, plots, relative = _mechanism(recipe, design, drawn or [(EXACT, _exact_rings(recipe, design))])
    scene = scene.scaled(1.0 / recipe.mm)
    return scene.mirrored() if recipe.rotation == "ccw" else scene, plots, relative


Drawn: TypeAlias = "tuple[str, tuple[tuple[Ring, ...], ...]]"
"""Drawing of a contour: its name, and the rings of each disc."""


def _drawing_of(group: Sequence[outline.FileContours]) -> Drawn:
    return ", ".join(file.name for file in group), tuple(rings for file in group for rings in file.rings)


def _on_face(disc_design: Disc) -> list[FilledShape]:
    """Boss and timing mark of a disc, which the outline read from a file lacks or has as a hole like others."""
    body = disc_design.body
    if body is None:
        return []
    boss = body.boss
    shapes = [] if boss is None else [FilledShape("hub", (disc(0.0, 0.0, 0.5 * boss.diameter),), boss.name)]
    for opening in body.openings:
        if opening.layer in {"MARK", "ENGRAVE"}:
            ring = Ring(opening.outline.points, opening.outline.bulges)
            shapes.append(FilledShape("timing mark", (ring,), "zero of the motion"))
    return shapes


def _exact_rings(recipe: Recipe, design: Design) -> tuple[tuple[Ring, ...], ...]:
    rim = (disc(0.0, 0.0, 0.5 * recipe.part.outer),) if recipe.part.outer else ()
    rings = []
    for disc_design in design.discs:
        contours = [outline.exact(contour) for _, contour in disc_design.contours] if design.contours else []
        if not contours:
            contours = [outline.exact(profile.surface.curve, whole=True) for profile in disc_design.surfaces]
        rings.append((*rim, *contours, *_openings(recipe, disc_design)))
    return tuple(rings)


def _openings(recipe: Recipe, disc_design: Disc) -> tuple[Ring, ...]:
    """Return the rings of the openings through a disc, mm; of a disc without a body its bore alone."""
    if disc_design.body is None:
        return (disc(0.0, 0.0, 0.5 * recipe.part.bore),) if recipe.part.bore else ()
    cut = [opening.outline for opening in disc_design.body.openings if opening.depth is None]
    return tuple(Ring(outline.points, outline.bulges) for outline in cut)


def _discs(design: Design, drawings: list[Drawn], bore: float | None, size: float, turned: Array) -> list[MovingBody]:
    """Return each disc with its boss and mark, the lowest first; discs above it are drawn translucent."""
    several = len(design.discs) > 1
    return [
        cam(
            [(name, rings[rank]) for name, rings in drawings],
            bore,
            size,
            turned,
            on_it=_on_face(disc_design),
            name=disc_design.name if several else "cam",
            role="metal upper" if rank else "metal",
        )
        for rank, disc_design in enumerate(design.discs)
    ]


def _mechanism(recipe: Recipe, design: Design, drawings: list[Drawn]) -> tuple[Scene, list[Plot], Array]:
    """Return scene and plots in mm, and the relative angle over the shaft angle (STEPS + 1,)."""
    _, rings_of_discs = drawings[0]
    # the greatest radius scales the symbols and ends the lines that pass the cam
    reach = max(float(np.hypot(*rings[0].flattened().T).max()) for rings in rings_of_discs)
    size, bore = JOINT * reach, recipe.part.bore
    note = "" if design.contours else "The cam is not made: a check of the exact contour fails."
    if len(design.discs) > 1:
        *lower, upper = (disc_design.name for disc_design in design.discs)
        note = f"{upper.capitalize()} stands in front of {' and '.join(lower)} and is drawn through. {note}".rstrip()
    first = design.exact.surfaces[0]
    # the line at the zero of the motion begins at the contour of a ring, and not at a bore
    if first.side < 0:
        bore = 2.0 * float(np.hypot(*first.curve.sample(np.zeros(1)).point[0]))
    if design.driven is not None and design.driven.turns:
        from camgeo.report.page.linked import SteppedMechanism, linkage_bodies, path_bodies

        # a mechanism that turns: its links move the frame, against which the cam turns
        driven = SteppedMechanism.of(design.driven.mechanism)
        discs = _discs(design, drawings, bore, size, driven.cam)
        bodies = linkage_bodies(driven, size)
        if recipe.linkage is not None:
            bodies += path_bodies(driven, recipe.linkage.traces, recipe.mm, size)
        stage = Stage(view_of(recipe, design), driven.cam, driven.theta, reach, size)
        bodies = _under_contacts(overlay_bodies(recipe.export.overlays, stage), bodies)
        return (
            Scene((*discs, pivot("shaft", 0.0, 0.0, size, "A"), *bodies), note),
            curves.output(recipe, driven),
            driven.theta,
        )
    if design.driven is not None:
        details = "; ".join(check.detail for check in design.driven.checks if not check.ok and check.detail)
        slides = "The mechanism does not make a full turn: the cam is shown in a frame that only slides. "
        note = f"{slides}{details[0].upper()}{details[1:]}. {note}" if details else slides + note
    # the follower alone, on its guide
    view = view_of(recipe, design)
    bodies, follower_plots = DRAWN[design.follower.arrangement](view, reach, size)
    shaft = pivot("shaft", 0.0, 0.0, size, "O" if view.guide.unit == "deg" else "")
    discs = _discs(design, drawings, bore, size, -SHAFT)
    stage = Stage(view, -SHAFT, SHAFT, reach, size)
    bodies = _under_contacts(overlay_bodies(recipe.export.overlays, stage), bodies)
    return Scene((*discs, shaft, *bodies), note), [*curves.motion(recipe, design), *follower_plots], SHAFT


def _under_contacts(overlays: Sequence[MovingBody], bodies: list[MovingBody]) -> list[MovingBody]:
    """Return bodies with overlays above all but the contacts, whose normals lie on lines of instant centres."""
    if not overlays:
        return bodies
    contacts = [body for body in bodies if body.kind == CONTACTS]
    return [*(body for body in bodies if body.kind != CONTACTS), *overlays, *contacts]


_Drawing: TypeAlias = "tuple[list[MovingBody], list[Plot]]"


def _faces(view: View[Translating, Flat], reach: float, size: float) -> _Drawing:
    return flat(view, reach, size), []


def _two_rollers(view: View[Oscillating, Roller], _: float, size: float) -> _Drawing:
    bodies, angles = double_roller(view, size)
    return bodies, [curves.pressure(view.recipe, dict(zip(("roller A", "roller B"), angles, strict=True)))]


def _two_faces(view: View[Oscillating, Flat], _: float, size: float) -> _Drawing:
    bodies, lever = flat_pair(view, size)
    return bodies, [curves.levers(view.recipe, lever)]


def _round_contact(view: View[Guide, Round], size: float) -> tuple[guided.Touch, Array, list[MovingBody], list[Plot]]:
    """Return roller, shoe or edge, displacement (STEPS + 1,), mm or rad, contacts, and the plot of pressure angles."""
    angle = view.pressure(SHAFT)
    touch = guided.touch_of(view.touch, angle, size)
    plots = [curves.pressure(view.recipe, {view.touch.word: angle}, SIGN)]
    return touch, view.travel(SHAFT)[0], _contacts(view, size, touch.within), plots


def _contacts(view: View[Guide, Touch], size: float, within: float = 0.0) -> list[MovingBody]:
    """Return the contact of each surface; its arrow is longer by `within`, mm, which a roller covers."""
    surfaces = view.design.exact.surfaces
    names = [f"contact, {surface.name}" if surface.name else "contact" for surface in surfaces]
    return [
        guided.contact_body(*surface_and_name, size, within) for surface_and_name in zip(surfaces, names, strict=True)
    ]


def _on_stem(view: View[Translating, Round], reach: float, size: float) -> _Drawing:
    touch, s, contacts, plots = _round_contact(view, size)
    return [*guided.on_stem(touch, view.datum + s, view.guide.offset, reach, size), *contacts], plots


def _on_arm(view: View[Oscillating, Round], _: float, size: float) -> _Drawing:
    touch, s, contacts, plots = _round_contact(view, size)
    return [*guided.on_arm(touch, view.contacts[0], s, (view.guide.arm, 0.0), size), *contacts], plots


def _face_contact(view: View[Guide, Flat], size: float) -> tuple[Array, float, float, list[MovingBody], list[Plot]]:
    """Return displacement (STEPS + 1,), low and high end of the contact's run on the face, mm, contacts, and plots.

    The displacement is in mm or rad; the ends have a margin.
    """
    place, angle = view.place(SHAFT), view.pressure(SHAFT)
    plots = [
        curves.pressure(view.recipe, {view.touch.word: angle}),
        curves.along(view.recipe, {"contact": place}, view.touch.width),
    ]
    margin = guided.MARGIN * size
    contacts = _contacts(view, size)
    return view.travel(SHAFT)[0], float(place.min()) - margin, float(place.max()) + margin, contacts, plots


def _face_on_stem(view: View[Translating, Flat], reach: float, size: float) -> _Drawing:
    s, low, high, contacts, plots = _face_contact(view, size)
    if view.touch.width is not None:
        low, high = -0.5 * view.touch.width, 0.5 * view.touch.width
    face = guided.face(view.touch.tilt, low, high, size)
    return [*guided.on_stem(face, view.datum + s, view.guide.offset, reach, size), *contacts], plots


def _face_on_arm(view: View[Oscillating, Flat], _: float, size: float) -> _Drawing:
    s, low, high, contacts, plots = _face_contact(view, size)
    nearer, middle, half = view.touch.nearer, 0.5 * (low + high), 0.5 * (high - low)
    origin = (middle, -view.guide.side * nearer)
    # a face that lies beyond the pivot's parallel is held at its near end: to its middle the arm would cross the cam
    short = half if nearer < 0.0 else 0.0
    face = guided.face(0.0, -half, half, size)
    return [*guided.on_arm(face, view.contacts[0], s, origin, size, short=short), *contacts], plots


def _roller_frame(view: View[Translating, Roller], _: float, size: float) -> _Drawing:
    first, second = view.contacts
    hole, radius = 0.5 * (view.recipe.part.bore or 0.0), view.touch.radius
    x = first.datum + view.travel(SHAFT)[0]
    touches = guided.roller(radius, size, "roller A"), guided.roller(radius, size, "roller B")
    bodies = guided.roller_frame(touches, x, first.datum + second.datum, hole, size)
    contacts, angles = [], {}
    for name, ahead in (("roller A", 0.0), ("roller B", 0.5 * TURN)):
        contacts.append(guided.contact_body(view.surface(first), f"contact of {name}", size, radius, ahead=ahead))
        angles[name] = view.pressure(SHAFT + ahead)
    return [*bodies, *contacts], [curves.pressure(view.recipe, angles, SIGN)]


def _pair_contacts(
    view: View[Guide, Round], size: float
) -> tuple[tuple[guided.Touch, guided.Touch], list[MovingBody], list[Plot]]:
    """Return the rollers or shoes on the discs of a pair, their contacts, and the plot of both pressure angles."""
    touches, angles, bodies = [], {}, []
    for number, contact in enumerate(view.contacts, start=1):
        surface = view.surface(contact)
        angle = surface.pressure(SHAFT)
        touch = guided.touch_of(contact.touch, angle, size, f" {number}")
        touches.append(touch)
        angles[touch.name] = angle
        bodies.append(guided.contact_body(surface, f"contact of {touch.name}", size, touch.within))
    first, second = touches
    return (first, second), bodies, [curves.pressure(view.recipe, angles, PUSHED)]


def _pair_on_stem(view: View[Translating, Round], _: float, size: float) -> _Drawing:
    first, second = view.contacts
    touches, contacts, plots = _pair_contacts(view, size)
    hole, x = 0.5 * (view.recipe.part.bore or 0.0), first.datum + view.travel(SHAFT)[0]
    apart = first.datum + second.datum
    bodies = guided.roller_frame(touches, x, apart, hole, size, y=view.guide.offset, facing=0.5 * TURN)
    return [*bodies, *contacts], plots


def _pair_on_arms(view: View[Oscillating, Round], _: float, size: float) -> _Drawing:
    touches, contacts, plots = _pair_contacts(view, size)
    s, bodies = view.travel(SHAFT)[0], dict[str, MovingBody]()
    for number, (contact, touch) in enumerate(zip(view.contacts, touches, strict=True), start=1):
        for body in guided.on_arm(touch, contact, contact.sense * s, (contact.guide.arm, 0.0), size):
            name = f"arm {number}" if body.name == "arm" else body.name
            bodies[name] = replace(body, name=name)  # both arms turn about one pivot
    return [*bodies.values(), *contacts], plots


def _pair_of_faces(view: View[Translating, Flat], reach: float, size: float) -> _Drawing:
    first, second = view.contacts
    p = first.datum + view.travel(SHAFT)[0]
    places = {contact.surface: view.surface(contact).place for contact in view.contacts}
    named = {name: place(SHAFT) for name, place in places.items() if place is not None}
    bodies = faces(p, first.datum + second.datum, reach, size, view.guide.offset)
    return [*bodies, *_contacts(view, size)], [curves.along(view.recipe, named)]


DRAWN: dict[Arrangement, Drawer[[float, float], _Drawing]] = dict(
    [
        entry(Translating, Roller, _on_stem),
        entry(Translating, Shoe, _on_stem),
        entry(Translating, KnifeEdge, _on_stem),
        entry(Translating, Flat, _face_on_stem),
        entry(Translating, Flat, _faces, 2),
        entry(Translating, Roller, _roller_frame, 2),
        entry(Oscillating, Roller, _on_arm),
        entry(Oscillating, Shoe, _on_arm),
        entry(Oscillating, KnifeEdge, _on_arm),
        entry(Oscillating, Flat, _face_on_arm),
        entry(Oscillating, Roller, _two_rollers, 2),
        entry(Oscillating, Flat, _two_faces, 2),
        entry(Translating, Roller, _pair_on_stem, 2, 2),
        entry(Translating, Shoe, _pair_on_stem, 2, 2),
        entry(Translating, Flat, _pair_of_faces, 2, 2),
        entry(Oscillating, Roller, _pair_on_arms, 2, 2),
        entry(Oscillating, Shoe, _pair_on_arms, 2, 2),
    ]
)
"""Function that draws each follower: bodies and plots, from the cam's reach and the size of a joint, mm."""
