"""The output folder: a set of files that changes as a whole, in a folder that a user may keep other files in.

A set is what a `report.json` names, and the report itself. It lives in ``out/<name>/``, a failed one in
``out/<name>.rejected/``. Beside them, only while a run is at work or after one was killed, stand

    .<name>.lock          locked by the run that is at work; the system unlocks it when the process ends
    .<name>.partial-<n>   files being written by process n, worth nothing before they are committed
    .<name>.swap          a committed set on its way into place
    .<name>.undo          a swap that failed on its way back

**What holds when a process is killed.** Everything up to the commit happens in the private folder: the new files, a
journal (which files come, which go, which were there), and hard links to the files that will be replaced or removed.
One rename of that folder to ``.swap`` is the commit. Before it the old set stands untouched. After it the new set is
decided upon: its files are renamed into place one by one, the report last, and ``.swap`` is renamed away. Cut off in
between, the next run of this name finds ``.swap`` and does the remaining renames: each is done once, one that was done
leaves no source behind, so doing the list again from its start is right at any point. If a rename fails while the
process lives (a folder without permission, a file held open), ``.swap`` is renamed to ``.undo``, which decides for the
old set, and the linked files are renamed back; cut off there, the next run continues that in the same way.

**What a reader sees.** Every file is whole, of the old set or of the new one, and so is the report, at any moment: a
rename replaces a file in one step. File systems have no step that replaces several files of a folder and leaves the
rest of it alone, so between the commit and the last rename (a fraction of a millisecond) new files stand beside the
old report. Whoever must not mix them holds them against the report's checksums. The new report never stands beside an
old file.

**What does not hold.** Nothing is forced onto the disk: a loss of power is left to the file system.
"""

from __future__ import annotations

import json
import os
import re
import stat
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Self

from camgeo.common import system
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.common.system import link_file, lock_file, retry, unlock
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from types import TracebackType

REPORT = "report.json"
REJECTED = ".rejected"
_JOURNAL = ".journal.json"  # files of a set do not begin with a dot
_OLD = ".old"


@dataclass(frozen=True)
class Family:
    """Kind of a set of files that a run replaces; a recipe's folder may hold several sets, each with its own report.

    `report` is the name of the report that lists the files of the set. The names of the files begin with a word of
    `begins`; where it is empty, with the recipe's name or `report.`. `role` stands before `lock`, `partial`, `swap` and
    `undo` in the names of what stands beside that folder.
    """

    report: str = REPORT
    begins: tuple[str, ...] = ()
    role: str = ""


EXPORTED = Family()


@dataclass(frozen=True)
class _Swap:
    """Journal of a swap of files in the output folder named `target`.

    It has the names of the files that come, the report last, of those that go, and of all that are linked as they were
    before.
    """

    target: str
    come: tuple[str, ...]
    go: tuple[str, ...]
    before: tuple[str, ...]

    @staticmethod
    def read(path: Path) -> _Swap:
        entry = json.loads(path.read_text("utf-8"))
        return _Swap(entry["target"], tuple(entry["come"]), tuple(entry["go"]), tuple(entry["before"]))


TRIES = 10  # to lock a name in a folder that others clear away


