"""`export`, `check` and `verify` of the library: what they refuse."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

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
