"""Whoever follows a message is helped: each remedy is applied to the recipe it was given for, and the fault is gone.

A figure is taken from the message itself, a little more than it asks for; where the message has none, the test chooses.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from camgeo.checks import remedies
from camgeo.output.pipeline import check
from camgeo.recipe.loading import load_text
from camgeo.report.document import summary
from camgeo.report.failure import remedy
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from collections.abc import Callable

    Follow = Callable[[float], str]

FILES = "\nexport: {tolerance: 0.001, files: [dxf]}\n"
SLIDER = "\nlinkage: {kind: slider-crank, coupler: 90, offset: 0}"
RISE = "motion: [{rise: 30, over: 100, law: cycloidal}, {dwell: 80}]"


def support(shape: str, more: str = "") -> str:
    return f"cam: {{kind: support, {shape}}}{more}{FILES}"


def roller(route: str, *, ratio: str = "4", radius: float = 8.0) -> str:
    return f"cam: {{kind: double-roller, ratio: {ratio}, arm: 40, roller_radius: {radius!r}, {route}}}{FILES}"


def pair(route: str) -> str:
    return f"cam: {{kind: flat-pair, ratio: 3, arm: 60, {route}}}{FILES}"


def arc(radius: float, side: str, ratio: str = "4") -> str:
    return roller(f"arc: {{radius: {radius!r}, side: {side}}}", ratio=ratio)


def humped(rise: float) -> str:
    return f"law: [{{rise: {rise}, over: 20, law: cycloidal}}, {{return: {rise}, over: 25, law: cycloidal}}]"


def driven(kind: str, **links: float) -> str:
    lengths = ", ".join(f"{name}: {length}" for name, length in links.items())
    shape = "fourier: {mean: 25, cos: {3: 2.938}}, shaft: [14.833, 0]"
    return support(shape, f"\nlinkage: {{{kind}, {lengths}}}")


def hung(link: float) -> str:
    dyad = f"{{kind: rrr, on: output, point: [80, 0], ground: [140, 80], links: [{link}, 30]}}"
    return f"\nlinkage: {{kind: four-bar, ground: 80, coupler: 70, rocker: 105, dyads: [{dyad}]}}"


def ringed(outer: float, hole: float) -> str:
    more = f"\npart: {{outer: {outer}, bolts: {{count: 3, circle: 147, hole: {hole}}}}}"
    cam = f"kind: disc, base_radius: 60, track: internal, follower: {{kind: roller, radius: 8}}, motion: {SHARP}"
    return f"cam: {{{cam}}}{more}{FILES}"


def waves(count: int) -> str:
    motion = f"motion: {{formula: 5*(1-cos({count}*t))}}"
    return f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8}}, {motion}}}{FILES}"


MATCHED = "{rise: 5, over: 100, law: match}, {rise: 15, over: 80, law: cycloidal}, {return: 20, over: 180, law: match}"
SHARP = "[{rise: 20, over: 60, law: cycloidal}, {dwell: 10}, {return: 20, over: 60, law: cycloidal}, {dwell: 230}]"


def swung(
    rise: float = 20,
    over: float = 140,
    rest: float | None = None,
    *,
    ground: float = 80,
    rocker: float = 2,
    law: str = "cycloidal",
    linkage: str = "inverted-slider-crank",
) -> str:
    left = (60 if over == 120 else 180 + rise - over) if rest is None else rest
    dwell = f", {{dwell: {left}}}" if left else ""
    frame = f"linkage: {{kind: {linkage}, ground: {ground}, rocker: {rocker}}}"
    swing = f"swing: [{{rise: {rise}, over: {over}, law: {law}}}{dwell}]"
    return f"cam: {{kind: constant-breadth, base_radius: 110, {swing}}}\n{frame}{FILES}"


def disc(base: float, follower: str, more: str = "", track: str = "") -> str:
    return (
        f"cam: {{kind: disc, base_radius: {base!r}, follower: {{{follower}}}, {track}motion: {SHARP}}}{more}{FILES}"
        + ("\npart: {outer: 400}\n" if track else "")
    )


def diameter(base: float, radius: float, more: str = FILES) -> str:
    lift = "motion: [{rise: 20, over: 60, law: cycloidal}, {dwell: 120}]"
    return f"cam: {{kind: constant-diameter, base_radius: {base!r}, roller_radius: {radius!r}, {lift}}}{more}"


def said(text: str) -> str:
    """What a design of the recipe is advised, empty if nothing; its files are not made."""
    try:
        design = designed(load_text(text, "tried.yaml"))
    except RecipeErrors as errors:
        return str(errors)
    return "\n".join(f"{each.name}: {each.value} {each.detail}" for each in design.checks if not each.ok)


def said_of_files(text: str) -> str:
    """The same of a design and its files, with what a failing check's remedy tells."""
    recipe = load_text(text, "tried.yaml")
    try:
        report = check(recipe).report
    except RecipeErrors as errors:
        return str(errors)
    failed = [each for each in report["checks"] if not each["ok"]]
    return "\n".join(f"{each['name']}: {each.get('detail', '')}; {remedy(each, report, recipe)}" for each in failed)


