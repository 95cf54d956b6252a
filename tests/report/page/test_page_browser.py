"""The page in a headless Chromium: no error, the right movement, keys, dragging, nothing over anything else."""

from __future__ import annotations

import html
import json
import math
import re
import threading
import time
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from support.browser import Browser, executable
from support.pages import SHAFT, SHOWN, Made, fetched, of, put, wait
from support.rendered import rendered, share

import camgeo
from camgeo.cli.watch import watch
from camgeo.recipe.starter import starter
from camgeo.report.page.page import page
from camgeo.synthesis.design import designed
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(
    executable() is None, reason="no browser here: install chromium, or name one in CAMGEO_BROWSER"
)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Any:
    with Browser(tmp_path_factory.mktemp("profile")) as found:
        found.size(1280, 800)
        yield found


def opened(browser: Browser, made: Made, tmp_path: Path, at: str = "#deg=0") -> Browser:
    path = tmp_path / "page.html"
    path.write_text(made.text, encoding="utf-8")
    browser.problems.clear()
    browser.requests.clear()
    browser.open(path.as_uri() + at)
    return browser


PLACE = """(() => {{
  const bodies = [...document.querySelectorAll('#drawing .body')];
  const body = bodies.find((g) => g.querySelector('title').textContent === {!r});
  return body.getAttribute('transform').match(/-?[0-9.]+/g).map(Number);
}})()"""
SLIDE = """(() => {{
  const slider = document.getElementById('slider');
  slider.value = {};
  slider.dispatchEvent(new Event('input'));
}})()"""


@pytest.mark.thin(16)
@pytest.mark.parametrize("name", SHOWN)
def test_the_slider_moves_the_follower_by_the_right_amount(browser: Browser, tmp_path: Path, name: str) -> None:
    made = of(name)
    page_ = opened(browser, made, tmp_path)
    design = designed(made.recipe)
    for degrees in (0.0, 33.3, 90.1, 151.7, 288.8, 359.9):
        page_.ask(SLIDE.format(degrees))
        assert page_.ask("document.documentElement.dataset.at") == f"{degrees:.4f}"
        shaft = np.array([math.radians(degrees)])
        if design.driven is not None:
            mechanism = design.driven.mechanism
            wanted = mechanism.at(mechanism.relative(shaft), 0).output[0, 0]
            stroke = mechanism.figures().swing
            got = output_of(page_, made)
        elif made.recipe.name in {"w-law", "w-ellipse"}:
            half = 0.5 if made.recipe.name == "w-ellipse" else 1.0
            wanted = half * design.exact.law.psi_of_shaft(shaft, 0)[0, 0]
            stroke = half * np.ptp(design.exact.law.psi_of_shaft(SHAFT, 0)[0])
            sense = 1.0 if made.recipe.rotation == "ccw" else -1.0
            got = sense * math.radians(page_.ask(PLACE.format("arm" if half == 1.0 else "pair of faces"))[2])
        else:
            wanted = design.exact.law.derivatives(shaft, 0)[0, 0]
            stroke = np.ptp(design.exact.law.derivatives(SHAFT, 0)[0])
            got = page_.ask(PLACE.format("yoke"))[0]
        assert got == pytest.approx(wanted, abs=1e-3 * stroke), degrees
    assert page_.problems == []
    assert {address.partition("#")[0] for address in page_.requests} <= {
        (tmp_path / "page.html").as_uri(),
        *("about:blank", "data:,"),
    }


def output_of(page_: Browser, made: Made) -> float:
    """Output of a linkage as the drawing shows it, rad or mm."""
    name = {"six-bar": "output of dyad 1", "slider-crank": "slide", "oscillating-yoke": "frame"}.get(
        made.recipe.name, "rocker"
    )
    x, _, angle = page_.ask(PLACE.format(name))
    turned = math.radians(angle)
    if name == "slide":
        return float(x) * made.recipe.mm
    if made.recipe.name == "six-bar":
        return -turned  # mirrored
    return math.pi / 2 - turned if name == "frame" else math.pi - turned


