"""Links and the address: what is cut or altered is refused, a step is an entry, the last design stays."""

from __future__ import annotations

import pytest
from support import tab

from camgeo.recipe.starter import starter

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

TEXT = starter("disc-roller")
SPOILT = """(async () => {
  const whole = await packed({ name: "x", text: recipe.bare.text, tables: {} });
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  let passed = "";
  let count = 0;
  for (let i = 1; i < whole.length; i++) {
    const cut = whole.slice(0, i);
    const altered = [...letters].filter((one) => one !== whole[i]).map((one) => cut + one + whole.slice(i + 1));
    const missing = cut + whole.slice(i + 1);
    for (const hash of [cut, missing, ...altered, cut + "A" + whole.slice(i), cut + "." + whole.slice(i)]) {
      count += 1;
      if (hash.length > 1 && (isWhole(hash) || !holdsRecipe(hash))) passed += hash + "\\n";
    }
  }
  return [isWhole(whole), passed, count];
})()"""


def test_no_link_that_is_cut_or_has_another_letter_passes(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    whole, passed, count = page.ask(SPOILT)
    assert whole
    assert passed == ""
    assert count > 20000


def test_a_spoilt_link_shows_nothing_and_stays_until_a_recipe_is_begun(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    cut = page.written()[:-4]
    page.ask(f"byId('text').dispatchEvent(new Event('input')); location.hash = {cut!r}")
    page.wait("!byId('notice').hidden")
    page.ask("new Promise((done) => setTimeout(done, 150))")  # behind the letters that were typed
    page.settle()
    assert "cut or altered" in page.text_of("notice")
    assert page.text_of("verdict") == "no recipe"
    assert page.text == ""
    assert page.ask("byId('stage').querySelector('figure').children.length") == 0
    assert page.ask("byId('stage').querySelector('.controls').offsetParent === null")
    assert page.ask("document.querySelectorAll('.plot').length") == 0
    assert page.ask(
        "[...document.querySelectorAll('#main > :not(.begin, .desk)')].every((e) => e.offsetParent === null)"
    )
    page.reload()
    page.settle()
    assert page.ask("byId('notice').hidden") is False  # Python is there, and nothing comes of it
    assert page.written() == cut
    assert page.text_of("verdict") == "no recipe"
    assert page.ask("document.querySelector('#drawing')") is None
    page.ask("document.querySelector('#notice button').click()")
    page.settle()
    assert page.text == TEXT
    assert page.ask("byId('notice').hidden")
    assert page.text_of("verdict") == "every check of the design holds"
    assert page.ask(f"isWhole({page.written()!r})")


def test_a_copied_link_leaves_comments_out_and_says_so(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    page.written()
    link = page.copied()
    assert "without its comments" in page.text_of("told")
    assert len(link) < 420
    assert len(page.ask("location.href")) > 2000  # the tab's own keeps them
    name, text = page.ask(f"unpacked({link[link.index('#') :]!r}).then((held) => [held.name, held.text])")
    assert name == "disc-roller"
    assert "#" not in text
    assert "{rise: 20, over: 110, law: modified-sine}" in text
    page.ask("navigator.clipboard.writeText = async () => { throw new Error('no leave'); }")
    page.click("link")
    page.wait("byId('told').querySelector('input') !== null")
    assert page.ask("byId('told').querySelector('input').value") == link


def test_a_finished_step_is_one_entry_and_going_back_undoes_it(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    page.written()
    # the history of a browser keeps fifty entries, and other tests may have filled it: entries are counted as they come
    page.ask(
        "window.entries = 0;"
        "history.pushState = (...entry) => {entries += 1; History.prototype.pushState.apply(history, entry);}"
    )
    for value in (37, 38, 39, 40):
        page.ask(f"""(() => {{
          const slider = document.querySelector('[data-path="cam.base_radius"] [type=range]');
          slider.value = {value};
          slider.dispatchEvent(new Event("input"));
        }})()""")
        page.settle()
        page.written()
    page.ask("step = null")
    page.enter("part.bore", "12")
    page.enter("part.bore", "13")
    page.written()
    steps = page.ask("recipe.done.length")
    assert page.ask("delete history.pushState && entries") == 3
    page.ask("history.back()")
    page.wait("recipe.text.includes('bore: 12')")
    page.settle()
    page.ask("history.back()")
    page.wait("recipe.text.includes('bore: 10')")
    page.settle()
    assert "base_radius: 40" in page.text
    assert page.ask("recipe.done.length") == steps - 2
    page.ask("history.forward()")
    page.wait("recipe.text.includes('bore: 12')")
    page.settle()
    page.press("redo")
    assert "bore: 13" in page.text


def test_going_back_is_not_undone_by_an_address_that_is_still_to_be_written(page: tab.Tab) -> None:
    page.load("disc-roller", TEXT)
    for value in ("12", "13"):
        page.enter("part.bore", value)
        page.written()
    page.ask("recipe.name = 'other'; remember(); writeAddress(); history.back()")
    page.ask("writing")
    page.wait("recipe.text.includes('bore: 12')")
    page.settle()
    assert "bore: 12" in page.text


def test_a_link_is_followed_where_an_address_is_written_before_the_page_hears_of_it(page: tab.Tab) -> None:
    page.load("linked", TEXT.replace("bore: 10", "bore: 15"))
    link = page.written()
    page.load("disc-roller", TEXT)
    page.written()
    page.ask(f"recipe.name = 'other'; remember(); location.hash = {link!r}; writeAddress()")
    page.wait("recipe.name === 'linked'")
    page.settle()
    assert page.written() == link


def test_the_last_design_stays_in_this_browser_until_it_is_forgotten(page: tab.Tab) -> None:
    page.load("kept", TEXT.replace("bore: 10", "bore: 11"))
    page.written()
    with page.other() as there:
        page.wait(f"{there}?.getElementById('text')?.value.includes('bore: 11')")
        page.click("forget")
        assert page.ask("localStorage.length") == 0
        page.enter("part.bore", "14")
        page.written()
        assert page.ask("localStorage.length") == 0  # nor what comes after
    assert "Forgotten" in page.text_of("keeps")
