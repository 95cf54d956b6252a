"""A groove for tests: two flanks under the roller of a disc cam, the outer one wider by a clearance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.recipe.loading import read

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

MOTION = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 40}, {return: 8, over: 140, law: cycloidal}, {dwell: 60}]"
CAM = f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8, offset: 5}}, motion: {MOTION}}}"


def grooved(text: str, clearance: float = 0.03, path: str = "groove.yaml") -> Recipe:
    """The recipe of a disc cam with its roller in a groove."""
    track = f"kind: disc, track: {{groove: {{clearance: {clearance}, depth: 4}}}},"
    return read(text.replace("kind: disc,", track).encode(), Path(path))
