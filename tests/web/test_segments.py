"""Segments of a motion as the page draws them, and changed in the recipe's text: the motion that comes of it.

Holds: camgeo.motions.stated.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.places import script

import camgeo
from camgeo.recipe.starter import starter
from camgeo.schema.yaml_source import Source

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

live = script("live")
DISC = starter("disc-roller")
HALF = starter("constant-breadth")
TURN = np.linspace(0.0, 2.0 * np.pi, 721)
COMMENTED = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  # the motion
  motion:  # of one turn
    - rise: 3/4 in  # up
      over: 110
    # at the top
    - {dwell: 70}  # a rest
      # of the machine
    - {return: 3/4 in, over: 180, law: cycloidal}  # down
"""
PEAKS = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  motion: [{to: 12, over: 80}, {to: 4, over: 60, law: cycloidal}, {dwell: 40}, {rise_fall: 6, over: 120},
    {to: 0, over: 60}]
"""


@pytest.fixture(autouse=True)
def folders(tmp_path: Path) -> Iterator[None]:
    """Of each test its own: in a browser nobody else is there."""
    with pytest.MonkeyPatch.context() as patch:  # designs stay shared: what is patched makes none
        patch.setattr(live, "FOLDER", str(tmp_path))
        yield


def changed(text: str, change: str, index: int = 0, at: float = 0.0) -> dict[str, Any]:
    given = {"name": "x", "text": text, "change": change, "index": index, "at": at}
    answer: dict[str, Any] = json.loads(live.answer("with_segments", json.dumps(given)))
    assert "trace" not in answer, answer["trace"]
    return answer


def refusal(*given: Any) -> str:
    (fault,) = changed(*given)["faults"]
    told: str = fault["told"]
    return told


def lifts(text: str) -> Any:
    return camgeo.design(camgeo.load(text)).motion(TURN)


def segments(text: str) -> list[tuple[str, float, float]]:
    """As the page is told, without the checks and the scene of `live.design`, which has them too."""
    motion = live.drawn(Source.of(text, "x"), live._shown(live._recipe("x", text)).motion())
    assert motion["why"] == ""
    return [(one["kind"], one["over"], one["change"]) for one in motion["segments"]]


def test_segments_are_drawn_as_the_motion_runs() -> None:
    motion = live.design("x", PEAKS)["motion"]
    assert (motion["path"], motion["total"], motion["closed"], motion["repeat"]) == ("cam.motion", 360.0, True, 1)
    assert segments(PEAKS) == [
        ("to", 80.0, 12.0),
        ("to", 60.0, -8.0),
        ("dwell", 40.0, 0.0),
        ("rise_fall", 120.0, 0.0),
        ("to", 60.0, -4.0),
    ]
    assert motion["segments"][3]["shape"][12] == 1.0  # 64 u³ (1 - u)³ at the middle
    shape = motion["segments"][1]["shape"]
    u = np.linspace(0.0, 1.0, len(shape))
    assert shape == pytest.approx(u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi), abs=1e-4)  # cycloidal
    half = live.design("x", HALF)["motion"]
    assert (half["total"], half["closed"], half["start"]) == (180.0, False, 0.0)


@pytest.mark.parametrize(
    ("motion", "why"),
    [
        ("{formula: 6*(1 - cos(t))}", "The motion is a formula, which is changed in its box."),
        ("{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}", "The motion is a lobe, whose lift and angles"),
        ("{points: [[0, 0], [90, 8], [180, 8], [270, 0]]}", "The motion is a spline through points"),
        ("{table: [[0, 0], [90, 5], [180, 8], [270, 5]], reading: 0.5}", "The motion is a table: its rows"),
    ],
)
def test_a_motion_of_another_source_says_why_there_is_nothing_to_drag(motion: str, why: str) -> None:
    text = re.sub(r"(?s)motion:.*", f"motion: {motion}\n", PEAKS)
    answer = live.design("x", text)
    assert answer["faults"] == []
    assert answer["motion"]["why"].startswith(why)
    assert refusal(text, "split").startswith(why)


def test_other_cams_and_linkages_say_so_too() -> None:
    for name, why in (("support", "gives no motion over the shaft angle"), ("four-bar", "what the linkage makes")):
        assert why in live.design("x", starter(name))["motion"]["why"]


def test_a_joint_is_added_where_the_shaft_is_and_halves_a_segment() -> None:
    text = changed(DISC, "add", 0, 300.4)["text"]
    assert "{dwell: 20}\n    - {dwell: 60}" in text
    assert lifts(text) == pytest.approx(lifts(DISC), abs=1e-9)  # two rests are one
    text = changed(DISC, "split", 0)["text"]
    assert segments(text)[:2] == [("rise", 55.0, 10.0), ("rise", 55.0, 10.0)]
    text = changed(DISC, "add", 0, 60.0)["text"]
    (_, first, lift), (_, second, rest), *_ = segments(text)
    assert (first, second, lift + rest) == (60.0, 50.0, 20.0)
    assert lift == pytest.approx(float(camgeo.design(camgeo.load(DISC)).motion(np.radians(60.0))), abs=0.11)
    text = changed(PEAKS, "split", 3)["text"]
    assert [one[:2] for one in segments(text)[3:5]] == [("rise", 60.0), ("return", 60.0)]
    text = changed(PEAKS, "split", 1)["text"]
    assert segments(text)[1:3] == [("to", 30.0, -4.0), ("to", 30.0, -4.0)]
    assert "{to: 8, over: 30, law: cycloidal}, {to: 4, over: 30, law: cycloidal}" in text
    repeated = changed(DISC, "repeat", 0, 3)["text"]
    assert segments(changed(repeated, "add", 0, 240.0 + 110.0)["text"])[3][0] == "dwell"  # of the third time


def test_a_copy_shares_the_angle_and_its_partner_moves_as_much_as_both() -> None:
    answer = changed(DISC, "copy", 0)
    assert answer["chosen"] == 1
    assert segments(answer["text"])[:4] == [
        ("rise", 55.0, 20.0),
        ("rise", 55.0, 20.0),
        ("dwell", 50.0, 0.0),
        ("return", 120.0, -40.0),
    ]
    assert segments(changed(HALF, "copy", 0)["text"])[:2] == [("rise", 60.0, 20.0), ("rise", 60.0, 20.0)]


def test_a_segment_is_deleted_and_the_cycle_stays_whole() -> None:
    assert segments(changed(DISC, "delete", 1)["text"]) == [
        ("rise", 110.0, 20.0),
        ("return", 170.0, -20.0),
        ("dwell", 80.0, 0.0),
    ]
    copied = changed(DISC, "copy", 0)["text"]
    assert segments(changed(copied, "delete", 0)["text"])[:3] == [
        ("dwell", 55.0, 0.0),
        ("rise", 55.0, 20.0),
        ("dwell", 50.0, 0.0),
    ]
    bump = DISC.replace("{dwell: 80}", "{rise: 5, over: 40}\n    - {return: 5, over: 40}")
    assert segments(changed(bump, "delete", 3)["text"]) == segments(DISC)  # both go, and rest
    assert segments(changed(bump, "delete", 4)["text"]) == segments(DISC)
    lower = DISC.replace("{rise: 20, over: 110", "{rise: 15, over: 60}\n    - {rise: 5, over: 50")
    assert segments(changed(lower, "delete", 1)["text"])[:3] == [
        ("rise", 60.0, 15.0),
        ("dwell", 100.0, 0.0),
        ("return", 120.0, -15.0),
    ]


def test_a_motion_is_repeated_and_comes_back() -> None:
    text = changed(DISC, "repeat", 0, 3)["text"]
    once, thrice = (camgeo.design(camgeo.load(one)) for one in (DISC, text))
    assert thrice.motion(TURN / 3.0 + 2.0) == pytest.approx(once.motion(TURN + 6.0), abs=1e-6)
    assert "repeat: 3" in text
    again = changed(text, "repeat", 0, 1)["text"]
    assert lifts(again) == pytest.approx(lifts(DISC), abs=1e-6)
    flow = changed(PEAKS, "repeat", 0, 2)["text"]
    assert "motion: {repeat: 2, segments: [{to: 12, over: 40}" in flow


@pytest.mark.parametrize("text", [DISC, PEAKS, COMMENTED], ids=["disc", "peaks", "commented"])
def test_a_motion_runs_backwards(text: str) -> None:
    back = changed(text, "reverse", 0)["text"]
    assert lifts(back) == pytest.approx(lifts(text)[::-1], abs=1e-7)
    assert lifts(changed(back, "reverse", 0)["text"]) == pytest.approx(lifts(text), abs=1e-7)


def test_half_a_turn_backwards_rises_as_it_did_and_rests_first() -> None:
    back = lifts(changed(HALF, "reverse", 0)["text"])
    forth = lifts(HALF)
    assert back[:361] == pytest.approx(forth[360] - forth[360::-1], abs=1e-9)


def test_comments_stay_and_go_along() -> None:
    text = changed(COMMENTED, "reverse", 0)["text"]
    assert text == COMMENTED.replace(
        """\
    - rise: 3/4 in  # up
      over: 110
    # at the top
    - {dwell: 70}  # a rest
      # of the machine
    - {return: 3/4 in, over: 180, law: cycloidal}  # down
