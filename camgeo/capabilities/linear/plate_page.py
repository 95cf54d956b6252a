"""The page of a linear cam: the plate slides under its follower, curves over the travel, checks and files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.linear.path import Arm
from camgeo.capabilities.linear.plate import as_drawn, openings
from camgeo.curve.ring import Ring, bar, box
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.pieces import ArcSpline
from camgeo.measures.units import UNIT_NAMES
from camgeo.recipe.figures import PRESSURE_ANGLE
from camgeo.report.page import svg, tables
from camgeo.report.page.followers import contact
from camgeo.report.page.guided import HALF_STEM, WIDTH, Touch, knife_edge, roller, shoe
from camgeo.report.page.page import picture, plotted
from camgeo.report.page.scene import STEPS, FilledShape, MovingBody, Scene, SceneInput, pivot, poses, still
from camgeo.report.plot import Plot, Series
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.fit.pieces import Outline
    from camgeo.output.own_kind import Made
    from kin.linear.verdict import PlateVerdict
    from kin.numeric.arrays import Array

COARSE = 5e-4  # of the plate's size: within which its outline is drawn
JOINT = 0.016  # of the plate's length and height together: size of a joint
RUN = 4.5  # sizes of a joint: length of the guide of a stem
MARGIN = 0.05  # of the travel: the plate's guide reaches beyond it


def drawn(design: LinearDesign) -> dict[str, Any]:
    """Data of the page's script that show and move the plate and its follower."""
    return picture(design.recipe, scene(design), np.linspace(0.0, 2.0 * math.pi, STEPS + 1), 1)


def script(design: LinearDesign, made: Sequence[Made[PlateVerdict]]) -> dict[str, Any]:
    """All data of the page's script, from the design and the files that were made or given."""
    return {
        **drawn(design),
        "marks": [],
        "plots": [plotted(plot) for plot in (*_plots(design), *_errors(design, made))],
        "rests": _rests(design),
        "linked": False,
        "contours": {},
        "errors": [],
    }


def panels(_: LinearDesign, report: dict[str, Any]) -> str:
    """HTML of the table of figures."""
    return tables.figures(report["plate"]["figures"], "at", f" {UNIT_NAMES[report['units']]}")


def looks() -> tuple[str, str]:
    """No CSS and no JavaScript beside that of every page."""
    return "", ""


def _rests(design: LinearDesign) -> list[list[object]]:
    """Begin, length and name of each dwell of all periods, in the recipe's unit."""
    mm = design.recipe.mm
    return [
        [(rest.begin + k * design.total) / mm, (rest.end - rest.begin) / mm, "dwell"]
        for k in range(design.recipe.periods)
        for rest in design.motion.rests
    ]


def drawing(design: LinearDesign) -> str:
    """Return the plate under its follower at input 0 as SVG."""
    return svg.moving(scene(design))


# --- the scene --------------------------------------------------------------------------------------------------------


def scene(design: LinearDesign) -> Scene:
    """The plate that slides, and the follower that it moves, in the recipe's unit, as drawn."""
    recipe = design.recipe
    u = np.linspace(0.0, design.length, STEPS + 1)
    low, high = design.extent
    height = float(design.outline.sample(np.array([run.low for run in design.outline.runs])).point[:, 1].max())
    size = JOINT * (high - low + height)
    bodies = [*_ground(design, size), _plate(design, u), *_follower(design, u, size)]
    unit = UNIT_NAMES[recipe.units]
    travel = SceneInput("travel", "plate", unit, design.length / recipe.mm, recipe.endless, key="x", pace="a minute")
    note = f"the plate travels to the {recipe.travel} while the motion runs from its first segment"
    drawn = Scene(tuple(bodies), note, travel)
    return drawn.scaled(1.0 / recipe.mm) if recipe.mm != 1.0 else drawn


def _sense(design: LinearDesign) -> float:
    return 1.0 if design.recipe.travel == "right" else -1.0


