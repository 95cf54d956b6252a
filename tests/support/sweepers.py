# needs: sweep
"""Stand-ins for what a sweep computes, in a module that worker processes can import."""

from __future__ import annotations

import os
import re
import tempfile
import time
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.chunks import SweepJob
from camgeo.capabilities.sweep.figures import Evaluator
from camgeo.capabilities.sweep.gather import REASON, Ranking
from camgeo.capabilities.sweep.keys import Axis, varied_fields
from camgeo.capabilities.sweep.plan import Plan
from camgeo.capabilities.sweep.search import Procedures
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.limits import Limit
from camgeo.recipe.loading import read

if TYPE_CHECKING:
    from pathlib import Path

GRID = Plan(
    (Axis("cam.shaft[0]", 10.0, 20.0, steps=25), Axis("linkage.rocker", 95.0, 110.0, steps=33)),
    "grid",
    825,
)

FOUR_BAR = """\
name: four-bar
about: AS 2023, Figure 9
cam:
  kind: support
  p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t)
  shaft: [18, 8.5]  # the shaft
linkage: {{kind: four-bar, ground: 80, coupler: 70, rocker: 105}}
dwell: {{band: 0.1}}
part: {{thickness: 8, bore: 6}}
sweep:
  # {comment}
  vary:
    cam.shaft[0]: {{from: 10, to: 20, steps: 25}}
    linkage.rocker: {{from: 95, to: 110, steps: 33}}
  limits: {{margin: {{at_least: {margin}}}}}
  rank: {rank}
  keep: 3
  refine: {refine}
export: {{tolerance: 0.01, files: [dxf]}}
"""


def task(comment="", *, margin=1.0, rank="dwell", refine="false", path="four-bar.yaml"):
    text = FOUR_BAR.format(comment=comment, margin=margin, rank=rank, refine=refine)
    return SweepTask.from_recipe(read(text.encode(), path))


def hills(scene, values):
    """A dwell with several tops, and a margin; designs with the sum of both variables above 128 do not turn.

    The scene is a text, or a recipe's in its comments, that may say `calls=FOLDER;`, where each call leaves a file,
    and `seconds=S;`, the time a call takes. So neither has a bearing on what comes out.
    """
    text = scene if isinstance(scene, str) else scene.recipe.text
    if found := re.search("calls=(.*?);", text):
        descriptor, _ = tempfile.mkstemp(prefix="call-", dir=found[1])
        os.write(descriptor, repr(values[0].tolist()).encode())
        os.close(descriptor)
    if found := re.search("seconds=(.*?);", text):
        time.sleep(float(found[1]))
    x, y = values[:, 0], values[:, 1]
    dwell = np.round(40.0 + 10.0 * np.sin(x / 2.0) * np.cos(y / 3.0), 1)  # rounded, so that there are ties
    stuck = x + y > 128.0
    dwell = np.where(stuck, np.nan, dwell)
    return {"dwell": dwell, "margin": np.where(stuck, np.nan, x - 12.0), REASON: np.where(stuck, 1.0, 0.0)}


def fail(_scene, _values):
    raise AssertionError("a chunk was computed that was there")


def sink(_task, values):
    """Polish by going to one place, which is better than all."""
    return {**values, "cam.shaft[0]": 15.0}, {"dwell": 60.0 + round(values["linkage.rocker"]) / 100.0, "margin": 3.0}


def measured(_task, values):
    """What `hills` says, and a figure that it goes without."""
    figures = hills("", values)
    return {"dwell": figures["dwell"] + 1.0, "dwell-relative": 0.5 * figures["dwell"], "margin": figures["margin"]}


RANKING = Ranking("dwell", most=True, limits=(Limit("margin", at_least=1.0),))


def gather_inputs(plan: Plan, compute=hills) -> list[dict[str, np.ndarray]]:
    """Figures of each chunk of a plan."""
    return [compute("", plan.values(*plan.span(number))) for number in range(plan.chunks)]


def by_hand(ranking: Ranking, plan: Plan = GRID) -> list[tuple[float, int]]:
    """Rank and index of each design kept, one by one."""
    found = []
    for index in range(plan.count):
        figures = hills("", plan.values(index, index + 1))
        if not np.isnan(figures["dwell"][0]) and all(
            (limit.at_least is None or figures[limit.figure][0] >= limit.at_least)
            and (limit.at_most is None or figures[limit.figure][0] <= limit.at_most)
            for limit in ranking.limits
        ):
            found.append((figures[ranking.rank][0], index))
    return sorted(found, key=lambda pair: (-pair[0] if ranking.most else pair[0], pair[1]))


PROCEDURES = Procedures(hills, measured, sink, ("", "binds"))


class Aside(str):
    """A scene that has no part in the key, as a recipe's comments have none."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "aside"


def job(plan: Plan = GRID, scene: str = "", compute=hills) -> SweepJob:
    return SweepJob(plan, Aside(scene), compute)


def calls(folder: Path) -> list[str]:
    """First values of each chunk that was computed, in no order."""
    return [path.read_text() for path in folder.glob("call-*")]


def tree(folder: Path) -> dict[str, bytes]:
    """Files of a folder by their paths, without the chunks, and without what tells of the run alone."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix != ".bin":
            data = path.read_bytes()
            if path.name == "sweep.json":
                data = re.sub(rb'"run": \{.*?\}', b"", data, flags=re.DOTALL)
            found[str(path.relative_to(folder))] = data
    return found


def evaluate(recipe, paths, values, **how):
    """Figures of designs in which the fields at `paths` have the values (m, k), as `Evaluator` gives them."""
    return Evaluator.prepare(recipe, paths, **how).evaluate(values)


def compute(recipe, values):
    """Figures of designs with the values (m, k) of a recipe's sweep."""
    return evaluate(recipe, tuple(axis.path for axis in varied_fields(recipe)), values).figures
