"""Drums as kin takes them, and meshes of them made here: rings of sections through points that a roller touches.

What stands here knows the laws by their own formulas, and the place touched by the equation of meshing; kin's code is
not used but for the intent that it is given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from support.programmes import Segment, law, programme

from kin.cylindrical.follower import Arm, DrumFollower
from kin.cylindrical.intent import DrumIntent, End, Groove, Rib
from kin.law.sources.laws import scca

TURN = 2.0 * math.pi
BLEND = 1.0 / 12.0  # of a rise at constant velocity, over which it gets up to speed
_CV = 1.0 - BLEND


def _blend(u):
    wave = np.where(u < BLEND, u - BLEND * np.sin(math.pi * u / BLEND) / math.pi, 2.0 * u - BLEND)
    return 0.5 * wave / _CV


def _ramp(u):
    return 0.5 * (1.0 - np.cos(math.pi * np.minimum(u / BLEND, 1.0))) / _CV


def _steep(u):
    return 0.5 * math.pi * np.sin(math.pi * np.minimum(u / BLEND, 1.0)) / (BLEND * _CV)


FORMULAS = {
    "cycloidal": (
        lambda u: u - np.sin(TURN * u) / TURN,
        lambda u: 1.0 - np.cos(TURN * u),
        lambda u: TURN * np.sin(TURN * u),
    ),
    "polynomial-345": (
        lambda u: u * u * u * (10.0 - 15.0 * u + 6.0 * u**2),
        lambda u: 30.0 * u**2 * (1.0 - u) ** 2,
        lambda u: 60.0 * u * (1.0 - 3.0 * u + 2.0 * u**2),
    ),
    "polynomial-4567": (
        lambda u: u**2 * u**2 * (35.0 - u * (84.0 - u * (70.0 - 20.0 * u))),
        lambda u: 140.0 * (u * (1.0 - u)) ** 2 * u * (1.0 - u),
        lambda u: 420.0 * u**2 * (1.0 - u) ** 2 * (1.0 - 2.0 * u),
    ),
    "harmonic": (
        lambda u: 0.5 * (1.0 - np.cos(math.pi * u)),
        lambda u: 0.5 * math.pi * np.sin(math.pi * u),
        lambda u: 0.5 * math.pi**2 * np.cos(math.pi * u),
    ),
}


LAWS = {
    **FORMULAS,
    "cv-blended": (
        lambda u: np.where(u < 0.5, _blend(u), 1.0 - _blend(1.0 - u)),
        lambda u: _ramp(np.minimum(u, 1.0 - u)),
        lambda u: np.where(u < 0.5, 1.0, -1.0) * _steep(np.minimum(u, 1.0 - u)),
    ),
}


def named(name):
    """Law of a segment."""
    return scca(0.5, 0.0, 1.0 - 2.0 * BLEND) if name == "cv-blended" else law(name)


@dataclass(frozen=True)
class Motion:
    """Rises (above 0), returns (below 0) and dwells (0): stroke, mm, over degrees, by a law; they fill all turns."""

    parts: tuple = ((40.0, 120.0, "cycloidal"), (0.0, 60.0, ""), (-40.0, 120.0, "polynomial-345"), (0.0, 60.0, ""))

    @property
    def turns(self):
        return round(sum(over for _, over, _ in self.parts) / 360.0)

    @property
    def law(self):
        kinds = {1: "rise", -1: "return", 0: "dwell"}
        segments = [
            Segment(kinds[int(np.sign(stroke))], math.radians(over), abs(stroke), named(name) if stroke else None)
            for stroke, over, name in self.parts
        ]
        return programme(segments, TURN * self.turns).motion

    def __call__(self, theta, order=0):
        """Lift, or its first or second derivative by the angle, at angles, rad."""
        theta = np.mod(theta, TURN * self.turns)
        total, at = np.zeros_like(theta), 0.0
        for stroke, over, name in self.parts:
            width = math.radians(over)
            if stroke:
                u = np.clip((theta - at) / width, 0.0, 1.0)
                part = stroke * LAWS[name][order](u) / width**order
                total += part if order == 0 else np.where((u > 0.0) & (u < 1.0), part, 0.0)
            at += width
        return total

    @property
    def breaks(self):
        return np.radians(np.cumsum([0.0, *(over for _, over, _ in self.parts[:-1])]))


@dataclass(frozen=True)
class Drum:
    """A drum as it is meant: c01 to begin with, its lift 0 at 20 over the lower face."""

    motion: Motion = field(default_factory=Motion)
    roller: float = 10.0
    inner: float = 38.0
    outer: float = 50.0
    level: float = 20.0
    track: Groove | Rib | End = field(default_factory=lambda: Groove(12.5))
    radius: float = 50.0
    length: float = 80.0
    bore: float = 12.0
    shortened: bool = False
    mirrored: bool = False
    offset: float = 0.0
    taper: float = 0.0
    at: float = 44.0
    arm: Arm | None = None
    shoe: float | None = None

    @property
    def plain(self):
        """Whether the roller is a cylinder whose axis is a radius."""
        return not (self.offset or self.taper or self.arm)

    @property
    def growth(self):
        return math.tan(self.taper)

    def size(self, roller, x):
        """Radius of a roller at places x along it."""
        return roller + (x - self.at) * self.growth

    def axis(self, theta, level, order=0):
        """Places y and z of a roller's axis, at a height at lift 0, or their derivatives by the angle."""
        if self.arm is None:
            still = np.zeros_like(theta)
            lift = self.motion(theta, order)
            return (still + self.offset, level + lift) if order == 0 else (still, lift)
        arm, beside = self.arm, level - self.level
        psi = math.asin((self.level - arm.pivot) / arm.length) + self.motion(theta)
        y = -arm.side * (arm.length * np.cos(psi) - beside * np.sin(psi))
        z = arm.length * np.sin(psi) + beside * np.cos(psi)
        if order == 0:
            return arm.offset + y, arm.pivot + z
        # everything turns about the pivot
        rate = arm.side * self.motion(theta, 1)
        return z * rate, -y * rate

    def gives(self, theta, place, roller, side, level):
        """How far a roller at angles has to give way to points at (x, y, z): mm, rad of an arm; -inf out of reach."""
        x, y, z = place
        size = self.size(roller, x)
        y0, z0 = self.axis(theta, level)
        with np.errstate(invalid="ignore"):
            if self.arm is None:
                gone = side * (z0 - z) + np.sqrt(size**2 - (y - y0) ** 2)
            else:
                arm = self.arm
                way, reach = np.hypot(y - arm.offset, z - arm.pivot), math.hypot(arm.length, level - self.level)
                towards = np.arctan2(z - arm.pivot, arm.side * (arm.offset - y))
                own = np.arctan2(z0 - arm.pivot, arm.side * (arm.offset - y0))
                gone = side * (own - towards) + np.arccos((way**2 + reach**2 - size**2) / (2.0 * way * reach))
        return np.where(np.isfinite(gone), gone, -np.inf)

    @property
    def floor(self):
        return self.bore if self.track.depth is None else self.radius - self.track.depth

    def intent(self, **more):
        from kin.contour.holes import round_hole

        follower = DrumFollower(
            self.roller, self.inner, self.outer, self.level, self.motion.law,
            self.offset, self.taper, self.at if self.taper else None, self.arm,
            self.motion.turns, self.shoe,
        )  # fmt: skip
        hole = round_hole("the bore", "bore", (0.0, 0.0), 2.0 * self.bore)
        given = {"bore": hole, "shortened": self.shortened, "mirrored": self.mirrored, **more}
        return DrumIntent(follower, self.track, self.radius, self.length, **given)

    @property
    def flanks(self):
        """Name, side, roller's radius and height of its axis at lift 0 of each flank."""
        track, level = self.track, self.level
        if isinstance(track, Groove):
            return [("lower", -1, self.roller, level), ("upper", 1, self.roller + track.clearance, level)]
        if isinstance(track, Rib):
            return [
                ("lower", -1, self.roller, level + 0.5 * track.distance),
                ("upper", 1, self.roller, level - 0.5 * track.distance),
            ]
        return [("lower", -1, self.roller, level)] if track.facing == "top" else [("upper", 1, self.roller, level)]

    @property
    def regular(self):
        """Whether no flank is undercut at its inner edge."""
        theta, rho = np.linspace(0.0, TURN, 4001), self.floor
        slope, bend = self.motion(theta, 1), self.motion(theta, 2)
        w = np.hypot(rho, slope)
        sides = ((side, roller) for _, side, roller, _ in self.flanks)
        return all(
            (w - side * roller * rho * bend / w**2 - (roller * slope) ** 2 / w**3 > 0.1 * rho).all()
            for side, roller in sides
        )

    def envelops(self, flank):
        """Whether a flank is nowhere undercut at its inner edge: what is touched there stands in no roller's way."""
        theta = np.linspace(0.0, TURN, 181)
        phi, z = self.touched(theta, np.array([self.floor]), *flank[1:])
        points = polar(phi, self.floor, z)[:, 0]
        whole = replace(self, mirrored=False)
        return np.abs(distances(whole, points, flank)[0]).max() < 1e-7

    def touched(self, theta, r, side, roller, level):
        """Polar angle and height (n, m) of the flank on cylinders r (m,), touched at angles theta (n,)."""
        if not self.plain:
            return self._touched_anywhere(theta[:, None], r, side, roller, level)
        slope = self.motion(theta, 1)[:, None]
        square = 0.5 * (r**2 - slope**2 + np.sqrt((r**2 + slope**2) ** 2 - 4.0 * (slope * roller) ** 2))
        rho = np.sqrt(square)
        a = np.arctan2(slope, rho)
        phi = theta[:, None] + np.arctan2(-side * roller * np.sin(a), rho)
        return phi, level + self.motion(theta)[:, None] + side * roller * np.cos(a)

    def _touched_anywhere(self, theta, r, side, roller, level):
        y, z = self.axis(theta, level)
        y1, z1 = self.axis(theta, level, 1)
        x = np.broadcast_to(r, (len(theta), len(r))).astype(float)
        for _ in range(60):
            size = self.size(roller, x)
            along = x + y1 + size * self.growth
            a = np.arctan2(z1, along) + side * np.arcsin(y * self.growth / np.hypot(along, z1))
            across = y - side * size * np.sin(a)
            x = np.sqrt(r**2 - across**2)
        return theta + np.arctan2(across, x), z + side * size * np.cos(a)


