"""Words of a recipe by which it uses capabilities, read from its text before its keys are known."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, entries

if TYPE_CHECKING:
    from camgeo.schema.yaml_source import Node


def words_of(root: Node) -> set[str]:
    """Words by which a recipe may use capabilities: its top keys, and formats of its files with options `key: word`.

    They are compared with the `words` of labels.
    """
    top = entries(root) if isinstance(root, Mapping) else {}
    export = top.get("export")
    files = entries(export).get("files") if isinstance(export, Mapping) else None
    words = set(top)
    for item in files.items if isinstance(files, Sequence) else ():
        if isinstance(item, Scalar):
            words.add(item.text)
        for kind, options in entries(item).items() if isinstance(item, Mapping) else ():
            words.add(kind)
            chosen = entries(options) if isinstance(options, Mapping) else {}
            words |= {f"{key}: {value.text}" for key, value in chosen.items() if isinstance(value, Scalar)}
    return words
