"""Linear, cylindrical and indexing cams on the page in a browser: they move, are drawn, compared, filmed and made."""

from __future__ import annotations

import io
import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image, ImageSequence
from support import tab
from support.places import RECIPES, script

from camgeo.api.root import root_of
from camgeo.recipe.loading import load_order_text

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]


def shipped(name: str) -> str:
    return (RECIPES / f"{name}.yaml").read_text("utf-8")


@pytest.fixture
def desk(other_page: tab.Tab) -> tab.Tab:
    """The page with a cam that stands still at 0."""
    other_page.turn_to(0)
    return other_page


def place(page: tab.Tab, body: str) -> list[float]:
    """Place and angle of a body, as it is drawn."""
    told = page.ask(f"document.querySelector('#drawing {body}').getAttribute('transform')")
    return [float(part) for part in re.findall(r"-?[\d.]+", told)]


def numbers(path: str) -> Any:
    return np.array(re.findall(r"-?[\d.]+", path), dtype=float).reshape(-1, 2)


# needs: linear
@pytest.mark.parametrize("width", [390, 1280])
def test_a_plate_slides_and_its_joint_is_moved_by_a_finger(desk: tab.Tab, width: int) -> None:
    desk.browser.size(width, 844)
    desk.load("feed", shipped("linear/plate-feed"))
    assert desk.text_of("verdict") == "every check of the design holds"
    desk.turn_to(100.0)
    assert place(desk, ".cam")[:2] == pytest.approx([-100.0, 0.0])
    assert "lift 20.00 mm" in desk.text_of("now")
    desk.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
    handle = "document.querySelector('[data-joint=\"1\"]')"
    x, y = desk.middle(handle)
    across = desk.ask("frame().width") / 200.0
    desk.browser.touch([(x, y), (x + 4 * across, y), (x + 10 * across, y)])
    desk.settle()
    over, rest, lift = desk.ask("[motion.segments[1].over, motion.segments[2].over, motion.segments[1].change]")
    assert over == pytest.approx(70.0, abs=2.0)
    assert over + rest == 100.0
    assert lift == pytest.approx(20.0, abs=0.4)  # a finger is not as still
    assert over == round(over)
    desk.ask(f"{handle}.focus()")
    desk.browser.key("ArrowRight")
    desk.settle()
    assert f"rise: {lift:g}, over: {over + 1:g}" in desk.text
    assert f"{15 + over + 1:g} mm, {lift:g} mm" in desk.ask(f"{handle}.getAttribute('aria-label')")
    assert desk.ask("document.documentElement.scrollWidth") <= width
    desk.press("undo")
    desk.press("undo")
    assert desk.text == shipped("linear/plate-feed")
    desk.slide("cam.motion[2].dwell", 45.0)  # a travel has no partner that gives it
    assert desk.text == shipped("linear/plate-feed").replace("dwell: 40", "dwell: 45")
    assert desk.ask("shown.input.most") == 205
    assert desk.browser.problems == []


# needs: cylindrical
def test_a_drum_turns_and_is_unrolled_beside(desk: tab.Tab) -> None:
    text = shipped("cylindrical/drum-groove")
    desk.load("drum", text)
    desk.turn_to(75.0)
    blank = desk.ask("[...document.querySelectorAll('#drawing .drum path')].at(-1).getAttribute('d')")
    still = root_of(recipe := load_order_text(text, "drum.yaml")).shown(recipe).still(75.0)
    (drawn,) = re.findall(r'd="([^"]+)"><title>blank</title>', still)
    np.testing.assert_allclose(numbers(blank), numbers(drawn), atol=0.02)
    places = []
    for at in (0.0, 75.0):
        desk.turn_to(at)
        rolled = desk.ask("document.querySelectorAll('#development .roller-at')[1].getAttribute('transform')")
        places.append([float(part) for part in re.findall(r"[\d.]+", rolled)])
    (x0, y0), (x, y) = places
    scale = 364.0 / (100.0 * math.pi)
    lift = 40.0 * (75.0 / 120.0 - math.sin(math.radians(225.0)) / (2.0 * math.pi))
    assert (x - x0, y0 - y) == pytest.approx((364.0 * 75.0 / 360.0, scale * lift), abs=0.03)
    for width in (390, 1280):
        desk.browser.size(width, 844)
        assert desk.ask("document.documentElement.scrollWidth") <= width
    desk.ask("byId('development').scrollIntoView({block: 'center'})")  # the desk stays in view, and covers nothing
    right = desk.ask("document.querySelector('.desk').getBoundingClientRect().right")
    assert 0.0 < right <= desk.ask("byId('development').getBoundingClientRect().left")
    desk.load("toy", shipped("disc-roller"))
    assert desk.ask("byId('panels').hidden && byId('panels').children.length === 0")
    assert desk.browser.problems == []


