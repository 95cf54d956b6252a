"""Edits of a recipe's own text: what is meant changes, and nothing else, however the text is written."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from support.cases import few
from support.places import SHIPPED

from camgeo.recipe.loading import load_text
from camgeo.schema.edit import number_text, remove_section, with_values
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.scalars import read_number
from camgeo.schema.yaml_source import Scalar, read_source, scalars

if TYPE_CHECKING:
    from pathlib import Path

TEXT = """\
# a four-bar   é 😀
name: x
"cam": {kind: support, "fourier": {mean: 25, cos: {3: 1, 5: '2'}}, shaft: [1,2]}  # shaft at 1
linkage:
  kind: four-bar
  ground: &r 80     # r1
  coupler: 70
  rocker:
    105
  dyads:
  - kind: rrr
    point: [ 1.5 , 13/15 ]
    ground: [-1,-2]
    links:
    - 80.0
    - |-
      5

# about the search
sweep:   # all of it
  vary:
    linkage.rocker: {from: 95,
       to: 110}   # rocker
    # no more

  # really

# about verify
verify: {angles: 500}
"""


@pytest.fixture(params=["CSafeLoader", "SafeLoader"], autouse=True)
def _reader(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run with PyYAML's fast reader and with its own: the marks must agree."""
    if request.param == "SafeLoader":
        monkeypatch.delattr(yaml, "CSafeLoader", raising=False)


def values(text: str) -> dict[str, str]:
    return {path: scalar.text for path, scalar in scalars(read_source(text.encode(), "x").root)}


# --- numbers ----------------------------------------------------------------------------------------------------------


def test_numbers_are_replaced_where_they_stand_and_comments_stay() -> None:
    changes = {
        "cam.fourier.mean": 25.5,
        "cam.fourier.cos.3": -1.25,
        "cam.fourier.cos.5": 1e-7,
        "cam.shaft[0]": 10,
        "cam.shaft[1]": 3.0,
        "linkage.ground": 81,
        "linkage.rocker": 1 / 3,
        "linkage.dyads[0].point[1]": 2,
        "linkage.dyads[0].ground[1]": 0.0,
        "linkage.dyads[0].links[0]": 79.5,
        "linkage.dyads[0].links[1]": 6,
        "verify.angles": 720,
    }
    expected = (
        TEXT.replace(
            "mean: 25, cos: {3: 1, 5: '2'}}, shaft: [1,2]", "mean: 25.5, cos: {3: -1.25, 5: '1e-07'}}, shaft: [10,3]"
        )
        .replace("&r 80 ", "81 ")
        .replace("    105", "    0.3333333333333333")
        .replace("13/15", "2")
        .replace("[-1,-2]", "[-1,0]")
        .replace("80.0", "79.5")
        .replace("|-\n      5\n", "6\n")
        .replace("500", "720")
    )
    assert with_values(TEXT, changes) == expected
    assert with_values(TEXT, dict(reversed(changes.items()))) == expected
    assert with_values(read_source(TEXT.encode(), "x"), changes) == expected


@pytest.mark.parametrize("ends", ["\r\n", "\r"])
def test_line_ends_stay(ends: str) -> None:
    text = TEXT.replace("\n", ends)
    changed = with_values(text, {"linkage.dyads[0].links[1]": 6, "linkage.coupler": 71})
    assert changed == TEXT.replace("|-\n      5\n", "6\n").replace(": 70", ": 71").replace("\n", ends)
    assert remove_section(text, "sweep") == remove_section(TEXT, "sweep").replace("\n", ends)


def test_json_is_yaml() -> None:
    text = '{"cam":{"p":"5","shaft":[1,2]},"sweep":{"a":[1]}, "name":"x"}'
    assert with_values(text, {"cam.shaft[1]": -3, "sweep.a[0]": 0.5, "cam.p": 7}) == (
        '{"cam":{"p":"7","shaft":[1,-3]},"sweep":{"a":[0.5]}, "name":"x"}'
    )


