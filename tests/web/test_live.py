"""What the page's worker asks of camgeo, asked here: fields and their places, units, faults, the policy of the page."""

from __future__ import annotations

import io
import json
import math
import re
import sys
from collections import Counter
from importlib import import_module
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import ezdxf
import numpy as np
import pytest
from support.drawn import polygon  # needs: follow
from support.places import RECIPES, SHIPPED, script
from support.starters import OF_CAMS

import camgeo
from camgeo.recipe.starter import starter
from camgeo.schema.yaml_source import Source, scalars

if TYPE_CHECKING:
    from collections.abc import Iterator

live = script("live")
TEXTS = {name: starter(name) for name in OF_CAMS} | {f"{path.stem}.yaml": path.read_text("utf-8") for path in SHIPPED}


@pytest.fixture(autouse=True)
def folders(tmp_path: Path) -> Iterator[None]:
    """Of each test its own: in a browser nobody else is there."""
    with pytest.MonkeyPatch.context() as patch:  # designs stay shared: what is patched makes none
        for name in ("FOLDER", "OUT"):
            (tmp_path / name).mkdir()
            patch.setattr(live, name, str(tmp_path / name))
        yield


def part(text: str, field: dict[str, Any]) -> str:
    """What stands at a field's place, counted as browsers do."""
    return text.encode("utf-16-le")[2 * field["start"] : 2 * field["end"]].decode("utf-16-le")


def put(text: str, field: dict[str, Any], value: str) -> str:
    data = text.encode("utf-16-le")
    return (data[: 2 * field["start"]] + value.encode("utf-16-le") + data[2 * field["end"] :]).decode("utf-16-le")


@pytest.mark.thin(5)
@pytest.mark.parametrize("name", TEXTS)
def test_every_value_stands_where_its_field_says_and_another_one_leaves_all_else(name: str) -> None:
    text = TEXTS[name]
    fields = live.fields(Source.of(text, name))
    assert sum(field["kind"] == "number" for field in fields) >= 3
    before = {path: node.text for path, node in scalars(Source.of(text, name).root)}
    for field in fields:
        path = field["path"]
        shown = part(text, field)
        if "before" in field:  # a default, which the text has not
            assert shown == ""
            continue
        assert shown.strip("'\"") == field["text"]
        if field["kind"] == "number":
            after = {path: node.text for path, node in scalars(Source.of(put(text, field, "7.25"), name).root)}
            assert {where for where in after if after[where] != before[where]} <= {path}
            assert after[path].startswith("7.25")
            assert (
                field["value"] is None
                or float(shown) == field["value"]
                or "/" in shown
                or "*" in shown
                or "pi" in shown
            )


def test_numbers_have_units_and_bounds_words_have_their_choices() -> None:
    text = (
        "cam: {kind: disc, base_radius: 1.5 in, follower: {kind: roller, radius: '9'}, motion: [{rise: 20, over: 180,"
    )
    text += " law: cycloidal}, {return: 20, over: 180, law: cycloidal}]}\nabout: ein Nocken – 𝛼\npart: {bore: 8}\n"
    fields = {field["path"]: field for field in live.fields(Source.of(text, "x"))}
    assert (fields["cam.base_radius"]["unit"], part(text, fields["cam.base_radius"])) == ("in", "1.5")
    assert (fields["cam.follower.radius"]["unit"], part(text, fields["cam.follower.radius"])) == ("mm", "9")
    assert fields["cam.motion[0].over"]["unit"] == "degrees"
    assert "modified-sine" in fields["cam.motion[1].law"]["choices"]
    assert part(text, fields["part.bore"]) == "8"  # behind a character of two units


@pytest.mark.thin(21)
@pytest.mark.parametrize("name", OF_CAMS)
def test_a_recipe_in_inches_makes_the_same_cam_and_comes_back(name: str) -> None:
    text = TEXTS[name]
    inch = live.converted(name, text, "inch")["text"]
    assert re.search(r"^units: inch", inch, re.MULTILINE)
    first, second = (camgeo.design(camgeo.load(one)) for one in (text, inch))
    assert second.motion(1.0) == pytest.approx(first.motion(1.0), rel=1e-6, abs=1e-6)
    back = live.converted(name, inch, "mm")["text"]
    values = [{path: node.text for path, node in scalars(Source.of(one, name).root)} for one in (text, back)]
    formulas = {field["path"] for field in live.fields(Source.of(text, name)) if field["kind"] == "text"}
    assert {path for path in values[0] if values[0][path] != values[1][path]} <= formulas


