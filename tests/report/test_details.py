"""Details of checks are in the recipe's unit: lengths, areas, volumes and places."""

from __future__ import annotations

import math
import pickle
import re
from typing import TYPE_CHECKING

import pytest
from support.cases import few
from support.heavy import ezdxf

import camgeo
from camgeo.output import pipeline
from camgeo.part.hub import Hub
from camgeo.recipe.loading import load, load_text
from kin.numeric.check import at_most, less_sure
from kin.numeric.lengths import UNIT, in_unit, length_words, place_words, span_words

if TYPE_CHECKING:
    from pathlib import Path

INCH = 25.4
VERIFY = "export: {tolerance: 0.01, files: [FILES]}\nverify: {angles: 24}\n"
MOTION = "motion: [{rise: 12, over: 120, law: cycloidal}, {return: 12, over: 120, law: cycloidal}, {dwell: 120}]"
DISC = f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 9}}, {MOTION}"
RECIPES = {
    "layers": DISC + "}\npart: {thickness: 10, bore: 12, hub: {diameter: 30, height: 8}, chamfer: 0.5, "
    "lightening: {ring: 3, wall: 4}}\n" + VERIFY.replace("FILES", "dxf, stl, 3mf"),
    "groove": DISC
    + ", track: {groove: {clearance: 0.05, depth: 7}}}\npart: {thickness: 14, bore: 12, outer: 150}\n"
    + VERIFY.replace("FILES", "dxf, stl"),
    "pair": DISC
    + ", conjugate: {radius: 9, distance: 120}}\npart: {thickness: 10, bore: 12}\n"
    + VERIFY.replace("FILES", "dxf, 3mf"),
    "yoke": "cam: {kind: support, p: 25 + 1.5*cos(3*t), shaft: [3, 2]}\npart: {thickness: 8, bore: 10}\n"
    + VERIFY.replace("FILES", "dxf, stl"),
    "milled": DISC  # needs: milling
    + "}\npart: {thickness: 10, bore: 12}\nmanufacture: {cutter: 6, feed: 300, plunge: 100, "  # needs: milling
    + "spindle: 8000, depth_of_cut: 2, safe_height: 5}\n"  # needs: milling
    + VERIFY.replace("FILES", "gcode"),  # needs: milling
}


def in_inches(text: str) -> str:
    """The same cam in a recipe of inches: every length carries its unit."""
    keys = "base_radius|radius|rise|return|thickness|bore|diameter|height|circle|hole|chamfer|wall|clearance|depth"
    more = "outer|distance|tolerance|cutter|feed|plunge|depth_of_cut|safe_height"
    text = re.sub(rf"\b({keys}|{more}): ([\d.]+)", r"\1: \2 mm", text)
    text = text.replace("shaft: [3, 2]", "shaft: [3 mm, 2 mm]").replace(
        "p: 25 + 1.5*cos(3*t)", "p: (25 + 1.5*cos(3*t))/25.4"
    )
    return f"units: inch\n{text}"


NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
# figures of a detail, and what they make of a check's own figure
FIGURES = {
    "wall": (rf": {NUMBER} in at", lambda wall: wall),
    "contour": (rf"{NUMBER} in outside, {NUMBER} in inside", max),
    "volume": (rf"{NUMBER} in\^3, by the \w+ {NUMBER}", lambda found, meant: abs(found - meant)),
    "thickness": (rf"z from {NUMBER} to {NUMBER} in, 0 to", None),
    "bore": (rf"about \({NUMBER}, {NUMBER}\)", None),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", few(RECIPES, 2))
def test_details_of_an_inch_recipe_are_in_inches(name: str) -> None:
    """No figure is left in mm; those of some checks make the check's own value, which is in inches."""
    recipe = load_text(in_inches(RECIPES[name]), "cam.yaml")
    report = pipeline.check(recipe).report
    assert len(report["checks"]) > 5
    for check in report["checks"]:
        detail = check.get("detail", "")
        if check["name"] == "units":  # it says how long a drawing's unit is
            continue
        assert not re.search(r"\bmm\b|[\ue000-\uf8ff]", detail), (check["name"], detail)
        pattern, value = FIGURES.get(check["name"], ("", None))
        found = re.search(pattern, detail) if pattern else None
        if found and value:
            figures = [float(number) for number in found.groups()]
            assert value(*figures) == pytest.approx(check["value"], rel=1e-2, abs=1e-7), (check["name"], detail)
        elif found and check["name"] == "thickness" and not recipe.part.of(Hub):
            assert float(found[2]) == pytest.approx(recipe.part.thickness / INCH, abs=1e-3)
        elif found and check["name"] == "bore":
            assert max(abs(float(number)) for number in found.groups()) < 0.2  # about the shaft, 3 and 2 mm off at most


def test_a_place_is_in_inches_too() -> None:
    text = RECIPES["yoke"].replace("bore: 10", "bore: 10, bolts: {count: 3, circle: 30, hole: 4}")
    for words, scale in ((text, 1.0), (in_inches(text), INCH)):
        checks = pipeline.check(load_text(words, "cam.yaml")).report["checks"]
        (detail,) = [check["detail"] for check in checks if check["name"] == "wall"]
        x, y = (float(number) for number in re.findall(r"at \(([-\d.e]+), ([-\d.e]+)\)", detail)[0])
        assert 5.0 < scale * (x * x + y * y) ** 0.5 < 30.0


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_places_of_a_file_are_in_the_axes_of_that_file(tmp_path: Path, rotation: str) -> None:
    """What is wrong at a place of a drawing is reported at that place, mirrored drawing or not."""
    recipe = tmp_path / "cam.yaml"
    part = "part: {bore: 10, bolts: {circle: 30, count: 3, hole: 3, start: 40}}"
    recipe.write_text(f"rotation: {rotation}\ncam: {{kind: support, p: 25 + 2*cos(3*t) + 0.5*sin(2*t)}}\n{part}\n")
    assert pipeline.export(load(recipe), tmp_path, only=["dxf"]).ok
    drawing = tmp_path / "cam" / "cam.dxf"

    document = ezdxf.readfile(drawing)
    space = document.modelspace()
    hole = space.query("CIRCLE[layer=='HOLES']")[0]
    x, y, _ = hole.dxf.center
    space.delete_entity(hole)
    space.add_circle((2.0, 9.0), 1.0, dxfattribs={"layer": "HOLES"})
    space.add_line((3.0, 4.0), (3.0, 4.0), dxfattribs={"layer": "CUT"})
    document.saveas(tmp_path / "holes.dxf")
    details = _details(recipe, tmp_path / "holes.dxf")
    assert f"bolt hole 1 at ({x:.6g}, {y:.6g}) is missing" in details["holes"]
    assert "about (2, 9), where none is expected" in details["holes"]
    assert "at (3, 4)" in details["closed"]

    document = ezdxf.readfile(drawing)
    for entity in document.modelspace():
        entity.transform(ezdxf.math.Matrix44.z_rotate(math.radians(7.0)) @ ezdxf.math.Matrix44.translate(1.0, 2.0, 0.0))
    document.saveas(tmp_path / "moved.dxf")
    details = _details(recipe, tmp_path / "moved.dxf")
    assert details["contour"].endswith("it is the exact one turned by 7 degrees, moved by (1, 2) mm")
    assert details["bore"].startswith("bore, about (1, 2),")


def _details(recipe: Path, drawing: Path) -> dict[str, str]:
    return {check.name: check.detail or "" for check in camgeo.verify(recipe, drawing).checks}


def test_words_without_marks_stay_and_marks_go_everywhere(tmp_path: Path) -> None:
    check = at_most("a", 0.5, 1.0, "mm", detail=f"{span_words(1.0, 50.8)} at {place_words(1e-9, 25.4)}")
    assert check.detail == "1 to 50.8 mm at (0, 25.4)"
    assert in_unit(check.detail, INCH, "in") == "0.0393700787 to 2 in at (0, 1)"
    assert in_unit(pickle.loads(pickle.dumps(check)).detail, INCH, "in").startswith("0.0393700787 to 2 in")
    more = less_sure(check, 0.254)
    assert in_unit(more.detail, INCH, "in").endswith("heights differ by up to 0.01 in through rounding")
    assert in_unit("no length in it", INCH, "in") == "no length in it"
    area = f"{length_words(645.16, '.6g', 2)} {UNIT}^2"
    assert in_unit(at_most("b", 0.0, 1.0, "mm^2", detail=area).detail, INCH, "in") == "1 in^2"
    (tmp_path / "words.txt").write_text(check.detail)
    assert (tmp_path / "words.txt").read_text() == "1 to 50.8 mm at (0, 25.4)"
