"""Grooves of several turns, which cross themselves: by pins at positions alone, worked numbers, planted faults.

Holds: camgeo.capabilities.cylindrical.crossings, camgeo.capabilities.cylindrical.patches,
camgeo.capabilities.cylindrical.filling, camgeo.capabilities.cylindrical.shoe.
"""

from __future__ import annotations

import math
import random
import re
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import changed, design_of, shared_design
from capabilities.cylindrical.wound_drums import (
    SCREW,
    SCREW_ROWS,
    SPIRAL,
    SPIRAL_ROWS,
    Pins,
    Row,
    random_track,
    text_of,
)
from support.heavy import trimesh

import camgeo
from camgeo.capabilities.cylindrical.checks_of import walls
from camgeo.capabilities.cylindrical.crossings import meetings
from camgeo.capabilities.cylindrical.figures import figures_of, volume
from camgeo.capabilities.cylindrical.shoe import longest
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.capabilities.cylindrical.tables import flank_table
from camgeo.capabilities.cylindrical.verdicts import intended
from camgeo.files.mesh import Item, Mesh
from camgeo.output.extension import MAKING, numbers_of
from camgeo.schema.errors import RecipeErrors
from kin.cylindrical.shoe import shoe_interference

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign

PARTS = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=float)
PARTS /= PARTS.sum(axis=1)[:, None]
MIDDLES = PARTS[:1]
SHORT_ROWS: list[Row] = [(40.0, 360.0, 60.0, 169.7), (-40.0, 360.0, 60.0, 60.0)]
SHORT = text_of(SHORT_ROWS, radius=30.0, depth=5.0, width=8.0, length=24.0)
"""A groove of two turns one of whose blends begins on an edge of its crossing, where the jerk jumps."""


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


BRUTE = "places all over a solid are held against pins at all angles of several turns"
DRUMS = "corners of crossings and figures of drums of several turns, in several of them"


def screw() -> DrumDesign:
    """The screw, made once."""
    return shared_design(SCREW)


@cache
def solid() -> Mesh:
    """Its solid, made once."""
    return held(screw())


# --- worked numbers ---------------------------------------------------------------------------------------------------


@pytest.mark.costly(DRUMS)
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


@pytest.mark.costly(DRUMS)
def test_the_play_of_a_shoe_in_a_crossing_is_what_its_arcs_leave() -> None:
    """By the circle through both tips and the middle of a side, drawn anew."""
    length, width, gap = 55.0, 10.0, max(screw().gaps)
    (x0, y0), (x1, y1) = (0.0, 0.5 * width), (0.5 * length, 0.0)
    centre = (x1 * x1 + y1 * y1 - x0 * x0 - y0 * y0) / (2.0 * (y1 - y0))  # on the line x = 0
    size = abs(y0 - centre)
    across = centre + math.sqrt(size * size - 0.25 * gap * gap)
    halves = screw().recipe.roller.half_width(0.5 * np.array([gap, length]))
    assert halves.tolist() == pytest.approx([across, 0.0], abs=1e-12)
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


@pytest.mark.slow
def test_a_screw_is_metal_exactly_where_no_pin_has_been() -> None:
    """Walls are touched by a pin, and missing where that of another turn has been; a closed body."""
    mesh = solid()
    assert faults(mesh, screw(), Pins(SCREW_ROWS, 5.0)) == []
    body = trimesh.Trimesh(mesh.points, mesh.triangles, process=False)
    assert body.euler_number == 0  # a ring about the bore, whose gaps are no tunnels
    fine = drum_mesh(screw(), 0.005, numbers_of("stl", 1.0))[0]
    assert volume(screw()) == pytest.approx(trimesh.Trimesh(fine.points, fine.triangles).volume, rel=2e-4)


@pytest.mark.slow
def test_a_spiral_with_a_quick_return_is_metal_where_no_pin_has_been() -> None:
    """The other way round, too, and with tracks that cross at unlike slopes."""
    design = design_of(SPIRAL)
    mesh = held(design)
    assert faults(mesh, design, Pins(SPIRAL_ROWS, 4.0)) == []


