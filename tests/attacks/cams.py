"""Disc cams by chance, whose motion on a drawing is found by brute force (`support.brute_disc`)."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from support.brute_disc import LAWS, Touching, motion, polygon

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

ANGLES = 720
STEP = 0.02  # mm between the points of a contour that is felt
# what looking at points STEP apart misses, mm: STEP^2/(8 R) under a roller of 3 mm, more where it is steep
MARGIN = 5e-5
SHARE = 1.02  # of a limit: 720 angles lie between the worst ones


@dataclass(frozen=True)
class Cam:
    """A disc cam, its follower, and its motion by segments (by, over, law), strokes in mm or degrees."""

    touching: Touching
    base: float
    rows: tuple[tuple[float, float, str], ...]
    rotation: str
    tolerance: float

    def text(self, files: str, more: str = "") -> str:
        """A recipe of it, with these files."""
        export = f"export: {{tolerance: {self.tolerance!r}, files: [{files}]}}\n"
        part = "part: {thickness: 6, bore: 8}\n"
        return self.touching.recipe(
            self.base, list(self.rows), f"rotation: {self.rotation}\nverify: {{angles: 360}}\n{part}{export}{more}"
        )

    @cached_property
    def intended(self) -> np.ndarray:
        """Places of the follower at ANGLES angles, mm or radians."""
        lift = motion(list(self.rows), np.arange(ANGLES) * 360.0 / ANGLES)
        return self.touching.rest(self.base) + (np.radians(lift) if self.touching.sense else lift)

    def error(self, path: Path, mm: float = 1.0) -> float:
        """Greatest motion error on a drawing in a unit of `mm`, in mm or degrees; nan where it is not felt."""
        outline = polygon(path, STEP / mm) * mm
        if self.rotation == "ccw":
            outline = outline.conjugate()
        theta = 2 * np.pi * np.arange(ANGLES) / ANGLES
        try:
            with np.errstate(all="ignore"):
                places = [self.touching.place(outline, angle, self.base) for angle in theta]
        except ValueError:  # at some angle it is nowhere met
            return math.nan
        worst = float(np.abs(np.array(places) - self.intended).max())
        return math.degrees(worst) if self.touching.sense else worst

    @property
    def margin(self) -> float:
        """What brute force itself may be off by, in mm or degrees."""
        return 3.0 * math.degrees(MARGIN / self.touching.length) if self.touching.sense else 3.0 * MARGIN


def drawn(rng: Random) -> Cam:
    """A disc cam with a follower of any kind but a flat face on an arm; most of them can be made."""
    base = round(rng.uniform(25.0, 60.0), rng.choice([0, 2, 6]))
    kind = rng.choice(["roller", "roller", "flat", "knife-edge", "shoe"])
    radius = round(rng.uniform(3.0, 12.0), 2) if kind in {"roller", "shoe"} else 0.0
    touching = Touching(kind, radius, offset=round(rng.choice([0.0, rng.uniform(-8.0, 8.0)]), 3))
    stroke = base * rng.uniform(0.05, 0.3)
    if kind == "flat":
        touching = Touching(kind, tilt=rng.choice([0.0, 0.0, math.radians(rng.uniform(-10.0, 10.0))]))
        stroke = base * rng.uniform(0.02, 0.12)
    elif rng.random() < 0.35:
        pivot = round(base * rng.uniform(2.4, 3.5), 2)
        length = round(pivot * rng.uniform(0.75, 0.95), 2)
        touching = Touching(kind, radius, pivot=pivot, length=length, sense=rng.choice([1, -1]))
        stroke = math.degrees(stroke / length)
    stroke = round(stroke, 4)
    law, back = rng.choice(list(LAWS)), rng.choice(list(LAWS))
    rise, fall = rng.randrange(80, 140), rng.randrange(80, 140)
    top = rng.randrange((360 - rise - fall) // 2)
    rows = [(stroke, rise, law), (0.0, top, ""), (-stroke, fall, back), (0.0, 360 - rise - fall - top, "")]
    rows = [row for row in rows if row[1]]
    turn = rng.randrange(len(rows)) if rng.random() < 0.3 else 0
    return Cam(
        touching,
        base,
        tuple(rows[turn:] + rows[:turn]),
        rng.choice(["cw", "ccw"]),
        rng.choice([0.001, 0.002, 0.005, 0.01]),
    )


def reported(done: Done) -> dict[str, Any] | None:
    """The one report that a call has printed as JSON; None without one."""
    if done.status not in {0, 1}:
        return None
    try:
        report = json.loads(done.out)
    except ValueError:
        return None
    report = report[0] if isinstance(report, list) else report
    return report if "checks" in report else None


def wrong_verdict(cam: Cam, done: Done, path: Path, mm: float = 1.0) -> list[str]:
    """Tell of a motion that is called right and is not, or wrong and is right; within what brute force can tell."""
    report = reported(done)
    if report is None:
        return []
    try:
        error = cam.error(path, mm)
    except Exception:  # noqa: BLE001 - a drawing that ezdxf cannot read is not for this judge
        return []
    checks = [check for check in report["checks"] if check["name"] == "motion" and check.get("file") == path.name]
    limit = max((check["limit"] for check in checks), default=None)
    if report["ok"] and (limit is None or not error <= SHARE * limit + cam.margin):
        return [f"verdict: called right, limit {limit}, off by {error:.6g} by brute force"]
    if limit is not None and not checks[0]["ok"] and error < limit / SHARE - cam.margin:
        return [f"verdict: called wrong, limit {limit}, value {checks[0]['value']}, off by {error:.6g} by brute force"]
    return []
