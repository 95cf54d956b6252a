"""The page's plots of a rigid follower train over a turn: load, forces, torque, pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.figures import FORCE_GREATEST, FORCE_LEAST, PRESSURE, TORQUE
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.report.page.curves import limits, short, shown_unit
from camgeo.report.page.followers import SHAFT
from camgeo.report.plot import Plot, Series
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array


def plots(recipe: Recipe, design: Design) -> list[Plot]:
    """Return the plots of load, forces, torque and contact pressure over the turn, in pounds for a recipe in inches.

    Empty without dynamics, for an elastic train whose contacts have no material, and where the stem jams. Raises
    RecipeErrors for a contact that nothing holds on the cam, a linkage that does not turn right round, a load without
    a finite value, and two preloaded contacts that wedge the stem.
    """
    running = running_of(recipe, design)
    if running is None or running.jam_deg is not None:
        return []
    state, note = running.state(SHAFT), f"at {running.train.rpm:g} rpm, of a rigid follower"

    def plot(title: str, axis: str, si: str, rows: Mapping[str, Array], sides: Mapping[str, Sequence[float]]) -> Plot:
        factor, unit = shown_unit(recipe, si)
        series = tuple(Series(name, factor * row) for name, row in rows.items())
        lines = limits(recipe, sides, series, factor)
        return Plot(title, unit, series, limits=lines, dwells=True, note=note, axis=axis, holds=(0.0,))

    def opposite(title: str, axis: str, si: str, rows: Array, sides: Mapping[str, Sequence[float]]) -> list[Plot]:
        """Return one plot for one or two contacts, and two plots, each of two opposite faces, for four contacts."""
        named = list(zip(running.turn.names, rows, strict=True))
        step = max(1, len(named) // 2)
        groups = [dict(named[k::step]) for k in range(step)]
        titles = [title if step == 1 else f"{title}, {' and '.join(group)}" for group in groups]
        return [plot(name, axis, si, group, sides) for name, group in zip(titles, groups, strict=True)]

    load = running.load(SHAFT)
    drawn = [plot("Load", "load", running.turn.unit, {"load against the follower": load}, {})] if load.any() else []
    drawn += opposite("Contact force", "force", "N", state.normal, {FORCE_GREATEST: (1.0,), FORCE_LEAST: (1.0,)})
    drawn.append(plot("Torque of the shaft", "torque", "N m", {"torque": state.torque}, {TORQUE: (1.0, -1.0)}))
    if recipe.linkage is not None:
        across, along, *joints = state.reactions.items()
        drawn.append(plot("Forces of the frame", "force", "N", dict([across, along]), {}))
        if joints:
            drawn.append(plot("Forces at joint D", "force", "N", dict(joints), {}))
    if state.pressure is not None:
        pressed = opposite("Contact pressure", "pressure", "N/mm^2", state.pressure, {PRESSURE: (1.0,)})
        most, (factor, _) = running.most_pressure, shown_unit(recipe, "N/mm^2")
        borne = () if most is None else ((factor * most, f"material {short(factor * most)}"),)
        drawn += [replace(pressure, limits=(*pressure.limits, *borne)) for pressure in pressed]
    return drawn
