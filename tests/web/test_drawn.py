"""The motion drawn: joints dragged by mouse, finger and keys, at both sizes; what each keeps, and one undo for each."""

from __future__ import annotations

import re
from typing import Any

import pytest
from support import tab

import camgeo
from camgeo.recipe.starter import starter

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

DISC = starter("disc-roller")
HALF = starter("constant-breadth")
LENGTHS = {
    "units: mm": "units: inch",
    "rise: 20,": "rise: 1/2 in,",
    "return: 20,": "return: 0.5,",
    "bore: 10": "bore: 0.4",
}
LENGTHS |= {"base_radius: 36": "base_radius: 1.5", "radius: 9": "radius: 0.4", "offset: 8": "offset: 0.3"}
LENGTHS |= {"thickness: 8": "thickness: 0.3", "bore: 10": "bore: 0.4"}


PEAKS = DISC.replace("{return: 20, over: 120, law: cycloidal}", "{to: 8, over: 120}")
PEAKS = PEAKS.replace("{dwell: 80}", "{dwell: 30}\n    - {dwell: 20}\n    - {to: 0, over: 30}")


@pytest.fixture
def desk(other_page: tab.Tab) -> tab.Tab:
    """The page with a cam that stands still at 0."""
    other_page.turn_to(0)
    other_page.load("disc-roller", DISC)
    return other_page


def segments(text: str) -> list[str]:
    """The segments of a recipe as they stand in its text, without comments."""
    motion = text[text.index("  motion:") :]
    return [row.strip("-{} ") for row in re.findall(r"(?m)^ +(- .*?)(?: +#.*)?$", motion)]


def place(page: tab.Tab, joint: int) -> tuple[float, float]:
    """Middle of a joint's handle in the window, after it has come into view."""
    return page.middle(f"document.querySelector('[data-joint=\"{joint}\"]')")


def labels(page: tab.Tab) -> list[str]:
    told: list[str] = page.ask("[...document.querySelectorAll('.joint')].map((one) => one.getAttribute('aria-label'))")
    return told


def test_a_dragged_joint_keeps_the_turn_and_the_partner_and_is_one_step(desk: tab.Tab) -> None:
    assert labels(desk) == [
        "joint 1: 110°, 20 mm",
        "joint 2: 160°, 20 mm",
        "joint 3: 280°, 0 mm, in angle only",
    ]
    x, y = place(desk, 0)
    steps = desk.ask("recipe.done.length")
    desk.browser.drag([(x, y), (x - 4, y + 5), (x - 11, y + 12), (x - 20, y + 30)])
    desk.settle()
    first, dwell, back, rest = segments(desk.text)
    over, lift = int(re.search(r"over: (\d+)", first)[1]), re.search(r"rise: ([\d.]+)", first)[1]
    assert 70 < over < 100
    assert dwell == f"dwell: {160 - over}"
    assert back == f"return: {lift}, over: 120, law: cycloidal"  # falls what the first one rises
    assert rest == "dwell: 80"
    assert float(lift) * 5 == int(float(lift) * 5)  # hundredths of 20 mm
    assert desk.text_of("verdict") == "every check of the design holds"
    assert desk.text_of("draw-told") == f"Joint 1 is at {over}°, {lift} mm."
    assert desk.ask("recipe.done.length") == steps + 1
    desk.press("undo")
    assert desk.text == DISC
    assert labels(desk)[0] == "joint 1: 110°, 20 mm"


def test_values_stand_at_the_joint_while_it_is_dragged_and_only_pictures_are_made(desk: tab.Tab) -> None:
    x, y = place(desk, 0)
    mouse = {"button": "left", "buttons": 1, "clickCount": 1}
    frame = desk.ask("byId('plots').querySelector('svg').dataset.frame")
    desk.browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **mouse)
    before = desk.ask("Number(document.body.dataset.shown)")
    for i in range(1, 9):
        desk.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + i, y=y + 2 * i, **mouse)
    told = desk.ask("[byId('bubble').hidden, byId('bubble').textContent]")
    assert told[0] is False
    assert re.fullmatch(r"1\d\d°, 1\d(\.\d)? mm", told[1])
    desk.wait(f"Number(document.body.dataset.shown) > {before}")
    assert (
        desk.ask("document.querySelector('.joints .preview').getAttribute('d').length") > 500
    )  # the curve comes along
    desk.settle()  # it rests, and is judged
    assert desk.text_of("verdict") == "every check of the design holds"
    assert desk.ask("byId('plots').querySelector('svg').dataset.frame") == frame  # the scale stays in the hand
    desk.browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x + 8, y=y + 16, **mouse)
    desk.settle()
    assert desk.ask("byId('bubble').hidden")
    assert desk.ask("byId('plots').querySelector('svg').dataset.frame") != frame
    assert desk.browser.problems == []


