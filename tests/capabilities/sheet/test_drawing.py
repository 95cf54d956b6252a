"""Shop drawings: every size once, nothing over anything else, the contour judged, faults with remedies.

Holds: camgeo.capabilities.sheet.dxf, camgeo.capabilities.sheet.format, camgeo.capabilities.sheet.frame,
camgeo.capabilities.sheet.options, camgeo.capabilities.sheet.pages, camgeo.capabilities.sheet.part,
camgeo.capabilities.sheet.pdf, camgeo.capabilities.sheet.views.
"""

from __future__ import annotations

import json
import math
import re
import zlib
from typing import TYPE_CHECKING, Any

import ezdxf
import ezdxf.bbox
import numpy as np
import pytest
from ezdxf.entities.lwpolyline import LWPolyline
from support.places import SHIPPED
from support.sheets import demand_clear

import camgeo
from camgeo.capabilities.sheet import drawing, lettering, views
from camgeo.capabilities.sheet.marks import Dimension
from camgeo.cli.main import main
from camgeo.recipe.recipe import load_text

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 9}
  motion:
    - {rise: 12, over: 100, law: modified-sine}
    - {dwell: 60}
    - {return: 12, over: 140, law: polynomial-345}
    - {dwell: 60}
part: {thickness: 12, bore: 16}
export: {tolerance: 0.002, files: [{sheet: {profile: 0.04}}]}
verify: {angles: 180}
"""
PART = """\
part:
  thickness: 12.5
  bore: 16
  keyway: {width: 5, depth: 2.3, at: 33}
  hub: {diameter: 31, height: 10.5, side: both}
  set_screw: {diameter: 4.25, at: 121, height: 4.4}
  bolts: {count: 3, circle: 52, hole: 5.5, start: 20.5}
  dowel: {circle: 58, hole: 4.1, at: 88}
  lightening: {ring: 6, wall: 2, start: 7}
  chamfer: 0.8
  mark: {as: engrave, width: 1.1, length: 4.2, depth: 0.35, radius: 38}
  density: 7850
"""
ALL_SIZES = CAM.replace("part: {thickness: 12, bore: 16}\n", PART)
# what the part of ALL_SIZES needs, as it stands on the first page; a keyway's depth is measured from across the bore
SIZES = [
    *("12.5", "Ø16", "5", "18.3", "33°", "Ø31", "2 × 10.5 hub", "Ø4.25", "121°", "4.4 up", "3 × Ø5.5", "Ø52", "20.5°"),
    *("Ø58", "Ø4.1", "88°", "7°", "0.8 × 45°", "mark 1.1 × 4.2", "R38", "0.35 deep", "Ø80"),
]


@pytest.fixture
def drawn() -> Iterator[list[drawing.Pages]]:
    """The pages of every drawing that is made in a test."""
    found: list[drawing.Pages] = []
    lay_out = drawing._pages

    def kept(*arguments: Any, **options: Any) -> drawing.Pages:
        found.append(lay_out(*arguments, **options))
        return found[-1]

    with pytest.MonkeyPatch.context() as patch:  # designs stay shared: what is patched makes none
        patch.setattr(drawing, "_pages", kept)
        yield found


def exported(text: str, folder: Path, *, ok: bool = True) -> Path:
    recipe = load_text(text, folder / "cam.yaml")
    report = camgeo.export(recipe, folder / "out")
    assert report.ok is ok, report
    return folder / "out" / ("cam" if ok else "cam.rejected")


def dimensions(path: Path) -> list[Any]:
    return [entity for entity in ezdxf.readfile(path).modelspace() if entity.dxftype() == "DIMENSION"]


def with_sheet(text: str, options: str) -> str:
    """A shipped recipe that asks for its drawing alone."""
    text = re.sub(r"files: *\n( +- .*\n)+|files: .*\n?", f"files: [{{sheet: {{{options}}}}}]\n", text)
    return text if "sheet" in text else f"{text}\nexport: {{files: [{{sheet: {{{options}}}}}]}}\n"


# --- pages ------------------------------------------------------------------------------------------------------------


@pytest.mark.costly("a sheet of a third of all cams")
@pytest.mark.thin(90)
@pytest.mark.parametrize(
    ("path", "paper"),
    [
        pytest.param(path, f"A{3 + number % 2}", id=path.stem)
        for number, path in enumerate(SHIPPED)
        if number % 3 == 0  # every third, on either paper
    ],
)
def test_nothing_lies_over_anything_else(path: Path, paper: str, drawn: list[drawing.Pages], tmp_path: Path) -> None:
    text = with_sheet(path.read_text(encoding="utf-8"), f"paper: {paper}, profile: 0.02")
    camgeo.export(load_text(text, path), tmp_path)
    assert drawn
    for pages in drawn:
        demand_clear(pages)


@pytest.mark.thin(4)
@pytest.mark.parametrize("projection", ["first", "third"])
@pytest.mark.parametrize("paper", ["A3", "A4"])
def test_of_a_part_with_everything(paper: str, projection: str, drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(ALL_SIZES.replace("profile:", f"paper: {paper}, projection: {projection}, profile:"), tmp_path)
    (pages,) = drawn
    demand_clear(pages)


@pytest.mark.slow
def test_lengths_stand_below_what_is_seen_behind_the_cut(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    """A rosette's leaf beside the cut reaches further down than the cut."""
    path = next(path for path in SHIPPED if path.stem == "w-rosette")
    camgeo.export(load_text(with_sheet(path.read_text(encoding="utf-8"), "paper: A3"), path), tmp_path)
    demand_clear(drawn[0])


