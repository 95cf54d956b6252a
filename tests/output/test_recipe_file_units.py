"""Files in a unit of their own: the same cam in mm and in inch, by camgeo's readers and by others, and with faults.

Holds: camgeo.common.units, camgeo.formats.options.
"""

from __future__ import annotations

import csv
import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.heavy import ezdxf
from support.kernel import kernel

from camgeo.cli.main import main
from camgeo.files.precision import DECIMALS, SINGLE, conversion_error
from camgeo.output import pipeline
from camgeo.output.job import Job
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.read.files import read_drawing, read_solid
from kin.read.gcode import read_gcode

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.recipe.recipe import Recipe

TOLERANCE = 0.002
INCH = 25.4
TEXT = """\
name: cam
units: {units}
cam:
  kind: disc
  base_radius: 30 mm
  follower: {{kind: roller, radius: 3/8 in}}
  motion: [{{rise: 1 cm, over: 120, law: cycloidal}}, {{dwell: 60}}, {{return: 10 mm, over: 180, law: cycloidal}}]
part: {{thickness: 8 mm, bore: 10 mm, bolts: {{count: 3, circle: 30 mm, hole: 4 mm}}}}
manufacture: {{cutter: 6 mm, feed: 300 mm, plunge: 100 mm, spindle: 8000, depth_of_cut: 2 mm, safe_height: 5 mm}}
verify: {{angles: 360}}
export: {{tolerance: 0.002 mm, files: [{files}]}}
"""
PLAIN = (
    "dxf",
    "svg",
    "stl",
    "3mf",
    "gcode",  # needs: milling
    "csv",
)
SUFFIX = {"gcode": "ngc"}
DRAWN = [pytest.param("step", marks=kernel), "dxf", "svg"]


def recipe_of(*kinds: str, units: str = "mm", own: tuple[str, ...] = ("mm", "inch")) -> Recipe:
    files = ", ".join(f"{{{kind}: {{units: {one}}}}}" for kind in kinds for one in own)
    return load_text(TEXT.format(units=units, files=files), "cam.yaml")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Recipe, Path, dict[str, Any]]:
    recipe = recipe_of(*PLAIN)
    outcome = pipeline.export(recipe, tmp_path_factory.mktemp("units"))
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    assert outcome.folder is not None
    return recipe, outcome.folder, outcome.report


@pytest.fixture(scope="module")
def stepped(tmp_path_factory: pytest.TempPathFactory) -> tuple[Recipe, Path, dict[str, Any]]:
    recipe = recipe_of("step")
    outcome = pipeline.export(recipe, tmp_path_factory.mktemp("step"))
    assert outcome.ok
    assert outcome.folder is not None
    return recipe, outcome.folder, outcome.report


Made = tuple["Recipe", Path, dict[str, Any]]


def paths(found: Made, kind: str) -> tuple[Path, Path]:
    """The file in mm and the one in inch."""
    _, folder, report = found
    by_unit = {file["units"]: folder / file["path"] for file in report["files"] if file["kind"] == kind}
    return by_unit["mm"], by_unit["inch"]


def found_for(kind: str, request: pytest.FixtureRequest) -> Made:
    found: Made = request.getfixturevalue("stepped" if kind == "step" else "made")
    return found


