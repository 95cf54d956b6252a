"""Faults of a cylindrical cam's recipe: each names its line, its field and a change that helps.

Holds: camgeo.capabilities.cylindrical.reading, camgeo.capabilities.cylindrical.keys,
camgeo.capabilities.cylindrical.drum_recipe, camgeo.capabilities.cylindrical.soundness.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import pytest
from capabilities.cylindrical.made_drums import (
    ARM,
    BOTTOM,
    CONE,
    GROOVE,
    RIB,
    RIB_ON_ARM,
    TOP,
    UNDERCUT,
    changed,
    design_of,
    recipe_of,
)

import camgeo
from camgeo.capabilities.cylindrical.checks_of import design_checks, wall_check, walls
from camgeo.capabilities.cylindrical.figures import figures_of
from camgeo.capabilities.cylindrical.flank import Flank
from camgeo.recipe.recipe import load_text
from camgeo.recipe.starter import starter
from camgeo.report.limit_words import sign
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

REFUSE = changed(UNDERCUT, ("shorten", "refuse"))
_THEN = ", law: cycloidal}, {dwell:"
ASLANT = changed(
    ARM,
    ("length: 80, offset: 78, pivot: 40", "length: 60, offset: -36, pivot: -10.7, side: leading"),
    ("rise: 30, over: 120", "rise: 40, over: 60"),
    ("return: 30, over: 120", "return: 40, over: 180"),
)
REFUSED = [
    (GROOVE, ("radius: 50", "rdius: 50"), "cam.rdius: unknown key; did you mean radius?"),
    (
        GROOVE,
        ("kind: cylindrical", "kind: cylindrical\n  turns: 3"),
        "the segments do not fill their angle, given 360 degrees; let them cover 3 turns",
    ),
    (GROOVE, ("radius: 10,", "radius: 10, arm: {length: 80},"), "cam.follower.arm.offset: missing"),
    (GROOVE, ("radius: 10,", "kind: cone, radius: 10,"), "a conical roller is a roller with a taper"),
    (GROOVE, ("radius: 10,", "radius: 10, at: 40,"), "cam.follower.at: cannot stand without taper; leave it out"),
    (GROOVE, ("radius: 10,", "radius: 10, taper: 61,"), "cam.follower.taper: above 60"),
    (GROOVE, ("radius: 10,", "radius: 10, taper: apex,"), "in degrees, or axis for an apex on the drum's axis"),
    (GROOVE, ("radius: 10,", "radius: 10, taper: 60,"), "the cone ends in its apex before the floor, 37.5 mm from"),
    (
        GROOVE,
        ("radius: 10,", "radius: 10, offset: 27.5,"),
        "past the floor's edge, near 0 degrees; give less than 27.5 mm",
    ),
    (GROOVE, ("radius: 10,", "radius: 10, offset: 20,"), None),
    (BOTTOM, ("radius: 10,", "radius: 10, offset: -25,"), None),
    (ARM, ("radius: 10,", "radius: 10, offset: 6,"), "cam.follower.offset: does not go with an arm; leave it out"),
    (
        ARM,
        ("pivot: 40", "pivot: 100"),
        "does not reach pitch_height at lift 0, given 100 mm; give a pivot between -60.7",
    ),
    (ARM, ("pivot: 40", "pivot: 98.5"), "cam.motion: the arm swings to 81.9"),
    (ARM, ("offset: 78", "offset: 38"), "past the floor's edge, near 60 degrees; give 78.637 mm"),
    (ARM, ("offset: 78", "offset: 78.637"), None),
    (
        ARM,
        ("length: 80, offset: 78", "length: 3000, offset: 2950"),
        "no offset serves: give a smaller swing, or",
    ),
    (ARM, ("return: 30", "return: 31"), "S jumps from 0 to 1 deg at 0 degrees; let the motion end where it begins"),
    (RIB_ON_ARM, ("distance: 36", "distance: 500"), "or a smaller distance"),
    (RIB_ON_ARM, ("offset: 78", "offset: 0"), "give 77.3077 mm"),
    (RIB_ON_ARM, ("offset: 78", "offset: 77.3077"), None),
    (CONE, ("at: 44", "at: 1"), "of the cone is no less than that; give at more than 10 mm, or a smaller roller"),
    (CONE, ("at: 44", "at: 10.5"), None),
    (
        GROOVE,
        ("radius: 10,", "radius: 10, taper: 60, at: 10,"),
        "of the cone is no less than that; give a smaller taper, or a smaller roller",
    ),
    (
        ASLANT,
        ("over: 60,", "over: 60,"),
        "cam.motion: the arm takes its roller back faster than the floor turns, near 3",
    ),
    (RIB_ON_ARM, ("distance: 36", "distance: 20"), "give more than 20 mm, and the rib's thickness"),
    (CONE, ("{groove: {depth: 12.5}}", "{rib: {depth: 12.5, distance: 22}}"), "give more than 22.7272727 mm, and"),
    (
        ARM,
        ("{groove: {depth: 12.5}}", "{end: bottom}"),
        None,
    ),
    (ARM, ("export:", "limits: {velocity: {at_most: 9}}\nexport:"), "velocity needs cam.drive.rpm; give that"),
    (GROOVE, ("export:", "limits: {off-radius: {at_most: 9}}\nexport:"), "off-radius needs an arm; give that"),
    (GROOVE, ("export:", "limits: {axial-thrust: {at_most: 9}}\nexport:"), "needs cam.drive.load and a taper"),
    (GROOVE, ("[stl]", "[svg]"), "svg is not made yet of a cylindrical cam; give stl, 3mf, ply or step"),
    (GROOVE, ("export:", "manufacture: {cutter: 20}\nexport:"), "manufacture: not made yet; leave it out"),
    (GROOVE, ("bore: 24", "flat: 20, bore: 24"), "part.flat: unknown key; the keys here are"),
    (GROOVE, ("bore: 24", "hub: {diameter: 30}, bore: 24"), "part.hub: unknown key"),
    (GROOVE, ("bore: 24", "chamfer: 1, bore: 24"), "part.chamfer: unknown key"),
    (GROOVE, ("bore: 24, ", ""), "part.keyway: needs part.bore: a keyway is cut into a bore; give part.bore"),
    (GROOVE, ("from: 38", "from: 37.5"), "the roller's end stands on the floor, given 37.5 mm; give more than 37.5 mm"),
    (GROOVE, ("from: 38", "from: 37.6"), None),
    (GROOVE, ("from: 38", "from: 40, to: 39"), "the roller bears nowhere; let it bear between 37.5 mm and 50 mm"),
    (GROOVE, ("depth: 12.5", "depth: 41"), "give less than 40 mm, or a smaller roller"),
    (GROOVE, ("depth: 12.5", "depth: 12.5, clearance: 30"), "of the floor, given 30 mm; give less than 27.5 mm"),
    (RIB, ("distance: 50", "distance: 20"), "give more than 20 mm, and the rib's thickness"),
    (TOP, (", from: 38", ""), "cam.follower.from: missing, needed with an end face"),
    (TOP, ("from: 38", "from: 9"), "give more than 10.5 mm, or a smaller roller"),
    (TOP, ("length: 80", "length: 20"), "give more than 50 mm, or less than 10 mm"),
    (TOP, ("length: 80", "length: 9"), None),
    (BOTTOM, ("pitch_height: 20", "pitch_height: -20"), "give more than -10 mm"),
    (GROOVE, ("{groove: {depth: 12.5}}", "{groove: {depth: 9}, end: top}"), "cam.track"),
    (GROOVE, ("{dwell: 60}", "{dwell: 61}"), "a track of several turns has cam.turns"),
    (GROOVE, (", {dwell: 60}]", "]"), "let them cover the whole turn, 360 degrees"),
    (GROOVE, ("return: 40", "return: 39"), "the motion does not join"),
    (GROOVE, ("[stl]", "[{dxf: {at: [36]}}]"), "no flank there, given 36 mm; give one from 37.5 mm to 50 mm"),
    (GROOVE, ("[stl]", "[{dxf: {at: [50]}}]"), None),
    (
        GROOVE,
        ("[stl]", "[{dxf: {at: [outr, pitch]}}]"),
        "at[0]: not a number, given 'outr'; give a length above 0 in mm, outer for the blank, or pitch for the path",
    ),
    (GROOVE, ("[stl]", "[{dxf: {at: [outer, 40, 40]}}]"), "the same radius twice"),
    (GROOVE, ("[stl]", "[{csv: {as: flank, step: 1e-9}}]"), "step: below 0.001, given 1e-9; give an angle from 0.001"),
    (GROOVE, ("[stl]", "[{csv: {as: flank, step: 0.001}}]"), None),
    (GROOVE, ("[stl]", "[{dxf: {as: arcs}}]"), "give development"),
    (GROOVE, ("export:", "limits: {velocity: {at_most: 9}}\nexport:"), "velocity needs cam.drive.rpm; give that"),
    (GROOVE, ("export:", "limits: {rib-thickness: {at_least: 9}}\nexport:"), "rib-thickness needs a rib"),
    (GROOVE, ("export:", "limits: {undercut-radius: {at_most: 9}}\nexport:"), "needs undercut: shorten"),
    (UNDERCUT, ("export:", "limits: {mating-radius: {at_least: 9}}\nexport:"), "needs undercut: refuse"),
    (GROOVE, ("  motion", "  drive: {material: steel}\n  motion"), "cannot stand without load; give load beside it"),
    (GROOVE, ("part:", "linkage: {kind: four-bar}\npart:"), "a cylindrical cam takes no linkage; leave it out"),
    (REFUSE, ("radius: 40", "radius: 40"), "the lower flank is undercut from the floor out to 29.338"),
    (
        UNDERCUT,
        ("over: 60, law: cycloidal}, {dwell: 120}", "over: 9, law: cycloidal}, {dwell: 171}"),
        "reach into one another",
    ),
    (GROOVE, ("radius: 10", "radius: 100"), "the radius of the roller; give a smaller roller, or a larger blank"),
    (TOP, ("radius: 10", "radius: 49.9"), "the radius of the roller; give a smaller roller, or a larger blank"),
]


@pytest.mark.thin(2)
@pytest.mark.parametrize(("text", "change", "wanted"), REFUSED, ids=lambda item: "" if item == GROOVE else None)
def test_a_fault_names_its_remedy(text: str, change: tuple[str, str], wanted: str | None) -> None:
    """A row without words is a neighbour that is taken."""
    text = changed(text, change)
    if wanted is None:
        design_of(text)
        return
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    assert wanted in str(error.value)
    assert re.match(r"drum\.yaml:\d+:\d+: ", str(error.value))


ON_ARM = ("radius: 12", "radius: 12, arm: {length: 50, offset: 49.5, pivot: 32}")
BESIDE_A_RADIUS = ("radius: 12", "radius: 12, offset: -4")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("follower", "sharp"),
    [
        (("radius: 12", "radius: 12"), ["radius", "depth"]),
        (ON_ARM, ["radius", "depth"]),
        # a shallower groove has a cone nearer the blank, and thinner
        (("radius: 12", "radius: 12, taper: axis"), ["radius"]),
        (BESIDE_A_RADIUS, ["radius", "depth"]),
    ],
    ids=["cylinder", "arm", "cone", "beside a radius"],
)
def test_remedies_of_an_undercut_hold(follower: tuple[str, str], sharp: list[str]) -> None:
    """A smaller roller, a shallower groove and a shortened contact each give a drum; a bit less of either does not."""
    text = changed(REFUSE, follower)
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    found = dict(zip(("radius", "depth"), re.findall(r"at most ([\d.]+) mm", str(error.value)), strict=True))
    assert "or let contact begin farther out: undercut: shorten" in str(error.value)
    for key, old in (("radius", "radius: 12"), ("depth", "depth: 20")):
        design_of(changed(text, (old, f"{key}: {found[key]}")))
        if key in sharp:
            with pytest.raises(RecipeErrors):
                design_of(changed(text, (old, f"{key}: {1.003 * float(found[key])}")))
    design_of(changed(text, ("refuse", "shorten")))


@pytest.mark.parametrize("follower", [ON_ARM, BESIDE_A_RADIUS], ids=["arm", "beside a radius"])
def test_an_undercut_is_told_soon(follower: tuple[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the roller touches a cylinder is sought at the ends of its line, and its size where it is too large."""
    sought, looked = [], []
    reached, regularity = Flank.reached, Flank.regularity
    monkeypatch.setattr(Flank, "reached", lambda *given: sought.append(1) or reached(*given))
    monkeypatch.setattr(Flank, "regularity", lambda *given: looked.append(given[2].size) or regularity(*given))
    with pytest.raises(RecipeErrors, match="undercut from the floor"):
        design_of(changed(REFUSE, follower))
    assert len(sought) < 200
    assert sum(looked) < 4_000_000


