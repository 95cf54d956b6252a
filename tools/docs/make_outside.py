"""Open the shipped files in other people's programs and write down what each measured: docs/outside.md.

    python tools/docs/make_outside.py

Each program is run without its window, on the same files; one that is not installed is reported so. Areas and volumes
are held against those of the exact cam with its openings, so a row shows what a program makes of a file, its own
rounding included.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import trimesh

from camgeo.output import pipeline
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.judge.volume import exact_area
from kin.read.files import read_drawing
from kin.read.layers import volume

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.recipe import Recipe

ROOT = Path(__file__).parents[2]
RECIPES = ("reuleaux", "shu-wu", "as-figure-9-1", "w-figure-9")
DRAWINGS = (("dxf", "arcs"), ("dxf", "spline"), ("dxf", "polyline"), ("svg", "arcs"), ("svg", "polyline"))
SETS = ("print-roller", "print-arm", "print-constant-diameter", "print-yoke", "print-four-bar", "print-double-roller")
BED = "0x0,400x0,400x400,0x400"  # mm; a set that is laid out in one file is wider than most printers' own
SOLIDS = ("stl", "3mf", "step")
PATIENCE = 300  # seconds for one program and one file
PX = 96.0 / 25.4  # Inkscape's pixels in a mm

FREECAD = """
import json, sys
import FreeCAD, Part, Mesh
def drawing(path, pieces):
    import importDXF
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Draft").SetBool("dxfUseLegacyImporter", False)
    importDXF.open(path)
    shapes = [one.Shape for one in FreeCAD.ActiveDocument.Objects if hasattr(one, "Shape")]
    wires = [Part.Wire(group) for group in Part.sortEdges([edge for shape in shapes for edge in shape.Edges])]
    closed = [wire for wire in wires if wire.isClosed() and len(wire.Edges) == pieces
              and (pieces > 1 or hasattr(wire.Edges[0].Curve, "getKnots"))]
    if not closed:
        return {"note": "open"}
    edges = closed[0].Edges
    if len(edges) == 1:  # over one long spline its integral of the area is out by percents, over its spans it is not
        edges = [piece.toShape() for piece in edges[0].Curve.toBezier()]
    return {"area": Part.Face(Part.Wire(edges)).Area, "note": "%d edges, closed" % len(edges)}
def mesh(path):
    found = Mesh.Mesh(path)
    flaws = found.hasNonManifolds() or found.hasNonUniformOrientedFacets()
    return {"volume": found.Volume, "note": "solid" if found.isSolid() and not flaws else "not a solid"}
def step(path):
    shape = Part.read(path)
    words = "valid" if shape.isValid() else "NOT valid"
    return {"volume": shape.Volume, "note": "%d solid, %d faces, %s" % (len(shape.Solids), len(shape.Faces), words)}
print("FreeCAD-" + ".".join(FreeCAD.Version()[:3]))
for job in json.load(open(JOBS)):
    try:
        path = job["path"]
        kind = path.rsplit(".", 1)[1]
        found = drawing(path, job["pieces"]) if kind == "dxf" else step(path) if kind == "step" else mesh(path)
    except Exception as error:
        found = {"note": "not opened: %s" % str(error).split(":")[0]}
    print("FOUND " + json.dumps(dict(found, path=path)))
