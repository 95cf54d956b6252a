"""Grooves of several turns, which cross themselves: against pins by positions alone, worked numbers, and planted faults.

Holds: camgeo.capabilities.cylindrical.crossings, camgeo.capabilities.cylindrical.patches,
camgeo.capabilities.cylindrical.sweep, camgeo.capabilities.cylindrical.shoe.
"""

from __future__ import annotations

import math
import random
import re
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import changed, design_of, recipe_of
from support.heavy import trimesh

from camgeo.capabilities.cylindrical.checks_of import walls
from camgeo.capabilities.cylindrical.crossings import meetings
from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.figures import figures_of, volume
from camgeo.capabilities.cylindrical.making import foresee
from camgeo.capabilities.cylindrical.shoe import half_width, longest
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.capabilities.cylindrical.tables import flank_table
from camgeo.common.clock import Clock
from camgeo.files.mesh import Mesh
from camgeo.output.extension import numbers_of
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign

TURN = 2.0 * math.pi
PARTS = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=float)
PARTS /= PARTS.sum(axis=1)[:, None]

Row = tuple[float, float, float, float]  # lift gained, degrees, and degrees of the blends at its ends


class Pins:
    """Lift over several turns by positions, from rows of constant velocity between blends, and where a pin has been."""

    def __init__(self, rows: Sequence[Row], radius: float) -> None:
        self.rows, self.radius = rows, radius
        self.turns = round(sum(row[1] for row in rows) / 360.0)

    def __call__(self, theta: np.ndarray) -> np.ndarray:
        """Lift, mm, at shaft angles, rad."""
        degrees = np.mod(np.degrees(theta), 360.0 * self.turns)
        lift, begin, level = np.zeros_like(degrees), 0.0, 0.0
        for gain, over, first, last in self.rows:
            t = np.clip(degrees - begin, 0.0, over)
            rate = gain / (over - 0.5 * (first + last))
            x, y = np.clip(t / max(first, 1e-9), 0.0, 1.0), np.clip((over - t) / max(last, 1e-9), 0.0, 1.0)
            begins = 0.5 * rate * first * (2 * x**3 - x**4) + rate * np.maximum(t - first, 0.0)
            ends = gain - 0.5 * rate * last * (2 * y**3 - y**4)
            inside = (degrees >= begin) & (degrees < begin + over)
            lift = np.where(inside, level + np.where(t < over - last, begins, ends), lift)
            begin, level = begin + over, level + gain
        return lift

    def away(self, points: np.ndarray, level: float) -> np.ndarray:
        """Distance (n, turns), mm, of places (n, 3) from the pin nearest to them in each turn; below 0 within it."""
        r, phi, z = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0]), points[:, 2] - level
        found = np.empty((len(points), self.turns))
        for turn in range(self.turns):
            middle, half = phi + TURN * turn, 1.6 * self.radius / r
            for _ in range(5):
                theta = middle[:, None] + half[:, None] * np.linspace(-1.0, 1.0, 25)
                off = np.hypot(r[:, None] * np.sin(theta - phi[:, None]), z[:, None] - self(theta))
                best = np.argmin(off, axis=1)
                middle, half = theta[np.arange(r.size), best], half / 8.0
            found[:, turn] = off.min(axis=1) - self.radius
        return found


def faults(mesh: Mesh, design: DrumDesign, pins: Pins, parts: np.ndarray = PARTS) -> list[str]:
    """What is wrong with a solid: open, metal where a pin has been, or a wall where none has touched it."""
    recipe, slack = design.recipe, design.recipe.export.tolerance
    points = np.einsum("wc,tcx->twx", parts, mesh.points[mesh.triangles]).reshape(-1, 3)
    if recipe.rotation == "ccw":
        points = points * np.array([1.0, -1.0, 1.0])
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    outside = (r > recipe.floor + slack) & (z > slack) & (z < recipe.height - slack)
    away = np.full(len(points), np.inf)
    near = r > recipe.floor - slack
    away[near] = pins.away(points[near], recipe.level).min(axis=1)
    wall = outside & (r < recipe.radius - slack)
    floor = near & ~outside & (z > slack) & (z < recipe.height - slack)
    found = [] if trimesh.Trimesh(mesh.points, mesh.triangles, process=False).is_watertight else ["open"]
    found += ["metal in a pin's way"] if (away[outside] < -slack).any() else []
    found += ["a wall that no pin touches"] if (away[wall] > slack).any() else []
    found += ["a floor where no pin has been"] if (away[floor] > slack).any() else []
    found += ["beyond the blank"] if (r > recipe.radius + slack).any() else []
    return found


