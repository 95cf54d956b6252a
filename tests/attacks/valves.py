"""Cam cards by chance: met by the figure `duration`, or refused with a card that is met."""

from __future__ import annotations

import json
import math
import re
from typing import TYPE_CHECKING

from attacks.outcome import Attack

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

LIFTS = (0.02, 0.15, 0.5, 1.27, 2.5, 5.08, 8.0)
WITHIN = 1e-6  # crank degrees, by which the figure may be off a card that is met
VALVES: tuple[str, ...] = (
    "valve: {ratio: 1.6, lash: 0.3}\n",  # needs: valve
    "valve: {ratio: 1, lash: 40}\n",  # needs: valve
    "valve: {ratio: {table: [[0, 1.5], [6, 1.6], [12, 1.55]]}}\n",  # needs: valve
    "valve: {ratio: {table: [[0, 1.5], [6, 1.6], [7, 0.01]]}, lash: 0.2}\n",  # needs: valve
    "valve: {ratio: -1}\n",  # needs: valve
)
TRAINS: tuple[str, ...] = (
    "spring: {on: valve, seat_length: 40, loads: [[40, 260], [20, 900]], solid_length: 18}",  # needs: dynamics
    "spring: {on: tappet, seat_length: 40, free_length: 70, rate: 30 N/mm}, load: 3",  # needs: dynamics
    "spring: {seat_length: 40, free_length: 70, rate: 30 N/mm}",  # needs: dynamics
    "spring: {on: valve, seat_length: 40, free_length: 70, rate: 30}, stiffness: 1e6",  # needs: dynamics
)
MASSES = ("0.1", "{tappet: 0.05, valve: 0.08}", "{tappet: 1e-9, valve: 1e9}", "{valve: 0}")
REFUSED = re.compile(r"give|let|lies? between|longer than|shorter durations|leaves nothing|half and powers")


def carded(rng: Random, number: int) -> Attack:
    """A lobe by its card, with ramps, its sides alike or not."""
    lift = round(rng.uniform(4.0, 12.0), 2)
    ramp = rng.choice(
        ["", "", f", ramp: {{height: {rng.choice([0.1, 0.3, 20])}, velocity: {rng.choice([0.01, 0.02, 1e-6])}}}"]
    )

    def card(share: float) -> list[tuple[float, float]]:
        """Of about a cosine, whose halves are met by no lobe to the last degree."""
        whole, rows = rng.uniform(230, 330), []
        for at in sorted(rng.sample(LIFTS, rng.randrange(1, 4))):
            part = math.acos(2.0 * min(at / lift, 1.0) - 1.0) / math.pi
            rows.append((at, round(share * (whole * part + rng.uniform(-4, 4)), 1)))
        return rows

    def written(rows: list[tuple[float, float]]) -> str:
        return ", ".join(f"{{at_lift: {at}, degrees: {degrees}}}" for at, degrees in rows)

    even = rng.random() < 0.7
    rows = card(1.0)
    shape = f"duration: [{written(rows)}]{ramp}{rng.choice(['', '', ', least: velocity', ', least: face'])}"
    if not even:
        other = rng.choice(["half: 66, powers: [2, 8, 14, 20, 26]", f"duration: [{written(card(0.5))}]{ramp}"])
        shape = f"opening: {{duration: [{written(card(0.5))}]}}, closing: {{{other}}}"
    bounds = ", ".join(
        f"{{at_lift: {at}, at_least: {degrees - WITHIN!r}, at_most: {degrees + WITHIN!r}}}" for at, degrees in rows
    )
    text = "cam:\n  kind: disc\n  base_radius: 40\n  follower: {kind: flat}\n"
    text += f"  motion: {{lobe: {{lift: {lift}, {shape}}}}}\nexport: {{files: [dxf]}}\n"
    text += f"limits: {{duration: [{bounds}]}}\n" if even else ""
    text += rng.choice(["", "", *VALVES])
    if TRAINS and rng.random() < 0.4:
        rpm = round(10 ** rng.uniform(1, 5))
        text += f"dynamics: {{mass: {rng.choice(MASSES)}, rpm: {rpm}, {rng.choice(TRAINS)}}}\n"

    def judge(done: Done, _: Path) -> list[str]:
        if done.status == 2:
            return [] if REFUSED.search(done.err) else [f"verdict: refused without a remedy: {done.err}"[:400]]
        checks = json.loads(done.out)[0]["checks"]
        missed = [check for check in checks if check["name"] == "limit:duration" and not check["ok"]]
        return [f"verdict: a card is not met: {missed}"[:400]] if missed else []

    words = ("check", "lobe.yaml", "--json")
    return Attack(f"card {number}", words, {"lobe.yaml": text.encode()}, (0, 1, 2), judge, seconds=15.0)
