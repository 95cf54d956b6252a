# needs: camshaft
"""Points of camshafts: each lobe by its own recipe, phases between lobes, and what is no point of a lobe.

Holds: kin.made.shaft_alike, camgeo.capabilities.made.camshaft, camgeo.capabilities.made.verify_shaft,
camgeo.synthesis.shaft_cam.
"""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from support.measured import bump
from support.shafts import HEAD, Planted, camshaft, shaft_points, written

import camgeo
from camgeo.cli.main import main
from camgeo.common.errors import CallError

NAMES = ["flat", "roller", "arm"]
LISTED = "lobes are 1 to 3, or flat, roller, arm"
LIMITS = "made: {profile: 0.03}\nverify: {motion_error: 0.02, angles: 360}\n"


def lobes_of(report):
    return {lobe["name"]: lobe for lobe in report["made"]["lobes"]}


@pytest.mark.thin(3)
@pytest.mark.parametrize("more", ["", "rotation: ccw\n", "units: inch\n"])
def test_a_clean_shaft_holds_and_shows_no_phase(more, tmp_path):
    recipe = camshaft(tmp_path, limits=LIMITS, more=more)
    if "inch" in more:
        text = (
            recipe.read_text("utf-8")
            .replace("diameter: 24, to: 90", "diameter: 24 mm, to: 90 mm")
            .replace("0.01,", "0.01 mm,")
        )
        for z in ("20", "40", "60"):
            text = text.replace(f"z: {z}}}", f"z: {z} mm}}")
        recipe.write_text(text, "utf-8")
    file = written(tmp_path / "points.csv", shaft_points(recipe, noise=0.001), "z_mm,x_mm,y_mm")
    report = camgeo.verify(recipe, file, probe_error="0.001 mm")
    assert report.ok
    assert [lobe["name"] for lobe in report["made"]["lobes"]] == NAMES
    assert set(report["made"]["verdicts"].values()) == {"ok"}
    for lobe in report["made"]["lobes"]:
        phase, scale = lobe["phase"], 1.0 if lobe["unit"] == "mm" else 25.4
        assert abs(phase["late_deg"]) < 2.0 * phase["uncertainty_deg"]
        assert phase["uncertainty_deg"] < 0.008
        assert lobe["surfaces"][0]["noise"] * scale == pytest.approx(0.001, rel=0.15)


@pytest.mark.thin(2)
@pytest.mark.parametrize("more", ["", "rotation: ccw\n"])
def test_planted_faults_are_found_on_their_lobe_alone(more, tmp_path):
    """A lobe that stands late by 0.1 degrees is told as that; a burr elsewhere is no phase of the others."""
    recipe = camshaft(tmp_path, limits=LIMITS, more=more)
    planted = {"roller": Planted(late=0.1), "arm": Planted(deviation=bump(0.03))}
    file = written(tmp_path / "points.csv", shaft_points(recipe, planted, noise=0.001), "z_mm,x_mm,y_mm")
    report = camgeo.verify(recipe, file, probe_error=0.001)
    assert not report.ok
    lobes = lobes_of(report)
    late = lobes["roller"]["phase"]
    assert late["late_deg"] == pytest.approx(0.1, abs=2.0 * late["uncertainty_deg"])
    assert late["against_datum_deg"] == pytest.approx(0.1, abs=2.0 * late["against_datum_uncertainty_deg"])
    assert [cause["cause"] for cause in lobes["roller"]["discs"][0]["causes"]] == ["turned"]
    assert lobes["roller"]["discs"][0]["profile"] < 0.012  # a turn is no fault of form about the shaft's axis
    assert abs(lobes["flat"]["phase"]["late_deg"]) < 0.002
    failed = {(check.name, check.surface) for check in report.checks if not check.ok}
    assert failed == {("made-motion", "roller"), ("made-profile", "arm"), ("made-motion", "arm")}
    assert report["made"]["verdicts"]["made-profile, arm"] == "failed"


