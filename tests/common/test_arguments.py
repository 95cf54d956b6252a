"""Wrong arguments over the whole public surface: a wrong type is a TypeError by name, a wrong value a CamgeoError."""

from __future__ import annotations

import inspect
import math
import pickle
import re
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import camgeo
from camgeo import testing
from camgeo.common.arguments import short_repr
from camgeo.common.errors import SurroundingsError

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    Functions: TypeAlias = dict[str, tuple[Callable[..., object], dict[str, object]]]

TEXT = """\
name: small
cam: {kind: support, p: 25 + 2*cos(3*t)}
export: {tolerance: 0.05, files: [dxf]}
verify: {angles: 24}
"""
SEARCHED = """\
name: searched
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [1, 2]}
sweep: {vary: {"cam.shaft[0]": {from: 1, to: 2, steps: 2}}, limits: {size: {at_most: 1}}, rank: size}
"""  # of which no design is kept, so that nothing is drawn
SHAFT = Path(__file__).parents[2] / "recipes" / "camshafts" / "packaging.yaml"  # needs: camshaft
OWN = frozenset(
    {f"{name}.of" for name in ("Check", "Edges", "Figure")}
    | {f"{name}.{method}" for name in ("Figures", "Search") for method in ("get", "items", "keys", "values")}
    | {f"Report.{method}" for method in ("get", "items", "keys", "values")}
    | {"Edges.count", "Edges.index", "Figures.placed"}
)  # made by the library itself, or Python's own


class OfBytes(PathLike):
    def __fspath__(self) -> bytes:
        return b"a"


WRONG: tuple[Any, ...] = (
    *(
        None,
        True,
        3,
        -1,
        0,
        7.5,
        math.nan,
        math.inf,
        -math.inf,
        10**400,
        -(10**5000),
        1e300,
        1e-300,
        1j,
        Fraction(1, 3),
    ),
    *("", "a", "a\nb", "a\0b", "\ud800", "x" * 5000, "../..", b"a", bytearray(b"a"), OfBytes(), object(), print),
    *([], ["dxf", 3], ["gcode"], [[1], [2, 3]], (), {}, {"a": 1}, {3: 4}, {1, 2}, range(3), np.zeros(3), np.array("a")),
    *(np.array([1j]), np.array(None), np.float64(0.5), np.int64(4), np.datetime64("2020-01-01"), iter("ab")),
)


def surface(folder: Path) -> Functions:
    """Every public function with arguments that do, but for those of results, which take none or other records."""
    recipe = camgeo.load(TEXT)
    design, report = camgeo.design(recipe), camgeo.export(recipe, folder)
    drawing = folder / "small" / "small.dxf"
    followed = camgeo.follow(drawing, flat=True)  # needs: follow
    return {
        "load": (camgeo.load, {"source": TEXT}),
        "design": (camgeo.design, {"recipe": recipe}),
        "export": (camgeo.export, {"recipe": recipe, "out": "out", "only": "dxf", "progress": None}),
        "check": (camgeo.check, {"recipe": recipe, "progress": None}),
        "verify": (camgeo.verify, {"recipe": recipe, "file": "a.dxf", "tolerance": 0.1, "units": "mm"}),
        "laws": (camgeo.laws, {}),
        # needs: sweep
        "search": (camgeo.search, {"recipe": camgeo.load(SEARCHED), "out": "out", "jobs": 1, "progress": None}),
        # needs: follow
        "follow": (
            camgeo.follow,
            {"file": drawing, "roller": 3.0, "flat": False, "arm": None, "at": (0.0, 0.0), "steps": 36},
        ),
        # needs: follow
        "Followed.recipe": (followed.recipe, {"table": "lift.csv"}),
        # needs: follow
        "Followed.told_recipe": (followed.told_recipe, {"table": "lift.csv"}),
        "Law": (camgeo.laws()["cycloidal"].__call__, {"u": 0.5, "derivative": 1}),
        "Recipe.replace": (recipe.replace, {"path": "name", "value": "other"}),
        "Recipe.save": (recipe.save, {"path": "saved.yaml"}),
        "Recipe.locate": (recipe.locate, {"path": "cam.kind"}),
        "Recipe.error": (recipe.error, {"path": "cam.kind"}),
        "Recipe.text_with": (recipe.text_with, {"values": {"verify.angles": 30}}),
        "Design.motion": (design.motion, {"theta": 0.5, "derivative": 1}),
        # needs: camshaft
        "CamshaftDesign.motion": (camgeo.design(SHAFT).motion, {"theta": 0.5, "derivative": 1}),
        "Design.contour": (design.contour, {"n": 7}),
        "Design.edges": (design.edges, {"tolerance": 0.1, "form": "arcs"}),
        "Report.explain": (report.explain, {"check": report.checks[0]}),
    }