def test_keys_move_a_joint_by_a_degree_and_a_hundredth_of_the_lift_and_finer_with_shift(desk: tab.Tab) -> None:
    desk.ask("document.querySelector('[data-joint=\"0\"]').focus()")
    for key, shift, rise, over in (
        ("ArrowRight", False, "20", "111"),
        ("ArrowUp", False, "20.2", "111"),
        ("ArrowLeft", True, "20.2", "110.9"),
        ("ArrowDown", True, "20.18", "110.9"),
    ):
        desk.browser.key(key, shift=shift)
        desk.settle()
        assert segments(desk.text)[0] == f"rise: {rise}, over: {over}, law: modified-sine"
        assert segments(desk.text)[2] == f"return: {rise}, over: 120, law: cycloidal"
        assert desk.text_of("draw-told") == f"{over}°, {rise} mm"
    assert desk.ask("document.activeElement.dataset.joint") == "0"
    assert desk.text_of("verdict") == "every check of the design holds"
    for _ in range(4):  # a press is a gesture
        desk.press("undo")
    assert desk.text == DISC


@pytest.mark.parametrize(("width", "dark"), [(390, False), (390, True), (1280, True)])
def test_two_bumps_are_drawn_by_a_finger_without_text(desk: tab.Tab, width: int, *, dark: bool) -> None:
    desk.browser.size(width, 844, dark=dark)
    desk.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
    desk.choose("segment", "3")
    desk.press("split")
    assert segments(desk.text)[3:] == ["dwell: 40", "dwell: 40"]
    for joint, wanted in ((0, 15.0), (3, 15.0)):
        x, y = place(desk, joint)
        low, high, height = desk.ask("(({low, high, height}) => [low, high, height])(frame())")
        level = desk.ask(f"ends(motion.segments)[{joint}].level")
        by = (level - wanted) / (high - low) * height
        desk.browser.touch([(x, y), (x, y + 0.3 * by), (x, y + 0.9 * by), (x, y + by)])
        desk.settle()
        lift = desk.ask(f"ends(motion.segments)[{joint}].level")
        assert abs(lift - wanted) <= 0.4  # the finger drags, and scrolls nothing
        desk.ask(f"document.querySelector('[data-joint=\"{joint}\"]').focus()")
        while (left := wanted - desk.ask(f"ends(motion.segments)[{joint}].level")) and abs(left) > 1e-6:
            step = desk.ask("hundredth(motion.segments)")
            desk.browser.key("ArrowUp" if left > 0 else "ArrowDown", shift=abs(left) < 0.99 * step)
        desk.settle()
    assert segments(desk.text) == [
        "rise: 15, over: 110, law: modified-sine",
        "dwell: 50",
        "return: 15, over: 120, law: cycloidal",
        "rise: 15, over: 40",
        "return: 15, over: 40",
    ]
    assert desk.text_of("faults") == ""
    design = camgeo.design(camgeo.load(desk.text))
    assert [round(design.motion(angle * 3.14159265358979 / 180), 6) for angle in (110, 280, 320)] == [15.0, 0.0, 15.0]
    assert desk.ask("document.documentElement.scrollWidth") <= width
    assert desk.browser.problems == []


def test_a_handle_is_large_enough_for_a_finger_and_where_two_overlap_the_nearest_is_meant(desk: tab.Tab) -> None:
    desk.browser.size(390, 844)
    sizes = desk.ask("[...document.querySelectorAll('.joint')].map((one) => [one.offsetWidth, one.offsetHeight])")
    assert sizes == [[44, 44]] * 3
    desk.write(DISC.replace("dwell: 50", "dwell: 10").replace("dwell: 80", "dwell: 120"))
    x, y = place(desk, 0)
    desk.browser.drag([(x - 3, y), (x - 10, y), (x - 23, y)])  # the second handle lies above it
    desk.settle()
    assert desk.ask("ends(motion.segments)[0].angle") < 95
    assert desk.ask("ends(motion.segments)[1].angle") == 120


