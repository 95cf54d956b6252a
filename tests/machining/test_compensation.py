"""Parts made different for a file: against shapely's buffers, the nominal files, and the judge's own verdict."""

from pathlib import Path

import numpy as np
import pytest
from support.cases import few
from support.heavy import ezdxf, shapely, trimesh
from support.programmes import Segment, law, programme

from camgeo.cli.main import main
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.support_function import Circle, lift_constant_breadth, lift_from_fourier
from kin.read.files import read_drawing

SUPPORT = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}\n"
SMALL = "cam: {kind: support, p: 1 + 0.05*cos(3*t)}\n"
ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
ARC = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, arc: {radius: 70}}\n"
PAIR = "cam: {kind: flat-pair, ratio: 3, arm: 40, delta: {cos: {1: 200}}}\n"
TRIMMED = "cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\n"
SHU_WU = """\
cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]}
"""
PLAIN = "{thickness: 6, bore: 10}"
FULL = "{thickness: 6, bore: 12, keyway: din6885, hub: {diameter: 22, height: 6}, chamfer: 0.5, "
FULL += "bolts: {count: 3, circle: 30, hole: 4, start: 30}, set_screw: {diameter: 3, at: 90}}"
FRAME = "cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}\n"
FRAME += "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n"


def recipe_of(files, *, cam=SUPPORT, part=PLAIN, top=""):
    body = f"{top}name: c\n{cam}part: {part}\nexport: {{tolerance: 0.001, files: [{files}]}}\nverify: {{angles: 90}}\n"
    return read(body.encode(), Path("c.yaml"))


def made(folder, files, **asked):
    recipe = recipe_of(files, **asked)
    outcome = pipeline.export(recipe, folder)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    return recipe, outcome.report, outcome.folder


def region(path, per_piece=30):
    drawing = read_drawing(path)
    holes = [hole.sample(per_piece) for hole in drawing.holes]
    return shapely.Polygon(drawing.contour.sample(per_piece), holes)


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("cam", "part", "top"),
    few(
        [
            (SUPPORT, FULL, ""),
            (ROLLER, PLAIN, "rotation: ccw\n"),
            (ARC, PLAIN, ""),
            (PAIR, PLAIN, ""),
            (SHU_WU, FULL, ""),
            (TRIMMED, PLAIN, ""),
        ],
        3,
    ),
)
def test_a_kerf_is_drawn_round_all_metal(tmp_path, cam, part, top):
    files = "dxf, {dxf: {kerf: 0.4}}, {svg: {kerf: 0.4}}, {dxf: {clearance: 0.3, version: R2013}}"
    _, report, folder = made(tmp_path, files, cam=cam, part=part, top=top)
    names = ["c.dxf", "c-arcs-R2010-kerf.dxf", "c.svg", "c-arcs-R2013-clearance.dxf"]
    assert [file["path"] for file in report["files"]] == names
    nominal, kerf, drawn, clear = (region(folder / name) for name in names)
    assert len(nominal.interiors) == len(kerf.interiors)
    for wanted, found in ((0.2, kerf), (0.2, drawn), (-0.3, clear)):
        # trimmed corners and those of keyways stay sharp where they can; a beam makes of them what is nominal
        back = found.buffer(-wanted, quad_segs=64)
        assert back.symmetric_difference(nominal).area < 4e-3 * nominal.length
        assert found.area - nominal.area == pytest.approx(wanted * nominal.length, rel=0.02)
        edge = shapely.points(np.array(found.exterior.coords))
        apart = shapely.distance(nominal.exterior, edge)
        assert apart.min() == pytest.approx(abs(wanted), abs=2.5e-3)


@pytest.mark.slow
def test_shrinkage_and_clearance_in_a_solid(tmp_path):
    files = "stl, {stl: {shrinkage: 0.4}}, {stl: {shrinkage: 2, clearance: 0.25, tolerance: 0.002}}"
    _, report, folder = made(tmp_path, files, part=FULL)
    nominal, larger, both = (trimesh.load(folder / file["path"]) for file in report["files"])
    assert [file["path"] for file in report["files"]] == ["c.stl", "c-shrinkage.stl", "c-clearance-shrinkage.stl"]
    assert larger.volume / nominal.volume == pytest.approx(1 / 0.996**3, rel=2e-4)
    assert larger.bounds == pytest.approx(nominal.bounds / 0.996, abs=3e-3)
    assert both.bounds[:, 2] == pytest.approx(nominal.bounds[:, 2] / 0.98, abs=1e-4)
    assert both.bounds[:, :2] == pytest.approx((nominal.bounds[:, :2] + [[0.25], [-0.25]]) / 0.98, abs=4e-3)
    entry = report["files"][2]["compensation"]
    assert entry == {
        "clearance": 0.25,
        "shrinkage": pytest.approx(2.0),
        "outward": -0.25,
        "scale": pytest.approx(1 / 0.98),
    }
    assert "compensation" not in report["files"][0]
    header = (folder / "c-clearance-shrinkage.stl").read_bytes()[:80]
    assert b"clearance 0.25, shrinkage 2 percent" in header