def figure(told: str, pattern: str) -> float:
    found = re.search(pattern, told)
    assert found, told
    return float(found[1]) if found.groups() else 0.0


# what is wrong; the remedy, its figure in brackets; the recipe with the remedy
HUBBED = "\npart: {{thickness: 10, bore: 20, hub: {{diameter: {0}, height: 5}}, {1}}}"
DESIGNS: list[tuple[str, str, Follow]] = [
    (support("p: -25"), r"add more than (\S+) to p", lambda by: support(f"p: -25 + {1.001 * by}")),
    (support("p: -25", SLIDER), r"add more than (\S+) to p", lambda by: support(f"p: -25 + {1.001 * by}", SLIDER)),
    (support("p: 15*cos(t)"), r"add more than (\S+) to p", lambda by: support(f"p: 15*cos(t) + {1.001 * by}")),
    (
        support("fourier: {mean: 1e-30}, shaft: [10, 4]"),
        r"fourier\.mean: .*; give a larger one",
        lambda _: support("fourier: {mean: 1}, shaft: [10, 4]"),
    ),
    (
        support("p: 25 + 5*cos(3*t)"),
        r"a p larger by more than (\S+) would have no undercut",
        lambda by: support(f"p: 25 + 5*cos(3*t) + {1.00001 * by}"),
    ),
    (
        support("p: 25 + cos(1000*t)"),
        r"a p larger by more than (\S+) would have no undercut",
        lambda by: support(f"p: 25 + cos(1000*t) + {1.00001 * by}"),
    ),
    (
        support("fourier: {mean: 25, cos: {3: 5}}"),
        r"a fourier\.mean larger by more than (\S+) would have no undercut",
        lambda by: support(f"fourier: {{mean: {25 + 1.00001 * by}, cos: {{3: 5}}}}"),
    ),
    (
        support("hypocycloid: {cusps: 3, size: 5, breadth: 50}"),
        r"a hypocycloid\.breadth larger by more than (\S+) would have no undercut",
        lambda by: support(f"hypocycloid: {{cusps: 3, size: 5, breadth: {50 + 1.00001 * by}}}"),
    ),
    (
        f"cam: {{kind: constant-breadth, base_radius: 5, {RISE}}}{FILES}",
        r"a base radius larger by more than (\S+) would have no undercut",
        lambda by: f"cam: {{kind: constant-breadth, base_radius: {5 + 1.00001 * by}, {RISE}}}{FILES}",
    ),
    (swung(over=120), r"let it cover (\S+), 180 and its net rise", lambda span: swung(over=120, rest=span - 120)),
    (swung(over=70), r"spread the swing over a larger angle", lambda _: swung(over=115)),
    (swung(over=70), r"or swing less", lambda _: swung(9, over=70)),
    (swung(rocker=85), r"or a rocker within (\S+) mm of the joint's offset", lambda by: swung(rocker=0.2 * by)),
    (swung(rocker=85), r"give a ground above (\S+) mm", lambda by: swung(rocker=85, ground=1.4 * by)),
    (swung(law="{polynomial: [0, 1]}", rest=0, over=200), r"let it rest at both ends", lambda _: swung()),
    (swung(linkage="four-bar, coupler: 60"), r"give linkage: \{kind: inverted-slider-crank", lambda _: swung()),
    (
        roller("delta: {cos: {1: 400}}", ratio="4/3", radius=30.0),
        r"a roller radius below (\S+) would have no undercut",
        lambda below: roller("delta: {cos: {1: 400}}", ratio="4/3", radius=0.99999 * below),
    ),
    (
        pair("delta: {cos: {1: 2390}}"),
        "a smaller swing would have no undercut",
        lambda _: pair("delta: {cos: {1: 2000}}"),
    ),
    (
        pair("arc: {radius: 300}"),
        r"an arc\.radius nearer to (\S+) would have no undercut",
        lambda mean: pair(f"arc: {{radius: {mean + 10}}}"),
    ),
    (
        support("p: 25 + 1e-9*cos(20000*t)"),
        r"p has about 2e\+04 waves in a turn; no more than (\S+) are worked out",
        lambda most: support(f"p: 25 + 1e-9*cos({most:.0f}*t)"),
    ),
    (
        support("p: 25 + 25*cos(3001*t)", SLIDER),
        "give p fewer or lower waves",
        lambda _: support("p: 25 + 1e-4*cos(101*t)", SLIDER),
    ),
    (
        support("p: 25 + 1e-6*cos(1001*t)", SLIDER),
        "keep its loops farther from binding, or give p fewer waves",
        lambda _: support("p: 25 + 1e-6*cos(101*t)", SLIDER),
    ),
    (
        support("p: 25 + cos(2*t)", SLIDER),
        "give p odd harmonics alone",
        lambda _: support("p: 25 + cos(3*t)", SLIDER),
    ),
    (
        support("p: 25 + cos(3*t)", f"{SLIDER}\ndwell: {{band: 1e-16}}"),
        "give a wider band",
        lambda _: support("p: 25 + cos(3*t)", f"{SLIDER}\ndwell: {{band: 0.01}}"),
    ),
    (
        arc(30.0, "convex", "2"),
        r"a convex arc needs a radius of at least (\S+) mm",
        lambda least: arc(1.1 * least, "convex", "2"),
    ),
    *(
        (
            arc(300.0, "concave", ratio),
            "a convex arc would satisfy it",
            lambda _, ratio=ratio: arc(300.0, "convex", ratio),
        )
        for ratio in ("2", "3", "4")
    ),
    (arc(1e6, "concave"), "or a ratio such as 5/3", lambda _: arc(1e6, "concave", "5/3")),
    *(
        (
            arc(20.0, "concave", ratio),
            r"a concave arc needs a radius above (\S+) mm",
            lambda above, ratio=ratio: arc(1.00001 * above, "concave", ratio).replace("8.0", "0.5"),
        )
        for ratio in ("5/3", "7/3", "8/3")
    ),
    *(
        (
            disc(prime - radius, f"kind: {kind}, radius: {radius!r}{more}"),
            rf"a {kind} radius below (\S+) with a base radius of {prime:g} less that radius",
            lambda below, prime=prime, kind=kind, more=more: disc(
                prime - 0.9999 * below, f"kind: {kind}, radius: {0.9999 * below!r}{more}"
            ),
        )
        for kind, prime, radius, more in (
            ("roller", 26.0, 18.0, ""),
            ("roller", 26.0, 18.0, ", offset: 7"),
            ("shoe", 40.0, 38.0, ""),
            ("roller", 26.0, 20.0, ", arm: {pivot: 60, length: 52}"),
        )
    ),
    (
        disc(80.0, "kind: roller, radius: 50", track="track: internal, "),
        r"a roller radius below (\S+) with a base radius of 30 and that radius",
        lambda below: disc(
            50.0 + 0.9999 * below, f"kind: roller, radius: {0.9999 * below!r}", track="track: internal, "
        ),
    ),
    (
        diameter(10.0, 18.0),
        r"a roller radius below (\S+) with a base radius of 28 less that radius",
        lambda below: diameter(28.0 - 0.9999 * below, 0.9999 * below),
    ),
    (
        disc(20.0, "kind: flat"),
        r"a base radius larger by more than (\S+) ",
        lambda by: disc(20.0 + 1.001 * by, "kind: flat"),
    ),
    (
        disc(20.0, "kind: flat, arm: {pivot: 60}"),
        r"a base radius larger by more than (\S+) with arm\.face smaller by as much",
        lambda by: disc(20.0 + 1.001 * by, f"kind: flat, arm: {{pivot: 60, face: {-1.001 * by!r}}}"),
    ),
    (
        support("p: 25, shaft: [40, 0]", "\npart: {bore: 10}"),
        "the shaft lies outside the contour",
        lambda _: support("p: 25, shaft: [10, 0]", "\npart: {bore: 10}"),
    ),
    (
        support("p: -25 + 5*cos(3*t)"),
        r"add more than (\S+) to p",
        lambda by: support(f"p: -25 + 5*cos(3*t) + {1.00001 * by}"),
    ),
    *(
        (
            arc(radius, "convex"),
            r"a convex arc needs a radius above (\S+) mm",
            lambda above: arc(1.001 * above, "convex").replace("8.0", "0.5"),
        )
        for radius in (30.0, 40.0)
    ),
    (
        roller("delta: {cos: {1: 1500, 3: 300}}", radius=0.5),
        r"with each value of D multiplied by (\S+) such a motion is possible",
        lambda share: roller(f"delta: {{cos: {{1: {1500 * share}, 3: {300 * share}}}}}", radius=0.5),
    ),
    (
        roller("delta: {formula: 1700*cos(4*t)}", radius=0.5),
        r"with each value of D multiplied by (\S+) such a motion is possible",
        lambda share: roller(f"delta: {{formula: {1700 * share}*cos(4*t)}}", radius=0.5),
    ),
    (
        roller(humped(30.0), radius=0.1),
        r"with each stroke multiplied by (\S+) such a motion is possible",
        lambda share: roller(humped(30.0 * share), radius=0.1),
    ),
    *(
        (
            driven(f"kind: {kind}", **links),
            rf"with linkage\.{name} (\S+) mm it would turn",
            lambda length, kind=kind, links=links, name=name: driven(f"kind: {kind}", **{**links, name: length}),
        )
        for kind, name, links in (
            ("four-bar", "ground", {"ground": 79.28, "coupler": 30, "rocker": 30}),
            ("four-bar", "rocker", {"ground": 79.28, "coupler": 61.85, "rocker": 10}),
            ("inverted-slider-crank", "ground", {"ground": 12, "rocker": 5}),
        )
    ),
    (
        support("p: 25 + cos(3*t)", hung(50.0)),
        r"with linkage\.dyads\[0\]\.links\[0\] (\S+) mm it would turn",
        lambda length: support("p: 25 + cos(3*t)", hung(length)),
    ),
    (
        support("fourier: {mean: 20, cos: {3: 2.503}}"),
        "or let what is lost be cut off: undercut: trim",
        lambda _: support("fourier: {mean: 20, cos: {3: 2.503}}, undercut: trim"),
    ),
    (
        disc(36.0, "kind: roller, radius: 8", "\npart: {bore: 20, bolts: {count: 4, circle: 70, hole: 12}}"),
        r"a part\.bolts\.hole below (\S+) mm would do",
        lambda below: disc(
            36.0,
            "kind: roller, radius: 8",
            f"\npart: {{bore: 20, bolts: {{count: 4, circle: 70, hole: {0.999 * below}}}}}",
        ),
    ),
    (
        disc(
            40.0,
            "kind: roller, radius: 8",
            "\npart: {bore: 20, wall: 3, dowel: {circle: 40, hole: 16}}",
        ),
        r"a part\.dowel\.hole below (\S+) mm would do",
        lambda below: disc(
            40.0,
            "kind: roller, radius: 8",
            f"\npart: {{bore: 20, wall: 3, dowel: {{circle: 40, hole: {0.999 * below}}}}}",
        ),
    ),
    (
        disc(
            40.0,
            "kind: roller, radius: 8",
            "\npart: {thickness: 10, bore: 28, wall: 3, hub: {diameter: 30, height: 10}}",
        ),
        r"a part\.bore below (\S+) mm would do",
        lambda below: disc(
            40.0,
            "kind: roller, radius: 8",
            f"\npart: {{thickness: 10, bore: {0.999 * below}, wall: 3, hub: {{diameter: 30, height: 10}}}}",
        ),
    ),
    *(
        (
            disc(40.0, "kind: roller, radius: 8", HUBBED.format(80.0, more)),
            r"a part\.hub\.diameter below (\S+) mm would do",
            lambda below, more=more: disc(40.0, "kind: roller, radius: 8", HUBBED.format(0.9999 * below, more)),
        )
        for more in ("chamfer: 2", "wall: 3")
    ),
    (
        ringed(150.0, 10.0),
        r"a part\.bolts\.hole below (\S+) mm and a part\.outer larger by more than \S+ mm would do",
        lambda below: ringed(
            150.0 + 1.001 * figure(said(ringed(150.0, 10.0)), r"larger by more than (\S+) mm"), 0.999 * below
        ),
    ),
    (
        waves(4000),
        "stretches of the contour run backwards; give the motion fewer or lower waves",
        lambda _: waves(2),
    ),
    (
        disc(40.0, "kind: roller, diameter: 16 mm"),
        r"cam\.follower\.diameter: unknown key; give radius: (\S+) mm",
        lambda radius: disc(40.0, f"kind: roller, radius: {radius} mm"),
    ),
    (
        f"cam: {{kind: disc, base_radius: 60, follower: {{kind: roller, radius: 8}}, motion: [{MATCHED}]}}{FILES}",
        r"two matched segments meet at 360 degrees: give the last entry `at_end: \{v: \.\.\., a: \.\.\.\}`",
        lambda _: (
            "cam: {kind: disc, base_radius: 60, follower: {kind: roller, radius: 8}, motion: "
            f"[{MATCHED[:-1]}, at_end: {{v: 0, a: 0}}}}]}}{FILES}"
        ),
    ),
]


