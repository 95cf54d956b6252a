"""The inspection table against high precision, the geometry of the followers, and kin's own envelope.

Holds: camgeo.formats.tables.inspection.
"""

import csv
from pathlib import Path

import mpmath
import numpy as np
import pytest

from camgeo.formats.tables.inspection import inspection_table
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from kin.follower.envelope import RollerEnvelope, TransmissionPitch
from kin.follower.faces_on_arm import FlatPair

ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
PAIR = "cam: {kind: flat-pair, ratio: 3, arm: 40, delta: {cos: {1: 200}}}\n"
TRIMMED = "cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\n"
SUPPORT = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}\n"


def table_of(body, angles=24):
    recipe = read(f"{body}verify: {{angles: {angles}}}\n".encode(), Path("c.yaml"))
    design = designed(recipe)
    columns, rows = inspection_table(recipe, design)
    return recipe, design, dict(zip(columns, rows.T, strict=True))


def pair(table, name):
    """A column of points or directions, such as `x_mm` and `y_mm`."""
    one = [key for key in table if key == f"{name}x" or key.startswith(f"{name}x_")]
    return np.column_stack([table[one[0]], table[one[0].replace("x", "y")]])


def units(angle):
    return np.column_stack([np.cos(angle), np.sin(angle)])


def test_a_flat_face_to_thirty_digits():
    _, _, table = table_of(SUPPORT + "manufacture: {cutter: 6}\n")
    assert list(table) == [
        *("shaft_deg", "lift_mm", "x_mm", "y_mm", "radius_mm", "polar_deg"),
        *("nx", "ny", "normal_deg", "cutter_x_mm", "cutter_y_mm"),
    ]
    with mpmath.workdps(30):
        for k in range(25):
            t = mpmath.radians(15 * k)
            p = 25 + 2 * mpmath.cos(3 * t) - 3 * mpmath.cos(t) - 2 * mpmath.sin(t)
            slope = -6 * mpmath.sin(3 * t) + 3 * mpmath.sin(t) - 2 * mpmath.cos(t)
            point = p * mpmath.expj(t) + slope * 1j * mpmath.expj(t)
            centre = point + 3 * mpmath.expj(t)
            meant = {
                "shaft_deg": 15 * k,
                "lift_mm": p,
                "x_mm": point.real,
                "y_mm": point.imag,
                "radius_mm": abs(point),
                "nx": mpmath.cos(t),
                "ny": mpmath.sin(t),
                "cutter_x_mm": centre.real,
                "cutter_y_mm": centre.imag,
            }
            for name, value in meant.items():
                assert table[name][k] == pytest.approx(float(value), abs=1e-13), name
            assert table["polar_deg"][k] == pytest.approx(float(mpmath.degrees(mpmath.arg(point))) % 360, abs=1e-12)
            assert table["normal_deg"][k] == pytest.approx(15 * k % 360, abs=1e-12)


def test_each_roller_touches_where_it_stands():
    _, design, table = table_of(ROLLER + "manufacture: {cutter: 10}\n")
    phi, psi = np.radians(table["shaft_deg"]), np.radians(table["follower_deg"])
    envelope = RollerEnvelope(TransmissionPitch(design.exact.law), 8.0)
    alpha = np.pi * 3 / 4
    assert np.ptp(psi) > 0.1
    for name, sense in (("a_", -1), ("b_", 1)):
        centre = 60.0 * (units(phi) + units(phi - psi + sense * alpha))
        point, normal = pair(table, name), pair(table, f"{name}n")
        assert np.allclose(point + 8.0 * normal, centre, rtol=0.0, atol=2e-12)
        assert np.allclose(pair(table, f"{name}cutter_"), point + 5.0 * normal, rtol=0.0, atol=1e-13)
        assert np.abs(envelope.feet(point).excess).max() < 1e-12
    assert np.hypot(*(pair(table, "a_") - pair(table, "b_")).T).min() > 20.0


