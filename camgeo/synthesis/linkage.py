"""The linkage that a cam drives: the mechanism of a recipe, its checks before any file, its figures and its table.

The cam is held in a square frame, the coupler (AS section 3). Angles of the recipe's checks are shaft angles, as
everywhere; where the linkage binds, the shaft has no angle, and the relative angle between cam and frame is reported.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from camgeo.checks.declared import DWELL, MOBILITY, REVERSAL
from camgeo.common.rounding import upward
from camgeo.recipe.linkage import with_other_lengths
from kin.numeric.angles import TURN, degrees
from kin.numeric.check import Check, failed
from kin.numeric.errors import CamgeoError
from kin.numeric.monotone import RoughError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.recipe.linkage import DwellLimits, Linkage
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from kin.law.support_function import Lift
    from kin.linkage.extremes import Figures
    from kin.linkage.mechanism import Mechanism, OutsideError
    from kin.numeric.arrays import Array
    from kin.numeric.longest_window import Window

Over: TypeAlias = Literal["shaft", "relative"]
LOOKS = 360  # relative angles at which a changed linkage is sampled first
OVER: tuple[Over, ...] = ("shaft", "relative")
DEGREES = 180.0 / math.pi
CHANGES = (1.05, 0.95, 1.1, 0.9, 1.2, 0.8, 1.5, 0.65, 2.0, 0.5, 3.0)  # factors of a link, for a linkage that binds


def mechanism_of(recipe: Recipe, lift: Lift, breadth: float) -> Mechanism:
    """Mechanism of a recipe that has a linkage, for the cam's `lift` and `breadth`, mm.

    Raises RecipeErrors where the shaft does not lie within the cam, or a dyad's output would not swing, ValueError for
    a recipe without a linkage, RoughError for a motion that changes too abruptly.
    """
    from kin.law.normalised import IntentError
    from kin.linkage.mechanism import Mechanism, OutsideError

    linkage = recipe.linkage
    if linkage is None:
        raise ValueError(f"{recipe.name}: there is no linkage")
    try:
        return Mechanism(linkage.loop, lift, breadth, linkage.dyads)
    except OutsideError as error:
        raise _outside(recipe, error) from error
    except IntentError as error:
        part = "linkage" if error.field.startswith("dyads") else "cam"
        field = f"{part}.{error.field}"
        raise recipe.error(field if field in recipe.marks else part, error.message) from error


def _outside(recipe: Recipe, error: OutsideError) -> RecipeErrors:
    """RecipeErrors for a shaft outside the cam, at the field that places it: base radius, shaft, or the cam."""
    if "cam.base_radius" in recipe.marks:
        more = upward(error.depth / recipe.mm)
        return recipe.error("cam.base_radius", error.message, None, f"give one larger by more than {more}")
    if "cam.shaft" in recipe.marks:
        return recipe.error("cam.shaft", error.message, None, "place it within the cam")
    return recipe.error("cam", error.message, None, "give shaft, a point within the cam")


# --- checks before any file -------------------------------------------------------------------------------------------


def mobility_checks(mechanism: Mechanism, turning: str = "") -> list[Check]:
    """Checks that every loop closes all round (AS after eq. 18), margin in mm, and that the shaft never turns back.

    A mechanism that does not turn right round has no shaft angle: the relative angles then stand in the detail only,
    with `turning`, words for a change that would let it turn.
    """
    mobility = mechanism.mobility()
    loop = "the linkage" if mobility.loop == 0 else f"dyad {mobility.loop}"
    where = (
        f"{loop} binds {_spans(mobility.binds)} of the relative angle" if mobility.binds else f"{loop} is the nearest"
    )
    back = f"the shaft would turn back {_spans(mobility.reverses)} of the relative angle" if mobility.reverses else ""

    def above_zero(name: str, value: float | None, unit: str, angle: float, detail: str) -> Check:
        held = value is not None and value > 0.0
        place = degrees(float(mechanism.at(angle, 0).shaft[0, 0])) if mobility.turns else None
        more = "" if held or not turning else f"; {turning}" if detail else turning
        return Check(name, held, value, 0.0, unit, place, "at_least", detail=detail + more)

    rate = None if math.isnan(mobility.least_rate) else mobility.least_rate
    return [
        above_zero(MOBILITY.name, mobility.margin, "mm", mobility.margin_at, where),
        above_zero(REVERSAL.name, rate, "", mobility.rate_at, back or (where if rate is None else "")),
    ]


def _length_that_turns(recipe: Recipe, mechanism: Mechanism) -> str:
    """Name the link whose length, changed by the least share of CHANGES, lets the mechanism turn; each is tried.

    Empty where none does, or where the links shape the cam, which would be another one.
    """
    linkage = recipe.linkage
    if linkage is None or linkage.shaped(recipe.cam) is not recipe.cam:
        return ""
    for factor in CHANGES:
        for path, length, changed in with_other_lengths(linkage, mechanism.mobility().loop, factor):
            if _turns(changed, mechanism):
                unit = "in" if recipe.units == "inch" else "mm"
                return f"with linkage.{path} {length / recipe.mm:.6g} {unit} it would turn"
    return ""


def _turns(linkage: Linkage, like: Mechanism) -> bool:
    """Whether a linkage turns right round with the cam of another mechanism."""
    from kin.linkage.mechanism import Mechanism

    try:
        made = Mechanism(linkage.loop, like.lift, like.breadth, linkage.dyads)
        rate = made.at(np.linspace(0.0, TURN, LOOKS, endpoint=False), 1).shaft[1]  # at few places: most fail there
        return bool(rate.min() > 0.0) and made.mobility().turns
    except (CamgeoError, ValueError):
        return False


def _spans(spans: Sequence[tuple[float, float]]) -> str:
    return " and ".join(f"from {math.degrees(a):.6g} to {math.degrees(b):.6g} deg" for a, b in spans)


def _dwell_check(dwell: DwellLimits, longest: Window) -> list[Check]:
    """Check that the longest dwell of the intended output has the recipe's least length; empty without one."""
    if dwell.at_least is None:
        return []
    length, wanted = math.degrees(longest.length), math.degrees(dwell.at_least)
    start = degrees(longest.start)
    detail = f"from {start:.6g} over {length:.6g} deg of the {dwell.over} angle"
    at = start if dwell.over == "shaft" else None
    return [Check(DWELL.name, length >= wanted, length, wanted, "deg", at, "at_least", detail=detail)]


