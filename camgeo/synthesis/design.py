"""The exact cam of a recipe: what the follower is meant to do, the curve that does it, and what is wrong with either.

Nothing here writes or fits: `designed` is the part of a run that needs no file.
"""

from __future__ import annotations

import math
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from camgeo.checks.declared import BENT, CURVATURE, PITCH, UNDERCUT_GLOBAL, UNDERCUT_LOCAL
from camgeo.checks.extension import CHECKING
from camgeo.common.clock import Clock
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError
from camgeo.part.features import EDGE_KEYS
from kin.numeric.check import Check, as_drawn
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.cams.follower import Follower
    from camgeo.cams.surface import Surface
    from camgeo.curve.curvature import Least
    from camgeo.curve.curve import Curve
    from camgeo.curve.undercut.undercut import Undercut
    from camgeo.motions.position import Position
    from camgeo.part.body import Body
    from camgeo.part.part import Part
    from camgeo.part.shapes import Opening
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.linkage import DesignedLinkage
    from kin.law.support_function import Lift
    from kin.numeric.arrays import Array

SMALL = 0.01  # of a cam's size: undercut no deeper than this may be worth cutting off
LOOKS, GOLDEN = 4096, 0.5 * (math.sqrt(5.0) - 1.0)  # places at which a contour's direction is sampled; step in periods
FIRST = 256  # of these places are sampled first: where very many stretches run backwards, some of these do
TOO_MANY = "at least {} stretches of the contour run backwards; give the motion fewer or lower waves"


@dataclass(frozen=True)
class SurfaceDesign:
    """A surface of a cam, the contour to be made, and the surface's checks of curvature and undercut.

    `contour` is None where a check forbids to make it: undercut that is not to be trimmed, a bore that breaks through.
    """

    surface: Surface
    contour: Curve | None
    checks: tuple[Check, ...]

    @property
    def trimmed(self) -> bool:
        """Whether undercut is cut off the contour; sharp corners of the recipe's own do not count."""
        return self.contour is not None and self.contour is not self.surface.curve

    @property
    def bent(self) -> Check:
        """Check of the radius of curvature of this surface."""
        return next(check for check in self.checks if check.name in BENT)


@dataclass(frozen=True)
class Disc:
    """A disc on the shaft: its surfaces, and the body of its part, None where no part is made.

    `z` is the height of its lower face above the lower face of the first disc, mm.
    """

    surfaces: tuple[SurfaceDesign, ...]
    body: Body | None = None
    z: float = 0.0

    @property
    def name(self) -> str:
        """Name of the disc: the names of its surfaces, joined by `and`."""
        return " and ".join(made.surface.name for made in self.surfaces)

    @property
    def contours(self) -> tuple[tuple[Surface, Curve], ...]:
        """Pairs of a surface and its contour; empty where any surface lacks one.

        A disc is made whole or not at all.
        """
        contours = tuple((made.surface, made.contour) for made in self.surfaces if made.contour is not None)
        return contours if len(contours) == len(self.surfaces) else ()


@dataclass(frozen=True)
class Design:
    """The exact cam of a recipe, the discs to be made of it, and all checks that need no file.

    `driven` is the linkage, None without one.
    """

    exact: ExactCam
    discs: tuple[Disc, ...]
    checks: tuple[Check, ...]
    driven: DesignedLinkage | None = None

    @property
    def surfaces(self) -> tuple[SurfaceDesign, ...]:
        """The surfaces of all discs."""
        return tuple(surface for disc in self.discs for surface in disc.surfaces)

    @property
    def contours(self) -> tuple[tuple[Surface, Curve], ...]:
        """Pairs of a surface and its contour over all discs; empty where any disc lacks one.

        A cam is made whole or not at all.
        """
        discs = [disc.contours for disc in self.discs]
        return tuple(chain.from_iterable(discs)) if all(discs) else ()

    @property
    def single(self) -> tuple[Design, ...]:
        """The design for each disc, as a file with that disc alone shows it."""
        return tuple(replace(self, discs=(disc,)) for disc in self.discs)

    @property
    def openings(self) -> tuple[Opening, ...]:
        """Openings of all discs: bores, holes and engravings besides the surfaces."""
        return tuple(opening for disc in self.discs if disc.body is not None for opening in disc.body.openings)

    @property
    def only_surface(self) -> SurfaceDesign:
        """The surface of a cam with one surface; raises ValueError for a cam with several."""
        (surface,) = self.surfaces
        return surface

    @property
    def trimmed(self) -> bool:
        """Whether undercut is cut off any surface, and motion lost with it."""
        return any(surface.trimmed for surface in self.surfaces)

    @property
    def motion(self) -> Position:
        """The follower's position over the shaft angle."""
        return self.exact.motion

    @property
    def follower(self) -> Follower:
        """Follower of the cam: its contacts, name and checks."""
        return self.exact.follower


