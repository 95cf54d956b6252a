"""Preloads by interference through recipe and file: worked cases, springs by brute force, and files with a fault.

The cases are f01, f03, f04, f05 and f26 of the sheet on forces. Their forces are of first order in the interference:
springs on the true contours differ by up to 2e-4 of them.

Holds: camgeo.cams.preload.
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camgeo.measures.figures import design_figures
from camgeo.measures.forces import FollowerTurn, elastic_contacts, preload_force, preload_section
from camgeo.output.pipeline import export
from camgeo.recipe.loading import load, read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended, permitted
from kin.follower.contact_forces import preloaded
from kin.follower.contact_lines import contact_line
from kin.judge.verify import verify
from kin.law.contacts import Contact, Roller, Translating

CAMS = {
    "yoke": "kind: support, p: 25 + 2*cos(3*t)",
    "roller-yoke": "kind: constant-diameter, base_radius: 35, roller_radius: 10,"
    " motion: [{rise: 20, over: 180, law: cycloidal}]",
    "double-roller": "kind: double-roller, ratio: 3, arm: 60, roller_radius: 10, delta: {cos: {1: 360}}",
    "flat-pair": "kind: flat-pair, ratio: 3, arm: 60, delta: {cos: {1: 1080}}",
}
GIVEN = {
    "yoke": (0.03, (3.0e7, 4.5e7)),
    "roller-yoke": (0.02, (5.0e7, 5.0e7)),
    "double-roller": (0.02, (2.0e7, 2.0e7)),
    "flat-pair": (0.02, (2.0e7, 2.0e7)),
}
TOLERANCE = 1e-4


def recipe_of(kind, interference=None, *, tolerance=TOLERANCE, more="", units="mm"):
    given, (k1, k2) = GIVEN[kind]
    size = given if interference is None else interference
    preload = f", preload: {{interference: {size!r}, stiffness: [{k1}, {k2}]}}" if size else ""
    text = f"units: {units}\ncam: {{{CAMS[kind]}{preload}}}\nexport: {{tolerance: {tolerance!r}, files: [dxf]}}\n{more}"
    return read(text.encode(), Path(f"{kind}.yaml"))


def held(kind, degrees):
    """Levers, the preload's force along the travel and the normal force of both contacts, N and mm."""
    recipe = recipe_of(kind)
    turn = FollowerTurn(designed(recipe))
    rows = turn.design.motion.travel(np.radians(degrees), 2)
    levers = np.array([line.lever for line in turn.lines(rows)])
    force = elastic_contacts(turn, turn.design.exact.preload, rows)
    return levers, force, force.preload / levers


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("kind", "levers", "preload", "normal"),
    [
        ("roller-yoke", [[1.0, 0.990880888, 0.974235381]], [500.0, 496.456589582, 487.117690552], None),
        (
            "double-roller",
            [[25.404909551, 24.933793054, 26.913663758], [25.404909551, 27.518953793, 31.994982980]],
            [5080.981910145, 5219.854235953, 5803.851590958],
            [[200.0, 209.348582646, 215.647027591], [200.0, 189.682146904, 181.398802260]],
        ),
        (
            "flat-pair",
            [[33.0, 33.420293252, 47.678773712], [33.0, 50.278714332, 81.370637893]],
            [6600.0, 7717.262330564, 11257.965428072],
            [[200.0, 230.915458232, 236.121119557], [200.0, 153.489651298, 138.354149846]],
        ),
    ],
)
def test_levers_and_forces_of_the_cases(kind, levers, preload, normal):
    """f26 at 0, 45, 90; f04 and f05 at 0, 10, 25 degrees."""
    at = [0.0, 45.0, 90.0] if kind == "roller-yoke" else [0.0, 10.0, 25.0]
    h, force, pressed = held(kind, at)
    assert h[: len(levers)] == pytest.approx(np.array(levers), abs=2e-9)
    assert force.preload == pytest.approx(preload, rel=1e-11)
    if normal is not None:
        assert pressed == pytest.approx(np.array(normal), rel=1e-11)