def test_a_drawing_says_what_it_is(tmp_path):
    _, _, folder = made(
        tmp_path, "{dxf: {kerf: 0.01}}, {svg: {kerf: 0.01}}", cam=SMALL, part="{bore: 0.4}", top="units: inch\n"
    )
    assert "c, kerf 0.01" in (folder / "c.dxf").read_text()
    assert "c, kerf 0.01" in (folder / "c.svg").read_text()
    (bore,) = ezdxf.readfile(folder / "c.dxf").modelspace().query("CIRCLE[layer=='BORE']")
    assert bore.dxf.radius == pytest.approx(0.195)


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("cam", few([SUPPORT, ROLLER, PAIR, SHU_WU], 2))
def test_no_file_passes_for_another(tmp_path, cam):
    """A nominal file in the place of a compensated one, and the reverse, fails; so does half of the kerf."""
    _, _, folder = made(tmp_path, "dxf, {dxf: {kerf: 0.4}}", cam=cam)
    nominal, kerf = folder / "c.dxf", folder / "c-arcs-R2010-kerf.dxf"
    recipe = recipe_of("dxf", cam=cam)
    found = verify(kerf, intended(recipe, designed(recipe)), 90, Limits(0.001))
    assert {"contour", "bore", "motion"} <= {check.name for check in found.checks if not check.ok}
    one, other = recipe_of("{dxf: {kerf: 0.4}}", cam=cam), recipe_of("{dxf: {kerf: 0.41}}", cam=cam)
    (tmp_path / "x").mkdir()
    for path, asked, ok in ((kerf, one, True), (nominal, one, False), (kerf, other, False)):
        named = tmp_path / "x" / "c.dxf"
        named.write_bytes(path.read_bytes())
        report = pipeline.judge_files(asked, [named])
        assert report["ok"] is ok
        failing = {check["name"] for check in report["checks"] if not check["ok"]}
        assert ok or {"contour", "motion", "bore"} <= failing
        assert report["files"][0]["compensation"]["outward"] == pytest.approx(0.2, abs=0.006)


@pytest.mark.slow
def test_motion_of_a_compensated_pair_is_the_nominal_one(tmp_path):
    _, report, _ = made(tmp_path, "dxf, {dxf: {clearance: 1, version: R2013}}", cam=PAIR)
    one, other = (file["motion"]["max"] for file in report["files"])
    assert other == pytest.approx(one, rel=0.1)


@pytest.mark.slow
def test_undercut_that_only_the_compensation_makes():
    sharp = "cam: {kind: support, p: 25 + 3*cos(3*t)}\n"  # rho = 25 - 24 cos 3t, 1 mm at least
    outcome = pipeline.check(recipe_of("dxf, {dxf: {clearance: 0.9}}", cam=sharp))
    assert outcome.ok
    outcome = pipeline.check(recipe_of("dxf, {stl: {clearance: 1.1}}", cam=sharp))
    failing = [(check["name"], check.get("file")) for check in outcome.report["checks"] if not check["ok"]]
    assert failing == [("radius-of-curvature", "c.stl"), ("undercut-local", "c.stl")]
    assert [file["path"] for file in outcome.report["files"]] == ["c.dxf"]
    pair = "cam: {kind: flat-pair, ratio: 3, arm: 40, delta: {cos: {1: 850}}}\n"
    outcome = pipeline.check(recipe_of("{dxf: {clearance: 8}}", cam=pair))
    assert [check["name"] for check in outcome.report["checks"] if not check["ok"]][-1] == "undercut-local"


@pytest.mark.parametrize(
    ("files", "cam", "message"),
    [
        (
            "{dxf: {kerf: 17}}",
            ROLLER,
            "export.files[0]: the metal is enlarged by 8.5, the roller's radius is 8; give less",
        ),
        (
            "{dxf: {kerf: 10}}",
            SUPPORT,
            "export.files[0]: an opening cannot be made smaller by 5: it is 10 mm across",
        ),
    ],
)
def test_more_than_there_is(files, cam, message):
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe_of(files, cam=cam))
    assert message in str(caught.value)


KNIFE = "cam: {kind: disc, base_radius: 30, follower: {kind: knife-edge}, motion: {formula: 4*(1 - cos(t))}}\n"
SHOE = KNIFE.replace("knife-edge", "shoe, radius: 6")


