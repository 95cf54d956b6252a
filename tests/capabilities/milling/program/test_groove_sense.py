"""The sense in which paths between two flanks run: each climbs along the nearer flank, and steps are alike."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.output import pipeline
from camgeo.recipe.loading import read
from kin.judge.cuts import cuts_of
from kin.read.gcode import read_gcode

GROOVE = """\
name: c
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  track: {groove: {clearance: 0.03, depth: 5}}
  motion: {formula: 3*(1 - cos(t))}
part: {thickness: 12}
verify: {angles: 36}
export: {tolerance: 0.01, files: [gcode]}
manufacture: {cutter: 4, feed: 600, plunge: 120, spindle: 8000, depth_of_cut: 5, safe_height: 5}
"""


def test_paths_run_as_the_nearer_flank_asks(tmp_path: Path) -> None:
    """A cutter of 2 mm radius runs from 2 - 9 to 9.03 - 2 mm off the pitch curve, in six steps of 3.2 mm or less.

    It is clockwise round the metal within, counter-clockwise within the metal without, the middle among the latter.
    """
    outcome = pipeline.export(read(GROOVE.encode(), Path("c.yaml")), tmp_path)
    assert outcome.ok
    cuts = sorted(cuts_of(read_gcode(outcome.folder / "c.ngc")), key=lambda cut: abs(cut.area))
    assert np.sign([cut.area for cut in cuts]).tolist() == [-1, -1, -1, 1, 1, 1, 1]
    assert [cut.z for cut in cuts] == [-5.0] * 7
    # parallels of a convex curve: lengths grow by 2 pi a step, areas by the mean length
    lengths = np.array([float(cut.path.length.sum()) for cut in cuts])
    assert np.diff(lengths) / (2.0 * math.pi) == pytest.approx(np.full(6, 14.03 / 6.0), abs=2e-3)
    areas = np.abs([cut.area for cut in cuts])
    assert np.diff(areas) / (0.5 * (lengths[1:] + lengths[:-1])) == pytest.approx(np.full(6, 14.03 / 6.0), abs=2e-2)
