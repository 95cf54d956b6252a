"""Linkages, dyads and dwells in a recipe: what they come to, and what is said about faults."""

from __future__ import annotations

import math

import pytest

from camgeo.recipe.linkage import DwellLimits, output_slides
from camgeo.recipe.loading import load_text
from camgeo.recipe.recipe import Recipe, Verify
from camgeo.recipe.starter import starter
from camgeo.schema.errors import RecipeErrors
from kin.linkage import dyad
from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank

MM = 25.4
DEG = math.pi / 180
SUPPORT = "cam: {kind: support, p: 25 + cos(3*t)}\n"
FOUR_BAR = "kind: four-bar, ground: 80, coupler: 70, rocker: 105"
SLIDER = "kind: slider-crank, coupler: 75, offset: 0"
RRR = "{kind: rrr, point: [80, 0], ground: [140, 80], links: [100, 30]}"
RRP = "{kind: rrp, point: [80, 0], link: 90, through: [0, 150], direction: 30}"
RPR = "{kind: rpr, point: [80, 0], ground: [80, 200]}"
LENGTH = "give a length above 0 in mm"


def recipe(body: str) -> Recipe:
    return load_text(body, "c.yaml")


def told(body: str) -> list[str]:
    with pytest.raises(RecipeErrors) as caught:
        recipe(body)
    return [line.removeprefix("c.yaml:") for line in str(caught.value).splitlines()]


# --- what they come to ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            "{kind: four-bar, ground: 3, coupler: 2, rocker: 4}",
            FourBar(3 * MM, 2 * MM, 4 * MM, "open"),
        ),
        (
            "{kind: inverted-slider-crank, ground: 3, rocker: 0, assembly: crossed}",
            InvertedSliderCrank(3 * MM, 0.0, "crossed"),
        ),
        (
            "{kind: slider-crank, coupler: 3, offset: -0.5, assembly: open}",
            SliderCrank(3 * MM, -0.5 * MM, "open"),
        ),
        (
            "{kind: four-bar, ground: 3, coupler: 2, rocker: 4, joint_offset: -0.5}",
            FourBar(3 * MM, 2 * MM, 4 * MM, "open", joint_offset=-0.5 * MM),
        ),
    ],
)
def test_linkages_in_inches_become_mm(body: str, expected: object) -> None:
    found = recipe(f"units: inch\n{SUPPORT}linkage: {body}")
    assert found.linkage is not None
    assert found.linkage.loop == expected
    assert (found.dwell, found.uses) == (None, ())
    hash(found.linkage)


def test_dyads_in_inches_become_mm_and_radians() -> None:
    dyads = """
    - {kind: rrr, on: coupler, point: [1, -2], ground: [3, 4], links: [5, 6], assembly: crossed}
    - {kind: rrp, on: previous, point: [1, 2], link: 3, through: [4, 5], direction: -90}
    - {kind: rpr, point: [1, 2], ground: [3, 4], offset: -0.5}
    - {kind: rpr, point: [0, 0], ground: [0, 0]}
"""
    four_bar = FOUR_BAR.replace(", ", "\n  ")
    found = recipe(f"units: inch\n{SUPPORT}linkage:\n  {four_bar}\n  dyads:{dyads}")
    assert found.linkage
    assert found.linkage.dyads == (
        dyad.RRR("coupler", (MM, -2 * MM), (3 * MM, 4 * MM), (5 * MM, 6 * MM), "crossed"),
        dyad.RRP("previous", (MM, 2 * MM), 3 * MM, (4 * MM, 5 * MM), -90 * DEG, "open"),
        dyad.RPR("output", (MM, 2 * MM), (3 * MM, 4 * MM), -0.5 * MM),
        dyad.RPR("output", (0.0, 0.0), (0.0, 0.0), 0.0),
    )


@pytest.mark.parametrize(
    ("linkage", "slides"),
    [
        (FOUR_BAR, False),
        ("kind: inverted-slider-crank, ground: 80, rocker: 0", False),
        (SLIDER, True),
        (f"{FOUR_BAR}, dyads: [{RRR}]", False),
        (f"{FOUR_BAR}, dyads: [{RRR}, {RRP}]", True),
        (f"{FOUR_BAR}, dyads: [{RRP}, {RPR}]", False),
        (f"{SLIDER}, dyads: [{RRR}]", False),
        (f"dyads: [{RRP}], {FOUR_BAR}", True),
    ],
)
def test_the_last_output_says_whether_band_and_error_are_angles_or_lengths(linkage: str, slides: bool) -> None:
    # dwell and verify stand before the linkage that decides
    body = f"dwell: {{band: 0.5, at_least: 40}}\nverify: {{output_error: 0.25}}\nunits: inch\n{SUPPORT}"
    found = recipe(f"{body}linkage: {{{linkage}}}")
    unit = MM if slides else DEG
    assert found.linkage
    assert output_slides(found.linkage) == slides
    assert found.dwell == DwellLimits(0.5 * unit, 40 * DEG, "shaft")
    assert found.verify == Verify(3600, None, 0.25 * unit)


