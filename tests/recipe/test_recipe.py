"""What a recipe comes to: values, units, names, places; and that the shipped recipes are cams.

Holds: camgeo.recipe.cam, camgeo.recipe.machining, camgeo.recipe.starter, camgeo.schema.json_schema.
"""

from __future__ import annotations

import dataclasses
import json
import math
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from support.places import SHIPPED
from support.starters import OF_CAMS

from camgeo.cams.constant_breadth import ConstantBreadthCam
from camgeo.cams.constant_diameter import ConstantDiameterCam
from camgeo.cams.disc_cams import DiscCam
from camgeo.cams.double_roller import DoubleRollerCam
from camgeo.cams.families import FAMILIES
from camgeo.cams.flat_pair import FlatPairCam
from camgeo.cams.pairs import ArcRoute, DeltaRoute, LawRoute, RosetteRoute
from camgeo.cams.support import FormulaShape, FourierShape, HypocycloidShape, ReuleauxShape, SupportCam
from camgeo.curve.moving_frame import Displacement
from camgeo.motions.motion import Segments
from camgeo.motions.segments import MotionSegment, SccaLaw
from camgeo.part.part import Part
from camgeo.recipe.cam import CAMS
from camgeo.recipe.export import Export, FileRequest
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load, read
from camgeo.recipe.machining import Compensation, Manufacture
from camgeo.recipe.recipe import Recipe, Verify
from camgeo.recipe.starter import starter
from camgeo.registry import registry
from camgeo.registry.formats import MODULES
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.json_schema import json_schema
from camgeo.schema.scalars import Complaint, read_number
from camgeo.synthesis.design import designed
from kin.law.contacts import Flat, Oscillating, Roller, Shoe, Translating
from kin.law.normalised import IntentError
from kin.law.sources.laws import named as named_law
from kin.law.sources.peaks import peaks
from kin.law.sources.programme import Dwell, JointState, Matched, RiseAndFall
from kin.law.support_function import Lift

MM = 25.4
DEG = math.pi / 180


def text(body: str) -> Recipe:
    return read(body.encode(), "case.yaml")


def cam(body: str, units: str = "mm") -> object:
    return text(f"units: {units}\ncam: {body}\n").cam


# --- whole recipes ----------------------------------------------------------------------------------------------------


def test_everything_said() -> None:
    recipe = read(
        b"""
name: dwell-four-bar
about: >
  AS 2023,
  Figure 9
units: mm
rotation: ccw
cam:
  kind: support
  p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t)
  shaft: [18, 8.5]
  undercut: trim
part: {thickness: 8, bore: 10}
export:
  tolerance: 1e-3
  files: [dxf, {dxf: {as: spline, version: R2013, tolerance: 1/1000}}, {stl: {tolerance: 0.01}}, csv]
verify: {angles: 720, motion_error: 0.002}
""",
        "somewhere/else.yaml",
    )
    assert recipe == Recipe(
        name="dwell-four-bar",
        about="AS 2023, Figure 9",
        units="mm",
        mm=1.0,
        rotation="ccw",
        cam=SupportCam(FormulaShape("25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t)", 1.0), (18.0, 8.5), "trim"),
        part=Part(8.0, 10.0),
        export=Export(
            0.001,
            (
                FileRequest("dxf", "arcs", options=(("version", "R2010"),)),
                FileRequest("dxf", "spline", 0.001, options=(("version", "R2013"),)),
                FileRequest("stl", tolerance=0.01),
                FileRequest("csv", "motion"),
            ),
        ),
        verify=Verify(720, 0.002),
        path=Path("somewhere/else.yaml"),
    )


def test_defaults() -> None:
    recipe = text("cam: {kind: support, p: '25'}")
    assert recipe == Recipe(
        name="case",
        about="",
        units="mm",
        mm=1.0,
        rotation="cw",
        cam=SupportCam(FormulaShape("25", 1.0), (0.0, 0.0), "refuse"),
        part=Part(None, None),
        export=Export(0.001, (FileRequest("dxf", "arcs", options=(("version", "R2010"),)),)),
        verify=Verify(3600, None),
        path=Path("case.yaml"),
    )


def test_a_capability_in_use_without_keys_of_its_own_gives_no_speed_and_no_zone() -> None:
    recipe = text("cam: {kind: support, p: '25'}").using(*registry.labels())
    assert recipe.uses == tuple(registry.labels())
    assert (recipe.rpm, recipe.zones) == (None, ())


