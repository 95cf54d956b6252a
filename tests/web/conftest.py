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


OPEN: list[tab.Tab] = []  # pages that stay open for the files of tests to come
PRESS = "byId('play').click()"


@pytest.fixture(scope="module", autouse=True)
def playing_here_alone() -> Iterator[None]:
    """Open pages play while tests of the page run: else a browser takes a core from all tests that come after."""
    for one in [*OPEN]:
        one.ask(f"window.stopped && (window.stopped = false, {PRESS})")
    yield
    for one in [*OPEN]:
        one.ask(f"(window.stopped = document.documentElement.dataset.playing === 'true') && {PRESS}")


def opened(address: str, profile: Path) -> Iterator[tab.Tab]:
    with Browser(profile) as browser:
        browser.size(1280, 800)
        one = tab.Tab(browser, address).open()
        OPEN.append(one)
        yield one
        OPEN.remove(one)


@pytest.fixture(scope="package")
def one_page(address: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tab.Tab]:
    yield from opened(address, tmp_path_factory.mktemp("profile"))


@pytest.fixture(scope="package")
def another_page(address: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tab.Tab]:
    yield from opened(address, tmp_path_factory.mktemp("profile"))


@pytest.fixture
def page(one_page: tab.Tab) -> tab.Tab:
    """The page, whatever tests have done with it."""
    return one_page.as_opened()


@pytest.fixture
def other_page(another_page: tab.Tab) -> tab.Tab:
    """The page in another browser, for tests that take many steps: the history of one keeps fifty."""
    return another_page.as_opened()
