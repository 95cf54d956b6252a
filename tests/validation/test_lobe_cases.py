"""Worked cases of valve lobes and camshafts, through recipe and report: f18 to f20, f23, d21."""

import csv
from itertools import pairwise
from pathlib import Path

import pytest

import camgeo

LOBE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: %s}
  motion: {lobe: {lift: %s, half: %s, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14, density: 7850}
"""
INTAKE, EXHAUST = LOBE % ("flat", 8, 68), LOBE % ("flat", 7.6, 65)


def limits(text: str, bounds: str) -> list[float | None]:
    """What is measured of each figure that is bounded, in the order given."""
    report = camgeo.check(camgeo.load(f"{text}limits: {{{bounds}}}\n"))
    return [check.value for check in report.checks if check.name.startswith("limit:")]


def rows(path: Path) -> list[dict[str, float]]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return [{key: float(cell) for key, cell in row.items() if cell} for row in csv.DictReader(lines)]


def at(table: list[dict[str, float]], key: str, angle: float) -> dict[str, float]:
    return next(row for row in table if row[key] == pytest.approx(angle, abs=1e-9))


@pytest.mark.slow
def test_f18_lifts_of_the_valve_are_stated_at_the_tappet() -> None:
    """Ratio 1.6, lash 0.30 at the valve: the valve's lift is 1.6 S - 0.30, so that S is (lift + lash)/ratio."""
    lifts = "[{at_lift: 0.30/1.6, at_least: 1}, {at_lift: (1 + 0.30)/1.6, at_least: 1}, {at_lift: 0.30, at_least: 1}]"
    durations = limits(INTAKE, f"duration: {lifts}")
    assert durations == pytest.approx([229.032572283, 205.365783367, 222.970764724], abs=6e-10)
    (velocity,) = limits(INTAKE, "ramp-velocity: {at_lift: 0.30/1.6, at_most: 1}")
    assert velocity is not None
    assert 1.6 * velocity * 6.0 * 3000.0 == pytest.approx(1832.860583452, abs=6e-9)  # mm/s at 6000 crank rpm
    # the closed form; the case's own quadrature ends in ...872
    assert limits(INTAKE, "lift-area: {at_most: 1000}") == pytest.approx([551.876848041457], abs=1e-11)


def test_f18_the_same_valve_lift_at_another_ratio() -> None:
    design = camgeo.design(camgeo.load(LOBE % ("flat", "8*1.6/1.75", 68)))
    assert design.motion([0.0, 3.141592653589793 / 9]) == pytest.approx([7.314285714, 6.130322681], abs=6e-10)


TAPPETS = {
    "flat": ("flat", (22.425104204, 5.792491495)),
    "roller": ("roller, radius: 9", (16.971749157, 12.181623197)),
    "shoe": ("shoe, radius: 200", (21.861647377, 6.759423384)),
}


@pytest.mark.thin(3)
@pytest.mark.parametrize(("follower", "point"), TAPPETS.values(), ids=TAPPETS)
def test_f19_one_lift_under_another_tappet_is_other_metal(
    tmp_path: Path, follower: str, point: tuple[float, float]
) -> None:
    text = LOBE % (follower, 8, 68) + "export: {files: [{csv: {as: contacts}}]}\n"
    (tmp_path / "lobe.yaml").write_text(text, encoding="utf-8")
    report = camgeo.export(tmp_path / "lobe.yaml", tmp_path)
    assert report.path is not None
    row = at(rows(report.path / "lobe.csv"), "shaft_deg", 45.0)
    assert (row["x_mm"], row["y_mm"]) == pytest.approx(point, abs=6e-10)
    assert row["lift_mm"] == pytest.approx(1.952853268, abs=6e-10)


@pytest.mark.slow
def test_f19_a_roller_on_the_metal_of_a_flat_tappet(tmp_path: Path) -> None:
    """The table of the lift that it has there is read as a motion, whose duration is not the tappet's."""
    export = "export: {tolerance: 0.001, files: [{csv: {as: lift, roller: 18, step: 0.5}}]}\n"
    (tmp_path / "lobe.yaml").write_text(INTAKE + export, encoding="utf-8")
    report = camgeo.export(tmp_path / "lobe.yaml", tmp_path)
    assert report.path is not None
    path = report.path / "lobe.csv"
    table = rows(path)
    lifts = [at(table, "c_deg", angle)["lift_mm"] for angle in (20.0, 45.0)]
    assert lifts == pytest.approx([4.908802073, 0.786343512], abs=6e-10)
    crossing = next(
        a["c_deg"] + (a["lift_mm"] - 1.27) / (a["lift_mm"] - b["lift_mm"]) * (b["c_deg"] - a["c_deg"])
        for a, b in pairwise(table)
        if a["lift_mm"] > 1.27 >= b["lift_mm"]
    )
    assert 4.0 * crossing == pytest.approx(161.322165148, abs=0.01)  # of straight joins
    felt = f"cam: {{kind: disc, base_radius: 18, follower: {{kind: roller, radius: 9}}, motion: {{table: {path}, "
    felt += "reading: 0.0001}}\n"
    (duration,) = limits(felt, "duration: {at_least: 1}")
    assert duration == pytest.approx(161.322165148, abs=0.005)
    assert limits(INTAKE, "duration: {at_least: 1}") == pytest.approx([194.148296112], abs=6e-10)


ORDER = (1, 3, 4, 2)


# needs: camshaft
def camshaft(folder: Path, engine: str, lobes: str) -> camgeo.Report:
    """A shaft of two recipes, intake and exhaust, by its tables."""
    (folder / "intake.yaml").write_text(INTAKE, encoding="utf-8")
    (folder / "exhaust.yaml").write_text(EXHAUST, encoding="utf-8")
    text = f"camshaft:\n  shaft: {{diameter: 24, from: -10, to: 200}}\n  lobes:\n{lobes}  engine: {{{engine}}}\n"
    (folder / "shaft.yaml").write_text(f"{text}export: {{files: [{{csv: {{as: events}}}}]}}\n", encoding="utf-8")
    return camgeo.export(folder / "shaft.yaml", folder)


# needs: camshaft
def four(folder: Path, engine: str) -> camgeo.Report:
    rows = [
        f"    - {{recipe: {valve}.yaml, cylinder: {cylinder}, valve: {valve}, z: {40 * k + 20 * j}}}\n"
        for k, cylinder in enumerate(ORDER)
        for j, valve in enumerate(("intake", "exhaust"))
    ]
    return camshaft(folder, f"order: [1, 3, 4, 2], {engine}", "".join(rows))


F20 = {  # crank degrees after the firing dead centre of cylinder 1: IVO, IVC, EVO, EVC
    1: (369.750709, 570.249291, 150.789980, 341.210020),
    3: (549.750709, 30.249291, 330.789980, 521.210020),
    4: (9.750709, 210.249291, 510.789980, 701.210020),
    2: (189.750709, 390.249291, 690.789980, 161.210020),
}


# needs: camshaft
def test_f20_events_of_each_cylinder(tmp_path: Path) -> None:
    lobes = dict(four(tmp_path, "intake: 110, exhaust: 114, lift: 1"))["camshaft"]["lobes"]
    for k, cylinder in enumerate(ORDER):
        intake, exhaust = lobes[2 * k], lobes[2 * k + 1]
        events = [lobe[key] for lobe in (intake, exhaust) for key in ("opens_crank_deg", "closes_crank_deg")]
        assert events == pytest.approx(F20[cylinder], abs=6e-7)
        assert 2.0 * intake["duration_deg"] == pytest.approx(200.498582789, abs=6e-9)
        assert 2.0 * exhaust["duration_deg"] == pytest.approx(190.420040535, abs=6e-9)


# needs: camshaft
def test_d21_lobe_centres(tmp_path: Path) -> None:
    """Intake at 108 after, exhaust at 112 before dead centre; the noses of even lobes stand at their centres."""
    section = dict(four(tmp_path, "intake: 108, exhaust: 112"))["camshaft"]
    expected = {1: (234, 124), 3: (324, 214), 4: (54, 304), 2: (144, 34)}
    for k, cylinder in enumerate(ORDER):
        own = section["lobes"][2 * k : 2 * k + 2]
        assert [lobe["centre_deg"] for lobe in own] == pytest.approx(expected[cylinder], abs=1e-9)
        assert [lobe["at_deg"] for lobe in own] == pytest.approx(expected[cylinder], abs=1e-9)
    assert [row["separation"] for row in section["cylinders"]] == pytest.approx([110.0] * 4)


# needs: camshaft
def test_d21_events_of_230_and_236_crank_degrees() -> None:
    """Durations of 230 and 236: open at 234 -+ 57.5 and at 124 -+ 59 cam degrees."""
    from camgeo.capabilities.camshaft.events import Event, valves_of

    intake = Event(234 - 57.5, 234 + 57.5, 234, 115)
    exhaust = Event(124 - 59, 124 + 59, 124, 118)
    assert valves_of(intake, exhaust, 0.0) == pytest.approx((7, 43, 50, 6, 13, 110), abs=1e-12)


# needs: camshaft
def test_f23_corrections_in_two_planes(tmp_path: Path) -> None:
    """Four lobes whose unbalance is none: masses in planes at -10 and 114 take the couple, which is over 124 mm."""
    lobes = "".join(
        f"    - {{recipe: intake.yaml, at: {angle}, z: {z}}}\n"
        for angle, z in ((235, 0), (145, 30), (325, 60), (55, 90))
    )
    balance = dict(camshaft(tmp_path, "order: [1], intake: 110, exhaust: 114", lobes))["camshaft"]["balance"]
    assert balance["unbalance_kg_mm"] == pytest.approx(0.0, abs=1e-12)
    assert balance["couple_kg_mm2"] / 124.0 == pytest.approx(0.212982616, abs=6e-10)
    assert balance["couple_deg"] == pytest.approx(36.565051177, abs=6e-9)
