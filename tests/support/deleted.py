"""The repository without a capability: its folders here and in kin, tests, pages, shipped recipes, what is marked.

A mark is a comment, `# needs: sweep` in Python and TOML, `<!-- needs: sweep -->` in Markdown. Behind a line it is of
that line. On the first line of a module it is of the whole. On a line of its own it is of what follows: in Python of a
statement or an entry with all that is indented below it; in Markdown of a block of code, of a section or a page where
its heading follows, else up to the next empty line. A page of which nothing is left is gone, and so is the gallery's
line of a recipe that is. README.md and the first page of docs hold no marks: each of their lines that names a
capability by a word of its label, or by its page, a starter or a recipe of it, goes with it.
"""

from __future__ import annotations

import ast
import functools
import re
import shutil
import subprocess
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import root_key
from camgeo.recipe.starter import STARTERS
from camgeo.recipe.words import words_of
from camgeo.registry import registry
from camgeo.schema.yaml_source import read_source
from support.places import ROOT

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence
    from pathlib import Path

LISTS = ("README.md", "docs/index.md")  # pages whose lines go with what they name
MARK = re.compile(r"(?P<before>.*?)\s*(?:#|<!--) needs: (?P<names>[a-z_, ]+?)(?: -->)?$")


def without_marked(text: str, name: str) -> str:
    """Give a text without what is marked as needing a capability."""
    lines, kept, i = text.split("\n"), [], 0
    if lines[0].startswith("#") and (whole := MARK.match(lines[0])) and name in whole["names"].split(", "):
        return ""
    while i < len(lines):
        mark = MARK.match(lines[i])
        if not mark or name not in mark["names"].split(", "):
            kept.append(lines[i])
            i += 1
        elif mark["before"].strip():
            i += 1
        else:
            behind = _behind_page if lines[i].lstrip().startswith("<") else _behind_python
            i = behind(lines, i + 1)
    return "\n".join(kept)


def _behind_python(lines: list[str], start: int) -> int:
    """Index of the first line behind a statement or an entry, of a definition with its decorators."""
    ends = [start + 1]
    for node in ast.walk(ast.parse("\n".join(lines))):
        decorators = getattr(node, "decorator_list", [])
        first = decorators[0] if decorators else node
        if getattr(first, "lineno", 0) == start + 1:
            ends.append(getattr(node, "end_lineno", 0))
    return max(ends)


def _behind_page(lines: list[str], start: int) -> int:
    """Index of the first line behind a block, a section or a paragraph."""
    first, code = lines[start], False
    if first.startswith("```"):
        return lines.index("```", start + 1) + 1
    level = len(first) - len(first.lstrip("#"))
    for i in range(start + 1, len(lines)):
        code ^= lines[i].startswith("```")
        if not code and (re.match(rf"#{{1,{level}}} ", lines[i]) if level else not lines[i]):
            return i
    return len(lines)


@functools.cache
def _words(path: Path) -> frozenset[str]:
    """Keys, formats, options of files and kind of a shipped recipe: each is read once for all capabilities."""
    source = read_source(path.read_bytes(), str(path))
    return frozenset({*words_of(source.root), f"kind: {root_key(source)}"})


def uses(path: Path, name: str) -> bool:
    """Whether a shipped recipe has a key, a format or an option of files of a capability, or is of its kind."""
    label = registry.labels()[name]
    return not _words(path).isdisjoint({*label.words, *label.roots, *(f"kind: {kind}" for kind in label.kinds)})


def covering(paths: Sequence[Path], words: Collection[str]) -> list[Path]:
    """Few of these recipes that together have every one of these words that any of them has."""
    left, chosen = frozenset[str]().union(*map(_words, paths)) & {*words}, []
    while left:
        chosen.append(max(paths, key=lambda path: len(_words(path) & left)))
        left -= _words(chosen[-1])
    return chosen


