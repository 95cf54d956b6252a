"""Keys of random programs that mill a turning body, some of them missing, too small or too large."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from random import Random

NEEDED = ("axes", "cutter", "feed", "plunge", "spindle", "safe_height")


def program_keys(
    rng: Random, axes: Sequence[str], diameters: Sequence[float], mm: float, taper: float | None = None
) -> str:
    """Keys of a `gcode` file in a flow mapping; `diameters` of the cutter are in the recipe's unit, which is `mm` mm.

    `taper` is that of a conical roller, degrees; None leaves the key out.
    """
    own = {
        "axes": rng.choice(axes),
        "cutter": f"{rng.choice(diameters)!r}",
        "feed": f"{rng.choice([*[300.0] * 6, 1e-6, 1e7]) / mm!r}",
        "plunge": f"{60 / mm!r}",
        "spindle": "2500",
        "safe_height": f"{rng.choice([*[5.0] * 6, 1e-7]) / mm!r}",
        "depth_of_cut": f"{rng.uniform(0.5, 20.0) / mm!r}",
        "allowance": f"{rng.choice([0.2, 0.2, 3.0]) / mm!r}",
        "decimals": rng.choice(["3", "5", "9"]),
        **({} if taper is None else {"taper": f"{rng.choice([taper, taper, 1.0, 80.0])}"}),
        "feed_mode": rng.choice(["inverse-time", "per-minute"]),
    }
    optional = [key for key in ("allowance", "decimals", "feed_mode", "depth_of_cut", "taper") if key in own]
    for key in (*optional, rng.choice(list(own))):
        if rng.random() < (0.6 if key not in NEEDED else 0.1):
            own.pop(key, None)
    return ", ".join(f"{key}: {value}" for key, value in own.items())
