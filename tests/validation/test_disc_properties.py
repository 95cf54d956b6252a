"""Random motions of random followers, from the recipe's text to where the follower rests on the drawing.

The drawing is read by ezdxf and touched by brute force; laws and followers are written here again, so that recipe,
motion, curve, file and judge are all held against something that knows none of them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st
from support.brute_disc import LAWS, Touching, motion, polygon
from support.cases import examples

from camgeo.output import pipeline
from camgeo.recipe.loading import load_text

if TYPE_CHECKING:
    from pathlib import Path

TOLERANCE = 1e-4
BASE = 40.0
ANGLES = np.arange(0.0, 360.0, 7.5)
# vertices 0.01 mm apart stand back from their arc by 0.01^2/8 over its radius, and roller and arc add up
STEP = 0.01


@st.composite
def followers(draw: st.DrawFn) -> Touching:
    kind = draw(st.sampled_from(["roller", "knife-edge", "shoe", "flat"]))
    sense = draw(st.sampled_from([0, 0, 1, -1]))
    ring = kind == "roller" and draw(st.booleans())
    radius = {"roller": draw(st.sampled_from([4.0, 10.0])), "shoe": draw(st.sampled_from([50.0, 120.0]))}.get(kind, 0.0)
    if kind == "flat":
        if sense:
            return Touching(kind, offset=draw(st.sampled_from([-5.0, 0.0, 12.0])), pivot=110.0, sense=sense)
        return Touching(kind, tilt=math.radians(draw(st.sampled_from([0.0, 6.0, -15.0]))))
    if sense:
        prime = BASE - radius if ring else BASE + radius
        pivot = draw(st.integers(13, 20)) / 10 * prime
        length = draw(st.integers(8, 11)) / 10 * pivot
        return Touching(kind, radius, pivot=pivot, length=length, sense=sense, ring=ring)
    return Touching(kind, radius, draw(st.integers(-40, 40)) / 2, ring=ring)


@st.composite
def motions(draw: st.DrawFn, stroke: float) -> list[tuple[float, float, str]]:
    """Up and down, perhaps twice, with dwells; the strokes are parts of the greatest."""
    times = draw(st.sampled_from([1, 1, 2]))
    rows = []
    for _ in range(times):
        by, law = stroke * draw(st.integers(1, 10)) / 10, st.sampled_from(sorted(LAWS))
        up, rest, down = (draw(st.integers(*ends)) / times for ends in ((80, 130), (1, 40), (80, 130)))
        rows += [
            (by, up, draw(law)),
            (0.0, rest, ""),
            (-by, down, draw(law)),
            (0.0, 360 / times - up - rest - down, ""),
        ]
    return rows


@pytest.mark.slow
@settings(
    max_examples=examples(24),
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
)
@given(st.data())
def test_the_follower_rests_on_the_drawing_where_it_is_meant_to(tmp_path: Path, data: st.DataObject) -> None:
    touching = data.draw(followers())
    swings = bool(touching.sense)
    rows = data.draw(motions(12.0))  # mm, or degrees
    rotation = data.draw(st.sampled_from(["cw", "ccw"]))
    drawn_as = data.draw(st.sampled_from(["arcs", "spline"]))
    more = f"rotation: {rotation}\nexport: {{tolerance: {TOLERANCE}, files: [dxf: {{as: {drawn_as}}}]}}\n"
    recipe = load_text(touching.recipe(BASE, rows, more), "cam.yaml")
    outcome = pipeline.export(recipe, tmp_path)
    assume(outcome.report["files"])  # undercut is refused before a file is made
    assert outcome.ok
    vertices = polygon(tmp_path / "cam" / "cam.dxf", STEP)
    if rotation == "ccw":
        vertices = np.conj(vertices)
    meant = motion(rows, ANGLES)
    found = np.array([touching.place(vertices, theta, BASE) for theta in np.radians(ANGLES)]) - touching.rest(BASE)
    off = np.abs((np.degrees(found) if swings else found) - meant).max()
    file = outcome.report["files"][0]
    apart = STEP**2 / 8 * (1 / 4 + 1 / 4)  # at the least radii, of roller and contour
    ratio = file["motion"]["max"] / file["measured_error"] if file["measured_error"] else 1.0
    assert off <= file["motion"]["max"] + file["motion"]["remainder"] + max(ratio, 2.0) * apart
