"""An indexing cam as bodies to be drawn: seen along the turret's axis, the cam, and the turret that it advances."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.engaged import Engaged
from camgeo.capabilities.indexing.ribs import RISE, far, layers, near, rims
from camgeo.curve.ring import Ring
from camgeo.report.page.scene import CONTACTS, STEPS, FilledShape, MovingBody, Scene, pivot, poses, still
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.ribs import Layer
    from kin.numeric.arrays import Array

CAM = "indexer"  # the kind of the body that a page draws anew at each angle
JOINT = 0.016  # of the cam's diameter and length together: size of a joint


def scene(design: IndexDesign, step: int = 0, of: list[Layer] | None = None) -> Scene:
    """The cam as it stands at a step of the turn, and its turret over the turn, in the recipe's unit.

    `of` are the layers of the cam, which are computed by default.
    """
    recipe = design.recipe
    of = of or layers(design)
    theta = np.linspace(0.0, TURN, STEPS + 1)
    turret = recipe.turret.drawn(recipe.roller, recipe.stops, recipe.sense)
    size = JOINT * (2.0 * float(of[-1].radius.max()) + recipe.length)
    psi = recipe.start + design.law.derivatives(theta, 0)[0]
    turned = poses(*turret.centre, psi if turret.way > 0 else math.pi - psi)
    body = tuple(FilledShape("follower", (ring,), "turret") for ring in turret.body)
    rollers = tuple(FilledShape("roller", (ring,), "roller") for ring in turret.rollers)
    bodies = (
        MovingBody("cam", CAM, tuple(cam_shapes(design, of, faced(design, float(theta[step])))), still()),
        MovingBody("turret", "follower", (*body, FilledShape("hub", (turret.rim,))), turned),
        MovingBody("rollers", "follower", rollers, turned),
        pivot("pivot", *turret.centre, size, "T"),
        *(_contacts(design, name, theta[step : step + 1]) for name in design.flanks),
    )
    way = "clockwise" if recipe.rotation == "cw" else "counter-clockwise"
    note = f"seen along the turret's axis; the cam turns {way}, seen from above"
    return Scene(bodies, note).scaled(1.0 / recipe.mm)


def faced(design: IndexDesign, theta: float) -> float:
    """Polar angle, rad, of the cam as it is computed, that faces the viewer at a shaft angle, rad."""
    return theta + design.recipe.sense * design.recipe.turret.facing


def touched(design: IndexDesign, name: str, theta: Array) -> Array:
    """Both ends of the lines along which a flank bears on rollers at shaft angles (n,), rad, as they are seen.

    They are (n, j, 2, 2): of each of j rollers two places, to the right and up, mm; nan where it is not borne.
    """
    engaged, flank, sense = Engaged(design, name, theta), design.flanks[name], design.recipe.sense
    angles, found = engaged.angles.ravel(), []
    pose = flank.pose(angles)
    for rho in engaged.ends:
        touch = flank.touch(pose, rho.ravel())
        out, beside, z = flank.place(pose, rho.ravel(), touch.sine, touch.cosine)
        right = np.hypot(out, beside) * np.sin(sense * np.arctan2(beside, out) - design.recipe.turret.facing)
        found.append(np.stack([right, z], axis=-1).reshape(*rho.shape, 2))
    return np.where(engaged.bears[..., None, None], np.stack(found, axis=2), np.nan)


def _contacts(design: IndexDesign, name: str, theta: Array) -> MovingBody:
    """Lines of contact of a flank at one shaft angle (1,), rad."""
    lines = touched(design, name, theta)[0]
    rings = tuple(Ring.through(line, closed=False) for line in lines if np.isfinite(line).all())
    return MovingBody(f"contact {name}", CONTACTS, (FilledShape("contact line", rings),), still())


def shares(of: list[Layer]) -> list[float]:
    """Share of each layer's distance from the cam's axis that the floor has where the cam is thinnest."""
    core = float(of[0].radius.min())
    return [core / float(each.radius.min()) for each in of]


def cam_shapes(design: IndexDesign, of: list[Layer], turn: float) -> list[FilledShape]:
    """Shapes of the cam from the hindmost to the foremost, with the polar angle `turn`, rad, towards the viewer."""
    sense = design.recipe.sense
    behind = [far(each, turn, sense, share) for each, share in zip(of, shares(of), strict=True)]
    core = FilledShape("fixed", (Ring.through(_core(of[0])),), "floor of the track")
    walls = [_shape("wall", outlines) for outlines in reversed(behind)]
    walls += [core, *(_shape("wall", near(each, turn, sense)) for each in of[:-1])]
    return [*walls, _shape("wall", rims(of, turn, sense)), _shape("metal", near(of[-1], turn, sense), "rib")]


def _core(of: Layer) -> Array:
    """Outline (n, 2) of the body within a layer."""
    half = np.column_stack([of.radius, np.linspace(0.0, of.length, RISE + 1)])
    return np.concatenate([half, half[::-1] * (-1.0, 1.0)])


def _shape(role: str, outlines: list[Array], name: str = "") -> FilledShape:
    return FilledShape(role, tuple(Ring.through(outline) for outline in outlines), name)