def test_the_frame_runs_straight_whatever_the_output_does() -> None:
    found = recipe(f"{SUPPORT}linkage: {{{FOUR_BAR}}}\nverify: {{motion_error: 0.5}}")
    assert found.verify == Verify(3600, 0.5, None)


def test_a_dwell_may_be_told_without_a_check() -> None:
    found = recipe(f"{SUPPORT}linkage: {{{FOUR_BAR}}}\ndwell: {{band: 180, over: relative}}")
    assert found.dwell == DwellLimits(math.pi, None, "relative")


@pytest.mark.parametrize("kind", ["four-bar", "inverted-slider-crank", "slider-crank"])
def test_starters_have_their_linkage(kind: str) -> None:
    found = recipe(starter(kind))
    types = {FourBar: ("four-bar",), InvertedSliderCrank: ("inverted-slider-crank",)}
    assert kind in types.get(type(found.linkage.loop), ("slider-crank",))
    assert found.dwell
    assert all(" #" in line or "{from" in line for line in starter(kind).splitlines()[1:])


@pytest.mark.parametrize("kind", ["support", "constant-breadth", "double-roller", "flat-pair"])
def test_starters_without_a_linkage_offer_no_keys_that_need_one(kind: str) -> None:
    lines = starter(kind).splitlines()
    offered = {line.split(":")[0] for line in lines}
    assert not offered & {"# dwell", "  # output_error"}
    assert ("# linkage" in offered) == (kind in {"support", "constant-breadth"})
    assert "# sweep" in offered  # needs: sweep


# --- what is said about faults ----------------------------------------------------------------------------------------

KINDS = "four-bar, inverted-slider-crank or slider-crank"
PLACE = "give a list of two lengths [x, y] in mm"


@pytest.mark.parametrize(
    ("linkage", "messages"),
    [
        ("5", ["2:10: linkage: not a mapping, given 5; give a mapping with the kind of linkage and its fields"]),
        (
            "",
            [
                (
                    "2:9: linkage: nothing given; give a mapping with the kind of linkage and its fields, "
                    "or leave the key out"
                )
            ],
        ),
        (
            "{ground: 5, bore: 2}",
            [
                f"2:10: linkage.kind: missing; give {KINDS}: the kind of linkage",
                "2:22: linkage.bore: unknown key; it belongs under part",
            ],
        ),
        ("{kind: fourbar}", ["2:17: linkage.kind: not one of the choices, given 'fourbar'; did you mean four-bar?"]),
        (
            "{kind: four-bar, ground: 0, coupler: -1}",
            [
                f"2:10: linkage.rocker: missing; {LENGTH}: length r4 of the rocker",
                f"2:35: linkage.ground: not above 0, given 0; {LENGTH}",
                f"2:47: linkage.coupler: not above 0, given -1; {LENGTH}",
            ],
        ),
        (
            "{kind: four-bar, ground: 80, coupler: 70, rocker: 90, offset: 3}",
            ["2:64: linkage.offset: unknown key; did you mean joint_offset?"],
        ),
        # needs: dynamics
        (
            "{kind: inverted-slider-crank, ground: 80, coupler: 70, rocker: -1}",
            [
                (
                    "2:52: linkage.coupler: unknown key; it belongs under dynamics, or under linkage of kind "
                    "four-bar or slider-crank"
                ),
                "2:73: linkage.rocker: below 0, given -1; give a length of at least 0 in mm",
            ],
        ),
        (
            "{kind: slider-crank, assembly: closed}",
            [
                f"2:10: linkage.coupler: missing; {LENGTH}: length r3 from the middle of the frame's side to the joint",
                (
                    "2:10: linkage.offset: missing; give a length in mm: "
                    "distance of the slide's line from the shaft, along +y"
                ),
                "2:41: linkage.assembly: not one of the choices, given 'closed'; did you mean crossed?",
            ],
        ),
    ],
)
def test_linkages(linkage: str, messages: list[str]) -> None:
    assert told(f"{SUPPORT}linkage: {linkage}") == messages


DYADS = "give a list of dyads such as [{kind: rrr, point: [80, 0], ground: [140, 80], links: [100, 30]}]"