# needs: cylindrical
def test_a_drum_is_made_judged_and_its_solid_shown_where_it_is_late_unrolled(desk: tab.Tab, tmp_path: Path) -> None:
    desk.browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    desk.load("drum", shipped("cylindrical/drum-end"))
    desk.judged("make")
    assert "ok" in desk.text_of("outcome")
    files = desk.ask("[...document.querySelectorAll('#files a')].map((one) => one.download)")
    assert {"drum.stl", "drum.3mf", "drum.dxf", "drum.csv", "report.json"} <= {*files}
    desk.ask("""work.ask = ((ask) => async function (call, ...rest) {
      if (call === "solid") await new Promise((done) => (window.goOn = done));
      return ask.call(this, call, ...rest);
    })(work.ask)""")
    desk.click("solid")
    desk.wait("!byId('solid-meanwhile').hidden")
    assert desk.ask("byId('solid-unrolled').querySelectorAll('.line').length") >= 2
    assert desk.ask("document.querySelectorAll('#development').length") == 1
    desk.ask("goOn()")
    desk.wait("!byId('solid-figure').hidden")
    assert desk.ask("byId('solid-meanwhile').hidden")
    assert desk.text_of("solid-size").startswith("80 × 80 × ")
    assert b"unrolled at a radius of 40 mm" in desk.saved("pdf", tmp_path / "drum.pdf")
    assert desk.browser.problems == []


# needs: linear
def test_a_plate_is_made_and_its_judged_page_is_let_in(desk: tab.Tab) -> None:
    desk.load("groove", shipped("linear/plate-groove").replace("files: [dxf, stl, html]", "files: [dxf, stl]"))
    desk.judged("make")
    assert "groove.stl cannot be made in a browser" in desk.text_of("outcome")
    desk.worked("solid")
    assert "manifold3d" in desk.text_of("hand-told")  # cuts the groove
    desk.load(
        "rack",
        shipped("linear/plate-endless").replace(
            "  holes: [{at: [12.5, 6], diameter: 4.3}, {at: [62.5, 6], diameter: 4.3}]\n", ""
        ),
    )
    desk.judged("make")
    desk.worked("solid")
    assert desk.text_of("solid-size").startswith("75 × 18 × 8 mm")  # three waves, 15 and 3 high
    assert desk.browser.problems == []


# needs: cylindrical
def test_a_kept_drum_turns_along_in_its_own_size(desk: tab.Tab) -> None:
    text = shipped("cylindrical/drum-end")
    desk.load("drum", text)
    desk.press("keep")
    desk.wait("document.querySelector('#drawing .kept .metal') !== null")
    desk.enter("cam.radius", "44")
    wide = "document.querySelector('#drawing {} .metal').getBBox().width"
    assert desk.ask(wide.format(".kept")) == pytest.approx(80.0, abs=0.01)
    assert desk.ask(wide.format(".drum")) == pytest.approx(88.0, abs=0.01)
    before = desk.ask("document.querySelector('#drawing .kept .metal').getAttribute('d')")
    desk.turn_to(45.0)
    assert desk.ask("document.querySelector('#drawing .kept .metal').getAttribute('d')") != before
    assert desk.ask("document.querySelectorAll('.plot .line.kept').length") >= 4


# needs: linear
def test_a_kept_plate_stands_at_the_same_travel_and_its_curves_too(desk: tab.Tab) -> None:
    text = shipped("linear/plate-feed")
    desk.load("feed", text)
    desk.press("keep")
    desk.wait("document.querySelector('#drawing .kept') !== null")
    desk.enter("cam.motion[0].dwell", "115")
    assert desk.ask("shown.input.most") == 300
    desk.turn_to(150.0)
    plates = desk.ask(
        "[...document.querySelectorAll('#drawing .kept > g')].map((one) => one.getAttribute('transform'))"
    )
    assert sum(one.startswith("translate(-150.000000 ") for one in plates if one) == 1
    kept = numbers(desk.ask("document.querySelector('.plot .line.kept').getAttribute('d')"))
    now = numbers(desk.ask("document.querySelector('.plot .line:not(.kept)').getAttribute('d')"))
    left, right = now[0, 0], now[-1, 0]
    assert kept[-1, 0] == pytest.approx(left + (right - left) * 200.0 / 300.0, abs=0.2)
    desk.load("disc", shipped("disc-roller"))  # a turn is compared by its share, and has no common axis
    assert desk.ask("document.querySelectorAll('.plot .line.kept').length") == 0
    desk.press("unkeep")


# needs: linear
def test_a_link_stands_at_its_place_though_the_plate_before_it_was_shorter(desk: tab.Tab) -> None:
    disc = shipped("disc-roller")
    link = script("build").link_to("disc", disc, ("kept", disc), 300.0)
    desk.load("feed", shipped("linear/plate-feed"))  # of 200 mm
    desk.ask(f"location.hash = {link[link.index('#') :]!r}")
    desk.wait("recipe.name === 'disc'")
    desk.settle()
    assert desk.ask("Number(document.documentElement.dataset.at)") == 300.0


