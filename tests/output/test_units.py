"""One part told in millimetres and in inches: the figures of the report and of a study are the same."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from camgeo.capabilities.study.document import document  # needs: study
from camgeo.capabilities.study.margins import margins  # needs: study
from camgeo.capabilities.study.tolerance_ladder import End, Rung  # needs: study
from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

MM = 25.4
# lengths as inches; in millimetres each is 25.4 times as long, to the last digit but one
LINKED = """\
name: part
units: {units}
cam: {{kind: support, p: ({one!r})*(1 + 0.05*sin(3*t)), shaft: [{third!r}, {third!r}]}}
linkage: {{kind: four-bar, ground: {four!r}, coupler: {four!r}, rocker: {five!r}}}
part: {{thickness: {third!r}, bore: {third!r}}}
export: {{tolerance: {fine!r}, files: [{{dxf: {{kerf: {kerf!r}}}}}, dxf, stl]}}
verify: {{angles: 360, output_error: 0.5}}
"""
FOUR_BAR = "{{kind: four-bar, ground: {four!r}, coupler: {four!r}, rocker: {five!r}}}"
SLIDING = LINKED.replace(FOUR_BAR, "{{kind: slider-crank, offset: {third!r}, coupler: {four!r}}}").replace(
    "0.5}}", "{kerf!r}}}"
)
ROLLER = """\
name: part
units: {units}
cam: {{kind: double-roller, ratio: 4/3, arm: {five!r}, roller_radius: {third!r}, delta: {{cos: {{1: {square!r}}}}}}}
part: {{thickness: {third!r}, bore: {third!r}}}
export: {{tolerance: {fine!r}, files: [dxf, stl]}}
verify: {{angles: 360}}
"""
INCHES = {"one": 1.0, "third": 0.3125, "four": 3.5, "five": 4.5, "fine": 1e-4, "kerf": 0.0078125, "square": 2.5}
LENGTHS = {"in": MM, "in^2": MM**2, "in^3": MM**3, "deg/in": 1.0 / MM}
ERRORS = {"geometry_error", "geometry_outward", "geometry_inward", "measured_error", "proved"}
SCALED = dict.fromkeys(("tolerance", "outward", "kerf", "perimeter", *ERRORS), MM) | {"area": MM**2}
FOUND = 1.01e-6  # share of a motion error, to which it is found
LEFT_OUT = {"unit", "units", "stages", "seconds", "bytes", "sha256", "detail", "why", "output_unit", "motion_unit"}


def recipes(text: str) -> tuple[Recipe, Recipe]:
    inches = text.format(units="inch", **INCHES)
    lengths = {name: value * (MM**2 if name == "square" else MM) for name, value in INCHES.items()}
    return load_text(text.format(units="mm", **lengths), "mm.yaml"), load_text(inches, "inch.yaml")


def alike(one: Any, other: Any, name: str = "", scale: float = 1.0) -> int:
    """Compare plain data of millimetres and of inches; how many figures were lengths, areas or volumes."""
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        if name not in {"margin", "frame"} and "unit" in one:
            assert (one["unit"] == other["unit"]) == (other["unit"] not in LENGTHS)
        scale = LENGTHS.get(other["unit"], 1.0) if "unit" in one else scale
        if "remainder" in one:  # how far a search came hangs on rounding, how far it has to come does not
            assert max(told.pop("remainder") / told["max"] for told in (one, other)) <= FOUND
        return sum(alike(one[key], other[key], key, scale) for key in one.keys() - LEFT_OUT)
    if isinstance(one, list):
        assert len(one) == len(other)
        return sum(alike(a, b, name, scale) for a, b in zip(one, other, strict=True))
    if not isinstance(one, float):
        assert one == other, name
        return 0
    if name.endswith("_deg"):  # of a worst place, which ties may move
        return 0
    scale = SCALED.get(name, scale)
    assert one == pytest.approx(other * scale, rel=1e-4, abs=1e-9), name
    return int(scale != 1.0)


@pytest.mark.slow
@pytest.mark.parametrize(("text", "lengths"), [(ROLLER, 20), (LINKED, 60), (SLIDING, 60)])
def test_reports(text: str, lengths: int) -> None:
    millimetres, inches = (pipeline.check(recipe).report for recipe in recipes(text))
    if text is SLIDING:  # what has the output's unit without naming it
        for report in (millimetres, inches):
            unit = report["linkage"]["output"]["unit"]
            for name in ("swing", "peaks"):
                report["linkage"][name] = {"unit": unit, name: report["linkage"][name]}
    assert alike(millimetres, inches) > lengths


# needs: study
@pytest.mark.thin(3)
@pytest.mark.parametrize(("text", "lengths"), [(LINKED, 8), (SLIDING, 6), (ROLLER, 8)])
def test_studies(text: str, lengths: int) -> None:
    rung = Rung("arcs", 0.01, 0.008, 0.009, 0.007, "mm", 0.006, "mm", 0.1, {}, 40, 30.0, 1000, ())
    studies = []
    for recipe in recipes(text):
        found = [rung, End("arcs", 0.001, "no finer one is held")]
        study = document(recipe, found, margins(recipe, designed(recipe)), [])
        (row,) = study["rows"]
        row["motion_error"] = {"unit": row["motion_unit"], "value": row["motion_error"]}
        row["output_error"] = {"unit": row["output_unit"], "value": row["output_error"]}
        studies.append(study)
    assert studies[0]["rows"][0]["ratio"] == pytest.approx(40 / 30)
    assert alike(*studies) > lengths
    assert all(math.isfinite(margin["value"]) for margin in studies[0]["margins"])