def test_each_face_of_a_pair_passes_the_pivot():
    """W section 5: the faces meet in the pivot at 2 l, their normals at t and t + alpha, t = phi - (psi + alpha)/2."""
    _, design, table = table_of(PAIR)
    phi, swing = np.radians(table["shaft_deg"]), np.radians(table["follower_deg"])
    alpha = np.pi / 3
    assert np.ptp(swing) > 0.05
    for name, side in (("a_", -0.5), ("b_", 0.5)):
        theta = phi - swing + side * alpha
        assert np.allclose(pair(table, f"{name}n"), units(theta), rtol=0.0, atol=1e-12)
        reach = np.sum(pair(table, name) * units(theta), axis=1)
        assert np.allclose(reach, np.sum(80.0 * units(phi) * units(theta), axis=1), rtol=0.0, atol=1e-11)
        follower = design.exact.gauge
        assert isinstance(follower, FlatPair)
        assert np.abs(follower.envelope.feet(pair(table, name)).excess).max() < 1e-11


def test_a_mirrored_drawing_in_inches_has_the_same_motion():
    body = "units: inch\ncam: {kind: support, p: 1 + 0.08*cos(3*t), shaft: [0.1, 0.05]}\n"
    _, _, cw = table_of(body)
    _, _, ccw = table_of(body + "rotation: ccw\n")
    assert list(cw) == [
        *("shaft_deg", "lift_in", "x_in", "y_in", "radius_in", "polar_deg", "nx", "ny", "normal_deg"),
    ]
    assert cw["x_in"].max() < 1.2
    for name in ("shaft_deg", "lift_in", "x_in", "radius_in", "nx"):
        assert np.array_equal(cw[name], ccw[name])
    for name in ("y_in", "ny"):
        assert np.array_equal(cw[name], -ccw[name])
    for name in ("polar_deg", "normal_deg"):
        assert np.allclose(np.mod(cw[name] + ccw[name] + 1.0, 360.0), 1.0, atol=1e-10)


def test_over_the_shaft_of_a_linkage():
    body = "cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}\n"
    body += "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n"
    recipe, design, table = table_of(body)
    from camgeo.synthesis.linkage import motion_table

    columns, rows = motion_table(recipe, design.driven.mechanism)
    motion = dict(zip(columns, rows.T, strict=True))
    assert np.array_equal(table["relative_deg"], motion["relative_deg"])
    theta = np.radians(table["relative_deg"])
    assert np.allclose(pair(table, "n"), units(theta), rtol=0.0, atol=1e-14)
    assert np.allclose(np.sum(pair(table, "") * units(theta), axis=1), table["lift_mm"], rtol=0.0, atol=1e-12)


def test_what_is_trimmed_away_has_empty_cells(tmp_path):
    body = (
        TRIMMED + "export: {tolerance: 0.01, files: [{csv: {as: inspection}}, csv]}\nverify: {angles: 360}\nname: c\n"
    )
    outcome = pipeline.export(read(body.encode(), "c.yaml"), tmp_path)
    assert outcome.ok
    assert [file["path"] for file in outcome.report["files"]] == ["c.csv", "c-motion.csv"]
    with (outcome.folder / "c.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 361
    assert all(row["lift_mm"] for row in rows)
    theta, look = np.radians([float(row["shaft_deg"]) for row in rows]), np.arange(3600) * np.pi / 1800
    p, slope = 25 + 4 * np.cos(3 * theta), -12 * np.sin(3 * theta)
    point = p[:, None] * units(theta) + slope[:, None] * units(theta + np.pi / 2)
    cut = (point @ units(look).T - (25 + 4 * np.cos(3 * look))).max(axis=1) > 1e-9
    assert 100 < cut.sum() < 200
    assert [row["x_mm"] == "" for row in rows] == cut.tolist()
    assert all((row["x_mm"] == "") == (row["ny"] == "") for row in rows)
