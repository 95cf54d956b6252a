"""Degree wheels of an engine, and the shaft drawn: what they say, to scale, for each cylinder.

Holds: camgeo.capabilities.camshaft.drawing, camgeo.capabilities.camshaft.svg.
"""

import re
from itertools import combinations
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, cast
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from support.camshafts import ENGINE, shaft
from support.heavy import trimesh

import camgeo
from camgeo.capabilities.camshaft.diagrams import _crank_wheel
from camgeo.capabilities.camshaft.keys import DIAGRAMS
from camgeo.recipe.loading import load_order
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe, Engine

RECIPES = Path(__file__).parents[3] / "recipes"


def test_the_rings_of_many_lobes_stay_wide_enough_for_their_numbers(tmp_path: Path) -> None:
    rows = [f"recipe: intake.yaml, cylinder: {k // 2 + 1}, valve: intake, z: {4 * k}, length: 4" for k in range(24)]
    order = ", ".join(str(k + 1) for k in range(12))
    engine = ENGINE.replace("1, 3, 4, 2", order)
    body = "  shaft: {diameter: 24, from: -2, to: 100}\n"
    report = camgeo.export(shaft(tmp_path, "\n".join(rows), engine, files="[svg]", body=body), tmp_path / "out")
    assert report.path is not None
    text = (report.path / "shaft.svg").read_text(encoding="utf-8")
    widths = [float(width) for width in re.findall(r'<path [^>]*stroke-width="([\d.]+)"', text)]
    numbers = re.findall(r'font-size="([\d.]+)" text-anchor="middle" class="ground" fill="#ffffff"[^>]*>(\d+)<', text)
    assert len(widths) == len(numbers) == 24
    assert all(width >= 2 * 0.62 * float(size) for width, (size, _) in zip(widths, numbers, strict=True))
    side = float(re.findall(r'width="([\d.]+)"', text)[0])
    reach = max(float(radius) for radius in re.findall(r' r="([\d.]+)"', text))
    assert reach + 40 < side / 2


EVENT = re.compile(r"<text [^>]*>((?:IV|EV)[OC] [\d.]+° [AB][TB]DC)<")
ALL_DRAWN = (
    "[{svg: {as: timing}}, {svg: {as: bars}}, {svg: {as: cam-wheel}}, {svg: {as: crank-wheel}}, {svg: {as: shaft}}]"
)


@pytest.mark.slow
def test_wheels_of_the_camshaft_and_of_the_crank_say_each_cylinders_events(tmp_path: Path) -> None:
    """Events, durations and overlap stand on both; each has 360 degrees, of the crank or of the cam."""
    source = RECIPES / "camshafts"
    for name in ("intake.yaml", "exhaust.yaml"):
        (tmp_path / name).write_text((source / name).read_text(encoding="utf-8"), encoding="utf-8")
    path = tmp_path / "four.yaml"
    text = (source / "four-cylinder.yaml").read_text(encoding="utf-8")
    text = text.replace("intake: 110, exhaust: 114", "intake: 96, exhaust: 94")
    path.write_text(re.sub(r"  files: .*", f"  files: {ALL_DRAWN}", text), encoding="utf-8")
    report = camgeo.export(path, tmp_path / "out")
    assert report.path is not None
    names = ["four.svg", *(f"four-{form}.svg" for form in DIAGRAMS[1:])]
    drawn = {form: (report.path / name).read_text(encoding="utf-8") for form, name in zip(DIAGRAMS, names, strict=True)}
    assert drawn["timing"] == drawn["cam-wheel"]
    cylinders = dict(report)["camshaft"]["cylinders"]
    (own,) = {tuple(round(row[key], 1) for key in list(row)[1:]) for row in cylinders}
    opens, closes, exhaust_opens, exhaust_closes, overlap, _ = own
    assert overlap > 0.0
    assert sorted(EVENT.findall(drawn["crank-wheel"])) == sorted(
        [f"IVO {opens}° BTDC", f"IVC {closes}° ABDC", f"EVO {exhaust_opens}° BBDC", f"EVC {exhaust_closes}° ATDC"]
    )
    lobes = dict(report)["camshaft"]["lobes"]
    for valve, lobe in zip(("intake", "exhaust"), lobes, strict=False):
        assert f"{valve} {2 * lobe['duration_deg']:.1f}°" in drawn["crank-wheel"]
    assert f"overlap {overlap}°" in drawn["crank-wheel"]
    assert "cylinders 1, 3, 4, 2: crank degrees" in drawn["crank-wheel"]  # alike: one wheel
    assert drawn["crank-wheel"].count("<svg") == 1
    assert drawn["cam-wheel"].count(f"overlap {cylinders[0]['overlap'] / 2:.1f}°") == 4
    for lobe in lobes:
        span = f"{lobe['opens_deg']:.1f}–{lobe['closes_deg']:.1f}° ({lobe['duration_deg']:.1f}°)"
        assert span in drawn["cam-wheel"]
    for words in drawn.values():
        ET.fromstring(words)


def test_cylinders_that_differ_have_wheels_of_their_own(tmp_path: Path) -> None:
    rows = (
        "recipe: intake.yaml, cylinder: 1, valve: intake, z: 30\nrecipe: lobe.yaml, cylinder: 3, valve: intake, z: 60"
    )
    (tmp_path / "lobe.yaml").write_text(
        (RECIPES / "camshafts" / "exhaust.yaml").read_text(encoding="utf-8"), encoding="utf-8"
    )
    report = camgeo.export(shaft(tmp_path, rows, ENGINE, files="[{svg: {as: crank-wheel}}]"), tmp_path / "out")
    assert report.path is not None
    text = (report.path / "shaft.svg").read_text(encoding="utf-8")
    assert text.count("<svg") == 3
    assert "cylinder 1: crank degrees" in text
    assert "cylinder 3: crank degrees" in text
    assert "overlap" not in text
    ET.fromstring(text)


