"""Loads over the turn from a table: what is read, what is refused with its line, and the forces that follow."""

from __future__ import annotations

import csv
import math
import pickle
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from camgeo.capabilities.dynamics.force_figures import extremes_of
from camgeo.capabilities.dynamics.load_table import LoadTable
from camgeo.capabilities.dynamics.running import Running
from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.output.pipeline import export
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.numeric.monotone import RoughError

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe

CAM = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion:
    [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}, {return: 20, over: 120, law: polynomial-345}, {dwell: 60}]
part: {thickness: 12, bore: 20}
"""
ROWS = "angle, load\n0, 0\n90, 100\n120, 250\n180, 0\n270, -40\n"


def recipe(folder: Path, rows: str | bytes = ROWS, more: str = "", train: str = "mass: 1.2, rpm: 300") -> Recipe:
    data = rows.encode() if isinstance(rows, str) else rows
    (folder / "load.csv").write_bytes(data)
    load = f"load: {{table: load.csv{more}}}"
    return read(f"{CAM}dynamics: {{{train}, preload: 80, {load}}}\n".encode(), folder / "case.yaml")


def running(made: Recipe) -> Running:
    found = running_of(made, designed(made))
    assert found is not None
    return found


def test_a_load_is_straight_between_its_rows_and_on_to_the_next_turn(tmp_path: Path) -> None:
    load = running(recipe(tmp_path)).load
    at = np.radians([0.0, 45.0, 90.0, 105.0, 150.0, 225.0, 315.0, 359.0, 405.0])
    assert load(at) == pytest.approx([0.0, 50.0, 100.0, 175.0, 125.0, -20.0, -20.0, -40.0 / 90.0, 50.0], abs=1e-10)


@pytest.mark.parametrize(
    ("rows", "more"),
    [
        (ROWS + "360, 0\n", ""),
        ("270;-40\n360;0\n450;100\n480;250\n540;0\n", ""),
        ("-90 -40\n0 0\n90 100\n120 250\n180 0\n", ""),
        ("0,0\n180,100\n240,250\n360,0\n540,-40\n", ", angle: crank"),
    ],
)
def test_the_same_load_in_other_words(rows: str, more: str, tmp_path: Path) -> None:
    """A row that closes the turn, another beginning, crank degrees."""
    phi = np.linspace(0.0, 2.0 * math.pi, 1001)
    given_ = running(recipe(tmp_path, rows, more)).load(phi)
    assert given_ == pytest.approx(running(recipe(tmp_path)).load(phi), abs=1e-9)


def test_a_table_and_the_formula_of_the_same_load(tmp_path: Path) -> None:
    """Two straight lines: every extreme of the forces is that of abs(t - pi), whose corners the search has to find."""
    table = recipe(tmp_path, f"0, {100 * math.pi!r}\n180, 0\n")
    formula = read(table.text.replace("{table: load.csv}", "100*abs(t - pi)").encode(), tmp_path / "case.yaml")
    one, other = extremes_of(running(table)), extremes_of(running(formula))
    for first, second in zip(*((*each.contacts, each.torque, each.along) for each in (one, other)), strict=True):
        for mine, its in zip(first, second, strict=True):
            assert mine.value == pytest.approx(its.value, rel=1e-9)
    assert running(table).mean_force(0) == pytest.approx(running(formula).mean_force(0), rel=1e-9)


def test_no_row_is_passed_over(tmp_path: Path) -> None:
    """A measured load of 3600 rows, one of them far above its neighbours, of a train that has no mass to speak of."""
    values = 50.0 + np.random.default_rng(7).normal(0.0, 5.0, 3600)
    values[1234] = 900.0
    rows = "".join(f"{0.1 * k:.1f}, {value:.4f}\n" for k, value in enumerate(values))
    found = extremes_of(running(recipe(tmp_path, rows, train="mass: 1.0e-9, rpm: 300")))
    assert found.along[1] == pytest.approx((980.0, 123.4), rel=1e-9)
    assert found.along[0].value == pytest.approx(80.0 + float(f"{values.min():.4f}"), rel=1e-9)
    assert found.along[0].at_deg == pytest.approx(0.1 * float(values.argmin()), abs=1e-6)


def test_corners_that_are_not_known_are_too_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The planted fault of the test above: a search that is not told of the rows gives up."""
    rows = "".join(f"{0.1 * k:.1f}, {k * k % 17}\n" for k in range(3600))
    run = running(recipe(tmp_path, rows))
    extremes_of(run)
    monkeypatch.setattr(Running, "corners", ())
    with pytest.raises(RoughError):
        extremes_of(running(run.recipe))