@pytest.mark.slow
def test_a_second_file_is_named_with_its_unit(made: Made) -> None:
    """The first keeps the name that it has alone."""
    _, folder, report = made
    for kind in PLAIN:
        first, second = paths(made, kind)
        assert first.stem == "cam"
        assert re.fullmatch(r"cam-.*\binch", second.stem)
        assert first.exists()
        assert second.exists()
    told = json.loads((folder / "report.json").read_text())["files"]
    assert {file["units"] for file in told} == {"mm", "inch"}
    assert report["units"] == "mm"


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRAWN)
def test_what_is_drawn_is_the_same_to_the_last_digits(kind: str, request: pytest.FixtureRequest) -> None:
    read: Callable[[Path], Any] = read_solid if kind == "step" else read_drawing
    millimetres, inches = (read(path) for path in paths(found_for(kind, request), kind))
    assert (millimetres.units_mm, inches.units_mm) == (1.0, INCH)
    assert np.abs(millimetres.contour.vertices - inches.contour.vertices).max() <= 1e-13
    assert inches.contour.area == pytest.approx(millimetres.contour.area, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    [
        "stl",
        "3mf",
        "gcode",  # needs: milling
    ],
)
def test_what_is_rounded_is_the_same_within_the_tolerance(kind: str, made: Made) -> None:
    sizes = []
    for path, mm in zip(paths(made, kind), (1.0, INCH), strict=True):
        if kind == "gcode":
            program = read_gcode(path)
            assert program.units_mm == mm
            continue
        solid = read_solid(path, (), mm if kind == "stl" else None)
        sizes.append((solid.contour.area / solid.contour.length, solid.thickness))
    assert not sizes or sizes[0] == pytest.approx(sizes[1], abs=TOLERANCE)


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    [
        "dxf",
        "svg",
        "stl",
        "3mf",
        "gcode",  # needs: milling
        pytest.param("step", marks=kernel),
    ],
)
def test_the_proof_holds_and_covers_the_conversion(kind: str, request: pytest.FixtureRequest) -> None:
    found = found_for(kind, request)
    told = {file["path"]: file for file in found[2]["files"]}
    own, other = (told[path.name] for path in paths(found, kind))
    for entry in (own, other):
        assert entry["measured_error"] <= entry["geometry_error"] + 1e-9
        assert entry["geometry_error"] <= TOLERANCE
    if kind in {"dxf", "svg", "step"}:
        assert own["geometry_error"] < other["geometry_error"] <= own["geometry_error"] + 1e-12


def contour_in(drawing: Any) -> Any:
    (found,) = drawing.modelspace().query("LWPOLYLINE[layer=='CUT']")
    return found


def test_another_reader_of_drawings(made: Made) -> None:
    millimetres, inches = (ezdxf.readfile(path) for path in paths(made, "dxf"))
    assert [d.header["$INSUNITS"] for d in (millimetres, inches)] == [4, 1]
    assert [d.header["$MEASUREMENT"] for d in (millimetres, inches)] == [1, 0]
    one, other = ([c.dxf.radius for c in d.modelspace().query("CIRCLE")] for d in (millimetres, inches))
    assert INCH * np.array(other) == pytest.approx(np.array(one), rel=1e-15)
    corners = [np.array(contour_in(drawing).get_points("xy")) for drawing in (millimetres, inches)]
    assert INCH * corners[1] == pytest.approx(corners[0], abs=1e-13)


def test_another_reader_of_meshes(made: Made) -> None:
    trimesh = pytest.importorskip("trimesh")
    one, other = (trimesh.load(path) for path in paths(made, "stl"))
    assert INCH * other.extents == pytest.approx(one.extents, abs=TOLERANCE)
    assert INCH**3 * other.volume == pytest.approx(one.volume, rel=1e-5)
    sizes = []
    for path, unit, mm in zip(paths(made, "3mf"), ("millimeter", "inch"), (1.0, INCH), strict=True):
        model = ET.fromstring(ZipFile(path).read("3D/3dmodel.model"))
        assert model.get("unit") == unit
        vertices = [[float(v.get(axis, "nan")) for axis in "xyz"] for v in model.iter() if v.tag.endswith("}vertex")]
        assert all(len(str(value).partition(".")[2]) <= 9 for vertex in vertices for value in vertex if value >= 1e-4)
        sizes.append(mm * np.ptp(vertices, axis=0))
    assert sizes[0] == pytest.approx(sizes[1], abs=TOLERANCE)


@pytest.mark.slow
@kernel
def test_another_reader_of_steps(stepped: Made) -> None:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    volumes = []
    for path in paths(stepped, "step"):
        reader = STEPControl_Reader()
        reader.ReadFile(str(path))
        reader.TransferRoots()
        properties = GProp_GProps()
        BRepGProp.VolumeProperties_s(reader.OneShape(), properties)
        volumes.append(properties.Mass())
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-9)


