"""Cam contours in closed form and files of them, made with numpy and ezdxf alone: nothing here comes from camgeo."""

from __future__ import annotations

import numpy as np

from support.heavy import ezdxf

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def circle_points(count, offset=0.0):
    t = (np.arange(count) + offset) * 2 * np.pi / count
    return np.column_stack([np.cos(t), np.sin(t)])


def support_points(count, mean=25.0, harmonics=((3, 2.0, 0.0), (5, 0.0, 0.3))):
    """Points p u + p' n of p = mean + sum of a cos kt + b sin kt: constant breadth 2 mean for odd k."""
    t = np.arange(count) * 2 * np.pi / count
    p, slope = np.full(count, mean), np.zeros(count)
    for k, a, b in harmonics:
        p += a * np.cos(k * t) + b * np.sin(k * t)
        slope += k * (b * np.cos(k * t) - a * np.sin(k * t))
    return np.column_stack([p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)])


def pitch_polar(t, lam, mu, arm, cos_terms):
    """W's analytic route: r = sqrt2 (a sqrt(l^2 + D) + b sqrt(l^2 - D)), and r'."""
    alpha = np.pi * mu / lam
    a, b = np.cos(np.pi / 4 - alpha / 2), np.sin(np.pi / 4 - alpha / 2)
    d = sum(c * np.cos(j * lam * t) for j, c in cos_terms.items())
    slope = sum(-c * j * lam * np.sin(j * lam * t) for j, c in cos_terms.items())
    plus, minus = np.sqrt(arm**2 + d), np.sqrt(arm**2 - d)
    return np.sqrt(2) * (a * plus + b * minus), slope / np.sqrt(2) * (a / plus - b / minus)


def roller_points(count, law, radius):
    """Points of the contour at the roller's radius inside the pitch curve; law = (lam, mu, arm, {j: a})."""
    t = np.arange(count) * 2 * np.pi / count
    r, slope = pitch_polar(t, *law)
    u, n = np.column_stack([np.cos(t), np.sin(t)]), np.column_stack([-np.sin(t), np.cos(t)])
    tangent = slope[:, None] * u + r[:, None] * n
    outward = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
    return r[:, None] * u - radius * outward


def arcs_through(points):
    """Every other point, and the bulges of the arcs through three consecutive ones."""
    start, middle = points[::2], points[1::2]
    end = np.roll(start, -1, axis=0)
    a, b = start - middle, end - middle
    # the angle from a to b is pi + sweep/2, counter-clockwise
    angle = np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))
    return start, np.tan((np.mod(angle, 2 * np.pi) - np.pi) / 2)


def write_dxf(path, vertices, bulges=None, *, bores=((0.0, 0.0, 5.0),), units=4, closed=True, extra=None, twice=False):
    """The least text that is a DXF file; what is drawn besides, by `extra`, goes through ezdxf."""
    bulges = np.zeros(len(vertices)) if bulges is None else bulges
    rows = [(x, y, b) for (x, y), b in zip(vertices.tolist(), bulges.tolist(), strict=True)]
    if extra:
        document = ezdxf.new("R2010")
        document.header["$INSUNITS"] = units
        space = document.modelspace()
        space.add_lwpolyline(rows, format="xyb", close=closed, dxfattribs={"layer": "CUT"})
        for x, y, radius in bores:
            space.add_circle((x, y), radius, dxfattribs={"layer": "BORE"})
        extra(space)
        document.saveas(path)
        return path
    contour = _entity("LWPOLYLINE", "CUT", "AcDbPolyline", (90, len(rows)), (70, int(closed)))
    contour += "".join(f"10\n{x}\n20\n{y}\n" + (f"42\n{b}\n" if b else "") for x, y, b in rows)
    holes = [
        _entity("CIRCLE", "BORE", "AcDbCircle", (10, x), (20, y), (30, 0.0), (40, radius)) for x, y, radius in bores
    ]
    entities = [contour] * (2 if twice else 1) + holes
    header = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1024\n9\n$INSUNITS\n70\n{units}\n0\nENDSEC\n"
    path.write_text(f"{header}0\nSECTION\n2\nENTITIES\n{''.join(entities)}0\nENDSEC\n0\nEOF\n")
    return path


def _entity(kind, layer, subclass, *tags):
    rows = [(0, kind), (100, "AcDbEntity"), (8, layer), (100, subclass), *tags]
    return "".join(f"{code}\n{value}\n" for code, value in rows)


def write_lines(path, vertices, leave_out=(), backwards=()):
    """Loose LINE entities, some left out, some drawn backwards."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    for k, (a, b) in enumerate(zip(vertices, np.roll(vertices, -1, axis=0), strict=True)):
        if k not in leave_out:
            space.add_line(*((b, a) if k in backwards else (a, b)), dxfattribs={"layer": "CUT"})
    space.add_circle((0, 0), 5.0, dxfattribs={"layer": "BORE"})
    document.saveas(path)
    return path


def solid_triangles(outer, inner, low, high):
    """Triangles (t, 3, 3) of the ring between two polygons of equally many corners, extruded."""

    def at(points, z):
        return np.column_stack([points, np.full(len(points), z)])

    def strip(a, b):
        """Triangles between two rows of points, facing a x b."""
        a2, b2 = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
        return np.concatenate([np.stack([a, a2, b2], axis=1), np.stack([a, b2, b], axis=1)])

    return np.concatenate(
        [
            strip(at(outer, low), at(outer, high)),
            strip(at(inner, high), at(inner, low)),
            strip(at(outer, high), at(inner, high)),
            strip(at(inner, low), at(outer, low)),
        ]
    )


def write_stl(path, triangles):
    record = np.zeros(len(triangles), RECORD)
    record["corners"] = triangles
    path.write_bytes(bytes(80) + np.uint32(len(triangles)).tobytes() + record.tobytes())
    return path
