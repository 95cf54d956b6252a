"""Plates, grooves, endless plates: what is right is accepted however it is saved, every planted fault is refused.

Holds: kin.linear.verdict.
"""

import math

import ezdxf
import numpy as np
import pytest
from capabilities.linear.kin.contours import (
    OVERRUN,
    arcs,
    closed,
    endless,
    groove,
    intent,
    on_arm,
    on_stem,
    polygon,
    top_of,
)
from support.cases import few
from support.programmes import Segment, law, programme

from kin.contour.contour import Contour
from kin.contour.holes import Hole, round_hole
from kin.linear.follower import Stem
from kin.linear.intent import Ends, Groove, PlateIntent
from kin.linear.judge import judge_chains, verify
from kin.linear.outline import Flank
from kin.linear.undercut import cuts
from kin.numeric.limits import Limits
from kin.numeric.records import replace
from kin.read.nesting import ClosedContour

LIMITS = Limits(1e-3)
HOLE = round_hole("hole", "holes", (30.0, 12.0), 6.6)
FOLLOWERS = {"upright": on_stem(), "lean": on_stem(lean=20.0), "arm": on_arm(1)}
RECTANGLE = ((-30.0, 0.0), (150.0, 0.0), (150.0, 80.0), (-30.0, 80.0))
GROOVED = PlateIntent(
    on_stem(), Ends((OVERRUN, OVERRUN)), groove=Groove(0.05), outline=Hole("outline", "outer", RECTANGLE, (0.0,) * 4)
)
BLANK = Contour.from_vertices(np.array(RECTANGLE))


def judged(contours, plate, limits=LIMITS):
    """Verdict on closed contours, the outermost first."""
    return judge_chains([ClosedContour(contour) for contour in contours], plate, limits)


def faults(*contours, plate=None, limits=LIMITS):
    """Names of the checks that fail."""
    verdict = judged(contours, intent(FOLLOWERS["upright"]) if plate is None else plate, limits)
    return {check.name for check in verdict.checks if not check.ok}


def through_points(contour, within):
    """The contour as a polygon through points of its arcs, within a distance of them."""
    pieces, _ = contour.as_arcs()
    bent = np.abs(pieces.curvature) > 0.0
    step = np.sqrt(8.0 * within / np.maximum(np.abs(pieces.curvature), 1e-9))
    parts = np.where(bent, np.ceil(pieces.length / step), 1.0).astype(np.intp)
    return Contour.from_vertices(pieces.cut(np.maximum(parts, 1))[0].start)


def halved(contour):
    """Every piece in two."""
    pieces, _ = contour.as_arcs()
    parts, _ = pieces.cut(np.full(len(pieces), 2))
    bulges = np.tan(0.25 * parts.curvature * parts.length)
    return Contour.from_bulges(parts.start, bulges)


SAVED = {
    "as made": lambda contour: contour,
    "run backwards": lambda contour: contour.reversed(),
    "from another start": lambda contour: Contour.from_pieces(contour.take(np.roll(np.arange(len(contour)), -57))),
    "lines split": halved,
    "arcs as chords": lambda contour: through_points(contour, 2e-4),
    "rounded to a micron's tenth": lambda contour: Contour.from_vertices(
        np.round(through_points(contour, 1e-4).vertices, 4)
    ),
}


@pytest.mark.parametrize("name", few(SAVED, 3))
def test_the_plate_is_accepted_however_it_is_saved(name):
    for follower in FOLLOWERS.values() if name == "as made" else [FOLLOWERS["upright"]]:
        assert faults(SAVED[name](arcs(follower)), plate=intent(follower)) == set()


def vertex(ends, bulges):
    ends[80, 1] += 0.003
    return ends, bulges


def bulge(ends, bulges):
    bulges[80] += 0.02
    return ends, bulges


def cut_short(ends, bulges):
    ends[0, 0] += 0.5
    return ends, bulges


def lift_as_flank():
    u = np.linspace(0.0, 120.0, 2001)
    lift = FOLLOWERS["upright"].law.derivatives(u[1:-1], 0)[0]
    return np.stack(
        [np.concatenate([[-6.0], u, [126.0]]), 32.0 + np.concatenate([[0.0, 0.0], lift, [0.0, 0.0]])], axis=-1
    )


def notched(depth):
    top = top_of(FOLLOWERS["upright"], np.linspace(0.0, 120.0, 2401))
    edge = 1130
    middle = 0.5 * (top[edge] + top[edge + 1])
    way = (top[edge + 1] - top[edge]) / np.hypot(*(top[edge + 1] - top[edge]))
    new = [middle - 0.001 * way, middle - depth * np.array([-way[1], way[0]]), middle + 0.001 * way]
    return closed(np.concatenate([top[: edge + 1], new, top[edge + 1 :]]))


