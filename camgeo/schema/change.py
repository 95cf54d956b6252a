"""Recipes from a program: plain values written as YAML, or put into the text of a recipe, which keeps its comments."""

from __future__ import annotations

import json
import math
import re
import sys
from collections import Counter
from collections.abc import Mapping as AnyMapping
from collections.abc import Sequence as AnySequence
from functools import partial
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from camgeo.schema.edit import number_text
from camgeo.schema.errors import RecipeError, RecipeErrors, quote
from camgeo.schema.items import Entry, NoPlaceError, cut, put
from camgeo.schema.yaml_source import (
    MAX_DEPTH,
    Mapping,
    Scalar,
    Sequence,
    Source,
    comments,
    content,
    entries,
    is_empty,
    is_within,
    join,
    nodes,
    scalars,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from camgeo.schema.yaml_source import Node

Value: TypeAlias = "str | float | bool | AnySequence[Value] | AnyMapping[str, Value] | NDArray[np.generic] | None"
"""Value of a recipe: a text, a number, a truth value, nothing, lists, arrays and mappings of those."""

_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")  # texts that YAML and people read as they stand
_WORDS = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n", "nan", "inf"})
_NO_PATH = ("not the path of a field", "write it like cam.base_radius or cam.motion[1].over")
_BY_HAND = ("the value cannot be put there", "write it into the text by hand")
_SHARED = ("an alias shares this place with others", "write the value out where it stands")
_STEP = re.compile(r"\.?(?:([A-Za-z0-9_-]+)|'([^'\\]*)')|\[([0-9]+)\]")


def yaml_text(values: AnyMapping[str, Value], file: str) -> str:
    """YAML text of a recipe's values, a key a line.

    Raises RecipeErrors for values that no recipe may hold; `file` is the recipe's name in these.
    """
    return "".join(f"{line}\n" for line in _block(values, "", file, 0))


def set_value(source: Source, path: str, value: Value) -> str:
    """Text of a recipe with a value set at a path such as `cam.motion[1].over`, or added where there is none yet.

    All else stays as it is, comments included; a list or mapping that is replaced goes with its comments. Raises
    RecipeErrors for a path that leads nowhere, a value that no recipe may hold, a place that aliases share, and a value
    that cannot be put there without harm to the rest.
    """
    steps = _steps(source, path)
    node, node_path = source.root, ""
    for i, step in enumerate(steps):
        child = _entry(node, step)
        if child is None:
            return _verify_change(source, path, _add_entry(source, node, node_path, steps[i:], value))
        node, node_path = child, join(node_path, step)
    own_ids = {id(scalar) for _, scalar in scalars(node)}
    if any(id(scalar) in own_ids for scalar_path, scalar in scalars(source.root) if not is_within(scalar_path, path)):
        raise _refusal(source.file, path, *_SHARED)
    text = _flow(value, path, source.file, 0)
    first, behind = _span(source, node.mark, node.end)
    old = source.text[first:behind]
    if not old:  # `key:` and nothing behind it
        text = text if source.text[first - 1 : first].isspace() else f" {text}"
    return _verify_change(source, path, source.text[:first] + text + old[len(old.rstrip()) :] + source.text[behind:])


def replace_entry(source: Source, path: str, key: str, value: Value) -> str:
    """Text of a recipe in which the entry at a path has another key and value; all else stays, comments included.

    Raises RecipeErrors for a path that leads nowhere, a value that no recipe may hold, and a place that cannot be
    changed without harm to the rest.
    """
    *parents, name = _steps(source, path)
    node: Node | None = source.root
    for step in parents:
        node = None if node is None else _entry(node, step)
    pairs = node.entries if isinstance(node, Mapping) else ()
    for key_node, value_node in pairs:
        if isinstance(key_node, Scalar) and key_node.text == name:
            first, behind = source.index(key_node.mark), source.index(value_node.end)
            text = source.text[first:behind]
            new_path = f"{path.removesuffix(str(name))}{key}"
            new = f"{key}: {_flow(value, new_path, source.file, 0)}{text[len(text.rstrip()) :]}"
            return _verify_change(source, path, source.text[:first] + new + source.text[behind:], new_path)
    raise _refusal(source.file, path, *_NO_PATH)


def insert_item(source: Source, path: str, index: int, value: Value) -> str:
    """Text of a recipe with a value in the list at a path, such as `cam.motion`, before the entry at an index.

    At the index that is the number of entries it comes last. All else stays as it is, comments included, as the tree of
    the new text proves. Raises RecipeErrors for a path at which no list stands, an index beyond it, a value that no
    recipe may hold, a list that shares anything with others by an alias, and a value that cannot be put there without
    harm to the rest.
    """
    items = _list_at(source, path, index, 1)
    text = _flow(value, join(path, index), source.file, 0)
    entry = Entry(text if items.flow else f" {text}")
    wanted = [content(item) for item in items.items]
    wanted.insert(index, content(Source.of(text, source.file).root))
    return _verify_items(source, path, partial(put, source, items, index, entry), {id(items): tuple(wanted)})


def remove_item(source: Source, path: str, index: int) -> str:
    """Text of a recipe without the entry at an index of the list at a path, and without the comments of that entry.

    To it belong the comments behind it and those below that are indented more; comments above it stay. Raises
    RecipeErrors as `insert_item` does.
    """
    items = _list_at(source, path, index)
    others = tuple(content(item) for i, item in enumerate(items.items) if i != index)
    return _verify_items(source, path, lambda: cut(source, items, index)[0], {id(items): others}, index)


def move_item(source: Source, path: str, index: int, to: int) -> str:
    """Text of a recipe in which the entry at an index of the list at a path has come to the index `to`.

    It takes its comments along, those that `remove_item` would remove. Raises RecipeErrors as `insert_item` does.
    """
    items = _list_at(source, path, index)
    _list_at(source, path, to)
    if index == to:
        return source.text

    def moved() -> str:
        without, entry, _ = cut(source, items, index)
        left = Source.of(without, source.file)
        return put(left, _list_at(left, path, 0), to, entry)

    wanted = [content(item) for item in items.items]
    wanted.insert(to, wanted.pop(index))
    return _verify_items(source, path, moved, {id(items): tuple(wanted)})


def _list_at(source: Source, path: str, index: int, beyond: int = 0) -> Sequence:
    """The list at a path, which has an entry at an index or so many `beyond`, and nothing that an alias shares."""
    node: Node | None = source.root
    for step in _steps(source, path):
        node = None if node is None else _entry(node, step)
    if not isinstance(node, Sequence):
        raise _refusal(source.file, path, "no list stands there", "give the path of a list, such as cam.motion")
    if not 0 <= index < len(node.items) + beyond:
        most = len(node.items) - 1 + beyond
        remedy = f"give an index from 0 to {most}" if most >= 0 else "insert an entry first"
        raise _refusal(source.file, path, f"the list has {len(node.items)} entries", remedy, str(index))
    count = Counter(map(id, nodes(source.root)))
    if any(count[id(one)] > 1 for one in nodes(node)):
        raise _refusal(source.file, path, *_SHARED)
    return node


def _verify_items(
    source: Source,
    path: str,
    change: Callable[[], str],
    wanted: AnyMapping[int, tuple[object, ...]],
    removed: int | None = None,
) -> str:
    """The new text itself, whose tree must be the old one with `wanted` in a list, and which must keep all comments.

    Comments of a `removed` entry need not be there. Raises RecipeErrors where that is not so.
    """
    try:
        text = change()
        new = Source.of(text, source.file)
        within = None if removed is None else cut(source, _list_at(source, path, removed), removed)[2]
    except (NoPlaceError, RecipeErrors) as error:
        raise _refusal(source.file, path, *_BY_HAND) from error
    first, behind = within or (0, 0)
    kept = Counter(source.text[a:b] for a, b in comments(source) if not first <= a < behind)
    lost = kept - Counter(text[a:b] for a, b in comments(new))
    if lost or content(new.root) != content(source.root, wanted):
        raise _refusal(source.file, path, *_BY_HAND)
    return text


def _steps(source: Source, path: str) -> list[str | int]:
    steps: list[str | int] = []
    position = 0
    while match := _STEP.match(path, position):
        steps.append(int(match[3]) if match[3] else match[1] or match[2])
        position = match.end()
    if position < len(path) or not steps or path.startswith("."):
        raise _refusal(source.file, path, *_NO_PATH)
    return steps


def _entry(node: Node, step: str | int) -> Node | None:
    if isinstance(step, int):
        return node.items[step] if isinstance(node, Sequence) and step < len(node.items) else None
    return entries(node).get(step) if isinstance(node, Mapping) else None


def _add_entry(source: Source, node: Node, target: str, steps: list[str | int], value: Value) -> str:
    """Add an entry to the mapping `node` at the path `target`, with the mappings that `steps` name in between.

    Raises RecipeErrors where a step is an entry of a list, or `node` is no mapping.
    """
    whole = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps).removeprefix(".")
    path = f"{target}{'' if whole.startswith('[') or not target else '.'}{whole}"
    for step in reversed(steps[1:]):
        if isinstance(step, int):
            raise _refusal(source.file, path, "the entry does not exist", "give the whole list by its own path")
        value = {step: value}
    name = steps[0]
    if isinstance(name, int) or not (isinstance(node, Mapping) or is_empty(node)):
        noun = "entry" if isinstance(name, int) else "field"
        raise _refusal(
            source.file, path, f"the {noun} does not exist", "give a value to a field or an entry that is there"
        )
    text = f"{name}: {_flow(value, path, source.file, 0)}"
    if not isinstance(node, Mapping):
        return set_value(source, target, {name: value})
    if node.flow:
        end = source.index(node.entries[-1][1].end) if node.entries else source.index(node.end) - 1
        return f"{source.text[:end]}{', ' if node.entries else ''}{text}{source.text[end:]}"
    key, last = node.entries[-1]
    cut = [*source.starts, len(source.text)][source.last_line(key, last)]
    before = source.text[:cut]
    newline = "\r\n" if "\r\n" in source.text else "\n"
    before += "" if before.endswith(("\n", "\r")) else newline
    return f"{before}{' ' * (node.entries[0][0].mark[1] - 1)}{text}{newline}{source.text[cut:]}"


