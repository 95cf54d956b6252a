"""The live page, built and opened once for all tests of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support import tab
from support.browser import Browser

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(scope="package")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tab.built(tmp_path_factory.mktemp("tab") / "site")


@pytest.fixture(scope="package")
def address(site: Path) -> Iterator[str]:
    with tab.served(site) as there:
        yield there


@pytest.fixture(scope="package")
def page(address: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tab.Tab]:
    with Browser(tmp_path_factory.mktemp("profile")) as browser:
        browser.size(1280, 800)
        yield tab.Tab(browser, address).open()


@pytest.fixture(scope="package")
def other_page(address: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tab.Tab]:
    """The page in another browser, for tests that take many steps: the history of one keeps fifty."""
    with Browser(tmp_path_factory.mktemp("profile")) as browser:
        browser.size(1280, 800)
        yield tab.Tab(browser, address).open()
