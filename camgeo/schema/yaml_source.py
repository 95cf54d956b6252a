"""YAML as a tree of texts with their places.

Only PyYAML's events are used: no tag is resolved and nothing is constructed, so a scalar is the text that was written
and the schema says how to read it. YAML 1.1's guesses (`on` a boolean, `1:30` ninety, `010` eight, `1e-3` a text)
therefore never come about. Size, depth and the expansion of aliases are bounded while reading.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import yaml

from camgeo.schema.errors import RecipeError, RecipeErrors, quote
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from collections.abc import Mapping as AnyMapping

MAX_BYTES = 1_000_000
MAX_DEPTH = 50
MAX_ALIASES = 100
MAX_NODES = 10_000  # texts, lists and mappings; those of an alias are counted wherever it stands

# What YAML does not permit, with its three line ends that editors do not count (NEL, LS, PS) and the byte order mark.
_FORBIDDEN = "[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]"
_DISPUTED = r"[\t?]|[|>][0-9+-]*#"  # libyaml takes some that PyYAML's own reader refuses: the latter decides
_LINE_END = r"\r\n|\r|\n"
_DIRECTIVE = r"(?:[ \t]*(?:#[^\r\n]*)?[\r\n])*%"
_BLANK = r"[ ]*(?:#[^\0\r\n\x85\u2028\u2029]*)?"
_BARE = r"[+-]?(?=\.?[0-9])[0-9.]{1,40}(?:[eE][+-]?[0-9]{1,20})?(?:/[0-9]{1,40})?"
_PLAIN_KEY = r"[A-Za-z0-9_-]{1,40}"

Mark: TypeAlias = tuple[int, int]  # line and column, from 1, in characters


@dataclass(frozen=True)
class Scalar:
    """A text, or a number as text, from `mark` to just before `end`, quotes included; `text` is without them.

    `plain` is whether it stands as it is, neither in quotes nor as a block behind | or >.
    `tag` is its YAML tag as written, None without one; `size` counts it as one node.
    """

    text: str
    plain: bool
    mark: Mark
    end: Mark
    tag: str | None = None
    size: int = 1


@dataclass(frozen=True)
class Sequence:
    """A list; `flow` is whether it stands in brackets.

    `end` is the place behind its bracket, or behind its last entry where it has none. `tag` is its YAML tag as written,
    None without one; `size` counts it and the nodes in it, also those of aliases.
    """

    items: tuple[Node, ...]
    flow: bool
    mark: Mark
    end: Mark
    tag: str | None
    size: int


@dataclass(frozen=True)
class Mapping:
    """A mapping as written, keys that stand twice included; `flow` is whether it stands in braces.

    `end` is the place behind its brace, or behind its last entry where it has none. `tag` is its YAML tag as written,
    None without one; `size` counts it and the nodes in it, keys and those of aliases too.
    """

    entries: tuple[tuple[Node, Node], ...]
    flow: bool
    mark: Mark
    end: Mark
    tag: str | None
    size: int


Node: TypeAlias = Scalar | Sequence | Mapping


@dataclass(frozen=True)
class Source:
    """Text of a recipe with its lines and its tree; `file` is its name in errors."""

    file: str
    text: str
    lines: tuple[str, ...]
    root: Node

    @staticmethod
    def of(text: str, file: str) -> Source:
        """Source of a text.

        Raises RecipeErrors for characters that YAML forbids, faulty syntax, several documents, directives, and anything
        above the bounds of this module.
        """
        return read_source(text.encode("utf-8", "surrogatepass"), file)

    @cached_property
    def starts(self) -> list[int]:
        """Indices in the text at which its lines begin."""
        return [0, *(end.end() for end in re.finditer(_LINE_END, self.text))]

    def index(self, mark: Mark) -> int:
        """Index in the text of a line and a column."""
        return self.starts[mark[0] - 1] + mark[1] - 1

    def last_line(self, key: Node, value: Node) -> int:
        """Number, from 1, of the last line of an entry of a mapping in block style, blank lines behind it left out."""
        line, column = value.mark if is_empty(value) else value.end
        last = line - (column == 1)  # a block of text ends where the next line begins
        while last > key.mark[0] and not self.lines[last - 1].strip():
            last -= 1
        return last


@dataclass()
class _Frame:
    """A list or mapping that is still being read; a mapping's keys and values alternate in `children`.

    `before` counts the nodes that came before it; `last` is the place just behind its last child.
    """

    event: yaml.CollectionStartEvent
    mark: Mark
    before: int
    last: Mark
    children: list[Node] = field(default_factory=list)

    def close(self, nodes: int, end: Mark) -> Node:
        size, tag, flow = nodes - self.before, self.event.tag, bool(self.event.flow_style)
        end = end if flow else self.last  # without brackets YAML's own end lies before whatever comes next
        if isinstance(self.event, yaml.SequenceStartEvent):
            return Sequence(tuple(self.children), flow, self.mark, end, tag, size)
        pairs = tuple(zip(self.children[::2], self.children[1::2], strict=True))
        return Mapping(pairs, flow, self.mark, end, tag, size)


class _BadEscapeError(yaml.YAMLError):
    """An escape beyond Unicode, behind `place`."""

    def __init__(self, place: Mark) -> None:
        super().__init__(place)
        self.place = place


def read_source(data: bytes, file: str) -> Source:
    """Text and tree of a recipe in YAML.

    Raises RecipeErrors for bytes that are not UTF-8, characters that YAML forbids, faulty syntax, several documents,
    directives, and anything above the bounds of this module.
    """
    if len(data) > MAX_BYTES:
        raise _fault(file, (0, 0), f"the file is larger than {MAX_BYTES} bytes", remedy="a recipe needs a few hundred")
    text = _decode(data, file)
    if re.match(_DIRECTIVE, text):
        place = _place(text, text.index("%"))
        raise _fault(file, place, "a YAML directive", remedy="a recipe has none; leave the line out")
    lines = tuple(re.split(_LINE_END, text))
    return Source(file, text, lines, _parse(text, lines, file))


def join(path: str, key: str | int) -> str:
    """Path of an entry: `cam.motion[1]`; unusual keys are quoted and shortened."""
    if isinstance(key, int):
        return f"{path}[{key}]"
    name = key if re.fullmatch(_PLAIN_KEY, key) else quote(key)
    return f"{path}.{name}" if path else name


def is_within(path: str, outer: str) -> bool:
    """Whether a path is `outer` or lies below it."""
    return path == outer or path.startswith((f"{outer}.", f"{outer}["))


def scalars(node: Node, path: str = "") -> Iterator[tuple[str, Scalar]]:
    """Every scalar of a tree with its path; a scalar that aliases share comes once for each path."""
    if isinstance(node, Scalar):
        yield path, node
    elif isinstance(node, Sequence):
        for i, item in enumerate(node.items):
            yield from scalars(item, join(path, i))
    else:
        for key, value in entries(node).items():
            yield from scalars(value, join(path, key))


def nodes(node: Node) -> Iterator[Node]:
    """Every node of a tree, keys too, from its root; one that aliases share comes once for each place."""
    yield node
    if isinstance(node, Sequence):
        for item in node.items:
            yield from nodes(item)
    elif isinstance(node, Mapping):
        for pair in node.entries:
            for part in pair:
                yield from nodes(part)


def content(node: Node, lists: AnyMapping[int, tuple[object, ...]] | None = None) -> object:
    """What a tree holds, without its places, to be compared; `lists` has the contents of lists that differ, by id."""
    if isinstance(node, Scalar):
        return node.text, node.plain, node.tag
    if isinstance(node, Sequence):
        given = (lists or {}).get(id(node))
        return "list", node.tag, tuple(content(item, lists) for item in node.items) if given is None else given
    return "mapping", node.tag, tuple((content(key, lists), content(value, lists)) for key, value in node.entries)


def comments(source: Source) -> Iterator[tuple[int, int]]:
    """Places of the comments in a text, from # to just before the end of the line, as indices in the text.

    What stands behind | or > on the line where a block of text begins counts to that text.
    """
    held = sorted(
        (source.index(node.mark), source.index(node.end)) for node in nodes(source.root) if isinstance(node, Scalar)
    )
    firsts = [first for first, _ in held]
    for start, line in zip(source.starts, source.lines, strict=True):
        for mark in re.finditer("#", line):
            place = start + mark.start()
            before = bisect_right(firsts, place)
            if not before or place >= held[before - 1][1]:
                yield place, start + len(line)
                break


def is_empty(node: Node) -> bool:
    """Whether a node is YAML's null in any spelling, empty included."""
    return isinstance(node, Scalar) and node.plain and node.text in ("", "~", "null", "Null", "NULL")


