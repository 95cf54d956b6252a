"""Meshes of grooves of several turns that cross: a blank less what the roller takes, by manifold3d.

The way of the roller is cut into pieces of less than a turn, each a row of sections between exact flanks.
"""

import manifold3d
import numpy as np
from capabilities.cylindrical.kin.drums import TURN, Drum, Groove, Motion, between, polar, sought

# of the pitch 20 at constant velocity, as c14 is
OUT_AND_BACK = Motion(((55.0, 1080.0, "cv-blended"), (-55.0, 1080.0, "cv-blended")))
TWO_AND_ONE = Motion(((36.0, 720.0, "cv-blended"), (-36.0, 360.0, "cv-blended")))
PIECES = 2  # of a turn
FINE = 2e-5  # mm: what is smaller is none in a file of single precision
ABOVE = 1.0  # mm over the blank, where a piece ends


def screw(motion=OUT_AND_BACK, **more):
    """A drum of 30 mm with a groove for a pin of 5 mm, c14 to begin with, and a shoe of 60 mm."""
    stroke = float(motion(np.linspace(0.0, motion.turns * TURN, 4001)).max())
    given = {
        "roller": 5.0, "inner": 23.0, "outer": 30.0, "level": 12.0, "track": Groove(7.5), "radius": 30.0,
        "length": 24.0 + stroke, "bore": 8.0, "shoe": 60.0,
    }  # fmt: skip
    return Drum(motion, **{**given, **more})


def piece(drum, number, steps, touched=None):
    """What the roller takes in one piece of the way, by number: points (n, 3) and triangles (t, 3)."""
    columns, rows, across = steps
    # pieces go on over a column of the next, with the same corners: faces that look at one another make booleans frail
    each = columns // PIECES
    theta = (np.arange(each * number, each * (number + 1) + 2) % (columns * drum.motion.turns)) * (TURN / columns)
    inward = np.append(drum.radius + ABOVE, np.linspace(drum.radius, drum.floor, rows + 1))
    sides = [(touched or drum.touched)(theta, inward, side, roller, level) for _, side, roller, level in drum.flanks]
    lower, upper = (polar(phi, inward, z) for phi, z in sides)

    def joined(k, way, r):
        phi, z = (between(one[:, [k]], other[:, [k]], across)[:, :-1] for one, other in zip(*way, strict=True))
        return polar(phi, r, z)

    floor, top = joined(-1, sides, inward[-1]), joined(0, sides[::-1], inward[0])
    rings = np.concatenate([lower, floor, upper[:, ::-1], top], axis=1)
    n, m = rings.shape[:2]
    k, i = (x.ravel() for x in np.meshgrid(np.arange(n - 1), np.arange(m), indexing="ij"))
    up = (i + 1) % m
    a, b, c, d = k * m + i, (k + 1) * m + i, (k + 1) * m + up, k * m + up
    walls = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    height, width = lower.shape[1], floor.shape[1]
    left, right = np.arange(height), (2 * height + width - 1) - np.arange(height)
    faces = []
    for j in range(height - 2):
        faces += [(left[j], left[j + 1], right[j + 1]), (left[j], right[j + 1], right[j])]
    bottom = np.arange(height - 2, height + width + 2)  # the floor bulges into the cap
    faces += [(bottom[0], bottom[j], bottom[j + 1]) for j in range(1, len(bottom) - 1)]
    lid = np.append(np.arange(2 * height + width - 1, m), 0)
    faces += [(lid[0], lid[j], lid[j + 1]) for j in range(1, len(lid) - 1)]
    cap = np.array(faces)
    triangles = np.concatenate([walls, cap, cap[:, ::-1] + (n - 1) * m])
    return np.round(rings.reshape(-1, 3), 9), triangles  # alike to the last bit in both pieces


def solid(points, triangles):
    """A manifold; triangles may look inwards."""
    a, b, c = (points[triangles[:, j]] for j in range(3))
    if np.einsum("nk,nk->", a, np.cross(b, c)) < 0.0:
        triangles = triangles[:, ::-1]
    mesh = manifold3d.Mesh64(points, triangles.astype(np.uint64))
    made = manifold3d.Manifold(mesh)
    assert made.status() == manifold3d.Error.NoError, made.status()
    return made


def ring(drum, columns):
    """The blank with its bore."""
    phi = np.arange(columns) * (TURN / columns)
    rings = (drum.radius, phi), (drum.bore, -phi)
    flat = [r * np.stack([np.cos(a), np.sin(a)], axis=-1) for r, a in rings]
    return manifold3d.Manifold.extrude(manifold3d.CrossSection(flat), drum.length)


def cut(drum, columns=360, rows=4, across=10, *, touched=None, pieces=None, blank=None):
    """Places (v, 3) and triangles (t, 3) of a drum, of so many columns a turn.

    `pieces` chooses from what is taken away, by number; `touched` gives other walls, `blank` another blank.
    """
    taken = taken_away(drum, columns, rows, across, touched=touched, pieces=pieces)
    return plain((blank or ring(drum, columns)) - union(taken))


def taken_away(drum, columns=360, rows=4, across=10, *, touched=None, pieces=None):
    """Pieces of what the roller takes, PIECES a turn."""
    count = PIECES * drum.motion.turns
    return [solid(*piece(drum, k, (columns, rows, across), touched)) for k in pieces or range(count)]


def union(bodies):
    """All of some manifolds."""
    return manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add)


def plain(body):
    """Places (v, 3) and triangles (t, 3) of a manifold as a file of single precision can have them.

    Corners that are one there are one.
    """
    mesh = body.simplify(FINE).to_mesh64()
    places = np.asarray(mesh.vert_properties[:, :3]).astype(np.float32)
    order = np.lexsort(places.T)
    first = np.append(True, (np.diff(places[order], axis=0) != 0.0).any(axis=1))
    number = np.empty(len(places), dtype=np.intp)
    number[order] = np.cumsum(first) - 1
    places, corners = places[order[first]], number[np.asarray(mesh.tri_verts, dtype=np.intp)]
    distinct = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    return places.astype(float), corners[distinct]


def outside(drum, points, turns=None):
    """Least distance (n,) of points (n, 3) from what the roller takes at all angles of some turns, below 0 within it.

    Positions alone: the least of all distances from its axis, sought in each turn about the point.
    """
    phi, r = np.arctan2(points[:, 1], points[:, 0]), np.hypot(points[:, 0], points[:, 1])
    reach = np.arcsin(np.minimum(1.0, 1.02 * drum.roller / r))[:, None]

    def away(theta):
        _, z = drum.axis(theta, drum.level)
        return np.hypot(r[:, None] * np.sin(phi[:, None] - theta), points[:, [2]] - z) - drum.roller

    spread = reach * np.linspace(-1.0, 1.0, 41)
    every = range(drum.motion.turns) if turns is None else turns
    return np.min([sought(away, phi[:, None] + TURN * k + spread, reach / 20.0, np.argmin) for k in every], axis=0)


def line(drum, theta, rho, side):
    """Points (n, 3) that the pin touches at angles (n,) and the place rho along it."""
    a = np.arctan2(drum.motion(theta, 1), rho)
    y, z = -side * drum.roller * np.sin(a), drum.level + drum.motion(theta) + side * drum.roller * np.cos(a)
    return np.stack([rho * np.cos(theta) - y * np.sin(theta), rho * np.sin(theta) + y * np.cos(theta), z], axis=-1)
