# needs: valve
"""The spring and the mass of a valve as its tappet feels them, against mpmath.

The reference knows no equation of motion: the force at the tappet is the power that goes into the energy of tappet,
valve and spring over the tappet's velocity, with energies differentiated numerically at 40 digits.

Holds: camgeo.capabilities.dynamics.moved_train.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import camgeo
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.running_forces import FollowerRunning, follower_running
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

mp.mp.dps = 40
CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: flat, width: 60}
  motion: {formula: 4*(1 - cos(t))}
"""
CONSTANT, LASH = "1.6", "0.3"
ROWS = ((0.0, 1.42), (3.0, 1.5), (6.0, 1.58), (8.5, 1.61))
TABLE = "{table: [[0, 1.42], [3, 1.5], [6, 1.58], [8.5, 1.61]]}"
SPRING = "spring: {on: valve, seat_length: 40, loads: [[40, 260], [27, 640]], solid_length: 24}"
TRAIN = f"dynamics: {{mass: {{tappet: 0.05, valve: 0.09}}, rpm: 2800, {SPRING}}}\n"
SPEED = mp.mpf(2800) * 2 * mp.pi / 60


def text(ratio: str, train: str = TRAIN, lash: str = LASH) -> str:
    return f"{CAM}valve: {{ratio: {ratio}, lash: {lash}}}\n{train}"


def running(recipe: str) -> FollowerRunning:
    found = read(recipe.encode(), Path("train.yaml"))
    train = found.of(Dynamics)
    assert train is not None
    return follower_running(found, designed(found), train)