def test_keys_and_buttons_turn_the_shaft(browser: Browser, tmp_path: Path) -> None:
    page_ = opened(browser, of("shu-wu"), tmp_path)

    def degrees() -> float:
        return float(page_.ask("document.documentElement.dataset.at"))

    for key, shift, expected in (
        *(("ArrowRight", False, 1.0), ("ArrowRight", True, 11.0), ("ArrowLeft", False, 10.0)),
        *(("End", False, 360.0), ("Home", False, 0.0), ("ArrowLeft", False, 359.0)),
    ):
        page_.key(key, shift=shift)
        assert degrees() == pytest.approx(expected)
    page_.key(" ")
    assert page_.ask("document.documentElement.dataset.playing") == "true"
    begun = degrees()
    page_.wait(f"Math.abs(document.documentElement.dataset.at - {begun}) > 2")
    page_.key(" ")
    assert page_.ask("document.getElementById('play').textContent") == "Play"
    still = degrees()
    time.sleep(0.2)
    assert degrees() == still
    # the place of a check
    goal = float(page_.ask("(() => { const b = document.querySelector('.go'); b.click(); return b.dataset.at; })()"))
    assert degrees() == pytest.approx(goal, abs=1e-3)
    assert page_.problems == []


@pytest.mark.thin(2)
@pytest.mark.parametrize(("name", "sense"), [("shu-wu", -1.0), ("w-law", 1.0)])
def test_the_cam_can_be_dragged(browser: Browser, tmp_path: Path, name: str, sense: float) -> None:
    page_ = opened(browser, of(name), tmp_path)
    x, y, one = page_.ask(
        "(() => { const m = document.querySelector('#drawing > g').getScreenCTM(); return [m.e, m.f, m.a]; })()"
    )
    reach = 13.0 * one  # within the metal of either cam, between the bore and what is cut round it
    angles = np.radians(np.linspace(100.0, 150.0, 9))
    page_.drag([(x + reach * math.cos(a), y - reach * math.sin(a)) for a in angles])
    degrees = float(page_.ask("document.documentElement.dataset.at"))
    assert (sense * degrees) % 360.0 == pytest.approx(50.0, abs=1.0)


@pytest.mark.slow
@pytest.mark.parametrize(("width", "dark"), [(360, False), (1280, True), (1600, False)])
@pytest.mark.parametrize("name", ["shu-wu", "six-bar", "w-law"])
def test_nothing_sticks_out_or_lies_over_its_neighbour(
    browser: Browser, tmp_path: Path, name: str, width: int, *, dark: bool
) -> None:
    made = of(name)
    browser.size(width, 740, dark=dark, mobile=width < 500)
    try:
        page_ = opened(browser, made, tmp_path)
        assert page_.ask("document.documentElement.scrollWidth") <= width
        overlapping = page_.ask("""(() => {
          const boxes = [...document.querySelectorAll('main > *, .left > *, .plot, .controls > *')]
            .filter((e) => e.offsetParent).map((e) => [e, e.getBoundingClientRect()]);
          const found = [];
          for (const [a, p] of boxes) for (const [b, q] of boxes) {
            if (a === b || a.contains(b) || b.contains(a) || p.width * p.height * q.width * q.height === 0) continue;
            const w = Math.min(p.right, q.right) - Math.max(p.left, q.left);
            const h = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
            if (w > 1 && h > 1) found.push(a.outerHTML.slice(0, 80) + ' | ' + b.outerHTML.slice(0, 80));
          }
          return found;
        })()""")
        assert overlapping == []
        ticks = page_.ask("""[...document.querySelectorAll('.plot svg')].filter((plot) => {
          const boxes = [...plot.querySelectorAll('text')].map((t) => t.getBoundingClientRect());
          return boxes.some((p, i) => boxes.some((q, j) => i < j && p.right > q.left && q.right > p.left
            && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 3));
        }).length""")
        assert ticks == 0
        assert page_.problems == []
    finally:
        browser.size(1280, 800)


@pytest.mark.slow
def test_values_along_an_axis_differ_where_they_are_nearly_the_same(browser: Browser, tmp_path: Path) -> None:
    text = re.sub(r"rise: 20|return: 20", lambda mark: mark[0].replace("20", "0.05"), starter("disc-roller"))
    report = camgeo.export(camgeo.load(text), tmp_path, only=["html"])
    browser.problems.clear()
    browser.open((report.path / "recipe.html").as_uri())
    told = browser.ask("""[...document.querySelectorAll('.plot svg')].map((plot) =>
      [...plot.querySelectorAll('text[text-anchor=end]')].map((text) => text.textContent))""")
    assert any(len(label) > 6 for labels in told for label in labels)
    assert all(len(set(labels)) == len(labels) for labels in told), told


