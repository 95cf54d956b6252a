# needs: follow
"""Drums of several turns and of unknown origin, followed through their crossings.

Holds: kin.cylindrical.wound, kin.cylindrical.running, camgeo.capabilities.cylindrical.follow.
"""

from __future__ import annotations

import json
import math
import random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import design_of
from capabilities.cylindrical.wound_drums import SCREW_ROWS, SPIRAL, SPIRAL_ROWS, Pins, random_track
from support.places import RECIPES

import camgeo
from camgeo.capabilities.cylindrical.solid import drum_mesh
from camgeo.cli.main import main
from camgeo.files.mesh import Item
from camgeo.output.extension import MAKING, numbers_of
from kin.cylindrical.unknown import Column
from kin.cylindrical.wound import windings

if TYPE_CHECKING:
    from pathlib import Path

LINES = 1440


# --- lines along the axis ---------------------------------------------------------------------------------------------


def drawn(pins: Pins, low: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights (n,) over all turns of the middle of a groove of constant width in its development, and half its width.

    Along the axis that is 1/cos a of the width, tan a = S'/r.
    """
    theta = (np.arange(LINES * pins.turns) + 0.5) * (2.0 * np.pi / LINES)
    slope = (pins(theta + 1e-5) - pins(theta - 1e-5)) / 2e-5
    return low + pins(theta), pins.radius * np.hypot(1.0, slope / radius)


def columns_of(middle: np.ndarray, half: np.ndarray, top: float) -> list[Column]:
    """What lines meet of a drum from 0 to its top, less what lies within half a width of the middles of each turn."""
    columns = []
    for k in range(LINES):
        ends = sorted((m - h, m + h) for m, h in zip(middle[k::LINES], half[k::LINES], strict=True))
        z = [0.0]
        for low, high in ends:
            if len(z) > 1 and low < z[-1]:
                z[-1] = max(z[-1], high)
            else:
                z += [low, high]
        z.append(top)
        columns.append(Column(np.array(z), np.tile([-1.0, 1.0], len(z) // 2)))
    return columns


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_turns_are_told_from_one_another(seed: int) -> None:
    """Middles are those of the pin; a wall stands where no other turn has taken it."""
    rows, _ = ((SCREW_ROWS, ""), (SPIRAL_ROWS, ""), *(random_track(random.Random(k)) for k in (1, 10, 15, 37)))[seed]
    pins = Pins(rows, 4.0)
    middle, half = drawn(pins, 12.0, 30.0)
    (found,) = windings(columns_of(middle, half, float(middle.max()) + 12.0), 30.0)
    assert len(found.lower) == LINES * pins.turns
    # it begins with the turn that is lowest at angle 0
    first = int(np.argmin(middle[::LINES])) * LINES
    middle, half = np.roll(middle, -first), np.roll(half, -first)
    # in a crossing a middle only says which metal is below the pin
    assert np.abs(0.5 * (found.lower + found.upper) - middle).max() < 0.015 * pins.radius
    others = np.arange(1, pins.turns)[:, None] * LINES + np.arange(len(middle))
    for wall, edge in enumerate((middle - half, middle + half)):
        there = (np.abs(edge - middle[others % len(middle)]) >= half[others % len(middle)]).all(axis=0)
        # none is told that is gone, but for a line or two at its end; few are not told that stand, where turns cross
        beside = np.any([np.roll(there, k) for k in (-2, -1, 1, 2)], axis=0)
        assert not (found.stands[wall] & ~there & ~beside).any()
        assert np.mean(there & ~found.stands[wall]) < 0.005
        assert not there.all()


def test_what_closes_after_a_turn_is_no_winding() -> None:
    theta = (np.arange(LINES) + 0.5) * (2.0 * np.pi / LINES)
    middle = 30.0 + 10.0 * np.sin(theta)
    assert windings(columns_of(middle, np.full(LINES, 4.0), 60.0), 30.0) == []
    assert windings([Column(np.array([0.0, 60.0]), np.array([-1.0, 1.0]))] * LINES, 30.0) == []


# --- solids -----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def spiral(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The STL of a drum that feeds over three turns, and comes back in one; its pin runs 11 mm over the lower face."""
    return solid_of(SPIRAL, tmp_path_factory.mktemp("spiral"))


def solid_of(text: str, folder: Path) -> Path:
    """The STL of a recipe, which nobody has judged."""
    design, write = design_of(text), MAKING["stl"].write
    assert write is not None
    mesh, *_ = drum_mesh(design, design.recipe.export.tolerance, numbers_of("stl", 1.0))
    write(folder / "drum.stl", [Item("drum", mesh)], "drum", 1.0, "")
    return folder / "drum.stl"


def longest_gap(pins: Pins, radius: float) -> float:
    """Greatest length, mm, of a wall that another turn takes, 2 R/sin b with b the angle of both tracks at a radius."""
    theta = np.linspace(0.0, 2.0 * np.pi * pins.turns, 20_001)
    gaps = []
    for turn in range(1, pins.turns):
        over = pins(theta + 2.0 * np.pi * turn) - pins(theta)
        at = theta[:-1][np.sign(over[:-1]) != np.sign(over[1:])]
        climbs = [
            np.arctan((pins(place + 1e-4) - pins(place - 1e-4)) / 2e-4 / radius)
            for place in (at, at + 2.0 * np.pi * turn)
        ]
        gaps += (2.0 * pins.radius / np.sin(np.abs(climbs[0] - climbs[1]))).tolist()
    return max(gaps)


@pytest.mark.costly("a solid is made and followed at all angles of its turns")
def test_a_spiral_gives_its_motion_back(spiral: Path) -> None:
    """By positions of the pin; crossings are followed, too. The groove has no play."""
    followed = camgeo.follow(spiral, drum="auto", width=8, length=26, rotation="ccw")
    assert isinstance(followed, camgeo.FollowedDrum)
    assert (followed.turns, followed.unit, len(followed.theta)) == (4, "mm", 2880)
    off = followed.position - 11.0 - Pins(SPIRAL_ROWS, 4.0)(followed.theta)
    # the solid is within 0.05; on its facets the pin stands too high, or none
    assert np.abs(off).max() < followed.run.error < 0.05
    assert np.abs(followed.play).max() < 2.0 * followed.run.error
    assert followed.theta[-1] == pytest.approx(2.0 * math.pi * 4.0 * (1.0 - 1.0 / 2880))
    # where tracks cross at an angle b a wall is gone over 2 R/sin b, if they are straight
    assert followed.run.gap == pytest.approx(longest_gap(Pins(SPIRAL_ROWS, 4.0), 40.0), rel=0.02)
    # both walls are gone over R tan(b/2) to either side of a crossing, and looked at a degree more
    told = followed.document()
    assert len(told["bridged"]) == 6
    assert max(part["end_deg"] - part["start_deg"] for part in told["bridged"]) < 8.0
    rows = np.genfromtxt(followed.table().splitlines(), delimiter=",", names=True)
    assert (rows["shaft_deg"][0], rows["shaft_deg"][-1]) == (0.0, 1439.5)
    speed = rows["velocity_mm_per_rad"][360]
    assert speed == pytest.approx(60.0 / math.radians(1080.0 - 70.0), rel=0.02)
    assert followed.lifts().splitlines()[-1].startswith("1440,")


@pytest.mark.slow
def test_another_turn_begins_the_motion(spiral: Path) -> None:
    """At angle 0 the third turn stands at 11 + S(720 degrees)."""
    pins = Pins(SPIRAL_ROWS, 4.0)
    third = 11.0 + float(pins(np.array([4.0 * math.pi]))[0])
    followed = camgeo.follow(spiral, drum="groove", width=8, rotation="ccw", height=round(third), turns=4)
    assert isinstance(followed, camgeo.FollowedDrum)
    off = followed.position - 11.0 - pins(followed.theta + 4.0 * math.pi)
    assert np.abs(off).max() < 0.05
    # a shoe whose length is not told is longer than the longest gap, and a line says so
    assert f"a recipe has a shoe {followed.shoe_length:.6g} mm long: give --length" in followed.summary()
    assert followed.shoe_length > followed.run.gap


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--roller", "4"), "closes after 4 turns and crosses itself, where a roller drops in; give width 8 of a shoe"),
        (("--roller", "4", "--width", "8"), "a shoe takes the place of a roller"),
        (("--width", "8", "--turns", "2"), "the groove closes after 4 turns, not 2; leave turns out"),
        (("--width", "8", "--turns", "1"), "the groove closes after 4 turns, not 1; leave turns out"),
        (("--width", "8", "--turns", "41"), "a groove closes after 1 to 40 turns, not 41"),
        (("--width", "8", "--length", "7"), "a shoe is longer than it is wide: give --length above 8"),
        (("--roller", "4", "--length", "30"), "only a shoe has a length: give --width, or leave --length out"),
        (("--width", "8", "--offset", "2"), "a shoe is on a carriage, and its pin is a radius of the drum"),
    ],
)
def test_wrong_calls(spiral: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], told: str) -> None:
    assert main(["follow", str(spiral), "--drum", "auto", "--rotation", "ccw", *words]) == 2
    assert told in capsys.readouterr().err


