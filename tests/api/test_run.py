"""`export`, `check` and `verify` of the library: what they refuse.

Holds: camgeo.output.claims, camgeo.api.root.
"""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

import pytest

import camgeo
from camgeo.cli.main import main

TEXT = "name: cam\ncam: {kind: support, p: 20}\nexport: {tolerance: 0.01, files: [svg, dxf]}\n"


@pytest.mark.parametrize(
    ("only", "faults"),
    [
        (["dxf", "step"], ["export.files lists no step; it lists dxf, svg"]),
        (["step", "step"], ["export.files lists no step; it lists dxf, svg"]),
        (["dxf", "dfx"], ["a kind of file is one of {}, not 'dfx'; did you mean dxf?"]),
        (
            ["nonsense", "stl"],
            ["a kind of file is one of {}, not 'nonsense'", "export.files lists no stl; it lists dxf, svg"],
        ),
    ],
)
def test_each_kind_of_an_export_is_one_that_the_recipe_lists(
    only: list[str], faults: list[str], tmp_path: Path
) -> None:
    from camgeo.registry.formats import FORMATS

    with pytest.raises(camgeo.CallError) as caught:
        camgeo.export(camgeo.load(TEXT), tmp_path, only=only)
    assert list(caught.value.faults) == [fault.format(", ".join(FORMATS)) for fault in faults]
    assert not list(tmp_path.iterdir())


FILES = ["a.dxf", "a.svg", "points.csv", "points.txt"]


@pytest.fixture
def closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a recipe, and with files that nobody may read."""
    (tmp_path / "cam.yaml").write_text(TEXT, encoding="utf-8")
    for name in FILES:
        (tmp_path / name).write_text("c_deg,radius\n", encoding="utf-8")

    def refusing(function):
        def opened(path, *words, **named):
            if isinstance(path, str | os.PathLike) and Path(path) in {tmp_path / name for name in FILES}:
                raise PermissionError(13, "Permission denied", str(path))
            return function(path, *words, **named)

        return opened

    for place in ("io.open", "builtins.open", "os.open"):
        module, _, name = place.partition(".")
        monkeypatch.setattr(place, refusing(getattr(import_module(module), name)))
    return tmp_path


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_nobody_may_read_is_a_line(name: str, closed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe, file = closed / "cam.yaml", closed / name
    with pytest.raises(camgeo.SurroundingsError) as caught:
        camgeo.verify(recipe, file)
    assert str(caught.value) == f"{file}: cannot be read: Permission denied"
    assert caught.value.path == file
    assert main(["verify", str(recipe), str(file)]) == 3
    assert capsys.readouterr().err == f"camgeo: {file}: cannot be read: Permission denied\n"
