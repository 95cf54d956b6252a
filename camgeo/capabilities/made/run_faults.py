"""Local faults of earlier runs: which of them a correction takes off, and what is left of a run's deviation for it.

A dent of a single part says nothing of the machine: taken off its program it would be a bump of the next part. So a
local fault is left out until a later run has it too, where it was not corrected yet: then it is the machine's, and
counts once, as the mean of both; from then on it counts in each run, as all that the machine adds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.made.causes import local_form
from kin.made.smooth import Smooth
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.made.local_faults import LocalFault
    from kin.made.points import Deviations
    from kin.made.smooth import SmoothFit
    from kin.numeric.arrays import Array


class RunFault(NamedTuple):
    """A local fault of a run, and the index of the first run that has it too; None for one that is left out."""

    fault: LocalFault
    first: int | None


class CountedRun(NamedTuple):
    """Part of a run's deviation that counts for the machine's, mm, and the local faults of the run."""

    curve: Smooth
    faults: tuple[RunFault, ...]


@dataclass(frozen=False)
class _Seen:
    """A fault of a run, with what it adds to the coefficients of the run's curve, (N,), and whether it counts."""

    run: int
    fault: LocalFault
    part: Array
    counts: bool = False

    def has(self, fault: LocalFault) -> bool:
        """Whether a fault of a later part may be the same; of one that counts any rest that a correction left is."""
        return bool(self.fault.holds(np.array([fault.at]))[0]) if self.counts else self.fault.alike(fault)


def counted(runs: Sequence[Sequence[tuple[Deviations, SmoothFit]]]) -> list[CountedRun]:
    """What counts of each run, from the deviations of its files and the curves through them, all on the same spans."""
    seen: list[_Seen] = []
    found = []
    for run, files in enumerate(runs):
        forms = [local_form(*file) for file in files]
        earlier = [[_first(seen, fault) for fault in form.faults] for form in forms]
        left = [
            [fault for fault, first in zip(form.faults, firsts, strict=True) if first is None]
            for form, firsts in zip(forms, earlier, strict=True)
        ]
        curves = [form.without(faults) for form, faults in zip(forms, left, strict=True)]
        curve, new = Smooth.total(curves).times(1.0 / len(files)), list[_Seen]()
        for form, firsts in zip(forms, earlier, strict=True):
            for fault, first in zip(form.faults, firsts, strict=True):
                if first is not None and first.counts:
                    continue
                whole = form.fitted.curve.coefficients
                part = (whole - form.without([fault]).coefficients) / len(files)
                if first is None:  # of several files, the same fault once
                    beside = _first(new, fault)
                    new += [_Seen(run, fault, part)] if beside is None else []
                    if beside is not None:
                        beside.part = beside.part + part
                else:  # seen for the second time: the mean of both
                    curve = replace(curve, coefficients=curve.coefficients - 0.5 * part)
        for again in {id(first): first for firsts in earlier for first in firsts if first is not None}.values():
            if not again.counts:
                again.counts = True
                curve = replace(curve, coefficients=curve.coefficients + 0.5 * again.part)
        faults = [
            RunFault(fault, None if first is None else first.run)
            for form, firsts in zip(forms, earlier, strict=True)
            for fault, first in zip(form.faults, firsts, strict=True)
        ]
        found.append(CountedRun(curve, tuple(faults)))
        seen += new
    return found


def _first(seen: Sequence[_Seen], fault: LocalFault) -> _Seen | None:
    """The first fault that may be the same."""
    return next((own for own in seen if own.has(fault)), None)