@pytest.mark.slow
def test_the_axes_are_named_with_their_units(browser: Browser, tmp_path: Path) -> None:
    made = of("as-figure-9-2a")
    page_ = opened(browser, made, tmp_path)
    texts = "[...plot.querySelectorAll('.axis')].map((text) => text.textContent)"
    axes = page_.ask(f"[...document.querySelectorAll('.plot svg')].map((plot) => {texts})")
    over = ["relative" if plot.get("over") else "shaft" for plot in made.data["plots"]]
    over += ["relative"] * len(made.data["errors"])
    assert [x for _, x in axes] == [f"{name} angle, °" for name in over]
    assert {"relative", "shaft"} == set(over)
    assert [y for y, _ in axes][:3] == ["output, °", "velocity, °/rad", "acceleration, °/rad²"]
    units = [plot["unit"] for plot in made.data["plots"]]
    assert all(y.endswith(unit) for (y, _), unit in zip(axes, units, strict=False))
    assert all(re.match(r"[a-z ]+, ", y) for y, _ in axes)


# needs: dynamics
@pytest.mark.slow
def test_a_force_begins_at_0_and_nothing_is_0_without_digits(browser: Browser, tmp_path: Path) -> None:
    """The lowest line of a pressure that is never 0 is at 0, that of an error that is 0 at its tolerance."""
    path = tmp_path / "even.yaml"
    path.write_text(
        "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8},"
        " motion: [{rise: 10, over: 180, law: cycloidal}, {return: 10, over: 180, law: cycloidal}]}\n"
        "part: {thickness: 10}\ndynamics: {mass: 1, preload: 300, rate: 0, rpm: 30, material: steel}\n",
        encoding="utf-8",
    )
    made = Made(path)
    (error,) = made.content.errors
    exact = replace(made.content, errors=(replace(error, low=0.0 * error.low, high=0.0 * error.high),))
    made.text = page(made.recipe, exact, made.outcome.report)
    page_ = opened(browser, made, tmp_path)
    first = """Object.fromEntries([...document.querySelectorAll('.plot')].map((plot) => [
      plot.querySelector('b').textContent,
      [[...plot.querySelectorAll('svg text')].map((text) => text.textContent),
       plot.querySelector('.value').textContent],
    ]))"""
    shown = page_.ask(first)
    for title in ("Contact force", "Contact pressure"):
        assert shown[title][0][0] == "0"
    texts, value = shown["Error of even.dxf"]
    assert value == "0 µm"
    assert "tolerance 1" in texts
    assert "but for rounding on the exact contour" in page_.ask("document.getElementById('error-note').textContent")
    assert page_.problems == []


@pytest.mark.slow
def test_the_error_goes_round_each_flank(browser: Browser, tmp_path: Path) -> None:
    """Each file's error of each surface is plotted between its tolerances, and is chosen round that surface."""
    path = tmp_path / "groove.yaml"
    path.write_text(
        "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8}, track: {groove: {depth: 5}},"
        " motion: [{rise: 10, over: 180, law: cycloidal}, {return: 10, over: 180, law: cycloidal}]}\n"
        "part: {thickness: 10, outer: 130}\nexport: {tolerance: 0.002, files: [dxf]}\nverify: {angles: 36}\n",
        encoding="utf-8",
    )
    made = Made(path)
    page_ = opened(browser, made, tmp_path)
    names = ["groove.dxf, inner", "groove.dxf, outer"]
    assert page_.ask("[...document.getElementById('error-file').options].map((option) => option.value)") == names
    texts = "[...plot.querySelectorAll('svg text')].map((text) => text.textContent)"
    shown = page_.ask(
        "Object.fromEntries([...document.querySelectorAll('.plot')].map((plot) =>"
        f" [plot.querySelector('b').textContent, {texts}]))"
    )
    assert all("tolerance 2" in shown[f"Error of {name}"] for name in names)
    for name, radius in zip(names, (30.0, 46.0), strict=True):  # at 0 degrees: the base circle, and the roller beyond
        note, place, band = page_.ask(f"""(() => {{
          const chosen = document.getElementById('error-file');
          chosen.value = {name!r};
          chosen.dispatchEvent(new Event('change'));
          const [place, band] = ['.place', '.band'].map((kind) => document.querySelector('#ring ' + kind));
          const at = [place.getAttribute('cx'), place.getAttribute('cy')].map(Number);
          return [document.getElementById('error-note').textContent, at, band.getAttribute('d')];
        }})()""")
        assert note.startswith(f"{name}, up to ")
        assert "its tolerance of 2 µm (dashed)" in note
        assert math.hypot(*place) == pytest.approx(radius, abs=0.01)
        x, y = (float(number) for number in re.findall(r"-?[0-9.]+", band)[:2])
        assert math.hypot(x, y) == pytest.approx(radius, abs=6.0)
    assert page_.problems == []


