"""`benchmarks/same_bytes.py`: it tells no difference where nothing changed, and every one where something did."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections import Counter

import pytest
from support.places import ROOT

BENCHMARKS = ROOT / "benchmarks"
RECIPE = """\
units: inch
cam: {kind: support, reuleaux: {sides: 3, breadth: 1.9, rounding: 8 mm}, shaft: [2 mm, 0]}
export: {tolerance: 0.001, files: [dxf, csv]}
verify: {angles: 8}
"""


@pytest.fixture
def recipe(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(RECIPE, encoding="utf-8")
    return path


@pytest.fixture
def tools(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    import random_recipes
    import same_bytes

    return random_recipes, same_bytes


def compared(old, new, recipe):
    command = [sys.executable, BENCHMARKS / "same_bytes.py", old, new, "--recipe", recipe]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert not done.stderr
    return done.returncode, done.stdout.splitlines()


@pytest.mark.slow
@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="no commits here")
def test_a_commit_and_itself_are_alike(recipe):
    status, lines = compared("HEAD", "HEAD", recipe)
    assert lines[-1] == "3 files and reports of HEAD and HEAD: no differences"
    assert status == 0


@pytest.mark.slow
def test_a_planted_change_is_found(recipe, tmp_path):
    tree = tmp_path / "changed"
    for package in ("camgeo", "kin"):
        shutil.copytree(ROOT / package, tree / package, ignore=shutil.ignore_patterns("__pycache__"))
    planted = 0
    for path in tree.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        planted += text.count("25.4")
        path.write_text(text.replace("25.4", "25.40001"), encoding="utf-8")
    assert planted
    status, lines = compared(ROOT, tree, recipe)
    assert status == 1
    for start in ("small/small.csv: first differs at byte ", "small/small.dxf: first differs at byte "):
        assert any(line.startswith(start) for line in lines)
    assert any(line.startswith("small/report.json: ") and ", now " in line for line in lines)


def test_a_hundred_random_recipes_have_everything(tools):
    random_recipes, _ = tools
    made = [random_recipes.made(0, slot) for slot in range(100)]
    assert made == [random_recipes.made(0, slot) for slot in range(100)]
    assert made != [random_recipes.made(1, slot) for slot in range(100)]
    assert len({each.text for each in made}) == 100
    families, topics = Counter(each.family for each in made), Counter(each.topic for each in made)
    assert set(families) == set(random_recipes.FAMILIES)
    assert set(topics) == set(random_recipes.TOPICS)
    assert min(families.values()) >= 3
    assert min(topics.values()) >= 5


def test_reports_are_compared_by_the_names_of_their_entries(tools):
    _, same_bytes = tools
    old = {"camgeo": "1", "checks": [{"name": "wall", "value": 1.0}, {"name": "dwell", "value": 2.0}]}
    moved = [
        {"name": "size", "value": 3.0},
        {"name": "wall", "value": 1.0, "seconds": 4},
        {"name": "dwell", "value": 2.5},
    ]
    new = {"camgeo": "2", "checks": moved}
    assert same_bytes.unlike(same_bytes.flat(old), same_bytes.flat(new)) == [
        "checks[size].name is new: 'size'",
        "checks[size].value is new: 3.0",
        "checks[dwell].value was 2.0, now 2.5",
    ]