"""


@dataclass(frozen=True)
class Sample:
    """One file; the exact area (mm^2) of its contour, alone and with its openings, its box, and its volume, mm^3."""

    recipe: str
    path: Path
    form: str
    pieces: int
    contour: float
    cut: float
    volume: float
    box: tuple[float, float]


@dataclass(frozen=True)
class Row:
    """What a program said of a file: the figure it measured and what it ought to be, and its own words."""

    program: str
    sample: Sample
    what: str = ""
    found: float | None = None
    meant: float | None = None
    note: str = ""

    def cells(self) -> str:
        """Return the row of a table."""
        off = ""
        if self.found is not None and self.meant is not None:
            off = f"{self.found / self.meant - 1.0:+.1e}"
        figure = "" if self.found is None else f"{self.found:.8g}"
        cells = (self.sample.recipe, self.sample.form, self.what, figure, off, self.note)
        return f"| {' | '.join(cells)} |"


def samples(
    recipe: Recipe,
    folder: Path,
    drawings: Sequence[tuple[str, str]] = DRAWINGS,
    solids: Sequence[str] = SOLIDS,
) -> list[Sample]:
    """Make the files of a recipe."""
    requests = [FileRequest(kind, as_) for kind, as_ in drawings]
    requests += [FileRequest(kind) for kind in solids]
    recipe = replace(recipe, export=replace(recipe.export, files=tuple(requests))).without("dynamics", "sweep")
    outcome = pipeline.export(recipe, folder)
    if not outcome.ok or outcome.folder is None:
        raise SystemExit(f"{recipe.name}: a check fails")
    return [_sample(recipe, outcome.folder / file["path"], file) for file in outcome.report["files"]]


def _sample(recipe: Recipe, path: Path, file: dict[str, object]) -> Sample:
    intent = intended(recipe, designed(recipe))
    drawing = read_drawing(path.parent / f"{recipe.name}.dxf")
    contour, holes = drawing.contour, sorted(hole.area for hole in drawing.holes)
    area, perimeter, _ = exact_area([contour], intent)
    touched = area
    if intent.outline is not None:  # of a ring the largest hole is the opening, which its area counts already
        touched, holes = 0.25 * math.pi * intent.outline**2 - area, holes[:-1]
    cut = area - sum(holes)
    thickness = recipe.part.thickness or 0.0
    solid = volume(intent.layers, intent.cross_holes, area, perimeter) if intent.layers else cut * thickness
    x0, y0, x1, y1 = contour.box
    form = f"{path.suffix[1:]}" + (f" ({file['as']})" if file.get("as") else "")
    return Sample(recipe.name, path, form, int(file["pieces"]), touched, cut, solid, (x1 - x0, y1 - y0))


def run(*command: object, folder: Path | None = None) -> str:
    """Run a program and return all it says; its failure is reported in the words it leaves."""
    try:
        done = subprocess.run(
            [str(word) for word in command], capture_output=True, text=True, timeout=PATIENCE, cwd=folder, check=False
        )
    except subprocess.TimeoutExpired:
        return f"no answer within {PATIENCE} s"
    return done.stdout + done.stderr + ("" if done.returncode == 0 else f"\nexit status {done.returncode}")


def freecad(made: list[Sample], work: Path) -> list[Row]:
    """FreeCAD measures the area of the contour of a drawing, and the volume of a solid."""
    mine = [one for one in made if one.path.suffix in {".dxf", ".stl", ".3mf", ".step"}]
    jobs, script = work / "jobs.json", work / "open.py"
    pieces = [1 if "spline" in one.form else one.pieces for one in mine]
    jobs.write_text(json.dumps([{"path": str(one.path), "pieces": n} for one, n in zip(mine, pieces, strict=True)]))
    script.write_text(FREECAD.replace("JOBS", repr(str(jobs))))
    said = run("freecadcmd", script)
    answers = [json.loads(line.split("FOUND ", 1)[1]) for line in said.splitlines() if "FOUND " in line]
    found = {answer["path"]: answer for answer in answers}
    rows = []
    for one in mine:
        answer = found.get(str(one.path), {"note": "no answer"})
        what = "area" if "area" in answer else "volume" if "volume" in answer else ""
        meant = {"area": one.contour, "volume": one.volume}.get(what)
        rows.append(Row("FreeCAD", one, what, answer.get(what), meant, answer["note"]))
    return rows


def openscad(made: list[Sample], work: Path) -> list[Row]:
    """OpenSCAD writes an STL of a solid, or of a drawing that it extrudes by 1 mm. The volume is that of this STL."""
    rows = []
    for one in made:
        if one.path.suffix == ".step":
            continue
        flat = one.path.suffix in {".dxf", ".svg"}
        layer = ', layer="CUT"' if one.path.suffix == ".dxf" else ""
        script, target = work / "open.scad", work / "open.stl"
        text = f'import("{one.path}"{layer});'
        script.write_text(f"$fn = 720; linear_extrude(1) {text}" if flat else f"union() {{ {text} cube(1e-3); }}")
        target.unlink(missing_ok=True)
        said = run("openscad", "--render", "-o", target, script)
        words = re.findall(r"(?:WARNING|ERROR): ((?:(?! of | in layer)[^\n])*)", said)
        simple = re.search(r"Simple:\s*(\w+)", said)
        note = f"simple: {simple[1]}" if simple else ""
        note = "; ".join([*filter(None, [note]), *words[:1]])
        meant = one.contour if one.path.suffix == ".dxf" else one.cut if flat else one.volume
        found = _stl_volume(target) if target.exists() else None
        rows.append(Row("OpenSCAD", one, "area" if flat else "volume", found, meant, note))
    return rows


def _stl_volume(path: Path) -> float:
    """Volume of a text or binary STL by the divergence theorem."""
    return float(trimesh.load_mesh(path, process=False).volume)


def prusa(made: list[Sample], work: Path) -> list[Row]:
    """PrusaSlicer reads the volume of a solid, and slices it."""
    rows = []
    for one in made:
        if one.path.suffix not in {".stl", ".3mf", ".step"}:
            continue
        said = run("prusa-slicer", "--info", one.path)
        volume_said = re.search(r"volume = ([\d.]+)", said)
        whole = re.search(r"manifold = (\w+)", said)
        target = work / "sliced.gcode"
        target.unlink(missing_ok=True)
        sliced = run("prusa-slicer", "--export-gcode", "--layer-height", "0.2", "-o", target, one.path)
        layers = target.read_text().count(";LAYER_CHANGE") if target.exists() else 0
        note = "; ".join(
            [f"manifold: {whole[1]}" if whole else "not opened", f"{layers} layers", *_warnings(sliced)[:1]]
        )
        rows.append(Row("PrusaSlicer", one, "volume", float(volume_said[1]) if volume_said else None, one.volume, note))
    return rows


def _warnings(said: str) -> list[str]:
    return re.findall(r"[^\n]*(?:error|warning|repaired)[^\n]*", said, re.IGNORECASE)


def slicing_of_sets(work: Path) -> list[str]:
    """PrusaSlicer on the mechanisms that are printed as sets: one row for each."""
    rows = [
        "| recipe | bodies | manifold | volume | layers of 0.2 mm | filament, cm^3 | time | it warns |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name in SETS:
        outcome = pipeline.export(load(ROOT / "recipes" / f"{name}.yaml"), work / "out")
        path = work / "out" / name / f"{name}-parts.3mf"
        if not outcome.ok:
            raise SystemExit(f"{name}: a check fails")
        said = run("prusa-slicer", "--info", path)
        whole, volumes = re.findall(r"manifold = (\w+)", said), re.findall(r"volume = ([\d.]+)", said)
        target = work / "set.gcode"
        target.unlink(missing_ok=True)
        sliced = run(
            "prusa-slicer",
            "--export-gcode",
            "--bed-shape",
            BED,
            "--center",
            "200,200",
            "--layer-height",
            "0.2",
            "-o",
            target,
            path,
        )
        text = target.read_text() if target.exists() else ""
        used = re.search(r"filament used \[cm3\] = ([\d.]+)", text)
        time = re.search(r"printing time \(normal mode\) = (.+)", text)
        cells = [name, len(whole), whole.count("yes"), f"{sum(map(float, volumes)):.6g}", text.count(";LAYER_CHANGE")]
        cells += [used[1] if used else "", time[1] if time else "", "; ".join(_warnings(sliced)) or "nothing"]
        rows.append(f"| {' | '.join(map(str, cells))} |")
    return rows


def inkscape(made: list[Sample], work: Path) -> list[Row]:
    """Inkscape measures width and height of the layer CUT in mm, in a filled copy, as the outline of a line is rounded.

    It gives six digits.
    """
    rows = []
    for one in made:
        if one.path.suffix != ".svg":
            continue
        copy = work / one.path.name
        drawn = one.path.read_text(encoding="utf-8")
        copy.write_text(re.sub(r"fill:none;stroke:[^;]*;stroke-width:[\d.]+", "fill:#000", drawn), encoding="utf-8")
        said = run("inkscape", "--query-all", copy)
        found = re.search(r"^CUT,[^,]+,[^,]+,([\d.]+),([\d.]+)", said, re.MULTILINE)
        width, height = (float(value) / PX for value in found.groups()) if found else (math.nan, math.nan)
        meant = one.box[0]
        note = f"height {height:.6g}, {height / one.box[1] - 1.0:+.1e}" if found else "not opened"
        rows.append(Row("Inkscape", one, "width", width if found else None, meant, note))
    return rows


def librecad(made: list[Sample], work: Path) -> list[Row]:
    """LibreCAD prints the drawing; without its window it measures nothing."""
    rows = []
    for one in made:
        if one.path.suffix != ".dxf":
            continue
        copy = work / one.path.name
        shutil.copy(one.path, copy)
        run("env", "QT_QPA_PLATFORM=offscreen", "librecad", "dxf2pdf", "-a", "-c", copy.name, folder=work)
        page = copy.with_suffix(".pdf")
        note = "not drawn"
        if page.exists():
            run("pdftoppm", "-r", "100", "-gray", page, page.with_suffix(""))
            pictures = list(work.glob(f"{page.stem}-*.pgm"))
            ink = sum(_ink(picture) for picture in pictures)
            note = f"drawn, {ink} dark points" if ink else "an empty page"
        rows.append(Row("LibreCAD", one, note=note))
    return rows


def _ink(path: Path) -> int:
    data = path.read_bytes()
    pixels = np.frombuffer(data[-(len(data) - len(data.split(b"255\n", 1)[0]) - 4) :], dtype=np.uint8)
    return int(np.count_nonzero(pixels < 128))


PROGRAMS = {  # the command, and how it tells its version
    "FreeCAD": ("freecadcmd", (), freecad),
    "OpenSCAD": ("openscad", ("--version",), openscad),
    "PrusaSlicer": ("prusa-slicer", ("--help",), prusa),
    "Inkscape": ("inkscape", ("--version",), inkscape),
    "LibreCAD": ("librecad", ("dxf2pdf", "-v"), librecad),
}
HEAD = """# What other people's programs make of the files

