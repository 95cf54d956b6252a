"""The best designs as complete recipes, and curves of their output over the shaft angle."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.pictures import Curve
from camgeo.capabilities.sweep.single_designs import mechanism_in, text_with
from camgeo.schema.change import set_value
from camgeo.schema.edit import remove_section
from camgeo.schema.scalars import MOST_TEXT
from camgeo.schema.yaml_source import Mapping, Source, scalars
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    import collections.abc

    from camgeo.capabilities.sweep.task import Task
    from camgeo.recipe.recipe import Recipe

_POINTS = 720  # of a curve, over a turn


@dataclass(frozen=True)
class Best:
    """A best design: its place from 1, its index in the plan, or that of the design it was polished from.

    `values` by path, in the recipe's units, words by their index; `figures` by name, in mm and degrees; `why` it could
    not be polished.
    """

    place: int
    index: int
    polished: bool
    values: dict[str, float]
    figures: dict[str, float]
    why: str = ""

    @property
    def file(self) -> str:
        """Name of its recipe's file."""
        return f"best-{self.place}.yaml"


def recipe_text(task: Task, best: Best) -> str:
    """Text of the user's recipe with the design's values, a name of its own, its figures in `about`, and no sweep.

    Raises RecipeErrors where the sweep cannot be cut out of the text.
    """
    text = text_with(task.recipe, best.values)
    for section in ("sweep", "name", "about"):
        text = remove_section(text, section)
    for path in task.recipe.tables:
        source = Source.of(text, str(task.recipe.path))  # as the best design's recipe is in another folder
        file = dict(scalars(source.root))[path].text
        text = set_value(source, path, (task.recipe.path.parent / file).resolve().as_posix())
    name = f"{task.recipe.name}-best-{best.place}"
    return _with_entries(text, {"name": name, "about": _about(task, best)})


def _about(task: Task, best: Best) -> str:
    """The design's origin and ranking figure, then as much of the recipe's own note as fits."""
    origin = f"polished from design {best.index}" if best.polished else f"design {best.index}"
    rank = task.sweep.rank
    unit = task.units([rank])[rank]
    figure = f"{rank} {best.figures[rank] / unit.divisor:.6g} {unit.name}".rstrip() if rank in best.figures else ""
    text = f"{origin} of {task.plan.count} of the sweep of {task.recipe.name}: {figure}"
    if task.recipe.about:
        text += f". {task.recipe.about}"
    return text if len(text) <= MOST_TEXT else text[: MOST_TEXT - 3] + "..."


def _with_entries(text: str, entries: collections.abc.Mapping[str, str]) -> str:
    """Text of a recipe with entries put first, in flow or block style as the recipe is."""
    root = Source.of(text, "recipe").root
    if not isinstance(root, Mapping):
        raise TypeError("a recipe is a mapping")
    line, column = root.mark
    lines = text.splitlines(keepends=True)
    index = sum(map(len, lines[: line - 1])) + column - 1
    items = [f"{name}: {json.dumps(value, ensure_ascii=False)}" for name, value in entries.items()]
    if root.flow:
        return text[: index + 1] + ", ".join(items) + ", " + text[index + 1 :]
    indent = " " * (column - 1)
    return text[:index] + "".join(f"{item}\n{indent}" for item in items) + text[index:]


def curve_of(recipe: Recipe, label: str) -> tuple[Curve, str]:
    """Output of a recipe's linkage over the shaft angle, or without one its cam's lift or swing; name of that axis.

    In degrees or the recipe's units. Raises PlaceError for a linkage that does not turn, TypeError for one on a cam
    without a lift, which no recipe has, and IntentError as the intent does.
    """
    if recipe.linkage is None:
        from camgeo.synthesis.motion_table import motion_table

        at_points = replace(recipe, verify=replace(recipe.verify, angles=_POINTS))
        (_, name, *_), rows = motion_table(at_points, recipe.cam.exact().motion)
        word, _, unit = name.partition("_")
        return Curve(label, rows[:, 0], rows[:, 1]), f"{word} ({unit})"
    mechanism = mechanism_in(recipe)
    shaft = np.linspace(0.0, 2.0 * math.pi, _POINTS + 1)
    output = mechanism.at(mechanism.relative(shaft), 0).output[0]
    swings = mechanism.unit == "deg"
    scale = math.degrees(1.0) if swings else 1.0 / recipe.mm
    unit = "deg" if swings else {"mm": "mm", "inch": "in"}[recipe.units]
    dwell = None
    if recipe.dwell is not None:
        longest = mechanism.dwells(recipe.dwell.band, most=1)[0]
        dwell = math.degrees(longest.start), math.degrees(longest.length)
    return Curve(label, np.degrees(shaft), output * scale, dwell), f"output ({unit})"
