"""Camshafts: lobes where they belong, at their angle, judged in the solid as it lies on disk; an engine's events."""

import csv
import json
import math
import pickle
import re
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import yaml
from support.heavy import trimesh

import camgeo
from camgeo.capabilities.camshaft.diagrams import LEFT, RIGHT
from camgeo.capabilities.camshaft.events import stretches
from camgeo.capabilities.camshaft.keys import DIAGRAMS, Levels
from camgeo.capabilities.camshaft.svg import WIDTH
from camgeo.cli.exit_status import SURROUNDINGS
from camgeo.cli.main import main
from camgeo.common.clock import Clock
from camgeo.recipe.loading import load_order
from camgeo.recipe.starter import starter
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.judge.camshaft import verify_camshaft

RECIPES = Path(__file__).parents[3] / "recipes"
INTAKE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14, density: 7850}
"""
EXHAUST = INTAKE.replace("lift: 8, half: 68", "lift: 7.6, half: 65")
ROLLER = """\
cam:
  kind: disc
  base_radius: 30
  follower: {kind: roller, radius: 8, offset: 4}
  motion: [{rise: 12, over: 60, law: modified-sine}, {dwell: 30}, {return: 12, over: 90, law: cycloidal}, {dwell: 180}]
part: {thickness: 10}
"""
ENGINE = "  engine: {order: [1, 3, 4, 2], intake: 110, exhaust: 114, lift: 1}\n"
SHAFT = "  shaft: {diameter: 24, to: 120, bore: 8}\n  journals: [{z: 0, length: 20, diameter: 30}]\n"


def shaft(
    folder: Path, lobes: str, engine: str = "", *, files: str = "[stl]", extra: str = "", body: str = SHAFT
) -> Path:
    for name, text in (("intake", INTAKE), ("exhaust", EXHAUST), ("roller", ROLLER)):
        (folder / f"{name}.yaml").write_text(text)
    path = folder / "shaft.yaml"
    rows = "".join(f"    - {{{row}}}\n" for row in lobes.strip().splitlines())
    text = f"{extra}camshaft:\n{body}  lobes:\n{rows}{engine}export: {{tolerance: 0.01, files: {files}}}\n"
    path.write_text(text + "verify: {angles: 360}\n")
    return path


TWO = "recipe: intake.yaml, at: 33.3, z: 30\nrecipe: roller.yaml, at: -120, z: 60"


def failing(report: camgeo.Report) -> set[str]:
    return {
        f"{check.name}, {check.surface}" if check.surface else check.name for check in report.checks if not check.ok
    }


# --- published and worked numbers -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def engine(tmp_path_factory: pytest.TempPathFactory) -> camgeo.Report:
    """Four cylinders of case f20, as tables."""
    folder = tmp_path_factory.mktemp("engine")
    lobes = "\n".join(
        f"recipe: {valve}.yaml, cylinder: {cylinder}, valve: {valve}, z: {40 * k + 20 * j}, length: 14"
        for k, cylinder in enumerate((1, 2, 3, 4))
        for j, valve in enumerate(("intake", "exhaust"))
    )
    body = "  shaft: {diameter: 24, to: 200}\n"
    path = shaft(folder, lobes, ENGINE, files="[{csv: {as: events}}, {csv: {as: motion}}, svg, html]", body=body)
    return camgeo.export(path, folder / "out")


@pytest.mark.parametrize(("cylinder", "intake", "exhaust"), [(1, 235, 123), (3, 325, 213), (4, 55, 303), (2, 145, 33)])
def test_lobes_stand_where_the_engine_has_them(
    engine: camgeo.Report, cylinder: int, intake: float, exhaust: float
) -> None:
    at = {lobe["name"]: lobe["at_deg"] for lobe in dict(engine)["camshaft"]["lobes"]}
    assert at[f"cylinder {cylinder} intake"] == pytest.approx(intake, abs=1e-9)
    assert at[f"cylinder {cylinder} exhaust"] == pytest.approx(exhaust, abs=1e-9)


def test_events_of_an_engine(engine: camgeo.Report) -> None:
    """Case f20: crossings at 1 mm of tappet lift, in closed form."""
    for row in dict(engine)["camshaft"]["cylinders"]:
        assert row["intake_opens"] == pytest.approx(-9.750708606, abs=1e-8)
        assert row["intake_closes"] == pytest.approx(30.249291394, abs=1e-8)
        assert row["exhaust_opens"] == pytest.approx(29.210020268, abs=1e-8)
        assert row["exhaust_closes"] == pytest.approx(-18.789979732, abs=1e-8)
        assert row["overlap"] == pytest.approx(-28.540688338, abs=1e-8)
        assert row["separation"] == pytest.approx(112, abs=1e-9)


def test_tables_of_an_engine(engine: camgeo.Report) -> None:
    """The same in CSV; lifts at crank 200 are those of case f20."""
    assert engine.path is not None
    events = list(csv.DictReader((engine.path / "shaft.csv").read_text().splitlines()))
    assert float(events[0]["opens_crank_deg"]) == pytest.approx(369.750709, abs=1e-6)
    assert float(events[0]["duration_crank_deg"]) == pytest.approx(200.498582789, abs=1e-8)
    rows = list(csv.DictReader((engine.path / "shaft-motion.csv").read_text().splitlines()))
    at_200 = next(row for row in rows if float(row["crank_deg"]) == 200.0)
    intake = [float(at_200[f"cylinder_{k}_intake_mm"]) for k in (1, 3, 4, 2)]
    exhaust = [float(at_200[f"cylinder_{k}_exhaust_mm"]) for k in (1, 3, 4, 2)]
    assert intake == pytest.approx([0, 0, 1.952853268, 1.952853268], abs=1e-8)
    assert exhaust == pytest.approx([5.821737715, 0, 0, 0], abs=1e-8)


def test_balance_of_four_lobes(tmp_path: Path) -> None:
    """Case f23: the sum is nothing, the couple is not."""
    rows = [f"recipe: intake.yaml, at: {at}, z: {z}" for at, z in ((235, 0), (145, 30), (325, 60), (55, 90))]
    body = "  shaft: {diameter: 24, to: 104}\n"
    path = shaft(tmp_path, "\n".join(rows), files="[csv]", body=body)
    balance = dict(camgeo.check(path))["camshaft"]["balance"]
    assert balance["unbalance_kg_mm"] == pytest.approx(0.0, abs=1e-12)
    assert balance["couple_kg_mm2"] == pytest.approx(26.409844330, abs=1e-6)
    assert balance["couple_deg"] == pytest.approx(36.565051177, abs=1e-6)
    assert balance["about_z"] == 52.0


MACHINE = {  # case f24: base radius, roller, offset, zero and the follower's direction, degrees
    "a": (40, 10, 0, 0, 0),
    "b": (36, 9, 6, 75, 90),
    "c": (32, 8, 0, 310, -60),
}
MOTIONS = {
    "a": "{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 120, law: polynomial-345}, "
    "{dwell: 60}",
    "b": "{rise: 24, over: 100, law: polynomial-4567}, {dwell: 40}, {return: 24, over: 140, law: polynomial-4567}, "
    "{dwell: 80}",
    "c": "{rise: 12, over: 60, law: modified-sine}, {dwell: 30}, {return: 12, over: 90, law: cycloidal}, {dwell: 180}",
}
MACHINE_LIFTS = {
    0.0: [0, 0, 11.482835811],
    40.0: [3.910022190, 0, 12],
    130.0: [20, 14.598907125, 0],
    350.0: [0, 0.001252930, 9.309969066],
}


@pytest.fixture(scope="module", params=["cw", "ccw"])
def machine(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> tuple[str, camgeo.Report]:
    """Three cams in phase, their followers in three directions about the shaft."""
    folder = tmp_path_factory.mktemp(request.param)
    for name, (base, roller, offset, *_) in MACHINE.items():
        follower = f"{{kind: roller, radius: {roller}, offset: {offset}}}"
        (folder / f"{name}.yaml").write_text(
            f"cam: {{kind: disc, base_radius: {base}, follower: {follower}, motion: [{MOTIONS[name]}]}}\n"
        )
    rows = "\n".join(
        f"recipe: {name}.yaml, at: {zero + direction}, direction: {direction}, z: {20 * (k + 1)}, length: 10"
        for k, (name, (*_, zero, direction)) in enumerate(MACHINE.items())
    )
    path = shaft(folder, rows, files="[stl, csv, svg, html]", extra=f"rotation: {request.param}\n")
    return request.param, camgeo.export(path, folder / "out")


@pytest.mark.thin(2)
def test_lifts_of_a_machine_in_phase(machine: tuple[str, camgeo.Report]) -> None:
    """Case f24: over the shaft's angle, wherever the followers stand."""
    _, report = machine
    assert report.ok
    assert report.path is not None
    table = list(csv.DictReader((report.path / "shaft.csv").read_text().splitlines()))
    lifts = {float(row["shaft_deg"]): [float(row[f"{name}_mm"]) for name in MACHINE] for row in table}
    for angle, expected in MACHINE_LIFTS.items():
        assert lifts[angle] == pytest.approx(expected, abs=2e-9)
    lobes = dict(report)["camshaft"]["lobes"]
    assert [lobe["at_deg"] for lobe in lobes] == pytest.approx([0, 165, 250])
    assert [lobe["zero_deg"] for lobe in lobes] == pytest.approx([0, 75, 310])
    assert "lifts over the shaft" in (report.path / "shaft.svg").read_text()


