"""The Python of a browser: shipped recipes have the verdicts and the figures there that they have here.

Where a recipe's part needs solids, its files that are solids are left out there, and compared is what is left.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import pytest
from support import pyodide
from support.once import common, once
from support.places import SHIPPED, TESTS

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

AGREE = 1e-9  # of figures in mm and degrees, absolute, and relative of those above 1
TRIED = SHIPPED[::5]
PATIENCE = 1800.0  # s for all recipes, on a busy machine
LEAST_FITTED = 5e-9  # the least, of what is measured of a file: handles of a spline lie where its error hardly changes

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(pyodide.why_not()), reason=pyodide.why_not())]


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the browser's Python says of all recipes, asked once by whichever process comes first."""

    def ask(folder: Path) -> None:
        pyodide.gather(folder / "pure")
        done = pyodide.run(TESTS / "support/in_pyodide.py", folder / "pure", folder / "answer.json", *TRIED)
        assert done.returncode == 0, done.stderr

    folder = once(common(tmp_path_factory) / "pyodide", ask, patience=PATIENCE)
    found: dict[str, Any] = json.loads((folder / "answer.json").read_text("utf-8"))
    return found


def test_indices_are_narrow_there_and_pairs_of_them_are_not(answers: dict[str, Any]) -> None:
    assert answers["index"] == 4
    assert answers["large"] == 131_070 + 131_072


def test_a_set_takes_the_place_of_another_one(answers: dict[str, Any]) -> None:
    assert answers["again"] == ["again.svg", "report.json"]


def test_what_needs_solids_is_left_out_and_said(answers: dict[str, Any]) -> None:
    found = answers["left out"]
    assert found["ok"]
    assert found["files"] == ["hubbed.dxf"]
    assert list(found["missing"]) == ["hubbed.stl", "hubbed.step"]
    assert "this part needs solids" in found["missing"]["hubbed.stl"]


def test_scenes_and_contours_are_shown_and_followed(answers: dict[str, Any]) -> None:
    assert answers["shown"]["plots"] >= 5
    assert answers["shown"]["bodies"] >= 4
    assert answers["shown"]["lift"] == pytest.approx(4.0, abs=0.002)


def test_a_missing_package_is_an_error_of_the_surroundings(answers: dict[str, Any]) -> None:
    assert answers["none"]["error"] == answers["second"]["error"] == "SurroundingsError"
    assert "this part needs solids" in answers["none"]["text"]
    assert "a second opinion needs" in answers["second"]["text"]


@pytest.mark.parametrize("path", TRIED, ids=lambda path: path.stem)
def test_a_shipped_recipe_has_the_same_verdicts_and_figures(answers: dict[str, Any], path: Any) -> None:
    there = answers["recipes"][path.stem]
    if "error" in there:
        assert there["error"] == "SurroundingsError", there
        return
    here = json.loads(camgeo.check(path).to_json())
    missing = {entry["what"] for entry in there["report"]["skipped"] if entry.get("missing")}
    differences = compared(judged(here, missing), judged(there["report"], missing))
    figures = {name: figure.value for name, figure in camgeo.design(path).figures.items()}
    differences += compared(figures, there["figures"])
    assert there["report"]["ok"] is here["ok"] is True
    assert not differences


def judged(report: dict[str, Any], missing: set[str]) -> dict[str, Any]:
    """Give what a report says of the design and of the files that both runs made."""
    kept: dict[str, Any] = without({key: value for key, value in report.items() if key not in APART}, missing)
    return kept


APART = {"stages", "skipped"}
OF_FILE = ("file", "path", "from")  # keys by which a part of a report says which file it is of


def without(part: Any, missing: set[str]) -> Any:
    """Leave out of a document what is of files that are missing."""
    if isinstance(part, dict):
        return {key: without(value, missing) for key, value in part.items()}
    if isinstance(part, list):
        return [without(item, missing) for item in part if not is_of(item, missing)]
    return part


def is_of(item: Any, missing: set[str]) -> bool:
    return isinstance(item, dict) and any(item.get(key) in missing for key in OF_FILE)


PLACES = ("_deg", "detail", "sentence", "centre")  # where an extreme is, which may be attained at several places
MACHINE = {"bytes", "sha256"}  # of a file: digits at rounding, triangles as they were clipped


def compared(here: Any, there: Any, where: str = "", least: float = AGREE) -> list[str]:
    """Say where two documents differ, by more than rounding where they hold numbers; of places nothing is asked."""
    if isinstance(here, dict) and isinstance(there, dict):
        names = sorted(name for name in {*here, *there} - MACHINE if not name.endswith(PLACES))
        least = LEAST_FITTED if {*names}.intersection(OF_FILE) else least
        pairs = [(f"{where}.{name}", here.get(name), there.get(name)) for name in names]
    elif isinstance(here, list) and isinstance(there, list) and len(here) == len(there):
        pairs = [(f"{where}[{i}]", *pair) for i, pair in enumerate(zip(here, there, strict=True))]
    elif isinstance(here, float) and isinstance(there, float):
        if ".peaks." in where:  # a peak may be attained upwards and downwards
            here, there = abs(here), abs(there)
        close = math.isclose(here, there, rel_tol=AGREE, abs_tol=least)
        return [] if close else [f"{where}: {here!r}, {there!r}"]
    else:
        return [] if here == there else [f"{where}: {here!r}, {there!r}"]
    return [line for place, first, second in pairs for line in compared(first, second, place, least)]
