"""STEP files written by Open CASCADE: read back by kin and by the kernel itself, judged, and with faults planted.

Holds: camgeo.files.brep.
"""

import builtins
import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.cases import few
from support.kernel import kernel, made, step_recipe
from support.parts import CAM, failures, files_of
from support.places import TESTS

from camgeo.cli.main import main
from camgeo.files.brep import need_kernel
from camgeo.files.curves import FLATTEST, misfit
from camgeo.files.errors import MissingExtraError
from camgeo.files.layer_outline import LayerOutline
from camgeo.files.solid import Solid
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import ArcSpline, Bound
from camgeo.formats.step import StepBody, write_step
from camgeo.output import pipeline
from camgeo.output.job import Job
from camgeo.output.part_geometry import contours_of, rim_of, solid_of
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.read.step.part21 import exchange
from kin.read.step.step import read_step

AREA = math.pi * (25**2 - 4 * 8 / 2)  # of p = 25 + 2 cos 3t: pi (m^2 + (1 - k^2) a^2/2)
PERIMETER = 50 * math.pi
FULL = (
    "{thickness: 8, bore: 12, keyway: {standard: din6885, at: 180}, hub: {diameter: 22, height: 10}, "
    "set_screw: {diameter: 3.4, at: 90}, bolts: {count: 3, circle: 31, hole: 3.2, start: 60}, "
    "dowel: {circle: 31, hole: 3, at: 200}, lightening: {largest: 2, wall: 1.5}, chamfer: 0.5, "
    "mark: {length: 3, width: 0.8, depth: 0.4}, wall: 1.2}"
)

BUSY = (
    "{thickness: 8, bore: 12, hub: {diameter: 22, height: 10}, set_screw: {diameter: 3.4, at: 90}, "
    "bolts: {count: 2, circle: 31, hole: 3.2}, chamfer: 0.5, mark: {length: 3, width: 0.8, depth: 0.4, radius: 21}}"
)


def written(recipe, folder):
    """A file that is not judged."""
    job = Job.of(recipe, designed(recipe))
    path = folder / "part.step"
    contours = contours_of(job.design, job.outlines("arcs", 0.001))
    write_step(path, [StepBody([*rim_of(job.body), *contours], solid_of(job.body))], tolerance=0.001, name="part")
    return path


def by_the_kernel(path):
    """The shape that the kernel reads, and its volume, mm^3, by the kernel's adaptive rule and by its plain one."""
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)).name == "IFSelect_RetDone"
    reader.TransferRoots()
    shape = reader.OneShape()
    assert BRepCheck_Analyzer(shape).IsValid()
    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, 1e-10, True)
    plain = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, plain)
    return shape, properties.Mass(), plain.Mass()


@pytest.fixture(scope="module")
def busy():
    recipe = step_recipe(BUSY)
    return recipe, designed(recipe)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """A disc with a bore: recipe, design and what its file says."""
    recipe = step_recipe("{thickness: 8, bore: 12}")
    design, path = made(recipe, tmp_path_factory.mktemp("plain"))
    return recipe, design, path.read_text()


def kinds_in(path):
    found = {}
    for records in exchange(path.read_bytes(), path).instances.values():
        for kind in records:
            found[kind] = found.get(kind, 0) + 1
    return found


# --- what is written ------------------------------------------------------------------------------------------------


@pytest.mark.thin(2)
@kernel
@pytest.mark.parametrize("form", ["arcs", "spline"])
def test_a_plain_disc_in_each_form(tmp_path, form):
    _, path = made(step_recipe("{thickness: 8, bore: 12}", f"{{step: {{as: {form}}}}}"), tmp_path)
    solid = read_step(path)
    assert solid.faults == ()
    assert solid.prism
    meant = 8 * (AREA - 36 * math.pi)
    assert solid.volume == pytest.approx(meant, rel=0, abs=8 * 0.001 * PERIMETER)
    _, volume, plain = by_the_kernel(path)
    assert volume == pytest.approx(solid.volume, rel=1e-8)  # the kernel's rule on a spline
    assert plain == pytest.approx(solid.volume, rel=1e-12)
    found = kinds_in(path)
    assert found["CYLINDRICAL_SURFACE"] == (1 + solid.pieces if form == "arcs" else 1)
    assert found.get("SURFACE_OF_LINEAR_EXTRUSION", 0) == {"arcs": 0, "spline": solid.pieces}[form]
    assert found["PLANE"] == 2
    assert not {"PCURVE", "B_SPLINE_SURFACE_WITH_KNOTS", "POLY_LOOP"} & set(found)
    assert path.read_text().count("SI_UNIT(.MILLI.,.METRE.)") == 1


