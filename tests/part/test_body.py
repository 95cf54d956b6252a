"""Parts from recipes: what places itself, the least walls with the names of their edges, and what is refused.

Holds: camgeo.part.checks, camgeo.part.dowel, camgeo.part.feature, camgeo.part.largest_holes, camgeo.part.lightening,
camgeo.part.mark.
"""

import math
import re

import numpy as np
import pytest
from support.parts import CAM, found, recipe_of

from camgeo.part.body import body_of
from camgeo.part.walls import Looks
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.expected_checks import foreseen
from kin.numeric.check import as_drawn


def opening(design, name):
    return next(one for one in design.discs[0].body.openings if one.name == name)


# --- what is placed -------------------------------------------------------------------------------------------------


def test_a_ring_of_holes_is_as_large_as_the_wall_lets_it():
    cam = "cam: {kind: support, p: 25 + 0*t}\n"
    design, checks = found(recipe_of("{bore: 10, lightening: {ring: 4, wall: 2}}", cam=cam))
    # between bore and rim 20 mm are left, 16 of them for holes of radius 8 about 15 mm from the shaft; 4 of those
    # would stand 15 sqrt 2 apart, 5.2 mm between them
    holes = [one.circle for one in design.discs[0].body.openings if one.name != "bore"]
    assert [radius for _, radius in holes] == [8.0] * 4
    assert holes[0][0] == pytest.approx((15.0, 0.0))
    assert checks["lightening"].value == 4
    assert "4 of 4 holes, 16 to 16 mm across, 2 mm from every edge" in checks["lightening"].detail


def test_a_crowded_ring_is_limited_by_its_neighbours():
    cam = "cam: {kind: support, p: 25 + 0*t}\n"
    design, checks = found(recipe_of("{bore: 10, lightening: {ring: 12, wall: 2, least: 1}, wall: 2}", cam=cam))
    (x, y), radius = design.discs[0].body.openings[1].circle
    # R sin 15 deg - 1 = r = 23 - R
    ring = 24.0 / (1.0 + math.sin(math.pi / 12))
    assert math.hypot(x, y) == pytest.approx(ring, abs=0.06)
    assert radius == pytest.approx(ring * math.sin(math.pi / 12) - 1.0, abs=0.06)
    assert checks["wall"].ok


@pytest.mark.slow
def test_the_largest_holes_shrink_from_one_to_the_next():
    design, checks = found(recipe_of("{bore: 12, lightening: {largest: 4, wall: 2}, wall: 2}"))
    sizes = [one.circle[1] for one in design.discs[0].body.openings if one.name.startswith("lightening")]
    assert len(sizes) == 4
    assert sizes == sorted(sizes, reverse=True)
    assert checks["wall"].ok
    # the first is the largest circle beside the bore: no place on a fine grid has 0.1 mm more room
    contour = design.only_surface.contour.sample(np.linspace(0, 2 * math.pi, 4000, endpoint=False)).point
    x, y = np.meshgrid(np.arange(-30, 30, 0.25), np.arange(-30, 30, 0.25))
    grid = np.column_stack([x.ravel(), y.ravel()])
    from shapely import Polygon, contains_xy

    grid = grid[contains_xy(Polygon(contour), grid[:, 0], grid[:, 1])]
    rim = np.array([np.hypot(*(contour - point).T).min() for point in grid])
    room = np.minimum(rim, np.hypot(*grid.T) - 6.0) - 2.0
    assert sizes[0] >= room.max() - 0.06


def test_no_room_for_a_hole_is_told():
    design, checks = found(recipe_of("{bore: 12, lightening: {largest: 3, wall: 8}}"))
    assert not checks["lightening"].ok
    assert checks["lightening"].detail.startswith("0 of 3 holes")
    assert design.only_surface.contour is None