@pytest.mark.slow
def test_a_shaft_turned_as_one_is_turned_back_as_one(tmp_path, capsys):
    recipe = camshaft(tmp_path)
    planted = {"arm": Planted(late=0.2)}
    file = written(tmp_path / "points.csv", shaft_points(recipe, planted, late=77.0, count=180), "z_mm,x_mm,y_mm")
    assert main(["verify", str(recipe), str(file)]) == 2
    assert "the shaft looks turned by 77.1 degrees: `--align rotation`" in capsys.readouterr().err
    report = camgeo.verify(recipe, file, align="rotation", spans=36)
    assert report["made"]["turned_late_deg"] == pytest.approx(77.0, abs=0.2)
    phases = [lobe["phase"] for lobe in lobes_of(report).values()]
    assert [phase["against_datum_deg"] for phase in phases] == pytest.approx([0.0, 0.0, 0.2], abs=1e-3)
    assert sum(phase["late_deg"] for phase in phases) != pytest.approx(0.2, abs=1e-3)  # shared, by least squares
    made = camgeo.verify(recipe, file, align="best-fit", spans=36)["made"]
    assert made["axis"]["leans_deg"] < 5e-4
    assert made["turned_late_deg"] == pytest.approx(report["made"]["turned_late_deg"], abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["ccw"])
def test_lifts_are_those_of_the_shafts_own_table(rotation, tmp_path):
    """Its table of lifts over the shaft's angle is made without points, angles and metal: followers stand anywhere."""
    recipe = camshaft(tmp_path, more=f"rotation: {rotation}\n", files="[{csv: {as: motion}}]")
    table = np.genfromtxt(camgeo.export(recipe, tmp_path / "out").path / "shaft.csv", delimiter=",", names=True)[:-1]
    for number, (name, unit) in enumerate(zip(NAMES, ("mm", "mm", "deg"), strict=True), 1):
        rows = [(f"{number}", a, s) for a, s in zip(table["shaft_deg"], table[f"{name}_{unit}"], strict=True)]
        for turned, options in ((0.0, {}), (40.0, {"align": "rotation"})):
            cells = [f"{lobe},{a + turned:.9g},{s + 3.0:.10g}" for lobe, a, s in rows]
            file = tmp_path / "lift.csv"
            file.write_text("\n".join([f"lobe,angle_deg,lift_{unit}", *cells]), "utf-8")
            lobe = lobes_of(camgeo.verify(recipe, file, **options))[name]
            assert abs(lobe["phase"]["late_deg"]) < 1e-5
            assert abs(lobe["motion"]["error"]["max"]) < 1e-5


@pytest.mark.slow
def test_lifts_of_all_lobes_turn_as_one(tmp_path):
    recipe = camshaft(tmp_path)
    angle, rows = np.arange(0.0, 360.0, 1.0), []
    design = camgeo.design(recipe)
    for late, number, row in ((0.3, 1, 0), (0.0, 2, 1)):
        lift = design.motion(np.radians(angle - late - 25.0))[row]
        rows += [f"{number},{a},{s:.9f}" for a, s in zip(angle, lift, strict=True)]
    file = tmp_path / "lift.csv"
    file.write_text("\n".join(["lobe,angle_deg,lift_mm", *rows]), "utf-8")
    made = camgeo.verify(recipe, file, align="rotation")["made"]
    assert made["turned_late_deg"] == pytest.approx(25.15, abs=0.15)
    assert made["lobes"][1]["phase"]["against_datum_deg"] == pytest.approx(-0.3, abs=2e-3)
    assert made["missing"] == ["arm"]


def lift_table(recipe, file, late=0.0, *, alone=(0.0, 0.0, 0.0), step=1.0, factor=1.0, heading="angle_deg"):
    """Lifts of all lobes over the shaft's angle, multiplied by a factor; shaft and lobes are late by degrees."""
    angle, motion, rows = np.arange(0.0, 360.0, step), camgeo.design(recipe).motion, []
    for rank, own in enumerate(alone):
        lift = motion(np.radians(angle - late - own))[rank] * (math.degrees(1.0) if NAMES[rank] == "arm" else 1.0)
        rows += [f"{rank + 1},{factor * a},{s:.9f}" for a, s in zip(angle, lift, strict=True)]
    file.write_text("\n".join([f"lobe,{heading},lift", *rows]), "utf-8")
    return file


