"""Changes to the text of a recipe that leave everything else in it as its author wrote it, comments included."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.quantity import split_unit
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import Mapping, Scalar, Source, keys, read_source, scalars

if TYPE_CHECKING:
    import collections.abc

    from camgeo.schema.yaml_source import Node

_NAME = "recipe"  # of a text in errors


def with_values(recipe: str | Source, values: collections.abc.Mapping[str, float]) -> str:
    """Text of a recipe with numbers in the place of others, by paths such as `cam.shaft[0]`.

    The values are in the recipe's units; each is written as the shortest text that reads back exactly, and a unit
    behind the old number is removed. Raises CallError for a path at which no number stands, for a number that an alias
    shares with other fields, and for a value that is not finite; RecipeErrors for a text that is no YAML.
    """
    source = _source(recipe)
    placed = list(scalars(source.root))
    places = dict(placed)
    changes = []
    for path, value in values.items():
        if path not in places:
            raise CallError(f"no number at {path}")
        scalar = places[path]
        try:
            read_number(split_unit(scalar.text)[0])
        except Complaint as complaint:
            raise CallError(f"no number at {path}: {complaint.problem}") from None
        if shared := [other_path for other_path, node in placed if node is scalar and other_path != path]:
            raise CallError(f"an alias shares the number at {path} with {shared[0]}")
        changes.append((scalar, number_text(value)))
    text = source.text
    for scalar, number in sorted(changes, key=lambda change: change[0].mark, reverse=True):
        first, behind = source.index(scalar.mark), source.index(scalar.end)
        text = text[:first] + _like(text[first:behind], number) + text[behind:]
    return text


def remove_section(recipe: str | Source, section: str) -> str:
    """Text of a recipe without a section of the top level and its comments; unchanged where it has no such section.

    Raises RecipeErrors for a text that is no YAML, for its only section, and for one that cannot be cut out without
    harm to the rest, as where an alias elsewhere stands for a value in it.
    """
    source = _source(recipe)
    root = source.root
    if not isinstance(root, Mapping) or section not in keys(root):
        return source.text
    index = next(i for i, (key, _) in enumerate(root.entries) if isinstance(key, Scalar) and key.text == section)
    text = _without_entry(source, root, index) if root.flow else _without_lines(source, root, index)
    other_entries = [pair for i, pair in enumerate(root.entries) if i != index]
    root_after = read_source(text.encode(), source.file).root if other_entries else None
    if (
        root_after is None
        or not isinstance(root_after, Mapping)
        or _plain(root_after) != [_plain_pair(pair) for pair in other_entries]
    ):
        remedy = "let it stand as a block of lines of its own"
        problem = "cannot be taken out of the text without harm"
        raise RecipeErrors([RecipeError(source.file, *root.entries[index][0].mark, section, problem, None, remedy)])
    return text


def number_text(value: float) -> str:
    """Shortest text of a number that reads back exactly; raises CallError where it is not finite."""
    value = float(value)
    if not math.isfinite(value):
        raise CallError(f"{value} cannot stand in a recipe")
    return repr(value).removesuffix(".0")


def _source(recipe: str | Source) -> Source:
    return recipe if isinstance(recipe, Source) else Source.of(recipe, _NAME)


def _like(old: str, number: str) -> str:
    """Text of a number in the style of the text that it replaces: in its quotes, or with its line ends."""
    if old[0] in "'\"":
        return f"{old[0]}{number}{old[0]}"
    return number + old[len(old.rstrip()) :]


def _without_entry(source: Source, root: Mapping, index: int) -> str:
    """Cut an entry out of braces, with the comma that sets it off."""
    if index + 1 < len(root.entries):
        first, behind = root.entries[index][0].mark, root.entries[index + 1][0].mark
    elif index:
        first, behind = root.entries[index - 1][1].end, root.entries[index][1].end
    else:
        first, behind = root.entries[index][0].mark, root.entries[index][1].end
    return source.text[: source.index(first)] + source.text[source.index(behind) :]


def _without_lines(source: Source, root: Mapping, index: int) -> str:
    """Cut the lines of an entry, and the indented comments behind it."""
    key, value = root.entries[index]
    starts = [*source.starts, len(source.text)]
    first, indent = key.mark
    behind = max(source.last_line(key, value), first)
    for number, text in enumerate(source.lines[behind:], behind + 1):
        if re.match(rf"[ \t]{{{indent},}}#", text):
            behind = number
        elif text.strip():
            break
    return source.text[: starts[first - 1]] + source.text[starts[behind] :]


def _plain(node: Node) -> object:
    """Content of a tree without its places: texts, pairs of a mapping as a list, entries of a list as a tuple."""
    if isinstance(node, Scalar):
        return node.text
    if isinstance(node, Mapping):
        return [_plain_pair(pair) for pair in node.entries]
    return tuple(map(_plain, node.items))


def _plain_pair(pair: tuple[Node, Node]) -> tuple[object, object]:
    return _plain(pair[0]), _plain(pair[1])
