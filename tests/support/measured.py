"""Points as an instrument would give them of a made part: the exact contours, a planted fault, noise by chance."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.recipe.recipe import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intents

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

COUNT = 720
AT = np.radians(50.0)  # parameter of a planted fault

MOTION = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 40}, {return: 8, over: 140, law: cycloidal}, {dwell: 60}]"
SWING = MOTION.replace(": 8,", ": 12,")
HALF = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 60}]"
ARM = "arm: {length: 65, pivot: 80}"


def disc(follower: str, motion: str = MOTION, more: str = "", part: str = "bore: 12") -> str:
    cam = f"base_radius: 40, {more}follower: {{{follower}}}, motion: {motion}"
    return f"part: {{{part}}}\nverify: {{angles: 360}}\ncam: {{kind: disc, {cam}}}"


def shipped(name: str) -> str:
    return (Path(__file__).parents[2] / "recipes" / f"{name}.yaml").read_text("utf-8")


RECIPES = {
    "roller on a stem": disc("kind: roller, radius: 10, offset: 6"),
    "knife edge on a stem": disc("kind: knife-edge, offset: -5"),
    "shoe on a stem": disc("kind: shoe, radius: 60"),
    "roller on a trailing arm": disc(f"kind: roller, radius: 10, {ARM}", SWING),
    "roller on a leading arm": disc(f"kind: roller, radius: 10, {ARM[:-1]}, side: leading}}", SWING),
    "ring": disc("kind: roller, radius: 10", MOTION, "track: internal, ", "outer: 160"),
    "groove": disc("kind: roller, radius: 10, offset: 6", MOTION, "track: {groove: {clearance: 0.03}}, "),
    "conjugate discs": disc("kind: roller, radius: 10", MOTION, "conjugate: {radius: 12, distance: 118}, "),
    "flat": disc("kind: flat"),
    "tilted flat": disc("kind: flat, tilt: 8"),
    "flat on an arm": disc("kind: flat, arm: {pivot: 90, face: 5}", SWING.replace("12,", "6,")),
    "yoke": shipped("reuleaux"),
    "roller yoke": shipped("hypocycloid"),
    "double roller": shipped("w-figure-5"),
    "flat pair": shipped("w-figure-9"),
    "four-bar": shipped("as-figure-9-1"),
}


def bump(height: float, width: float = 6.0) -> Callable[[Array], Array]:
    """A fault of that height, mm, of a normal distribution's shape, as many degrees wide."""

    def deviation(t: Array) -> Array:
        away = np.mod(t - AT + np.pi, 2.0 * np.pi) - np.pi
        return height * np.exp(-0.5 * (away / np.radians(width)) ** 2)

    return deviation


def nothing(t: Array) -> Array:
    return np.zeros_like(t)


@cache
def surfaces(text: str) -> tuple[tuple[int, Any, Any], ...]:
    """Disc, part and surface of each surface that the recipe of a text has."""
    recipe = read(text.encode(), "part.yaml")
    parts = intents(recipe, designed(recipe))
    return tuple((k, part, surface) for k, part in enumerate(parts) for surface in part.surfaces)


def points(
    part: Any, surface: Any, deviation: Callable[[Array], Array] = nothing, noise: float = 0.0, count: int = COUNT
) -> Array:
    """Points of a surface (n, 2), mm, as the file is drawn."""
    t = np.arange(count) * 2.0 * np.pi / count
    frame = surface.gauge.envelope.frames(t)
    off = deviation(t) + noise * np.random.default_rng(1).normal(size=count)
    sign = np.array([1.0, -1.0 if part.mirrored else 1.0])
    return (frame.points + (surface.side * off)[:, None] * frame.normals) * sign


def table(places: Array, heading: str = "x_mm,y_mm") -> str:
    return "\n".join([heading, *(f"{x:.7f},{y:.7f}" for x, y in places)]) + "\n"


def measured(
    folder: Path, text: str, deviation: Callable[[Array], Array] = nothing, noise: float = 0.0, count: int = COUNT
) -> tuple[Path, list[Path]]:
    """A recipe and files of points of all its discs in a folder; the first surface has the deviation."""
    recipe = folder / "part.yaml"
    recipe.write_text(text, "utf-8")
    rows: dict[int, list[Array]] = {}
    for rank, (disc_, part, surface) in enumerate(surfaces(text)):
        planted = deviation if rank == 0 else nothing
        rows.setdefault(disc_, []).append(points(part, surface, planted, noise, count))
    files = []
    for disc_, places in rows.items():
        files.append(folder / f"points-{disc_ + 1}.csv")
        files[-1].write_text(table(np.concatenate(places)), "utf-8")
    return recipe, files


def turned(places: Array, degrees: float) -> Array:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return places @ np.array([[c, s], [-s, c]])
