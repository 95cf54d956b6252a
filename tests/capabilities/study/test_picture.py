"""What the picture of a study draws: run times in ms, pieces, errors, and the slopes of theory; nothing is rendered."""

from __future__ import annotations

from typing import Any

import pytest

from camgeo.capabilities.study.picture import picture

ROWS = [
    {"form": "arcs", "geometry_error": error, "pieces": n, "least_pieces": least}
    | {"seconds": 0.25, "stages": {"fit": 0.125, "write": 0.5}}
    for error, n, least in ((1e-2, 10, 9), (1e-5, 100, 90), (None, 0, None))
]


def test_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    figure_module = pytest.importorskip("matplotlib.figure")
    drawn: list[Any] = []
    monkeypatch.setattr(figure_module.Figure, "savefig", lambda self, *_, **__: drawn.append(self))
    picture({"recipe": "c", "units": "mm", "rows": ROWS})
    time, pieces = drawn[0].axes
    writing, judging = (line.get_xydata().tolist() for line in time.lines)
    assert writing == [[625.0, 1e-2], [625.0, 1e-5]]
    assert judging == [[250.0, 1e-2], [250.0, 1e-5]]
    own, slope = (line.get_xydata().tolist() for line in pieces.lines)
    assert own == [[10.0, 1e-2], [100.0, 1e-5]]
    # nine times the pieces that theory needs take a 729th of the error
    assert slope[0] == pytest.approx([10.0, 729e-5])
    assert slope[1] == pytest.approx([90.0, 1e-5])
    assert time.get_ylim() == pytest.approx((3e-6, 3e-2))
    assert "mm" in time.get_ylabel()
