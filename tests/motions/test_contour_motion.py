"""The motion of a follower on a drawing that exists: what was exported comes back, whoever follows it."""

import math
import os

import numpy as np
import pytest

from camgeo.motions import motion
from camgeo.motions.contour_motion import ContourPlacing, ContourReading
from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

MOTION = "[{rise: 8, over: 100, law: modified-sine}, {dwell: 60}, {return: 8, over: 120, law: cycloidal}, {dwell: 80}]"
FOLLOWERS = {
    "roller": "{kind: roller, radius: 8}",
    "offset": "{kind: roller, radius: 8, offset: 6}",
    "knife": "{kind: knife-edge}",
    "flat": "{kind: flat}",
    "arm": "{kind: roller, radius: 8, arm: {length: 65, pivot: 80}}",
}


def recipe(motion, folder, follower, files="dxf", more=""):
    return load_text(
        f"{more}cam: {{kind: disc, base_radius: 40, follower: {FOLLOWERS[follower]}, motion: {motion}}}\n"
        f"part: {{thickness: 8}}\nexport: {{tolerance: 0.001, files: [{files}]}}\n",
        folder / "cam.yaml",
    )


def exported(folder, follower, files="dxf", more=""):
    made = recipe(MOTION, folder, follower, files, more)
    assert pipeline.export(made, folder / "out").report["ok"]
    return made.cam.exact()


def moved(exact, order=0):
    rows = exact.motion.rows((np.arange(720) + 0.3) * 2 * math.pi / 720, order)
    rows[0] -= rows[0].min()
    return rows


@pytest.mark.thin(15)
@pytest.mark.parametrize("files", ["dxf", "svg", "{dxf: {as: spline}}"])
@pytest.mark.parametrize("more", ["", "rotation: ccw\n"])
@pytest.mark.parametrize("follower", FOLLOWERS)
def test_a_drawing_becomes_the_motion_that_it_was_made_of(follower, more, files, tmp_path):
    intended = exported(tmp_path, follower, files, more)
    ending = "svg" if files == "svg" else "dxf"
    reading = 0.003 if follower != "arm" else 0.003 * math.degrees(1 / 65)
    made = recipe(
        f"{{contour: out/cam/cam.{ending}, reading: {reading:.6f}}}", tmp_path, follower, more=more
    ).cam.exact()
    size = 1.0 if follower != "arm" else 1 / 65
    assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.006 * size)
    peak = np.abs(moved(intended, 2)[2]).max()
    assert np.abs(moved(made, 2)[2]).max() == pytest.approx(peak, rel=0.1)
    assert made.kept.distance <= 0.003 * size
    assert made.kept.remarks == ()


def test_another_follower_on_the_same_contour_moves_otherwise(tmp_path):
    exported(tmp_path, "roller")
    given = "{contour: out/cam/cam.dxf, reading: 0.003}"
    other = moved(recipe(given, tmp_path, "knife").cam.exact())[0]
    assert np.abs(other - moved(recipe(given, tmp_path, "roller").cam.exact())[0]).max() > 0.05


def test_a_drawing_in_another_unit(tmp_path):
    intended = exported(tmp_path, "roller", "{dxf: {units: inch}}")
    made = recipe("{contour: out/cam/cam.dxf, reading: 0.003}", tmp_path, "roller").cam.exact()
    assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.006)


def test_the_report_of_a_contour_has_its_distance_and_no_line(tmp_path):
    exported(tmp_path, "roller")
    report = pipeline.check(recipe("{contour: out/cam/cam.dxf, reading: 0.003}", tmp_path, "roller")).report
    table = report["table"]
    assert table["distance"] == pytest.approx(0.003, rel=0.1)
    assert (table["unit"], table["line"]) == ("mm", None)
    assert report["ok"]


@pytest.mark.thin(2)
@pytest.mark.parametrize(("track", "outer"), [("internal", 140), ("{groove: {clearance: 0.02}}", 140)])
def test_rings_and_grooves_come_back(track, outer, tmp_path):
    def cam(motion):
        return load_text(
            f"cam: {{kind: disc, base_radius: 40, track: {track}, follower: {FOLLOWERS['roller']}, motion: {motion}}}\n"
            f"part: {{outer: {outer}}}\nexport: {{tolerance: 0.001, files: [dxf]}}\n",
            tmp_path / "cam.yaml",
        )

    assert pipeline.export(cam(MOTION), tmp_path / "out").report["ok"]
    made = cam("{contour: out/cam/cam.dxf, reading: 0.003}").cam.exact()
    assert moved(made)[0] == pytest.approx(moved(cam(MOTION).cam.exact())[0], abs=0.006)