@given(
    st.lists(st.integers(0, 3599), min_size=2, max_size=40, unique=True),
    st.data(),
)
@settings(max_examples=examples(60))
def test_any_load(places: list[int], data: st.DataObject) -> None:
    """What the rows say at the rows, between two of them what lies between, and again a turn later."""
    degrees = np.sort(np.array(places) / 10.0)
    values = np.array(data.draw(st.lists(st.integers(-999, 999), min_size=len(places), max_size=len(places)))) * 1.0
    load = LoadTable("x", tuple(np.radians(degrees).tolist()), tuple(values.tolist()))
    assert load(np.radians(degrees)) == pytest.approx(values, abs=1e-8)
    assert load(np.radians(degrees + 360.0)) == pytest.approx(values, abs=1e-6)
    ahead, after = np.append(degrees[1:], degrees[0] + 360.0), np.roll(values, -1)
    for share in (0.25, 0.5):
        found = load(np.radians(degrees + share * (ahead - degrees)))
        assert found == pytest.approx(values + share * (after - values), abs=1e-6)
    assert pickle.loads(pickle.dumps(load)) == load


def test_through_report_and_file(tmp_path: Path) -> None:
    """The recipe names its table, as sweeps need to know; the CSV has the force of the load besides the spring's."""
    made = recipe(tmp_path, train="mass: 1.0e-9, rpm: 300")
    assert made.tables == ("dynamics.load.table",)
    text = made.text + "export: {tolerance: 0.01, files: [{csv: {as: forces}}]}\nverify: {angles: 360}\n"
    outcome = export(read(text.encode(), tmp_path / "case.yaml"), tmp_path / "out")
    assert outcome.ok
    with next((tmp_path / "out").rglob("*.csv")).open(newline="") as file:
        head, *rows = list(csv.reader(file))
    force = {float(row[0]): float(row[head.index("contact_N")]) for row in rows}
    assert force[150.0] == pytest.approx(205.0, rel=1e-9)  # in a dwell the normal is the travel's
    assert force[330.0] == pytest.approx(80.0 - 40.0 / 3.0, rel=1e-9)
    assert outcome.report["forces"]["contacts"][0]["max"] > force[120.0] * (1.0 - 1e-12)


BACK = "add the rows of the rest of the turn"


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (
            "0, 1\n90, x\n",
            "load.csv, line 2: 'x' is not a number, in '90, x'; an angle and a load are expected",
        ),
        ("0, 1\n90, 2, 3\n180, 1\n", "line 2: 3 columns, and 2 are expected, parted by commas: '90, 2, 3'"),
        ("", "load.csv, no row of numbers is among its lines"),
        ("0, 5\n", "a table has at least 2 rows, not 1"),
        ("0, 1\n90, 2\n80, 1\n180, 0\n270, 0\n", "line 3: the angles must rise; 80 follows 90"),
        ("0, 1\n90, 2\n90, 3\n180, 0\n", "line 3: the angles must rise; 90 stands twice"),
        ("0, 1\n90, nan\n180, 0\n", "line 2: the load is not finite"),
        ("0, 1\n180, 2\n400, 1\n", "line 3: the table covers more than 360 degrees"),
        (
            "0, 1\n180, 2\n360, 3\n",
            "line 3: the load does not close: 3 N here, 1 N in the first row, a turn earlier; give ",
        ),
        ("0, 1\n60, 2\n120, 3\n", f"the table ends after 120 degrees with 3 N, and begins with 1 N; {BACK}"),
        ("0, 1\n60, 2e13\n120, 1\n", "load.csv, line 2: a load above 4000000000000; give a table of smaller ones"),
        (b"\x00\x01", "not a text, given 'load.csv'; save the table as CSV"),
    ],
)
def test_a_table_that_is_none(rows: str | bytes, words: str, tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors) as caught:
        recipe(tmp_path, rows)
    (error,) = caught.value.errors
    assert (error.path, error.line) == ("dynamics.load.table", 8)
    assert words in str(error)


