"""Sharp and irregular Reuleaux polygons from recipe to file: corners that are points, and faults that are seen.

Holds: camgeo.cams.family, camgeo.cams.follower.
"""

import json
import math

import ezdxf
import numpy as np
import pytest
from support.intent import findings
from support.kernel import kernel

from camgeo.api.run import export
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.fit.arcs import fit_arcs
from camgeo.machining.cutter import CutterPath, cutter_path
from camgeo.measures.remarks import remarks_of
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended, permitted
from kin.contour.contour import Contour
from kin.judge.verify import verify
from kin.law.reuleaux import closed_angles, corners
from kin.read.files import read_drawing, read_solid

TRIANGLE = "cam: {kind: support, reuleaux: {sides: 3, breadth: 50}}\n"
FIVE = "cam: {kind: support, reuleaux: {sides: 5, breadth: 50, angles: [50, 30]}, shaft: [3, 1]}\n"
SHARP = {"triangle": TRIANGLE, "irregular": FIVE}
PHI = np.linspace(0, 2 * np.pi, 720, endpoint=False)


def recipe_of(text):
    return load_text(text, "cam.yaml")


def points_of(text):
    """Corners in order round the contour, mm, from the shaft, and the order of a star's points there."""
    if text == TRIANGLE:
        own, shaft = closed_angles(3, ()), 0j
    else:
        own, shaft = closed_angles(5, np.radians([50.0, 30.0])), 3.0 + 1.0j
    star = 50.0 * np.array(corners(own))
    z = star[np.argsort(np.mod(np.angle(star), 2 * np.pi))] - shaft
    return np.column_stack([z.real, z.imag])


def arcs_of(points, breadth=50.0):
    """Bulges of arcs of a radius between points (n, 2), counter-clockwise."""
    chord = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    return np.tan(0.5 * np.arcsin(0.5 * chord / breadth))


def judged(text, points, bulges, tolerance=1e-4):
    recipe = recipe_of(text)
    intent = intended(recipe, designed(recipe))
    contour = Contour.from_bulges(points, bulges)
    found = findings(contour, intent, PHI, permitted(recipe, tolerance))
    return {check.name: check for check in found.checks}


# --- what is made -----------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
def test_every_format_holds_its_corners(text, tmp_path):
    files = "dxf, svg, stl, 3mf, glb, html, csv, {csv: {as: contacts}}, {csv: {as: polar}}"
    files += ", gcode"  # needs: milling
    files += ", {csv: {as: inspection}}, {dxf: {as: polyline}}, {dxf: {as: spline}}"
    milled = "{cutter: 6, feed: 400, plunge: 100, spindle: 6000, depth_of_cut: 5, safe_height: 5}"
    more = f"part: {{thickness: 8, bore: 8}}\nmanufacture: {milled}\n"
    recipe = recipe_of(f"{text}{more}export: {{tolerance: 0.001, files: [{files}]}}\n")
    report = export(recipe, tmp_path)
    assert report.ok
    folder = tmp_path / "cam"
    corner = points_of(text)
    for name in ("cam.dxf", "cam-polyline.dxf", "cam-spline.dxf", "cam.stl", "cam.svg"):
        path = folder / name
        assert path.exists(), sorted(each.name for each in folder.iterdir())
    arcs = read_drawing(folder / "cam.dxf").contour
    assert len(arcs) == len(corner)
    for name in ("cam.dxf", "cam-polyline.dxf", "cam-spline.dxf", "cam.svg"):
        ends = read_drawing(folder / name).contour.end
        away = np.hypot(*(ends[:, None] - corner).transpose(2, 0, 1)).min(axis=0)
        assert away.max() < 1e-12, name
    polyline = next(iter(ezdxf.readfile(folder / "cam.dxf").query("LWPOLYLINE[layer=='CUT']")))
    assert len(polyline) == len(corner)
    for table in ("cam-contacts.csv", "cam-inspection.csv"):
        assert "nan" not in (folder / table).read_text()
    checks = verify(folder / "cam.dxf", intended(recipe, designed(recipe)), 360, permitted(recipe, 1e-9)).checks
    assert all(check.ok for check in checks), [str(check) for check in checks if not check.ok]


@pytest.mark.slow
@kernel
@pytest.mark.thin(2)
@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
def test_step_holds_its_corners(text, tmp_path):
    body = "part: {thickness: 8, bore: 8}\nexport: {tolerance: 0.001, files: [step]}\n"
    assert export(recipe_of(text + body), tmp_path).ok
    ends = read_solid(tmp_path / "cam" / "cam.step").contour.end
    away = np.hypot(*(ends[:, None] - points_of(text)).transpose(2, 0, 1)).min(axis=0)
    assert away.max() < 1e-12


