"""A capability is deleted in a copy: all else works on, and its words are unknown."""

from __future__ import annotations

import ast
import functools
import os
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.deleted import (
    LISTS,
    copy_without,
    covering,
    dependent,
    pages,
    unshipped,
    uses,
    without_marked,
    without_named,
)
from support.places import ROOT

from camgeo.recipe.extension import KEYS
from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

TESTS = ("recipe", "cli", "report", "docs", "capabilities/sweep", "web/test_live.py")  # of tests/

CAPABILITIES = tuple(registry.labels())


# Of an installation that can be edited: it would find what a copy lacks where it was copied from.
APART = """\
import sys
sys.meta_path[:] = [finder for finder in sys.meta_path if "__editable__" not in getattr(finder, "__module__", "")]
"""


def start(folder: Path, *words: str) -> subprocess.Popen[str]:
    apart = folder.with_name("apart")
    apart.mkdir(exist_ok=True)
    (apart / "sitecustomize.py").write_text(APART)
    path = os.pathsep.join(map(str, (folder, apart)))
    surroundings = {**os.environ, "PYTHONPATH": path, "COLUMNS": "200"}  # a line of a failure is not cut
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


def files_of_tests() -> list[Path]:
    """The tests that are tried without a capability."""
    places = [ROOT / "tests" / test for test in TESTS]
    return sorted(file for place in places for file in ([place] if place.is_file() else place.rglob("test_*.py")))


def words_of(name: str) -> set[str]:
    """Words by which texts name a capability: its own name, those of recipes."""
    label = registry.labels()[name]
    return {name, *(word.partition(":")[0] for word in label.words), *label.roots}


def chosen_tests(name: str) -> list[str]:
    """Tests that name a capability though it is gone: a mark was forgotten, or a word means another thing."""
    words = "|".join(map(re.escape, sorted(words_of(name))))
    named = re.compile(
        rf"\b(?:{words}): *[{{\[\w]|(?<=['\"`/.])(?:{words})(?=['\"`/.:])"
    )  # a key, or in quotes: no English word
    paths = [path for path in files_of_tests() if ROOT / "tests" / "capabilities" / name not in path.parents]
    left = {path: without_marked(path.read_text(encoding="utf-8"), name) for path in paths}
    naming = [str(path.relative_to(ROOT)) for path, text in left.items() if named.search(text)]
    return naming or ["tests/cli/test_main.py"]


def recipes_of(name: str) -> list[str]:
    """Few recipes that have every word of all capabilities but one."""
    paths = sorted(path for path in (ROOT / "recipes").rglob("*.yaml") if not uses(path, name))
    others = {word for other in registry.labels().values() for word in (*other.words, *other.roots)}
    return [str(path.relative_to(ROOT)) for path in covering(paths, others)]


