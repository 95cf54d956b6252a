"""A design kept beside the others: dashed in drawing and plots in one scale, its figures in a table, also in a link."""

from __future__ import annotations

import numpy as np
import pytest
from support import tab

import camgeo
from camgeo.recipe.starter import starter

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

DISC = starter("disc-roller")
WIDE = """(() => {
  const box = (name) => document.querySelector(name).getBoundingClientRect();
  const [kept, now] = [box("#drawing .kept .metal"), box("#drawing .cam .metal")];
  return [kept.height, now.height];
})()"""


@pytest.fixture
def desk(other_page: tab.Tab) -> tab.Tab:
    """The page with a cam that stands still at 0, with none kept."""
    other_page.load("first", DISC)
    other_page.turn_to(0)
    return other_page


def keep(page: tab.Tab) -> None:
    page.press("keep")
    page.wait("!byId('beside').hidden && document.querySelector('#drawing .kept') !== null")
    page.settle()


def row(page: tab.Tab, name: str) -> list[str]:
    told = (
        "[...document.querySelectorAll('#beside-rows tr')].map((row) => [...row.cells].map((cell) => cell.textContent))"
    )
    return next(cells[1:] for cells in page.ask(told) if cells[0] == name)


@pytest.mark.parametrize(("width", "dark"), [(390, True), (1280, False)])
def test_a_kept_design_stands_dashed_in_one_scale_with_its_figures(desk: tab.Tab, width: int, *, dark: bool) -> None:
    desk.browser.size(width, 844, dark=dark)
    keep(desk)
    assert desk.text_of("beside-name") == "first"
    assert row(desk, "swing") == ["20 mm", "20 mm", "same"]
    desk.enter("cam.base_radius", "18")
    kept, now = desk.ask(WIDE)
    contours = [camgeo.design(camgeo.load(text)).contour(2000) for text in (DISC, desk.text)]
    heights = [float(np.ptp(points[:, 1])) for points in contours]
    assert kept / now == pytest.approx(heights[0] / heights[1], rel=5e-3)  # one scale for both
    scale = kept / heights[0]
    desk.enter("cam.base_radius", "22")
    assert desk.ask(WIDE)[0] / heights[0] == pytest.approx(scale, rel=1e-6)  # and it stays
    desk.enter("cam.base_radius", "18")
    figures = [camgeo.design(camgeo.load(text)).figures["size"].value for text in (DISC, desk.text)]
    shown = row(desk, "size")
    assert [float(cell.split()[0]) for cell in shown[:2]] == pytest.approx(figures, rel=1e-4)
    assert float(shown[2].replace("−", "-")) == pytest.approx(figures[1] - figures[0], rel=5e-3)
    assert desk.ask("document.querySelectorAll('.plot .line.kept').length") >= 5
    assert desk.ask("document.documentElement.scrollWidth") <= width
    desk.press("unkeep")
    assert desk.ask("byId('beside').hidden && document.querySelectorAll('.kept').length === 0")
    assert desk.ask("document.activeElement.id") == "keep"
    desk.press("undo")
    desk.wait("!byId('beside').hidden && document.querySelector('#drawing .kept') !== null")
    assert desk.browser.problems == []


def test_a_kept_design_turns_along(desk: tab.Tab) -> None:
    keep(desk)
    desk.enter("cam.motion[0].rise", "30")
    place = "document.querySelectorAll('#drawing .kept > g')[{}].getAttribute('transform')"
    count = desk.ask("document.querySelectorAll('#drawing .kept > g').length")
    still = [desk.ask(place.format(i)) for i in range(count)]
    desk.turn_to(110)
    turned = [desk.ask(place.format(i)) for i in range(count)]
    assert sum(a != b for a, b in zip(still, turned, strict=True)) >= 2  # the cam and its follower
    assert sum("rotate(110.0" in one or "rotate(-110.0" in one for one in turned) == 1


def test_a_link_carries_the_kept_design_to_another_tab(desk: tab.Tab) -> None:
    keep(desk)
    desk.load("second", DISC.replace("base_radius: 36", "base_radius: 44"))
    assert desk.text_of("beside-name") == "first"  # it stays beside another recipe
    link = desk.copied()
    assert "and the kept design" in desk.text_of("told")
    with desk.other(link[link.index("#") :]) as there:
        desk.wait(f"{there}?.querySelector('#drawing .kept') && !{there}.getElementById('beside').hidden")
        told = desk.ask(
            f"[{there}.getElementById('beside-name'), {there}.getElementById('name')].map((one) => one.textContent)"
        )
        assert told == ["first", "second"]
        assert "base_radius: 44" in desk.ask(f"{there}.getElementById('text').value")


def test_a_reload_keeps_it_and_a_step_back_takes_it_away(desk: tab.Tab) -> None:
    keep(desk)
    desk.enter("part.bore", "12")
    desk.written()
    desk.reload()
    desk.wait("byId('beside').hidden === false")
    desk.settle()
    assert desk.text_of("beside-name") == "first"
    desk.press("unkeep")
    desk.written()
    desk.ask("history.back()")
    desk.wait("byId('beside').hidden === false")
    desk.settle()
    assert desk.ask("recipe.beside.name") == "first"


def test_a_kept_design_in_inches_is_as_large_as_in_millimetres(desk: tab.Tab) -> None:
    keep(desk)
    desk.choose("unit", "inch")
    desk.wait("recipe.text.includes('units: inch')")
    desk.settle()
    kept, now = desk.ask(WIDE)
    assert kept == pytest.approx(now, rel=1e-3)
