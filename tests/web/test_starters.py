"""Starters as somebody seeks them: by what they are for, in the order of use, and "nothing found" said."""

from __future__ import annotations

import json

import pytest
from support import tab

from camgeo.recipe.starter import starter

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

FOUND = "[...document.querySelectorAll('#starters li:not([hidden])')].map((one) => one.dataset.name).join(' ')"


def sought(page: tab.Tab, words: str) -> str:
    page.ask(f"byId('find').value = {json.dumps(words)}; byId('find').dispatchEvent(new Event('input'))")
    names: str = page.ask(FOUND)
    return names


def test_starters_are_found_by_what_people_say(page: tab.Tab) -> None:
    page.load("disc-roller", starter("disc-roller"))
    page.ask("byId('begin').open = true")
    page.wait("document.querySelectorAll('#shipped li').length > 0")
    assert sought(page, "").split()[:3] == ["disc-roller", "toy", "disc-flat"]
    for words, name in (
        ("one roller, spring", "disc-roller"),
        ("two bumps, hand cranked", "toy"),
        ("automaton", "toy"),
        ("valve lobe", "disc-lobe"),
        ("Wunderlich", "double-roller-law"),
        ("Reuleaux", "reuleaux"),
        ("oscillating", "disc-arm"),
        ("desmodromic", "disc-groove"),
        ("prime circle", "disc-roller"),
    ):
        assert sought(page, words).split()[0] == name, words
    assert page.text_of("found") == ""
    assert sought(page, "geneva wheel") == ""
    assert "Nothing is found" in page.text_of("found")
    assert page.ask("byId('shipped-head').hidden")
    found = sought(page, "prime circle")
    toggled = "byId('begin').dispatchEvent(new Event('toggle'))"  # opened again before the list has come
    page.ask(f"byId('starters').replaceChildren(); byId('shipped').replaceChildren(); {toggled}; {toggled}")
    page.wait("listing === null")
    assert page.ask(FOUND) == found  # of words that stood there before the list came
    sought(page, "")
    page.ask("document.querySelector('#starters [data-name=toy] button').click()")
    page.settle()
    assert page.text_of("verdict") == "every check of the design holds"
    assert "tolerance: 0.02" in page.text


def test_a_law_by_default_is_shown_and_written_when_another_is_chosen(page: tab.Tab) -> None:
    page.load("toy", starter("toy"))
    law = "document.querySelector('[data-path=\"cam.motion[0].law\"] select')"
    assert page.ask(f"{law}.selectedOptions[0].textContent") == "modified-sine (by default)"
    page.ask(f"{law}.value = 'cycloidal'; {law}.dispatchEvent(new Event('change'))")
    page.settle()
    assert "- {rise: 15, over: 80, law: cycloidal}" in page.text
    assert page.ask(f"{law}.selectedOptions[0].textContent") == "cycloidal"
    assert page.text_of("verdict") == "every check of the design holds, 1 remark"  # on the jump of acceleration


@pytest.mark.parametrize("width", [390, 1280])
def test_a_value_is_added_in_view(page: tab.Tab, width: int) -> None:
    page.browser.size(width, 800)
    page.load("disc-roller", starter("disc-roller"))
    page.ask("byId('add').querySelector('summary').scrollIntoView({block: 'end'})")
    page.ask("byId('add').querySelector('summary').click()")
    page.wait("byId('add-path').options.length > 5")
    page.wait("""(() => {
      const box = byId("add-it").getBoundingClientRect();
      return byId("add-it").contains(document.elementFromPoint(box.left + 5, box.top + 5));
    })()""")
