# needs: dynamics
"""Forces of rigid followers over the turn: worked cases, work against levers, files and refusals.

The cases are d17 of the sheet on disc cams and f01, f02, f03, f10, f11, f25 of the sheet on forces.
"""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.capabilities.dynamics.force_figures import extremes_of, forces_section, forces_table
from camgeo.capabilities.dynamics.load_formula import Sampled
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.measures.figures import design_figures
from camgeo.output.pipeline import check, export
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.numeric.records import replace

LOBE = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion:
    - {rise: 20, over: 120, law: cycloidal}
    - {dwell: 60}
    - {return: 20, over: 120, law: polynomial-345}
    - {dwell: 60}
part: {thickness: 12, bore: 20}
"""
OFFSET = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 6}
  BESIDE
  motion:
    - {rise: 24, over: 100, law: polynomial-4567}
    - {dwell: 40}
    - {return: 24, over: 140, law: polynomial-4567}
    - {dwell: 80}
part: {thickness: 10, bore: 20}
"""
GROOVE = OFFSET.replace("BESIDE", "track: {groove: {clearance: 0.03}}")
DISCS = OFFSET.replace("BESIDE", "conjugate: {radius: 11, distance: 120}")
YOKE = "cam: {kind: support, p: 25 + 2*cos(3*t), preload: {interference: 0.03, stiffness: [3.0e7, 4.5e7]}}\n"
MOTION = "motion: [{rise: 20, over: 120, law: cycloidal}, {return: 20, over: 120, law: modified-sine}, {dwell: 120}]"
ARM_MOTION = MOTION.replace(" 20,", " 15,")
KINDS = {
    "roller": f"kind: disc, base_radius: 40, follower: {{kind: roller, radius: 10, offset: 7}}, {MOTION}",
    "ring": f"kind: disc, base_radius: 60, follower: {{kind: roller, radius: 10}}, track: internal, {MOTION}",
    "knife-edge": f"kind: disc, base_radius: 40, follower: {{kind: knife-edge, offset: -3}}, {MOTION}",
    "arm": "kind: disc, base_radius: 34, follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80}},"
    + ARM_MOTION,
    "leading": "kind: disc, base_radius: 34,"
    " follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80, side: leading}}," + ARM_MOTION,
    "flat": f"kind: disc, base_radius: 60, follower: {{kind: flat, offset: 4, tilt: 10}}, {MOTION}",
    "flat-arm": "kind: disc, base_radius: 60, follower: {kind: flat, arm: {pivot: 110, face: 5}},"
    + ARM_MOTION.replace(" 15,", " 5,"),
    "yoke": "kind: support, p: 25 + 2*cos(3*t)",
    "roller-yoke": "kind: constant-diameter, base_radius: 35, roller_radius: 10,"
    " motion: [{rise: 20, over: 180, law: cycloidal}]",
    "double-roller": "kind: double-roller, ratio: 3, arm: 60, roller_radius: 10, delta: {cos: {1: 360}}",
    "flat-pair": "kind: flat-pair, ratio: 3, arm: 60, delta: {cos: {1: 1080}}",
}


def cam_of(kind):
    return f"cam: {{{KINDS[kind]}}}\npart: {{outer: 200}}\n" if kind == "ring" else f"cam: {{{KINDS[kind]}}}\n"


def running(text, dynamics):
    recipe = read(f"{text}\ndynamics: {{{dynamics}}}\n".encode(), Path("case.yaml"))
    found = running_of(recipe, designed(recipe))
    assert found is not None
    return found


def place(one, value, at, rel=1e-9):
    assert (one.value, one.at_deg) == (pytest.approx(value, rel=rel), pytest.approx(at, abs=1e-5))


