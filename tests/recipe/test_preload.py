"""What a preload by interference excludes: one line each, and the tolerance that the remedy names does."""

import re

import pytest

import camgeo

YOKE = (
    "cam: {{kind: constant-breadth, base_radius: 40, preload: {{interference: {}}}, "
    "motion: [{{rise: 20, over: 120, law: modified-sine}}, {{dwell: 60}}]}}\n"
)


def refused(text):
    with pytest.raises(camgeo.RecipeErrors) as errors:
        camgeo.load(text)
    return str(errors.value)


def test_a_tolerance_that_takes_the_interference_is_refused_and_the_remedy_does():
    text = YOKE.format(0.02) + "export: {tolerance: TOLERANCE, files: [dxf]}\n"
    message = refused(text.replace("TOLERANCE", "0.01"))
    assert (
        "export.tolerance: a tolerance of 0.01 on either side of a contour leaves none of the interference" in message
    )
    below = float(re.search(r"give a tolerance below ([\d.]+)", message)[1])
    assert below == 0.01
    camgeo.load(text.replace("TOLERANCE", f"{0.99 * below}"))


def test_the_tolerance_of_a_file_is_named():
    assert "export.files[0].dxf.tolerance: a tolerance of 0.05" in refused(
        YOKE.format(0.02) + "export: {files: [{dxf: {tolerance: 0.05}}]}\n"
    )


def test_without_a_tolerance_the_default_is_named():
    assert "cam.preload.interference: a tolerance of 0.001 on either side" in refused(YOKE.format(0.002))


def test_a_clearance_undoes_it():
    text = YOKE.format(0.05) + "export: {files: [{stl: {clearance: 0.1}}]}\npart: {thickness: 8}\n"
    assert "export.files[0].stl.clearance: a clearance undoes the interference" in refused(text)