def keys(node: Mapping) -> dict[str, Scalar]:
    """Keys of a mapping that are texts, by their text; of equal keys the first."""
    first: dict[str, Scalar] = {}
    for key, _ in node.entries:
        if isinstance(key, Scalar):
            first.setdefault(key.text, key)
    return first


def entries(node: Mapping) -> dict[str, Node]:
    """Values of a mapping by the keys that are texts; of equal keys the first."""
    first: dict[str, Node] = {}
    for key, value in node.entries:
        if isinstance(key, Scalar):
            first.setdefault(key.text, value)
    return first


def scalar_text(node: Scalar) -> str:
    """Text of a scalar for an error: a number bare, any other text quoted."""
    return node.text if re.fullmatch(_BARE, node.text) else quote(node.text)


def describe(node: Node) -> str:
    """Text on a node for an error: its scalar, or `a list of 3`."""
    if isinstance(node, Scalar):
        return "nothing" if is_empty(node) else scalar_text(node)
    count = len(node.entries if isinstance(node, Mapping) else node.items)
    return f"a {'mapping' if isinstance(node, Mapping) else 'list'} of {count}"


def _decode(data: bytes, file: str) -> str:
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        place = _place(data[: error.start].decode("utf-8") + "?", None)
        raise _fault(file, place, "not UTF-8", f"byte 0x{data[error.start]:02x}", "save the file as UTF-8") from None
    text = text.removeprefix("\ufeff")
    # no forbidden character is printable: the pattern, which takes long to compile, is left out for most texts
    printable = text.replace("\n", "").isprintable()
    if not printable and (forbidden := re.search(_FORBIDDEN, text)):
        value = f"U+{ord(forbidden[0]):04X}"
        raise _fault(
            file, _place(text, forbidden.start()), "a character that cannot stand in a recipe", value, "delete it"
        )
    return text


