"""The follower on a shop drawing: in phantom lines it touches the contour that is drawn, and its sizes stand beside it.

Holds: camgeo.capabilities.sheet.follower.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from shapely.geometry import LineString, Point, Polygon

from camgeo.capabilities.sheet.follower import follower_figure
from camgeo.capabilities.sheet.part import DrawnDisc, Loop
from camgeo.part.body import Body
from camgeo.recipe.recipe import load_text
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.capabilities.sheet.follower import FollowerFigure

MOTION = "motion: [{rise: 12, over: 100, law: cycloidal}, {return: 12, over: 140, law: cycloidal}, {dwell: 120}]"
SWING = MOTION.replace("12,", "10,")
DISC = "kind: disc, base_radius: 40"
FOLLOWERS = {
    "roller": (f"{{{DISC}, follower: {{kind: roller, radius: 9}}, {MOTION}}}", ["Ø18 roller"]),
    "offset": (f"{{{DISC}, follower: {{kind: roller, radius: 9, offset: 8}}, {MOTION}}}", ["Ø18 roller", "offset 8"]),
    "shoe": (f"{{{DISC}, follower: {{kind: shoe, radius: 9}}, {MOTION}}}", ["R9 shoe"]),
    "edge": (f"{{{DISC}, follower: {{kind: knife-edge}}, {MOTION}}}", ["knife edge"]),
    "arm": (
        f"{{{DISC}, follower: {{kind: roller, radius: 8, arm: {{length: 65, pivot: 80}}}}, {SWING}}}",
        ["Ø16 roller", "arm 65", "pivot, 80 from the shaft"],
    ),
    "flat": ("{kind: disc, base_radius: 40, follower: {kind: flat}, motion: {formula: 4*(1 - cos(t))}}", ["flat face"]),
    "yoke": ("{kind: support, p: 25 + 2*cos(3*t) + sin(t)}", ["flat face", "flat face"]),
}


def figure(cam: str, rotation: str = "cw") -> tuple[FollowerFigure, Polygon]:
    """The figure of a follower, and its contour as it is drawn, as a polygon within 1e-4 mm."""
    design = designed(load_text(f"rotation: {rotation}\ncam: {cam}\nexport: {{files: [dxf]}}\n", "cam.yaml"))
    ((_, contour),) = design.contours
    t = contour.shape.period * np.arange(20_000) / 20_000
    points = contour.sample(t).point * ((1.0, -1.0) if rotation == "ccw" else (1.0, 1.0))
    recipe = load_text(f"cam: {cam}\nexport: {{files: [dxf]}}\n", "cam.yaml")
    drawn = DrawnDisc((Loop(points, "CUT", surface=True),), Body(None, ()), recipe.part, rotation == "ccw")
    return follower_figure(design, drawn), Polygon(points)


@pytest.mark.parametrize("rotation", ["cw", "ccw"])
@pytest.mark.parametrize("name", FOLLOWERS)
def test_it_touches_the_contour_and_has_its_sizes(name: str, rotation: str) -> None:
    cam, sizes = FOLLOWERS[name]
    found, contour = figure(cam, rotation)
    assert sorted(row.text for row in found.sizes) == sorted(sizes)
    edge = contour.exterior
    rollers = [(Point(centre), radius) for centre, radius in found.circles]
    touching = [abs(edge.distance(centre) - radius) for centre, radius in rollers if not contour.contains(centre)]
    lines = [LineString(points) for points, pattern in found.lines if pattern == "phantom"]
    touching += [line.distance(edge) for line in lines]
    contacts = 2 if name == "yoke" else 1
    assert sum(gap < 2e-3 for gap in touching) == contacts, touching
    # and nothing of it stands in the metal
    assert all(line.intersection(contour.buffer(-0.01)).length == 0.0 for line in lines)


def test_an_offset_lies_where_the_surface_comes_from() -> None:
    """Of a shaft that turns clockwise the surface under the follower comes from above."""
    cam, _ = FOLLOWERS["offset"]
    for rotation, side in (("cw", 1.0), ("ccw", -1.0)):
        found, _ = figure(cam, rotation)
        ((_, y), _), *_ = found.circles
        assert y == pytest.approx(8.0 * side)