# --- the whole of it --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class DesignedLinkage:
    """The linkage of a recipe: its mechanism, checks, dwells, and the figures of its motion.

    `dwells` has the dwells over the shaft and over the relative angle, the longest first; it is empty where the recipe
    has no dwell, and for a linkage that does not turn right round. `figures` is None for such a linkage.
    """

    mechanism: Mechanism
    checks: tuple[Check, ...]
    dwells: Mapping[Over, tuple[Window, ...]]
    figures: Figures | None

    @property
    def turns(self) -> bool:
        """Whether the shaft can be turned right round; else the mechanism has no motion over the shaft angle."""
        return self.mechanism.mobility().turns


def driven(recipe: Recipe, lift: Lift, breadth: float | None) -> DesignedLinkage:
    """Mechanism of a recipe that has a linkage, with its checks; `breadth`, mm, is the cam's, None where it varies.

    Raises RecipeErrors where no square frame holds the cam, or the shaft does not lie within it, where a dyad's output
    would not swing, the band of a dwell is too narrow for rounding errors, or the motion changes too abruptly to be
    resolved.
    """
    if breadth is None:
        remedy = "give p odd harmonics alone, or take another kind of cam"
        raise recipe.error(
            "linkage", "a square frame holds a cam of constant breadth alone, and this cam's varies", None, remedy
        )
    try:
        mechanism = mechanism_of(recipe, lift, breadth)
    except RoughError as error:
        at = math.degrees(error.at % TURN)
        problem = f"its motion changes too abruptly for that of a linkage to be resolved, near {at:.6g} degrees"
        raise recipe.error("cam", problem, None, "give p fewer or lower waves") from error
    try:
        return _driven(recipe, mechanism)
    except RoughError as error:
        at = math.degrees(error.at % TURN)
        problem = f"the motion changes too abruptly to be resolved, near a relative angle of {at:.6g} degrees"
        smoother = "the motion a larger stroke" if "cam.base_radius" in recipe.marks else "p fewer waves"
        remedy = f"keep its loops farther from binding, or give {smoother}"
        raise recipe.error("linkage", problem, None, remedy) from error


