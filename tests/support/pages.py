"""Pages of shipped recipes as tests want them: each made once, with the data that its script reads."""

from __future__ import annotations

import json
import math
import re
import time
import urllib.request
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.output.pipeline import check_and_show
from camgeo.recipe.loading import load, load_text
from camgeo.report.page.content import content
from camgeo.report.page.page import page
from camgeo.report.page.scene import STEPS
from camgeo.synthesis.design import designed
from support.places import RECIPES

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.scene import MovingBody

SHOWN = ("shu-wu", "as-figure-9-2a", "six-bar", "slider-crank", "oscillating-yoke", "w-law", "w-ellipse")
SHAFT = 2.0 * math.pi * np.arange(STEPS + 1) / STEPS


class Made:
    """A recipe with everything a page shows, made once."""

    def __init__(self, path: Path) -> None:
        self.recipe: Recipe = load(path)
        self.outcome, self.content = check_and_show(self.recipe)
        self.text = page(self.recipe, self.content, self.outcome.report)
        self.data: dict[str, Any] = json.loads(re.findall(r'id="data">(.*?)</script>', self.text, re.DOTALL)[0])

    def pose(self, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """x, y and angle, rad, of a body as the script reads them."""
        index = [body.name for body in self.content.scene.bodies].index(name)
        x, y, angle = (unpacked(row, STEPS + 1) for row in self.data["bodies"][index])
        return x, y, np.radians(angle)

    def plot(self, title: str, series: int = 0) -> np.ndarray:
        (entry,) = (plot for plot in self.data["plots"] if plot["title"] == title)
        return unpacked(entry["series"][series], STEPS + 1)


@cache
def overlaid(name: str, names: str) -> dict[str, MovingBody]:
    """Overlays of a shipped recipe's page by the names of their bodies, without its files.

    The shaft turns clockwise, and the pivot or the normal of face 1 is on the x axis.
    """
    text = (RECIPES / f"{name}.yaml").read_text(encoding="utf-8")
    text = re.sub(r"  files: .*", f"  files: [{{html: {{overlays: [{names}]}}}}]", text)
    recipe = load_text(text, f"{name}.yaml")
    scene = content(recipe, designed(recipe), ()).scene
    return {body.name: body for body in scene.bodies if body.kind == "overlays"}


def origin(body: MovingBody) -> np.ndarray:
    """Where the origin of a body stands over the turn, complex."""
    return body.pose[:, 0] + 1j * body.pose[:, 1]


def along(body: MovingBody) -> np.ndarray:
    """The direction of its x axis over the turn, complex."""
    return np.exp(1j * body.pose[:, 2])


CACHE: dict[str, Made] = {}


def of(name: str) -> Made:
    if name not in CACHE:
        CACHE[name] = Made(RECIPES / f"{name}.yaml")
    return CACHE[name]


def wait(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def put(path: Path, text: str) -> None:
    """Save a file at once: a watch would take what it finds between an emptied file and its text."""
    new = path.with_name("new")
    new.write_text(text, encoding="utf-8")
    new.replace(path)


def fetched(address: str) -> str:
    with urllib.request.urlopen(address, timeout=20) as answer:
        text: str = answer.read().decode("utf-8")
        return text


def told(stream: Any) -> dict[str, Any]:
    """Next event of a stream that is no mere sign of life."""
    while True:
        line = stream.readline().decode("utf-8")
        if line.startswith("data: "):
            event: dict[str, Any] = json.loads(line[6:])
            return event


def unpacked(row: dict[str, Any], count: int) -> np.ndarray:
    """The values (count,) of a packed row, as the page's script reads them."""
    if "c" in row:
        return np.full(count, row["c"])
    if "n" in row:
        return np.array([np.nan if v is None else v for v in row["n"]], dtype=np.float64)
    return np.cumsum(row["v"]) / 10.0 ** row["d"]
