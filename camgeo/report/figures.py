"""What the figures of a design are: each measured where it is asked for, in mm and degrees, with its place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.checks.declared import (
    CHECKS,
    CLEARANCE,
    COLLISION,
    CURVATURE,
    LEAST_BACKLASH,
    PRESSURE,
    RATIO,
    STANDS,
    TRAVEL,
    WALL,
)
from camgeo.recipe.figures import DWELL, FIGURES, HOLLOW_RADIUS, PEAKS, PITCH_RADIUS, RADIUS, SIZE
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from typing import Any

    from camgeo.curve.curve import Curve
    from camgeo.report.document import FileResult
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.linkage import Driven
    from kin.judge.check import Check
    from kin.linkage.extremes import Place
    from kin.numeric.arrays import Array

POINTS = 4096  # of each run of a contour, among which the farthest from the shaft is sought
_CLOSER = 64  # points about the farthest, once more
_SHARE = 1e-12  # of the greatest value, to which a motion is followed
_ORDERS = {"swing": 0, **{name: k for k, name in enumerate(PEAKS, 1)}}
_OF_CHECKS = {one.name: one for one in (PRESSURE, RATIO, TRAVEL, WALL, CLEARANCE, COLLISION)}


class Measured(NamedTuple):
    """A figure, None where there is none, which `detail` then explains; `at_deg` is the shaft angle of its place."""

    value: float | None
    unit: str
    at_deg: float | None = None
    detail: str = ""


NO_CONTOUR = Measured(None, "mm", detail="no contour is made")


def of_design(design: Design, checks: Sequence[Check], names: Iterable[str]) -> dict[str, Measured]:
    """Measure figures of the exact cam, its motion and mechanism; one that no check of this run has is left out.

    `checks` are all that were made.
    """
    wanted = [name for name in names if FIGURES[name].of == "design"]
    found: dict[str, Measured] = {}
    motion = [name for name in wanted if name in _ORDERS]
    if design.driven is not None:
        found |= _of_linkage(design.driven, wanted)
    elif motion:
        found |= _of_motion(design, max(_ORDERS[name] for name in motion))
    for name in wanted:
        if name in _OF_CHECKS:
            same = [check for check in checks if check.name == name and check.file is None]
            if same:
                found[name] = _of_check(max(same, key=_nearness))
            elif name == PRESSURE.name:
                found[name] = Measured(0.0, "deg", detail="a flat face is pushed along its normal")
        elif name in _OF_CURVE:
            found[name] = _OF_CURVE[name](design)
    return {name: found[name] for name in wanted if name in found}


def _nearness(check: Check) -> float:
    """The more the nearer a check is to its limit."""
    if check.value is None:
        return math.inf
    return -check.value if check.sense == "at_least" else check.value


def _of_check(check: Check) -> Measured:
    return Measured(check.value, check.unit, check.at_deg, "" if check.value is not None else check.detail)


# --- of the curve -----------------------------------------------------------------------------------------------------


def _radius(design: Design) -> Measured:
    """Of the contour, not of the roller's way, which is bent less by the roller's radius."""
    bent = next(check for check in design.checks if check.name == CURVATURE.name)
    value = None if bent.value is None else bent.value - design.profile.roller_radius
    return Measured(value, "mm", bent.at_deg, bent.detail)


def _pitch_radius(design: Design) -> Measured:
    return _of_check(next(check for check in design.checks if check.name == CURVATURE.name))


def _hollow_radius(design: Design) -> Measured:
    from camgeo.curve.backwards import least_hollow

    if design.contour is None:
        return NO_CONTOUR
    radius, at = least_hollow(design.contour)
    if math.isinf(radius):
        return Measured(radius, "mm", detail="the contour has no concave part")
    return Measured(radius, "mm", design.position.shaft_deg(at))


def _size(design: Design) -> Measured:
    if design.contour is None:
        return NO_CONTOUR
    value, at = farthest(design.contour)
    return Measured(value, "mm", design.position.shaft_deg(at))


def farthest(contour: Curve) -> tuple[float, float]:
    """Greatest distance of a contour from the shaft, mm, and the parameter there."""

    def distance(t: Array) -> Array:
        point = contour.sample(t).point
        return np.asarray(np.hypot(point[:, 0], point[:, 1]))

    best, at = 0.0, 0.0
    for run in contour.runs:
        t = np.linspace(run.low, run.high, POINTS)
        worst = int(np.argmax(distance(t)))
        t = np.linspace(t[max(worst - 1, 0)], t[min(worst + 1, POINTS - 1)], 2 * _CLOSER + 1)
        far = distance(t)
        worst = int(np.argmax(far))
        if far[worst] > best:
            best, at = float(far[worst]), float(t[worst])
    return best, at


_OF_CURVE: dict[str, Callable[[Design], Measured]] = {
    RADIUS: _radius,
    PITCH_RADIUS: _pitch_radius,
    HOLLOW_RADIUS: _hollow_radius,
    SIZE: _size,
}


# --- of the motion ----------------------------------------------------------------------------------------------------


def _of_motion(design: Design, order: int) -> dict[str, Measured]:
    """Stroke or swing of the follower, and the greatest of its derivatives by the shaft angle up to an order."""
    from kin.numeric.monotone import RoughError, between, cells, pieces

    position = design.position
    unit, scale = position.unit, position.shown(1.0)
    names = [name for name, k in _ORDERS.items() if k <= order]
    try:
        made = cells(
            lambda t: position.by_parameter(t, order), between(0.0, TURN, design.intent.breaks.tolist()), share=_SHARE
        )
    except RoughError:
        why = "the motion changes too abruptly to be resolved"
        return {name: Measured(None, unit + FIGURES[name].per, detail=why) for name in names}
    found: dict[str, Measured] = {}
    for name in names:
        row = pieces(made, _ORDERS[name])
        low, high = row.least(), row.greatest()
        if name == "swing":
            found[name] = Measured(scale * (high[0] - low[0]), unit)
            continue
        value, at = max(low, high, key=lambda place: abs(place[0]))
        found[name] = Measured(scale * abs(value), unit + FIGURES[name].per, position.shaft_deg(at % TURN))
    return found


def _of_linkage(driven: Driven, names: Iterable[str]) -> dict[str, Measured]:
    """Figures of a linkage's motion."""
    mobility, unit = driven.mechanism.mobility(), driven.mechanism.unit
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    found = {
        "margin": Measured(mobility.margin, "mm"),
        "shaft-rate": Measured(None if math.isnan(mobility.least_rate) else mobility.least_rate, "", detail=STANDS),
    }
    if driven.figures is None:
        of = ("", "dwell", "linkage")
        lost = (name for name in names if FIGURES[name].needs in of and name not in {*found, *_OF_CURVE})
        return found | {name: Measured(None, "", detail=STANDS) for name in lost}

    def placed(place: Place, factor: float, unit: str) -> Measured:
        return Measured(abs(place.value) * factor, unit, math.degrees(place.shaft))

    made, turn = driven.figures, math.degrees(1.0)
    found |= {
        "swing": Measured(made.swing * scale, unit),
        PEAKS[0]: placed(made.velocity, scale, f"{unit}/rad"),
        PEAKS[1]: placed(made.acceleration, scale, f"{unit}/rad^2"),
        "transmission-angle": placed(made.transmission_least, turn, "deg"),
        "force-angle": placed(made.force_least, turn, "deg"),
    }
    for name, over in ((DWELL, "shaft"), ("dwell-relative", "relative")):
        longest = [dwell for key, dwells in driven.dwells.items() if key == over for dwell in dwells[:1]]
        for dwell in longest:
            at = math.degrees(dwell.start) % 360.0 if over == "shaft" else None
            found[name] = Measured(math.degrees(dwell.length), "deg", at)
    return found


