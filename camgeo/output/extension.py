"""What a run asks of capabilities and formats."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.measures.extension import Results
from camgeo.registry.formats import of_formats
from camgeo.registry.slot import EMPTY, NO_CHECK, Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.common.clock import Clock
    from camgeo.files.mesh import Item
    from camgeo.files.precision import Precision
    from camgeo.measures.file_result import FileResult
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.report.document import Findings
    from camgeo.synthesis.design import Design
    from kin.numeric.check import Check


class CallOption(NamedTuple):
    """Option of `camgeo verify`, a keyword of the library: its help, the word for its value in help, its choices.

    An option without choices takes any text.
    """

    about: str
    metavar: str = ""
    choices: tuple[str, ...] = ()


class FileCall(NamedTuple):
    """Arguments of `verify` for a capability's own files.

    `units` is the length, mm, of the unit of files that state none, None for the recipe's; `options` by name.
    """

    paths: Sequence[Path]
    units: float | None = None
    options: Mapping[str, object] = EMPTY


@dataclass(frozen=True, kw_only=True)
class Output:
    """Answers of a capability that makes or judges files.

    demand    raises SurroundingsError where a library that it needs is missing, before anything is designed
    left_out  pairs (name, reason) of what a run leaves out: (recipe, requests of files, design)
    foresee   refuses what is certain to be refused of files with its `Variant`, before anything is fitted
    make      writes and judges the files of a request with its `Variant`: (job, request, path of the first file)
    look      checks of files beside the judge's: (recipe, design, all files, checks of them so far, clock)
    claims    whether `verify` leaves a file of the label's suffixes to it, by its heading or the options of the call;
              raises OSError where the file cannot be read
    options   options of a call on such files, by name; the command line gives their values as text
    judge     checks and sections on such files; raises CallError for files that cannot be judged, SurroundingsError
              where the disk refuses
    """

    demand: Callable[[Recipe], None] = NO_CHECK
    left_out: Callable[[Recipe, Sequence[FileRequest], Design], Sequence[tuple[str, str]]] = always(())
    foresee: Callable[[Job, FileRequest], None] = NO_CHECK
    make: Callable[[Job, FileRequest, Path], MadeFiles] | None = None
    look: Callable[[Recipe, Design, Sequence[FileResult], Sequence[Check], Clock], Results] = always(Results())
    claims: Callable[[Path, Mapping[str, object]], bool] = always(False)
    options: Mapping[str, CallOption] = EMPTY
    judge: Callable[[Recipe, Design, FileCall, Clock], Results] | None = None


OUTPUTS = Slot("output", Output())


class RunResults(NamedTuple):
    """Results of a run, for files that report on all others.

    `job` is None where a check of the exact contour fails, so that no cam is made.
    """

    recipe: Recipe
    design: Design
    findings: Findings
    job: Job | None
    clock: Clock


@dataclass(frozen=True, kw_only=True)
class Making:
    """What makes the files of a format.

    make       fits, writes, reads back and judges one file at a path
    summarise  writes files that report on all others of a run, when they are judged: (run, request, path)
    foresee    refuses what is certain to be refused, before anything is fitted; raises MissingExtraError where a
               package is missing that makes its files, which are then left out
    unmade     pairs (name, reason) of features of the part that its files leave out
    numbers    gives the precision of the numbers of a mesh; None for a format without meshes
    write      writes named meshes in their places: (path, meshes, title, mm of the unit, about)
    """

    make: Callable[[Job, FileRequest, Path], MadeFiles] | None = None
    summarise: Callable[[RunResults, FileRequest, Path], MadeFiles] | None = None
    foresee: Callable[[Job, FileRequest], None] = NO_CHECK
    unmade: Callable[[Recipe, Design], Sequence[tuple[str, str]]] = always(())
    numbers: Callable[[], Precision] | None = None
    write: Callable[[Path, Sequence[Item], str, float, str], None] | None = None


MAKING = of_formats("MAKING", Making())
"""`MAKING` of each format by its word."""


def numbers_of(kind: str, mm: float) -> Precision:
    """Precision of the numbers of a mesh in a unit of `mm` mm; raises ValueError for a format without meshes."""
    numbers = MAKING[kind].numbers
    if numbers is None:
        raise ValueError(f"{kind} holds no mesh")
    return numbers().in_units(mm)