def test_what_cannot_be_converted_is_said_and_left() -> None:
    text = next(path for path in SHIPPED if path.stem == "disc-table").read_text("utf-8")
    table = next(path for path in SHIPPED if path.stem == "disc-table").with_suffix(".csv").read_text("utf-8")
    (Path(live.FOLDER) / "disc-table.csv").write_text(table, "utf-8")
    assert "not all of these numbers" in live.converted("x", text, "inch")["faults"][0]["text"]


def test_faults_have_line_and_column() -> None:
    answer = json.loads(live.answer("design", json.dumps({"name": "x", "text": "cam: {kind: disk}\nunits: ell\n"})))
    assert [(fault["line"], fault["column"]) for fault in answer["faults"]] == [(1, 13), (2, 8)]
    assert "did you mean disc" in answer["faults"][0]["text"]
    assert answer["fields"] == [] or all(field["path"] != "cam.kind" for field in answer["fields"])


# needs: camshaft
@pytest.mark.parametrize("call", ["design", "make", "absent"])
def test_a_camshaft_is_made_by_the_command_which_is_named(call: str) -> None:
    text = (RECIPES / "camshafts" / "four-cylinder.yaml").read_text("utf-8")
    answer = json.loads(live.answer(call, json.dumps({"name": "engine", "text": text})))
    (fault,) = answer["faults"]
    assert fault["line"] == 2
    assert "this page makes no camshaft, which the command `camgeo export engine.yaml` does" in fault["text"]
    assert "here give the recipe of a lobe" in fault["text"]


def test_a_fault_of_its_own_is_told_and_not_raised() -> None:
    answer = json.loads(live.answer("design", json.dumps({"name": "x"})))
    assert answer["faults"][0]["text"] == "camgeo has failed"
    assert "TypeError" in answer["trace"]


def test_a_check_that_fails_comes_with_its_remedy_and_the_line_of_its_field() -> None:
    text = TEXTS["disc-roller"] + "limits: {pressure-angle: {at_most: 20}}\n"
    answer = live.design("x", text)
    (failed,) = answer["failed"]
    assert failed["line"] == text.count("\n")
    assert failed["path"] == "limits.pressure-angle.at_most"
    assert "a larger base radius" in failed["text"]
    assert 'data-at="226.42' in failed["place"]


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", OF_CAMS)
def test_the_picture_before_the_checks_is_that_of_the_design(name: str) -> None:
    picture, scene = live.picture("x", TEXTS[name]), live.design("x", TEXTS[name])["scene"]
    if "linkage:" in re.sub("#.*", "", TEXTS[name]):
        assert picture == {}
        return
    assert {key for key in picture if picture[key] != scene[key]} <= {"drawing"}
    first, second = (Counter(re.findall(r"-?\d+(?:\.\d+)?", one["drawing"])) for one in (picture, scene))
    assert (first - second).total() + (second - first).total() <= 4  # a bore begins on its other side


def test_a_cam_that_undercuts_has_a_picture_before_its_checks() -> None:
    text = TEXTS["disc-roller"].replace("base_radius: 36 ", "base_radius: 1 ")
    assert not live.design("x", text)["ok"]
    assert live.picture("x", text)["drawing"].startswith("<svg")


def test_fields_that_are_not_there_are_offered_and_added() -> None:
    text = TEXTS["disc-roller"]
    offered = {field["path"]: field for field in live.more("x", text)["more"]}
    assert {"limits", "part.keyway", "cam.follower.arm"} <= set(offered)
    assert "dynamics" in offered  # needs: dynamics
    assert not {"cam.base_radius", "cam.sizing"} & set(offered)
    added = live.added("x", text, "limits", "{pressure-angle: {at_most: 45}}")["text"]
    assert added.replace("limits: {pressure-angle: {at_most: 45}}\n", "") == text
    assert camgeo.design(camgeo.load(added)).ok
    assert "no value of YAML" in live.added("x", text, "limits", "{a: [}")["faults"][0]["text"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["disc-roller", "four-bar", "disc-groove", "double-roller"])
def test_the_policy_lets_every_judged_page_in(name: str) -> None:
    build = script("build")
    policies = {build.policy([build.judged_page(TEXTS[one])]) for one in (name, "support")}
    assert len(policies) == 1