@pytest.mark.slow
def test_a_planted_text_over_another_is_seen(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(CAM, tmp_path)
    (pages,) = drawn
    first = pages.annotated[0]
    first.text((first.texts[3].box[0], first.texts[3].at[1]), "planted")
    with pytest.raises(AssertionError):
        demand_clear(pages)


@pytest.mark.slow
def test_a_planted_line_through_a_text_is_seen(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(CAM, tmp_path)
    first = drawn[0].annotated[0]
    x0, y0, x1, y1 = first.texts[3].box
    first.line((x0 - 5.0, y0), (x1 + 5.0, y1))
    with pytest.raises(AssertionError):
        demand_clear(drawn[0])


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "groove-stem",  # needs: milling
        "disc-ring",  # needs: milling
        "conjugate-stem",
        "oscillating-yoke",
        "w-law",
    ],
)
def test_on_a4_parts_of_up_to_170_mm_are_drawn_half_their_size(
    name: str, drawn: list[drawing.Pages], tmp_path: Path
) -> None:
    path = next(path for path in SHIPPED if path.stem == name)
    camgeo.export(load_text(with_sheet(path.read_text(encoding="utf-8"), "paper: A4, profile: 0.02"), path), tmp_path)
    assert all(pages.scale >= 0.5 for pages in drawn)


@pytest.mark.slow
def test_each_size_of_the_part_stands_once(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(ALL_SIZES, tmp_path)
    first = drawn[0].annotated[0]
    texts = [text.text for text in first.texts if text.layer != "FRAME"]
    for size in SIZES:
        stands = [text for text in texts if re.search(rf"(?<![\d.]){re.escape(size)}(?![\d.])", text)]
        if size == "5":
            stands = [text for text in stands if text == "5"]
        assert len(stands) == 1, (size, stands)
    assert len([text for text in texts if text.startswith("6 × Ø")]) == 1


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("bore", "value", "words"),
    [
        ("{square: 14, at: 10}", 14.0, "square, a flat's normal at 10°"),
        ("{hexagon: 17}", 17.0, "hexagon, a flat's normal at 0°"),
        ("16, flat: {across: 14.5, at: 40}", 14.5, "flat at 40°"),
    ],
)
def test_a_bore_that_is_not_round_has_a_view(
    bore: str, value: float, words: str, drawn: list[drawing.Pages], tmp_path: Path
) -> None:
    exported(CAM.replace("bore: 16", f"bore: {bore}"), tmp_path)
    first = drawn[0].annotated[0]
    assert [mark.value for mark in first.marks if isinstance(mark, Dimension)].count(value) == 1
    assert any(words in text.text for text in first.texts)
    demand_clear(drawn[0])


