"""Files that are judged together: the disc of each by its name, and sets of files of one cam."""

from pathlib import Path

import camgeo
from camgeo.output.sets import sets_of

PAIR = camgeo.load("""
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9}
  conjugate: {distance: 120, radius: 11, gap: 2}
  motion: [{rise: 24, over: 110, law: modified-sine}, {dwell: 50}, {return: 24, over: 120, law: cycloidal}, {dwell: 80}]
part: {thickness: 12, bore: 20}
export: {tolerance: 0.01, files: [dxf, {stl: {tolerance: 0.05}}]}
""")


def sets(*names, tolerance=None):
    return [
        (each.requirement.kind, each.requirement.tolerance, [(place, disc) for place, _, disc in each.files])
        for each in sets_of(PAIR, [Path(name) for name in names], tolerance)
    ]


def test_a_name_says_its_disc():
    assert sets("recipe-2.dxf", "recipe-1.dxf") == [("dxf", 0.01, [(0, 1), (1, 0)])]


def test_others_take_the_discs_in_their_order():
    assert sets("front.dxf", "back.dxf") == [("dxf", 0.01, [(0, 0), (1, 1)])]


def test_kinds_and_their_tolerances_are_kept_apart():
    assert sets("recipe-1.stl", "recipe-1.dxf") == [("stl", 0.05, [(0, 0)]), ("dxf", 0.01, [(1, 0)])]
    assert [tolerance for _, tolerance, _ in sets("recipe-1.stl", "recipe-1.dxf", tolerance=0.2)] == [0.2, 0.2]
