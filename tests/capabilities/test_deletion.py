"""A capability is deleted in a copy: all else works on, and its words are unknown."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.deleted import copy_without, uses, without_marked
from support.places import ROOT

from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

TESTS = ("tests/recipe", "tests/cli", "tests/report", "tests/docs", "tests/capabilities/sweep")

DELETED = ("budget", "dynamics", "made", "study", "sweep", "mechanism", "milling", "camshaft", "second_opinion")


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    surroundings = {**os.environ, "PYTHONPATH": str(folder)}
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=surroundings, capture_output=True, text=True, check=False
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", DELETED)
def test_without_a_capability_all_else_works(name: str, tmp_path: Path) -> None:
    folder = copy_without(name, tmp_path / "copy")
    assert not (folder / "camgeo" / "capabilities" / name).exists()
    recipes = [str(path.relative_to(folder)) for path in sorted((folder / "recipes").rglob("*.yaml"))]
    exported = run(folder, "-m", "camgeo", "export", *recipes, "--out", str(tmp_path / "out"))
    assert (exported.returncode, exported.stderr) == (0, "")
    there = [test for test in TESTS if (folder / test).is_dir()]
    tested = run(folder, "-m", "pytest", "-q", "-x", "-n", "2", "-p", "no:cacheprovider", *there)
    assert tested.returncode == 0, tested.stdout[-6000:]


@pytest.mark.slow
@pytest.mark.parametrize("name", DELETED)
def test_its_words_are_unknown(name: str, tmp_path: Path) -> None:
    label = registry.labels()[name]
    folder = copy_without(name, tmp_path / "copy")
    for command in label.commands:
        assert f"invalid choice: '{command}'" in run(folder, "-m", "camgeo", command).stderr
    path = folder / "cam.yaml"
    if label.option:
        option = f"--{name.replace('_', '-')}"
        assert f"unrecognized arguments: {option}" in run(folder, "-m", "camgeo", "verify", "a", "b", option).stderr
    for kind in label.formats:
        path.write_text(f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nexport: {{files: [{kind}]}}\n", encoding="utf-8")
        assert f"unknown file format, given '{kind}'" in run(folder, "-m", "camgeo", "check", str(path)).stderr
    options = [word for word in label.words if ": " in word]
    for option in options:
        text = f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nexport: {{files: [{{stl: {{{option}}}}}]}}\n"
        path.write_text(text, encoding="utf-8")
        key = option.partition(":")[0]
        assert f"stl.{key}: unknown key" in run(folder, "-m", "camgeo", "check", str(path)).stderr
    for word in {*label.words, *label.roots} - {*label.formats, *options}:
        path.write_text(f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\n{word}: {{}}\n", encoding="utf-8")
        assert f"{word}: unknown key" in run(folder, "-m", "camgeo", "check", str(path)).stderr
    figures = registry.capability(name).figures if label.record else {}
    for figure in figures:
        path.write_text(
            f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nlimits: {{{figure}: {{at_most: 1}}}}\n", encoding="utf-8"
        )
        assert f"limits.{figure}: unknown figure" in run(folder, "-m", "camgeo", "check", str(path)).stderr


def test_what_is_marked_goes() -> None:
    text = "a\n# needs: sweep\nb\nc\n\nd  # needs: study, sweep\ne\n# needs: sweep\n@x\ndef f():\n    pass\n\n\ng = 1\n"
    assert without_marked(text, "sweep") == "a\nc\n\ne\n\n\ng = 1\n"
    page = "# A\n<!-- needs: sweep -->\n## B\ntext\n### C\ntext\n## D\n<!-- needs: sweep -->\n```yaml\na\n\nb\n```\nend"
    assert without_marked(page, "sweep") == "# A\n## D\nend"
    assert without_marked(page, "dynamics") == page


def test_a_recipe_uses_what_it_names() -> None:
    assert uses(ROOT / "recipes" / "sweep-four-bar.yaml", "sweep")
    assert not uses(ROOT / "recipes" / "reuleaux.yaml", "sweep")
