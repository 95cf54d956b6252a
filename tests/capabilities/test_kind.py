"""A kind of cam that is no disc, made up here: a rack of one straight flank. The core knows it by its label alone.

It is read by the grammar of motions over a length, written, read back and judged by a place in mm, and deleted again.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FILES = {
    "__init__": """
from camgeo.registry.label import Label
LABEL = Label(rank=99, kinds={"rack": "racks are made for a follower on a straight flank"})
""",
    "keys": """
from typing import ClassVar
from camgeo.motions.inputs import Input
from camgeo.motions.motion import MotionSource, motion_field
from camgeo.recipe.export import build_export, export_of
from camgeo.recipe.keys import CORE
from camgeo.recipe.recipe import Order, Verify
from camgeo.registry.formats import FORMATS
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, mapping
from kin.numeric.records import dataclass
TRAVEL = Input(Kind.LENGTH, "travel", MOST, "x")
MOTION = motion_field("motion", Kind.LENGTH, "motion over the travel", over=TRAVEL, required=True)
RACK = mapping("cam", "the rack", Field("kind", Kind.CHOICE, "rack", required=True, choices=("rack",)), MOTION)
TABLE = FieldTable((CORE.field("name"), CORE.field("units"), RACK, export_of({"dxf": FORMATS["dxf"]})))
@dataclass(frozen=True)
class Rack(Order):
    root: ClassVar[str] = "rack"
    motion: MotionSource
def build(values, document, mm):
    export = build_export(values.get("export", {}))
    facts = {"name": values["name"], "about": "", "units": values.get("units", "mm"), "mm": mm}
    return Rack(**facts, export=export, verify=Verify(angles=1), motion=values["cam"]["motion"], **vars(document))
""",
    "pipeline": """
import ezdxf, numpy as np
from camgeo.output.output_folder import RunFolder
from camgeo.output.pipeline import REPORT, Outcome
from camgeo.report.document import Findings, as_json, document
from kin.numeric.check import Check
def export(recipe, out, only, progress):
    motion = recipe.motion.motion(recipe.motion.covered, "cam.motion", None, open_ends=True)
    with RunFolder(out, recipe.name) as run:
        drawing, x = ezdxf.new(units=4), np.array([0.0, motion.total])
        rows = np.column_stack([x, motion.derivatives(x, 0)[0]])
        drawing.modelspace().add_lwpolyline(rows)
        drawing.saveas(run.folder / f"{recipe.name}.dxf")
        (line,) = ezdxf.readfile(run.folder / f"{recipe.name}.dxf").modelspace()
        flank, u = np.array(line.get_points("xy")), np.linspace(0.0, motion.total, 101)
        off = np.abs(np.interp(u, *flank.T) - motion.derivatives(u, 0)[0])
        worst, most = int(off.argmax()), recipe.export.tolerance
        check = Check("motion-error", off[worst] <= most, off[worst], most, "mm", u[worst], at_unit="mm")
        findings = Findings((check,), (), (), (), "knife edge")
        (run.folder / REPORT).write_text(as_json(document(recipe, findings)))
        folder = run.commit([f"{recipe.name}.dxf"]) if findings.ok else run.reject()
    return Outcome(document(recipe, findings), findings.ok, folder)
""",
    "root": """
from camgeo.api.root import Root
from camgeo.capabilities.rack import keys, pipeline
from camgeo.recipe.recipe import Document, reader_of_kind
from camgeo.recipe.keys import UNITS
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.yaml_source import entries
from camgeo.registry.root import Reading
def read(source, path):
    reader = reader_of_kind(source, "rack")
    reader.survey(source.root, "")
    units = entries(source.root)["units"].text if "units" in entries(source.root) else "mm"
    reader.units, reader.mm = units, UNITS[units]
    values = reader.table(keys.TABLE, source.root, "")
    if reader.errors:
        raise RecipeErrors(reader.errors)
    document = Document(path=path, text=source.text, marks=reader.marks)
    return keys.build(values | {"name": path.stem}, document, reader.mm)