def test_rollers_on_the_metal_of_a_machine_lift_as_its_table_says(machine: tuple[str, camgeo.Report]) -> None:
    """Case f24 by first contact: the solid is turned with the shaft, rollers come in along their directions."""
    rotation, report = machine
    assert report.path is not None
    mesh = trimesh.load(report.path / "shaft.stl")
    for k, (base, radius, offset, _, direction) in enumerate(MACHINE.values()):
        section = mesh.section(plane_origin=[0, 0, 20 * (k + 1) + 5], plane_normal=[0, 0, 1])
        edge = max(section.discrete, key=lambda points: np.ptp(points[:, 0])) @ np.array([1, 1j, 0])
        if rotation == "ccw":
            edge = edge.conj()
        lowest = math.sqrt((base + radius) ** 2 - offset**2)
        places = np.interp(np.arange(0, len(edge) - 1, 0.02), np.arange(len(edge)), edge)
        for angle, lifts in MACHINE_LIFTS.items():
            seen = places * np.exp(-1j * math.radians(angle + direction))  # along the stem, the shaft turns clockwise
            aside = np.abs(seen.imag - offset)
            high = seen.real[aside < radius] + np.sqrt(radius**2 - aside[aside < radius] ** 2)
            assert high.max() - lowest == pytest.approx(lifts[k], abs=0.02)


def test_the_direction_turns_an_engines_metal_and_no_event(tmp_path: Path, engine: camgeo.Report) -> None:
    """A lobe that is placed by its valve follows its tappet; without the direction its file is judged out of phase."""
    row = "recipe: intake.yaml, cylinder: 3, valve: intake, z: 30, direction: {}"
    (straight := tmp_path / "straight").mkdir()
    report = camgeo.export(path := shaft(tmp_path, row.format(-15), ENGINE), tmp_path / "out")
    assert report.ok
    assert report.path is not None
    lobe = dict(report)["camshaft"]["lobes"][0]
    first = dict(engine)["camshaft"]["lobes"][4]
    assert lobe["at_deg"] == pytest.approx(310, abs=1e-9)
    for event in ("zero_deg", "opens_deg", "closes_deg", "centre_deg"):
        assert lobe[event] == pytest.approx(first[event], abs=1e-9)
    file = report.path / "shaft.stl"
    assert camgeo.verify(path, file).ok
    assert "phase, cylinder 3 intake" in failing(camgeo.verify(shaft(straight, row.format(0), ENGINE), file))