@pytest.mark.costly("three lobes, each judged before and after it is turned")
@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("late", "alone"),
    [
        (12.3, (0.0, 0.0, 0.0)),
        (180.0, (0.0, 0.0, 0.0)),
        (-90.0, (0.0, 30.0, 0.0)),
        (50.0, (0.0, 0.0, -100.0)),
    ],
)
def test_lifts_from_any_zero_are_told_and_judged_as_one(late, alone, tmp_path, capsys):
    """One zero for all tables: the shaft is turned as one, and a lobe that stands off the others is told as that."""
    recipe = camshaft(tmp_path, limits=LIMITS)
    file = lift_table(recipe, tmp_path / "lift.csv", late, alone=alone, step=2.0)
    assert main(["verify", str(recipe), str(file)]) == 2
    assert f"the shaft looks turned by {late:.3g} degrees: `--align rotation`" in capsys.readouterr().err
    made = camgeo.verify(recipe, file, align="rotation", probe_error=0.001)["made"]
    assert math.remainder(made["turned_late_deg"] - late, 360.0) == pytest.approx(0.0, abs=1e-6)
    for lobe, own in zip(made["lobes"], alone, strict=True):
        assert lobe["phase"]["late_deg"] == pytest.approx(own, abs=1e-6)
        assert lobe["motion"]["without_phase"] < 1e-6
        assert made["verdicts"][f"made-motion, {lobe['name']}"] == ("failed" if own else "ok")
        assert (f"{lobe['name']} looks turned by {own:.3g} degrees against the others" in made["remarks"]) == bool(own)


@pytest.mark.slow
def test_lifts_of_a_shaft_that_turns_the_other_way_or_of_other_lobes(tmp_path):
    recipe = camshaft(tmp_path)
    file = lift_table(recipe, tmp_path / "lift.csv", 20.0, factor=-1.0)
    with pytest.raises(CallError, match=r"the shaft looks run in the other sense, turned by 20 degrees: let angles"):
        camgeo.verify(recipe, file)
    text = lift_table(recipe, file).read_text("utf-8")
    file.write_text(re.sub(r"(?m)^[12],", lambda row: {"1,": "2,", "2,": "1,"}[row[0]], text), "utf-8")
    with pytest.raises(CallError, match="those of flat look like roller, those of roller look like flat: look at the"):
        camgeo.verify(recipe, file)
    file.write_text(re.sub(r"(?m)^3.*\n?", "", lift_table(recipe, file).read_text("utf-8")), "utf-8")
    with pytest.raises(CallError, match=r"they look 25.4 times too large: `--units mm`"):
        camgeo.verify(recipe, file, units="inch")


@pytest.mark.slow
@pytest.mark.parametrize("engine", [True, False])
def test_crank_degrees_of_an_engine(engine, tmp_path, capsys):
    """Angles over two turns that nothing names are the crank's where the recipe has an engine; else a heading says."""
    recipe = camshaft(tmp_path)
    if engine:
        text = recipe.read_text("utf-8").replace("  lobes:", "  engine: {order: [1], separation: 110}\n  lobes:")
        recipe.write_text(text, "utf-8")
    file = lift_table(recipe, tmp_path / "lift.csv", factor=2.0)
    halved = "angles over two turns are taken as those of the engine's crank and halved; head their column crank_deg"
    if engine:
        assert halved in camgeo.verify(recipe, file)["made"]["remarks"]
    else:
        assert main(["verify", str(recipe), str(file)]) == 2
        assert "the lifts look to be at crank degrees: head their column crank_deg\n" in capsys.readouterr().err
    file = lift_table(recipe, file, heading="crank_deg")
    with pytest.raises(CallError, match="the lifts look to be at the camshaft's own angles: head their column cam_deg"):
        camgeo.verify(recipe, file)
    for heading, factor in (("crank_deg", 2.0), ("cam_deg", 1.0)):
        made = camgeo.verify(recipe, lift_table(recipe, file, factor=factor, heading=heading))["made"]
        assert all(abs(lobe["phase"]["late_deg"]) < 1e-6 for lobe in made["lobes"])
        assert halved not in made["remarks"]


