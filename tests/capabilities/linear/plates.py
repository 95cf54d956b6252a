"""Recipes of plates for tests: one to begin with, and changes of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.capabilities.linear.design import designed
from camgeo.capabilities.linear.reading import read_linear
from camgeo.common.clock import Clock
from camgeo.schema.yaml_source import read_source

if TYPE_CHECKING:
    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.keys import LinearRecipe

MOTION = "[{dwell: 10}, {rise: 20, over: 50, law: cycloidal}, {dwell: 20}, {return: 20, over: 40, law: polynomial-345}]"
CAM = f"""cam:
  kind: linear
  base: 32
  follower: {{kind: roller, radius: 8}}
  ends: {{overrun: 6}}
  motion: {MOTION}
"""
PLATE = CAM + "part: {thickness: 12}\nexport: {files: [dxf]}\n"
ON_ARM = """cam:
  kind: linear
  base: 21.478791400460436
  follower: {kind: roller, radius: 8, arm: {length: 60, pivot: 50, side: trailing}}
  ends: {overrun: 6}
  motion:
    [{dwell: 10}, {rise: 24, over: 60, law: cycloidal}, {dwell: 10}, {return: 24, over: 50, law: polynomial-345}]
"""
GROOVE = PLATE.replace("  ends:", "  track: {groove: {clearance: 0.05, depth: 6}}\n  ends:").replace(
    "thickness: 12", "thickness: 12, height: 80"
)
ENDLESS = """cam:
  kind: linear
  base: 14
  endless: true
  follower: {kind: roller, radius: 6}
  motion: {formula: 5*(1 - cos(2*pi*x/40)), over: 40}
part: {thickness: 8}
"""


def changed(text: str, *pairs: tuple[str, str]) -> str:
    """Text with the first of each pair replaced by the second; each has to be there."""
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def recipe_of(text: str, name: str = "plate.yaml") -> LinearRecipe:
    """Recipe of a text."""
    return read_linear(read_source(text.encode(), name), Path(name))


def design_of(text: str) -> LinearDesign:
    """Exact plate of a text."""
    return designed(recipe_of(text), Clock())
