"""Turrets as kin takes them, and meshes of indexing cams made here: a blank less a tube that a roller sweeps.

What stands here knows the cycloidal law by its formula and the place touched by the equation of meshing; kin's code is
not used but for the intent that it is given. The tube is taken from the blank by a boolean of another library.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import manifold3d
import numpy as np
from support.programmes import Segment, law, programme

from kin.contour.holes import round_hole
from kin.indexing.forms import Barrel, Globoid
from kin.indexing.intent import IndexIntent

TURN = 2.0 * math.pi


def cycloidal(u, order=0):
    """The law, or its derivative of an order up to 2."""
    return (u - np.sin(TURN * u) / TURN, 1.0 - np.cos(TURN * u), TURN * np.sin(TURN * u))[order]


@dataclass(frozen=True)
class Turret:
    """c15 to begin with, in a shorter cam: a barrel whose turret of 6 advances over 150 degrees, from -30 degrees."""

    form: Barrel | Globoid = field(default_factory=lambda: Barrel(50.0, 13.0, 57.0, 60.0, 1))
    stops: int = 6
    start: float = math.radians(-30.0)
    over: float = math.radians(150.0)
    roller: float = 9.0
    inner: float = 37.5
    outer: float = 50.0
    length: float = 70.0
    height: float = 35.0
    clearance: float = 0.0
    bore: float = 20.0
    mirrored: bool = False

    @property
    def intent(self):
        pitch = TURN / self.stops
        parts = [Segment("rise", self.over, pitch, law("cycloidal")), Segment("dwell", TURN - self.over)]
        bore = round_hole("the bore", "bore", (0.0, 0.0), self.bore) if self.bore else None
        return IndexIntent(
            self.form,
            self.height,
            self.length,
            programme(parts, TURN).motion,
            self.start,
            self.stops,
            self.roller,
            self.inner,
            self.outer,
            self.clearance,
            bore,
            self.mirrored,
        )

    def psi(self, theta, order=0):
        """Angle of the roller that is followed for ever, or its derivative."""
        pitch = TURN / self.stops
        turns = np.floor(theta / TURN)
        u = np.clip((theta - TURN * turns) / self.over, 0.0, 1.0)
        value = pitch * cycloidal(u, order) / self.over**order
        return self.start + value + pitch * turns if order == 0 else np.where((u > 0.0) & (u < 1.0), value, 0.0)

    @property
    def globoid(self):
        return isinstance(self.form, Globoid)

    def contact(self, theta, rho, side, more=0.0):
        """Points (n, 3) touched at angles and places of a roller, its radius greater by `more`."""
        psi, slope, radius = self.psi(theta), self.psi(theta, 1), self.roller + more
        er = np.stack([np.cos(theta), np.sin(theta), 0.0 * theta], axis=-1)
        et = np.stack([-np.sin(theta), np.cos(theta), 0.0 * theta], axis=-1)
        k = np.array([0.0, 0.0, 1.0])
        if self.globoid:
            c = self.form.distance
            alpha = np.arctan2(rho * slope, c - rho * np.cos(psi))
            up = np.sin(psi)[:, None] * er + np.cos(psi)[:, None] * k
            axis = (c - rho * np.cos(psi))[:, None] * er + (self.height + rho * np.sin(psi))[:, None] * k
        else:
            l, s = self.form.pitch, self.form.sense
            alpha = np.arctan2(l * slope * np.cos(psi), rho + s * l * slope * np.sin(psi))
            up = np.broadcast_to(k, er.shape)
            y = self.form.offset - s * l * np.cos(psi)
            axis = rho[:, None] * er + y[:, None] * et + (self.height + l * np.sin(psi))[:, None] * k
        normal = -np.sin(alpha)[:, None] * et + np.cos(alpha)[:, None] * up
        return axis + side * radius * normal

    def depth(self, points):
        r = np.hypot(points[..., 0], points[..., 1])
        if self.globoid:
            return np.hypot(self.form.distance - r, points[..., 2] - self.height) - self.form.radius
        return self.form.radius - r

    def on_layer(self, theta, depth, side, more=0.0):
        """Points (n, 3) touched in the layer of a depth, by halving along the roller."""
        if self.globoid:
            low, high = np.full_like(theta, self.form.radius - 5.0), np.full_like(theta, self.form.distance - 1.0)
        else:
            low, high = np.full_like(theta, 1.0), np.full_like(theta, self.form.radius + 20.0)
        for _ in range(60):
            middle = 0.5 * (low + high)
            deeper = self.depth(self.contact(theta, middle, side, more)) > depth
            inwards = deeper if self.globoid else ~deeper
            low, high = np.where(inwards, low, middle), np.where(inwards, middle, high)
        return self.contact(theta, 0.5 * (low + high), side, more)


def changed(turret, **how):
    """The turret with fields changed."""
    return replace(turret, **how)


GLOBOID = Turret(
    Globoid(49.0, 13.0, 90.0), 8, math.radians(-22.5), math.radians(120.0), 8.0, 49.0, 61.0, 50.0, 25.0, 0.0, 16.0
)
"""c16 in a cam: 8 rollers on a turret 90 mm from the cam's axis."""


