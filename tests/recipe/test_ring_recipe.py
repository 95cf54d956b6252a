"""What a recipe of a ring must have and cannot have: one line each, and remedies that do."""

import pytest

from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

RING = (
    "cam:\n  kind: disc\n  base_radius: 36\n  follower: {{kind: roller, radius: 9}}\n{}"
    "  motion: [{{rise: 12, over: 110, law: cycloidal}}, {{dwell: 60}}, {{return: 12, over: 110, law: cycloidal}}, "
    "{{dwell: 80}}]\n"
)
INTERNAL = RING.format("  track: internal\n")
OUTER = "part: {thickness: 8, outer: 130}\n"


def faults(text):
    with pytest.raises(RecipeErrors) as caught:
        load_text(text, "ring.yaml")
    return [(error.path, error.problem) for error in caught.value.errors]


def test_a_ring_and_its_outline_need_each_other():
    assert faults(INTERNAL) == [("cam.track", "a ring needs part.outer, the diameter of its outline")]
    assert faults(RING.format("") + OUTER) == [("part.outer", "belongs to a ring or a groove")]
    assert faults("cam: {kind: support, p: 30}\n" + OUTER) == [("part.outer", "belongs to a ring or a groove")]
    assert load_text(INTERNAL + OUTER, "ring.yaml").part.outer == 130.0
    assert load_text(RING.format("") + OUTER.replace(", outer: 130", ""), "ring.yaml").part.outer is None


def test_a_fault_of_the_cam_is_not_told_twice():
    assert [path for path, _ in faults(RING.format("  track: inner\n") + OUTER)] == ["cam.track"]


@pytest.mark.parametrize(
    "feature",
    [
        "bore: 10",
        "hub: {diameter: 20, height: 5}",
        "lightening: {ring: 3, wall: 2}",
        "chamfer: 0.5",
        "mark: {as: cut}",
    ],
)
def test_what_belongs_to_a_disc_is_refused(feature):
    name = feature.partition(":")[0]
    text = INTERNAL + OUTER.replace("outer", f"{feature}, outer")
    assert faults(text) == [(f"part.{name}", "belongs to a disc on a shaft, not to a ring")]


# needs: mechanism
def test_files_that_are_not_made_of_a_ring():
    assert faults(INTERNAL + OUTER + "export: {files: [{stl: {parts: all}}]}\n") == [
        ("export.files[0]", "the bodies round a ring are not made")
    ]


# needs: milling
def test_a_program_for_a_ring_needs_what_any_program_needs():
    milling = "manufacture: {cutter: 6, layer: true, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 1e-9}\n"
    assert faults(INTERNAL + OUTER + "export: {files: [gcode]}\n" + milling) == [
        ("manufacture", "gcode needs safe_height"),
        ("manufacture.depth_of_cut", "too little for a program"),
    ]
    sound = milling.replace("1e-9", "2, safe_height: 5")
    assert load_text(INTERNAL + OUTER + "export: {files: [gcode, dxf]}\n" + sound, "ring.yaml").manufacture.layer


def test_a_ring_is_sized_by_its_pressure_angle_alone():
    """The roller touches where the metal is hollow: convex places of the pitch curve say nothing of the metal's."""
    said = "sizing: {pressure-angle: {at_most: 25}, radius-of-curvature: {at_least: 3}}"
    text = INTERNAL.replace("base_radius: 36", said) + OUTER.replace("130", "300")
    assert faults(text) == [("cam.sizing.radius-of-curvature", "does not size a ring")]
    alone = load_text(text.replace(", radius-of-curvature: {at_least: 3}", ""), "ring.yaml")
    assert all(check.ok for check in designed(alone).checks)


def test_a_face_that_swings_to_its_pivot_is_a_fault_of_its_arm():
    text = (
        "cam: {kind: disc, base_radius: 40, follower: {kind: flat, arm: {pivot: 45}}, motion: [{rise: 40, over: 180, "
    )
    text += "law: cycloidal}, {return: 40, over: 180, law: cycloidal}]}"
    with pytest.raises(RecipeErrors, match=r"cam.yaml:1:.*cam.follower.arm: the face swings from 62.734 to 102.734"):
        designed(load_text(text, "cam.yaml"))
    designed(load_text(text.replace("rise: 40", "rise: 20").replace("return: 40", "return: 20"), "cam.yaml"))
