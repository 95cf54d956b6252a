"""Materials of contacts: by name or by their figures, the pressure that follows, and a limit that is stated alone."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import camgeo
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.running import float_rpm
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.cli.main import main
from camgeo.output.pipeline import check
from camgeo.recipe.loading import read
from camgeo.recipe.materials import Material
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 180, law: polynomial-345}]
part: {thickness: 12, bore: 20}
export: {files: [csv]}
dynamics: {mass: 1.2, rpm: 300, preload: 80, MATERIAL}
"""
OWN = "material: {E: 206000, nu: 0.3"


def report(material: str, more: str = "") -> dict[str, Any]:
    found: dict[str, Any] = check(read((CAM.replace("MATERIAL", material) + more).encode(), Path("cam.yaml"))).report
    return found


@pytest.mark.slow
def test_a_name_and_its_figures_are_one_material() -> None:
    assert report("material: steel")["forces"] == report(f"{OWN}}}")["forces"]
    assert (
        report("material: steel, roller_material: pom")["forces"]["pressure"]
        == (report(f"{OWN}}}, roller_material: {{E: 3000, nu: 0.35}}")["forces"]["pressure"])
    )


def test_pressure_by_hertz_of_two_materials() -> None:
    """Worked by hand: p^2 = N (1/10 + 1/rho) / (pi w ((1 - nu1^2)/E1 + (1 - nu2^2)/E2)), on the dwell's arc of 60."""
    text = CAM.replace("MATERIAL", "material: {E: 70000, nu: 0.33}, roller_material: bronze")
    recipe = read(text.encode(), Path("cam.yaml"))
    running = running_of(recipe, designed(recipe))
    assert running is not None
    pressure = running.state(np.radians([150.0])).pressure
    assert pressure is not None
    compliance = (1.0 - 0.33**2) / 70000.0 + (1.0 - 0.34**2) / 110000.0
    assert pressure[0, 0] == pytest.approx(
        math.sqrt(80.0 * (0.1 + 1.0 / 60.0) / (math.pi * 12.0 * compliance)), rel=1e-9
    )


def test_a_limit_is_told_and_not_judged() -> None:
    """The weaker of both; far above it nothing fails but where the recipe limits the figure."""
    plain = report(f"{OWN}}}")["forces"]["pressure"][0]
    assert {"limit", "share_of_limit"}.isdisjoint(plain)
    found = report(f"{OWN}, limit: 900}}, roller_material: {{E: 206000, nu: 0.3, limit: 20}}")
    (pressure,) = found["forces"]["pressure"]
    assert pressure["limit"] == 20.0
    assert pressure["share_of_limit"] == pytest.approx(plain["max"] / 20.0)
    assert pressure["share_of_limit"] > 3.0
    assert all(one["ok"] for one in found["checks"])
    judged = report(f"{OWN}, limit: 20}}", "limits: {contact-pressure: {at_most: 20}}\n")["checks"]
    assert [one["name"] for one in judged if not one["ok"]] == ["limit:contact-pressure"]


def test_the_page_tells_the_share() -> None:
    from camgeo.capabilities.dynamics.panel import forces

    shown = forces(report(f"{OWN}, limit: 1200}}"))
    assert "that pressure over the 1200 N/mm^2 that the material bears" in shown
    assert "material bears" not in forces(report(f"{OWN}}}"))


