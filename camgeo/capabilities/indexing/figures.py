"""Figures of an indexing cam, each with its shaft angle: of the exact flanks, of the turret in time, of its load.

Figures of flanks and loads are sampled over the turn, and narrowed about the greatest sample. Velocity and acceleration
are proved extremes of the motion.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.engaged import Engaged
from camgeo.capabilities.indexing.keys import ANY, INNER, LEAST, LENGTH, MIDDLE, MOST_ENGAGED, OUTSIDE, RIB
from camgeo.capabilities.indexing.tracks import removed, rib_thickness
from camgeo.curve.extremes import both
from camgeo.measures.hertz import bearable, line_pressure
from camgeo.measures.placed import Figure
from camgeo.recipe.figures import PRESSURE_ANGLE
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array

    Rows = Mapping[str, Engaged]
    Figured = Callable[[Rows], Array]

MINUTE = 60.0
SEEK, ZOOMS, ABOUT = 720, 4, 25  # places of a turn at which a figure is sought, and about the greatest one, so often
LAYERS = 12  # of Gauss between floor and blank, over which a volume is integrated
BEYOND = 1e-9  # rad that a place of a figure lies beside a break


def figures_of(design: IndexDesign) -> list[Figure]:
    """All figures that a design has, in the order of reports."""
    search = Search(design)
    found = [
        search.angle(name, partial(_steepest, share=share))
        for name, share in ((PRESSURE_ANGLE, (0.0, 1.0)), (MIDDLE, (0.5,)), (INNER, (0.0,)), (OUTSIDE, (1.0,)))
    ]
    found.append(search.angle(ANY, _any))
    found.append(contact_length(search))
    for name, sign in ((LEAST, -1.0), (MOST_ENGAGED, 1.0)):
        value, at = search.greatest(partial(_engaged, sign=sign))
        found.append(Figure(name, sign * value, "", at))
    thin, at = rib_thickness(design)
    found.append(Figure(RIB, thin, "mm", math.degrees(at) % 360.0))
    if design.recipe.clearance > 0.0:
        found.append(search.angle("play", partial(_play, clearance=design.recipe.clearance)))
    bend, at = search.greatest(lambda rows: -_least(rows, lambda each: -each.curvature.max(axis=1)))
    found.append(Figure("mating-radius", 1.0 / bend if bend > 0.0 else math.inf, "mm", at))
    return [*found, *_driven(design), *_loaded(design, search), *_heavy(design)]


class Search:
    """Greatest values of figures over the turn of a design: sampled, and narrowed about the greatest sample."""

    def __init__(self, design: IndexDesign) -> None:
        """Sample the turn, on both sides of each break."""
        self.design = design
        breaks = design.law.breaks
        beside = np.mod(np.concatenate([breaks - BEYOND, breaks + BEYOND]), TURN)
        self.theta = np.sort(np.concatenate([np.arange(SEEK) * (TURN / SEEK), beside]))
        self._turn = self.rows(self.theta)

    def rows(self, theta: Array) -> dict[str, Engaged]:
        """Lines of contact of both flanks at shaft angles (n,), rad."""
        return {name: Engaged(self.design, name, theta) for name in self.design.flanks}

    def greatest(self, figure: Figured) -> tuple[float, float]:
        """Greatest value of a figure of such lines, (n,), nan where there is none, and its shaft angle, degrees."""
        theta, values = self.theta, _known(figure(self._turn))
        i = int(np.argmax(values))
        best, place, step = float(values[i]), float(theta[i]), TURN / SEEK
        for _ in range(ZOOMS):
            theta = place + np.linspace(-step, step, ABOUT)
            values = _known(figure(self.rows(theta)))
            i = int(np.argmax(values))
            if values[i] > best:
                best, place = float(values[i]), float(theta[i])
            step = 2.0 * step / (ABOUT - 1)
        return best, math.degrees(place) % 360.0

    def angle(self, name: str, figure: Figured) -> Figure:
        """Figure of an angle, from its values in rad."""
        value, at = self.greatest(figure)
        return Figure(name, math.degrees(value) if value > -math.inf else math.nan, "deg", at)


def contact_length(search: Search) -> Figure:
    """Least length, mm, over the turn, of the longest line along which a flank bears on a roller."""
    value, at = search.greatest(lambda rows: -_least(rows, lambda each: each.length.max(axis=1)))
    return Figure(LENGTH, -value, "mm", at)


def _known(values: Array) -> Array:
    return np.where(np.isnan(values), -np.inf, values)


def _least(rows: Rows, figure: Callable[[Engaged], Array]) -> Array:
    """The lesser of the values (n,) of both flanks."""
    return np.asarray(np.min([figure(each) for each in rows.values()], axis=0))


def _most(rows: Rows, figure: Callable[[Engaged], Array]) -> Array:
    return -_least(rows, lambda each: -figure(each))


def _steepest(rows: Rows, share: tuple[float, ...]) -> Array:
    """Greatest pressure angle (n,), rad, of the best placed roller at shares of its line, on the worse flank."""

    def angle(each: Engaged) -> Array:
        own = np.arange(each.theta.size), each.best[0]
        places = [each.ends[0] + part * each.length for part in share]
        return np.asarray(np.max([_known(each.pressure(rho)[own]) for rho in places], axis=0))

    return _most(rows, angle)


def _any(rows: Rows) -> Array:
    """Greatest pressure angle (n,), rad, of all rollers: along a line it is greatest at an end."""

    def angle(each: Engaged) -> Array:
        return np.asarray(np.max([_known(each.pressure(rho)) for rho in each.ends], axis=0).max(axis=1))

    return _most(rows, angle)


def _engaged(rows: Rows, sign: float) -> Array:
    return _most(rows, lambda each: sign * each.bears.sum(axis=1))


def _play(rows: Rows, clearance: float) -> Array:
    """Play of the turret (n,), rad: the clearance over the longest lever of the upper flank's contacts."""
    each = rows["upper"]
    levers = [np.where(each.bears, each.lever(rho), 0.0) for rho in each.ends]
    with np.errstate(divide="ignore"):
        return np.asarray(clearance / np.max(levers, axis=0).max(axis=1))


