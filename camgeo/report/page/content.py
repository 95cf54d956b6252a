"""Everything a page shows of one recipe, gathered from the design and the files: scene, plots, dwells, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from camgeo.curve.ring import Ring, disc
from camgeo.report.page import curves, guided, outline
from camgeo.report.page.followers import SHAFT, cam, double_roller, flat, flat_pair
from camgeo.report.page.scene import Body, Scene, Shape, pivot
from camgeo.synthesis.view import Drawer, Round, View, entry, view_of
from kin.law.contacts import Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.law.contacts import Arrangement, Guide, Touch
    from kin.numeric.arrays import Array

JOINT = 0.045  # of the cam's reach: the size of a joint
EXACT = "exact"
SIGN = "above 0 where the cam drives a rise"


@dataclass(frozen=True, eq=False)
class FileError:
    """How far a file lies outside the exact contour in each step: least and greatest (STEPS,), negative inside."""

    name: str
    low: Array
    high: Array


@dataclass(frozen=True, eq=False)
class Content:
    """What a page shows; lengths in the recipe's unit, the drawing as the shaft turns.

    `relative` (STEPS + 1,) is the angle between cam and frame over the shaft's, rad; without a linkage they are one.
    `point` and `normal` (STEPS, 2) are of the exact contour in the cam's axes, at the middle of each step, where
    `errors` are looked at.
    """

    scene: Scene
    plots: tuple[curves.Plot, ...]
    rests: tuple[curves.Rest, ...]
    relative: Array
    point: Array
    normal: Array
    errors: tuple[FileError, ...]


def content(recipe: Recipe, design: Design, results: Sequence[FileResult]) -> Content:
    """Gather what a page shows; `results` are those of the drawings and solids that were made."""
    files = [found for result in results if (found := outline.read(recipe, result)) is not None]
    per = outline.Exact.looks(files)
    exacts = [outline.Exact.of(design, made, per) for made in design.surfaces]
    drawn = [(file.name, file.rings) for file in files] or [(EXACT, _exact_rings(recipe, design))]
    scene, plots, relative = _mechanism(recipe, design, drawn)
    plots += curves.preload(design)
    plots += [curves.curvature(recipe, design, *each) for each in zip(design.surfaces, exacts, strict=True)]
    measured = [
        (file.name, made.surface.name, each.error(arcs))
        for file in files
        for made, each, arcs in zip(design.surfaces, exacts, file.arcs, strict=True)
    ]
    # round the contour errors are drawn of a cam that has one, of others over the turn alone
    plots += [curves.off(recipe, f"{name}, {surface}", error) for name, surface, error in measured if surface]
    errors = [FileError(name, *(row / recipe.mm for row in error)) for name, surface, error in measured if not surface]
    exact = exacts[0]
    scene = scene.scaled(1.0 / recipe.mm)
    middle = slice(exact.per // 2, None, exact.per)
    point, normal = exact.point[middle] / recipe.mm, exact.normal[middle]
    if recipe.rotation == "ccw":
        flip = np.array([1.0, -1.0])
        scene, point, normal = scene.mirrored(), point * flip, normal * flip
    rests = tuple(curves.rests(recipe, design))
    return Content(scene, tuple(plots), rests, relative, point, normal, tuple(errors))


def _on_face(design: Design) -> list[Shape]:
    """Hub and timing mark of a part; a file's outline shows neither, or does not tell which hole is the mark."""
    bodies = [one.body for one in design.discs if one.body is not None]
    hubs = [body.hub for body in bodies if body.hub is not None]
    found = [Shape("hub", (disc(0.0, 0.0, 0.5 * hub.diameter),), "hub") for hub in hubs]
    for opening in design.openings:
        if opening.name == "mark":
            ring = Ring(opening.outline.points, opening.outline.bulges)
            found.append(Shape("timing mark", (ring,), "zero of the motion"))
    return found


def _exact_rings(recipe: Recipe, design: Design) -> tuple[Ring, ...]:
    bore = recipe.part.bore
    holes = (disc(0.0, 0.0, 0.5 * bore),) if bore else ()
    rim = (disc(0.0, 0.0, 0.5 * recipe.part.outer),) if recipe.part.outer else ()
    contours = [outline.exact(contour) for _, contour in design.contours]
    if not contours:
        contours = [outline.exact(surface.curve, whole=True) for surface in design.exact.surfaces]
    return (*rim, *contours, *holes)


def _mechanism(
    recipe: Recipe, design: Design, drawn: list[tuple[str, tuple[Ring, ...]]]
) -> tuple[Scene, list[curves.Plot], Array]:
    """Return scene and plots in mm, and the relative angle over the shaft angle (STEPS + 1,)."""
    reach = float(np.hypot(*drawn[0][1][0].flattened().T).max())
    size, bore = JOINT * reach, recipe.part.bore
    note = "" if design.contours else "The cam is not made: a check of the exact contour fails."
    first = design.exact.surfaces[0]
    if first.side < 0:
        bore = 2.0 * float(np.hypot(*first.curve.sample(np.zeros(1)).point[0]))
    on_it = _on_face(design)
    disk = cam(drawn, bore, size, -SHAFT, on_it)
    if design.driven is not None and design.driven.turns:
        from camgeo.report.page.linked import Driven, linked

        driven = Driven.of(design.driven.mechanism)
        disk = cam(drawn, bore, size, driven.cam, on_it)
        bodies = linked(driven, size)
        return (
            Scene((disk, pivot("shaft", 0.0, 0.0, size, "A"), *bodies), note),
            curves.output(recipe, driven),
            driven.theta,
        )
    if design.driven is not None:
        where = "; ".join(check.detail for check in design.driven.checks if not check.ok and check.detail)
        slides = "The mechanism does not make a full turn: the cam is shown in a frame that only slides. "
        note = f"{slides}{where[0].upper()}{where[1:]}. {note}" if where else slides + note
    view = view_of(recipe, design)
    bodies, more = DRAWN[design.follower.arrangement](view, reach, size)
    shaft = pivot("shaft", 0.0, 0.0, size, "O" if view.guide.unit == "deg" else "")
    return Scene((disk, shaft, *bodies), note), [*curves.motion(recipe, design), *more], SHAFT


