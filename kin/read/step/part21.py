"""Exchange files of ISO 10303-21, the text form of STEP: the instances of the data section, by number.

A value is a number, a text, an `Enumeration`, a `Reference`, a tuple of values, a `Typed` value, or None for what is
left out ($) or derived (*). An instance is one record, or several where it is of several types at once.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

BEGIN, END = "ISO-10303-21;", "END-ISO-10303-21;"
TOKEN = re.compile(
    r"\s+|/\*.*?\*/|(?P<text>'[^']*+(?:''[^']*+)*+')|#(?P<reference>\d+)|(?P<real>[-+]?\d+\.\d*(?:[Ee][-+]?\d+)?)"
    r"|(?P<integer>[-+]?\d+)|\.(?P<enumeration>[A-Za-z_][A-Za-z0-9_]*)\.|(?P<word>!?[A-Za-z_][A-Za-z0-9_-]*)"
    r"|(?P<mark>[(),;=$*])|(?P<binary>\"[0-9A-Fa-f]*\")",
    re.DOTALL,
)
LARGEST = 1e30  # number that can be computed with
LONGEST = 60  # characters of a text that an error shows
MOST_DIGITS = 18  # of a whole number
DEEPEST = 64  # of lists within lists
NONE = ("", "")  # in place of a token behind the last


class Reference(int):
    """Reference to another instance: its number."""

    __slots__ = ()


class Enumeration(str):
    """A name between dots, such as MILLI, T or F."""

    __slots__ = ()


class Typed(NamedTuple):
    """A value that states its type, such as LENGTH_MEASURE(25.4)."""

    name: str
    values: tuple[Value, ...]


Value: TypeAlias = "float | int | str | tuple[Value, ...] | Typed | None"


class Exchange(NamedTuple):
    """Contents of a STEP file: records by type for each instance number, and the name of its schema."""

    path: Path
    instances: dict[int, dict[str, tuple[Value, ...]]]
    schema: str

    def error(self, number: int, what: str, reason: str = "unsupported") -> ReadError:
        """Make the error that names the instance of a number."""
        kinds = "+".join(self.instances.get(number, {"": ()})) or "?"
        return ReadError(reason, f"#{number} {kinds[:LONGEST]}: {what}", self.path)

    def of(self, kind: str) -> list[int]:
        """Numbers of the instances of a type."""
        return [number for number, records in self.instances.items() if kind in records]

    def kind(self, number: int, kinds: tuple[str, ...], by: int) -> str:
        """First of the types `kinds` that instance `number` is of; `by` is the instance that refers to it.

        Raises ReadError where there is no such instance, or it is of none of the types.
        """
        if number not in self.instances:
            raise self.error(by, f"refers to #{number}, which is not there", "syntax")
        for kind in kinds:
            if kind in self.instances[number]:
                return kind
        raise self.error(number, f"is none of {', '.join(kinds)}")

    def values(self, number: int, kind: str, count: int) -> tuple[Value, ...]:
        """Values of the record of type `kind` in the instance of a number.

        Raises ReadError where there is no such record, or it has fewer than `count` values.
        """
        values = self.instances.get(number, {}).get(kind)
        if values is None:
            raise self.error(number, f"is no {kind}")
        if len(values) < count:
            raise self.error(number, f"has {len(values)} values, {count} belong there", "syntax")
        return values

    def number(self, value: Value, by: int) -> float:
        """Value as a number.

        Raises ReadError, which names instance `by`: "syntax" for no number, "range" for one above LARGEST.
        """
        if isinstance(value, Typed) and len(value.values) == 1:
            value = value.values[0]
        if isinstance(value, bool) or not isinstance(value, int | float) or isinstance(value, Reference):
            raise self.error(by, f"{shown(value)} is not a number", "syntax")
        if not abs(value) <= LARGEST:
            raise self.error(by, f"a value of {value:g}", "range")
        return float(value)

    def reference(self, value: Value, by: int) -> int:
        """Number of the instance that a value refers to; raises ReadError, naming instance `by`, for any other."""
        if not isinstance(value, Reference):
            raise self.error(by, f"{shown(value)} is not a reference", "syntax")
        return int(value)

    def several(self, value: Value, by: int) -> tuple[Value, ...]:
        """Entries of a value that is a list; raises ReadError, which names instance `by`, for any other value."""
        if not isinstance(value, tuple) or isinstance(value, Typed):
            raise self.error(by, f"{shown(value)} is not a list", "syntax")
        return value

    def flag(self, value: Value, by: int) -> bool:
        """True for .T., False for .F.; raises ReadError, which names instance `by`, for any other value."""
        if value not in {"T", "F"} or not isinstance(value, Enumeration):
            raise self.error(by, f"{shown(value)} is neither .T. nor .F.", "syntax")
        return value == "T"


def shown(value: Value) -> str:
    """Text of a value for a message, "$" for None, cut to LONGEST characters."""
    return "$" if value is None else repr(value)[:LONGEST]


def exchange(raw: bytes, path: Path) -> Exchange:
    """Parse the bytes of a STEP file. Raises ReadError for a file that is empty, cut short or none of the format."""
    if not raw.strip():
        raise ReadError("empty", "the file is empty", path)
    text = raw.decode("latin-1")
    if not text.lstrip().startswith(BEGIN):
        raise ReadError("syntax", f"not a STEP file: it does not begin with {BEGIN}", path)
    if END not in text[-200:]:
        raise ReadError("truncated", f"the end mark {END} is missing: the file is cut short", path)
    head, mark, data = text.partition("DATA;")
    body, closed, _ = data.rpartition("ENDSEC;")
    if not (mark and closed):
        raise ReadError("syntax", "there is no section DATA", path)
    schema = re.search(r"FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'", head)
    return Exchange(path, _instances(body, path), schema[1] if schema else "")


def _instances(body: str, path: Path) -> dict[int, dict[str, tuple[Value, ...]]]:
    tokens = _tokens(body, path)
    instances: dict[int, dict[str, tuple[Value, ...]]] = {}
    for kind, number in tokens:
        if kind != "reference" or next(tokens, NONE) != ("mark", "="):
            raise ReadError("syntax", f"#{number}= expected, not {number}", path)
        records: dict[str, tuple[Value, ...]] = {}
        token = next(tokens, NONE)
        several = token == ("mark", "(")
        if several:
            token = next(tokens, NONE)
        while token[0] == "word":
            records[token[1].upper()] = _list(tokens, int(number), path)
            token = next(tokens, NONE)
        if several and token == ("mark", ")"):
            token = next(tokens, NONE)
        if not records or token != ("mark", ";"):
            raise ReadError("syntax", f"#{number} does not end as an instance does", path)
        if int(number) in instances:
            raise ReadError("syntax", f"#{number} is there twice", path)
        instances[int(number)] = records
    return instances


def _tokens(body: str, path: Path) -> Iterator[tuple[str, str]]:
    """Kind and text of each token, one at a time: a list of all takes a hundred times the file's size."""
    at, last = 0, "?"
    while at < len(body):
        match = TOKEN.match(body, at)
        if match is None:
            raise ReadError("syntax", f"{body[at : at + 20]!r} after #{last} is nothing of this format", path)
        at = match.end()
        if match.lastgroup is None:
            continue
        kind, token = match.lastgroup, match[match.lastgroup]
        if kind in {"reference", "integer"} and len(token) > MOST_DIGITS:
            raise ReadError("range", f"{token[:LONGEST]!r} is beyond all numbers of instances and counts", path)
        last = token if kind == "reference" else last
        yield kind, token


