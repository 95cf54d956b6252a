"""Pages of files of any origin: the file as it is drawn, its verdict, and its error round the contour."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.heavy import ezdxf, trimesh
from support.pages import unpacked

import camgeo
from camgeo.cli.exit_status import FAILED, OK, WRONG
from camgeo.cli.main import main
from camgeo.report.page.scene import STEPS

if TYPE_CHECKING:
    from pathlib import Path

TEXT = (
    "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10}\n"
    "export: {tolerance: 0.01, files: [dxf]}\nverify: {angles: 720}\n"
)


def drawn(path: Path, outset: float) -> Path:
    """A polygon of 600 points of the cam and its bore, moved out along its normals over one degree about 90."""
    design = camgeo.design(camgeo.load(TEXT))
    points = design.contour(600)
    angle = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    out = np.hypot(points[:, 0], points[:, 1])
    points *= (1.0 + outset * (np.abs(angle - 90.0) < 3.0) / out)[:, None]
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_lwpolyline(points.tolist(), close=True)
    document.modelspace().add_circle((0.0, 0.0), 5.0)
    document.saveas(path)
    return path


def data(page: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(re.findall(r'id="data">(.*?)</script>', page, re.DOTALL)[0])
    return found


@pytest.mark.slow
@pytest.mark.parametrize("outset", [0.0, 0.05])
def test_a_drawing_has_its_error_ring(tmp_path: Path, outset: float) -> None:
    path = drawn(tmp_path / "old.dxf", outset)
    report = camgeo.verify(camgeo.load(TEXT), path, page=True)
    assert report.ok == (outset == 0.0)
    assert report.page is not None
    assert "Error of the files round the contour" in report.page
    (error,) = data(report.page)["errors"]
    assert error["file"] == "old.dxf"
    assert error["tolerance"] == 0.01
    most = unpacked(error["high"], STEPS)
    assert float(most.max()) == pytest.approx(outset, abs=0.002)
    assert camgeo.verify(camgeo.load(TEXT), path).page is None


def test_a_solid_and_a_drawing_each_have_theirs(tmp_path: Path) -> None:
    design = camgeo.design(camgeo.load(TEXT))
    prism = trimesh.creation.extrude_polygon(pytest.importorskip("shapely").Polygon(design.contour(600)), 8.0)
    prism.export(tmp_path / "old.stl")
    path = drawn(tmp_path / "old.dxf", 0.0)
    report = camgeo.verify(camgeo.load(TEXT), path, tmp_path / "old.stl", page=True)
    assert report.page is not None
    errors = data(report.page)["errors"]
    assert [error["file"] for error in errors] == ["old.dxf", "old.stl"]
    assert not report.ok  # the solid has no bore
    assert "bore" in report.page


def test_a_file_that_cannot_be_read_has_a_page_that_says_so(tmp_path: Path) -> None:
    (tmp_path / "broken.dxf").write_text("0\nEOF\n", encoding="utf-8")
    report = camgeo.verify(camgeo.load(TEXT), tmp_path / "broken.dxf", page=True)
    assert report.page is not None
    assert not report.ok
    assert data(report.page)["errors"] == []
    assert "nothing to cut" in report.page


@pytest.mark.slow
def test_the_command_writes_it_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe, page = tmp_path / "cam.yaml", tmp_path / "page.html"
    recipe.write_text(TEXT, encoding="utf-8")
    path = drawn(tmp_path / "old.dxf", 0.05)
    assert main(["verify", str(recipe), str(path), "--page", str(page)]) == FAILED
    assert "old.dxf" in page.read_text("utf-8")
    assert main(["verify", str(recipe), str(path), "--page", str(page)]) == WRONG
    assert "exists already and is left as it is" in capsys.readouterr().err
    assert (
        main(["verify", str(recipe), str(drawn(tmp_path / "good.dxf", 0.0)), "--page", str(tmp_path / "b.html")]) == OK
    )
