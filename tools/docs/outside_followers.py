"""One cam of each follower in other people's programs: the last section of docs/outside.md (`make_outside.py`)."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

import ezdxf
import make_outside as outside
import trimesh

from camgeo.recipe.loading import load, load_text

if TYPE_CHECKING:
    from pathlib import Path

    from make_outside import Row, Sample

    from camgeo.recipe.recipe import Recipe

SHIPPED = ("disc-roller", "disc-flat", "disc-knife-edge", "disc-shoe", "disc-arm", "disc-arm-flat", "disc-ring")
MOTION = (
    "[{rise: 14, over: 110, law: cycloidal}, {dwell: 50}, {return: 14, over: 110, law: polynomial-345}, {dwell: 90}]"
)
MADE = {
    "knife-edge-arm": "base_radius: 35, follower: {kind: knife-edge, arm: {length: 70, pivot: 85}}",
    "shoe-arm": "base_radius: 35, follower: {kind: shoe, radius: 40, arm: {length: 70, pivot: 90}}",
    "ring-arm": ("base_radius: 60, track: internal, follower: {kind: roller, radius: 9, arm: {length: 80, pivot: 95}}"),
}
"""Followers of which no recipe is shipped."""
DRAWINGS = (("dxf", "arcs"), ("svg", "arcs"))
SOLIDS = ("stl", "step")
HEAD = """
## Each follower of a disc cam

The table has one cam for each follower, as a drawing of arcs, an STL and a STEP. Figures are relative differences of
area, volume or width; of a ring the area is that of its opening. admesh, trimesh and ezdxf look for faults to repair.
"""
COLUMNS = (
    "FreeCAD DXF, area",
    "FreeCAD STEP, volume",
    "OpenSCAD STL, volume",
    "PrusaSlicer STL, volume",
    "Inkscape SVG, width",
    "LibreCAD DXF",
    "admesh STL",
    "trimesh STL, volume",
    "ezdxf audit",
)


def recipes() -> list[Recipe]:
    """The shipped cams and those made here."""
    found = [load(outside.ROOT / "recipes" / f"{name}.yaml") for name in SHIPPED]
    for name, cam in MADE.items():
        part = "{thickness: 8, outer: 200}" if "internal" in cam else "{thickness: 8, bore: 12}"
        text = (
            f"cam: {{kind: disc, {cam}, motion: {MOTION}}}\npart: {part}\nexport: {{tolerance: 0.001, files: [dxf]}}\n"
        )
        found.append(load_text(text, f"{name}.yaml"))
    return found


def section(work: Path) -> list[str]:
    """Lines of the section."""
    lines = [HEAD, f"| follower | {' | '.join(COLUMNS)} |", "| --- |" + " --- |" * len(COLUMNS)]
    made = {recipe.name: outside.samples(recipe, work / "followers", DRAWINGS, SOLIDS) for recipe in recipes()}
    every = [one for samples in made.values() for one in samples]
    solids = [one for one in every if one.path.suffix == ".stl"]
    rows = [*outside.freecad(every, work), *outside.openscad(solids, work), *outside.prusa(solids, work)]
    rows += [*outside.inkscape(every, work), *outside.librecad(every, work)]
    for name, samples in made.items():
        files = {one.path.suffix: one for one in samples}
        mine = {(row.program, row.sample.path.suffix): row for row in rows if row.sample.recipe == name}
        cells = [
            _told(mine.get((title.split()[0], f".{title.split()[1].strip(',').lower()}"))) for title in COLUMNS[:6]
        ]
        cells += [_admesh(files[".stl"]), _trimesh(files[".stl"]), _audit(files[".dxf"])]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return lines


def _told(row: Row | None) -> str:
    if row is None:
        return "not installed"
    if row.found is None or row.meant is None:
        return row.note
    return f"{row.found / row.meant - 1.0:+.1e}"


def _admesh(sample: Sample) -> str:
    if shutil.which("admesh") is None:
        return "not installed"
    said = outside.run("admesh", sample.path)
    names = ("Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets reversed", "Normals fixed")
    counts = [re.search(rf"{name}\s*:\s*(\d+)", said) for name in names]
    wrong = [f"{name}: {count[1]}" for name, count in zip(names, counts, strict=True) if count and count[1] != "0"]
    return "; ".join(wrong) if wrong else "nothing" if all(counts) else "not opened"


def _trimesh(sample: Sample) -> str:
    mesh = trimesh.load_mesh(sample.path)
    off = f"{mesh.volume / sample.volume - 1.0:+.1e}"
    return f"{off}, watertight" if mesh.is_watertight and mesh.is_winding_consistent else f"{off}, NOT watertight"


def _audit(sample: Sample) -> str:
    audit = ezdxf.readfile(sample.path).audit()
    return (
        "nothing" if not audit.errors and not audit.fixes else f"{len(audit.errors)} errors, {len(audit.fixes)} mended"
    )
