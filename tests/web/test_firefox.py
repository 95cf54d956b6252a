"""The whole way through the page in Firefox: a design, its files, somebody's file, and links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support import firefox, tab
from support.drawn import polygon  # needs: follow

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path

WHY_NOT = tab.why_not() or firefox.why_not()
pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT)]


# needs: follow
def test_the_whole_way(address: str, tmp_path: Path) -> None:
    with firefox.Firefox(tmp_path / "profile") as browser:
        browser.size(390, 844)
        page = tab.Tab(browser, address).open()
        assert page.text_of("verdict") == "every check of the design holds"
        for width in (390, 768, 1280, 1920):
            browser.size(width, 800)
            assert page.ask("document.documentElement.scrollWidth") <= width
        # two bumps and the STL
        page.load("toy", starter("toy"))
        page.enter("cam.motion[0].rise", "12,5")
        assert "{return: 12.5, over: 80}" in page.text
        page.judged("make")
        assert page.text_of("outcome").startswith("toy: ok")
        links = page.ask("[...document.querySelectorAll('#files a')].map((one) => one.download).join(' ')")
        assert "toy.stl" in links.split()
        # a step back, and a link that is cut
        page.written()
        page.ask("history.back()")
        page.wait("!recipe.text.includes('12.5')")
        page.settle()
        assert page.ask("recipe.undone.length") == 1
        page.ask("location.hash = own.slice(0, -3)")
        page.wait("!byId('notice').hidden")
        assert page.text_of("verdict") == "no recipe"
        page.ask("document.querySelector('#notice button').click()")
        page.settle()
        # the motion of a polygon
        design = camgeo.design(camgeo.load(starter("disc-roller")))
        page.drop("points.dxf", polygon(tmp_path / "points.dxf", design.contour(200)).read_bytes())
        page.wait("!byId('with-file').hidden")
        page.ask("byId('radius').value = '18'; byId('offset').value = '8'")
        page.judged("follow")
        assert "acceleration of the smoothed motion" in page.text_of("outcome")
        page.ask("document.querySelector('#next button.main').click()")
        page.wait("recipe.text.includes('table:')")
        page.settle()
        assert page.text_of("verdict").startswith("every check of the design holds")
