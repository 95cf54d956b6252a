"""The best designs as complete recipes, and their output over the shaft angle."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sweep.pictures import Curve
from camgeo.capabilities.sweep.rebuilt import mechanism_in, text_with
from camgeo.recipe.loading import read
from camgeo.schema.change import changed
from camgeo.schema.edit import without
from camgeo.schema.scalars import MOST_TEXT
from camgeo.schema.yaml_source import Mapping, Source, scalars
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    import collections.abc

    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.recipe.recipe import Recipe

_POINTS = 720  # of a curve, over a turn


@dataclass(frozen=True)
class Best:
    """A best design: its place from 1, the index it has or comes from, whether it was polished, values, figures.

    `values` by path, as the recipe writes them; `figures` in mm and degrees; `why` it could not be polished.
    """

    place: int
    index: int
    polished: bool
    values: dict[str, float]
    figures: dict[str, float]
    why: str = ""

    @property
    def file(self) -> str:
        """Name of its recipe."""
        return f"best-{self.place}.yaml"


def recipe_text(ask: Ask, best: Best) -> str:
    """The user's recipe with the design's values, a name of its own, its figures in `about`, and no sweep.

    Raises RecipeErrors where the sweep cannot be cut out of the text.
    """
    text = text_with(ask.recipe, best.values)
    for section in ("sweep", "name", "about"):
        text = without(text, section)
    for path in ask.recipe.tables:
        source = Source.of(text, str(ask.recipe.path))  # its recipe stands in another folder
        file = dict(scalars(source.root))[path].text
        text = changed(source, path, (ask.recipe.path.parent / file).resolve().as_posix())
    name = f"{ask.recipe.name}-best-{best.place}"
    return _opened(text, {"name": name, "about": _about(ask, best)})


def loaded(text: str, best: Best) -> Recipe:
    """The recipe of a best design, read as any other; raises RecipeErrors."""
    return read(text.encode(), best.file)


def told(ask: Ask, figures: collections.abc.Mapping[str, float]) -> str:
    """Figures in a line, with their units."""
    units = ask.units(figures)
    parts = (f"{name} {value / units[name].divisor:.6g} {units[name].name}".rstrip() for name, value in figures.items())
    return ", ".join(parts)


def _about(ask: Ask, best: Best) -> str:
    """Where a design comes from and the figure that ranks it, then the recipe's own note as far as there is room."""
    origin = f"polished from design {best.index}" if best.polished else f"design {best.index}"
    ranking = {name: value for name, value in best.figures.items() if name == ask.sweep.rank}
    text = f"{origin} of {ask.plan.count} of the sweep of {ask.recipe.name}: {told(ask, ranking)}"
    if ask.recipe.about:
        text += f". {ask.recipe.about}"
    return text if len(text) <= MOST_TEXT else text[: MOST_TEXT - 3] + "..."


def _opened(text: str, entries: collections.abc.Mapping[str, str]) -> str:
    """Put entries before the first of a recipe's text, in its own way of writing."""
    root = Source.of(text, "recipe").root
    if not isinstance(root, Mapping):
        raise TypeError("a recipe is a mapping")
    line, column = root.mark
    lines = text.splitlines(keepends=True)
    index = sum(map(len, lines[: line - 1])) + column - 1
    written = [f"{name}: {json.dumps(value, ensure_ascii=False)}" for name, value in entries.items()]
    if root.flow:
        return text[: index + 1] + ", ".join(written) + ", " + text[index + 1 :]
    indent = " " * (column - 1)
    return text[:index] + "".join(f"{entry}\n{indent}" for entry in written) + text[index:]


def curve_of(recipe: Recipe, label: str) -> tuple[Curve, str]:
    """Output of a recipe's linkage over the shaft angle, or its cam's lift or swing where there is none; its name.

    In degrees or the recipe's units. Raises PlaceError for a linkage that does not turn, TypeError for one on a cam
    without a lift, which no recipe has, and IntentError as the intent does.
    """
    if recipe.linkage is None:
        from camgeo.synthesis.motion_table import motion_table

        sampled = replace(recipe, verify=replace(recipe.verify, angles=_POINTS))
        (_, name, *_), rows = motion_table(sampled, recipe.cam.exact().motion)
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