def test_a_roller_under_a_spring():
    """d17: the least preload for 20 N along the travel, contact, torque and pressure; f10: the roller's mean force."""
    run = running(LOBE, "mass: 1.2, rate: 8000, rpm: 900, least_force: 20, material: steel")
    assert run.preload == pytest.approx(181.057194334, abs=1e-8)
    found = extremes_of(run)
    place(found.contacts[0][1], 512.548261558, 32.88899)
    assert found.torque[1].value == pytest.approx(7.157395826, abs=1e-8)
    assert found.torque[0].value == pytest.approx(-6.234318915, abs=1e-8)
    place(found.pressure[0][1], 413.290830829, 34.29398)
    place(found.along[0], 20.0, 88.26003)
    mean, turns = run.mean_force(0)
    assert (mean, turns) == (pytest.approx(323.666317826, rel=1e-9), pytest.approx(5.073398780, rel=1e-9))
    assert np.abs(run.state(np.linspace(0.0, 2.0 * math.pi, 3601)).roller_rpm).max() <= 5400.0 * (1.0 + 1e-9)


def test_a_change_at_the_turns_beginning_is_given_once():
    """Inertia alone presses: F is -m w^2 10 sin(t), which is 0 at 0 and 180 degrees."""
    cam = "cam: {kind: disc, base_radius: 36, follower: {kind: roller, radius: 9}, track: {groove: {clearance: 0.03}}"
    run = running(f"{cam}, motion: {{formula: 10*sin(t)}}}}\npart: {{thickness: 10, bore: 20}}\n", "mass: 1, rpm: 900")
    assert run.own_section()["changes_at_deg"] == pytest.approx([0.0, 180.0], abs=1e-9)


@pytest.mark.slow
def test_a_groove():
    """f02 and f11: which flank bears, forces, torque, pressure, and the mean force on the one roller."""
    run = running(GROOVE, "mass: 1.2, rpm: 900, load: 40, material: steel")
    found = extremes_of(run)
    place(found.contacts[0][1], 685.546444223, 28.55102)
    place(found.contacts[1][1], 597.180225135, 71.91727)
    place(found.torque[1], 13.323856492, 35.21859)
    place(found.torque[0], -11.516046674, 65.38044)
    place(found.pressure[0][1], 519.511892433, 30.34643)
    place(found.pressure[1][1], 436.137099842, 72.08105)
    section = json.loads(json.dumps(forces_section(run, found)))
    changes = [50.907835313, 96.371508773, 147.365173096, 207.504200668]
    assert section["changes_at_deg"] == pytest.approx(changes, abs=1e-8)
    (roller,) = section["rollers"]
    assert (roller["mean_force"], roller["turns"]) == (
        pytest.approx(342.352514644, rel=1e-9),
        pytest.approx(5.904164230, rel=1e-9),
    )
    speeds = run.state(np.radians([50.907835313])).roller_rpm[:, 0]
    assert speeds == pytest.approx([5293.501289, -7093.501289], abs=1e-4)


def test_two_discs():
    """f01 rigid: the force changes its disc where it changes sign."""
    run = running(DISCS, "mass: 2.5, rpm: 600, load: 150")
    state = run.state(np.radians([20.0, 50.0, 85.0, 180.0, 250.0]))
    force = [651.645312, 150.0, -221.641284, -147.427092453, 419.915086401]
    assert state.force == pytest.approx(force, abs=1e-8)
    assert ((state.normal[0] > 0.0) == (state.force > 0.0)).all()
    assert ((state.normal[1] > 0.0) == (state.force < 0.0)).all()
    assert np.degrees(run.changes) == pytest.approx(
        [53.715220524, 91.954215081, 157.542225650, 199.442907756], abs=1e-8
    )


