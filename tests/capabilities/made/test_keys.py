"""Key `made`: files of runs in order, what an entry says in place of options, and the datum that a part fixes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.measured import disc

from camgeo.capabilities.made.keys import Made, PointFile, datum_of, files_of_run, in_recipe
from camgeo.recipe.recipe import read
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe


def recipe(folder: Path, points: str) -> Recipe:
    for name in ("a.csv", "b.csv"):
        (folder / name).touch()
    return read(f"{disc('kind: flat')}\nmade: {{points: {points}}}\n".encode(), folder / "part.yaml")


def test_a_run_is_a_file_or_a_list_of_files_with_options_of_their_own(tmp_path: Path) -> None:
    probe = "{file: b.csv, units: inch, align: rotation, probe: {radius: 2, error: 0.002}}"
    made = recipe(tmp_path, f"[a.csv, [a.csv, {probe}]]").of(Made)
    assert made is not None
    probed = PointFile("b.csv", 25.4, "g", 2.0, None, 0.002)
    assert made.points == ((PointFile("a.csv"),), (PointFile("a.csv"), probed))
    assert files_of_run(made.points[0], "made.points[0]") == [("made.points[0]", PointFile("a.csv"))]
    assert [place for place, _ in files_of_run(made.points[1], "at")] == ["at[0]", "at[1]"]


def test_a_file_that_is_missing_is_named_where_it_stands(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match=r"made\.points\[0\]\[1\]: the file does not exist, given 'c\.csv'"):
        recipe(tmp_path, "[[a.csv, c.csv]]")


def test_a_name_longer_than_any_file_has_a_place(tmp_path: Path) -> None:
    with pytest.raises(RecipeErrors, match=r"made\.points\[0\]: cannot be read: .*, given 'x+\.\.\.'; give its path"):
        recipe(tmp_path, f"[{'x' * 300}.csv]")


def test_remedies_name_keys_of_the_entry() -> None:
    assert in_recipe("give `--align rotation`, --units inch or --probe-radius") == (
        "give `align: rotation`, units: inch or probe.radius"
    )


@pytest.mark.parametrize(
    ("part", "datum"), [("bore: 12", "bore"), ("outer: 160", "none"), ("bore: 12, keyway: din6885", "part")]
)
def test_what_the_part_fixes_is_the_datum(part: str, datum: str) -> None:
    ring = part.startswith("outer")
    text = disc("kind: roller, radius: 10", more="track: internal, " if ring else "", part=part)
    loaded = read(text.encode(), "part.yaml").part
    assert datum_of(None, loaded) == datum
    assert datum_of(Made(datum="none"), loaded) == "none"
