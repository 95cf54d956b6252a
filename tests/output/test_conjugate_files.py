"""Files of conjugate discs: a file for each disc or one for both, made, opened by others, and judged as a set."""

import json
import math
import re
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from support.heavy import ezdxf, trimesh
from support.kernel import kernel

import camgeo
from camgeo.cli.main import main
from camgeo.output.dispatch import demand_capacity
from camgeo.recipe.loading import read
from camgeo.registry.formats import FORMATS
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import foreseen
from camgeo.testing import assert_contour, assert_motion

RECIPE = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 6}
  conjugate: {radius: 11, distance: 120, gap: 2}
  motion:
    - {rise: 24, over: 100, law: polynomial-4567}
    - {dwell: 40}
    - {return: 24, over: 140, law: polynomial-4567}
    - {dwell: 80}
part: {thickness: 12, bore: 20, keyway: {width: 6, depth: 2.8, at: 90}}
export: {tolerance: 1e-4, files: [dxf, {3mf: {tolerance: 0.01}}, glb]}
verify: {angles: 36}
"""
STL_AND_STEP = RECIPE.replace("[dxf, {3mf: {tolerance: 0.01}}, glb]", "[stl, step]").replace("1e-4", "0.001")


def written(folder, text=RECIPE, name="pair"):
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The recipe, and the report on its files."""
    recipe = written(tmp_path_factory.mktemp("pair"))
    report = camgeo.export(recipe, recipe.parent)
    assert report.ok, [check for check in report.checks if not check.ok]
    return recipe, report


def failures(report):
    return {(check.file, check.surface, check.name) for check in report.checks if not check.ok}


def test_every_disc_has_a_file_or_stands_in_one_with_the_other(made):
    _, report = made
    assert [file.name for file in report.files] == ["pair-1.dxf", "pair-2.dxf", "pair.3mf", "pair.glb"]
    entries = {entry["path"]: entry for entry in report["files"]}
    assert [entries[f"pair-{k}.dxf"]["surface"] for k in (1, 2)] == ["disc 1", "disc 2"]
    assert "play" not in entries["pair-1.dxf"]
    (play,) = entries["pair-2.dxf"]["play"]
    assert play["between"] == ["disc 1", "disc 2"]
    assert max(abs(play["min"]), abs(play["max"])) < 2.3e-4
    assert [one["name"] for one in entries["pair.3mf"]["surfaces"]] == ["disc 1", "disc 2"]
    assert len(entries["pair.3mf"]["play"]) == 1


def test_the_checks_are_those_that_are_foreseen(made):
    recipe, report = made
    told = {str(one) for one in foreseen(read(recipe.read_bytes(), recipe))}
    found = {check.name + (f"[{check.file}]" if check.file else "") for check in report.checks}
    assert found == told
    assert "form-closure[pair-2.dxf]" in told
    assert "form-closure[pair-1.dxf]" not in told


def test_other_programs_find_two_discs_in_place(made):
    _, report = made
    foot = math.sqrt(45**2 - 6**2)  # each contour reaches farthest where its own roller stands highest
    for k, reach in ((1, math.hypot(foot + 24, 6) - 9), (2, math.hypot(120 - foot, 6) - 11)):
        drawing = ezdxf.readfile(report.path / f"pair-{k}.dxf")
        (contour,) = drawing.modelspace().query("LWPOLYLINE[layer=='CUT']")
        assert contour.closed
        points = np.array([[x, y] for x, y, *_ in contour.get_points("xyb")])
        assert np.hypot(*points.T).max() == pytest.approx(reach, abs=2e-4)
        assert len(drawing.modelspace().query("*[layer=='BORE']")) == 1
        assert not drawing.audit().has_errors
    scene = trimesh.load_scene(report.path / "pair.3mf")
    heights = {name: mesh.bounds[:, 2].tolist() for name, mesh in scene.geometry.items()}
    assert set(heights) == {"disc 1", "disc 2"}
    assert scene.bounds[:, 2].tolist() == [0.0, 26.0]
    assert all(mesh.is_watertight for mesh in scene.geometry.values())
    view = trimesh.load_scene(report.path / "pair.glb")
    assert len(view.geometry) == 2
    assert view.extents[1] == pytest.approx(0.026)  # upward in glTF, in metres


