"""The pages of the trades, each in its own order: its recipes are written, its commands run, its files are there."""

import re
import shlex
from pathlib import Path

import pytest
from support.cases import few

from camgeo.cli.main import main

DOCS = Path(__file__).parents[2] / "docs"
TRADES = [
    "engine.md",  # needs: valve, camshaft
    "packaging.md",
    "toy.md",
    "lecture.md",
]
LINES = 125  # three screens


def blocks(page: str) -> list[tuple[str, str]]:
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.findall(r"^```(\w+)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize("page", few(TRADES, len(TRADES), first=len(TRADES) - 1))
def test_a_page_of_a_trade_runs_as_it_stands(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = 0
    for language, text in blocks(page):
        name = re.match(r"# (\S+\.yaml)\n", text)
        if language == "yaml" and name is not None:
            (tmp_path / name[1]).write_text(text, encoding="utf-8")
        elif language == "sh":
            for line in text.splitlines():
                words = shlex.split(line, comments=True)
                assert words[0] == "camgeo"
                assert main(words[1:]) == 0, line
                ran += 1
    assert ran >= 1
    assert list(tmp_path.rglob("*.html"))


@pytest.mark.parametrize("page", TRADES)
def test_a_page_of_a_trade_is_three_screens_at_most(page: str) -> None:
    assert len((DOCS / page).read_text(encoding="utf-8").splitlines()) <= LINES
