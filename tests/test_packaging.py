"""What the project says of itself: one version, packages that are found, a citation that can be read.

Holds: camgeo.version.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib

import pytest
import yaml
from setuptools import find_packages
from support.places import ROOT

import camgeo

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))

BROUGHT = {
    "PIL": "matplotlib",
    "fontTools": "fpdf2",
    "_pytest": "pytest",
    "resvg_py": "resvg-py",
    "xdist": "pytest-xdist",
    "yaml": "PyYAML",
}
"""Modules that a distribution of another name brings."""
SKIPPED = {"OCP"}
"""Modules without which tests are skipped: no test imports one that the line in README installs."""


def required(extra: str) -> set[str]:
    """Names of the distributions that an extra installs."""
    return {re.split("[<>=~!;]", line)[0] for line in PROJECT["project"]["optional-dependencies"][extra]}


def test_the_version_stands_in_one_place():
    assert "version" not in PROJECT["project"]
    assert PROJECT["project"]["dynamic"] == ["version"]
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "camgeo.version.__version__"}
    # a plain text: setuptools then reads it without importing the package
    text = (ROOT / "camgeo" / "version.py").read_text(encoding="utf-8")
    assert re.findall(r'^__version__ = "(.*)"$', text, re.MULTILINE) == [camgeo.__version__]


IN_THE_ROOT = {
    *(".ci", ".gitignore", "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "MANIFEST.in", "README.md"),
    *("benchmarks", "camgeo", "docs", "examples", "kin", "out", "pyproject.toml", "recipes", "tests"),
    *("tools", "web"),
}


def test_the_root_holds_what_it_should():
    """A command that takes a name for a file leaves none behind that is committed unseen."""
    if not (ROOT / ".git").exists():
        pytest.skip("this is no clone, so nothing tells what belongs to it")
    done = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    assert {line.partition("/")[0] for line in done.stdout.splitlines()} == IN_THE_ROOT


def test_every_folder_of_code_is_packed():
    found = set(find_packages(ROOT, include=PROJECT["tool"]["setuptools"]["packages"]["find"]["include"]))
    modules = [path for name in ("camgeo", "kin") for path in (ROOT / name).rglob("*.py")]
    assert {".".join(path.parent.relative_to(ROOT).parts) for path in modules} == found
    data = PROJECT["tool"]["setuptools"]["package-data"]["*"]
    others = [path for name in found for path in ROOT.joinpath(*name.split(".")).iterdir() if path.is_file()]
    others = [path for path in others if path.suffix not in {".py", ".pyc"}]
    assert {"py.typed", "page.html"} <= {path.name for path in others}
    assert [path.name for path in others if not any(path.match(pattern) for pattern in data)] == []
    assert all((ROOT / name / "py.typed").is_file() for name in ("camgeo", "kin"))


def test_the_citation_is_of_this_version():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= citation.keys()
    assert citation["version"] == camgeo.__version__
    assert citation["title"] == PROJECT["project"]["name"]
    assert citation["license"] == PROJECT["project"]["license"]
    assert citation["authors"] == [{"name": "The camgeo maintainers"}]
    # the readme's sentence says the same
    words = (ROOT / "README.md").read_text(encoding="utf-8").partition("To cite camgeo: ")[2]
    assert words.startswith(
        f"The camgeo maintainers, *camgeo*, version {citation['version']}, {citation['date-released']}."
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "status", "shown"),
    [
        (["recipes/shu-wu.yaml"], 0, {"shu-wu.yaml"}),
        # a call that names nothing takes the tests, here of a folder without any
        (["-o", "testpaths=benchmarks"], 5, set()),
    ],
)
def test_the_repositorys_own_recipes_are_test_items(arguments, status, shown):
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stdout + done.stderr
    assert set(re.findall(r"^recipes/(.*?)::", done.stdout, re.MULTILINE)) == shown


def test_readme_has_two_lines_to_begin_with() -> None:
    done = subprocess.run([sys.executable, ROOT / ".ci" / "readme_lines"], capture_output=True, text=True, check=True)
    install, test = done.stdout.splitlines()
    assert install.endswith("camgeo export recipes/disc-roller.yaml -v")
    assert "'.[test]'" in test
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"\n```sh\n{install}\n```\n" in readme
    assert f"\n```sh\n{test}\n```\n" in readme


@pytest.mark.slow  # it reads all tests, and nothing of the product runs
def test_what_tests_import_the_line_in_readme_installs() -> None:
    paths = [*(ROOT / "tests").rglob("*.py"), *(ROOT / "benchmarks").glob("*.py")]
    own = {"camgeo", "kin", *(path.stem for path in paths), *(path.parent.name for path in paths)}
    installed = required("test") | {re.split("[<>=~!;]", line)[0] for line in PROJECT["project"]["dependencies"]}
    imported = set()
    for path in (ROOT / "tests").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported.add((node.module or "").partition(".")[0])
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Heavy":
                imported.add(ast.literal_eval(node.args[0]).partition(".")[0])
    others = imported - set(sys.stdlib_module_names) - own
    assert {"numpy", "hypothesis", "shapely", "setuptools"} <= others
    assert {name for name in others if BROUGHT.get(name, name) not in installed} == SKIPPED


def test_only_step_files_need_more_than_the_tests_install() -> None:
    """What any other extra brings is tested wherever tests run; tests of STEP files are skipped (`support.kernel`)."""
    extras = set(PROJECT["project"]["optional-dependencies"]) - {"test", "dev", "site"}
    assert {extra for extra in extras if not required(extra) <= required("test")} == {"step"}