def natural_spline(rows: tuple[tuple[float, float], ...]) -> Any:
    """Natural cubic spline through the rows, by its moments."""
    x, y = ([mp.mpf(str(row[k])) for row in rows] for k in (0, 1))
    n = len(x)
    matrix, right = mp.eye(n), mp.zeros(n, 1)
    for i in range(1, n - 1):
        a, b = x[i] - x[i - 1], x[i + 1] - x[i]
        matrix[i, i - 1], matrix[i, i], matrix[i, i + 1] = a / 6, (a + b) / 3, b / 6
        right[i] = (y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a
    moments = mp.lu_solve(matrix, right)

    def value(s: Any) -> Any:
        i = max(k for k in range(n - 1) if s >= x[k] or k == 0)
        h = x[i + 1] - x[i]
        low, high = (x[i + 1] - s) / h, (s - x[i]) / h
        bend = (low**3 - low) * moments[i] + (high**3 - high) * moments[i + 1]
        return low * y[i] + high * y[i + 1] + h**2 / 6 * bend

    return value


def reference(ratio: Any) -> tuple[Any, Any]:
    """Force at the tappet, N, by the shaft angle while the valve is open, and the angle at which it opens."""
    tappet, valve, rate = mp.mpf("0.05"), mp.mpf("0.09"), mp.mpf(380) / 13

    def lift(t: Any) -> Any:
        return 4 * (1 - mp.cos(t))

    def travel(t: Any) -> Any:
        return ratio(lift(t)) * lift(t) - mp.mpf("0.3")

    def energy(t: Any) -> Any:  # N mm
        moving = SPEED**2 * (tappet * mp.diff(lift, t) ** 2 + valve * mp.diff(travel, t) ** 2) / 2000
        return moving + 260 * travel(t) + rate * travel(t) ** 2 / 2

    return lambda t: mp.diff(energy, t) / mp.diff(lift, t), mp.findroot(travel, 0.3)


@pytest.mark.slow
@pytest.mark.parametrize(("written", "rows"), [(CONSTANT, None), (TABLE, ROWS)])
def test_the_force_at_the_tappet_is_that_of_the_energy(written: str, rows: Any) -> None:
    ratio = (lambda _: mp.mpf("1.6")) if rows is None else natural_spline(rows)
    force, opens = reference(ratio)
    train = running(text(written))
    t = np.array([0.5, 1.1, 1.9, 2.6, 3.1, 4.4, 5.7])
    state = train.state(t)
    assert state.normal[0] == pytest.approx([float(force(mp.mpf(at))) for at in t.tolist()], rel=1e-9)
    # torque is force times the tappet's velocity
    assert state.torque == pytest.approx([float(force(mp.mpf(at)) * 4 * mp.sin(at)) / 1e3 for at in t.tolist()])
    # in the lash and on the seat the tappet alone is moved: 0.05 kg
    shut = np.array([0.0, 0.2, 2.0 * math.pi - 0.1])
    assert train.state(shut).normal[0] == pytest.approx(
        [0.05 * float(SPEED) ** 2 * 4e-3 * math.cos(at) for at in shut.tolist()], rel=1e-12
    )
    report: Any = camgeo.check(camgeo.load(text(written)))
    least, most = min_max(force, opens)
    (contact,) = report["forces"]["contacts"]
    assert contact["min"] == pytest.approx(float(least), rel=1e-9)
    assert contact["max"] == pytest.approx(float(most), rel=1e-9)
    (stretch,) = report["forces"]["moved"]["open"]
    assert math.radians(stretch["from_deg"]) == pytest.approx(float(opens), rel=1e-9)
    assert math.radians(stretch["to_deg"]) == pytest.approx(2.0 * math.pi - float(opens), rel=1e-9)


def min_max(force: Any, opens: Any) -> tuple[Any, Any]:
    """Extremes over the open stretch, its ends included; the motion is even about pi."""
    places = [opens + (mp.pi - opens) * k / 24 for k in range(25)]
    values = [force(at) for at in places[:-1]] + [force(mp.pi - mp.mpf("1e-12"))]
    found = list(values)
    for sign in (1, -1):
        k = max(range(25), key=lambda i: sign * values[i])
        if 0 < k < 24:
            low, high = places[k - 1], places[k + 1]
            golden = (mp.sqrt(5) - 1) / 2
            for _ in range(40):
                a, b = high - golden * (high - low), low + golden * (high - low)
                low, high = (low, b) if sign * force(a) > sign * force(b) else (a, high)
            found.append(force((low + high) / 2))
    return min(found), max(found)


def test_an_engine_builders_spring_is_told_at_its_valve() -> None:
    """130 lbf on the seat, 420 lbf/in: at 1.6 times 0.321 in that is 345.7 lbf, and solid by 0.0636 in."""
    recipe = """\
units: inch
cam:
  kind: disc
  base_radius: 0.60
  follower: {kind: roller, radius: 0.375}
  motion: {lobe: {lift: 0.321, duration: [{at_lift: 0.015, degrees: 262}, {at_lift: 0.050, degrees: 228}], nose: 180}}
valve: {ratio: 1.6}
part: {thickness: 0.5}
dynamics: {mass: 0.3, rpm: 600, spring: {on: CARRIER, seat_length: 1.80, loads: [[1.80, 130 lbf], [1.30, 340 lbf]],
  solid_length: 1.35}}
limits: {coil-bind: {at_least: 0.06}, spring-open-load: {at_most: 300 lbf}, spring-seat-load: {at_least: 100 lbf}}
"""
    for carrier, lift in (("valve", 0.5136), ("tappet", 0.321)):
        made = camgeo.check(camgeo.load(recipe.replace("CARRIER", carrier)))
        found = {check.name.removeprefix("limit:"): check for check in made.checks}
        assert found["spring-seat-load"].value == pytest.approx(130 * 4.4482216152605, rel=1e-9)
        assert found["spring-open-load"].value == pytest.approx((130 + 420 * lift) * 4.4482216152605, rel=1e-9)
        assert found["coil-bind"].value == pytest.approx(1.8 - lift - 1.35, rel=1e-9)
        assert found["coil-bind"].ok is (carrier == "tappet")
    with pytest.raises(RecipeErrors, match=r"give on: valve, .* or on: tappet"):
        camgeo.load(recipe.replace("on: CARRIER, ", ""))


def test_without_lash_the_valve_is_open_from_dwell_to_dwell_and_its_mass_alone_may_count() -> None:
    motion = "[{dwell: 60}, {rise: 8, over: 90, law: cycloidal}, {dwell: 20}, {return: 8, over: 190, law: cycloidal}]"
    recipe = text("1.5", lash="0").replace("{formula: 4*(1 - cos(t))}", motion)
    report: Any = camgeo.check(camgeo.load(recipe))
    (stretch,) = report["forces"]["moved"]["open"]
    assert (stretch["from_deg"], stretch["to_deg"]) == pytest.approx((60.0, 0.0), abs=1e-9)
    (contact,) = report["forces"]["contacts"]
    assert contact["min"] > 0.0  # not the 0 of the dwell, in which the seat carries the spring
    assert report["forces"]["moved"]["mass_at_tappet"]["max"] == pytest.approx(0.05 + 1.5**2 * 0.09)
    assert report["forces"]["moved"]["rate_at_tappet"]["min"] == pytest.approx(1.5**2 * 380 / 0.013)
    shut = running(recipe).state(np.radians([0.0, 30.0]))
    assert shut.normal[0].tolist() == [0.0, 0.0]
    # a spring at the tappet presses all the turn; the valve's mass counts while it is open
    report = camgeo.check(camgeo.load(recipe.replace("on: valve", "on: tappet")))
    state = running(recipe.replace("on: valve", "on: tappet")).state(np.radians([30.0, 105.0]))
    assert state.normal[0] == pytest.approx([260.0, 260.0 + 380 / 13 * 4.0], rel=1e-9)  # no acceleration at half lift
    (check,) = [check for check in report.checks if check.name == "float"]
    assert "seat" not in check.detail


def test_each_opening_of_a_turn_is_judged() -> None:
    recipe = text(CONSTANT).replace("4*(1 - cos(t))", "4*(1 - cos(2*t))")
    report: Any = camgeo.check(camgeo.load(recipe.replace("2800", "1400")))
    stretches = report["forces"]["moved"]["open"]
    once = camgeo.check(camgeo.load(text(CONSTANT)))["forces"]
    assert [row["from_deg"] for row in stretches] == pytest.approx(
        [once["moved"]["open"][0]["from_deg"] / 2 + turn for turn in (0.0, 180.0)]
    )
    assert report["forces"]["contacts"][0]["min"] == pytest.approx(once["contacts"][0]["min"])


def test_float_is_judged_while_the_valve_is_open_and_the_load_holds_the_tappet_before() -> None:
    """At 2800 turns the tappet alone would leave the cam where it decelerates in its lash, if it did."""
    report: Any = camgeo.check(camgeo.load(text(CONSTANT)))
    (check,) = [check for check in report.checks if check.name == "float"]
    assert check.ok
    assert "while the valve is open, 17.6124 to 342.388" in check.detail
    assert "its seat carries the spring, and nothing holds the tappet" in check.detail
    loaded = camgeo.check(camgeo.load(text(CONSTANT, TRAIN.replace("rpm:", "load: 5, rpm:"))))
    (check,) = [check for check in loaded.checks if check.name == "float"]
    assert "its load alone holds the tappet" in check.detail
    # faster it floats; with the force at the seat that is named it does not
    fast = text(CONSTANT, TRAIN.replace("2800", "12000"))
    floating = camgeo.check(camgeo.load(fast))
    explained = floating.explain(next(check for check in floating.checks if check.name == "float"))
    assert "a dynamics.spring of " in explained
    force = float(explained.partition("a dynamics.spring of ")[2].partition(" N at its seat_length")[0])
    mended = fast.replace("[[40, 260], [27, 640]]", f"[[40, {force}], [27, {force + 380}]]")
    assert camgeo.check(camgeo.load(mended))["ok"]
    assert not camgeo.check(camgeo.load(mended.replace(str(force), str(0.99 * force))))["ok"]


@pytest.mark.parametrize(
    ("train", "message", "remedy"),
    [
        (
            TRAIN.replace("on: valve, ", ""),
            "dynamics.spring.on: missing, needed beside valve; give on: valve, whose travel it has, or on: tappet",
            TRAIN.replace("on: valve", "on: tappet"),
        ),
        (
            TRAIN.replace("on: valve", "on: rocker"),
            "dynamics.spring.on: not one of the choices, given 'rocker'; give valve or tappet",
            TRAIN,
        ),
        (
            TRAIN.replace("{tappet: 0.05, valve: 0.09}", "0.2").replace("rpm", "stiffness: 8e6, rpm"),
            "follow, given 'valve'; leave stiffness out, or give preload and rate as the tappet feels them",
            "dynamics: {mass: 0.2, stiffness: 8.0e6, damping: 60, rpm: 2800, preload: 416, rate: 74800}\n",
        ),
        (
            TRAIN.replace("on: valve", "on: tappet").replace("rpm", "stiffness: 8e6, rpm"),
            "dynamics.mass: an elastic train has one mass; give one number, tappet + ratio^2 valve",
            TRAIN.replace("on: valve", "on: tappet")
            .replace("{tappet: 0.05, valve: 0.09}", "0.2804")
            .replace("rpm", "stiffness: 8e6, damping: 60, rpm"),
        ),
        (TRAIN.replace(", valve: 0.09", ""), "dynamics.mass.valve: missing; give a number of at least 0 in kg", TRAIN),
        (TRAIN.replace("tappet: 0.05", "tappet: 0"), "dynamics.mass.tappet: not above 0", TRAIN),
    ],
)
def test_faults_and_what_mends_them(train: str, message: str, remedy: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        camgeo.load(text(CONSTANT, train))
    assert message in str(caught.value)
    assert len(caught.value.errors) == 1
    camgeo.load(text(CONSTANT, remedy))


@pytest.mark.parametrize(
    ("train", "message", "remedy"),
    [
        (TRAIN.replace("{tappet: 0.05, valve: 0.09}", "0.1"), "there is no valve, given 'valve'", ("on: valve, ", "")),
        (
            TRAIN.replace("on: valve, ", ""),
            "masses of tappet and valve without a valve; give one number",
            ("{tappet: 0.05, valve: 0.09}", "0.1"),
        ),
    ],
)
def test_a_train_without_a_valve_has_none_of_its_words(train: str, message: str, remedy: tuple[str, str]) -> None:
    with pytest.raises(RecipeErrors, match=message):
        camgeo.load(CAM + train)
    camgeo.load(CAM + train.replace(*remedy))


def test_a_valve_that_never_opens_is_refused() -> None:
    with pytest.raises(RecipeErrors, match="the valve never opens; give less lash"):
        camgeo.check(camgeo.load(text(CONSTANT, lash="20")))
    camgeo.check(camgeo.load(text(CONSTANT, lash="2")))


# needs: made
def test_on_a_made_part_float_is_judged_while_the_valve_is_open(tmp_path: Path) -> None:
    recipe = text("1.5", lash="0").replace(
        "{formula: 4*(1 - cos(t))}",
        "[{dwell: 60}, {rise: 8, over: 100, law: cycloidal}, {dwell: 60}, {return: 8, over: 140, law: cycloidal}]",
    )
    (tmp_path / "cam.yaml").write_text(recipe + "made: {profile: 0.05}\nexport: {files: [dxf]}\n", encoding="utf-8")
    contour = camgeo.design(camgeo.load(str(tmp_path / "cam.yaml"))).contour(720)
    noise = np.random.default_rng(1).normal(0.0, 0.001, contour.shape)
    np.savetxt(tmp_path / "cam.csv", contour + noise, delimiter=",", header="x_mm,y_mm", comments="", fmt="%.6f")
    made = camgeo.verify(str(tmp_path / "cam.yaml"), str(tmp_path / "cam.csv"))["made"]
    intended = camgeo.check(camgeo.load(recipe))["forces"]["contacts"][0]
    (row,) = [row for row in made["figures"] if row["name"] == "least contact force"]
    assert [row["intended"], row["made"]] == pytest.approx([intended["min"]] * 2, rel=0.01)  # not the dwell's 0


@pytest.mark.parametrize("carrier", ["valve", "tappet"])
def test_a_valve_moves_with_its_mass_and_its_spring_each_without_the_other(carrier: str) -> None:
    """While it is open the mass of the valve counts 1.6 squared times, whatever carries the spring."""
    heavy = TRAIN.replace("on: valve", f"on: {carrier}")
    light = heavy.replace("{tappet: 0.05, valve: 0.09}", "0.05")
    t = np.array([1.9, 2.6, 4.4])
    both, alone = (running(text(CONSTANT, train)).state(t).normal[0] for train in (heavy, light))
    assert both - alone == pytest.approx(0.09 * 1.6**2 * float(SPEED) ** 2 * 4e-3 * np.cos(t), rel=1e-9)