def test_remedies_of_tables(tmp_path: Path) -> None:
    """As the errors say: a last row like the first; the rest of the turn."""
    for rows in ("0, 1\n180, 2\n360, 1\n", "0, 1\n60, 2\n120, 3\n180, 3\n240, 2\n300, 2\n", "0, 1\n60, 2\n120, 1\n"):
        recipe(tmp_path, rows)


@pytest.mark.parametrize(
    ("load", "field", "words"),
    [
        ("{table: none.csv}", "dynamics.load.table", "the file does not exist"),
        ("{tabel: load.csv}", "dynamics.load.tabel", "unknown key; did you mean table?"),
        ("{angle: crank}", "dynamics.load.table", "missing"),
        ("{table: load.csv, angle: camm}", "dynamics.load.angle", "cam"),
        ("[1, 2]", "dynamics.load", "a formula in t, or {table: load.csv}"),
        ("3*x", "dynamics.load", "x"),
        ("{table: load.csv}, stiffness: 1.0e6", "dynamics.load", "belongs to a train without stiffness"),
    ],
)
def test_what_is_no_load(load: str, field: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text(ROWS, encoding="utf-8")
    with pytest.raises(RecipeErrors) as caught:
        read(f"{CAM}dynamics: {{mass: 1, rpm: 300, preload: 80, load: {load}}}\n".encode(), tmp_path / "case.yaml")
    assert any(error.path == field and words in str(error) for error in caught.value.errors)


def test_a_follower_that_swings(tmp_path: Path) -> None:
    """Its load is a moment, N m."""
    (tmp_path / "load.csv").write_text("0, 1\n60, 2\n120, 3\n", encoding="utf-8")
    text = """\
cam:
  kind: disc
  base_radius: 34
  follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80}}
  motion: [{rise: 15, over: 120, law: cycloidal}, {return: 15, over: 120, law: cycloidal}, {dwell: 120}]
dynamics: {mass: 0.01, rpm: 60, preload: 80, load: {table: load.csv}}
"""
    with pytest.raises(RecipeErrors, match="ends after 120 degrees with 3 N m, and begins with 1 N m"):
        read(text.encode(), tmp_path / "case.yaml")


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("rows", "more", "factor"),
    [
        (ROWS.replace("load", "load_lbf"), "", 4.4482216152605),
        (ROWS.replace("load", "load (kN)"), "", 1000.0),
        (ROWS, ", units: kN", 1000.0),
        (ROWS, ", scale: 2.5", 2.5),
        (ROWS.replace("angle, load", "crank_deg, load_N").replace("270", "540").replace("180", "360"), "", None),
        ("t, angle, load_N\n0, 0, 0\n1, 90, 100\n2, 120, 250\n3, 180, 0\n4, 270, -40\n", "", 1.0),
        ("0;9;0\n90;9;100\n120;9;250\n180;9;0\n270;9;-40\n", ", columns: [1, 3]", 1.0),
    ],
)
def test_units_and_columns_of_a_load(rows: str, more: str, factor: float | None, tmp_path: Path) -> None:
    phi = np.linspace(0.0, 2.0 * math.pi, 101)
    found = running(recipe(tmp_path, rows, more)).load(phi)
    if factor is not None:
        assert found == pytest.approx(factor * running(recipe(tmp_path)).load(phi), rel=1e-12, abs=1e-9)
    else:
        assert found[75] == pytest.approx(-40.0)


def test_a_load_in_newton_metres_is_none_along_a_stem(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match="the column 'load_Nm' is in Nm; a force is meant here"):
        recipe(tmp_path, ROWS.replace("load", "load_Nm"))


def test_of_many_rows_those_on_straight_lines_are_left_out(tmp_path: Path) -> None:
    angle = np.arange(0.0, 360.0, 0.05)
    load = np.round(100 + 60 * np.sin(np.radians(angle)) + 200 * (np.abs(angle - 200.0) < 20.0), 2)
    made = recipe(tmp_path, "\n".join(f"{a:.2f};{f:.2f}" for a, f in zip(angle, load, strict=True)))
    table = running(made).train.load
    assert isinstance(table, LoadTable)
    assert len(table.theta) < 0.4 * len(angle)
    assert np.abs(table(np.radians(angle)) - load).max() <= 0.005 * (1 + 1e-9)
