"""Former names of keys and figures: read with a notice, named in errors as written, published as deprecated."""

from __future__ import annotations

import csv
import json
import warnings
from typing import TYPE_CHECKING

import pytest

import camgeo
from camgeo.cli.main import main
from camgeo.output import pipeline
from camgeo.recipe.figures import FIGURES, FORMER, PRESENT
from camgeo.recipe.keys import RECIPE
from camgeo.recipe.loading import load, load_text
from camgeo.schema.errors import DeprecatedKeyWarning, RecipeErrors
from camgeo.schema.fields import field_at, present
from camgeo.schema.json_schema import json_schema

if TYPE_CHECKING:
    from pathlib import Path

SHAFT = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [4, 3]}\n"
PIVOT = SHAFT.replace("shaft", "pivot")
TRAIN = "dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, backlash: 0.05, rpm: 600}\n"
SWEEP = """\
export: {tolerance: 0.01, files: [dxf]}
verify: {angles: 60}
sweep:
  vary: {'cam.KEY[0]': {from: 1, to: 5, steps: 3}}
  limits: {FIGURE: {at_least: 1}}
  rank: FIGURE
"""
KINDS = {"cam": "support", "linkage": ""}


def told(text: str) -> list[str]:
    with pytest.raises(RecipeErrors) as caught:
        load_text(text, "cam.yaml")
    return [str(error) for error in caught.value.errors]


def notices(text: str) -> list[str]:
    return [str(notice) for notice in load_text(text, "cam.yaml").notices]


def test_a_former_key_reads_as_the_present_one_with_one_notice_each() -> None:
    assert load_text(PIVOT, "cam.yaml") == load_text(SHAFT, "cam.yaml")
    assert notices(SHAFT + TRAIN) == []
    assert notices(PIVOT + TRAIN.replace("backlash", "play")) == [
        "cam.yaml:1:42: cam.pivot: a former name, read in this version alone; write shaft",
        "cam.yaml:2:54: dynamics.play: a former name, read in this version alone; write backlash",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PIVOT.replace("[4, 3]", "[4, a]"), "1:53: cam.pivot[1]: not a number, given 'a'; give a length in mm"),
        (
            PIVOT.replace("[4, 3]", "4"),
            "1:49: cam.pivot: not a point, given 4; give a list of two lengths [x, y] in mm",
        ),
        (
            PIVOT.replace("pivot:", "shaft: [1, 2], pivot:"),
            "1:57: cam.pivot: the former name of shaft, which is given too; leave it out",
        ),
        (
            SHAFT + TRAIN.replace("backlash", "preload: 3, play"),
            "2:72: dynamics.play: cannot be combined with preload; give exactly one of preload or backlash",
        ),
        (
            SHAFT + TRAIN.replace("backlash", "rate: 3, play"),
            "2:60: dynamics.rate: a spring rate beside play; give preload in place of play, or leave the rate out",
        ),
        (
            SHAFT + "limits: {face-length: {at_most: a}}\n",
            "2:33: limits.face-length.at_most: not a number, given 'a'; give a number in mm",
        ),
        (
            SHAFT + "limits: {transmission: {at_most: 1}}\n",
            (
                "2:24: limits.transmission: velocity-ratio needs a cam of "
                "kind double-roller or flat-pair; the figures of this recipe are "
            ),
        ),
    ],
)
def test_errors_name_the_key_that_was_written(text: str, message: str) -> None:
    (one,) = told(text)
    assert one.startswith(f"cam.yaml:{message}")


@pytest.mark.parametrize("written", [SHAFT, PIVOT])
@pytest.mark.parametrize("asked", ["shaft", "pivot"])
def test_a_value_is_replaced_by_either_key_and_the_key_stays(written: str, asked: str) -> None:
    recipe = load_text(written, "cam.yaml")
    assert recipe.replace(f"cam.{asked}", [1, 2]).text == written.replace("[4, 3]", "[1, 2]")
    assert recipe.replace(f"cam.{asked}[1]", -5).text == written.replace("[4, 3]", "[4, -5]")


