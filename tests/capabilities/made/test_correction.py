"""Contours corrected for what a machine made of earlier runs: by a simulated machine, by formulas, and bad input.

Holds: camgeo.capabilities.made.earlier_runs, kin.made.corrected.
"""

from __future__ import annotations

import json
import re
import shutil

import numpy as np
import pytest
from support.machine import milled, scattered
from support.measured import RECIPES, bump, disc, measured, points, surfaces, table, turned

import camgeo
from camgeo.capabilities.made.keys import offered
from camgeo.cli.main import main
from camgeo.registry.formats import FORMATS as OF_FILES
from kin.read.files import read_drawing

ROLLER = disc("kind: roller, radius: 10, offset: 6", part="bore: 12, thickness: 4")
MILL = "\nmanufacture: {cutter: 6, feed: 300, plunge: 100, spindle: 8000, depth_of_cut: 4, safe_height: 5}"


def written(folder, text, runs, files, tolerance=0.001):
    recipe = folder / "part.yaml"
    points = f"\nmade: {{points: [{', '.join(runs)}]}}" if runs else ""
    recipe.write_text(f"{text}{points}\nexport: {{tolerance: {tolerance}, files: [{files}]}}\n", "utf-8")
    return recipe


def corrected_runs(folder, text, play, tolerance=0.0003):
    """Greatest and root mean square of what the machine leaves of a part, run by run, mm."""
    ((_, _, surface),) = surfaces(text)
    greatest, mean = [], []
    for run in range(4):
        file = "{gcode: {correct: 0.8}}" if run else "gcode"
        recipe = written(folder, text, [f"run{k}.csv" for k in range(run)], file, tolerance)
        (program,) = camgeo.export(recipe, folder / "out").path.glob("*.ngc")
        places = milled(program, 2.98, play=play, skew=4e-4)
        off = surface.gauge.envelope.feet(places).excess
        greatest.append(np.abs(off).max())
        mean.append(np.sqrt(np.mean(off**2)))
        (folder / f"run{run}.csv").write_text(table(scattered(places, 0.0005, run)), "utf-8")
    return greatest, mean


# needs: milling
@pytest.mark.slow
@pytest.mark.parametrize("sides", [3])
def test_the_machine_is_corrected_to_its_noise_on_a_reuleaux_polygon(sides, tmp_path):
    greatest, mean = corrected_runs(tmp_path, polygon(sides, 5.0) + MILL, 0.0)
    assert greatest[0] > 0.025
    assert mean[1:3] == pytest.approx([0.2 * mean[0], 0.04 * mean[0]], rel=0.2)
    assert mean[3] < 0.0005
    assert greatest[3] < 0.0015


# needs: milling
@pytest.mark.slow
@pytest.mark.parametrize("play", [0.0, pytest.param(0.004, marks=pytest.mark.slow)])
def test_a_machine_is_corrected_to_its_noise_in_three_runs(play, tmp_path):
    """A cutter that is too small, axes that are not square, screws with play: a fifth is left of it each time.

    Points scatter by 0.5 um. Play leaves kinks where a slide turns back, which no smooth curve takes off.
    """
    greatest, mean = corrected_runs(tmp_path, ROLLER + MILL, play)
    assert greatest[0] > 0.029
    assert mean[1:3] == pytest.approx([0.2 * mean[0], 0.04 * mean[0]], rel=0.15)
    assert mean[3] < 0.0005
    assert greatest[3] < (0.003 if play else 0.001)


def wavy(t):
    """What a machine adds: waves, and a bump."""
    return 0.012 * np.sin(3.0 * t + 0.4) + bump(0.008, 10.0)(t)


def plain(text):
    return text.replace("\nexport: {tolerance: 0.001, files: [dxf]}", "").partition("\nexport:")[0]


def runs_of(folder, text, *deviations, noise=0.0):
    """Files of points of runs with these deviations on the first surface, a list for each run."""
    runs = []
    for k, deviation in enumerate(deviations):
        _, files = measured(folder, text, deviation, noise)
        names = [f"run{k}-{i + 1}.csv" for i in range(len(files))]
        for file, name in zip(files, names, strict=True):
            shutil.move(file, folder / name)
        runs.append(f"[{', '.join(names)}]")
    return runs