def test_a_yoke_under_its_inertia():
    """f03: 2 kg at 1500 rpm; face 2 lifts at 1509.876363135 rpm, not where the inertia is the preload."""
    _, force, _ = held("yoke", [0.0, 20.0, 40.0, 60.0])
    assert force.preload == pytest.approx([540.0] * 4, rel=1e-13)
    inertia = np.array([-888.264396098, -444.132198049, 444.132198049, 888.264396098])
    first, second = force.split(inertia)
    assert first == pytest.approx([184.694241561, 362.347120780, 717.652879220, 895.305758439], abs=2e-9)
    assert second == pytest.approx([1072.958637659, 806.479318829, 273.520681171, 7.041362341], abs=2e-9)
    peak = 888.264396098 / 1500.0**2
    assert math.sqrt(force.loses_second[0] / peak) == pytest.approx(1509.876363135, abs=1e-6)
    assert math.sqrt(-force.loses_first[0] / peak) == pytest.approx(1849.213332184, abs=1e-6)
    # beyond, the contact that is left bears all
    assert force.split(np.array([2e3] * 4))[:, 0].tolist() == [2e3, 0.0]
    assert force.split(np.array([-3e3] * 4))[:, 0].tolist() == [0.0, 3e3]


def test_two_discs():
    """f01: rollers 9 and 11 on a stem 6 mm beside the shaft, 120 mm apart, disc 2 grown by 0.02 mm."""
    motion = "[{rise: 24, over: 100, law: polynomial-4567}, {dwell: 40}, {return: 24, over: 140, law: polynomial-4567}"
    recipe = read(
        f"cam: {{kind: disc, base_radius: 36, follower: {{kind: roller, radius: 9, offset: 6}},"
        f" motion: {motion}, {{dwell: 80}}]}}\n".encode(),
        Path("disc.yaml"),
    )
    phi = np.radians([20.0, 50.0, 85.0, 180.0, 250.0, 82.23807, 218.85345])
    rows = recipe.cam.exact().motion.travel(phi, 2)
    foot = math.sqrt(45.0**2 - 6.0**2)
    near = Contact(Translating(6.0), Roller(9.0), foot)
    far = Contact(Translating(-6.0), Roller(11.0), 120.0 - foot, -1, turned=math.pi)
    levers = [contact_line(contact, rows).lever for contact in (near, far)]
    force = preloaded((levers[0], levers[1]), (0.0, 0.02), (4e4, 6e4))
    expected = [479.534525186, 440.238297544, 479.823297035, 465.090615325, 460.577107503, 480.0, 426.508379977]
    assert force.preload == pytest.approx(expected, abs=1e-8)
    load = np.array([651.645312, 150.0, -221.641284, -147.427092453, 419.915086401])
    first, second = (p[:5] / h[:5] for p, h in zip(force.split(np.append(load, [0.0, 0.0])), levers, strict=True))
    assert first == pytest.approx([740.660903890, 542.398609476, 391.301727874, 419.255560353, 647.267475801], abs=1e-8)
    assert second == pytest.approx([88.405933393, 373.434916102, 613.236731539, 581.270311390, 207.004054773], abs=1e-8)


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("kind", "least", "most"),
    [
        ("yoke", 540.0, 540.0),
        ("roller-yoke", 487.117690552, 500.0),
        ("double-roller", 5.080981910, 6.874269643),
        ("flat-pair", 6.6, 17.4),
    ],
)
def test_figures(kind, least, most):
    recipe = recipe_of(kind)
    design = designed(recipe)
    found = design_figures(recipe, design, design.checks, ["preload-force-least", "preload-force-greatest"])
    values = [found[f"preload-force-{word}"] for word in ("least", "greatest")]
    assert [one.value for one in values] == pytest.approx([least, most], rel=1e-9)
    assert {one.unit for one in values} == {"N" if kind in {"yoke", "roller-yoke"} else "N m"}
    assert tuple(one.value for one in values) == tuple(one.value for one in preload_force(design, design.exact.preload))
    section = json.loads(json.dumps(preload_section(recipe, design)))
    assert section["interference"] == GIVEN[kind][0]
    if len(set(GIVEN[kind][1])) == 1:  # the cams are symmetric; levers that differ take some of twice the preload
        lost = [one["load"] for one in section["lost"]]
        assert lost[0] == pytest.approx(-lost[1], rel=1e-9)
        assert lost[1] <= 2.0 * least * (1.0 + 1e-12)


def test_contact_is_lost_at_twice_the_preload():
    """Not at the preload, where springs and levers are equal: f26 at 0 and 90 degrees."""
    _, force, _ = held("roller-yoke", [0.0, 90.0])
    assert force.loses_second == pytest.approx(2.0 * force.preload)
    assert force.loses_first == pytest.approx(-2.0 * force.preload)