def test_a_failed_set_gives_no_file_to_make_from() -> None:
    text = TEXTS["support"].replace("[dxf, svg, stl, csv, html]", "[dxf]") + "limits: {size: {at_most: 20}}\n"
    answer = live.make("failed", text)
    assert not answer["ok"]
    assert {file["name"].rpartition(".")[2] for file in answer["files"]} == {"html", "json"}


def test_what_cannot_be_made_for_want_of_a_package_is_named_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("camgeo.files.errors.find_spec", lambda name: None if name == "manifold3d" else name)
    text = TEXTS["disc-roller"]
    hub = text.replace("bore: 10 ", "bore: 10\n  hub: {diameter: 24, height: 6} ")
    assert not {"stl", "dxf", "svg"} & set(live.absent("x", text)["absent"])
    assert "manifold3d" in live.absent("x", hub)["absent"]["stl"]
    assert live.absent("x", text.replace("base_radius: 36 ", "base_radius: 1 "))["absent"] == {}


# needs: follow
FOLLOWER: dict[str, Any] = {
    **dict.fromkeys(
        ("roller", "shoe", "width", "offset", "pivot", "arm", "x", "y", "reading", "units", "gap", "across"), ""
    ),
    **dict.fromkeys(("diameter", "flat", "leading", "yoke"), False),
    "track": "external",
    "rotation": "cw",
}


# needs: follow
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "follower", "words"),
    [
        ("disc-roller", {"roller": "9", "offset": "8"}, "roller of radius 9 mm on a stem, offset 8 mm"),
        ("disc-flat", {"flat": True, "width": "34"}, "a centred face is"),
        ("disc-shoe", {"shoe": "6 cm", "reading": "0.02"}, "shoe of radius 60 mm"),
        # needs: milling
        ("disc-ring", {"roller": "6", "track": "internal"}, "inside a ring"),
        ("disc-groove", {"roller": "8", "track": "groove"}, "play in the groove"),
        ("disc-arm", {"roller": "8", "pivot": "80", "arm": "65"}, "on a trailing arm of 65 mm"),
    ],
)
def test_a_file_is_followed_by_what_the_page_offers(name: str, follower: dict[str, Any], words: str) -> None:
    report = camgeo.export(camgeo.load(TEXTS[name]), live.OUT, only=["dxf"])
    path = next(report.path.glob("*.dxf"))
    (Path(live.FOLDER) / "cam.dxf").write_bytes(path.read_bytes())
    answer = json.loads(live.answer("follow", json.dumps({"file": "cam.dxf", "follower": FOLLOWER | follower})))
    assert words in answer["verdict"]
    assert answer["page"]


# needs: follow
def test_ends_that_do_not_meet_are_joined_where_the_page_is_told_how_near() -> None:
    drawing = ezdxf.new(units=4)
    corners = [(30.0 * math.cos(k * math.pi / 18), 25.0 * math.sin(k * math.pi / 18)) for k in range(37)]
    corners[-1] = (30.0, -0.02)
    for line in pairwise(corners):
        drawing.modelspace().add_line(*line)
    drawing.saveas(Path(live.FOLDER) / "open.dxf")
    follower = FOLLOWER | {"roller": "8", "reading": "0.2"}
    refused = json.loads(live.answer("follow", json.dumps({"file": "open.dxf", "follower": follower})))
    (asked,) = set(re.findall(r"let ends of its lines meet within (\S+) mm", json.dumps(refused)))
    answer = json.loads(live.answer("follow", json.dumps({"file": "open.dxf", "follower": follower | {"gap": asked}})))
    assert "lift" in answer.get("verdict", ""), answer
    judged = json.loads(
        live.answer(
            "verify",
            json.dumps({"name": "c", "text": TEXTS["disc-roller"], "file": "open.dxf", "units": "", "gap": asked}),
        )
    )
    assert judged["ok"] is False  # a figure of each, for another cam


