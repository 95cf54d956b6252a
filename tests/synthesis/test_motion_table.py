"""A linkage's motion in its table: lengths of its links, and slopes of its columns by differences, in each unit."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.linkage import motion_table

FOUR_BAR = """\
{units}cam: {{kind: support, p: {mean!r} + {wave!r}*sin(3*t), shaft: [{shaft!r}, {low!r}]}}
linkage: {{kind: four-bar, ground: {ground!r}, coupler: {coupler!r}, rocker: {rocker!r}, dyads: [
  {{kind: rrp, on: output, point: [{point!r}, 0], link: {link!r}, through: [0, {through!r}], direction: 30}}]}}
verify: {{angles: 720}}
"""
MM = {"mean": 25.0, "wave": 1.0, "shaft": 18.0, "low": 8.5, "ground": 80.0, "coupler": 70.0, "rocker": 105.0}
MORE = {"point": 60.0, "link": 150.0, "through": 150.0}


def table(unit: str) -> dict[str, np.ndarray]:
    mm, units = (25.4, "units: inch\n") if unit == "in" else (1.0, "")
    text = FOUR_BAR.format(units=units, **{key: value / mm for key, value in (MM | MORE).items()})
    recipe = read(text.encode(), Path("c.yaml"))
    driven = designed(recipe).driven
    assert driven is not None
    names, rows = motion_table(recipe, driven.mechanism)
    return dict(zip(names, rows.T, strict=True))


def slopes(values: np.ndarray, step: float) -> np.ndarray:
    """Derivative at all places but the ends, by central differences."""
    slope: np.ndarray = (values[2:] - values[:-2]) / (2.0 * step)
    return slope


@pytest.mark.thin(2)
@pytest.mark.parametrize("unit", ["mm", "in"])
def test_links_keep_their_lengths_and_columns_their_slopes(unit: str) -> None:
    """A at the origin, B at (ground, 0), D on the rocker about B, the slide on its line; all by the shaft angle."""
    columns, mm = table(unit), 25.4 if unit == "in" else 1.0
    angles = ["shaft_deg", "relative_deg", "frame_deg"]
    assert list(columns) == [
        *angles,
        *(f"output_{unit}", "velocity", "acceleration", "output_0_deg", "velocity_0", "acceleration_0"),
        *("frame_velocity", "frame_acceleration", "velocity_by_relative", "acceleration_by_relative"),
        *(f"joint_x_{unit}", f"joint_y_{unit}", f"joint_1_x_{unit}", f"joint_1_y_{unit}"),
    ]
    shaft, relative, frame = (np.radians(columns[name]) for name in angles)
    assert columns["shaft_deg"] == pytest.approx(np.linspace(0.0, 360.0, 721), abs=1e-12)
    assert relative - shaft == pytest.approx(frame - frame[0], abs=1e-12)

    rocker = np.radians(columns["output_0_deg"])
    joint = columns[f"joint_x_{unit}"] * mm, columns[f"joint_y_{unit}"] * mm
    assert joint[0] == pytest.approx(80.0 - 105.0 * np.cos(rocker), abs=1e-9)
    assert joint[1] == pytest.approx(105.0 * np.sin(rocker), abs=1e-9)
    slide, at = columns[f"output_{unit}"] * mm, math.radians(30.0)
    assert columns[f"joint_1_x_{unit}"] * mm == pytest.approx(slide * math.cos(at), abs=1e-9)
    assert columns[f"joint_1_y_{unit}"] * mm == pytest.approx(150.0 + slide * math.sin(at), abs=1e-9)

    step = shaft[1]
    for position, velocity, acceleration in (
        (columns[f"output_{unit}"], columns["velocity"], columns["acceleration"]),
        (columns["output_0_deg"], columns["velocity_0"], columns["acceleration_0"]),
        (columns["frame_deg"], columns["frame_velocity"], columns["frame_acceleration"]),
    ):
        assert slopes(position, step) == pytest.approx(velocity[1:-1], abs=1e-3 * np.abs(velocity).max())
        assert slopes(velocity, step) == pytest.approx(acceleration[1:-1], abs=1e-3 * np.abs(acceleration).max())
    # by the relative angle: v = v_r theta', a = a_r theta'^2 + v_r theta''
    rate, bend = 1.0 + np.radians(columns["frame_velocity"]), np.radians(columns["frame_acceleration"])
    by_relative = columns["velocity_by_relative"], columns["acceleration_by_relative"]
    assert by_relative[0] * rate == pytest.approx(columns["velocity"], abs=1e-9)
    assert by_relative[1] * rate**2 + by_relative[0] * bend == pytest.approx(columns["acceleration"], abs=1e-9)
    assert columns["velocity"][0] == pytest.approx(columns["velocity"][-1], abs=1e-9)
