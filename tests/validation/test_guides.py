# needs: dynamics
"""The guide of a stem: f25 through recipe, report and file, equilibrium in the plane, and what jams.

f25 (sheet on forces): overhang 30, length 40, friction .12, 100 N along the travel, rising and falling. A stem that is
pushed ahead, where alpha is below 0, has reactions above 0.
"""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.capabilities.dynamics.force_figures import extremes_of, rigid_forces
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.output.pipeline import check, export
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

CAM = """
cam:
  kind: disc
  base_radius: {base!r}
  follower: {{{follower}}}
  {beside}
  motion: {motion}
part: {{thickness: 10, bore: 5}}
dynamics: {{mass: {mass}, rpm: {rpm}, {held}, guide: {{overhang: {overhang!r}, length: 40, friction: {friction}}}}}
export: {{tolerance: 0.01, files: [{{csv: {{as: forces}}}}]}}
verify: {{angles: 360}}
"""
WAVE = "{{formula: {a!r}*(1 - cos(t))}}"  # at 90 degrees S = S' = a, at 270 S = a and S' = -a
DOUBLE = "[{rise: 24, over: 100, law: polynomial-4567}, {dwell: 40}, {return: 24, over: 140, law: polynomial-4567}, {dwell: 80}]"  # noqa: E501
SLOW = {"mass": 1e-9, "rpm": 1, "held": "preload: 100", "friction": 0.12, "beside": "", "overhang": 30.0}


def text(**values):
    return CAM.format(**{**SLOW, **values})


def wave(a, tan, offset=0.0):
    """A roller whose pressure angle at 90 degrees has the tangent `tan`, and A = 30 there and at 270."""
    along = (a - offset) / tan - a
    base = math.hypot(along, offset) - 10.0
    follower = f"kind: roller, radius: 10, offset: {offset}"
    return text(base=base, follower=follower, motion=WAVE.format(a=a), overhang=30.0 + a)


def running(source):
    recipe = read(source.encode(), Path("guide.yaml"))
    found = running_of(recipe, designed(recipe))
    assert found is not None
    return found


ROLLERS = [
    (wave(40.0, math.tan(0.4)), 90, 0.4, 124.341689817),
    (wave(40.0, math.tan(0.4)), 270, -0.4, 96.349649329),
    (wave(10.0, math.tan(-0.3), 40.0), 90, -0.3, 115.382783400),
    (wave(40.0, math.tan(0.3)), 270, -0.3, 95.786124041),
]


def written(source, folder):
    """The report, and the rows of the table by shaft angle."""
    outcome = export(read(source.encode(), Path("guide.yaml")), folder)
    assert outcome.ok
    with next(folder.rglob("*.csv")).open(newline="") as file:
        rows = {float(row["shaft_deg"]): {k: float(v) for k, v in row.items()} for row in csv.DictReader(file)}
    return json.loads(next(folder.rglob("report.json")).read_text(encoding="utf-8")), rows


@pytest.mark.thin(4)
@pytest.mark.parametrize(("source", "at", "alpha", "force"), ROLLERS)
def test_f25_of_a_roller(source, at, alpha, force, tmp_path):
    report, rows = written(source, tmp_path)
    row = rows[float(at)]
    assert row["contact_N"] == pytest.approx(force, rel=1e-9)
    assert row["guide_a_N"] == pytest.approx(-force * math.sin(alpha) * 70.0 / 40.0, rel=1e-9)
    assert row["guide_b_N"] == pytest.approx(-force * math.sin(alpha) * 30.0 / 40.0, rel=1e-9)
    (contact,) = report["forces"]["contacts"]
    assert contact["min"] <= force * (1.0 + 1e-9)
    assert contact["max"] >= force * (1.0 - 1e-9)