@pytest.mark.slow
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
    assert told in faults(Mesh(points, triangles), screw(), Pins(rows, radius), MIDDLES)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3, 5))
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
                reasons = "undercut|run into one another|reach into|ridge|more lift a turn|wider bend"
                if not re.search(reasons, str(error)):
                    raise
                continue
            design = design_of(re.sub(r"length: [\d.]+}", f"length: {named[1]}}}", text, count=1))
        assert faults(held(design), design, Pins(rows, design.recipe.roller.radius)) == []
        return
    raise AssertionError("no random track was made")


# --- walls, tables, refusals ------------------------------------------------------------------------------------------


def test_the_wall_between_turns_is_the_lift_of_a_turn_less_the_groove() -> None:
    """In the stretch of constant velocity helices of the lead a are p cos a apart, less the groove's width."""
    design = shared_design(SPIRAL)
    (found,) = [wall for wall, where, _ in walls(design) if "between neighbouring turns" in where]
    rate = 60.0 / (1080.0 - 70.0)  # mm a degree
    lead = math.atan(math.degrees(rate) / design.recipe.floor)
    assert found == pytest.approx(360.0 * rate * math.cos(lead) - 8.0, abs=2e-3)
    assert not [where for _, where, _ in walls(screw()) if "between neighbouring turns" in where]  # they end in points


def test_rows_of_the_table_that_a_crossing_cuts_away_are_empty() -> None:
    """Where a place of one turn's flank is inside the pin of another turn, and nowhere else."""
    design, pins = screw(), Pins(SCREW_ROWS, 5.0)
    theta = np.arange(0.0, 12.0 * math.pi, math.radians(4.0))
    names, rows = flank_table(design, theta, 1.0, "mm")
    for name, flank in design.flanks.items():
        columns = [names.index(f"{name}_{key}") for key in ("r_mm", "phi_deg", "z_mm")]
        inner = np.arange(3 * theta.size) % 3 == 0  # at the shoe's inner end
        contact = flank.along(theta, np.full(theta.size, 24.5))
        points = np.column_stack([contact.r * np.cos(contact.phi), contact.r * np.sin(contact.phi), contact.z])
        away = pins.away(points, design.recipe.level).min(axis=1)
        clear = abs(away) > 2e-3
        empty = np.isnan(rows[inner][:, columns]).all(axis=1)
        assert empty.any()
        assert ((away < 0.0) == empty)[clear].all()
        assert np.isclose(away[~empty], 0.0, atol=1e-4).all()


SHOE = "{kind: shoe, width: 10.0, length: 55.0}"


@pytest.mark.costly(DRUMS)
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
    design = shared_design(changed(SCREW, (SHOE, f"{{kind: shoe, width: 10, length: {length}}}")))
    assert design.crossings
    tolerance = design.recipe.export.tolerance
    assert shoe_interference(intended(design).follower)[0] <= tolerance


@pytest.mark.slow
@pytest.mark.parametrize(("law", "tolerance"), [("harmonic", 0.05), ("{uniform: {blend: 90}}", 0.005)])
def test_the_shoe_of_a_remedy_bridges_gaps_in_files_too(law: str, tolerance: float, tmp_path: Path) -> None:
    """In a file within the tolerance a gap may be longer; a shoe that is too short for it alone is refused before."""
    text = re.sub(r"law: \{uniform: \{[^}]*\}\}", f"law: {law}", changed(SCREW, ("length: 55.0}", "length: 30}")))
    text = re.sub(r"tolerance: [\d.]+", f"tolerance: {tolerance}", text)
    with pytest.raises(RecipeErrors) as refused:
        design_of(text)
    gap, length = (float(x) for x in re.findall(r"(?:missing over|a shoe of) ([\d.]+) mm", str(refused.value)))
    assert gap < length < gap + 0.05 + 4.0 * tolerance / math.sin(0.2)
    with pytest.raises(RecipeErrors, match=f"a solid within its tolerance, at .*give a shoe of {length:g} mm"):
        design_of(text.replace("length: 30}", f"length: {gap + 0.1 * (length - gap)}}}"))
    path = tmp_path / "screw.yaml"
    path.write_text(text.replace("length: 30}", f"length: {length}}}"), encoding="utf-8")
    report = camgeo.export(path, tmp_path / "out")
    assert report.ok, str(report)


