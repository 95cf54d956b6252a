"""Faults of an indexing cam's recipe: each names its line, its field and a change that helps.

Holds: camgeo.capabilities.indexing.reading, camgeo.capabilities.indexing.form_rules,
camgeo.capabilities.indexing.keys,
camgeo.capabilities.indexing.index_recipe, camgeo.capabilities.indexing.soundness,
camgeo.capabilities.indexing.exact, camgeo.capabilities.indexing.pressed.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from capabilities.indexing.made_indexers import (
    BARREL,
    GLOBOID,
    changed,
    design_of,
    recipe_of,
    rollers_of,
    shared_design,
)

import camgeo
from camgeo.recipe.recipe import load_text
from camgeo.recipe.starter import starter
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from pathlib import Path

SMALL = changed(
    BARREL, ("stops: 6, radius: 60, roller: 9", "stops: 6, radius: 25, roller: 4"), ("length: 80", "length: 36")
)
REFUSED = [
    (BARREL, ("radius: 50", "rdius: 50"), "cam.barrel.rdius: unknown key; did you mean radius?"),
    (BARREL, ("  depth", "  globoid: {distance: 90, radius: 49}\n  depth"), "give exactly one of barrel or globoid"),
    (BARREL, ("  barrel: {radius: 50}\n", ""), "cam: needs barrel or globoid; give exactly one of them"),
    (BARREL, ("stops: 6", "stops: 1"), "cam.turret.stops: below 2, given 1; give a whole number from 2 to 60"),
    (
        BARREL,
        (", radius: 60", ""),
        "cam.turret.radius: missing, needed with a barrel; give the distance of the rollers",
    ),
    (GLOBOID, ("stops: 8", "stops: 8, radius: 60"), "cam.turret.radius: does not go with a globoid; leave it out"),
    (GLOBOID, ("stops: 8", "stops: 8, side: leading"), "cam.turret.side: does not go with a globoid; leave it out"),
    (
        BARREL,
        ("roller: 9", "roller: 9, clearance: 0.1, preload: 0.1"),
        "cam.turret.preload: does not go with clearance; leave one of them out",
    ),
    (BARREL, ("roller: 9", "roller: 9, preload: 9"), "given 9 mm; give a few hundredths of a mm, less than 9 mm"),
    (
        BARREL,
        ("rise: 60", "rise: 59"),
        "advances by 59 degrees a turn, not by 60 degrees, 360/6; let the motion end 60",
    ),
    (BARREL, ("rise: 60", "rise: 59.99999"), None),
    (BARREL, ("{dwell: 210}", "{dwell: 200}"), "given 350 degrees; let them cover the whole turn, 360 degrees"),
    (
        BARREL,
        ("cycloidal", "constant-velocity"),
        "cam.motion: the motion does not join: S' jumps from 22.9183 to 0 deg/rad",
    ),
    (
        BARREL,
        ("[{rise: 60, over: 150, law: cycloidal}, {dwell: 210}]", "{formula: '60*t*t/(4*pi*pi)'}"),
        "where one turn follows the other; let the motion begin and end with one velocity, as laws",
    ),
    (BARREL, ("over: 150", "over: least"), "cam.motion[0].over: not a number"),
    (
        BARREL,
        ("roller: 9", "roller: 9, from: 37"),
        "stands on the floor, given 37 mm; give more than 37 mm, or a greater",
    ),
    (BARREL, ("roller: 9", "roller: 9, from: 37.1"), None),
    # a hundredth of the radius of 50, and of the distance of 90
    (
        BARREL,
        ("roller: 9", "roller: 1e-9"),
        "too small beside the cam: it is less than 1 percent of the blank's radius",
    ),
    (BARREL, ("roller: 9", "roller: 0.01"), "given 0.01 mm; give at least 0.5 mm"),
    (BARREL, ("roller: 9", "roller: 0.5"), None),
    (GLOBOID, ("roller: 8", "roller: 0.8"), "percent of the distance of both axes, given 0.8 mm; give at least 0.9 mm"),
    (
        BARREL,
        ("roller: 9", "roller: 9, from: 40, to: 39"),
        "cam.turret.to: the roller bears nowhere; let it bear between 40 mm and 50 mm",
    ),
    # 62.5^2 = 61.98588^2 + 8^2, and 49^2 + 8^2 = 49.64877^2
    (
        GLOBOID,
        ("roller: 8", "roller: 8, to: 62"),
        "the rim of the roller's end stands on the floor, given 62 mm; give less than 61.985 mm, or a greater depth",
    ),
    (GLOBOID, ("roller: 8", "roller: 8, to: 61.985"), None),
    (GLOBOID, ("roller: 8", "roller: 8, to: 48"), "bears nowhere; let it bear between 49 mm and 61.985 mm"),
    # one of both ends is at fault, and the other one stays
    (
        BARREL,
        ("roller: 9", "roller: 9, from: 55, to: 45"),
        "cam.turret.from: the roller bears nowhere; let it bear between 37 mm and 50 mm",
    ),
    (BARREL, ("roller: 9", "roller: 9, from: 40, to: 45"), None),
    (
        GLOBOID,
        ("roller: 8", "roller: 8, from: 61.5"),
        "turret.from: the roller bears nowhere; let it bear between 49 mm",
    ),
    (GLOBOID, ("depth: 13.5", "depth: 1.1"), "cam.depth: the roller bears nowhere; give more than 1.1488 mm"),
    (GLOBOID, ("depth: 13.5", "depth: 1.5"), None),
    (BARREL, ("depth: 13", "depth: 0.4"), "cam.depth: the roller bears nowhere; give more than 0.5 mm"),
    (BARREL, ("depth: 13", "depth: 2"), None),
    (BARREL, ("depth: 13", "depth: 45"), "given 45 mm; give less than 41 mm, or a smaller roller"),
    (
        changed(BARREL, ("radius: 50", "radius: 9"), ("depth: 13", "depth: 2")),
        ("stops", "stops"),
        "give a smaller roller, or a larger blank",
    ),
    (GLOBOID, ("[stl]", "[dxf]"), "export.files[0]: a globoid has no development; give stl, 3mf or ply"),
    (BARREL, ("[stl]", "[{dxf: {at: [20]}}]"), "no flank there, given 20 mm; give one from 37 mm to 50 mm"),
    (BARREL, ("[stl]", "[{dxf: {at: [outer, 37, 50]}}]"), None),
    (BARREL, ("[stl]", "[{dxf: {at: [outr]}}]"), "give a length above 0 in mm, or outer for the blank"),
    (BARREL, ("[stl]", "[{dxf: {at: [40, 40]}}]"), "the same radius twice"),
    (BARREL, ("[stl]", "[step]"), "step is not made yet of an indexing cam; give stl, 3mf or ply"),
    (BARREL, ("[stl]", "[svg]"), "svg is not made yet of an indexing cam; give stl, 3mf or ply"),
    (BARREL, ("[stl]", "[{csv: {step: 1e-9}}]"), "step: below 0.001, given 1e-9; give an angle from 0.001 to 90"),
    (BARREL, ("export:", "limits: {velocity: {at_most: 9}}\nexport:"), "velocity needs cam.drive.rpm; give that"),
    (BARREL, ("export:", "limits: {play: {at_most: 9}}\nexport:"), "play needs cam.turret.clearance; give that"),
    (BARREL, ("export:", "limits: {torque: {at_most: 9}}\nexport:"), "needs cam.drive.load, or rpm and inertia"),
    (BARREL, ("export:", "limits: {contact-pressure: {at_most: 9}}\nexport:"), "needs cam.drive.load and material"),
    (BARREL, ("export:", "limits: {mass: {at_most: 9}}\nexport:"), "mass needs part.density; give that"),
    (BARREL, ("export:", "limits: {rib-thickness: {at_least: 2}}\nexport:"), None),
    (
        BARREL,
        ("  motion", "  drive: {material: steel}\n  motion"),
        "cannot stand without load, or rpm and inertia; give",
    ),
    (BARREL, ("  motion", "  drive: {material: steel, rpm: 9, inertia: 0.1}\n  motion"), None),
    (BARREL, ("  motion", "  drive: {inertia: 0.1}\n  motion"), "cannot stand without rpm; give rpm beside it"),
    (BARREL, ("  motion", "  drive: {load: 9, roller_material: steel}\n  motion"), "give material beside it"),
    (BARREL, ("part:", "linkage: {kind: four-bar}\npart:"), "a cam of kind indexing takes no linkage; leave it out"),
    (BARREL, ("part:", "sweep: {a: 1}\npart:"), "a cam of kind indexing takes no sweep; leave it out"),  # needs: sweep
    (BARREL, ("bore: 24", "hub: {diameter: 30}, bore: 24"), "part.hub: unknown key; the keys here are length, bore"),
    (BARREL, ("bore: 24", "chamfer: 1, bore: 24"), "part.chamfer: unknown key"),
    (BARREL, ("bore: 24, ", ""), "part.keyway: needs part.bore: a keyway is cut into a bore; give part.bore"),
    (BARREL, ("export:", "manufacture: {cutter: 20}\nexport:"), "manufacture: not made yet; leave it out"),
    (BARREL, ("export:", "made: {profile: 0.02}\nexport:"), "made: not made yet; leave it out"),
]


@pytest.mark.thin(2)
@pytest.mark.parametrize(("text", "change", "wanted"), REFUSED, ids=lambda item: "" if item == BARREL else None)
def test_a_fault_names_its_remedy(text: str, change: tuple[str, str], wanted: str | None) -> None:
    """A row without words is a neighbour that is taken."""
    text = changed(text, change)
    if wanted is None:
        design_of(text)
        return
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    assert wanted in str(error.value)
    assert re.match(r"index\.yaml:\d+:\d+: ", str(error.value))


LONG = changed(
    GLOBOID,
    ("{distance: 90, radius: 49}", "{distance: 79.9, radius: 40.5}"),
    ("depth: 13.5", "depth: 7.8"),
    ("stops: 8, roller: 8", "stops: 10, roller: 8.7"),
    ("{rise: 45, over: 120, law: cycloidal}, {dwell: 240}", "{rise: 36, over: 213, law: polynomial-345}, {dwell: 147}"),
    ("length: 60, bore: 20", "length: 79, bore: 8"),
)
TALL = r"turret\.height: .* give one between ([\d.]+) mm"
REMEDIES = [
    # proofs fail where all places looked at are sound: both ask for a little less
    (LONG, ("length: 79", "length: 79.5"), r"end face.*at most ([\d.]+) mm, with", ("length: 79.5", "length: {}"), 1.0),
    (
        changed(GLOBOID, ("240", "320"), ("over: 120", "over: 40")),
        ("roller: 8", "roller: 3.385"),
        r"neither proved nor excluded.*at most ([\d.]+) mm",
        ("roller: 3.385", "roller: {}"),
        1.0,
    ),
    (BARREL, ("roller: 9", "roller: 31"), r"give less than ([\d.]+) mm, or fewer", ("roller: 31", "roller: {}"), 0.3),
    (
        GLOBOID,
        ("roller: 8", "roller: 20"),
        r"give less than ([\d.]+) mm, or fewer",
        ("roller: 20", "roller: {}"),
        0.5,
    ),
    (BARREL, ("length: 80", "length: 90"), r"length of at most ([\d.]+) mm, with", ("length: 90", "length: {}"), 1.0),
    (
        BARREL,
        ("{radius: 50}", "{radius: 50, offset: 5}"),
        r"give one between ([\d.]+) mm",
        ("offset: 5", "offset: {}"),
        2.4,
    ),
    (BARREL, ("length: 80", "length: 110"), r"give less than ([\d.]+) mm, with", ("length: 110", "length: {}"), 0.85),
    (BARREL, ("length: 80", "length: 140"), r"give less than ([\d.]+) mm, with", ("length: 140", "length: {}"), 0.85),
    (BARREL, ("roller: 9", "roller: 9, height: 1e4"), TALL, ("height: 1e4", "height: {}"), 1.1),
    (BARREL, ("roller: 9", "roller: 9, height: -1e4"), TALL, ("height: -1e4", "height: {}"), 1.1),
    (GLOBOID, ("roller: 8", "roller: 8, height: 1e4"), TALL, ("height: 1e4", "height: {}"), 2.0),
    (GLOBOID, ("roller: 8", "roller: 8, height: -40"), TALL, ("height: -40", "height: {}"), 2.0),
    (
        BARREL,
        ("roller: 9", "roller: 9, height: 25"),
        TALL,
        ("height: 25", "height: {}"),
        1.1,
    ),
    (GLOBOID, ("length: 60", "length: 100"), r"give less than ([\d.]+) mm, with", ("length: 100", "length: {}"), 0.9),
    (GLOBOID, ("distance: 90", "distance: 60"), r"give more than ([\d.]+) mm", ("distance: 60", "distance: {}"), 1.2),
    (BARREL, ("roller: 9", "roller: 14"), r"radius of at most ([\d.]+) mm", ("roller: 14", "roller: {}"), 1.0),
    (BARREL, ("cycloidal", "{uniform: {blend: 10}}"), r"radius of at most ([\d.]+)", ("roller: 9", "roller: {}"), 1.0),
    (
        changed(GLOBOID, ("240", "320")),
        ("over: 120", "over: 40"),
        r"radius of at most ([\d.]+) mm",
        ("roller: 8", "roller: {}"),
        1.0,
    ),
]


@pytest.mark.thin(3)
@pytest.mark.costly("a search for a size, and a cam of it")
@pytest.mark.parametrize(("text", "change", "told", "size", "share"), REMEDIES)
def test_remedies_of_a_size_hold(
    text: str, change: tuple[str, str], told: str, size: tuple[str, str], share: float
) -> None:
    """The size that a message names, or one a share of it off where it is but a bound, makes a cam."""
    text = changed(text, change)
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    found = re.search(told, str(error.value))
    assert found is not None, str(error.value)
    design_of(changed(text, (size[0], size[1].format(share * float(found[1])))))


def test_a_step_between_two_angles_of_a_grid() -> None:
    """A step so short that the roller is past the cam from one angle to the next is too fast."""
    text = changed(BARREL, ("over: 150", "over: 0.001"), ("dwell: 210", "dwell: 359.999"), ("length: 80", "length: 30"))
    with pytest.raises(RecipeErrors, match=r"the turret takes a roller past the cam.*give a longer rise"):
        design_of(text)


def test_a_step_between_two_angles_of_a_long_cam() -> None:
    """The motion is at fault, not the length, and a longer rise serves."""
    text = changed(BARREL, ("over: 150", "over: 0.001"), ("dwell: 210", "dwell: 359.999"))
    with pytest.raises(RecipeErrors, match=r"cam\.motion: the turret takes a roller past the cam.*give a longer rise"):
        design_of(text)


@pytest.mark.costly("cams before and after the remedy")
def test_a_roller_that_hardly_reaches_in_is_told_where_to_bear() -> None:
    """What the check names holds it."""

    def failing(place: str) -> list[str]:
        recipe = recipe_of(changed(BARREL, ("roller: 9", f"roller: 9, {place}")))
        return [check.detail for check in camgeo.design(recipe).checks if not check.ok]

    (told,) = failing("from: 49.999")
    assert told.endswith("let it bear from 37.5 to 50 mm, by turret.from and to")
    assert failing("from: 37.5, to: 50") == []


@pytest.mark.thin(2)
@pytest.mark.costly("a search for a size, and a cam of it")
@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("preload: {}", "the lower half of a roller meets the upper"),
        ("clearance: {}", "the upper half of a roller meets"),
    ],
)
def test_halves_of_a_roller_that_meet_the_other_flank(key: str, words: str) -> None:
    """The greatest that is named makes a cam, and by positions the other half stays clear; a third more does not.

    A place of the flank of the smaller roller is looked at at all angles at which it is on the other side of the axis.
    """
    text = changed(BARREL, ("roller: 9", f"roller: 8, {key}"))
    with pytest.raises(RecipeErrors) as error:
        design_of(changed(text, ("{}", "0.8" if key.startswith("clear") else "2")))
    assert words in str(error.value)
    found = re.search(r"give at most ([\d.]+) mm", str(error.value))
    assert found is not None, str(error.value)
    design = design_of(changed(text, ("{}", found[1])))
    small = min(design.flanks.values(), key=lambda each: each.radius)
    rollers, sizes = rollers_of(design, 150.0), vars(design.recipe.form)
    every, clear = np.linspace(-0.5, 3.5, 8001), []
    for start in np.radians(np.arange(0.0, 150.0, 10.0)).tolist():
        row = small.on(np.array([start]), 37.0)
        if not 0.0 < float(row.z[0]) < 80.0:
            continue
        point = np.array([[37.0 * math.cos(row.phi[0]), 37.0 * math.sin(row.phi[0]), row.z[0]]])
        psi = rollers.psi(every)
        across = point[0, 1] * np.cos(every) - point[0, 0] * np.sin(every)
        beside = across - sizes["offset"]
        beta = np.arctan2(point[0, 2] - sizes["height"], -sizes["side"] * beside)
        other = np.sin(beta - psi) * small.side < 0.0
        clear.append(float(rollers.away(point, every)[0][other].min(initial=math.inf)))
    assert len(clear) > 5
    assert min(clear) > design.largest


def test_a_cam_too_short_to_bear_is_told_without_warnings() -> None:
    text = changed(BARREL, ("length: 80", "length: 30"), ("  motion", "  drive: {load: 9, material: steel}\n  motion"))
    failed = [check.name for check in camgeo.design(recipe_of(text)).checks if not check.ok]
    assert failed == ["contact-length"]


@pytest.mark.parametrize("side", ["trailing", "leading"])
def test_rollers_that_meet_the_cam_behind_the_turret(side: str) -> None:
    """A small turret beside a large barrel: a larger one, with its axis farther off by as much, clears it."""
    text = changed(SMALL, ("roller: 4", f"roller: 4, side: {side}"))
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    found = re.search(
        r"on their way back, behind the turret's axis; give ([\d.]+) mm, and a barrel.offset of (-?[\d.]+)",
        str(error.value),
    )
    assert found is not None, str(error.value)
    design_of(changed(text, ("radius: 25", f"radius: {found[1]}"), ("50}", f"50, offset: {found[2]}}}")))


@pytest.mark.costly("a search for a size, and two cams")
def test_a_length_that_does_not_serve_alone_is_not_offered() -> None:
    """Where a shorter cam would be undercut, a longer step alone is."""
    text = changed(BARREL, ("{radius: 50}", "{radius: 50, offset: 32}"))
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    assert str(error.value).endswith("give a longer rise")
    shorter = changed(BARREL, ("over: 150", "over: 90"), ("210", "270"))
    with pytest.raises(RecipeErrors) as error:
        design_of(shorter)
    found = re.search(r"give a longer rise, or a length of at most ([\d.]+) mm", str(error.value))
    assert found is not None
    design_of(changed(shorter, ("length: 80", f"length: {found[1]}")))
    design_of(changed(shorter, ("over: 90", "over: 180"), ("270", "180")))


@pytest.mark.slow
def test_a_size_that_is_named_serves_as_it_is_written() -> None:
    """By samples alone 14.13 mm would serve; with it, the rib is cut away."""
    text = """cam:
  kind: indexing
  barrel: {radius: 34.64276586563071}
  depth: 9.548799739777126
  turret: {stops: 7, radius: 68.66615917090706, roller: 15.77757596501763, side: leading}
  motion: [{rise: 360/7, over: 205.8155660108796, law: modified-sine}, {dwell: 154.1844339891204}]