# needs: milling
def test_the_words_of_a_program(made: Made) -> None:
    millimetres, inches = (path.read_text() for path in paths(made, "gcode"))
    assert "G21" in millimetres
    assert "G20" in inches
    assert "(units: inch)" in inches

    def reach(text: str) -> float:
        return max(float(word) for word in re.findall(r"X(-?[0-9.]+)", text))

    assert INCH * reach(inches) == pytest.approx(reach(millimetres), abs=TOLERANCE)
    feeds = [float(re.findall(r"F([0-9.]+)", text)[-1]) for text in (millimetres, inches)]
    assert INCH * feeds[1] == pytest.approx(feeds[0], rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("table", ["motion", "contacts", "polar", "inspection"])
def test_the_columns_of_a_table(table: str, tmp_path: Path) -> None:
    rows = {}
    for unit in ("mm", "inch"):
        text = TEXT.format(units="mm", files=f"{{csv: {{as: {table}, units: {unit}}}}}")
        outcome = pipeline.export(load_text(text, "cam.yaml"), tmp_path / unit)
        with (tmp_path / unit / "cam" / "cam.csv").open() as stream:
            rows[unit] = list(csv.DictReader(stream))
        assert outcome.report["files"][0]["units"] == unit
    told = [name for name in rows["mm"][0] if name.endswith("_mm")]
    assert told
    for name in told:
        for one, other in zip(rows["mm"], rows["inch"], strict=True):
            a, b = one[name], other[name[:-2] + "in"]
            assert (a == b == "") or float(a) == pytest.approx(INCH * float(b), rel=1e-9, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "changed", "failing"),
    [
        ("dxf", (r"(\$INSUNITS\n *70\n *)1\n", r"\g<1>4\n"), "units"),
        ("svg", (r'(width="[0-9.]+)in(" height="[0-9.]+)in', r"\1mm\2mm"), "units"),
        # needs: milling
        ("gcode", ("G20", "G21"), "closed"),
        pytest.param("step", (r"WITH_UNIT\(2\.5399999999999999E\+01", "WITH_UNIT(2.55E+01"), "contour", marks=kernel),
    ],
)
def test_a_unit_that_is_misstated(
    kind: str, changed: tuple[str, str], failing: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    found = found_for(kind, request)
    inches = paths(found, kind)[1]
    text, count = re.subn(*changed, inches.read_text())
    assert count == 1
    spoilt = tmp_path / inches.name
    spoilt.write_text(text)
    assert failing in failures(found[0], spoilt)
    assert failures(found[0], inches) == set()


def failures(recipe: Recipe, path: Path) -> set[str]:
    return {check["name"] for check in pipeline.judge_files(recipe, [path])["checks"] if not check["ok"]}


@pytest.mark.slow
def test_a_shifted_vertex_of_an_inch_drawing(made: Made, tmp_path: Path) -> None:
    inches = paths(made, "dxf")[1]
    drawing = ezdxf.readfile(inches)
    contour = contour_in(drawing)
    x, y, *rest = contour[3]
    contour[3] = (x + 0.0002, y, *rest)  # 0.005 mm
    spoilt = tmp_path / inches.name
    drawing.saveas(spoilt)
    assert failures(made[0], spoilt) >= {"contour", "motion"}


@pytest.mark.slow
def test_a_mesh_has_the_unit_of_its_request(made: Made, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """An STL states no unit: that of the recipe's file of its name counts, or --units."""
    recipe, _, _ = made
    millimetres, inches = paths(made, "stl")
    assert failures(recipe, inches) == failures(recipe, millimetres) == set()
    swapped = tmp_path / inches.name
    swapped.write_bytes(millimetres.read_bytes())
    assert failures(recipe, swapped)
    text = tmp_path / "cam.yaml"
    text.write_text(recipe.text)
    renamed = tmp_path / "other.stl"
    renamed.write_bytes(inches.read_bytes())
    assert main(["verify", str(text), str(renamed)]) == 1
    assert "it states no unit and is read in one of 1 mm, another is given by --units" in capsys.readouterr().out
    assert main(["verify", str(text), str(renamed), "--units", "inch"]) == 0
    assert main(["verify", str(text), str(inches), "--tolerance", "0.0001in"]) == 0
    assert main(["verify", str(text), str(inches), "--tolerance", "0.00001in"]) == 1
    # the page shows what the judge has read, in mm
    verdict = verify(inches, intended(recipe, designed(recipe)), 360, Limits(TOLERANCE), INCH)
    (surface,) = verdict.surfaces
    assert surface.contour is not None
    assert np.abs(surface.contour.vertices).max() > 35.0


@pytest.mark.slow
def test_an_inch_recipe_with_files_in_mm(tmp_path: Path) -> None:
    recipe = recipe_of("dxf", "csv", units="inch", own=("mm",))
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok
    assert outcome.report["units"] == "inch"
    assert [file["units"] for file in outcome.report["files"]] == ["mm", "mm"]
    assert ezdxf.readfile(tmp_path / "cam" / "cam.dxf").header["$INSUNITS"] == 4
    assert outcome.report["files"][0]["tolerance"] == pytest.approx(TOLERANCE / INCH)


@pytest.mark.parametrize(("kind", "mm", "inch"), [("dxf", "mm", "inch"), ("csv", "mm", "inch"), ("stl", "mm", "mm")])
def test_the_unit_where_none_is_given(kind: str, mm: str, inch: str) -> None:
    for units, wanted in (("mm", mm), ("inch", inch)):
        recipe = load_text(TEXT.format(units=units, files=kind), "cam.yaml")
        (asked,) = recipe.export.files
        assert asked.units is None
        assert recipe.in_units_of(asked).units == wanted
        assert asked.filename("cam", recipe.export.files) == f"cam.{kind}"


# needs: mechanism
@pytest.mark.slow
def test_bodies_of_a_mechanism_in_inch(tmp_path: Path) -> None:
    text = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 6, bore: {square: 8}}\n"
    text += "export: {tolerance: 0.01, files: [{stl: {parts: all, units: inch}}, {3mf: {parts: all, units: inch}}]}\n"
    outcome = pipeline.export(load_text(text, "set.yaml"), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    assert {file["units"] for file in outcome.report["files"]} == {"inch"}
    assert len(outcome.report["files"]) > 4


@pytest.mark.parametrize(
    ("files", "said"),
    [
        (
            "{dxf: {units: furlong}}",
            "11:53: export.files[0].dxf.units: not one of the choices, given 'furlong'; give mm or inch",
        ),
        (
            "{stl: {units: in}}",
            "11:53: export.files[0].stl.units: not one of the choices, given 'in'; did you mean inch?",
        ),
        ("{glb: {units: inch}}", "11:46: export.files[0].glb.units: unknown key; it belongs at the top level"),
        # needs: mechanism
        ("{stl: {parts: all, units: mm}}, {stl: {parts: all, units: inch}}", "a second file of one name"),
        ("{dxf: {units: inch}}, {dxf: {units: inch}}", "export.files[1]: the same file twice"),
    ],
)
def test_what_is_refused(files: str, said: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        load_text(TEXT.format(units="mm", files=files), "cam.yaml")
    assert said in str(caught.value)


def test_a_fit_leaves_room_for_what_writing_moves() -> None:
    recipe = recipe_of("dxf")
    job = Job.of(recipe, designed(recipe))
    (plain,) = job.outlines("arcs", TOLERANCE)
    moved = TOLERANCE - 0.5 * plain.bound.worst
    assert job.written_outlines("arcs", TOLERANCE, lambda _: 0.0)[0] is plain
    (found,) = job.written_outlines("arcs", TOLERANCE, lambda _: 0.1 * TOLERANCE)
    assert found.bound.worst + 0.1 * TOLERANCE <= TOLERANCE
    assert job.written_outlines("arcs", TOLERANCE, lambda _: moved)[0] is plain  # no finer fit would help
    assert 0.0 < conversion_error(plain) < 1e-12


@given(st.floats(-500.0, 500.0), st.sampled_from([SINGLE, DECIMALS]))
def test_the_numbers_of_a_mesh_in_inch(value: float, numbers: Any) -> None:
    """What is held is what a reader makes of the number in the file, and it moves by half a spacing at most."""
    inches = numbers.in_units(INCH)
    held = inches.number(value)
    assert inches.number(held) == held
    assert abs(held - value) <= 0.5 * inches.spacing(abs(value) + 1e-9)
    written = numbers.nearest(np.array([held / INCH]))[0]
    assert written * INCH == held


def test_a_request_says_its_unit() -> None:
    assert FileRequest("dxf", units="inch").unit_for("mm") == "inch"
    assert FileRequest("dxf").unit_for("inch") == "inch"
    assert FileRequest("step").unit_for("inch") == "mm"