def test_the_mark_lies_on_the_ray_at_zero_as_far_out_as_the_wall_lets_it():
    design, checks = found(recipe_of("{bore: 10, mark: {as: cut, width: 1, length: 3}, wall: 1.5}"))
    x_min, y_min, x_max, y_max = opening(design, "mark").outline.box()
    assert (y_min, y_max) == pytest.approx((-0.5, 0.5))
    assert x_max - x_min == pytest.approx(3.0)
    assert checks["wall"].ok
    farther, checks = found(
        recipe_of(f"{{bore: 10, mark: {{as: cut, width: 1, length: 3, radius: {x_max + 0.02}}}, wall: 1.5}}")
    )
    assert not checks["wall"].ok
    assert checks["wall"].detail.startswith("mark and contour: 1.4")
    assert farther.only_surface.contour is None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "tight"),
    [("mark: {width: 60}", True), ("mark: {width: 30, length: 40}, chamfer: 1", True), ("mark: {width: 4}", False),
     ("mark: {width: 9, radius: 20}", False), ("mark: {as: cut}, wall: 60", True)],
)  # fmt: skip
def test_a_mark_without_room_fails_with_what_would_have_some(part, tight):
    def marked(text):
        return found(recipe_of(f"{{thickness: 8, {text}}}", cam="cam: {kind: support, p: 25 + 2*cos(3*t)}\n"))

    design, checks = marked(part)
    assert not checks["mark"].ok
    assert design.only_surface.contour is None
    size, wall = re.search(r"long; (?:(\{.*\}) has|a part\.wall of (.*) leaves some)$", checks["mark"].detail).groups()

    def mended(share):
        values = re.sub(r"[\d.]+", lambda number: f"{share * float(number[0]):.9g}", size or wall)
        return re.sub(*(("mark: {.*?}", f"mark: {values}") if size else ("wall: 60", f"wall: {values}")), part)

    design, checks = marked(mended(1.0))
    assert "mark" not in checks
    assert checks["wall"].ok
    assert opening(design, "mark")
    if tight:  # a hundredth more has no room
        assert not marked(mended(1.01))[1]["mark"].ok


def test_a_mark_where_the_ray_meets_no_metal_is_left_out():
    _, checks = found(recipe_of("{thickness: 8, mark: {}}", cam="cam: {kind: support, p: 25, shaft: [60, 0]}\n"))
    assert checks["mark"].detail.endswith("; no other has any, leave it out")


# --- walls ----------------------------------------------------------------------------------------------------------


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("part", "told"),
    [
        ("{bore: 12, bolts: {count: 4, circle: 17, hole: 6}}", "bore and bolt hole 1: -0.5 mm at ("),
        ("{bore: 12, bolts: {count: 4, circle: 46, hole: 6}}", "bolt hole 1 and contour: "),
        ("{bore: 12, dowel: {circle: 30, hole: 4}, mark: {as: cut, radius: 16}}", "dowel hole and mark: "),
        ("{bore: 12, keyway: {width: 4, depth: 8}, dowel: {circle: 30, hole: 4}}", "bore and dowel hole: "),
        ("{bore: 12, thickness: 8, hub: {diameter: 45, height: 5}}", "hub and contour: "),
        ("{thickness: 8, hub: {diameter: 24, height: 5}, dowel: {circle: 24, hole: 4}}", "dowel hole and hub: "),
        ("{bore: {square: 30}, thickness: 8, hub: {diameter: 36, height: 5}}", "bore and hub: "),
        ("{bore: 50}", "bore and contour: "),
    ],
)  # fmt: skip
def test_a_clash_is_named_with_its_place(part, told):
    design, checks = found(recipe_of(part))
    if part == "{bore: 50}":  # the plain part keeps its short form
        assert not checks["wall"].ok
        assert checks["wall"].at_deg is not None
        return
    wall = checks["wall"]
    assert not wall.ok
    assert wall.value <= 0.0
    assert told in wall.detail
    assert design.only_surface.contour is None


def test_a_wall_that_is_asked_for_is_kept_or_refused_at_its_edge():
    part = "{{bore: 12, dowel: {{circle: 26, hole: 4}}, wall: {}}}"
    _, checks = found(recipe_of(part.format(4.999)))
    assert (checks["wall"].value, checks["wall"].limit) == pytest.approx((5.0, 4.999))
    assert checks["wall"].ok
    _, checks = found(recipe_of(part.format(5.001)))
    assert not checks["wall"].ok
    assert "bore and dowel hole: 5 mm at (" in checks["wall"].detail


