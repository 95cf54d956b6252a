"""docs/library.md: its blocks run in their order, as a reader would paste them; what comments say is printed."""

from __future__ import annotations

import logging
import re
from pathlib import Path
from typing import TYPE_CHECKING

import camgeo

if TYPE_CHECKING:
    import pytest

PAGE = Path(__file__).parents[2] / "docs" / "library.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def test_the_blocks_run_and_print_what_they_say(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(logging, "basicConfig", lambda **_: None)
    names: dict[str, object] = {}
    level = logging.getLogger("camgeo").level
    try:
        for block in BLOCKS:
            exec(compile(block, str(PAGE), "exec"), names)
    finally:
        logging.getLogger("camgeo").setLevel(level)
    printed = capsys.readouterr().out
    told = [text for block in BLOCKS for text in re.findall(r"print\(.*\)  +# (.*?)(?: \.\.\.)?$", block, re.MULTILINE)]
    shown = [text for text in told if re.match(r"True|feeder: ok|radius-of-curvature: ok", text)]
    assert len(shown) == 3
    for text in shown:
        assert text.partition(": no undercut")[0] in printed, text
    assert "did you mean" in printed or "given 'thirty'" in printed
    assert "FAILED" in printed


def test_the_page_names_all_that_is_public() -> None:
    text = PAGE.read_text(encoding="utf-8")
    missing = [name for name in camgeo.__all__ if name not in {"__version__", "Edges", "Figure", "Check"}]
    assert [name for name in missing if not re.search(rf"\b{name}\b", text)] == []