def test_the_default_tolerance_is_a_micrometre_in_inches_too() -> None:
    assert text("units: inch\ncam: {kind: support, p: 1}").export.tolerance == 0.001


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            "{kind: support, fourier: {mean: 2, sin: {5: 0.01, 3: -0.1}}, shaft: [1, -0.5]}",
            SupportCam(FourierShape(2 * MM, (), ((3, -0.1 * MM), (5, 0.01 * MM))), (1 * MM, -0.5 * MM), "refuse"),
        ),
        (
            "{kind: support, reuleaux: {sides: 3, breadth: 2, rounding: 0.2}}",
            SupportCam(ReuleauxShape(3, 2 * MM, 0.2 * MM), (0.0, 0.0), "refuse"),
        ),
        (
            "{kind: support, hypocycloid: {cusps: 5, size: 0.02, breadth: 2}}",
            SupportCam(HypocycloidShape(5, 0.02 * MM, 2 * MM), (0.0, 0.0), "refuse"),
        ),
        (
            "{kind: support, p: 1 + 0.1*cos(3*t)}",
            SupportCam(FormulaShape("1 + 0.1*cos(3*t)", MM), (0.0, 0.0), "refuse"),
        ),
        (
            "{kind: constant-breadth, base_radius: 2, motion: [{rise: 1, over: 120, law: cycloidal}, {dwell: 60}]}",
            ConstantBreadthCam(
                2 * MM,
                Segments((MotionSegment("rise", 120 * DEG, 1 * MM, "cycloidal"), MotionSegment("dwell", 60 * DEG))),
                "refuse",
            ),
        ),
        (
            "{kind: double-roller, ratio: 4/3, arm: 2, roller_radius: 0.3, delta: {cos: {1: 0.5}, sin: {3: -0.1}}}",
            DoubleRollerCam(4, 3, 2 * MM, 0.3 * MM, DeltaRoute(((1, 0.5 * MM**2),), ((3, -0.1 * MM**2),)), "refuse"),
        ),
        (
            "{kind: double-roller, ratio: 3, arm: 2, roller_radius: 0.3, arc: {radius: 2.5, side: concave}}",
            DoubleRollerCam(3, 1, 2 * MM, 0.3 * MM, ArcRoute(2.5 * MM, "concave"), "refuse"),
        ),
        (
            "{kind: double-roller, ratio: 5/3, arm: 2, roller_radius: 0.3, rosette: {leaf: sin(pi*x)/4}}",
            DoubleRollerCam(5, 3, 2 * MM, 0.3 * MM, RosetteRoute("sin(pi*x)/4", MM), "refuse"),
        ),
        (
            (
                "{kind: flat-pair, ratio: 2, arm: 1, undercut: trim, law: ["
                "{rise: 4, over: 45, law: {polynomial: [0, 0, 3, -2]}}, {return: 4, over: 45, law: harmonic}]}"
            ),
            FlatPairCam(
                2,
                1,
                MM,
                LawRoute(
                    Segments(
                        (
                            MotionSegment("rise", 45 * DEG, 4 * DEG, (0.0, 0.0, 3.0, -2.0)),
                            MotionSegment("return", 45 * DEG, 4 * DEG, "harmonic"),
                        )
                    )
                ),
                "trim",
            ),
        ),
    ],
)
def test_cams_in_inches_become_mm_and_radians(body: str, expected: object) -> None:
    assert cam(body, "inch") == expected


def test_the_motion_error_is_an_angle_where_the_follower_swings() -> None:
    plate = text("units: inch\ncam: {kind: support, p: 1}\nverify: {motion_error: 0.001}")
    pair = "cam: {kind: flat-pair, ratio: 2, arm: 1, delta: {cos: {1: 0.1}}}"
    swinging = text(f"units: inch\n{pair}\nverify: {{motion_error: 0.5}}")
    assert plate.verify.motion_error == 0.001 * MM
    assert swinging.verify.motion_error == 0.5 * DEG


def test_units_count_wherever_they_stand() -> None:
    assert text("part: {bore: 1}\ncam: {kind: support, p: 1}\nunits: inch").part.bore == MM


def test_a_sum_of_fractions_fills_the_angle_of_the_law() -> None:
    body = "law: [{rise: 1, over: 90/7, law: cycloidal}, {return: 1, over: 90/7, law: cycloidal}]"
    route = cam(f"{{kind: flat-pair, ratio: 7/3, arm: 30, {body}}}")
    segments = vars(route)["route"].motion.segments
    assert sum(segment.over for segment in segments) == pytest.approx(math.pi / 7, abs=1e-15)