def unshipped(name: str) -> list[Path]:
    """Shipped recipes that go with a capability."""
    return [path for path in (ROOT / "recipes").rglob("*.yaml") if uses(path, name)]


@functools.cache
def pages(name: str) -> tuple[str, ...]:
    """Names of the pages of docs that go with a capability."""
    found = sorted((ROOT / "docs").glob("*.md"))
    return tuple(p.stem for p in found if p.stem == name or not without_marked(p.read_text(encoding="utf-8"), name))


@functools.cache
def naming(name: str) -> re.Pattern[str]:
    """What names a capability in a line of Markdown: its pages, commands, options, starters, words and recipes."""
    label = registry.labels()[name]
    starters = [starter for starter in STARTERS if STARTERS.owner(starter) == name]
    options = [*label.sources, *([name.replace("_", "-")] if label.option else [])]
    parts = {
        r"\]\((?:docs/)?(?:{})\.md": pages(name),
        r"\bcamgeo (?:{})(?![\w-])": [*label.commands, *(f"new {starter}" for starter in starters)],
        r"--(?:{})(?![\w-])": options,
        r"`(?:{})(?:: [^`]*)?`": [*label.words, *label.formats, *label.roots, *label.kinds],
        r"(?:^|[/ ])(?:{})\.yaml\b": [path.stem for path in unshipped(name)],
    }
    chosen = [part.format("|".join(map(re.escape, words))) for part, words in parts.items() if words]
    return re.compile("|".join(chosen))


def without_named(text: str, name: str) -> str:
    """Give a page of `LISTS` without the lines that name a capability."""
    return "\n".join(line for line in text.split("\n") if not naming(name).search(line))


def dependent(text: str, name: str) -> list[str]:
    """Lines of a page of `LISTS` that would go with a capability, though what stands about them needs them.

    A line stands for itself as a row of a table, as an item of a list, as a paragraph, and in a paragraph where the
    line before it ends, and it begins, a sentence or a link.
    """
    lines, found, code = text.split("\n"), [], False
    for before, line, behind in zip(["", *lines], lines, [*lines[1:], ""], strict=False):
        code ^= line.startswith("```")
        if not naming(name).search(line):
            continue
        item = line.startswith(("|", "- ")) and (line.startswith("|") or not behind.startswith("  "))
        begins = not before or (before.endswith((".", ":", "·")) and re.match(r"[A-Z`\[]", line))
        ends = not behind or line.endswith((".", "·")) or (before.endswith("·") and line.endswith("."))
        if code or not (item or (begins and ends)):
            found.append(line)
    return found


def copy_without(names: Collection[str], folder: Path) -> Path:
    """Copy what the repository holds, but for these capabilities, into a folder."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    gone = {path.relative_to(ROOT).as_posix() for name in names for path in unshipped(name)}
    own = tuple(f"kin/{half}/" for name in names for half in registry.labels()[name].kin)
    for name in names:
        own += (f"camgeo/capabilities/{name}/", f"tests/capabilities/{name}/", f"docs/{name}.md", f"web/{name}.")
    for place in listed.stdout.decode().split("\0"):
        path = ROOT / place
        if not place or place in gone or place.startswith(own) or not path.is_file():
            continue
        copied = folder / place
        copied.parent.mkdir(parents=True, exist_ok=True)
        whole = path.read_text(encoding="utf-8") if path.suffix in {".py", ".md", ".toml"} else ""
        if "needs: " not in whole and place not in {"docs/gallery.md", *LISTS}:
            shutil.copy2(path, copied)
            continue
        text = functools.reduce(without_marked, names, whole)
        if place in LISTS:
            text = functools.reduce(without_named, names, text)
        if place == "docs/gallery.md":
            lines = text.split("\n")
            text = "\n".join(line for line in lines if not any(recipe in line for recipe in gone))
        if text:
            copied.write_text(text, encoding="utf-8")
    return folder