def _verify_change(source: Source, path: str, text: str, new_path: str = "") -> str:
    """The new text itself, whose values at all other paths must be the old ones; the entry may move to `new_path`.

    Raises RecipeErrors where other values have changed, or the new text is no YAML.
    """
    try:
        new = Source.of(text, source.file).root
    except RecipeErrors as errors:
        raise _refusal(source.file, path, *_BY_HAND) from errors
    if _texts_elsewhere(source.root, path) != _texts_elsewhere(new, new_path or path):
        raise _refusal(source.file, path, *_BY_HAND)
    return text


def _texts_elsewhere(root: Node, path: str) -> dict[str, str]:
    """Texts by all paths but this one and those below it, without empty values."""
    return {
        scalar_path: scalar.text
        for scalar_path, scalar in scalars(root)
        if not (is_within(scalar_path, path) or is_empty(scalar))
    }


def _span(source: Source, mark: tuple[int, int], end: tuple[int, int]) -> tuple[int, int]:
    return source.index(mark), max(source.index(mark), source.index(end))


def _refusal(file: str, path: str, problem: str, remedy: str = "", value: str | None = None) -> RecipeErrors:
    return RecipeErrors([RecipeError(file, 0, 0, path, problem, value, remedy)])


# --- values as YAML ---------------------------------------------------------------------------------------------------


