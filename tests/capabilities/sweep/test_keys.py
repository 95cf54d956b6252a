"""The sweep of a recipe: what it comes to, and what is said about faults.

Holds: camgeo.capabilities.sweep.starter.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from camgeo.capabilities.sweep.keys import MOST_AXES, MOST_VALUES, Axis, Sweep, sweep_figures, varied_fields
from camgeo.capabilities.sweep.starter import ANSWERS
from camgeo.recipe.design_figure import NOTHING
from camgeo.recipe.figures import OF_DWELL, OF_FACE, OF_FOLLOWER, OF_LINKAGE, OF_ROLLER, OF_SWING
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.limits import Limit
from camgeo.recipe.loading import load_text
from camgeo.schema.edit import with_values
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import field_at
from camgeo.schema.yaml_source import join

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

FIGURES = sweep_figures()
HERE = (NOTHING, OF_LINKAGE, OF_DWELL, OF_FACE)  # what a recipe with a linkage and a dwell has

BASE = """\
cam: {kind: support, fourier: {mean: 25, cos: {3: 1.5}}, shaft: [10, 4]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105, dyads: [{kind: rpr, point: [9, 0], ground: [80, 200]}]}
dwell: {band: 0.1}
part: {thickness: 8}
sweep:
"""
FIRST = BASE.count("\n") + 1  # line of the first key of the sweep


def recipe(body: str) -> Recipe:
    return load_text(body, "c.yaml")


def sweep(body: str, base: str = BASE) -> Sweep:
    found = recipe(base + body).of(Sweep)
    assert found
    return found


def told(body: str, base: str = BASE) -> list[str]:
    """The errors of a sweep, their lines counted from its first key."""
    with pytest.raises(RecipeErrors) as caught:
        recipe(base + body)
    first = base.count("\n")
    return [f"{error.line - first}:{str(error).split(':', 2)[2]}" for error in caught.value.errors]


# --- what it comes to -------------------------------------------------------------------------------------------------


def test_everything_said() -> None:
    body = """\
  vary:
    cam.shaft[0]: {from: -10, to: 20}
    linkage.rocker: {to: 110, from: 190/2}
    linkage.dyads[0].point[1]: [1, -2.5, 1/4]
  method: sobol
  count: 1024
  seed: 7
  limits: {radius-of-curvature: {at_least: 3}, size: {at_least: 1, at_most: 40}, transmission-angle: {at_least: 40}}
  rank: dwell-relative
  keep: 3
  angles: 720
  refine: true
"""
    assert sweep(body) == Sweep(
        vary=(
            Axis("cam.shaft[0]", -10.0, 20.0),
            Axis("linkage.rocker", 95.0, 110.0),
            Axis("linkage.dyads[0].point[1]", -2.5, 1.0, (1.0, -2.5, 0.25)),
        ),
        method="sobol",
        count=1024,
        seed=7,
        limits=(
            Limit("radius-of-curvature", at_least=3.0),
            Limit("size", 1.0, 40.0),
            Limit("transmission-angle", at_least=40.0),
        ),
        rank="dwell-relative",
        keep=3,
        angles=720,
        refine=True,
    )


def test_defaults() -> None:
    found = sweep("  {vary: {linkage.rocker: {from: 95, to: 110, steps: 4}}, rank: dwell}")
    assert found == Sweep((Axis("linkage.rocker", 95.0, 110.0, steps=4),), "grid", None, 0, (), "dwell", 10, 360, False)


def test_values_stay_as_written_and_limits_come_in_the_units_of_figures() -> None:
    body = """\
  vary: {linkage.rocker: {from: 95, to: 110, steps: 4}}
  limits: {size: {at_most: 2}, margin: {at_least: 0.5}, swing: {at_most: 30}, dwell: {at_least: 30}}
  rank: swing