# needs: follow
def test_a_file_that_is_not_judged_has_the_curves_of_its_motion_and_says_why(tmp_path: Path) -> None:
    design = camgeo.export(camgeo.load(TEXTS["disc-roller"]), tmp_path, only=["dxf"])
    (Path(live.FOLDER) / "cam.dxf").write_bytes((design.path / "recipe.dxf").read_bytes())
    follower = FOLLOWER | {"roller": "9", "x": "1"}
    answer = json.loads(live.answer("follow", json.dumps({"file": "cam.dxf", "follower": follower})))
    assert answer["verdict"].endswith("Not judged is the file: a page judges a file about its own origin")
    assert "Acceleration" in answer["page"]
    assert "leave" not in answer["verdict"]
    follower = FOLLOWER | {"roller": ""}
    (fault,) = json.loads(live.answer("follow", json.dumps({"file": "cam.dxf", "follower": follower})))["faults"]
    assert fault["told"] == "say how large the touch is: its box is empty"


# needs: follow
@pytest.mark.slow
def test_a_roller_goes_by_its_diameter_and_a_polygon_has_the_reading_that_it_allows() -> None:
    design = camgeo.design(camgeo.load(TEXTS["disc-roller"]))
    polygon(Path(live.FOLDER) / "points.dxf", design.contour(120))
    follower = FOLLOWER | {"roller": "18", "diameter": True, "offset": "8"}
    answer = json.loads(live.answer("follow", json.dumps({"file": "points.dxf", "follower": follower})))
    assert "roller of radius 9 mm" in answer.get("verdict", ""), answer
    reading = float(re.search(r"reading: ([\d.]+)", answer["recipe"])[1])
    assert 0.01 < reading < 0.05
    (Path(live.FOLDER) / next(iter(answer["tables"]))).write_text(next(iter(answer["tables"].values())), "utf-8")
    motion = camgeo.design(live._recipe("points", answer["recipe"])).motion
    shaft = np.linspace(0.0, 6.2, 300)
    law = design.motion(shaft, derivative=2)
    assert np.abs(motion(shaft, derivative=2)).max() == pytest.approx(np.abs(law).max(), rel=0.1)
    assert "smoothed_acceleration" in Path(answer["files"][0]["path"]).read_text("utf-8")


@pytest.mark.parametrize("name", ["disc-roller", "support"])
def test_a_table_becomes_the_motion(name: str) -> None:
    rows = "".join(f"{angle},{10 - 10 * np.cos(np.radians(angle)):.6f}\n" for angle in range(0, 361, 2))
    (Path(live.FOLDER) / "lift.csv").write_text(f"angle,lift\n{rows}", "utf-8")
    text = live.with_table("x", TEXTS[name], "lift.csv")["text"]
    answer = live.design("x", text)
    assert answer["faults"] == []
    assert "table: lift.csv" in text
    assert camgeo.design(live._recipe("x", text)).motion(np.pi) == pytest.approx(20.0, abs=1e-4)


# needs: follow
def test_a_length_that_is_none_is_named() -> None:
    call = {"file": "cam.dxf", "follower": FOLLOWER | {"roller": "9 ell"}}
    answer = json.loads(live.answer("follow", json.dumps(call)))
    assert answer["faults"][0]["text"].startswith("roller: 9 ell is no length")


@pytest.mark.slow
def test_modules_are_compiled_and_all_else_stays(tmp_path: Path) -> None:
    build = script("build")
    archive = tmp_path / "numpy.whl"
    texts = {"a/__init__.py": "b = 1", "a/c.py": "d = 2", "a/c.pyi": "d: int", "a/e.so": "binary", "a/tests/f.py": ""}
    texts |= {"a/g/__init__.py": "", "a/g/h.py": "", "i.py": ""}
    with ZipFile(archive, "w") as wheel:
        for name, content in texts.items():
            wheel.writestr(name, content)
    with ZipFile(archive) as wheel:
        wheel.extractall(tmp_path / "folder")
    if build.python_of_pyodide() is None:
        pytest.skip("no Python of the version of Pyodide's here, which compiles")
    first, rare = (ZipFile(io.BytesIO(one)) for one in build.repacked(archive, ("a.g", "i")))
    assert first.read("a/e.so") == b"binary"
    assert first.namelist() == ["a/__init__.pyc", "a/c.pyc", "a/e.so"]
    assert rare.namelist() == ["a/g/__init__.pyc", "a/g/h.pyc", "i.pyc"]
    whole = ZipFile(io.BytesIO(build.compiled(tmp_path / "folder", "__init__.py")))
    assert {"a/__init__.py", "a/c.pyc", "a/c.pyi", "i.pyc"} <= set(whole.namelist())