@pytest.mark.slow
def test_each_plot_is_saved_as_a_picture_by_itself(browser: Browser, tmp_path: Path) -> None:
    page_ = opened(browser, of("as-figure-9-2a"), tmp_path)
    page_.ask("""(() => {
      window.saved = [];
      const made = URL.createObjectURL;
      URL.createObjectURL = (blob) => { window.saved.push(blob); return made.call(URL, blob); };
      HTMLAnchorElement.prototype.click = function () { window.named = [...(window.named || []), this.download]; };
      for (const button of document.querySelectorAll('.plot .save')) button.click();
    })()""")
    pictures = page_.ask("Promise.all(window.saved.map((blob) => blob.text()))")
    assert len(pictures) == page_.ask("document.querySelectorAll('.plot').length")
    assert page_.ask("window.named")[1] == "as-figure-9-2a-velocity.svg"
    for picture in pictures:
        root = ET.fromstring(picture)
        assert not re.search(r"var\(|class=|<style", picture)
        assert any("angle, °" in (element.text or "") for element in root.iter())
    image = rendered(pictures[1])
    assert share(image, "#ffffff") > 0.5
    assert share(image, "#1f5f99") > 0.001  # the curve
    assert page_.problems == []


@pytest.mark.slow
def test_the_address_leads_to_an_angle_and_follows_it(browser: Browser, tmp_path: Path) -> None:
    page_ = opened(browser, of("shu-wu"), tmp_path, "#deg=75")
    page_.ask("location.hash = '#deg=120'")
    page_.wait("document.documentElement.dataset.at === '120.0000'")
    page_.key("ArrowRight")
    page_.wait("location.hash === '#deg=121'")
    assert page_.problems == []


@pytest.mark.slow
def test_on_a_phone_the_drawing_stays_in_sight(browser: Browser, tmp_path: Path) -> None:
    browser.size(390, 844, mobile=True)
    try:
        page_ = opened(browser, of("shu-wu"), tmp_path)
        for part in (".plot:nth-of-type(3)", ".plots .rests", ".checks"):
            page_.ask(f"document.querySelector('{part}').scrollIntoView({{block: 'center'}})")
            box = [
                page_.ask(f"document.querySelector('figure').getBoundingClientRect().{e}") for e in ("top", "bottom")
            ]
            assert box[0] == pytest.approx(0.0, abs=1.0)
            assert 150.0 < box[1] < 0.4 * 844
        assert page_.problems == []
    finally:
        browser.size(1280, 800)


LATE = """(() => {
  const Plain = EventSource;
  window.EventSource = function (address) {
    window.hear = () => {
      new Plain(address).onmessage = (message) => this.onmessage(message);
    };
  };
})()"""


@pytest.mark.slow
def test_a_watched_page_reloads_itself_where_it_stood_and_shows_a_fault(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    text = of("shu-wu").text
    path.write_text(text, encoding="utf-8")
    address: list[str] = []
    stop = threading.Event()

    def exported() -> tuple[str | None, str]:
        if stop.is_set():
            raise KeyboardInterrupt
        found = path.read_text(encoding="utf-8")
        return (found, "") if "<h1>" in found else (None, "a.yaml:1:1: <nothing>")

    def run() -> None:
        with pytest.raises(KeyboardInterrupt):
            watch([path], exported, address.append)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        wait(lambda: bool(address))
        wait(lambda: "<h1>" in fetched(address[0]))
        browser.problems.clear()
        browser.open(address[0] + "#deg=45")
        browser.wait("document.getElementById('fault')?.hidden")
        assert browser.ask("document.querySelectorAll('th a').length") > 0
        assert browser.ask("document.querySelectorAll('th a[href]').length") == 0  # the server has no files
        put(path, "half")
        browser.wait("document.getElementById('fault').textContent === 'a.yaml:1:1: <nothing>'")
        assert not browser.ask("document.getElementById('fault').hidden")
        put(path, text.replace("<h1>shu-wu</h1>", "<h1>another</h1>"))
        browser.wait("document.querySelector('h1')?.textContent === 'another'")
        browser.wait("document.documentElement.dataset.at === '45.0000'")
        # saved again before the page hears of anything
        late = browser.call("Page.addScriptToEvaluateOnNewDocument", source=LATE)["identifier"]
        browser.open(address[0] + "#deg=45")
        put(path, text.replace("<h1>shu-wu</h1>", "<h1>third</h1>"))
        wait(lambda: "<h1>third</h1>" in fetched(address[0]))
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=late)
        browser.ask("hear()")
        browser.wait("document.querySelector('h1')?.textContent === 'third'")
        assert browser.problems == []
        browser.call("Page.navigate", url="about:blank")
    finally:
        stop.set()
        put(path, "")
        thread.join(20)
    assert not thread.is_alive()


