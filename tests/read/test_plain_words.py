"""What is wrong with a damaged file is said in words of the file, not in those of Python or of a library."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from camgeo.output.pipeline import export
from camgeo.recipe.loading import load_text
from kin.read.errors import ReadError
from kin.read.files import read_drawing, read_solid

if TYPE_CHECKING:
    from pathlib import Path

CAM = "cam: {kind: support, p: 25 + cos(3*t)}\nexport: {tolerance: 0.05, files: [dxf, svg]}\n"
FOREIGN = re.compile(
    r"Error|None|<class|could not|convert|invalid|literal|token|codec|object|\bb'|Expected|index|tuple|\binf\b|\bnan\b"
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    outcome = export(load_text(CAM, "plain"), tmp_path_factory.mktemp("plain"))
    assert outcome.folder is not None
    return outcome.folder


def first(text: str, code: str, value: str) -> str:
    """Put another value in the place of the first one under a group code of the entities."""
    head, mark, rest = text.partition("ENTITIES")
    return head + mark + re.sub(rf"(?m)^( *{code}\n)[^\n]*$", rf"\g<1>{value}", rest, count=1)


DXF = {
    "letters": lambda text: first(text, "10", "abc"),
    "nothing": lambda text: first(text, "10", ""),
    "underscore": lambda text: first(text, "10", "1_0"),
    "underscored count": lambda text: first(text, "90", "1_0"),
    "two numbers": lambda text: first(text, "42", "1 2"),
    "infinite": lambda text: first(text, "10", "1e999"),
    "nan": lambda text: first(text, "42", "nan"),
    "no code": lambda text: text.replace("ENTITIES\n  0\n", "ENTITIES\n x0\n", 1),
    "a line gone": lambda text: text.replace("ENTITIES\n", "", 1),
    "no y": lambda text: re.sub(r"(ENTITIES.*?) 20\n[^\n]*\n", r"\1", text, count=1, flags=re.DOTALL),
}
SVG = {
    "endless page": lambda text: re.sub(r'width="[^"]*"', 'width="1e999mm"', text, count=1),
    "tiny box": lambda text: re.sub(r'viewBox="[^"]*"', 'viewBox="0 0 1e-320 1e-320"', text, count=1),
    "underscore": lambda text: re.sub(r'viewBox="[^"]*"', 'viewBox="0 0 1_0 1_0"', text, count=1),
    "cut short": lambda text: text[:-20],
    "no encoding": lambda text: re.sub(r"^(<\?xml[^>]*\?>)?", '<?xml version="1.0" encoding="rot13"?>', text, count=1),
    "infinite": lambda text: re.sub(r' d="M[-0-9.]+', ' d="M1e999', text, count=1),
    "underscore in a path": lambda text: re.sub(r' d="M[-0-9.]+', ' d="M1_0', text, count=1),
}
STL = {
    "underscore": (b"1_0 0 0", "facet 1: the coordinate 1_0 is not a number"),
    "letters": (b"0 0 q", "facet 1: the coordinate q is not a number"),
    "not ASCII": (b"0 0 \xe9", "facet 1: the coordinate \xe9 is not a number"),
}


@pytest.mark.parametrize("fault", DXF)
def test_dxf(fault: str, folder: Path, tmp_path: Path) -> None:
    text = (folder / "plain.dxf").read_text("utf-8")
    damaged = DXF[fault](text)
    assert damaged != text
    path = tmp_path / "damaged.dxf"
    path.write_text(damaged, "utf-8")
    with pytest.raises(ReadError) as caught:
        read_drawing(path)
    assert not FOREIGN.search(caught.value.message), caught.value.message


@pytest.mark.parametrize("fault", SVG)
def test_svg(fault: str, folder: Path, tmp_path: Path) -> None:
    text = (folder / "plain.svg").read_text("utf-8")
    damaged = SVG[fault](text)
    assert damaged != text
    path = tmp_path / "damaged.svg"
    path.write_text(damaged, "utf-8")
    with pytest.raises(ReadError) as caught:
        read_drawing(path)
    assert not FOREIGN.search(caught.value.message), caught.value.message


@pytest.mark.parametrize("fault", STL)
def test_stl_as_text(fault: str, tmp_path: Path) -> None:
    vertex, message = STL[fault]
    path = tmp_path / "damaged.stl"
    facet = b"facet normal 0 0 1\nouter loop\nvertex %s\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n" % vertex
    path.write_bytes(b"solid 1_0\n" + facet + b"endsolid 1_0\n")
    with pytest.raises(ReadError) as caught:
        read_solid(path)
    assert caught.value.message == message


def test_a_layer_may_be_called_by_digits_with_an_underscore(folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "layer.dxf"
    text = (folder / "plain.dxf").read_text("utf-8")
    path.write_text(re.sub(r"(?m)^CUT$", "1_0", text), "utf-8")
    assert read_drawing(path).contour.area > 0.0