def lowered():
    contour = arcs(FOLLOWERS["upright"])
    points = contour.start.copy()
    bottom = points[:, 1] == 0.0
    points[bottom, 1] -= 0.01
    return Contour.from_bulges(points, np.tan(0.25 * contour.sweep))


PLANTED = {
    "a vertex moved": (lambda: arcs(FOLLOWERS["upright"], spoil=vertex), {"contour", "motion"}),
    "a bulge changed": (lambda: arcs(FOLLOWERS["upright"], spoil=bulge), {"contour", "motion"}),
    "mirrored": (lambda: arcs(FOLLOWERS["upright"]).mirrored().turned(math.pi), {"contour", "motion", "ends"}),
    "scaled by 1.001": (lambda: arcs(FOLLOWERS["upright"]).scaled(1.001), {"contour", "motion", "ends"}),
    "tilted by 0.05 degrees": (lambda: arcs(FOLLOWERS["upright"]).turned(math.radians(0.05)), {"contour", "motion"}),
    "shifted along": (lambda: arcs(FOLLOWERS["upright"]).moved(0.01, 0.0), {"contour", "motion", "ends"}),
    "shifted up": (lambda: arcs(FOLLOWERS["upright"]).moved(0.0, 0.01), {"contour", "motion"}),
    "cut short": (lambda: arcs(FOLLOWERS["upright"], spoil=cut_short), {"contour", "ends"}),
    "for another roller": (lambda: arcs(on_stem(radius=9.0, level=41.0)), {"contour", "motion"}),
    "the lift as the flank": (lambda: closed(lift_as_flank()), {"contour", "motion"}),
    "a notch": (lambda: notched(0.01), {"contour"}),
    "a bump": (lambda: notched(-0.01), {"contour", "motion"}),
    "an edge too low": (lowered, {"contour"}),
}


@pytest.mark.parametrize("name", few(PLANTED, 3))
def test_a_planted_fault_is_refused(name):
    made, expected = PLANTED[name]
    found = faults(made())
    assert expected <= found, name
    if name in {"a notch", "cut short", "an edge too low"}:
        assert "motion" not in found  # contact alone does not feel them


def test_a_small_fault_within_the_tolerance_is_none():
    assert faults(arcs(FOLLOWERS["upright"]).moved(0.0004, 0.0)) == set()
    assert faults(arcs(FOLLOWERS["upright"]).moved(0.0004, 0.0), limits=Limits(3e-4)) >= {"contour"}
    wide = Limits(0.02, motion=1e-4)
    assert faults(arcs(FOLLOWERS["upright"]).moved(0.001, 0.0), limits=wide) == {"motion"}


def test_holes_stand_where_they_should():
    plate = intent(FOLLOWERS["upright"], holes=(HOLE,))
    outline = arcs(FOLLOWERS["upright"])
    assert faults(outline, HOLE.contour, plate=plate) == set()
    assert faults(outline, HOLE.contour.moved(0.002, 0.0), plate=plate) == {"holes"}
    assert faults(outline, plate=plate) == {"holes"}
    assert faults(outline, HOLE.contour, HOLE.contour.moved(20.0, 0.0), plate=plate) == {"holes"}
    assert faults(outline, HOLE.contour) == {"holes"}


@pytest.mark.costly("a plate, and a verdict of each of its faults")
def test_a_groove_and_its_faults():
    chain = groove(on_stem(), count=800)
    assert faults(BLANK, chain, plate=GROOVED) == set()
    assert faults(BLANK, chain.reversed(), plate=GROOVED) == set()
    verdict = judged([BLANK, chain], GROOVED)
    assert [flank.name for flank in verdict.flanks] == ["lower", "upper"]
    assert verdict.play.least == pytest.approx(0.05, abs=1e-3)
    other = groove(on_stem(radius=8.01), count=800)
    found = faults(BLANK, other, plate=GROOVED)
    assert {"contour", "motion", "form-closure"} <= found
    tight = groove(on_stem(), clearance=0.0, count=800)
    assert {"contour", "motion", "form-closure"} <= faults(BLANK, tight, plate=GROOVED)
    assert "ends" in faults(BLANK, groove(on_stem(), count=800, beyond=3.0), plate=GROOVED)
    assert faults(BLANK.moved(0.01, 0.0), chain, plate=GROOVED) == {"outer"}
    assert {"contour", "motion"} <= faults(BLANK, chain.moved(0.01, 0.0), plate=GROOVED)


