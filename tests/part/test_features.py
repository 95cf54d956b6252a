"""A feature is its file and its word: what goes over the records names none of them, and the docs name all."""

import ast
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from camgeo.part.features import FEATURES, NAMES, with_records
from camgeo.part.part import PART, Part, build_part
from camgeo.part.slot import Slot

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "camgeo" / "part"
CAM = "cam: {kind: support, p: 40 + 0*t}\n"
FILES = "export: {tolerance: 0.01, files: [dxf, stl, step]}\nverify: {angles: 36}\n"
PARTS = {
    "keyway": "keyway: din6885",
    "hub": "hub: {diameter: 24, height: 10}",
    "set_screw": "set_screw: {diameter: 4, at: 90}",
    "bolts": "bolts: {count: 3, circle: 40, hole: 4}",
    "dowel": "dowel: {circle: 40, hole: 4, at: 60}",
    "slot": "slot: {length: 8, width: 4, circle: 60, at: 180}",
    "chamfer": "chamfer: 0.5",
    "mark": "mark: {}",
}


def test_every_file_with_a_record_is_a_feature():
    stems = {path.stem for path in FOLDER.glob("*.py") if "\nFEATURE = Feature(" in path.read_text(encoding="utf-8")}
    assert stems == set(NAMES)
    assert [feature.name for feature in FEATURES] == list(NAMES)


@pytest.mark.parametrize("feature", FEATURES, ids=lambda feature: feature.name)
def test_its_key_is_read_and_on_both_pages(feature):
    assert PART.inner.field(feature.name) is feature.field
    assert (
        f"<!-- part.{feature.name} -->" in (ROOT / "docs" / "recipe-part.md").read_text("utf-8")
        or not feature.field.table
    )
    assert f"`{feature.name}`" in (ROOT / "docs" / "part.md").read_text(encoding="utf-8")


def names_in(path):
    """Features whose module another one imports, or of whose keys it has the path."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == "camgeo.part":
            yield from (each.name for each in node.names if each.name in NAMES)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (name for name in NAMES if node.module == f"camgeo.part.{name}")
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from (name for name in NAMES if re.search(rf"\bpart\.{name}\b", node.value))


@pytest.mark.slow
def test_the_core_names_no_feature_outside_its_file():
    own = {FOLDER / f"{name}.py" for name in NAMES} | {FOLDER / "features.py"}
    core = {path for path in (ROOT / "camgeo").rglob("*.py") if "capabilities" not in path.parts} - own
    naming = {str(path.relative_to(ROOT)): set(names_in(path)) for path in sorted(core)}
    assert {path: names for path, names in naming.items() if names} == {}


def package_without(name, folder):
    """Copy both packages without a feature: its file, and its word in the one list."""
    for package in ("camgeo", "kin"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "camgeo" / "part" / f"{name}.py").unlink()
    path = folder / "camgeo" / "part" / "features.py"
    left = tuple(each for each in NAMES if each != name)
    text, count = re.subn(r"(?m)^NAMES = .*$", f"NAMES = {left}", path.read_text(encoding="utf-8"))
    assert count == 1
    path.write_text(text, encoding="utf-8")


def run(folder, *words):
    surroundings = {**os.environ, "PYTHONPATH": str(folder)}
    call = [sys.executable, "-m", "camgeo", *words]
    return subprocess.run(call, cwd=folder, env=surroundings, capture_output=True, text=True, check=False)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_without_its_file_and_word_other_recipes_give_the_same_files(name, tmp_path):
    others = [key for key in PARTS if key not in {name, *(("set_screw",) if name == "hub" else ())}]
    plain = f"{CAM}part: {{thickness: 8, bore: 12, {', '.join(map(PARTS.get, others))}}}\n{FILES}"
    package_without(name, tmp_path / "less")
    for folder in (ROOT, tmp_path / "less"):
        (tmp_path / "plain.yaml").write_text(plain, encoding="utf-8")
        done = run(folder, "export", str(tmp_path / "plain.yaml"), "--out", str(tmp_path / f"of-{folder.name}"))
        assert done.returncode == 0, done.stdout + done.stderr
    files = {path.name: path.read_bytes() for path in (tmp_path / f"of-{ROOT.name}").rglob("plain.*")}
    assert {path.suffix for path in map(Path, files)} == {".dxf", ".stl", ".step"}
    assert files == {path.name: path.read_bytes() for path in (tmp_path / "of-less").rglob("plain.*")}
    own = f"{CAM}part: {{thickness: 8, bore: 12, {PARTS.get(name, f'{name}: 1')}}}\n"
    (tmp_path / "own.yaml").write_text(own, encoding="utf-8")
    assert f"part.{name}: unknown key" in run(tmp_path / "less", "check", str(tmp_path / "own.yaml")).stderr


def test_a_part_gives_each_feature_by_its_class():
    values = {
        "slot": {"length": 12.0, "width": 5.0, "circle": 36.0},
        "chamfer": 0.5,
        "keyway": {"width": 4.0, "depth": 2.0},
    }
    part = build_part(values | {"bore": 12.0})
    assert part.of(Slot) == Slot(12.0, 5.0, 36.0)
    assert [feature.name for feature, _ in with_records(part.features)] == ["keyway", "slot", "chamfer"]
    assert part.edge == 0.5
    assert [feature.name for feature, _ in with_records(part.with_sharp_edges().features)] == ["keyway", "slot"]
    assert (part.holed, part.walled, part.round_bore, part.plain) == (True, True, False, False)
    assert (Part().holed, Part().walled, Part(bore=5.0).round_bore, Part(bore=5.0).plain) == (False, False, True, True)
