"""docs/library.md: its blocks run in their order, as a reader would paste them; what comments say is printed.

Holds: camgeo.api.loading, camgeo.api.report, camgeo.api.run.
"""

from __future__ import annotations

import logging
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.places import RECIPES

import camgeo
from camgeo.registry import registry

if TYPE_CHECKING:
    from collections.abc import Callable

PAGE = Path(__file__).parents[2] / "docs" / "library.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


@pytest.mark.slow  # a page in one go: what it shows is tested where it is made
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
    assert len(shown) == 4
    for text in shown:
        assert re.split(": (?:no undercut|verdict)", text)[0] in printed, text
    assert "did you mean" in printed or "given 'thirty'" in printed
    assert "FAILED" in printed


def test_the_page_names_all_that_is_public() -> None:
    text = PAGE.read_text(encoding="utf-8")
    others = set(registry.library_names())  # on the pages of capabilities
    missing = [name for name in camgeo.__all__ if name not in {"__version__", "Edges", "Figure", "Check", *others}]
    assert [name for name in missing if not re.search(rf"\b{name}\b", text)] == []


FLAWED = "cam: {kind: support, p: 25 + 5*cos(3*t)}\npart: {bore: 10}\n"
SHIPPED = RECIPES / "shu-wu.yaml"
SOUND = FLAWED.replace("5*cos", "2*cos")
ERRORS: dict[str, list[Callable[[], object]]] = {
    "RecipeErrors": [lambda: camgeo.load("nothing.yaml"), lambda: camgeo.load(SOUND.replace("support", "suport"))],
    "CallError": [
        lambda: camgeo.verify(camgeo.load(SOUND), "nothing.dxf"),
        lambda: camgeo.design(camgeo.load(SOUND)).edges(0.001, form="nurbs"),
        lambda: camgeo.export(camgeo.load(SOUND), "out", only=["exe"]),
        lambda: camgeo.design(camgeo.load(FLAWED)).contour(10),
    ],
    "TypeError": [lambda: camgeo.design(camgeo.load(SOUND)).contour(1.5)],
    "UnitsError": [
        lambda: camgeo.verify(SHIPPED, camgeo.export(SHIPPED, "out", only="dxf").files[0].path, units="inch")
    ],
    "ToleranceError": [lambda: camgeo.design(camgeo.load(SOUND)).edges(1e-18)],
    "others below `CamgeoError`": [lambda: camgeo.load(SOUND).save("none/cam.yaml")],
}


def test_each_error_is_raised_where_the_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    table = PAGE.read_text(encoding="utf-8").partition("| error | when |\n| --- | --- |\n")[2].partition("\n\n")[0]
    rows = dict(re.findall(r"^\| (.*?) \| (.*) \|$", table, re.MULTILINE))
    assert {name.removeprefix("`").removesuffix("`") if name[0] == "`" else name for name in rows} == set(ERRORS)
    assert rows["`CallError`"].endswith("also a `ValueError`")
    for name, calls in ERRORS.items():
        for call in calls:
            with pytest.raises(Exception) as raised:
                call()
            if name.startswith("others"):
                assert isinstance(raised.value, camgeo.CamgeoError)
            else:
                assert type(raised.value).__name__ == name, raised.value
                assert isinstance(raised.value, ValueError) == rows[f"`{name}`"].endswith("also a `ValueError`")