@pytest.mark.costly(DRUMS)
def test_demands_that_contradict_say_what_to_change() -> None:
    """A sharp reversal takes no shoe as long as the gap; the same with wider blends does."""
    sharp = re.sub(r"blend: \[[^]]*\]", "blend: [8.0, 8.0]", SHORT)
    with pytest.raises(
        RecipeErrors,
        match=r"a shoe of at most .* passes the bend .* gap of .* needs a longer one: give more lift a turn, a wider",
    ):
        design_of(sharp)
    assert design_of(sharp.replace("8.0, 8.0", "60.0, 60.0"))


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        (
            [("1080.0", "680.0"), ("}, {return", "}, {dwell: 400}, {return")],
            "two turns of the groove are one over a stretch",
        ),
        (
            [("rise: 55.0", "rise: 20.0"), ("return: 55.0", "return: 20.0")],
            "neighbouring turns of the groove run into one",
        ),
        (
            [
                ("1080.0", "720.0"),
                ("1080.0", "720.0"),
                ("}, {return", "}, {dwell: 360}, {return"),
                ("}}}]", "}}}, {dwell: 360}]"),
            ],
            "cam.motion: two turns of the groove touch without crossing, near",
        ),
        (
            [("groove: {depth: 6.0}", "end: top")],
            "cam.follower.kind: a shoe is led by a groove alone, not by an end face",
        ),
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


class LawPins(Pins):
    """Pins led by the lifts of a design's motion."""

    def __init__(self, design: DrumDesign, radius: float) -> None:
        super().__init__([(0.0, 360.0 * design.recipe.turns, 0.0, 0.0)], radius)
        self.law = design.law

    def __call__(self, theta: np.ndarray) -> np.ndarray:
        return np.asarray(self.law.derivatives(theta.ravel(), 0)[0].reshape(theta.shape))


def stepped(join: float) -> str:
    """Recipe of two turns, whose acceleration jumps from one sign to the other at an angle of the rise."""
    shares = [40.0 * part / 360.0 for part in (join, 360.0 - join)]
    laws = ("[0, 0, 1]", "[0, 2, -1]")
    rises = ", ".join(
        f"{{rise: {share!r}, over: {over!r}, law: {{polynomial: {law}}}}}"
        for share, over, law in zip(shares, (join, 360.0 - join), laws, strict=True)
    )
    text = text_of(
        [(40.0, 360.0, 90.0, 90.0), (-40.0, 360.0, 90.0, 90.0)], radius=30.0, depth=5.0, width=8.0, length=24.0
    )
    return re.sub("motion: .*\n", f"motion: [{rises}, {{return: 40, over: 360, law: modified-sine}}]\n", text)


@pytest.mark.slow
def test_an_acceleration_that_jumps_on_an_edge_is_refused_and_beside_it_is_made() -> None:
    """A degree beside it, where the remedy leads, the break is a column of its own: the solid is within tolerance."""
    with pytest.raises(RecipeErrors, match="jumps on the edge of a crossing, near 204 degrees; let segments meet"):
        design_of(stepped(204.0))
    for join in (203.0, 205.0):
        design = design_of(stepped(join))
        mesh = held(design)
        assert trimesh.Trimesh(mesh.points, mesh.triangles, process=False).is_watertight
        assert faults(mesh, design, LawPins(design, 4.0), PARTS[:4]) == []