@pytest.mark.slow
@pytest.mark.parametrize("label", ["number", "name", "2.0"])
def test_lobes_by_a_column(label, tmp_path):
    recipe = camshaft(tmp_path)
    rows = [row for row in shaft_points(recipe) if label != "2.0" or row[0] == "roller"]
    if label == "number":
        rows = [(f"{NAMES.index(row[0]) + 1}", *row[1:]) for row in rows]
    elif label == "2.0":
        rows = [("2.0", *row[1:]) for row in rows]
    order = np.random.default_rng(1).permutation(len(rows))
    file = written(tmp_path / "points.csv", [rows[k] for k in order], "lobe,x_mm,y_mm")
    made = camgeo.verify(recipe, file)["made"]
    assert [lobe["name"] for lobe in made["lobes"]] == (NAMES if label != "2.0" else ["roller"])
    assert all(lobe["discs"][0]["profile"] < 1e-7 for lobe in made["lobes"])


@pytest.mark.slow
def test_a_file_for_each_lobe_and_lobes_that_are_missing_are_said(tmp_path, capsys):
    recipe = camshaft(tmp_path)
    rows = shaft_points(recipe, noise=0.001, count=120)
    files = [
        written(tmp_path / f"{name}.csv", [row for row in rows if row[0] == name], "z_mm,x_mm,y_mm")
        for name in ("arm", "flat")
    ]
    assert main(["verify", str(recipe), *map(str, files), "--spans", "24"]) == 0
    out = capsys.readouterr().out
    assert "  remark: no points of roller: not judged" in out.splitlines()
    made = camgeo.verify(recipe, *files, spans=24)["made"]
    assert [(lobe["name"], lobe["files"]) for lobe in made["lobes"]] == [("flat", ["flat.csv"]), ("arm", ["arm.csv"])]
    assert (made["datum"], made["missing"]) == ("flat", ["roller"])


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("columns", "change", "message"),
    [
        (
            "x_mm,y_mm",
            lambda row: row,
            f"points.csv: a column z or lobe has to tell which lobe each point is on; {LISTED}",
        ),
        (
            "z_mm,x_mm,y_mm",
            lambda row: (row[0], 35.0 if row[0] == "flat" else row[1], *row[2:]),
            "points.csv: line 2: z is 35 mm, which is on no lobe; the nearest is flat, 20 to 34 mm",
        ),
        (
            HEAD,
            lambda row: ("roller", *row[1:]),
            "points.csv: line 2: z is 27 mm, which is not on roller, 40 to 50 mm, that its column names",
        ),
        (
            "lobe,x_mm,y_mm",
            lambda row: ("intake", *row[1:]),
            f"points.csv: line 2: 'intake' is no lobe; {LISTED}",
        ),
        (
            "lobe,x_mm,y_mm",
            lambda row: ("4", *row[1:]),
            f"points.csv: line 2: '4' is no lobe; {LISTED}",
        ),
    ],
)
def test_points_of_no_lobe(columns, change, message, tmp_path, capsys):
    recipe = camshaft(tmp_path)
    file = written(tmp_path / "points.csv", [change(row) for row in shaft_points(recipe, count=60)], columns)
    assert main(["verify", str(recipe), str(file)]) == 2
    assert capsys.readouterr().err.splitlines() == [f"camgeo: {tmp_path}/{message}"]


def test_too_few_points_of_one_lobe(tmp_path):
    recipe = camshaft(tmp_path)
    rows = [row for i, row in enumerate(shaft_points(recipe, count=60)) if row[0] != "arm" or i % 2]
    with pytest.raises(CallError, match=r"arm has 30 points, and at least 36 are needed, all round it"):
        camgeo.verify(recipe, written(tmp_path / "points.csv", rows, "lobe,x_mm,y_mm"))


