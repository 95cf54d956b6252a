"""The page of an indexing cam: what it draws is where brute force has it, and its script draws the same; its glb.

Holds: camgeo.capabilities.indexing.ribs, camgeo.capabilities.indexing.turning, camgeo.capabilities.indexing.charts,
camgeo.capabilities.indexing.actors, camgeo.report.page.chart.
"""

from __future__ import annotations

import json
import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import (
    BARREL,
    GLOBOID,
    advance,
    changed,
    rollers_of,
    shared_design,
    window,
)
from support.browser import Browser, executable

import camgeo
from camgeo.capabilities.indexing.charts import development
from camgeo.capabilities.indexing.index_page import script
from camgeo.capabilities.indexing.ribs import layer, near
from camgeo.capabilities.indexing.turning import faced, scene, touched

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.design import IndexDesign

CCW = "rotation: ccw\n"
MIDDLE = 0.5 * (49.0 + math.sqrt(62.0**2 - 8.0**2))  # of a roller of the globoid, mm from the turret's axis
LEADING = changed(BARREL, ("roller: 9}", "roller: 9, side: leading}"))
INCHES = """units: inch
cam:
  kind: indexing
  globoid: {distance: 4, radius: 2.2}
  depth: 0.55
  turret: {stops: 8, roller: 0.35, clearance: 0.002}
  motion: [{dwell: 40}, {rise: 45, over: 200, law: cycloidal}, {dwell: 120}]
part: {length: 2.6}
export: {tolerance: 0.0004, files: [stl]}
"""
TURRETS = [
    (BARREL, 150.0, 6, 1.0, 1.0),
    (CCW + BARREL, 150.0, 6, 1.0, -1.0),
    (CCW + LEADING, 150.0, 6, -1.0, -1.0),
    (LEADING, 150.0, 6, -1.0, 1.0),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "over", "stops", "side", "sense"), TURRETS)
def test_rollers_of_a_barrel_are_where_the_dial_takes_them(
    text: str, over: float, stops: int, side: float, sense: float
) -> None:
    """To the right of the viewer counts offset - side l cos psi, to the left of a mirrored cam; up l sin psi.

    The offset is by default l (1 + cos(pi/n))/2, and half a pitch below the middle is the start.
    """
    bodies = {body.name: body for body in scene(shared_design(text)).bodies}
    offset = side * 30.0 * (1.0 + math.cos(math.pi / stops))
    for step in (0, 90, 150, 500):
        psi = -math.pi / stops + advance(np.array([math.radians(0.5 * step)]), stops, over)[0]
        angles = psi + math.tau * np.arange(stops) / stops
        wanted = np.column_stack([sense * (offset - side * 60.0 * np.cos(angles)), 40.0 + 60.0 * np.sin(angles)])
        found = []
        for shape in bodies["rollers"].shapes:
            points = bodies["rollers"].placed(shape.rings[0].flattened(), step)
            np.testing.assert_allclose(np.ptp(points, axis=0), 18.0, atol=4e-3)
            found.append(0.5 * (points.min(axis=0) + points.max(axis=0)))
        away = np.linalg.norm(wanted[:, None] - np.array(found)[None], axis=2)
        assert away.min(axis=1).max() < 3e-3
        assert sorted(away.argmin(axis=1)) == list(range(stops))


@pytest.mark.parametrize("head", ["", CCW])
def test_rollers_of_a_globoid_point_at_its_axis(head: str) -> None:
    """The cam's axis is at the left; a roller at psi reaches from 49 mm along -cos psi and sin psi.

    The rim of its end, 8 mm beside its axis, is 62 mm from the turret's.
    """
    body = next(body for body in scene(shared_design(head + GLOBOID)).bodies if body.name == "rollers")
    for step in (0, 100, 400):
        psi = -math.pi / 8.0 + advance(np.array([math.radians(0.5 * step)]), 8, 120.0)[0]
        middles, ways = [], []
        for shape in body.shapes:
            corners = body.placed(shape.rings[0].points, step)
            sides = np.linalg.norm(np.diff(corners, axis=0), axis=1)
            assert max(sides.tolist()) == pytest.approx(16.0)
            middles.append(corners.mean(axis=0))
        ways = psi + math.tau * np.arange(8) / 8.0
        wanted = np.column_stack([90.0 - MIDDLE * np.cos(ways), 30.0 + MIDDLE * np.sin(ways)])
        away = np.linalg.norm(wanted[:, None] - np.array(middles)[None], axis=2)
        assert away.min(axis=1).max() < 1e-9