def held(design: DrumDesign) -> Mesh:
    """The solid in the precision of an STL."""
    return drum_mesh(design, design.recipe.export.tolerance, numbers_of("stl", 1.0))[0]


def text_of(rows: Sequence[Row], *, radius: float, depth: float, width: float, length: float, more: str = "") -> str:
    """Recipe of rows; its lowest place lies width and 3 mm over the lower face, its highest as far below the upper."""
    low = width + 3.0
    stroke = float(max(np.cumsum([row[0] for row in rows])))
    turns = round(sum(row[1] for row in rows) / 360.0)
    motion = ", ".join(
        f"{{{'rise' if gain > 0 else 'return'}: {abs(gain)!r}, over: {over!r}, law: {{uniform: {{blend: [{a!r}, {b!r}]}}}}}}"
        for gain, over, a, b in rows
    )
    return (
        f"{more}cam:\n  kind: cylindrical\n  radius: {radius!r}\n  turns: {turns}\n"
        f"  track: {{groove: {{depth: {depth!r}}}}}\n"
        f"  follower: {{kind: shoe, width: {width!r}, length: {length!r}}}\n  pitch_height: {low!r}\n"
        f"  motion: [{motion}]\npart: {{length: {stroke + 2.0 * low!r}, bore: 10}}\n"
        "export: {tolerance: 0.05, files: [stl]}\n"
    )


BRUTE = "places all over a solid are held against pins at all angles of several turns"
SCREW_ROWS: list[Row] = [(55.0, 1080.0, 90.0, 90.0), (-55.0, 1080.0, 90.0, 90.0)]
SCREW = text_of(SCREW_ROWS, radius=30.0, depth=6.0, width=10.0, length=55.0)
"""The screw of the worked case, 20 mm a turn, with reversals."""
SPIRAL_ROWS: list[Row] = [(60.0, 1080.0, 60.0, 80.0), (-60.0, 360.0, 80.0, 60.0)]
SPIRAL = text_of(SPIRAL_ROWS, radius=40.0, depth=6.0, width=8.0, length=26.0, more="rotation: ccw\n")


@cache
def screw() -> DrumDesign:
    """The screw, made once."""
    return design_of(SCREW)


@cache
def solid() -> Mesh:
    """Its solid, made once."""
    return held(screw())


# --- worked numbers ---------------------------------------------------------------------------------------------------


def test_tracks_cross_where_the_worked_case_has_them() -> None:
    """Half a turn and 10 mm apart; at 20 mm a turn a gap at r = 30 is 47.6544062808 mm long (c14)."""
    law = screw().law
    found = sorted(meetings(screw().flanks["lower"]))
    assert np.degrees([at for at, _ in found]) == pytest.approx([180, 360, 540, 720, 900], abs=1e-9)
    heights = law.derivatives(np.array([at for at, _ in found]), 0)[0]
    assert heights == pytest.approx([7.5, 17.5, 27.5, 37.5, 47.5], abs=1e-9)
    # square to its path a groove is wider than the roller by R^3 sin^4 a/(3 r^2)
    lead = math.atan(10.0 / math.pi / 30.0)
    wide = 47.6544062808 * (1.0 + 125.0 * math.sin(lead) ** 4 / (3.0 * 30.0**2) / 10.0)
    assert wide == pytest.approx(47.6544062808, abs=3e-5)
    assert [crossing.gap(30.0) for crossing in screw().crossings] == pytest.approx([wide] * 5, abs=2e-7)
    inner = 10.0 / math.sin(2.0 * math.atan(10.0 / math.pi / 24.5))
    assert [crossing.gap(24.5) for crossing in screw().crossings] == pytest.approx([inner] * 5, rel=3e-6)
    figures = {figure.name: figure.value for figure in figures_of(screw())}
    assert figures["crossings"] == 5
    assert figures["crossing-angle"] == pytest.approx(math.degrees(2.0 * math.atan(10.0 / math.pi / 30.0)), abs=1e-9)
    assert figures["crossing-gap"] == max(crossing.gap(30.0) for crossing in screw().crossings)