@pytest.mark.thin(48)
@pytest.mark.parametrize(("text", "pattern", "follow"), DESIGNS, ids=[pattern for _, pattern, _ in DESIGNS])
def test_a_design_that_is_changed_as_told_is_sound(text: str, pattern: str, follow: Follow) -> None:
    assert not said(follow(figure(said(text), pattern)))


CHAMFERED = "\npart: {{bore: 10, thickness: 30, chamfer: {0!r}}}"
BORED = "\npart: {{bore: {0!r}, wall: 5}}"
LIMITED = "\nverify: {motion_error: 0.0005}"


# needs: dynamics
def sprung(preload: float, rate: float) -> str:
    train = f"rpm: 300, mass: 1, stiffness: 1e5, damping: 100, preload: {preload}, rate: {rate}"
    return disc(40.0, "kind: roller, radius: 10", f"\ndynamics: {{{train}}}\nverify: {{angles: 24}}")


COARSE = FILES.replace("0.001", "0.002")
FINER = "\nverify: {{motion_error: 0.001}}\nexport: {{tolerance: {}, files: [dxf]}}\n"


def needle(cos: float) -> str:
    """An ellipse between two faces, the thinner the nearer to 1600."""
    cam = f"{{kind: flat-pair, ratio: 2, arm: 40, delta: {{cos: {{1: {cos}}}}}}}"
    return f"cam: {cam}\nexport: {{tolerance: 0.001, files: [dxf]}}\n"


