"""The verdict on a file of a kind of cams with a judge of its own: what is the same for all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.check import about
from kin.numeric.records import dataclass, replace
from kin.read.checks import unread_check

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Self

    from kin.numeric.check import Check
    from kin.read.errors import ReadError
    from kin.read.formats import Contents


@dataclass(frozen=True, eq=False)
class FileVerdict:
    """Results for a file: the name of its format, dxf, stl, step ..., and its checks.

    A file that cannot be read has a single check that says why.
    """

    kind: str
    checks: tuple[Check, ...]

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)

    @classmethod
    def unread(cls, path: Path, kind: str, contents: Contents, error: ReadError) -> Self:
        """Verdict on a file that cannot be read, by what it should hold."""
        return cls(kind, (unread_check(contents, error),)).about(path)

    def about(self, path: Path) -> Self:
        """The verdict with the name of its file in all checks."""
        return replace(self, checks=tuple(about(check, path.name) for check in self.checks))