@pytest.mark.thin(4)
@pytest.mark.parametrize(("count", "told"), [(6, ""), (7, "; and 1 more pair"), (8, "; and 2 more pairs")])
def test_walls_that_are_too_thin_are_named_and_the_others_counted(count, told):
    _, checks = found(recipe_of(f"{{bore: 12, bolts: {{count: {count}, circle: 12, hole: 1}}}}"))
    assert checks["wall"].detail.count("bore and bolt hole") == 6
    assert checks["wall"].detail.rpartition(")")[2] == told


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("screw", "told"),
    [
        ("diameter: 4.8", "set screw and the disc's face: 0.1 mm"),
        ("diameter: 3, height: 1", "set screw and the disc's face: -0.5 mm"),
        ("diameter: 3, height: 4", "set screw and the hub's face: -0.5 mm"),
        ("diameter: 3, at: 90}, dowel: {circle: 17, hole: 1.5, at: 90", "set screw and dowel hole: -1.5 mm at ("),
    ],
)
def test_walls_of_the_set_screw(screw, told):
    part = f"{{thickness: 8, bore: 12, hub: {{diameter: 22, height: 5}}, set_screw: {{{screw}}}, wall: 0.5}}"
    _, checks = found(recipe_of(part))
    assert told in checks["wall"].detail


def test_a_chamfer_takes_from_the_walls_and_needs_a_blunt_contour():
    part = "{thickness: 8, bore: 12, dowel: {circle: 36, hole: 4, at: 100}CHAMFER}"
    _, plain = found(recipe_of(part.replace("CHAMFER", "")))
    _, chamfered = found(recipe_of(part.replace("CHAMFER", ", chamfer: 0.75")))
    assert chamfered["wall"].value == pytest.approx(plain["wall"].value - 0.75, abs=1e-9)
    assert "chamfer" in chamfered["wall"].detail
    sharp = "cam: {kind: support, reuleaux: {sides: 3, breadth: 50, rounding: 1}}\n"
    design, checks = found(recipe_of("{thickness: 8, bore: 12, chamfer: 1.25}", cam=sharp))
    assert (checks["chamfer"].value, checks["chamfer"].limit) == pytest.approx((1.0, 1.25))
    assert not checks["chamfer"].ok
    assert design.only_surface.contour is None
    trimmed = "cam: {kind: support, p: 25 + 3.3*cos(3*t), undercut: trim}\n"
    _, checks = found(recipe_of("{thickness: 8, bore: 12, chamfer: 0.5}", cam=trimmed))
    assert "a trimmed contour has corners" in checks["chamfer"].detail


def test_rotation_mirrors_the_part_and_leaves_its_walls():
    part = "{bore: 12, keyway: {standard: din6885, at: 30}, bolts: {count: 3, circle: 32, hole: 4, start: 10}}"
    one, checks = found(recipe_of(part))
    other, mirrored = found(recipe_of(part, more="rotation: ccw\n"))
    assert checks["wall"].detail.endswith("mm at (21.13, 6.165)")
    assert as_drawn(checks["wall"], mirrored=True) == mirrored["wall"]
    for a, b in zip(one.discs[0].body.mirrored().openings, other.discs[0].body.mirrored().openings, strict=True):
        assert np.array_equal(a.outline.points, b.outline.points)


def test_inches_and_millimetres_make_the_same_part():
    inch = "cam: {kind: support, p: (25 + 2*cos(3*t))/25.4, shaft: [3/254, 2/254]}\n".replace("3/254", "15/127")
    cam = inch.replace("2/254", "10/127")
    part = "{bore: 60/127, mark: {width: 5/254, length: 20/127}, bolts: {count: 3, circle: 160/127, hole: 20/127}}"
    _, inches = found(recipe_of(part, cam=cam, more="units: inch\n"))
    _, checks = found(recipe_of("{bore: 12, mark: {width: 0.5, length: 4}, bolts: {count: 3, circle: 32, hole: 4}}"))
    assert inches["wall"].value == pytest.approx(checks["wall"].value, abs=1e-9)