@pytest.mark.slow
def test_an_endless_plate_and_its_faults():
    follower = endless()
    plate, contour = intent(follower), polygon(follower, 600)
    assert faults(contour, plate=plate) == set()
    assert {"contour", "motion"} <= faults(contour.moved(0.01, 0.0), plate=plate)
    assert {"contour"} <= faults(polygon(follower, 600), plate=replace(plate, periods=1))
    assert {"contour", "motion"} <= faults(polygon(endless(Stem(0.01)), 600), plate=plate)


@pytest.mark.costly("a plate, and a verdict of each of its faults")
def test_an_undercut_flank_is_judged_against_what_is_given():
    follower = on_stem(radius=30.0, level=62.0)
    plate = intent(follower, trimmed=True)
    flank = polygon_of_trimmed(follower)
    verdict = judged([flank], plate)
    assert [check.name for check in verdict.checks if not check.ok] == []
    assert "motion" not in {check.name for check in verdict.checks}
    assert -verdict.flanks[0].motion.least == pytest.approx(0.757847, abs=2e-3)
    assert faults(flank, plate=plate, limits=Limits(1e-3, motion=0.5)) == {"motion"}


def polygon_of_trimmed(follower):
    """Plate through the envelope of all rollers, without the parts that its corners leave out."""
    ends = Ends((OVERRUN, OVERRUN))
    u = np.linspace(0.0, 120.0, 1001)
    parts = cuts(follower, beyond=ends.overrun)
    kept = np.all([(u < cut.begin) | (u > cut.end) for cut in parts], axis=0)
    top = np.concatenate([top_of(follower, u)[1:-1][kept], [cut.corner for cut in parts]])
    top = top[np.argsort(top[:, 0])]
    return closed(np.concatenate([[[-OVERRUN, top[0, 1]]], top, [[120.0 + OVERRUN, top[-1, 1]]]]))


# --- files ------------------------------------------------------------------------------------------------------------


def drawn(path, contours, *, layers=None, unit=4):
    """Write closed polylines, each on its layer; `unit` is $INSUNITS."""
    drawing = ezdxf.new("R2010", units=unit)
    for number, contour in enumerate(contours):
        points = [(x, y, b) for (x, y), b in zip(contour.start.tolist(), np.tan(0.25 * contour.sweep), strict=True)]
        layer = "0" if layers is None else layers[number]
        drawing.modelspace().add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": layer})
    drawing.saveas(path)
    return path


def failing(verdict):
    return {check.name for check in verdict.checks if not check.ok}


def test_a_drawing_from_disk(tmp_path):
    plate = intent(FOLLOWERS["upright"], holes=(HOLE,))
    outline = arcs(FOLLOWERS["upright"])
    verdict = verify(drawn(tmp_path / "a.dxf", [outline, HOLE.contour]), plate, LIMITS)
    assert failing(verdict) == set()
    assert verdict.kind == "dxf"
    assert {check.file for check in verdict.checks} == {"a.dxf"}
    assert verdict.flanks[0].motion.max < 1e-3
    # mirrored for a plate that travels to the right, holes too
    turned = [contour.mirrored().turned(math.pi) for contour in (outline, HOLE.contour)]
    right = drawn(tmp_path / "right.dxf", turned)
    assert failing(verify(right, replace(plate, mirrored=True), LIMITS)) == set()
    assert {"contour", "motion", "holes"} <= failing(verify(right, plate, LIMITS))


def test_units_of_a_drawing(tmp_path):
    plate, outline = intent(FOLLOWERS["upright"]), arcs(FOLLOWERS["upright"])
    inches = drawn(tmp_path / "inch.dxf", [outline.scaled(1.0 / 25.4)], unit=1)
    assert failing(verify(inches, plate, LIMITS)) == set()
    unstated = drawn(tmp_path / "none.dxf", [outline], unit=0)
    assert failing(verify(unstated, plate, LIMITS)) == {"units"}
    assert failing(verify(unstated, plate, LIMITS, 1.0)) == set()
    assert "units" in failing(verify(drawn(tmp_path / "wrong.dxf", [outline], unit=1), plate, LIMITS))


def test_a_groove_in_a_drawing(tmp_path):
    chain = groove(on_stem(), count=800)
    path = drawn(tmp_path / "groove.dxf", [BLANK, chain], layers=["CUT", "GROOVE_INNER"])
    assert failing(verify(path, GROOVED, LIMITS)) == set()
    missing = verify(drawn(tmp_path / "blank.dxf", [BLANK], layers=["CUT"]), GROOVED, LIMITS)
    assert [(check.name, check.detail) for check in missing.checks] == [
        ("readable", "the groove is missing, in which its follower runs")
    ]
    assert faults(BLANK, plate=GROOVED) == {"readable"}