def _place(text: str, index: int | None) -> Mark:
    """Line and column of the character at `index`, or of the last one."""
    before = text[:-1] if index is None else text[:index]
    lines = re.split(_LINE_END, before)
    return len(lines), len(lines[-1].removeprefix("\ufeff")) + 1


def _mark(mark: object) -> Mark:
    """Convert a mark of PyYAML's, of its C reader or its own; its absence stands for the first character."""
    return getattr(mark, "line", 0) + 1, getattr(mark, "column", 0) + 1


def _behind(mark: Mark, lines: tuple[str, ...]) -> Mark:
    """Place of an empty value: behind the last character before it that is no blank, whatever the reader names."""
    line, column = min(mark, (len(lines), len(lines[-1]) + 1))
    return line, len(lines[line - 1][: column - 1].rstrip()) + 1


def _parse(text: str, lines: tuple[str, ...], file: str) -> Node:
    fast = getattr(yaml, "CSafeLoader", None)
    if fast is not None and not re.search(_DISPUTED, text):
        with suppress(yaml.YAMLError):  # PyYAML's own reader words the same fault better, and alike on every machine
            return _build(_events(text, fast), lines, file)
    try:
        return _build(_events(text, _Loader), lines, file)
    except yaml.MarkedYAMLError as error:
        place = _mark(error.problem_mark or error.context_mark)
        problem = ", ".join(filter(None, (error.context, error.problem)))
        raise _fault(file, place, f"YAML cannot be read: {problem}", remedy=_syntax_remedy(problem)) from None
    except _BadEscapeError as error:
        raise _fault(file, error.place, "an escape that stands for no character", remedy="write it out") from None


class _Loader(yaml.SafeLoader):
    """PyYAML's own reader, which passes over blanks and comments at once: one by one they take a third of its time."""

    def scan_to_next_token(self) -> None:
        """Go to the next token; a line that ends outside brackets lets a simple key begin."""
        if self.index == 0 and self.peek() == "\ufeff":
            self.forward()
        scan_line_break: Callable[[], str] = self.scan_line_break
        blanks = re.compile(_BLANK)
        more = True
        while more:
            blank = blanks.match(self.buffer, self.pointer)
            passed = 0 if blank is None else blank.end() - self.pointer
            self.pointer += passed
            self.index += passed
            self.column += passed
            more = bool(scan_line_break())
            if more and not self.flow_level:
                self.allow_simple_key = True


def _events(text: str, loader: type[yaml.SafeLoader]) -> Iterator[yaml.Event]:
    """Events of a text, read one at a time, so that nothing is read beyond a bound."""
    end: Mark = (1, 1)
    try:
        for event in yaml.parse(text, Loader=loader):
            yield event
            end = _mark(event.end_mark)
    except (ValueError, OverflowError) as error:  # from PyYAML's own reader
        raise _BadEscapeError(end) from error