def springs(points, centres, normals_out, radius, stiffness):
    """Shift of a frame of two rollers, mm, and its force: springs on the metal's points, by bisection."""

    def press(shift):
        forces = []
        for centre, out, k in zip(centres, normals_out, stiffness, strict=True):
            away = points - (centre + shift * centres[0] / abs(centres[0]))
            near = away[np.argmin(np.abs(away))]
            overlap = max(radius - abs(near), 0.0)
            forces.append(k * overlap * (-near / abs(near) * out.conjugate()).real)
        return forces

    low, high = -0.02, 0.02
    for _ in range(60):
        middle = 0.5 * (low + high)
        first, second = press(middle)
        low, high = (middle, high) if first > second else (low, middle)
    return press(0.5 * (low + high))


def test_springs_by_brute_force():
    """Two rollers that press on the points of the grown metal find the same force, to the second order."""
    recipe = recipe_of("roller-yoke")
    design = designed(recipe)
    t = np.linspace(0.0, 2.0 * math.pi, 40_001)[:-1]
    (surface,) = design.exact.surfaces
    x, y = surface.curve.sample(t).point.T
    points = x + 1j * y
    for degrees, force in ((45.0, 496.456589582), (90.0, 487.117690552)):
        phi = math.radians(degrees)
        s = 45.0 + float(design.motion.travel(np.array([phi]), 0)[0, 0])
        out = np.exp(1j * phi)
        found = springs(points, (s * out, (s - 110.0) * out), (out, -out), 10.0, (5e4, 5e4))
        assert found[0] == pytest.approx(found[1], rel=1e-9)
        assert found[0] == pytest.approx(force, rel=3e-4)


# --- files ------------------------------------------------------------------------------------------------------------


def failing(verdict):
    return {check.name for check in verdict.checks if not check.ok}


@pytest.fixture(
    scope="module",
    params=[
        "yoke",
        "roller-yoke",
        *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("double-roller", "flat-pair")),
    ],
)
def exported(request, tmp_path_factory):
    """A kind of cam, its recipe, its folder and its DXF."""
    kind = request.param
    recipe = recipe_of(kind)
    outcome = export(recipe, tmp_path_factory.mktemp(kind))
    assert outcome.ok
    return kind, recipe, outcome.folder


@pytest.mark.thin(2)
def test_what_is_made_interferes(exported):
    kind, _, folder = exported
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    (play,) = report["files"][0]["play"]
    assert play["max"] < 0.0
    assert report["preload"]["force"]["min"] > 0.0
    if kind == "yoke":  # faces overlap alike all round
        assert [play["min"], play["max"]] == pytest.approx([-0.03, -0.03], abs=2.0 * TOLERANCE)
    elif kind == "roller-yoke":  # about (1/cos(alpha 1) + 1/cos(alpha 2))/2 of the interference
        assert [play["min"], play["max"]] == pytest.approx([-0.0205, -0.02], abs=4.0 * TOLERANCE)


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    "share", [0.0, pytest.param(0.5, marks=pytest.mark.slow), pytest.param(1.5, marks=pytest.mark.slow), 2.0]
)
def test_another_interference_fails(exported, share, tmp_path):
    kind, recipe, _ = exported
    other = recipe_of(kind, share * GIVEN[kind][0] if share else 0.0)
    outcome = export(other, tmp_path)
    assert outcome.ok
    verdict = verify(
        outcome.folder / f"{kind}.dxf", intended(recipe, designed(recipe)), 360, permitted(recipe, TOLERANCE)
    )
    closed = "constant-breadth" if kind == "yoke" else "form-closure"
    assert {"contour", closed} <= failing(verdict)
    if kind == "yoke":
        assert ("breadth-max" in failing(verdict)) == (share > 1.0)


def test_a_limit_as_wide_as_the_interference_is_none(exported):
    kind, recipe, folder = exported
    limits = replace(permitted(recipe, TOLERANCE), play=1.0)
    verdict = verify(folder / f"{kind}.dxf", intended(recipe, designed(recipe)), 360, limits)
    (check,) = [check for check in verdict.checks if check.name in {"constant-breadth", "form-closure"}]
    assert not check.ok
    assert "as much as the interference" in check.detail


def test_the_shipped_recipe():
    recipe = load(Path(__file__).parents[2] / "recipes" / "yoke-preload.yaml")
    section = json.loads(json.dumps(preload_section(recipe, designed(recipe))))
    assert section["force"]["min"] == pytest.approx(450.0)
    assert [one["load"] for one in section["lost"]] == pytest.approx([-900.0, 900.0])


# --- what a recipe cannot have ----------------------------------------------------------------------------------------

YOKE = "kind: support, p: 25 + 2*cos(3*t)"
ROLLERS = CAMS["roller-yoke"]


