"""The discs of a shaft judged from several files: each by its own intent, then the play between their surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from kin.judge.closure import judge_closures
from kin.judge.verify import verify, verify_together
from kin.numeric.check import about
from kin.numeric.lengths import marked
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.judge.intent import Limits, ShaftIntent
    from kin.judge.verdict import ClosureVerdict, SurfaceVerdict, Verdict
    from kin.numeric.check import Check


class DiscFile(NamedTuple):
    """A file with the disc of a shaft of index `disc`, or with all of them (None); `units`, mm, is the unit given."""

    path: Path
    disc: int | None
    units: float | None = None


class DiscsRead(NamedTuple):
    """Surfaces that were read from a file; `file` is its name, `uneven` the greatest difference of its sections, mm."""

    file: str
    surfaces: Sequence[SurfaceVerdict]
    uneven: float = 0.0


def verify_set(files: Sequence[DiscFile], shaft: ShaftIntent, angles: int, limits: Limits) -> list[Verdict]:
    """Judge files that go together, at least one; closures between discs stand in the verdict on the last file.

    `angles` are equal steps of the shaft. A closure is left out if one of its discs is not given or cannot be read.
    Raises OSError where the disk refuses, UnitsError where a file states another unit than the one given, and
    ValueError for another suffix or no angles.
    """
    verdicts = []
    for path, disc, units in files:
        if disc is None:
            verdicts.append(verify_together(path, shaft, angles, limits))
        else:
            verdicts.append(verify(path, shaft.parts[disc], angles, limits, units))
    read = [
        DiscsRead(file.path.name, verdict.surfaces, verdict.uneven)
        for file, verdict in zip(files, verdicts, strict=True)
    ]
    closures, checks = left_between(read, shaft, limits)
    last = verdicts[-1]
    verdicts[-1] = replace(last, checks=(*last.checks, *checks), closures=(*last.closures, *closures))
    return verdicts


def left_between(
    files: Sequence[DiscsRead], shaft: ShaftIntent, limits: Limits
) -> tuple[tuple[ClosureVerdict, ...], tuple[Check, ...]]:
    """Judge the play between surfaces of discs that were read from files: closures and checks.

    The checks are reported under the last file, with the others named.
    """
    intents = {surface.name: surface for part in shaft.parts for surface in part.surfaces}
    verdicts = [verdict for file in files for verdict in file.surfaces]
    surfaces = [(intents[verdict.name], verdict.contour) for verdict in verdicts if verdict.contour is not None]
    closures, checks = judge_closures(surfaces, shaft.closures, limits, max(file.uneven for file in files))
    others = ", ".join(file.file for file in files[:-1])
    if others:
        checks = [
            replace(check, detail=f"{marked(check.detail)}; with {others}".removeprefix("; ")) for check in checks
        ]
    return closures, tuple(about(check, files[-1].file) for check in checks)