@pytest.mark.slow
def test_it_prints_and_follows_the_colours(browser: Browser, tmp_path: Path) -> None:
    page_ = opened(browser, of("as-figure-9-2a"), tmp_path)
    assert page_.pdf().startswith(b"%PDF")
    ground = "getComputedStyle(document.body).backgroundColor"
    light = page_.ask(ground)
    page_.size(1280, 800, dark=True)
    assert page_.ask(ground) != light
    page_.size(1280, 800)
    assert page_.problems == []


UNDERCUT = "cam: {kind: support, p: 10 + 2*cos(3*t)}\npart: {thickness: 5}\n"


@pytest.mark.slow
def test_one_player_shows_one_scene_after_another(browser: Browser, tmp_path: Path) -> None:
    """What a program plays is a design's scene; what was shown before is gone, and hears of nothing."""
    made = of("shu-wu")
    held = replace_once(made.text, "playScene(JSON", "window.endScene = playScene(JSON")
    page_ = opened(browser, made, tmp_path)
    (tmp_path / "page.html").write_text(held, encoding="utf-8")
    page_.open((tmp_path / "page.html").as_uri() + "#deg=0")
    other = camgeo.design(camgeo.load(UNDERCUT)).scene()
    page_.ask(f"(() => {{ endScene(); window.endScene = playScene({json.dumps(other)}); return 1; }})()")
    plots = page_.ask("[...document.querySelectorAll('#plots figcaption b')].map((b) => b.textContent)")
    assert plots == [plot["title"] for plot in other["plots"]]
    assert page_.ask("document.querySelectorAll('#drawing .body').length") == len(other["bodies"])
    assert page_.ask("document.querySelectorAll('#drawing .mark.failed').length") > 0
    assert page_.ask("document.querySelector('#drawing .mark title').textContent").startswith(
        "radius-of-curvature: -6 mm"
    )
    assert page_.ask("document.getElementById('errors').hidden")
    page_.ask(SLIDE.format(90))
    assert page_.ask("document.documentElement.dataset.at") == "90.0000"
    page_.key("ArrowRight")
    assert page_.ask("document.documentElement.dataset.at") == "91.0000"  # one player hears the key
    assert page_.problems == []


@pytest.mark.slow
def test_a_frame_without_an_origin_shows_the_page(browser: Browser, tmp_path: Path) -> None:
    """Its address cannot be written there; the page turns all the same."""
    hear = "<script>addEventListener('error', (event) => parent.postMessage(event.message, '*'))</script></head>"
    turn = (
        "<script>const slider = document.getElementById('slider'); slider.value = 90;"
        "slider.dispatchEvent(new Event('input')); const told = () => document.documentElement.dataset.at;"
        "setTimeout(() => parent.postMessage(told(), '*'), 600);</script></body>"
    )
    text = replace_once(replace_once(of("shu-wu").text, "</head>", hear), "</body>", turn)
    note = "addEventListener('message', (event) => document.title += event.data + ';')"
    frame = f'<iframe sandbox="allow-scripts" srcdoc="{html.escape(text)}"></iframe>'
    outer = f'<!DOCTYPE html><html data-ready="true"><head><script>{note}</script></head><body>{frame}</body></html>'
    (tmp_path / "outer.html").write_text(outer, encoding="utf-8")
    browser.open((tmp_path / "outer.html").as_uri())
    browser.wait("document.title.includes('90.0000')")
    assert browser.ask("document.title") == "90.0000;"


def replace_once(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1
    return text.replace(old, new)