@pytest.mark.slow
def test_lobes_that_meet_need_a_column(tmp_path):
    recipe = camshaft(tmp_path)
    recipe.write_text(recipe.read_text("utf-8").replace("z: 40", "z: 34"), "utf-8")
    rows = [(name, 34.0 if name != "arm" else z, x, y) for name, z, x, y in shaft_points(recipe, count=60)]
    with pytest.raises(CallError, match="z is 34 mm, where flat and roller meet: give a column lobe too"):
        camgeo.verify(recipe, written(tmp_path / "points.csv", rows, "z_mm,x_mm,y_mm"))
    assert camgeo.verify(recipe, written(tmp_path / "points.csv", rows), spans=12).ok


def test_a_folder_of_the_shaft_and_each_lobe(tmp_path, capsys):
    recipe = camshaft(tmp_path)
    file = written(tmp_path / "points.csv", shaft_points(recipe, {"arm": Planted(late=0.1)}, noise=0.001))
    assert main(["verify", str(recipe), str(file), "--out", str(tmp_path / "made"), "-v"]) == 0
    out = capsys.readouterr().out
    assert "smoothed over" in out
    assert "phase                       late by 0.1" in out
    names = sorted(path.name for path in (tmp_path / "made").iterdir())
    each = [f"shaft-{name}-made.{suffix}" for name in sorted(NAMES) for suffix in ("csv", "html", "svg")]
    assert names == sorted([*each, "shaft-made.html"])
    page = (tmp_path / "made" / "shaft-made.html").read_text("utf-8")
    assert '<a href="shaft-arm-made.html">arm</a>' in page
    assert "late by 0.1" in page


@pytest.mark.slow
def test_the_uncertainty_of_axes_counts_as_they_act(tmp_path):
    """A turn of the axes is common to all lobes and no phase between them; a shift moves lobes by where they stand."""
    recipe = camshaft(tmp_path)
    file = written(tmp_path / "points.csv", shaft_points(recipe, count=180))
    turned = lobes_of(camgeo.verify(recipe, file, probe_error=0, axes_error=(0, 0.05)))
    for name in ("roller", "arm"):
        assert turned[name]["phase"]["uncertainty_deg"] == pytest.approx(0.05, rel=1e-6)
        assert turned[name]["phase"]["against_datum_uncertainty_deg"] < 1e-6
    shift = 0.01
    shifted = lobes_of(camgeo.verify(recipe, file, probe_error=0, axes_error=(shift, 0)))
    worst = dict.fromkeys(NAMES, 0.0)
    for k in range(6):  # half a turn: the other half moves lobes as far the other way
        by = shift * np.exp(1j * k * math.pi / 6)
        rows = [(name, z, x + by.real, y + by.imag) for name, z, x, y in shaft_points(recipe, count=180)]
        lobes = lobes_of(camgeo.verify(recipe, written(tmp_path / "moved.csv", rows)))
        worst = {name: max(worst[name], abs(lobes[name]["phase"]["late_deg"])) for name in NAMES}
    for name in NAMES:
        assert shifted[name]["phase"]["uncertainty_deg"] == pytest.approx(worst[name], rel=0.05)


@pytest.mark.slow
def test_the_phase_scatters_as_its_uncertainty_says(tmp_path, monkeypatch):
    recipe = camshaft(tmp_path)
    lates, told = [], []
    for seed in range(16):
        rng = np.random.default_rng(seed)
        monkeypatch.setattr(np.random, "default_rng", lambda _, rng=rng: rng)
        file = written(tmp_path / "points.csv", shaft_points(recipe, noise=0.002, count=180))
        phases = [lobe["phase"] for lobe in camgeo.verify(recipe, file, spans=36)["made"]["lobes"]]
        lates.append([phase["late_deg"] for phase in phases])
        told.append([phase["uncertainty_deg"] for phase in phases])
    ratio = 2.0 * np.std(lates, axis=0) / np.mean(told, axis=0)
    assert (np.abs(ratio - 1.0) < 0.4).all()