@pytest.mark.parametrize(
    ("material", "field", "words"),
    [
        ("material: stell", "material", "did you mean steel?"),
        ("material: {E: 0, nu: 0.3}", "material.E", "not above 0"),
        ("roller_material: [steel]", "roller_material", "give steel, nodular-iron"),
    ],
)
def test_what_is_no_material(material: str, field: str, words: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        report(material)
    (error,) = caught.value.errors
    assert error.path == f"dynamics.{field}"
    assert words in str(error)


@pytest.mark.parametrize("key", ["width: 4", "material: steel", "roller_material: {E: 3000, nu: 0.4}"])
def test_an_elastic_train_without_a_spring_has_no_pressure(key: str) -> None:
    yoke = "cam: {kind: constant-breadth, base_radius: 40, motion: {formula: 6*(1 - cos(t))}}\n"
    train = "dynamics: {mass: 0.4, rpm: 60, backlash: 0.05, stiffness: 1.0e6"
    with pytest.raises(RecipeErrors, match=r"belongs to a train without stiffness; leave stiffness out, or this"):
        read(f"{yoke}{train}, {key}}}\n".encode(), Path("case.yaml"))
    read(f"{yoke}{train}}}\n".encode(), Path("case.yaml"))
    read(CAM.replace("MATERIAL", f"{key}, stiffness: 1.0e6").encode(), Path("case.yaml"))  # a spring holds it


def test_a_pressure_needs_a_width() -> None:
    """Without one there is no figure: a limit of it is refused and does not pass unseen."""
    limits = "limits: {contact-pressure: {at_most: 0.001}}\n"
    bare = CAM.replace("MATERIAL", "material: steel").replace("part: {thickness: 12, bore: 20}\n", "")
    with pytest.raises(
        RecipeErrors,
        match=r"contact-pressure needs dynamics.material, part.thickness, a groove's depth or dynamics.width",
    ):
        read((bare + limits).encode(), Path("cam.yaml"))
    whole = CAM.replace("MATERIAL", "material: steel")
    for wide in (bare.replace("material: steel", "material: steel, width: 12"), whole):
        found = check(read((wide + limits).encode(), Path("cam.yaml"))).report
        assert [entry["ok"] for entry in found["checks"] if entry["name"] == "limit:contact-pressure"] == [False]


@pytest.mark.slow
def test_a_sweep_ranks_by_the_pressure_over_the_part_s_thickness(tmp_path: Path) -> None:
    more = "sweep: {vary: {cam.base_radius: [40, 45]}, rank: contact-pressure, keep: 2}\n"
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(CAM.replace("MATERIAL", "material: steel") + more, encoding="utf-8")
    assert main(["sweep", str(recipe), "--out", str(tmp_path)]) == 0
    lines = (tmp_path / "cam" / "sweep.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    pressures = [float(row["contact-pressure_N_per_mm2"]) for row in rows]
    assert pressures == sorted(pressures)
    assert all(0.0 < pressure < 1e4 for pressure in pressures)


# --- over which width -------------------------------------------------------------------------------------------------

DISC = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  TRACK
  motion:
    - {rise: 20, over: 110, law: modified-sine}
    - {dwell: 50}
    - {return: 20, over: 120, law: cycloidal}
    - {dwell: 80}
part: {PART}
dynamics: {mass: 1, rpm: 60, SPRING, material: steelWIDTH}
limits: {contact-pressure: {at_most: 700}}
export: {files: [{csv: {as: forces}}]}
"""
GROOVE = "track: {groove: {clearance: 0.03, depth: 3}}"
CONJUGATE = "conjugate: {radius: 9, distance: 110}"


def disc(part: str = "thickness: 10", width: str = "", track: str = "", units: str = "") -> str:
    spring = "load: 800" if track else "preload: 800"
    text = DISC.replace("TRACK", track or "undercut: refuse").replace("PART", part).replace("SPRING", spring)
    return units + text.replace("WIDTH", f", width: {width}" if width else "")


def pressure_of(text: str) -> tuple[float, dict[str, Any]]:
    found = check(read(text.encode(), Path("case.yaml"))).report["forces"]
    return max(one["max"] for one in found["pressure"]), found["width"]


@pytest.mark.thin(10)
@pytest.mark.parametrize(
    ("part", "width", "track", "value", "bound"),
    [
        ("thickness: 10, bore: 20", "", "", 10.0, "the part's thickness"),
        ("thickness: 10, bore: 20, chamfer: 2", "", "", 6.0, "the land between the chamfers"),
        ("thickness: 10, bore: 20, chamfer: 2", "6", "", 6.0, "the land between the chamfers"),
        ("thickness: 10, bore: 20, chamfer: 2", "5", "", 5.0, "dynamics.width"),
        ("thickness: 14, bore: 20", "", GROOVE, 3.0, "the groove's depth"),
        ("outer: 150", "", GROOVE, 3.0, "the groove's depth"),
        ("thickness: 14, bore: 20", "", GROOVE.replace(", depth: 3", ""), 14.0, "the part's thickness"),
        ("thickness: 14, bore: 20", "2.5", GROOVE, 2.5, "dynamics.width"),
        ("thickness: 9, bore: 20, chamfer: 1.5", "", CONJUGATE, 6.0, "the land between the chamfers"),
        ("bore: 20", "40", "", 40.0, "dynamics.width"),
    ],
)
def test_the_width_is_the_least_of_the_metal(part: str, width: str, track: str, value: float, bound: str) -> None:
    """The pressure goes with 1/sqrt(width): 644.44 N/mm^2 over 10 mm, so 831.97 over the land of 6."""
    wide = disc("bore: 20", "1", track)
    over, told = pressure_of(disc(part, width, track))
    assert told == {"value": value, "unit": "mm", "bound_by": bound}
    assert over == pytest.approx(pressure_of(wide)[0] / math.sqrt(value), rel=1e-9)


def test_the_land_of_the_case() -> None:
    report = check(read(disc("thickness: 10, bore: 20, chamfer: 2").encode(), Path("case.yaml"))).report
    (limit,) = (one for one in report["checks"] if one["name"] == "limit:contact-pressure")
    assert (limit["ok"], limit["value"]) == (False, pytest.approx(831.965, abs=1e-3))
    assert pressure_of(disc("thickness: 10, bore: 20"))[0] == pytest.approx(644.437, abs=1e-3)


@pytest.mark.slow
def test_a_lobe_s_land_and_an_inch_recipe() -> None:
    lobe = """units: inch
cam:
  kind: disc
  base_radius: 18 mm
  follower: {kind: flat}
  motion: {lobe: {lift: 8.25 mm, half: 66, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 0.5, chamfer: 0.05}
dynamics: {mass: 0.1, rpm: 60, preload: 800, material: steel}
"""
    value, width = pressure_of(lobe)
    assert width == {"value": pytest.approx(0.4, rel=1e-12), "unit": "in", "bound_by": "the land between the chamfers"}
    bare, _ = pressure_of(lobe.replace(", chamfer: 0.05", ""))
    assert value == pytest.approx(bare * math.sqrt(0.5 / 0.4), rel=1e-9)


@pytest.mark.parametrize(
    ("text", "words", "most"),
    [
        (disc(width="40"), "wider than the metal: the part's thickness is 10 mm, given 40 mm", "10"),
        (disc("thickness: 10, chamfer: 2", "7"), "the land between the chamfers is 6 mm, given 7 mm", "6"),
        (disc("thickness: 14", "4", GROOVE), "the groove's depth is 3 mm, given 4 mm", "3"),
        (disc("thickness: 9", "9.001", CONJUGATE), "the part's thickness is 9 mm, given 9.001 mm", "9"),
    ],
)
def test_contacts_wider_than_the_metal(text: str, words: str, most: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        read(text.encode(), Path("case.yaml"))
    (error,) = caught.value.errors
    assert error.path == "dynamics.width"
    assert words in str(error)
    assert str(error).endswith(f"give {most} mm or less, or leave it out")
    width = text.split("width: ")[1].split("}", maxsplit=1)[0]
    for remedied in (text.replace(f"width: {width}", f"width: {most}"), text.replace(f", width: {width}", "")):
        read(remedied.encode(), Path("case.yaml"))


# needs: camshaft
@pytest.mark.slow
def test_a_lobe_is_as_wide_as_on_its_shaft(tmp_path: Path) -> None:
    """Two lobes of one recipe, 5 and 20 mm long: each is held against its limit over its own length."""
    (tmp_path / "lobe.yaml").write_text(disc("thickness: 10, chamfer: 2"), encoding="utf-8")
    shaft = tmp_path / "shaft.yaml"
    shaft.write_text(
        "camshaft:\n  shaft: {diameter: 30, to: 60}\n  lobes:\n"
        "    - {recipe: lobe.yaml, at: 0, z: 5, length: 5}\n    - {recipe: lobe.yaml, at: 90, z: 20.1, length: 20}\n",
        encoding="utf-8",
    )
    report = camgeo.check(shaft)
    values = {one["surface"]: one["value"] for one in report["checks"] if one["name"] == "limit:contact-pressure"}
    assert list(values.values()) == pytest.approx([644.4371 * math.sqrt(10.0 / long) for long in (5.0, 20.0)], rel=1e-5)


@pytest.mark.parametrize(
    ("stated", "mega"),
    [
        ("600 MPa", 600.0),
        ("600 N/mm^2", 600.0),
        ("600 N/mm²", 600.0),
        ("0.6 GPa", 600.0),
        ("1000 psi", 6.894757293168361),
    ],
)
def test_pressures_carry_their_units(stated: str, mega: float) -> None:
    """1 psi is 0.45359237 kg by 9.80665 m/s^2 over a square inch."""
    own = f"material: {{E: 206 GPa, nu: 0.3, limit: {stated}}}"
    text = CAM.replace("MATERIAL", own) + f"limits: {{contact-pressure: {{at_most: {stated}}}}}\n"
    recipe = read(text.encode(), Path("cam.yaml"))
    train = recipe.of(Dynamics)
    assert train is not None
    assert train.material == Material(206_000.0, 0.3, pytest.approx(mega, rel=1e-15))
    assert recipe.limits[0].at_most == pytest.approx(mega, rel=1e-15)
    with pytest.raises(
        RecipeErrors, match=r"'lbf' is no unit of a pressure, .* give N/mm\^2, N/mm², MPa, GPa, psi or ksi"
    ):
        read(text.replace(f"at_most: {stated}", "at_most: 3 lbf").encode(), Path("cam.yaml"))


@pytest.mark.parametrize(
    ("load", "preload", "rate", "rpm"),
    [
        (0, 80, 0, 60 / math.tau * math.sqrt(80 / (1.2 * 0.004))),
        (20, 60, 5000, 60 / math.tau * math.sqrt((80 + 2 * 5000 * 0.004) / (1.2 * 0.004))),
        (-100, 80, 0, 0.0),
    ],
)
def test_the_speed_at_which_float_begins(load: float, preload: float, rate: float, rpm: float) -> None:
    """By hand for y = 4 mm (1 - cos t): the force m Omega^2 a cos t + k y + F0 is least where the follower is highest.

    A load that pulls more than the spring presses loses the follower at rest.
    """
    text = f"""\
cam:
  kind: disc
  base_radius: 40
  follower: {{kind: flat}}
  motion: {{formula: 4*(1 - cos(t))}}
dynamics: {{mass: 1.2, rpm: 2000, preload: {preload}, rate: {rate}, load: "{load}"}}
"""
    recipe = read(text.encode(), Path("cam.yaml"))
    running = running_of(recipe, designed(recipe))
    assert running is not None
    assert float_rpm(running, [(0.0, math.tau)]) == pytest.approx(rpm, rel=1e-9)


def test_float_names_its_speed() -> None:
    (floats,) = (each for each in report("", "").get("checks", ()) if each["name"] == "float")
    assert floats["ok"]
    assert "begins" not in floats["detail"]
    fast = CAM.replace("rpm: 300", "rpm: 900").replace(", MATERIAL", "")
    (floats,) = (
        each for each in check(read(fast.encode(), Path("cam.yaml"))).report["checks"] if each["name"] == "float"
    )
    recipe = read(fast.encode(), Path("cam.yaml"))
    running = running_of(recipe, designed(recipe))
    assert running is not None
    rpm = float_rpm(running, [(0.0, math.tau)])
    assert floats["detail"].startswith(f"float begins at {rpm:.6g} rpm of the shaft, and 900 are asked for; greatest ")
    for speed, holds in ((0.999 * rpm, True), (1.001 * rpm, False)):
        near = read(fast.replace("rpm: 900", f"rpm: {speed:.9g}").encode(), Path("cam.yaml"))
        (judged,) = (each for each in check(near).report["checks"] if each["name"] == "float")
        assert judged["ok"] == holds