def test_a_yoke_loses_its_faces():
    """f03: face 2 lifts at 1509.876 rpm, face 1 at 1849.213; torque as there."""
    run = running(YOKE, "mass: 2, rpm: 1500")
    state = run.state(np.radians([0.0, 20.0, 40.0, 60.0]))
    assert state.normal[0] == pytest.approx([184.694241561, 362.347120780, 717.652879220, 895.305758439], abs=1e-8)
    assert state.normal[1] == pytest.approx([1072.958637659, 806.479318829, 273.520681171, 7.041362341], abs=1e-8)
    assert state.torque == pytest.approx([0.0, 2.307778597, -2.307778597, 0.0], abs=1e-8)
    (first, low, _), (second, high, _) = run.lost_rpm()
    assert (first, second) == ("flat face A", "flat face B")
    assert (high, low) == (pytest.approx(1509.876363135, rel=1e-9), pytest.approx(1849.213332184, rel=1e-9))


def test_a_load_that_is_sampled_lets_faces_go_at_the_lower_speed():
    """Its true value lies between 33 and 47 N: each face is lost as early as under the worse of the two."""
    runs = {load: running(YOKE, f"mass: 2, rpm: 1500, load: '{load}'") for load in (33, 40, 47)}
    alone = {load: [loss.rpm for loss in run.lost_rpm()] for load, run in runs.items()}
    sampled = running(YOKE, "mass: 2, rpm: 1500, load: '40'")
    sampled.__dict__["_followed"] = replace(sampled._followed, sampled=Sampled(1.0, 7.0))
    for face, (_, rpm, _) in enumerate(sampled.lost_rpm()):
        assert rpm == pytest.approx(min(alone[33][face], alone[47][face]), rel=1e-12)
        assert rpm < 0.999 * alone[40][face]


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", KINDS)
def test_work_against_levers(kind):
    """F y' is the torque of the contacts' lines about the shaft, to 1e-9 of the greatest."""
    run = running(cam_of(kind), "mass: 1.5, rpm: 700, preload: 30, rate: 500, load: 5 + 3*cos(t)")
    phi = np.linspace(0.013, 6.27, 997)
    state = run.state(phi)
    torque, work = state.torque, state.force * state.rows[1]
    assert np.abs(torque - work).max() <= 1e-9 * np.abs(work).max()
    assert np.abs(work).max() > 0.0


@pytest.mark.thin(4)
@pytest.mark.parametrize("kind", [*KINDS, "groove", "discs"])
def test_the_lines_are_those_of_the_surfaces(kind):
    """Points and normals of the contacts against the maker's own curves, where the parameter is the shaft angle."""
    run = running({"groove": GROOVE, "discs": DISCS}.get(kind) or cam_of(kind), "mass: 1.5, rpm: 700, preload: 30")
    phi = np.linspace(0.1, 6.1, 61)
    state, exact = run.state(phi), run.design.exact
    columns = list(run.design.motion.parameters(phi, phi).values())
    for k, (contact, line) in enumerate(zip(run.design.follower.contacts, state.lines, strict=True)):
        surface = next(one for one in exact.surfaces if one.name == contact.surface)
        t = columns[k] if len(columns) > 1 else phi + contact.turned * (not contact.surface)
        frame = surface.curve.sample(np.mod(t, surface.curve.shape.period))
        touched = line.centre - surface.side * contact.touch.radius * line.normal
        turned = np.exp(1j * (phi + contact.turned))
        point = (touched[:, 0] + 1j * touched[:, 1]) * turned
        normal = (line.normal[:, 0] + 1j * line.normal[:, 1]) * turned
        assert point == pytest.approx(frame.point[:, 0] + 1j * frame.point[:, 1], abs=1e-8)
        assert normal == pytest.approx(frame.normal[:, 0] + 1j * frame.normal[:, 1], abs=1e-9)


