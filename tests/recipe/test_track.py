"""Recipes of grooves: what goes with them, and what is refused by name."""

from pathlib import Path

import pytest

from camgeo.cams.groove import Groove
from camgeo.output.pipeline import export
from camgeo.part.hub import Hub
from camgeo.recipe.loading import read
from camgeo.report.failure import failure
from camgeo.schema.errors import RecipeErrors

TRACK = "  track: {groove: {clearance: 0.03, depth: 6}}\n"
GROOVE = """
cam:
  kind: disc
  base_radius: 30
  follower: {kind: roller, radius: 8}
  track: {groove: {clearance: 0.03, depth: 6}}
  motion: [{rise: 10, over: 180, law: cycloidal}, {return: 10, over: 180, law: cycloidal}]
part: {thickness: 12, bore: 10, outer: 130}
export: {files: [dxf]}
"""


def recipe(text):
    return read(text.encode(), Path("groove.yaml"))


def faults(text):
    with pytest.raises(RecipeErrors) as caught:
        recipe(text)
    return [(error.path, error.problem) for error in caught.value.errors]


def test_a_groove_is_read():
    cam = recipe(GROOVE).cam
    assert (cam.kind, cam.side, cam.holding) == ("disc", 1, Groove(0.03, 6.0))
    assert recipe(GROOVE.replace("clearance: 0.03, depth: 6", "")).cam.holding == Groove()
    inches = GROOVE.replace("clearance: 0.03, depth: 6", "clearance: 0.001 in")
    assert recipe(inches).cam.holding.clearance == pytest.approx(0.0254)


HUB = "hub: {diameter: 20, height: 5"
REFUSED = {
    "flat": ("kind: roller, radius: 8", "kind: flat", "cam.follower.kind", "does not run in a groove"),
    "shoe": ("kind: roller", "kind: shoe", "cam.follower.kind", "does not run in a groove"),
    "knife": ("kind: roller, radius: 8", "kind: knife-edge", "cam.follower.kind", "does not run in a groove"),
    "trim": ("  motion:", "  undercut: trim\n  motion:", "cam.undercut", "a groove is not trimmed"),
    "chamfer": ("bore: 10", "bore: 10, chamfer: 1", "part.chamfer", "the edges of a groove are not chamfered"),
    "hub": ("bore: 10", f"bore: 10, {HUB}}}", "part.hub", "a groove is milled from the top face"),
    "hubs": ("bore: 10", f"bore: 10, {HUB}, side: both}}", "part.hub", "a groove is milled from the top face"),
    "deep": ("depth: 6", "depth: 12", "cam.track.groove.depth", "not below the thickness"),
    "scrub": ("0.03", "-0.01", "cam.track.groove.clearance", "a roller in a groove needs clearance"),
    "kerf": ("[dxf]", "[{dxf: {kerf: 0.2}}]", "export.files[0].dxf.kerf", "a groove is made to its nominal size"),
    "shrinkage": (
        "[dxf]", "[{stl: {shrinkage: 0.2}}]", "export.files[0].stl.shrinkage", "a groove is made to its nominal size",
    ),
    "grown": (
        "[dxf]", "[{svg: {clearance: 0.1}}]", "export.files[0].svg.clearance", "a groove is made to its nominal size",
    ),
    "no depth": (
        "clearance: 0.03, depth: 6", "clearance: 0.03", "export.files[1]", "stl needs the depth of the groove",
    ),
    "no blank": (", outer: 130", "", "export.files[1]", "stl of a groove needs its blank"),
    "cutter": (
        "export:", "manufacture: {cutter: 16.1}\nexport:", "manufacture.cutter",
        "wider than the groove",
    ),
    # needs: dynamics
    "train": (
        "export:", "dynamics: {mass: 1.2, stiffness: 2.0e6, preload: 200, rpm: 300}\nexport:", "dynamics.stiffness",
        "a groove has no elastic train",
    ),
    "word": ("{groove: {clearance: 0.03, depth: 6}}", "groove", "cam.track", "not one of the choices"),
    "other": ("groove:", "grove:", "cam.track.grove", "unknown key"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_does_not_go_with_a_groove_is_refused_by_name(name):
    before, after, path, problem = REFUSED[name]
    assert before in GROOVE
    assert (path, problem) in faults(spoilt(before, after, path))


def spoilt(before, after, path):
    """The recipe with a fault, and with a solid where that is the fault's place."""
    text = GROOVE.replace("[dxf]", "[dxf, stl]") if path == "export.files[1]" else GROOVE
    return text.replace(before, after)


def test_each_is_one_fault():
    for name, (before, after, path, _) in REFUSED.items():
        assert len(faults(spoilt(before, after, path))) == 1, name


def test_a_hub_below_goes_with_it():
    assert recipe(GROOVE.replace("bore: 10", f"bore: 10, {HUB}, side: bottom}}")).part.of(Hub).side == "bottom"


@pytest.mark.slow
def test_a_groove_is_sized_as_the_disc_within_it():
    """Both flanks are parallels of one path, whose pressure angle is sized."""
    sizing = "sizing: {pressure-angle: {at_most: 30}, radius-of-curvature: {at_least: 12}}"
    cam = recipe(GROOVE.replace("base_radius: 30", sizing)).cam
    disc = recipe(GROOVE.replace("base_radius: 30", sizing).replace(TRACK, "").replace(", outer: 130", "")).cam
    assert (cam.base_radius, cam.guide) == (disc.base_radius, disc.guide)
    inner, outer = cam.exact().surfaces
    (alone,) = disc.exact().surfaces
    assert inner.extremes("slope") == outer.extremes("slope") == alone.extremes("slope")


def test_a_linkage_is_refused():
    more = "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}\n"
    assert faults(GROOVE + more) == [("linkage", "cannot be combined with a cam of kind disc")]


@pytest.mark.slow
def test_no_roller_is_advised_that_leaves_no_base_circle(tmp_path):
    """Hollows of the outer flank grow with the roller, on the same pitch curve; a base radius below 0 is no advice."""
    for least, advised in ((200.0, False), (48.0, True)):
        text = GROOVE + f"limits: {{hollow-radius: {{at_least: {least}}}}}\nname: groove\n"
        report = export(recipe(text), tmp_path).report
        (failed,) = [check for check in report["checks"] if not check["ok"]]
        assert ("roller radius" in failure(failed, report, recipe(text))) is advised