def encloses(outline: np.ndarray, x: float, z: float) -> bool:
    """Whether a place lies within a closed outline, by the edges to one side of it."""
    (x0, z0), (x1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    over = (x0 <= x) != (x1 <= x)
    share = (x - x0[over]) / (x1[over] - x0[over])
    return bool(np.count_nonzero(z0[over] + share * (z1[over] - z0[over]) > z) % 2)


def seen_point(design: IndexDesign, w: float, psi: float, z: float, theta: float) -> tuple[float, np.ndarray]:
    """How far to the right a place shows, and its point on the cam as it is computed; by hand of either form."""
    recipe = design.recipe
    if recipe.turret.word == "barrel":
        r, phi = w, theta + recipe.sense * psi
    else:
        # seen along e_t, from where the polar angle is a quarter of a turn less than the shaft angle
        r, phi = 90.0 - math.sqrt(w * w - (z - 30.0) ** 2), theta + recipe.sense * (psi - 0.5 * math.pi)
    return r * math.sin(psi), np.array([[r * math.cos(phi), r * math.sin(phi), z]])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "over", "layer_at", "size"),
    [
        (BARREL, 150.0, 50.0, 9.0),
        (CCW + LEADING, 150.0, 41.0, 9.0),
        (GLOBOID, 120.0, 49.0, 8.0),
        (CCW + GLOBOID, 120.0, 60.0, 8.0),
    ],
)
def test_metal_is_seen_where_no_roller_has_been(text: str, over: float, layer_at: float, size: float) -> None:
    """On the blank and deeper, at two shaft angles, by distances from rollers at all angles alone."""
    design = shared_design(text)
    rollers = rollers_of(design, over)
    for theta in (0.0, math.radians(70.0)):
        outlines = near(layer(design, layer_at), faced(design, theta), design.recipe.sense)
        places = [
            (psi, z) for psi in np.linspace(-1.4, 1.4, 15) for z in np.linspace(1.0, design.recipe.length - 1.0, 17)
        ]
        shown = [seen_point(design, layer_at, psi, z, theta) for psi, z in places]
        points = np.concatenate([point for _, point in shown])
        # rollers do not reach through the cam's axis to its far side
        every = window(design.recipe.stops)[::4]  # half a degree
        here = points[:, :1] * np.cos(every) + points[:, 1:2] * np.sin(every) > 0.0
        away = np.where(here, rollers.away(points, every), np.inf).min(axis=1) - size
        assert (away > 0.3).sum() > 40
        assert (away < -0.3).sum() > 40
        for (x, _), (_, z), off in zip(shown, places, away.tolist(), strict=True):
            if abs(off) > 0.3:
                assert (off > 0.0) == any(encloses(outline, x, z) for outline in outlines), (theta, x, z)


def numbers(path: str) -> np.ndarray:
    return np.array(re.findall(r"-?[\d.]+", path), dtype=float).reshape(-1, 2)


@pytest.mark.parametrize(("head", "sense"), [("", 1.0), (CCW, -1.0)])
def test_places_of_the_development(head: str, sense: float) -> None:
    """Px by hand: 364 px are the turn of 314.159 mm; at the start rollers stand 60 sin(30) = 30 mm off the middle."""
    drawn = development(shared_design(head + BARREL))
    scale = 364.0 / (100.0 * math.pi)
    offset = 30.0 * (1.0 + math.cos(math.pi / 6.0))
    beside = math.asin((offset - 60.0 * math.cos(math.pi / 6.0)) / 50.0) / math.tau
    at = np.array(re.findall(r'class="roller-at" transform="translate\((-?[\d.]+) (-?[\d.]+)\)"', drawn), dtype=float)
    for z in (10.0, 70.0):
        share = beside if sense > 0.0 else 1.0 - beside
        wanted = 46.0 + 364.0 * share, 8.0 + scale * (80.0 - z)
        assert np.abs(at - wanted).max(axis=1).min() < 0.011
    # rollers of 9 mm rest at 10 and 70 mm
    edges = np.concatenate([numbers(path) for path in re.findall(r'class="line" d="([^"]+)"', drawn)])
    x = 46.0 + 364.0 * (270.0 if sense > 0.0 else 90.0) / 360.0
    heights = np.unique(np.round(80.0 - (edges[np.abs(edges[:, 0] - x) < 2.1][:, 1] - 8.0) / scale, 0))
    assert set(heights.tolist()) == {1.0, 19.0, 61.0, 79.0}


def test_a_globoid_has_curves_and_no_development() -> None:
    data = script(shared_design(GLOBOID))
    titles = [plot["title"] for plot in data["plots"]]
    assert titles == ["Turret", "Velocity", "Acceleration", "Pressure angle", "Rollers engaged"]
    assert data["player"]["data"]["rollers"] == []


def unpacked(row: dict) -> np.ndarray:
    return np.cumsum(row["v"]) / 10.0 ** row["d"]