@pytest.mark.parametrize("word", ["barrel", "drum"])
def test_other_words_for_the_kind(word: str, tmp_path: Path) -> None:
    path = tmp_path / "it.yaml"
    path.write_text(changed(GROOVE, ("kind: cylindrical", f"kind: {word}")), "utf-8")
    with pytest.raises(RecipeErrors) as error:
        camgeo.load(path)
    assert str(error.value).endswith(f"cam.kind: not one of the choices, given '{word}'; give cylindrical")
    with pytest.raises(
        ValueError,
        match="there is cylindrical, cylindrical-rib, cylindrical-end, cylindrical-arm and cylindrical-screw",
    ):
        starter(word)


def test_defaults_and_units() -> None:
    recipe = recipe_of(changed(GROOVE, (", from: 38", "")))
    assert (recipe.floor, recipe.roller.inner, recipe.roller.outer) == (37.5, 38.0, 50.0)
    inches = recipe_of(
        changed("units: inch\n" + GROOVE, ("radius: 50", "radius: 2"), ("depth: 12.5", "depth: 0.5"))
        .replace("radius: 10, from: 38", "radius: 10 mm")
        .replace("pitch_height: 20", "pitch_height: 20 mm")
        .replace("40, over", "40 mm, over")
        .replace("bore: 24", "bore: 24 mm")
        .replace("length: 80", "length: 80 mm")
    )
    assert inches.radius == pytest.approx(50.8)
    assert inches.roller.inner == pytest.approx(0.5 * 76.2 + 0.5)
    assert recipe_of(changed(GROOVE, ("[stl]", "[dxf]"))).export.files[0].as_ == "development"
    assert [request.kind for request in recipe_of(GROOVE[: GROOVE.index("export")]).export.files] == ["stl"]


