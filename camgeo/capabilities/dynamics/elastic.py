"""Dynamics of a recipe's follower train: as intended, and with each file's cam; the report's section and its checks.

Forces are in N, about a pivot N m; velocities m/s or rad/s. Residual amplitudes are in the recipe's unit, degrees where
the follower swings.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.declared import FLOAT, LEAST_BACKLASH
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.running import begins_at
from camgeo.checks.declared import STANDS
from kin.numeric.angles import degrees
from kin.numeric.check import Check, about, failed
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.dynamics.cycle import Turn
    from kin.dynamics.drive import Drive
    from kin.dynamics.excitation import Faces
    from kin.dynamics.impacts import Course
    from kin.dynamics.train import Running, Steady, Train
    from kin.numeric.arrays import Array

TURNS = 20  # turns that are followed from rest, fewer where one repeats the turn before it
_DIGITS = 9  # decimals of a dwell's ends in degrees; more are rounding
MOST_FOR_FLOAT = 150  # stretches of a drive: with more, the speed at which float begins is not searched
MOST_PLACES = 4_500_000  # places of all searches for float together, and of all courses: some two seconds each


class _Purse:
    """Budget of places that searches may look at; each search may spend an equal share of what is left."""

    def __init__(self, searches: int) -> None:
        self._places, self._searches = MOST_PLACES, searches

    def share(self) -> int:
        """Greatest number of places that the next search may look at."""
        return self._places // max(self._searches, 1)

    def spend(self, places: int) -> None:
        """Take the places that a search has looked at out of the budget."""
        self._places, self._searches = max(0, self._places - places), self._searches - 1


@dataclass(frozen=True, eq=False)
class _Scene:
    """Data that all runs of a recipe share.

    `floats` and `courses` are the budgets of searches for float and of courses from rest; `rests` has begin and end of
    each dwell, rad. `unit` converts metres or radians to the report's unit, whose name is `unit_name`.
    """

    recipe: Recipe
    design: Design
    dynamics: Dynamics
    train: Train
    floats: _Purse
    courses: _Purse
    rests: tuple[tuple[float, float], ...]
    unit: float
    unit_name: str

    @cached_property
    def lowest(self) -> float:
        """Least position of the intended motion, m or rad."""
        from kin.dynamics.drive import drives, lowest

        (drive,) = drives([_faces(self, None).lower])
        return lowest(drive.knots, [drive.position], lambda row: row[0])[0]


def dynamics_of(recipe: Recipe, design: Design, files: Sequence[FileResult]) -> tuple[dict[str, Any], list[Check]]:
    """Section `dynamics` of the report and its checks: as intended, and with each file in which a contour was read.

    Under a linkage files have no run. Each run has one check: `float`, that the contact force stays at 0 or above at
    the recipe's speed, or with backlash `least-backlash`, that some backlash is left. A file on which the follower
    finds no contact has a failed check. Raises RecipeErrors where the train has no steady state, for backlash of a
    single contact, and for a linkage that does not turn right round; ValueError for a recipe without an elastic train.
    """
    from kin.dynamics.drive import DriveError
    from kin.dynamics.train import DynamicsError
    from kin.follower.motion_error import ContactError

    train_keys = recipe.of(Dynamics)
    if train_keys is None:
        raise ValueError("the recipe has no elastic train")
    sources: list[FileResult | None] = [None]
    if recipe.linkage is None:
        sources += [file for file in files if file.contour is not None]
    scene = _scene(recipe, train_keys, design, len(sources))
    entries: list[dict[str, Any]] = []
    checks: list[Check] = []
    for file in sources:  # faults of the train or of the intended motion are the recipe's, others fail a file's check
        try:
            entry, check = _run(scene, file)
        except DynamicsError as error:
            raise recipe.error("dynamics", str(error)) from error
        except (ContactError, DriveError) as error:
            if file is None:
                raise recipe.error("dynamics", str(error)) from error
            entry = {"from": file.path.name}
            check = failed(
                (FLOAT if train_keys.backlash is None else LEAST_BACKLASH).name, str(error), unit="N", limit=0.0
            )
        entries.append(entry)
        checks.append(check if file is None else about(check, file.path.name))
    train = scene.train
    section = {
        "rpm": train_keys.rpm,
        "natural_ratio": train.ratio(train_keys.rpm),
        "natural_rpm": train.natural * 30.0 / math.pi,
        "damping_ratio": train.damping_ratio,
        "unit": scene.unit_name,
        "force_unit": "N" if scene.unit_name != "deg" else "N m",
        "runs": entries,
    }
    return section, checks


def steady_force(recipe: Recipe, design: Design, dynamics: Dynamics, shaft: Array) -> tuple[Running, Array]:
    """The train under a spring at its speed, and its steady contact force (n,), N or N m, for the intended motion.

    `shaft` (n,) are shaft angles, rad. Raises RecipeErrors where the train has no steady state, for backlash of a
    single contact, and for a linkage that does not turn right round; ValueError for a rigid train.
    """
    from kin.dynamics.drive import DriveError
    from kin.dynamics.train import DynamicsError, steady

    scene = _scene(recipe, dynamics, design, 1)
    try:
        state = steady(scene.train, _drives(scene, None)[0], dynamics.rpm)
    except (DynamicsError, DriveError) as error:
        raise recipe.error("dynamics", str(error)) from error
    running = scene.train.at(dynamics.rpm)
    return running, state.force_at(running, shaft)


def _scene(recipe: Recipe, dynamics: Dynamics, design: Design, runs: int) -> _Scene:
    """Data shared by so many `runs`, whose searches share two budgets of places, for float and for courses.

    Raises RecipeErrors for backlash of one contact and a linkage that does not turn, ValueError for a recipe without
    an elastic train.
    """
    from kin.dynamics.train import Train
    from kin.law.contacts import METRE

    if dynamics.stiffness is None:
        raise ValueError("the recipe has no elastic train")
    train = Train(dynamics.mass, dynamics.damping, dynamics.stiffness, dynamics.preload or 0.0, dynamics.rate)

    if design.driven is None:
        follower = design.exact.gauge
        if dynamics.backlash is not None and len(follower.contacts) == 1:
            why = f"a single {design.follower.name} has no backlash"
            raise recipe.error("dynamics.backlash", why, None, "give preload")
        swings, dwells = follower.unit == "deg", follower.rests
    else:
        if not design.driven.turns:
            raise recipe.error("dynamics", STANDS)
        swings = design.driven.mechanism.unit == "deg"
        dwells = tuple((dwell.start, dwell.end) for dwell in design.driven.dwells.get("shaft", ()))
    name = "deg" if swings else "in" if recipe.units == "inch" else "mm"
    unit = math.degrees(1.0) if swings else 1.0 / (METRE * recipe.mm)
    return _Scene(
        recipe,
        design,
        dynamics,
        train,
        floats=_Purse(runs),
        courses=_Purse(runs),
        rests=dwells,
        unit=unit,
        unit_name=name,
    )


def _faces(scene: _Scene, file: FileResult | None) -> Faces:
    """Excitation of the follower by its lower face, and with backlash the upper one: intended, or by a file's contour.

    Raises ContactError where the follower finds no contact on the contour.
    """
    from kin.dynamics.excitation import Faces, OfMechanism, intended_faces, measured_faces

    if scene.design.driven is not None:
        return Faces(OfMechanism(scene.design.driven.mechanism), None)
    follower = scene.design.exact.gauge
    play = scene.dynamics.backlash
    if play is not None:  # the recipe gives it at the contact, mm; on an arm it is the turn that closes it, rad
        play = follower.moved_by(play)
    if file is None or file.contour is None:
        return intended_faces(follower, play)
    return measured_faces(follower, file.contour, play)


def _run(scene: _Scene, file: FileResult | None) -> tuple[dict[str, Any], Check]:
    """Entry of the report for a run of the train, as intended or with a file's cam, and its check."""
    drives = _drives(scene, file)
    entry: dict[str, Any] = {"from": "intended" if file is None else file.path.name}
    if len(drives) > 1:
        return _with_backlash(scene, entry, drives[0], drives[1])
    return _with_spring(scene, entry, drives[0])


