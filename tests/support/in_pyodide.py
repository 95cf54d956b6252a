"""What the tests do in the Python of a browser: the first argument is the answer's file, the others are recipes.

The answer is a mapping of plain data; an exception is told by its class and its text.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import camgeo
from camgeo.files.triangulate import region
from kin.read.mesh.mesh import Mesh

OUT = Path.home() / "out"  # in the file system of the browser
HUBBED = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10, hub: {diameter: 18, height: 4}}\n"


TEXT = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nname: again\nexport: {files: [%s]}\n"


def told(step: Any, *arguments: Any) -> Any:
    try:
        return step(*arguments)
    except Exception as error:  # noqa: BLE001 - whatever it is becomes part of the answer
        return {"error": type(error).__name__, "text": str(error)}


def exported(path: Path) -> dict[str, Any]:
    begin = time.perf_counter()
    report = camgeo.export(path, OUT)
    return {"seconds": time.perf_counter() - begin, "report": json.loads(report.to_json()), "figures": figures(path)}


def figures(path: Path) -> dict[str, float | None]:
    return {name: figure.value for name, figure in camgeo.design(path).figures.items()}


def turned(n: int, radius: float) -> Any:
    angle = 2.0 * np.pi * np.arange(n) / n
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def large() -> int:
    """Triangles of a disc and of a ring, whose pairs of vertices take more than 31 bits."""
    disc = region(turned(131_072, 20.0), [])
    ring = region(turned(65_536, 20.0), [turned(65_536, 10.0)])
    assert Mesh(np.zeros((131_072, 3)), disc).edge_faults == (131_072, 0, 0)
    return len(disc) + len(ring)


def again() -> list[str]:
    """Files of a set that takes the place of another one."""
    for files in ("dxf, svg", "svg"):
        camgeo.export(camgeo.load(TEXT % files), OUT)
    return sorted(path.name for path in (OUT / "again").iterdir())


def left_out() -> dict[str, Any]:
    report = camgeo.export(camgeo.load(HUBBED + "name: hubbed\nexport: {files: [dxf, stl, step]}\n"), OUT)
    return {"ok": report.ok, "missing": report.missing, "files": [file.name for file in report.files]}


def shown() -> dict[str, Any]:
    """Lengths of a scene, and of a contour followed in a file made here."""
    design = camgeo.design(camgeo.load(TEXT % "dxf"))
    report = camgeo.export(design.recipe, OUT)
    assert report.path is not None
    followed = camgeo.follow(report.path / "again.dxf", flat=True)
    scene = design.scene()
    return {"plots": len(scene["plots"]), "bodies": len(scene["bodies"]), "lift": followed.lift}


answer, *recipes = map(Path, sys.argv[1:])
answers = {
    "index": np.dtype(np.intp).itemsize,
    "large": told(large),
    "again": told(again),
    "left out": told(left_out),
    "shown": told(shown),
    "none": told(lambda: camgeo.export(camgeo.load(HUBBED + "export: {files: [stl]}\n"), OUT)),
    "second": told(lambda: camgeo.check(camgeo.load(HUBBED), second_opinion=True)),
    "recipes": {path.stem: told(exported, path) for path in recipes},
}
answer.write_text(json.dumps(answers), "utf-8")