# --- of files and of the dynamics -------------------------------------------------------------------------------------


def of_file(name: str, file: FileResult, checks: Sequence[Check]) -> Measured:
    """Measure a figure of a file that has a contour; `checks` are all that were made."""
    motion, unread = file.motion, "the file could not be judged"
    if name == "contour-error":
        return Measured(file.measured_error, "mm", detail=unread)
    if name == "pieces":
        return Measured(None if file.pieces is None else float(file.pieces), "", detail=unread)
    if name == "output-error":
        error = None if file.linkage is None else file.linkage.error
        return Measured(None, "", detail=unread) if error is None else Measured(error.max, error.unit, error.at_deg)
    if name == "backlash":
        held = [
            one for one in checks if one.file == file.path.name and one.name in CHECKS and CHECKS[one.name].backlash
        ]
        lost = "a single flat face has no backlash, and of a trimmed contour it is not judged"
        return _of_check(max(held, key=_nearness)) if held else Measured(None, "mm", detail=lost)
    if motion is None:
        return Measured(None, "", detail=unread)
    if name == "dwell-error":
        return Measured(motion.dwell_flatness, motion.unit, detail="the motion has no dwell")
    return Measured(motion.max, motion.unit, motion.at_deg)


def of_dynamics(name: str, section: Mapping[str, Any], checks: Sequence[Check]) -> dict[str | None, Measured]:
    """Measure a figure of each run of the dynamics, by the file that drives it, None for the intended motion."""
    if name == LEAST_BACKLASH.name:
        return {check.file: _of_check(check) for check in checks if check.name == LEAST_BACKLASH.name}
    kind, found = name.partition("-")[0], {}
    for run in section["runs"]:
        steady = run.get("steady") or {}
        value, at = steady.get(f"{kind}_force"), steady.get(f"{kind}_at_deg")
        lost = "" if value is not None else "there is no steady state"
        found[None if run["from"] == "intended" else run["from"]] = Measured(value, section["force_unit"], at, lost)
    return found