# --- in time, under load ----------------------------------------------------------------------------------------------


def steepest(design: IndexDesign, order: int) -> tuple[float, float]:
    """Greatest magnitude of a derivative of S of an order, rad, and its shaft angle, rad."""

    def figure(tau: Series, side: Side = 1) -> Series:
        s = design.law.turn.on(tau, side)
        for _ in range(order):
            s = s.derivative()
        return s

    knots = design.law.turn.knots
    low, high = both(figure, np.column_stack([knots[:-1], knots[1:]]))
    worst = high if high.value >= -low.value else low
    return abs(worst.value), worst.at


def _driven(design: IndexDesign) -> list[Figure]:
    """Greatest velocity and acceleration of the turret in time."""
    rpm = design.recipe.drive.rpm
    if rpm is None:
        return []
    rate, found = rpm * TURN / MINUTE, []
    for order, name, per in ((1, "velocity", "/s"), (2, "acceleration", "/s^2")):
        value, at = steepest(design, order)
        found.append(Figure(name, math.degrees(value * rate**order), f"deg{per}", math.degrees(at)))
    return found


def turret_torque(design: IndexDesign, theta: Array) -> tuple[Array, Array]:
    """Torque on the turret (n,), N m, and that of the cam, by virtual work: (load + J psi'' Omega^2) psi'."""
    drive = design.recipe.drive
    rate = (drive.rpm or 0.0) * TURN / MINUTE
    _, first, second = design.law.derivatives(theta, 2)
    torque = (drive.load or 0.0) + (drive.inertia or 0.0) * second * rate * rate
    return torque, torque * first


def _loaded(design: IndexDesign, search: Search) -> list[Figure]:
    """Torques, N m, the force of the contact, N, and its pressure, N/mm^2.

    At each shaft angle one roller carries the torque alone: that which it loads least by the mm of its line of contact.
    A torque that drives the turret on is borne by the lower flank, one that holds it back by the upper flank.
    """
    drive = design.recipe.drive
    if drive.load is None and (drive.inertia is None or drive.rpm is None):
        return []

    def torques(rows: Rows) -> tuple[Array, Array]:
        return turret_torque(design, rows["lower"].theta)

    def borne(rows: Rows, of: Callable[[Engaged, Array, Array], Array]) -> Array:
        torque = 1e3 * torques(rows)[0]
        values = {name: of(each, each.best[0], np.abs(torque)) for name, each in rows.items()}
        found: Array = np.where(torque >= 0.0, values["lower"], values["upper"])
        return np.where(np.isfinite(found), found, np.nan)

    def force(each: Engaged, index: Array, torque: Array) -> Array:
        own = np.arange(index.size), index
        return np.where(each.bears[own], torque / each.levers[own], np.nan)

    found = []
    for k, name in enumerate(("turret-torque", "torque")):
        value, at = search.greatest(lambda rows, k=k: np.abs(torques(rows)[k]))  # type: ignore[misc]
        found.append(Figure(name, value, "N m", at))
    value, at = search.greatest(lambda rows: borne(rows, force))
    found.append(Figure("contact-force", value, "N", at))
    if drive.material is None:
        return found
    cam, roller = drive.material, drive.roller_material or drive.material

    def pressed(each: Engaged, index: Array, torque: Array) -> Array:
        bend = each.curvature[np.arange(index.size), index]
        with np.errstate(invalid="ignore"):  # no roller bears, and `borne` leaves it out
            return line_pressure(torque * each.best[1] * bend, np.ones_like(torque), 1.0, cam, roller)

    value, at = search.greatest(lambda rows: borne(rows, pressed))
    return [*found, Figure("contact-pressure", value, "N/mm^2", at)]


def bears(design: IndexDesign) -> float | None:
    """Permissible pressure of the contact, N/mm^2: the lesser of both materials; None where neither states one."""
    drive = design.recipe.drive
    return bearable(drive.material, drive.roller_material)


# --- volume -----------------------------------------------------------------------------------------------------------


def _heavy(design: IndexDesign) -> list[Figure]:
    density = design.recipe.part.density
    return [] if density is None else [Figure("mass", volume(design) * density * 1e-9, "kg")]


def volume(design: IndexDesign) -> float:
    """Volume of the exact cam, mm^3: the blank, less what the rollers take out layer by layer, less the bore."""
    recipe = design.recipe
    low, high = recipe.layers
    node, weight = np.polynomial.legendre.leggauss(LAYERS)
    taken = [removed(design, w) for w in (low + 0.5 * (high - low) * (node + 1.0)).tolist()]
    bore = 0.0 if design.bore is None else design.bore.outline.area
    return recipe.form.volume - bore * recipe.length - 0.5 * (high - low) * float(weight @ taken)
