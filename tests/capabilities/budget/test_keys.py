"""The key `budget`: what it becomes, what is refused, fits, and what the command prints."""

from __future__ import annotations

import math

import pytest
from support.budgets import CAM, budget
from support.places import ROOT

from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

YOKE = "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}\n"
FRAME = """\
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [10, 4]}
linkage: {kind: slider-crank, coupler: 75, offset: 0}
"""
SIX_BAR = """\
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [10, 4]}
linkage:
  {kind: slider-crank, coupler: 75, offset: 0, dyads: [{kind: rpr, point: [9, 0], ground: [80, 200]}]}
"""


REFUSED = [
    ("tolerances: {profil: 0.01}", CAM, "unknown dimension", "did you mean profile?"),
    ("tolerances: {base_radius: 0.01}", CAM, "shapes the contour", "give profile"),
    ("tolerances: {follower.arm.length: 0.01}", CAM, "this cam has no such dimension", "follower.offset"),
    ("tolerances: {profile: -0.01}", CAM, "below 0", "give"),
    ("tolerances: {profile: none}", CAM, "", ""),
    ("tolerances: {}", CAM, "no tolerance is given", "profile: 0.01"),
    ("tolerances: {profile: free, angle: free}", CAM, "free, and without a cost", "give cost.profile"),
    ("tolerances: {profile: 0.1}, cost: {profile: 1}", CAM, "its tolerance is stated", "free"),
    ("tolerances: {profile: free}, exponent: 2", CAM, "without a cost it has no use", "leave it out, or give cost"),
    ("tolerances: {guide: 0.1}", CAM, "the guide's place is not known", "budget.guide"),
    ("tolerances: {profile: 0.1}, cost: {guide: 2}", CAM, "the guide's place is not known", "budget.guide"),
    ("tolerances: {profile: 0.1}, cost: {bore: 2}, fit: h6", CAM, "the fit says it already", "leave it out"),
    ("tolerances: {profile: 0.1}, guide: 50", CAM, "it has no use", "leave it out"),
    ("tolerances: {profile: 0.1}, play: 0.1", CAM, "not held from both sides", "leave it out"),
    ("tolerances: {profile: 0.1, bore: 0.1}, fit: h6", CAM, "the fit says it already", "leave it out"),
    (
        "tolerances: {profile: 0.1, angle: 0.1}, fit: h6, key: {hub: JS9, shaft: P9}",
        CAM,
        "the play of the key says it already",
        "leave it out",
    ),
    ("tolerances: {profile: 0.1}, key: {hub: JS9, shaft: P9}", CAM, "needs budget.fit", "fit: h6"),
    (
        "tolerances: {profile: 0.1}, fit: h6, key: {hub: JS9, shaft: P9}",
        CAM.replace("din6885", "{standard: din6885, fit: P9}"),
        "part.keyway.fit in line 6 makes it P9",
        "give P9, or part.keyway.fit: JS9",
    ),
    ("tolerances: {profile: 0.1}, fit: h6", YOKE, "the bore has no tolerance class", "part.bore"),
    ("tolerances: {profile: 0.1}", SIX_BAR, "the influence of dyads is not known", "leave"),
    ("tolerances: {profile: 0.1}, fit: h6", CAM.replace("20, fit", "130, fit"), "reaches to 120 mm", "bore"),
]


@pytest.mark.parametrize(("body", "cam", "problem", "remedy"), REFUSED)
def test_what_is_refused_says_why_and_what_would_do(body: str, cam: str, problem: str, remedy: str) -> None:
    with pytest.raises(RecipeErrors) as caught:
        budget(body, cam)
    (error,) = caught.value.errors
    assert problem in error.problem
    assert remedy in error.remedy
    assert error.line == cam.count("\n") + 1


def test_the_remedies_do() -> None:
    for body, cam in (
        ("tolerances: {profile: 0.1}", CAM),
        ("tolerances: {profile: free, angle: free}, cost: {profile: 1, angle: 2}", CAM),
        ("tolerances: {profile: free}, cost: {profile: 1}, exponent: 2", CAM),
        ("tolerances: {guide: 0.1}, guide: 120", CAM),
        ("tolerances: {profile: 0.1}, fit: h6, key: {hub: JS9, shaft: P9}", CAM),
        (
            "tolerances: {profile: 0.1}, fit: h6, key: {hub: P9, shaft: P9}",
            CAM.replace("din6885", "{standard: din6885, fit: P9}"),
        ),
        ("tolerances: {profile: 0.1}, play: 0.3", YOKE),
        ("tolerances: {profile: 0.1}, play: 0.3", FRAME),
    ):
        assert budget(body, cam).permitted == 0.05


# needs: made
def test_the_profile_is_half_the_zone_of_measured_points() -> None:
    made = CAM + "made: {profile: 0.03}\n"
    with pytest.raises(RecipeErrors) as caught:
        budget("tolerances: {profile: 0.01}", made)
    (error,) = (one for one in caught.value.errors if one.path.startswith("budget"))
    assert str(error) == (
        "c.yaml:10:49: budget.tolerances.profile: not half of made.profile, 0.03 in line 9, which is a zone, "
        "given 0.01; give 0.015, or made.profile 0.02"
    )
    for remedied in (budget("tolerances: {profile: 0.015}", made), budget("tolerances: {profile: free}", made)):
        assert remedied.permitted == 0.05


def test_play_is_of_the_motion_and_has_its_unit() -> None:
    arms = (ROOT / "recipes" / "w-figure-5.yaml").read_text(encoding="utf-8")
    assert budget("tolerances: {profile: 0.01}, play: 0.2", arms).play == pytest.approx(math.radians(0.2))
    four_bar = (ROOT / "recipes" / "as-figure-9-1.yaml").read_text(encoding="utf-8")
    assert budget("tolerances: {profile: 0.01}, play: 0.2", four_bar).play == pytest.approx(math.radians(0.2))


def test_values_are_in_mm_and_radians() -> None:
    inches = CAM.replace("cam:", "units: inch\ncam:", 1).replace("part:", "#", 1)
    value = budget("tolerances: {profile: 0.001, angle: 0.05}, zero: -60", inches)
    assert dict(value.tolerances) == pytest.approx({"profile": 0.0254, "angle": math.radians(0.05)})
    assert value.permitted == pytest.approx(1.27)
    assert value.zero == pytest.approx(math.radians(300.0))
    arm = CAM.replace("offset: 10", "arm: {length: 65, pivot: 80}").replace("36", "34")
    assert budget("tolerances: {profile: 0.001}", arm).permitted == pytest.approx(math.radians(0.05))


def test_a_bore_with_a_class_is_round_as_any() -> None:
    plain = load_text(CAM.replace("{diameter: 20, fit: H7}", "20"), "c.yaml").part
    fitted = load_text(CAM, "c.yaml").part
    assert (fitted.bore, fitted.sides, fitted.features, fitted.fit) == (plain.bore, 0, plain.features, "H7")
    assert load_text(CAM.replace("din6885", "jis-b1301"), "c.yaml").part == fitted
    with pytest.raises(RecipeErrors, match="a round bore has no flats"):
        load_text(CAM.replace("fit: H7", "fit: H7, at: 10"), "c.yaml")
    with pytest.raises(RecipeErrors, match=r"part\.bore\.fit: missing"):
        load_text(CAM.replace(", fit: H7", ""), "c.yaml")