def test_the_play_of_a_shoe_in_a_crossing_is_what_its_arcs_leave() -> None:
    """By the circle through both tips and the middle of a side, drawn anew."""
    length, width, gap = 55.0, 10.0, max(screw().gaps)
    (x0, y0), (x1, y1) = (0.0, 0.5 * width), (0.5 * length, 0.0)
    centre = (x1 * x1 + y1 * y1 - x0 * x0 - y0 * y0) / (2.0 * (y1 - y0))  # on the line x = 0
    size = abs(y0 - centre)
    across = centre + math.sqrt(size * size - 0.25 * gap * gap)
    assert half_width(screw(), 0.5 * gap) == pytest.approx(across, abs=1e-12)
    assert half_width(screw(), 0.5 * length) == pytest.approx(0.0, abs=1e-12)
    play = {figure.name: figure.value for figure in figures_of(screw())}["shoe-play"]
    assert play == pytest.approx(0.5 * width - across, abs=1e-12)


def boat_stands_in(pins: Pins, at: float, rho: float, length: float) -> float:
    """How deep a boat, its middle on the path and turned as best it may, stands in walls, mm, unrolled at rho.

    Along the walls are all places whose distance from the path is half the width; nothing else is known of them.
    """
    t = at + np.linspace(-0.75, 0.75, 6001) * length / rho
    path = np.column_stack([rho * (t - at), pins(t) - pins(np.array([at]))])
    half = pins.radius
    size = 0.5 * (0.25 * length**2 / half + half)
    x = np.linspace(-0.5 * length, 0.5 * length, 161)
    side = np.sqrt(size * size - x * x) - (size - half)
    best = math.inf
    slope = math.atan(np.gradient(path[:, 1], path[:, 0])[3000])
    for turn in slope + np.linspace(-2e-3, 2e-3, 9):
        c, s = math.cos(turn), math.sin(turn)
        deep = 0.0
        for sign in (1.0, -1.0):
            y = sign * side
            places = np.column_stack([c * x - s * y, s * x + c * y])
            away = np.sqrt(((places[:, None, :] - path[None, ::6, :]) ** 2).sum(axis=2)).min(axis=1)
            deep = max(deep, float(away.max()) - half)
        best = min(best, deep)
    return best


def test_the_longest_shoe_passes_the_bend_and_a_longer_one_jams() -> None:
    """By positions: a boat at the bend stands in the wall if and only if it is longer than the bound."""
    design = screw()
    bend = longest(design)
    pins = Pins(SCREW_ROWS, 5.0)
    rho = design.recipe.roller.inner
    assert boat_stands_in(pins, bend.at, rho, 0.995 * bend.length) < 2e-5
    assert boat_stands_in(pins, bend.at, rho, 1.4 * bend.length) > 1e-3


# --- solids by positions ----------------------------------------------------------------------------------------------


@pytest.mark.costly(BRUTE)
def test_a_screw_is_metal_exactly_where_no_pin_has_been() -> None:
    """Walls are touched by a pin, and missing where that of another turn has been; a closed body."""
    mesh = solid()
    assert faults(mesh, screw(), Pins(SCREW_ROWS, 5.0)) == []
    body = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    assert body.euler_number == 0  # a ring about the bore, whose gaps are no tunnels
    fine = drum_mesh(screw(), 0.005, numbers_of("stl", 1.0))[0]
    assert volume(screw()) == pytest.approx(trimesh.Trimesh(fine.points, fine.triangles).volume, rel=2e-4)


@pytest.mark.costly(BRUTE)
def test_a_spiral_with_a_quick_return_is_metal_where_no_pin_has_been() -> None:
    """The other way round, too, and with tracks that cross at unlike slopes."""
    design = design_of(SPIRAL)
    mesh = held(design)
    assert faults(mesh, design, Pins(SPIRAL_ROWS, 4.0)) == []