# --- from a program ---------------------------------------------------------------------------------------------------


def test_a_camshaft_is_loaded_and_designed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From its file, its text or a mapping: whatever `check` takes. Lifts are those of case f20, at crank 200."""
    rows = [
        f"recipe: {valve}.yaml, cylinder: 4, valve: {valve}, z: {z}" for valve, z in (("intake", 30), ("exhaust", 60))
    ]
    path = shaft(tmp_path, "\n".join(rows), ENGINE, files="[csv]")
    monkeypatch.chdir(tmp_path)
    design = camgeo.design(path)
    assert isinstance(design, camgeo.CamshaftDesign)
    assert design.ok
    assert list(design.lobes) == ["cylinder 4 intake", "cylinder 4 exhaust"]
    assert design.motion(math.radians(100)) == pytest.approx([1.952853268, 0], abs=1e-8)
    assert design.motion([[0, 1], [2, 3]], derivative=1).shape == (2, 2, 2)
    assert design.angles["cylinder 4 intake"] == pytest.approx(math.radians(55))
    radius = design.lobes["cylinder 4 intake"].figures["radius-of-curvature"]
    assert design.figures["radius-of-curvature, cylinder 4 intake"] == radius
    assert repr(design) == "CamshaftDesign('shaft', 2 lobes)"
    for source in (path.read_text(encoding="utf-8"), yaml.safe_load(path.read_text(encoding="utf-8"))):
        recipe = camgeo.load(source)
        assert isinstance(recipe, camgeo.CamshaftRecipe)
        assert camgeo.check(recipe).ok
        assert np.array_equal(camgeo.design(recipe).motion(1.0), design.motion(1.0))
    with pytest.raises(camgeo.CallError, match="a derivative is one of order 0 to 6"):
        design.motion(0.0, derivative=7)
    again = pickle.loads(pickle.dumps(design))
    assert again.checks == design.checks


def test_a_report_of_a_camshaft_shows_itself_and_explains_its_checks(tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO, body="  shaft: {diameter: 37, to: 120}\n")
    report = camgeo.check(path)
    (failed,) = (check for check in report.checks if not check.ok)
    told = report.explain(failed)
    assert told.startswith("shaft, intake: 18 mm, at least 18.5 mm allowed\n")
    assert told.endswith(f"recipe   {path}:4:16 camshaft.lobes[0].recipe")
    assert "shaft, intake" in report._repr_html_()
    assert "size, roller" in report.figures
    assert "<svg" in report.design._repr_svg_()
    mapping = {
        "camshaft": {
            "shaft": {"diameter": 20, "to": 10},
            "lobes": [{"recipe": str(tmp_path / "intake.yaml"), "at": 0, "z": 1}],
        }
    }
    with pytest.raises(camgeo.RecipeErrors, match=r"^recipe: camshaft\.lobes\[0\]\.z: it reaches from 1 to 15 mm"):
        camgeo.load(mapping)


# --- the chart --------------------------------------------------------------------------------------------------------

CHART = re.compile(
    r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"[^>]*stroke-width="1"><title>(\w+): ([^<]+) degrees</title>'
)
STRETCHES = {
    "a": {
        "rise 0–120": [(0, 120)],
        "dwell 120–180": [(120, 180)],
        "return 180–300": [(180, 300)],
        "dwell 300–360": [(300, 360)],
    },
    "b": {
        "rise 75–175": [(75, 175)],
        "dwell 175–215": [(175, 215)],
        "return 215–355": [(215, 355)],
        "dwell 355–75": [(355, 360), (0, 75)],
    },
    "c": {
        "rise 310–10": [(310, 360), (0, 10)],
        "dwell 10–40": [(10, 40)],
        "return 40–130": [(40, 130)],
        "dwell 130–310": [(130, 310)],
    },
}


@pytest.mark.parametrize("name", ["shaft.svg", "shaft.html"])
def test_a_machine_has_a_bar_for_each_stretch_split_at_360(machine: tuple[str, camgeo.Report], name: str) -> None:
    """Case f24: rises, dwells and returns over the machine's angle."""
    _, report = machine
    assert report.path is not None
    text = (report.path / name).read_text(encoding="utf-8")
    bars: dict[str, dict[str, list[tuple[float, float]]]] = {}
    heights: dict[str, set[str]] = {}
    for x, y, width, lobe, label in CHART.findall(text):
        begin = (float(x) - LEFT) * 360 / (WIDTH - LEFT - RIGHT)
        end = begin + float(width) * 360 / (WIDTH - LEFT - RIGHT)
        bars.setdefault(lobe, {}).setdefault(label, []).append((begin, end))
        heights.setdefault(lobe, set()).add(y)
    assert bars == {
        lobe: {label: [pytest.approx(part, abs=0.01) for part in parts] for label, parts in of_lobe.items()}
        for lobe, of_lobe in STRETCHES.items()
    }
    assert all(len(rows) == 1 for rows in heights.values())
    assert ">return 40–130<" in text
    assert ">310–10<" in text  # on the part that has room for it


