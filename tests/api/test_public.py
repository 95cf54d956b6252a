"""The face of the package: lazy, typed, and one base for all errors raised on purpose."""

from __future__ import annotations

import ast
import importlib
import inspect
import math
import pickle
import re
import subprocess
import sys
import typing
from pathlib import Path

import numpy as np
import pytest

import camgeo
from camgeo.output.output_folder import RunFolder

ROOT = Path(__file__).parents[2]


def test_the_import_loads_nothing_else() -> None:
    code = "import sys, camgeo; print(sorted({name.split('.')[0] for name in sys.modules} & set(sys.argv[1:])))"
    heavy = ["numpy", "yaml", "ezdxf", "kin", "typing", "logging", "dataclasses"]
    done = subprocess.run(
        [sys.executable, "-S", "-c", code, *heavy], capture_output=True, text=True, cwd=ROOT, check=True
    )
    assert done.stdout == "[]\n"


@pytest.mark.slow
def test_reading_a_recipe_loads_no_library_of_drawings_or_solids() -> None:
    code = "import sys, camgeo; camgeo.load(sys.argv[1]); print(sorted(set(sys.argv[2:]) & set(sys.modules)))"
    heavy = ["ezdxf", "manifold3d", "matplotlib", "OCP", "scipy", "camgeo.output.pipeline", "camgeo.fit.arcs"]
    command = [sys.executable, "-c", code, str(ROOT / "recipes" / "shu-wu.yaml"), *heavy]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout == "[]\n"


def test_every_name_is_there_and_listed() -> None:
    homes: dict[str, str] = vars(camgeo)["_homes"]()
    for name in camgeo.__all__:
        assert getattr(camgeo, name) is not None
        assert name in dir(camgeo)
    assert set(camgeo.__all__) == {"__version__", *homes}
    typed = {}
    for file in (camgeo.__file__, camgeo.capabilities.__file__):
        tree = ast.parse(Path(file or "").read_text(encoding="utf-8"))
        typed |= {
            a.name: node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for a in node.names
        }
    inner = {"import_module", "__version__", "library_names", "capabilities", "*"}
    assert {name: module for name, module in typed.items() if name not in inner} == homes
    with pytest.raises(AttributeError, match="module 'camgeo' has no attribute 'lode'"):
        getattr(camgeo, "lode")  # noqa: B009 - mypy would see it, as a user's does


@pytest.mark.slow
def test_a_type_checker_knows_the_names_and_no_others(tmp_path: Path) -> None:
    """A slip of the pen in an import is found before anything runs; what is there has its own type."""
    pytest.importorskip("mypy")
    (tmp_path / "right.py").write_text(
        "import camgeo\nfrom camgeo import Figures, File, Remark, UnitsError, laws, search\n"
        "velocity: float = laws()['cycloidal'].velocity\nfigures: Figures = camgeo.design('cam.yaml').figures\n"
    )
    (tmp_path / "slip.py").write_text("from camgeo import Desing\nimport camgeo\ncamgeo.lode('cam.yaml')\n")
    command = [sys.executable, "-m", "mypy", *(str(tmp_path / name) for name in ("right.py", "slip.py"))]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)  # in the project's strict way
    told = [line.rpartition("/")[2] for line in done.stdout.splitlines() if ": error: " in line]
    assert [line.partition(": error: ")[0] for line in told] == ["slip.py:1", "slip.py:3"], done.stdout
    assert 'has no attribute "Desing"' in told[0]


ERRORS_OF_PYTHON = {"TypeError", "ValueError", "KeyError", "IndexError"}


def test_an_error_that_a_public_function_names_is_public() -> None:
    for name, one in public_functions().items():
        named = set(re.findall(r"\b[A-Z]\w+Errors?\b", inspect.getdoc(one) or ""))
        assert named <= {*camgeo.__all__} | ERRORS_OF_PYTHON, name


def test_what_is_shown_of_an_object_is_short(tmp_path: Path) -> None:
    """In a debugger or a notebook: what it is, and of which cam."""
    path = tmp_path / "small.yaml"
    path.write_text("cam: {kind: support, p: 25 + cos(3*t)}\nexport: {tolerance: 0.05, files: [dxf]}\n")
    recipe = camgeo.load(path)
    assert repr(recipe) == f"Recipe('small', {str(path)!r})"
    design = camgeo.design(recipe)
    assert repr(design).startswith("Design('small', ")
    assert len(repr(design)) < 100
    assert repr(design.figures) == f"Figures({', '.join(design.figures)})"
    assert f"size: {design.figures['size']}" in str(design.figures).splitlines()
    report = camgeo.export(recipe, tmp_path / "out")
    assert repr(report) == f"Report('small', ok, {str(tmp_path / 'out' / 'small')!r})"
    assert repr(camgeo.check(recipe)) == "Report('small', ok)"