WITH_FILES: list[tuple[str, str, Follow]] = [
    (
        needle(1599.9984),
        r"psi'\(phi\) reaches (0\.9999\d+), .*; a smaller swing would satisfy it",
        lambda _: needle(1500.0),
    ),
    (
        support("p: 25 + 2*cos(3*t)", CHAMFERED.format(9.5)),
        r"a chamfer below (\S+) mm",
        lambda below: support("p: 25 + 2*cos(3*t)", CHAMFERED.format(0.999 * below)),
    ),
    # needs: dynamics
    (
        sprung(10.0, 0.0),
        r"a dynamics\.preload of (\S+)",
        lambda preload: sprung(preload, 0.0),
    ),
    # needs: dynamics
    (
        sprung(10.0, 5000.0),
        r"a dynamics\.preload of (\S+)",
        lambda preload: sprung(preload, 5000.0),
    ),
    (
        disc(40.0, "kind: roller, radius: 8", "\nmanufacture: {wheel: 200, cutter: 6}"),
        r"a manufacture\.wheel of (\S+) mm or less",
        lambda wheel: disc(40.0, "kind: roller, radius: 8", f"\nmanufacture: {{wheel: {wheel}, cutter: 6}}"),
    ),
    (
        disc(100.0, "kind: flat, width: 10"),
        r"a follower\.width of (\S+) mm or more",
        lambda width: disc(100.0, f"kind: flat, width: {width}"),
    ),
    (
        disc(100.0, "kind: flat, diameter: 10, axial_offset: 2"),
        r"a follower\.diameter of (\S+) mm or more",
        lambda diameter: disc(100.0, f"kind: flat, diameter: {diameter}, axial_offset: 2"),
    ),
    (
        driven("kind: four-bar", ground=79.28, coupler=61.85, rocker=60).replace(
            "\nexport", "\ndwell: {band: 0.1, at_least: 120}\nexport"
        ),
        r"a dwell\.at_least of (\S+) or less",
        lambda length: driven("kind: four-bar", ground=79.28, coupler=61.85, rocker=60).replace(
            "\nexport", f"\ndwell: {{band: 0.1, at_least: {length}}}\nexport"
        ),
    ),
    (support("p: 0*t"), "a larger p$", lambda _: support("p: 0*t + 1")),
    (
        support("fourier: {mean: 20, cos: {3: 2.5}}"),
        r"a larger fourier\.mean",
        lambda _: support("fourier: {mean: 20.1, cos: {3: 2.5}}"),
    ),
    (
        support("p: 25", BORED.format(45.0)),
        r"a bore smaller by more than (\S+) mm",
        lambda by: support("p: 25", BORED.format(45.0 - 1.001 * by)),
    ),
    (
        disc(26.0, "kind: roller, radius: 8", "\nlimits: {radius-of-curvature: {at_least: 14}}"),
        r"a roller radius of (\S+) mm with a base radius of 34 less that radius",
        lambda radius: disc(
            34.0 - radius, f"kind: roller, radius: {radius!r}", "\nlimits: {radius-of-curvature: {at_least: 14}}"
        ),
    ),
    (
        diameter(30.0, 8.0, FINER.format(0.002)),
        r"a tolerance of about (\S+), or verify",
        lambda tolerance: diameter(30.0, 8.0, FINER.format(tolerance)),
    ),
    (
        support("p: 25 + 2*cos(3*t)", LIMITED).replace("0.001,", "0.002,"),
        r"a tolerance of (\S+), or verify",
        lambda tolerance: support("p: 25 + 2*cos(3*t)", LIMITED).replace("0.001,", f"{tolerance},"),
    ),
    (
        support("p: 25 + 2*cos(3*t)", LIMITED).replace("0.001,", "0.002,"),
        r"verify\.motion_error above (\S+)",
        lambda above: support("p: 25 + 2*cos(3*t)", LIMITED.replace("0.0005", f"{1.001 * above}")).replace(
            "0.001,", "0.002,"
        ),
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "pattern", "follow"), WITH_FILES, ids=[pattern for _, pattern, _ in WITH_FILES])
def test_files_of_a_recipe_that_is_changed_as_told_pass(text: str, pattern: str, follow: Follow) -> None:
    assert not said_of_files(follow(figure(said_of_files(text), pattern)))


