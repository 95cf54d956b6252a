"""Files of cams with more surfaces than their form is taught: refused by name, before anything is written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.groove import CAM, grooved

from camgeo.output import pipeline
from camgeo.output.dispatch import SURFACES
from camgeo.recipe.export import FILES
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

PART = "part: {thickness: 8, bore: 10}"
MILLED = "manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 2, safe_height: 5}"
FORMS = sorted(SURFACES, key=str)


def written(kind: str, how: str | None) -> str:
    return kind if how is None else f"{{{kind}: {{as: {how}}}}}"


def test_every_form_of_a_file_is_in_the_table() -> None:
    """But for the page, which shows all other files."""
    offered = set()
    for kind, table in FILES.items():
        choices = next((field.choices for field in table.fields if field.name == "as"), None) or (None,)
        offered |= {(kind, how) for how in choices}
    assert set(SURFACES) == offered - {("html", None)}


@pytest.mark.parametrize(("kind", "how"), FORMS)
def test_a_form_that_is_taught_one_surface_refuses_two(kind: str, how: str | None, tmp_path: Path) -> None:
    text = f"{CAM}\n{PART}\n{MILLED}\nexport: {{files: [{written(kind, how)}]}}\n"
    recipe = grooved(text)
    with pytest.raises(RecipeErrors) as caught:
        pipeline.export(recipe, tmp_path / "out")
    (error,) = caught.value.errors
    assert error.path == "export.files[0]"
    assert f"{kind}{f' as {how}' if how else ''} does not hold a cam of 2 surfaces" in str(error)
    assert not list(tmp_path.rglob("*.*"))


def test_a_form_that_is_taught_more_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(SURFACES, ("dxf", "arcs"), 2)
    recipe = grooved(f"{CAM}\nexport: {{files: [{{csv: {{as: polar}}}}]}}\n")
    with pytest.raises(RecipeErrors, match=r"csv as polar does not hold a cam of 2 surfaces.*give dxf as arcs"):
        pipeline.export(recipe, tmp_path / "out")
