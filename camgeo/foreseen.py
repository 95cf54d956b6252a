"""The checks that a run of a recipe is going to make, told without running it.

Only the intended motion is built, which costs milliseconds, no curve and no file. A run may differ where an undercut
decides: without a contour no file is judged, and a trimmed one only against a limit of the motion that is given; and
where a linkage does not turn, by which files are not judged then.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.recipe.model import (
    NO_CONTOUR,
    NO_PART,
    SOLIDS,
    ConstantBreadthCam,
    DoubleRollerCam,
    FlatPairCam,
    SupportCam,
)

if TYPE_CHECKING:
    from camgeo.recipe.model import Recipe
    from camgeo.recipe.model_part import Part

LEAST_ROOM = 1e-2  # mm: a hole that is wider than the cutter by less than twice this is not milled
MILLING = ("cutter-reach", "units", "closed", "cutter", "arcs", "rapid", "depth", "direction", "entry", "gouge")
PLAY = frozenset({"constant-breadth", "breadth-max", "form-closure"})
"""Checks of a file on what is left between contour and follower."""


class Foreseen(NamedTuple):
    """One check to come: its name, and the file it concerns, None for the exact curve and the intended motion."""

    name: str
    file: str | None = None

    def __str__(self) -> str:
        """Write it as in a test's name."""
        return self.name if self.file is None else f"{self.name}[{self.file}]"


def foreseen(recipe: Recipe) -> tuple[Foreseen, ...]:
    """Tell the checks of a recipe, those of each file after those that need none; raises kin.law.IntentError."""
    yoke = _in_a_yoke(recipe)
    names = ["radius-of-curvature", "undercut-local"]
    if isinstance(recipe.cam, DoubleRollerCam):
        names += ["undercut-global", "closing-equation", "transmission", "pressure-angle"]
    elif isinstance(recipe.cam, FlatPairCam):
        names += ["closing-equation", "transmission"]
    else:
        names += ["constant-breadth", "face-length"] if yoke else ["face-length"]
    linkage = recipe.linkage is not None
    dwell = ["dwell"] if recipe.dwell is not None and recipe.dwell.at_least is not None else []
    if linkage:
        names += ["mobility", "reversal", *dwell]
    train = [] if recipe.dynamics is None else ["float" if recipe.dynamics.play is None else "play"]
    part = recipe.part
    bore, solid = _of_part(part)
    if bore or part.hub is not None:
        names.append("wall")
    names += [name for name in ("chamfer", "lightening") if getattr(part, name) is not None]
    if any(request.parts == "all" for request in recipe.export.files):
        names += ["clearance", "collision"]
    found = [Foreseen(name) for name in names]
    play = ["form-closure"] if isinstance(recipe.cam, DoubleRollerCam | FlatPairCam) else []
    if yoke:
        play = ["constant-breadth", "breadth-max"]
    for request in recipe.export.files:
        if request.kind in NO_CONTOUR:
            continue
        file = request.filename(recipe.name, recipe.export.files)
        own = ["units", "closed", *bore]
        if request.kind in SOLIDS:
            own = ["watertight", *bore, "thickness", *solid, "volume"]
        if request.kind == "gcode":
            own = [*MILLING, *_milled(recipe)]
        if request.kind == "dxf" and request.compensation is None and _layered(recipe):
            own.insert(0, "cutter-reach")
        driven = ["linkage-error", *dwell] if linkage and request.compensation is None else []
        found += [Foreseen(name, file) for name in (*own, "contour", "motion", *play, *driven)]
    found += [Foreseen(name) for name in train]
    if not linkage:  # of a linkage the intended output alone drives
        found += [Foreseen(name, file) for name in train for file in _judged(recipe)]
    return tuple(found)


def _of_part(part: Part) -> tuple[list[str], list[str]]:
    """Checks of a file's openings, and those of a solid besides."""
    drilled = part.bolts is not None or part.dowel is not None or part.lightening is not None
    given = (("bore", part.bore is not None), ("holes", drilled), ("mark", part.mark is not None))
    raised = (("hub", part.hub is not None), ("chamfer", part.chamfer is not None))
    screwed = (("set-screw", part.set_screw is not None),)
    return [name for name, there in given if there], [name for name, there in (*raised, *screwed) if there]


def _judged(recipe: Recipe) -> list[str]:
    """Names of the files that have a contour."""
    files = recipe.export.files
    shown = [request for request in files if request.kind not in NO_PART and request.compensation is None]
    return [request.filename(recipe.name, files) for request in shown]


def _layered(recipe: Recipe) -> bool:
    return recipe.manufacture is not None and recipe.manufacture.layer


def _milled(recipe: Recipe) -> list[str]:
    """Checks of the openings that a program mills; where lightening holes find their place is not known beforehand."""
    part, asked = recipe.part, recipe.manufacture
    if asked is None or not asked.holes:
        return []
    least = asked.cutter + 2.0 * LEAST_ROOM
    plain_bore = part.bore if not (part.sides or part.keyway or part.flat or part.hub) else None
    hub = 0.0 if part.hub is None else part.hub.diameter
    drilled = [one.hole for one in (part.bolts, part.dowel) if one is not None and one.circle >= hub]
    found = ["bore"] if plain_bore is not None and plain_bore >= least else []
    return [*found, "holes"] if any(hole >= least for hole in drilled) else found


def _in_a_yoke(recipe: Recipe) -> bool:
    """Whether two parallel faces hold the cam. Builds the motion in any case: one that cannot be is told first."""
    from camgeo.figures import is_constant_breadth
    from camgeo.profile.build import intent_of
    from kin.lift import Lift

    intent = intent_of(recipe.cam)
    if isinstance(recipe.cam, ConstantBreadthCam):
        return True
    return isinstance(recipe.cam, SupportCam) and isinstance(intent, Lift) and is_constant_breadth(intent)
