"""Records of contacts against the judge: what the maker says of a follower is what kin holds a contour against.

A field of a record that kin did not read would be silently wrong. So each is put wrong in turn: kin refuses the record,
or finds the maker's own contour faulty.
"""

from __future__ import annotations

import math
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.fit.arcs import fit_arcs
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour
from kin.follower.follower import followers_of
from kin.follower.motion_error import ContactError
from kin.law.contacts import Arrangement, Contact, Flat, Oscillating, Roller, Shoe, Translating

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any


MOTION = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 40}, {return: 8, over: 140, law: cycloidal}, {dwell: 60}]"
SWING = MOTION.replace(": 8,", ": 12,")
HALF = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 60}]"


GROOVE = "{groove: {clearance: 0.03}}"


def disc(follower: str, motion: str = MOTION, track: str = "external", conjugate: str = "") -> str:
    part = "part: {outer: 160}\n" if track == "internal" else ""
    more = f"conjugate: {{{conjugate}}}, " * bool(conjugate)
    cam = f"base_radius: 40, track: {track}, {more}follower: {{{follower}}}, motion: {motion}"
    return f"{part}cam: {{kind: disc, {cam}}}"


ARM = "arm: {length: 65, pivot: 80}"
RECIPES = {
    "roller on a stem": disc("kind: roller, radius: 10, offset: 6"),
    "knife edge on a stem": disc("kind: knife-edge, offset: -5"),
    "shoe on a stem": disc("kind: shoe, radius: 60"),
    "roller on a trailing arm": disc(f"kind: roller, radius: 10, {ARM}", SWING),
    "roller on a leading arm": disc(f"kind: roller, radius: 10, {ARM[:-1]}, side: leading}}", SWING),
    "knife edge on an arm": disc(f"kind: knife-edge, {ARM}", SWING),
    "shoe on an arm": disc(f"kind: shoe, radius: 30, {ARM}", SWING),
    "ring on a stem": disc("kind: roller, radius: 10, offset: 6", MOTION, "internal"),
    "ring on an arm": disc(f"kind: roller, radius: 10, {ARM}", SWING, "internal"),
    "groove on a stem": disc("kind: roller, radius: 10, offset: 6", MOTION, GROOVE),
    "groove on an arm": disc(f"kind: roller, radius: 10, {ARM}", SWING, GROOVE),
    "conjugate rollers on a stem": disc(
        "kind: roller, radius: 10, offset: 6", MOTION, conjugate="radius: 12, distance: 118"
    ),
    "conjugate shoes on a stem": disc("kind: shoe, radius: 20", MOTION, conjugate="distance: 130, gap: 2"),
    "conjugate rollers on a bell crank": disc(
        f"kind: roller, radius: 10, {ARM}", SWING, conjugate="radius: 9, length: 60, angle: 95"
    ),
    "conjugate rollers on a leading bell crank": disc(
        f"kind: roller, radius: 10, {ARM[:-1]}, side: leading}}", SWING, conjugate="length: 70, angle: 90"
    ),
    "conjugate flat faces": disc("kind: flat, offset: 3", MOTION, conjugate="distance: 90"),
    "flat on a stem": disc("kind: flat"),
    "tilted flat on a stem": disc("kind: flat, tilt: 8, offset: 5"),
    "flat on a trailing arm": disc("kind: flat, arm: {pivot: 90, face: 5}", SWING.replace("12,", "6,")),
    "flat on a leading arm": disc("kind: flat, arm: {pivot: 90, side: leading}", SWING.replace("12,", "6,")),
    "flat by its support function": "cam: {kind: support, p: 30 + 3*cos(2*t)}",
    "yoke": "cam: {kind: support, p: 30 + 2*cos(3*t)}",
    "yoke by its motion": f"cam: {{kind: constant-breadth, base_radius: 40, motion: {HALF}}}",
    "roller yoke": f"cam: {{kind: constant-diameter, base_radius: 40, roller_radius: 10, motion: {HALF}}}",
    "double roller": "cam: {kind: double-roller, ratio: 3, arm: 60, roller_radius: 8, delta: {cos: {1: 400}}}",
    "flat pair": "cam: {kind: flat-pair, ratio: 3, arm: 40, delta: {cos: {1: 200}}}",
}
OFF = 1e-2  # mm, rad: by how much a field is put wrong
SEEN = 1e-4  # mm, deg: more than the contour's own error
PHI = np.radians(np.arange(0.0, 360.0, 5.0))


