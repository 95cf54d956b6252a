"""Pages of a drawing are numbered in order, each with the number of all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import camgeo
from camgeo.capabilities.sheet import drawing
from camgeo.recipe.loading import load_text

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

CAM = """\
cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 9}, motion: {formula: 6*(1 - cos(t))}}
part: {thickness: 12, bore: 16}
export: {tolerance: 0.01, files: [sheet]}
verify: {angles: 36}
"""


def test_pages_are_numbered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[drawing.Pages] = []
    lay_out = drawing._pages

    def kept(*arguments: Any, **options: Any) -> drawing.Pages:
        made.append(lay_out(*arguments, **options))
        return made[-1]

    monkeypatch.setattr(drawing, "_pages", kept)
    assert camgeo.export(load_text(CAM, tmp_path / "cam.yaml"), tmp_path / "out").ok
    (pages,) = made
    count = len(pages.all)
    assert count > 2
    numbers = [[text.text for text in page.texts if text.text.endswith(f"/{count}")] for page in pages.all]
    assert numbers == [[f"{k}/{count}"] for k in range(1, count + 1)]
