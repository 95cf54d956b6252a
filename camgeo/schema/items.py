"""Entries of lists in a text, cut out and put in where they stand: in rows of their own, or in line in brackets.

To an entry of a list in block style belong the lines from its dash on, and the comments below that are indented more
than the dash; to one in brackets, where it stands on lines of its own, the comment behind its comma. All other comments
belong to the list and stay.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from camgeo.schema.yaml_source import comments
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.yaml_source import Node, Sequence, Source


@dataclass(frozen=True)
class Entry:
    """The text of an entry, without its dash or its comma, and the comment behind the comma of one in brackets."""

    text: str
    comment: str = ""


class NoPlaceError(CamgeoError, ValueError):
    """An entry whose beginning or end cannot be told from what stands around it."""


def cut(source: Source, items: Sequence, index: int) -> tuple[str, Entry, tuple[int, int]]:
    """The text without an entry, the entry, and the indices between which it stood.

    Raises NoPlaceError where the place of an entry cannot be told.
    """
    return (_cut_from_line if items.flow else _cut_from_block)(source, items, index)


def put(source: Source, items: Sequence, index: int, entry: Entry) -> str:
    """The text with an entry that comes to stand at an index, 0 to the number of entries.

    Raises NoPlaceError where the place of an entry cannot be told.
    """
    return (_put_in_line if items.flow else _put_in_block)(source, items, index, entry)


# --- block style ------------------------------------------------------------------------------------------------------


def _rows(source: Source, items: Sequence) -> list[tuple[int, int]]:
    """For each entry the index of its dash, and the one behind its last line."""
    starts = [*source.starts, len(source.text)]
    rows = []
    for item in items.items:
        dash = _dash(source, item)
        line = bisect_right(source.starts, dash)
        behind, indent = max(source.last_line(item, item), line), dash - source.starts[line - 1]
        for number, text in enumerate(source.lines[behind:], behind + 1):
            if re.match(rf"[ \t]{{{indent + 1},}}#", text):
                behind = number
            elif text.strip():
                break
        rows.append((dash, starts[behind]))
    return rows


def _dash(source: Source, item: Node) -> int:
    """Index of the dash of an entry, which stands before it or lines above, with comments in between."""
    line, column = item.mark
    before = source.lines[line - 1][: column - 1]
    while line:
        found = re.fullmatch(r"((?:.*\s)?-)?\s*(?:#.*)?", before)
        if found is None:
            break
        if found[1]:
            return source.starts[line - 1] + len(found[1]) - 1
        line -= 1
        before = source.lines[line - 1]
    raise NoPlaceError


def _line_end(source: Source) -> str:
    return "\r\n" if "\r\n" in source.text else "\n"


def _column(source: Source, index: int) -> int:
    return index - source.starts[bisect_right(source.starts, index) - 1]


def _cut_from_block(source: Source, items: Sequence, index: int) -> tuple[str, Entry, tuple[int, int]]:
    text, rows = source.text, _rows(source, items)
    dash, behind = rows[index]
    entry = Entry(text[dash + 1 : behind])
    first = dash - _column(source, dash)
    if len(rows) == 1:
        end = text[behind - 1 : behind] == "\n"
        return f"{text[:dash]}  []{_line_end(source) if end else ''}{text[behind:]}", entry, (dash, behind)
    if not text[first:dash].strip():
        return text[:first] + text[behind:], entry, (dash, behind)
    following = rows[1][0]  # the list begins behind another dash, which stays
    return text[:dash] + text[behind:following].lstrip() + text[following:], entry, (dash, behind)


def _put_in_block(source: Source, items: Sequence, index: int, entry: Entry) -> str:
    text, rows, end = source.text, _rows(source, items), _line_end(source)
    indent = " " * _column(source, rows[0][0])
    row = f"-{entry.text}{'' if entry.text.endswith(chr(10)) else end}"
    if index == 0:
        return f"{text[: rows[0][0]]}{row}{indent}{text[rows[0][0] :]}"
    behind = rows[index - 1][1]
    before = text[:behind] if text[behind - 1 : behind] in "\r\n" else f"{text[:behind]}{end}"
    return f"{before}{indent}{row}{text[behind:]}"


# --- brackets ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _InLine:
    """Where an entry in brackets stands: its text, the index behind its comma, and its lines if they are its own.

    Without a comma `comma` is None; `rows` is None where something else stands on its lines.
    """

    first: int
    end: int
    comma: int | None
    rows: tuple[int, int] | None


def _in_line(source: Source, items: Sequence) -> list[_InLine]:
    text, places = source.text, []
    said = list(comments(source))
    bounds = [*(source.index(item.mark) for item in items.items[1:]), source.index(items.end) - 1]
    for item, bound in zip(items.items, bounds, strict=True):
        first = source.index(item.mark)
        end = first + len(text[first : source.index(item.end)].rstrip())
        free = [i for i in range(end, bound) if text[i] == "," and not any(a <= i < b for a, b in said)]
        comma = free[0] + 1 if free else None
        line = source.starts[bisect_right(source.starts, first) - 1]
        rest = re.compile(r"[ \t]*(?:#[^\r\n]*)?(?:\r\n|\r|\n)").match(text, comma or end)
        own = rest is not None and not (text[line:first] + text[end : (comma or end + 1) - 1]).strip()
        places.append(_InLine(first, end, comma, (line, rest.end()) if rest and own else None))
    return places


def _cut_from_line(source: Source, items: Sequence, index: int) -> tuple[str, Entry, tuple[int, int]]:
    text, places = source.text, _in_line(source, items)
    place = places[index]
    own = text[place.first : place.end]
    if place.rows is not None and place.rows[1] < source.index(items.end):
        first, behind = place.rows
        return text[:first] + text[behind:], Entry(own, text[place.comma or place.end : behind].strip()), place.rows
    first, rest = place.first, text[place.end :]
    if place.comma is not None:
        between, rest = text[place.end : place.comma - 1], text[place.comma :]
        rest = between + rest if between.strip() else rest if rest.lstrip(" \t")[:1] == "#" else rest.lstrip(" \t")
    elif index and not text[places[index - 1].end : first].replace(",", "").strip():
        first = places[index - 1].end
    return text[:first] + rest, Entry(own), (place.first, place.end)


def _put_in_line(source: Source, items: Sequence, index: int, entry: Entry) -> str:
    text, own = source.text, entry.text.strip()
    if not items.items:
        inside = text.index("[", source.index(items.mark)) + 1
        return f"{text[:inside]}{own}{' ' if text[inside] == '#' else ''}{text[inside:]}"
    beside = _in_line(source, items)[max(index - 1, 0)]
    behind_own = f"  {entry.comment}" if entry.comment else ""
    if beside.rows is not None and beside.rows[1] < source.index(items.end):
        line, behind = beside.rows
        row = f"{text[line : beside.first]}{own},{behind_own}{_line_end(source)}"
        if index == 0:
            return text[:line] + row + text[line:]
        comma = "" if beside.comma else ","
        return text[: beside.end] + comma + text[beside.end : behind] + row + text[behind:]
    break_ = f"{behind_own}{_line_end(source)}{' ' * _column(source, beside.first)}" if behind_own else ""
    if index == 0:
        return f"{text[: beside.first]}{own},{break_ or ' '}{text[beside.first :]}"
    return f"{text[: beside.end]}, {own}{break_}{text[beside.end :]}"