def test_the_library_warns_from_wherever_a_recipe_comes(tmp_path: Path) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(PIVOT)
    cam = {"kind": "support", "p": "25 + 2*cos(3*t)", "pivot": [4, 3]}
    for source in (path, PIVOT, {"cam": cam}):
        with pytest.warns(DeprecatedKeyWarning, match=r"cam\.pivot: a former name.*write shaft$") as caught:
            camgeo.load(source)
        assert [one.filename for one in caught] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        camgeo.load(SHAFT)


def test_an_error_of_a_later_stage_names_it_too() -> None:
    recipe = load_text(PIVOT, "cam.yaml")
    assert str(recipe.error("cam.shaft", "the shaft lies outside the cam")) == (
        "cam.yaml:1:49: cam.pivot: the shaft lies outside the cam"
    )
    assert load_text(SHAFT, "cam.yaml").written("cam.shaft[0]") == "cam.shaft[0]"
    limited = load_text(SHAFT + "limits: {face-length: {at_most: 9}}\n", "cam.yaml")
    assert limited.locate("limits.contact-travel.at_most") == (2, 33)


@pytest.mark.parametrize(("key", "path"), [("shaft", "pivot"), ("pivot", "shaft"), ("pivot", "pivot")])
def test_paths_reach_the_number_by_either_key(key: str, path: str) -> None:
    recipe = load_text(SHAFT.replace("shaft", key), "cam.yaml")
    assert recipe.text_with({f"cam.{path}[1]": -2}) == recipe.text.replace("3]", "-2]")
    text = SHAFT.replace("shaft", key) + SWEEP.replace("KEY", path).replace("FIGURE", "size")
    (axis,) = load_text(text, "cam.yaml").sweep.vary
    assert (axis.path, axis.low, axis.high) == (f"cam.{path}[0]", 1.0, 5.0)
    assert len(notices(text)) == 1
    assert notices(text)[0].endswith(("write shaft", "write cam.shaft"))
    assert told(text.replace("[0]'", "[2]'"))[0].endswith(f"did you mean cam.{key}[1]?")


def test_present_paths() -> None:
    assert present(RECIPE, "cam.pivot[1]", KINDS) == "cam.shaft[1]"
    assert present(RECIPE, "dynamics.play", KINDS) == "dynamics.backlash"
    for path in (
        "cam.shaft[1]",
        "cam.fourier.cos.3",
        "linkage.dyads[0].ground[1]",
        "pivot",
        "linkage.pivot",
        "cam[",
        "",
    ):
        assert present(RECIPE, path, KINDS) == path
    assert field_at(RECIPE, "cam.pivot[0]", KINDS) is field_at(RECIPE, "cam.shaft[0]", KINDS) is not None


def test_a_library_is_warned_and_a_command_says_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(PIVOT + "export: {tolerance: 0.01, files: [dxf]}\nverify: {angles: 60}\n")
    line = f"{path}:1:42: cam.pivot: a former name, read in this version alone; write shaft"
    with pytest.warns(DeprecatedKeyWarning) as caught:
        load(path)
    assert [str(one.message) for one in caught] == [line]
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["check", str(path)]) == 0
    assert capsys.readouterr().err == line + "\n"


def test_renamed_checks_say_their_former_names() -> None:
    limits = "limits: {face-length: {at_most: 99}}\n"
    text = PIVOT + limits + "export: {tolerance: 0.01, files: [csv]}\nverify: {angles: 60}\n"
    checks = {check["name"]: check for check in pipeline.check(load_text(text, "cam.yaml")).report["checks"]}
    assert checks["contact-travel"]["formerly"] == "face-length"
    assert checks["limit:contact-travel"]["formerly"] == "limit:face-length"
    assert "formerly" not in checks["radius-of-curvature"]
    assert not {"face-length", "limit:face-length"} & checks.keys()


