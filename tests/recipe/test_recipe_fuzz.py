"""Whatever stands in a recipe's file, a `Recipe` or `RecipeErrors` comes of it, and the errors lie in the file."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.places import SHIPPED as SHIPPED_FILES
from support.starters import OF_CAMS

from camgeo.recipe.cam import CAMS
from camgeo.recipe.extension import KEYS as OF_CAPABILITIES
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.limits import bounds
from camgeo.recipe.linkage import DYADS, LINKAGES
from camgeo.recipe.loading import read
from camgeo.recipe.starter import starter
from camgeo.registry.formats import FORMATS
from camgeo.schema.edit import remove_section
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import _Loader

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.fields import FieldTable

NEW = {f"new {kind}": starter(kind).encode() for kind in OF_CAMS}
SHIPPED = NEW | {path.name: path.read_bytes() for path in SHIPPED_FILES}


def reading(data: bytes) -> Recipe | RecipeErrors:
    try:
        return read(data, "some/folder/case.yaml")
    except RecipeErrors as errors:
        return errors


def outcome(data: bytes) -> Recipe | str:
    """Read, hold what every reading promises, and give the recipe or its errors' text."""
    found = reading(data)
    if isinstance(found, RecipeErrors):
        lines = re.split(r"\r\n|\r|\n", data.decode("utf-8", "replace"))
        assert found.errors
        assert list(found.errors) == sorted(found.errors, key=lambda e: (e.line, e.column))
        for error in found.errors:
            assert error.problem
            assert 0 <= error.line <= len(lines)
            assert error.line == error.column == 0 or 1 <= error.column <= len(lines[error.line - 1]) + 1
            assert str(error).isprintable()
        return str(found)
    assert found.name not in {"", ".", ".."}
    names = [request.filename(found.name, found.export.files) for request in found.export.files]
    assert len(set(names)) == len(names) >= 1
    folder = (Path("out") / found.name).resolve()
    assert folder.parent == Path("out").resolve()
    assert all((folder / name).resolve().parent == folder for name in names)
    assert found.export.tolerance > 0
    assert found == reading(data)
    if found.uses:
        edited(found)
    return found


def edited(recipe: Recipe) -> None:
    """Hold that a capability whose key is cut out of the text is one that the recipe does not use but for its files."""
    for name in recipe.uses:
        by_file = any(request.variant == name for request in recipe.export.files)
        if name in recipe.marks:
            try:
                left = reading(remove_section(recipe.text, name).encode())
            except RecipeErrors:  # an alias, or YAML that cannot be cut
                continue
            if not isinstance(left, RecipeErrors):
                assert (left.without(name) if by_file else left) == recipe.without(name)


def test_there_is_something_to_mutate() -> None:
    assert len(SHIPPED) >= 17


@settings(max_examples=examples(300))
@given(st.binary(max_size=200))
@example(b"\xff\xfec\x00a\x00m\x00")
@example(b"\xef\xbb\xbfcam: 1")
@example(b"cam: {kind: support, p: '\xc2\x85'}")
@example(b'cam: {kind: support, p: "\\ud800"}')
@example(b'cam: "\\UFFFFFFFF"')
@example(b"name: \x00")
@example(b"%TAG ! !\n" * 20)
def test_bytes(data: bytes) -> None:
    outcome(data)


@settings(max_examples=examples(300))
@given(st.text(alphabet=" \n\t:-[]{},&*!|>'\"#%@`?~<=ak1.", max_size=120))
@example("? a\n: b")
@example("? [a, b]\n: c")
@example("&a [*a]")
@example("a: &a b\nc: *a\n*a : d")
@example("- - - - 1")
@example("{" * 60)
@example("a: |2\n  b")
def test_yaml_signs(text: str) -> None:
    outcome(text.encode())


def _keys(table: FieldTable) -> set[str]:
    tables = [each for field in table.fields for each in (field.table, field.form and field.form.instead) if each]
    below = {key for each in tables for key in _keys(each)}
    return {*table.keys, *below}


TABLES = [*CAMS.values(), *LINKAGES.values(), *DYADS.values(), *map(bounds, FIGURES.values())]
KEYS = sorted({"kind", *FORMATS, *FIGURES, *_keys(recipe_table()), *(key for table in TABLES for key in _keys(table))})
TEXTS = [
    *CAMS,
    *LINKAGES,
    *DYADS,
    *FORMATS,
    *FIGURES,
    *("crossed", "coupler", "previous", "relative", "grid", "sobol", "true"),
    *("inch", "ccw", "arcs", "spline", "R12", "trim", "convex", "cycloidal", "4/3", "25 + cos(3*t)", "8*sin(pi*x)"),
    *("NUL", "../up", "", "~", "1e-3", "180/7", "1/0", ".inf", "010", "1:30", "yes", "2020-01-01", "9" * 70, "1e999"),
    *("log(-1)", "1/0", "t**-199", "(" * 60, "a" * 1200, "sqrt(t", "\ud800", "é", "\x07", "a\nb"),
]
scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.sampled_from(TEXTS) | st.text(max_size=8)
structures = st.recursive(
    scalars,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(KEYS) | st.sampled_from(["1", "3", "2", "-1", "x"]), inner, max_size=5)
    ),
    max_leaves=20,
)


