"""Entries of lists in the text of a recipe: put in, taken out and moved, with every comment kept.

Holds: camgeo.schema.items.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from camgeo.schema.change import insert_item, move_item, remove_item
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import Source

if TYPE_CHECKING:
    from camgeo.schema.change import Value

BLOCK = """\
# a cam
cam:
  motion: # over a turn
    # first comes
    - {rise: 12, over: 120}   # the rise
      # slowly
    # then
    - dwell: 60  # a rest
      # of the follower

    - return: 12 # back
      over: 180
part: {bore: 12}  # mm
"""
ROWS = """\
cam:
  motion: [   # over a turn
    {rise: 12, over: 120},  # the rise
    # then
    {dwell: 60},  # a rest
    {return: 12, over: 180}  # back
  ]
"""


def source(text: str) -> Source:
    return Source.of(text, "cam.yaml")


def test_entries_of_a_block_take_their_comments_along() -> None:
    text = move_item(source(BLOCK), "cam.motion", 2, 0)
    assert text == BLOCK.replace("    - return: 12 # back\n      over: 180\n", "").replace(
        "    - {rise: 12", "    - return: 12 # back\n      over: 180\n    - {rise: 12"
    )
    text = remove_item(source(BLOCK), "cam.motion", 1)
    assert text == BLOCK.replace("    - dwell: 60  # a rest\n      # of the follower\n", "")
    text = insert_item(source(BLOCK), "cam.motion", 1, {"dwell": 20})
    assert text == BLOCK.replace("      # slowly\n", "      # slowly\n    - {dwell: 20}\n")
    text = insert_item(source(BLOCK), "cam.motion", 3, {"dwell": 20})
    assert text == BLOCK.replace("over: 180\n", "over: 180\n    - {dwell: 20}\n")


def test_entries_in_brackets_take_theirs_along_where_each_has_its_line() -> None:
    text = move_item(source(ROWS), "cam.motion", 2, 0)
    assert text == ROWS.replace("    {return: 12, over: 180}  # back\n", "").replace(
        "    {rise: 12", "    {return: 12, over: 180},  # back\n    {rise: 12"
    )
    assert remove_item(source(ROWS), "cam.motion", 0) == ROWS.replace("    {rise: 12, over: 120},  # the rise\n", "")
    text = insert_item(source(ROWS), "cam.motion", 3, {"dwell": 20})
    assert text == ROWS.replace("over: 180}  # back\n", "over: 180},  # back\n    {dwell: 20},\n")
    line = "a: [1, [2, 3], 'x, y']  # three\n"
    assert remove_item(source(line), "a", 1) == "a: [1, 'x, y']  # three\n"
    assert move_item(source(line), "a", 2, 0) == "a: ['x, y', 1, [2, 3]]  # three\n"
    assert insert_item(source(line), "a[1]", 0, 7) == "a: [1, [7, 2, 3], 'x, y']  # three\n"
    assert insert_item(source("a: [] # none\n"), "a", 0, 7) == "a: [7] # none\n"


def test_the_last_entry_leaves_an_empty_list_to_which_others_come() -> None:
    for text in ("a:\n- b # x\nc: 1\n", "a:\n  # y\n  - b", "a:\n- - b\n  - c\n", "a: [b]\n"):
        emptied = source(text)
        for _ in yaml.safe_load(text)["a"]:
            emptied = source(remove_item(emptied, "a", 0))
        assert yaml.safe_load(emptied.text)["a"] == []
        assert yaml.safe_load(insert_item(emptied, "a", 0, "z"))["a"] == ["z"]
        assert ("# y" in text) == ("# y" in emptied.text)


SHARED = "a: &list [1, &one 2]\nb: *list\nc: [*one, 3]\nd:\n  - &own {x: 1}\n  - 5\n"


@pytest.mark.parametrize(
    ("path", "index", "problem", "remedy"),
    [
        ("a", 0, "an alias shares this place with others", "write the value out where it stands"),
        ("b", 0, "an alias shares this place with others", "write the value out where it stands"),
        ("c", 1, "an alias shares this place with others", "write the value out where it stands"),
        ("d[0]", 0, "no list stands there", "give the path of a list, such as cam.motion"),
        ("e", 0, "no list stands there", "give the path of a list, such as cam.motion"),
        ("d", 2, "the list has 2 entries, given 2", "give an index from 0 to 1"),
        ("d", -1, "the list has 2 entries, given -1", "give an index from 0 to 1"),
        ("d..", 0, "not the path of a field", "write it like cam.base_radius"),
    ],
)
def test_what_cannot_be_done_is_refused(path: str, index: int, problem: str, remedy: str) -> None:
    changes = (lambda: remove_item(source(SHARED), path, index), lambda: move_item(source(SHARED), path, index, 0))
    for change in changes:
        with pytest.raises(RecipeErrors) as caught:
            change()
        assert f"{path}: {problem}; {remedy}" in str(caught.value)
    assert remove_item(source(SHARED), "d", 0).endswith("d:\n  - 5\n")  # an anchor that nothing refers to


def test_a_comment_between_an_entry_and_its_comma_stays() -> None:
    assert remove_item(source("a: [1 # x\n  , 2]\n"), "a", 0) == "a: [ # x\n   2]\n"


# --- all lists --------------------------------------------------------------------------------------------------------

COMMENT = re.compile(r"# c\d+")
SCALARS = st.sampled_from(["1", "x y", "'# no'", '"a, b"', "a#b", "12 mm", "~", "-3"])
FLOWS = st.one_of(
    SCALARS, st.sampled_from(["{rise: 1, over: 20}", "[1, [2]]", "{}", "[]", "{a: [1, 2], b: 'c, #'}", "!!str 3"])
)


class Written(NamedTuple):
    """A text with a list at `path`; the comments of each entry by its number."""

    text: str
    path: str
    own: list[set[str]]


@st.composite
def blocks(draw: st.DrawFn) -> Written:
    """A list in block style between comments, whose entries are of all kinds, as deep as `- -` goes."""
    count = iter(range(1000))
    own: list[set[str]] = []

    def said(chance: int = 3) -> str:
        return f"# c{next(count)}" if draw(st.integers(0, chance)) == 0 else ""

    outer = draw(st.sampled_from(["", "  "]))
    compact = draw(st.booleans())
    indent = outer + "  " * compact
    lines = [f"top: 1 {said()}".rstrip(), f"a: {said()}".rstrip()]
    for i in range(draw(st.integers(1, 4))):
        first = len(lines)
        for _ in range(draw(st.integers(0, 1)) * (i > 0 or not compact)):
            lines.append(draw(st.sampled_from(["", f"{indent}{said(0)}"])))
            first = len(lines)
        dash = f"{outer}- -" if compact and i == 0 else f"{indent}-"
        kind = draw(st.integers(0, 4))
        tail = said()
        if kind == 0:
            lines.append(f"{dash} rise: 1 {tail}".rstrip())
            lines += [f"{indent}  over: 2 {said()}".rstrip(), f"{indent}  law: [a, b]"]
        elif kind == 1:
            lines += [f"{dash} |-", f"{indent}  text # c", f"{indent}  more"]
        elif kind == 2 and draw(st.booleans()):
            lines.append(f"{dash} {tail}".rstrip())
            if draw(st.booleans()):
                lines.append(f"{indent}   key: value {said()}".rstrip())
        elif kind == 3:
            lines += [f"{dash} [1, {tail}".rstrip(), f"{indent}   2] {said()}".rstrip()]
        else:
            lines.append(f"{dash} {draw(FLOWS)} {tail}".rstrip())
        if kind != 1 and draw(st.integers(0, 3)) == 0:
            lines.append(f"{indent}  {said(0)}")
        own.append(set(COMMENT.findall("\n".join(lines[first:]))))
    end = draw(st.sampled_from(["", "\n", "\nz: 2 # c999\n", "\n# c999\nz: 2\n"]))
    text = "\n".join(lines) + end
    return Written(text.replace("\n", draw(st.sampled_from(["\n", "\r\n"]))), "a[0]" if compact else "a", own)


@st.composite
def brackets(draw: st.DrawFn) -> Written:
    """A list in brackets on one line or on several, with comments wherever they may stand."""
    count = iter(range(1000))
    own: list[set[str]] = []

    def gap(chance: int = 2) -> str:
        kind = draw(st.integers(0, chance))
        if kind == 0:
            return draw(st.sampled_from(["\n    ", f" # c{next(count)}\n    ", f"\n    # c{next(count)}\n    "]))
        return " " * (kind % 2)

    number = draw(st.integers(0, 4))
    text = "top: 1\na: [" + gap()
    for i in range(number):
        text += draw(FLOWS)
        behind = len(text)
        text += gap(4)
        if i < number - 1 or draw(st.booleans()):
            text += ","
            behind = len(text)
        text += gap()
        # only a comment behind its comma, or where it has none behind itself, on that line, may be its own
        own.append(set(COMMENT.findall(text[behind:].partition("\n")[0])))
    return Written(f"{text}] # c999\nz: 2\n", "a", own)


def held(text: str, path: str) -> tuple[list[object], object]:
    tree = yaml.load(text, Loader=yaml.BaseLoader)
    return (tree["a"] if path == "a" else tree["a"][0]), tree


@given(st.one_of(blocks(), brackets()), st.data())
def test_the_tree_is_the_list_operation_and_no_comment_of_others_is_lost(written: Written, data: st.DataObject) -> None:
    text, path, own = written
    items, _ = held(text, path)
    assert len(items) == len(own)
    count = sorted(COMMENT.findall(text))
    values: list[Value] = [7, "x: y # z", {"rise": 2, "over": [1, 2]}, [1], {}, None]
    value = data.draw(st.sampled_from(values))
    index = data.draw(st.integers(0, len(items)))
    inserted = insert_item(source(text), path, index, value)
    into, tree = held(text, path)
    into.insert(index, yaml.load(yaml.safe_dump(value), Loader=yaml.BaseLoader) if value is not None else "null")
    assert held(inserted, path)[1] == tree
    assert sorted(COMMENT.findall(inserted)) == count
    if not items:
        return
    index = data.draw(st.integers(0, len(items) - 1))
    removed = remove_item(source(text), path, index)
    into, tree = held(text, path)
    del into[index]
    assert held(removed, path)[1] == tree
    assert set(COMMENT.findall(text)) - set(COMMENT.findall(removed)) <= own[index]
    to = data.draw(st.integers(0, len(items) - 1))
    moved = move_item(source(text), path, index, to)
    into, tree = held(text, path)
    into.insert(to, into.pop(index))
    assert held(moved, path)[1] == tree
    assert sorted(COMMENT.findall(moved)) == count