@cache
def held(name: str) -> tuple[Any, ...]:
    """Contacts, law, and of each surface of a recipe's cam its side and its contour."""
    design = designed(read(RECIPES[name].encode(), Path("c.yaml")))
    surfaces = {}
    for surface, contour in design.contours:
        arcs = fit_arcs(contour, 1e-6)
        surfaces[surface.name] = surface.side, Contour.from_bulges(arcs.points, arcs.bulges)
    assert surfaces
    return design.follower.contacts, design.exact.judged_law, surfaces


def off(name: str, contacts: tuple[Contact[Any, Any], ...], turned: int = 1) -> float:
    """By how much a contour is off, mm or deg, infinite where kin refuses the contacts."""
    _, law, surfaces = held(name)
    sides: Any = {surface: turned * side for surface, (side, _) in surfaces.items()}
    worst = [0.0]
    try:
        for surface, follower in followers_of(contacts, law, sides).items():
            judged = follower.judge(surfaces[surface][1], PHI)
            play = judged.play
            worst += [judged.motion.max, *((abs(play.least), abs(play.most)) if play else ())]
    except (ContactError, ValueError):
        return math.inf
    return max(worst)


def wrong(contact: Contact[Any, Any]) -> Iterator[tuple[str, Contact[Any, Any]]]:
    """The contact with each of its fields, and each of its guide's and touch's, put wrong."""
    for field in fields(Contact):
        value = getattr(contact, field.name)
        if field.name == "sense":
            yield "sense", replace(contact, sense=-value)
        elif field.name == "surface":
            yield "surface", replace(contact, surface="another")
        elif field.name in {"guide", "touch"}:
            for one in fields(value):
                inner = getattr(value, one.name)
                if inner is None or free(contact, field.name, one.name):
                    continue
                other = -inner if one.name == "side" else inner + OFF
                yield f"{field.name}.{one.name}", replace(contact, **{field.name: replace(value, **{one.name: other})})
        else:
            yield field.name, replace(contact, **{field.name: value + OFF})


def free(contact: Contact[Any, Any], *name: str) -> bool:
    """Whether a field says nothing that a contour could show."""
    straight = isinstance(contact.touch, Flat) and not contact.touch.tilt
    return name == ("touch", "width") or (straight and name == ("guide", "offset"))


def exchanged(contacts: tuple[Contact[Any, Any], ...]) -> tuple[Contact[Any, Any], ...]:
    """Two contacts each in the other's place, and on its surface; one of them twice."""
    if len(contacts) == 1:
        return contacts * 2
    surfaces = [one.surface for one in contacts]
    return tuple(replace(one, surface=surface) for one, surface in zip(contacts[::-1], surfaces, strict=True))


@pytest.mark.thin(7)
@pytest.mark.parametrize("name", RECIPES)
def test_the_record_is_what_the_judge_finds(name: str) -> None:
    contacts = held(name)[0]
    assert off(name, contacts) < SEEN


@pytest.mark.thin(16)
@pytest.mark.parametrize("name", RECIPES)
def test_no_field_of_a_record_is_left_unread(name: str) -> None:
    contacts = held(name)[0]
    tried = 0
    for index, contact in enumerate(contacts):
        for field, other in wrong(contact):
            changed = (*contacts[:index], other, *contacts[index + 1 :])
            assert off(name, changed) > SEEN, f"contact {index + 1}: {field}"
            tried += 1
    assert tried >= 5 * len(contacts)
    if contacts[0].touch.radius or isinstance(contacts[0].touch, Flat):  # a point's contour has no side
        assert off(name, contacts, -1) > SEEN
    assert off(name, exchanged(contacts)) > SEEN


@pytest.mark.slow
def test_every_arrangement_is_there() -> None:
    """Each pair of guide and touch that a recipe may give, with one contact and with two."""
    there = {(type(one.guide), type(one.touch), len(held(name)[0])) for name in RECIPES for one in held(name)[0]}
    alone = {(type(one.guide), type(one.touch)) for name in RECIPES for one in held(name)[0][:1]}
    assert {count for *_, count in there} == {1, 2}
    assert len(alone) == 8
    assert {(Translating, Roller, 2), (Translating, Flat, 2), (Oscillating, Roller, 2), (Oscillating, Flat, 2)} <= there
    assert (Translating, Shoe, 1) in there


def test_what_an_arrangement_offers() -> None:
    assert Arrangement(Oscillating, Flat, 2).offers == {"swings"}
    assert Arrangement(Translating, Flat, 2).offers == {"face", "plate", "led"}
    assert Arrangement(Translating, Roller).offers == {"roller", "guided", "led", "stem", "rolling"}
    assert (Arrangement(Oscillating, Flat, 2).backlash_unit, Arrangement(Oscillating, Roller, 2).backlash_unit) == (
        "deg",
        "mm",
    )