def public() -> set[str]:
    """Names of all public functions and methods that take an argument; of a recipe those that the page describes."""
    found, page = set(), (Path(__file__).parents[2] / "docs" / "library.md").read_text(encoding="utf-8")
    for name in camgeo.__all__:
        one = getattr(camgeo, name)
        if inspect.isfunction(one):
            found.add(name)
        elif inspect.isclass(one) and not issubclass(one, Exception):
            methods = {at: f for at, f in inspect.getmembers(one, inspect.isfunction) if not at.startswith("_")}
            found |= {f"{name}.{at}" for at, f in methods.items() if len(inspect.signature(f).parameters) > 1}
    return {name for name in found if "Recipe." not in name or f"`{name.lower()}(" in page}


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="module")
def functions(tmp_path_factory: pytest.TempPathFactory) -> Functions:
    return surface(tmp_path_factory.mktemp("made"))


def called(function: Callable[..., object], given: dict[str, object]) -> None:
    if function.__name__ == "replace":  # whose arguments have no names outside
        function(*given.values())
    elif function.__name__ == "error":
        function(given["path"], "a problem")
    else:
        function(**given)


def refusal(function: Callable[..., object], given: dict[str, object]) -> Exception | None:
    """What a call raises."""
    try:
        called(function, given)
    except Exception as error:  # noqa: BLE001 - that is what the tests are about
        return error
    return None


@pytest.mark.slow
@pytest.mark.usefixtures("elsewhere")
def test_every_public_function_is_held_to_the_rule(
    functions: Functions,
) -> None:
    assert {"load", "verify", "Recipe.replace", "Recipe.save", "Report.explain"} <= public() - OWN <= set(functions)
    refused = types = 0
    for name, (function, given) in functions.items():
        if name != "verify":
            called(function, given)  # as it stands it does
        for argument in given:
            for value in WRONG:
                error = refusal(function, {**given, argument: value})
                said = f"{name}({argument}={short_repr(value)}): {type(error).__name__}: {str(error)[:200]}"
                if isinstance(error, TypeError):
                    assert re.match(rf"{argument}\b.* must be |value must be left out", str(error)), said
                else:
                    assert error is None or (isinstance(error, camgeo.CamgeoError) and str(error)), said
                types += isinstance(error, TypeError)
                refused += isinstance(error, camgeo.CamgeoError)
    assert types > 500
    assert refused > 100


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("load", {"source": None}, "source must be a path, YAML text or a mapping, not NoneType"),
        ("design", {"recipe": 3}, "recipe must be a Recipe or the path of one, not int"),
        ("export", {"only": 3}, "only must be a str or a sequence of str, not int"),
        ("export", {"only": ["dxf", None]}, "only[1] must be a str, not NoneType"),
        ("export", {"progress": "x"}, "progress must be a function or None, not str"),
        ("verify", {"file": 3}, "file must be a str or a path, not int"),
        ("verify", {"file": OfBytes()}, "file must be a str or a path of a str, not bytes"),
        ("verify", {"tolerance": "1"}, "tolerance must be a number, not str"),
        ("verify", {"units": 25.4}, "units must be a str, not float"),
        ("Recipe.replace", {"path": 3}, "path must be a str or a mapping from such, not int"),
        ("Recipe.replace", {"path": {3: 4}, "value": None}, "path must be a str, not int"),
        ("Recipe.replace", {"path": {"name": "b"}}, "value must be left out where path is a mapping"),
        ("Design.motion", {"theta": "a"}, "theta must be a number or an array of numbers, not str"),
        ("Design.motion", {"theta": [1.0, None]}, "theta must be a number, not NoneType"),
        ("Design.motion", {"theta": [1j]}, "theta must be a number or an array of numbers, not complex"),
        ("Design.motion", {"derivative": 1.0}, "derivative must be an int, not float"),
        ("Design.contour", {"n": 7.5}, "n must be an int, not float"),
        ("Design.contour", {"n": True}, "n must be an int, not bool"),
        ("Design.edges", {"tolerance": True}, "tolerance must be a number, not bool"),
        ("Report.explain", {"check": 3}, "check must be a Check, not int"),
    ],
)
def test_a_wrong_type_is_named(
    functions: Functions,
    name: str,
    given: dict[str, object],
    message: str,
) -> None:
    function, right = functions[name]
    with pytest.raises(TypeError) as caught:
        called(function, {**right, **given})
    assert str(caught.value) == message


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("load", {"source": "a\0"}, "source is no path: a\\x00 has a null character in it"),
        ("load", {"source": {"cam": {"kind": 10**5000}}}, "recipe: cam.kind: a number of too many digits; "),
        ("export", {"out": "a\0"}, "out is no path: a\\x00 has a null character in it"),
        ("export", {"only": "png"}, "a kind of file is one of "),
        ("Recipe.save", {"path": "/nix/a"}, "/nix/a: cannot be written: No such file or directory"),
        ("Recipe.save", {"path": "."}, ".: cannot be written: Is a directory"),
        ("Recipe.text_with", {"values": {"cam.kind": 3}}, "no number at cam.kind: not a number"),
        ("Design.motion", {"theta": 10**400}, "shaft angles are finite numbers, in radians"),
        ("Design.motion", {"theta": [[1], [2, 3]]}, "theta is no array: its rows differ in length"),
        ("Design.contour", {"n": 10**12}, "a contour takes 3 points at least and 1000000 at most, not 1000000000000"),
        ("Design.edges", {"tolerance": 1e300}, "a tolerance is a length above 0 and up to 2000000 mm, not 1e+300"),
    ],
)
def test_a_wrong_value_is_a_line(
    functions: Functions,
    name: str,
    given: dict[str, object],
    message: str,
) -> None:
    function, right = functions[name]
    with pytest.raises(camgeo.CamgeoError) as caught:
        called(function, {**right, **given})
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again)) == (type(caught.value), str(caught.value))