MATCHED = (
    "{rise: 2, over: 40, law: match}, {rise: 6, over: 60, law: constant-velocity}, {rise: 2, over: 40, law: match}"
)
LOBE = "{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}"
SOURCES = {
    "lobe": (LOBE, 235, [("return", 235, 303), ("dwell", 303, 527), ("rise", 167, 235)]),
    "formula": ("{formula: 5*(1 - cos(t))}", 30, [("rise", 30, 210), ("return", 210, 390)]),
    "one rise of three segments": (
        f"[{MATCHED}, {{dwell: 40}}, {{return: 10, over: 180, law: cycloidal}}]",
        0,
        [("rise", 0, 140), ("dwell", 140, 180), ("return", 180, 360)],
    ),
    "rise and fall": (
        "[{rise_fall: 5, over: 90}, {dwell: 270}]",
        0,
        [("rise", 0, 45), ("return", 45, 90), ("dwell", 90, 360)],
    ),
    "two a turn": (
        "{repeat: 2, segments: [{rise: 5, over: 60, law: harmonic}, {to: 0, over: 60, law: harmonic}, {dwell: 60}]}",
        350,
        [
            (name, at + turn, at + turn + 60)
            for turn in (350, 170)
            for name, at in (("rise", 0), ("return", 60), ("dwell", 120))
        ],
    ),
    "a whole dwell": ("[{dwell: 360}]", 20, [("dwell", 0, 360)]),
}


@pytest.mark.parametrize(("motion", "zero", "expected"), SOURCES.values(), ids=SOURCES)
def test_stretches_of_any_source(motion: str, zero: float, expected: list[tuple[str, float, float]]) -> None:
    text = f"cam: {{kind: disc, base_radius: 30, follower: {{kind: roller, radius: 8}}, motion: {motion}}}\n"
    exact = designed(camgeo.load(text), Clock()).exact
    found = [tuple(stretch) for stretch in stretches(exact, math.radians(zero))]
    right = [(phase, begin % 360, begin % 360 + end - begin) for phase, begin, end in expected]
    assert [phase for phase, *_ in found] == [phase for phase, *_ in right]
    assert np.array([ends for _, *ends in found]) == pytest.approx(np.array([ends for _, *ends in right]), abs=1e-4)


def test_waves_of_a_base_circle_are_a_dwell() -> None:
    """Forty waves of 0.3 micrometres beside a lift of 8 mm; those of 30 are drawn."""
    motion = "{formula: 8*((1 - cos(t))/2)**8 + %s*cos(40*t)}"
    text = f"cam: {{kind: disc, base_radius: 60, follower: {{kind: flat}}, motion: {motion}}}\n"
    small, large = (stretches(designed(camgeo.load(text % wave), Clock()).exact, 0.0) for wave in ("0.0003", "0.03"))
    assert [stretch.phase for stretch in small] == ["rise", "return", "dwell"]
    rise, back, dwell = small
    assert rise.end == back.begin == pytest.approx(180.0, abs=1e-6)
    assert dwell.begin == back.end
    assert dwell.end == pytest.approx(360.0 + rise.begin, abs=1e-9)
    assert 60.0 < rise.begin < 120.0
    assert len(large) > 20


# --- the metal --------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def solid(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, camgeo.Report]:
    folder = tmp_path_factory.mktemp("solid")
    path = shaft(folder, TWO, files="[stl, 3mf, html]")
    return path, camgeo.export(path, folder / "out")


def test_a_solid_of_two_lobes(solid: tuple[Path, camgeo.Report]) -> None:
    _, report = solid
    assert report.ok
    assert report.path is not None
    mesh = trimesh.load(report.path / "shaft.stl")
    assert mesh.is_watertight
    assert mesh.body_count == 1
    assert mesh.bounds[:, 2].tolist() == [0.0, 120.0]
    # the nose of the flat lobe, whose greatest lift is at shaft angle 0, points to `at`
    (section,) = mesh.section(plane_origin=[0, 0, 37], plane_normal=[0, 0, 1]).discrete[:1] or [None]
    points = max(mesh.section(plane_origin=[0, 0, 37], plane_normal=[0, 0, 1]).discrete, key=lambda p: np.ptp(p[:, 0]))
    nose = points[np.hypot(points[:, 0], points[:, 1]).argmax()]
    assert section is not None
    assert math.degrees(math.atan2(nose[1], nose[0])) == pytest.approx(33.3, abs=0.5)
    assert np.hypot(*nose[:2]) == pytest.approx(26.0, abs=0.02)


def test_the_page_shows_timing_and_checks(solid: tuple[Path, camgeo.Report]) -> None:
    _, report = solid
    assert report.path is not None
    text = (report.path / "shaft.html").read_text()
    assert "<script" not in text
    assert "{{" not in text
    assert "Content-Security-Policy" in text.partition("</head>")[0]
    assert "every check holds" in text
    assert "<button" not in text
    assert re.search(r"position, roller", text)


def test_events_of_the_page_are_to_a_hundredth_of_a_degree(engine: camgeo.Report) -> None:
    """All cells of a column have as many decimals; the exact number is a hint."""
    assert engine.path is not None
    text = (engine.path / "shaft.html").read_text()
    lobes, cylinders = (re.findall(r"<tr>(.*?)</tr>", table) for table in re.findall(r"<table>(.*?)</table>", text))
    columns = {}
    for head, *rows in (lobes, cylinders):
        cells = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in rows]
        columns |= dict(zip(re.findall(r"<th[^>]*>(.*?)</th>", head), zip(*cells, strict=True), strict=True))
    for name, key in (("opens", "opens_deg"), ("duration", "duration_deg"), ("closes, crank", "closes_crank_deg")):
        exact = [lobe[key] for lobe in dict(engine)["camshaft"]["lobes"]]
        assert columns[name] == tuple(f'<span title="{value!r}">{value:.2f}</span>' for value in exact)
    assert set(columns["IVO BTDC"]) == {
        f'<span title="{row["intake_opens"]!r}">-9.75</span>' for row in dict(engine)["camshaft"]["cylinders"]
    }
    assert columns["to z"][:2] == ("14", "34")
    assert columns["cylinder"] == ("1", "3", "4", "2")