def polar(phi, r, z):
    """Points (n, m, 3) of polar coordinates that broadcast to (n, m)."""
    phi, r, z = np.broadcast_arrays(phi, r, z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


def between(first, last, parts):
    """Rows without the first: (n, 1) to (n, 1) in equal parts, (n, parts)."""
    share = np.arange(1, parts + 1) / parts
    return first + (last - first) * share


@dataclass(frozen=True)
class Steps:
    """Columns a turn, and rows of a flank, of the floor, of the blank and of the bore from a flank to an end."""

    columns: int = 720
    flank: int = 8
    floor: int = 6
    blank: int = 4
    bore: int = 4


def fitting(e, drum=None):
    """Steps for an error of about e, mm, on a drum of c01's size."""
    scale = math.sqrt(0.01 / e)
    size = 1.0 if drum is None else math.sqrt(max(drum.radius, 40.0) / 50.0)
    return Steps(*(math.ceil(k * size * scale) for k in (400, 5, 12, 6, 6)))


class Made:
    """A mesh as a ring of sections: points (n, m, 3) of n sections with m corners, and the part each row belongs to."""

    def __init__(self, drum, steps=None, surface=None, more=()):
        """`surface(theta, r, side, roller, level)` gives polar angle and height of the walls; by default exact ones.

        `more` are further angles with a column.
        """
        self.drum, steps = drum, steps or Steps()
        touched = surface or drum.touched
        theta = np.unique(np.concatenate([np.arange(steps.columns) * (TURN / steps.columns), drum.motion.breaks, more]))
        theta = theta[np.diff(theta, append=theta[0] + TURN) > 1e-6]
        self.theta = theta
        t = theta[:, None]
        high, low = drum.radius, drum.floor
        inward = np.linspace(high, low, steps.flank + 1)
        walls = {name: (side, touched(theta, inward, side, roller, level)) for name, side, roller, level in drum.flanks}
        rows, names = [polar(t, drum.bore, 0.0)], ["bore"]

        def add(points, name):
            rows.append(points)
            names.extend([name] * points.shape[1])

        def wall(name, *, outward):
            phi, z = walls[name][1]
            points = polar(phi, inward, z)
            add(points[:, ::-1] if outward else points, name)

        def over(r, first, last, parts, name, *, close=False):
            """Rows on the cylinder r from one (phi, z), itself a row, to the last, a row if `close`."""
            rest = slice(None) if close else slice(-1)
            phi, z = (between(one, two, parts)[:, rest] for one, two in zip(first, last, strict=True))
            add(polar(phi, r, z), name)

        def edge(name, k):
            phi, z = walls[name][1]
            return phi[:, [k]], z[:, [k]]

        bottom, top = (t, np.zeros_like(t)), (t, np.full_like(t, drum.length))
        track = drum.track
        if isinstance(track, Groove):
            add(polar(t, high, 0.0), "blank")
            over(high, bottom, edge("lower", 0), steps.blank, "blank")
            wall("lower", outward=False)
            over(low, edge("lower", -1), edge("upper", -1), steps.floor, "floor")
            wall("upper", outward=True)
            over(high, edge("upper", 0), top, steps.blank, "blank", close=True)
            add(polar(t, drum.bore, drum.length), "bore")
        elif isinstance(track, Rib):
            add(polar(t, low, 0.0), "floor")
            over(low, bottom, edge("upper", -1), steps.blank, "floor")
            wall("upper", outward=True)
            over(high, edge("upper", 0), edge("lower", 0), steps.blank, "blank")
            wall("lower", outward=False)
            over(low, edge("lower", -1), top, steps.blank, "floor", close=True)
            add(polar(t, drum.bore, drum.length), "bore")
        elif track.facing == "top":
            add(polar(t, high, 0.0), "blank")
            over(high, bottom, edge("lower", 0), steps.blank, "blank")
            wall("lower", outward=False)
            if track.depth is None:
                over(low, edge("lower", -1), bottom, steps.bore, "bore")
            else:
                over(low, edge("lower", -1), top, steps.bore, "floor", close=True)
                add(polar(t, drum.bore, drum.length), "bore")
        else:
            if track.depth is None:
                rows.clear()
                names.clear()
                over(low, top, edge("upper", -1), steps.bore, "bore")
            else:
                add(polar(t, low, 0.0), "floor")
                over(low, bottom, edge("upper", -1), steps.bore, "floor")
            wall("upper", outward=True)
            over(high, edge("upper", 0), top, steps.blank, "blank", close=True)
            add(polar(t, drum.bore, drum.length), "bore")
        self.points = np.concatenate(rows, axis=1)
        self.names = names

    @property
    def corners(self):
        """Corner numbers (t, 3), counter-clockwise from outside."""
        n, m = self.points.shape[:2]
        k, i = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
        after, up = (k + 1) % n, (i + 1) % m
        a, b, c, d = k * m + i, after * m + i, after * m + up, k * m + up
        faces = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
        return faces[:, [0, 2, 1]] if self.drum.mirrored else faces

    @property
    def places(self):
        """Corners' places (v, 3), mirrored where the drum is."""
        flat = self.points.reshape(-1, 3)
        return flat * [1.0, -1.0, 1.0] if self.drum.mirrored else flat.copy()

    def number(self, name, column, row):
        """Corner number of a row of the named part, counted within it, in a column."""
        rows = [k for k, own in enumerate(self.names) if own == name]
        return (column % len(self.theta)) * len(self.names) + rows[row]


def binary(places, corners):
    """Bytes of a binary STL."""
    record = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    record["c"] = places[corners]
    return b"\0" * 80 + np.uint32(len(corners)).tobytes() + record.tobytes()


def sought(function, at, width, best, rounds=4):
    """Greatest (or least) values (n,) of a function of angles (n, m) about `at` (n, m), by ever closer grids."""
    for _ in range(rounds):
        value = function(at)
        centre = np.take_along_axis(at, best(value, axis=1)[:, None], axis=1)
        at = centre + width * np.linspace(-1.0, 1.0, 41)
        width = width / 20.0
    value = function(at)
    return np.take_along_axis(value, best(value, axis=1)[:, None], axis=1)[:, 0]


def distances(drum, points, flank, *, highest=False):
    """Distance (n,) of points (n, 3) from an exact flank, above 0 within the metal, and the height over it, (n,).

    Positions alone: the least distance from all axes of the roller, and how far it has to give way to the point. With
    `highest`, side times the height (n,) of the flank itself.
    """
    _, side, roller, level = flank
    if drum.mirrored:
        points = points * [1.0, -1.0, 1.0]
    phi, r = np.arctan2(points[:, 1], points[:, 0]), np.hypot(points[:, 0], points[:, 1])
    most = 1.02 * roller if drum.plain else 1.3 * roller + np.abs(drum.axis(np.linspace(0.0, 7.0, 99), level)[0]).max()
    reach = np.arcsin(np.minimum(1.0, most / r))

    def along(theta):
        return r[:, None] * np.cos(phi[:, None] - theta), r[:, None] * np.sin(phi[:, None] - theta)

    def away(theta):
        (x, y), (y0, z0) = along(theta), drum.axis(theta, level)
        return (np.hypot(y - y0, points[:, [2]] - z0) - drum.size(roller, x)) * math.cos(drum.taper)

    def gives(theta):
        return drum.gives(theta, (*along(theta), points[:, [2]]), roller, side, level)

    def heights(theta):
        (x, y), (y0, z0) = along(theta), drum.axis(theta, level)
        with np.errstate(invalid="ignore"):
            return np.nan_to_num(side * z0 + np.sqrt(drum.size(roller, x) ** 2 - (y - y0) ** 2), nan=-np.inf)

    at = phi[:, None] + reach[:, None] * np.linspace(-1.0, 1.0, 201)
    width = reach[:, None] / 100.0
    if highest:
        return sought(heights, at, width, np.argmax)
    return sought(away, at, width, np.argmin), sought(gives, at, width, np.argmax)


def enveloped(drum):
    """Surface for `Made` with the flank as all rollers leave it, undercut or not: at angles theta, by positions."""

    def surface(theta, r, side, roller, level):
        flank = ("", side, roller, level)
        phi, far = (x.ravel() for x in np.meshgrid(theta, r, indexing="ij"))
        points = np.stack([far * np.cos(phi), far * np.sin(phi), np.zeros_like(far)], axis=-1)
        height = np.concatenate(
            [
                distances(replace(drum, mirrored=False), part, flank, highest=True)
                for part in np.array_split(points, 1 + len(points) // 4000)
            ]
        )
        return np.broadcast_to(theta[:, None], (len(theta), len(r))), side * height.reshape(len(theta), len(r))

    return surface


def resting(drum, points, theta, flank):
    """How far the roller with ends is kept from its place at each angle (n,) by points (m, 3): positions alone."""
    _, side, roller, level = flank
    if drum.mirrored:
        points = points * [1.0, -1.0, 1.0]
    found = []
    for t in theta:
        x = points[:, 0] * np.cos(t) + points[:, 1] * np.sin(t)
        y = points[:, 1] * np.cos(t) - points[:, 0] * np.sin(t)
        _, z0 = drum.axis(t, level)
        own = (x >= drum.inner) & (x <= drum.outer) & (side * (z0 - points[:, 2]) < 0.0)
        place = (x[own], y[own], points[own, 2])
        found.append(np.max(drum.gives(t, place, roller, side, level), initial=-np.inf))
    return np.array(found)


KINDS = ("groove", "rib", "top", "bottom", "hub", "undercut")


def random_drum(chance, kind):
    """A drum of a kind by chance: of mm or of inches, turning either way, up to 45 degrees steep at its inner end.

    An end's flank goes down to the bore, or with "hub" to a floor. The crests of "undercut" are as sharp as that.
    """
    size = float(chance.choice([1.0, 3.175]))
    radius, roller = chance.uniform(35.0, 60.0) * size, chance.uniform(5.0, 11.0) * size
    depth = chance.uniform(0.15, 0.3) * radius
    outer = radius * float(chance.choice([1.0, 0.97]))
    inner = radius - depth + 0.04 * radius
    over = 360.0 * chance.dirichlet(np.full(4, 8.0))
    names = chance.choice(list(FORMULAS), 2)
    stroke = chance.uniform(8.0, 40.0) * size
    if kind == "undercut":
        roller, depth = 12.0 * size, 0.4 * radius
        inner, over = 0.65 * radius, np.array([62.0, 110.0, 70.0, 118.0])
        names, stroke = ["cycloidal", "cycloidal"], 0.38 * radius
    parts: tuple = ((1.0, over[0], names[0]), (0.0, over[1], ""), (-1.0, over[2], names[1]), (0.0, over[3], ""))
    steep = np.abs(Motion(parts)(np.linspace(0.0, TURN, 4001), 1)).max()
    stroke = min(stroke, inner / steep)
    parts = tuple((sign * stroke, wide, name) for sign, wide, name in parts)
    level = roller + 15.0 * size
    tracks: dict[str, Groove | Rib | End] = {
        "groove": Groove(depth, float(chance.choice([0.0, 0.05])) * size),
        "undercut": Groove(depth, 0.05 * size),
        "rib": Rib(depth, 3.0 * roller + chance.uniform(4.0, 15.0) * size),
        "top": End(),
        "bottom": End("bottom"),
        "hub": End("top", depth),
    }
    track = tracks[kind]
    level += 0.5 * track.distance if isinstance(track, Rib) else 0.0
    length = 2.0 * level + stroke
    bore = (0.55 if kind in {"top", "bottom"} else 0.3) * radius
    cut, turned = kind == "undercut", bool(chance.integers(2))
    drum = Drum(Motion(parts), roller, inner, outer, level, track, radius, length, bore, cut, turned)
    while not cut and not drum.regular:
        parts = tuple((0.85 * lift, wide, name) for lift, wide, name in drum.motion.parts)
        drum = replace(drum, motion=Motion(parts))
    return drum, size


LED = ("offset", "cone", "arm", "cone on an arm", "rib on an arm", "cone beside the axis")


def random_led(chance, kind):
    """A drum by chance whose roller is a cone, on an arm or beside the axis, with its size: `random_drum` otherwise."""
    tracks = {"offset": "hub", "cone": "rib", "arm": "groove", "cone on an arm": "bottom", "rib on an arm": "rib"}
    drum, size = random_drum(chance, tracks.get(kind, "groove"))
    sense = int(chance.choice([-1, 1]))
    more = {}
    if "cone" in kind:
        middle = 0.5 * (drum.inner + drum.outer)
        apex = math.atan(drum.roller / middle)
        more |= {"at": middle, "taper": apex if chance.integers(2) else chance.uniform(0.3, 1.2) * apex}
    if kind in {"offset", "cone beside the axis"}:
        more["offset"] = sense * chance.uniform(0.05, 0.15) * drum.radius
    if "arm" in kind:
        stroke = drum.motion.parts[0][0]
        reach = drum.radius * chance.uniform(1.5, 2.5)
        swing = 2.0 * math.asin(0.5 * stroke / reach)
        parts = tuple((lift / stroke * swing, over, name) for lift, over, name in drum.motion.parts)
        pivot = drum.level + chance.uniform(0.35, 0.65) * stroke
        aside = sense * reach * 0.5 * (1.0 + math.cos(0.5 * swing)) + chance.uniform(-0.03, 0.03) * drum.radius
        more |= {"motion": Motion(parts), "arm": Arm(reach, aside, pivot, sense)}
    drum = replace(drum, **more)
    while not all(drum.envelops(flank) for flank in drum.flanks):
        parts = tuple((0.85 * lift, over, name) for lift, over, name in drum.motion.parts)
        drum = replace(drum, motion=Motion(parts))
    return drum, size


def on_triangles(made, name, chance, count):
    """Places (n, 3) on the triangles of a part of a drum: points of all edges, and so many within by chance."""
    names = np.array(made.names * len(made.theta))
    corners = made.corners
    triangles = made.places[corners[(names[corners] == name).all(axis=1)]]
    a, b = triangles, np.roll(triangles, -1, axis=1)
    shares = np.linspace(0.0, 1.0, 5)[:-1, None, None, None]
    edges = (a + shares * (b - a)).reshape(-1, 3)
    weights = chance.dirichlet(np.ones(3), count)
    return edges, np.einsum("nk,nkx->nx", weights, triangles[chance.choice(len(triangles), count)])


__all__ = [
    "KINDS",
    "LED",
    "Arm",
    "Drum",
    "End",
    "Groove",
    "Made",
    "Motion",
    "Rib",
    "Steps",
    "binary",
    "distances",
    "enveloped",
    "fitting",
    "on_triangles",
    "random_drum",
    "random_led",
    "replace",
    "resting",
]


def on_flanks(read, intent, theta):
    """How far a mesh's flanks keep the drum's own roller with ends from its place at angles (n,), an (n,) for each."""
    from kin.cylindrical.contact import set_down
    from kin.cylindrical.faces import Body, faces_of
    from kin.cylindrical.gauge import gauges_of

    found = []
    for stands in faces_of(
        Body.of(read.mesh, mirrored=intent.mirrored), intent, gauges_of(intent), read.rounding
    ).stands:
        gauge = replace(stands.gauge, radius=intent.follower.radius)
        corners, reach = stands.body.corners[stands.touched], math.asin(min(1.0, gauge.reach / gauge.inner))
        angles = np.unwrap(stands.body.phi[corners], axis=1)
        spans = angles.min(axis=1) - reach, angles.max(axis=1) + reach
        found.append(set_down(gauge, stands.body.points[corners], spans, theta) / gauge.lever)
    return found
