"""A motion by a lobe: its nose, its cam card, and the two sides."""

import math
import re

import numpy as np
import pytest
from support.motion_recipes import FLAT, lift, rad, read_motion, recipe

import camgeo
from camgeo.output import pipeline
from camgeo.schema.errors import RecipeErrors
from kin.law.sources.lobe import lobe


def test_a_lobe_stands_in_the_middle_of_a_part_of_a_turn_and_at_0_of_a_whole_one(tmp_path):
    text = "{lobe: {lift: 3, half: 60, powers: [2, 8, 14, 20, 26]}}"
    plain = lobe(3.0, rad(60), (2, 8, 14, 20, 26))
    off = np.array([0.0, 10.0, 35.0, 59.0, 75.0])
    expected = plain.derivatives(np.radians(off), 0)[0]
    made = recipe(text, tmp_path)
    assert lift(made, 90 + off)[0] == pytest.approx(expected, abs=1e-13)
    assert lift(made, 90 - off)[0] == pytest.approx(expected, abs=1e-13)
    whole = read_motion(text).motion(2 * math.pi, "motion", 1)
    assert whole.derivatives(np.radians(off), 0)[0] == pytest.approx(expected, abs=1e-13)


CARD = "duration: [{at_lift: 1.27 mm, degrees: 228}, {at_lift: 0.15, degrees: 270}]"


@pytest.mark.slow
def test_a_card_is_met_by_the_figure_and_told_in_a_remark(tmp_path):
    read = recipe(f"{{lobe: {{lift: 9.2, {CARD}}}}}", tmp_path, head=FLAT)
    report = dict(camgeo.check(read))
    (told,) = [remark for remark in report["remarks"] if remark["name"] == "cam-card"]
    assert re.fullmatch(r"the card is met by .* over [\d.]+ degrees of the cam on either side", told["sentence"])
    assert "table" not in report
    inch = recipe(f"{{lobe: {{lift: 9.2/25.4, {CARD.replace('0.15', '0.15/25.4')}}}}}", tmp_path, FLAT, units="inch")
    assert tappet(inch) == pytest.approx(tappet(read), abs=1e-9)


def tappet(read):
    """Lifts at every five degrees."""
    return camgeo.design(read).motion(np.radians(np.arange(0.0, 360.0, 5.0)))


@pytest.mark.slow
def test_sides_take_what_they_lack_from_the_lobe(tmp_path):
    shape = "lift: 9.2, half: 66, powers: [2, 8, 14, 20, 26], ramp: {height: 0.2, velocity: 0.02}"
    even = recipe(f"{{lobe: {{{shape}}}}}", tmp_path, head=FLAT)
    same = recipe(f"{{lobe: {{{shape}, opening: {{half: 66}}, closing: {{}}}}}}", tmp_path, head=FLAT)
    uneven = recipe(f"{{lobe: {{{shape}, closing: {{half: 70}}}}}}", tmp_path, head=FLAT)
    assert tappet(same) == pytest.approx(tappet(even), abs=0)
    assert tappet(uneven)[37:] == pytest.approx(tappet(even)[37:], abs=0)
    assert (tappet(uneven)[1:14] > tappet(even)[1:14]).all()


FAULTS = [
    (
        "lift: 9",
        "cam.motion.lobe: needs powers or duration; give half and powers, or duration: [{at_lift: 1.27 mm, ",
        "lift: 9, duration: [{at_lift: 1.27 mm, degrees: 228}]",
    ),
    (
        "lift: 9, powers: [2, 8, 14, 20, 26]",
        "cam.motion.lobe: powers need half; give half, an angle above 0 up to 180 in degrees",
        "lift: 9, powers: [2, 8, 14, 20, 26], half: 66",
    ),
    (
        f"lift: 9, half: 66, powers: [2, 8, 14, 20, 26], {CARD}",
        "cam.motion.lobe.duration: cannot be combined with powers; give exactly one of them",
        f"lift: 9, {CARD}",
    ),
    (
        f"lift: 9, closing: {{{CARD}}}",
        "cam.motion.lobe: needs powers or duration",
        f"lift: 9, {CARD}",
    ),
    (
        "lift: 9, duration: {at_lift: 12, degrees: 228}",
        "cam.motion.lobe.duration[0].at_lift: a lift of a card lies between 0 and the lift of the lobe",
        "lift: 9, duration: {at_lift: 1.2, degrees: 228}",
    ),
    (
        f"lift: 9.2, {CARD.replace('270}', '250}, {at_lift: 5, degrees: 140}')}",
        "cam.motion.lobe.duration: no lobe of the family is above these lifts for so long; the nearest has ",
        "",
    ),
]


def test_faults_of_a_card_are_told_as_it_is_read(tmp_path):
    for keys, message, _ in FAULTS[:-2]:  # the last ones are of the motion
        with pytest.raises(RecipeErrors) as caught:
            recipe(f"{{lobe: {{{keys}}}}}", tmp_path, head=FLAT)
        assert message in str(caught.value)


@pytest.mark.thin(6)
@pytest.mark.parametrize(("lobe", "message", "remedy"), FAULTS)
def test_faults_of_a_card_and_what_mends_them(lobe, message, remedy, tmp_path):
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe(f"{{lobe: {{{lobe}}}}}", tmp_path, head=FLAT))
    assert message in str(caught.value)
    if not remedy:
        nearest = re.search(r"has ([\d.]+), ([\d.]+), ([\d.]+) degrees", str(caught.value)).groups()
        remedy = lobe
        for written, told in zip(("228", "250", "140"), nearest, strict=True):
            remedy = remedy.replace(written, told)
    pipeline.check(recipe(f"{{lobe: {{{remedy}}}}}", tmp_path, head=FLAT))
