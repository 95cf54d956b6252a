"""Pictures of docs/manufacture.md: `python tools/docs/make_manufacture_pictures.py` writes them anew."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import matplotlib as mpl
import numpy as np

from camgeo.output import pipeline
from camgeo.recipe.loading import read
from kin.judge.intent import Milling
from kin.judge.milling import milled
from kin.read.gcode import arcs_of, read_gcode

mpl.use("Agg")
import matplotlib.pyplot as plt  # the backend must be chosen first

ROOT = Path(__file__).parents[2]
RECIPE = """\
name: milled
cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}
part: {thickness: 6, bore: 12, bolts: {count: 4, circle: 34, hole: 9}}
export: {tolerance: 0.002, files: [gcode]}
manufacture: {cutter: 8, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 3, safe_height: 5, holes: true,
  allowance: 1, start: 90}
"""


def main() -> None:
    """Draw what the program of one cam does in the plane, and what it leaves."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = pipeline.export(read(RECIPE.encode(), "milled.yaml"), Path(folder))
        assert outcome.folder is not None
        program = read_gcode(outcome.folder / "milled.ngc")
    left = milled(program, Milling(4.0, 6.0, 3.0), 0.002)
    figure, axes = plt.subplots(figsize=(7.0, 7.0))
    for contour in (left.contour, *left.holes):
        ring = contour.sample(40)
        axes.fill(*ring.T, color="0.85" if contour is left.contour else "white", zorder=0)
        axes.plot(*np.append(ring, ring[:1], axis=0).T, color="black", lw=1.0)
    for move in program.moves:
        if move.start[:2] == move.end[:2] and move.centre is None:
            continue
        arcs = arcs_of([move])
        s = np.linspace(0.0, 1.0, 30)
        points = np.concatenate([arcs.take(np.full(30, k)).points(s * arcs.length[k]) for k in range(len(arcs))])
        colour = "tab:red" if move.rapid else "tab:blue"
        axes.plot(*points.T, color=colour, lw=0.7, ls=":" if move.rapid else "-")
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    figure.tight_layout()
    figure.savefig(ROOT / "docs" / "pictures" / "milling.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
