"""Faults of a recipe, each with its place and its remedy, all of them at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.common.terminal import escaped
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterable

_SHOWN = 60  # characters of a value that an error repeats
NEAR, NEARER = 0.6, 0.75  # likeness from which a word is suggested, and from which it is taken for a misspelling
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
    """All faults of a recipe in the order of their places, each once; `str()` gives a line for each."""

    errors: tuple[RecipeError, ...]

    def __init__(self, errors: Iterable[RecipeError]) -> None:
        once = dict.fromkeys(errors)
        self.errors = tuple(sorted(once, key=lambda error: (error.line, error.column)))
        super().__init__(self.errors)

    def __str__(self) -> str:
        """Write the faults one a line."""
        return "\n".join(map(str, self.errors))


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
    """The nearest of the known words, of a likeness of `near` or more; empty without one."""
    from difflib import get_close_matches  # for the message alone

    if len(word) > _LONGEST_WORD:
        return ""
    return next(iter(get_close_matches(word.lower(), list(words), n=1, cutoff=near)), "")