@pytest.mark.slow
def test_a_knife_edge_has_no_radius_to_give():
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe_of("{dxf: {kerf: 0.2}}", cam=KNIFE))
    (error,) = caught.value.errors
    assert error.problem.endswith("enlarged by 0.1, and a knife edge has no radius to be smaller by that")
    assert error.remedy == "leave kerf out, give a clearance of at least 0.1 too, or a roller"
    for files, cam in (
        ("dxf", KNIFE),
        ("{dxf: {kerf: 0.2, clearance: 0.1}}", KNIFE),
        ("{dxf: {kerf: 0.2}}", KNIFE.replace("knife-edge", "roller, radius: 6")),
    ):
        assert pipeline.check(recipe_of(files, cam=cam)).ok
    with pytest.raises(RecipeErrors, match="the shoe radius is 6; give less"):
        pipeline.check(recipe_of("{dxf: {kerf: 13}}", cam=SHOE))


@pytest.mark.thin(2)
@pytest.mark.parametrize("guide", ["", ", arm: {length: 60, pivot: 66}"])
def test_the_cam_of_a_knife_edge_shrinks(guide):
    cam = KNIFE.replace("knife-edge", f"knife-edge{guide}")
    outcome = pipeline.check(recipe_of("{dxf: {shrinkage: 1.5}}, {svg: {clearance: 0.1, shrinkage: 0.4}}", cam=cam))
    assert outcome.ok
    assert len(outcome.report["files"]) == 2


@pytest.mark.slow
def test_what_a_linkage_is_not_judged_by():
    outcome = pipeline.check(recipe_of("dxf, {dxf: {kerf: 0.2}}", cam=FRAME))
    assert outcome.ok
    driven = [check["file"] for check in outcome.report["checks"] if check["name"] == "linkage-error"]
    assert driven == ["c.dxf"]
    assert {"what": "linkage-error", "why": "c-arcs-R2010-kerf.dxf: the part is not the nominal one"} in (
        outcome.report["skipped"]
    )


# needs: mechanism
def test_a_set_of_bodies_has_a_clearance_of_its_own():
    with pytest.raises(RecipeErrors, match="compensation of a whole mechanism; give"):
        recipe_of("{stl: {parts: all, clearance: 0.2}}")


def test_laws_of_longer_arms():
    for cam in (ROLLER, ARC, PAIR):
        law_of = designed(recipe_of("dxf", cam=cam)).exact.law
        tau = np.linspace(0.0, 6.0, 31)
        (r, t), (longer, same) = law_of.pitch(tau, 2), law_of.scaled(1.5).pitch(tau, 2)
        assert longer == pytest.approx(1.5 * r, rel=1e-12, abs=1e-10)
        assert same == pytest.approx(t, rel=1e-12, abs=1e-12)


def test_lifts_farther_out():
    rise = programme([Segment("rise", 2.0, 20.0, law("cycloidal")), Segment("dwell", np.pi - 2.0)], np.pi)
    for lift in (lift_from_fourier(25.0, {3: 2.0}, {5: 0.3}, (3.0, 2.0)), lift_constant_breadth(40.0, rise)):
        moved = lift.moved(-0.3, 1.25)
        theta = np.linspace(0.0, 2 * np.pi, 41)
        assert moved.derivatives(theta, 3)[0] == pytest.approx(1.25 * (lift.derivatives(theta, 0)[0] - 0.3))
        assert moved.derivatives(theta, 3)[1:] == pytest.approx(1.25 * lift.derivatives(theta, 3)[1:], abs=1e-12)
        assert moved.radius == pytest.approx(1.25 * (lift.radius - 0.3), nan_ok=True)
        assert np.array_equal(moved.breaks, lift.breaks)
        mid, rad = moved.radius_enclosure(theta[:-1], theta[1:], 0)
        rho = moved.derivatives(theta, 2)
        assert (np.abs(rho[0, :-1] + rho[2, :-1] - mid[0]) <= rad[0]).all()
    assert any(isinstance(f, Circle) for f in moved.law.functions)


def test_from_the_command_line(tmp_path, capsys):
    body = f"name: c\n{SUPPORT}part: {PLAIN}\nexport: {{files: [{{dxf: {{kerf: 0.2}}}}]}}\nverify: {{angles: 90}}\n"
    (tmp_path / "c.yaml").write_text(body)
    assert main(["export", str(tmp_path / "c.yaml"), "--out", str(tmp_path / "out")]) == 0
    assert main(["verify", str(tmp_path / "c.yaml"), str(tmp_path / "out" / "c" / "c.dxf")]) == 0
    (tmp_path / "c.yaml").write_text(body.replace("0.2", "0.1"))
    assert main(["verify", str(tmp_path / "c.yaml"), str(tmp_path / "out" / "c" / "c.dxf")]) == 1
    capsys.readouterr()


@pytest.mark.slow
@pytest.mark.parametrize("cam", few([SUPPORT, ROLLER], 2))
def test_solids_of_other_formats(tmp_path, cam):
    pytest.importorskip("OCP")
    _, report, _ = made(tmp_path, "{step: {kerf: 0.2}}, {3mf: {clearance: 0.2, shrinkage: 1}}", cam=cam)
    assert [file["compensation"]["outward"] for file in report["files"]] == [0.1, -0.2]