def failed(value: float | None, limit: float | None = 0.0, **more: object) -> dict[str, object]:
    return {"name": "tried", "value": value, "limit": limit, "unit": "mm", "file": "tried.dxf", **more}


def test_what_a_failed_check_is_told() -> None:
    """Of the check and the recipe alone; nothing where nothing is known."""
    ring = load_text(ringed(150.0, 10.0), "ring.yaml")
    bored, cam = (load_text(support("p: 25", more), "plate.yaml") for more in (BORED.format(45.0), ""))
    lone = load_text(disc(80.0, "kind: roller, radius: 8", track="track: internal, "), "ring.yaml")
    asked = load_text(support("p: 25", LIMITED), "asked.yaml")
    inches = load_text(f"units: inch\n{support('p: 1', BORED.format(0.4).replace('5', '0.2'))}", "plate.yaml")
    pair_of_faces = load_text(needle(1500.0).replace("export", "verify: {motion_error: 0.5}\nexport"), "asked.yaml")
    card = "{lobe: {lift: 9, nose: 180, duration: [{at_lift: 1, degrees: 240}, {at_lift: 5, degrees: 120}]}}"
    lobe = f"cam: {{kind: disc, base_radius: 18, follower: {{kind: flat}}, motion: {card}}}"
    carded = load_text(lobe, "card.yaml")
    faced = load_text(lobe.replace("lift: 9", "lift: 9, least: face"), "card.yaml")
    report = {"files": [{"path": "tried.dxf", "tolerance": 0.002}], "checks": [{"name": "tried", "value": 40.0}]}
    unknown = {**report, "checks": [*report["checks"], {"name": "tried", "value": None}]}
    shorter = {**report, "checks": [*report["checks"], {"name": "tried", "value": 30.0}, {"name": "x", "value": 1.0}]}
    less = "opening and outline: 2 mm"
    for what, check_made, recipe, words in (
        (remedies.rounder, failed(-3.0), cam, "a p larger by more than 3 mm"),
        (remedies.rounder, failed(None), cam, ""),
        (remedies.rounder, failed(1.0, None), cam, ""),
        (remedies.smaller_wheel, failed(20.0), cam, "a manufacture.wheel of 40 mm or less"),
        (remedies.smaller_wheel, failed(0.0), cam, ""),
        (remedies.wider_face, failed(12.0), cam, "a follower.width of 12 mm or more"),
        (
            remedies.wider_face,
            failed(12.0),
            carded,
            "a follower.width of 12 mm or more, or cam.motion.lobe.least: face",
        ),
        (remedies.wider_face, failed(12.0), faced, "a follower.width of 12 mm or more"),
        (remedies.smaller_bore, failed(2.0, 5.0), bored, "a bore smaller by more than 6 mm"),
        (remedies.smaller_bore, failed(-17.4, 5.0), bored, "a bore smaller by more than 44.8 mm"),
        (remedies.smaller_bore, failed(-17.5, 5.0), bored, ""),  # the whole bore
        (remedies.smaller_bore, failed(None, 5.0), bored, ""),
        (remedies.smaller_bore, failed(0.1, 0.2, unit="in"), inches, "a bore smaller by more than 0.2 in"),
        (remedies.smaller_bore, failed(0.1, 0.31, unit="in"), inches, ""),
        # rounded up it is the whole bore of 0.4 in
        (remedies.smaller_bore, failed(0.1, 0.29999999, unit="in"), inches, ""),
        (remedies.smaller_bore, failed(0.1, 0.2999, unit="in"), inches, "a bore smaller by more than 0.3998 in"),
        (remedies.smaller_bore, failed(2.0, 5.0), cam, ""),
        (remedies.smaller_bore, failed(2.0, 5.0), ring, ""),
        (remedies.smaller_bore, failed(2.0, 5.0), lone, "a part.outer larger by more than 6 mm"),
        (remedies.smaller_bore, failed(2.0, 5.0, detail=less), ring, "a part.outer larger by more than 6 mm"),
        (remedies.smaller_bore, failed(2.0, 5.0, detail=f"{less}; more would do"), ring, ""),
        (remedies.nearer, failed(0.001, 0.0005), asked, "a tolerance of 0.0005, or verify.motion_error above 0.001"),
        (remedies.nearer, failed(0.001, 0.0005), cam, ""),
        (remedies.nearer, failed(0.0, 0.0005), asked, ""),
        (remedies.nearer, failed(None, 0.0005), asked, ""),
        # the error of a swing varies with the place: about as the tolerance
        (
            remedies.nearer,
            failed(0.8, 0.5),
            pair_of_faces,
            "a tolerance of about 0.0013, or verify.motion_error above 0.8",
        ),
        (
            remedies.nearer,
            failed(0.8, 0.5, file="other.dxf"),
            pair_of_faces,
            "verify.motion_error above 0.8",
        ),
        (remedies.looser, failed(0.004, 0.001), asked, "verify.motion_error above 0.002"),  # four times what it is
        (remedies.looser, failed(0.8, 0.5), pair_of_faces, "verify.motion_error above 0.8"),  # degrees
        (remedies.looser, failed(0.004, 0.0), asked, ""),
        (remedies.looser, failed(0.004, 0.001), cam, ""),
    ):
        assert what(check_made, report, recipe) == words, (what.__name__, check_made)
    for all_checks, words in (
        (report, "a dwell.at_least of 40 or less, or a wider dwell.band"),
        (shorter, "a dwell.at_least of 30 or less, or a wider dwell.band"),
        (unknown, ""),
        ({"checks": [{"name": "tried", "value": 0.0}]}, ""),
    ):
        assert remedies.shorter_dwell(failed(1.0), all_checks, cam) == words