KEPT = """(() => {
  let seed = 7;
  const dice = () => ((seed = (seed * 16807) % 2147483647) / 2147483647);
  const whole = motion;
  const bad = [];
  for (let round = 0; round < 400; round++) {
    let { segments } = whole;
    motion = whole;
    for (let i = 0; i < 6; i++) {
      const k = Math.floor(dice() * segments.length);
      const moved = withJoint(segments, k, 400 * dice() - 20, 60 * dice() - 20, 0.2);
      const turn = moved.reduce((sum, one) => sum + one.over, 0);
      const end = moved.reduce((sum, one) => sum + one.change, 0);
      const goes = (one) => !(one.kind in STEPPED) || STEPPED[one.kind] * one.change > 0;
      const lost = moved.some((one) => !(one.over > 0) || !goes(one));
      const low = Math.min(...ends(moved).map(({ level }) => level));
      const rests = moved.some((one) => one.kind === "dwell" && one.change);
      if (Math.abs(turn - whole.total) > 1e-6 || (whole.closed && Math.abs(end) > 1e-6) || lost || rests || low < -1e-9)
        bad.push([k, turn, end, low, JSON.stringify(moved.map(({ kind, over, change }) => [kind, over, change]))]);
      segments = moved;
      motion = { ...whole, segments };
    }
  }
  motion = whole;
  return bad.slice(0, 3);
})()"""


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("disc", DISC),
        ("half", HALF),
        ("peaks", PEAKS),
    ],
)
def test_wherever_a_joint_is_dragged_the_cycle_stays_whole(desk: tab.Tab, name: str, text: str) -> None:
    desk.load(name, text)
    assert desk.ask("motion.segments.length") == len(segments(text))
    assert desk.ask(KEPT) == []


def test_half_a_turn_keeps_its_180_degrees_and_its_end_moves_in_lift(desk: tab.Tab) -> None:
    desk.load("half", HALF)
    assert labels(desk) == ["joint 1: 120°, 20 mm", "joint 2: 180°, 20 mm, in lift only"]
    x, y = place(desk, 0)
    desk.browser.drag([(x, y), (x - 10, y), (x - 25, y + 10)])
    desk.settle()
    rise, dwell = segments(desk.text)
    over = int(re.search(r"over: (\d+)", rise)[1])
    assert over < 110
    assert dwell == f"dwell: {180 - over}"
    assert desk.text_of("verdict").startswith("every check of the design holds")


def test_a_repeated_motion_is_drawn_in_its_first_part(desk: tab.Tab) -> None:
    desk.ask("byId('repeat').value = '2'; byId('repeat').dispatchEvent(new Event('change'))")
    desk.wait("recipe.text.includes('repeat: 2')")
    desk.settle()
    assert labels(desk)[0] == "joint 1: 55°, 20 mm"
    x, y = place(desk, 0)
    desk.browser.drag([(x, y), (x, y + 10), (x, y + 25)])
    desk.settle()
    rise, dwell, back, _ = segments(desk.text)
    lift = re.search(r"rise: ([\d.]+)", rise)[1]
    assert float(lift) < 17
    assert (dwell, back) == ("dwell: 25", f"return: {lift}, over: 60, law: cycloidal")
    assert desk.text_of("verdict").startswith("every check of the design holds")


def test_a_number_with_its_own_unit_keeps_it(desk: tab.Tab) -> None:
    text = DISC
    for old, new in LENGTHS.items():
        text = text.replace(old, new)
    desk.load("inch", text)
    assert labels(desk)[0] == "joint 1: 110°, 0.5 in"
    desk.ask("document.querySelector('[data-joint=\"0\"]').focus()")
    desk.browser.key("ArrowUp")
    desk.settle()
    assert segments(desk.text)[0] == "rise: 0.505 in, over: 110, law: modified-sine"
    assert segments(desk.text)[2] == "return: 0.505, over: 120, law: cycloidal"


def test_a_valley_is_dragged_to_the_ground_and_no_further(desk: tab.Tab) -> None:
    desk.load("peaks", DISC.replace("{dwell: 80}", "{dwell: 40}\n    - {dwell: 40}"))
    x, y = place(desk, 3)
    desk.browser.drag([(x, y), (x, y - 10), (x, y - 40), (x, y + 60)])  # up, and down below where it was
    desk.settle()
    assert segments(desk.text)[3:] == ["rise: 0.2, over: 40", "return: 0.2, over: 40"]
    desk.press("undo")
    assert segments(desk.text)[3:] == ["dwell: 40", "dwell: 40"]
    x, y = place(desk, 0)
    desk.browser.drag([(x, y), (x, y + 200)])
    desk.settle()
    assert segments(desk.text)[0].startswith("rise: 0.2, over: 110")