@pytest.mark.costly(BRUTE)
@pytest.mark.parametrize(
    ("plant", "told"),
    [
        ("vertex", "metal in a pin's way"),
        ("turned", "metal in a pin's way"),
        ("larger pin", "metal in a pin's way"),
        ("smaller pin", "a wall that no pin touches"),
        ("later return", "metal in a pin's way"),
        ("hole", "open"),
        ("scaled", "beyond the blank"),
    ],
)
def test_planted_faults_are_seen(plant: str, told: str) -> None:
    """The oracle refuses a solid that is wrong."""
    mesh, rows, radius = solid(), SCREW_ROWS, 5.0
    points, triangles = mesh.points.copy(), mesh.triangles
    if plant == "vertex":
        recipe = screw().recipe
        r = np.hypot(points[:, 0], points[:, 1])
        away = Pins(rows, radius).away(points, recipe.level).min(axis=1)
        inside = (r > recipe.floor + 1.0) & (r < recipe.radius - 1e-3) & (abs(away) < 0.1)
        k = int(np.flatnonzero(inside if inside.any() else (r > recipe.radius - 1e-3) & (abs(away) < 0.1))[0])
        flank_up = points[k, 2] + np.array([0.4, -0.4])
        tried = np.array([[*points[k, :2], z] for z in flank_up])
        points[k, 2] = flank_up[int(np.argmin(Pins(rows, radius).away(tried, recipe.level).min(axis=1)))]
    elif plant == "turned":
        c, s = math.cos(0.05), math.sin(0.05)
        points = points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    elif plant == "scaled":
        points = points * 1.01
    elif plant == "hole":
        triangles = triangles[:-1]
    elif plant == "later return":
        rows = [(55.0, 1100.0, 90.0, 110.0), (-55.0, 1060.0, 90.0, 70.0)]
    else:
        radius = 5.2 if plant == "larger pin" else 4.8
    assert told in faults(Mesh(points, triangles), screw(), Pins(rows, radius), PARTS[:4])


def random_track(rng: random.Random) -> tuple[list[Row], str]:
    """Rows of a random screw, or of a spiral with a quick return, and the text of its recipe."""
    radius = rng.uniform(25.0, 45.0)
    depth, width = rng.uniform(0.12, 0.2) * radius, rng.uniform(0.15, 0.25) * radius
    out = rng.choice([2, 3, 4])
    back = out if rng.random() < 0.5 else rng.choice([1, 2])
    stroke = out * width * rng.uniform(1.9, 2.6)
    shift = rng.uniform(-60.0, 60.0)
    blends = [rng.uniform(60.0, 100.0) for _ in range(4)]
    rows = [(stroke, out * 360.0 + shift, *blends[:2]), (-stroke, back * 360.0 - shift, *blends[2:])]
    more = "rotation: ccw\n" if rng.random() < 0.5 else ""
    return rows, text_of(rows, radius=radius, depth=depth, width=width, length=width * rng.uniform(2.0, 5.0), more=more)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_random_tracks_are_metal_where_no_pin_has_been(seed: int) -> None:
    """Screws and spirals; a shoe that does not serve is given the length that its error names."""
    rng = random.Random(700 + seed)
    for _ in range(60):
        rows, text = random_track(rng)
        try:
            design = design_of(text)
        except RecipeErrors as error:
            named = re.search(r"(?:give a shoe of|give at most) ([\d.]+) mm", str(error))
            if named is None:  # undercut, no wall between turns, or no shoe that serves
                assert re.search("undercut|run into one another|reach into|ridge|more lift a turn|wider bend", str(error))
                continue
            design = design_of(re.sub(r"length: [\d.]+}", f"length: {named[1]}}}", text, count=1))
        assert faults(held(design), design, Pins(rows, design.recipe.roller.radius)) == []
        return
    raise AssertionError("no random track was made")


# --- walls, tables, refusals ------------------------------------------------------------------------------------------


def test_the_wall_between_turns_is_the_lift_of_a_turn_less_the_groove() -> None:
    """In the stretch of constant velocity helices of the lead a are p cos a apart, less the groove's width."""
    design = design_of(SPIRAL)
    (found,) = [wall for wall, where in walls(design) if "between neighbouring turns" in where]
    rate = 60.0 / (1080.0 - 70.0)  # mm a degree
    lead = math.atan(math.degrees(rate) / design.recipe.floor)
    assert found == pytest.approx(360.0 * rate * math.cos(lead) - 8.0, abs=2e-3)
    assert not [where for _, where in walls(screw()) if "between neighbouring turns" in where]  # they end in points


def test_rows_of_the_table_that_a_crossing_cuts_away_are_empty() -> None:
    """Where a place of one turn's flank is inside the pin of another turn, and nowhere else."""
    design, pins = screw(), Pins(SCREW_ROWS, 5.0)
    theta = np.arange(0.0, 12.0 * math.pi, math.radians(4.0))
    names, rows = flank_table(design, theta, 1.0, "mm")
    for name, flank in design.flanks.items():
        columns = [names.index(f"{name}_{key}") for key in ("r_mm", "phi_deg", "z_mm")]
        inner = np.arange(3 * theta.size) % 3 == 0  # at the shoe's inner end
        contact = flank.along(theta, np.full(theta.size, 24.5))
        points = np.column_stack(
            [contact.r * np.cos(contact.phi), contact.r * np.sin(contact.phi), contact.z]
        )
        away = pins.away(points, design.recipe.level).min(axis=1)
        clear = abs(away) > 2e-3
        empty = np.isnan(rows[inner][:, columns]).all(axis=1)
        assert empty.any()
        assert ((away < 0.0) == empty)[clear].all()
        assert np.isclose(away[~empty], 0.0, atol=1e-4).all()