@pytest.mark.slow
def test_a_sized_ring_is_rounder_by_a_smaller_roller_alone() -> None:
    def ring(radius: float, least: float) -> str:
        size = "sizing: {pressure-angle: {at_most: 30}}, track: internal"
        cam = f"kind: disc, {size}, follower: {{kind: roller, radius: {radius!r}}}, motion: {SHARP}"
        return f"cam: {{{cam}}}\npart: {{outer: 900}}\nlimits: {{radius-of-curvature: {{at_least: {least}}}}}{FILES}"

    smaller = figure(said_of_files(ring(6.0, 76.0)), r"a roller radius of (\S+) mm would satisfy it")
    assert smaller < 6.0
    assert said_of_files(ring(smaller, 76.0)) == ""
    # less than the whole roller does not make it so round
    (told,) = said_of_files(ring(6.0, 200.0)).splitlines()
    assert "roller" not in told
    kept = figure(told, r"limits\.radius-of-curvature\.at_least of (\S+) would satisfy it")
    assert said_of_files(ring(6.0, kept)) == ""


@pytest.mark.slow
def test_a_face_on_a_stem_is_as_wide_on_a_larger_cam() -> None:
    def limited(base: float) -> str:
        return said_of_files(disc(base, "kind: flat", "\nlimits: {face-width: {at_most: 20}}"))

    assert "base radius" not in limited(120.0)
    assert limited(120.0) == limited(160.0) != ""
    assert "a smaller stroke, or the same over a wider angle would satisfy it" in limited(120.0)