def contacts(folder, follower, more="", name="old.csv", **changed):
    """The places of contact at each degree, as the table of contacts has them, in a file of their own."""
    text = recipe(MOTION, folder, follower, "{csv: {as: contacts}}", more)
    assert pipeline.export(text, folder / "out").report["ok"]
    lines = [line for line in (folder / "out/cam/cam.csv").read_text().splitlines() if not line.startswith("#")]
    heading, rows = lines[0].split(","), np.array([line.split(",") for line in lines[1:-1]], dtype=float)
    points = rows[:, [heading.index("x_mm"), heading.index("y_mm")]]
    np.savetxt(folder / name, points, fmt="%.6f", delimiter=",", **{"header": "x_mm,y_mm", "comments": "", **changed})
    return text.cam.exact()


@pytest.mark.thin(6)
@pytest.mark.parametrize("more", ["", "rotation: ccw\n"])
@pytest.mark.parametrize("follower", FOLLOWERS)
def test_points_round_a_contour_become_the_motion_that_they_were_made_of(follower, more, tmp_path):
    """Straight lines from point to point are some 0.01 mm within the contour."""
    intended = contacts(tmp_path, follower, more)
    reading = 0.02 if follower != "arm" else 0.02 * math.degrees(1 / 65)
    made = recipe(f"{{contour: old.csv, reading: {reading:.6f}}}", tmp_path, follower, more=more).cam.exact()
    size = 1.0 if follower != "arm" else 1 / 65
    assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.04 * size)
    assert made.kept.distance <= 0.02 * size


@pytest.mark.thin(3)
@pytest.mark.parametrize("follower", ["roller", "offset", "arm"])
def test_points_of_a_pitch_curve_give_the_motion_of_the_centre_that_runs_on_it(follower, tmp_path):
    """The contour of a knife edge is the pitch curve of a roller whose cam is smaller all round by its radius."""
    edges = {name: value.replace("roller, radius: 8", "knife-edge") for name, value in FOLLOWERS.items()}
    knife = f"cam: {{kind: disc, base_radius: 48, follower: {edges[follower]}, motion: {MOTION}}}\n"
    text = f"{knife}part: {{thickness: 8}}\nexport: {{files: [dxf, {{csv: {{as: contacts}}}}]}}\n"
    assert pipeline.export(load_text(text, tmp_path / "cam.yaml"), tmp_path / "out").report["ok"]
    intended = recipe(MOTION, tmp_path, follower).cam.exact()
    reading = 0.02 if follower != "arm" else 0.02 * math.degrees(1 / 65)
    size = 1.0 if follower != "arm" else 1 / 65
    for file in ("cam.csv", "cam.dxf"):
        given = f"{{contour: out/cam/{file}, curve: pitch, reading: {reading:.6f}}}"
        made = recipe(given, tmp_path, follower).cam.exact()
        assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.04 * size)


def test_points_in_a_file_without_a_unit_are_in_that_beside_it(tmp_path):
    intended = contacts(tmp_path, "roller", header="x,y")
    text = (tmp_path / "old.csv").read_text().splitlines()
    rows = [",".join(f"{float(cell) / 25.4:.7f}" for cell in line.split(",")) for line in text[1:]]
    (tmp_path / "inches.csv").write_text("\n".join(["x;y", *(row.replace(",", ";").replace(".", ",") for row in rows)]))
    made = recipe("{contour: inches.csv, units: inch, reading: 0.02}", tmp_path, "roller").cam.exact()
    assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.04)


@pytest.mark.thin(5)
@pytest.mark.parametrize(
    ("motion", "message"),
    [
        ("{contour: none.dxf, reading: 0.01}", "the file does not exist, given 'none.dxf'"),
        ("{contour: cam.yaml, reading: 0.01}", "cam.yaml: "),
        ("{contour: out/cam/cam.dxf}", "a contour shows no digits; give reading beside it, such as reading: 0.02"),
        ("{contour: aside.svg, reading: 0.01}", "aside.svg: no closed contour goes round the origin"),
        ("{contour: out/cam/cam.dxf, reading: 0.01, columns: [1, 2]}", "columns: cannot stand without a table"),
        ("{contour: mixed.csv, reading: 0.01}", "cross near "),
        ("{contour: lifts.csv, reading: 0.01}", "angles and lifts make no contour; give them as table, or points x, y"),
        ("{contour: out, reading: 0.01}", "contour: a folder, given 'out'; give its path as seen"),
        ("{contour: %s, reading: 0.01}" % ("x" * 300), "contour: cannot be read: "),
        ("{contour: few.csv, reading: 0.01}", "contour: few.csv: points: 20, and at least 36 are needed"),
        ("{formula: 1 - cos(t), curve: pitch}", "curve: cannot stand without a contour; leave it out"),
        ("{formula: 1 - cos(t), turn: 12}", "turn: cannot stand without a contour; leave it out"),
        ("{contour: old.csv, reading: 0.01, gap: 0.1}", "old.csv: a gap is one between ends in a drawing; leave gap"),
        ("{contour: old.csv, reading: 0.01, across: arc}", "old.csv: the contour is closed; leave across out"),
        (
            "{contour: part.csv, reading: 0.01}",
            "a stretch of the contour is left out; give the points between them, or",
        ),
    ],
)
def test_what_is_no_contour_is_refused(motion, message, tmp_path):
    contacts(tmp_path, "roller")
    exported(tmp_path, "roller")
    heading, *rows = (tmp_path / "old.csv").read_text().splitlines()
    (tmp_path / "mixed.csv").write_text("\n".join([heading, *rows[::2], *rows[1::2]]))
    (tmp_path / "part.csv").write_text("\n".join([heading, *rows[:150], *rows[180:]]))
    (tmp_path / "few.csv").write_text("\n".join([heading, *rows[:20]]))
    (tmp_path / "lifts.csv").write_text("\n".join(["angle_deg,lift_mm", *(f"{k},1" for k in range(360))]))
    square = "M 60 60 L 70 60 L 70 70 L 60 70 Z"
    size = 'width="99mm" height="99mm" viewBox="0 0 99 99"'
    aside = f'<svg xmlns="http://www.w3.org/2000/svg" {size}><path d="{square}"/></svg>'
    (tmp_path / "aside.svg").write_text(aside)
    (tmp_path / "cam.yaml").write_text("a: 1\n")
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(motion, tmp_path, "roller"))
    assert message in str(caught.value)