@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
def test_the_radius_is_told_and_no_undercut(text, tmp_path):
    report = export(recipe_of(text), tmp_path)
    found = json.loads((tmp_path / "cam" / "report.json").read_text())
    assert report.ok
    checks = {check["name"]: check for check in found["checks"] if check.get("file") is None}
    count = len(points_of(text))
    radius = checks["radius-of-curvature"]
    assert (radius["ok"], radius["value"], radius["limit"]) == (True, 0.0, None)
    assert radius["detail"] == f"{count} sharp corners, as the recipe asks"
    assert checks["undercut-local"]["value"] == 0.0
    assert found["contour"]["perimeter"] == pytest.approx(50 * math.pi, rel=1e-12)  # Barbier
    (remark,) = found["remarks"]
    angle = {3: 60.0, 5: math.degrees(max(closed_angles(5, np.radians([50.0, 30.0]))))}[count]
    assert (remark["name"], remark["value"]) == ("sharp-corner", pytest.approx(angle))
    motion = next(check for check in found["checks"] if check["name"] == "motion")
    assert motion["limit"] is not None  # nothing is cut off, so the motion is judged
    assert motion["value"] < 1e-12


def test_what_the_remark_asks_for_helps():
    rounded = recipe_of(TRIANGLE.replace("50}", "50, rounding: 0.5}"))
    assert [one.name for one in remarks_of(rounded, designed(rounded))] == []
    bounded = recipe_of(TRIANGLE + "limits: {radius-of-curvature: {at_least: 1}}\n")
    assert [one.name for one in remarks_of(bounded, designed(bounded))] == []


def test_a_limit_of_the_radius_fails_and_its_remedy_holds(tmp_path):
    limits = "limits: {radius-of-curvature: {at_least: 1}}\n"
    assert not export(recipe_of(TRIANGLE + limits), tmp_path).ok
    assert export(recipe_of(TRIANGLE.replace("50}", "50, rounding: 1.01}") + limits), tmp_path).ok


def test_rounding_of_nothing_is_the_same_as_none():
    first, second = recipe_of(TRIANGLE), recipe_of(TRIANGLE.replace("50}", "50, rounding: 0}"))
    assert first.cam == second.cam


def test_a_rounded_polygon_of_unequal_arcs_is_its_parallel(tmp_path):
    text = FIVE.replace("50, angles", "50, rounding: 4, angles")
    assert export(recipe_of(text + "export: {tolerance: 0.0001}\n"), tmp_path).ok
    contour = read_drawing(tmp_path / "cam" / "cam.dxf").contour
    assert len(contour) == 10
    assert sorted(set(np.round(contour.radius, 9))) == [4.0, 46.0]


def test_the_corner_points_stay_where_they_are_while_the_face_turns():
    recipe = recipe_of(FIVE)
    design = designed(recipe)
    corner = points_of(FIVE)[0]
    t = np.radians(np.linspace(-24.9, 24.9, 101))  # the first corner bears for 50 degrees about +x
    p = design.exact.law.derivatives(t, 2)
    assert p[0] == pytest.approx(corner[0] * np.cos(t) + corner[1] * np.sin(t), abs=1e-12)
    assert np.abs(p[0] + p[2]).max() < 1e-12


def test_kerf_rounds_the_corners(tmp_path):
    text = FIVE + "export: {files: [{dxf: {kerf: 0.2}}]}\n"
    assert export(recipe_of(text), tmp_path).ok
    contour = read_drawing(tmp_path / "cam" / "cam.dxf").contour
    assert len(contour) == 10
    assert contour.radius.min() == pytest.approx(0.1, rel=1e-9)


def test_no_chamfer_runs_along_corners():
    made = designed(recipe_of(TRIANGLE + "part: {thickness: 8, chamfer: 0.5}\n"))
    check = next(one for one in made.checks if one.name == "chamfer")
    assert not check.ok
    assert check.detail == (
        "a sharp contour has corners, along which no chamfer runs; leave it out, or give a reuleaux.rounding above "
        "0.5 mm"
    )
    rounded = TRIANGLE.replace("breadth", "rounding: 0.51, breadth")
    made = designed(recipe_of(rounded + "part: {thickness: 8, chamfer: 0.5}\n"))
    assert next(one for one in made.checks if one.name == "chamfer").ok


def test_the_cutter_swings_about_the_corners_either_way():
    contour = designed(recipe_of(FIVE)).only_surface.contour
    path = cutter_path(contour, 3.0)
    assert path.curve.closed
    assert path.lost == ()
    exact = path.arcs(1e-6)
    swung = CutterPath(Curve(Parallel(contour.shape, -3.0), contour.runs), 3.0, corners=True).arcs(1e-6)
    for made in (exact, swung):
        found = Contour.from_bulges(made.points, made.bulges)
        assert found.length == pytest.approx(math.pi * 56.0, rel=1e-12)  # Barbier
    assert len(exact.points) == 10