class RunFolder:
    """Private folder of one run, as a context: files are written to `folder`, then committed or rejected as a set.

    Left without either, or by an exception, the output folder `out` is as before. `name` is the recipe's. Raises
    BusyError where another run of this name is at work, SurroundingsError in place of any OSError, ValueError for a
    name that is no plain file name or ends in `.rejected`.
    """

    def __init__(self, out: Path, name: str, family: Family = EXPORTED) -> None:
        if not _is_plain_name(name) or name.lower().endswith(REJECTED):
            raise ValueError(f"{name!r} is not the name of an output folder")
        self._out = out
        self._name = name
        self._family = family
        self._report = family.report
        self._lock = -1
        self._new: list[Path] = []
        self.folder = self._beside(f"partial-{os.getpid()}")

    def __enter__(self) -> Self:
        """Lock the name, clear away what killed runs left, finish or undo a swap that was cut off, make `folder`.

        Raises BusyError where another run of this name is at work, SurroundingsError where the disk refuses.
        """
        try:
            self._new = [path for path in (self._out, *self._out.parents) if not os.path.lexists(path)]
            lock = self._lock_name()
            if lock is None:
                text = f"another run is at work here (it holds {self._beside('lock').name})"
                raise BusyError(text, self._out / self._name)
            self._lock = lock
            try:
                self._clear()
                self._recover()
                self.folder.mkdir()
            except BaseException:
                self._unlock()
                raise
        except OSError as error:
            raise _surroundings_error(error, self._out) from error
        return self

    def _lock_name(self) -> int | None:
        """Make the output folder and lock the name in it: descriptor of the lock, None where another run holds it.

        It tries again where another run has removed the empty folder in between.
        """
        for _ in range(TRIES):
            self._out.mkdir(parents=True, exist_ok=True)
            with suppress(FileNotFoundError):
                return lock_file(self._beside("lock"))
        return lock_file(self._beside("lock"))

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        """Clear away and unlock; finish a swap that an interrupt cut off. Folders that this run made and left empty go.

        Raises SurroundingsError in place of an OSError of the run.
        """
        try:
            # what cannot be finished or cleared away now is left to the next run, and says nothing about this one
            with suppress(OSError, SurroundingsError):
                self._clear()
                self._recover()
        finally:
            self._unlock()
            with suppress(OSError):  # what is not empty stays, and all above it
                for folder in self._new:
                    folder.rmdir()
        if isinstance(error, OSError):
            raise _surroundings_error(error, self.folder) from error

    def kept_names(self) -> tuple[str, ...]:
        """Names of files of the last set that this run has not written again, which `commit` may keep; no report.

        Raises SurroundingsError where the last set cannot be read, or its report is no report of camgeo.
        """
        try:
            names = self._last_set(self._out / self._name)
        except OSError as error:
            raise _surroundings_error(error, self._out / self._name) from error
        return tuple(name for name in names if name != self._report and not (self.folder / name).exists())

    def commit(self, names: Iterable[str], *, keep: Iterable[str] = ()) -> Path:
        """Put the files `names` and the report of `folder` in the place of the last set; returns their new folder.

        Files of the last set are removed, unless `keep` has them; files that are not of the last set stay. A set in
        ``<name>.rejected`` goes, unless only a part of the set is new, which `keep` says. Raises
        ValueError for a name that is not one of this recipe's files, and for a file not written; SurroundingsError, the
        last set as it was, where the disk refuses or a file of the user's is in the way.
        """
        kept = tuple(keep)
        folder = self._replace(self._name, names, kept)
        if not kept:
            self._drop_rejected()
        return folder

    def _drop_rejected(self) -> None:
        """Remove the failed set of this name, the report last, and its folder if no other file is in it.

        The good set is in place: what the disk does not let go stays, and the next good set tries again.
        """
        rejected = self._out / (self._name + REJECTED)
        with suppress(OSError, SurroundingsError):
            for name in self._last_set(rejected):
                _remove(rejected / name)
            rejected.rmdir()

    def reject(self, names: Iterable[str] | None = None) -> Path:
        """Put the set into ``<name>.rejected`` in the place of the last set there; returns that folder.

        The folder `out/<name>` stays as it is. `names` are the files of the set, by default all that the run has
        written. Raises ValueError for a name that is not one of this recipe's files, and for a file not written;
        SurroundingsError, the last set as it was, where the disk refuses or a file of the user's is in the way.
        """
        if names is None:
            names = [path.name for path in sorted(self.folder.iterdir()) if path.name != self._report]
        return self._replace(self._name + REJECTED, names, ())

    def _replace(self, target: str, names: Iterable[str], keep: Iterable[str]) -> Path:
        folder, swap = self._out / target, self._beside("swap")
        try:
            self._prepare(folder, tuple(names), tuple(keep))
            retry(lambda: self.folder.rename(swap))
        except OSError as error:
            raise _surroundings_error(error, folder) from error
        try:
            self._forward(swap)
        except OSError as error:
            self._give_up(folder, error)
        # the set is in place; if this fails, the next run repeats a swap that finds nothing left to move
        with suppress(OSError):
            self._done(swap)
        return folder

    def _prepare(self, folder: Path, names: tuple[str, ...], keep: tuple[str, ...]) -> None:
        """Write the journal and link the old files; nothing outside the private folder changes but an empty folder.

        Raises SurroundingsError where a file that no report lists is in the way; ValueError for a name that is not one
        of this recipe's files, and for a file that was not written.
        """
        for name in (*names, *keep):
            if not self._is_own_name(name):
                raise ValueError(f"{name!r} is not the name of a file of {self._name}")
        come = (*dict.fromkeys(names), self._report)
        missing = [name for name in come if not (self.folder / name).is_file()]
        if missing:
            raise ValueError(f"{', '.join(missing)} was not written into {self.folder}")
        last = self._last_set(folder)
        for name in come:
            if name not in last and os.path.lexists(folder / name):
                raise SurroundingsError("is in the way, and no report lists it as replaceable", folder / name)
        _make_own(folder)
        before = tuple(name for name in last if name not in keep or name in come)
        (self.folder / _OLD).mkdir()
        for name in before:
            link_file(folder / name, self.folder / _OLD / name)
        journal = {"target": folder.name, "come": come, "go": sorted(set(before) - set(come)), "before": before}
        (self.folder / _JOURNAL).write_text(json.dumps(journal), "utf-8", newline="\n")

    def _recover(self) -> None:
        """Go on with a swap that was being undone, then finish one that was committed, if there is any."""
        for role, step in (("undo", self._back), ("swap", self._forward)):
            if self._beside(role).exists():
                step(self._beside(role))
                self._done(self._beside(role))

    def _forward(self, swap: Path) -> None:
        """Put a committed set in its place; may be repeated from any point."""
        journal = _Swap.read(swap / _JOURNAL)
        folder = self._out / journal.target
        _make_own(folder)
        for name in journal.come[:-1]:
            _move(swap / name, folder / name)
        for name in journal.go:
            _remove(folder / name)
        _move(swap / journal.come[-1], folder / journal.come[-1])

    def _back(self, undo: Path) -> None:
        """Put the old set back; may be repeated from any point."""
        journal = _Swap.read(undo / _JOURNAL)
        folder = self._out / journal.target
        _make_own(folder)
        for name in journal.before:
            _move(undo / _OLD / name, folder / name)
        for name in journal.come:
            if name not in journal.before:
                _remove(folder / name)

    def _done(self, swap: Path) -> None:
        """Remove a swap whose files are all in place: rename it to the private folder, then clear that."""
        retry(lambda: swap.rename(self.folder))
        self._clear()

    def _clear(self) -> None:
        """Remove the private folders of files being written for this name; only this run can own them, by its lock."""
        for path in self._partial():
            _discard(path)

    def _give_up(self, folder: Path, error: OSError) -> None:
        """Undo a swap that failed; raises SurroundingsError in any case."""
        try:
            retry(lambda: self._beside("swap").rename(self._beside("undo")))
            self._back(self._beside("undo"))
            self._done(self._beside("undo"))
        except OSError as second:
            raise SurroundingsError(
                f"a swap of files failed and could not be undone ({second.strerror or second}); "
                "the next run will try again",
                folder,
            ) from error
        raise _surroundings_error(error, folder) from error

    def _last_set(self, folder: Path) -> tuple[str, ...]:
        """Names of the files that the report in a folder lists and that are there, the report last.

        Empty where there is no report. Raises SurroundingsError where the report is no report of camgeo.
        """
        if not os.path.lexists(folder):
            return ()
        _make_own(folder)
        report = folder / self._report
        if not os.path.exists(report):  # noqa: PTH110 - pathlib raises where it may not look
            return ()
        if not report.is_file():  # a pipe, say, whose reader waits
            raise SurroundingsError("is not a report of camgeo; move it out of the way", report)
        text = report.read_bytes()
        try:
            entries = [entry["path"] for entry in json.loads(text)["files"]]
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            raise SurroundingsError("is not a report of camgeo; move it out of the way", report) from error
        names = [name for name in dict.fromkeys(entries) if isinstance(name, str) and self._is_own_name(name)]
        return (*(name for name in names if _is_file(folder / name)), self._report)

    def _is_own_name(self, name: str) -> bool:
        """Whether a file can be one of this recipe's: a plain name that begins as those of its family do.

        Another file that a report names, perhaps changed by hand, is not touched.
        """
        return (
            _is_plain_name(name)
            and name.startswith(self._family.begins or (self._name, "report."))
            and name != self._name
        )

    def _beside(self, role: str) -> Path:
        return self._out / f".{self._name}.{self._family.role}{role}"

    def _partial(self) -> list[Path]:
        pattern = re.compile(re.escape(self._beside("partial-").name) + "[0-9]+")
        return [path for path in sorted(self._out.iterdir()) if pattern.fullmatch(path.name)]

    def _unlock(self) -> None:
        """Let the next run of this name begin."""
        unlock(self._lock, self._beside("lock"))