def _block(values: AnyMapping[str, Value], path: str, file: str, depth: int) -> list[str]:
    """Lines of a mapping in block style; a list of lists or of mappings takes a line for each entry."""
    lines = []
    indent = "  " * depth
    for key, value in values.items():
        entry_path = join(path, _key(key, path, file))
        name = _scalar(key, entry_path, file)
        if isinstance(value, AnyMapping) and value:
            lines += [f"{indent}{name}:", *_block(value, entry_path, file, _deeper(depth, entry_path, file))]
            continue
        plain = _without_arrays(value)
        if _is_list(plain) and any(isinstance(item, AnyMapping) or _is_list(_without_arrays(item)) for item in plain):
            items = (_flow(item, join(entry_path, i), file, depth + 1) for i, item in enumerate(plain))
            lines += [f"{indent}{name}:", *(f"{indent}  - {item}" for item in items)]
        else:
            lines.append(f"{indent}{name}: {_flow(value, entry_path, file, depth)}")
    return lines


def _flow(value: object, path: str, file: str, depth: int) -> str:
    """Text of any value on one line, in flow style."""
    depth = _deeper(depth, path, file)
    value = _without_arrays(value)
    if isinstance(value, AnyMapping):
        pairs = (
            f"{_scalar(_key(k, path, file), path, file)}: {_flow(v, join(path, k), file, depth)}"
            for k, v in value.items()
        )
        return f"{{{', '.join(pairs)}}}"
    if _is_list(value):
        return f"[{', '.join(_flow(item, join(path, i), file, depth) for i, item in enumerate(value))}]"
    return _scalar(value, path, file)


def _without_arrays(value: object) -> object:
    """Lists for numpy's arrays and Python's numbers for numpy's; other values as they are."""
    numpy = sys.modules.get("numpy")  # who has an array has imported it
    return value.tolist() if numpy is not None and isinstance(value, numpy.ndarray | numpy.generic) else value


def _is_list(value: object) -> TypeGuard[AnySequence[Value]]:
    return isinstance(value, AnySequence) and not isinstance(value, str | bytes | bytearray)


def _deeper(depth: int, path: str, file: str) -> int:
    if depth > MAX_DEPTH:
        raise _refusal(file, path[:60], f"nested more than {MAX_DEPTH} deep")
    return depth + 1


def _key(key: object, path: str, file: str) -> str:
    if not isinstance(key, str):
        raise _refusal(file, path, "a key is a text", value=quote(str(key)))
    return key


def _scalar(value: object, path: str, file: str) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        try:
            return str(value)
        except ValueError:  # Python writes none of thousands of digits
            raise _refusal(file, path, "a number of too many digits", "give one of a few digits") from None
    if isinstance(value, float) and math.isfinite(value):
        return number_text(value)
    if isinstance(value, str):
        is_plain = _PLAIN.fullmatch(value) and value.lower() not in _WORDS
        return value if is_plain else json.dumps(value, ensure_ascii=False)
    problem = "a number is finite" if isinstance(value, float) else "neither a text, a number, a list nor a mapping"
    raise _refusal(file, path, problem, value=quote(str(value)))