def refused(cam, preload, more=""):
    """The one error of a recipe: its field, and its text."""
    try:
        designed(read(f"cam: {{{cam}, preload: {{{preload}}}}}\n{more}".encode(), Path("x.yaml")))
    except RecipeErrors as errors:
        (error,) = errors.errors
        return error.path, str(error)
    raise AssertionError("not refused")


TRAIN = "dynamics: {mass: 2, stiffness: 1.0e6, rpm: 100, "


@pytest.mark.parametrize(
    ("cam", "preload", "more", "field", "words"),
    [
        (YOKE.replace("3*t", "2*t"), "interference: 0.02", "", "cam.preload", "its breadth varies"),
        (ROLLERS, "interference: 20", "export: {tolerance: 0.01}", "cam.preload.interference", "roller's radius"),
        (YOKE, "interference: 0.002", "", "cam.preload.interference", "below 0.001"),
        (YOKE, "interference: 0.02", "export: {tolerance: 0.01}", "export.tolerance", "below 0.01"),
        (
            YOKE,
            "interference: 0.02",
            "export: {files: [{dxf: {tolerance: 0.02}}]}",
            "export.files[0].dxf.tolerance",
            "below 0.01",
        ),
        # needs: dynamics
        (YOKE, "interference: 0.02", TRAIN + "backlash: 0.1}", "dynamics.backlash", "leave cam.preload out"),
        # needs: dynamics
        (YOKE, "interference: 0.02", TRAIN + "preload: 10}", "dynamics.preload", "leave cam.preload out"),
        # needs: dynamics
        (YOKE, "interference: 0.02", TRAIN.rstrip(", ") + "}", "dynamics.stiffness", "leave it out"),
        (YOKE + ", undercut: trim", "interference: 0.02", "", "cam.undercut", "leave it out"),
        (
            YOKE,
            "interference: 0.02",
            "part: {thickness: 5, bore: 5}\nexport: {files: [{stl: {clearance: 0.1}}]}",
            "export.files[0].stl.clearance",
            "leave it out",
        ),
        # needs: mechanism
        (
            YOKE,
            "interference: 0.02",
            "part: {thickness: 5, bore: {hexagon: 5}}\nexport: {files: [{stl: {parts: all}}]}",
            "export.files[0]",
            "leave `parts: all` out",
        ),
        (YOKE, "interference: 0", "", "cam.preload.interference", "above 0"),
        (YOKE, "interference: 0.02, stiffness: [1, 2, 3]", "", "cam.preload.stiffness", "2"),
        (YOKE, "stiffness: [1.0e7, 1.0e7]", "", "cam.preload.interference", "missing"),
        (YOKE, "interference: 0.02", "limits: {preload-force-least: {at_least: 1}}", None, "cam.preload.stiffness"),
    ],
)
def test_what_is_refused(cam, preload, more, field, words):
    path, text = refused(cam, preload, more)
    assert field is None or path == field
    assert words in text


def test_a_limit_of_its_force():
    """A limit that fails says by how much; one without a preload is refused."""
    recipe = recipe_of("yoke", more="limits: {preload-force-least: {at_least: 541}}")
    (limit,) = recipe.limits
    assert limit.figure == "preload-force-least"
    with pytest.raises(RecipeErrors, match=r"cam\.preload\.stiffness"):
        recipe_of("yoke", 0.0, more="limits: {preload-force-least: {at_least: 541}}")


@pytest.mark.slow
@pytest.mark.parametrize("interference", [1e-6, 5.0])
def test_extremes(interference, tmp_path):
    """A millionth of a millimetre is held by a finer tolerance still; metres of stroke take millimetres."""
    recipe = recipe_of("yoke", interference, tolerance=min(0.2 * interference, 1e-3))
    outcome = export(recipe, tmp_path)
    assert outcome.ok
    report = json.loads((outcome.folder / "report.json").read_text(encoding="utf-8"))
    (play,) = report["files"][0]["play"]
    assert play["max"] == pytest.approx(-interference, rel=0.5)


def test_inches():
    """The same cam in inches: lengths in inches, forces in N."""
    recipe = read(
        b"units: inch\ncam: {kind: support, p: 1 + 0.08*cos(3*t),"
        b" preload: {interference: 0.001, stiffness: [3.0e7, 4.5e7]}}\n",
        Path("x.yaml"),
    )
    section = json.loads(json.dumps(preload_section(recipe, designed(recipe))))
    assert (section["interference"], section["unit"]) == (pytest.approx(0.001), "in")
    assert section["force"]["min"] == pytest.approx(0.0254 / (1.0 / 3e4 + 1.0 / 4.5e4))
