"""What the page's worker asks of camgeo, asked here: fields and their places, units, faults, the policy of the page."""

from __future__ import annotations

import io
import json
import re
from collections import Counter
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
from support.places import RECIPES, SHIPPED, script
from support.starters import OF_CAMS

import camgeo
from camgeo.recipe.starter import starter
from camgeo.schema.yaml_source import Source, scalars

live = script("live")
TEXTS = {name: starter(name) for name in OF_CAMS} | {f"{path.stem}.yaml": path.read_text("utf-8") for path in SHIPPED}


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of each test its own: in a browser nobody else is there."""
    for name in ("FOLDER", "OUT"):
        (tmp_path / name).mkdir()
        monkeypatch.setattr(live, name, str(tmp_path / name))


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
        assert shown.strip("'\"") == field["text"]
        if field["kind"] == "number":
            after = {path: node.text for path, node in scalars(Source.of(put(text, field, "7.25"), name).root)}
            assert {where for where in after if after[where] != before[where]} <= {path}
            assert after[path].startswith("7.25")
            assert float(shown) == field["value"] or "/" in shown or "*" in shown or "pi" in shown


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
    assert 'data-deg="226.42' in failed["place"]


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
    policies = {build.policy(build.first_page(TEXTS[one])) for one in (name, "support")}
    assert len(policies) == 1


def test_a_failed_set_gives_no_file_to_make_from() -> None:
    text = TEXTS["support"].replace("[dxf, svg, stl, csv, html]", "[dxf]") + "limits: {size: {at_most: 20}}\n"
    answer = live.make("failed", text)
    assert not answer["ok"]
    assert {file["name"].rpartition(".")[2] for file in answer["files"]} == {"html", "json", "zip"}


def test_what_cannot_be_made_for_want_of_a_package_is_named_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("camgeo.files.errors.find_spec", lambda name: None if name == "manifold3d" else name)
    text = TEXTS["disc-roller"]
    hub = text.replace("bore: 10 ", "bore: 10\n  hub: {diameter: 24, height: 6} ")
    assert not {"stl", "dxf", "svg"} & set(live.absent("x", text)["absent"])
    assert "manifold3d" in live.absent("x", hub)["absent"]["stl"]
    assert live.absent("x", text.replace("base_radius: 36 ", "base_radius: 1 "))["absent"] == {}


# needs: follow
FOLLOWER: dict[str, Any] = {
    **dict.fromkeys(("roller", "shoe", "width", "offset", "pivot", "arm", "x", "y", "reading", "units"), ""),
    **dict.fromkeys(("flat", "leading", "yoke"), False),
    "track": "external",
    "rotation": "cw",
}


# needs: follow
@pytest.mark.thin(3)
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
def test_a_length_that_is_none_is_named() -> None:
    call = {"file": "cam.dxf", "follower": FOLLOWER | {"roller": "9 ell"}}
    answer = json.loads(live.answer("follow", json.dumps(call)))
    assert answer["faults"][0]["text"].startswith("roller: 9 ell is no length")


@pytest.mark.parametrize("kept", ["", "__init__.py"])
def test_modules_are_compiled_and_all_else_stays(tmp_path: Path, kept: str) -> None:
    build = script("build")
    archive = tmp_path / "numpy.whl"
    with ZipFile(archive, "w") as wheel:
        for name, text in {
            "a/__init__.py": "b = 1",
            "a/c.py": "d = 2",
            "a/c.pyi": "d: int",
            "a/e.so": "binary",
        }.items():
            wheel.writestr(name, text)
    with ZipFile(archive) as wheel:
        wheel.extractall(tmp_path / "folder")
    if build.python_of_pyodide() is None:
        pytest.skip("no Python of the version of Pyodide's here, which compiles")
    packed = build.compiled(tmp_path / "folder", kept) if kept else build.repacked(archive)
    with ZipFile(io.BytesIO(packed)) as made:
        names = made.namelist()
        assert made.read("a/e.so") == b"binary"
    package = "a/__init__.py" if kept else "a/__init__.pyc"
    assert names == ([package, "a/c.pyc", "a/c.pyi", "a/e.so"] if kept else [package, "a/c.pyc", "a/e.so"])


def test_a_capability_that_is_gone_takes_its_part_of_the_page_along(monkeypatch: pytest.MonkeyPatch) -> None:
    build = script("build")
    parts = build.with_parts()
    assert "follow" in parts  # needs: follow
    core = "".join((build.WEB / name).read_text("utf-8") for name in ("index.html", "tab.js", "tab.css"))
    for name in parts:
        ids = re.findall(r' id="([\w-]+)"', (build.WEB / f"{name}.html").read_text("utf-8"))
        assert [one for one in ids if re.search(rf"(id=\"|byId\(\"|#){one}\b", core)] == []
    monkeypatch.setattr("camgeo.registry.registry.labels", dict)
    assert build.with_parts() == []