def test_a_guide_rubs():
    """f25: N = F/(cos alpha - q mu (2A + B)/B |sin alpha|), and the moments of the stem about either end."""
    run = running(LOBE, "mass: 1.2, preload: 100, rpm: 10, guide: {overhang: 30, length: 40, friction: 0.12}")
    phi = np.linspace(0.1, 6.1, 333)
    state, rigid = run.state(phi), running(LOBE, "mass: 1.2, preload: 100, rpm: 10").state(phi)
    alpha = np.arctan2(state.lines[0].normal[:, 1], state.lines[0].normal[:, 0])
    ahead = 30.0 - 1e3 * state.rows[0]
    q = np.sign(state.rows[1])
    expected = state.force / (np.cos(alpha) - q * 0.12 * (2.0 * ahead + 40.0) / 40.0 * np.abs(np.sin(alpha)))
    assert state.normal[0] == pytest.approx(expected, rel=1e-12)
    near, far = state.reactions.values()
    assert near - far == pytest.approx(state.normal[0] * np.sin(alpha), abs=1e-9)
    assert (state.normal[0][q > 0] > rigid.normal[0][q > 0]).all()
    for alpha_, q_, force in ((0.4, 1, 124.341689817), (0.4, -1, 96.349649329), (-0.3, 1, 115.382783400)):
        lever = math.cos(alpha_) - q_ * 0.12 * 100.0 / 40.0 * abs(math.sin(alpha_))
        assert 100.0 / lever == pytest.approx(force, abs=1e-8)


def test_report_table_and_figures(tmp_path):
    """The report's section, the page, a limit and the CSV tell the same."""
    text = LOBE + (
        "dynamics: {mass: 1.2, rate: 8000, rpm: 900, preload: 190, material: steel}\n"
        "limits: {contact-pressure: {at_most: 420}, shaft-torque: {at_most: 8}, mean-roller-force: {at_most: 400}}\n"
        "export: {tolerance: 0.01, files: [{csv: {as: forces}}, html]}\nverify: {angles: 720}\n"
    )
    recipe = read(text.encode(), Path("lobe.yaml"))
    outcome = export(recipe, tmp_path)
    report = json.loads(next(tmp_path.rglob("report.json")).read_text(encoding="utf-8"))
    held = {check["name"] for check in report["checks"]}
    assert {"float", "limit:contact-pressure", "limit:shaft-torque", "limit:mean-roller-force"} <= held
    assert outcome.ok
    section = report["forces"]
    assert section["contacts"][0]["contact"] == "roller"
    assert "dynamics" not in report
    design = designed(recipe)
    names, rows = forces_table(running_of(recipe, design), 720)
    assert names == ("shaft_deg", "contact_N", "torque_Nm", "pressure_N_mm2", "roller_rpm")
    assert rows[:, 1].max() == pytest.approx(section["contacts"][0]["max"], rel=1e-4)
    found = design_figures(
        recipe, design, design.checks, ["contact-force-greatest", "contact-pressure", "shaft-torque"]
    )
    assert found["contact-force-greatest"].value == section["contacts"][0]["max"]
    assert found["contact-pressure"].value == section["pressure"][0]["max"]
    with next(tmp_path.rglob("*.csv")).open(newline="") as file:
        written = list(csv.reader(file))
    assert tuple(written[0]) == names
    assert float(written[100][1]) == pytest.approx(rows[99, 1], rel=1e-9)


@pytest.mark.thin(2)
@pytest.mark.parametrize(("text", "contacts"), [(GROOVE, ("inner", "outer")), (DISCS, ("disc_1", "disc_2"))])
def test_the_table_of_two_surfaces(text, contacts, tmp_path):
    """One table has both contacts; one of them bears at a time."""
    more = "dynamics: {mass: 1.2, rpm: 900}\nexport: {files: [{csv: {as: forces}}]}\nverify: {angles: 360}\n"
    outcome = export(read((text + more).encode(), Path("two.yaml")), tmp_path)
    assert outcome.ok
    with next(tmp_path.rglob("*.csv")).open(newline="") as file:
        head, *rows = list(csv.reader(file))
    first, second = (head.index(f"{name}_N") for name in contacts)
    assert all(min(float(row[first]), float(row[second])) == 0.0 for row in rows)
    assert any(float(row[first]) > 0.0 for row in rows)
    assert any(float(row[second]) > 0.0 for row in rows)