@pytest.mark.slow
def test_f25_of_a_flat_face(tmp_path):
    """Touched 9 mm from the axis on the rise: the greatest force of the turn; both ends bear the couple."""
    source = text(base=40.0, follower="kind: flat", motion=WAVE.format(a=9.0))
    report, rows = written(source, tmp_path)
    assert rows[90.0]["contact_N"] == pytest.approx(105.708245243, rel=1e-10)
    assert rows[270.0]["contact_N"] == pytest.approx(100.0 / (1.0 + 0.12 * 2.0 * 9.0 / 40.0), rel=1e-10)
    assert rows[90.0]["guide_a_N"] == pytest.approx(105.708245243 * 9.0 / 40.0, rel=1e-10)
    assert rows[90.0]["guide_b_N"] == pytest.approx(rows[90.0]["guide_a_N"], rel=1e-12)
    section = report["forces"]
    (contact,) = section["contacts"]
    assert (contact["max"], contact["max_at_deg"]) == (
        pytest.approx(105.708245243, rel=1e-9),
        pytest.approx(90.0, abs=1e-4),
    )
    assert section["guide"][0]["max"] == pytest.approx(105.708245243 * 9.0 / 40.0, rel=1e-9)
    (jam,) = (one for one in report["checks"] if one["name"] == "guide-jam")
    assert (jam["value"], jam["limit"], jam["unit"]) == (pytest.approx(9.0, abs=1e-9), pytest.approx(40.0 / 0.24), "mm")


ONE = {"mass": 1.2, "rpm": 300, "held": "preload: 400", "base": 36.0, "motion": DOUBLE}
TWO = ONE | {"held": "load: 30", "mass": 2.0}
PLANE = {
    "roller": (ONE | {"follower": "kind: roller, radius: 9, offset: 6"}, 0.0),
    "roller inside its guide": (ONE | {"follower": "kind: roller, radius: 9", "overhang": 4.0}, 0.0),
    "flat": (ONE | {"follower": "kind: flat, offset: 4", "base": 90.0}, 0.0),
    "groove": (TWO | {"follower": "kind: roller, radius: 9", "beside": "track: {groove: {clearance: 0.02}}"}, 0.0),
    "discs": (
        TWO | {"follower": "kind: roller, radius: 9, offset: 6", "beside": "conjugate: {radius: 11, distance: 120}"},
        120.0,
    ),
    "flats": (TWO | {"follower": "kind: flat, offset: 4", "base": 90.0, "beside": "conjugate: {distance: 220}"}, 220.0),
}


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", PLANE)
def test_equilibrium_in_the_plane(name):
    """Forces and moments on the stem, x outward along it; a second contact stands `apart` further back."""
    values, apart = PLANE[name]
    run = running(text(**values))
    phi = np.linspace(0.05, 6.2, 301)
    state, guide = run.state(phi), run.train.guide
    near, far = state.reactions.values()
    first = state.lines[0]
    axis = run.design.follower.offset
    lowest = run.design.follower.contacts[0].datum + run.turn.extremes(lambda at: run.turn.rows(at)[:1])[0][0].value
    end = lowest + guide.overhang  # of the guide, on the stem's line
    x, y = 0.0, 0.0
    moment = 0.0
    for k, line in enumerate(state.lines):
        way = -1.0 if apart and k else 1.0
        force = run.sides[k] * state.normal[k] * way * line.normal.T
        at = way * line.centre.T
        if name in {"roller", "groove", "discs"}:
            assert at[0] == pytest.approx(first.centre[:, 0] - (apart if k else 0.0), abs=1e-9)
            assert at[1] == pytest.approx(axis, abs=1e-9)
        x, y = x + force[0], y + force[1]
        moment = moment + (at[0] - end) * force[1] - (at[1] - axis) * force[0]
    size = np.abs(state.normal).max()
    assert y - near + far == pytest.approx(0.0, abs=1e-9 * size)
    assert moment + guide.length * far == pytest.approx(0.0, abs=1e-6 * size)
    rub = guide.friction * (np.abs(near) + np.abs(far)) * np.sign(state.rows[1])
    assert x - rub == pytest.approx(state.force, abs=1e-9 * size)
    assert np.abs(near).max() > 0.01 * size
    if apart or name == "groove":
        assert (state.normal[1] > 0.0).any()