READING = Reading(table=lambda: keys.TABLE, read=read, noun="rack", instead="the recipe of a disc")
LEFT = dict.fromkeys(("design", "check", "judge", "claimed"))
def explain(check, report, recipe, file_name):
    return f"{check['name']} failed"
ROOT = Root(export=pipeline.export, foresee=lambda _: (), explain=explain, **LEFT)
""",
}
STRAIGHT = (
    "units: inch\ncam: {kind: rack, motion: [{rise: 1, over: 4, law: constant-velocity}]}\nexport: {files: [dxf]}\n"
)


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    code = "import sys; from camgeo.cli.main import main; sys.exit(main(sys.argv[1:]))"
    return subprocess.run([sys.executable, "-c", code, *words], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the packages, the made-up kind among them."""
    folder = tmp_path_factory.mktemp("copy")
    for package in ("camgeo", "kin"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    own = folder / "camgeo" / "capabilities" / "rack"
    own.mkdir()
    for name, code in FILES.items():
        (own / f"{name}.py").write_text(code, encoding="utf-8")
    return folder


def fault(copy: Path, text: str, *words: str) -> str:
    (copy / "wrong.yaml").write_text(text, encoding="utf-8")
    done = run(copy, *(words or ("export",)), "wrong.yaml")
    assert done.returncode == 2, done.stderr
    return done.stderr


@pytest.mark.slow
def test_it_is_made_and_judged_over_its_travel(copy: Path) -> None:
    (copy / "rack.yaml").write_text(STRAIGHT, encoding="utf-8")
    done = run(copy, "export", "rack.yaml")
    assert done.returncode == 0, done.stderr
    report = json.loads((copy / "out" / "rack" / "report.json").read_text(encoding="utf-8"))
    assert "rotation" not in report
    (check,) = report["checks"]
    assert (check["ok"], check["unit"], check["at_unit"]) == (True, "in", "in")
    (copy / "bent.yaml").write_text(STRAIGHT.replace("constant-velocity", "cycloidal"), encoding="utf-8")
    done = run(copy, "export", "bent.yaml")
    assert done.returncode == 1
    # s - u of the cycloidal law is greatest at a quarter: 1/(2 pi)
    off, at = map(float, re.search(r"motion-error: ([\d.]+) in, .*, at ([\d.]+) in", done.stdout).groups())
    assert off == pytest.approx(0.1591549, abs=1e-6)
    assert at in {1.0, 3.0}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (
            STRAIGHT + "linkage: {kind: four-bar}\n",
            "linkage: a rack takes no linkage; leave it out, or give the recipe of a disc",
        ),
        (
            STRAIGHT.replace("[dxf]", "[stl]"),
            "export.files[0]: a rack takes no stl; leave it out, or give the recipe of a disc",
        ),
        (STRAIGHT.replace("motion:", "moton:"), "cam.moton: unknown key; did you mean motion?"),
        (STRAIGHT.replace("over: 4", "over: 0"), "cam.motion[0].over: not above 0"),
        (STRAIGHT.replace("kind: rack", "kind: rak"), "did you mean rack?"),
        (
            STRAIGHT.replace("kind: rack", "kind: worm"),
            "racks are made for a follower on a straight flank (rack); ",
        ),
    ],
)
def test_words_that_it_does_not_take_are_refused_in_a_sentence(copy: Path, text: str, problem: str) -> None:
    told = fault(copy, text)
    assert problem in told
    assert "worm" not in text or told.rstrip().endswith("; other cams are not made")


@pytest.mark.slow
def test_a_command_of_discs_refuses_it(copy: Path) -> None:
    assert "cam.kind: a rack is no disc cam; export, check and verify take it" in fault(copy, STRAIGHT, "report")
    assert "rack" in run(copy, "schema", "rack").stdout


@pytest.mark.slow
def test_without_its_folder_the_kind_is_unknown(copy: Path, tmp_path: Path) -> None:
    for package in ("camgeo", "kin"):
        shutil.copytree(copy / package, tmp_path / package)
    shutil.rmtree(tmp_path / "camgeo" / "capabilities" / "rack")
    assert "rack" not in fault(tmp_path, STRAIGHT).replace("'rack'", "")
