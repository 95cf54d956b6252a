"""The text that a recipe was read from: the places of its fields, errors about them, and edits that keep all else."""

from __future__ import annotations

import collections.abc
from typing import TYPE_CHECKING

from camgeo.common.arguments import demand_type, number_of, path_of
from camgeo.common.errors import SurroundingsError
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.yaml_source import Source
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from camgeo.schema.change import Value
    from camgeo.schema.yaml_source import Mark


@dataclass(frozen=True, kw_only=True)
class Document:
    """A recipe as written: the `path` it was read from, and its `text`.

    `marks` has line and column of each field given, by the field's path; `kinds` the words of the kinds of cam and
    linkage. `unplaced` names in errors a text that stands in no file and so has no lines to refer to; empty for a file.
    """

    path: Path
    text: str = field(default="", repr=False, compare=False)
    marks: collections.abc.Mapping[str, Mark] = field(default_factory=dict, repr=False, compare=False)
    kinds: collections.abc.Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    unplaced: str = field(default="", repr=False, compare=False)

    @property
    def tables(self) -> tuple[str, ...]:
        """Paths of the fields that give a table, as rows or by a file whose path is relative to the recipe's folder."""
        return tuple(path for path in self.marks if path.endswith(".table"))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the recipe's text to a file, in place of what is there.

        Raises SurroundingsError where the file system refuses, CallError for a path that no file can have, TypeError
        for what is no path.
        """
        file = path_of("path", path)
        try:
            file.write_text(self.text, encoding="utf-8", newline="")
        except OSError as error:
            raise SurroundingsError(f"cannot be written: {error.strerror or error}", file) from error

    def locate(self, path: str) -> tuple[int, int]:
        """Line and column, from 1, of a field such as `cam.motion[1].law`, or of its nearest parent that is given.

        Raises TypeError for a path that is no str.
        """
        demand_type("path", path, str, "a str")
        while path and path not in self.marks:
            path = path[: max(path.rfind("."), path.rfind("["), 0)]
        return self.marks.get(path, (1, 1))

    def stated(self, path: str) -> str:
        """Path of a field, or of its nearest parent that the recipe gives; `cam` without any."""
        while path and path not in self.marks:
            path = path.rpartition("[" if path.endswith("]") else ".")[0]
        return path or "cam"

    def error(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> RecipeErrors:
        """Error about the field `path`, with its line and column: what is wrong, the value as shown, and a remedy."""
        line, column = self.locate(path)
        error = RecipeError(str(self.path), line, column, path, problem, value, remedy)
        return RecipeErrors([error.without_place(self.unplaced) if self.unplaced else error])

    def text_with(self, values: collections.abc.Mapping[str, float]) -> str:
        """The recipe's text with the numbers at these paths replaced, in the recipe's units; all else stays.

        Raises CallError for a path at which no number stands, for a number that an alias shares with other fields, and
        for a number that is not finite; TypeError for what is no mapping from paths to numbers.
        """
        from camgeo.schema.edit import with_values

        demand_type("values", values, collections.abc.Mapping, "a mapping from paths to numbers")
        for path in values:
            demand_type("values: a path", path, str, "a str")
        numbers = {path: number_of(f"values[{path!r}]", value) for path, value in values.items()}
        return with_values(self.text, numbers)

    def source(self) -> Source:
        """The text as a tree of nodes; raises RecipeErrors for a text that is no YAML."""
        return Source.of(self.text, str(self.path))

    def changed(self, values: collections.abc.Mapping[str, Value]) -> str:
        """The text with the values at these paths set, or added where a field is not given yet; all else stays.

        Raises RecipeErrors where a path leads nowhere, for a value that no recipe may hold, and for a place that an
        alias shares; TypeError for a path that is no str.
        """
        from camgeo.schema.change import set_value

        text = self.text
        for path, value in values.items():
            demand_type("path", path, str, "a str")
            text = set_value(Source.of(text, str(self.path)), path, value)
        return text
