"""Linear, cylindrical and indexing cams as the worker answers for them: fields, curves, segments, solids, paper.

Holds: camgeo.api.shown.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.places import RECIPES, script

import camgeo
from camgeo.schema.yaml_source import Source, scalars

if TYPE_CHECKING:
    from collections.abc import Iterator

live = script("live")
TEXTS = {
    path.stem: path.read_text("utf-8")
    for kind in ("linear", "cylindrical", "indexing")
    for path in sorted((RECIPES / kind).glob("*.yaml"))
}
UNITS = {"mm": 1.0, "inch": 25.4}


@pytest.fixture(autouse=True)
def folders(tmp_path: Path) -> Iterator[None]:
    """Of each test its own: in a browser nobody else is there."""
    with pytest.MonkeyPatch.context() as patch:  # designs stay shared: what is patched makes none
        for name in ("FOLDER", "OUT"):
            (tmp_path / name).mkdir()
            patch.setattr(live, name, str(tmp_path / name))
        yield


def unpacked(row: dict[str, Any]) -> Any:
    """Values of a packed row, which has steps."""
    return np.cumsum(row["v"]) / 10.0 ** row["d"]


def cycloid(u: float, stroke: float, over: float) -> float:
    return stroke * (u / over - math.sin(2.0 * math.pi * u / over) / (2.0 * math.pi))


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", TEXTS)
def test_values_stand_where_their_fields_say(name: str) -> None:
    text = TEXTS[name]
    fields = {field["path"]: field for field in live.fields(Source.of(text, name))}
    numbers = [field for field in fields.values() if field["kind"] == "number"]
    assert len(numbers) >= 8
    for field in fields.values():
        if "before" not in field:
            assert text[field["start"] : field["end"]].strip("'\"") == field["text"]
    laws = {"cam.motion[0].law", "cam.motion[1].law", "cam.motion.segments[0].law", "cam.motion[0].law.uniform.blend"}
    assert laws & set(fields)
    assert live.more(name, text)["more"]


# needs: linear
def test_a_swing_of_a_plate_is_in_degrees_and_a_lift_in_its_unit() -> None:
    units = {}
    for name in ("plate-feed", "plate-groove"):
        fields = {field["path"]: field for field in live.fields(Source.of(TEXTS[name], name))}
        units[name] = fields["cam.motion[1].rise"]["unit"], fields["cam.motion[1].over"]["unit"]
    assert units == {"plate-feed": ("mm", "mm"), "plate-groove": ("degrees", "mm")}


# needs: linear
def test_a_plate_is_shown_over_its_travel() -> None:
    answer = live.design("feed", TEXTS["plate-feed"], figures=True)
    assert (answer["faults"], answer["ok"]) == ([], True)
    scene = answer["scene"]
    assert (scene["input"]["name"], scene["input"]["most"], scene["input"]["closed"]) == ("travel", 200.0, False)
    lift = unpacked(scene["plots"][0]["series"][0])
    for travel in (130, 150, 170):  # of the return by a cycloid, 20 mm from 115 to 185 mm
        assert np.interp(travel, np.linspace(0, 200, 721), lift) == pytest.approx(
            20.0 - cycloid(travel - 115, 20, 70), abs=1e-3
        )
    assert 'data-at="150.000' in answer["checks"]  # the steepest place, in the middle of the return
    figures = {figure["name"]: figure for figure in answer["figures"]}
    assert figures["travel"]["value"] == pytest.approx(200.0)
    assert "pressure-angle" in scene["panels"]


# needs: linear
def test_a_check_of_a_plate_that_fails_leads_to_its_line_and_its_place() -> None:
    text = TEXTS["plate-feed"].replace("pressure-angle: {at_most: 45}", "pressure-angle: {at_most: 20}")
    (failed,) = live.design("feed", text)["failed"]
    assert failed["line"] == 1 + text[: text.index("pressure-angle: {")].count("\n")
    assert 'data-at="150.000' in failed["place"]
    assert "travel" in failed["text"]


# needs: cylindrical
@pytest.mark.slow
def test_a_drum_is_shown_over_a_turn_with_its_charts() -> None:
    answer = live.design("drum", TEXTS["drum-groove"])
    scene = answer["scene"]
    lift = unpacked(scene["plots"][0]["series"][0])
    assert lift[2 * 45] == pytest.approx(cycloid(45, 40, 120), abs=1e-3)
    assert scene["player"]["name"] == "playDrum"
    assert 'id="development"' in scene["panels"]
    assert "45.15°" in scene["panels"]  # atan(2 * 40 / (2 pi / 3) / 38)
    picture = live.picture("drum", TEXTS["drum-groove"])
    assert {key for key in picture if picture[key] != scene[key]} == set()


@pytest.mark.thin(6)
@pytest.mark.costly("solids of several turns among them")
@pytest.mark.parametrize("name", [name for name in TEXTS if not name.endswith("-shortened")])  # it takes its time
def test_the_solid_of_a_kind_is_closed(name: str) -> None:
    (file,) = live.solid(name, TEXTS[name])["files"]
    corners = np.fromfile(file["path"], "<f4").reshape(-1, 3, 3)
    _, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = number.reshape(-1, 3)
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    ahead, back = (edges[np.lexsort(edges[:, way].T)] for way in ([1, 0], [0, 1]))
    np.testing.assert_array_equal(ahead, back[:, ::-1])  # each edge is run as often one way as the other
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    deep = {}
    deep |= {"plate-endless": 8.0, "plate-feed": 12.0, "plate-groove": 16.0}  # needs: linear
    deep |= {"drum-end": 60.0, "drum-groove": 80.0, "drum-rib": 4.2 * 25.4}  # needs: cylindrical
    deep |= {"drum-shortened": 65.0, "drum-arm": 90.0, "drum-cone": 80.0}  # needs: cylindrical
    deep |= {"drum-screw": 88.0, "drum-spiral": 88.0}  # needs: cylindrical
    deep |= {"drum-milled": 70.0}  # needs: cylindrical, milling
    deep |= {"index-barrel": 90.0, "index-globoid": 72.0}  # needs: indexing
    assert high[2] - low[2] == pytest.approx(deep[name], rel=0.2 if name.endswith("-end") else 1e-6)


# needs: cylindrical
@pytest.mark.parametrize(("name", "radius", "sign"), [("drum-groove", 50.0, 1), ("drum-rib", 2.25 * 25.4, -1)])
def test_a_drum_comes_on_paper_unrolled(name: str, radius: float, sign: int) -> None:
    """Once round and 15 degrees more; on the blank of the groove the dwells are 10 mm beside the axis at 20 and 60."""
    text = live.paper(name, TEXTS[name])["files"][0]["path"]
    page = Path(text).read_bytes().decode("latin-1")
    assert "unrolled at a radius of" in page
    assert "\nh\nS" not in page  # nothing of it is closed
    (drawing,) = live._shown(live._recipe(name, TEXTS[name])).drawings(0.004)
    *_, base, top, first, mark, last = drawing[1]
    turn = sign * 2.0 * math.pi * radius
    for edge in (base, top):
        assert edge[:, 0] == pytest.approx([0.0, turn * (1.0 + 15.0 / 360.0)], abs=1e-6)
    assert [line[0, 0] for line in (first, mark, last)] == pytest.approx([0.0, turn, turn * 375.0 / 360.0], abs=1e-6)
    if name == "drum-groove":
        lower = drawing[1][0]
        at = np.interp(np.radians([150.0, 330.0]) * radius, *lower.T)
        assert at == pytest.approx([50.0, 10.0], abs=0.01)


def segments(text: str) -> list[tuple[str, float, float]]:
    """As the page is told, without the checks and the scene of `live.design`, which has them too."""
    motion = live.drawn(Source.of(text, "x"), live._shown(live._recipe("x", text)).motion())
    assert motion["why"] == ""
    return [(one["kind"], one["over"], one["change"]) for one in motion["segments"]]


def changed(text: str, change: str, index: int = 0, at: float = 0.0) -> str:
    given = {"name": "x", "text": text, "change": change, "index": index, "at": at}
    answer: dict[str, Any] = json.loads(live.answer("with_segments", json.dumps(given)))
    assert "text" in answer, answer
    new: str = answer["text"]
    return new


def lifts(text: str) -> Any:
    cam = camgeo.design(live._recipe("x", text))
    return cam.motion(np.linspace(0.0, cam.travel, 401))


# needs: linear
def test_segments_of_a_travel_are_drawn_in_its_unit() -> None:
    motion = live.design("x", TEXTS["plate-feed"])["motion"]
    assert (motion["total"], motion["step"], motion["closed"], motion["behind"]) == (200.0, 1.0, False, "nothing")
    assert segments(TEXTS["plate-feed"]) == [
        ("dwell", 15, 0),
        ("rise", 60, 20),
        ("dwell", 40, 0),
        ("return", 70, -20),
        ("dwell", 15, 0),
    ]
    waves = live.design("x", TEXTS["plate-endless"])["motion"]
    assert (waves["total"], waves["repeat"], waves["closed"], waves["step"]) == (25.0, 3, True, 0.1)


# needs: linear
def test_a_travel_runs_backwards_is_split_and_may_end_higher() -> None:
    text = TEXTS["plate-feed"]
    before = lifts(text)
    assert lifts(changed(text, "reverse")) == pytest.approx(before[::-1], abs=1e-9)
    joint = segments(changed(text, "add", at=33.4))
    assert [over for _, over, _ in joint[:3]] == [15, 18, 42]
    halves = segments(changed(text, "split", 1))
    assert [(kind, over) for kind, over, _ in halves[1:3]] == [("rise", 30), ("rise", 30)]
    assert halves[1][2] + halves[2][2] == pytest.approx(20.0)
    groove = TEXTS["plate-groove"]  # which ends 22 degrees higher, and backwards begins there
    assert lifts(changed(groove, "reverse")) == pytest.approx(lifts(groove)[::-1], abs=1e-9)
    waves = segments(changed(TEXTS["plate-endless"], "repeat", at=2))
    assert [over for _, over, _ in waves] == pytest.approx([16.5, 2.25, 16.5, 2.25])


@pytest.mark.costly("figures of a drum in two units, and of a wrong one")
@pytest.mark.thin(13)
@pytest.mark.parametrize("name", [name for name, text in TEXTS.items() if "crank" not in text])  # it holds to 1e-9
def test_a_kind_in_another_unit_stays_the_same_cam(name: str) -> None:
    text = TEXTS[name]
    other = "mm" if "units: inch" in text else "inch"
    new = live.converted(name, text, other)["text"]
    assert re.search(rf"(?m)^units: {other}", new)
    sizes = []
    for one in (text, new):
        recipe = live._recipe(name, one)
        plain = {path: node.text for path, node in scalars(recipe.source().root)}
        stroke = next(value for path, value in plain.items() if re.fullmatch(r"cam\.motion.*\.rise", path))
        turns = "arm:" in text or "turret:" in text
        sizes.append(float(stroke) * (1.0 if turns else UNITS[recipe.units]))  # of an arm, or a turret
    assert sizes[1] == pytest.approx(sizes[0], rel=1e-6)
    sized = r"cam\.follower\.(radius|width)|cam\.turret\.(roller)"  # a roller has a radius, a shoe a width
    key, size = next(
        (found[1] or found[2], value) for path, value in plain.items() if (found := re.fullmatch(sized, path))
    )
    wrong = re.sub(rf"\b{key}: {re.escape(size)}\b", f"{key}: {0.99 * float(size)}", new)
    assert not live._alike(live._recipe(name, text), live._recipe(name, wrong))


# needs: cylindrical
@pytest.mark.slow
def test_a_swing_over_a_drum_has_its_plot_in_degrees() -> None:
    answer = live.design("arm", TEXTS["drum-arm"])
    assert answer["scene"]["plots"][0]["unit"] == "°"


# needs: cylindrical
def test_a_swing_over_a_drum_is_drawn_in_degrees() -> None:
    (rise, *_) = (change for kind, _, change in segments(TEXTS["drum-arm"]) if kind == "rise")
    assert rise == pytest.approx(20.0, abs=1e-6)


# needs: indexing
@pytest.mark.thin(2)
@pytest.mark.costly("cams with their turrets, and checks of them")
@pytest.mark.parametrize("name", ["index-barrel", "index-globoid"])
def test_a_turret_is_shown_over_a_turn(name: str) -> None:
    """Its angle goes from half a pitch below the middle to half a pitch above it, and its segments stand upon it."""
    stops, begin = {"index-barrel": (8, 0.0), "index-globoid": (10, 90.0)}[name]
    answer = live.design(name, TEXTS[name])
    assert (answer["faults"], answer["ok"]) == ([], True)
    scene = answer["scene"]
    angle = scene["plots"][0]
    assert (angle["title"], angle["unit"]) == ("Turret", "°")
    values = unpacked(angle["series"][0])
    assert [values[0], values[round(2 * (begin + 90.0))], values[-1]] == pytest.approx(
        [-180.0 / stops, 0.0, 180.0 / stops], abs=1e-3
    )
    assert scene["player"]["name"] == "playIndexer"
    assert ('id="development"' in scene["panels"]) == (name == "index-barrel")
    assert "rib-thickness" in scene["panels"]
    picture = live.picture(name, TEXTS[name])
    assert {key for key in picture if picture[key] != scene[key]} == set()
    motion = answer["motion"]
    assert (motion["total"], motion["closed"], motion["behind"]) == (360.0, False, "nothing")
    assert motion["start"] == pytest.approx(-180.0 / stops)
    (rise,) = (one for one in motion["segments"] if one["kind"] == "rise")
    assert (rise["over"], rise["change"]) == (180, pytest.approx(360.0 / stops, abs=1e-6))


# needs: indexing
@pytest.mark.costly("the design of two turrets")
def test_a_barrel_comes_on_paper_unrolled_and_a_globoid_says_why_not() -> None:
    page = Path(live.paper("index-barrel", TEXTS["index-barrel"])["files"][0]["path"]).read_bytes().decode("latin-1")
    assert "unrolled at a radius of 50 mm" in page
    given = {"name": "index-globoid", "text": TEXTS["index-globoid"]}
    (fault,) = json.loads(live.answer("paper", json.dumps(given)))["faults"]
    assert "a globoid has no development" in fault["text"]


# needs: axis
def test_what_moves_no_cam_is_made_by_the_command() -> None:
    text = (RECIPES / "axis" / "pusher.yaml").read_text("utf-8")
    (fault,) = json.loads(live.answer("design", json.dumps({"name": "pusher", "text": text})))["faults"]
    assert "this page makes no motion of an axis, which the command `camgeo export pusher.yaml` does" in fault["text"]
