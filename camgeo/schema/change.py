"""Recipes from a program: plain values written as YAML, or put into the text of a recipe, which keeps its comments."""

from __future__ import annotations

import json
import math
import re
import sys
from collections.abc import Mapping as AnyMapping
from collections.abc import Sequence as AnySequence
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from camgeo.schema.edit import spelled
from camgeo.schema.errors import RecipeError, RecipeErrors, shown
from camgeo.schema.yaml_source import (
    MAX_DEPTH,
    Mapping,
    Scalar,
    Sequence,
    Source,
    entries,
    is_empty,
    is_within,
    join,
    scalars,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from camgeo.schema.yaml_source import Node

Value: TypeAlias = "str | float | bool | AnySequence[Value] | AnyMapping[str, Value] | NDArray[np.generic] | None"
"""What may stand in a recipe: a text, a number, a truth value, nothing, lists, arrays and mappings of those."""

_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")  # texts that YAML and people read as they stand
_WORDS = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n", "nan", "inf"})
_STEP = re.compile(r"\.?(?:([A-Za-z0-9_-]+)|'([^'\\]*)')|\[([0-9]+)\]")


def written(values: AnyMapping[str, Value], file: str) -> str:
    """Write a recipe's values as YAML, a key a line; raises RecipeErrors, which name `file`, for what none may hold."""
    return "".join(f"{line}\n" for line in _block(values, "", file, 0))


def changed(source: Source, path: str, value: Value) -> str:
    """Put a value in the place of another in a recipe's text, or add it where its path has none yet.

    All else stays as it is, comments included; what a list or a mapping held goes with its comments. Raises
    RecipeErrors for a path that leads nowhere, a value that no recipe may hold, and a place that aliases share.
    """
    steps = _steps(source, path)
    node, at = source.root, ""
    for i, step in enumerate(steps):
        found = _entry(node, step)
        if found is None:
            return _checked(source, path, _added(source, node, at, steps[i:], value))
        node, at = found, join(at, step)
    own = {id(scalar) for _, scalar in scalars(node)}
    if any(id(scalar) in own for there, scalar in scalars(source.root) if not is_within(there, path)):
        raise _refused(source, path, "an alias shares this place with others", "write the value out where it stands")
    text = _flow(value, path, source.file, 0)
    first, behind = _span(source, node.mark, node.end)
    old = source.text[first:behind]
    if not old:  # `key:` and nothing behind it
        text = text if source.text[first - 1 : first].isspace() else f" {text}"
    return _checked(source, path, source.text[:first] + text + old[len(old.rstrip()) :] + source.text[behind:])


def exchanged(source: Source, path: str, key: str, value: Value) -> str:
    """Put an entry with another key in the place of one; all else stays as `changed` has it."""
    *above, name = _steps(source, path)
    node: Node | None = source.root
    for step in above:
        node = None if node is None else _entry(node, step)
    pairs = node.entries if isinstance(node, Mapping) else ()
    for old, held in pairs:
        if isinstance(old, Scalar) and old.text == name:
            first, behind = source.index(old.mark), source.index(held.end)
            text = source.text[first:behind]
            there = f"{path.removesuffix(str(name))}{key}"
            new = f"{key}: {_flow(value, there, source.file, 0)}{text[len(text.rstrip()) :]}"
            return _checked(source, path, source.text[:first] + new + source.text[behind:], there)
    raise _refused(source, path, "not the path of a field", "write it like cam.base_radius or cam.motion[1].over")


def _steps(source: Source, path: str) -> list[str | int]:
    steps: list[str | int] = []
    at = 0
    while found := _STEP.match(path, at):
        steps.append(int(found[3]) if found[3] else found[1] or found[2])
        at = found.end()
    if at < len(path) or not steps or path.startswith("."):
        raise _refused(source, path, "not the path of a field", "write it like cam.base_radius or cam.motion[1].over")
    return steps


def _entry(node: Node, step: str | int) -> Node | None:
    if isinstance(step, int):
        return node.items[step] if isinstance(node, Sequence) and step < len(node.items) else None
    return entries(node).get(step) if isinstance(node, Mapping) else None


def _added(source: Source, node: Node, target: str, steps: list[str | int], value: Value) -> str:
    """Add an entry to the mapping at a path; the mappings between come to be with it."""
    whole = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps).removeprefix(".")
    path = f"{target}{'' if whole.startswith('[') or not target else '.'}{whole}"
    for step in reversed(steps[1:]):
        if isinstance(step, int):
            raise _refused(source, path, "the entry does not exist", "give the whole list by its own path")
        value = {step: value}
    name = steps[0]
    if isinstance(name, int) or not (isinstance(node, Mapping) or is_empty(node)):
        held = "entry" if isinstance(name, int) else "field"
        raise _refused(source, path, f"the {held} does not exist", "give a value to a field or an entry that is there")
    text = f"{name}: {_flow(value, path, source.file, 0)}"
    if not isinstance(node, Mapping):
        return changed(source, target, {name: value})
    if node.flow:
        end = source.index(node.entries[-1][1].end) if node.entries else source.index(node.end) - 1
        return f"{source.text[:end]}{', ' if node.entries else ''}{text}{source.text[end:]}"
    key, last = node.entries[-1]
    cut = [*source.starts, len(source.text)][source.last_line(key, last)]
    before = source.text[:cut]
    newline = "\r\n" if "\r\n" in source.text else "\n"
    before += "" if before.endswith(("\n", "\r")) else newline
    return f"{before}{' ' * (node.entries[0][0].mark[1] - 1)}{text}{newline}{source.text[cut:]}"


