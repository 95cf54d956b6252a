"""A corpus of tables as others write them: sound ones, and ones with one row or a swapped pair that is wrong.

Motions are every law of the catalogue, two laws in turn, lobes with and without ramps, sums of harmonics, and motions
that are cut off above their foot, as a lift is by the lash: these have a corner there. A table has rows 0.5 to 20
degrees apart, to 3 to 6 decimals or significant digits, with zeros at its ends or without.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kin.law.sources.laws import NAMES, named
from kin.law.sources.least_jerk import least
from kin.law.sources.lobe import Ramp, lobe
from kin.law.sources.programme import Dwell, Move, programme
from kin.law.sources.tabled import tabled
from kin.read.tables import read_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kin.law.sources.motion import Motion
    from kin.law.sources.ring import Samples
    from kin.numeric.arrays import Array

TURN = 2 * math.pi
STEPS = (0.5, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 18.0, 20.0)
KINDS = ("law", "law", "law", "law", "two laws", "lobe", "ramps", "corner", "harmonics")
FORMS: tuple[Callable[[float, int], str], ...] = (
    lambda value, digits: f"{value:.{digits}f}",
    lambda value, digits: f"{value:.{digits}f}".rstrip("0").rstrip(".").replace("-0", "0"),
    lambda value, digits: f"{value:.{digits}g}",
    lambda value, digits: f"{value:#.{digits}g}",
)
POWERS = ((2, 8, 14, 20, 26), (2, 6, 8, 10, 12), (2, 10, 18, 26, 34))
READINGS, CHANGES = (
    10.0,
    5.0,
)  # least error of a wrong row, in its readings and in what leaving the sound one out changes


@dataclass(frozen=True)
class Written:
    """A table: what it is of, its cells, and the indices of its wrong rows, with what was done to them."""

    about: str
    step: float
    cells: tuple[str, ...]
    wrong: tuple[int, ...] = ()
    harm: str = ""

    @property
    def rows(self) -> Samples:
        """The rows as a file of them is read; line k has row k - 1."""
        return read_table("\n".join(f"{k * self.step:g};{cell}" for k, cell in enumerate(self.cells)))

    def is_named(self, motion: Motion) -> bool:
        """Whether one of the wrong rows has a remark of the motion."""
        sentences = (
            [remark.sentence for remark in motion.kept.remarks if remark.name == "table-row"] if motion.kept else []
        )
        return any(f"line {i + 1}:" in sentence for i in self.wrong for sentence in sentences)


def _motion(rng: np.random.Generator, kind: str) -> tuple[Callable[[Array], Array], str]:
    """A displacement, mm, at degrees, and what it is."""
    stroke = float(rng.uniform(2.0, 30.0))
    if kind == "harmonics":
        k = np.arange(1, 5)[:, None]
        size, phase = rng.uniform(-1.0, 1.0, (4, 1)) / k**2, rng.uniform(0.0, TURN, (4, 1))
        wave = lambda deg: (size * np.cos(k * np.radians(deg) + phase)).sum(axis=0)  # noqa: E731
        low, high = wave(np.linspace(0.0, 360.0, 3601)).min(), wave(np.linspace(0.0, 360.0, 3601)).max()
        return lambda deg: stroke * (wave(deg) - low) / (high - low), kind
    if kind in {"lobe", "ramps"}:
        half, powers = float(rng.uniform(50.0, 80.0)), POWERS[int(rng.integers(3))]
        ramp = Ramp(float(rng.uniform(0.1, 0.4)), math.degrees(rng.uniform(0.01, 0.03))) if kind == "ramps" else None
        motion = lobe(stroke, math.radians(half), powers, nose=math.pi * int(rng.integers(2)), ramp=ramp)
        about = f"{kind} {half:.1f} {powers}"
    else:
        up, down = (round(float(rng.uniform(50.0, 175.0)), int(rng.integers(0, 3))) for _ in range(2))
        top = math.floor(10.0 * rng.uniform(0.0, 359.0 - up - down)) / 10.0 if rng.random() < 0.5 else 0.0
        rise, back = (str(rng.choice(NAMES)) for _ in range(2))
        back = back if kind == "two laws" else rise
        steps: list[Dwell | Move] = [Move(math.radians(up), named(rise), by=stroke)]
        steps += [Dwell(math.radians(top))] if top else []
        steps += [Move(math.radians(down), named(back), by=-stroke), Dwell(math.radians(360.0 - up - top - down))]
        motion = programme(steps, TURN)
        about = f"{kind} {rise} {back} {up:g} {top:g} {down:g}"
    cut = stroke * float(rng.uniform(0.01, 0.1)) if kind == "corner" else 0.0
    return lambda deg: np.maximum(motion.derivatives(np.mod(np.radians(deg), TURN), 0)[0] - cut, 0.0), about


def sound(rng: np.random.Generator) -> Written:
    """One sound table."""
    displacement, about = _motion(rng, KINDS[int(rng.integers(len(KINDS)))])
    step, digits, form = STEPS[int(rng.integers(len(STEPS)))], int(rng.integers(3, 7)), int(rng.integers(len(FORMS)))
    cells = tuple(FORMS[form](value, digits) for value in displacement(np.arange(0.0, 360.0, step)).tolist())
    return Written(f"{about}, {step:g} degrees, form {form} to {digits}", step, cells)


def _harmed(rng: np.random.Generator, table: Written) -> Written | None:
    """The table with a digit, a sign or a decimal point changed, or two rows swapped; None where that cannot be."""
    cells, i = list(table.cells), int(rng.integers(len(table.cells)))
    harm, cell = ("digit", "swap", "sign", "point")[int(rng.integers(4))], table.cells[i]
    wrong: tuple[int, ...] = (i,)
    if harm == "swap":
        wrong = i, (i + 1) % len(cells)
        cells[i], cells[wrong[1]] = cells[wrong[1]], cell
    elif harm == "sign":
        cells[i] = f"-{cell}"
    elif "e" in cell or (harm == "point" and "." not in cell):
        return None
    elif harm == "digit":
        k = int(rng.choice([k for k, letter in enumerate(cell) if letter.isdigit()]))
        cells[i] = f"{cell[:k]}{int(rng.integers(10))}{cell[k + 1 :]}"
    else:
        digits, k = cell.replace(".", ""), cell.index(".") + int(rng.choice([-1, 1]))
        cells[i] = f"{digits[:k] or '0'}.{digits[k:]}"
    return replace(table, cells=tuple(cells), wrong=wrong, harm=harm)


def spoilt(rng: np.random.Generator) -> Written:
    """One table with an error that can be told: 10 readings, and 5 times what leaving the sound row out changes."""
    while True:
        table = sound(rng)
        harmed = _harmed(rng, table)
        if harmed is None:
            continue
        layout = tabled(table.rows, None, TURN, 1, rest=None, field="motion")
        index = list(harmed.wrong)
        error = float(np.abs(harmed.rows.s - table.rows.s)[index].max())
        if error < READINGS * float(layout.resolution[index].max()):
            continue
        changes = []
        for i in index:
            bounds = layout.bounds()
            others = least(layout.space, bounds.at(np.delete(np.arange(len(bounds.x)), i)))
            changes.append(
                math.inf if others is None else abs(float(others.curve(bounds.x[[i]])[0]) - float(layout.s[i]))
            )
        if error >= CHANGES * max(changes):
            return harmed


def corpus(count: int, seed: int) -> Iterator[tuple[Written, Written]]:
    """So many sound tables, and as many spoilt ones."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield sound(rng), spoilt(rng)
