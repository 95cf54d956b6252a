# needs: made
"""What is said of files is not said of measured points: a tolerance, a gap and a page are refused one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

CAM = "cam: {kind: support, p: 40 + cos(2*t)}\npart: {bore: 10}\n"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"tolerance": 0.01}, "no tolerance, gap and page of files"),
        ({"gap": 0.01}, "no tolerance, gap and page of files"),
        ({"page": True}, "no tolerance, gap and page of files"),
        ({"units": "furlong"}, "a unit is one of mm"),
        ({}, "at least 36 are needed"),
    ],
)
def test_options_of_files(tmp_path: Path, options: dict[str, Any], told: str) -> None:
    points = tmp_path / "points.csv"
    points.write_text("x_mm,y_mm\n41,0\n")
    with pytest.raises(camgeo.CallError, match=told) as failed:
        camgeo.verify(camgeo.load(CAM), points, **options)
    assert str(failed.value).count("\n") == 0


def test_each_fault_of_a_call_is_told(tmp_path: Path) -> None:
    points, drawing = tmp_path / "points.csv", tmp_path / "cam.dxf"
    points.write_text("x_mm,y_mm\n41,0\n")
    drawing.write_text("")
    with pytest.raises(camgeo.CallError) as failed:
        camgeo.verify(camgeo.load(CAM), points, drawing, points, gap=0.01, units="furlong")
    faults = str(failed.value).splitlines()
    assert len(faults) == 4
    for fault, told in zip(
        faults, ("a call of its own", "given 2 times", "a unit is one of", "no tolerance"), strict=True
    ):
        assert told in fault
