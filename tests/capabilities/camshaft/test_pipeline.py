"""Camshafts: lobes where they belong, at their angle, judged in the solid as it lies on disk; an engine's events.

Holds: camgeo.capabilities.camshaft, camgeo.capabilities.camshaft.body, camgeo.capabilities.camshaft.shaft_page,
camgeo.capabilities.camshaft.root, camgeo.capabilities.camshaft.extension, camgeo.capabilities.camshaft.section,
camgeo.capabilities.camshaft.tables.
"""

import csv
import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from support.camshafts import ENGINE, INTAKE, ROLLER, SHAFT, TWO, shaft
from support.heavy import trimesh

import camgeo
from camgeo.capabilities.camshaft.diagrams import LEFT, RIGHT
from camgeo.capabilities.camshaft.svg import WIDTH
from camgeo.cli.exit_status import SURROUNDINGS
from camgeo.cli.main import main
from camgeo.common.clock import Clock
from camgeo.recipe.loading import load_order
from kin.judge.camshaft import verify_camshaft

RECIPES = Path(__file__).parents[3] / "recipes"


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
    first = dict(engine)["camshaft"]["lobes"][0]
    assert (first["opens_crank_deg"], first["opens_deg"]) == pytest.approx((369.750709, 184.8753543), abs=1e-6)
    assert first["closes_crank_deg"] - first["opens_crank_deg"] == pytest.approx(200.498582789, abs=1e-8)
    rows = list(csv.DictReader((engine.path / "shaft-motion.csv").read_text().splitlines()))
    assert [float(row["shaft_deg"]) for row in rows] == [*range(361)]
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


@pytest.mark.slow
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
    assert "lifts over the shaft" in (report.path / "shaft.svg").read_text(encoding="utf-8")


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
    text = (report.path / "shaft.html").read_text(encoding="utf-8")
    assert "<script" not in text
    assert "{{" not in text
    assert "Content-Security-Policy" in text.partition("</head>")[0]
    assert "every check holds" in text
    assert "<button" not in text
    assert re.search(r"position, roller", text)


def test_events_of_the_page_are_to_a_hundredth_of_a_degree(engine: camgeo.Report) -> None:
    """All cells of a column have as many decimals; the exact number is a hint."""
    assert engine.path is not None
    text = (engine.path / "shaft.html").read_text(encoding="utf-8")
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_equal_lobes_of_a_solid_need_no_face_and_others_do(tmp_path: Path) -> None:
    """A file in which the second lobe is as the first, where it is meant to be turned, has no face there."""
    rows = "recipe: intake.yaml, at: 30, z: 20, length: 10\nrecipe: intake.yaml, at: {}, z: 30, length: 10"
    body = "  shaft: {diameter: 24, to: 60}\n"
    made = camgeo.export(shaft(tmp_path, rows.format(30), body=body), tmp_path / "out")
    assert made.path is not None
    fails = failing(camgeo.verify(shaft(tmp_path, rows.format(120), body=body), made.path / "shaft.stl"))
    assert {"phase, intake 2", "contour, intake 2", "motion, intake 2"} <= fails


@pytest.mark.slow
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


def test_a_shaft_as_thick_as_a_lobe_fails(tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO, body="  shaft: {diameter: 37, to: 120}\n")
    report = camgeo.check(path)
    assert failing(report) == {"shaft, intake"}
    assert json.loads(report.to_json())["files"] == []


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


@pytest.mark.slow
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
