"""A capability is deleted in a copy: all else works on, and its words are unknown."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.deleted import copy_without, unshipped, uses, without_marked
from support.places import ROOT

from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

TESTS = (
    "tests/recipe",
    "tests/cli",
    "tests/report",
    "tests/docs",
    "tests/capabilities/sweep",
    "tests/web/test_live.py",
)

CAPABILITIES = tuple(registry.labels())


def start(folder: Path, *words: str) -> subprocess.Popen[str]:
    surroundings = {**os.environ, "PYTHONPATH": str(folder), "COLUMNS": "200"}  # a line of a failure is not cut
    return subprocess.Popen(
        [sys.executable, *words],
        cwd=folder,
        env=surroundings,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(folder: Path, *words: str) -> tuple[int, str, str]:
    """Exit status, output and errors of Python in a copy."""
    process = start(folder, *words)
    output, errors = process.communicate()
    return process.returncode, output, errors


@pytest.mark.slow
@pytest.mark.parametrize("name", CAPABILITIES)
def test_without_a_capability_all_else_works(name: str, tmp_path: Path) -> None:
    """A minute on two cores: the recipes are exported while the tests run."""
    folder = copy_without(name, tmp_path / "copy")
    assert not (folder / "camgeo" / "capabilities" / name).exists()
    recipes = [str(path.relative_to(folder)) for path in sorted((folder / "recipes").rglob("*.yaml"))]
    there = [test for test in TESTS if (folder / test).exists()]
    with start(folder, "-m", "pytest", "-q", "--tb=no", "-p", "no:xdist", "-p", "no:cacheprovider", *there) as tests:
        status, _, errors = run(folder, "-m", "camgeo", "export", *recipes, "--out", str(tmp_path / "out"))
        output, _ = tests.communicate()
    failures = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
    errors = "".join(line for line in errors.splitlines(keepends=True) if "takes more than" not in line)  # progress
    if status or errors or tests.returncode:
        pytest.fail(f"without {name}:\n{errors}" + "\n".join(failures or output.splitlines()[-5:]), pytrace=False)


def strings(path: Path) -> set[str]:
    """Every text that a module holds, but its docstrings."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    constants = [node for node in nodes if isinstance(node, ast.Constant) and id(node) not in docstrings]
    return {node.value for node in constants if isinstance(node.value, str)}


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", CAPABILITIES)
def test_no_test_that_is_left_imports_it(name: str) -> None:
    imported = re.compile(rf"^\s*(?:from|import) camgeo\.capabilities\.{name}\b", re.MULTILINE)
    paths = [path for path in (ROOT / "tests").rglob("*.py") if path.parents[0].name != name]
    texts = {path.name: path.read_text(encoding="utf-8") for path in paths}
    naming = {file: text for file, text in texts.items() if imported.search(text)}
    assert [file for file, text in naming.items() if imported.search(without_marked(text, name))] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in CAPABILITIES if unshipped(name)])
def test_no_test_that_is_left_reads_a_recipe_that_is_gone(name: str, tmp_path: Path) -> None:
    tests = copy_without(name, tmp_path / "copy") / "tests"
    stems = "|".join(re.escape(path.stem) for path in unshipped(name))
    read = re.compile(rf"(?:^|[/ ])(?:{stems})(?:\.yaml)?(?:$| )")
    hits = [(path.name, text) for path in tests.rglob("*.py") for text in strings(path) if read.search(text)]
    assert hits == []


@pytest.mark.slow
@pytest.mark.parametrize("name", CAPABILITIES)
def test_its_words_are_unknown(name: str, tmp_path: Path) -> None:
    label = registry.labels()[name]
    folder = copy_without(name, tmp_path / "copy")
    for command in label.commands:
        assert f"invalid choice: '{command}'" in run(folder, "-m", "camgeo", command)[2]
    path = folder / "cam.yaml"
    if label.option:
        option = f"--{name.replace('_', '-')}"
        assert f"unrecognized arguments: {option}" in run(folder, "-m", "camgeo", "verify", "a", "b", option)[2]
    for kind in label.formats:
        path.write_text(f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nexport: {{files: [{kind}]}}\n", encoding="utf-8")
        assert f"unknown file format, given '{kind}'" in run(folder, "-m", "camgeo", "check", str(path))[2]
    options = [word for word in label.words if ": " in word]
    for option in options:
        text = f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nexport: {{files: [{{stl: {{{option}}}}}]}}\n"
        path.write_text(text, encoding="utf-8")
        key = option.partition(":")[0]
        assert f"stl.{key}: unknown key" in run(folder, "-m", "camgeo", "check", str(path))[2]
    for word in {*label.words, *label.roots} - {*label.formats, *options}:
        path.write_text(f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\n{word}: {{}}\n", encoding="utf-8")
        assert f"{word}: unknown key" in run(folder, "-m", "camgeo", "check", str(path))[2]
    figures = registry.capability(name).figures if label.record else {}
    for figure in figures:
        path.write_text(
            f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\nlimits: {{{figure}: {{at_most: 1}}}}\n", encoding="utf-8"
        )
        assert f"limits.{figure}: unknown figure" in run(folder, "-m", "camgeo", "check", str(path))[2]


def test_what_is_marked_goes() -> None:
    text = "a\n# needs: sweep\nb\nc\n\nd  # needs: study, sweep\ne\n# needs: sweep\n@x\ndef f():\n    pass\n\n\ng = 1\n"
    assert without_marked(text, "sweep") == "a\nc\n\ne\n\n\ng = 1\n"
    assert without_marked("# needs: sweep\n" + text, "sweep") == ""
    page = "# A\n<!-- needs: sweep -->\n## B\ntext\n### C\ntext\n## D\n<!-- needs: sweep -->\n```yaml\na\n\nb\n```\nend"
    assert without_marked(page, "sweep") == "# A\n## D\nend"
    assert without_marked(page, "dynamics") == page


# needs: sweep
def test_a_recipe_uses_what_it_names() -> None:
    assert uses(ROOT / "recipes" / "sweep-four-bar.yaml", "sweep")
    assert not uses(ROOT / "recipes" / "reuleaux.yaml", "sweep")