def test_a_smaller_swing_has_a_smaller_pressure_angle() -> None:
    recipes = (load_text(roller(f"delta: {{cos: {{1: {size}}}}}"), "swung.yaml") for size in (400, 200))
    wide, narrow = ({each.name: each.value for each in designed(recipe).checks} for recipe in recipes)
    assert narrow["velocity-ratio"] < 0.75 * wide["velocity-ratio"]
    assert narrow["pressure-angle"] < wide["pressure-angle"]


def test_a_limit_that_is_not_allowed_itself_is_told_as_such() -> None:
    report = check(load_text(support("p: 0*t"), "tried.yaml")).report
    assert "radius-of-curvature: 0 mm, more than 0 needed" in summary(report)


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("p", "words"),
    [
        ("25 + 25*cos(99*t)", "99 stretches of the contour run backwards into each other; up to 40 are separated"),
        ("25 + cos(1000*t)", "1000 stretches of the contour run backwards; up to 200 are reported one by one"),
    ],
)
def test_undercut_in_very_many_places_is_told_as_a_number(p: str, words: str) -> None:
    """Each of them takes milliseconds, or the square of their number where they cross."""
    assert words in said(support(f"p: {p}, undercut: trim"))


@pytest.mark.parametrize("word", ["roller", "translating-roller", "plate", "flat", "groove"])
def test_a_kind_of_cam_that_is_none_tells_which_are_made(word: str) -> None:
    told = said(f"cam: {{kind: {word}}}\n")
    assert all(
        f"({kind}" in told for kind in ("disc", "constant-breadth", "constant-diameter", "double-roller", "flat-pair")
    )
    assert told.endswith("other cams are not made")
    assert said("cam: {kind: suport}\n").endswith("did you mean support?")


def test_why_a_motion_of_constant_breadth_covers_a_half_turn() -> None:
    whole = "motion: [{rise: 20, over: 180, law: harmonic}, {return: 20, over: 180, law: harmonic}]"
    told = said(f"cam: {{kind: constant-breadth, base_radius: 40, {whole}}}\n")
    assert "given 360 degrees; let them cover one half turn, 180 degrees; two parallel faces hold the cam" in told
