"""Overlays of the page: each construction against its equation at every step of the turn, and what is refused.

Holds: camgeo.formats.html.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.pages import SHAFT, along, origin, overlaid
from support.places import RECIPES

from camgeo.formats.html import OVERLAYS
from camgeo.recipe.loading import load_text
from camgeo.report.page import overlays
from camgeo.report.page.content import content
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.report.page.scene import MovingBody


def curve(body: MovingBody) -> np.ndarray:
    points = np.concatenate([ring.points for shape in body.shapes for ring in shape.rings])
    return points[:, 0] + 1j * points[:, 1]


def test_without_being_asked_for_there_is_none() -> None:
    text = (RECIPES / "shu-wu.yaml").read_text(encoding="utf-8")
    recipe = load_text(text, "shu-wu.yaml")
    assert all(body.kind != "overlays" for body in content(recipe, designed(recipe), ()).scene.bodies)
    assert set(overlays.MADE) == set(OVERLAYS)


def test_instant_centres_of_a_yoke() -> None:
    """Q is S' from the shaft, across the follower's line, and both normals pass through it (SW 10)."""
    found = overlaid("shu-wu", "instant-centres")
    design = designed(load_text((RECIPES / "shu-wu.yaml").read_text(encoding="utf-8"), "shu-wu.yaml"))
    slope = design.motion.rows(SHAFT, 1)[1]
    q = origin(found["instant centre of cam and follower"])
    assert q == pytest.approx(1j * slope, abs=1e-9)
    assert origin(found["normals of the contacts"]) == pytest.approx(q)
    assert np.ptp(found["normals of the contacts"].pose[:, 2]) == 0.0
    letters = [label.text for body in found.values() for label in body.labels]
    assert letters == ["I₁₃ → ∞", "I₁₂", "I₂₃ = Q"]


@pytest.mark.thin(4)
@pytest.mark.parametrize(("name", "count"), [("w-booth", 4), ("w-figure-5", 6), ("w-figure-9", 8), ("w-rosette", 10)])
def test_chords_of_one_length_close(name: str, count: int) -> None:
    """2 lambda chords of 2 l sin alpha, each beginning where the one before ends; the first is AB (W section 6)."""
    chords = list(overlaid(name, "chord-polygon").values())
    assert len(chords) == count
    for chord, after in zip(chords, [*chords[1:], chords[0]], strict=True):
        (length,) = {float(x) for x in curve(chord).real if x}
        assert origin(chord) + length * along(chord) == pytest.approx(origin(after), abs=1e-9 * length)
    lam, mu, arm = {"w-booth": (2, 1, 40), "w-figure-5": (3, 1, 60), "w-figure-9": (4, 3, 60), "w-rosette": (5, 3, 60)}[
        name
    ]
    assert length == pytest.approx(2 * arm * math.sin(math.pi * mu / lam))
    assert np.abs(origin(chords[0]) - arm) == pytest.approx(arm)  # A is l from the pivot


@pytest.mark.parametrize(("name", "arm"), [("w-figure-5", 60.0), ("w-ellipse", 30.0)])
def test_isoptic_circle_and_pedal(name: str, arm: float) -> None:
    """The faces' corner stays 2 l from O, both touch c*, and the feet of their perpendiculars run on the pedal."""
    found = overlaid(name, "isoptic, pedal")
    touched = found.get("curve of the faces")
    if touched is None:  # a flat pair's own contour: Goldberg's ellipse
        t = np.linspace(0.0, 2 * math.pi, 1440, endpoint=False)
        points = 48.0 * np.cos(t) + 36j * np.sin(t)
    else:
        points = curve(touched)
    turned = np.exp(1j * found["pedal"].pose[:, 2])
    for letter in "AB":
        face, ray = found[f"face through {letter}"], found[f"perpendicular to the face through {letter}"]
        foot = origin(found[f"foot {letter}"])
        assert np.abs(origin(face)) == pytest.approx(2.0 * arm)
        assert (along(face) * along(ray).conj()).real == pytest.approx(0.0, abs=1e-12)
        assert np.abs((foot / along(ray)).imag).max() < 1e-9
        assert ((foot - origin(face)) / along(face)).imag == pytest.approx(0.0, abs=1e-9)
        pedal = curve(found["pedal"])
        for step in range(0, 720, 90):
            assert np.abs(pedal - foot[step] / turned[step]).min() < 0.006 * arm
            # the curve lies on one side of the face, and touches it
            beyond = ((points * turned[step] - foot[step]) / along(ray)[step]).real
            assert beyond.max() == pytest.approx(0.0, abs=2e-3)


def test_evolute_of_an_ellipse() -> None:
    """The stretched astroid (a x)^(2/3) + (b y)^(2/3) = (a^2 - b^2)^(2/3), on the cam; the normal touches it."""
    found = overlaid("w-ellipse", "evolute")
    points = curve(found["evolute"])
    astroid = np.abs(48.0 * points.real) ** (2 / 3) + np.abs(36.0 * points.imag) ** (2 / 3)
    assert astroid == pytest.approx((48.0**2 - 36.0**2) ** (2 / 3), rel=1e-9)
    normal, centre = found["normal of the contact"], origin(found["centre of curvature"])
    off = ((centre - origin(normal)) / along(normal)).imag
    assert np.abs(off).max() < 1e-9
    assert ((centre - origin(normal)) / along(normal)).real.min() > 0.0


@pytest.mark.slow
def test_evolute_of_rounded_corners_is_their_centres_and_does_not_fail() -> None:
    """Arcs have no evolute but points; a linkage's cam turns with its frame."""
    assert "evolute" not in overlaid("reuleaux", "evolute")
    found = overlaid("as-figure-9-2a", "evolute")
    assert np.ptp(found["evolute"].pose[:, 2]) > 6.0
    assert "evolute" in overlaid("disc-roller", "evolute")


@pytest.mark.parametrize(
    ("cam", "names", "said"),
    [
        (
            "{kind: support, p: 30}",
            "[pedal]",
            "a cam of kind support does not have, given 'pedal'; give instant-centres",
        ),
        ("{kind: support, p: 30}", "[evolut]", "no overlay, given 'evolut'; did you mean evolute?"),
        ("{kind: support, p: 30}", "[evolute, evolute]", "the same overlay twice, given 'evolute'; leave one out"),
        ("{kind: support, p: 30}", "[]", "an empty list; give a list of instant-centres, chord-polygon, isoptic,"),
        (
            "{kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}",
            "[instant-centres]",
            "kind flat-pair does not have, given 'instant-centres'; give chord-polygon, isoptic, pedal or evolute",
        ),
        (
            "{kind: support, p: 25 + cos(3*t)}\nlinkage: {kind: slider-crank, coupler: 90, offset: 0}",
            "[instant-centres]",
            "an overlay that a linkage does not have, given 'instant-centres'; give evolute",
        ),
    ],
)
def test_what_a_family_lacks_is_refused(cam: str, names: str, said: str) -> None:
    with pytest.raises(RecipeErrors) as raised:
        load_text(f"cam: {cam}\nexport: {{files: [{{html: {{overlays: {names}}}}}]}}\n", "cam.yaml")
    assert said in str(raised.value)
