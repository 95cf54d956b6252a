"""The page of examples: ten designs that open at their place beside a kept one, and every shipped recipe as a card."""

from __future__ import annotations

import base64
import json
import re
import zlib
from typing import TYPE_CHECKING, Any

import pytest
from support import tab
from support.browser import Browser
from support.places import RECIPES, ROOT, script

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

EXAMPLES = script("lecture").EXAMPLES


def held(link: str) -> Any:
    """What an address holds; its checksum is looked at."""
    name, _, rest = link.partition("#r=")
    assert name == "index.html"
    assert zlib.crc32(rest[8:].encode()) == int(rest[:8], 16)
    packed = base64.urlsafe_b64decode(rest[8:] + "=" * (-len(rest[8:]) % 4))
    return json.loads(zlib.decompress(packed, -15))


def test_an_address_holds_recipe_kept_design_and_place() -> None:
    link_to = script("build").link_to
    text = (RECIPES / "disc-roller.yaml").read_text("utf-8")
    assert held(link_to("a", text)) == ["a", text, {}]
    assert held(link_to("a", text, ("b", "ä"), 44.5)) == ["a", text, {}, ["b", "ä", {}], 44.5]
    table = (RECIPES / "disc-table.yaml").read_text("utf-8")
    assert held(link_to("t", table))[2] == {"disc-table.csv": (RECIPES / "disc-table.csv").read_text("utf-8")}


def test_ten_shipped_recipes_are_shown_of_papers_and_of_trades() -> None:
    assert len(EXAMPLES) == len({one.recipe for one in EXAMPLES}) == 10
    there = [one for one in EXAMPLES if (RECIPES / f"{one.recipe}.yaml").is_file()]
    assert len(there) >= 6
    assert len(there) == 10  # needs: dynamics, valve, milling, linear, cylindrical
    assert sum(re.search(r"\b(19|20)\d\d\b", one.see) is not None for one in EXAMPLES) >= 3
    # needs: dynamics, valve, milling, linear, cylindrical
    assert {one.recipe.split("/")[0] for one in EXAMPLES} >= {"linear", "cylindrical", "valve-lobe", "disc-packaging"}


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with Browser(tmp_path_factory.mktemp("profile")) as one:
        yield one


def listed(browser: Browser, address: str) -> None:
    """Open the page of examples."""
    browser.leave(f"{address}examples.html")
    browser.wait("document.readyState === 'complete' && document.querySelectorAll('#gallery a').length > 0")


@pytest.mark.slow
@pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())
@pytest.mark.parametrize("width", [390, 1280])
def test_cards_are_in_reach_and_on_a_phone_one_opens_by_a_finger(browser: Browser, address: str, width: int) -> None:
    browser.size(width, 844)
    listed(browser, address)
    links = browser.ask("[...document.querySelectorAll('#lecture a')].map((one) => one.getAttribute('href'))")
    pictured = {path.stem for path in (ROOT / "docs" / "gallery").glob("*.svg")}
    cards = browser.ask("[...document.querySelectorAll('#gallery a b')].map((one) => one.textContent)")
    assert pictured >= {*cards} >= {path.stem for path in RECIPES.glob("*.yaml")}
    assert browser.ask("document.documentElement.scrollWidth") <= width
    assert browser.ask("[...document.images].every((one) => one.loading === 'lazy')")
    least = "Math.min(...[...document.querySelectorAll('.cards a')].map((one) => one.getBoundingClientRect().height))"
    assert browser.ask(least) >= 44
    if width > 390:
        return
    wanted = held(links[0])
    card = "document.querySelectorAll('#lecture a')[0]"
    page = tab.Tab(browser, address)
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
    browser.touch([page.middle(card)])
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
    page.wait("document.body?.dataset.loaded && !byId('beside').hidden")
    page.settle()
    assert page.text_of("name") == wanted[0]
    assert page.text == wanted[1]
    assert page.text_of("beside-name") == wanted[3][0]
    root = "document.documentElement.dataset"
    assert page.ask(f"[Number({root}.at), {root}.playing]") == [wanted[4], "false"]
    assert page.ask("document.querySelectorAll('#drawing .kept path').length") > 0
    page.written()
    page.click("play")
    page.wait(f"Number({root}.at) !== {wanted[4]}")
    page.enter("export.tolerance", "0.02")  # and goes on from where it is
    assert page.ask(f"{root}.playing") == "true"
    page.click("play")
    assert browser.problems == []


@pytest.mark.slow
@pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())
def test_what_examples_say_is_in_their_figures(site: Path) -> None:
    """By hand: a rise of 40 over 120 degrees by a cycloid is as steep as atan(2 * 40 / (2 pi / 3) / radius)."""
    text = (site / "examples.html").read_text("utf-8")
    assert "Pressure angle: 45.1°, dashed 37.4°" in text  # needs: cylindrical
    assert "Radius of curvature: 5 mm, dashed 1 mm" in text
    shown = re.findall(r'<li><a href="([^"]+)">', text)
    for link in shown:
        assert len(link) < 4000
        held(link)
    for name in re.findall(r'src="([^"]+\.svg)"', text):
        assert (site / name).is_file()