# --- from recipe to verdict -------------------------------------------------------------------------------------------


@pytest.mark.thin(3)
@pytest.mark.costly("solids of several turns are judged at all angles")
@pytest.mark.parametrize("text", [SHORT, SCREW, SPIRAL], ids=["short", "screw", "spiral"])
def test_solid_and_development_are_judged_over_all_turns(text: str, tmp_path: Path) -> None:
    """Each flank's motion within what the tolerance implies; the report has the crossings."""
    files = "[stl, {dxf: {as: development}}, {csv: {as: flank, step: 10}}, html]"
    (tmp_path / "drum.yaml").write_text(changed(text, ("[stl]", files)), encoding="utf-8")
    report = camgeo.export(str(tmp_path / "drum.yaml"), str(tmp_path / "out"))
    assert report.ok, str(report)
    held_of = {check.name for check in report.checks if check.file}
    assert {"watertight", "contour", "motion"} <= {name.partition(",")[0] for name in held_of}


@pytest.mark.slow
@pytest.mark.parametrize(
    "plant",
    [
        (
            "return: 55.0, over: 1080.0, law: {uniform: {blend: [90.0, 90.0]}}",
            "return: 55.0, over: 1080.0, law: {uniform: {blend: [70.0, 130.0]}}",
        ),
        ("cam:\n", "rotation: ccw\ncam:\n"),
    ],
)
def test_the_solid_of_another_screw_is_refused(plant: tuple[str, str], tmp_path: Path) -> None:
    """Verify with the recipe of the screw: a return with other blends, and mirrored.

    The screw's motion is its own mirror image; with an offset start that of a drum turning the other way is not.
    """
    right = changed(
        SCREW, ("motion: [", "motion: [{dwell: 40}, "), ("return: 55.0, over: 1080.0", "return: 55.0, over: 1040.0")
    )
    own = (plant[0].replace("1080.0", "1040.0"), plant[1].replace("1080.0", "1040.0"))
    (tmp_path / "wrong.yaml").write_text(changed(right, own), encoding="utf-8")
    assert camgeo.export(str(tmp_path / "wrong.yaml"), str(tmp_path / "out")).ok
    (tmp_path / "drum.yaml").write_text(right, encoding="utf-8")
    assert not camgeo.verify(str(tmp_path / "drum.yaml"), str(tmp_path / "out" / "wrong" / "wrong.stl")).ok


@pytest.mark.costly("solids of several turns are judged at all angles")
def test_a_screw_whose_crossing_is_not_open_is_refused(tmp_path: Path) -> None:
    """Metal left in one crossing, as a bar across both tracks, is in the shoe's way."""
    mesh = solid()
    crossing = screw().crossings[2]
    z = screw().recipe.level + float(screw().law.derivatives(np.array([crossing.first]), 0)[0][0])
    tip = np.array([29.0 * math.cos(crossing.first), 29.0 * math.sin(crossing.first), z])
    points, triangles = mesh.points, mesh.triangles
    near = points[triangles].mean(axis=1)
    floor = np.hypot(*near.T[:2]) < screw().recipe.floor + 0.2
    k = int(np.flatnonzero(floor)[np.argmin(np.linalg.norm(near[floor] - tip, axis=1))])
    a, b, c = triangles[k]
    n = len(points)
    more = np.array([[a, b, n], [b, c, n], [c, a, n]])
    planted = Mesh(np.vstack([points, tip]), np.vstack([np.delete(triangles, k, axis=0), more]))
    assert faults(planted, screw(), Pins(SCREW_ROWS, 5.0), MIDDLES) == ["metal in a pin's way"]
    (tmp_path / "drum.yaml").write_text(SCREW, encoding="utf-8")
    write = MAKING["stl"].write
    assert write is not None
    write(tmp_path / "planted.stl", [Item("drum", planted)], "drum", 1.0, "")
    assert not camgeo.verify(str(tmp_path / "drum.yaml"), str(tmp_path / "planted.stl")).ok