def test_a_second_change_finds_its_way_after_the_first() -> None:
    once = with_values(TEXT, {"cam.fourier.mean": 1234567.875})
    assert with_values(once, {"cam.fourier.mean": 25, "cam.shaft[1]": 2}) == TEXT


@pytest.mark.thin(32)
@pytest.mark.parametrize("path", few(SHIPPED, 3), ids=lambda path: path.stem)
def test_every_number_of_a_shipped_recipe_can_be_replaced(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    before = values(text)
    numbers = [name for name, value in before.items() if re.fullmatch(r"-?[0-9]+(\.[0-9]+)?", value)]
    assert numbers
    for i, name in enumerate(numbers):
        changed = with_values(text, {name: i + 0.5})
        assert values(changed) == {**before, name: f"{i + 0.5}"}
        assert re.findall("#.*", changed) == re.findall("#.*", text)
    every = {name: -float(i) - 1e-9 for i, name in enumerate(numbers)}
    assert values(with_values(text, every)) == before | {name: number_text(value) for name, value in every.items()}
    same = {name: float(before[name]) for name in numbers}
    found, again = load_text(text, path), load_text(with_values(text, same), path)
    assert found == again


@given(st.floats(allow_nan=False, allow_infinity=False).filter(lambda x: x == 0 or abs(x) > 1e-30))
def test_numbers_read_back_exactly(x: float) -> None:
    assert read_number(number_text(x)) == x
    text = with_values("cam: {a: 1, b: 2}", {"cam.a": x})
    assert read_number(values(text)["cam.a"]) == x


@pytest.mark.parametrize(
    ("x", "written"), [(1, "1"), (10.0, "10"), (-0.5, "-0.5"), (1e22, "1e+22"), (0.1 + 0.2, "0.30000000000000004")]
)
def test_numbers_are_spelled_briefly(x: float, written: str) -> None:
    assert number_text(x) == written


@pytest.mark.parametrize("x", [math.inf, -math.inf, math.nan])
def test_what_is_not_finite_is_refused(x: float) -> None:
    with pytest.raises(ValueError, match="cannot stand in a recipe"):
        with_values(TEXT, {"linkage.rocker": x})


@pytest.mark.thin(4)
@pytest.mark.parametrize("path", ["linkage.rockers", "linkage", "cam.kind", "cam.shaft", "cam.shaft[2]", "", "name"])
def test_only_numbers_are_replaced(path: str) -> None:
    with pytest.raises(ValueError, match=f"no number at {re.escape(path)}"):
        with_values(TEXT, {path: 1})


def test_a_number_that_an_alias_shares_is_refused() -> None:
    text = "a: &x 5\nb: [&y {c: 1}, *y]\nd: *x\n"
    for path, other in (("a", "d"), ("d", "a"), ("b[0].c", r"b\[1\].c")):
        with pytest.raises(ValueError, match=f"an alias shares the number at .* with {other}"):
            with_values(text, {path: 1})


# --- sections ---------------------------------------------------------------------------------------------------------


def test_a_section_goes_with_the_comments_in_it() -> None:
    start, end = TEXT.index("sweep:"), TEXT.index("\n# about verify")
    assert remove_section(TEXT, "sweep") == TEXT[:start] + TEXT[end:]
    assert remove_section(TEXT, "name") == TEXT.replace("name: x\n", "")
    assert remove_section(TEXT, "verify") == TEXT.replace("verify: {angles: 500}\n", "")
    start, end = TEXT.index("linkage:"), TEXT.index("\n# about the search")
    assert remove_section(TEXT, "linkage") == TEXT[:start] + TEXT[end:]
    assert remove_section(TEXT, "cam").splitlines() == [line for line in TEXT.splitlines() if '"cam"' not in line]
    assert remove_section(TEXT, "dwell") == TEXT


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{a: 1, sweep: {b: [1, 2]}, c: 3}", "{a: 1, c: 3}"),
        ("{a: 1, sweep: {b: [1, 2]}}", "{a: 1}"),
        ("{a: 1, ? sweep : 2, b: 3}", "{a: 1, ? b: 3}"),
        ("{sweep: {b: [1, 2]}, a: 1}  # c", "{a: 1}  # c"),
        ("{\n  a: 1,  # one\n  sweep: 2,  # two\n  c: 3\n}\n", "{\n  a: 1,  # one\n  c: 3\n}\n"),
        ("a: 1\nsweep:\nb: 2\n", "a: 1\nb: 2\n"),
        ("a: 1\nsweep:  # none\n\nb: 2\n", "a: 1\n\nb: 2\n"),
        ("a: 1\nsweep: ~\nb: 2\n", "a: 1\nb: 2\n"),
        ("a: 1\nsweep: {b: 1}", "a: 1\n"),
        ("  a: 1\n  sweep:\n    b: 1\n    # in\n  # out\n  c: 2\n", "  a: 1\n  # out\n  c: 2\n"),
        ("a: 1\nsweep:\n- 1\n- {b: 2}\nc: 2\n", "a: 1\nc: 2\n"),
        ("a: 1\nsweep: |\n  text\n  more\n\nc: 2\n", "a: 1\n\nc: 2\n"),
        ("a: 1\nsweep: [1,\n 2,\n]\nc: 2\n", "a: 1\nc: 2\n"),
        ("a: 1\n? sweep\n: {b: 2}\nc: 2\n", "a: 1\nc: 2\n"),
        ("# top\n---\nsweep: {b: 2}\nc: 2\n...\n", "# top\n---\nc: 2\n...\n"),
        ("s: &s {b: 1}\nsweep: *s\nc: 2\n", "s: &s {b: 1}\nc: 2\n"),
        ("s: &s {b: 1}\nsweep:\n  d: *s\nc: 2\n", "s: &s {b: 1}\nc: 2\n"),
        ("a: {sweep: 1}\n", "a: {sweep: 1}\n"),
        ("- sweep\n", "- sweep\n"),
    ],
)
def test_a_section_however_it_is_written(text: str, expected: str) -> None:
    assert remove_section(text, "sweep") == expected


