"""The valve that a tappet works: its events and peaks by hand, a rocker by a table, limits, files, camshafts.

Holds: camgeo.capabilities.valve.figures, camgeo.capabilities.valve.keys, camgeo.capabilities.valve.measures,
camgeo.capabilities.valve.section, camgeo.capabilities.valve.table.
"""

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.heavy import interpolate

import camgeo
from camgeo.capabilities.valve.train import Valve
from camgeo.schema.errors import RecipeErrors

LOBE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26], nose: 180}}
part: {thickness: 14}
"""
VALVE = "valve: {ratio: 1.6, lash: 0.30}\n"
ROCKER = "valve: {ratio: {table: [[0, 1.5], [3, 1.58], [6, 1.62], [9, 1.6]]}, lash: 0.30}\n"


def measured(text: str, bounds: str) -> list[float | None]:
    """What is measured of each figure that is bounded, in the order given."""
    report = camgeo.check(camgeo.load(f"{text}limits: {{{bounds}}}\n"))
    return [check.value for check in report.checks if check.name.startswith("limit:")]


def lift(degrees: Any) -> Any:
    """Lift, velocity and acceleration of the tappet, by rad, at cam degrees from the nose."""
    u, half = np.radians(degrees) / math.radians(68), math.radians(68)
    powers, made = (2, 8, 14, 20, 26), np.zeros((3, *np.shape(u)))
    made[0] = 8.0
    for k in powers:
        c = -8.0 * math.prod(other / (other - k) for other in powers if other != k)
        made += [c * u**k, c * k * u ** (k - 1) / half, c * k * (k - 1) * u ** (k - 2) / half**2]
    return made


@pytest.mark.slow
def test_durations_are_those_of_the_tappet_at_the_lift_less_the_lash() -> None:
    """Case f18 by the key: the valve is 1 mm open where the tappet lifts 1.3/1.6 mm."""
    lifts = "[{at_lift: 0, at_least: 1}, {at_lift: 1, at_least: 1}, {at_lift: 0.18, at_least: 1}]"
    found = measured(LOBE + VALVE, f"valve-duration: {lifts}")
    assert found == pytest.approx([229.032572283, 205.365783367, 222.970764724], abs=6e-10)
    assert measured(LOBE + VALVE, "valve-lift: {at_least: 1}") == pytest.approx([12.5], abs=1e-12)


def test_velocity_and_acceleration_while_it_is_open() -> None:
    degrees = np.linspace(0.0, 229.032572283 / 4, 400_001)
    rows = 1.6 * lift(degrees)
    bounds = "valve-velocity: {at_most: 1}, valve-acceleration: {at_most: 1}, valve-seating: {at_most: 1}"
    velocity, acceleration, seating = measured(LOBE + VALVE, bounds)
    assert velocity == pytest.approx(np.abs(rows[1]).max(), rel=1e-9)
    assert acceleration == pytest.approx(np.abs(rows[2]).max(), rel=1e-9)
    assert seating == pytest.approx(math.radians(abs(rows[1][-1])), rel=1e-9)
    # 1832.860583452 mm/s at 6000 crank rpm, as case f18 has it
    assert seating is not None
    assert seating * 6.0 * 3000.0 == pytest.approx(1832.860583452, abs=6e-9)


@pytest.mark.slow
def test_a_rocker_by_a_table_is_a_natural_cubic_spline_of_the_ratio() -> None:
    valve = camgeo.load(LOBE + ROCKER).of(Valve)
    assert valve is not None
    x = np.linspace(0.0, 8.0, 201)
    spline = interpolate.CubicSpline([0, 3, 6, 9], [1.5, 1.58, 1.62, 1.6], bc_type="natural")
    r, slope, bend = (spline(x, k) for k in range(3))
    assert valve.travel(x) == pytest.approx(np.array([r * x, slope * x + r, bend * x + 2 * slope]), abs=1e-12)
    for wanted in (0.0, 1.0, 7.5):
        assert valve.travel(np.array([valve.follower_lift(wanted)]))[0, 0] == pytest.approx(wanted + 0.3, abs=1e-12)
    found = measured(LOBE + ROCKER, "valve-lift: {at_least: 1}, valve-acceleration: {at_most: 1}")
    rows = valve.rows(lift(np.linspace(-57.0, 57.0, 400_001)))
    assert found == pytest.approx([rows[0].max(), np.abs(rows[2]).max()], rel=1e-9)


@pytest.mark.slow
def test_a_table_of_one_ratio_is_that_ratio() -> None:
    flat = "valve: {ratio: {table: [[0, 1.6], [4, 1.6], [8, 1.6]]}, lash: 0.30}\n"
    bounds = "valve-duration: {at_least: 1}, valve-velocity: {at_most: 1}, valve-acceleration: {at_most: 1}"
    assert measured(LOBE + flat, bounds) == pytest.approx(measured(LOBE + VALVE, bounds), rel=1e-12)


def test_files_report_and_page(tmp_path: Path) -> None:
    (tmp_path / "rocker.csv").write_text("# measured\ntappet;ratio\n0;1.5\n3;1.58\n6;1.62\n9;1.6\n", encoding="utf-8")
    text = LOBE + "valve: {ratio: {table: rocker.csv}, lash: 0.30}\n"
    (tmp_path / "lobe.yaml").write_text(f"{text}export: {{files: [{{csv: {{as: valve}}}}, html]}}\n", encoding="utf-8")
    report: dict[str, Any] = dict(camgeo.export(tmp_path / "lobe.yaml", tmp_path))
    entry = report["valve"]
    assert (entry["lash"], entry["unit"]) == (0.3, "mm")
    assert entry["ratio"] == [[0.0, 1.5], [3.0, 1.58], [6.0, 1.62], [9.0, 1.6]]
    seat, open_ = entry["events"]
    assert (seat["lift"], open_["lift"]) == (0.0, 1.0)
    assert seat["duration_crank_deg"] > open_["duration_crank_deg"]
    with (tmp_path / "lobe" / "lobe.csv").open(encoding="utf-8") as file:
        rows = {float(row["shaft_deg"]): row for row in csv.DictReader(file)}
    assert float(rows[180.0]["valve_mm"]) == pytest.approx(entry["lift"], rel=1e-11)
    assert float(rows[180.0]["crank_deg"]) == 360.0
    closed = [row for at, row in rows.items() if not seat["opens_deg"] < at < seat["closes_deg"]]
    assert {row["valve_mm"] for row in closed} == {"0"}
    page = (tmp_path / "lobe" / "lobe.html").read_text(encoding="utf-8")
    assert all(words in page for words in ("Valve lift", "Valve acceleration", "Valve events", "ratio by a table"))


@pytest.mark.slow
@pytest.mark.parametrize("lash", ["", ", lash: 0"])
@pytest.mark.parametrize("nose", ["180", "0"])
def test_without_lash_the_valve_is_open_while_the_tappet_is_off_its_lowest_place(lash: str, nose: str) -> None:
    bounds = "valve-duration: {at_lift: 0, at_least: 1}, valve-seating: {at_most: 1}, valve-velocity: {at_most: 1}"
    lobe = LOBE.replace("nose: 180", f"nose: {nose}")
    duration, seating, velocity = measured(f"{lobe}valve: {{ratio: 1.6{lash}}}\n", bounds)
    assert duration == pytest.approx(4 * 68, abs=1e-9)
    assert seating == pytest.approx(0.0, abs=1e-12)
    assert velocity == pytest.approx(np.abs(1.6 * lift(np.linspace(0.0, 68.0, 400_001))[1]).max(), rel=1e-9)


@pytest.mark.parametrize(
    ("rows", "units"),
    [
        ("lift_in,ratio\n0,1.5\n0.15748031496,1.6\n0.35433070866,1.58\n", "mm"),
        ("Lift [mm];ratio\n0;1,5\n4;1,6\n9;1,58\n", "inch"),
        ("0 1.5\n4 1.6\n9 1.58\n", "mm"),
    ],
)
def test_a_rockers_table_is_in_the_unit_of_its_heading(tmp_path: Path, rows: str, units: str) -> None:
    (tmp_path / "rocker.csv").write_text(rows, encoding="utf-8")
    lobe = LOBE.replace("base_radius: 18", "base_radius: 18 mm").replace("lift: 8", "lift: 8 mm")
    text = f"units: {units}\n{lobe.replace('14}', '14 mm}')}valve: {{ratio: {{table: rocker.csv}}, lash: 0.3 mm}}\n"
    (tmp_path / "lobe.yaml").write_text(text, encoding="utf-8")
    valve = camgeo.load(tmp_path / "lobe.yaml").of(Valve)
    assert valve is not None
    assert np.array(valve.ratios) == pytest.approx(np.array([[0, 1.5], [4, 1.6], [9, 1.58]]), abs=1e-9)


def test_a_rockers_table_of_angles_is_refused(tmp_path: Path) -> None:
    text = LOBE + "valve: {ratio: {table: rocker.csv}}\n"
    (tmp_path / "lobe.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "rocker.csv").write_text("lift_deg,ratio\n0,1.5\n9,1.58\n", encoding="utf-8")
    with pytest.raises(RecipeErrors, match="the column 'lift_deg' is in degrees; a length is meant here"):
        camgeo.load(tmp_path / "lobe.yaml")


@pytest.mark.slow
def test_a_limit_says_that_the_valve_does_not_lift_so_far() -> None:
    bounds = "limits: {valve-duration: {at_lift: 13, at_least: 1}}\n"
    for lash, words in (("0.30", "the valve lifts 12.5 mm"), ("20", "the valve never opens with a lash of 20 mm")):
        report = camgeo.check(camgeo.load(LOBE + VALVE.replace("0.30", lash) + bounds))
        (limit,) = (check for check in report.checks if check.name == "limit:valve-duration")
        assert not limit.ok
        assert f"{words}, and is not above 13 mm" in limit.detail


def test_inches_are_the_same_valve() -> None:
    inch = LOBE.replace("18", "18/25.4").replace("lift: 8", "lift: 8/25.4").replace("14}", "14/25.4}")
    text = f"units: inch\n{inch}valve: {{ratio: 1.6, lash: 0.30/25.4}}\n"
    found = measured(text, "valve-duration: {at_lift: 1 mm, at_least: 1}, valve-lift: {at_least: 1}")
    assert found == pytest.approx([205.365783367, 12.5 / 25.4], abs=6e-10)


@pytest.mark.thin(8)
@pytest.mark.parametrize(
    ("valve", "message", "remedy"),
    [
        ("{lash: 0.3}", "valve.ratio: missing", "{ratio: 1.6, lash: 0.3}"),
        ("{ratio: 0}", "valve.ratio: not above 0", "{ratio: 1.6}"),
        ("{ratio: 1.6, lash: -1}", "valve.lash: below 0", "{ratio: 1.6}"),
        (
            "{ratio: {table: [[0, 1.5], [1e300, 1.6]]}}",
            "line 2: a tappet lifts up to 2e+06 mm",
            "{ratio: {table: [[0, 1.5], [9, 1.6]]}}",
        ),
        (
            "{ratio: {table: [[1, 1.5], [9, 1.6]]}}",
            "the tappet lifts do not rise from 0",
            "{ratio: {table: [[0, 1.5], [9, 1.6]]}}",
        ),
        ("{ratio: {table: [[0, 1.5]]}}", "1 rows", "{ratio: {table: [[0, 1.5], [9, 1.6]]}}"),
        (
            "{ratio: {table: [[0, 1.5], [7, 1.6]]}}",
            "valve.ratio.table: the table ends at a tappet lift of 7, the tappet lifts 8; give rows up to 8 or more",
            "{ratio: {table: [[0, 1.5], [8, 1.6]]}}",
        ),
        (
            "{ratio: {table: [[0, 1.5], [4, 1.6], [9, 0.1]]}}",
            "valve.ratio.table: the valve falls while the tappet rises; give ratios that fall less steeply",
            "{ratio: {table: [[0, 1.5], [4, 1.6], [9, 1.4]]}}",
        ),
    ],
)
def test_faults_and_what_mends_them(valve: str, message: str, remedy: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        camgeo.check(camgeo.load(f"{LOBE}valve: {valve}\n"))
    assert message in str(caught.value)
    assert camgeo.check(camgeo.load(f"{LOBE}valve: {remedy}\n")).ok


def test_a_ratio_that_falls_steeply_between_close_rows_lets_the_valve_fall() -> None:
    """Rows 0.1 um apart, of which two fall by 4e-5: the travel's slope 1.5 - 4 (4e-5/1e-4) is below 0 over 0.1 um."""
    steps = [[round(4.002 + 1e-4 * k, 6), 1.5 if k < 0 else 1.49996] for k in range(-8, 8)]
    table = f"valve: {{ratio: {{table: {[[0, 1.5], *steps, [9, 1.49996]]}}}, lash: 0.1}}\n"
    with pytest.raises(camgeo.RecipeErrors, match="the valve falls while the tappet rises"):
        camgeo.check(camgeo.load(LOBE + table))


