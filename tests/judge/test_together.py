"""Discs on one shaft in several files, or one above the other in one: each is judged, and what is left between them.

An inner flank stands on disc 1 and an outer one in disc 2, parallels of one pitch curve by numpy alone.
"""

import math

import numpy as np
import pytest
from support import followers
from support.camfiles import arcs_through, circle_points, solid_triangles, write_dxf, write_stl
from support.meshfiles import in_3mf

from kin.follower.guide import Line
from kin.judge.intent import ClosureIntent, Limits, PartIntent, ShaftIntent, SurfaceIntent
from kin.judge.together import DiscFile, verify_set
from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula

ROLLER, BLANK, BORE, THICKNESS, GAP = 9.0, 80.0, 5.0, 10.0, 2.0
LAW = "45 + 4*cos(t) + 1.5*sin(2*t)"
MANY = 800
T = np.arange(MANY) * 2 * math.pi / MANY
LIMITS = Limits(1e-4)


def flank(offset, turned=0.0, mirrored=False):
    """Points (n, 2) of the parallel at an offset, turned by an angle in degrees."""
    r, slope = 45 + 4 * np.cos(T) + 1.5 * np.sin(2 * T), -4 * np.sin(T) + 3 * np.cos(2 * T)
    tangent = (slope + 1j * r) * np.exp(1j * T)
    points = (r * np.exp(1j * T) - 1j * offset * tangent / np.abs(tangent)) * np.exp(1j * math.radians(turned))
    return (
        np.column_stack([points.real, -points.imag])[::-1] if mirrored else np.column_stack([points.real, points.imag])
    )


def shaft():
    law = lift_from_formula(Formula(LAW)).law
    inner = SurfaceIntent(followers.roller(Line(), ROLLER, law), "disc 1")
    outer = SurfaceIntent(followers.roller(Line(), ROLLER, law, side=-1), "disc 2", side=-1)
    parts = (
        PartIntent((inner,), bore=2 * BORE, thickness=THICKNESS, name="disc 1"),
        PartIntent((outer,), outline=2 * BLANK, thickness=THICKNESS, name="disc 2"),
    )
    return ShaftIntent(parts, (0.0, THICKNESS + GAP), (ClosureIntent("disc 1", "disc 2"),))


def drawn(path, points, radius):
    return write_dxf(path, *arcs_through(points), bores=[(0.0, 0.0, radius)])


def first(path, **fault):
    return drawn(path, flank(-ROLLER, **fault), BORE)


def second(path, back=0.0, **fault):
    return drawn(path, flank(ROLLER + back, **fault), BLANK)


def judged(*paths, limits=LIMITS):
    return verify_set([DiscFile(path, k) for k, path in enumerate(paths)], shaft(), 90, limits)


def failures(verdicts):
    return {(check.file, check.surface, check.name) for verdict in verdicts for check in verdict.checks if not check.ok}


def test_two_drawings_and_what_is_left_between_them(tmp_path):
    one, two = judged(first(tmp_path / "a.dxf"), second(tmp_path / "b.dxf"))
    assert not failures([one, two])
    assert not one.closures
    (closure,) = two.closures
    assert (closure.pushes, closure.stops) == ("disc 1", "disc 2")
    assert max(abs(closure.play.least), abs(closure.play.most)) < 1e-6
    (check,) = [check for check in two.checks if check.name == "form-closure"]
    assert check.file == "b.dxf"
    assert check.detail.endswith("with a.dxf")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "caught"),
    [
        ({"turned": 0.02}, {"contour", "motion", "form-closure"}),
        ({"mirrored": True}, {"contour", "motion", "form-closure"}),
        ({"back": 2.5e-4}, {"contour", "motion", "form-closure"}),
    ],
)
def test_faults_of_disc_2_are_caught_in_its_file(tmp_path, fault, caught):
    verdicts = judged(first(tmp_path / "a.dxf"), second(tmp_path / "b.dxf", **fault))
    assert {name for _, _, name in failures(verdicts)} >= caught
    assert {file for file, _, _ in failures(verdicts)} == {"b.dxf"}


@pytest.mark.slow
def test_discs_turned_together_are_off_their_keyway(tmp_path):
    """What is left between them stays nothing: the contours tell, as their angle is the shaft's."""
    verdicts = judged(first(tmp_path / "a.dxf", turned=0.02), second(tmp_path / "b.dxf", turned=0.02))
    found = failures(verdicts)
    assert found >= {("a.dxf", "disc 1", "contour"), ("b.dxf", "disc 2", "contour")}
    assert "form-closure" not in {name for _, _, name in found}