def test_a_drum_is_no_disc() -> None:
    with pytest.raises(RecipeErrors, match="a cylindrical cam is no disc cam; export, check and verify take it"):
        load_text(GROOVE, "drum.yaml")


def test_of_a_slip_in_the_kind_no_other_key_is_at_fault() -> None:
    words = (("cylindricl", "did you mean cylindrical?"), ("drum", "give cylindrical"))
    for word, instead in (*words, ("barel", "give cylindrical"), ("drums", "give cylindrical")):
        with pytest.raises(RecipeErrors) as told:
            recipe_of(changed(GROOVE, ("kind: cylindrical", f"kind: {word}")))
        (fault,) = told.value.errors
        assert f"cam.kind: not one of the choices, given {word!r}; {instead}" in str(fault)


def test_of_a_kind_that_there_is_not_no_other_key_is_at_fault() -> None:
    with pytest.raises(RecipeErrors) as told:
        load_text(changed(GROOVE, ("kind: cylindrical", "kind: quark")), "drum.yaml")
    (fault,) = told.value.errors
    assert (fault.path, fault.problem, fault.value) == ("cam.kind", "not one of the choices", "'quark'")


def test_a_length_of_0_fails() -> None:
    """What is shown as needed is more than 0, as a line of contact, or a rib, of no length is none."""
    for name in ("contact-length", "rib-thickness"):
        for limit, shown in ((0.0, ">"), (2.0, ">=")):
            assert sign({"name": name, "sense": "at_least", "limit": limit}) == shown
    design = design_of(RIB)
    lengths = [check for check in design_checks(design, figures_of(design)) if check.limit == 0.0]
    assert {check.name for check in lengths} >= {"contact-length", "rib-thickness"}