# --- YAML's ways ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("5", 5.0),
        ("+5", 5.0),
        ("5.", 5.0),
        (".5", 0.5),
        ("1e-3", 1e-3),
        ("1E1", 10.0),
        ("'5'", 5.0),
        ("50/7", 50 / 7),
        ("0.10", 0.1),
    ],
)
def test_numbers_however_they_are_written(written: str, value: float) -> None:
    assert text(f"cam: {{kind: support, p: 9}}\npart: {{thickness: {written}}}").part.thickness == value


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_float_that_means_something_is_read_back_exactly(x: float) -> None:
    if 0 < abs(x) < 1e-30:
        with pytest.raises(Complaint, match="too small"):
            read_number(repr(x))
    else:
        assert read_number(repr(x)) == x


@given(st.text(max_size=12))
def test_a_number_is_what_the_rule_says_or_a_complaint(written: str) -> None:
    try:
        value = read_number(written)
    except Complaint:
        return
    assert math.isfinite(value)
    top, _, bottom = written.partition("/")
    assert value == (float(top) / float(bottom) if bottom else float(written))


@pytest.mark.parametrize("written", ["on", "yes", "010", "1e-3", "2020-01-01", "1:30", "12", "null-1", "true"])
def test_a_text_is_a_text_whatever_yaml_1_1_takes_it_for(written: str) -> None:
    assert text(f"about: {written}\ncam: {{kind: support, p: 9}}").about == written


def test_aliases_stand_for_what_they_name() -> None:
    recipe = text(
        "cam: {kind: constant-breadth, base_radius: &r 40, motion: [&s {rise: 5, over: 90, law: cycloidal}, *s]}\n"
        "part: {thickness: *r}\n"
    )
    assert recipe.part.thickness == 40
    motion = vars(recipe.cam)["motion"].segments
    assert motion[0] == motion[1]


@pytest.mark.slow
def test_line_ends_and_a_byte_order_mark_change_nothing() -> None:
    for path in SHIPPED:
        data = path.read_bytes()
        recipe = read(data, path)
        for ends, mark in (("\r\n", b""), ("\r", b""), ("\n", b"\xef\xbb\xbf")):
            other = read(mark + data.decode().replace("\n", ends).encode(), path)
            assert other == recipe
            assert other.marks == recipe.marks


@pytest.mark.slow
def test_recipes_are_read_alike_without_the_c_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    fast = [load(path) for path in SHIPPED]
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    for recipe, path in zip(fast, SHIPPED, strict=True):
        other = load(path)
        assert other == recipe
        assert other.marks == recipe.marks


@pytest.mark.slow
def test_a_recipe_travels_between_processes() -> None:
    for path in SHIPPED:
        recipe = load(path)
        assert pickle.loads(pickle.dumps(recipe)) == recipe
        hash(recipe.cam)


def test_a_recipe_whose_swing_was_evaluated_travels_between_processes() -> None:
    """Tables of the law's inverse go with it."""
    recipe = load(next(path for path in SHIPPED if path.stem == "yoke-swing"))
    swing = designed(recipe).exact
    again = pickle.loads(pickle.dumps((recipe, swing)))
    assert again[0] == recipe


# --- names and places -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["a", "A.b_c-9", "7", "_x", "x" * 64, "contour", "com", "com10"])
def test_names_that_do(name: str) -> None:
    assert text(f"name: {name}\ncam: {{kind: support, p: 9}}").name == name


def test_the_name_is_the_stem_of_the_file() -> None:
    assert read(b"cam: {kind: support, p: 9}", "far/away/cam.v2.yaml").name == "cam.v2"


def test_file_names_tell_apart_what_differs() -> None:
    arcs, r12 = (FileRequest("dxf", "arcs", options=(("version", version),)) for version in ("R2010", "R12"))
    spline, stl, table = FileRequest("dxf", "spline"), FileRequest("stl"), FileRequest("csv")
    every = (arcs, r12, spline, stl, table)
    assert arcs.filename("x", (arcs, stl, table)) == "x.dxf"
    names = [r.filename("x", every) for r in every]
    for count in range(1, len(every) + 1):  # what is added behind renames nothing
        assert [r.filename("x", every[:count]) for r in every[:count]] == names[:count]
    solids = FileRequest("stl", units="inch"), FileRequest("stl")
    assert [r.filename("x", solids) for r in solids] == ["x.stl", "x-nominal.stl"]
    three = (arcs, spline, stl)
    assert [r.filename("x", three) for r in three] == ["x.dxf", "x-spline.dxf", "x.stl"]
    assert [r.filename("x", every) for r in every] == [
        "x.dxf",
        "x-arcs-R12.dxf",
        "x-spline.dxf",
        "x.stl",
        "x.csv",
    ]


BODY = """\
cam:
  kind: constant-breadth
  base_radius: 40
  motion:
    - {rise: 20, over: 120, law: modified-sine}
    - dwell: 60
part: {thickness: 10}
"""


