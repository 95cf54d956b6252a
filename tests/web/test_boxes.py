"""Boxes of numbers: they keep together what sliders do, and a fault stands at its box in the words of the page."""

from __future__ import annotations

import pytest
from support import tab

from camgeo.recipe.starter import starter

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

TEXT = starter("disc-roller")
INVALID = (
    "[...document.querySelectorAll('#form [aria-invalid=true]')].map((box) => box.parentElement.dataset.path).join()"
)
IN_VIEW = """(() => {
  const note = document.querySelector("#form .fault").getBoundingClientRect();
  return document.elementFromPoint(note.left + 5, note.top + 5)?.className;
})()"""


def test_a_box_moves_its_partner_as_the_slider_does(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    page.enter("cam.motion[0].rise", "15")
    assert "{return: 15, over: 120" in page.text
    assert "return follows: 15" in page.text_of("told")
    assert page.text_of("verdict") == "every check of the design holds"
    page.enter("cam.motion[0].rise", "1/2 in")
    assert "{rise: 1/2 in, over: 110" in page.text
    assert "{return: 12.7, over: 120" in page.text
    page.enter("cam.motion[2].over", "122,5")
    assert "{dwell: 77.5}" in page.text
    assert page.text_of("verdict") == "every check of the design holds"
    page.press("undo")  # both are one step
    assert "{dwell: 80}" in page.text
    assert "over: 120" in page.text
    page.load("rest", TEXT.replace("dwell: 80", "dwell: rest"))
    page.enter("cam.motion[0].over", "100")
    assert "{dwell: 50}" in page.text  # the rest takes it


def test_a_number_that_is_corrected_leaves_its_partner_as_it_was(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    for wrong in ("400", "abc"):
        page.enter("cam.motion[0].over", wrong)
        assert page.text_of("verdict") == "a fault in the recipe"
        page.enter("cam.motion[0].over", "110")
        assert page.text == TEXT
        assert page.text_of("verdict") == "every check of the design holds"
    page.enter("cam.motion[0].over", "abc")
    page.enter("cam.motion[0].over", "")
    assert page.ask("document.querySelector('#form .fault').textContent") == "empty: give a value"
    page.enter("cam.motion[0].over", "100")
    assert "{dwell: 60}" in page.text


def test_what_is_entered_while_the_text_is_read_is_entered_behind_that(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    for box, given, wanted in (
        ('[data-path="cam.base_radius"] .box', "value = '37'", "base_radius: 37 "),
        ('[data-path="cam.motion[0].law"] select', "value = 'cycloidal'", "over: 110, law: cycloidal}"),
        ('[data-path="export.files"] [value="3mf"]', "checked = true", "html, 3mf]"),
        ("#segment-law", "value = 'harmonic'", "over: 110, law: harmonic}"),
    ):
        page.ask(f"""(() => {{
          const box = document.querySelector({box!r});
          put(snapshot());
          box.{given};
          box.dispatchEvent(new Event("change"));
        }})()""")
        page.settle()
        assert wanted in page.text
    assert page.browser.problems == []


@pytest.mark.parametrize("width", [390, 1280])
def test_a_fault_stands_at_its_box_and_in_view(page: tab.Tab, width: int) -> None:
    page.browser.size(width, 800)
    page.load("disc-roller", TEXT)
    for path, value, told in (
        ("cam.base_radius", "-1", "not above 0, given -1"),
        ("cam.motion[0].over", "250", "the segments do not fill their angle"),
        ("cam.motion[2].return", "x", "not a number"),
    ):
        page.ask(f"document.querySelector('[data-path=\"{path}\"] .box').focus()")
        page.enter(path, value)
        assert page.ask(INVALID) == path
        assert told in page.ask("document.querySelector('#form .fault').textContent")
        assert page.ask("document.querySelector('#form [aria-invalid]').getAttribute('aria-describedby')") == page.ask(
            "document.querySelector('#form .fault').id"
        )
        assert page.ask(IN_VIEW) == "fault"
        page.press("undo")
    assert page.ask(INVALID) == ""
    assert page.ask("document.querySelectorAll('.fault').length") == 0
    page.write(TEXT.replace("rise: 20", "rise: 15"))  # in the text nothing moves along
    assert "the lift jumps from 0 to 5 mm" in page.text_of("form")
    assert page.ask(INVALID) == "cam.motion[0].rise"
