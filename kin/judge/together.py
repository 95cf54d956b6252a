"""The discs of a shaft judged from several files: each by its own intent, then what is left between their surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from kin.judge.check import about
from kin.judge.closure import judge_closures
from kin.judge.verify import verify, verify_together
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.judge.closure import Surface
    from kin.judge.intent import Limits, ShaftIntent
    from kin.judge.verdict import Verdict


class DiscFile(NamedTuple):
    """A file with one disc of a shaft, by its place among them, or with all of them (None); and the unit given, mm."""

    path: Path
    disc: int | None
    units: float | None = None


def verify_set(files: Sequence[DiscFile], shaft: ShaftIntent, angles: int, limits: Limits) -> list[Verdict]:
    """Judge files that are made to go together; a closure stands in the verdict on the last file that it needs.

    One whose surfaces are not all there, as a disc is not given or cannot be read, is left out. Raises as `verify`.
    """
    verdicts = []
    there: dict[str, tuple[Surface, float, str]] = {}
    for path, disc, units in files:
        if disc is None:
            verdict, parts = verify_together(path, shaft, angles, limits), shaft.parts
        else:
            verdict, parts = verify(path, shaft.parts[disc], angles, limits, units), (shaft.parts[disc],)
        intents = {surface.name: surface for part in parts for surface in part.surfaces}
        for found in verdict.surfaces:
            if found.contour is not None:
                there[found.name] = ((intents[found.name], found.contour), verdict.uneven, path.name)
        verdicts.append(_closed(verdict, there, shaft, limits, path.name))
    return verdicts


def _closed(
    verdict: Verdict, there: dict[str, tuple[Surface, float, str]], shaft: ShaftIntent, limits: Limits, file: str
) -> Verdict:
    """The verdict with the closures for which its file brings the last surface."""
    new = {surface.name for surface in verdict.surfaces}
    for closure in shaft.closures:
        names = {closure.pushes, closure.stops}
        if not names & new or not names <= set(there):
            continue
        uneven = max(there[name][1] for name in names)
        closures, checks = judge_closures([there[name][0] for name in sorted(names)], [closure], limits, uneven)
        others = sorted({there[name][2] for name in names} - {file})
        if others:
            told = f"with {', '.join(others)}"
            checks = [replace(check, detail=f"{check.detail}; {told}" if check.detail else told) for check in checks]
        verdict = replace(
            verdict,
            checks=(*verdict.checks, *(about(check, file) for check in checks)),
            closures=(*verdict.closures, *closures),
        )
    return verdict
