"""The best of twenty cams as a test: `pytest examples/test_best_cam.py`."""

from pathlib import Path

import pytest
from twenty_cams import LEAST, main

import camgeo
from camgeo.testing import assert_closed, assert_motion


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> camgeo.Report:
    return main(str(tmp_path_factory.mktemp("out")))


def test_every_check_holds(report: camgeo.Report) -> None:
    assert report.ok, "\n".join(report.explain(check) for check in report.checks if not check.ok)


def test_it_is_not_bent_too_sharply(report: camgeo.Report) -> None:
    bent = report.figures["radius-of-curvature"].value
    assert bent is not None
    assert bent >= LEAST


def test_the_drawing_moves_the_follower_as_it_should(report: camgeo.Report) -> None:
    drawing = next(file.path for file in report.files if file.kind == "dxf")
    assert isinstance(drawing, Path)
    assert_closed(drawing)
    assert assert_motion(report.recipe, drawing).max <= 0.001


def test_a_file_from_elsewhere_is_judged_the_same_way(report: camgeo.Report) -> None:
    solid = next(file.path for file in report.files if file.kind == "stl")
    assert solid is not None
    assert camgeo.verify(report.recipe, solid).ok
    assert not camgeo.verify(report.recipe, solid, tolerance=1e-6).ok