# needs: cylindrical
def test_a_film_of_a_drum_turns_it(desk: tab.Tab, tmp_path: Path) -> None:
    desk.browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    text = shipped("cylindrical/drum-end").replace("[stl, 3mf, ", "[").replace(", {csv: {as: flank}}", "")
    desk.load("film", text)
    desk.judged("make")
    film = Image.open(io.BytesIO(desk.saved("gif", tmp_path / "film.gif")))
    pictures = [np.asarray(one.convert("RGB")).astype(int) for one in ImageSequence.Iterator(film)]
    metal = "getComputedStyle(document.querySelector('#drawing .drum .metal')).fill"
    colour = [int(part) for part in re.findall(r"\d+", desk.ask(metal))]
    blank = [(np.abs(picture - colour).sum(axis=2) < 3) for picture in pictures]
    beside = pictures[0].shape[1] // 4  # of the roller and its carriage
    tops = [one[:, beside].argmax() for one in blank]  # where the metal begins: the end face rises and falls
    assert len({*tops}) > 5
    assert np.corrcoef(tops[:36], tops[36:])[0, 1] > 0.95  # twice a turn


# needs: indexing
@pytest.mark.parametrize(("name", "at", "step"), [("index-barrel", 60.0, 45.0), ("index-globoid", 150.0, 36.0)])
def test_an_indexing_cam_advances_its_turret(desk: tab.Tab, name: str, at: float, step: float) -> None:
    """Both are a third of their rise on, by a modified sine, from half a step below the middle."""
    text = shipped(f"indexing/{name}")
    desk.load("dial", text)
    assert desk.text_of("verdict") == "every check of the design holds"
    desk.turn_to(at)
    rib = desk.ask("[...document.querySelectorAll('#drawing .indexer path')].at(-1).getAttribute('d')")
    still = root_of(recipe := load_order_text(text, "dial.yaml")).shown(recipe).still(at)
    (drawn,) = re.findall(r'd="([^"]+)"><title>rib</title>', still)
    np.testing.assert_allclose(numbers(rib), numbers(drawn), atol=0.02)
    share = (2.0 + math.pi / 3.0 - 2.25 * math.sin(7.0 * math.pi / 9.0)) / (4.0 + math.pi)
    told = re.search(r"turret ([−\d.]+)°", desk.text_of("now"))
    assert told is not None
    assert float(told[1].replace("−", "-")) == pytest.approx(step * (share - 0.5), abs=0.01)
    titles = desk.ask("[...document.querySelectorAll('.plot b')].map((one) => one.textContent)")
    assert titles == ["Turret", "Velocity", "Acceleration", "Pressure angle", "Rollers engaged"]
    engaged = desk.ask("[...document.querySelectorAll('.plot')].at(-1).querySelector('.value').textContent")
    assert re.fullmatch(r"lower flank [123], upper flank [123]", engaged)
    assert desk.ask("document.querySelector('#development') !== null") == (name == "index-barrel")
    for width in (390, 1280):
        desk.browser.size(width, 844)
        assert desk.ask("document.documentElement.scrollWidth") <= width
    assert desk.browser.problems == []


# needs: indexing, cylindrical
def test_a_cam_with_fewer_rollers_follows_another(desk: tab.Tab) -> None:
    """Its picture is there before its development, which is still that of the other cam."""
    for name in ("cylindrical/drum-rib", "cylindrical/drum-groove", "indexing/index-barrel", "indexing/index-globoid"):
        desk.load("cam", shipped(name))
        assert desk.text_of("verdict").startswith("every check of the design holds")
    assert desk.ask("document.querySelector('#development') === null")
    assert desk.browser.problems == []


# needs: indexing
def test_rollers_of_a_dial_run_along_its_development(desk: tab.Tab) -> None:
    """At rest two of them stand 60 sin(22.5) = 22.96 mm off the middle, whose distance is the sum of their heights."""
    desk.load("dial", shipped("indexing/index-barrel"))
    scale = 364.0 / (100.0 * math.pi)
    for at in (180.0, 270.0):
        desk.turn_to(at)
        told = desk.ask(
            "[...document.querySelectorAll('#development .roller-at')].map((one) => one.getAttribute('transform'))"
        )
        places = np.array([re.findall(r"-?[\d.]+", one) for one in told], dtype=float)
        offset = 30.0 * (1.0 + math.cos(math.pi / 8.0)) - 60.0 * math.cos(math.pi / 8.0)
        for z in (45.0 - 60.0 * math.sin(math.pi / 8.0), 45.0 + 60.0 * math.sin(math.pi / 8.0)):
            wanted = 46.0 + 364.0 * (at / 360.0 + math.asin(offset / 50.0) / math.tau), 8.0 + scale * (90.0 - z)
            assert np.abs(places - wanted).max(axis=1).min() < 0.03