def test_a_gap_is_refused_with_the_key_that_closes_it_and_a_contour_is_placed(tmp_path):
    """A disc of two arcs about (3, 0), one of which begins 0.0025 mm too late, mirrored and turned about the shaft."""
    bow, late = "A 20 20 0 0 0", 0.0025
    begin = f"{3 - 20 * math.cos(late / 20):.9f} {20 * math.sin(late / 20):.9f}"
    paths = f'<path d="M 23 0 {bow} -17 0"/><path d="M {begin} {bow} 23 0"/>'
    size = 'width="99mm" height="99mm" viewBox="0 0 99 99"'
    (tmp_path / "gap.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{paths}</svg>')
    keys = "contour: gap.svg, reading: 0.005"
    with pytest.raises(RecipeErrors, match=r"0\.0025 apart.*; give gap: 0\.002[56] beside it to join them") as refused:
        recipe(f"{{{keys}}}", tmp_path, "roller")
    gap = str(refused.value).partition("give gap: ")[2].partition(" ")[0]
    made = recipe(f"{{{keys}, gap: {gap}, mirror: y, turn: 30}}", tmp_path, "roller").cam.exact()
    (told,) = made.kept.remarks
    assert told.sentence == "gap.svg: ends up to 0.0025 mm apart are joined, as asked"
    top = (np.argmax(moved(made)[0]) + 0.3) / 2.0
    assert top == pytest.approx(210.0, abs=1.0)
    assert np.ptp(moved(made)[0]) == pytest.approx(6.0, abs=0.012)


def test_points_that_leave_a_stretch_out_are_closed_across_and_that_is_told(tmp_path):
    intended = contacts(tmp_path, "roller")
    heading, *rows = (tmp_path / "old.csv").read_text().splitlines()
    (tmp_path / "part.csv").write_text("\n".join([heading, *rows[:300], *rows[330:]]))  # of the base circle
    made = recipe("{contour: part.csv, reading: 0.02, across: arc}", tmp_path, "roller").cam.exact()
    (told,) = made.kept.remarks
    assert "part.csv: nothing is known of the contour from " in told.sentence
    assert moved(made)[0] == pytest.approx(moved(intended)[0], abs=0.04)


def test_a_flat_face_has_no_pitch_curve(tmp_path):
    contacts(tmp_path, "flat")
    with pytest.raises(
        RecipeErrors, match=r"old\.csv: a flat face has no centre and so no pitch curve; give the cam's"
    ):
        pipeline.check(recipe("{contour: old.csv, curve: pitch, reading: 0.02}", tmp_path, "flat"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
@pytest.mark.parametrize("name", ["pipe.dxf", "pipe.csv"])
def test_a_pipe_is_not_waited_for(name, tmp_path):
    os.mkfifo(tmp_path / name)
    with pytest.raises(RecipeErrors, match="a pipe, a socket or a device, not a file"):
        recipe(f"{{contour: {name}, reading: 0.01}}", tmp_path, "roller")


class ReadAsError(Exception):
    """What a contour was to be read as."""


@pytest.mark.parametrize(("rotation", "mirrored"), [("", False), ("rotation: cw\n", False), ("rotation: ccw\n", True)])
def test_a_contour_is_placed_as_the_keys_beside_it_say(rotation, mirrored, monkeypatch, tmp_path):
    def read(_reader, name, _path, how):
        raise ReadAsError(name, how)

    monkeypatch.setattr(motion, "read_contours", read)
    with pytest.raises(ReadAsError) as asked:
        recipe(
            "{contour: c.dxf, reading: 0.01, mirror: x, turn: 30, units: thou, gap: 0.1}",
            tmp_path,
            "flat",
            "dxf",
            rotation,
        )
    name, how = asked.value.args
    assert name == "c.dxf"
    assert how == ContourReading(0.0254, ContourPlacing("x", math.radians(30.0), mirrored), False, 0.1, None)
