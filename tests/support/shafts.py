# needs: camshaft
"""Points as an instrument would give them of a made camshaft: lobes turned or faulty by what is planted, noise."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.camshaft.keys import CamshaftRecipe
from camgeo.capabilities.camshaft.lobes import placed
from camgeo.common.clock import Clock
from camgeo.recipe.loading import load_order
from camgeo.synthesis.intent import intended
from support.measured import nothing

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from kin.numeric.arrays import Array

HEAD = "lobe,z_mm,x_mm,y_mm"
FLAT = """\
cam:
  kind: disc
  base_radius: 18
  follower: {kind: flat}
  motion: {lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}
part: {thickness: 14}
"""
ROLLER = """\
cam:
  kind: disc
  base_radius: 30
  follower: {kind: roller, radius: 8, offset: 4}
  motion: [{rise: 12, over: 60, law: modified-sine}, {dwell: 30}, {return: 12, over: 90, law: cycloidal}, {dwell: 180}]
part: {thickness: 10}
"""
ARM = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 8, arm: {length: 70, pivot: 85}}
  motion: [{rise: 18, over: 80, law: cycloidal}, {return: 18, over: 80, law: cycloidal}, {dwell: 200}]
part: {thickness: 10}
"""


class Planted(NamedTuple):
    """A fault of a lobe: degrees by which it is late, and its deviation, mm, by the parameter."""

    late: float = 0.0
    deviation: Callable[[Array], Array] = nothing


def camshaft(folder: Path, *, more: str = "", limits: str = "", files: str = "[stl]") -> Path:
    """The recipe of three lobes and those of the lobes, in a folder; `limits` is added to each lobe's."""
    for name, text in (("flat", FLAT), ("roller", ROLLER), ("arm", ARM)):
        (folder / f"{name}.yaml").write_text(text + limits, "utf-8")
    rows = (
        "{recipe: flat.yaml, at: 33.3, z: 20}",
        "{recipe: roller.yaml, at: -120, direction: 90, z: 40}",
        "{recipe: arm.yaml, at: 250, direction: -60, z: 60}",
    )
    text = "".join(f"    - {row}\n" for row in rows)
    path = folder / "shaft.yaml"
    body = f"camshaft:\n  shaft: {{diameter: 24, to: 90}}\n  lobes:\n{text}"
    path.write_text(f"{more}{body}export: {{tolerance: 0.01, files: {files}}}\nverify: {{angles: 360}}\n", "utf-8")
    return path


_KNOWN: dict[tuple[str, ...], tuple[CamshaftRecipe, Sequence[PlacedLobe]]] = {}


def _placed(recipe: Path) -> tuple[CamshaftRecipe, Sequence[PlacedLobe]]:
    """A shaft and its lobes, designed once however many folders hold recipes of the same text."""
    key = (recipe.read_text("utf-8"), *(path.read_text("utf-8") for path in sorted(recipe.parent.glob("*.yaml"))))
    if key not in _KNOWN:
        order = load_order(recipe)
        assert isinstance(order, CamshaftRecipe)
        _KNOWN[key] = order, placed(order, Clock())
    return _KNOWN[key]


def shaft_points(
    recipe: Path,
    planted: Mapping[str, Planted] | None = None,
    *,
    late: float = 0.0,
    noise: float = 0.0,
    count: int = 360,
) -> list[tuple[str, float, float, float]]:
    """Rows of lobe, z, x and y, mm, as the shaft is drawn; all is late by `late` degrees."""
    order, lobes = _placed(recipe)
    rng, rows = np.random.default_rng(1), []
    mirrored = -1.0 if order.rotation == "ccw" else 1.0
    for lobe in lobes:
        cam = lobe.on_shaft(order.engine)
        fault = (planted or {}).get(cam.name, Planted())
        (surface,) = intended(cam.recipe, cam.design).surfaces
        t = np.arange(count) * (2.0 * np.pi / count)
        frame = surface.gauge.envelope.frames(t)
        off = fault.deviation(t) + noise * rng.normal(size=count)
        place = (frame.points + off[:, None] * frame.normals) @ np.array([1.0, 1.0j])
        place *= np.exp(1j * (cam.at + np.radians(late + fault.late)))
        z = 0.5 * (cam.low + cam.high)
        rows += [(cam.name, z, one.real, mirrored * one.imag) for one in place.tolist()]
    return rows


def written(path: Path, rows: list[tuple[str, float, float, float]], columns: str = HEAD) -> Path:
    """A file of the columns that are named, of `HEAD` or without their units."""
    known = HEAD.replace("_mm", "").split(",")
    chosen = [known.index(name.removesuffix("_mm")) for name in columns.split(",")]
    cells = (",".join(str(row[k]) if k == 0 else f"{row[k]:.9f}" for k in chosen) for row in rows)
    path.write_text("\n".join([columns, *cells]) + "\n", "utf-8")
    return path