@kernel
def test_every_feature_is_exact_and_is_found(tmp_path):
    design, path = made(step_recipe(FULL), tmp_path)
    solid = read_step(path)
    assert solid.faults == ()
    assert not solid.prism
    assert solid.faces == pytest.approx((0.0, 7.6, 8.0, 18.0), abs=1e-12)
    _, volume, _ = by_the_kernel(path)
    assert volume == pytest.approx(solid.volume, rel=1e-7)
    found = kinds_in(path)
    holes = sum(opening.circle is not None for opening in design.discs[0].body.openings)
    assert holes == 6
    # the contour, its holes, the hub, the bore and the ends of the mark, the set screw
    assert found["CYLINDRICAL_SURFACE"] == solid.pieces + holes + 1 + 1 + 2 + 1
    assert found["CONICAL_SURFACE"] == 2 * solid.pieces
    assert found["B_SPLINE_CURVE_WITH_KNOTS"] == 2  # where the set screw meets hub and bore


@pytest.mark.slow
@kernel
@pytest.mark.parametrize("side", few(["bottom", "both"], 2))
def test_hubs_on_other_sides_mirrored(tmp_path, side):
    hub = f"hub: {{diameter: 20, height: 7, side: {side}}}"
    part = f"{{thickness: 6, bore: 10, {hub}, set_screw: {{diameter: 3, at: 40}}}}"
    _, path = made(step_recipe(part, more="rotation: ccw\n"), tmp_path)
    assert read_step(path).z_min == pytest.approx(-7.0, abs=1e-12)


@kernel
def test_inches_are_written_as_millimetres(tmp_path):
    cam = "units: inch\ncam: {kind: support, p: 1 + 0.05*cos(3*t)}\n"
    recipe = read(
        f"{cam}part: {{thickness: 0.5, bore: 0.25}}\nexport: {{tolerance: 0.0001, files: [step]}}\n".encode(),
        Path("part.yaml"),
    )
    _, path = made(recipe, tmp_path)
    solid = read_step(path)
    assert (solid.units_mm, solid.z_max) == (1.0, 12.7)
    assert solid.volume == pytest.approx(25.4**3 * 0.5 * math.pi * (1 - 8 * 0.05**2 / 2 - 1 / 64), rel=1e-4)


@pytest.mark.slow
@kernel
@pytest.mark.parametrize("form", few(["arcs", "spline"], 2))
def test_a_contour_with_corners(tmp_path, form):
    cam = "cam: {kind: support, p: 20 + 7.5*cos(2*t), undercut: trim}\n"
    recipe = step_recipe("{thickness: 5, bore: 8}", f"{{step: {{as: {form}}}}}", cam=cam)
    assert designed(recipe).trimmed
    _, path = made(recipe, tmp_path)
    assert read_step(path).faults == ()


@pytest.mark.slow
@kernel
def test_names_and_header_and_the_same_bytes(tmp_path):
    body = "name: kurve\nabout: Käfer's \\ note\n"
    recipe = step_recipe("{thickness: 8, bore: 12}", more=body)
    _, path = made(recipe, tmp_path)
    first = path.read_bytes()
    text = first.decode("ascii")
    assert "'2000-01-01T00:00:00'" in text
    assert re.search(r"PRODUCT\('kurve',\s*'kurve',\s*'K\\X2\\00E4\\X0\\fer''s \\\\ note'", text)
    assert "MANIFOLD_SOLID_BREP('kurve'" in text
    assert "FILE_NAME('kurve.step'" in text
    assert "AUTOMOTIVE_DESIGN" in text
    made(recipe, tmp_path)
    assert path.read_bytes() == first
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from pathlib import Path; "
        "from support.kernel import made, step_recipe; "
        "made(step_recipe('{thickness: 8, bore: 12}', more=sys.argv[3]), Path(sys.argv[2]))"
    )
    other = tmp_path / "other"
    other.mkdir()
    done = subprocess.run(
        [sys.executable, "-c", code, str(TESTS), str(other), body],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == ""  # the kernel keeps its statistics to itself
    assert (other / path.name).read_bytes() == first


@pytest.mark.slow
@kernel
def test_settings_of_the_kernel_are_as_they_were(tmp_path):
    from OCP.Interface import Interface_Static

    made(step_recipe("{thickness: 8}"), tmp_path)
    Interface_Static.SetCVal_s("write.step.schema", "AP242DIS")
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 1)
    made(step_recipe("{thickness: 8}"), tmp_path)
    assert Interface_Static.CVal_s("write.step.schema") == "AP242DIS"
    assert Interface_Static.IVal_s("write.surfacecurve.mode") == 1
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")