@pytest.mark.slow
def test_what_jams(tmp_path):
    """Beyond B/(2 mu) from the axis, or the angle of d20, no force moves the stem: a check fails."""
    flat = {"base": 40.0, "follower": "kind: flat", "motion": WAVE.format(a=9.0)}
    roller = {"base": 40.0, "follower": "kind: roller, radius: 9", "motion": WAVE.format(a=9.0)}
    for values, friction, ok in ((flat, 2.2, True), (flat, 2.25, False), (roller, 2.1, True), (roller, 3.0, False)):
        source = text(**values, friction=friction)
        recipe = read(source.encode(), Path("guide.yaml"))
        report = check(recipe).report
        (jam,) = (one for one in report["checks"] if one["name"] == "guide-jam")
        assert jam["ok"] is ok
        assert ("jams_at_deg" not in report["forces"]) is ok
    assert report["forces"]["jams_at_deg"] == running(source).jam_deg
    limited = source + "limits: {guide-force: {at_most: 1000}, contact-force-greatest: {at_most: 1000}}\n"
    found = [one for one in check(read(limited.encode(), Path("guide.yaml"))).report["checks"] if not one["ok"]]
    assert [one["name"] for one in found] == ["guide-jam", "limit:guide-force", "limit:contact-force-greatest"]
    assert all("jams" in one["detail"] for one in found[1:])
    assert not export(read(source.replace("forces}}]", "forces}}, html]").encode(), Path("guide.yaml")), tmp_path).ok
    rows = next(tmp_path.rglob("*.csv")).read_text(encoding="utf-8").splitlines()
    assert sum(",," in row for row in rows) > 10


@pytest.mark.slow
def test_the_second_disc_jams_first():
    """Its roller stands the distance of the rollers further from the guide."""
    values, apart = PLANE["discs"]
    source = text(**values)
    guide = running(source).train.guide
    (jam,) = (
        one for one in check(read(source.encode(), Path("x.yaml"))).report["checks"] if one["name"] == "guide-jam"
    )
    limit = math.degrees(math.atan(40.0 / (0.12 * (2.0 * (30.0 + apart) + 40.0))))
    assert jam["limit"] == pytest.approx(limit, rel=1e-9)
    assert jam["limit"] < math.degrees(guide.jam())


@pytest.mark.slow
def test_a_flat_face_needs_more_than_without_friction():
    free = {"base": 90.0, "follower": "kind: flat", "motion": DOUBLE, "mass": 1.2, "rpm": 300, "held": "preload: 400"}
    rubbing, slippery = (extremes_of(running(text(**free, friction=mu))) for mu in (0.3, 1e-12))
    assert rubbing.contacts[0][1].value > 1.01 * slippery.contacts[0][1].value
    assert rubbing.along == slippery.along
    assert rigid_forces(running(text(**free)).recipe, running(text(**free)).design).section["guide"]


@pytest.mark.parametrize(
    ("follower", "words"),
    [
        ("kind: flat, tilt: 5", "the friction of a tilted face is not found; leave it out, or the tilt"),
        (
            "kind: roller, radius: 8, arm: {length: 65, pivot: 80}",
            "the follower has no stem of its own; leave it out, or",
        ),
    ],
)
def test_what_is_refused(follower, words):
    with pytest.raises(RecipeErrors) as caught:
        read(text(base=40.0, follower=follower, motion=DOUBLE.replace("24", "9")).encode(), Path("guide.yaml"))
    (error,) = caught.value.errors
    assert error.path == "dynamics.guide"
    assert words in str(error)


def test_the_margin_of_an_angle_is_of_round_followers():
    with pytest.raises(RecipeErrors, match=r"jam-margin needs dynamics\.guide of a round follower"):
        read(
            (text(base=40.0, follower="kind: flat", motion=DOUBLE) + "limits: {jam-margin: {at_least: 3}}\n").encode(),
            Path("x.yaml"),
        )