def _list(tokens: Iterator[tuple[str, str]], number: int, path: Path) -> tuple[Value, ...]:
    """Values between brackets, which the next tokens are."""
    stack: list[tuple[str, list[Value]]] = []
    name, before = "", ""
    for kind, text in tokens:
        if (kind, text) == ("mark", "("):
            stack.append((name, []))
            name = ""
            if len(stack) > DEEPEST:
                raise ReadError("range", f"#{number}: its values lie more than {DEEPEST} brackets deep", path)
        elif not stack or (kind, text) == ("mark", ";") or (name and kind != "mark"):
            break
        elif (kind, text) == ("mark", ")"):
            outer, values = stack.pop()
            whole = tuple(values)
            if not stack:
                return whole
            stack[-1][1].append(Typed(outer, whole) if outer else whole)
        elif kind == "word":
            name = text.upper()
        elif (kind, text) != ("mark", ","):
            stack[-1][1].append(_value(kind, text))
        elif before in {"(", ","}:
            break
        before = text
    raise ReadError("syntax", f"#{number}: its values do not end, or one is missing", path)


def _value(kind: str, text: str) -> Value:
    match kind:
        case "real":
            return float(text)
        case "integer":
            return int(text)
        case "reference":
            return Reference(text)
        case "enumeration":
            return Enumeration(text.upper())
        case "text":
            return text[1:-1].replace("''", "'")
    return None