def test_curves_of_the_turret_and_of_engaged_rollers() -> None:
    """A cycloid of 60 degrees over 150; at rest two rollers are within the cam, at -30 and 30 degrees."""
    plots = {plot["title"]: plot for plot in script(shared_design(BARREL))["plots"]}
    angle = unpacked(plots["Turret"]["series"][0])
    theta = np.radians(np.arange(721) * 0.5)
    # after the whole turn the curve ends a pitch further on
    np.testing.assert_allclose(angle[:720], np.degrees(advance(theta[:720], 6, 150.0)) - 30.0, atol=1e-3)
    assert angle[720] == pytest.approx(30.0, abs=1e-3)
    steep = unpacked(plots["Velocity"]["series"][0])
    assert steep.max() == pytest.approx(2.0 * 60.0 / math.radians(150.0), abs=1e-2)
    for series in plots["Rollers engaged"]["series"]:
        assert unpacked(series)[500] == 2.0


@pytest.mark.costly("a page with the cam on seven layers")
def test_a_page_asks_for_nothing(tmp_path: Path) -> None:
    (tmp_path / "dial.yaml").write_text(changed(BARREL, ("[stl]", "[html]")), encoding="utf-8")
    assert camgeo.export(tmp_path / "dial.yaml", tmp_path / "out").ok
    text = (tmp_path / "out" / "dial" / "dial.html").read_text("utf-8")
    assert 'id="development"' in text
    assert "playIndexer" in text
    assert not re.search(r'(?:src|href)="(?!#|data:)[^"]*//', text)


@pytest.mark.slow
@pytest.mark.skipif(executable() is None, reason="no browser")
@pytest.mark.parametrize("text", [BARREL, CCW + LEADING, GLOBOID, CCW + GLOBOID, INCHES])
def test_the_script_draws_the_same(tmp_path: Path, text: str) -> None:
    """At an angle between the values that a page has, and at one of them; nothing is wider than a phone."""
    (tmp_path / "dial.yaml").write_text(changed(text, ("[stl]", "[html]")), encoding="utf-8")
    page = camgeo.export(tmp_path / "dial.yaml", tmp_path).files[-1].path
    with Browser(tmp_path / "profile") as browser:
        for step in (0, 150, 301):
            browser.open(page.as_uri() + f"#deg={0.5 * step}")
            found = browser.ask(
                '[...document.querySelectorAll("#drawing .indexer path")].map((p) => p.getAttribute("d"))'
            )
            for path, shape in zip(found, scene(shared_design(text), step).bodies[0].shapes, strict=True):
                outlines = [ring.points for ring in shape.rings]
                if shape.role != "fixed" and outlines:
                    np.testing.assert_allclose(numbers(path), np.concatenate(outlines), atol=0.01)
        browser.size(390, 844)
        assert browser.ask("document.documentElement.scrollWidth") <= 390
        assert not browser.problems
        assert not [each for each in browser.requests if not each.startswith("file:")]


# --- glb --------------------------------------------------------------------------------------------------------------


def turned(path: Path, name: str) -> np.ndarray:
    """Points (steps, n, 3), mm, z upward, of a node at all its steps, by the rules of the format."""
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    document, binary = json.loads(data[20 : 20 + size]), data[28 + size :]

    def array(index: int) -> np.ndarray:
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        wide = {"VEC3": 3, "VEC4": 4}[accessor["type"]]
        return (
            np.frombuffer(binary, "<f4", wide * accessor["count"], view["byteOffset"]).reshape(-1, wide).astype(float)
        )

    (node,) = (k for k, node in enumerate(document["nodes"]) if node["name"] == name)
    (animation,) = document["animations"]
    rows = {
        channel["target"]["path"]: array(animation["samplers"][channel["sampler"]]["output"])
        for channel in animation["channels"]
        if channel["target"]["node"] == node
    }
    (part,) = document["meshes"][document["nodes"][node]["mesh"]]["primitives"]
    points = array(part["attributes"]["POSITION"])
    axis, real = rows["rotation"][:, None, :3], rows["rotation"][:, None, 3:]
    once = np.cross(axis, points[None]) + real * points[None]
    x, y, z = np.moveaxis(points[None] + 2.0 * np.cross(axis, once) + rows["translation"][:, None], -1, 0) * 1e3
    return np.stack([x, -z, y], axis=-1)


def written(text: str, tmp_path: Path) -> Path:
    """The glb of a recipe."""
    (tmp_path / "dial.yaml").write_text(changed(text, ("[stl]", "[{glb: {tolerance: 0.1}}]")), encoding="utf-8")
    (file,) = camgeo.export(tmp_path / "dial.yaml", tmp_path).files
    return file.path