def test_contact_that_a_weak_spring_loses():
    recipe = read((LOBE + "dynamics: {mass: 1.2, rate: 8000, rpm: 900, preload: 100}\n").encode(), Path("lobe.yaml"))
    from camgeo.capabilities.dynamics.force_figures import rigid_forces

    (check,) = rigid_forces(recipe, designed(recipe)).checks
    assert not check.ok
    assert check.value == pytest.approx(100.0 - 161.057194334, abs=1e-8)  # 20 N are left with 181.06


@pytest.mark.parametrize(
    ("text", "dynamics", "field", "words"),
    [
        (LOBE, "mass: 1, rpm: 100", "dynamics", "preload or least_force"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, least_force: 2", "dynamics.least_force", "exactly one"),
        (LOBE, "mass: 1, rpm: 100, stiffness: 1.0e6", "dynamics", "needs preload or backlash"),
        (LOBE, "mass: 1, rpm: 100, backlash: 0.1", "dynamics.stiffness", "missing, needed with backlash"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, transient: true", "dynamics.stiffness", "needed with transient"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, stiffness: 1.0e6, load: 3", "dynamics.load", "leave stiffness out"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: 3*x", "dynamics.load", "x"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: 1/(t - 1)", "dynamics.load", "no bound near 57.2958 degrees"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: sqrt(sin(t))", "dynamics.load", "sqrt of a negative number"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: 1e60", "dynamics.load", "1e+60 N at 0.703125 degrees, above 4000"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: -4.01e12*sin(t)**80", "dynamics.load", "give a smaller load"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, load: 9e12*exp(-1e6*(t - 2)**2)", "dynamics.load", "N at 114.6"),
        (LOBE, "mass: 1, rpm: 100, preload: 1, material: cheese", "dynamics.material", "steel"),
        (GROOVE, "mass: 1, rpm: 100, stiffness: 1.0e6, preload: 1", "dynamics.stiffness", "leave it out"),
        (DISCS, "mass: 1, rpm: 100, stiffness: 1.0e6, preload: 1", "dynamics.stiffness", "leave it out"),
    ],
)
def test_what_is_refused(text, dynamics, field, words):
    with pytest.raises(RecipeErrors) as caught:
        extremes_of(running(text, dynamics))
    (error,) = caught.value.errors
    assert error.path == field
    assert words in str(error)


@pytest.mark.slow
@pytest.mark.parametrize("load", ["sqrt(1 - cos(t))", "abs(sin(t))", "5 + 1/(2 + sin(t))", "40"])
def test_loads_that_are_bounded(load):
    """Corners and roots of 0 are no poles."""
    found = extremes_of(running(GROOVE, f"mass: 1, rpm: 100, load: {load}"))
    assert all(least.value == 0.0 for least, _ in found.contacts) or load == "40"


def test_the_greatest_load_that_is_taken():
    """As of a table, 4e12 N; the page draws what presses then, and the mean force is no overflow."""
    source = LOBE + "dynamics: {mass: 4e12, rpm: 2e6, rate: 4e12, preload: 4e12, load: 4e12*cos(t)}\n"
    report = check(read((source + "export: {files: [html]}\n").encode(), Path("x.yaml"))).report
    assert report["forces"]["contacts"][0]["max"] > 1e20
    assert math.isfinite(report["forces"]["rollers"][0]["mean_force"])


def test_a_table_needs_forces():
    with pytest.raises(RecipeErrors, match="a table of forces needs"):
        read((LOBE + "export: {files: [{csv: {as: forces}}]}\n").encode(), Path("x.yaml"))
    with pytest.raises(RecipeErrors, match=r"shaft-torque needs dynamics without stiffness"):
        read((LOBE + "limits: {shaft-torque: {at_most: 8}}\n").encode(), Path("x.yaml"))