def _drives(scene: _Scene, file: FileResult | None) -> list[Drive]:
    """Excitation of the follower by each face, the lower one first; dwells are cut at their ends."""
    from kin.dynamics.drive import drives
    from kin.dynamics.excitation import Faces
    from kin.follower.drive import Shifted

    faces = _faces(scene, file)
    # a spring's force is given at the lowest place of the intended motion, from which positions count then; with a rate
    # there is no backlash, so no upper face
    if scene.dynamics.rate:
        faces = Faces(Shifted(faces.lower, 1.0, -scene.lowest), None)
    ends = [end for rest in scene.rests for end in rest]
    return drives([face for face in faces if face is not None], ends)


def _with_spring(scene: _Scene, entry: dict[str, Any], drive: Drive) -> tuple[dict[str, Any], Check]:
    """Add steady state, course from rest and float speed of a train under a spring to its entry; and check `float`."""
    from kin.dynamics.train import steady

    train, rpm = scene.train, scene.dynamics.rpm
    state = steady(train, drive, rpm, scene.rests)
    entry["steady"] = _steady(scene, state)
    if scene.dynamics.transient:
        entry |= _followed(_course(scene, drive, None), rpm, train)
    entry |= _float_speed(scene, drive)
    least = state.force.least
    detail = f"greatest {state.force.greatest:.6g}; with the natural frequency {train.ratio(rpm):.4g} times the shaft's"
    if least < 0.0 and entry["float_rpm"] is not None:
        detail = begins_at(entry["float_rpm"], rpm) + detail
    unit = "N m" if scene.unit_name == "deg" else "N"
    at_deg = degrees(state.force.least_at)
    return entry, Check(FLOAT.name, least >= 0.0, least, 0.0, unit, at_deg, "at_least", detail=detail)