_Drawing: TypeAlias = "tuple[list[Body], list[curves.Plot]]"


def _faces(view: View[Translating, Flat], reach: float, size: float) -> _Drawing:
    return flat(view, reach, size), []


def _two_rollers(view: View[Oscillating, Roller], _: float, size: float) -> _Drawing:
    bodies, angles = double_roller(view, size)
    return bodies, [curves.pressure(view.recipe, dict(zip(("roller A", "roller B"), angles, strict=True)))]


def _two_faces(view: View[Oscillating, Flat], _: float, size: float) -> _Drawing:
    bodies, lever = flat_pair(view, size)
    return bodies, [curves.levers(view.recipe, lever)]


def _pressed(view: View[Guide, Round], size: float) -> tuple[guided.Touch, Array, list[Body], list[curves.Plot]]:
    """Return what touches a cam about a centre, the displacement at the page's steps, the contact and the plot."""
    angle = view.pressure(SHAFT)
    touch = guided.touch_of(view.touch, angle, size)
    plots = [curves.pressure(view.recipe, {view.touch.word: angle}, SIGN)]
    return touch, view.travel(SHAFT)[0], _contacts(view, size, touch.within), plots


def _contacts(view: View[Guide, Touch], size: float, within: float = 0.0) -> list[Body]:
    """Return where each surface is touched."""
    surfaces = view.design.exact.surfaces
    names = [f"contact, {surface.name}" if surface.name else "contact" for surface in surfaces]
    return [guided.touched(*each, size, within) for each in zip(surfaces, names, strict=True)]


def _on_stem(view: View[Translating, Round], reach: float, size: float) -> _Drawing:
    touch, s, found, plots = _pressed(view, size)
    return [*guided.on_stem(touch, view.datum + s, view.guide.offset, reach, size), *found], plots


def _on_arm(view: View[Oscillating, Round], _: float, size: float) -> _Drawing:
    touch, s, found, plots = _pressed(view, size)
    return [*guided.on_arm(touch, view.contacts[0], s, (view.guide.arm, 0.0), size), *found], plots


def _faced(view: View[Guide, Flat], size: float) -> tuple[Array, float, float, list[Body], list[curves.Plot]]:
    """Return the displacement, the run of the contact along a face, the contact, and plots of both."""
    place, angle = view.place(SHAFT), view.pressure(SHAFT)
    plots = [curves.pressure(view.recipe, {view.touch.word: angle}), curves.along(view.recipe, place)]
    margin = guided.MARGIN * size
    found = _contacts(view, size)
    return view.travel(SHAFT)[0], float(place.min()) - margin, float(place.max()) + margin, found, plots


def _face_on_stem(view: View[Translating, Flat], reach: float, size: float) -> _Drawing:
    s, low, high, found, plots = _faced(view, size)
    if view.touch.width is not None:
        low, high = -0.5 * view.touch.width, 0.5 * view.touch.width
    face = guided.face(view.touch.tilt, low, high, size)
    return [*guided.on_stem(face, view.datum + s, view.guide.offset, reach, size), *found], plots


def _face_on_arm(view: View[Oscillating, Flat], _: float, size: float) -> _Drawing:
    s, low, high, found, plots = _faced(view, size)
    nearer, middle, half = view.touch.nearer, 0.5 * (low + high), 0.5 * (high - low)
    at = (middle, -view.guide.side * nearer)
    # a face that lies beyond the pivot's parallel is held at its near end: to its middle the arm would cross the cam
    short = half if nearer < 0.0 else 0.0
    face = guided.face(0.0, -half, half, size)
    return [*guided.on_arm(face, view.contacts[0], s, at, size, short=short), *found], plots


def _roller_frame(view: View[Translating, Roller], _: float, size: float) -> _Drawing:
    first, second = view.contacts
    hole, radius = 0.5 * (view.recipe.part.bore or 0.0), view.touch.radius
    x = first.datum + view.travel(SHAFT)[0]
    bodies = guided.roller_frame(x, first.datum + second.datum, radius, hole, size)
    found, angles = [], {}
    for name, on in (("roller A", 0.0), ("roller B", 0.5 * TURN)):
        found.append(guided.touched(view.surface(first), f"contact of {name}", size, radius, on=on))
        angles[name] = view.pressure(SHAFT + on)
    return [*bodies, *found], [curves.pressure(view.recipe, angles, SIGN)]


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
    ]
)
"""How each follower is drawn: its bodies and the plots they give, from the cam's reach and the size of a joint."""