part: {length: 62.72843093142297, bore: 12}
"""
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    found = re.search(r"give a roller radius of at most ([\d.]+) mm", str(error.value))
    assert found is not None, str(error.value)
    design_of(changed(text, ("15.77757596501763", found[1])))


@pytest.mark.slow
def test_no_roller_is_named_that_is_too_small() -> None:
    """A step of one degree leaves a rib between rollers alone that are too small: a longer one serves."""
    text = changed(
        GLOBOID, ("stops: 8, roller: 8", "stops: 60, roller: 2"), ("rise: 45, over: 120", "rise: 6, over: 1")
    )
    text = changed(text, ("dwell: 240", "dwell: 359"))
    with pytest.raises(RecipeErrors, match=r"leave no rib between them.*; give a longer rise or a smaller depth$"):
        design_of(text)
    design_of(changed(text, ("over: 1,", "over: 300,"), ("dwell: 359", "dwell: 60")))


def test_where_no_smaller_roller_is_looked_into_without_an_error() -> None:
    """A roller that touches no layer, while the greatest one that leaves a rib is sought, does not serve."""
    text = changed(BARREL, ("length: 80", "length: 90"), ("roller: 9", "roller: 29"))
    with pytest.raises(RecipeErrors, match=r"give "):
        design_of(text)


@pytest.mark.slow
def test_rollers_that_leave_no_rib() -> None:
    """Rollers that nearly touch one another cut the rib between them away; the smaller ones named leave one."""
    text = changed(
        GLOBOID,
        ("stops: 8, roller: 8", "stops: 8, roller: 18.5"),
        ("distance: 90", "distance: 120"),
        ("over: 120", "over: 240"),
        ("dwell: 240", "dwell: 120"),
    )
    with pytest.raises(RecipeErrors) as error:
        design_of(text)
    found = re.search(r"roller radius of at most ([\d.]+) mm", str(error.value))
    assert found is not None, str(error.value)
    design_of(changed(text, ("roller: 18.5", f"roller: {found[1]}")))


@pytest.mark.parametrize("word", ["globoidal", "turret", "ferguson"])
def test_other_words_for_the_kind(word: str, tmp_path: Path) -> None:
    path = tmp_path / "it.yaml"
    path.write_text(changed(BARREL, ("kind: indexing", f"kind: {word}")), "utf-8")
    with pytest.raises(RecipeErrors) as error:
        camgeo.load(path)
    assert str(error.value).endswith(f"cam.kind: not one of the choices, given '{word}'; give indexing")
    with pytest.raises(ValueError, match="there is indexing-barrel and indexing-globoid"):
        starter(word)


def test_an_indexing_cam_is_no_disc() -> None:
    with pytest.raises(RecipeErrors, match="a cam of kind indexing is no disc cam; export, check and verify take it"):
        load_text(BARREL, "index.yaml")


def test_defaults_and_units() -> None:
    recipe = recipe_of(BARREL)
    assert (recipe.roller.inner, recipe.roller.outer, recipe.turret.height) == (37.5, 50.0, 40.0)
    assert recipe.start == pytest.approx(-math.pi / 6)
    assert recipe.turret.sizes["offset"] == pytest.approx(60.0 * (1.0 + math.cos(math.pi / 6)) / 2.0)
    assert recipe_of(changed(BARREL, ("roller: 9", "roller: 9, side: leading"))).turret.sizes["offset"] < 0.0
    assert recipe_of(changed(BARREL, ("roller: 9", "roller: 9, preload: 0.01"))).clearance == pytest.approx(-0.01)
    globoid = recipe_of(GLOBOID)
    assert (globoid.roller.inner, globoid.layers) == (49.0, (49.0, 62.5))
    # the rim of its flat end stands half a millimetre off the floor
    assert math.hypot(globoid.roller.outer, 8.0) == pytest.approx(62.0)
    inch = recipe_of(
        "units: inch\n"
        + changed(
            GLOBOID,
            ("distance: 90", "distance: 4"),
            ("radius: 49", "radius: 2"),
            ("depth: 13.5", "depth: 0.5"),
            ("roller: 8", "roller: 8 mm"),
            ("length: 60", "length: 2"),
            ("bore: 20", "bore: 0.5"),
        )
    )
    assert inch.roller.inner == pytest.approx(50.8)
    assert math.hypot(inch.roller.outer, 8.0) == pytest.approx(50.8 + 12.7 - 0.5)


def test_of_a_slip_in_the_kind_no_other_key_is_at_fault() -> None:
    with pytest.raises(RecipeErrors) as told:
        recipe_of(changed(BARREL, ("kind: indexing", "kind: indexng")))
    (fault,) = told.value.errors
    assert "cam.kind: not one of the choices, given 'indexng'; did you mean indexing?" in str(fault)


def test_each_turn_advances_by_a_pitch() -> None:
    """S(theta + 2 pi) = S(theta) + 2 pi/n, with the same derivatives; at a break each side has its own."""
    law = shared_design(BARREL).law
    theta = [0.3, 2.0, 5.0]
    here, later = (law.derivatives([angle + turn for angle in theta], 3) for turn in (0.0, 3.0 * math.tau))
    assert later[0] - here[0] == pytest.approx([math.pi] * 3)
    assert later[1:] == pytest.approx(here[1:], abs=1e-9)
    end = math.radians(150.0)
    third = [float(law.derivatives(end + math.tau, 3, side)[3][0]) for side in (-1, 1)]
    b = math.radians(150.0)
    assert third == pytest.approx([math.pi / 3 * math.tau**2 / b**3, 0.0])
    seam = [float(law.derivatives(math.tau, 3, side)[3][0]) for side in (-1, 1)]
    assert seam == pytest.approx([0.0, third[0]])
    assert law.unrolled.derivatives([1.0 + math.tau], 1)[:, 0] == pytest.approx(
        law.derivatives(1.0 + math.tau, 1)[:, 0]
    )
    mid, rad = law.enclosure([math.tau - 0.1], [math.tau + 0.1], 0)
    assert float(mid[0, 0] - rad[0, 0]) <= math.pi / 3 <= float(mid[0, 0] + rad[0, 0])


def test_a_rest_over_the_end_of_the_turn_is_one() -> None:
    text = changed(
        BARREL,
        (
            "[{rise: 60, over: 150, law: cycloidal}, {dwell: 210}]",
            "[{dwell: 90}, {rise: 60, over: 150, law: cycloidal}, {dwell: 120}]",
        ),
    )
    law = design_of(text).law
    assert law.breaks == pytest.approx([math.radians(90.0), math.radians(240.0)])
    assert len(law.unrolled.functions) == 2 * (law.turns[1] - law.turns[0] + 1) + 1
