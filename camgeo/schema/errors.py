"""Faults of a recipe, each with its place and its remedy, all of them at once."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from camgeo.common.terminal import escaped
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterable

_SHOWN = 60  # characters of a value that an error repeats
NEAR, NEARER = 0.6, 0.75  # likeness from which a word is suggested, and from which it is taken for a misspelling
SLIP = 0.9  # likeness of a word with one wrong letter
MOST_ALIKE = 3  # faults that differ in their places alone and have a line each
_LONGEST_WORD = 40  # characters of a word for which a near one is sought


@dataclass(frozen=True)
class RecipeError:
    """One fault of a recipe.

    `line` and `column` count from 1, in characters; line 0 stands for the file as a whole. `path` is the field's path,
    such as `cam.motion[1].law`, and empty where no field is at fault. `value` is the given value as written, None where
    there is none to show.
    """

    file: str
    line: int
    column: int
    path: str
    problem: str
    value: str | None = None
    remedy: str = ""

    @property
    def statement(self) -> str:
        """Place and problem of the fault: file:line:column: path: problem."""
        file = escaped(self.file)
        place = f"{file}:{self.line}:{self.column}" if self.line else file
        return f"{place}: {self.path}: {self.problem}" if self.path else f"{place}: {self.problem}"

    def __str__(self) -> str:
        """Write the fault on one line: file:line:column: path: problem, given value; remedy."""
        value = f", given {self.value}" if self.value is not None else ""
        remedy = f"; {self.remedy}" if self.remedy else ""
        return f"{self.statement}{value}{remedy}"

    def without_place(self, file: str) -> RecipeError:
        """Copy of the fault without line and column, under another name of the file: for texts that no file holds."""
        return replace(self, file=file, line=0, column=0)


class RecipeErrors(CamgeoError):  # noqa: N818 - it carries several errors
    """All faults of a recipe in the order of their places, each once.

    `str()` gives a line for each; of more than MOST_ALIKE that differ in their places alone the first has one, with
    their number.
    """

    errors: tuple[RecipeError, ...]

    def __init__(self, errors: Iterable[RecipeError]) -> None:
        once = dict.fromkeys(errors)
        self.errors = tuple(sorted(once, key=lambda error: (error.line, error.column)))
        super().__init__(self.errors)

    def __str__(self) -> str:
        """Write the faults one a line, many alike on one line."""
        alike: dict[object, list[RecipeError]] = {}
        for error in self.errors:
            alike.setdefault(_without_place(error), []).append(error)
        lines = []
        for error in self.errors:
            equal = alike[_without_place(error)]
            if len(equal) <= MOST_ALIKE:
                lines.append(str(error))
            elif error is equal[0]:
                last = f", the last in line {equal[-1].line}" if equal[-1].line else ""
                lines.append(f"{error}; and {len(equal) - 1} more such faults{last}")
        return "\n".join(lines)


def _without_place(error: RecipeError) -> object:
    """What faults that differ in their places alone have in common: their paths without numbers of entries too."""
    return error.file, re.sub(r"\[\d+\]", "[]", error.path), error.problem, error.value, error.remedy


def quote(text: str) -> str:
    """Text in quotes for an error, shortened to 60 characters, control characters escaped."""
    return repr(text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "...")


def suggestion(word: str, words: Iterable[str], near: float = NEAR) -> str:
    """Question that names the nearest of the known words, `did you mean arm?`; empty if none is near.

    `near` is the least likeness from 0 to 1, the ratio of difflib; 1 is the same word.
    """
    nearest = nearest_word(word, words, near)
    return f"did you mean {nearest}?" if nearest else ""


def nearest_word(word: str, words: Iterable[str], near: float = NEAR) -> str:
    """The known word that differs by a slip, or that ends it, as harmonic does simple-harmonic, or the nearest one.

    `near` is the least likeness of the nearest; empty without one.
    """
    from difflib import get_close_matches  # for the message alone

    if len(word) > _LONGEST_WORD:
        return ""
    known, given = list(words), word.lower()
    ending = [one for one in known if given.endswith(f"-{one}")]
    slip = get_close_matches(given, known, n=1, cutoff=SLIP)
    return next(iter(slip or ending or get_close_matches(given, known, n=1, cutoff=near)), "")
