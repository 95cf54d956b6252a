"""Faults of a linear cam's recipe: each names its line, its field and a change that helps.

Holds: camgeo.capabilities.linear.reading, camgeo.capabilities.linear.keys, camgeo.capabilities.linear.sizing,
camgeo.schema.lists.
"""

from __future__ import annotations

import math
import re

import pytest
from capabilities.linear.plates import CAM, ENDLESS, GROOVE, MOTION, ON_ARM, PLATE, changed, design_of, recipe_of

from camgeo.capabilities.linear.figures import figures_of
from camgeo.schema.errors import RecipeErrors

REFUSED = [
    (PLATE, ("kind: roller", "kind: flat"), "a flat face on a stem can only be a wedge"),
    (PLATE, ("base: 32", "bse: 32"), "cam.bse: unknown key; did you mean base?"),
    (PLATE, ("radius: 8", "lean: 8"), "cam.follower.radius: missing; give the radius of the roller"),
    (PLATE, ("kind: roller", "kind: knife-edge"), "a knife edge has no radius"),
    (PLATE, ("radius: 8", "radius: 8, arm: {length: 60, pivot: 150}"), "give a pivot between -20 and 100 mm"),
    (PLATE, ("radius: 8", "radius: 8, lean: 5, arm: {length: 60, pivot: 50}"), "an arm has no lean"),
    (PLATE, ("  ends: {overrun: 6}\n", ""), "cam.ends: missing; give ends: {overrun: 5}"),
    (PLATE, ("overrun: 6", "overrun: [6, 6, 6]"), "give one length, or two: [start, end]"),
    (PLATE, ("overrun: 6", "overrun: [6, 0]"), "cam.ends.overrun[1]: not above 0"),
    (PLATE, (f"motion: {MOTION}", f"motion: {{repeat: 2, segments: {MOTION}}}"), "only an endless motion repeats"),
    (ENDLESS, ("  endless", "  ends: {overrun: 3}\n  endless"), "an endless plate has none"),
    (
        ENDLESS,
        ("  endless", "  drive: {crank: {radius: 20, rod: 60, rpm: 9}}\n  endless"),
        "does not drive an endless plate",
    ),
    (ENDLESS, ("part:", "  track: {groove: {clearance: 0}}\npart:"), "runs out of its plate at both edges"),
    (PLATE, ("  ends", "  track: {groove: {clearance: 0.1}}\n  ends"), "part.height: missing, needed with cam.track"),
    (PLATE, ("thickness: 12", "thickness: 12, height: 90"), "belongs to a plate with a groove"),
    (GROOVE, ("kind: roller", "kind: shoe"), "does not run in a groove"),
    (GROOVE, ("depth: 6", "depth: 12"), "not below the thickness"),
    (
        PLATE,
        ("  ends", "  drive: {forth: 3, crank: {radius: 60, rod: 99, rpm: 9}}\n  ends"),
        "cannot be combined with crank",
    ),
    (PLATE, ("  ends", "  drive: {crank: {radius: 60, rod: 59, rpm: 9}}\n  ends"), "give a longer rod"),
    (PLATE, ("  ends", "  drive: {back: 3}\n  ends"), "cannot stand without forth"),
    (PLATE, ("  ends", "  drive: {material: steel}\n  ends"), "cannot stand without load"),
    (PLATE, ("thickness: 12", "thickness: 12, chamfer: 6"), "give less than 6 mm"),
    (PLATE, ("thickness: 12", "thickness: 12, slots: [{at: [9, 9], length: 5, width: 5}]"), "not below its length"),
    (PLATE, ("thickness: 12", "thickness: 12, bore: 5"), "part.bore: unknown key"),
    (PLATE, ("part:", "linkage: {kind: four-bar}\npart:"), "a linear cam takes no linkage; leave it out"),
    (PLATE, ("part:", "limits: {velocity: {at_most: 9}}\npart:"), "velocity needs cam.drive with a speed or a crank"),
    (PLATE, ("part:", "limits: {play: {}}\npart:"), "play needs a groove"),
    (PLATE, ("{thickness: 12}", "{}"), None),
    (PLATE, ("[dxf]", "[{stl: {}}]"), None),
    (changed(PLATE, ("{thickness: 12}", "{}")), ("[dxf]", "[stl]"), "stl needs a thickness"),
    (
        PLATE,
        ("over: 40, law: polynomial-345", "over: 40, law: constant-velocity"),
        "S' jumps from 0 to -0.5 mm/mm at 80 mm",
    ),
    (
        PLATE,
        ("  ends", "  drive: {crank: {radius: 50, rod: 99, rpm: 9}}\n  ends"),
        "give 60 mm, or motion over twice the radius",
    ),
    (ON_ARM, ("rise: 24", "rise: 114"), "the arm swings to 94 degrees from the travel"),
    (PLATE, ("  ends: {overrun: 6}", "  ends: {overrun: 6, as: dwell}"), None),
    (
        PLATE,
        (f"{{overrun: 6}}\n  motion: {MOTION}", "{overrun: 6, as: dwell}\n  motion: {formula: x/4, over: 40}"),
        "cannot stay where it is beyond it; give tangent",
    ),
]


LOW = changed(PLATE, ("base: 32", "base: 0.001"))