# judged where all their files are, or as others of their kind
OTHERS = {"roller on a stem", "roller on a trailing arm", "flat", "flat on an arm", "yoke", "flat pair"}


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in RECIPES if kind not in OTHERS])
def test_every_kind_is_corrected_and_judged_against_that(kind, tmp_path):
    text = plain(RECIPES[kind])
    recipe = written(tmp_path, text, runs_of(tmp_path, text, wavy, noise=0.0005), "dxf, {dxf: {as: arcs, correct: 1}}")
    report = camgeo.export(recipe, tmp_path / "out")
    assert report.ok
    files = {file["path"]: file for file in report["files"]}
    assert all(file["compensation"]["correct"] == 1.0 for name, file in files.items() if "correct" in name)
    assert any("compensation" not in file for file in files.values())
    correction = report["made"]["corrections"][0]
    assert set(correction["files"]) == {name for name in files if "correct" in name}
    assert abs(correction["greatest"]) * (25.4 if report["units"] == "inch" else 1.0) > 0.010
    assert correction["motion"]["change"] != 0.0
    assert camgeo.verify(recipe, *(report.path / name for name in files)).ok


def polygon(sides, rounding):
    cam = f"kind: support, reuleaux: {{sides: {sides}, breadth: 50, rounding: {rounding}}}"
    return f"part: {{bore: 8, thickness: 4}}\nverify: {{angles: 360}}\ncam: {{{cam}}}"


FORMATS = (
    "dxf: {as: arcs, correct: 1}",
    "dxf: {as: spline, correct: 1}",
    "dxf: {as: polyline, correct: 1}",
    *(f"{name}: {{correct: 1}}" for name, record in OF_FILES.items() if name not in {"dxf", "csv"} and offered(record)),
    *(f"csv: {{as: {form}, correct: 1}}" for form in ("points", "grinding", "lift, roller: 25")),
)


# needs: milling
@pytest.mark.slow
@pytest.mark.parametrize(("sides", "rounding"), [(5, 0.3)])
def test_every_file_of_a_corrected_reuleaux_polygon_holds(sides, rounding, tmp_path):
    """Its radius of curvature jumps from the rounding to the breadth less that, and the contour has no corner."""
    text = polygon(sides, rounding) + MILL.replace("cutter: 6", "wheel: 200, cutter: 6")
    files = ", ".join(f"{{{form}}}" for form in FORMATS)
    report = camgeo.export(
        written(tmp_path, text, runs_of(tmp_path, text, wavy, noise=0.0005), files), tmp_path / "out"
    )
    assert [check for check in report["checks"] if not check["ok"]] == []
    assert len(report["files"]) == len(FORMATS)
    assert camgeo.verify(tmp_path / "part.yaml", *(report.path / file["path"] for file in report["files"])).ok


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["roller on a stem", "ring", "flat", "flat on an arm"])
def test_a_jump_of_acceleration_leaves_no_corner_either(kind, tmp_path):
    text = plain(RECIPES[kind]).replace("cycloidal", "harmonic")
    files = "{dxf: {as: arcs, correct: 1}}, {dxf: {as: spline, correct: 1}}, {svg: {correct: 1}}"
    report = camgeo.export(
        written(tmp_path, text, runs_of(tmp_path, text, wavy, noise=0.0005), files), tmp_path / "out"
    )
    assert [check for check in report["checks"] if not check["ok"]] == []


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["roller on a stem"])
def test_tables_that_grind_or_draw_the_contour_are_corrected(kind, tmp_path):
    """Where a wheel of 200 mm stands, and which way it faces, say where it leaves the metal."""
    text = plain(RECIPES[kind]) + "\nmanufacture: {wheel: 200}"
    forms = ", ".join(
        f"{{csv: {{as: {form}, correct: 0.8, local: take}}}}" for form in ("grinding", "points", "lift, roller: 25")
    )
    recipe = written(tmp_path, text, runs_of(tmp_path, text, wavy), forms)
    report = camgeo.export(recipe, tmp_path / "out")
    files = [report.path / file["path"] for file in report["files"]]
    assert [file.name for file in files] == ["part-correct.csv", "part-points-correct.csv", "part-lift-correct.csv"]
    assert report.ok
    assert camgeo.verify(recipe, *files).ok
    ((_, _, surface),) = surfaces(RECIPES[kind])
    degrees, far, normal = np.loadtxt(files[0], delimiter=",", skiprows=4).T
    centres, facing = (
        length[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        for length, angle in ((far, np.radians(degrees)), (np.ones_like(far), np.radians(normal)))
    )
    points = np.loadtxt(files[1], delimiter=",")[:, :2]
    for places in (centres - 100.0 * facing, points):
        feet = surface.gauge.envelope.feet(places)
        assert feet.excess == pytest.approx(-0.8 * wavy(feet.parameter), abs=0.0005)


def read_contour(path):
    (chain, *_) = sorted(read_drawing(path).chains, key=lambda chain: -chain.contour.length)
    return chain.contour.sample(8)


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.5])
def test_the_contour_is_the_exact_one_less_the_sum_along_its_normals(share, tmp_path):
    """Of two runs, the first measured in two files, whose mean counts; places are those of a formula."""
    runs = runs_of(tmp_path, ROLLER, bump(0.02), bump(0.01), lambda t: 0.006 * np.cos(2.0 * t))
    runs = [f"[{runs[0][1:-1]}, {runs[1][1:-1]}]", runs[2]]
    recipe = written(tmp_path, ROLLER, runs, f"{{dxf: {{as: arcs, correct: {share}, local: take}}}}")
    report = camgeo.export(recipe, tmp_path / "out")
    file = report["files"][0]
    ((_, _, surface),) = surfaces(ROLLER)
    t = np.linspace(0.0, 2.0 * np.pi, 40_001)
    frame = surface.gauge.envelope.frames(t)
    off = bump(0.015)(t) + 0.006 * np.cos(2.0 * t)
    exact = frame.points - share * off[:, None] * frame.normals
    drawn = read_contour(report.path / file["path"])
    away = np.abs(drawn[:, None] - exact[None, ::40]).sum(axis=2).argmin(axis=1) * 40
    near = np.clip(away[:, None] + np.arange(-40, 41), 0, 40_000)
    distance = np.hypot(*np.moveaxis(drawn[:, None] - exact[near], 2, 0)).min(axis=1)
    assert distance.max() < 0.0011 + 0.003  # points 0.006 mm apart
    assert distance.mean() < 0.002
    # the nominal contour, under the name of the corrected file, is told from it
    other = written(tmp_path, ROLLER, (), "{dxf: {as: arcs}}")
    (nominal,) = camgeo.export(other, tmp_path / "nominal").path.glob("*.dxf")
    recipe = written(tmp_path, ROLLER, runs, f"{{dxf: {{as: arcs, correct: {share}, local: take}}}}")
    shutil.copy(nominal, tmp_path / file["path"])
    failed = {one["name"]: one for one in camgeo.verify(recipe, tmp_path / file["path"])["checks"] if not one["ok"]}
    assert failed["contour"]["value"] == pytest.approx(share * np.abs(off).max(), abs=0.002)
    assert failed["motion"]["value"] == pytest.approx(share * np.abs(off).max(), abs=0.002)