def test_a_follower_on_an_arm_works_no_valve() -> None:
    arm = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8, arm: {length: 60, pivot: 70}}, "
    arm += "motion: [{rise: 10, over: 120, law: cycloidal}, {return: 10, over: 120, law: cycloidal}, {dwell: 120}]}\n"
    with pytest.raises(RecipeErrors, match="a valve is worked by a tappet, a follower on a stem"):
        camgeo.load(arm + VALVE)


def test_a_lash_that_is_never_taken_up_has_no_events() -> None:
    report: dict[str, Any] = dict(camgeo.check(camgeo.load(f"{LOBE}valve: {{ratio: 1, lash: 9}}\n")))
    assert report["valve"]["lift"] == 0.0
    assert report["valve"]["events"][0]["duration_crank_deg"] is None


# needs: camshaft
@pytest.mark.thin(2)
@pytest.mark.parametrize("valve", [VALVE, ROCKER])
def test_a_camshaft_tells_its_events_at_the_valve(valve: str, tmp_path: Path) -> None:
    (tmp_path / "lobe.yaml").write_text(LOBE + valve, encoding="utf-8")
    body = "camshaft:\n  shaft: {diameter: 24, to: 60}\n  lobes:\n"
    body += "    - {recipe: lobe.yaml, cylinder: 1, valve: intake, z: 5}\n"
    body += "    - {recipe: lobe.yaml, cylinder: 1, valve: exhaust, z: 30}\n"
    told = {}
    at = camgeo.load(LOBE + valve).of(Valve)
    assert at is not None
    for name, where in (("valve", "valve_lift: 1"), ("tappet", f"lift: {at.follower_lift(1.0)!r}")):
        engine = f"  engine: {{order: [1], separation: 110, {where}}}\n"
        files = "export: {files: [{csv: {as: events}}, {csv: {as: motion}}, {svg: {as: crank-wheel}}]}\n"
        (tmp_path / f"{name}.yaml").write_text(body + engine + files, encoding="utf-8")
        told[name] = dict(camgeo.export(tmp_path / f"{name}.yaml", tmp_path))["camshaft"]["cylinders"][0]
    assert told["valve"] == pytest.approx(told["tappet"], abs=1e-9)
    with (tmp_path / "valve" / "valve-motion.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert max(float(row["cylinder_1_intake_valve_mm"]) for row in rows) == pytest.approx(12.5, abs=0.5)
    assert "of the valve" in (tmp_path / "valve" / "valve.svg").read_text(encoding="utf-8")


# needs: camshaft
def test_a_camshaft_at_valves_that_no_lobe_tells_of_is_refused(tmp_path: Path) -> None:
    (tmp_path / "lobe.yaml").write_text(LOBE, encoding="utf-8")
    body = (
        "camshaft:\n  shaft: {diameter: 24, to: 60}\n  lobes: [{recipe: lobe.yaml, cylinder: 1, valve: intake, z: 5}]\n"
    )
    path = tmp_path / "shaft.yaml"
    path.write_text(f"{body}  engine: {{order: [1], separation: 110, valve_lift: 1}}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors, match=r"lobe\.yaml tells of no valve; give `valve: \{ratio: \.\.\., lash: "):
        camgeo.check(path)
    (tmp_path / "lobe.yaml").write_text(LOBE + VALVE, encoding="utf-8")
    assert camgeo.check(path).ok


# needs: camshaft
@pytest.mark.slow
def test_a_lobe_without_a_valve_has_no_events_at_the_lift_of_valves(tmp_path: Path) -> None:
    """Of a lobe that works no valve, as a pump's, the middle of its stroke is told, as of one whose follower swings."""
    (tmp_path / "lobe.yaml").write_text(LOBE + VALVE, encoding="utf-8")
    (tmp_path / "pump.yaml").write_text(LOBE, encoding="utf-8")
    path = tmp_path / "shaft.yaml"
    path.write_text(
        "camshaft:\n  shaft: {diameter: 24, to: 60}\n  lobes:\n"
        "    - {recipe: lobe.yaml, cylinder: 1, valve: intake, z: 5}\n"
        "    - {recipe: pump.yaml, at: 40, z: 30}\n"
        "  engine: {order: [1], separation: 110, valve_lift: 1}\n",
        encoding="utf-8",
    )
    report: dict[str, Any] = dict(camgeo.check(path))
    own, pump = report["camshaft"]["lobes"]
    assert own["lift"] == pytest.approx((1.0 + 0.30) / 1.6, abs=1e-12)
    assert pump["lift"] == pytest.approx(4.0, abs=1e-9)


@pytest.mark.thin(2)
@pytest.mark.parametrize(("units", "lifts"), [("mm", (0.1, 1.0)), ("inch", (0.006, 0.05, 0.2))])
def test_the_tappets_durations_at_the_lifts_of_cards_are_told_without_a_limit(
    units: str, lifts: tuple[float, ...]
) -> None:
    """A formula's lift of 4 (1 - cos t): above s for 2 (pi - acos(1 - s/4)) of the cam, twice that of the crank."""
    mm = 1.0 if units == "mm" else 25.4
    text = f"units: {units}\ncam: {{kind: disc, base_radius: {30 / mm}, follower: {{kind: flat}}, "
    text += f"motion: {{formula: {4 / mm}*(1 - cos(t))}}}}\nvalve: {{ratio: 1.5}}\n"
    told = camgeo.check(camgeo.load(text))["valve"]["tappet"]
    assert tuple(row["lift"] for row in told) == lifts
    for row in told:
        open_for = 2.0 * (math.pi - math.acos(1.0 - row["lift"] * mm / 4.0))
        assert row["duration_crank_deg"] == pytest.approx(2.0 * math.degrees(open_for), abs=1e-6)
        assert row["centre_deg"] == pytest.approx(180.0, abs=1e-6)