@pytest.mark.parametrize(
    ("path", "line", "column", "starts"),
    [
        ("cam.base_radius", 3, 16, "40"),
        ("cam.motion", 5, 5, "- {rise"),
        ("cam.motion[0].law", 5, 34, "modified-sine"),
        ("cam.motion[1].dwell", 6, 14, "60"),
        ("cam.motion[1].law", 6, 7, "dwell: 60"),
        ("cam.motion[7]", 5, 5, "- {rise"),
        ("cam.undercut", 2, 3, "kind"),
        ("part.bore", 7, 7, "{thickness"),
        ("export.tolerance", 1, 1, "cam:"),
        ("", 1, 1, "cam:"),
    ],
)
def test_fields_are_located_and_absent_ones_by_their_parent(path: str, line: int, column: int, starts: str) -> None:
    recipe = text(BODY)
    assert recipe.locate(path) == (line, column)
    assert BODY.splitlines()[line - 1][column - 1 :].startswith(starts)


def test_a_later_stage_can_point_to_a_field() -> None:
    errors = text(BODY).error("cam.motion[0].over", "too steep", "120", "give more")
    assert isinstance(errors, RecipeErrors)
    assert str(errors) == "case.yaml:5:24: cam.motion[0].over: too steep, given 120; give more"


def test_a_segment_gives_its_step() -> None:
    named, given_, rest = (
        MotionSegment("rise", 1.0, 2.0, "harmonic").step(),
        MotionSegment("return", 1.0, 2.0, (0.0, 1.0)).step(),
        MotionSegment("dwell", 1.0).step(),
    )
    assert (named.over, named.by, named.to, named.law.name) == (1.0, 2.0, None, "harmonic")
    assert given_.by == -2.0
    assert given_.law.derivatives(0.25, 1)[:, 0].tolist() == [0.25, 1.0]
    assert rest == Dwell(1.0)
    to = MotionSegment("to", 1.0, 2.0, SccaLaw(0.25, 0.0, 0.2), split=0.4).step()
    assert (to.by, to.to) == (None, 2.0)
    assert to.law.name == "scca-20 (split 0.4)"
    assert peaks(to.law.motion).velocity == pytest.approx(peaks(named_law("scca-20").motion).velocity, rel=1e-12)
    match = MotionSegment("rise", 1.0, 2.0, "match", at_end=(0.0, -3.0)).step()
    assert match.law == Matched(at_end=JointState(0.0, -3.0))
    assert MotionSegment("rise_fall", 1.0, 2.0).step() == RiseAndFall(1.0, 2.0)
    assert MotionSegment("displacement", 1.0, formula="u**3", scale=25.4).step().scale == 25.4
    with pytest.raises(IntentError, match="only a matched segment takes a state at its end"):
        MotionSegment("rise", 1.0, 2.0, "cubic", at_end=(0.0, 1.0)).step("motion[3]")
    with pytest.raises(IntentError, match="a matched segment takes no split"):
        MotionSegment("rise", 1.0, 2.0, "match", split=0.4).step()


# --- the shipped recipes ----------------------------------------------------------------------------------------------

WALL = 3.0  # mm of metal that a shipped cam leaves around its bore
THIN = 1.2  # where AS has the shaft near the edge


SHOWS = {  # formats of the recipes that each show one of them, or one option of a file
    "disc-kerf": {"dxf", "svg"},
    "disc-laser": {"svg"},
    "disc-shrinkage": {"dxf", "stl"},
    "disc-step": {"step", "dxf", "csv"},
    # needs: dynamics
    "disc-transient": {"dxf", "csv"},
    "yoke-overlays": {"dxf", "html"},
}