def designed(recipe: Recipe, clock: Clock | None = None) -> Design:
    """Design of a recipe: exact cam, discs, linkage, and all checks that need no file; `clock` times its stages.

    Raises RecipeErrors where there is no such motion or curve, undercut or an edge of the part cannot be proved, and
    for a linkage that cannot be made; CurveError where the least radius of the hollows that a grinding wheel has to
    fit cannot be proved.
    """
    from kin.law.normalised import IntentError

    clock = clock or Clock()
    try:
        with clock.stage("motion"):
            exact = recipe.cam.exact(framed=recipe.linkage is not None)
        with clock.stage("profile"):
            surfaces = exact.surfaces
    except IntentError as error:
        raise recipe.error(f"cam.{error.field}", error.message) from error
    try:
        with clock.stage("undercut"):
            sounded = tuple(sound(recipe, exact, surface) for surface in surfaces)
    except IntentError as error:  # of a guide or a face that cannot follow the motion
        raise recipe.error(f"cam.{error.field}", error.message) from error
    except CurveError as error:
        raise recipe.error("cam", _unproved(recipe, error, exact)) from error
    with clock.stage("figures"):
        from camgeo.synthesis.checks import motion_checks, wheel_checks

        checks = [check for surface in sounded for check in surface.checks]
        contours = [(made.surface, made.contour) for made in sounded if made.contour is not None]
        checks += motion_checks(exact)
        for answers in CHECKING.of(recipe.uses):
            checks += answers.exact(recipe, exact, contours)
        checks += wheel_checks(recipe, exact, contours)
    # the linkage, and the part with its walls
    driven = None
    if recipe.linkage is not None:
        from camgeo.synthesis import linkage

        with clock.stage("linkage"):
            driven = linkage.driven(recipe, _plate(exact), exact.follower.breadth)
        checks += driven.checks
    try:
        with clock.stage("part"):
            bodied = [_with_body(recipe, disc, exact) for disc in discs_of(sounded, recipe.part, exact.gap)]
    except CurveError as error:
        raise recipe.error(next((key for key in EDGE_KEYS if key in recipe.marks), "part"), str(error)) from error
    discs = tuple(disc for disc, _ in bodied)
    checks += [check for _, walls in bodied for check in walls]
    drawn = tuple(as_drawn(check, mirrored=recipe.rotation == "ccw") for check in checks)
    return Design(exact, discs, drawn, driven)


def sketched(recipe: Recipe) -> Design:
    """Design with the exact cam alone and no check: undercut and walls are not examined.

    Takes a fraction of the time of `designed`. Raises RecipeErrors where there is no such motion or curve.
    """
    from kin.law.normalised import IntentError

    try:
        exact = recipe.cam.exact(framed=False)
        surfaces = tuple(SurfaceDesign(surface, surface.curve, ()) for surface in exact.surfaces)
        discs = discs_of(surfaces, recipe.part, exact.gap)
        # a round bore is drawn without a body, whose other openings hang on the walls
        bodied = discs if recipe.part.plain else tuple(_with_body(recipe, disc, exact)[0] for disc in discs)
    except IntentError as error:
        raise recipe.error(f"cam.{error.field}", error.message) from error
    except CurveError as error:
        raise recipe.error("cam", str(error)) from error
    return Design(exact, bodied, ())