def test_each_drawing_has_the_reference_circles_of_its_disc(made):
    """Of disc 2 the circle about the shaft that its roller's centre touches, by a look at many places of the motion."""
    recipe, report = made
    motion = designed(read(recipe.read_bytes(), recipe)).exact.motion
    lift = motion.rows(np.linspace(0.0, 2.0 * math.pi, 3601), 0)[0]
    start = math.sqrt((36.0 + 9.0) ** 2 - 6.0**2)  # of the stem, above the shaft
    second = np.hypot(120.0 - start - lift, 6.0).min()
    radii = []
    for file in report.files[:2]:
        drawing = ezdxf.readfile(recipe.parent / "pair" / file.name)
        reference = [entity for entity in drawing.modelspace() if entity.dxf.layer == "REFERENCE"]
        radii.append([entity.dxf.radius for entity in reference if entity.dxftype() == "CIRCLE"])
    assert radii == [[36.0, 45.0], [pytest.approx(second, rel=1e-6)]]


def dense(path):
    """Points (n,) of a drawing's contour, complex, each arc cut by its bulge into parts of some 6 microns at most."""
    (contour,) = ezdxf.readfile(path).modelspace().query("LWPOLYLINE[layer=='CUT']")
    rows = [(complex(x, y), b) for x, y, b in contour.get_points("xyb")]
    found = []
    for (start, bulge), (end, _) in zip(rows, rows[1:] + rows[:1], strict=True):
        share = np.arange(0.0, 1.0, 0.006 / abs(end - start))
        if abs(bulge) > 1e-12:
            centre = 0.5 * (start + end) + 0.5j * (end - start) * (1 - bulge**2) / (2 * bulge)
            found.append(centre + (start - centre) * np.exp(4j * np.arctan(bulge) * share))
        else:
            found.append(start + share * (end - start))
    return np.concatenate(found)


def test_the_play_is_that_of_every_point_of_both_drawings(made):
    """The stem is pushed out by roller 1 and stopped by roller 2; nothing of this is camgeo's."""
    _, report = made
    one, two = (dense(report.path / f"pair-{k}.dxf") for k in (1, 2))
    (play,) = report["files"][1]["play"]
    worst = [play["min_at_deg"], play["max_at_deg"]]
    left = []
    for theta in np.radians([*worst, *range(0, 360, 9)]):
        near, far = one * np.exp(-1j * theta) - 6j, two * np.exp(-1j * theta) - 6j
        near, far = near[np.abs(near.imag) < 9], far[np.abs(far.imag) < 11]
        pushed = (near.real + np.sqrt(81 - near.imag**2)).max()
        left.append(120 + (far.real - np.sqrt(121 - far.imag**2)).min() - pushed)
    assert left[:2] == pytest.approx([play["min"], play["max"]], abs=2e-6)
    assert play["min"] - 1e-6 < min(left)
    assert max(left) < play["max"] + 2e-6


def test_one_disc_is_judged_alone_and_says_what_is_left_out(made):
    recipe, report = made
    alone = camgeo.verify(recipe, report.path / "pair-2.dxf")
    assert alone.ok
    left = {entry["what"]: entry["why"] for entry in alone["skipped"]}
    assert left["form-closure"] == "pair-2.dxf is judged alone: disc 1 is not among the files that are given"