@pytest.mark.slow
def test_every_worked_example_is_shipped_and_the_variety_is_there() -> None:
    recipes = {path.stem: load(path) for path in SHIPPED}
    assert {f"as-figure-{n}" for n in ("1", "2a", "2b", "2c", "2d")} <= recipes.keys()
    assert {"reuleaux", "reuleaux-nine", "hypocycloid", "fourier", "rabinowitz", "shu-wu"} <= recipes.keys()
    assert {"w-booth", "w-figure-5", "w-figure-9", "w-law", "w-rosette", "w-ellipse"} <= recipes.keys()
    for recipe in recipes.values():
        assert recipe.about
        if not any(file.variant for file in recipe.export.files):
            kinds = {file.kind for file in recipe.export.files if file.kind in MODULES}
            assert kinds == SHOWS.get(recipe.name, {"dxf", "stl", "csv"})
    files = [file for recipe in recipes.values() for file in recipe.export.files]
    assert {file.kind for file in files} >= {"dxf", "svg", "stl", "step", "csv", "html"}
    apart = [file.compensation for file in files if file.compensation is not None]
    assert any(one.kerf for one in apart)
    assert any(one.shrinkage for one in apart)
    assert any(file.own.get("overlays") for file in files)
    assert [name for name, recipe in recipes.items() if recipe.cam.undercut == "trim"] == ["disc-trim"]
    tables = {"motion", "contacts", "grinding", "lift", "trace"}
    tables.add("inspection")  # needs: milling
    tables.add("forces")  # needs: dynamics
    tables.add("valve")  # needs: valve, dynamics
    assert {file.as_ for file in files} == {"arcs", "polyline", "spline", *tables, None}
    assert {file.own.get("version") for file in files} == {"R12", "R2000", "R2010", "R2013", None}
    assert {recipe.units for recipe in recipes.values()} == {"mm", "inch"}
    assert {recipe.rotation for recipe in recipes.values()} == {"cw", "ccw"}
    parts = [part for recipe in recipes.values() for part in (recipe.cam, getattr(recipe.cam, "route", None))]
    shapes = [getattr(part, "shape", part) for part in parts]
    flat = {FormulaShape, FourierShape, ReuleauxShape, HypocycloidShape, ConstantBreadthCam, type(None)}
    swinging = {DoubleRollerCam, FlatPairCam, DeltaRoute, LawRoute, ArcRoute, RosetteRoute}
    assert {type(shape) for shape in shapes} >= flat | swinging
    kinds, shipped = set(FAMILIES), {recipe.cam.kind for recipe in recipes.values()}
    assert shipped >= kinds - {"constant-diameter"}
    assert shipped == kinds  # needs: mechanism


# Least and greatest lift (mm) or swing (degrees), and least radius of curvature of the contour or, for rollers, of a
# convex stretch of the pitch curve (mm). Computed apart from the package with numpy: Fourier transform of 2e5 samples
# for AS; closed forms for the Reuleaux triangle (greatest lift 40/sqrt(3) + 5), the ellipse (36^2/48) and SW's
# own example; circles through three neighbours of 2e5 points of Wunderlich's pitch curves; the worked cases of disc
# cams (tests/validation), of rollers and shoes the least radius of the pitch curve.
FIGURES = {
    "as-figure-1": (6.914216, 43.085784, 9.0),
    "as-figure-2a": (8.826925, 41.173075, 7.815923),
    "as-figure-2b": (7.391663, 42.608337, 5.0),
    "as-figure-2c": (7.335189, 42.664811, 5.250995),
    "as-figure-2d": (6.918355, 43.081645, 5.316947),
    "rabinowitz": (8.0, 10.0, 1.0),
    "reuleaux": (21.905989, 28.094011, 5.0),
    "shu-wu": (40.0, 60.0, 34.27910),
    "w-booth": (-14.477512, 14.477512, 45.17538),
    "w-figure-5": (-15.128, 15.128, 75.0),
    "w-figure-9": (-9.997919, 9.997919, 14.93756),
    "w-rosette": (-7.645, 7.645, 25.5887),
    "w-law": (-8.0, 8.0, None),
    "w-ellipse": (-16.260205, 16.260205, 27.0),
    "disc-arm": (0.0, 20.0, 39.474536),
    "disc-arm-flat": (0.0, 10.0, 25.986559),
    "disc-flat": (0.0, 12.0, 16.078192),
    # needs: milling
    "disc-packaging": (0.0, 30.0, 60.0),
    "disc-roller": (0.0, 24.0, 40.661314),
    "disc-shoe": (0.0, 10.0, 70.950026),
    # needs: dynamics
    "valve-lobe": (0.0, 8.0, 3.816408),
}