def test_walls_of_every_track() -> None:
    """What is left beside the track, and round the bore, is a check: the thinnest wall is named."""
    assert min(walls(design_of(GROOVE)))[0] == pytest.approx(10.0)
    groove = {where: wall for wall, where, _ in walls(design_of(GROOVE))}
    assert groove["between the bore and the floor"] == pytest.approx(37.5 - math.hypot(12 + 3.3, 4))
    assert {b: a for a, b, _ in walls(design_of(RIB))}["between the rib and the upper face"] == pytest.approx(
        125 - (40 + 25 + 40 - 10)
    )
    assert min(walls(design_of(BOTTOM)))[0] == pytest.approx(10.0)
    assert {b: a for a, b, _ in walls(design_of(TOP))}["between the flank and the lower face"] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("drum", "thin", "keys"),
    [
        (GROOVE, ("length: 80", "length: 60"), ("length: 60",)),
        (GROOVE, ("pitch_height: 20", "pitch_height: 6"), ("pitch_height: 6", "length: 80")),
        (GROOVE, ("bore: 24", "bore: 76"), ("radius: 50",)),
        (RIB, ("length: 125", "length: 90"), ("length: 90",)),
    ],
)
def test_a_wall_that_is_missing_says_what_makes_it(drum: str, thin: tuple[str, str], keys: tuple[str, ...]) -> None:
    """The remedy is tried: with the keys raised by the amount told, and a little more, the same wall stands."""
    text = changed(drum, thin).replace(", keyway: din6885", "").replace(", from: 38", "")
    failing = wall_check(design_of(text))
    assert not failing.ok
    more = float(failing.detail.partition("by more than ")[2].split()[0]) + 0.01
    assert more == pytest.approx(0.01 - (failing.value or 0.0), abs=1e-4)
    for key in keys:
        name, _, value = key.partition(": ")
        assert name in failing.detail
        text = changed(text, (key, f"{name}: {float(value) + more:.6f}"))
    assert wall_check(design_of(text)).ok


def test_a_rib_that_is_gone_says_what_makes_it() -> None:
    design = design_of(changed(RIB, ("distance: 50", "distance: 22")))
    (rib,) = [each for each in design_checks(design, figures_of(design)) if each.name == "rib-thickness"]
    assert not rib.ok
    assert "give a larger cam.track.rib.distance" in rib.detail


def test_a_roller_beside_the_blank_carries_nothing() -> None:
    """A contact that would begin beyond the blank is told, and what brings it back."""
    text = changed(GROOVE, ("radius: 10, from: 38", "radius: 6, offset: 30, from: 41"))
    for change, carries in ((("offset: 30", "offset: 30"), False), (("offset: 30", "offset: 12"), True)):
        design = design_of(changed(text, change))
        (length,) = [each for each in design_checks(design, figures_of(design)) if each.name == "contact-length"]
        assert length.ok is carries
        assert ("give a smaller offset, or a smaller from" in length.detail) is not carries
