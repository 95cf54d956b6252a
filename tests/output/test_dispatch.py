"""Files of cams with more surfaces than their form is taught: refused by name, before anything is written."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from support.groove import CAM, grooved
from support.heavy import ezdxf

from camgeo.checks.declared import MOTION, RATIO
from camgeo.output import pipeline
from camgeo.output.job import Job
from camgeo.registry.formats import FORMATS
from camgeo.report import document
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.numeric.check import Check

if TYPE_CHECKING:
    from pathlib import Path

PART = "part: {thickness: 8, bore: 10, outer: 160}"
MILLED = "manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 2, safe_height: 5}"
MOST = {
    (kind, name or None): form.surfaces
    for kind, record in FORMATS.items()
    if not record.summary
    for name, form in record.forms.items()
}
FORMS = sorted(MOST, key=str)
READ = {  # tables of one surface that are refused of a groove as its recipe is read
    ("csv", "grinding"): ("{csv: {as: grinding}}", "a wheel grinds the outside of a disc"),
    ("csv", "lift"): ("{csv: {as: lift, roller: 25}}", "a wheel grinds the outside of a disc"),
    ("csv", "trace"): ("{csv: {as: trace}}", "needs linkage.trace"),
    ("csv", "valve"): ("{csv: {as: valve}}", "a table of the valve needs one"),
}
ALONE = [form for form in FORMS if MOST[form] == 1 and form not in READ]


def written(kind: str, how: str | None) -> str:
    return kind if how is None else f"{{{kind}: {{as: {how}}}}}"


def test_every_form_that_a_recipe_may_ask_for_has_a_record() -> None:
    for record in FORMATS.values():
        choices = next((field.choices for field in record.options.fields if field.name == "as"), ("",))
        assert set(record.forms) == set(choices)
        assert all(form.name == name for name, form in record.forms.items())


@pytest.mark.parametrize(("kind", "how"), ALONE)
def test_a_form_that_is_taught_one_surface_refuses_two(kind: str, how: str | None, tmp_path: Path) -> None:
    text = f"{CAM}\n{PART}\n{MILLED}\nexport: {{files: [{written(kind, how)}]}}\n"
    recipe = grooved(text)
    with pytest.raises(RecipeErrors) as caught:
        pipeline.export(recipe, tmp_path / "out")
    (error,) = caught.value.errors
    assert error.path == "export.files[0]"
    assert f"{kind}{f' as {how}' if how else ''} does not hold a cam of 2 surfaces" in str(error)
    assert not list(tmp_path.rglob("*.*"))


@pytest.mark.parametrize("form", [form for form in READ if form in FORMS], ids=str)
def test_a_table_that_no_groove_has(form: tuple[str, str]) -> None:
    assert MOST[form] == 1
    file, problem = READ[form]
    with pytest.raises(RecipeErrors) as caught:
        grooved(f"{CAM}\n{PART}\nmanufacture: {{wheel: 300}}\nexport: {{files: [{file}]}}\n")
    (error,) = caught.value.errors
    assert error.path == "export.files[0].csv.as"
    assert problem in str(error)


def test_a_form_that_is_taught_more_is_named(tmp_path: Path) -> None:
    recipe = grooved(f"{CAM}\nexport: {{files: [{{csv: {{as: polar}}}}]}}\n")
    with pytest.raises(RecipeErrors, match=r"csv as polar does not hold a cam of 2 surfaces.*give dxf as arcs"):
        pipeline.export(recipe, tmp_path / "out")


HELD = [form for form in FORMS if MOST[form] > 1 and form[0] in {"dxf", "svg"}]
LIMITED = "limits: {contour-error: {at_most: 0.002}, size: {at_most: 200}}"


def exported(files: str, folder: Path, clearance: float = 0.03, more: str = "") -> pipeline.Outcome:
    text = f"{CAM}\npart: {{bore: 10}}\n{more}\nexport: {{tolerance: 0.001, files: [{files}]}}\n"
    return pipeline.export(grooved(text, clearance), folder)


@pytest.mark.thin(6)
@pytest.mark.parametrize(("kind", "how"), HELD)
def test_a_drawing_of_two_flanks_is_judged_on_both(kind: str, how: str | None, tmp_path: Path) -> None:
    outcome = exported(written(kind, how), tmp_path, more=LIMITED)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    checks = {(check["name"], check.get("surface")) for check in outcome.report["checks"]}
    for name in ("pitch-radius", "undercut-global", "pressure-angle", "contour", "motion"):
        assert checks >= {(name, "inner"), (name, "outer")}
    assert checks >= {("form-closure", None), ("limit:contour-error", "outer"), ("limit:size", "outer")}
    (file,) = outcome.report["files"]
    inner, outer = file["surfaces"]
    exact = outcome.report["contour"]
    for one in (inner, outer):
        assert one["measured_error"] <= 0.001
        assert one["perimeter"] == pytest.approx(exact[one["name"]]["perimeter"], rel=1e-5)
    assert outer["perimeter"] - inner["perimeter"] > 2 * 3.14 * 16
    assert "perimeter" not in file


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "how"), HELD)
def test_a_flank_that_is_another_is_seen(kind: str, how: str | None, tmp_path: Path) -> None:
    """A file of another clearance fails on the outer flank alone, by what it is off."""
    folder = exported(written(kind, how), tmp_path, clearance=0.035).folder
    assert folder is not None
    (path,) = (path for path in folder.iterdir() if path.suffix == f".{kind}")
    meant = grooved(f"{CAM}\npart: {{bore: 10}}\nexport: {{tolerance: 0.001, files: [{written(kind, how)}]}}\n")
    checks = pipeline.judge_files(meant, [path])["checks"]
    failed = {(check["name"], check.get("surface")) for check in checks if not check["ok"]}
    assert failed == {("contour", "outer"), ("motion", "outer"), ("form-closure", None)}
    (off,) = (check["value"] for check in checks if (check["name"], check.get("surface")) == ("contour", "outer"))
    assert off == pytest.approx(0.005, abs=0.001)


@pytest.mark.slow
def test_layers_and_columns_are_those_of_the_flanks(tmp_path: Path) -> None:
    folder = exported("dxf, {csv: {as: contacts}}", tmp_path).folder
    assert folder is not None
    drawing = ezdxf.readfile(folder / "groove.dxf")
    layers = [entity.dxf.layer for entity in drawing.modelspace() if entity.dxf.layer != "REFERENCE"]
    assert layers == ["GROOVE_INNER", "GROOVE_OUTER", "BORE"]
    header = (folder / "groove.csv").read_text().partition("\n")[0].split(",")
    assert [name for name in header if name.endswith("_x_mm")] == ["inner_x_mm", "outer_x_mm"]


def test_a_contact_knows_its_surface_and_one_roller_is_one() -> None:
    design = designed(grooved(CAM))
    assert design.follower.arrangement.contacts == 1
    assert [contact.surface for contact in design.follower.contacts] == ["inner", "outer"]
    with pytest.raises(ValueError, match="too many values"):
        _ = design.only_surface


@pytest.mark.slow
def test_a_page_draws_every_surface() -> None:
    recipe = grooved(f"{CAM}\npart: {{bore: 10}}\nexport: {{tolerance: 0.001, files: [dxf]}}\n")
    outcome, found = pipeline.check_and_show(recipe)
    assert outcome.ok
    (cam,) = (body for body in found.scene.bodies if body.name == "cam")
    assert len(cam.shapes[0].rings) == 3  # both flanks, and the bore
    assert {"contact, inner", "contact, outer"} <= {body.name for body in found.scene.bodies}
    titles = [plot.title for plot in found.plots]
    assert titles[-3:-1] == ["Curvature of the pitch curve, inner", "Curvature of the pitch curve, outer"]
    assert titles[-1] == "Backlash, groove.dxf"
    assert [(error.name, error.surface) for error in found.errors] == [("groove.dxf", "inner"), ("groove.dxf", "outer")]
    for error in found.errors:
        assert -0.001 <= error.low.min() < -0.0003
        assert 0.0003 < error.high.max() <= 0.001
    rows = [row for row in document.table(outcome.report).splitlines() if row.startswith("groove.dxf")]
    assert [row.split()[1] for row in rows] == ["inner", "outer"]


@pytest.mark.parametrize(("ratio", "told"), [(0.9995, True), (0.9985, False), (None, False)])
def test_a_motion_that_misses_the_contour_is_explained_where_the_follower_moves_almost_along_it(
    ratio: float | None, told: bool
) -> None:
    checks = [] if ratio is None else [SimpleNamespace(name=RATIO.name, value=ratio)]
    cam = SimpleNamespace(advice=SimpleNamespace(less_swing=lambda _: "a smaller swing"))
    job: Any = SimpleNamespace(design=SimpleNamespace(checks=checks), recipe=SimpleNamespace(cam=cam, mm=1.0))
    lost = Check(MOTION.name, ok=False, value=None, limit=0.1, unit="mm", detail="a roller meets nothing")
    assert ("reaches 0.9995, so the follower moves almost along" in Job._why_lost(job, lost).detail) == told
    kept = Check(MOTION.name, ok=True, value=0.01, limit=0.1, unit="mm")
    assert Job._why_lost(job, kept) is kept