def test_a_rise_that_is_dragged_below_its_beginning_is_a_return_with_its_law_and_comment(desk: tab.Tab) -> None:
    text = DISC.replace(
        "{rise: 20, over: 110, law: modified-sine}",
        "{rise: 12, over: 60, law: cubic}  # up\n    - rise: 8 # on\n      over: 50",
    )
    desk.load("two", text)
    press = """(() => {
      const joint = document.querySelector('[data-joint="0"]');
      for (let i = 0; i < 50; i++) joint.dispatchEvent(new KeyboardEvent("keydown", { key: "KEY", repeat: i > 0 }));
      joint.dispatchEvent(new KeyboardEvent("keyup", { key: "KEY" }));
    })()"""
    desk.ask(press.replace("KEY", "ArrowUp"))  # 0.2 mm each; at 20 the second segment would have no stroke
    desk.settle()
    assert "{rise: 22.2, over: 60, law: cubic}  # up\n    - return: 2.2 # on\n      over: 50\n" in desk.text
    assert desk.text_of("faults") == ""
    desk.ask(press.replace("KEY", "ArrowDown"))
    desk.settle()
    assert "{rise: 12, over: 60, law: cubic}  # up\n    - rise: 8 # on\n      over: 50\n" in desk.text
    assert desk.text_of("faults") == ""


def test_what_is_done_to_a_segment_is_one_step_each(desk: tab.Tab) -> None:
    steps = desk.ask("recipe.done.length")
    desk.choose("segment", "0")
    for name, count in (("split", 5), ("copy", 6), ("delete", 6), ("reverse", 6)):
        desk.press(name)
        assert desk.text_of("draw-told") == ""
        assert len(segments(desk.text)) == count
        assert desk.text_of("verdict").startswith("every check of the design holds")
    desk.turn_to(300)
    desk.press("add-joint")
    assert len(segments(desk.text)) == 7
    assert desk.ask("recipe.done.length") == steps + 5
    for _ in range(5):
        desk.press("undo")
    assert desk.text == DISC
    desk.choose("segment", "0")
    desk.press("delete")
    assert desk.text_of("draw-told") == "something must move: nothing but dwells would be left"
    assert desk.text == DISC


def test_a_law_is_chosen_for_the_segment_whose_joint_has_the_focus(desk: tab.Tab) -> None:
    desk.ask("document.querySelector('[data-joint=\"0\"]').focus()")
    assert desk.ask("[byId('segment').value, byId('segment-law').value]") == ["0", "modified-sine"]
    desk.choose("segment-law", "polynomial-345")
    desk.settle()
    assert segments(desk.text)[0] == "rise: 20, over: 110, law: polynomial-345"
    desk.ask("document.querySelector('[data-joint=\"1\"]').focus()")
    assert desk.ask("byId('segment-law').labels[0].hidden")  # a rest has none


def test_a_motion_without_segments_says_why_it_has_no_joints(desk: tab.Tab) -> None:
    desk.load("lobe", starter("disc-lobe"))
    assert desk.text_of("draw-why").startswith("The motion is a lobe")
    assert labels(desk) == []
    assert desk.ask("byId('draw-tools').hidden && byId('joints').hidden && !byId('draw').hidden")
    desk.load("support", starter("support"))
    assert "gives no motion over the shaft angle" in desk.text_of("draw-why")
    desk.load("disc-roller", DISC)
    assert len(labels(desk)) == 3
    desk.write(DISC.replace("dwell: 80", "dwell: 81"))  # a fault: there is no motion
    assert labels(desk) == []


def test_where_a_picture_waits_for_a_joint_the_newest_is_made(desk: tab.Tab) -> None:
    before: Any = desk.ask("work.number")
    desk.ask("""(() => {
      const joint = document.querySelector('[data-joint="0"]');
      const press = (kind, repeat) =>
        joint.dispatchEvent(new KeyboardEvent(kind, { key: "ArrowUp", bubbles: true, repeat }));
      for (let i = 0; i < 12; i++) press("keydown", i > 0);
      press("keyup", false);
    })()""")
    desk.settle()
    assert desk.ask("work.number") - before == 3  # as for a slider
    assert segments(desk.text)[0].startswith("rise: 22.4,")
    desk.press("undo")  # a key that is held is one gesture
    assert desk.text == DISC