def test_laws_are_functions_with_their_peaks() -> None:
    """Cycloidal: s = u - sin 2 pi u/(2 pi), greatest velocity 2, acceleration 2 pi, jerk 4 pi^2."""
    law = camgeo.laws()["cycloidal"]
    assert (law.velocity, law.acceleration, law.jerk) == pytest.approx((2, 2 * math.pi, 4 * math.pi**2))
    assert law(0.25) == pytest.approx(0.25 - 1 / (2 * math.pi))
    assert law([[0, 0.5], [0.25, 1]], derivative=1) == pytest.approx(np.array([[0, 2], [1, 0]]), abs=1e-12)
    assert camgeo.laws()["parabolic"]([0, 0.5, 1], derivative=2).tolist() == [4, -4, -4]
    for u, order in ((1.1, 0), (math.nan, 0), (0.5, 4), (0.5, -1)):
        with pytest.raises(camgeo.CallError):
            law(u, derivative=order)


def public_functions() -> dict[str, object]:
    found: dict[str, object] = {}
    for name in camgeo.__all__:
        one = getattr(camgeo, name)
        if inspect.isfunction(one):
            found[name] = one
        elif inspect.isclass(one) and one.__module__.startswith("camgeo.api"):
            for method, function in inspect.getmembers(one):
                if not method.startswith("_"):
                    found[f"{name}.{method}"] = getattr(function, "fget", None) or getattr(function, "func", function)
    return {
        name: one for name, one in found.items() if inspect.isfunction(one) and one.__module__.startswith("camgeo.")
    }


def test_no_public_function_takes_any_or_gives_a_bare_dict() -> None:
    functions = public_functions()
    assert {"load", "design", "verify", "Design.motion", "Report.explain", "Design.figures"} <= set(functions)
    for name, one in functions.items():
        told = {where: str(note) for where, note in one.__annotations__.items()}
        assert "return" in told, name
        assert not any("Any" in note for note in told.values()), name
        assert not told["return"].startswith("dict"), name


def errors_of(package: str) -> list[type[BaseException]]:
    """Every exception class that the modules of a package define, by importing those that define one."""
    found = []
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and node.bases and node.name.endswith(("Error", "Errors")):
                module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
                found.append(getattr(importlib.import_module(module), node.name))
    return [one for one in found if issubclass(one, BaseException) and not one.__name__.startswith("_")]


@pytest.mark.slow
def test_every_error_has_the_one_base() -> None:
    found = errors_of("kin") + errors_of("camgeo")
    assert len(found) >= 30
    assert {"RecipeErrors", "CurveError", "ReadError", "IntentError", "UnitsError"} <= {one.__name__ for one in found}
    assert [one for one in found if not issubclass(one, camgeo.CamgeoError)] == []


def test_an_error_is_called_what_the_library_calls_it() -> None:
    """A traceback names the class that an `except` clause takes."""
    for name in camgeo.__all__:
        one = getattr(camgeo, name)
        assert not inspect.isclass(one) or one.__name__ == name


def test_former_bases_are_kept() -> None:
    from camgeo.curve.curve import CurveError
    from camgeo.files.errors import MissingExtraError
    from kin.numeric.errors import UnsettledError

    assert issubclass(CurveError, ValueError)
    assert issubclass(MissingExtraError, ImportError)
    assert issubclass(UnsettledError, ArithmeticError)


def test_errors_of_a_call_can_be_pickled() -> None:
    error = camgeo.CallError("one", "two")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.faults) == ("one\ntwo", ("one", "two"))


def test_type_checkers_see_the_names() -> None:
    hints = typing.get_type_hints(camgeo.check, None, {"Callable": typing.Callable, "OrderSource": object})
    assert hints["return"] is camgeo.Report


def test_errors_of_the_surroundings_are_named_and_can_be_pickled(tmp_path: Path) -> None:
    recipe = camgeo.load("cam: {kind: support, p: 25 + cos(3*t)}\nexport: {tolerance: 0.05, files: [dxf]}\n")
    with RunFolder(tmp_path, "recipe"), pytest.raises(camgeo.BusyError, match="another run is at work here") as caught:
        camgeo.export(recipe, tmp_path)
    assert isinstance(caught.value, camgeo.SurroundingsError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), again.path) == (camgeo.BusyError, str(caught.value), tmp_path / "recipe")


def test_a_text_of_a_single_line(tmp_path: Path) -> None:
    """It is a text by its `: `, which a path that is given as a `str` does not have."""
    assert camgeo.load("cam: {kind: support, p: 25 + cos(3*t)}").cam.kind == "support"
    with pytest.raises(camgeo.RecipeErrors, match="did you mean support"):
        camgeo.load("cam: {kind: suport, p: 9}")
    with pytest.raises(camgeo.RecipeErrors, match="the file does not exist"):
        camgeo.load("no.yaml")
    (tmp_path / "a: b.yaml").write_text("name: b\ncam: {kind: support, p: 9}\n", encoding="utf-8")
    assert camgeo.load(tmp_path / "a: b.yaml").name == "b"