def _course(scene: _Scene, lower: Drive, upper: Drive | None) -> Course:
    """Course of the train from rest, within its share of the budget."""
    from kin.dynamics.impacts import course

    followed = course(scene.train, (lower, upper), scene.dynamics.rpm, TURNS, most=scene.courses.share())
    scene.courses.spend(followed.places)
    return followed


def _with_backlash(scene: _Scene, entry: dict[str, Any], lower: Drive, upper: Drive) -> tuple[dict[str, Any], Check]:
    """Add the course of a train with backlash to its entry; and check `least-backlash`, mm or degrees.

    Raises DynamicsError where not one turn could be followed.
    """
    from kin.dynamics.events import LOWER, UPPER
    from kin.dynamics.impacts import least_gap
    from kin.dynamics.train import DynamicsError

    least, at = least_gap(lower, upper)
    detail = ""
    if least > 0.0 and scene.dynamics.transient:
        followed = _course(scene, lower, upper)
        if not followed.turns and followed.stopped is not None:
            raise DynamicsError(followed.stopped)
        entry |= _followed(followed, scene.dynamics.rpm, scene.train)
        bore = followed.turns[-1].bore
        entry["impacts"]["faces"] = [name for name, face in (("lower", LOWER), ("upper", UPPER)) if face in bore]
        if not bore:
            detail = "the follower touches neither face: the backlash exceeds the cam's motion"
    swings = scene.unit_name == "deg"
    value, unit = (math.degrees(least), "deg") if swings else (1e3 * least, "mm")
    return entry, Check(LEAST_BACKLASH.name, least > 0.0, value, 0.0, unit, degrees(at), "at_least", detail=detail)


def _steady(scene: _Scene, steady: Steady) -> dict[str, Any]:
    """Report entry of a steady state: extremes of the contact force, and residual vibration in each dwell."""
    force = steady.force
    return {
        "holds": steady.holds,
        "peak_force": force.greatest,
        "peak_at_deg": degrees(force.greatest_at),
        "least_force": force.least,
        "least_at_deg": degrees(force.least_at),
        "residual": [
            {
                "dwell_from_deg": round(degrees(rest.start), _DIGITS) % 360.0,
                "dwell_to_deg": round(degrees(rest.end), _DIGITS) or 360.0,
                "amplitude": scene.unit * rest.amplitude,
            }
            for rest in steady.residual
        ],
    }


