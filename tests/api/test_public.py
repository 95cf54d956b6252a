"""The face of the package: lazy, typed, and one base for all errors raised on purpose."""

from __future__ import annotations

import ast
import importlib
import inspect
import pickle
import subprocess
import sys
import typing
from pathlib import Path

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


def test_reading_a_recipe_loads_no_library_of_drawings_or_solids() -> None:
    code = "import sys, camgeo; camgeo.load(sys.argv[1]); print(sorted(set(sys.argv[2:]) & set(sys.modules)))"
    heavy = ["ezdxf", "manifold3d", "matplotlib", "OCP", "scipy", "camgeo.output.pipeline", "camgeo.fit.arcs"]
    command = [sys.executable, "-c", code, str(ROOT / "recipes" / "shu-wu.yaml"), *heavy]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout == "[]\n"


def test_every_name_is_there_and_listed() -> None:
    for name in camgeo.__all__:
        assert getattr(camgeo, name) is not None
        assert name in dir(camgeo)
    assert set(camgeo.__all__) == {"__version__", *camgeo._HOMES}
    tree = ast.parse(Path(camgeo.__file__ or "").read_text(encoding="utf-8"))
    typed = {a.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for a in node.names}
    assert typed - {"import_module", "__version__"} == set(camgeo._HOMES)
    with pytest.raises(AttributeError, match="module 'camgeo' has no attribute 'lode'"):
        camgeo.lode  # noqa: B018


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