def test_a_check_of_another_report_is_none_of_these(
    functions: Functions,
) -> None:
    explain, _ = functions["Report.explain"]
    other = camgeo.design(camgeo.load(TEXT).replace("cam.p", "26 + 2*cos(3*t)")).checks[0]
    with pytest.raises(camgeo.CallError, match=r"is none of this report's checks; give one of \.checks"):
        explain(other)


def test_right_types_of_other_libraries_do(
    functions: Functions,
) -> None:
    motion, contour, edges = (functions[f"Design.{name}"][0] for name in ("motion", "contour", "edges"))
    assert motion(np.float32(0.5), derivative=np.int64(1)) == motion(0.5, derivative=1)
    assert motion([0, Fraction(1, 2)]).tolist() == [motion(0.0), motion(0.5)]  # type: ignore[attr-defined]
    assert contour(np.uint8(7)).shape == (7, 2)  # type: ignore[attr-defined]
    assert edges(Fraction(1, 10)) == edges(0.1)


def test_what_is_not_written_as_the_disk_refuses_is_no_oserror(tmp_path: Path) -> None:
    recipe = camgeo.load(TEXT)
    for path in (tmp_path / ("x" * 5000), tmp_path / "no" / "folder", tmp_path):
        with pytest.raises(SurroundingsError, match="cannot be written: "):
            recipe.save(path)


def test_a_replaced_recipe_names_the_field_and_no_line(tmp_path: Path) -> None:
    path = tmp_path / "cam.yaml"
    path.write_text(TEXT)
    recipe = camgeo.load(path)
    with pytest.raises(camgeo.RecipeErrors) as caught:
        recipe.replace({"name": "x", "cam.p": "cos("})
    assert str(caught.value).startswith(f"{path} (replaced): cam.p: ")
    steep = recipe.replace("cam.p", "25 + 9*cos(3*t)")
    assert str(steep.error("cam.p", "wrong")) == f"{path} (replaced): cam.p: wrong"
    report = camgeo.check(steep)
    (told,) = {report.explain(check).splitlines()[-1] for check in report.checks if not check.ok}
    assert told.split(maxsplit=1)[1].startswith(f"{path} (replaced) cam")
    steep.save(path)
    assert str(camgeo.load(path).error("cam.p", "wrong")) == f"{path}:2:25: cam.p: wrong"


def test_a_recipe_from_a_mapping_has_no_lines() -> None:
    with pytest.raises(camgeo.RecipeErrors) as caught:
        camgeo.load({"cam": {"kind": "support", "p": "25"}, "export": {"tolerance": -1}})
    assert str(caught.value) == "recipe: export.tolerance: not above 0, given -1; give a length above 0 in mm"


def test_assertions_keep_the_rule_too(tmp_path: Path) -> None:
    path = tmp_path / "a.dxf"
    path.write_text("0\nEOF\n")
    wrong: tuple[tuple[Callable[[], object], type[Exception], str], ...] = (
        (lambda: testing.assert_closed(3), TypeError, "path must be a str or a path, not int"),
        (lambda: testing.assert_closed(path, gap="1"), TypeError, "gap must be a number, not str"),
        (lambda: testing.assert_closed(path, gap=math.nan), camgeo.CallError, "gap is a number of 0 or above, not nan"),
        (lambda: testing.assert_closed("a\0.dxf"), camgeo.CallError, "path is no path: a\\x00.dxf has a null"),
        (lambda: testing.assert_watertight(path), camgeo.CallError, "a.dxf: not a .stl, .ply, .3mf or .step file"),
        (lambda: testing.assert_recipe(None), TypeError, "recipe must be a Recipe or the path of one, not NoneType"),
        (
            lambda: testing.assert_motion(recipe, path, angles=0),
            camgeo.CallError,
            "a file is judged at 1 angle at least",
        ),
        (lambda: testing.assert_contour(recipe, path, tolerance="a"), TypeError, "tolerance must be a number, not str"),
    )
    (tmp_path / "small.yaml").write_text(TEXT)
    recipe = tmp_path / "small.yaml"
    for call, kind, message in wrong:
        with pytest.raises(kind) as caught:
            call()
        assert str(caught.value).startswith(message)