OF_A_LOBE = ("phase", "contour", "motion")
PLANTED = {
    "crank for cam degrees": (TWO.replace("33.3", "66.6"), SHAFT, {f"{check}, intake" for check in OF_A_LOBE}),
    "a tenth of a degree": (TWO.replace("-120", "-119.9"), SHAFT, {f"{check}, roller" for check in OF_A_LOBE}),
    "another place": (TWO.replace("z: 60", "z: 60.02"), SHAFT, {"position, roller", "thickness"}),
    "a thick journal": (TWO, SHAFT.replace("diameter: 30", "diameter: 30.05"), {"journal, journal 1"}),
    "a wide bore": (TWO, SHAFT.replace("bore: 8", "bore: 8.05"), {"bore"}),
    "a long shaft": (TWO, SHAFT.replace("to: 120", "to: 120.05"), {"thickness"}),
}


@pytest.mark.thin(6)
@pytest.mark.parametrize(("lobes", "body", "fails"), PLANTED.values(), ids=PLANTED)
def test_planted_faults(
    tmp_path: Path, solid: tuple[Path, camgeo.Report], lobes: str, body: str, fails: set[str]
) -> None:
    """A solid of another recipe: a lobe by crank for cam degrees, slightly turned, in another place, other bars."""
    right, _ = solid
    made = camgeo.export(shaft(tmp_path, lobes, body=body), tmp_path / "out")
    assert made.ok
    assert made.path is not None
    assert failing(camgeo.verify(right, made.path / "shaft.stl")) == fails


