"""Bodies that do not belong to a part are named, with size and place, whatever the format and wherever they lie."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.heavy import ezdxf
from support.meshfiles import HEIGHT, binary, in_3mf, ring, text
from support.stepfiles import washer

from kin.contour.arcs import unit
from kin.read.bodies import Sought
from kin.read.errors import ReadError
from kin.read.files import read_bodies, read_drawing, read_solid

T = np.arange(24) * 2.0 * np.pi / 24
PLACES = {
    "far above": ((0.0, 0.0), 20.0, 24.0),
    "above the rim": ((20.0, 0.0), 8.5, 9.0),
    "below": ((0.0, 0.0), -9.0, -1.0),
    "beside": ((60.0, 5.0), 0.0, HEIGHT),
    "beside, higher": ((60.0, 5.0), 1.0, HEIGHT + 1),
    "in the bore": ((0.0, 0.0), 0.0, HEIGHT),
    "in the bore, lower": ((0.0, 0.0), 0.5, 1.5),
    "in the bore, above the middle": ((0.0, 0.0), 5.0, 7.0),
}


def small(place, low, high):
    """Another ring, 4 mm wide, at a place."""
    centre = np.array(place)
    return ring(centre + 2.0 * unit(T), centre + 0.5 * unit(T), low, high)


@pytest.mark.thin(8)
@pytest.mark.parametrize("write", [binary, text, in_3mf])
@pytest.mark.parametrize("heights", [(), (4.0,)])
@pytest.mark.parametrize("name", PLACES)
def test_a_body_beside_the_cam_is_named(tmp_path, name, heights, write):
    (x, y), low, high = PLACES[name]
    path = tmp_path / ("part.3mf" if write is in_3mf else "part.stl")
    write(path, np.concatenate([small((x, y), low, high), ring()]))
    with pytest.raises(ReadError, match="it holds 2 bodies") as caught:
        read_solid(path, heights)
    message = caught.value.message
    size = re.search(
        r"there is body \d of ([\d.]+) x ([\d.]+) x ([\d.]+) mm at x (\S+) to \S+, y \S+ to \S+, z (\S+)", message
    )
    assert [float(v) for v in size.groups()] == pytest.approx([4.0, 4.0, high - low, x - 2.0, low], abs=0.01)
    assert "take out what does not belong" in message


def test_many_bodies_and_bodies_that_touch(tmp_path):
    many = [small((60.0 + 6.0 * k, 0.0), 0.0, 2.0) for k in range(30)]
    with pytest.raises(ReadError, match=r"it holds 31 bodies.*, and 26 more"):
        read_solid(binary(tmp_path / "many.stl", np.concatenate([ring(), *many])))
    # a hub that stands on the disc as a shell of its own hangs together with it, as a printer sees it
    hub = ring(8.0 * unit(T), 6.0 * unit(T), HEIGHT, 14.0)
    solid = read_solid(binary(tmp_path / "hub.stl", np.concatenate([ring(), hub])))
    assert (solid.z_max, solid.faces) == (14.0, (0.0, 8.0, 14.0))


def test_a_void_between_heights_that_are_asked_for(tmp_path):
    """An open mesh is no body, and its sections may be empty all the same."""
    open_below = ring(low=20.0, high=28.0)[4:]
    path = binary(tmp_path / "open.stl", np.concatenate([ring()[4:], open_below]))
    for heights in ((), (14.0,)):
        with pytest.raises(ReadError, match=r"nothing is at z = 14|open"):
            read_solid(path, heights)


def test_two_solids_in_a_step_file(tmp_path):
    one, other = washer(), washer(3.0, 1.0, 2.0, at=(40.0, 7.0))
    first = one.index("DATA;") + 5
    lines = other[other.index("DATA;") + 5 : other.index("#900=")]
    moved = re.sub(r"#(\d+)", lambda m: m[0] if int(m[1]) >= 900 else f"#{int(m[1]) + 2000}", lines)
    path = tmp_path / "two.step"
    path.write_text(one[:first] + "\n" + moved + one[first:])
    with pytest.raises(
        ReadError, match=r"beside solid #\d+ there is solid #2\d+ of 6 x 6 x 2 mm at x 37 to 43, y 4 to 10"
    ):
        read_solid(path)


@pytest.mark.parametrize("kind", ["dxf", "svg"])
@pytest.mark.parametrize(("x", "word"), [(40.0, "does not lie inside the largest one"), (0.0, "lies inside a hole")])
def test_an_outline_that_does_not_belong(tmp_path, kind, x, word):
    path = tmp_path / f"cam.{kind}"
    circles = [(0.0, 20.0), (0.0, 8.0), (x, 2.0)]
    if kind == "dxf":
        document = ezdxf.new(units=4)
        for centre, radius in circles:
            document.modelspace().add_circle((centre, 0.0), radius)
        document.saveas(path)
    else:
        drawn = "".join(f'<circle cx="{centre}" r="{radius}"/>' for centre, radius in circles)
        head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="-50 -50 100 100">'
        path.write_text(f"{head}{drawn}</svg>")
    with pytest.raises(ReadError, match=rf"the closed contour at \({x + 2:g}, .*\) {word}; it is 4 x 4 mm"):
        read_drawing(path)


def test_the_order_of_triangles_does_not_matter(tmp_path):
    solid = np.concatenate([ring(), small((60.0, 0.0), 0.0, 1.0)])
    rng = np.random.default_rng(1)
    with pytest.raises(ReadError, match="it holds 2 bodies"):
        read_solid(binary(tmp_path / "shuffled.stl", solid[rng.permutation(len(solid))]))


@pytest.mark.parametrize("write", [binary, in_3mf])
@pytest.mark.parametrize("stepped", [False, True])
def test_a_height_beyond_a_single_part_is_refused_in_mm_whether_it_is_a_prism_or_not(tmp_path, stepped, write):
    """A plain prism once had no such section, without a word, and its other sections had heights of the first ones."""
    path = tmp_path / ("part.3mf" if write is in_3mf else "part.stl")
    hub = [ring(8.0 * unit(T), 6.0 * unit(T), HEIGHT, 14.0)] if stepped else []
    write(path, np.concatenate([ring(), *hub]))
    high = 14.0 if stepped else HEIGHT
    with pytest.raises(ReadError, match=rf"reaches from z = 0 to {high:g} mm: it has no section at -30") as caught:
        read_solid(path, [-30.0, 5.0])
    assert caught.value.reason == "height"
    assert ("--units" in caught.value.message) == (write is binary)
    if write is binary:
        with pytest.raises(ReadError, match=rf"to {25.4 * high:g} mm: .* -30; .* in one of 25.4 mm"):
            read_solid(path, [-30.0, 50.0, 60.0], 25.4)
        solid = read_solid(path, [50.0, 60.0], 25.4)
        assert [cut.height for cut in solid.sections] == [50.0, 60.0]
        assert solid.section(60.0) is solid.sections[1]
    with pytest.raises(ValueError, match="no section was taken at z = 3 mm"):
        read_solid(path, [5.0]).section(3.0)


def test_sections_of_one_of_several_bodies_have_the_heights_at_which_they_are(tmp_path):
    path = in_3mf(tmp_path / "two.3mf", ring(), ring(low=20.0, high=30.0))
    low, high = read_bodies(path, [Sought((-3.0, 5.0)), Sought((0.7, -0.1, 0.3))], [0.0, 20.0])
    assert [cut.height for cut in low.sections] == [5.0]
    assert [cut.height for cut in high.sections] == [0.7, 0.3]