def tube(turret, step=0.01, strips=4, across=24, radial=False):
    """What the roller sweeps, as points (rings, n, 3): from beyond one end of the cam to beyond the other.

    With `radial` the flanks go straight towards the axis from their outer edge, as careless modelling has them.
    """
    form, half = turret.form, max(turret.height, turret.length - turret.height)
    arm = form.radius - 1.0 if turret.globoid else form.pitch
    most = math.asin(min(0.99, (half + 1.25 * turret.roller) / arm))
    theta = np.arange(-turret.stops * TURN, turret.stops * TURN, step)
    theta = theta[np.abs(turret.psi(theta)) < most]
    depths = np.linspace(form.depth, -1.0, strips + 1)
    low = np.stack([turret.on_layer(theta, depth, -1) for depth in depths], axis=1)
    high = np.stack([turret.on_layer(theta, depth, 1, turret.clearance) for depth in depths], axis=1)
    if radial:
        low, high = (straight(turret, rows, depths) for rows in (low, high))
    share = np.linspace(0.0, 1.0, across + 1)[1:-1]
    top = between(turret, low[:, -1], high[:, -1], share, depths[-1])
    floor = between(turret, high[:, 0], low[:, 0], share, depths[0])
    return np.concatenate([low, top, high[:, ::-1], floor], axis=1)


def straight(turret, rows, depths):
    """Rows of a barrel's flank with the angle and height of the place on the blank."""
    edge = rows[:, -2]
    share = (turret.form.radius - depths) / np.hypot(edge[:, :1], edge[:, 1:2])
    return np.stack([edge[:, :1] * share, edge[:, 1:2] * share, np.broadcast_to(edge[:, 2:], share.shape)], axis=-1)


def between(turret, one, other, share, depth):
    """Points (n, m, 3) of a layer from one row (n, 3) to another, by shares (m,)."""
    first, last = (chart(turret, row) for row in (one, other))
    last[:, 0] = first[:, 0] + np.remainder(last[:, 0] - first[:, 0] + math.pi, TURN) - math.pi
    phi, height = np.moveaxis(first[:, None] + share[:, None] * (last - first)[:, None], -1, 0)
    if turret.globoid:
        wide = turret.form.radius + depth
        r, z = turret.form.distance - wide * np.cos(height), turret.height + wide * np.sin(height)
    else:
        r, z = turret.form.radius - depth, height
    return np.stack([r * np.cos(phi), r * np.sin(phi), z + 0.0 * phi], axis=-1)


def chart(turret, points):
    """Polar angle and height of points (n, 3), of a globoid the angle about the turret's axis."""
    phi, r, z = np.arctan2(points[:, 1], points[:, 0]), np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    return np.stack([phi, np.arctan2(z - turret.height, turret.form.distance - r) if turret.globoid else z], axis=-1)


def closed(rings):
    """Triangles of a tube with rings (m, n, 3) of points, closed at both ends by fans."""
    m, n, _ = rings.shape
    i, j = np.meshgrid(np.arange(m - 1), np.arange(n), indexing="ij")
    a, b, c, d = (((i + u) * n + (j + v) % n).ravel() for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)))
    ring = np.arange(n)
    last = ring + (m - 1) * n
    ends = [
        np.stack([ring, np.roll(ring, -1), np.full(n, m * n)], axis=1),
        np.stack([np.roll(last, -1), last, np.full(n, m * n + 1)], axis=1),
    ]
    sides = [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    points = np.concatenate([rings.reshape(-1, 3), rings[0].mean(axis=0)[None], rings[-1].mean(axis=0)[None]])
    return points, np.concatenate(sides + ends)


def made(turret, segments=720, **how):
    """Points (n, 3), mm, and triangles (t, 3) of the cam: its blank less the tube."""
    form, height, length = turret.form, turret.height, turret.length
    if turret.globoid:
        z = np.linspace(0.0, length, 121) - height
        rim = np.stack([form.distance - np.sqrt(form.radius**2 - z**2), z + height], axis=1)
    else:
        rim = np.array([[form.radius, 0.0], [form.radius, length]])
    profile = np.concatenate([[[0.5 * turret.bore, 0.0]], rim, [[0.5 * turret.bore, length]]])
    blank = manifold3d.Manifold.revolve(manifold3d.CrossSection([profile]), segments)
    cut = solid(*closed(tube(turret, **how)))
    if cut.volume() < 0.0:
        points, corners = closed(tube(turret, **how))
        cut = solid(points, corners[:, ::-1])
    left = (blank - cut).to_mesh64()
    points, corners = np.array(left.vert_properties)[:, :3], np.array(left.tri_verts).astype(np.int64)
    return (points * [1.0, -1.0, 1.0], corners[:, ::-1]) if turret.mirrored else (points, corners)


def solid(points, corners):
    """A mesh as another library's solid."""
    return manifold3d.Manifold(manifold3d.Mesh64(points.astype(np.float64), corners.astype(np.uint64)))


def written(path, points, corners, precision=np.float64):
    """The mesh as a PLY, or where precision is single as an STL."""
    places = points[corners]
    if path.suffix == ".stl":
        records = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
        records["p"] = places
        path.write_bytes(bytes(80) + np.uint32(len(corners)).tobytes() + records.tobytes())
        return path
    kind = "double" if precision is np.float64 else "float"
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property {kind} {axis}\n" for axis in "xyz")
    head += f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    faces = np.zeros(len(corners), dtype=[("n", "u1"), ("c", "<i4", 3)])
    faces["n"], faces["c"] = 3, corners
    path.write_bytes(head.encode() + points.astype("<f8" if kind == "double" else "<f4").tobytes() + faces.tobytes())
    return path
