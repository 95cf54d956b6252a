"""Case d20: how a normal error of the metal moves the follower, as files show it that are made too small all round.

First order: flat d, tilted d/cos beta, roller d/cos alpha, arm d/(L cos alpha) and with a face d/reach.
"""

import math
from pathlib import Path

import pytest

import camgeo

SMALL = 0.01  # mm
RISE = "{rise: %s, over: 120, law: cycloidal}, {dwell: 40}, {return: %s, over: 120, law: polynomial-345}, {dwell: 80}"
ARM = "base_radius: 34, follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80, side: %s}}"
FACE = "base_radius: 36, follower: {kind: flat, arm: {pivot: 90, face: 10, side: %s}}"
CASES = {  # cam, stroke, and the greatest motion error over the normal one where that is no matter of pressure angles
    "flat": ("base_radius: 32, follower: {kind: flat}", 12, 1.0),
    "flat, tilted": ("base_radius: 32, follower: {kind: flat, tilt: 8, offset: 5}", 12, 1 / math.cos(math.radians(8))),
    "roller": ("base_radius: 36, follower: {kind: roller, radius: 9, offset: 6}", 20, None),
    "arm, trailing": (ARM % "trailing", 20, None),
    "arm, leading": (ARM % "leading", 20, None),
    "face on an arm, trailing": (FACE % "trailing", 10, math.degrees(1.0) / 61.897303035),  # d08: least reach
    "face on an arm, leading": (FACE % "leading", 10, math.degrees(1.0) / 62.354139715),
}


@pytest.mark.thin(12)
@pytest.mark.parametrize(("cam", "stroke", "gain"), CASES.values(), ids=CASES)
def test_d20_metal_that_is_too_small_everywhere(tmp_path: Path, cam: str, stroke: float, gain: float | None) -> None:
    text = f"cam: {{kind: disc, {cam}, motion: [{RISE % (stroke, stroke)}]}}\n"
    if gain is None:
        limits = "limits: {pressure-angle: {at_most: 80}}\n"
        report = camgeo.check(camgeo.load(text + limits))
        (angle,) = [check.value for check in report.checks if check.name == "limit:pressure-angle"]
        assert angle is not None
        gain = 1.0 / math.cos(math.radians(angle))
        gain *= math.degrees(1.0) / 65.0 if "arm" in cam else 1.0
    for name, file in (("right", "dxf"), ("cam", f"{{dxf: {{clearance: {SMALL}}}}}")):
        export = f"export: {{tolerance: 0.00001, files: [{file}]}}\n"
        (tmp_path / f"{name}.yaml").write_text(text + export, encoding="utf-8")
    made = camgeo.export(tmp_path / "cam.yaml", tmp_path / "out")
    assert made.ok
    assert made.path is not None
    judged = camgeo.verify(tmp_path / "right.yaml", made.path / "cam.dxf")
    assert not judged.ok
    (check,) = [check for check in judged.checks if check.name == "motion"]
    assert check.value == pytest.approx(SMALL * gain, rel=2e-3)  # to first order


def test_d20_radius_at_a_nose() -> None:
    """Where S' is 0 the pitch curve's radius is b²/(b - S''): 25 mm for S'' = -40 at b = 46.503676272."""
    cam = "base_radius: 18.503676272, follower: {kind: roller, radius: 8}, motion: {formula: 10*(1 - cos(2*t))}"
    report = camgeo.check(camgeo.load(f"cam: {{kind: disc, {cam}}}\nlimits: {{pitch-radius: {{at_least: 24}}}}\n"))
    (check,) = [check for check in report.checks if check.name == "limit:pitch-radius"]
    assert check.value == pytest.approx(25.0, abs=1e-8)
    assert check.at_deg == pytest.approx(90.0, abs=1e-4) or check.at_deg == pytest.approx(270.0, abs=1e-4)