@pytest.mark.slow
def test_a_correction_goes_with_kerf_and_shrinkage(tmp_path):
    runs = runs_of(tmp_path, ROLLER, bump(0.02))
    recipe = written(tmp_path, ROLLER, runs, "{dxf: {as: arcs, correct: 1, local: take, kerf: 0.2, shrinkage: 1}}")
    report = camgeo.export(recipe, tmp_path / "out")
    file = report["files"][0]
    assert file["path"] == "part-kerf-shrinkage-correct.dxf"
    told = file["compensation"]
    assert (told["kerf"], told["shrinkage"], told["correct"]) == (0.2, 1.0, 1.0)
    assert "kerf 0.2, shrinkage 1 percent, correct 1" in (report.path / file["path"]).read_text("utf-8")
    ((_, _, surface),) = surfaces(ROLLER)
    frame = surface.gauge.envelope.frames(np.radians([50.0]))
    meant = (frame.points + (0.1 - 0.02) * frame.normals) / 0.99
    drawn = read_contour(report.path / file["path"])
    assert np.hypot(*(drawn - meant).T).min() < 0.02
    away = (drawn - meant) @ frame.normals[0]
    assert np.abs(away[np.hypot(*(drawn - meant).T) < 0.3]).max() < 0.002


@pytest.mark.slow
def test_a_file_of_a_run_has_its_own_unit_probe_and_placing(tmp_path):
    """Centres of a ball, in inches, of a part turned by 5 degrees that is 20 um too large."""
    ((_, _, surface),) = surfaces(ROLLER)
    frame = surface.gauge.envelope.frames(np.arange(720) * np.pi / 360.0)
    places = frame.points + 1.52 * frame.normals
    c, s = np.cos(np.radians(5.0)), np.sin(np.radians(5.0))
    (tmp_path / "run.csv").write_text(table(places @ np.array([[c, s], [-s, c]]) / 25.4, "x,y"), "utf-8")
    entry = "{file: run.csv, units: inch, align: rotation, probe: {radius: 1.5, error: 0.002}}"
    report = camgeo.export(written(tmp_path, ROLLER, [entry], "{dxf: {correct: 1}}"), tmp_path / "out")
    assert report["made"]["runs"][0]["files"] == ["run.csv"]
    surface = report["made"]["runs"][0]["surfaces"][0]
    assert surface["greatest"] == pytest.approx(0.02, abs=5e-4)
    # the probe's stated error does not average: both uncertainties hold it
    silent = entry.replace(", error: 0.002", "")
    without = camgeo.export(written(tmp_path, ROLLER, [silent], "{dxf: {correct: 0.5}}"), tmp_path / "silent")["made"]
    plain_surface, correction = without["runs"][0]["surfaces"][0], without["corrections"][0]
    assert surface["uncertainty"] == pytest.approx(np.hypot(plain_surface["uncertainty"], 0.002))
    half = camgeo.export(written(tmp_path, ROLLER, [entry], "{dxf: {correct: 0.5}}"), tmp_path / "half")["made"]
    assert half["corrections"][0]["uncertainty"] == pytest.approx(np.hypot(correction["uncertainty"], 0.001))