def _syntax_remedy(problem: str) -> str:
    if r"'\t'" in problem:
        return "indent with spaces, not tabs"
    if "mapping values are not allowed" in problem:
        return "a text that contains a colon and a space needs quotes; keys of one mapping start in one column"
    if "alias" in problem or "anchor" in problem:
        return "quote a text that begins with * or &"
    return "check indentation, quotes, brackets and colons in this line and the line above"


_OfTree = yaml.ScalarEvent | yaml.AliasEvent | yaml.CollectionStartEvent | yaml.CollectionEndEvent


def _build(events: Iterator[yaml.Event], lines: tuple[str, ...], file: str) -> Node:
    """Build the tree of one document; unlike PyYAML's composer it neither recurses nor goes on behind a bound.

    Raises RecipeErrors for a second document, for none, and for a tree above a bound of this module.
    """
    tree, documents = _Tree(lines, file), 0
    for event in events:
        if isinstance(event, _OfTree):
            tree.take(event)
        else:
            documents += isinstance(event, yaml.DocumentStartEvent)
            if documents > 1:
                remedy = "one recipe a file; leave out the line ---"
                raise _fault(file, _mark(event.start_mark), "a second YAML document", remedy=remedy)
    if tree.root is None:
        raise _fault(file, (1, 1), "the recipe is empty", remedy="`camgeo new` writes one to start from")
    return tree.root


class _Tree:
    """A document's tree under construction."""

    def __init__(self, lines: tuple[str, ...], file: str) -> None:
        self.lines, self.file = lines, file
        self.root: Node | None = None
        self.frames: list[_Frame] = []
        self.anchors: dict[str, Node] = {}
        self.aliases = self.nodes = 0

    def take(self, event: _OfTree) -> None:
        """Take the next event, which begins or ends a list or mapping, or is a whole node."""
        mark, end = _mark(event.start_mark), _mark(event.end_mark)
        if isinstance(event, yaml.CollectionStartEvent):
            self._open(event, mark)
        elif isinstance(event, yaml.CollectionEndEvent):
            frame = self.frames.pop()
            node = frame.close(self.nodes, end)
            self._add(node, mark, node.end, frame.event.anchor)
        elif isinstance(event, yaml.AliasEvent):
            self._add(self._node_of(event, mark), mark, end, None)
        else:
            if not event.value and not event.style:
                mark = _behind(mark, self.lines)
            self.nodes += 1
            self._add(Scalar(event.value, not event.style, mark, end, event.tag), mark, end, event.anchor)

    def _open(self, event: yaml.CollectionStartEvent, mark: Mark) -> None:
        if len(self.frames) == MAX_DEPTH:
            raise _fault(self.file, mark, f"nested more than {MAX_DEPTH} deep", remedy="a recipe needs five levels")
        self.frames.append(_Frame(event, mark, self.nodes, mark))
        self.nodes += 1

    def _node_of(self, event: yaml.AliasEvent, mark: Mark) -> Node:
        """Node of an alias; raises RecipeErrors for too many aliases and for one without anchor."""
        self.aliases += 1
        if self.aliases > MAX_ALIASES:
            raise _fault(self.file, mark, f"more than {MAX_ALIASES} aliases", remedy="write the values out")
        if event.anchor not in self.anchors:
            value = quote(f"*{event.anchor}")
            raise _fault(self.file, mark, "an alias without its anchor", value, _syntax_remedy("alias"))
        node = self.anchors[event.anchor]
        self.nodes += node.size
        return node

    def _add(self, node: Node, mark: Mark, end: Mark, anchor: str | None) -> None:
        """Add a node to the open list or mapping, or as root; raises RecipeErrors for more than `MAX_NODES` nodes."""
        if self.nodes > MAX_NODES:
            problem = f"more than {MAX_NODES} entries, aliases expanded"
            raise _fault(self.file, mark, problem, remedy="a recipe needs a few dozen")
        if anchor is not None:
            self.anchors[anchor] = node
        if self.frames:
            self.frames[-1].children.append(node)
            self.frames[-1].last = end
        else:
            self.root = node


def _fault(file: str, mark: Mark, problem: str, value: str | None = None, remedy: str = "") -> RecipeErrors:
    return RecipeErrors([RecipeError(file, *mark, "", problem, value, remedy)])