MIRRORED = (
    "[{dwell: 180}, {rise: 12, over: 90, law: cycloidal}, {dwell: 30}, {return: 12, over: 60, law: modified-sine}]"
)
OTHER_LOBES = {
    "a mirrored lobe": (MIRRORED, "offset: -4"),
    "a table in crank degrees read as one of the cam": (
        "[{rise: 12, over: 30, law: modified-sine}, {dwell: 15}, {return: 12, over: 45, law: cycloidal}, {dwell: 270}]",
        "offset: 4",
    ),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize(("motion", "offset"), OTHER_LOBES.values(), ids=OTHER_LOBES)
def test_another_lobe_is_caught(tmp_path: Path, solid: tuple[Path, camgeo.Report], motion: str, offset: str) -> None:
    right, _ = solid
    path = shaft(tmp_path, TWO)
    text = re.sub(r"motion: .*", f"motion: {motion}", ROLLER).replace("offset: 4", offset)
    (tmp_path / "roller.yaml").write_text(text)
    made = camgeo.export(path, tmp_path / "out")
    assert made.path is not None
    fails = failing(camgeo.verify(right, made.path / "shaft.stl"))
    assert {"phase, roller", "contour, roller", "motion, roller"} <= fails
    assert not {name for name in fails if name.endswith("intake")}


@pytest.mark.slow
def test_a_mirrored_shaft_fails(tmp_path: Path, solid: tuple[Path, camgeo.Report]) -> None:
    right, _ = solid
    made = camgeo.export(shaft(tmp_path, TWO, extra="rotation: ccw\n"), tmp_path / "out")
    assert made.ok
    assert made.path is not None
    assert {"phase, intake", "contour, roller", "motion, roller"} <= failing(
        camgeo.verify(right, made.path / "shaft.stl")
    )


def test_a_phase_is_measured(solid: tuple[Path, camgeo.Report]) -> None:
    """Judged as if turned by a tenth of a degree more, the lobe is found a tenth of a degree back."""
    from dataclasses import replace

    from camgeo.capabilities.camshaft.lobes import placed
    from camgeo.capabilities.camshaft.pipeline import _intent
    from camgeo.recipe.loading import load_order

    path, report = solid
    recipe = load_order(path)
    intent = _intent(recipe, placed(recipe, Clock()), 0.01)
    first, second = intent.lobes
    turned = replace(intent, lobes=(replace(first, at=first.at + math.radians(0.1)), second))
    assert report.path is not None
    verdict = verify_camshaft(report.path / "shaft.3mf", turned, 360)
    check = next(check for check in verdict.checks if check.name == "phase")
    assert not check.ok
    assert check.value == pytest.approx(0.1, abs=1e-3)
    assert "-0.0998" in check.detail


def test_a_disc_is_no_camshaft(tmp_path: Path, solid: tuple[Path, camgeo.Report]) -> None:
    right, _ = solid
    (tmp_path / "one.yaml").write_text(INTAKE + "export: {tolerance: 0.01, files: [stl]}\n")
    one = camgeo.export(tmp_path / "one.yaml", tmp_path / "out")
    assert one.path is not None
    assert not camgeo.verify(right, one.path / "one.stl").ok


# --- face to face -----------------------------------------------------------------------------------------------------


def test_every_sum_of_tenths_of_a_millimetre_meets_the_tenth_that_it_is() -> None:
    """Of all z to 30 and lengths to 20 mm, a sixth of the sums is not the float of the next body's z."""
    z, long = (tenths.ravel() for tenths in np.meshgrid(np.arange(1, 301), np.arange(1, 201)))
    sums, stated = z / 10 + long / 10, (z + long) / 10
    off = sums != stated
    assert 0.08 < np.mean(sums > stated) < off.mean() < 0.2
    level = Levels(np.unique(stated).tolist())
    assert list(map(level, sums[off].tolist())) == stated[off].tolist()


def test_a_height_that_is_stated_takes_the_sums_about_it() -> None:
    level = Levels([32.4, 6.2])
    assert level(20.1 + 12.3) == 32.4 != 20.1 + 12.3
    assert level(1.1 + 5.1) == 6.2 != 1.1 + 5.1
    assert level(6.2 + 1e-8) == 6.2 + 1e-8


FLUSH = {  # lobes, journals and where the shaft ends: sums that round up and down, beside one another and at the end
    "up": ("at: 0, z: 20.1, length: 12.3", "at: 90, z: 32.4, length: 12", "", 60.0),
    "down": ("at: 0, z: 1.1, length: 5.1", "at: 90, z: 6.2, length: 12", "", 60.0),
    "a journal at the end, up": ("at: 0, z: 1, length: 5", "at: 90, z: 9, length: 5", "{z: 20.1, length: 12.3}", 32.4),
    "a journal at the end, down": ("at: 0, z: 1, length: 5", "at: 90, z: 9, length: 5", "{z: 24.9, length: 5.2}", 30.1),
    "a lobe at the end": ("at: 0, z: 1, length: 5", "at: 90, z: 20.1, length: 12.3", "", 32.4),
    "a journal between lobes": (
        "at: 0, z: 1.1, length: 5.1",
        "at: 90, z: 11.3, length: 5",
        "{z: 6.2, length: 5.1}",
        60,
    ),
}


@pytest.mark.thin(6)
@pytest.mark.parametrize(("first", "second", "journal", "end"), FLUSH.values(), ids=FLUSH)
def test_bodies_that_meet_face_to_face(tmp_path: Path, first: str, second: str, journal: str, end: float) -> None:
    bar = f"  journals: [{journal[:-1]}, diameter: 30}}]\n" if journal else ""
    body = f"  shaft: {{diameter: 24, to: {end}}}\n{bar}"
    path = shaft(tmp_path, f"recipe: intake.yaml, {first}\nrecipe: intake.yaml, {second}", files="[3mf]", body=body)
    report = camgeo.check(path)
    assert report.ok
    assert {check.name for check in report.checks} >= {"phase", "position", "thickness", "volume"}


@pytest.mark.slow
def test_equal_lobes_side_by_side_are_one_stretch(tmp_path: Path) -> None:
    """They have no face between them: their position is that of the faces at either end, in every solid."""
    pytest.importorskip("OCP")
    lobes = "at: 30, z: 20.1, length: 12.3\nat: -330, z: 32.4, length: 12\nat: 30, z: 44.4, length: 3"
    rows = "\n".join(f"recipe: intake.yaml, {row}" for row in lobes.splitlines())
    body = "  shaft: {diameter: 24, to: 60}\n"
    report = camgeo.export(shaft(tmp_path, rows, files="[stl, 3mf, step]", body=body), tmp_path / "out")
    assert report.ok
    assert sum(check.name == "position" for check in report.checks) == 9
    assert report.path is not None
    other = shaft(tmp_path, rows.replace("length: 3", "length: 3.02"), body=body)
    assert failing(camgeo.verify(other, report.path / "shaft.3mf")) == {"position, intake 3", "thickness"}
    turned = shaft(tmp_path, rows.replace("at: -330", "at: -329"), body=body)
    assert {"phase, intake 2", "contour, intake 2"} <= failing(camgeo.verify(turned, report.path / "shaft.3mf"))


def test_equal_lobes_of_a_solid_need_no_face_and_others_do(tmp_path: Path) -> None:
    """A file in which the second lobe is as the first, where it is meant to be turned, has no face there."""
    rows = "recipe: intake.yaml, at: 30, z: 20, length: 10\nrecipe: intake.yaml, at: {}, z: 30, length: 10"
    body = "  shaft: {diameter: 24, to: 60}\n"
    made = camgeo.export(shaft(tmp_path, rows.format(30), body=body), tmp_path / "out")
    assert made.path is not None
    fails = failing(camgeo.verify(shaft(tmp_path, rows.format(120), body=body), made.path / "shaft.stl"))
    assert {"phase, intake 2", "contour, intake 2", "motion, intake 2"} <= fails


THIN = {
    "a gap between lobes": (
        "at: 0, z: 1.1, length: 5.1\nat: 90, z: 6.2000001, length: 12",
        "camshaft.lobes[1].z: intake 1 and intake 2 are 1e-07 mm apart, which is too thin; let them ",
    ),
    "a gap before the end": (
        "at: 0, z: 1, length: 5\nat: 90, z: 20, length: 39.995",
        "camshaft.lobes[1].z: intake 2 and the shaft's upper end are 0.005 mm apart, which is too thin; let them ",
    ),
    "a gap at the lower end": (
        "at: 0, z: 0.001, length: 5\nat: 90, z: 20, length: 5",
        "camshaft.lobes[0].z: the shaft's lower end and intake 1 are 0.001 mm apart, which is too thin; let them ",
    ),
    "a lobe": (
        "at: 0, z: 1, length: 0.0000000001\nat: 90, z: 20, length: 5",
        "camshaft.lobes[0].length: intake 1 is too thin, 0 mm long; give a length of more than 0.01 mm, or ",
    ),
}


@pytest.mark.parametrize(("rows", "message"), THIN.values(), ids=THIN)
def test_what_is_thinner_than_the_tolerance_is_refused_by_name(tmp_path: Path, rows: str, message: str) -> None:
    lobes = "\n".join(f"recipe: intake.yaml, {row}" for row in rows.splitlines())
    body = "  shaft: {diameter: 24, to: 60}\n"
    with pytest.raises(camgeo.RecipeErrors, match=re.escape(message)):
        camgeo.check(shaft(tmp_path, lobes, body=body))


@pytest.mark.thin(2)
@pytest.mark.parametrize("z", ["6.2", "6.2101"], ids=["they meet", "farther apart"])
def test_what_would_do_for_a_thin_gap_does(tmp_path: Path, z: str) -> None:
    rows = f"recipe: intake.yaml, at: 0, z: 1.1, length: 5.1\nrecipe: intake.yaml, at: 90, z: {z}, length: 12"
    assert camgeo.check(shaft(tmp_path, rows, body="  shaft: {diameter: 24, to: 60}\n")).ok


@pytest.mark.slow
def test_a_thin_gap_is_held_where_the_tolerance_is_finer(tmp_path: Path) -> None:
    rows = "recipe: intake.yaml, at: 0, z: 1, length: 5\nrecipe: intake.yaml, at: 90, z: 6.001, length: 5"
    path = shaft(tmp_path, rows, files="[3mf, step]", body="  shaft: {diameter: 24, to: 60}\n")
    path.write_text(path.read_text().replace("tolerance: 0.01", "tolerance: 0.0009"))
    pytest.importorskip("OCP")
    assert camgeo.check(path).ok


# --- what is refused --------------------------------------------------------------------------------------------------


REFUSED = {
    "two in one place": (
        ("recipe: intake.yaml, at: 0, z: 30\nrecipe: intake.yaml, at: 9, z: 40", ""),
        "shaft.yaml:6:39: camshaft.lobes[1].z: intake 2 overlaps intake 1, which reaches from 30 to 44 mm; give",
    ),
    "no file": (
        ("recipe: nope.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: no such file, given 'nope.yaml'; give the path of a recipe from ",
    ),
    "no recipe": (
        ("recipe: secrets.txt, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: no recipe, given 'secrets.txt'; give the recipe of a cam\n",
    ),
    "a camshaft": (
        ("recipe: shaft.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: a camshaft is no lobe, given 'shaft.yaml'; give the recipe",
    ),
    "a fault of a lobe's own": (
        ("recipe: slip.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: SLIP:3:16: cam.base_radius: not above 0, given -18; give ",
    ),
    "no engine": (
        ("recipe: intake.yaml, cylinder: 1, valve: intake, z: 30", ""),
        "shaft.yaml:5:39: camshaft.lobes[0].cylinder: needs the engine's data; give camshaft.engine, or `at`",
    ),
    "a fifth cylinder": (
        ("recipe: intake.yaml, cylinder: 5, valve: intake, z: 30", ENGINE),
        "shaft.yaml:5:39: camshaft.lobes[0].cylinder: not in the firing order, given 5; give one of 1, 3, 4, 2",
    ),
    "no valve": (
        ("recipe: intake.yaml, cylinder: 1, z: 30", ENGINE),
        "shaft.yaml:5:7: camshaft.lobes[0].valve: missing, needed with cylinder; give intake or exhaust",
    ),
    "beyond the shaft": (
        ("recipe: intake.yaml, at: 0, z: 110", ""),
        "shaft.yaml:5:39: camshaft.lobes[0].z: it reaches from 110 to 124 mm, the shaft from 0 to 120 mm; ",
    ),
}


@pytest.mark.parametrize(("recipe", "message"), REFUSED.values(), ids=REFUSED)
def test_one_line_with_place_and_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], recipe: tuple[str, str], message: str
) -> None:
    path = shaft(tmp_path, *recipe)
    (tmp_path / "secrets.txt").write_text("root:x:0:0:root:/root:/bin/bash\n")
    (tmp_path / "slip.yaml").write_text(INTAKE.replace("18", "-18"))
    message = message.replace("SLIP", str(tmp_path / "slip.yaml"))
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1
    assert not (tmp_path / "out" / "shaft").exists()


def test_an_inch_shaft_tells_inches_and_its_lobes_are_in_their_own_unit(tmp_path: Path) -> None:
    """A lobe's recipe without `units` is in mm wherever it stands; the report is in the shaft's unit."""
    body = "  shaft: {diameter: 1, to: 2}\n"
    lobe = "recipe: intake.yaml, at: 0, z: {}, length: 0.5"
    report = camgeo.check(shaft(tmp_path, lobe.format(1), extra="units: inch\n", files="[csv]", body=body))
    (check,) = (check for check in report.checks if check.name == "shaft")
    assert check.value == pytest.approx(18 / 25.4)
    assert check.unit == "in"
    with pytest.raises(camgeo.RecipeErrors, match=r"it reaches from 1\.6 to 2\.1 inch, the shaft from 0 to 2 inch"):
        camgeo.check(shaft(tmp_path, lobe.format(1.6), extra="units: inch\n", body=body))


@pytest.mark.parametrize(
    "kind",
    [
        "dxf",
        "gcode",  # needs: milling
    ],
)
def test_a_drawing_is_that_of_a_lobe(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str) -> None:
    path = shaft(tmp_path, TWO, files=f"[{kind}]")
    assert main(["check", str(path)]) == 2
    assert f"a camshaft has no {kind}; export the lobe's own recipe" in capsys.readouterr().err


def test_a_shaft_as_thick_as_a_lobe_fails(tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO, body="  shaft: {diameter: 37, to: 120}\n")
    report = camgeo.check(path)
    assert failing(report) == {"shaft, intake"}
    assert json.loads(report.to_json())["files"] == []


@pytest.mark.parametrize(
    ("recipe", "message"),
    [
        ("w-booth", "two contacts on one arm are no lobe's"),
        ("disc-ring", "a ring, a groove or a pair is no lobe"),  # needs: milling
    ],
)
def test_what_is_no_lobe(tmp_path: Path, recipe: str, message: str) -> None:
    path = shaft(tmp_path, f"recipe: {RECIPES / recipe}.yaml, at: 0, z: 30, length: 9")
    with pytest.raises(camgeo.RecipeErrors, match=message):
        camgeo.check(path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["four-cylinder", "packaging"])
def test_shipped_camshafts(tmp_path: Path, name: str) -> None:
    report = camgeo.export(RECIPES / "camshafts" / f"{name}.yaml", tmp_path)
    assert report.ok
    assert report.path is not None
    mesh = trimesh.load(report.path / f"{name}.stl")
    assert mesh.is_watertight
    assert mesh.body_count == 1


@pytest.mark.slow
def test_twenty_four_lobes_beside_one_another(tmp_path: Path) -> None:
    """They touch; the mesh closes, and every one is judged."""
    rows = [f"recipe: intake.yaml, at: {15 * k}, z: {4 * k}, length: 4" for k in range(24)]
    body = "  shaft: {diameter: 24, from: -2, to: 100}\n"
    report = camgeo.check(shaft(tmp_path, "\n".join(rows), files="[stl]", body=body))
    assert report.ok
    assert sum(check.name == "phase" for check in report.checks) == 24


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


def test_the_page_has_the_diagrams_in_colours_of_its_own(solid: tuple[Path, camgeo.Report]) -> None:
    """No plate of white in the dark: every colour of a diagram is a class that the page's style knows."""
    _, report = solid
    assert report.path is not None
    text = (report.path / "shaft.html").read_text(encoding="utf-8")
    style, _, rest = text.partition("</style>")
    drawings = re.findall(r"<svg xmlns.*?</svg>", rest, re.DOTALL)
    assert drawings
    for drawing in drawings:
        coloured = re.findall(r"<\w+ [^>]*(?:fill|stroke)=\"#[^>]*>", drawing)
        named = [re.findall(r'class="([^"]+)"', element) for element in coloured]
        assert all(named)
        for (names,) in named:
            assert all(f".diagrams .{name} {{" in style for name in names.split())
    assert "prefers-color-scheme: dark" in style.partition(".diagrams {")[2]


@pytest.mark.parametrize("word", ["camshafxt", "cam_shaft", "Camshaft"])
def test_a_slip_in_the_word_camshaft_is_named(word: str, tmp_path: Path) -> None:
    path = tmp_path / "shaft.yaml"
    path.write_text(f"{word}: {{lobes: []}}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors) as caught:
        load_order(path)
    assert f"shaft.yaml:1:1: {word}: unknown key; did you mean camshaft?" in str(caught.value)
    path.write_text("cma: {kind: disc}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors, match=r"cma: unknown key; did you mean cam\?"):
        load_order(path)


@pytest.mark.parametrize("key", ["motion_error", "output_error"])
def test_what_a_lobe_is_permitted_stands_in_its_own_recipe(key: str, tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO)
    path.write_text(path.read_text().replace("verify: {", f"verify: {{{key}: 0.1, "), encoding="utf-8")
    with pytest.raises(RecipeErrors, match=rf"verify\.{key}: unknown key; the keys here are angles"):
        load_order(path)
    assert key not in starter("camshaft")


def test_separation_and_advance_are_the_centres_that_they_make(tmp_path: Path) -> None:
    lobes = "recipe: intake.yaml, cylinder: 1, valve: intake, z: 25\n"
    lobes += "recipe: exhaust.yaml, cylinder: 1, valve: exhaust, z: 50"
    files = "[{csv: {as: events}}]"
    told = []
    for centres in ("separation: 110, advance: 4", "intake: 106, exhaust: 114"):
        path = shaft(tmp_path, lobes, f"  engine: {{order: [1], {centres}}}\n", files=files)
        told.append(dict(camgeo.export(path, tmp_path / "out"))["camshaft"])
    assert told[0] == told[1]
    assert told[0]["cylinders"][0]["separation"] == pytest.approx(110.0, abs=1e-9)


@pytest.mark.parametrize(
    ("engine", "message"),
    [
        ("order: [1]", "camshaft.engine: needs intake or separation; give exactly one of them"),
        ("order: [1], intake: 106, exhaust: 114, separation: 110", "separation: cannot be combined with intake"),
        ("order: [1], separation: 110, exhaust: 114", "exhaust: cannot be combined with separation; leave it out"),
        ("order: [1], intake: 106", "camshaft.engine.exhaust: missing, needed with intake"),
        ("order: [1], intake: 106, exhaust: 114, advance: 4", "advance: needs the lobes' separation; leave it out"),
    ],
)
def test_centres_are_given_one_way(engine: str, message: str, tmp_path: Path) -> None:
    path = shaft(tmp_path, "recipe: intake.yaml, cylinder: 1, valve: intake, z: 25", f"  engine: {{{engine}}}\n")
    with pytest.raises(RecipeErrors) as caught:
        load_order(path)
    assert message in str(caught.value)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["manifold3d", "OCP"])
def test_a_solid_that_a_missing_package_would_make_is_left_out(tmp_path, monkeypatch, capsys, name):
    """The rest is judged and placed as one set; where nothing is left nothing is written."""
    monkeypatch.setitem(sys.modules, name, None)
    kept, gone = ("step", "stl") if name == "manifold3d" else ("stl", "step")
    if kept == "step":
        pytest.importorskip("OCP", reason="a STEP file is written by Open CASCADE")
    path = shaft(tmp_path, "recipe: intake.yaml, z: 30, at: 0", files=f"[{kept}, {gone}, csv, html]")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == SURROUNDINGS
    assert f"camgeo: shaft: shaft.{gone} is left out: " in capsys.readouterr().err
    files = ["report.json", "shaft.csv", "shaft.html", f"shaft.{kept}"]
    assert sorted(file.name for file in (tmp_path / "out/shaft").iterdir()) == files
    report = json.loads((tmp_path / "out/shaft/report.json").read_text("utf-8"))
    assert report["skipped"][0]["what"] == f"shaft.{gone}"
    assert report["skipped"][0]["missing"]
    alone = shaft(tmp_path, "recipe: intake.yaml, z: 30, at: 0", files=f"[{gone}]")
    assert main(["check", str(alone)]) == SURROUNDINGS
    with pytest.raises(camgeo.SurroundingsError):
        camgeo.export(alone, tmp_path / "none")
    assert not (tmp_path / "none/shaft").exists()


def test_a_camshaft_has_no_page_of_a_file(tmp_path):
    report = camgeo.export(shaft(tmp_path, "recipe: intake.yaml, z: 30, at: 0"), tmp_path)
    with pytest.raises(camgeo.CallError, match="a page shows the files of one cam; give the recipe of a lobe"):
        camgeo.verify(tmp_path / "shaft.yaml", report.files[0].path, page=True)