def test_one_file_for_both_discs_is_refused(made, capsys):
    """Else disc 1 would be judged twice, each time alone, and a pair without a disc 2 called right."""
    recipe, report = made
    first = report.path / "pair-1.dxf"
    with pytest.raises(camgeo.CallError, match=r"-1\.dxf: it is given 2 times; give each file once"):
        camgeo.verify(recipe, first, first)
    assert main(["verify", str(recipe), str(first), str(first)]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "give each file once" in told


def test_a_table_is_not_judged_against_a_pair(made, tmp_path, capsys):
    table = tmp_path / "pair.csv"
    table.write_text("c_deg,x_mm\n0,30\n")
    assert main(["verify", str(made[0]), str(table)]) == 1
    assert "readable (pair.csv): a 3MF or STEP holds 2 discs" in capsys.readouterr().out


# needs: made
@pytest.mark.parametrize(
    ("text", "words"), [("", "no row of numbers"), ("a,b\n1,2\n", "no columns of measured points")]
)
def test_a_table_that_is_none_is_no_points_of_a_pair_either(made, tmp_path, capsys, text, words):
    table = tmp_path / "pair.csv"
    table.write_text(text)
    assert main(["verify", str(made[0]), str(table)]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.slow
def test_files_by_other_names_are_taken_in_their_order(made, tmp_path, capsys):
    recipe, report = made
    paths = [tmp_path / name for name in ("left.dxf", "right.dxf")]
    for path, k in zip(paths, (1, 2), strict=True):
        path.write_bytes((report.path / f"pair-{k}.dxf").read_bytes())
    assert main(["verify", str(recipe), *map(str, paths)]) == 0
    assert main(["verify", str(recipe), *map(str, paths[::-1]), "--json"]) == 1
    told = json.loads(capsys.readouterr().out.split("\n", 1)[1])
    assert [file["path"] for file in told["files"]] == ["right.dxf", "left.dxf"]
    failed = {(check["name"], check.get("surface"), check["file"]) for check in told["checks"] if not check["ok"]}
    assert failed >= {("contour", "disc 1", "right.dxf"), ("contour", "disc 2", "left.dxf")}


@pytest.mark.slow
def test_assertions_take_the_worst_of_both_discs(made):
    recipe, report = made
    (entry,) = [entry for entry in report["files"] if entry["path"] == "pair.3mf"]
    both = [one["measured_error"] for one in entry["surfaces"]]
    assert assert_contour(recipe, report.path / "pair.3mf") == max(both) > min(both)
    alone = report["files"][1]["motion"]
    assert assert_motion(recipe, report.path / "pair-2.dxf").max == alone["max"]


# --- planted faults ---------------------------------------------------------------------------------------------------


def redrawn(path, there, change):
    """The drawing with its contour changed, a complex function of its points."""
    drawing = ezdxf.readfile(path)
    (contour,) = drawing.modelspace().query("LWPOLYLINE[layer=='CUT']")
    points = [(complex(x, y), b) for x, y, b in contour.get_points("xyb")]
    flipped = change(1j) * change(1.0).conjugate()
    sign = math.copysign(1.0, flipped.imag)
    contour.set_points([((w := change(z)).real, w.imag, sign * b) for z, b in points], format="xyb")
    drawing.saveas(there)
    return there


@pytest.mark.parametrize(
    ("change", "caught"),
    [
        pytest.param(lambda z: z * np.exp(1j * math.radians(0.02)), {"contour", "motion", "form-closure"}, id="turned"),
        pytest.param(
            lambda z: z.conjugate(), {"contour", "motion", "form-closure"}, id="mirrored", marks=pytest.mark.slow
        ),
        pytest.param(lambda z: z * (1 + 4e-6), {"contour", "motion"}, id="larger", marks=pytest.mark.slow),
    ],
)
def test_a_fault_of_disc_2_is_caught_in_its_file(made, tmp_path, change, caught):
    recipe, report = made
    there = redrawn(report.path / "pair-2.dxf", tmp_path / "pair-2.dxf", change)
    found = failures(camgeo.verify(recipe, report.path / "pair-1.dxf", there))
    assert {name for _, _, name in found} >= caught
    assert {file for file, _, _ in found} == {"pair-2.dxf"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("written_as", "caught"),
    [
        (("gap: 2", "gap: 2.0002"), set()),
        (("offset: 6", "offset: 6.001"), {("disc 2", "contour"), ("disc 2", "motion"), ("", "form-closure")}),
        ((", keyway: {width: 6, depth: 2.8, at: 90}", ""), {("", "bore")}),
        (("at: 90", "at: 90.02"), {("", "bore")}),
    ],
)
def test_a_disc_of_another_recipe_is_caught(made, tmp_path, written_as, caught):
    recipe, report = made
    other = camgeo.export(written(tmp_path, RECIPE.replace(*written_as)), tmp_path, only=["dxf"])
    found = failures(camgeo.verify(recipe, report.path / "pair-1.dxf", other.path / "pair-2.dxf"))
    assert found == {("pair-2.dxf", *one) for one in caught}  # a drawing tells nothing of the gap


@pytest.fixture(scope="module")
def fine(tmp_path_factory):
    """The recipe, and the path of its pair in a 3MF within 1e-4 mm."""
    recipe = written(tmp_path_factory.mktemp("fine"), RECIPE.replace("{3mf: {tolerance: 0.01}}", "3mf"))
    return recipe, camgeo.export(recipe, recipe.parent, only=["3mf"]).path / "pair.3mf"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("turned", "level", "caught"),
    [(0.0, 14.0002, {"thickness"}), (0.0, 13.9998, {"thickness"}), (0.02, 14.0, {"contour", "motion", "bore"})],
)
def test_a_body_of_a_3mf_out_of_its_place_is_caught(fine, tmp_path, turned, level, caught):
    recipe, path = fine
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    there, place = tmp_path / "pair.3mf", f'"{c!r} {s!r} 0 {-s!r} {c!r} 0 0 0 1 0 0 {level!r}"'
    with ZipFile(path) as source, ZipFile(there, "w") as target:
        for name in source.namelist():
            text = source.read(name).decode()
            moved = re.sub(r'"[^"]* 14"(?=/>)', place, text)
            assert (moved != text) == name.endswith(".model")
            target.writestr(name, moved)
    report = camgeo.verify(recipe, there)
    assert failures(report) >= {("pair.3mf", "disc 2", name) for name in caught}
    assert not any(surface == "disc 1" for _, surface, _ in failures(report))
    (check,) = [check for check in report.checks if check.name == "thickness" and check.surface == "disc 2"]
    told = f"a horizontal face at z = {level - 14:.9g} mm, where none is expected"
    assert (told in check.detail) == (level != 14.0)


@pytest.mark.thin(3)
@pytest.mark.parametrize(("level", "words"), [(0.0, "14 mm lower"), (9.0, "5 mm lower"), (16.5, "2.5 mm higher")])
def test_a_body_that_another_program_dropped_to_the_plate(made, tmp_path, level, words):
    """Also where its layers are no longer at the heights of any section."""
    recipe, report = made
    there = tmp_path / "pair.3mf"
    with ZipFile(report.path / "pair.3mf") as source, ZipFile(there, "w") as target:
        for name in source.namelist():
            text = source.read(name).decode()
            target.writestr(name, re.sub(r'"[^"]* 14"(?=/>)', f'"1 0 0 0 1 0 0 0 1 0 0 {level}"', text))
    report = camgeo.verify(recipe, there)
    assert not report.ok
    assert any(f"disc 2 lies {words} than it should" in check.detail for check in report.checks if not check.ok)


def saved_as_assembly(shape, path, raised):
    """The solids as the kernel saves an assembly: each a part in its place, those above the first farther up."""
    from OCP.BRep import BRep_Builder
    from OCP.gp import gp_Trsf, gp_Vec
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Compound, TopoDS_Iterator

    up, builder, whole = gp_Trsf(), BRep_Builder(), TopoDS_Compound()
    up.SetTranslation(gp_Vec(0.0, 0.0, raised))
    builder.MakeCompound(whole)
    parts = TopoDS_Iterator(shape)
    for place in (TopLoc_Location(), TopLoc_Location(up)):
        builder.Add(whole, parts.Value().Located(place))
        parts.Next()
    writer, before = STEPControl_Writer(), Interface_Static.IVal_s("write.step.assembly")
    try:
        Interface_Static.SetIVal_s("write.step.assembly", 1)
        writer.Transfer(whole, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
    finally:
        Interface_Static.SetIVal_s("write.step.assembly", before)
    return path


@pytest.mark.slow
@kernel
def test_a_step_file_holds_two_solids_at_their_gap(tmp_path):
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_SOLID
    from OCP.TopExp import TopExp_Explorer

    recipe = written(tmp_path, STL_AND_STEP)
    report = camgeo.export(recipe, tmp_path)
    assert report.ok, failures(report)
    reader = STEPControl_Reader()
    reader.ReadFile(str(report.path / "pair.step"))
    reader.TransferRoots()
    shape = reader.OneShape()
    explorer, spans = TopExp_Explorer(shape, TopAbs_SOLID), []
    while explorer.More():
        box = Bnd_Box()
        BRepBndLib.AddOptimal_s(explorer.Current(), box, False)
        _, _, low, _, _, high = box.Get()
        spans.append((low, high))
        explorer.Next()
    assert np.array(sorted(spans)) == pytest.approx(np.array([(0.0, 12.0), (14.0, 26.0)]), abs=1e-6)
    for raised, words in ((0.0, ""), (0.002, "disc 2 lies 0.002 mm higher"), (-14.0, "disc 2 lies 14 mm lower")):
        again = camgeo.verify(recipe, saved_as_assembly(shape, tmp_path / "saved.step", raised))
        caught = ("saved.step", "", "readable") if raised < 0.0 else ("saved.step", "disc 2", "thickness")
        assert failures(again) == ({caught} if words else set())
        assert all(check.detail.endswith(f"; {words} than it should") for check in again.checks if not check.ok)
    wide = STL_AND_STEP.replace("gap: 2", "gap: 2.002")
    other = camgeo.export(written(tmp_path, wide, "wide"), tmp_path)
    found = failures(camgeo.verify(recipe, other.path / "wide.step"))
    assert found == {("wide.step", "disc 2", "thickness")}
    assert failures(camgeo.verify(recipe, other.path / "wide-1.stl", other.path / "wide-2.stl")) == set()


# --- what is taught ---------------------------------------------------------------------------------------------------


# needs: mechanism
def test_the_bodies_round_a_pair_are_refused():
    with pytest.raises(camgeo.RecipeErrors, match=r"export.files\[2\]: the bodies round conjugate discs are not made"):
        read(RECIPE.replace("glb", "{stl: {parts: all}}").encode(), Path("pair.yaml"))


def test_forms_that_hold_no_pair_refuse_by_name():
    recipe = read(RECIPE.encode(), Path("pair.yaml"))
    design = designed(recipe)
    needs = {"grinding": ("manufacture: {wheel: 300}\n", ""), "lift": ("", ", roller: 25")}
    needs["valve"] = ("valve: {ratio: 1.6, lash: 0.3}\n", "")  # needs: valve
    needs["controller"] = ("", ", for: plain")
    for kind, form in sorted(
        (kind, name) for kind, record in FORMATS.items() for name, form in record.forms.items() if form.discs == 1
    ):
        more, key = needs.get(form, ("", ""))
        text = more + RECIPE.replace("glb", f"{{{kind}: {{as: {form}{key}}}}}")
        if form == "trace":  # of a linkage, which a pair does not drive
            with pytest.raises(camgeo.RecipeErrors, match=r"needs linkage\.trace"):
                read(text.encode(), Path("pair.yaml"))
            continue
        changed = read(text.encode(), Path("pair.yaml"))
        with pytest.raises(camgeo.RecipeErrors, match=f"{kind} as {form} does not hold a cam of 2 discs"):
            demand_capacity(changed, design, changed.export.files[-1])
