"""The exact cam of a recipe: what the follower is meant to do, the curve that does it, and what is wrong with either.

Nothing here writes or fits: `designed` is the part of a run that needs no file.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from camgeo.checks.declared import CURVATURE, PITCH, UNDERCUT_GLOBAL, UNDERCUT_LOCAL, WALL
from camgeo.common.clock import Clock
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError
from kin.judge.check import Check

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import ExactCam, Follower, Surface
    from camgeo.cams.position import Position
    from camgeo.curve.curvature import Least
    from camgeo.curve.curve import Curve
    from camgeo.curve.undercut.undercut import Undercut
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.linkage import Driven
    from camgeo.synthesis.part.body import Body
    from kin.law.support_function import Lift
    from kin.numeric.arrays import Array

SMALL = 0.01  # of a cam's size: undercut no deeper may be worth cutting off
LOOKS, GOLDEN = 4096, 0.5 * (math.sqrt(5.0) - 1.0)  # places at which a contour's direction is looked at, their step
FIRST = 256  # of them that are looked at first: where so many stretches run backwards, some of these do
TOO_MANY = "at least {} stretches of the contour run backwards; give the motion fewer or lower waves"


@dataclass(frozen=True)
class Design:
    """The exact cam of a recipe, the contour to be made of it, and the checks that need no file.

    `contour` is None where a check forbids to make it: undercut that is not to be trimmed, a bore that breaks through.
    `driven` is the linkage, None without one; `body` the part where it has more than a round bore.
    """

    exact: ExactCam
    contour: Curve | None
    checks: tuple[Check, ...]
    trimmed: bool
    driven: Driven | None = None
    body: Body | None = None

    @property
    def surface(self) -> Surface:
        """The exact curve."""
        return self.exact.surfaces[0]

    @property
    def motion(self) -> Position:
        """The follower's position over the shaft angle."""
        return self.exact.motion

    @property
    def follower(self) -> Follower:
        """What follows the cam."""
        return self.exact.follower


def designed(recipe: Recipe, clock: Clock | None = None) -> Design:
    """Motion, curve and exact checks of a recipe; raises RecipeErrors where there is no such motion or curve."""
    from kin.law.programme import IntentError

    clock = clock or Clock()
    try:
        with clock.stage("motion"):
            exact = recipe.cam.exact(framed=recipe.linkage is not None)
        with clock.stage("profile"):
            surface = exact.surfaces[0]
    except IntentError as error:
        raise recipe.error(f"cam.{error.field}", error.message) from error
    try:
        with clock.stage("undercut"):
            checks, contour = sound(recipe, exact)
    except IntentError as error:  # of a guide or a face that cannot follow the motion
        raise recipe.error(f"cam.{error.field}", error.message) from error
    except CurveError as error:
        raise recipe.error("cam", _unproved(recipe, error, exact)) from error
    with clock.stage("figures"):
        from camgeo.synthesis.checks import guide_checks, motion_checks

        more = motion_checks(exact)
        more += guide_checks(recipe, exact, contour)
    driven = None
    if recipe.linkage is not None:
        from camgeo.synthesis import linkage

        with clock.stage("linkage"):
            driven = linkage.driven(recipe, _plate(exact), exact.follower.breadth)
        more += driven.checks
    body = None
    if contour is not None:
        try:
            with clock.stage("part"):
                body, found = _part(recipe, contour, exact)
        except CurveError as error:
            raise recipe.error("part.chamfer", str(error)) from error
        more += found
        if not all(check.ok for check in found):
            contour = body = None  # without its least walls there is no part to draw
    return Design(exact, contour, (*checks, *more), is_trimmed(contour, surface), driven, body)


def _plate(exact: ExactCam) -> Lift:
    if exact.plate is None:
        raise TypeError("a linkage carries a plate")
    return exact.plate