def test_files_swapped(tmp_path):
    assert failures(judged(second(tmp_path / "a.dxf"), first(tmp_path / "b.dxf"))) >= {
        ("a.dxf", "disc 1", "contour"),
        ("b.dxf", "", "outer"),
    }


def test_one_disc_alone(tmp_path):
    (verdict,) = verify_set([DiscFile(second(tmp_path / "b.dxf"), 1)], shaft(), 90, LIMITS)
    assert verdict.ok
    assert "form-closure" not in {check.name for check in verdict.checks}


def test_a_disc_that_cannot_be_read_closes_nothing(tmp_path):
    (tmp_path / "b.dxf").write_text("nothing")
    verdicts = judged(first(tmp_path / "a.dxf"), tmp_path / "b.dxf")
    assert failures(verdicts) == {("b.dxf", "", "readable")}
    assert not verdicts[1].closures


# --- solids -----------------------------------------------------------------------------------------------------------

COARSE = Limits(1e-3)


def bodies(gap=GAP, **fault):
    z = THICKNESS + gap
    one = solid_triangles(flank(-ROLLER), BORE * circle_points(MANY), 0.0, THICKNESS)
    two = solid_triangles(BLANK * circle_points(MANY), flank(ROLLER, **fault), z, z + THICKNESS)
    return one, two


def together(path):
    return verify_set([DiscFile(path, None)], shaft(), 36, COARSE)


def shifted(triangles, by):
    return triangles + np.array(by)


@pytest.mark.slow
def test_two_bodies_in_one_file_stand_in_their_order(tmp_path):
    one, two = bodies()
    (verdict,) = together(in_3mf(tmp_path / "pair.3mf", two, one))
    assert verdict.ok, failures([verdict])
    assert [surface.name for surface in verdict.surfaces] == ["disc 1", "disc 2"]
    assert len(verdict.closures) == 1
    named = [(check.surface, check.name) for check in verdict.checks]
    assert named.count(("disc 1", "watertight")) == named.count(("disc 2", "watertight")) == 1
    assert {("disc 1", "bore"), ("disc 2", "thickness"), ("disc 2", "volume"), ("disc 2", "outer")} <= set(named)
    assert ("", "form-closure") in named


@pytest.mark.slow
def test_where_a_pair_lies_on_the_plate_does_not_count(tmp_path):
    c, s = math.cos(0.3), math.sin(0.3)
    place = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1], [100.1, 20.3, 0.7]])
    (verdict,) = together(in_3mf(tmp_path / "pair.3mf", *bodies(), place=place))
    assert verdict.ok, failures([verdict])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gap", "moved"),
    [
        (GAP + 2e-3, "0.002 mm higher"),
        pytest.param(GAP - 2e-3, "0.002 mm lower", marks=pytest.mark.slow),
        pytest.param(0.0, "2 mm lower", marks=pytest.mark.slow),
    ],
)
def test_another_gap(tmp_path, gap, moved):
    (verdict,) = together(in_3mf(tmp_path / "pair.3mf", *bodies(gap)))
    ((_, surface, name),) = failures([verdict])
    assert (surface, name) == ("disc 2", "thickness")
    detail = next(check.detail for check in verdict.checks if not check.ok)
    assert detail.endswith(f"from z = 12 mm, where disc 2 belongs; disc 2 lies {moved} than it should")


@pytest.mark.slow
def test_a_body_turned_in_its_place(tmp_path):
    (verdict,) = together(in_3mf(tmp_path / "pair.3mf", *bodies(turned=0.1)))
    assert failures([verdict]) >= {("pair.3mf", "disc 2", "contour"), ("pair.3mf", "disc 2", "motion")}


@pytest.mark.thin(2)
@pytest.mark.parametrize(("count", "told"), [(1, "it holds 1 body, where 2 are expected"), (3, "3 objects are built")])
def test_more_or_fewer_bodies(tmp_path, count, told):
    one, two = bodies()
    (verdict,) = together(in_3mf(tmp_path / "pair.3mf", *[one, two, shifted(two, (0, 0, 40))][:count]))
    (check,) = verdict.checks
    assert check.name == "watertight"
    assert check.detail.startswith(told)


def test_each_disc_in_an_stl_of_its_own(tmp_path):
    one, two = bodies()
    paths = [write_stl(tmp_path / "a.stl", one), write_stl(tmp_path / "b.stl", shifted(two, (0, 0, -THICKNESS - GAP)))]
    files = [DiscFile(path, k, 1.0) for k, path in enumerate(paths)]
    verdicts = verify_set(files, shaft(), 36, COARSE)
    assert not failures(verdicts)
    ((closure,),) = [verdict.closures for verdict in verdicts if verdict.closures]
    assert max(abs(closure.play.least), abs(closure.play.most)) < 1e-3