def discs_of(surfaces: Sequence[SurfaceDesign], part: Part, gap: float) -> tuple[Disc, ...]:
    """The discs of surfaces, from the lowest up, without bodies; `gap`, mm, is between two neighbouring discs."""
    ranks, pitch = sorted({made.surface.disc for made in surfaces}), (part.thickness or 0.0) + gap
    return tuple(
        Disc(tuple(made for made in surfaces if made.surface.disc == rank), None, rank * pitch) for rank in ranks
    )


def _plate(exact: ExactCam) -> Lift:
    if exact.plate is None:
        raise TypeError("a linkage carries a plate")
    return exact.plate


def sound(recipe: Recipe, exact: ExactCam, surface: Surface) -> SurfaceDesign:
    """A surface with its checks of curvature and undercut, and the contour to be made.

    The contour is None where undercut is not to be trimmed or cannot be, and where the radius just reaches its limit.
    Raises CurveError where undercut can be neither proved nor excluded, IntentError for a guide or a face that cannot
    follow the motion.
    """
    checks, contour = _checked(recipe, surface, exact.motion.shaft_deg)
    return SurfaceDesign(surface, contour, tuple(replace(check, surface=surface.name) for check in checks))


def _checked(recipe: Recipe, surface: Surface, shaft_deg: Callable[[float], float]) -> tuple[list[Check], Curve | None]:
    """Checks of curvature and undercut of a surface, and the contour to be made, trimmed where the recipe has it so.

    The contour is None where undercut is not to be trimmed or cannot be, and where the radius just reaches its limit.
    `shaft_deg` gives the shaft angle, degrees, at a parameter of the contour. Raises as `sound` does.
    """
    from camgeo.curve.undercut.causes import UndercutError
    from camgeo.curve.undercut.undercut import MOST_REPORTED, undercuts

    trim, advice = recipe.cam.undercut == "trim", recipe.cam.advice.on(surface.name)
    of_kind = {"local": UNDERCUT_LOCAL, "global": UNDERCUT_GLOBAL}
    roller = surface.radius
    # a contour with more stretches that run backwards than are reported is refused before any bound is computed
    if roller and len(backward := _seen_backward(surface.curve)) > MOST_REPORTED * surface.curve.shape.repeats:
        raise CurveError(TOO_MANY.format(len(backward)), float(backward[0]))
    least = _bent_most(surface)
    # of the path of the roller's centre: the contour's radius and the roller's together, the contour's own without a
    # roller; roomy where it exceeds the roller's
    radius = least.radius + roller
    roomy, at_deg = radius > roller, None if math.isinf(radius) else shaft_deg(least.at)
    bent = Check((PITCH if roller else CURVATURE).name, roomy, radius, roller, "mm", at_deg, "at_least")
    if math.isinf(radius):
        bent = replace(bent, detail="the pitch curve of the ring has no hollow")
    if least.excess and roomy:
        bound = f"nearly a circle over a long way; proved to be no less than {(radius - least.excess) / recipe.mm:.12g}"
        bent = replace(bent, detail=bound)
    try:
        undercut = undercuts(surface.curve)
    except UndercutError as error:
        kind = "global" if roomy else "local"
        free = "" if error.free_at is None else f"; {advice.free_of_undercut(error.free_at, recipe.mm)}"
        return [bent, Check(of_kind[kind].name, False, None, 0.0, "mm", None, detail=f"{error}{free}")], None
    outcome, contour = "", None if undercut else surface.curve
    if trim and undercut:
        try:
            outcome, contour = "; trimmed", _trimmed(surface.curve)
        except UndercutError as error:
            outcome = f"; trimming is not possible: {error}"
    if not (roomy or undercut):
        contour = None  # a radius that just reaches the limit loses no contact, and leaves an edge
    if not surface.curve.closed:  # it has corners that the recipe asks for
        bent = _sharp(surface, shaft_deg)
    # the radius of the contour before it is trimmed is reported, without a limit
    cut_off = bool(undercut and contour)
    checks = [replace(bent, ok=True, limit=None, detail="trimmed") if cut_off else bent]
    # what frees the worst place frees all: the smallest of the rollers, the largest of the base radii
    free_at = (min if surface.radius else max)((cut.free_at for cut in undercut), default=0.0)
    free = advice.free_of_undercut(free_at, recipe.mm)
    for kind in ("local", "global"):
        cuts = [cut for cut in undercut if cut.kind == kind]
        # declared for rollers alone: without one it is reported only where it is found
        if kind == "global" and surface.radius == 0.0 and not cuts:
            continue
        if not cuts:
            checks.append(Check(of_kind[kind].name, True, 0.0, 0.0, "mm"))
            continue
        worst = max(cuts, key=lambda cut: cut.depth)
        detail = f"{_extent(surface, shaft_deg, worst)}; {free}{outcome}"
        small = worst.depth <= SMALL * surface.curve.size
        if advice.trims and not trim and small and _can_be_trimmed(surface.curve):
            detail += "; or let what is lost be cut off: undercut: trim"
        depth = worst.depth if math.isfinite(worst.depth) else None
        ok, at_deg, limit = contour is not None, shaft_deg(worst.at), None if cut_off else 0.0
        checks.append(Check(of_kind[kind].name, ok, depth, limit, "mm", at_deg, detail=detail))
    return checks, contour


