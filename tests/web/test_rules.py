"""The page by the rules of axe, where that is installed: npm's axe-core in the folder of Pyodide."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from support import pyodide, tab
from support.browser import GONE_OVER, Browser

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path

AXE = pyodide.folder() / "node_modules" / "axe-core" / "axe.min.js"
WHY_NOT = tab.why_not() or ("" if AXE.is_file() else f"no axe-core here: npm install it in {pyodide.folder()}")

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT)]

FAILING = """axe.run(document, { iframes: false, resultTypes: ["violations"] }).then((found) => JSON.stringify(
  found.violations.map(({ id, nodes }) => [id, nodes.map((node) => node.target.join(" "))])))"""


def test_no_rule_fails_on_the_judged_page(tmp_path: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    report = camgeo.export(camgeo.load(starter("disc-roller")), tmp_path, only=["html", "stl"])
    with Browser(tmp_path_factory.mktemp("judged")) as browser:
        browser.open((report.path / "recipe.html").as_uri())
        browser.ask(f"{AXE.read_text('utf-8')};1")
        for width in (390, 1280):
            for dark in (False, True):
                browser.size(width, 844, dark=dark)
                browser.ask(GONE_OVER)
                assert json.loads(browser.ask(FAILING)) == []


def test_no_rule_fails_open_or_shut_with_a_fault_or_without(page: tab.Tab) -> None:
    page.load("disc-roller", starter("disc-roller"))
    page.ask(f"{AXE.read_text('utf-8')};1")
    page.turn_to(0)
    page.press("keep")
    assert page.ask("byId('beside').hidden") is False
    page.judged("make")
    page.worked("solid")
    assert page.ask("byId('solid-figure').hidden") is False
    for opened, over in ((False, "110"), (True, "250")):
        page.ask(f"for (const id of ['begin', 'add']) byId(id).open = {json.dumps(opened)}")
        page.ask(f"byId('with-file').hidden = {json.dumps(not opened)}")
        page.wait(f"{json.dumps(not opened)} || byId('starters').children.length > 9")
        page.enter("cam.motion[0].over", over)
        for width in (390, 1280):
            for dark in (False, True):
                page.browser.size(width, 844, dark=dark)
                page.ask(GONE_OVER)
                assert json.loads(page.ask(FAILING)) == []
