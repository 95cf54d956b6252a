"""The attack of a number: the same for the same seed, whoever asks for it."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from attacks import (
    axes,  # needs: axis
    calls,
    drives,
    drums,  # needs: cylindrical
    files,
    ground,
    indexing,  # needs: indexing
    measured,
    plates,  # needs: linear
    recipes,
    shafts,
    tables,
    valves,
    wider,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from attacks.outcome import Attack

WAYS: tuple[Callable[[Random, int], Attack], ...] = (
    recipes.sound,
    recipes.of_any_kind,
    recipes.wrong,
    files.altered,
    wider.furnished,
    tables.tabled,
    tables.mangled,
    recipes.wrong,
    files.altered,
    calls.called,
    wider.sized,
    recipes.of_any_kind,
    recipes.wrong,
    files.altered,
    wider.furnished,
    files.altered,
    wider.bomb,
    tables.redrawn,
    recipes.sound,
    recipes.wrong,
    files.altered,
    calls.called,
    wider.searched,
    wider.dropped,
    wider.budgeted,  # needs: budget
    wider.on_a_shaft,
    shafts.flush,
    valves.carded,
    drives.driven,
    drives.tabled_for_a_drive,
    measured.probed,  # needs: made
    measured.corrected,  # needs: made
    measured.of_a_shaft,  # needs: camshaft, made
    ground.ground,
    ground.tabled_for_a_grinder,
    ground.pressed,
    ground.named,
    calls.followed,  # needs: follow
    recipes.of_the_schema,
    recipes.of_the_schema,
    calls.misnamed,
    calls.followed_by_name,  # needs: follow
    plates.slid,  # needs: linear
    plates.tabled,  # needs: linear
    plates.mangled,  # needs: linear
    axes.driven,  # needs: axis
    axes.misdriven,  # needs: axis
    drums.turned,  # needs: cylindrical
    drums.stepped,  # needs: cylindrical
    drums.slipped,  # needs: cylindrical
    drums.wound,  # needs: cylindrical
    drums.milled,  # needs: cylindrical, milling
    indexing.stepped,  # needs: indexing
    indexing.unrolled,  # needs: indexing
    indexing.slipped,  # needs: indexing
    indexing.milled,  # needs: indexing, milling
)
"""Ways to attack, in turn."""


def attack_of(seed: int, number: int) -> Attack:
    """Give the attack of a number, deterministic in both."""
    return WAYS[number % len(WAYS)](Random(f"attack {seed} {number}"), number)
