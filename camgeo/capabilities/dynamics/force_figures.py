"""Forces of a rigid follower at its speed: extremes over the turn, as the report's section, figures and a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.dynamics.declared import FLOAT
from camgeo.capabilities.dynamics.figures import FORCE_GREATEST, FORCE_LEAST, GUIDE_FORCE, MEAN_FORCE, PRESSURE, TORQUE
from camgeo.capabilities.dynamics.keys import BOUNDS
from camgeo.capabilities.dynamics.running import begins_at, float_rpm
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.measures.forces import PER_MM, ExtremeAtAngle
from camgeo.measures.measured import ABRUPT, Measured
from camgeo.measures.units import pounds
from kin.numeric.angles import TURN, degrees
from kin.numeric.check import Check
from kin.numeric.monotone import RoughError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.dynamics.moved_train import MovedTrain
    from camgeo.capabilities.dynamics.running import Running
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

FORCES = {
    **dict.fromkeys((FORCE_LEAST, FORCE_GREATEST, GUIDE_FORCE, MEAN_FORCE), "N"),
    TORQUE: "N m",
    PRESSURE: "N/mm^2",
}


@dataclass(frozen=True, eq=False)
class Extremes:
    """Least and greatest value of each force over the turn, in this order.

    `contacts` has the normal force of each contact, N, `torque` the shaft's, N m, `along` the force F along the travel,
    N or N m. `reactions`, N, are by the names of their columns; `pressure` has Hertz's pressure of each contact,
    N/mm^2, and is empty without material or width.
    """

    contacts: tuple[tuple[ExtremeAtAngle, ExtremeAtAngle], ...]
    torque: tuple[ExtremeAtAngle, ExtremeAtAngle]
    along: tuple[ExtremeAtAngle, ExtremeAtAngle]
    reactions: Mapping[str, tuple[ExtremeAtAngle, ExtremeAtAngle]]
    pressure: tuple[tuple[ExtremeAtAngle, ExtremeAtAngle], ...]


def extremes_of(running: Running) -> Extremes:
    """Find the extremes of all forces over the whole turn, for a stem that does not jam.

    Where a valve's seat carries the spring while it is shut, the least force of the contacts and along the travel are
    those of the open valve. Of a load that is sampled they are those of the least and the greatest that it may be.
    Raises RoughError for too abrupt a motion, RecipeErrors for a load without a finite value.
    """
    count = len(running.turn.names)

    def values(t: Array) -> Array:
        states = [running.at(t, more) for more in running.doubts]
        more = [() if state.pressure is None else state.pressure for state in states]
        rows = [
            [*state.normal, state.torque, state.force, *state.reactions.values(), *pressure]
            for state, pressure in zip(states, more, strict=True)
        ]
        return np.stack([row for own in zip(*rows, strict=True) for row in own])

    def found(stretch: tuple[float, float]) -> list[tuple[ExtremeAtAngle, ExtremeAtAngle]]:
        each = iter(running.turn.extremes(values, stretch))
        return [
            (min(least for least, _ in group), max(most for _, most in group))
            for group in zip(*[each] * len(running.doubts), strict=True)
        ]

    extremes = found((0.0, TURN))
    if judged := judged_stretches(running):
        held = [found(stretch) for stretch in judged]
        for k in (*range(count), count + 1):
            extremes[k] = min(own[k][0] for own in held), extremes[k][1]
    names = tuple(running.at(running.turn.places[:1]).reactions)
    beside = extremes[count + 2 :]  # reactions, then pressures
    # with two contacts a least force below 0 is rounding
    contacts = tuple((ExtremeAtAngle(max(least.value, 0.0), least.at_deg), most) for least, most in extremes[:count])
    if count == 1:  # a negative force is what the spring lacks to hold the follower on the cam
        contacts = (extremes[0],)
    return Extremes(
        contacts,
        extremes[count],
        extremes[count + 1],
        dict(zip(names, beside, strict=False)),
        tuple(beside[len(names) :]),
    )


def judged_stretches(running: Running) -> list[tuple[float, float]]:
    """Stretches of the turn, rad, in which the spring is to hold the follower; empty where that is all of it."""
    moved = running.moved
    if moved is None or moved.coil is None:
        return []
    return [(event.opening, event.closing) for event in moved.stretches]


def float_check(running: Running, extremes: Extremes) -> Check | None:
    """Check that F is at 0 or above, so that a single contact stays on the cam; None with several contacts."""
    if len(extremes.contacts) > 1:
        return None
    least, most = extremes.along
    unit, sampled = running.turn.unit, running.sampled
    detail = f"greatest {most.value:.6g}; of a rigid follower"
    if running.moved is not None and running.moved.coil is not None:
        where = " and ".join(f"{opens:.6g} to {closes:.6g}" for opens, closes in _open_deg(running.moved))
        detail += f", while the {running.moved.body.name} is open, {where} degrees; before and after, its seat "
        detail += f"carries the spring, and {_held_shut(running)} holds the tappet"
    if sampled is not None:
        place = f"{degrees(sampled.at):.6g} degrees"
        detail += f"; the load, sampled near {place}, may be off by {sampled.within:.2g} {unit}, which is counted"
    if least.value < 0.0:
        rpm = float_rpm(running, judged_stretches(running) or [(0.0, TURN)])
        detail = begins_at(rpm, running.train.rpm) + detail
    return Check(FLOAT.name, least.value >= 0.0, least.value, 0.0, unit, least.at_deg, "at_least", detail=detail)


def _open_deg(moved: MovedTrain) -> list[tuple[float, float]]:
    """Shaft angles, degrees, at which the body leaves its seat and meets it again."""
    return [(degrees(event.opening % TURN), degrees(event.closing % TURN)) for event in moved.stretches]


def _held_shut(running: Running) -> str:
    """Words for what holds the tappet on the cam while the body is shut."""
    return "its load alone" if running.train.load != "0" else "nothing"


def _moved_section(running: Running, moved: MovedTrain) -> dict[str, object]:
    """Entry of the report on what the follower moves: where it is open, and what the follower feels of it there."""

    def felt(t: Array) -> Array:
        position = running.turn.rows(t)[0]
        ratio = moved.ratio(position)
        rows = [ratio[0], running.train.mass + moved.mass * ratio[0] ** 2]
        if moved.coil is not None:  # N/m: R^2 k + R' F
            force = moved.spring(t, position) / ratio[0]
            rows.append(ratio[0] ** 2 * moved.coil.rate + ratio[1] * force / PER_MM)
        return np.array(rows)

    stretches = [running.turn.extremes(felt, (event.opening, event.closing)) for event in moved.stretches]
    entry: dict[str, object] = {
        "on": moved.body.name if moved.coil is not None else "tappet",
        "open": [{"from_deg": opens, "to_deg": closes} for opens, closes in _open_deg(moved)],
    }
    if moved.coil is not None:
        entry["shut"] = {"carried_by": "seat", "tappet_held_by": _held_shut(running)}
    names = (("ratio", ""), ("mass_at_tappet", "kg"), ("rate_at_tappet", "N/m"))
    for (name, unit), *each in zip(names, *stretches, strict=False):
        entry[name] = _range((min(least for least, _ in each), max(most for _, most in each)), unit)
    return entry


def forces_section(running: Running, extremes: Extremes) -> dict[str, object]:
    """Section `forces` of the report: ranges of contact forces, torque, reactions and pressures, with shaft angles.

    Lengths are in the recipe's unit. Raises RecipeErrors for a load without a finite value, RoughError for too abrupt
    a motion.
    """
    names, turn = running.turn.names, running.turn
    section: dict[str, object] = {
        "rpm": running.train.rpm,
        "contacts": [
            {"contact": name, **_range(entry, "N")} for name, entry in zip(names, extremes.contacts, strict=True)
        ],
        "torque": _range(extremes.torque, "N m"),
    }
    if running.moved is not None:
        section["moved"] = _moved_section(running, running.moved)
    if running.train.least_force is not None:
        section |= {"preload": running.preload, "preload_unit": turn.unit}
    if running.sampled is not None:
        at, within = running.sampled
        section["load_sampled"] = {"at_deg": degrees(at), "within": within, "unit": turn.unit}
    ends = {"guide_a": "near", "guide_b": "far"}  # a stem's guide; other reactions are a linkage's
    if guide := [
        {"end": ends[name], **_range(entry, "N")} for name, entry in extremes.reactions.items() if name in ends
    ]:
        section["guide"] = guide
    elif extremes.reactions:
        section["reactions"] = [{"reaction": name, **_range(entry, "N")} for name, entry in extremes.reactions.items()]
    if extremes.pressure and running.width is not None:
        recipe, (length, bound) = running.recipe, running.width
        unit = "in" if recipe.units == "inch" else "mm"
        section["width"] = {"value": length / recipe.mm, "unit": unit, "bound_by": BOUNDS[bound]}
        bearable = running.most_pressure
        section["pressure"] = [
            {"contact": name, "max": most.value, "max_at_deg": most.at_deg, "unit": "N/mm^2"}
            | ({} if bearable is None else {"limit": bearable, "share_of_limit": most.value / bearable})
            for name, (_, most) in zip(names, extremes.pressure, strict=True)
        ]
    section |= running.own_section()
    if lost := running.lost_rpm():
        section["lost"] = [entry._asdict() for entry in lost]
    return section


class Forces(NamedTuple):
    """Section `forces` of the report on a rigid follower, and its checks."""

    section: dict[str, object]
    checks: tuple[Check, ...]


def rigid_forces(recipe: Recipe, design: Design) -> Forces | None:
    """Find the forces of the follower, taken as rigid; the section says where a stem jams, and then has no forces.

    None without dynamics, and for an elastic train without a material. Raises RecipeErrors for too abrupt a motion, a
    load without a finite value, a contact that nothing holds on the cam, preloaded contacts that wedge the stem, and a
    linkage that does not turn right round.
    """
    running = running_of(recipe, design)
    if running is None:
        return None
    try:
        if running.jam_deg is not None:  # the check `guide-jam` fails
            return Forces({"rpm": running.train.rpm, "jams_at_deg": running.jam_deg}, ())
        extremes = extremes_of(running)
    except RoughError as error:
        raise recipe.error("dynamics", f"{ABRUPT}: {error}") from error
    check = float_check(running, extremes)
    return Forces(forces_section(running, extremes), () if check is None else (check,))


def forces_table(running: Running, count: int, units: str = "mm") -> tuple[tuple[str, ...], Array]:
    """Names of c columns and rows (count + 1, c) over a turn in `count` equal steps, its end included.

    Columns are the shaft angle in degrees, contact forces, torque, reactions, and, where known, pressures and speeds of
    rollers: N, N m, N/mm^2, rpm. With the `units` inch the same in lbf, lbf in and psi follow. Forces are nan where the
    stem jams. Raises RecipeErrors for a load without a finite value, RoughError for too abrupt a motion.
    """
    state = running.state(np.linspace(0.0, TURN, count + 1))
    names = [name.replace(" ", "_") for name in running.turn.names]
    several = len(names) > 1
    columns: dict[str, Array] = {"shaft_deg": np.linspace(0.0, 360.0, count + 1)}
    columns |= {f"{name}_N" if several else "contact_N": row for name, row in zip(names, state.normal, strict=True)}
    columns["torque_Nm"] = state.torque
    columns |= {f"{name}_N": row for name, row in state.reactions.items()}
    groups = ("pressure_N_mm2", state.pressure), ("roller_rpm", state.roller_rpm)
    for column, rows in groups:
        if rows is not None:
            columns |= {f"{name}_{column}" if several else column: row for name, row in zip(names, rows, strict=True)}
    for column in tuple(columns):
        for ending, unit in (("_N", "N"), ("_Nm", "N m"), ("_N_mm2", "N/mm^2")):
            if column.endswith(ending) and (imperial := pounds(units, unit)) is not None:
                name, factor = imperial
                columns[f"{column.removesuffix(ending)}_{name.replace(' ', '_')}"] = factor * columns[column]
    return tuple(columns), np.column_stack(list(columns.values()))


def figures_of(recipe: Recipe, design: Design) -> dict[str, Measured]:
    """Every figure of forces that the recipe has, by its name, with the contact that has it.

    Empty without dynamics, and for an elastic train without a material. All figures have no value where the stem jams
    in its guide, or the motion is too abrupt. Raises RecipeErrors for a load without a finite value, a contact that
    nothing holds on the cam, preloaded contacts that wedge the stem, and a linkage that does not turn right round.
    """
    running = running_of(recipe, design)
    if running is None:
        return {}
    try:
        if running.jam_deg is not None:
            jam = "the stem jams in its guide"
            return {name: Measured(None, unit, running.jam_deg, detail=jam) for name, unit in FORCES.items()}
        forces = extremes_of(running)
    except RoughError:
        return {name: Measured(None, unit, detail=ABRUPT) for name, unit in FORCES.items()}
    names = running.turn.names

    # the worst contact of each figure; a guide's reaction and the torque count either way
    def worst(pairs: Sequence[tuple[ExtremeAtAngle, ExtremeAtAngle]], unit: str) -> Measured:
        value, name = max((extreme[1], name) for name, extreme in zip(names, pairs, strict=True))
        return Measured(value.value, unit, value.at_deg, surface=name if len(names) > 1 else "")

    least, name = min((extreme[0], name) for name, extreme in zip(names, forces.contacts, strict=True))
    torque = max(forces.torque, key=lambda extreme: abs(extreme.value))
    figures = {
        FORCE_LEAST: Measured(least.value, "N", least.at_deg, surface=name if len(names) > 1 else ""),
        FORCE_GREATEST: worst(forces.contacts, "N"),
        TORQUE: Measured(abs(torque.value), "N m", torque.at_deg),
    }
    if forces.pressure:
        figures[PRESSURE] = worst(forces.pressure, "N/mm^2")
    guides = [extreme for name, pair in forces.reactions.items() if name.startswith("guide") for extreme in pair]
    if guides:
        end = max(guides, key=lambda extreme: abs(extreme.value))
        figures[GUIDE_FORCE] = Measured(abs(end.value), "N", end.at_deg)
    means = [mean[0] for k in range(len(names)) if (mean := running.mean_force(k)) is not None]
    if means:
        figures[MEAN_FORCE] = Measured(max(means), "N")
    return figures


def _range(extremes: tuple[ExtremeAtAngle, ExtremeAtAngle], unit: str) -> dict[str, object]:
    least, most = extremes
    return {
        "min": least.value,
        "max": most.value,
        "unit": unit,
        "min_at_deg": least.at_deg,
        "max_at_deg": most.at_deg,
    }
