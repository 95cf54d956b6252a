"""Everything a page shows of one recipe, gathered from the design and the files: scene, plots, dwells, errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias, cast

import numpy as np

from camgeo.curve.ring import Ring, disc
from camgeo.report.page import curves, guided, outline
from camgeo.report.page.followers import SHAFT, cam, double_roller, flat, flat_pair
from camgeo.report.page.scene import Body, Scene, Shape, pivot
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.cams.constant_diameter import ConstantDiameterCam
    from camgeo.cams.disc_cams import OscillatingFaceCam, OscillatingRoundCam, TranslatingFaceCam, TranslatingRoundCam
    from camgeo.curve.moving_frame import Displacement
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
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


def content(recipe: Recipe, design: Design, paths: Sequence[Path]) -> Content:
    """Gather what a page shows; `paths` are the drawings and solids that were made, and still lie there."""
    files = [found for path in paths if (found := outline.read(recipe, path)) is not None]
    exact = outline.Exact.of(design, outline.Exact.looks(files))
    drawn = [(file.name, file.rings) for file in files] or [(EXACT, _exact_rings(recipe, design))]
    scene, plots, relative = _mechanism(recipe, design, drawn)
    touch = next((name for name in TOUCHES if design.follower.name.endswith(name)), "roller")
    plots.append(curves.curvature(recipe, design, exact, touch))
    errors = [FileError(file.name, *(row / recipe.mm for row in exact.error(file))) for file in files]
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
    if design.body is None:
        return []
    found = []
    if design.body.hub is not None:
        found.append(Shape("hub", (disc(0.0, 0.0, 0.5 * design.body.hub.diameter),), "hub"))
    for opening in design.body.openings:
        if opening.name == "mark":
            ring = Ring(opening.outline.points, opening.outline.bulges)
            found.append(Shape("timing mark", (ring,), "zero of the motion"))
    return found


def _exact_rings(recipe: Recipe, design: Design) -> tuple[Ring, ...]:
    bore = recipe.part.bore
    holes = (disc(0.0, 0.0, 0.5 * bore),) if bore else ()
    rim = (disc(0.0, 0.0, 0.5 * recipe.part.outer),) if recipe.part.outer else ()
    if design.contour is None:
        return (*rim, outline.exact(design.profile.curve, whole=True), *holes)
    return (*rim, outline.exact(design.contour), *holes)


def _mechanism(
    recipe: Recipe, design: Design, drawn: list[tuple[str, tuple[Ring, ...]]]
) -> tuple[Scene, list[curves.Plot], Array]:
    """Return scene and plots in mm, and the relative angle over the shaft angle (STEPS + 1,)."""
    reach = float(np.hypot(*drawn[0][1][0].flattened().T).max())
    size, bore = JOINT * reach, recipe.part.bore
    note = "" if design.contour is not None else "The cam is not made: a check of the exact contour fails."
    if recipe.part.outer:
        bore = 2.0 * float(np.hypot(*design.profile.curve.sample(np.zeros(1)).point[0]))
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
    drawn_as = DRAWN[design.follower.name]
    bodies, more = drawn_as.bodies(recipe, design, reach, size)
    shaft = pivot("shaft", 0.0, 0.0, size, drawn_as.letter)
    return Scene((disk, shaft, *bodies), note), [*curves.motion(recipe, design), *more], SHAFT


class _Drawn(NamedTuple):
    """How a follower is drawn: its bodies with the plots they give, and the letter at the shaft."""

    bodies: Callable[[Recipe, Design, float, float], tuple[list[Body], list[curves.Plot]]]
    letter: str


def _faces(_: Recipe, design: Design, reach: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    return flat(cast("Lift", design.intent), design.yoke_breadth, reach, size), []


def _two_rollers(recipe: Recipe, design: Design, _: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    bodies, angles = double_roller(cast("Transmission", design.intent), recipe.cam.touch_radius, size)
    return bodies, [curves.pressure(recipe, dict(zip(("roller A", "roller B"), angles, strict=True)))]


def _two_faces(recipe: Recipe, design: Design, _: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    bodies, lever = flat_pair(cast("Transmission", design.intent), size)
    return bodies, [curves.levers(recipe, lever)]


_Touch: TypeAlias = "Callable[[float, Array, float], guided.Touch]"
"""Radius, pressure angle at the page's steps and size of a joint to what touches the cam."""
TOUCHES: dict[str, _Touch] = {
    "roller": lambda radius, _, size: guided.roller(radius, size),
    "knife edge": lambda _, __, size: guided.knife_edge(size),
    "shoe": guided.shoe,
}


def _touching(design: Design) -> str:
    """What touches the cam, without how it is led."""
    return design.follower.name.partition(" ")[2]


