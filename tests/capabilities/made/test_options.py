"""Options of `camgeo verify` for points: units, what is refused, and the uncertainty that they state of a figure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.measured import RECIPES

from camgeo.capabilities.made.options import PointOptions, claims, read_options
from camgeo.common.errors import CallError
from camgeo.recipe.recipe import read
from kin.made.motion import Influence

if TYPE_CHECKING:
    from pathlib import Path

INCHES = read(f"units: inch\n{RECIPES['flat'].replace('bore: 12', 'bore: 0.5')}".encode(), "part.yaml")


def test_lengths_are_in_the_recipe_s_unit_or_their_own() -> None:
    options = read_options(
        {"probe_radius": "0.1", "probe_error": "0.002mm", "axes_error": "0.001,90", "align": "best-fit"}, INCHES, 10.0
    )
    assert options.probing.ball == pytest.approx(2.54)
    assert options.error == pytest.approx(0.002)
    assert options.axes == pytest.approx((0.0254, 0.5 * math.pi))
    assert (options.probing.align, options.probing.units) == ("gxy", 10.0)
    assert (options.axes_shift, options.axes_turn) == options.axes
    assert options.systematic == pytest.approx(math.hypot(0.002, 0.0254))


def test_all_that_makes_no_sense_is_said_at_once() -> None:
    wrong = {"align": "best", "probe_radius": "-1", "axes_error": "0.1", "spans": "many", "out": ""}
    with pytest.raises(CallError) as caught:
        read_options(wrong, INCHES)
    assert [fault.partition(":")[0] for fault in caught.value.faults] == [
        "--align",
        "--probe-radius",
        "--axes-error",
        "--spans",
        "--out",
    ]
    with pytest.raises(CallError, match="a probe has a face or a radius"):
        read_options({"probe_radius": "1", "probe_face": "2"}, INCHES)


def test_the_uncertainty_of_a_figure_is_the_root_of_the_sum_of_squares() -> None:
    """Noise 2 * 0.5, the probe at worst 3 * 2, the axes hypot(3, 4) * 0.4: root of 1 + 36 + 4."""
    influence = Influence(0.5, 3.0, np.array([3.0, 4.0]))
    assert PointOptions(error=2.0, axes=(0.4, 1.0)).expanded(influence) == pytest.approx(math.sqrt(41.0))
    assert PointOptions().expanded(influence) == 1.0


def test_a_grinder_s_table_is_claimed_only_when_asked_for(tmp_path: Path) -> None:
    table = tmp_path / "a.csv"
    table.write_text("c_deg,x_mm\n0,1\n", encoding="utf-8")
    assert not claims(table, {})
    assert claims(table, {"as": "measured"})
    table.write_text("x_mm,y_mm\n0,1\n", encoding="utf-8")
    assert claims(table, {})
    assert not claims(table, {"as": "grinding"})