Five other programs opened drawings and solids of camgeo and measured them. Solids agree with the exact cam in every
program that opens them. Drawings do too, apart from arcs in OpenSCAD:

- FreeCAD, LibreCAD and Inkscape read the drawings with their arcs, and FreeCAD reads splines too. FreeCAD 0.20 does
  not open 3MF.
- OpenSCAD is right with meshes and polylines. It draws the arcs of a DXF as chords and those of an SVG as coarse
  polygons, and it fills the openings of an SVG. Give it an STL, or a DXF of polylines.
- PrusaSlicer slices every solid.

Areas of the contour are in mm^2, for an SVG with its openings subtracted; volumes are in mm^3. `off` is the relative
difference from the exact cam, with the tolerance of the file and the rounding of the program. FreeCAD's area inside one
long spline is wrong by up to four percent, so the table has the sum over its spans.
"""


def main() -> None:
    """Write docs/outside.md."""
    from outside_followers import section

    text = [HEAD]
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        made = [one for name in RECIPES for one in samples(load(ROOT / "recipes" / f"{name}.yaml"), work / "out")]
        for program, (command, ask, opened) in PROGRAMS.items():
            if shutil.which(command) is None:
                text.append(f"\n## {program}\n\nNot installed where this was written.\n")
                continue
            rows = opened(made, work)
            said = run("env", "QT_QPA_PLATFORM=offscreen", command, *(ask or (work / "open.py",)))
            version = re.search(rf"{program}[^\d\n]*(\d+\.\d+(\.\d+)?)", said, re.IGNORECASE)
            about = " ".join((opened.__doc__ or "").split())
            text.append(f"\n## {program} {version[1] if version else ''}\n\n{about}\n")
            text.append("| recipe | file | what | measured | off | it says |\n| --- | --- | --- | --- | --- | --- |")
            text += [row.cells() for row in rows]
            if program == "PrusaSlicer":
                told = "Sets to print, with all bodies in one 3MF, sliced with the program's own settings"
                text += [f"\n{told} (volumes in mm^3):\n", *slicing_of_sets(work)]
        text += section(work)
    (ROOT / "docs" / "outside.md").write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