def _ring(outline: Outline) -> Ring:
    if not isinstance(outline, ArcSpline):
        raise TypeError("a ring is made of arcs")
    return Ring(outline.points, outline.bulges)


def _plate(design: LinearDesign, u: Array) -> MovingBody:
    within = COARSE * design.outline.size
    outline = as_drawn(design, fit_arcs(design.outline, within))
    rings = [_ring(outline)]
    shapes = []
    for opening in openings(design.recipe, drawn=True):
        if opening.depth is None:
            rings.append(_ring(opening.outline))
        else:
            shapes.append(FilledShape("timing mark", (_ring(opening.outline),), opening.name))
    if design.recipe.groove is not None:
        groove = as_drawn(design, fit_arcs(design.groove, within))
        rings.append(_ring(groove))
    plate = FilledShape("metal", tuple(rings), "plate")
    return MovingBody("plate", "cam", (plate, *shapes), poses(_sense(design) * u, 0.0, 0.0))


def _ground(design: LinearDesign, size: float) -> list[MovingBody]:
    """The guide along which the plate slides, over its whole way."""
    low, high = design.extent
    far = _sense(design) * design.length
    left, right = low + min(far, 0.0), high + max(far, 0.0)
    rail = box(left - size, -1.2 * size, right + size, 0.0)
    return [MovingBody("rail", "ground", (FilledShape("fixed", (rail,), "guide of the plate"),), still())]


def _follower(design: LinearDesign, u: Array, size: float) -> list[MovingBody]:
    """Stem or arm with what touches the plate, and the contacts, seen from the follower's guide."""
    recipe, path = design.recipe, design.path
    side = design.sides(u)
    s = path.law.derivatives(u, 0, side)[0]
    centre, way = path.guide.place(u, s)
    place = np.column_stack([centre.real + u, centre.imag])
    angle = path.pressure_angle(u, side)
    radius = recipe.follower.radius
    touch = {
        "roller": lambda: roller(radius, size),
        "shoe": lambda: shoe(radius, angle, size),
        "knife-edge": lambda: knife_edge(size),
    }[recipe.follower.kind]()
    bodies = (
        _on_arm(path.guide, place, way, touch, size)
        if isinstance(path.guide, Arm)
        else _on_stem(place, way, touch, size)
    )
    for name, flank in design.flanks.items():
        frame = flank.shape.sample(u, side)
        push = flank.sense * frame.normal
        direction = np.unwrap(np.arctan2(push[:, 1], push[:, 0]))
        label = f"contact {name}".strip()
        bodies.append(contact(label, frame.point[:, 0] + u, frame.point[:, 1], direction, size, within=radius))
    return bodies if recipe.travel == "right" else [_turned(body) for body in bodies]


def _turned(body: MovingBody) -> MovingBody:
    """A body mirrored in the y axis: about the x axis, and then by half a turn."""
    (flat,) = Scene((body,)).mirrored().bodies
    turn = 0.0 if body.upright else math.pi
    angle = body.pose[:, 2] if body.upright else flat.pose[:, 2] + turn
    return replace(flat, pose=np.column_stack([-flat.pose[:, 0], -flat.pose[:, 1], angle]))


def _on_stem(place: Array, way: Array, touch: Touch, size: float) -> list[MovingBody]:
    pose = poses(place[:, 0], place[:, 1], way)
    along = np.array([math.cos(way[0]), math.sin(way[0])])
    run = (place - place[0]) @ along
    half, start = HALF_STEM * size, float(run.max()) + touch.ahead + size
    length = start + (RUN + 2.0) * size - float(run.min())
    stem = FilledShape("follower", (box(touch.foot, -half, length, half),), "stem")
    thick = 1.1 * size
    blocks = tuple(
        box(start, low, start + RUN * size, high) for low, high in ((half, half + thick), (-half - thick, -half))
    )
    return [
        MovingBody("stem", "follower", (stem,), pose),
        MovingBody(touch.name, "follower", touch.shapes, pose),
        MovingBody(
            "guide",
            "ground",
            (FilledShape("fixed", blocks, "guide"),),
            still(float(place[0, 0]), float(place[0, 1]), float(way[0])),
        ),
    ]