def test_foreseen_checks_are_those_that_are_made():
    for part in (
        "{thickness: 8, bore: 12, keyway: din6885, hub: {diameter: 24, height: 6}, chamfer: 0.4, mark: {}}",
        "{bore: 12, bolts: {count: 3, circle: 32, hole: 4}, lightening: {largest: 2, wall: 2}}",
        "{thickness: 8, hub: {diameter: 24, height: 6}}",
        "{thickness: 8, chamfer: 0.4}",
    ):
        recipe = recipe_of(part)
        design, _ = found(recipe)
        names = [one.name for one in foreseen(recipe) if one.file is None]
        assert sorted(names) == sorted(check.name for check in design.checks)


# --- what a recipe is refused for -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("part", "told"),
    [
        ("{keyway: din6885}", "part.keyway: needs part.bore: a keyway is cut into a bore"),
        ("{bore: 5, keyway: din6885}", "part.keyway: no key of DIN 6885 for this bore, given 5 mm"),
        ("{bore: {hexagon: 10}, keyway: din6885}", "part.keyway: needs a round bore"),
        ("{bore: {hexagon: 10, square: 10}}", "part.bore.hexagon: cannot be combined with square"),
        ("{bore: 10, keyway: {width: 10, depth: 1}}", "part.keyway.width: not below the bore's diameter, given 10 mm"),
        ("{bore: 10, keyway: {width: 3}}", "part.keyway.depth: missing, needed with width"),
        ("{bore: 10, keyway: din6886}", "part.keyway: unknown keyway, given 'din6886'"),
        ("{bore: 10, keyway: din6885, flat: {across: 9}}", "part.flat: cannot be combined with keyway"),
        ("{bore: 10, flat: {across: 10}}", "part.flat.across: not below the bore's diameter, given 10 mm"),
        ("{bore: 10, flat: {across: 5}}", "part.flat.across: not above half the bore, given 5 mm"),
        ("{bore: 10, hub: {diameter: 20, height: 5}}", "part.hub: needs part.thickness: a hub stands on the disc"),
        ("{thickness: 8, bore: 10, hub: {diameter: 10, height: 5}}", "part.hub.diameter: not above the bore"),
        ("{thickness: 8, bore: 10, set_screw: {diameter: 3}}", "part.set_screw: needs part.hub"),
        (
            "{thickness: 8, bore: 10, hub: {diameter: 20, height: 3}, set_screw: {diameter: 3}}",
            "part.set_screw.diameter: not below the hub's height, given 3 mm; give less than 3 mm",
        ),
        (
            "{thickness: 8, bore: {square: 9}, hub: {diameter: 30, height: 20}, set_screw: {diameter: 9}}",
            "part.set_screw.diameter: not below the bore's width, given 9 mm; give less than 9 mm",
        ),
        ("{thickness: 8, chamfer: 4}", "part.chamfer: not below half the thickness, given 4 mm; give less than 4 mm"),
        ("{thickness: 0.3, mark: {depth: 0.4}}", "part.mark.depth: not below the thickness"),
        ("{mark: {as: cut, depth: 1}}", "part.mark.depth: a mark that is cut through has no depth"),
        ("{bolts: {count: 6, circle: 10, hole: 5}}", "part.bolts.hole: not below the distance between two of them"),
        ("{lightening: {wall: 2}}", "part.lightening: needs ring or largest"),
        ("{lightening: {wall: 2, largest: 3, start: 5}}", "part.lightening.start: needs a ring"),
    ],
)
def test_what_cannot_be(part, told):
    with pytest.raises(RecipeErrors) as caught:
        recipe_of(part, cam=CAM)
    assert any(told in line for line in str(caught.value).splitlines()), str(caught.value)


def test_a_body_needs_no_thickness_for_a_drawing():
    design, _ = found(recipe_of("{thickness: 8, bore: {hexagon: 12, at: 30}}"))
    looks = Looks.of(design.only_surface.contour)
    body = body_of(recipe_of("{thickness: 8, bore: {hexagon: 12, at: 30}}").part, looks)
    assert body.prism
    assert (body.bottom, body.top) == (0.0, 8.0)
