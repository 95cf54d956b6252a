"""The live page in a real browser: what it shows agrees with camgeo here, and what goes wrong is told and survived."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from support import tab
from support.browser import Browser

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with tab.served(tab.built(tmp_path_factory.mktemp("tab") / "site")) as there:
        yield there


@pytest.fixture(scope="module")
def page(address: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tab.Tab]:
    with Browser(tmp_path_factory.mktemp("profile")) as browser:
        browser.size(1280, 800)
        yield tab.Tab(browser, address).open()


def test_a_picture_stands_there_before_python_does(address: str, tmp_path: Any) -> None:
    with Browser(tmp_path) as browser:
        browser.size(390, 844, mobile=True)
        browser.open(address)
        assert browser.ask("document.body.dataset.loaded") is None
        assert browser.ask("document.querySelectorAll('#drawing .body').length") >= 4
        assert browser.ask("document.querySelectorAll('.plot').length") >= 5
        assert browser.ask("byId('loading').hidden") is False


def test_it_loads_from_its_own_server_alone_and_without_complaint(page: tab.Tab) -> None:
    assert page.text_of("verdict") == "every check of the design holds"
    assert page.browser.problems == []
    assert {url for url in page.browser.requests if not url.startswith((page.address, "data:", "about:"))} == set()