def test_a_wheel_needs_an_engine(tmp_path: Path) -> None:
    rows = "recipe: intake.yaml, at: 30, z: 30"
    with pytest.raises(RecipeErrors, match=r"needs the engine's data.*; give camshaft.engine, or .svg"):
        load_order(shaft(tmp_path, rows, files="[{svg: {as: crank-wheel}}]"))
    load_order(shaft(tmp_path, rows, files="[{svg: {as: bars}}]"))


@pytest.mark.thin(2)
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_the_drawing_of_the_shaft_is_to_scale(tmp_path: Path, rotation: str) -> None:
    """Lobes and bars stand at their places along z, as high as their contours at a shaft angle of 0."""
    rows = "recipe: intake.yaml, at: 33.3, z: 30"
    path = shaft(tmp_path, rows, files="[stl, {svg: {as: shaft}}]", extra=f"rotation: {rotation}\n")
    report = camgeo.export(path, tmp_path / "out")
    assert report.path is not None
    text = (report.path / "shaft.svg").read_text(encoding="utf-8")
    boxes = [
        [float(value) for value in found]
        for found in re.findall(r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"', text)
    ]
    mesh = trimesh.load(report.path / "shaft.stl")
    (low, _, bottom), (high, _, top) = mesh.bounds
    shaft_box = min(boxes, key=lambda box: box[0] + 1e-3 * box[3])
    scale = max(box[2] for box in boxes) / (top - bottom)
    lobe = next(box for box in boxes if box[0] - shaft_box[0] == pytest.approx(scale * (30 - bottom), abs=0.05))
    points = mesh.vertices[(mesh.vertices[:, 2] > 29.9) & (mesh.vertices[:, 2] < 44.1)]
    assert lobe[2] == pytest.approx(scale * 14, abs=0.05)
    assert lobe[3] == pytest.approx(scale * np.ptp(points[:, 0]), rel=2e-3)
    axis = next(box for box in boxes if box[2] == max(box[2] for box in boxes))
    middle = axis[1] + 0.5 * axis[3]
    assert (middle - lobe[1]) == pytest.approx(scale * points[:, 0].max(), rel=3e-3)
    assert f"it turns {'clockwise' if rotation == 'cw' else 'counter-clockwise'}" in text
    assert low < high
    (polygon,) = re.findall(r'<polygon points="([^"]+)"', text)
    corners = np.array([[float(value) for value in corner.split(",")] for corner in polygon.split()])
    (centre,) = set(re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', text))
    from_axis = (corners - [float(value) for value in centre]) * (1.0, -1.0)
    seen, made = (rows[np.argmax(np.hypot(*rows.T))] for rows in (from_axis, points[:, :2]))
    assert np.arctan2(*seen) == pytest.approx(np.arctan2(*made), abs=0.03)


def boxes(drawing: str) -> list[tuple[str, float, float, float, float]]:
    """Words of a drawing with the least and greatest x and y of their letters, px: 0.56 of the size wide each."""
    found = []
    row = r'<text x="([\d.-]+)" y="([\d.-]+)" font-size="([\d.]+)" text-anchor="(\w+)"[^>]*>([^<]*)</text>'
    for x, y, size, anchor, words in re.findall(row, drawing):
        wide = 0.56 * float(size) * len(words)
        left = float(x) - {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor] * wide
        found.append((words, left, left + wide, float(y) - 0.72 * float(size), float(y) + 0.05 * float(size)))
    return found


def covering(drawing: str) -> list[tuple[str, str]]:
    """Pairs of words of a drawing that cover one another."""
    pairs = combinations(boxes(drawing), 2)
    return [(a[0], b[0]) for a, b in pairs if a[1] < b[2] and b[1] < a[2] and a[3] < b[4] and b[3] < a[4]]


@pytest.mark.parametrize(
    ("intake", "exhaust"),
    [((358.0, 224.0), (138.0, 224.0)), ((362.0, 190.0), (170.0, 192.0)), ((359.9, 180.2), (179.9, 180.2))],
)
def test_no_words_of_a_crank_wheel_cover_others(intake: tuple[float, float], exhaust: tuple[float, float]) -> None:
    recipe = cast("CamshaftRecipe", SimpleNamespace(name="engine", units="mm", mm=1.0))
    engine = cast("Engine", SimpleNamespace(lift=1.0, at_valve=False))

    def wheel(*events: tuple[str, float, float]) -> str:
        return _crank_wheel(recipe, engine, events, [1])

    drawn = wheel(("intake", *intake), ("exhaust", *exhaust))
    assert covering(drawn) == []
    assert {"TDC", "BDC"} <= {words for words, *_ in boxes(drawn)}
    rng = np.random.default_rng(1)
    for _ in range(60):
        events = [(valve, rng.uniform(0.0, 720.0), rng.uniform(60.0, 340.0)) for valve in ("intake", "exhaust")]
        drawn = wheel(*events)
        assert covering(drawn) == [], events
        height = float(re.findall(r'height="([\d.]+)"', drawn)[0])
        assert all(low > 40.0 or words.startswith("engine") for words, _, _, low, _ in boxes(drawn)[2:])
        assert all(high < height for *_, high in boxes(drawn))