""",
        """\
    - {rise: 3/4 in, over: 180, law: cycloidal}  # down
    - {dwell: 70}  # a rest
      # of the machine
    - return: 3/4 in  # up
      over: 110
    # at the top
""",
    )
    for change, index, at in (("split", 1, 0), ("copy", 0, 0), ("repeat", 0, 2), ("add", 0, 200.0)):
        new = changed(COMMENTED, change, index, at)["text"]
        assert re.findall("#.*", new) == re.findall("#.*", COMMENTED)
        assert live.design("x", new)["faults"] == []


def test_a_rise_and_fall_that_is_split_keeps_its_comment() -> None:
    text = DISC.replace("{dwell: 80}", "rise_fall: 5  # a tick\n      over: 80 # of the clock")
    new = changed(text, "split", 3)["text"]
    assert "- rise: 5  # a tick\n      over: 40 # of the clock\n    - {return: 5, over: 40}\n" in new


SHORT = DISC.replace("dwell: 50", "dwell: 1").replace("dwell: 80", "dwell: 129")
FREE = DISC.replace("over: 110,", "over: least,").replace("dwell: 80", "dwell: rest") + (
    "limits: {pressure-angle: {at_most: 28}}\n"
)


@pytest.mark.slow
def test_an_angle_that_is_left_open_is_drawn_and_stays_open() -> None:
    source, stated = Source.of(FREE, "x"), live._shown(camgeo.load(FREE)).motion()
    motion = live.drawn(source, stated)
    assert [one["free"] for one in motion["segments"]] == [True, False, False, True]
    assert sum(one["over"] for one in motion["segments"]) == pytest.approx(360.0, abs=1e-6)
    for change, told in (("split", "the angle of this segment is left open"), ("repeat", "an angle is left open")):
        with pytest.raises(camgeo.CallError, match=told):
            live.changed(source, stated, change, 0, 2.0)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ((DISC, "delete", 0), "something must move: nothing but dwells would be left"),
        ((DISC, "repeat", 0, 0), "give a whole number from 1 to 100"),
        ((HALF, "repeat", 0, 2), "this cam's motion fills half a turn, and the other half follows from it"),
        ((HALF, "add", 0, 200.0), "the motion is given up to 180 degrees; what follows comes of it"),
        ((DISC, "split", 9), "choose a segment first"),
        (
            (SHORT, "split", 1),
            "this segment is shorter",
        ),
        ((PEAKS, "delete", 0), "the cycle would not close: change this segment as text"),
        ((HALF.replace("law: modified-sine", "law: modified-sine, split: 0.3"), "reverse"), "segment 1 has a law that"),
    ],
)
def test_what_cannot_be_is_told_in_words(given: tuple[Any, ...], told: str) -> None:
    assert refusal(*given).startswith(told)


def test_figures_of_a_kept_design_are_those_of_the_library() -> None:
    answer = live.beside("x", DISC)
    figures = camgeo.design(camgeo.load(DISC)).figures
    assert {row["name"]: row["unit"] for row in answer["figures"]} == {name: one.unit for name, one in figures.items()}
    shown = {row["name"]: row for row in answer["figures"]}
    assert shown["size"]["value"] == pytest.approx(figures["size"].value, rel=1e-12)
    assert (shown["hollow-radius"]["value"], shown["hollow-radius"]["text"]) == (None, "∞")
    assert live.design("x", DISC)["figures"] == []
    assert live.design("x", DISC, figures=True)["figures"] == answer["figures"]