def _driven(recipe: Recipe, mechanism: Mechanism) -> DesignedLinkage:
    mobile = mechanism.mobility()
    checks = mobility_checks(mechanism, "" if mobile.turns else _length_that_turns(recipe, mechanism))
    dwells: dict[Over, tuple[Window, ...]] = {}
    limits = recipe.dwell
    if limits is not None and mechanism.mobility().turns:
        try:
            dwells = {over: mechanism.dwells(limits.band, over) for over in OVER}
        except ValueError as error:
            unit = "rad" if mechanism.unit == "deg" else "mm"
            raise recipe.error("dwell.band", f"{error} {unit}", None, "give a wider band") from error
        checks += _dwell_check(limits, dwells[limits.over][0])
    elif limits is not None and limits.at_least is not None:
        checks.append(
            failed(DWELL.name, "the mechanism does not turn", unit="deg", limit=math.degrees(limits.at_least))
        )
    figures = mechanism.figures() if mechanism.mobility().turns else None
    return DesignedLinkage(mechanism, tuple(checks), dwells, figures)


def motion_table(recipe: Recipe, mechanism: Mechanism) -> tuple[tuple[str, ...], Array]:
    """Names of k columns and rows (angles + 1, k) over equal steps of the shaft, for a mechanism that turns.

    Columns are the angles of shaft, relative motion and frame; position, velocity and acceleration of each output, the
    last one first; velocity and acceleration of the frame; the last output's by the relative angle, which AS plot; and
    joints in the fixed axes, D first. Derivatives are by radian of the shaft. Angles are in degrees, lengths in the
    recipe's unit. At a break derivatives are the limits from above, at the end of the turn from below.
    """
    count = recipe.verify.angles
    shaft = np.linspace(0.0, TURN, count + 1)
    theta = mechanism.relative(shaft)
    parts = [mechanism.at(theta[:-1], 2), mechanism.at(theta[-1:], 2, -1)]

    # angles and the frame, then outputs, their derivatives by the relative angle, and joints
    length = "in" if recipe.units == "inch" else "mm"
    frame = DEGREES * np.concatenate([part.over_shaft(part.frame) for part in parts], axis=1)
    columns = {"shaft_deg": np.linspace(0.0, 360.0, count + 1), "relative_deg": theta * DEGREES, "frame_deg": frame[0]}
    units = [mechanism.linkage.unit, *(dyad.unit for dyad in mechanism.dyads)]
    last = len(units) - 1
    for index in (last, *range(last)):  # the output that counts comes first
        mark = "" if index == last else f"_{index}"
        unit, scale = ("deg", DEGREES) if units[index] == "deg" else (length, 1.0 / recipe.mm)
        rows = scale * np.concatenate([part.over_shaft(part.outputs[index]) for part in parts], axis=1)
        columns |= {f"output{mark}_{unit}": rows[0], f"velocity{mark}": rows[1], f"acceleration{mark}": rows[2]}
        if index == last:
            relative = scale * np.concatenate([part.output for part in parts], axis=1)
    columns |= {"frame_velocity": frame[1], "frame_acceleration": frame[2]}
    columns |= {"velocity_by_relative": relative[1], "acceleration_by_relative": relative[2]}
    for index in range(len(units)):
        mark = "" if index == 0 else f"_{index}"
        x, y = np.concatenate([part.joints[index][:, 0] for part in parts], axis=1) / recipe.mm
        columns |= {f"joint{mark}_x_{length}": x, f"joint{mark}_y_{length}": y}
    return tuple(columns), np.column_stack(list(columns.values()))
