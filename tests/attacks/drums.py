# needs: cylindrical
"""Random cylindrical cams, whose developments are held against rollers at all angles by positions alone; and slips."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
from capabilities.cylindrical.made_drums import LED, random_drum
from capabilities.cylindrical.positions import envelope
from capabilities.cylindrical.wound_drums import Pins, random_track
from support.heavy import ezdxf

from attacks.outcome import Attack
from attacks.programs import program_keys

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from capabilities.cylindrical.positions import Lift

    from attacks.outcome import Done

SLIPS = (
    ("radius:", "raduis:"),
    ("depth", "deep"),
    ("over: ", "over: 1e9"),
    ("pitch_height: ", "pitch_height: -"),
    ("rotation: cw", "rotation: left"),
    ("length: ", "length: 1e-9"),
    ("law: cycloidal", "law: linear"),
    ("bore: ", "bore: 9"),
    ("radius: ", "radius: 0"),
    ("pivot: ", "pivot: 1e4"),
    ("side: ", "side: un"),
    ("offset: ", "offset: 9"),
    ("taper: ", "taper: 8"),
    ("taper: axis", "taper: apex"),
    ("profile: ", "profile: -"),
)
TURN_SLIPS = (
    ("turns: ", "turns: 1"),
    ("turns: ", "truns: "),
    ("kind: shoe", "kind: boat"),
    ("kind: shoe, ", ""),
    ("width: ", "width: 9"),
    ("length: ", "length: 1e-7"),
    ("blend: [", "blend: [9"),
    ("depth: ", "depth: 4"),
)
"""Slips in tracks of several turns."""


def turned(rng: Random, number: int) -> Attack:
    """A random drum: the development at the blank is what all rollers leave there."""
    inch, ccw = rng.random() < 0.5, rng.random() < 0.5
    track = rng.choice(["groove", "rib", "top", "bottom"])
    text, lift = random_drum(rng, track, inch=inch, ccw=ccw, undercut=False, led=rng.choice(LED))
    text = text.replace("files: [stl]", "files: [{dxf: {at: [outer]}}, csv]")

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status:
            return [] if done.status in {1, 2} else [f"verdict: {done.err[:200]}"]
        return wrong(folder, text, lift)

    return Attack(f"drum {number}", ("export", "drum.yaml"), {"drum.yaml": text.encode()}, (0, 1, 2), judge)


def stepped(rng: Random, number: int) -> Attack:
    """A random drum as STEP: corners of its surfaces are what all rollers leave there; left out without the kernel."""
    inch, ccw = rng.random() < 0.5, rng.random() < 0.5
    track = rng.choice(["groove", "rib", "top", "bottom"])
    text, lift = random_drum(rng, track, inch=inch, ccw=ccw, undercut=rng.random() < 0.1)
    text = text.replace("files: [stl]", "files: [step, csv]")

    def judge(done: Done, folder: Path) -> list[str]:
        if done.status not in {0, 3}:
            return [] if done.status in {1, 2} else [f"verdict: {done.err[:200]}"]
        return [problem for path in folder.rglob("*.step") for problem in wrong_corners(path, text, lift)]

    return Attack(f"drum {number} as STEP", ("export", "drum.yaml"), {"drum.yaml": text.encode()}, (0, 1, 2, 3), judge)


def milled(rng: Random, number: int) -> Attack:
    """A random drum as a program with random words: it is made, or refused with a reason, and nothing else."""
    track = rng.choice(["groove", "rib", "top", "bottom"])
    inch = rng.random() < 0.5
    mm = 25.4 if inch else 1.0
    undercut = rng.random() < 0.1
    led = "carriage" if undercut or rng.random() < 0.3 else rng.choice(LED)
    text, _ = random_drum(rng, track, inch=inch, ccw=rng.random() < 0.5, undercut=undercut, led=led)
    roller = number_after(text.split("follower:")[1], "radius: ")
    cone = number_after(text, "taper: ") if led.startswith("cone") else 5.0
    axes = ["[X, A]", *["[X, Y, A]"] * 5, "[A, X, Z]", "[X]"]
    diameters = [roller * by for by in (2.0, 2.0, 1.99, 1.9, 1.5, 1.2, 0.9, 2.1)]
    options = program_keys(rng, axes, diameters, mm, cone)
    text = text.replace("files: [stl]", f"files: [{{gcode: {{{options}}}}}]")
    return Attack(f"milled drum {number}", ("export", "drum.yaml"), {"drum.yaml": text.encode()}, (0, 2))


def wound(rng: Random, number: int) -> Attack:
    """A random screw or spiral of several turns: its points are where pins are, or it is refused with a reason."""
    rows, text = random_track(rng)
    if rng.random() < 0.3:
        old, new = rng.choice(TURN_SLIPS)
        text = text.replace(old, new, 1)
    text = text.replace("files: [stl]", "files: [{csv: {as: flank, step: 15}}]")

    def judge(done: Done, folder: Path) -> list[str]:
        (table, *_) = [*folder.rglob("*.csv"), None]
        if done.status or table is None:
            return []
        return strayed(table, text, Pins(rows, 0.5 * number_after(text, "width: ")))

    return Attack(f"wound drum {number}", ("export", "drum.yaml"), {"drum.yaml": text.encode()}, (0, 1, 2), judge)


def strayed(table: Path, text: str, pins: Pins) -> list[str]:
    """Rows of flank points that no pin touches, or that a pin has cut away."""
    names = table.read_text("utf-8").split("\n", 1)[0].split(",")
    rows = np.genfromtxt(table, delimiter=",", skip_header=1)
    level, mirror = number_after(text, "pitch_height: "), -1.0 if "rotation: ccw" in text else 1.0
    found = []
    for name in ("lower", "upper"):
        r, phi, z = (rows[:, names.index(f"{name}_{key}")] for key in ("r_mm", "phi_deg", "z_mm"))
        there = np.isfinite(r)
        angle = mirror * np.radians(phi[there])
        points = np.column_stack([r[there] * np.cos(angle), r[there] * np.sin(angle), z[there]])
        off = float(np.abs(pins.away(points, level).min(axis=1)).max())
        if off > 1e-3:
            found.append(f"a point of the {name} flank is {off:.3g} mm off the pins")
    return found


def slipped(rng: Random, number: int) -> Attack:
    """A random drum with a slip in it: it is refused, or made, and nothing is half written."""
    track, led = rng.choice(["groove", "rib", "top"]), rng.choice(LED)
    text, _ = random_drum(rng, track, inch=False, ccw=False, undercut=False, led=led)
    text += "made: {profile: 0.03}\n"
    old, new = rng.choice([slip for slip in SLIPS if slip[0] in text])
    text = text.replace("files: [stl]", "files: [csv]").replace(old, new, 1)
    return Attack(f"slipped drum {number}", ("check", "drum.yaml"), {"drum.yaml": text.encode()}, (0, 1, 2))


def wrong_corners(path: Path, text: str, lift: Lift) -> list[str]:
    """Corners of B-spline surfaces that are not what rollers leave of either flank, within ten tolerances."""
    mm = 25.4 if "units: inch" in text else 1.0
    level, tolerance = (number_after(text, f"{key}: ") * mm for key in ("pitch_height", "tolerance"))
    _, _, touching, *_ = text.split("radius: ")
    roller = number_after(f"radius: {touching}", "radius: ") * mm
    more = number_after(text, "clearance: ") * mm if "clearance: " in text else 0.0
    half = 0.5 * number_after(text, "distance: ") * mm if "distance: " in text else 0.0
    step = path.read_text(encoding="latin-1")
    places = dict(re.findall(r"(#\d+) = CARTESIAN_POINT\('',\(([^)]*)\)\)", step))
    off = []
    for net in re.findall(r"B_SPLINE_SURFACE_WITH_KNOTS\('',3,3,\((.*?)\),\.UNSPEC", step, re.DOTALL):
        lines = [re.findall(r"#\d+", row) for row in re.findall(r"\(([^()]*)\)", net)]
        corners = [places[line[k]] for line in (lines[0], lines[-1]) for k in (0, -1)]
        x, y, z = np.array([[float(part) for part in corner.split(",")] for corner in corners]).T
        phi = np.arctan2(-y if "rotation: ccw" in text else y, x)
        beside = []
        for side, radius in ((-1, roller), (1, roller + more)):
            wanted, _ = envelope(lift.second(-side * half), side, radius, np.hypot(x, y), np.mod(phi, 2.0 * math.pi))
            beside.append(float(np.abs(z - level - wanted).max()))
        off.append(min(beside))
    return [f"flank: a corner is off by {worst:.4g} mm" for worst in off if worst > 10.0 * tolerance]


def number_after(text: str, key: str) -> float:
    """First number behind a key."""
    return float(re.split(r"[\s,}\]]", text.split(key, 1)[1], maxsplit=1)[0])


def wrong(folder: Path, text: str, lift: Lift) -> list[str]:
    """Lines of a development that are not what rollers leave on the blank, within ten tolerances of their own."""
    mm = 25.4 if "units: inch" in text else 1.0
    level_at_0, tolerance = (number_after(text, f"{key}: ") * mm for key in ("pitch_height", "tolerance"))
    _, blank, touching, *_ = text.split("radius: ")
    radius, roller = (number_after(f"radius: {part}", "radius: ") * mm for part in (blank, touching))
    found = []
    for line in ezdxf.readfile(next(folder.rglob("*.dxf"))).modelspace().query("LWPOLYLINE"):
        layer = line.dxf.layer
        if not layer.endswith(("LOWER", "UPPER")):
            continue
        x, z = np.array(line.get_points("xy")).T * mm
        side = -1 if layer.endswith("LOWER") else 1
        more = 0.0
        if "clearance: " in text and side > 0:
            more = number_after(text, "clearance: ") * mm
        own = lift
        if "distance: " in text:
            own = lift.second(-0.5 * side * number_after(text, "distance: ") * mm)
        phi = (-x if "rotation: ccw" in text else x) / radius
        wanted, _ = envelope(own, side, roller + more, np.full_like(phi, radius), np.mod(phi, 2.0 * math.pi))
        off = float(np.abs(z - level_at_0 - wanted).max())
        if off > 10.0 * tolerance:
            found.append(f"flank: {layer} is off by {off:.4g} mm")
    return found