def kinded(kinds: dict[str, FieldTable]) -> st.SearchStrategy[object]:
    return st.sampled_from(sorted(kinds)).flatmap(
        lambda kind: st.fixed_dictionaries(
            {"kind": st.just(kind)}, optional={field.name: structures for field in kinds[kind].fields}
        )
    )


def tabled(name: str, **known: st.SearchStrategy[object]) -> st.SearchStrategy[object]:
    table = recipe_table().field(name).table
    assert table
    return st.fixed_dictionaries({}, optional={key: known.get(key, structures) for key in table.keys})


numbers = st.integers(-5, 200) | st.floats(-5, 200)
dyads = st.lists(kinded(DYADS) | structures, max_size=3)
linkages = kinded(LINKAGES) | st.fixed_dictionaries(
    {"kind": st.sampled_from(sorted(LINKAGES))},
    optional={"ground": numbers, "coupler": numbers, "rocker": numbers, "offset": numbers, "dyads": dyads},
)
PATHS = ["cam.shaft[0]", "cam.base_radius", "linkage.rocker", "linkage.dyads[0].point[1]", "part.bore", "cam", "x[", ""]
ranges = st.fixed_dictionaries({"from": numbers, "to": numbers}, optional={"steps": st.integers(0, 9)})
vary = st.dictionaries(st.sampled_from(PATHS), ranges | st.lists(numbers, max_size=3) | structures, max_size=4)
known = {
    **{name: tabled(name, vary=vary) for name in OF_CAPABILITIES.answering() if name in recipe_table().keys},
    "cam": kinded(CAMS),
    "linkage": linkages,
    "dwell": tabled("dwell"),
    "verify": tabled("verify"),
}
recipes = st.fixed_dictionaries({}, optional={key: known.get(key, structures) for key in recipe_table().keys})


@pytest.mark.slow
@settings(max_examples=examples(150), deadline=None)
@given(recipes | structures)
def test_structures_near_the_schema(structure: object) -> None:
    outcome(json.dumps(structure).encode())  # a JSON text is a YAML one


PIECES = [
    *(
        "\n·  ·\t·: ·- ·[·]·{·}·*a·&a ·!!str ·'·\"·#·|·>·---\n·0·-·1e9·.inf·1:30·010·4/2·nan·inch·spline·linkage:·null"
        "·<<: ·?·%·\r·(·)·**·,·sin·law: cycloidal·polynomial·\0·\u2028·é·part: {bore: 2}\n"
    )
    .encode()
    .split("·".encode()),
    b"\xff",
]


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    data = SHIPPED[draw(st.sampled_from(sorted(SHIPPED)))]
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(data)))
        end = min(len(data), start + draw(st.integers(0, 12)))
        way = draw(st.sampled_from(["insert", "delete", "double", "line"]))
        if way == "insert":
            data = data[:start] + draw(st.sampled_from(PIECES)) + data[start:]
        elif way == "delete":
            data = data[:start] + data[end:]
        elif way == "double":
            data = data[:end] + data[start:]
        else:
            lines = data.splitlines(keepends=True)
            place = draw(st.integers(0, len(lines) - 1)) if lines else 0
            data = b"".join(lines[:place] + lines[place + 1 :] + lines[place : place + 1])
    return data


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_recipes_as_they_are(name: str) -> None:
    outcome(SHIPPED[name])


@settings(max_examples=examples(500), deadline=None)
@given(mutated())
def test_mutated_recipes(data: bytes) -> None:
    outcome(data)


@pytest.mark.skipif(not hasattr(yaml, "CSafeLoader"), reason="there is only one reader here to compare")
@settings(max_examples=examples(300), deadline=None)
@given(mutated())
def test_both_readers_of_yaml_agree(data: bytes) -> None:
    with pytest.MonkeyPatch.context() as patch:
        fast = outcome(data)
        patch.delattr(yaml, "CSafeLoader")
        assert outcome(data) == fast


@pytest.mark.slow
@settings(max_examples=examples(300), deadline=None)
@given(mutated())
def test_blanks_and_comments_that_are_passed_at_once_change_no_place(data: bytes) -> None:
    """Events and their marks are those of PyYAML's reader, which goes sign by sign; so is a fault that ends them."""
    text = data.decode("utf-8", "replace").removeprefix("\ufeff")

    def events(loader: type[yaml.SafeLoader]) -> list[str]:
        told: list[str] = []
        try:
            told.extend(
                f"{event} {event.start_mark.line} {event.start_mark.column} {event.end_mark.column}"
                for event in yaml.parse(text, Loader=loader)
            )
        except (yaml.YAMLError, ValueError, OverflowError) as error:
            told.append(str(error))
        return told

    assert events(_Loader) == events(yaml.SafeLoader)