def test_runs_are_told_with_the_scatter_of_their_files(tmp_path, capsys):
    """Of two files that differ by 0.002 sin(5 t) the standard deviation about their mean is half of that, 0.001."""
    wave = np.array([0.02, 0.004])[:, None] * np.cos(np.arange(720) * np.pi / 360.0 - np.radians(50.0))
    waves = lambda _: wave[0], lambda t: wave[0] + 0.002 * np.sin(5.0 * t), lambda _: wave[1]
    runs = runs_of(tmp_path, ROLLER, *waves, noise=0.0002)
    runs = [f"[{runs[0][1:-1]}, {runs[1][1:-1]}]", runs[2]]
    recipe = written(tmp_path, ROLLER, runs, "html, {dxf: {correct: 0.5}}")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out"), "-v"]) == 0
    told = capsys.readouterr().out
    section = json.loads((tmp_path / "out" / "part" / "report.json").read_text("utf-8"))["made"]
    ((first,), (second,)) = (run["surfaces"] for run in section["runs"])
    assert first["files_differ_by"] == pytest.approx(0.001, rel=0.02)
    assert "files_differ_by" not in second
    (total,) = section["systematic"]
    assert total["greatest"] == pytest.approx(first["greatest"] + second["greatest"], rel=0.01)
    assert total["at_deg"] == pytest.approx(50.0, abs=15.0)
    assert section["corrections"][0]["greatest"] == pytest.approx(-0.5 * total["greatest"])
    assert re.search(r"run0-1\.csv, run1-1\.csv +1440 +\+0\.0\d+ +\d+\.\d\d deg .* 0\.0\d+\n", told)
    assert re.search(r"\nsum +\+0\.02\d* ", told)
    assert re.search(r"part-correct\.dxf: 0\.5 of the sum +-0\.01\d* ", told)
    page = (tmp_path / "out" / "part" / "part.html").read_text("utf-8")
    assert '<h2 id="runs-head">Parts that were made</h2>' in page
    assert '<th scope="row">run0-1.csv, run1-1.csv</th><td></td><td>1440</td>' in page


@pytest.mark.slow
def test_without_a_corrected_file_points_are_only_told(tmp_path):
    runs = runs_of(tmp_path, ROLLER, bump(0.02))
    report = camgeo.export(written(tmp_path, ROLLER, runs, "dxf"), tmp_path / "out")
    assert report["made"]["corrections"] == []
    assert report["made"]["runs"][0]["surfaces"][0]["greatest"] == pytest.approx(0.02, abs=1e-3)
    assert [file["path"] for file in report["files"]] == ["part.dxf"]
    before = (report.path / "part.dxf").read_bytes()
    again = camgeo.export(written(tmp_path, ROLLER, (), "dxf"), tmp_path / "again")
    assert (again.path / "part.dxf").read_bytes() == before