@pytest.mark.thin(6)
@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_recipe_is_a_cam_with_metal_around_its_bore(path: Path) -> None:
    recipe = load(path)
    exact = recipe.cam.exact()
    intent = exact.law
    assert exact.surfaces[0].curve is not None
    bore = (recipe.part.bore or 0) / 2
    if isinstance(intent, Lift):
        theta = np.linspace(0, 2 * np.pi, 7201)
        p = intent.derivatives(theta, 2)
        low, high, radius = p[0].min(), p[0].max(), (p[0] + p[2]).min()
        assert radius > 0 or path.stem == "reuleaux-irregular"  # of sharp corners
        papers = path.stem.startswith("as-") or path.stem in {
            "six-bar",
            "sweep-four-bar",  # needs: sweep
            "coupler-curve",
        }  # the paper's own shafts
        assert low - bore > (THIN if papers else WALL)
    elif isinstance(intent, Displacement):
        theta = np.linspace(0, 2 * np.pi, 72001)
        low, high = 0.0, intent.derivatives(theta, 0)[0].max()
        high = np.degrees(high) if exact.motion.unit == "deg" else high
        frame = exact.surfaces[0].base.shape.sample(theta)
        radius = 1 / (frame.turn / frame.speed).max()
        assert radius > recipe.cam.touch.radius
        assert isinstance(recipe.cam, DiscCam | ConstantDiameterCam)
        assert recipe.cam.base_radius - bore > WALL
    else:
        tau = np.linspace(0, 2 * intent.delta, 7201)
        r, t = intent.pitch(tau, 2)
        swing = np.degrees(intent.at(tau, 0)[1][0])
        low, high = swing.min(), swing.max()
        if isinstance(recipe.cam, FlatPairCam):
            # r(t) is a support function here (W 5): by t, r' = r1/t1 and r'' = (r2 - r' t2)/t1^2
            radius = (r[0] + (r[2] - r[1] / t[1] * t[2]) / t[1] ** 2).min()
            assert radius > 0
            assert r[0].min() - bore > WALL
        else:
            z1 = r[1] + 1j * r[0] * t[1]
            z2 = r[2] - r[0] * t[1] ** 2 + 1j * (2 * r[1] * t[1] + r[0] * t[2])
            curvature = (z1.conj() * z2).imag / np.abs(z1) ** 3
            radius = 1 / curvature.max()
            assert radius > recipe.cam.touch.radius
            assert r[0].min() - recipe.cam.touch.radius - bore > WALL
    if path.stem in FIGURES:
        least, greatest, sharpest = FIGURES[path.stem]
        assert (low, high) == pytest.approx((least, greatest), abs=6e-4)
        assert sharpest is None or radius == pytest.approx(sharpest, rel=1e-4)


# --- starters and the JSON schema -------------------------------------------------------------------------------------

PRINTED = {
    "toy": {"stl", "3mf", "svg", "html"},
    "toy-set": {"stl", "3mf", "html"},  # needs: mechanism
}


@pytest.mark.thin(3)
@pytest.mark.parametrize("kind", OF_CAMS)
def test_a_starter_is_a_cam_as_it_stands(kind: str) -> None:
    recipe = text(starter(kind))
    assert recipe.cam is not None
    assert recipe.cam.exact().law is not None
    files = PRINTED.get(kind, {"dxf", "svg", "stl", "csv", "html"})
    assert {file.kind for file in recipe.export.files} == files


@pytest.mark.slow
def test_starters_show_every_kind_of_cam() -> None:
    cams = [text(starter(kind)).cam for kind in OF_CAMS]
    kinds = {SupportCam, ConstantBreadthCam, ConstantDiameterCam, DoubleRollerCam, FlatPairCam, DiscCam}
    assert {type(cam) for cam in cams} == kinds
    assert {(cam.arrangement.guide, cam.arrangement.touch) for cam in cams if isinstance(cam, DiscCam)} >= {
        (Translating, Roller),
        (Oscillating, Roller),
        (Translating, Shoe),
        (Translating, Flat),
        (Oscillating, Flat),
    }
    assert {text(starter(kind)).cam.kind for kind in OF_CAMS} == set(CAMS)


def test_a_starter_of_an_arm_shows_no_field_of_a_stem() -> None:
    stem, arm = starter("disc-roller"), starter("disc-arm")
    assert "    offset: 8 " in stem
    assert "    # arm: " in stem
    assert "      pivot: 80 " in arm
    assert not re.search(r"^ *(# )?offset:", arm, re.MULTILINE)


def test_an_unknown_starter_names_a_near_one() -> None:
    with pytest.raises(ValueError, match=re.escape("no starter for 'flat'; did you mean flat-pair?")):
        starter("flat")


def test_a_starter_explains_each_line() -> None:
    lines = starter("double-roller").splitlines()
    assert "  arm: 60                               # arm length, the distance l of the closing equation, mm" in lines
    assert "  # instead of delta: law, arc or rosette" in lines
    assert all("#" in line for line in lines)


