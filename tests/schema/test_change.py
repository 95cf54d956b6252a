"""Recipes from a program: values by path, comments kept; mappings as YAML."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

import camgeo
from camgeo.recipe.loading import load, load_text
from camgeo.schema.change import Value, set_value, yaml_text
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import read_source, scalars

ROOT = Path(__file__).parents[2]
RECIPES = sorted((ROOT / "recipes").glob("*.yaml"))
TEXT = """\
# a cam
cam:
  kind: constant-breadth          # a yoke
  base_radius: 30  # mm
  motion:
    - {rise: 12, over: 120, law: modified-sine}   # first
    - {dwell: 60}
part: {bore: 12, thickness: 8}
export:
  files: [dxf, stl]

"""


def test_a_value_is_changed_and_all_else_stays() -> None:
    recipe = load_text(TEXT, "cam.yaml").replace("cam.base_radius", 42)
    assert recipe.text == TEXT.replace("base_radius: 30  #", "base_radius: 42  #")
    assert vars(recipe.cam)["base_radius"] == 42.0


def test_several_values_at_once_of_every_kind() -> None:
    old = load_text(TEXT, "cam.yaml")
    new = old.replace({"cam.motion[0].rise": 10.5, "part.bore": np.float64(11.0), "cam.kind": "constant-breadth"})
    assert new.text == TEXT.replace("rise: 12", "rise: 10.5").replace("bore: 12", "bore: 11")
    assert old.text == TEXT
    assert new.replace("export.files", ["dxf", {"stl": {"tolerance": 0.01}}]).export.files[1].tolerance == 0.01


@pytest.mark.parametrize(
    ("path", "value", "line"),
    [
        ("name", "small", "name: small\n"),
        ("about", "line: 'x' # no \"y\"", 'about: "line: \'x\' # no \\"y\\""\n'),
        ("export.tolerance", 0.002, "  tolerance: 0.002\n"),
        ("part.wall", 2, "part: {bore: 12, thickness: 8, wall: 2}\n"),
        ("verify.angles", 720, "verify: {angles: 720}\n"),
    ],
)
def test_a_field_that_is_not_there_is_added(path: str, value: str | float, line: str) -> None:
    text = load_text(TEXT, "cam.yaml").replace(path, value).text
    assert line in text
    kept = [one for one in TEXT.splitlines() if one and not one.startswith("part")]
    assert [one for one in text.splitlines() if one in kept] == kept


def test_a_field_without_a_value_gets_one() -> None:
    text = set_value(read_source(b"about:\ncam: 3", "r"), "about", "x")
    assert text == "about: x\ncam: 3"
    assert set_value(read_source(text.encode(), "r"), "part.bore", 3) == "about: x\ncam: 3\npart: {bore: 3}\n"


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("cam.motion[7].rise", 3, "the entry does not exist"),
        ("cam.foo[1]", 3, "the entry does not exist"),
        ("cam.base_radius.x", 3, "the field does not exist"),
        ("cam..x", 3, "not the path of a field"),
        ("", 3, "not the path of a field"),
        ("cam.base_radius", float("nan"), "a number is finite"),
        ("cam.base_radius", {1, 2}, "neither a text, a number, a list nor a mapping"),
        ("cam.base_radiu", 3, "did you mean base_radius?"),
        ("cam.base_radius", -3, "base_radius"),
    ],
)
def test_what_cannot_be_is_refused_by_its_path(path: str, value: object, message: str) -> None:
    with pytest.raises(RecipeErrors, match=message.replace("?", r"\?")) as caught:
        load_text(TEXT, "cam.yaml").replace(path, value)
    assert path in str(caught.value)


def test_what_an_alias_shares_is_left_alone() -> None:
    source = read_source(b"part: {bore: &b 12, wall: *b}\n", "r")
    with pytest.raises(RecipeErrors, match="an alias shares this place"):
        set_value(source, "part.bore", 13)


@pytest.mark.slow
def test_any_scalar_of_the_shipped_recipes_can_be_replaced() -> None:
    dice = random.Random(7)
    assert len(RECIPES) >= 30
    for path in RECIPES:
        source = read_source(path.read_bytes(), str(path))
        found = dict(scalars(source.root))
        for at in dice.sample(sorted(found), 4):
            new = read_source(set_value(source, at, "x y: #1").encode(), "new")
            assert {k: v.text for k, v in scalars(new.root)} == {k: v.text for k, v in found.items()} | {at: "x y: #1"}
            assert [n.count("#") for n in new.lines].count(0) <= [o.count("#") for o in source.lines].count(0)


@pytest.mark.thin(4)
@pytest.mark.parametrize("path", RECIPES[::6], ids=lambda path: path.stem)
def test_a_recipe_saved_is_the_same(path: Path, tmp_path: Path) -> None:
    load(path).save(tmp_path / path.name)
    assert (tmp_path / path.name).read_bytes() == path.read_bytes()


def test_a_mapping_is_written_so_that_it_reads_back() -> None:
    values = {
        "about": "on",
        "units": "inch",
        "cam": {"kind": "support", "p": "2 + 0.1*cos(3*t)"},
        "part": {"bore": np.int64(1), "thickness": "1/4"},
        "export": {"files": ["dxf", {"stl": {"tolerance": 1e-05}}], "tolerance": "1/1000"},
    }
    text = yaml_text(values, "recipe")
    recipe = load_text(text, "recipe")
    assert (recipe.about, recipe.part.bore, recipe.export.files[1].tolerance) == ("on", 25.4, 25.4e-5)
    assert yaml_text({"a": {"b": [1, 2.5, True, None], "c": {}}}, "r") == "a:\n  b: [1, 2.5, true, null]\n  c: {}\n"


def test_a_mapping_that_holds_itself_is_refused() -> None:
    loop: dict[str, object] = {}
    loop["a"] = loop
    with pytest.raises(RecipeErrors, match="nested more than"):
        yaml_text(loop, "recipe")
    with pytest.raises(RecipeErrors, match="a key is a text"):
        yaml_text({1: 2}, "recipe")  # type: ignore[dict-item]


def test_arrays_of_numpy_are_lists() -> None:
    """Of one dimension and of two, in a mapping that is loaded and in a value that is put in place; numbers too."""
    points = [[0.0, 0.0], [90.0, 5.0], [180.0, 10.0], [270.0, 5.0]]
    follower: dict[str, Value] = {"kind": "roller", "radius": np.array(8)}
    cam: dict[str, Value] = {"kind": "disc", "base_radius": np.float64(30), "follower": follower}
    rows = {form: camgeo.load({"cam": {**cam, "motion": {"points": form(points)}}}).text for form in (list, np.array)}
    assert rows[list].replace(".0", "") == rows[np.array]
    shafted = camgeo.load("cam: {kind: support, p: 30 + cos(3*t), shaft: [1, 2]}\n")
    assert shafted.replace("cam.shaft", np.array([3, 4.5])).text == shafted.replace("cam.shaft", [3, 4.5]).text
    for wrong in (
        np.zeros((2, 2, 2)),
        np.array([np.nan, 1]),
        np.array(["a", "b"]),
        np.array([1j, 2]),
        np.array([[1, 2]]),
    ):
        with pytest.raises(camgeo.RecipeErrors, match=r"cam\.shaft"):
            shafted.replace("cam.shaft", wrong)