def sound(recipe: Recipe, exact: ExactCam) -> tuple[list[Check], Curve | None]:
    """Checks of curvature and undercut, and the contour to be made: None where undercut refuses it."""
    from camgeo.curve.undercut.causes import UndercutError
    from camgeo.curve.undercut.undercut import MOST_TOLD, undercuts

    surface, trim = exact.surfaces[0], recipe.cam.undercut == "trim"
    of_kind = {"local": UNDERCUT_LOCAL, "global": UNDERCUT_GLOBAL}
    # the base curve's radii are the contour's and the roller's together; its own bounds need not be computed for that
    roller = surface.radius
    if roller and len(backward := _seen_backward(surface.curve)) > MOST_TOLD * surface.curve.shape.repeats:
        raise CurveError(TOO_MANY.format(len(backward)), float(backward[0]))
    least = _bent_most(surface)
    radius = least.radius + roller
    shaft_deg = exact.motion.shaft_deg
    roomy, at_deg = radius > roller, None if math.isinf(radius) else shaft_deg(least.at)
    bent = Check((PITCH if roller else CURVATURE).name, roomy, radius, roller, "mm", at_deg, "at_least")
    if math.isinf(radius):
        bent = replace(bent, detail="the pitch curve of the ring has no hollow")
    if least.room and roomy:
        lower = f"nearly a circle over a long way; proved to be no less than {(radius - least.room) / recipe.mm:.12g}"
        bent = replace(bent, detail=lower)
    try:
        found = undercuts(surface.curve)
    except UndercutError as error:
        kind = "global" if roomy else "local"
        free = "" if error.free_at is None else f"; {recipe.cam.advice.free_of_undercut(error.free_at, recipe.mm)}"
        return [bent, Check(of_kind[kind].name, False, None, 0.0, "mm", None, detail=f"{error}{free}")], None
    outcome, contour = "", None if found else surface.curve
    if trim and found:
        try:
            outcome, contour = "; trimmed", _trimmed(surface.curve)
        except UndercutError as error:
            outcome = f"; trimming is not possible: {error}"
    if not (roomy or found):
        contour = None  # a radius that just reaches the limit loses no contact, and leaves an edge
    if not surface.curve.closed:
        bent = _sharp(surface, shaft_deg)
    # of a trimmed contour the radius that was asked for is reported, and held against nothing
    cut_off = bool(found and contour)
    checks = [replace(bent, ok=True, limit=None, detail="trimmed") if cut_off else bent]
    # what frees the worst place frees all: the smallest of the rollers, the largest of the base radii
    free_at = (min if surface.radius else max)((cut.free_at for cut in found), default=0.0)
    free = recipe.cam.advice.free_of_undercut(free_at, recipe.mm)
    for kind in ("local", "global"):
        cuts = [cut for cut in found if cut.kind == kind]
        if kind == "global" and surface.radius == 0.0 and not cuts:
            continue
        if not cuts:
            checks.append(Check(of_kind[kind].name, True, 0.0, 0.0, "mm"))
            continue
        worst = max(cuts, key=lambda cut: cut.depth)
        detail = f"{_extent(surface, shaft_deg, worst)}; {free}{outcome}"
        if not trim and worst.depth <= SMALL * surface.curve.size and _can_be_trimmed(surface.curve):
            detail += "; or let what is lost be cut off: undercut: trim"
        depth = worst.depth if math.isfinite(worst.depth) else None
        ok, at_deg, limit = contour is not None, shaft_deg(worst.at), None if cut_off else 0.0
        checks.append(Check(of_kind[kind].name, ok, depth, limit, "mm", at_deg, detail=detail))
    return checks, contour


def _seen_backward(curve: Curve) -> Array:
    """Parameters (n,), of LOOKS, at which a contour begins to run backwards: so many stretches there are at least."""
    t: Array = curve.shape.period * (np.arange(LOOKS) * GOLDEN % 1.0)  # in step with no number of waves
    if not (curve.sample(t[:FIRST]).speed < 0.0).any():
        return t[:0]
    t = np.sort(t)
    backward = curve.sample(t).speed < 0.0
    begins: Array = t[backward & ~np.roll(backward, 1)]
    return begins