def test_what_cannot_be_read_is_told(tmp_path):
    path = tmp_path / "open.dxf"
    drawing = ezdxf.new(units=4)
    drawing.modelspace().add_line((0.0, 0.0), (10.0, 0.0))
    drawing.saveas(path)
    verdict = verify(path, intent(FOLLOWERS["upright"]), LIMITS)
    assert [(check.name, check.ok) for check in verdict.checks] == [("closed", False)]
    (tmp_path / "a.csv").write_text("1,2\n")
    refused = verify(tmp_path / "a.csv", intent(FOLLOWERS["upright"]), LIMITS)
    assert "drawings and solids" in refused.checks[0].detail
    with pytest.raises(ValueError, match="none of"):
        verify(tmp_path / "a.pdf", intent(FOLLOWERS["upright"]), LIMITS)


def prism(path, top, thickness):
    """Write an STL of the plate below an upper edge (n, 2), from left to right, cut into upright strips."""
    low = np.stack([top[:, 0], np.zeros(len(top))], axis=-1)
    ring = np.concatenate([low, top[::-1]])
    count, faces = len(top), []
    for i in range(count - 1):
        a, b, c, d = low[i], low[i + 1], top[i + 1], top[i]
        for corners in ((a, b, c), (a, c, d)):
            faces.append([[*corner, thickness] for corner in corners])
            faces.append([[*corner, 0.0] for corner in corners[::-1]])
    for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        faces.append([[*start, 0.0], [*end, 0.0], [*end, thickness]])
        faces.append([[*start, 0.0], [*end, thickness], [*start, thickness]])
    record = np.zeros(len(faces), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    record["v"] = np.array(faces)
    path.write_bytes(bytes(80) + np.uint32(len(faces)).tobytes() + record.tobytes())
    return path


def test_a_solid_from_disk(tmp_path):
    plate = intent(FOLLOWERS["upright"], thickness=12.0)
    top = top_of(FOLLOWERS["upright"], np.linspace(0.0, 120.0, 481))
    verdict = verify(prism(tmp_path / "a.stl", top, 12.0), plate, LIMITS)
    assert failing(verdict) == set()
    assert {"watertight", "thickness", "contour", "motion", "ends"} <= {check.name for check in verdict.checks}
    assert failing(verify(tmp_path / "a.stl", replace(plate, thickness=12.1), LIMITS)) == {"thickness"}
    larger = prism(tmp_path / "b.stl", 1.001 * top, 12.0)
    assert {"contour", "motion"} <= failing(verify(larger, plate, LIMITS))
    cut = tmp_path / "c.stl"
    cut.write_bytes((tmp_path / "a.stl").read_bytes()[:-50])
    assert [(check.name, check.ok) for check in verify(cut, plate, LIMITS).checks] == [("readable", False)]


def test_a_flank_that_goes_on_as_a_dwell_ends_in_an_arc_of_the_roller():
    """The motion begins on the rise: before it the roller stays, and its own arc leads down to the level."""
    motion = programme([Segment("rise", 100.0, 12.0, law("constant-velocity"))], 100.0).motion
    follower = on_stem(radius=10.0, level=30.0, motion=motion)
    contact = top_of(follower, np.array([0.0, 100.0]))[1:]
    arc = math.atan(0.12) - np.linspace(math.atan(0.12), 0.0, 40)
    foot = np.stack([10.0 * np.sin(arc), 30.0 - 10.0 * np.cos(arc)], axis=-1)
    beyond = contact[-1] + 5.0 * np.array([1.0, 0.12])
    top = np.concatenate([[[contact[0, 0] - 9.0, 20.0]], foot, [beyond]])
    plate = PlateIntent(follower, Ends((9.0, 5.0), tangent=False))
    exact = Flank(follower, plate.ends)
    np.testing.assert_allclose(exact.corners[0], top[0], atol=1e-12)
    level = replace(plate, ends=Ends((9.0, 5.0)))
    assert Flank(follower, level.ends).corners[0, 1] == pytest.approx(contact[0, 1] - 9.0 * 0.12, abs=1e-12)
    # as a dwell, but for the end of the rise, where that would cut the flank
    found = faults(closed(top), plate=plate, limits=Limits(1e-3))
    assert "motion" not in found
    near = exact.pitch.feet(foot)
    np.testing.assert_allclose(near.excess, 0.0, atol=1e-12)