def _checked(source: Source, path: str, text: str, new_path: str = "") -> str:
    """Give back the new text, if it says what the old one did but for the value at a path, or at a new one."""
    try:
        new = Source.of(text, source.file).root
    except RecipeErrors as errors:
        raise _refused(source, path, "the value cannot be put there", "write it into the text by hand") from errors
    if _others(source.root, path) != _others(new, new_path or path):
        raise _refused(source, path, "the value cannot be put there", "write it into the text by hand")
    return text


def _others(root: Node, path: str) -> dict[str, str]:
    """Give the texts at all other paths; nothing, which a value may have replaced, is none."""
    return {at: scalar.text for at, scalar in scalars(root) if not (is_within(at, path) or is_empty(scalar))}


def _span(source: Source, mark: tuple[int, int], end: tuple[int, int]) -> tuple[int, int]:
    return source.index(mark), max(source.index(mark), source.index(end))


def _refused(source: Source, path: str, problem: str, remedy: str) -> RecipeErrors:
    return RecipeErrors([RecipeError(source.file, 0, 0, path, problem, None, remedy)])


# --- values as YAML ---------------------------------------------------------------------------------------------------


def _block(values: AnyMapping[str, Value], path: str, file: str, depth: int) -> list[str]:
    """Lines of a mapping; lists of lists or of mappings take a line an entry."""
    lines = []
    indent = "  " * depth
    for key, value in values.items():
        at = join(path, _key(key, path, file))
        name = _scalar(key, at, file)
        if isinstance(value, AnyMapping) and value:
            lines += [f"{indent}{name}:", *_block(value, at, file, _deeper(depth, at, file))]
            continue
        held = _without_arrays(value)
        if _is_list(held) and any(isinstance(item, AnyMapping) or _is_list(_without_arrays(item)) for item in held):
            items = (_flow(item, join(at, i), file, depth + 1) for i, item in enumerate(held))
            lines += [f"{indent}{name}:", *(f"{indent}  - {item}" for item in items)]
        else:
            lines.append(f"{indent}{name}: {_flow(value, at, file, depth)}")
    return lines


def _flow(value: object, path: str, file: str, depth: int) -> str:
    """Write any value on one line."""
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
    """Give numpy's arrays as lists and its numbers as Python's; all else as it is."""
    numpy = sys.modules.get("numpy")  # who has an array has imported it
    return value.tolist() if numpy is not None and isinstance(value, numpy.ndarray | numpy.generic) else value


def _is_list(value: object) -> TypeGuard[AnySequence[Value]]:
    return isinstance(value, AnySequence) and not isinstance(value, str | bytes | bytearray)


def _deeper(depth: int, path: str, file: str) -> int:
    if depth > MAX_DEPTH:
        raise RecipeErrors([RecipeError(file, 0, 0, path[:60], f"nested more than {MAX_DEPTH} deep")])
    return depth + 1


def _key(key: object, path: str, file: str) -> str:
    if not isinstance(key, str):
        raise RecipeErrors([RecipeError(file, 0, 0, path, "a key is a text", shown(str(key)))])
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
            remedy = "give one of a few digits"
            raise RecipeErrors([RecipeError(file, 0, 0, path, "a number of too many digits", None, remedy)]) from None
    if isinstance(value, float) and math.isfinite(value):
        return spelled(value)
    if isinstance(value, str):
        return (
            value if _PLAIN.fullmatch(value) and value.lower() not in _WORDS else json.dumps(value, ensure_ascii=False)
        )
    told = shown(str(value))
    what = "a number is finite" if isinstance(value, float) else "neither a text, a number, a list nor a mapping"
    raise RecipeErrors([RecipeError(file, 0, 0, path, what, told)])