@kernel
def test_cadquery_imports_it(tmp_path):
    cadquery = pytest.importorskip("cadquery")
    _, path = made(step_recipe(FULL), tmp_path)
    part = cadquery.importers.importStep(str(path))
    assert part.solids().size() == 1
    box = part.val().BoundingBox()
    assert (box.zmin, box.zmax) == pytest.approx((0.0, 18.0), abs=1e-6)
    assert part.faces("<Z").val().geomType() == "PLANE"


# --- planted faults -------------------------------------------------------------------------------------------------


@pytest.mark.thin(3)
@kernel
@pytest.mark.parametrize(
    ("pattern", "replacement", "found"),
    [
        (r"(CYLINDRICAL_SURFACE\('',#\d+,\s*)6\.0+E\+00", r"\g<1>6.0100000000000000E+00", {"watertight"}),
        (r"6\.0000000000000000E\+00(?=\))", "6.0100000000000000E+00", {"watertight"}),
        (r"SI_UNIT\(\.MILLI\.,", "SI_UNIT($,", {"bore", "contour", "thickness", "motion", "volume"}),
        (r"SI_UNIT\(\.MILLI\.,", "SI_UNIT(.CENTI.,", {"bore", "contour", "thickness", "volume", "motion"}),
        (r"8\.0000000000000000E\+00", "8.0100000000000000E+00", {"thickness"}),
        (r"CLOSED_SHELL\('',\((#\d+),", "CLOSED_SHELL('',(", {"watertight"}),
    ],
)
def test_planted_faults_are_caught(plain, tmp_path, pattern, replacement, found):
    recipe, design, text = plain
    every = 0 if "8.0" in replacement or replacement.startswith("6.01") else 1
    faulty, count = re.subn(pattern, replacement, text, count=every)
    assert count
    path = tmp_path / "part.step"
    path.write_text(faulty)
    failed = failures(path, recipe, design, 0.001)
    assert failed & found, failed


@kernel
def test_a_moved_corner_of_the_contour_is_caught(plain, tmp_path):
    recipe, design, text = plain
    vertex = re.search(r"VERTEX_POINT\('',(#\d+)\)", text)[1]
    number = re.search(rf"{vertex} = CARTESIAN_POINT\('',\(\s*([-+.\dE]+)", text)[1]
    assert text.count(number) > 2
    path = tmp_path / "part.step"
    path.write_text(text.replace(number, f"{float(number) + 0.01:.16E}"))
    assert failures(path, recipe, design, 0.001) & {"watertight", "contour"}


@pytest.mark.slow
@kernel
@pytest.mark.parametrize(
    ("change", "check"),
    few(
        [
            ({"thickness: 8": "thickness: 8.01"}, "thickness"),
            ({"bore: 12": "bore: 12.01"}, "bore"),
            ({"height: 10}": "height: 10.01}"}, "hub"),
            ({"diameter: 22": "diameter: 22.01"}, "hub"),
            ({"diameter: 3.4": "diameter: 3.42"}, "set-screw"),
            ({"at: 90": "at: 90.2"}, "set-screw"),
            ({"chamfer: 0.5": "chamfer: 0.51"}, "chamfer"),
            ({"depth: 0.4": "depth: 0.41"}, "mark"),
            ({"hole: 3.2": "hole: 3.21"}, "holes"),
        ],
        2,
    ),
)
def test_a_part_that_is_not_the_one_meant(tmp_path, busy, change, check):
    text = BUSY
    for old, new in change.items():
        assert old in text
        text = text.replace(old, new)
    path = written(step_recipe(text), tmp_path)
    recipe, design = busy
    assert check in failures(path, recipe, design, 0.001)


@pytest.mark.slow
@kernel
def test_the_part_meant_is_sound(tmp_path, busy):
    recipe, design = busy
    assert not failures(written(recipe, tmp_path), recipe, design, 0.001)


# --- bounds and refusals --------------------------------------------------------------------------------------------


def test_rounding_of_circles_is_in_the_bound():
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    for bulge in (0.3, 1e-3, 1e-6):
        outline = ArcSpline(square, np.full(4, bulge), Bound(0.0, 0.0))
        radius = 10 * (1 + bulge**2) / (4 * bulge)
        assert 2.2e-16 * radius < misfit(outline) < 1e-13 * radius
    flat = 0.2 * FLATTEST
    assert misfit(ArcSpline(square, np.full(4, flat), Bound(0.0, 0.0))) == pytest.approx(5 * flat)
    assert misfit(ArcSpline(square, np.zeros(4), Bound(0.0, 0.0))) == 0.0


