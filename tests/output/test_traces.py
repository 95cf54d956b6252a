"""Paths of points of links in files: on REFERENCE in a DXF as ezdxf reads it, in a table, and what is refused.

Holds: camgeo.formats.tables.trace, camgeo.synthesis.traces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import ezdxf
import ezdxf.path
import numpy as np
import pytest
import shapely
from support.places import RECIPES

from camgeo.output.pipeline import export
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

TEXT = (
    (RECIPES / "coupler-curve.yaml").read_text(encoding="utf-8").replace("[dxf, stl,", "[dxf, {dxf: {version: R12}},")
)


@pytest.mark.thin(2)
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_paths_in_files(tmp_path: Path, rotation: str) -> None:
    """The path of joint D is an arc about B, which stands at [ground, 0] in the table and turned in the drawing."""
    recipe = load_text(f"rotation: {rotation}\n{TEXT}", "curve.yaml")
    report = export(recipe, tmp_path).report
    assert report["ok"]
    folder = tmp_path / "curve"
    rows = np.genfromtxt(folder / "curve.csv", delimiter=",", names=True)
    x, y = rows["trace_1_x_mm"], rows["trace_1_y_mm"]
    assert np.hypot(x - 70.0, y) == pytest.approx(90.0, abs=1e-9)
    moving = rows["trace_1_speed"] > 1e-3
    assert np.abs(rows["trace_1_curvature"])[moving] == pytest.approx(1 / 90.0, rel=1e-6)
    for file in ("curve.dxf", "curve-arcs-R12.dxf"):
        drawing = ezdxf.readfile(folder / file)
        assert not drawing.audit().errors
        paths = {}
        for entity in drawing.modelspace().query("LWPOLYLINE POLYLINE"):
            if entity.dxf.layer == "REFERENCE":
                name = entity.get_xdata("CAMGEO")[0].value
                paths[name] = np.array(
                    [(point.x, point.y) for point in ezdxf.path.make_path(entity).control_vertices()]
                )
        assert list(paths) == [f"path of coupler [{place}]" for place in ("0, 0", "-90, 0", "30, 20")]
        # as the mechanism stands at shaft angle 0: the frame's angle and a quarter turn behind
        first = np.column_stack([x, y])
        frame = np.arctan2(*(first[0] - [rows["trace_2_x_mm"][0], rows["trace_2_y_mm"][0]])[::-1]) + np.pi / 2
        back = np.exp(-1j * frame) * (x + 1j * y)
        drawn = np.column_stack([back.real, back.imag if rotation == "cw" else -back.imag])
        line = shapely.LineString(paths["path of coupler [0, 0]"])
        assert shapely.distance(line, shapely.points(drawn)).max() < recipe.export.tolerance


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("on: coupler, point: [30, 20]", "on: frame, point: [30, 20]", "no moving link, given 'frame'; give coupler,"),
        ("on: coupler, point: [30, 20]", "on: 'dyads[0]', point: [3, 2]", "there is no such link, given 'dyads[0]'"),
        ("on: coupler, point: [30, 20]", "on: coupler", r"point: missing; give a list of two lengths"),
        ("[30, 20]}", "[30, 20]}" + "\n    - {on: output, point: [1, 1]}" * 18, "more than 20 entries"),
    ],
)
def test_what_is_refused_of_traces(old: str, new: str, said: str) -> None:
    assert old in TEXT
    with pytest.raises(RecipeErrors) as raised:
        load_text(TEXT.replace(old, new), "curve.yaml")
    assert said in str(raised.value)


def test_a_table_of_traces_needs_traces() -> None:
    with pytest.raises(RecipeErrors, match=r"csv\.as: needs linkage\.trace.* give points such as linkage\.trace"):
        load_text("cam: {kind: support, p: 30}\nexport: {files: [{csv: {as: trace}}]}\n", "cam.yaml")
