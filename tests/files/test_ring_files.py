"""Rings through files: outline, opening and holes by second readers, and what a judge says of spoilt ones.

Holds: camgeo.output.drawing.
"""

import math

import numpy as np
import pytest
from support.heavy import ezdxf
from support.parts import files_of, found, recipe_of

from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.layer_outline import LayerOutline
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.pieces import ArcSpline
from camgeo.formats.dxf import write_dxf
from camgeo.machining.compensation import compensate
from camgeo.output import pipeline
from camgeo.part.shapes import disc
from camgeo.recipe.loading import load_text
from camgeo.recipe.machining import Compensation
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify

CAM = (
    "cam:\n  kind: disc\n  base_radius: 36\n  follower: {{kind: roller, radius: 9}}\n  track: internal\n{}"
    "  motion: [{{rise: 12, over: {}, law: modified-sine}}, {{dwell: 60}}, "
    "{{return: 12, over: 100, law: polynomial-345}}, {{dwell: {}}}]\n"
)
RING = CAM.format("", 110, 90)
PART = "{thickness: 8, outer: 130, bolts: {count: 5, circle: 118, hole: 5}}"
HOLES = 5 * math.pi * 2.5**2


def ring(part=PART, cam=RING, **other):
    return recipe_of(part, cam=cam, **other)


def volume(design):
    """Of the ring with its holes, by the closed form of the opening's area."""
    area, _ = design.exact.gauge.envelope.area_and_perimeter()
    return 8 * (math.pi * 65**2 - area - HOLES)


@pytest.mark.thin(6)
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
@pytest.mark.parametrize("form", ["arcs", "spline", "polyline"])
def test_a_drawing_shows_outline_opening_and_holes(tmp_path, form, rotation):
    recipe = ring(files=f"{{dxf: {{as: {form}}}}}, {{svg: {{as: {form}}}}}", more=f"rotation: {rotation}\n")
    _, made = files_of(recipe, tmp_path)
    entities = [one for one in ezdxf.readfile(made["dxf"][0]).modelspace() if one.dxf.layer != "REFERENCE"]
    round_ones = sorted((one.dxf.layer, one.dxf.radius) for one in entities if one.dxftype() == "CIRCLE")
    assert round_ones == [("CUT", 65.0)] + 5 * [("HOLES", 2.5)]
    assert [one.dxf.layer for one in entities if one.dxftype() != "CIRCLE"] == ["CUT"]
    for _, checks in made.values():
        assert checks["outer"].value < 1e-9
        assert checks["holes"].ok
        assert checks["motion"].ok
    text = made["svg"][0].read_text()
    assert text.count("<circle") == 6
    assert 'viewBox="-66 -66 132 132"' in text