def _can_be_trimmed(curve: Curve) -> bool:
    from camgeo.curve.undercut.causes import UndercutError

    try:
        _trimmed(curve)
    except UndercutError:
        return False
    return True


def is_trimmed(contour: Curve | None, surface: Surface) -> bool:
    """Whether undercut was cut off a contour: corners that it has by design lose no motion."""
    return contour is not None and contour is not surface.curve


def _sharp(surface: Surface, shaft_deg: Callable[[float], float]) -> Check:
    """The check of curvature of a contour whose corners are asked for: reported, and held against nothing."""
    runs = surface.curve.runs
    detail = f"{len(runs)} sharp corners, as the recipe asks"
    return Check(CURVATURE.name, True, 0.0, None, "mm", shaft_deg(runs[0].high), "at_least", detail=detail)


def _bent_most(surface: Surface) -> Least:
    """Where the contour bends most on the side where it may undercut: least radius there, and the place.

    In a ring that is a hollow of the pitch curve, where the metal bulges inward; the opening's own hollows are wider
    than the roller by their pitch curve's radius, however small it is.
    """
    from camgeo.curve.curvature import enclosed_least_radius

    if surface.side > 0:
        return enclosed_least_radius(surface.curve)
    from camgeo.curve.backwards import backwards

    least = enclosed_least_radius(backwards(surface.curve))
    return replace(least, at=-least.at % surface.curve.shape.period)


def _extent(surface: Surface, shaft_deg: Callable[[float], float], cut: Undercut) -> str:
    """Say from where to where contact is lost, in shaft angles."""
    if cut.end - cut.start >= surface.curve.shape.period:
        return "all round"
    return f"from {shaft_deg(cut.start):.6g} to {shaft_deg(cut.end):.6g} deg"


def _unproved(recipe: Recipe, error: CurveError, exact: ExactCam) -> str:
    """Say what could not be proved of a curve, and what would do."""
    from camgeo.curve.undercut.bottleneck import OpenNeckError

    if not isinstance(error, OpenNeckError):
        return str(error)
    first, second = map(exact.motion.shaft_deg, error.pair)
    most, least = error.most / recipe.mm, error.least / recipe.mm
    half = f"lies between {least:.9g} and {most:.9g}" if error.seen else f"is at least {least:.9g}"
    return (
        f"whether a {recipe.cam.advice.radius_field} of {most:.9g} has no undercut between {first:.6g} and "
        f"{second:.6g} deg cannot be proved: half the width of the neck there {half}; "
        f"{f'one below {downward(least)}' if least > 0.0 else 'none'} is proved to have no undercut"
    )


def _trimmed(curve: Curve) -> Curve:
    from camgeo.curve.undercut.trim import trimmed  # few contours need it

    return trimmed(curve)


def _part(recipe: Recipe, contour: Curve, exact: ExactCam) -> tuple[Body | None, list[Check]]:
    """The body of a part that has more than a bore, and the checks of the walls."""
    part = recipe.part
    if part.plain:
        if part.bore is None:
            return None, []
        from camgeo.synthesis.part.walls import least_wall

        wall, at = least_wall(contour, part.bore)
        ok = wall > 0.0 if part.wall is None else wall >= part.wall
        told = "" if ok else "bore and contour" if wall > -0.5 * part.bore else "the shaft lies outside the contour"
        return None, [
            Check(
                WALL.name,
                ok,
                wall,
                part.wall or 0.0,
                "mm",
                exact.motion.shaft_deg(at),
                "at_least",
                detail=told,
            )
        ]
    from camgeo.synthesis.part.body import body_of
    from camgeo.synthesis.part.checks import part_checks
    from camgeo.synthesis.part.walls import Looks

    looks = Looks.of(contour)
    body = body_of(part, looks)
    return body, part_checks(body, looks, part.wall, exact.motion.shaft_deg)