# needs: indexing
def test_an_indexing_cam_is_made_judged_compared_and_filmed(desk: tab.Tab, tmp_path: Path) -> None:
    desk.browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    text = shipped("indexing/index-globoid")
    desk.load("globoid", text)
    desk.judged("make")
    assert "ok" in desk.text_of("outcome")
    files = desk.ask("[...document.querySelectorAll('#files a')].map((one) => one.download)")
    assert {"globoid.stl", "globoid.csv", "report.json"} <= {*files}
    desk.worked("solid")
    # 2 (100 - sqrt(60^2 - 36^2)) = 104 mm, where no track cuts the rim
    assert re.match(r"[\d.]+ × 104 × 72 mm", desk.text_of("solid-size"))
    desk.press("keep")
    desk.wait("document.querySelector('#drawing .kept .metal') !== null")
    desk.enter("part.length", "66")
    tall = "document.querySelector('#drawing {} .metal').getBBox().height"
    assert desk.ask(tall.format(".kept")) == pytest.approx(72.0, abs=0.01)
    assert desk.ask(tall.format(".indexer")) == pytest.approx(66.0, abs=0.01)
    before = desk.ask("document.querySelector('#drawing .kept .metal').getAttribute('d')")
    desk.turn_to(200.0)
    assert desk.ask("document.querySelector('#drawing .kept .metal').getAttribute('d')") != before
    desk.press("unkeep")
    film = Image.open(io.BytesIO(desk.saved("gif", tmp_path / "globoid.gif")))
    pictures = [np.asarray(one.convert("RGB")).astype(int) for one in ImageSequence.Iterator(film)]
    moved = [int((np.abs(one - pictures[0]).sum(axis=2) > 30).sum()) for one in pictures]
    assert max(moved) > 1000
    assert desk.browser.problems == []


def test_what_is_not_seen_or_shall_not_move_stands_still(desk: tab.Tab) -> None:
    desk.load("disc", shipped("disc-roller"))
    desk.click("play")
    at = "Number(document.documentElement.dataset.at)"
    rest = "new Promise((done) => setTimeout(done, 400))"
    desk.ask("Object.defineProperty(document, 'hidden', { value: true, configurable: true })")
    desk.ask("document.dispatchEvent(new Event('visibilitychange'))")
    before = desk.ask(at)
    desk.ask(rest)
    assert desk.ask(at) == before
    assert desk.text_of("play") == "Pause"  # it goes on as soon as it is seen
    desk.ask("delete document.hidden")
    desk.ask("document.dispatchEvent(new Event('visibilitychange'))")
    desk.wait(f"{at} !== {before}")
    began = desk.ask(f"[performance.now(), {at}]")
    desk.ask("new Promise((done) => setTimeout(done, 1500))")
    ended = desk.ask(f"[performance.now(), {at}]")
    turned = (ended[1] - began[1]) % 360
    assert turned <= 1.3 * 36.0 * (ended[0] - began[0]) / 1000.0  # 6 turns a minute, and not twice that
    calm = [{"name": "prefers-reduced-motion", "value": "reduce"}]
    desk.browser.call("Emulation.setEmulatedMedia", features=calm)
    desk.wait("byId('play').textContent === 'Play'")
    before = desk.ask(at)
    desk.ask(rest)
    assert desk.ask(at) == before


def test_a_kind_is_chosen_among_the_starters(desk: tab.Tab) -> None:
    desk.ask("byId('begin').open = true")
    desk.wait("document.querySelectorAll('#shipped li').length > 0")
    names = desk.ask("[...document.querySelectorAll('.starters li')].map((one) => one.dataset.name)")
    assert {"linear", "linear-groove", "plate-feed"} <= {*names}  # needs: linear
    assert {"cylindrical", "cylindrical-end", "drum-rib"} <= {*names}  # needs: cylindrical
    assert {"indexing-barrel", "indexing-globoid", "index-barrel"} <= {*names}  # needs: indexing
    loose = desk.ask("[...document.querySelectorAll('.starters img')].map((one) => one.getAttribute('src'))")
    assert len({*loose}) == len(loose)


def test_every_shipped_kind_has_its_style_and_player_on_the_page(site: Path) -> None:
    code, style = ((site / name).read_text("utf-8") for name in ("page.js", "tab.css"))
    for path in (path for kind in ("linear", "cylindrical", "indexing") for path in RECIPES.glob(f"{kind}/*.yaml")):
        recipe = load_order_text(path.read_text("utf-8"), str(path))
        rules, player = root_of(recipe).shown(recipe).looks()
        assert rules in style
        assert player in code