def _is_plain_name(name: str) -> bool:
    """Whether a name is a single component of a path on every system, not hidden and printable."""
    return bool(name) and not name.startswith(".") and name.isprintable() and not set(name) & set('/\\:*?"<>|')


def _make_own(folder: Path) -> None:
    """Make a folder if there is none; raises SurroundingsError where anything else stands there, a link included."""
    with suppress(FileExistsError):
        folder.mkdir()
    if not stat.S_ISDIR(folder.lstat().st_mode):
        raise SurroundingsError("is in the way: a file or a symbolic link where a folder of its own should be", folder)


def _move(source: Path, target: Path) -> None:
    """Rename over whatever file is there, unless that was done before or both are the same file already."""
    if not os.path.lexists(source):
        return
    if os.path.lexists(target) and os.path.samestat(source.lstat(), target.lstat()):
        return
    retry(lambda: source.replace(target))


def _remove(path: Path) -> None:
    """Remove a file if it is there."""
    retry(lambda: path.unlink(missing_ok=True))


def _is_file(path: Path) -> bool:
    """Whether a file is there, or a symbolic link, which is replaced as such and never followed."""
    try:
        mode = os.lstat(path).st_mode
    except FileNotFoundError:
        return False
    return stat.S_ISREG(mode) or stat.S_ISLNK(mode)


def _discard(folder: Path) -> None:
    """Remove a private folder with all that is in it; symbolic links are removed, not followed."""
    if folder.is_symlink() or not folder.is_dir():
        folder.unlink()
        return
    for path in folder.iterdir():
        _discard(path)
    folder.rmdir()


def _surroundings_error(error: OSError, path: Path) -> SurroundingsError:
    """SurroundingsError for an OSError, at the path that the system named, or else `path`.

    For a permission refused on Windows it advises to close other programs that have the file open.
    """
    place = Path(os.fsdecode(error.filename)) if isinstance(error.filename, (str, bytes)) else path
    text = error.strerror or str(error)
    if system.WINDOWS and isinstance(error, PermissionError):
        text += "; if another program has it open, close it there and run the command again"
    return SurroundingsError(text, place)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Path of a folder that is removed at the end; raises SurroundingsError in place of an OSError within."""
    import tempfile

    try:
        with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
            yield Path(folder)
    except OSError as error:
        raise _surroundings_error(error, Path(tempfile.tempdir or os.curdir)) from error