def _pressed(recipe: Recipe, design: Design, size: float) -> tuple[guided.Touch, Array, list[Body], list[curves.Plot]]:
    """Return what touches a cam about a centre, the displacement at the page's steps, the contact and the plot."""
    name = _touching(design)
    s = design.position.rows(SHAFT, 0)[0]
    angle = recipe.cam.pressure_angle(design.intent, design.profile)(SHAFT)
    touch = TOUCHES[name](recipe.cam.touch_radius, angle, size)
    plots = [curves.pressure(recipe, {name: angle}, SIGN)]
    return touch, s, [guided.touched(design.profile, size, touch.within)], plots


def _on_stem(recipe: Recipe, design: Design, reach: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    touch, s, found, plots = _pressed(recipe, design, size)
    along = cast("TranslatingRoundCam", recipe.cam).guide
    x, y = guided.centres(along, s)
    return [*guided.on_stem(touch, x, float(y[0]), reach, size), *found], plots


def _on_arm(recipe: Recipe, design: Design, _: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    touch, s, found, plots = _pressed(recipe, design, size)
    arm = cast("OscillatingRoundCam", recipe.cam).guide
    return [*guided.on_arm(touch, arm, s, (arm.length, 0.0), size), *found], plots


def _faced(recipe: Recipe, design: Design, size: float) -> tuple[Array, float, float, list[Body], list[curves.Plot]]:
    """Return the displacement, the run of the contact along a face, the contact, and plots of both."""
    s = design.position.rows(SHAFT, 0)[0]
    place = recipe.cam.contact_place(design.intent, design.profile)(SHAFT)
    angle = recipe.cam.pressure_angle(design.intent, design.profile)(SHAFT)
    plots = [curves.pressure(recipe, {_touching(design): angle}), curves.along(recipe, place)]
    margin = guided.MARGIN * size
    return s, float(place.min()) - margin, float(place.max()) + margin, [guided.touched(design.profile, size)], plots


def _face_on_stem(recipe: Recipe, design: Design, reach: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    s, low, high, found, plots = _faced(recipe, design, size)
    cam = cast("TranslatingFaceCam", recipe.cam)
    if cam.width is not None:
        low, high = -0.5 * cam.width, 0.5 * cam.width
    face = cam.face(cast("Displacement", design.intent))
    x = face.level + s
    return [*guided.on_stem(guided.face(cam.tilt, low, high, size), x, cam.offset, reach, size), *found], plots


def _face_on_arm(recipe: Recipe, design: Design, _: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    s, low, high, found, plots = _faced(recipe, design, size)
    face = cast("OscillatingFaceCam", recipe.cam).face(cast("Displacement", design.intent))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    at = (middle, -face.side * face.face)
    # a face that lies beyond the pivot's parallel is held at its near end: to its middle the arm would cross the cam
    short = half if face.face < 0.0 else 0.0
    return [*guided.on_arm(guided.face(0.0, -half, half, size), face, s, at, size, short=short), *found], plots


def _roller_frame(recipe: Recipe, design: Design, _: float, size: float) -> tuple[list[Body], list[curves.Plot]]:
    cam, s = cast("ConstantDiameterCam", recipe.cam), design.position.rows(SHAFT, 0)[0]
    x, _y = guided.centres(cam.guide, s)
    hole = 0.5 * (recipe.part.bore or 0.0)
    bodies = guided.roller_frame(x, cam.apart(design.intent), cam.touch_radius, hole, size)
    found, angles = [], {}
    for name, on in (("roller A", 0.0), ("roller B", 0.5 * TURN)):
        found.append(guided.touched(design.profile, size, cam.touch_radius, on=on, name=f"contact of {name}"))
        angles[name] = cam.pressure_angle(design.intent, design.profile)(SHAFT + on)
    return [*bodies, *found], [curves.pressure(recipe, angles, SIGN)]


DRAWN: dict[str, _Drawn] = {
    "flat face": _Drawn(_faces, ""),
    "yoke": _Drawn(_faces, ""),
    "square frame": _Drawn(_faces, ""),  # of a linkage that does not turn right round
    "double roller": _Drawn(_two_rollers, "O"),
    "flat pair": _Drawn(_two_faces, "O"),
    "translating flat face": _Drawn(_face_on_stem, ""),
    "oscillating flat face": _Drawn(_face_on_arm, "O"),
    "roller yoke": _Drawn(_roller_frame, ""),
    **{f"translating {name}": _Drawn(_on_stem, "") for name in TOUCHES},
    **{f"oscillating {name}": _Drawn(_on_arm, "O") for name in TOUCHES},
}