@pytest.mark.thin(3)
@pytest.mark.costly("the solid of a cam")
@pytest.mark.parametrize(
    ("text", "side", "sense"), [(CCW + BARREL, 1.0, -1.0), (BARREL, 1.0, 1.0), (LEADING, -1.0, 1.0)]
)
def test_rollers_of_a_barrel_turn_beside_it_in_a_viewer(text: str, side: float, sense: float, tmp_path: Path) -> None:
    """Their axes are parallel to x, from 37.5 to 50 mm; y is offset - side l cos psi, and -y of a mirrored cam."""
    path = written(text, tmp_path)
    found, cam = turned(path, "rollers"), turned(path, "cam")
    assert len(found) == 361
    offset = side * 30.0 * (1.0 + math.cos(math.pi / 6.0))
    for step in (0, 50, 150):
        psi = -math.pi / 6.0 + advance(np.array([math.radians(step)]), 6, 150.0)[0] + math.tau * np.arange(6) / 6.0
        wanted = np.column_stack(
            [np.full(6, 43.75), sense * (offset - side * 60.0 * np.cos(psi)), 40.0 + 60.0 * np.sin(psi)]
        )
        middles = found[step].reshape(6, -1, 3).mean(axis=1)
        assert np.linalg.norm(wanted[:, None] - middles[None], axis=2).min(axis=1).max() < 1e-3
        assert [found[step, :, 0].min(), found[step, :, 0].max()] == pytest.approx([37.5, 50.0], abs=1e-3)
    # of its eight steps the second is a quarter of a turn: what was at the polar angle 90 degrees stands at 0
    x, y, _ = cam[0].T
    np.testing.assert_allclose(cam[2][:, :2], np.column_stack([sense * y, -sense * x]), atol=1e-3)


@pytest.mark.costly("the solid of a cam")
def test_rollers_of_a_globoid_turn_in_its_throat_in_a_viewer(tmp_path: Path) -> None:
    """At psi from the turret's centre, 90 mm off along x, towards -cos psi and, up, sin psi."""
    found = turned(written(CCW + GLOBOID, tmp_path), "rollers")
    for step in (0, 40, 100):
        psi = -math.pi / 8.0 + advance(np.array([math.radians(step)]), 8, 120.0)[0] + math.tau * np.arange(8) / 8.0
        wanted = np.column_stack([90.0 - MIDDLE * np.cos(psi), np.zeros(8), 30.0 + MIDDLE * np.sin(psi)])
        middles = found[step].reshape(8, -1, 3).mean(axis=1)
        assert np.linalg.norm(wanted[:, None] - middles[None], axis=2).min(axis=1).max() < 1e-3


@pytest.mark.parametrize("text", [BARREL, CCW + BARREL, LEADING])
def test_at_rest_a_barrel_is_touched_above_and_below_each_roller(text: str) -> None:
    design = shared_design(text)
    recipe = design.recipe
    form, radius, rest = recipe.form, recipe.roller.radius, math.radians(300.0)
    for name, way in (("lower", -1.0), ("upper", 1.0)):
        lines = touched(design, name, np.array([rest]))[0]
        lines = lines[np.isfinite(lines).all(axis=(1, 2))]
        assert len(lines) == 2
        for line in lines:
            up = [side * form.pitch * math.sin(math.pi / recipe.stops) for side in (-1.0, 1.0)]
            height = min((form.height + each + way * radius for each in up), key=lambda z: abs(z - line[0, 1]))
            beside = form.offset - form.side * form.pitch * math.cos(math.pi / recipe.stops)
            assert line[:, 0] == pytest.approx([recipe.sense * beside] * 2, abs=1e-9)
            assert line[:, 1] == pytest.approx([height] * 2, abs=1e-9)


def test_lines_of_contact_of_a_globoid_lie_beside_its_rollers() -> None:
    design = shared_design(GLOBOID)
    recipe = design.recipe
    radius, rest = recipe.roller.radius, math.radians(330.0)
    centre, half = np.array(recipe.turret.drawn(recipe.roller, recipe.stops, recipe.sense).centre), 0.5
    for name, way in (("lower", -1.0), ("upper", 1.0)):
        lines = touched(design, name, np.array([rest]))[0]
        lines = lines[np.isfinite(lines).all(axis=(1, 2))]
        assert len(lines) == 2
        places = sorted(lines.tolist(), key=lambda line: line[0][1])
        for line, turn in zip(places, (-half, half), strict=True):
            psi = turn * 2.0 * math.pi / recipe.stops
            along, across = np.array([-math.cos(psi), math.sin(psi)]), np.array([math.sin(psi), math.cos(psi)])
            seen = (np.array(line) - centre) * [math.copysign(1.0, centre[0]), 1.0]
            assert seen @ across == pytest.approx([way * radius] * 2, abs=1e-9)
            assert seen[0] @ along == pytest.approx(recipe.roller.inner, abs=0.2)