@pytest.fixture(scope="module", params=CAPABILITIES)
def copied(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """A capability, and the repository without it."""
    return request.param, copy_without([request.param], tmp_path_factory.mktemp("without") / "copy")


@pytest.mark.slow
def test_without_a_capability_all_else_works(copied: tuple[str, Path]) -> None:
    """Those that may know another: tests that name it, recipes of other capabilities; all else is tried without any."""
    name, folder = copied
    gone = [folder / "camgeo" / "capabilities" / name, *(folder / "kin" / half for half in registry.labels()[name].kin)]
    assert not any(path.exists() for path in gone)
    demand_that_all_works(folder, chosen_tests(name), recipes_of(name))


@pytest.mark.slow
def test_without_any_all_else_works(tmp_path: Path) -> None:
    """A core that reaches for a capability by any of its names fails, whichever it is: all tests, all recipes left."""
    folder = copy_without(CAPABILITIES, tmp_path / "copy")
    recipes = [str(path.relative_to(folder)) for path in sorted((folder / "recipes").rglob("*.yaml"))]
    tests = [str(path.relative_to(ROOT)) for path in files_of_tests() if (folder / path.relative_to(ROOT)).exists()]
    assert len(recipes) > 30
    demand_that_all_works(folder, tests, recipes)


def demand_that_all_works(folder: Path, places: list[str], recipes: list[str]) -> None:
    """Tests at these places of a copy pass, and its recipes are exported while they run."""
    assert all((folder / place).exists() for place in [*places, *recipes])
    quiet = ("-q", "--tb=no", "-p", "no:xdist", "-p", "no:cacheprovider")
    with start(folder, "-m", "pytest", *quiet, *places) as tests:
        status, _, errors = run(folder, "-m", "camgeo", "export", *recipes, "--out", str(folder.with_name("out")))
        output, _ = tests.communicate()
    failures = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
    errors = "".join(line for line in errors.splitlines(keepends=True) if not line.endswith(" ...\n"))  # progress
    if status or errors or tests.returncode:
        pytest.fail(f"{errors}" + "\n".join(failures or output.splitlines()[-5:]), pytrace=False)


@functools.cache  # most modules are the same without one capability as without another
def strings(module: str) -> frozenset[str]:
    """Every text that a module, given by its own text, holds, but its docstrings."""
    nodes = list(ast.walk(ast.parse(module)))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    constants = [node for node in nodes if isinstance(node, ast.Constant) and id(node) not in docstrings]
    return frozenset(node.value for node in constants if isinstance(node.value, str))


@pytest.mark.slow
@pytest.mark.parametrize("name", CAPABILITIES)
def test_no_test_that_is_left_imports_it(name: str) -> None:
    packages = [f"camgeo.capabilities.{name}", *(f"kin.{half}" for half in registry.labels()[name].kin)]
    imported = re.compile(rf"^\s*(?:from|import) (?:{'|'.join(map(re.escape, packages))})\b", re.MULTILINE)
    own = ROOT / "tests" / "capabilities" / name
    paths = [path for path in (ROOT / "tests").rglob("*.py") if own not in path.parents]
    texts = {path.name: path.read_text(encoding="utf-8") for path in paths}
    naming = {file: text for file, text in texts.items() if imported.search(text)}
    assert [file for file, text in naming.items() if imported.search(without_marked(text, name))] == []


@pytest.mark.slow
def test_no_test_that_is_left_reads_a_recipe_that_is_gone(copied: tuple[str, Path]) -> None:
    name, folder = copied
    if not (gone := unshipped(name)):
        return
    tests, stems = folder / "tests", "|".join(re.escape(path.stem) for path in gone)
    read = re.compile(rf"(?:^|[/ ])(?:{stems})(?:\.yaml)?(?:$| )")
    texts = [(path.name, strings(path.read_text(encoding="utf-8"))) for path in tests.rglob("*.py")]
    hits = [(name, text) for name, held in texts for text in held if read.search(text)]
    assert hits == []


@pytest.mark.slow
def test_its_words_are_unknown(copied: tuple[str, Path]) -> None:
    name, folder = copied
    label = registry.labels()[name]
    for command in label.commands:
        assert f"invalid choice: '{command}'" in run(folder, "-m", "camgeo", command)[2]
    if label.option:
        option = f"--{name.replace('_', '-')}"
        assert f"unrecognized arguments: {option}" in run(folder, "-m", "camgeo", "verify", "a", "b", option)[2]
    options = [word for word in label.words if ": " in word]
    told = {f"export: {{files: [{kind}]}}": f"unknown file format, given '{kind}'" for kind in label.formats}
    for option in options:
        told[f"export: {{files: [{{stl: {{{option}}}}}]}}"] = f"stl.{option.partition(':')[0]}: unknown key"
    told |= {
        f"{word}: {{}}": f"{word}: unknown key" for word in {*label.words, *label.roots} - {*label.formats, *options}
    }
    told |= {f"limits: {{{key}: {{at_most: 1}}}}": f"limits.{key}: unknown figure" for key in KEYS[name].figures}
    for number, text in enumerate(told):
        recipe = f"cam: {{kind: support, p: 25 + 2*cos(3*t)}}\n{text}\n"
        (folder / f"cam-{number}.yaml").write_text(recipe, encoding="utf-8")
    names = [f"cam-{number}.yaml" for number in range(len(told))]
    errors = run(folder, "-m", "camgeo", "check", *names)[2].splitlines() if told else []
    for file, words in zip(names, told.values(), strict=True):
        assert [line for line in errors if file in line and words in line], words


def test_what_is_marked_goes() -> None:
    text = "a\n# needs: sweep\nb\nc\n\nd  # needs: study, sweep\ne\n# needs: sweep\n@x\ndef f():\n    pass\n\n\ng = 1\n"
    assert without_marked(text, "sweep") == "a\nc\n\ne\n\n\ng = 1\n"
    assert without_marked("# needs: sweep\n" + text, "sweep") == ""
    page = "# A\n<!-- needs: sweep -->\n## B\ntext\n### C\ntext\n## D\n<!-- needs: sweep -->\n```yaml\na\n\nb\n```\nend"
    assert without_marked(page, "sweep") == "# A\n## D\nend"
    assert without_marked(page, "dynamics") == page


@pytest.mark.parametrize("place", LISTS)
def test_a_list_of_pages_needs_no_marks(place: str) -> None:
    """What goes with a capability is told by its label, and each such line stands for itself."""
    text = (ROOT / place).read_text(encoding="utf-8")
    assert "<!--" not in text
    for name in CAPABILITIES:
        assert dependent(text, name) == []
        left = without_named(text, name)
        assert [page for page in pages(name) if f"{page}.md" in left] == []


# needs: valve, camshaft, sweep
def test_a_line_goes_with_what_it_names() -> None:
    text = "| a | `camgeo sweep R` |\n| b | `camgeo new disc-roller` |\n\nA.\nThe [engine](docs/engine.md) is B.\nC"
    assert without_named(text, "sweep") == text.partition("\n")[2]
    assert without_named(text, "valve") == text.replace("The [engine](docs/engine.md) is B.\n", "")
    assert without_named("`camgeo sweeper`, `camgeo new toy`, `swept`, sweep", "sweep")
    assert without_named("key `sweep: {...}` of", "sweep") == ""
    assert dependent(text, "sweep") == dependent(text, "valve") == []
    torn = (
        "The best of\n[many designs](docs/sweep.md), ranked.\n\n```sh\ncamgeo sweep a.yaml\n```\n- a\n  [b](sweep.md)"
    )
    assert len(dependent(torn, "sweep")) == 3


# needs: sweep
def test_a_recipe_uses_what_it_names() -> None:
    assert uses(ROOT / "recipes" / "sweep-four-bar.yaml", "sweep")
    assert not uses(ROOT / "recipes" / "reuleaux.yaml", "sweep")