def test_the_check_of_a_pitch_curve_has_the_name_of_its_figure() -> None:
    motion = "[{rise: 8, over: 180, law: cycloidal}, {return: 8, over: 180, law: cycloidal}]"
    for follower, name in (("roller, radius: 5", "pitch-radius"), ("knife-edge", "radius-of-curvature")):
        text = f"cam: {{kind: disc, base_radius: 30, follower: {{kind: {follower}}}, motion: {motion}}}\n"
        design = camgeo.design(camgeo.load(text))
        report = camgeo.check(camgeo.load(text + "export: {tolerance: 0.01, files: [csv]}\nverify: {angles: 60}\n"))
        (told,) = (one for one in report["checks"] if one["name"] in {"pitch-radius", "radius-of-curvature"})
        assert told["name"] == name
        assert told.get("formerly") == ("radius-of-curvature" if name == "pitch-radius" else None)
        checks = {check.name: check.value for check in design.checks}
        metal = design.figures["radius-of-curvature"].value
        pitch = design.figures["pitch-radius"].value if name == "pitch-radius" else metal
        assert checks[name] == pitch
        assert (checks[name] == metal) is (name == "radius-of-curvature")


@pytest.mark.slow
def test_a_sweep_writes_both_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "swept.yaml"
    path.write_text(PIVOT + SWEEP.replace("KEY", "pivot").replace("FIGURE", "face-length"))
    assert main(["sweep", str(path), "--out", str(tmp_path / "out"), "-v"]) == 0
    said = capsys.readouterr()
    assert said.err.count("a former name") == 3
    assert "swept: contact-travel " in said.out
    assert "face-length" not in said.out
    rows = list(csv.DictReader((tmp_path / "out" / "swept" / "sweep.csv").read_text().splitlines()))
    assert rows[0]["contact-travel_mm"] == rows[0]["face-length_mm"] != ""
    assert "cam.pivot[0]" in rows[0]
    found = json.loads((tmp_path / "out" / "swept" / "sweep.json").read_text())
    best = found["best"][0]["figures"]
    assert best["face-length"] == best["contact-travel"]
    assert {"face-length", "contact-travel"} <= found["figures"].keys()
    assert "pivot: [" in (tmp_path / "out" / "swept" / "best-1.yaml").read_text()


def test_the_schema_has_former_names_as_deprecated() -> None:
    schema = json_schema(RECIPE)["properties"]
    (support,) = (one for one in schema["cam"]["oneOf"] if one["properties"]["kind"]["const"] == "support")
    assert support["properties"]["pivot"]["deprecated"]
    assert support["properties"]["pivot"]["items"] == support["properties"]["shaft"]["items"]
    held = schema["dynamics"]["oneOf"]
    assert [one["required"] for one in held] == [["preload"], ["backlash"], ["play"], []]  # a rigid train may have none
    assert held[2]["properties"] == {"backlash": False, "preload": False}
    assert held[3]["properties"] == {"backlash": False, "play": False, "preload": False}
    words, former = schema["sweep"]["properties"]["rank"]["anyOf"]
    assert former == {"enum": ["transmission", "face-length"], "deprecated": True}
    assert not {*former["enum"]} & {*words["enum"]}


def test_no_former_name_is_a_present_one() -> None:
    assert not FORMER.keys() & PRESENT.keys()
    assert FORMER.keys() <= FIGURES.keys()
    assert not PRESENT.keys() & FIGURES.keys()


@pytest.mark.parametrize("keys", [("pivot", "shaft"), ("shaft", "pivot")])
@pytest.mark.parametrize("written", [SHAFT, PIVOT])
def test_a_sweep_varies_a_number_by_one_of_its_names_alone(written: str, keys: tuple[str, str]) -> None:
    text = written + SWEEP.replace("KEY", keys[0]).replace("FIGURE", "size")
    second = f"}}, 'cam.{keys[1]}[0]': [1, 2]}}\n  limits"
    (one,) = told(text.replace("}}\n  limits", second))
    assert one.endswith(
        f"sweep.vary.'cam.{keys[1]}[0]': varies the same number as cam.{keys[0]}[0]; leave one of the two out"
    )
    assert not any("varies" in str(notice) for notice in load_text(text, "cam.yaml").notices)
    other = second.replace("[0]", "[1]")
    assert len(load_text(text.replace("}}\n  limits", other), "cam.yaml").sweep.vary) == 2