def screw_lift(degrees: np.ndarray) -> np.ndarray:
    """Lift of recipe drum-screw: 60 mm over three turns and back, with blends of 90 degrees."""
    return Pins([(60.0, 1080.0, 90.0, 90.0), (-60.0, 1080.0, 90.0, 90.0)], 4.0)(np.radians(degrees))


def spiral_lift(degrees: np.ndarray) -> np.ndarray:
    """Lift of recipe drum-spiral: 60 mm over three turns, and back in the fourth by a modified sine (Neklutin)."""
    feed = Pins([(60.0, 1080.0, 60.0, 80.0), (-60.0, 360.0, 9.0, 9.0)], 4.0)(np.radians(degrees))
    u, pi = np.clip((degrees - 1080.0) / 360.0, 0.0, 1.0), np.pi
    ends = pi * u - np.sin(4.0 * pi * u) / 4.0
    middle = 2.0 + pi * u - 2.25 * np.sin(pi * (1.0 + 4.0 * u) / 3.0)
    share = np.where(u < 0.125, ends, np.where(u > 0.875, 4.0 + ends, middle)) / (4.0 + pi)
    return np.where(degrees < 1080.0, feed, 60.0 * (1.0 - share))


@pytest.mark.slow  # solids are made, followed and judged
@pytest.mark.parametrize(
    "case",
    [
        ("drum-screw", screw_lift, ("--length", "46", "--from", "25"), ("bore: 20}", "bore: 20, keyway: din6885}")),
        ("drum-spiral", spiral_lift, ("--length", "26", "--from", "34", "--rotation", "ccw"), None),
    ],
)
def test_recipes_come_back(case: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Positions are the law's within the recipe's tolerance, and the recipe that is written accepts the file."""
    name, lift, words, bore = case
    path = solid_of((RECIPES / "cylindrical" / f"{name}.yaml").read_text("utf-8"), tmp_path)
    files = ["--recipe", str(tmp_path / "new.yaml"), "--table", str(tmp_path / "motion.csv")]
    reading = ["--reading", "0.016"]
    call = ["follow", str(path), "--drum", "auto", "--width", "8", *words, *reading, *files, "--json"]
    assert main(call) == 0
    told = json.loads(capsys.readouterr().out)
    rows = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
    off = rows["position_mm"] - 14.0 - lift(rows["shaft_deg"])
    # on the other wall of a crossing the error of the play counts as well
    assert np.abs(off).max() < min(2.0 * told["error"], 0.02)
    assert told["play"]["least"] == pytest.approx(0.05, abs=0.025)
    text = (tmp_path / "new.yaml").read_text("utf-8")
    assert f"turns: {told['turns']}" in text
    if bore is not None:
        assert bore[0] in text
        (tmp_path / "new.yaml").write_text(text.replace(*bore), encoding="utf-8")
    assert main(["verify", str(tmp_path / "new.yaml"), str(path)]) == 0


@pytest.mark.slow  # solids are made and followed
@pytest.mark.parametrize("seed", [1, 10, 36])
def test_random_tracks_come_back(seed: int, tmp_path: Path) -> None:
    rows, text = random_track(random.Random(seed))
    recipe = camgeo.load(text)
    width = float(text.split("width: ")[1].split(",")[0])
    pins = Pins(rows, 0.5 * width)
    followed = camgeo.follow(solid_of(text, tmp_path), drum="auto", width=width, rotation=recipe.rotation)
    assert isinstance(followed, camgeo.FollowedDrum)
    off = followed.position - width - 3.0 - pins(followed.theta)
    assert np.abs(off).max() < recipe.export.tolerance