SHOE = "{kind: shoe, width: 10.0, length: 55.0}"


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (SHOE, "{radius: 5}", "cam.follower: a wall of the groove is missing over 47.6544 mm where its tracks cross"),
        ("length: 55.0}", "length: 47}", "cam.follower.length: a wall of the groove is missing over 47.6544 mm"),
        ("length: 55.0}", "length: 95}", "cam.follower.length: the shoe jams in the bend near"),
    ],
)
def test_a_follower_that_does_not_pass_is_refused_with_one_that_does(old: str, new: str, told: str) -> None:
    """The remedy's length serves, and names the angles of crossings."""
    with pytest.raises(RecipeErrors) as refused:
        design_of(changed(SCREW, (old, new)))
    text = str(refused.value)
    assert told in text
    if "missing" in text:
        assert re.search(r"at \d+ and \d+; \d+ and \d+; \d+ and \d+ degrees of the shaft, and 2 more", text)
    (length,) = re.findall(r"(?:a shoe of|at most) ([\d.]+) mm", text)
    assert design_of(changed(SCREW, (SHOE, f"{{kind: shoe, width: 10, length: {length}}}"))).crossings


def test_demands_that_contradict_say_what_to_change() -> None:
    """A sharp reversal takes no shoe as long as the gap; the same with wider blends does."""
    sharp = SCREW.replace("90.0, 90.0", "12.0, 12.0")
    with pytest.raises(RecipeErrors, match=r"a shoe of at most .* passes the bend .* gap of .* needs a longer one: give more lift a turn, a wider"):
        design_of(sharp)
    assert design_of(sharp.replace("12.0, 12.0", "60.0, 60.0"))


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        ([("1080.0", "680.0"), ("}, {return", "}, {dwell: 400}, {return")], "two turns of the groove are one over a stretch"),
        ([("rise: 55.0", "rise: 20.0"), ("return: 55.0", "return: 20.0")], "neighbouring turns of the groove run into one"),
        ([("turns: 6", "turns: 5")], "let them cover 5 turns, 1800 degrees; a track of several turns has cam.turns"),
        ([("turns: 6", "turns: 0")], "cam.turns"),
        ([("turns: 6", "turns: 2.5")], "cam.turns"),
        ([("groove: {depth: 6.0}", "rib: {depth: 6.0, distance: 30}")], "the turns of a rib would cross"),
        ([("{groove: {depth: 6.0}}", "{end: top}")], "the turns of an end face would cross"),
        ([("turns: 6", "turns: 6\n  undercut: shorten")], "cam.undercut: an undercut that shortens a track of several"),
        ([("width: 10.0, length", "radius: 5, length")], "cam.follower.length: cannot be combined with radius"),
        ([("width: 10.0, length: 55.0", "radius: 5")], "cam.follower.radius: does not go with a shoe"),
        ([("kind: shoe, ", "")], "cam.follower.width: does not go with a roller; give kind: shoe"),
        ([("length: 55.0}", "length: 9}")], "cam.follower.length: a shoe is longer than it is wide"),
        ([("length: 55.0}", "length: 55, offset: 2}")], "cam.follower.offset: does not go with a shoe"),
        ([("length: 55.0}", "length: 55, taper: 5}")], "cam.follower.taper: does not go with a shoe"),
    ],
)
def test_recipes_of_several_turns_with_a_fault(pairs: list[tuple[str, str]], told: str) -> None:
    """One clear error with its field."""
    with pytest.raises(RecipeErrors) as refused:
        design_of(changed(SCREW, *pairs))
    assert told in str(refused.value)


def test_step_of_several_turns_is_refused_with_what_serves() -> None:
    recipe = recipe_of(changed(SCREW, ("[stl]", "[step]")))
    with pytest.raises(RecipeErrors, match="crosses itself, is not made yet; give stl, 3mf or ply"):
        foresee(designed(recipe, Clock()), recipe.export.files[0])
