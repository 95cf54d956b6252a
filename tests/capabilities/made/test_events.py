"""Lift, velocity and durations of a made cam against those intended: by brute force, and with their uncertainty.

Holds: kin.made.events, kin.made.lifts.
"""

from __future__ import annotations

import numpy as np
import pytest
from support.measured import measured, surfaces, table

import camgeo
from camgeo.cli.main import main

LOBE = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat, width: 33}
  motion: {lobe: {lift: 8.25, half: 66, powers: [2, 8, 14, 20, 26], ramp: {height: 0.25, velocity: 0.02}, nose: 180}}
part: {thickness: 14, bore: 20}
limits: {duration: [{at_lift: 1.27, at_least: 190}, {at_lift: 5, at_least: 100}]}
verify: {angles: 720}
"""


def events(recipe, *files, **options):
    return camgeo.verify(recipe, *files, **options)["made"]["events"]


def flank(height, centre=150.0, width=6.0):
    """A fault on the opening flank, by the shaft angle, degrees, of a flat follower, which is the parameter."""
    return lambda t: height * np.exp(-0.5 * ((np.degrees(np.mod(t, 2.0 * np.pi)) - centre) / width) ** 2)


def felt(places, angles):
    """Lift of a flat follower on points of metal (m, 2) at shaft angles (n,), degrees, from the lowest."""
    toward = np.radians(angles)
    reach = np.array([(places @ np.array([np.cos(a), np.sin(a)])).max() for a in toward])
    return reach - reach[: len(reach) // 6].mean()  # it rests there


@pytest.fixture
def planted(tmp_path):
    """A lobe with a fault of 20 um on its opening flank, and the metal itself, closely."""
    recipe, files = measured(tmp_path, LOBE, flank(0.02))
    ((_, _, surface),) = surfaces(LOBE)
    t = np.linspace(0.0, 2.0 * np.pi, 40_000, endpoint=False)
    frame = surface.gauge.envelope.frames(t)
    return recipe, files, frame.points + flank(0.02)(t)[:, None] * frame.normals, frame.points


@pytest.mark.slow
@pytest.mark.parametrize("lift", [pytest.param(1.27, marks=pytest.mark.slow), 5.0])
def test_durations_are_those_of_brute_force(lift, planted):
    recipe, files, metal, exact = planted
    angles = np.arange(0.0, 360.0, 0.05)
    crossings = {}
    for name, places in (("made", metal), ("intended", exact)):
        above = felt(places, angles) - lift
        k = np.flatnonzero((above[:-1] < 0.0) != (above[1:] < 0.0))
        crossings[name] = angles[k] + 0.05 * above[k] / (above[k] - above[k + 1])
    row = next(row for row in events(recipe, *files)["above"] if row["lift"] == lift)
    for name, (opens, closes) in crossings.items():
        assert row["opens_deg"][name] == pytest.approx(opens, abs=5e-4)
        assert row["closes_deg"][name] == pytest.approx(closes, abs=5e-4)
        assert row["centre_deg"][name] == pytest.approx(0.5 * (opens + closes), abs=5e-4)
        assert row["duration_crank_deg"][name] == pytest.approx(2.0 * (closes - opens), abs=2e-3)
    assert abs(np.diff([*crossings["made"]]) - np.diff([*crossings["intended"]])) > (0.04 if lift == 5.0 else -1.0)


@pytest.mark.slow
def test_lift_and_velocity_are_those_of_brute_force(tmp_path):
    recipe, files = measured(tmp_path, LOBE, flank(0.03, 180.0, 20.0))
    told = events(recipe, *files)["follower"]
    assert told["lift"]["intended"] == pytest.approx(8.25, abs=1e-9)
    assert told["lift"]["made"] == pytest.approx(8.28, abs=1e-5)
    ((_, _, surface),) = surfaces(LOBE)
    angle = np.arange(0.0, 360.0, 0.01)
    position = surface.gauge.intended(np.radians(angle)) + flank(0.03, 180.0, 20.0)(np.radians(angle))
    assert told["velocity"]["made"] == pytest.approx(np.gradient(position, np.radians(0.01)).max(), abs=2e-3)
    assert told["velocity"]["intended"] < told["velocity"]["made"]


@pytest.mark.slow
def test_size_is_no_duration_and_a_turn_is_phase_alone(tmp_path):
    """The lash is set on the base circle as it was made."""
    recipe, files = measured(tmp_path, LOBE, lambda t: np.full_like(t, 0.02))
    for row in events(recipe, *files)["above"]:
        assert row["duration_crank_deg"]["made"] == pytest.approx(row["duration_crank_deg"]["intended"], abs=1e-6)
    x, y = np.genfromtxt(files[0], delimiter=",", skip_header=1).T
    late = (x + 1j * y) * np.exp(1j * np.radians(0.1))
    files[0].write_text(table(np.column_stack([late.real, late.imag])), "utf-8")
    made = camgeo.verify(recipe, *files)["made"]
    assert made["motion"]["phase_deg"] == pytest.approx(0.1, abs=1e-5)
    for row in made["events"]["above"]:
        assert row["centre_deg"]["made"] - row["centre_deg"]["intended"] == pytest.approx(0.1, abs=1e-4)
        assert row["duration_crank_deg"]["made"] == pytest.approx(row["duration_crank_deg"]["intended"], abs=1e-3)


def test_what_the_probe_may_do_at_worst_counts_at_each_crossing(tmp_path):
    """Metal of U at the opening and none at rest moves it by U/S'; both ends and rests together twice as much each."""
    recipe, files = measured(tmp_path, LOBE)
    ((_, _, surface),) = surfaces(LOBE)
    row = events(recipe, *files, probe_error=0.002)["above"][-1]
    opening = np.radians(row["opens_deg"]["intended"])
    velocity = surface.gauge.motion.derivatives(np.array([opening]), 1)[1, 0]
    interpolated = np.degrees(2.0 * 0.002 / velocity)
    assert row["opens_deg"]["uncertainty"] == pytest.approx(interpolated, rel=0.3)
    assert row["duration_crank_deg"]["uncertainty"] == pytest.approx(4.0 * interpolated, rel=0.3)