def _on_arm(guide: Arm, place: Array, way: Array, touch: Touch, size: float) -> list[MovingBody]:
    psi = guide.side * (way - 0.5 * math.pi)
    # the arm's own x leads from the pivot to the touching part
    angle = psi if guide.side > 0 else math.pi - psi
    end = (guide.length, 0.0)
    shape = FilledShape("follower", (bar((0.0, 0.0), end, WIDTH * size),), "arm")
    return [
        MovingBody("arm", "follower", (shape,), poses(0.0, guide.height, angle)),
        MovingBody(touch.name, "follower", touch.shapes, poses(place[:, 0], place[:, 1], way)),
        pivot("pivot", 0.0, guide.height, size, "P", angle=0.5 * math.pi),
    ]


# --- curves -----------------------------------------------------------------------------------------------------------


def _plots(design: LinearDesign) -> list[Plot]:
    """Lift and its derivatives, pressure angle, and curvature of the flanks over the travel."""
    recipe = design.recipe
    u = np.linspace(0.0, design.length, STEPS + 1)
    side = design.sides(u)
    unit = UNIT_NAMES[recipe.units]
    rows = design.path.law.derivatives(u, 2, side)
    scale = math.degrees(1.0) if recipe.swings else 1.0 / recipe.mm
    shown = "°" if recipe.swings else unit
    names = (("swing", "") if recipe.swings else ("lift", "")), ("velocity", f"/{unit}"), ("acceleration", f"/{unit}²")
    plots = [
        Plot(name.capitalize(), f"{shown}{per}", (Series(name, rows[k] * scale * recipe.mm**k),), dwells=True)
        for k, (name, per) in enumerate(names)
    ]
    angle = np.degrees(design.path.pressure_angle(u, side))
    limits = tuple(
        (sign * math.degrees(bound.at_most), "limit" if sign > 0 else "")
        for bound in recipe.limits
        if bound.figure == PRESSURE_ANGLE and bound.at_most is not None
        for sign in (1.0, -1.0)
    )
    note = "above 0 where the plate drives a rise on its way forth; on its way back the sign changes"
    plots.append(Plot("Pressure angle", "°", (Series("angle", angle),), limits=limits, dwells=True, note=note))
    bend = []
    for name, flank in design.flanks.items():
        frame = flank.shape.sample(u, side)
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature = flank.sense * frame.turn / frame.speed
        there = flank.stands(u)
        bend.append(Series(name or "flank", np.where(there, curvature * recipe.mm, np.nan)))
    plots.append(
        Plot("Curvature of the flank", f"1/{unit}", tuple(bend), dwells=True, note="above 0 where the metal is convex")
    )
    return plots


def _errors(design: LinearDesign, made: Sequence[Made[PlateVerdict]]) -> list[Plot]:
    """Error of the motion that each file gives, over the travel."""
    from camgeo.capabilities.linear.verdicts import follower_of
    from kin.linear.judge import positions

    recipe = design.recipe
    if recipe.groove is not None or recipe.endless:
        return []
    u = np.linspace(0.0, design.total, STEPS + 1)
    s = design.path.law.derivatives(u, 0, design.sides(u))[0]
    small = 1e3 if recipe.units == "mm" else 1e6
    scale, unit = (
        (math.degrees(1.0), "°") if recipe.swings else (small / recipe.mm, "µm" if recipe.units == "mm" else "µin")
    )
    plots = []
    for each in made:
        if each.verdict is None or not each.verdict.flanks or each.file.request.compensation is not None:
            continue
        flank = each.verdict.flanks[0]
        if flank.contour is None:
            continue
        error = (positions(flank.contour, follower_of(design), u) - s) * scale
        plots.append(
            Plot(f"Error of {each.file.path.name}", unit, (Series("error", error),), axis="error", holds=(0.0,))
        )
    return plots
