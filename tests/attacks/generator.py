"""The attack of a number: the same for the same seed, whoever asks for it."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from attacks import calls, files, recipes

if TYPE_CHECKING:
    from attacks.outcome import Attack

WAYS = ("sound", "any kind", "wrong", "wrong", "file", "file", "file", "call")


def attack_of(seed: int, number: int) -> Attack:
    """Give the attack of a number, deterministic in both."""
    rng = Random(f"attack {seed} {number}")
    way = WAYS[number % len(WAYS)]
    if way == "sound":
        return recipes.sound(rng, number)
    if way == "any kind":
        return recipes.of_any_kind(rng, number)
    if way == "wrong":
        return recipes.wrong(rng, number)
    if way == "file":
        return files.altered(rng, number, seed)
    return calls.called(rng, number)