@pytest.mark.slow
def test_durations_scatter_as_their_uncertainty_says(tmp_path):
    recipe, files = measured(tmp_path, LOBE)
    places = np.genfromtxt(files[0], delimiter=",", skip_header=1)
    normals = places / np.hypot(*places.T)[:, None]
    made, told = [], []
    for seed in range(24):
        noise = np.random.default_rng(seed).normal(0.0, 0.002, len(places))
        files[0].write_text(table(places + noise[:, None] * normals), "utf-8")
        rows = events(recipe, *files, spans=36)["above"]
        made.append([row["duration_crank_deg"]["made"] for row in rows])
        told.append([row["duration_crank_deg"]["uncertainty"] for row in rows])
    ratio = 2.0 * np.std(made, axis=0) / np.mean(told, axis=0)
    assert (np.abs(ratio - 1.0) < 0.35).all()


# needs: valve
def test_lifts_of_the_valve(tmp_path, capsys):
    """Its own where limits or its figures have them; greatest lift and velocity by the rocker and the lash."""
    text = LOBE.replace("limits:", "valve: {ratio: 1.6, lash: 0.3}\nlimits:").replace("at_lift: 5", "at_lift: 4")
    text = text.replace("limits: {", "limits: {valve-duration: {at_lift: 3, at_least: 100}, ")
    recipe, files = measured(tmp_path, text, flank(0.02))
    told = events(recipe, *files)
    assert [(row["of"], row["lift"]) for row in told["above"]] == [
        ("follower", 1.27),
        ("follower", 4.0),
        ("valve", 0.0),
        ("valve", 1.0),
        ("valve", 3.0),
    ]
    assert told["valve"]["lift"]["intended"] == pytest.approx(1.6 * 8.25 - 0.3, abs=1e-9)
    follower, valve = (told[name]["velocity"]["made"] for name in ("follower", "valve"))
    assert valve == pytest.approx(1.6 * follower, rel=1e-9)
    design = camgeo.design(recipe)
    assert told["above"][-1]["duration_crank_deg"]["intended"] == pytest.approx(
        design.figures["valve-duration"].value, abs=1e-7
    )
    assert main(["verify", str(recipe), *map(str, files)]) == 0
    out = capsys.readouterr().out
    assert "  valve above 3 mm              " in out
    assert "  valve, greatest lift          12.9" in out


def test_a_cam_without_stated_lifts_has_no_events(tmp_path):
    recipe, files = measured(tmp_path, LOBE.partition("limits:")[0] + "verify: {angles: 720}\n")
    assert "events" not in camgeo.verify(recipe, *files)["made"]


def test_a_lift_that_is_not_passed_is_said(tmp_path, capsys):
    text = LOBE.replace("at_lift: 5, at_least: 100", "at_lift: 9, at_least: 0")
    recipe, files = measured(tmp_path, text)
    main(["verify", str(recipe), *map(str, files)])
    assert "  follower above 9 mm           not crossed once upwards and once down" in capsys.readouterr().out


# needs: camshaft
@pytest.mark.slow
def test_events_of_a_shaft_are_over_its_own_angle(tmp_path):
    from support.shafts import Planted, camshaft, shaft_points, written

    recipe = camshaft(tmp_path)
    rows = "{recipe: flat.yaml, cylinder: 1, valve: intake, direction: 20, z: 20}"
    text = recipe.read_text("utf-8").replace("{recipe: flat.yaml, at: 33.3, z: 20}", rows)
    recipe.write_text(
        text.replace("  lobes:", "  engine: {order: [1], intake: 110, exhaust: 114, lift: 1}\n  lobes:"), "utf-8"
    )
    file = written(tmp_path / "points.csv", shaft_points(recipe, {"cylinder 1 intake": Planted(late=0.2)}))
    report = camgeo.verify(recipe, file, spans=36)
    meant = report["camshaft"]["lobes"][0]
    told = report["made"]["lobes"][0]["events"]
    row = told["above"][0]
    assert row["lift"] == 1.0
    for name in ("opens_deg", "closes_deg", "centre_deg"):
        assert row[name]["intended"] == pytest.approx(meant[name], abs=1e-9)
        assert row[name]["made"] == pytest.approx(meant[name] + 0.2, abs=1e-3)
    assert row["duration_crank_deg"]["intended"] == pytest.approx(2.0 * meant["duration_deg"], abs=1e-9)