@pytest.mark.parametrize("text", [LOW, changed(GROOVE, ("base: 32", "base: 0.001"))], ids=["plate", "groove"])
def test_a_plate_is_higher_than_its_files_may_be_off(text: str) -> None:
    with pytest.raises(RecipeErrors) as errors:
        design_of(text)
    told = "cam.base: the plate is 0.001 mm high where its contour is lowest, and the tolerance 0.001; give at least "
    assert str(errors.value).startswith(f"plate.yaml:3:9: {told}")
    (least,) = re.search(r"give at least ([\d.]+) mm$", str(errors.value)).groups()
    design_of(changed(text, ("base: 0.001", f"base: {least}")))


def test_the_travel_at_which_a_knife_edge_on_an_arm_has_its_way() -> None:
    text = changed(ON_ARM, ("kind: roller, radius: 8, arm: {length: 60", "kind: knife-edge, arm: {length: 60"))
    text = re.sub(r"(rise|return): 24", r"\1: 60", text).replace("over: 60", "over: 6").replace("over: 50", "over: 5")
    with pytest.raises(RecipeErrors) as errors:
        design_of(text)
    told = str(errors.value)
    assert "the path of what the arm leads turns by half a turn and meets itself" in told
    assert "roller" not in told
    (longer,) = re.search(r"lengthen the motion ([\d.]+) times", told).groups()
    for by, serves in ((float(longer), True), (0.99 * float(longer), False)):

        def scaled(found: re.Match[str], by: float = by) -> str:
            return f"{found[1]}: {float(found[2]) * by}"

        stretched = re.sub(r"(over|dwell): (\d+)", scaled, text)
        if serves:
            design_of(stretched)
        else:
            with pytest.raises(RecipeErrors, match="turns by half a turn"):
                design_of(stretched)


@pytest.mark.parametrize(("text", "change", "wanted"), REFUSED, ids=lambda item: "" if item == PLATE else None)
def test_a_fault_names_its_remedy(text: str, change: tuple[str, str], wanted: str | None) -> None:
    """A row without words is a neighbour that is taken."""
    text = changed(text, change)
    if wanted is None:
        design_of(text)
        return
    with pytest.raises(RecipeErrors) as errors:
        design_of(text)
    assert wanted in str(errors.value)


def test_an_undercut_names_the_roller_and_the_travel_that_serve() -> None:
    text = changed(PLATE, ("radius: 8", "radius: 18"))
    with pytest.raises(RecipeErrors) as errors:
        design_of(text)
    told = str(errors.value)
    assert told.startswith("plate.yaml:4:36: cam.follower.radius: the flank undercuts at the crest near 86.4236 mm")
    radius, longer = re.search(r"at most ([\d.]+) mm, or lengthen the motion ([\d.]+) times", told).groups()
    design_of(changed(text, ("radius: 18", f"radius: {radius}")))
    lengths = {name: float(name) * float(longer) for name in ("10", "50", "40")}
    longer_motion = re.sub(r"(over|dwell): (\d+)", lambda m: f"{m[1]}: {float(m[2]) * float(longer)}", text)
    assert lengths
    design_of(longer_motion)
    design_of(changed(text, ("  ends", "  undercut: trim\n  ends")))


@pytest.mark.parametrize(("lean", "most"), [(0, 30), (10, 30), (-12, 40)])
def test_the_travel_is_found(lean: int, most: int) -> None:
    """On a stem L = Cv h/(cos g tan a - sin g) with g = -lean, of the return with + sin g; the greater of the two."""
    text = changed(
        PLATE,
        ("radius: 8", f"radius: 2, lean: {lean}"),
        ("  ends", f"  sizing: {{pressure-angle: {{at_most: {most}}}}}\n  ends"),
    )
    g, a = math.radians(-lean), math.radians(most)
    rise = 2.0 * 20.0 / (math.cos(g) * math.tan(a) - math.sin(g)) / 50.0
    fall = 1.875 * 20.0 / (math.cos(g) * math.tan(a) + math.sin(g)) / 40.0
    design = design_of(text)
    assert design.total == pytest.approx(120.0 * max(rise, fall), rel=1e-12)
    assert figures_of(design)[0].value == pytest.approx(most, rel=1e-12)


def test_the_travel_of_an_arm_is_found() -> None:
    design = design_of(changed(ON_ARM, ("  ends", "  sizing: {pressure-angle: {at_most: 40}}\n  ends")))
    assert figures_of(design)[0].value == pytest.approx(40.0, abs=1e-9)
    with pytest.raises(RecipeErrors, match="the arm itself leans more"):
        design_of(changed(ON_ARM, ("  ends", "  sizing: {pressure-angle: {at_most: 15}}\n  ends")))


def test_lengths_are_in_the_recipes_unit() -> None:
    inch = recipe_of(
        "units: inch\n" + changed(PLATE, ("base: 32", "base: 1.25"), ("overrun: 6", "overrun: [0.5, 3 mm]"))
    )
    assert (inch.base, inch.ends.overrun) == (31.75, (12.7, 3.0))
    assert inch.motion.covered == pytest.approx(120 * 25.4)
    wave = recipe_of(changed(CAM, (MOTION, "{formula: x/4, over: 2 in}")))
    assert wave.motion.covered == pytest.approx(50.8)


def test_an_undercut_of_a_travel_that_is_found_asks_for_another_angle() -> None:
    text = changed(PLATE, ("  ends", "  sizing: {pressure-angle: {at_most: 80}}\n  ends"))
    with pytest.raises(RecipeErrors, match="or a smaller angle under sizing"):
        design_of(text)
    design_of(changed(text, ("at_most: 80", "at_most: 35")))