@pytest.mark.parametrize(
    ("dyads", "messages"),
    [
        ("rrr", [f"1: linkage.dyads: not a list, given 'rrr'; {DYADS}"]),
        ("[]", [f"1: linkage.dyads: an empty list; {DYADS}"]),
        (
            "[rrr]",
            ["2: linkage.dyads[0]: not a mapping, given 'rrr'; give a mapping with the kind of dyad and its fields"],
        ),
        ("[{}]", ["2: linkage.dyads[0].kind: missing; give rrr, rrp or rpr: the kind of dyad"]),
        ("[{kind: rrrr}]", ["9: linkage.dyads[0].kind: not one of the choices, given 'rrrr'; did you mean rrr?"]),
        (
            "[{kind: rrr, on: previous, point: [1, 2], ground: [3, 4], links: [5, 6]}]",
            ["18: linkage.dyads[0].on: there is no dyad before the first, given 'previous'; give output or coupler"],
        ),
        (
            "[{kind: rrr, on: frame, point: 5, ground: [1], links: [5, 0], link: 4}]",
            [
                "18: linkage.dyads[0].on: not one of the choices, given 'frame'; give output, coupler or previous",
                f"32: linkage.dyads[0].point: not a point, given 5; {PLACE}",
                f"43: linkage.dyads[0].ground: not a point, given a list of 1; {PLACE}",
                f"59: linkage.dyads[0].links[1]: not above 0, given 0; {LENGTH}",
                "63: linkage.dyads[0].link: unknown key; did you mean links?",
            ],
        ),
        (
            "[{kind: rrr, point: [1, 2], ground: [1, 2], links: 5}]",
            [
                (
                    "52: linkage.dyads[0].links: not a pair of lengths, given 5; "
                    "give a list of two lengths above 0 [a, b] in mm"
                )
            ],
        ),
        (
            "[{kind: rrp, point: [1, 2], link: 0, through: [1, 2], direction: 400}]",
            [
                f"35: linkage.dyads[0].link: not above 0, given 0; {LENGTH}",
                "66: linkage.dyads[0].direction: above 360, given 400; give an angle from -360 to 360 in degrees",
            ],
        ),
        (
            "[{kind: rpr, point: [1, 2], assembly: open}]",
            [
                (
                    f"2: linkage.dyads[0].ground: missing; {PLACE}: "
                    "the fixed pivot [x, y] in the fixed axes, the shaft at [0, 0]"
                ),
                (
                    "29: linkage.dyads[0].assembly: unknown key; it belongs under linkage of kind four-bar, "
                    "inverted-slider-crank or slider-crank, or under a dyad of kind rrr or rrp"
                ),
            ],
        ),
    ],
)
def test_dyads(dyads: str, messages: list[str]) -> None:
    before = f"linkage: {{{FOUR_BAR}, dyads: "  # the columns are those of `dyads` itself
    parts = (message.partition(":") for message in messages)
    assert told(f"{SUPPORT}{before}{dyads}}}") == [f"2:{len(before) + int(column)}:{rest}" for column, _, rest in parts]


def test_too_many_dyads() -> None:
    (message,) = told(f"{SUPPORT}linkage: {{{FOUR_BAR}, dyads: [{', '.join([RRR] * 21)}]}}")
    assert message.endswith("linkage.dyads: more than 20 entries, given 21; at most 20 are read")


@pytest.mark.parametrize(
    ("body", "messages"),
    [
        (SUPPORT + "dwell: {band: 1}", ["2:8: dwell: needs a linkage; give a linkage, or leave it out"]),
        (
            SUPPORT + "verify: {output_error: 1}",
            ["2:24: verify.output_error: needs a linkage; give a linkage, or leave it out"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, arc: {radius: 50}}\nlinkage: {" + FOUR_BAR + "}",
            [
                (
                    "2:10: linkage: cannot be combined with a cam of kind flat-pair; "
                    "a frame around a cam of kind support or constant-breadth drives it"
                )
            ],
        ),
        (
            "cam: {kind: support, fourier: {mean: 25, cos: {3: 1, 2: 0}, sin: {4: 1}}}\nlinkage: {" + FOUR_BAR + "}",
            [
                (
                    "1:66: cam.fourier.sin: an even harmonic under a linkage, given 4; "
                    "a frame needs constant breadth: odd harmonics alone"
                )
            ],
        ),
    ],
)
def test_what_does_not_go_together(body: str, messages: list[str]) -> None:
    assert told(body) == messages


@pytest.mark.parametrize(
    ("linkage", "line", "message"),
    [
        (
            FOUR_BAR,
            "dwell: {at_least: 5}",
            (
                "8: dwell.band: missing; give a change of the output above 0 in degrees: "
                "greatest less least output within a dwell, in degrees, or a length where it slides"
            ),
        ),
        (
            FOUR_BAR,
            "dwell: {band: 0}",
            "15: dwell.band: not above 0, given 0; give a change of the output above 0 in degrees",
        ),
        (SLIDER, "dwell: {band: 0}", "15: dwell.band: not above 0, given 0; give a change of the output above 0 in mm"),
        (
            FOUR_BAR,
            "dwell: {band: 1, at_least: 361}",
            "28: dwell.at_least: above 360, given 361; give an angle above 0 up to 360 in degrees",
        ),
        (
            FOUR_BAR,
            "dwell: {band: 1, over: cam}",
            "24: dwell.over: not one of the choices, given 'cam'; give shaft or relative",
        ),
        (FOUR_BAR, "dwell: 5", "8: dwell: not a mapping, given 5; give a mapping with band, at_least and over"),
        (
            SLIDER,
            "verify: {output_error: -1}",
            "24: verify.output_error: not above 0, given -1; give a change of the output above 0 in mm",
        ),
    ],
)
def test_dwells_and_errors(linkage: str, line: str, message: str) -> None:
    assert told(f"{SUPPORT}linkage: {{{linkage}}}\n{line}") == [f"3:{message}"]
