"""Pages of conjugate discs: both discs drawn with what touches them, an error of each, and the backlash over a turn."""

from pathlib import Path

import numpy as np
import pytest

from camgeo.output.pipeline import check_and_show
from camgeo.recipe.loading import read

MOTION = (
    "[{rise: 10, over: 120, law: polynomial-345}, {dwell: 60}, {return: 10, over: 130, law: cycloidal}, {dwell: 50}]"
)
PAIRS = {
    "stem": ("kind: roller, radius: 9, offset: 6", "radius: 11, distance: 120"),
    "shoe": ("kind: shoe, radius: 12", "distance: 130"),
    "crank": ("kind: roller, radius: 8, arm: {length: 65, pivot: 80}", "radius: 9, length: 60, angle: 90"),
    "faces": ("kind: flat, offset: 4", "distance: 110"),
}
RADII = {"stem": (9, 11), "shoe": (12, 12), "crank": (8, 9)}


def recipe_of(name, files="dxf"):
    follower, conjugate = PAIRS[name]
    return read(
        f"cam: {{kind: disc, base_radius: 36, follower: {{{follower}}}, conjugate: {{{conjugate}}},\n"
        f"  motion: {MOTION}}}\n"
        f"export: {{tolerance: 0.002, files: [{files}]}}\nverify: {{angles: 36}}\n".encode(),
        Path("pair.yaml"),
    )


def bodies(content):
    return {body.name: body for body in content.scene.bodies}


def ring_of(body, step):
    return body.placed(body.shapes[0].rings[0].flattened(), step)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["stem", "crank", pytest.param("shoe", marks=pytest.mark.slow)])
def test_each_roller_touches_its_own_disc(name):
    content = check_and_show(recipe_of(name))[1]
    found = bodies(content)
    word = "shoe" if name == "shoe" else "roller"
    for step in (0, 130, 500):
        for k, radius in enumerate(RADII[name], start=1):
            centre, contact = (found[body].at(step)[:2] for body in (f"{word} {k}", f"contact of {word} {k}"))
            away = np.hypot(*(ring_of(found[f"disc {k}"], step) - centre).T).min()
            assert away == pytest.approx(radius, abs=0.02)
            assert np.hypot(*np.subtract(centre, contact)) == pytest.approx(radius, abs=1e-9)
    roles = [found[f"disc {k}"].shapes[0].role for k in (1, 2)]
    assert roles == ["metal", "metal upper"]
    assert content.scene.note == "Disc 2 stands in front of disc 1 and is drawn through."


def test_two_faces_stand_against_their_discs():
    found = bodies(check_and_show(recipe_of("faces"))[1])
    for step in (0, 130, 500):
        x = found["yoke"].at(step)[0]
        assert ring_of(found["disc 1"], step)[:, 0].max() == pytest.approx(x, abs=0.02)
        assert ring_of(found["disc 2"], step)[:, 0].min() == pytest.approx(x - 110, abs=0.02)


@pytest.mark.slow
def test_the_error_of_each_disc_and_the_backlash_of_both():
    outcome, content = check_and_show(recipe_of("stem"))
    plots = {plot.title: plot for plot in content.plots}
    errors = [(error.name, error.surface, error.tolerance) for error in content.errors]
    assert errors == [("pair-1.dxf", "disc 1", 0.002), ("pair-2.dxf", "disc 2", 0.002)]
    for error, disc in zip(content.errors, outcome.report["files"], strict=True):
        contour, drawn = content.contours[error.surface], ring_of(bodies(content)[error.surface], 0)
        assert np.hypot(*np.diff(contour.point, axis=0).T).max() < 1.0
        for k in (0, 200, 500):  # round the contour: what is drawn lies along the normal
            away = drawn - contour.point[k]
            nearest = away[np.hypot(*away.T) < 5.0]
            assert np.abs(nearest @ contour.normal[k]).min() < 0.02
        assert 0.5 * disc["measured_error"] < max(error.high.max(), -error.low.min()) <= disc["measured_error"] + 1e-6
    plot = plots["Backlash, pair-1.dxf and pair-2.dxf"]
    (play,) = outcome.report["files"][1]["play"]
    (series,) = plot.series
    assert plot.unit == "µm"
    assert 1e3 * play["min"] - 1e-6 <= series.values.min() < 0.0 < series.values.max() <= 1e3 * play["max"] + 1e-6
    assert series.values.max() > 0.8e3 * play["max"]  # at the page's steps the curve is nearly as high


@pytest.mark.slow
def test_a_contour_is_chosen_for_both_discs():
    content = check_and_show(recipe_of("stem", "dxf, {svg: {as: polyline}}"))[1]
    for k in (1, 2):
        shapes = bodies(content)[f"disc {k}"].shapes
        assert [shape.name for shape in shapes[:2]] == ["pair-1.dxf, pair-2.dxf", "pair-1.svg, pair-2.svg"]
    assert bodies(content)["disc 2"].shapes[1].role == "metal upper other"