"""
    inches = sweep(body, "units: inch\n" + BASE)
    assert inches.vary == (Axis("linkage.rocker", 95.0, 110.0, steps=4),)
    assert inches.limits == (
        Limit("size", None, 2 * 25.4),
        Limit("margin", 0.5 * 25.4),
        Limit("swing", None, 30.0),
        Limit("dwell", 30.0),
    )
    sliding = BASE.replace(
        "kind: four-bar, ground: 80, coupler: 70, rocker: 105", "kind: slider-crank, coupler: 70, offset: 0"
    )
    sliding = sliding.replace(", dyads: [{kind: rpr, point: [9, 0], ground: [80, 200]}]", "")
    inches = sweep(body.replace("rocker", "offset"), "units: inch\n" + sliding)
    assert inches.limits[2] == Limit("swing", None, 30 * 25.4)


@pytest.mark.parametrize(
    ("cam", "path"),
    [
        ("{kind: constant-breadth, base_radius: 40, motion: [{rise: 5, over: 120, law: cycloidal}, {dwell: 60}]}", path)
        for path in ("cam.base_radius", "cam.motion[0].rise", "cam.motion[1].dwell")
    ]
    + [
        ("{kind: support, fourier: {mean: 25, sin: {3: 1.5, '5': 0}}, shaft: [1, 2]}", path)
        for path in ("cam.fourier.mean", "cam.fourier.sin.3", "cam.fourier.sin.5", "cam.shaft[1]")
    ]
    + [("{kind: support, reuleaux: {sides: 3, breadth: 50, rounding: 5}}", "cam.reuleaux.rounding")],
)
def test_any_number_of_the_cam_may_vary(cam: str, path: str) -> None:
    found = recipe(f"cam: {cam}\nsweep:\n  vary:\n    {path}: [1, 2.5]\n  rank: size")
    assert varied_fields(found) == (Axis(path, 1.0, 2.5, (1.0, 2.5)),)
    assert "2.5" in with_values(found.text, {path: 2.5}).splitlines()[0]


def test_whole_numbers_vary_by_a_list() -> None:
    body = "cam: {kind: support, reuleaux: {sides: 3, breadth: 50, rounding: 5}}\nsweep: {rank: size, vary: {VARY}}"
    found = recipe(body.replace("VARY", "cam.reuleaux.sides: [3, 5, 7]")).of(Sweep)
    assert found
    assert found.vary == (Axis("cam.reuleaux.sides", 3.0, 7.0, (3.0, 5.0, 7.0)),)
    with pytest.raises(RecipeErrors) as caught:
        recipe(body.replace("VARY", "cam.reuleaux.sides: [3, 4, 5.5, 101]"))
    assert [str(error).split(": ", 1)[1].split("; ")[0] for error in caught.value.errors] == [
        "sweep.vary.'cam.reuleaux.sides'[1]: an even number, given 4",
        "sweep.vary.'cam.reuleaux.sides'[2]: not a whole number, given 5.5",
        "sweep.vary.'cam.reuleaux.sides'[3]: above 99, given 101",
    ]
    with pytest.raises(RecipeErrors, match=re.escape("takes whole numbers alone; list them, such as [3, 5, 7]")):
        recipe(body.replace("VARY", "cam.reuleaux.sides: {from: 3, to: 7, steps: 5}"))


# --- what is said about faults ----------------------------------------------------------------------------------------

RANGE = "give a range such as {from: 95, to: 110, steps: 16}, or a list of values"
RANK = "  rank: dwell\n"
ROCKER = "  vary: {linkage.rocker: [95, 100]}\n"
FIRST_PATH = "cam.fourier.mean"


@pytest.mark.parametrize(
    ("axis", "message"),
    [
        ("cam.shaft: [1]", "no number stands there; give the path of a number in it, such as cam.shaft[0]"),
        ("cam.kind: [1]", "another cam has other keys; give it a recipe of its own"),
        (
            "linkage.dyads[0].offset: [1]",
            "the recipe gives it no value; give it a value first, which the sweep replaces",
        ),
        ("cam.fourier.sin.3: [1]", "the recipe gives it no value; give it a value first, which the sweep replaces"),
        ("cam.hypocycloid.size: [1]", "the recipe gives it no value; give it a value first, which the sweep replaces"),
        ("cam.shaft[2]: [1]", "unknown field, given 'cam.shaft[2]'; did you mean cam.shaft[1]?"),
        (
            "linkage.dyads[1].point[0]: [1]",
            ("unknown field, given 'linkage.dyads[1].point[0]'; did you mean linkage.dyads[0].point[0]?"),
        ),
        ("linkage.roker: [1]", "unknown field, given 'linkage.roker'; did you mean linkage.rocker?"),
        ("speed: [1]", f"unknown field, given 'speed'; give the path of a number, such as {FIRST_PATH}"),
        ("part.bore: [1]", f"unknown field, given 'part.bore'; give the path of a number, such as {FIRST_PATH}"),
        (
            "part.thickness: [1]",
            f"no figure of a design depends on it; vary numbers of cam and linkage, such as {FIRST_PATH}",
        ),
        (
            "dwell.band: [1]",
            f"no figure of a design depends on it; vary numbers of cam and linkage, such as {FIRST_PATH}",
        ),
        ("linkage.rocker: 100", f"not a range, given 100; {RANGE}"),
        ("linkage.rocker: []", f"an empty list; {RANGE}"),
        ("linkage.rocker:", f"not a range, given nothing; {RANGE}"),
        (
            "linkage.rocker: {from: 1, to: 2}",
            ("a grid needs steps; give a whole number from 2 to 1000000, or take the method random or sobol"),
        ),
        (
            f"linkage.rocker: [{', '.join(['1'] * (MOST_VALUES + 1))}]",
            "more than 1000 entries, given 1001; at most 1000 are read",
        ),
    ],
)
def test_an_axis(axis: str, message: str) -> None:
    path = axis.split(": ", maxsplit=1)[0].removesuffix(":")
    column = 5 + len(axis) - len(axis.split(":", 1)[1].lstrip())
    assert told(f"  vary:\n    {axis}\n{RANK}") == [f"2:{column}: {join('sweep.vary', path)}: {message}"]


@pytest.mark.parametrize(
    ("axis", "messages"),
    [
        (
            "{from: 100, to: 95, steps: 4}",
            [".to: not above `from`, given 95; give a greater number, or a list of values"],
        ),
        ("{from: 0, to: 95, steps: 4}", [".from: not above 0, given 0; linkage.rocker takes a length above 0"]),
        ("{from: 5, to: 1e7, steps: 4}", [".to: above 2000000, given 10000000; linkage.rocker takes a length above 0"]),
        ("[5, -1/8]", ["[1]: not above 0, given -0.125; linkage.rocker takes a length above 0"]),
        ("{from: 1, to: 2, steps: 1}", [".steps: below 2, given 1; give a whole number from 2 to 1000000"]),
        (
            "{from: 1, until: 2, steps: 4}",
            [
                ".to: missing; give a number in mm: last value",
                ".until: unknown key; the keys here are from, to and steps",
            ],
        ),
        ("{from: a, to: 2, steps: 4}", [".from: not a number, given 'a'; give a number in mm"]),
        ("[a]", ["[0]: not a number, given 'a'; give a number in mm"]),
    ],
)
def test_the_values_of_an_axis(axis: str, messages: list[str]) -> None:
    found = [message.split(": ", 1)[1] for message in told(f"  vary: {{linkage.rocker: {axis}}}\n{RANK}")]
    assert found == [f"sweep.vary.'linkage.rocker'{message}" for message in messages]


def test_a_number_that_is_faulty_itself_is_told_once() -> None:
    base = BASE.replace("rocker: 105", "rocker: 0")
    (message,) = told(ROCKER + RANK, base)
    assert ": linkage.rocker: not above 0" in message


def test_a_number_that_an_alias_shares_cannot_vary() -> None:
    base = BASE.replace("coupler: 70, rocker: 105", "coupler: &l 70, rocker: *l")
    assert told(ROCKER + RANK, base) == [
        (
            "1:26: sweep.vary.'linkage.rocker': a number that an alias shares with other fields; "
            "write the number out wherever it is meant"
        )
    ]
    assert sweep("  {vary: {linkage.ground: [80]}, rank: dwell}", base.replace("ground: 80", "ground: &g 80"))


@pytest.mark.parametrize(
    ("body", "messages"),
    [
        (
            "  {rank: dwell}",
            [
                (
                    "1:3: sweep.vary: missing; give a mapping from paths to ranges, such as "
                    "{linkage.rocker: {from: 95, to: 110, steps: 16}}: numbers and words of cam and linkage by their "
                    "paths, each with its range or values"
                )
            ],
        ),
        (
            "  vary: {}\n" + RANK,
            [
                (
                    "1:9: sweep.vary: nothing varies; give a mapping from paths to ranges, such as "
                    "{linkage.rocker: {from: 95, to: 110, steps: 16}}"
                )
            ],
        ),
        (
            "  vary: [1]\n" + RANK,
            [
                (
                    "1:9: sweep.vary: not a mapping, given a list of 1; give a mapping from paths to ranges, "
                    "such as {linkage.rocker: {from: 95, to: 110, steps: 16}}"
                )
            ],
        ),
        (
            ROCKER + "  count: 5\n  seed: 1\n" + RANK,
            [
                "2:10: sweep.count: a grid has no count; leave it out, or take the method random or sobol",
                "3:9: sweep.seed: a grid has no seed; leave it out, or take the method random or sobol",
            ],
        ),
        (
            "  vary: {linkage.rocker: {from: 95, to: 100, steps: 3}}\n  method: random\n" + RANK,
            [
                "1:3: sweep: random needs count; give the number of designs, such as count: 1000",
                "1:53: sweep.vary.'linkage.rocker'.steps: random has no steps; leave it out, or take a grid",
            ],
        ),
        (
            ROCKER + "  method: gird\n  count: 0\n" + RANK,
            [
                "2:11: sweep.method: not one of the choices, given 'gird'; did you mean grid?",
                "3:10: sweep.count: below 1, given 0; give a whole number from 1 to 100000000",
            ],
        ),
        (
            ROCKER + "  method: sobol\n  count: 8.5\n" + RANK,
            [
                "3:10: sweep.count: not a whole number, given 8.5; give a whole number from 1 to 100000000",
            ],
        ),
        (
            "  vary:\n    linkage.rocker: {from: 95, to: 99, steps: 1e4}\n"
            "    linkage.ground: {from: 95, to: 99, steps: 10001}\n" + RANK,
            [
                (
                    "2:5: sweep.vary: too many designs, given 100010000; at most 100000000 are looked at; "
                    "take fewer steps, or the method sobol with a count"
                )
            ],
        ),
        (
            ROCKER,
            [
                "1:3: sweep.rank: missing; give "
                + ", ".join([*FIGURES][:-1])
                + f" or {[*FIGURES][-1]}: figure by which the designs are ranked"
            ],
        ),
        (ROCKER + "  rank: dwel\n", ["2:9: sweep.rank: not one of the choices, given 'dwel'; did you mean dwell?"]),
        (ROCKER + "  refine: yes\n" + RANK, ["2:11: sweep.refine: not true or false, given 'yes'; give true or false"]),
        (
            ROCKER + "  keep: 0\n  angles: 12\n" + RANK,
            [
                "2:9: sweep.keep: below 1, given 0; give a whole number from 1 to 1000",
                "3:11: sweep.angles: below 24, given 12; give a whole number from 24 to 36000",
            ],
        ),
        (
            ROCKER
            + "  limits: {transmision: {at_least: 4}, size: {}, swing: {at_least: 5, at_most: 4}, margin: 3}\n"
            + RANK,
            [
                "2:12: sweep.limits.transmision: unknown figure; did you mean transmission-angle?",
                "2:46: sweep.limits.size: no bound; give at_least, at_most or both",
                "2:80: sweep.limits.swing.at_most: below at_least, so no design is accepted; exchange them",
                "2:92: sweep.limits.margin: not a mapping, given 3; give a mapping with at_least and at_most",
            ],
        ),
        (
            ROCKER + "  limits: {weight: {at_most: 4}, shaft-rate: {at_lest: 0}, size: {at_most: x}}\n" + RANK,
            [
                "2:12: sweep.limits.weight: unknown figure; the figures are "
                + ", ".join([name for name, one in FIGURES.items() if one.needs in HERE][:-1])
                + " and size",
                "2:47: sweep.limits.shaft-rate.at_lest: unknown key; did you mean at_least?",
                "2:76: sweep.limits.size.at_most: not a number, given 'x'; give a number in mm",
            ],
        ),
        (ROCKER + "  ranking: dwell\n" + RANK, ["2:3: sweep.ranking: unknown key; did you mean rank?"]),
    ],
)
def test_sweeps(body: str, messages: list[str]) -> None:
    assert told(body) == messages


def test_a_grid_may_be_just_as_large_as_is_permitted() -> None:
    ends = "from: 95, to: 99, steps: 1e4"
    found = sweep(f"  {{vary: {{linkage.rocker: {{{ends}}}, linkage.ground: {{{ends}}}}}, rank: dwell}}")
    assert [axis.steps for axis in found.vary] == [10_000, 10_000]


def test_a_bound_on_the_number_of_axes() -> None:
    axes = ", ".join(f"x{i}: [1]" for i in range(MOST_AXES + 1))
    assert told(f"  vary: {{{axes}}}\n{RANK}") == ["1:9: sweep.vary: more than 20 axes, given 21; leave some out"]


@pytest.mark.parametrize(("name", "figure"), FIGURES.items())
def test_a_figure_needs_what_it_is_taken_from(name: str, figure: object) -> None:
    needs = FIGURES[name].needs
    if needs not in HERE:
        return  # BASE has a linkage: see test_a_figure_that_a_linkage_has_not
    lines = BASE.splitlines(keepends=True)
    vary = "  vary: {cam.fourier.mean: [25]}\n"
    bodies = {
        "dwell": "".join(line for line in lines if not line.startswith("dwell")),
        "linkage": "".join(line for line in lines if not line.startswith(("dwell", "linkage"))),
    }
    section = needs.words
    remedy = f"{name} needs {section}; give {section}, or take another figure"
    for missing, base in bodies.items():
        for body, at in (
            (f"{vary}  rank: {name}\n", f"2:9: sweep.rank: {remedy}"),
            (
                f"{vary}  limits: {{{name}: {{at_least: 1}}}}\n  rank: size\n",
                f"2:{14 + len(name)}: sweep.limits.{name}: {remedy}",
            ),
        ):
            if (needs is OF_LINKAGE and missing == "linkage") or needs is OF_DWELL:
                assert told(body, base) == [at]
            else:
                assert sweep(body, base)
    assert figure is FIGURES[name]


@pytest.mark.parametrize(
    "name", [name for name, one in FIGURES.items() if one.needs in (OF_FOLLOWER, OF_ROLLER, OF_SWING)]
)
def test_a_figure_that_a_linkage_has_not(name: str) -> None:
    section = FIGURES[name].needs.words
    body = f"  vary: {{cam.fourier.mean: [25]}}\n  rank: {name}\n"
    assert told(body) == [f"2:9: sweep.rank: {name} needs {section}; give {section}, or take another figure"]


def test_a_sweep_may_stand_before_what_it_varies() -> None:
    top, _, last = BASE.partition("linkage:")
    body = "sweep: {vary: {linkage.rocker: [95]}, rank: dwell}\nlinkage:"
    assert recipe(top + body + last.replace("sweep:\n", "")).of(Sweep)


@pytest.mark.parametrize(
    ("path", "known"),
    [
        ("cam.shaft[0]", True),
        ("cam.fourier.cos.7", True),
        ("cam.fourier.cos.x", False),
        ("cam.base_radius", False),
        ("linkage.rocker", True),
        ("linkage.offset", False),
        ("linkage.dyads[3].offset", True),
        ("linkage.dyads[3].colour", False),
        ("export.tolerance", True),
        ("", False),
        ("cam..shaft", False),
        ("cam.shaft.x", False),
    ],
)
def test_fields_of_the_schema_are_known_by_their_paths(path: str, known: bool) -> None:
    kinds = {"cam": "support", "linkage": "four-bar"}
    assert (field_at(recipe_table(), path, kinds) is not None) == known


# --- units ------------------------------------------------------------------------------------------------------------


def refusal(text: str) -> str:
    with pytest.raises(RecipeErrors) as caught:
        load_text(text, "unit.yaml")
    return str(caught.value)


def support(text: str, units: str = "mm") -> str:
    return f"units: {units}\ncam: {{kind: support, p: 25 + 2*cos(3*t), shaft: [{text}, 4]}}\n"


def test_a_sweep_varies_in_the_unit_of_its_field() -> None:
    sweep = "sweep:\n  vary: {{{}}}\n  rank: size\n"
    at = "'cam.shaft[0]': "
    found = load_text(support("1 cm") + sweep.format(at + "{from: 1 cm, to: 0.75 in, steps: 4}"), "a.yaml").of(Sweep)
    assert found is not None
    assert (found.vary[0].low, found.vary[0].high) == (10.0, 19.05)
    listed = load_text(support("1", "inch") + sweep.format(at + "[12.7 mm, 1]"), "a.yaml").of(Sweep)
    assert listed is not None
    assert listed.vary[0].values == (0.5, 1.0)
    assert "'kg' is no unit of a length" in refusal(support("1") + sweep.format(at + "[1 kg]"))
    unknown = refusal(support("1") + sweep.format("cam.shoft: [1 mm]"))
    assert "unknown field" in unknown
    assert "no unit" not in unknown


def test_the_starter_is_a_search_of_its_own() -> None:
    assert sorted(ANSWERS.starters) == ["sweep"]
    search = ANSWERS.starters["sweep"].more["sweep"]
    assert isinstance(search, dict)
    assert search["rank"] == "dwell"
    assert str(search["vary"]).count("steps") == 2