CORRECT = "{dxf: {correct: 0.8}}"
BAD = {
    "no points": (ROLLER, (), CORRECT, "files[0].dxf.correct: there are no measured points to correct by; give made.p"),
    "no file": (
        ROLLER,
        ["run9.csv"],
        CORRECT,
        "made.points[0]: the file does not exist, given 'run9.csv'; give its path as seen",
    ),
    "in a list": (
        ROLLER,
        ["[run.csv, run9.csv]"],
        CORRECT,
        "made.points[0][1]: the file does not exist, given 'run9.csv'",
    ),
    "no list": (ROLLER, ["[[run.csv]]"], CORRECT, "made.points[0][0]: not the path of a file"),
    "too much": (ROLLER, ["run.csv"], "{dxf: {correct: 2}}", "files[0].dxf.correct: above 1.5, given 2; give a number"),
    "units": (ROLLER, ["{file: run.csv, units: cm}"], CORRECT, "made.points[0].units: "),
    "another cam": (ROLLER, ["other.csv"], CORRECT, "part.yaml:4:17: made.points[0]: other.csv: the points lie "),
    "gap": (ROLLER, ["run.csv", "[run.csv, gap.csv]"], CORRECT, "made.points[1][1]: gap.csv: "),
    "in inches": (
        ROLLER,
        ["{file: run.csv, units: inch}"],
        CORRECT,
        "made.points[0]: run.csv: a heading states a unit of 1 mm; leave units out",
    ),
    "too small": (ROLLER, ["small.csv"], CORRECT, "they look 25.4 times too small: `units: inch`"),
    "turned": (ROLLER, ["turned.csv"], CORRECT, "they look turned by 20 degrees: `align: rotation`"),
    "a table of motion": (
        ROLLER,
        ["run.csv"],
        "{csv: {as: motion, correct: 1}}",
        "files[0].csv.correct: belongs to a table as grinding, lift",
    ),
    "trimmed": (
        ROLLER.replace("base_radius", "undercut: trim, base_radius"),
        ["run.csv"],
        CORRECT,
        "files[0].dxf.correct: a contour whose undercut is cut off is not corrected; give undercut: refuse",
    ),
    "sharp corners": (
        polygon(3, 0.0).replace(", rounding: 0.0", ""),
        ["corners.csv"],
        CORRECT,
        "files[0]: a contour with sharp corners is not corrected: give `reuleaux.rounding`, or leave `correct` out",
    ),
    "a corner hardly rounded": (
        polygon(3, 0.02),
        ["corners.csv"],
        CORRECT,
        "files[0]: the corrected contour turns back at ",
    ),
    "told only": (ROLLER, ["other.csv"], "dxf", "made.points[0]: other.csv: the points lie "),
    "hollow": (ROLLER, ["dents.csv"], CORRECT, "the corrected contour turns back at "),
}


@pytest.mark.thin(12)
@pytest.mark.parametrize("name", list(BAD))
def test_bad_input_is_told_in_one_line(name, tmp_path, capsys):
    text, runs, files, told = BAD[name]
    ((_, part, surface),) = surfaces(ROLLER)
    places = points(part, surface)
    (tmp_path / "run.csv").write_text(table(places), "utf-8")
    (tmp_path / "other.csv").write_text(table(places * [1.0, 1.1]), "utf-8")
    (tmp_path / "gap.csv").write_text(table(places[:540]), "utf-8")
    (tmp_path / "small.csv").write_text(table(places / 25.4, "x,y"), "utf-8")
    (tmp_path / "turned.csv").write_text(table(turned(places, 20.0)), "utf-8")
    peaks = points(part, surface, lambda t: 0.1 * np.sin(60.0 * t))
    (tmp_path / "dents.csv").write_text(table(peaks), "utf-8")
    if "corners.csv" in runs:
        runs = runs_of(tmp_path, text, wavy)
    recipe = written(tmp_path, text, runs, files)
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert told in error
    assert len(error.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    for share in re.findall(r"give ([0-9.]+) or less, or smooth", error):
        recipe = written(tmp_path, text, runs, files.replace("0.8", share))
        assert camgeo.export(recipe, tmp_path / "out").ok


# needs: milling
@pytest.mark.slow
def test_head_and_name_of_a_program_say_that_it_is_corrected(tmp_path):
    runs = runs_of(tmp_path, ROLLER, bump(0.02))
    recipe = written(tmp_path, ROLLER + MILL, runs, "gcode, {gcode: {correct: 0.8}}")
    report = camgeo.export(recipe, tmp_path / "out")
    assert sorted(path.name for path in report.path.glob("*.ngc")) == ["part-correct.ngc", "part.ngc"]
    assert "(part, correct 0.8)" in (report.path / "part-correct.ngc").read_text("utf-8")
    assert "correct" not in (report.path / "part.ngc").read_text("utf-8")
    told = json.loads((report.path / "report.json").read_text("utf-8"))
    assert [file.get("compensation", {}).get("correct") for file in told["files"]] == [None, 0.8]