def valid(value: object, schema: dict | bool) -> bool:
    """Judge by the part of JSON schema that is used here."""
    if isinstance(schema, bool):
        return schema
    types = {
        "object": dict,
        "array": list,
        "string": str,
        "boolean": bool,
        "number": (int, float),
        "integer": int,
    }
    named = schema.get("type", list(types))
    named = [named] if isinstance(named, str) else named
    kind = tuple(t for name in named for t in np.atleast_1d(types[name]))
    if not isinstance(value, kind) or (isinstance(value, bool) and "boolean" not in named):
        return False
    if "enum" in schema and value not in schema["enum"]:
        return False
    if "const" in schema and value != schema["const"]:
        return False
    if isinstance(value, str) and not re.search(schema.get("pattern", ""), value):
        return False
    if isinstance(value, int | float):
        inside = schema.get("minimum", -math.inf) <= value <= schema.get("maximum", math.inf)
        even = "not" in schema and value % schema["not"]["multipleOf"] == 0
        if not inside or even or not value > schema.get("exclusiveMinimum", -math.inf):
            return False
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", math.inf):
            return False
        if not all(valid(item, schema.get("items", True)) for item in value):
            return False
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        if not set(schema.get("required", [])) <= value.keys():
            return False
        if not all(valid(v, properties.get(k, schema.get("additionalProperties", True))) for k, v in value.items()):
            return False
        if not schema.get("minProperties", 0) <= len(value) <= schema.get("maxProperties", math.inf):
            return False
    if "anyOf" in schema and not any(valid(value, one) for one in schema["anyOf"]):
        return False
    return "oneOf" not in schema or sum(valid(value, one) for one in schema["oneOf"]) == 1


class Plain(yaml.SafeLoader):
    """YAML as editors read it: by version 1.2, where `on` is a text."""


BOOL = "tag:yaml.org,2002:bool"
Plain.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != BOOL]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Plain.add_implicit_resolver(BOOL, re.compile("true|false"), ["t", "f"])


def plain_yaml(text: str | bytes) -> dict:
    return yaml.load(text, Loader=Plain)  # a safe loader


@pytest.mark.thin(12)
@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_the_json_schema_admits_what_is_shipped(path: Path) -> None:
    plain = plain_yaml(path.read_bytes())
    assert valid(plain, json_schema(recipe_table()))
    assert not valid({**plain, "linkage": {}}, json_schema(recipe_table()))
    assert not valid({key: value for key, value in plain.items() if key != "cam"}, json_schema(recipe_table()))


@pytest.mark.thin(3)
@pytest.mark.parametrize("kind", OF_CAMS)
def test_the_json_schema_admits_the_starters(kind: str) -> None:
    assert valid(plain_yaml(starter(kind)), json_schema(recipe_table()))


SUPPORT = "{kind: support, p: 9}"


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("body", "more"),
    [
        (SUPPORT, "{linkage: {kind: five-bar}}"),
        (SUPPORT, "{linkage: {kind: four-bar, ground: 80, coupler: 70}}"),
        (SUPPORT, "{linkage: {kind: slider-crank, coupler: 70, offset: 5, rocker: 8}}"),
        (SUPPORT, "{linkage: {kind: slider-crank, coupler: 70, offset: 5, dyads: []}}"),
        (SUPPORT, "{linkage: {kind: inverted-slider-crank, ground: 80, rocker: -1}}"),
        (SUPPORT, "{linkage: {kind: slider-crank, coupler: 70, offset: 5}, dwell: {at_least: 40}}"),
        (SUPPORT, "{linkage: {kind: slider-crank, coupler: 70, offset: 5, dyads: [{kind: rpr, point: [1, 2]}]}}"),
        (SUPPORT, "{sweep: {vary: {}, rank: size}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: []}, rank: size}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: {from: 1}}, rank: size}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: [1]}, rank: volume}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: [1]}, rank: size, limits: {size: {}}}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: [1]}, rank: size, limits: {volume: {at_least: 1}}}}"),  # needs: sweep
        (SUPPORT, "{sweep: {vary: {cam.x: [1]}, rank: size, refine: 'yes'}}"),  # needs: sweep
    ],
)
def test_the_json_schema_refuses_linkages_and_sweeps_that_load_refuses(body: str, more: str) -> None:
    plain = {"cam": plain_yaml(body), **plain_yaml(more)}
    assert valid({"cam": plain["cam"]}, json_schema(recipe_table()))
    assert not valid(plain, json_schema(recipe_table()))
    with pytest.raises(RecipeErrors):
        text(json.dumps(plain))


@pytest.mark.parametrize(
    "body",
    [
        "{kind: support}",
        "{kind: support, p: cos(t), reuleaux: {sides: 3, breadth: 5, rounding: 1}}",
        "{kind: support, reuleaux: {sides: 4, breadth: 5, rounding: 1}}",
        "{kind: support, reuleaux: {sides: 3, breadth: -5, rounding: 1}}",
        "{kind: flat-pair, ratio: 2, arm: 30, roller_radius: 4, arc: {radius: 5}}",
        "{kind: constant-breadth, base_radius: 4, motion: [{dwell: 5, law: cycloidal}]}",
        "{kind: constant-breadth, base_radius: 4, motion: [{rise: 5, law: cycloidal}]}",
        "{kind: constant-breadth, base_radius: 4, motion: [{rise: 5, over: 180, law: bouncing}]}",
        "{kind: constant-breadth, base_radius: 4, motion: []}",
        "{kind: roller}",
    ],
)
def test_the_json_schema_refuses_what_load_refuses(body: str) -> None:
    assert not valid({"cam": yaml.safe_load(body)}, json_schema(recipe_table()))
    with pytest.raises(RecipeErrors):
        cam(body)