def test_a_module_comes_when_it_is_imported_and_not_when_it_is_looked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
    fetched = []

    def fetch() -> None:
        fetched.append(True)
        if len(fetched) == 1:
            raise OSError("later.zip: the server answers 404")
        (tmp_path / "a_late_one").mkdir()
        (tmp_path / "a_late_one" / "__init__.py").write_text("from a_late_one.inner import VALUE\n", "utf-8")
        (tmp_path / "a_late_one" / "inner.py").write_text("VALUE = 3\n", "utf-8")

    (tmp_path / "listed").write_text("a_late_one\nanother\n", "utf-8")
    script("later").install(fetch, tmp_path / "listed")
    assert find_spec("a_late_one") is not None
    assert find_spec("a_third") is None
    assert fetched == []
    with pytest.raises(ConnectionError, match="404"):
        import_module("a_late_one")
    assert import_module("a_late_one").VALUE == 3
    assert import_module("a_late_one.inner").VALUE == 3
    with pytest.raises(ModuleNotFoundError):
        import_module("another")  # the archive has come without it
    assert len(fetched) == 2
    for name in ("a_late_one", "a_late_one.inner"):
        monkeypatch.delitem(sys.modules, name)


def test_a_capability_that_is_gone_takes_its_part_of_the_page_along(monkeypatch: pytest.MonkeyPatch) -> None:
    build = script("build")
    parts = build.with_parts()
    assert "follow" in parts  # needs: follow
    core = "".join((build.WEB / name).read_text("utf-8") for name in ("index.html", *build.scripts_of([]), "tab.css"))
    for name in parts:
        ids = re.findall(r' id="([\w-]+)"', (build.WEB / f"{name}.html").read_text("utf-8"))
        assert [one for one in ids if re.search(rf"(id=\"|byId\(\"|#){one}\b", core)] == []
    monkeypatch.setattr("camgeo.registry.registry.labels", dict)
    assert build.with_parts() == []


@pytest.mark.thin(5)
@pytest.mark.parametrize("name", TEXTS)
def test_without_comments_a_recipe_says_the_same(name: str) -> None:
    source = Source.of(TEXTS[name], name)
    bare = live.bare(source)
    before, after = ([(path, node.text) for path, node in scalars(one.root)] for one in (source, Source.of(bare, name)))
    assert before == after
    assert not re.search(r"^\s*#", bare, re.MULTILINE)


def test_what_looks_like_a_comment_and_is_none_stays() -> None:
    text = "# whole\n'a # b': \"c # d\" # e\nf: g#h # i\nj: |\n  k # l\n\n  # m\nn: [1, # o\n  2] # p"
    bare = live.bare(Source.of(text, "x"))
    assert bare == "'a # b': \"c # d\"\nf: g#h\nj: |\n  k # l\n\n  # m\nn: [1,\n  2]"


def test_faults_are_told_in_words_of_the_page() -> None:
    text = TEXTS["disc-roller"].replace("rise: 20", "rise: 15")
    (fault,) = live.design("x", text)["faults"]
    assert "the lift jumps from 0 to 5 mm" in fault["told"]
    assert fault["text"] == f"cam.motion: {fault['told']}"
    said = live.in_words_of_the_page("S(t + 180) = S(180) - S(t): S' is 3; give it by --units, such as --units inch")
    assert said.startswith("the lift at t + 180 = the lift at 180 - the lift at t: the velocity is 3; ")
    assert said.endswith("choose the unit of the file, such as inch")
    said = live.in_words_of_the_page("the contour is open; give across arc or chord to close it there")
    assert said == "the contour is open; choose how the contour goes on where it is open"
    (empty,) = live.design("x", "")["faults"]
    assert "camgeo" not in empty["told"]


def test_a_segment_without_a_law_has_its_default_as_a_field() -> None:
    text = starter("toy").replace("    - {rise: 15, over: 80}\n", "    - rise: 15\n      over: 80  # slow\n", 1)
    fields = {field["path"]: field for field in live.fields(Source.of(text, "x"))}
    for path, after in (
        ("cam.motion[0].law", "    - rise: 15\n      over: 80\n      law: cycloidal  # slow\n"),
        ("cam.motion[1].law", "    - {return: 15, over: 80, law: cycloidal}\n"),
    ):
        field = fields[path]
        assert (field["text"], part(text, field)) == ("modified-sine", "")
        changed = put(text, field, f"{field['before']}cycloidal")
        assert after in changed
        assert camgeo.design(camgeo.load(changed)).ok
    assert "cam.motion[2].law" not in fields  # of a dwell
