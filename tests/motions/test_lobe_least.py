"""What is least of a lobe that meets its cam card: the words, the faults, and the remedy of a face too narrow."""

from __future__ import annotations

import pytest

import camgeo
from camgeo.schema.errors import RecipeErrors

CAM = """\
cam:
  kind: disc
  base_radius: 24
  follower: {kind: flat, width: WIDTH}
  motion: {lobe: {lift: 8.2, duration: {at_lift: 1.27, degrees: 228}, nose: 180MORE}}
limits: {peak-acceleration: {at_least: 0}}
"""


def checked(width: float, more: str = "") -> camgeo.Report:
    return camgeo.check(camgeo.load(CAM.replace("WIDTH", f"{width}").replace("MORE", more)))


@pytest.mark.slow
def test_a_narrower_face_does_where_the_velocity_is_least() -> None:
    """The remedy of the check is tried: the face holds, and the acceleration pays for it."""
    usual = checked(60.0)
    (wide,) = [check.value for check in usual.checks if check.name == "face-width"]
    (bent,) = [check.value for check in usual.checks if check.name == "limit:peak-acceleration"]
    narrow = 0.995 * wide
    short = checked(narrow)
    (check,) = [check for check in short.checks if check.name == "face-width"]
    assert not check.ok
    assert "or cam.motion.lobe.least: face" in short.explain(check)
    eased = checked(narrow, ", least: face")
    assert eased.ok
    assert next(check.value for check in eased.checks if check.name == "limit:peak-acceleration") > bent
    assert "of least peak velocity" in eased["remarks"][0]["sentence"]
    same = checked(narrow, ", least: velocity")
    assert [check.value for check in same.checks] == [check.value for check in eased.checks]
    again = checked(0.9 * narrow, ", least: face")
    (check,) = [check for check in again.checks if check.name == "face-width"]
    assert "least: face" not in again.explain(check)


def test_what_is_least_belongs_to_a_card_and_a_face_to_a_flat_follower() -> None:
    powers = CAM.replace("duration: {at_lift: 1.27, degrees: 228}", "half: 68, powers: [2, 8, 14, 20, 26]")
    with pytest.raises(RecipeErrors, match=r"lobe\.least: belongs to a lobe by its durations; leave it out"):
        camgeo.load(powers.replace("WIDTH", "60").replace("MORE", ", least: velocity"))
    roller = CAM.replace("kind: flat, width: WIDTH", "kind: roller, radius: 10")
    with pytest.raises(RecipeErrors, match="no flat face on a stem, given 'face'; give velocity or acceleration"):
        camgeo.load(roller.replace("MORE", ", least: face"))
    camgeo.load(roller.replace("MORE", ", least: velocity"))
    with pytest.raises(RecipeErrors, match="given 'jerk'; give acceleration, velocity or face"):
        camgeo.load(roller.replace("MORE", ", least: jerk"))
