"""Laws of a recipe's own: constant velocity between blends, points, rows of a table."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

import camgeo
from camgeo.motions.segments import SccaLaw, UniformLaw
from camgeo.schema.errors import RecipeErrors
from kin.law.normalised import IntentError
from kin.law.sources.laws import blended, from_rows, named, through_points
from kin.law.sources.peaks import peaks
from kin.law.sources.ring import Samples

CAM = "cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 8}, motion: MOTION}\n"


def design(motion: str) -> camgeo.Design:
    return camgeo.design(camgeo.load(CAM.replace("MOTION", motion)))


def rate(made: camgeo.Design, degrees: list[float]) -> Any:
    """Velocity in mm a degree, by difference quotients."""
    step = 1e-4
    above, below = (made.motion(np.radians(np.array(degrees) + sign * step)) for sign in (1, -1))
    return (above - below) / (2 * step)


# --- constant velocity ------------------------------------------------------------------------------------------------


@settings(max_examples=examples(20), deadline=None)
@given(st.floats(0.01, 0.6), st.floats(0.01, 0.39))
def test_a_blended_law_is_uniform_between_its_blends(first: float, last: float) -> None:
    law = blended(first, last)
    velocity = 1.0 / (1.0 - 0.5 * (first + last))
    u = np.linspace(first + 1e-9, 1.0 - last - 1e-9, 50)
    s, v, a = law.derivatives(u, 2)
    assert v == pytest.approx(velocity, rel=1e-12)
    assert a == pytest.approx(0.0, abs=1e-9)
    assert s == pytest.approx(velocity * (u - 0.5 * first), abs=1e-12)
    ends = law.derivatives(np.array([0.0, 1.0]), 2, np.array([1, -1]))
    assert ends[0] == pytest.approx([0.0, 1.0], abs=0)
    assert ends[1:] == pytest.approx(0.0, abs=0)
    assert peaks(law.motion).velocity == pytest.approx(velocity, rel=1e-12)
    assert peaks(law.motion).acceleration == pytest.approx(1.5 * velocity / min(first, last), rel=1e-9)
    # by difference quotients on the blends
    x, h = np.array([0.3 * first, 0.8 * first, 1.0 - 0.4 * last]), 1e-6
    below, here, above = (law.derivatives(x + k * h, 1) for k in (-1, 0, 1))
    assert here[1] == pytest.approx((above[0] - below[0]) / (2 * h), rel=1e-6)


@pytest.mark.parametrize(("first", "last"), [(0.0, 0.0), (0.0, 0.4), (0.4, 0.0), (0.5, 0.5), (1.0, 0.0)])
def test_blends_of_nothing_or_of_all(first: float, last: float) -> None:
    law = blended(first, last)
    s = law.derivatives(np.linspace(0.0, 1.0, 101), 0)[0]
    assert (np.diff(s) > 0.0).all()
    assert s[[0, -1]].tolist() == [0.0, 1.0]
    assert math.isfinite(peaks(law.motion).acceleration) == (first > 0.0 and last > 0.0)
    if first == last == 0.0:
        assert s == pytest.approx(named("constant-velocity").derivatives(np.linspace(0, 1, 101), 0)[0], abs=1e-15)


def test_blends_are_degrees_in_the_order_in_which_they_are_passed() -> None:
    """Up over 120 and down over 90 degrees, each beginning gently over 30 and ending over 10."""
    made = design(
        "[{rise: 20, over: 120, law: {uniform: {blend: [30, 10]}}}, {dwell: 40}, "
        "{return: 20, over: 90, law: {uniform: {blend: [30, 10]}}}, {dwell: 110}]"
    )
    up, down = (
        np.array([0.5, 1.0, 1.0, 1.0, 0.5]) * 20 / (120 - 20),
        np.array([0.5, 1.0, 1.0, 1.0, 0.5]) * 20 / (90 - 20),
    )
    assert rate(made, [15.0, 30.0, 60.0, 110.0, 115.0]) == pytest.approx(up, rel=1e-7)
    assert rate(made, [175.0, 190.0, 220.0, 240.0, 245.0]) == pytest.approx(-down, rel=1e-7)


def test_one_number_is_both_blends_and_parts_without_a_blend_join() -> None:
    rest = "{dwell: 60}, {return: 9, over: 180, law: cycloidal}]"
    one, two = (
        design(f"[{{rise: 9, over: 120, law: {{uniform: {{blend: {blend}}}}}}}, {rest}") for blend in ("12", "[12, 12]")
    )
    angle = np.radians(np.arange(0.0, 360.0, 3.0))
    assert one.motion(angle) == pytest.approx(two.motion(angle), abs=0)
    # two parts at one velocity, 0.1 mm a degree: without a blend where they meet there is no step
    first, second = "{rise: 4.5, over: 50, law: {uniform: {blend: [10, 0]}}}", "law: {uniform: {blend: [0, 10]}}}"
    parts = f"[{first}, {{rise: 5.5, over: 60, {second}, {{return: 10, over: 250, law: cycloidal}}]"
    assert rate(design(parts), [49.0, 50.0, 51.0]) == pytest.approx(0.1, rel=1e-9)
    assert camgeo.check(camgeo.load(CAM.replace("MOTION", parts))).ok


def test_laws_say_what_they_are_made_of() -> None:
    assert UniformLaw((0.1, 0.2)).law(1.0, "law").name == "uniform (blends 0.1 and 0.2)"
    assert SccaLaw(0.25).law(1.0, "law").name == "modified-sine"


# --- points and tables ------------------------------------------------------------------------------------------------


def test_a_law_through_points_meets_them_and_rests() -> None:
    points = [(0.0, 0.0), (0.3, 0.12), (0.55, 0.6), (0.8, 0.95), (1.0, 1.0)]
    law = through_points(points)
    u, s = np.array(points).T
    assert law.derivatives(u, 0)[0] == pytest.approx(s, abs=1e-12)
    ends = law.derivatives(np.array([0.0, 1.0]), 2, np.array([1, -1]))
    assert ends[1:] == pytest.approx(0.0, abs=1e-9)
    assert law.reverses


@pytest.mark.parametrize(
    "points", [[(0, 0), (1, 1)], [(0, 0), (0.5, 0.5), (0.9, 1)], [(0, 0), (0.6, 0.5), (0.5, 0.6), (1, 1)]]
)
def test_points_that_are_no_law_are_refused(points: list[tuple[float, float]]) -> None:
    with pytest.raises(IntentError, match="the points of a law"):
        through_points(points)


@pytest.mark.parametrize("bad", [(0.6, math.nan), (math.nan, 0.6), (0.6, math.inf)])
def test_numbers_of_points_that_are_not_finite_are_named(bad: tuple[float, float]) -> None:
    with pytest.raises(IntentError, match="both numbers of a point are finite") as caught:
        through_points([(0.0, 0.0), (0.5, 0.5), bad, (1.0, 1.0)])
    assert caught.value.field == "law[2]"


def test_too_many_points_are_counted() -> None:
    u = np.linspace(0.0, 1.0, 1001).tolist()
    with pytest.raises(IntentError, match="a law has at most 1000 points, not 1001"):
        through_points([(x, x) for x in u])


def test_a_law_of_rows_is_the_law_that_they_were_taken_of() -> None:
    u = np.linspace(0.0, 1.0, 41)
    s = np.round(named("cycloidal").derivatives(u, 0)[0], 4)
    law = from_rows(Samples(u, s, np.arange(41) + 1), 0.00005)
    x = np.linspace(0.0, 1.0, 500)
    assert law.derivatives(x, 0)[0] == pytest.approx(named("cycloidal").derivatives(x, 0)[0], abs=2e-4)
    assert law.derivatives(u, 0)[0] == pytest.approx(s, abs=0.00006)
    assert law.derivatives(np.array([0.0, 1.0]), 0, np.array([1, -1]))[0].tolist() == [0.0, 1.0]


def test_a_return_runs_points_and_tables_backwards(tmp_path: Path) -> None:
    rows = [(0.0, 0.0), (0.2, 0.02), (0.4, 0.1), (0.6, 0.4), (0.8, 0.85), (1.0, 1.0)]
    (tmp_path / "s.csv").write_text("u;s\n" + "".join(f"{u};{s}\n" for u, s in rows), encoding="utf-8")
    for law in (f"{{points: {[list(row) for row in rows]}}}", "{table: s.csv, reading: 0.001}"):
        over = f"over: 100, law: {law}"
        motion = f"[{{rise: 10, {over}}}, {{dwell: 80}}, {{return: 10, {over}}}, {{dwell: 80}}]"
        (tmp_path / "cam.yaml").write_text(CAM.replace("MOTION", motion), encoding="utf-8")
        made = camgeo.design(tmp_path / "cam.yaml")
        up, down = (
            made.motion(np.radians(np.arange(0.0, 101.0, 5.0))),
            made.motion(np.radians(np.arange(180.0, 281.0, 5.0))),
        )
        assert down == pytest.approx(up[::-1], abs=1e-9)


@pytest.mark.parametrize(
    ("law", "message", "remedy"),
    [
        (
            "{uniform: {blend: [100, 30]}}",
            "law.uniform.blend: both blends together take 130 degrees, their segment 120; give blends of up to 120",
            "{uniform: {blend: [90, 30]}}",
        ),
        ("{uniform: {blend: [10]}}", "law.uniform.blend: not two angles; give an angle", "{uniform: {blend: 10}}"),
        (
            "{points: [[0, 0], [0.5, 0.4]]}",
            "law.points: the points of a law lead from [0, 0] to [1, 1] by one or more between; let it lead",
            "{points: [[0, 0], [0.5, 0.4], [1, 1]]}",
        ),
        (
            "{table: [[0, 0], [0.3, 0.2], [0.7, 0.8], [1, 1]]}",
            "law.table: rows in a recipe show no last digit; give reading beside them",
            "{table: [[0, 0], [0.3, 0.2], [0.7, 0.8], [1, 1]], reading: 0.01}",
        ),
        (
            "{table: [[0, 0], [0.3, 0.2], [0.7, 0.8], [1, 1.2]], reading: 0.01}",
            "law.table: the rows, the rows of a law lead from 0;0 to 1;1; let it lead from 0 to 1",
            "{table: [[0, 0], [0.3, 0.2], [0.7, 0.8], [1, 1]], reading: 0.01}",
        ),
        ("{uniform: {blend: 9}, reading: 0.1}", "law.reading: cannot stand without a table", "{uniform: {blend: 9}}"),
    ],
)
def test_faults_of_a_law_and_what_mends_them(law: str, message: str, remedy: str) -> None:
    motion = "[{rise: 9, over: 120, law: LAW}, {dwell: 60}, {return: 9, over: 180, law: cycloidal}]"
    with pytest.raises(RecipeErrors) as caught:
        design(motion.replace("LAW", law))
    assert message in str(caught.value)
    design(motion.replace("LAW", remedy))
