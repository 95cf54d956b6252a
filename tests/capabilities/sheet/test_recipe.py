"""The tolerance zone that a shop drawing states, among those of other capabilities."""

from __future__ import annotations

import pytest

from camgeo.recipe.loading import load_text

CAM = """\
cam: {kind: support, p: 25 + 2*cos(3*t)}
part: {thickness: 8, bore: 10}
export: {files: [dxf, {sheet: {profile: 0.05, paper: A3}}]}
"""
STATED = ("export.files[1].sheet.profile", 0.05)


def test_a_drawing_that_states_a_width_gives_the_zone() -> None:
    recipe = load_text(CAM, "cam.yaml")
    assert recipe.zone == pytest.approx(STATED)
    assert recipe.profile == 0.05
    inches = load_text(f"units: inch\n{CAM}", "cam.yaml")
    assert inches.profile == pytest.approx(1.27)
    assert load_text(CAM.replace("profile: 0.05, ", ""), "cam.yaml").zone is None


# needs: made
def test_the_zone_of_a_made_part_counts_before_that_of_a_drawing() -> None:
    recipe = load_text(f"{CAM}made: {{profile: 0.04}}\n", "cam.yaml")
    assert recipe.zones == (("made.profile", 0.04), STATED)


# needs: budget
def test_a_drawing_counts_before_a_budget_whose_zone_is_twice_plus_and_minus() -> None:
    text = f"{CAM}budget: {{permitted: 0.1, tolerances: {{profile: 0.015}}}}\n"
    assert load_text(text, "cam.yaml").zones == (STATED, ("budget.tolerances.profile", 0.03))