@pytest.mark.slow
@pytest.mark.parametrize("more", [pytest.param("", marks=pytest.mark.slow), "rotation: ccw\n"])
def test_what_is_to_be_measured_is_judged_at_its_digits(more, tmp_path):
    """Inspection table and DMIS, measured without error: places, heights, normals, zones of the lobes that have one."""
    files = "[{csv: {as: inspection, step: 3}}, {dmis: {step: 3}}, {dmis: {step: 5, units: inch}}]"
    recipe = camshaft(tmp_path, files=files, more=more)
    flat = tmp_path / "flat.yaml"
    flat.write_text(flat.read_text("utf-8") + "made: {profile: 0.02}\n", "utf-8")
    folder = camgeo.export(recipe, tmp_path / "out").path
    table = np.genfromtxt(folder / "shaft.csv", delimiter=",", names=True)
    assert len(table) == 3 * 120
    assert {27.0, 45.0, 65.0} == set(table["z_mm"])
    assert np.hypot(table["nx"], table["ny"]) == pytest.approx(1.0, abs=1e-11)
    first = table[table["lobe"] == 1]
    assert set(first["upper_mm"]) == {0.01}
    assert set(first["lower_mm"]) == {-0.01}
    assert np.isnan(table["upper_mm"][table["lobe"] == 2]).all()
    assert first["shaft_deg"][0] == pytest.approx(33.3)
    programs = sorted(folder.glob("*.dmi"))
    assert len(programs) == 2
    lines = [program.read_text("ascii").splitlines() for program in programs]
    assert sum("T(ZONE)=TOL/PROFP,-0.01,0.01" in rows for rows in lines) == 1
    assert [sum(row.endswith("TA(ZONE)") for row in rows) for rows in lines] in ([120, 72], [72, 120])
    answers = []
    for program, rows in zip(programs, lines, strict=True):
        kept = [row.replace("F(P", "FA(P") for row in rows if row.startswith(("F(P", "UNITS"))]
        answers.append(tmp_path / f"{program.stem}.dmo")
        answers[-1].write_text("\n".join(kept), "utf-8")
    for file in (folder / "shaft.csv", *answers):
        report = camgeo.verify(recipe, file, probe_error=1e-9)
        assert report.ok
        for lobe in report["made"]["lobes"]:
            assert lobe["discs"][0]["profile"] < 2e-9
            assert abs(lobe["phase"]["late_deg"]) < 1e-8


