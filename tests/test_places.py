"""Where a module is tested: by a test of its stem, one that imports it, or one that says so in its docstring."""

from __future__ import annotations

import ast
import re
from functools import cache

import pytest
from support.places import ROOT

from camgeo.registry import registry

PRODUCT = sorted(path.relative_to(ROOT) for top in ("camgeo", "kin") for path in (ROOT / top).rglob("*.py"))
TESTS = sorted((ROOT / "tests").rglob("*.py"))
HALVES = {half: name for name, label in registry.labels().items() for half in label.kin}
HOLDS = re.compile(r"Holds:\s*((?:(?:camgeo|kin)[\w.]*\w,?\s*)+)\.")


@pytest.mark.slow  # it reads all tests, and nothing of the product runs
def test_every_module_is_named_where_it_is_tested():
    """But for answers of capabilities, all of which `tests/registry/test_slot.py` reads."""
    named, stated = imported(), {name for names in held().values() for name in names}
    lost = [
        str(path)
        for path in PRODUCT
        if not has_its_stem(path) and dotted(path) not in named and dotted(path) not in stated and defines(path)
    ]
    assert not lost, f"say in the docstring of a test module which of these it holds: {', '.join(lost)}"


@pytest.mark.slow  # likewise
def test_what_tests_say_they_hold_is_there():
    modules = {dotted(path) for path in PRODUCT}
    assert {str(path): strays for path, names in held().items() if (strays := names - modules)} == {}


@pytest.mark.parametrize(
    ("docstring", "names"),
    [
        ("Motions.\n\nHolds: camgeo.fit.arcs,\nkin.law.x_y.\n", ["camgeo.fit.arcs", "kin.law.x_y"]),
        ("Holds what it is given.", []),
    ],
)
def test_a_docstring_says_what_it_holds(docstring, names):
    assert stated_in(docstring) == set(names)


def dotted(path) -> str:
    return ".".join(path.with_suffix("").parts).removesuffix(".__init__")


def defines(path) -> bool:
    """Whether a module has definitions; a package's `__init__` may have its label and its exports besides."""
    kinds = ast.FunctionDef | ast.ClassDef
    if path.stem != "__init__":
        kinds |= ast.Assign | ast.AnnAssign
    body = ast.parse((ROOT / path).read_text(encoding="utf-8")).body
    return any(isinstance(node, kinds) and not ast.unparse(node).startswith("ANSWERS = ") for node in body)


def has_its_stem(path) -> bool:
    """Whether the tree of tests has a file, or a folder, of the module's name: kin/law/x.py, tests/law/test_x.py.

    Tests of a capability's half in kin lie in the folder `kin` of the capability's own.
    """
    place = ROOT / "tests" / path.parent.relative_to(path.parts[0])
    if path.parts[:1] == ("kin",) and path.parts[1] in HALVES:
        place = ROOT / "tests" / "capabilities" / HALVES[path.parts[1]] / "kin"
    stem = path.stem.lstrip("_")
    return (place / f"test_{stem}.py").exists() or (place / stem).is_dir()


def imported() -> set[str]:
    """Modules that some file of the tests imports, or names from them."""
    names: set[str] = set()
    for path in TESTS:
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.ImportFrom) and node.module:
                names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
    return names


@cache
def tree(path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def held() -> dict[object, set[str]]:
    """Modules that each test says it holds."""
    docstrings = {path: ast.get_docstring(tree(path)) or "" for path in TESTS}
    return {path.relative_to(ROOT): stated_in(text) for path, text in docstrings.items() if stated_in(text)}


def stated_in(docstring: str) -> set[str]:
    return {name for match in HOLDS.finditer(docstring) for name in re.split(r",\s*|\s+", match[1]) if name}
