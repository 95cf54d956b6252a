"""What takes its time: its stage, its seconds and Stop stand at its button, and what was made before is marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support import tab

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

# Press a button in the middle of the window; what is seen when the first stage is told is kept by the page itself: a
# call may be done before a test looks again.
SEEN = """((id) => {
  const button = byId(id).getBoundingClientRect();
  const shown = ["busy", "stop"].map((one) => byId(one).getBoundingClientRect());
  const inView = (one) => one.width && one.bottom <= innerHeight && one.top >= 0;
  const near = shown.every((one) => inView(one) && Math.abs(one.top - button.top) < 120);
  const bar = document.querySelector("#at-work progress");
  return [near && bar.offsetWidth > 0 && !byId("stop").disabled, byId("judged").className, byId("busy").textContent];
})"""
WATCHED = f"""((id) => {{
  window.seen = null;
  const watch = new MutationObserver(() => {{
    if (!byId("busy").textContent.includes(":")) return;
    window.seen = {SEEN}(id);
    watch.disconnect();
  }});
  watch.observe(byId("busy"), {{ childList: true }});
  byId(id).scrollIntoView({{ block: "center", behavior: "instant" }});
  byId(id).click();
}})"""


# needs: follow
def test_status_progress_and_stop_stand_at_the_button(page: tab.Tab, tmp_path: Path) -> None:
    text = starter("disc-roller")
    report = camgeo.export(camgeo.load(text), tmp_path, only=["dxf"])
    page.load("disc-roller", text)
    page.drop("cam.dxf", (report.path / "recipe.dxf").read_bytes())
    for name, words, width in (("verify", "judging", 1280), ("follow", "following", 390)):
        page.browser.size(width, 800)
        page.rest()  # else scrolling that goes on takes the button out of view
        page.ask(f"{WATCHED}('{name}')")
        page.wait("window.seen !== null")
        there, looks, told = page.ask("window.seen")
        assert there
        assert "older" in looks
        assert told.startswith(words)
        page.wait("!underWay")
        assert "done in" in page.text_of("busy")
        assert page.ask("byId('judged').className") == "tables"
        assert page.text_of("since") == ""
    # pressed at once, as it may be done before a test presses the other
    since = page.ask("byId('follow').click(), [byId('since').textContent, byId('stop').click()][0]")
    assert "of the run before" in since
    page.wait("byId('busy').textContent === 'stopped'")
    assert "of a run before" in page.text_of("since")
    assert "older" in page.ask("byId('judged').className")