def _seen_backward(curve: Curve) -> Array:
    """Parameters (n,) of sampled places at which a contour begins to run backwards, one for each stretch seen."""
    t = curve.shape.period * np.mod(np.arange(LOOKS, dtype=np.float64) * GOLDEN, 1.0)  # in step with no number of waves
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


def _sharp(surface: Surface, shaft_deg: Callable[[float], float]) -> Check:
    """The check of curvature of a contour with corners by its recipe: radius 0, without a limit."""
    runs = surface.curve.runs
    detail = f"{len(runs)} sharp corners, as the recipe asks"
    return Check(CURVATURE.name, True, 0.0, None, "mm", shaft_deg(runs[0].high), "at_least", detail=detail)


def _bent_most(surface: Surface) -> Least:
    """Least radius of curvature on the side on which the contour may undercut, mm, and its parameter.

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
    """Words for the shaft angles from which to which contact is lost."""
    if cut.end - cut.start >= surface.curve.shape.period:
        return "all round"
    return f"from {shaft_deg(cut.start):.6g} to {shaft_deg(cut.end):.6g} deg"


def _unproved(recipe: Recipe, error: CurveError, exact: ExactCam) -> str:
    """Words for what could not be proved of a curve, and for a radius that would be proved."""
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


def _with_body(recipe: Recipe, disc: Disc, exact: ExactCam) -> tuple[Disc, list[Check]]:
    """The disc with its body, and the checks of its walls; without its least walls there is no part to draw."""
    if not disc.contours:
        return disc, []
    from camgeo.part.body import Body, body_of
    from camgeo.part.checks import bore_check, part_checks
    from camgeo.part.walls import Looks

    part, shaft_deg = recipe.part, exact.motion.shaft_deg
    if part.plain and part.bore is None:
        return replace(disc, body=Body(part.thickness, (), pocket=disc.surfaces[0].surface.depth)), []
    looks = [Looks.of(contour, surface.side, surface.name) for surface, contour in disc.contours]
    body = body_of(part, looks[0], disc.surfaces[0].surface.depth)
    if not part.plain:
        checks = part_checks(body, looks, part.wall, shaft_deg)
    else:
        checks = [] if part.bore is None else [bore_check(part.bore, looks, part.wall, shaft_deg)]
    if len(disc.surfaces) < len(exact.surfaces):  # of one of several discs, which its surface tells
        checks = [replace(check, surface=disc.surfaces[0].surface.name) for check in checks]
    if all(check.ok for check in checks):
        return replace(disc, body=body), checks
    return replace(disc, surfaces=tuple(replace(made, contour=None) for made in disc.surfaces)), checks