@kernel
def test_a_tolerance_below_rounding_is_refused(tmp_path):
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    outline = ArcSpline(square, np.full(4, 1e-7), Bound(1e-12, 1e-12))
    with pytest.raises(ToleranceError, match=r"more than 1e-10 mm: circles of nearly straight arcs"):
        write_step(
            tmp_path / "x.step",
            [StepBody([LayerOutline("CUT", outline)], Solid(5.0, 0.0, 5.0, None, 0.0, []))],
            tolerance=1e-10,
        )


@pytest.mark.slow
@kernel
@pytest.mark.parametrize("form", few(["arcs", "spline"], 2))
def test_fine_tolerances_are_held(tmp_path, form):
    recipe = step_recipe("{thickness: 8, bore: 12}", f"{{step: {{as: {form}, tolerance: 1.0e-6}}}}")
    _, files = files_of(recipe, tmp_path)
    assert all(check.ok for check in files["step"][1].values())


@pytest.mark.slow
@pytest.mark.parametrize("hub", ["", ", hub: {diameter: 20, height: 5}"])
def test_an_eccentric_circle_has_a_chamfer(hub):
    """Its cone, whole, would have a seam; no other contour is a single circle."""
    cam = "cam: {kind: support, p: 25 + 3*cos(t)}\n"
    recipe = step_recipe(f"{{thickness: 8, bore: 10, chamfer: 1{hub}}}", cam=cam)
    outcome = pipeline.check(recipe)
    assert outcome.ok
    assert any(check["name"] == "chamfer" and check["ok"] for check in outcome.report["checks"])


def test_a_chamfer_along_a_spline_is_refused():
    with pytest.raises(
        RecipeErrors, match=r"step\.as: the chamfer of a spline is not a spline, given 'spline'; give arcs"
    ):
        step_recipe("{thickness: 8, chamfer: 0.5}", "{step: {as: spline}}")


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ("{step: {as: polyline}}", "step.as: not one of the choices, given 'polyline'"),
        ("{step: {version: AP214}}", "version: unknown key"),
        ("{step: {tolerance: 0}}", "tolerance: not above 0"),
    ],
)
def test_options_that_are_wrong(files, message):
    with pytest.raises(RecipeErrors) as caught:
        step_recipe("{thickness: 8}", files)
    assert message in str(caught.value)


def test_a_thickness_is_needed():
    with pytest.raises(RecipeErrors, match="step needs a thickness"):
        step_recipe("{bore: 12}")


def test_without_the_extra_the_run_says_what_to_install(tmp_path, monkeypatch, capsys):
    real = builtins.__import__

    def missing(name, *args, **kwargs):
        if name.split(".")[0] == "OCP":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", missing)
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(f"{CAM}part: {{thickness: 8}}\nexport: {{files: [step]}}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 3
    assert "a STEP file needs Open CASCADE: pip install '.[step]' in a clone of camgeo" in capsys.readouterr().err
    circle = ArcSpline(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.ones(2), Bound(0.0, 0.0))
    with pytest.raises(MissingExtraError):
        write_step(
            tmp_path / "x.step",
            [StepBody([LayerOutline("CUT", circle)], Solid(5.0, 0.0, 5.0, None, 0.0, []))],
            tolerance=1e-3,
        )


def test_an_interrupt_while_the_kernel_is_imported_is_no_missing_package(tmp_path, monkeypatch, capsys):
    real = builtins.__import__

    def stopped(name, *args, **kwargs):
        if name.split(".")[0] == "OCP":
            raise ImportError("initialization failed") from KeyboardInterrupt()
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", stopped)
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(f"{CAM}part: {{thickness: 8}}\nexport: {{files: [step]}}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 130
    assert "Open CASCADE" not in capsys.readouterr().err
    with pytest.raises(KeyboardInterrupt):
        need_kernel()


@kernel
def test_another_version_of_the_kernel_is_told(monkeypatch):
    import OCP

    monkeypatch.setattr(OCP, "__version__", "8.0.1.1")
    with pytest.raises(MissingExtraError, match=r"needs Open CASCADE 7, not 8\.0\.1\.1: pip install"):
        need_kernel()


@pytest.mark.slow
@kernel
def test_the_command_verifies_a_file_of_another_name(tmp_path, capsys):
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(f"{CAM}part: {{thickness: 8, bore: 12}}\nexport: {{files: [step]}}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path / "out")]) == 0
    (made_file,) = (tmp_path / "out").rglob("*.step")
    other = tmp_path / "returned.STP"
    other.write_bytes(made_file.read_bytes())
    assert main(["verify", str(recipe), str(other)]) == 0
    other.write_text(made_file.read_text().replace("SI_UNIT(.MILLI.,", "SI_UNIT($,"))
    assert main(["verify", str(recipe), str(other)]) == 1
    assert "returned.STP" in "".join(capsys.readouterr())