# --- what is refused --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (
            "sides: 5, breadth: 50, angles: [50]",
            "1:64: cam.reuleaux.angles: not as many as 5 sides leave open, given 1",
        ),
        ("sides: 3, breadth: 50, angles: [60]", "given 1; leave it out: it is regular"),
        ("sides: 5, breadth: 50, angles: [80, 60]", "1:64: cam.reuleaux.angles: no Reuleaux polygon of 5 sides has"),
        ("sides: 5, breadth: 50, angles: [0, 60]", "1:65: cam.reuleaux.angles[0]: below 0.1, given 0"),
        (
            "sides: 5, breadth: 50, angles: 50",
            "not a list, given 50; give a list of numbers from 0.1 to 180 in degrees",
        ),
        ("sides: 5, breadth: 50, rounding: -1", "1:66: cam.reuleaux.rounding: below 0, given -1"),
    ],
)
def test_faults_are_named_with_their_place(keys, said):
    with pytest.raises(RecipeErrors) as caught:
        designed(recipe_of(f"cam: {{kind: support, reuleaux: {{{keys}}}}}"))
    (error,) = caught.value.errors
    assert said in str(error)


# --- faults of a file -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
def test_the_polygon_by_hand_passes(text):
    points = points_of(text)
    checks = judged(text, points, arcs_of(points), 1e-9)
    assert all(check.ok for check in checks.values()), checks


@pytest.mark.thin(12)
@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
@pytest.mark.parametrize("which", [0, 1, 2])
@pytest.mark.parametrize("fault", ["shaved", "moved", "turned", "rounded"])
def test_a_corner_that_is_off_is_seen(text, which, fault):
    points = points_of(text)
    bulges = arcs_of(points)
    n = len(points)
    away = points - points.mean(axis=0)
    out = away[which] / np.hypot(*away[which])
    side = np.array([-out[1], out[0]])
    if fault == "moved":
        points[which] += 0.001 * side
    elif fault == "turned":  # all of it, by a thousandth of a degree
        c, s = np.cos(np.radians(1e-3)), np.sin(np.radians(1e-3))
        points = points @ np.array([[c, s], [-s, c]])
    else:
        # off by 0.001 mm in the middle: a chord, or an arc, between points on the two sides
        place = points[which] - 0.001 * out
        sides = [points[which - 1] - points[which], points[(which + 1) % n] - points[which]]
        cuts = []
        for way, sense in zip(sides, (-1, 1), strict=True):
            tangent = way / np.hypot(*way)
            half = np.arctan(bulges[which - 1 if sense < 0 else which]) * 2.0
            turn = np.array([[np.cos(half), np.sin(half)], [-np.sin(half), np.cos(half)]])
            tangent = (turn if sense > 0 else turn.T) @ tangent  # of the arc at the corner
            cuts.append(points[which] + tangent * ((place - points[which]) @ out) / (tangent @ out))
        points = np.insert(np.delete(points, which, axis=0), which, cuts, axis=0)
        bulge = 0.0 if fault == "shaved" else 0.1
        bulges = np.insert(bulges, which, bulge)
    checks = judged(text, points, bulges)
    assert not checks["contour"].ok
    assert not checks["motion"].ok
    if fault == "shaved":
        assert checks["motion"].value == pytest.approx(0.001, rel=1e-3)


@pytest.mark.thin(2)
@pytest.mark.parametrize("text", SHARP.values(), ids=SHARP)
@pytest.mark.parametrize("which", [0, 1, 2])
def test_an_arc_about_another_centre_is_seen(text, which):
    points = points_of(text)
    bulges = arcs_of(points)
    chord = np.hypot(*(points[(which + 1) % len(points)] - points[which]))
    bulges[which] += 2 * 2e-4 / chord  # its middle 0.0002 mm farther out
    checks = judged(text, points, bulges)
    assert not checks["contour"].ok
    assert not checks["motion"].ok


@pytest.mark.slow
def test_a_rounding_in_place_of_a_corner_is_seen():
    """By 0.002 mm: it takes 0.0003 mm off a corner of 120 degrees."""
    recipe = recipe_of(TRIANGLE)
    intent = intended(recipe, designed(recipe))
    other = designed(recipe_of(TRIANGLE.replace("50}", "50, rounding: 0.002}"))).only_surface.contour
    made = fit_arcs(other, 1e-9)
    found = findings(Contour.from_bulges(made.points, made.bulges), intent, PHI, permitted(recipe, 1e-4))
    assert not next(check for check in found.checks if check.name == "motion").ok


def test_a_trimmed_cam_is_still_judged_by_its_own_limits():
    recipe = recipe_of("cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\n")
    design = designed(recipe)
    assert design.trimmed
    assert intended(recipe, design).surfaces[0].trimmed
    assert not designed(recipe_of(TRIANGLE)).trimmed