@pytest.mark.slow
def test_solids_have_the_volume_of_the_ring(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    recipe = ring(files="stl, 3mf")
    design, made = files_of(recipe, tmp_path)
    meant = volume(design)
    mesh = trimesh.load(made["stl"][0])
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(meant, rel=3e-4)
    assert mesh.euler_number == 2 - 2 * 6  # an opening and five holes
    for _, checks in made.values():
        assert {"outer", "holes", "thickness", "volume", "contour", "motion"} <= set(checks)


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("form", ["arcs", "spline"])
def test_a_step_file_has_the_volume_of_the_ring(tmp_path, form):
    pytest.importorskip("OCP")
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps
    from OCP.STEPControl import STEPControl_Reader

    recipe = ring(files=f"{{step: {{as: {form}}}}}")
    design, made = files_of(recipe, tmp_path)
    path, checks = made["step"]
    reader, properties = STEPControl_Reader(), GProp_GProps()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    BRepGProp.VolumeProperties_s(reader.OneShape(), properties)
    assert properties.Mass() == pytest.approx(volume(design), rel=3e-4)
    assert checks["outer"].ok
    assert checks["volume"].ok


@pytest.mark.slow
def test_a_kerf_narrows_the_opening_and_widens_the_outline(tmp_path):
    """The pitch curve stays: the roller of the drawn part is smaller by what its opening is."""
    recipe = ring(files="{dxf: {kerf: 0.4}}")
    design, _ = found(recipe)
    made = compensate(recipe, design, Compensation(kerf=0.4), "export.files[0]")
    assert made.design.only_surface.surface.base.size == pytest.approx(design.only_surface.surface.base.size)
    contours = design.only_surface.contour, made.design.only_surface.contour
    point, inner = (one.sample(np.linspace(0.0, 6.0, 9)).point for one in contours)
    assert np.hypot(*(point - inner).T) == pytest.approx(np.full(9, 0.2))
    path, checks = files_of(recipe, tmp_path)[1]["dxf"]
    outline = max(one.dxf.radius for one in ezdxf.readfile(path).modelspace().query('CIRCLE[layer=="CUT"]'))
    assert outline == pytest.approx(65.2)
    assert checks["motion"].ok


@pytest.mark.slow
def test_a_trimmed_ring_tells_the_motion_that_is_lost(tmp_path):
    recipe = ring("{outer: 130}", CAM.format("  undercut: trim\n", 40, 160).replace("36\n", "30\n"), files="dxf")
    _, checks = found(recipe)
    lost = checks["undercut-local"].value
    assert checks["undercut-local"].detail.endswith("trimmed")
    assert lost > 0.05
    design, made = files_of(recipe, tmp_path)
    verdict = verify(made["dxf"][0], intended(recipe, design), 360, Limits(0.01))
    assert verdict.ok
    assert verdict.motion.max == pytest.approx(lost, rel=0.2)


# --- spoilt rings -----------------------------------------------------------------------------------------------------


def turned(outline: ArcSpline, degrees: float) -> ArcSpline:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return ArcSpline(outline.points @ np.array([[c, s], [-s, c]]), outline.bulges, outline.bound)


FAULTS = {
    "none": (-9.0, 0.0, 130.0),
    "the radius on the wrong side": (9.0, 0.0, 130.0),
    "one micrometre too deep": (-9.001, 0.0, 130.0),
    "turned": (-9.0, 0.02, 130.0),
    "of another outline": (-9.0, 0.0, 130.001),
}


@pytest.mark.thin(4)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_spoilt_ring_is_caught(tmp_path, fault):
    recipe = ring("{outer: 130}")
    design, _ = found(recipe)
    distance, degrees, outer = FAULTS[fault]
    outline = turned(fit_arcs(Curve.whole(Parallel(design.only_surface.surface.base.shape, distance)), 2e-5), degrees)
    path = tmp_path / "ring.dxf"
    rim = disc("outline", "CUT", (0.0, 0.0), 0.5 * outer)
    write_dxf(path, [LayerOutline("CUT", outline), LayerOutline("CUT", rim.outline, rim.circle)])
    verdict = verify(path, intended(recipe, design), 180, Limits(1e-4))
    failed = {check.name for check in verdict.checks if not check.ok}
    assert failed == {
        "none": set(),
        "of another outline": {"outer"},
    }.get(fault, {"contour", "motion"})


def test_a_solid_of_another_height_is_told_as_such(tmp_path):
    text = (
        "cam: {kind: disc, base_radius: 60, track: internal, follower: {kind: roller, radius: 9},\n"
        "  motion: [{rise: 10, over: 180, law: cycloidal}, {return: 10, over: 180, law: cycloidal}]}\n"
        "part: {thickness: 8, outer: 180}\nexport: {files: [stl]}\nverify: {angles: 36}\n"
    )
    assert pipeline.export(load_text(text, "low.yaml"), tmp_path).ok
    high = load_text(text.replace("thickness: 8", "thickness: 20"), "high.yaml")
    checks = pipeline.judge_files(high, [tmp_path / "low" / "low.stl"])["checks"]
    (failed,) = (check for check in checks if not check["ok"])
    assert "no section" in failed["detail"]