@pytest.mark.slow
def test_of_a_shaft_that_turns_the_other_way(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(f"rotation: ccw\n{ALL_SIZES}", tmp_path)
    texts = [text.text for text in drawn[0].annotated[0].texts]
    assert "bore, keyway at 327°" in texts
    assert any("counter-clockwise" in text for text in texts)


def test_without_a_tolerance_or_a_thickness_the_face_alone_is_drawn_and_it_says_so(
    drawn: list[drawing.Pages], tmp_path: Path
) -> None:
    exported(CAM.replace("thickness: 12, ", "").replace("{sheet: {profile: 0.04}}", "sheet"), tmp_path)
    texts = [text.text for text in drawn[0].annotated[0].texts]
    assert "contour: no profile tolerance is stated" in texts
    assert "A-A" not in texts
    assert texts[texts.index("Ø16") + 1] == "bore"
    demand_clear(drawn[0])


def test_a_bore_has_its_fit_and_a_slot_its_sizes_and_its_circle(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    part = "bore: {diameter: 16, fit: H7}, slot: {length: 12.3, width: 5.1, circle: 52, at: 40}}"
    exported(CAM.replace("bore: 16}", part), tmp_path)
    texts = [text.text for text in drawn[0].annotated[0].texts]
    assert "Ø16 H7 (+0.018/0)" in texts
    assert texts[texts.index("slot 5.1 × 12.3") + 1] == "across 40°"
    assert texts[texts.index("Ø52") + 1] == "slot circle"
    demand_clear(drawn[0])


# --- the DXF ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_dimensions_measure_what_they_say(tmp_path: Path) -> None:
    found = dimensions(exported(ALL_SIZES, tmp_path) / "cam-sheet.dxf")
    assert len(found) >= 12
    for one in found:
        size = re.search(r"Ø([\d.]+)", one.dxf.text) or re.search(r"([\d.]+)(?: hub)?$", one.dxf.text)
        assert size, one.dxf.text
        assert one.get_measurement() == pytest.approx(float(size[1]), abs=6e-5)
        assert one.dxf.actual_measurement == pytest.approx(float(size[1]), abs=6e-5)
        kinds = [entity.dxftype() for entity in one.virtual_entities()]
        assert kinds.count("SOLID") == (0 if one.dimtype == 3 else 2)  # arrows; a leader stands beside a diameter
        assert kinds.count("TEXT") == 1


@pytest.mark.slow
def test_the_contour_is_judged_and_a_planted_error_is_seen(tmp_path: Path) -> None:
    folder = exported(CAM, tmp_path)
    recipe = load_text(CAM, tmp_path / "cam.yaml")
    document = ezdxf.readfile(folder / "cam-sheet.dxf")
    (contour,) = (one for one in document.modelspace() if isinstance(one, LWPolyline) and one.dxf.layer == "CUT")
    contour.lwpoints.values[5, 0] += 0.01
    document.saveas(tmp_path / "planted.dxf")
    assert not camgeo.verify(recipe, tmp_path / "planted.dxf").ok


@pytest.mark.slow
def test_the_table_is_that_of_the_contour(tmp_path: Path) -> None:
    folder = exported(CAM.replace("profile:", "step: 30, profile:"), tmp_path)
    texts = list(ezdxf.readfile(folder / "cam-sheet.dxf").modelspace().query("TEXT[layer=='TABLE']"))
    rows: dict[float, list[tuple[float, str]]] = {}
    for text in texts:
        x, y, _ = text.dxf.align_point
        rows.setdefault(round(y, 6), []).append((x, text.dxf.text))
    table = [[text for _, text in sorted(row)] for _, row in sorted(rows.items(), reverse=True)]
    assert table[0] == ["angle °", "R"]
    assert [row[0] for row in table[1:]] == [str(30 * k) for k in range(12)]
    design = camgeo.design(load_text(CAM, tmp_path / "cam.yaml"))
    points = design.contour(36000)
    angles = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    at = np.mod(np.radians(30.0 * np.arange(12)) - angles[0], 2.0 * np.pi) + angles[0]
    radii = np.interp(at, angles, np.hypot(*points.T))
    assert [float(row[1]) for row in table[1:]] == pytest.approx(radii.tolist(), abs=1e-4)


@pytest.mark.slow
def test_conjugate_discs_have_a_sheet_each(tmp_path: Path) -> None:
    path = next(path for path in SHIPPED if path.stem == "conjugate-flat")
    text = with_sheet(path.read_text(encoding="utf-8"), "profile: 0.02")
    report = camgeo.export(load_text(text, path), tmp_path)
    assert report.ok
    folder = tmp_path / "conjugate-flat"
    assert {path.name for path in folder.glob("*sheet*")} == {
        f"conjugate-flat-sheet-{k}.{e}" for k in (1, 2) for e in ("pdf", "dxf")
    }


# --- the PDF ----------------------------------------------------------------------------------------------------------


def streams(path: Path) -> list[str]:
    """Contents of the pages of a PDF, and other streams."""
    parts = re.findall(rb"stream\n(.*?)\nendstream", path.read_bytes(), re.DOTALL)
    found = []
    for part in parts:
        try:
            found.append(zlib.decompress(part).decode("latin-1"))
        except zlib.error:
            continue
    return found


@pytest.mark.slow
def test_the_last_page_has_a_bar_of_100_mm(tmp_path: Path) -> None:
    folder = exported(CAM, tmp_path)
    lines = [
        [float(v) for v in found]
        for text in streams(folder / "cam-sheet.pdf")
        for found in re.findall(r"([\d.]+) ([\d.]+) m\s+([\d.]+) ([\d.]+) l\s+S", text)
    ]
    long = [math.hypot(x1 - x0, y1 - y0) * 25.4 / 72.0 for x0, y0, x1, y1 in lines]
    assert any(abs(one - 100.0) < 0.1 for one in long)


@pytest.mark.slow
def test_the_last_page_and_the_dxf_have_the_contour_at_its_size(tmp_path: Path) -> None:
    """Whatever the scale of the views: extents of the longest path, against those of the exact contour."""
    folder = exported(CAM.replace("profile:", "scale: '1:2', profile:"), tmp_path)
    exact = camgeo.design(load_text(CAM, tmp_path / "cam.yaml")).contour(36_000)
    wanted = (exact.max(axis=0) - exact.min(axis=0)).tolist()
    last = [text for text in streams(folder / "cam-sheet.pdf") if re.search(r"\d l\b", text)][-1]
    paths = [re.findall(r"([\d.]+) ([\d.]+) [ml]\b", path) for path in re.split(r"\b[SbBsf]\b", last)]
    longest = np.array(max(paths, key=len), dtype=float) * 25.4 / 72.0
    assert (longest.max(axis=0) - longest.min(axis=0)).tolist() == pytest.approx(wanted, abs=0.02)
    space = ezdxf.readfile(folder / "cam-sheet.dxf").modelspace()
    (contour,) = (one for one in space if isinstance(one, LWPolyline) and one.dxf.layer == "CUT")
    box = ezdxf.bbox.extents([contour]).size
    assert [box.x, box.y] == pytest.approx(wanted, abs=0.01)


@pytest.mark.slow
def test_text_can_be_searched_in_an_embedded_font(tmp_path: Path) -> None:
    folder = exported(CAM.replace("profile:", "title: Kurve Łódź, profile:"), tmp_path)
    data = (folder / "cam-sheet.pdf").read_bytes()
    assert b"/ToUnicode" in data
    assert b"/FontFile2" in data
    assert len(data) < 80_000


@pytest.mark.slow
def test_the_same_recipe_gives_the_same_bytes(tmp_path: Path) -> None:
    first, second = (exported(ALL_SIZES, tmp_path / name) for name in ("a", "b"))
    for name in ("cam-sheet.pdf", "cam-sheet.dxf"):
        assert (first / name).read_bytes() == (second / name).read_bytes()


@pytest.mark.slow
def test_checksums_are_those_of_the_other_files(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    folder = exported(CAM.replace("files: [", "files: [dxf, csv, "), tmp_path)
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    sums = {file["path"]: file["sha256"] for file in report["files"]}
    texts = [text.text for text in drawn[0].annotated[-1].texts]
    for name in ("cam.dxf", "cam.csv"):
        assert texts[texts.index(name) + 1] == f"sha256 {sums[name]}"
    assert any(text.startswith("All ") for text in texts)


def test_a_failed_check_stands_on_the_drawing(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(f"{CAM}limits: {{pressure-angle: {{at_most: 1}}}}\n", tmp_path, ok=False)
    texts = [text.text for text in drawn[0].annotated[-1].texts]
    assert any(text.startswith("NOT APPROVED: 1 of ") for text in texts)
    assert "limit:pressure-angle" in " ".join(texts)


# --- faults -----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "message", "remedy"),
    [
        ("step: 7", "sheet.step: does not divide 360 degrees", "step: 5"),
        (
            "paper: Letter",
            "sheet.paper: not one of the choices, given 'Letter'; give A3 or A4: sizes of ANSI",
            "paper: A4",
        ),
        ("scale: '50:1'", "sheet.scale: the views do not fit on A3, given 50:1; give 1:1", "scale: '1:1'"),
        (f"title: {'x' * 200}", "sheet.title: does not fit into the title block; give about", f"title: {'x' * 50}"),
        ("drawn: 王", "sheet.drawn: characters that the font lacks, given '王'; leave them out", "drawn: W"),
    ],
)
def test_faults_are_told_with_what_helps(
    options: str, message: str, remedy: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(CAM.replace("profile: 0.04", options), encoding="utf-8")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out" / "cam").exists()
    path.write_text(CAM.replace("profile: 0.04", remedy), encoding="utf-8")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 0


def test_two_tolerances_that_disagree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recipe = load_text(CAM, tmp_path / "cam.yaml")
    monkeypatch.setattr(type(recipe), "zones", (("part.bore", 0.05),))
    match = r"export\.files\[0\]\.sheet\.profile: part\.bore in line \d+ makes it 0\.05, given 0\.04"
    with pytest.raises(camgeo.RecipeErrors, match=match):
        camgeo.export(recipe, tmp_path / "out")
    monkeypatch.setattr(type(recipe), "zones", (("part.bore", 0.04),))
    assert camgeo.export(recipe, tmp_path / "out").ok


def test_without_the_library_the_other_files_are_made_and_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    path = tmp_path / "cam.yaml"
    path.write_text(CAM.replace("files: [", "files: [dxf, "), encoding="utf-8")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 3
    told = capsys.readouterr().err
    assert "cam-sheet.pdf is left out: a shop drawing needs fpdf2: pip install '.[sheet]'" in told
    assert {one.name for one in (tmp_path / "out" / "cam").iterdir()} == {"cam.dxf", "report.json"}


# needs: budget
def test_a_budget_states_the_tolerance(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    text = CAM.replace("{sheet: {profile: 0.04}}", "sheet")
    exported(f"{text}budget: {{permitted: 0.1, tolerances: {{profile: 0.015}}}}\n", tmp_path)
    assert "0.03" in [text.text for text in drawn[0].annotated[0].texts]


# needs: made
@pytest.mark.slow
def test_a_made_part_states_the_tolerance(drawn: list[drawing.Pages], tmp_path: Path) -> None:
    exported(f"{CAM.replace('{sheet: {profile: 0.04}}', 'sheet')}made: {{profile: 0.05}}\n", tmp_path)
    assert "0.05" in [text.text for text in drawn[0].annotated[0].texts]


# needs: camshaft
def test_a_camshaft_has_no_sheet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cam.yaml").write_text(CAM, encoding="utf-8")
    text = "camshaft: [{recipe: cam.yaml, angle: 0, at: 0}]\nexport: {files: [sheet]}\n"
    (tmp_path / "shaft.yaml").write_text(text, encoding="utf-8")
    assert main(["export", str(tmp_path / "shaft.yaml")]) == 2
    assert "a camshaft takes no sheet; leave it out, or give the recipe of a lobe" in capsys.readouterr().err


def test_a_text_is_as_wide_as_its_letters() -> None:
    assert lettering.width("", 2.5) == 0.0
    assert lettering.width("0000", 5.0) == pytest.approx(8.0 * lettering.width("0", 2.5))
    assert lettering.unknown("Ø20 H7 ± Łódź Ω ж") == ""
    assert lettering.unknown("a王b王") == "王"


def test_points_of_a_view_turn_counter_clockwise() -> None:
    assert views._turned(np.eye(2), 0.5 * math.pi) == pytest.approx(np.array([[0.0, 1.0], [-1.0, 0.0]]), abs=1e-15)