def test_a_section_that_others_lean_on_is_not_cut() -> None:
    with pytest.raises(RecipeErrors, match="an alias without its anchor"):
        remove_section("sweep: {a: &a 5}\nb: *a\n", "sweep")
    with pytest.raises(RecipeErrors) as caught:
        remove_section("sweep: {a: 5}\n", "sweep")
    assert str(caught.value) == (
        "recipe:1:1: sweep: cannot be taken out of the text without harm; let it stand as a block of lines of its own"
    )


def test_what_is_no_yaml_is_refused() -> None:
    with pytest.raises(RecipeErrors, match="YAML cannot be read"):
        remove_section("a: [", "sweep")
    with pytest.raises(RecipeErrors, match="YAML cannot be read"):
        with_values("a: [", {"a": 1})


# --- marks ------------------------------------------------------------------------------------------------------------


@pytest.mark.thin(6)
@pytest.mark.parametrize("path", few(SHIPPED, 3), ids=lambda path: path.stem)
def test_every_section_of_a_shipped_recipe_can_go(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    before = values(text)
    for section in {name.split(".")[0] for name in before}:
        left = remove_section(text, section)
        assert values(left) == {name: value for name, value in before.items() if name.split(".")[0] != section}


def test_lists_and_mappings_know_their_end() -> None:
    root = read_source(TEXT.encode(), "x").root
    assert not isinstance(root, Scalar)
    lines = TEXT.splitlines()
    assert root.end == (len(lines), len(lines[-1]) + 1)
    cam = {key.text: value for key, value in root.entries}["cam"]
    line, column = cam.end
    assert lines[line - 1][: column - 1].endswith("[1,2]}")