def _followed(followed: Course, rpm: float, train: Train) -> dict[str, Any]:
    """Entries for a course: `transient` and `impacts`, both None where not one turn could be followed."""
    if not followed.turns:
        return {"transient": None, "impacts": None, "transient_why": followed.stopped}
    entry = {"transient": _transient(followed, rpm, train), "impacts": _impacts(followed)}
    return entry if followed.stopped is None else entry | {"transient_why": followed.stopped}


def _transient(followed: Course, rpm: float, train: Train) -> dict[str, Any]:
    """Report entry of the start from rest: extremes of force over all turns, and turns until the free motion is 1 %."""
    turns = followed.turns
    peak = max(range(len(turns)), key=lambda i: turns[i].greatest)
    low = min(range(len(turns)), key=lambda i: turns[i].least)
    entry_of_start = {
        "turns": len(turns),
        "turns_most": TURNS,
        "settled": followed.settled,
        "peak_force": turns[peak].greatest,
        "peak_at_deg": math.degrees(turns[peak].greatest_at) + 360.0 * peak,
        "least_force": turns[low].least,
        "least_at_deg": math.degrees(turns[low].least_at) + 360.0 * low,
    }
    fading = train.at(rpm).bound.fading
    # the free motion fades by `fading` per rad of shaft while contact holds; where it is lost that has no meaning
    if fading > 0.0 and not turns[-1].free:
        entry_of_start["turns_to_one_percent"] = math.log(100.0) / (2.0 * math.pi * fading)
    return entry_of_start


def _impacts(followed: Course) -> dict[str, Any]:
    """Impacts in the last turn that was followed: number, velocity, force, and degrees out of contact.

    `settled` says whether all later turns repeat the last one. Where they do not, no two turns are alike and rounding
    decides what the last one is; `of_turns` then has the least and greatest figures of the later half of the turns.
    """
    last: Turn = followed.turns[-1]
    impacts: dict[str, Any] = {
        "settled": followed.settled,
        "count": last.impacts,
        "greatest_velocity": last.velocity,
        "velocity_at_deg": degrees(last.velocity_at) if last.impacts else None,
        "peak_force": last.greatest,
        "peak_at_deg": degrees(last.greatest_at),
        "free_deg": math.degrees(last.free),
    }
    if not followed.settled:
        half = followed.turns[len(followed.turns) // 2 :]
        impacts["of_turns"] = {
            "turns": len(half),
            "count": [min(turn.impacts for turn in half), max(turn.impacts for turn in half)],
            "greatest_velocity": [min(turn.velocity for turn in half), max(turn.velocity for turn in half)],
            "peak_force": [min(turn.greatest for turn in half), max(turn.greatest for turn in half)],
        }
    return impacts


def _float_speed(scene: _Scene, drive: Drive) -> dict[str, Any]:
    """Report entries of the speed, rpm, at which float begins; None with the reason where it is not known."""
    from kin.dynamics.separation import float_speed
    from kin.dynamics.train import DynamicsError

    train = scene.train
    if len(drive) > MOST_FOR_FLOAT:
        return {"float_rpm": None, "float_why": f"not searched: the motion has more than {MOST_FOR_FLOAT} stretches"}
    try:
        speed = float_speed(train, drive, most=scene.floats.share())
    except DynamicsError as error:
        return {"float_rpm": None, "float_why": str(error)}
    scene.floats.spend(speed.places)
    entry: dict[str, Any] = {"float_rpm": speed.rpm, "float_rigid_rpm": speed.rigid_rpm}
    if speed.between is not None:
        holds, floats = speed.between
        above = f"above {holds:.6g} rpm" if floats is None else f"between {holds:.6g} and {floats:.6g} rpm"
        entry["float_between_rpm"] = list(speed.between)
        entry["float_why"] = (
            f"not settled: it begins {above}; with {train.damping_ratio:.3g} times the critical damping there are too "
            "many resonances to look at; more damping or less stiffness has fewer, fewer files leave more room"
        )
    elif speed.rpm is None:
        entry["float_why"] = "contact holds up to a shaft at twice the natural frequency"
    return entry
