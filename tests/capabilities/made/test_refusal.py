"""Errors of measured points: each names the files, the cam of a shaft, or the place in the recipe that named them."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.measured import RECIPES

from camgeo.capabilities.made.refusal import as_call_errors, refused_at
from camgeo.common.errors import CallError
from camgeo.recipe.recipe import read
from camgeo.schema.errors import RecipeErrors
from kin.follower.frame_contact import FrameError
from kin.made.points import UnlikePointsError
from kin.made.smooth import GapError, SpansError
from kin.numeric.errors import UnsettledError

FILES = [Path("a.csv"), Path("b.csv")]


def refuse(error: Exception) -> None:
    raise error


@pytest.mark.parametrize(
    ("error", "lobe", "message"),
    [
        (UnlikePointsError("they look turned"), "", "a.csv, b.csv: they look turned"),
        (UnlikePointsError("they look turned"), "intake", "a.csv, b.csv: intake: they look turned"),
        (FrameError("it binds"), "", "a.csv, b.csv: on the metal that these points tell, it binds"),
        (CallError("its lifts are in degrees"), "", "a.csv, b.csv: its lifts are in degrees"),
        (CallError("its lifts are in degrees"), "intake", "a.csv, b.csv: intake: its lifts are in degrees"),
        (CallError("b.csv: no such disc"), "", "b.csv: no such disc"),
        (CallError("b.csv: no such disc"), "intake", "intake: b.csv: no such disc"),
    ],
)
def test_what_is_refused_of_points_names_their_files(error: Exception, lobe: str, message: str) -> None:
    with pytest.raises(CallError) as caught, as_call_errors(FILES, lobe):
        refuse(error)
    assert str(caught.value) == message


@pytest.mark.parametrize("error", [GapError("a gap"), SpansError("13 spans"), UnsettledError("no foot")])
def test_errors_of_points_are_those_of_the_call_and_of_the_recipe(error: Exception) -> None:
    with pytest.raises(CallError, match=f"^a.csv, b.csv: {error}$"), as_call_errors(FILES):
        refuse(error)
    recipe = read(f"{RECIPES['flat']}\nmade: {{profile: 0.02}}\n".encode(), "part.yaml")
    with pytest.raises(RecipeErrors, match=f"made: {error}$"), refused_at(recipe, "made"):
        refuse(error)


def test_an_error_of_another_kind_passes() -> None:
    """What the calls do not name is no fault of points: shapes that disagree, a value that is none."""
    recipe = read(f"{RECIPES['flat']}\nmade: {{profile: 0.02}}\n".encode(), "part.yaml")
    defect = ValueError("operands could not be broadcast together")
    for context in (as_call_errors(FILES), as_call_errors(FILES, "intake"), refused_at(recipe, "made")):
        with pytest.raises(ValueError, match=r"^operands could not be broadcast together$") as caught, context:
            refuse(defect)
        assert caught.value is defect


def test_what_is_refused_in_a_recipe_stands_at_its_place() -> None:
    text = f"{RECIPES['flat']}\nmade: {{profile: 0.02}}\n"
    recipe = read(text.encode(), "part.yaml")
    with pytest.raises(RecipeErrors) as caught, refused_at(recipe, "made", "a.csv", FILES[0]):
        refuse(CallError("a.csv: no points; --units inch"))
    (error,) = caught.value.errors
    assert (error.path, error.problem) == ("made", "a.csv: no points; units: inch")
    with refused_at(recipe, "made"):
        pass