@pytest.mark.parametrize(
    ("files", "told"),
    [
        ("[{csv: {as: inspection, step: 7}}]", "csv.step: 360 degrees are no whole number of it; give 7.05882353"),
        ("[{csv: {as: events, step: 5}}]", "csv.step: belongs to a table as inspection; leave it out"),
        ("[{csv: {step: 5}}]", "csv.step: belongs to a table as inspection; leave it out"),
        ("[{dmis: {step: 7}}]", "dmis.step: 360 degrees are no whole number of it; give 7.05882353"),
        ("[{dmis: {tolerance: 1}}]", "dmis.tolerance: unknown key"),
    ],
)
def test_steps_of_what_is_to_be_measured(files, told, tmp_path, capsys):
    assert main(["export", str(camshaft(tmp_path, files=files)), "--out", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err


OFF = r"points.csv: the points lie \S+ mm off the contours on average: "
UP = "measure it with the upper end up, as the file is drawn, or turn y round"


@pytest.mark.thin(10)
@pytest.mark.parametrize(
    ("wrong", "columns", "message"),
    [
        (lambda n, z, x, y: (n, z, x, -y), "z_mm,x_mm,y_mm", f"{OFF}the shaft looks mirrored: {UP}"),
        (
            lambda n, z, x, y: (n, z, y, x),
            "z_mm,x_mm,y_mm",
            f"{OFF}the shaft looks mirrored, turned by -90 degrees: {UP}, then `--align rotation`",
        ),
        (
            lambda n, z, x, y: (n, 92.0 - z, x, -y),
            "z_mm,x_mm,y_mm",
            f"{OFF}the shaft looks measured from its other end: count z from the recipe's end, and turn y round",
        ),
        (
            lambda n, z, x, y: ({"flat": "arm", "arm": "flat"}.get(n, n), z, x, y),
            "lobe,x_mm,y_mm",
            f"{OFF}those of flat look like arm, those of arm look like flat: look at the column that tells them",
        ),
        (
            lambda n, z, x, y: (n, z, x / 25.4, y / 25.4),
            "lobe,x,y",
            f"{OFF}they look 25.4 times too small: `--units inch`",
        ),
        (
            lambda n, z, x, y: (n, z / 25.4, x / 25.4, y / 25.4),
            "z,x,y",
            "z is 1.06299213 mm, which is .*, 20 to 34 mm; they look 25.4 times too small: `--units inch`",
        ),
        (
            lambda n, z, x, y: (n, z + 50.0, x, y),
            "z_mm,x_mm,y_mm",
            "z is 77 mm, .*; they look shifted along the shaft: count z from the recipe's zero, -50 mm",
        ),
        (
            lambda n, z, x, y: (n, 150.0 - (21.0 if n == "flat" else z), x, -y),
            "z_mm,x_mm,y_mm",
            "on no lobe; .*; they look measured from the other end: z is 150 mm less the column, and y turned round",
        ),
        (
            lambda n, z, x, y: (n, z, x + 1.5, y),
            "z_mm,x_mm,y_mm",
            r"they look shifted by \(.*\) mm: measure them about the axis of the bearings",
        ),
    ],
)
def test_points_that_are_not_of_this_shaft_are_told_what_they_look_like(wrong, columns, message, tmp_path, capsys):
    recipe = camshaft(tmp_path)
    rows = [wrong(*row) for row in shaft_points(recipe, count=120)]
    file = written(tmp_path / "points.csv", rows, columns)
    assert main(["verify", str(recipe), str(file)]) == 2
    (line,) = (line for line in capsys.readouterr().err.splitlines() if not line.endswith(" ..."))
    assert re.search(message, line)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("wrong", "right", "options"),
    [
        # the only quick one that looks for a shaft of points at every angle, which takes seconds
        (lambda n, z, x, y: (n, z, y, x), lambda n, z, x, y: (n, z, x, -y), {"align": "rotation"}),
        (lambda n, z, x, y: (n, 92.0 - z, x, -y), lambda n, z, x, y: (n, 92.0 - z, x, -y), {}),
        (lambda n, z, x, y: (n, z, x / 25.4, y / 25.4), lambda *row: row, {"units": "inch"}),
    ],
)
def test_what_is_told_helps(wrong, right, options, tmp_path):
    recipe = camshaft(tmp_path)
    rows = [right(*wrong(*row)) for row in shaft_points(recipe, count=48)]
    columns = "lobe,x,y" if "units" in options else "z_mm,x_mm,y_mm"
    report = camgeo.verify(recipe, written(tmp_path / "points.csv", rows, columns), spans=12, **options)
    assert all(lobe["discs"][0]["profile"] < 1e-6 for lobe in lobes_of(report).values())


@pytest.mark.slow
@pytest.mark.parametrize("late", [2.0, -30.0])
def test_a_lobe_that_stands_elsewhere_is_judged_and_told(late, tmp_path):
    """It is the part that is wrong, not its points: a turn of one lobe is none of the shaft."""
    recipe = camshaft(tmp_path, limits=LIMITS)
    file = written(tmp_path / "points.csv", shaft_points(recipe, {"roller": Planted(late=late)}, count=180))
    report = camgeo.verify(recipe, file, spans=36, probe_error=0.001)
    assert report["made"]["verdicts"]["made-motion, roller"] == "failed"
    assert report["made"]["verdicts"]["made-motion, flat"] == "ok"
    remark = next(text for text in report["made"]["remarks"] if "against the others" in text)
    told = re.fullmatch(r"roller looks turned by (\S+) degrees against the others", remark)
    assert told is not None
    assert float(told[1]) == pytest.approx(late, rel=0.01)