def test_the_model_is_frozen() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        text(BODY).name = "other"  # type: ignore[misc]  # this is what it refuses


# needs: milling
def test_milling_and_compensation() -> None:
    body = """\
units: inch
cam: {kind: support, p: 1}
part: {thickness: 0.5}
export: {files: [dxf, {dxf: {kerf: 0.01}}, {stl: {clearance: 0.004, shrinkage: 0.4}}, {csv: {as: inspection}}, gcode]}
manufacture: {cutter: 0.25, feed: 20, plunge: 5, spindle: 9000, depth_of_cut: 0.1, safe_height: 0.2, start: 90}
"""
    recipe = read(body.encode(), "c.yaml")
    assert recipe.manufacture == Manufacture(
        6.35, feed=508.0, plunge=127.0, spindle=9000.0, depth_of_cut=2.54, safe_height=5.08, start=math.pi / 2
    )
    assert recipe.manufacture.lead == recipe.manufacture.radius == 3.175
    files = recipe.export.files
    names = [file.filename("c", files) for file in files]
    assert names == ["c.dxf", "c-arcs-R2010-kerf.dxf", "c.stl", "c.csv", "c.ngc"]
    assert [file.compensation for file in files] == [
        None,
        Compensation(kerf=0.254),
        Compensation(clearance=pytest.approx(0.1016), shrinkage=0.004),
        None,
        None,
    ]
    kerf, both = files[1].compensation, files[2].compensation
    assert kerf is not None
    assert both is not None
    assert (kerf.out, kerf.scale, kerf.words(25.4)) == (0.127, 1.0, "kerf 0.01")
    assert both.out == pytest.approx(-0.1016)
    assert both.scale == 1 / 0.996
    assert (both.tags, both.words(25.4)) == ("clearance-shrinkage", "clearance 0.004, shrinkage 0.4 percent")


# needs: milling
@pytest.mark.parametrize(
    ("more", "messages"),
    [
        (
            "export: {files: [gcode]}",
            [
                (
                    "2:18: export.files[0]: gcode needs manufacture; give manufacture with cutter, feed, plunge, "
                    "spindle, depth_of_cut and safe_height, or leave gcode out"
                ),
                "2:18: export.files[0]: gcode needs a thickness; give part.thickness, or leave gcode out",
            ],
        ),
        (
            "export: {files: [gcode]}\npart: {thickness: 4}\nmanufacture: {cutter: 6, feed: 300, spindle: 9000}",
            ["4:14: manufacture: gcode needs plunge; give plunge, depth_of_cut and safe_height, or leave gcode out"],
        ),
        (
            "manufacture: {cutter: 6, allowance: 3}",
            ["2:37: manufacture.allowance: not below a quarter of the cutter, given 3 mm; give less than 1.5 mm"],
        ),
        (
            "manufacture: {diameter: 6, direction: down}",
            [
                (
                    "2:14: manufacture.cutter: missing; give a length above 0 in mm: diameter of the cutter that mills "
                    "the contour"
                ),
                "2:15: manufacture.diameter: unknown key; it belongs under follower of kind flat",
                "2:39: manufacture.direction: not one of the choices, given 'down'; give climb or conventional",
            ],
        ),
        (
            "export: {files: [{gcode: {kerf: 0.2}}, {dxf: {kerf: -1}}, {stl: {shrinkage: 30}}]}\npart: {thickness: 4}",
            None,
        ),
    ],
)
def test_milling_that_cannot_be(more: str, messages: list[str] | None) -> None:
    with pytest.raises(RecipeErrors) as caught:
        read(f"cam: {{kind: support, p: 9}}\n{more}\n".encode(), "c.yaml")
    found = str(caught.value).splitlines()
    if messages is None:
        assert [line.split(";")[0].split(" ", 1)[1] for line in found] == [
            "export.files[0]: gcode needs manufacture",
            "export.files[0].gcode.kerf: unknown key",
            "export.files[1].dxf.kerf: not above 0, given -1",
            "export.files[2].stl.shrinkage: above 20, given 30",
        ]
    else:
        assert found == [f"c.yaml:{message}" for message in messages]


@pytest.mark.parametrize("name", ["cam.dxf", "cam.STL", "points.csv"])
def test_a_file_of_a_cam_is_no_recipe(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"\xff0\nEOF\n")
    with pytest.raises(RecipeErrors, match="a file of a cam, and no recipe; give the recipe first"):
        load(tmp_path / name)
