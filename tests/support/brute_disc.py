"""Where a follower rests on a drawing, by looking at every vertex of a dense polygon: ezdxf and numpy alone.

Angles in radians, lengths in mm; a place is the lift's coordinate along the stem, or the arm's angle from the line
pivot-shaft. Nothing here comes from camgeo or kin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from support.heavy import ezdxf

LAWS = {
    "cycloidal": lambda u: u - np.sin(2 * np.pi * u) / (2 * np.pi),
    "polynomial-345": lambda u: u**3 * (10 - 15 * u + 6 * u**2),
    "polynomial-4567": lambda u: u**4 * (35 - 84 * u + 70 * u**2 - 20 * u**3),
    "parabolic": lambda u: np.where(u < 0.5, 2 * u**2, 1 - 2 * (1 - u) ** 2),
}


@dataclass(frozen=True)
class Touching:
    """A follower: kind, radius, and a stem's offset and tilt or an arm's pivot, length or face, and sense."""

    kind: str
    radius: float = 0.0
    offset: float = 0.0
    tilt: float = 0.0
    pivot: float = 0.0
    length: float = 0.0
    sense: int = 0  # +1 a trailing arm, -1 a leading one, 0 a stem
    ring: bool = False

    def recipe(self, base: float, rows: list[tuple[float, float, str]], more: str) -> str:
        """Text of a recipe with this follower and motion (see `motion`), and `more` topics."""
        keys = {"kind": self.kind}
        if self.radius:
            keys["radius"] = repr(self.radius)
        if self.sense:
            held = f"face: {self.offset!r}" if self.kind == "flat" else f"length: {self.length!r}"
            side = "trailing" if self.sense > 0 else "leading"
            keys["arm"] = f"{{pivot: {self.pivot!r}, {held}, side: {side}}}"
        elif self.kind == "flat":
            keys["tilt"] = repr(math.degrees(self.tilt))
        else:
            keys["offset"] = repr(self.offset)
        follower = ", ".join(f"{key}: {value}" for key, value in keys.items())
        steps = [
            f"{{{'rise' if by > 0 else 'return'}: {abs(by)!r}, over: {over!r}, law: {law}}}"
            if law
            else f"{{dwell: {over!r}}}"
            for by, over, law in rows
        ]
        track = "track: internal, " if self.ring else ""
        cam = f"kind: disc, base_radius: {base!r}, {track}follower: {{{follower}}}, motion: [{', '.join(steps)}]"
        part = f"part: {{outer: {4.0 * base + 100.0!r}}}\n" if self.ring else ""
        return f"cam: {{{cam}}}\n{part}{more}"

    def rest(self, base: float) -> float:
        """Place at displacement 0, from the base radius."""
        prime = base - self.radius if self.ring else base + self.radius
        if self.kind == "flat":
            if self.sense:
                return math.asin((base + self.offset) / self.pivot)
            return base / math.cos(self.tilt)
        if self.sense:
            triangle = self.pivot**2 + self.length**2 - prime**2
            return math.acos(triangle / (2 * self.pivot * self.length))
        return math.sqrt(prime**2 - self.offset**2)

    def place(self, polygon: np.ndarray, theta: float, base: float) -> float:
        """Where it is held by the vertices (n,), complex, of the cam turned by theta; a knife edge by its sides.

        In a ring it is held by what lies before it.
        """
        turned = polygon * np.exp(-1j * theta)
        if self.kind == "flat":
            return self._face(turned)
        if self.sense:
            off = self.pivot - turned
            far, beta = np.abs(off), self.sense * np.angle(off)
            if self.kind == "knife-edge":
                return _outermost(beta, far - self.length)
            cosine = (self.length**2 + far**2 - self.radius**2) / (2 * self.length * far)
            near = np.abs(cosine) <= 1.0
            apart, beta = np.arccos(cosine[near]), beta[near]
            return float((beta - apart)[beta > self.rest(base)].min() if self.ring else (beta + apart).max())
        across = turned.imag - self.offset
        if self.kind == "knife-edge":
            return _outermost(turned.real, across)
        near = np.abs(across) <= self.radius
        along, reach = turned.real[near], np.sqrt(self.radius**2 - across[near] ** 2)
        return float((along - reach)[along > self.rest(base)].min() if self.ring else (along + reach).max())

    def _face(self, turned: np.ndarray) -> float:
        if not self.sense:
            return float((turned * np.exp(-1j * self.tilt)).real.max() / math.cos(self.tilt))
        off = self.pivot - turned
        far, beta = np.abs(off), self.sense * np.angle(off)
        return float((np.arcsin(self.offset / far) + beta).max())


def _outermost(place: np.ndarray, beside: np.ndarray) -> float:
    """Greatest place at which a closed polygon is crossed by the path of a point, `beside` which its vertices lie."""
    following, next_place = np.roll(beside, -1), np.roll(place, -1)
    cut = (beside * following <= 0) & (beside != following)
    share = beside[cut] / (beside[cut] - following[cut])
    return float((place[cut] + share * (next_place[cut] - place[cut])).max())


def motion(rows: list[tuple[float, float, str]], degrees: np.ndarray) -> np.ndarray:
    """Displacement of strokes (by, over, law), a dwell without a law, over the turn; 0 where it is lowest."""
    ends = np.cumsum([0.0, *(over for _, over, _ in rows)])
    low = np.cumsum([0.0, *(by for by, _, _ in rows)])
    row = np.clip(np.searchsorted(ends, degrees % 360, side="right") - 1, 0, len(rows) - 1)
    found = low[row]
    for i, (by, over, law) in enumerate(rows):
        inside = row == i
        if law:
            found[inside] += by * LAWS[law](np.clip((degrees % 360 - ends[i])[inside] / over, 0.0, 1.0))
    return found - low.min()


def polygon(path: Any, step: float = 0.01, layer: str = "") -> np.ndarray:
    """The outermost contour of a drawing, or of a layer, as complex vertices (n,), its arcs in steps of that length."""
    entities = [entity for entity in ezdxf.readfile(path).modelspace() if layer in {"", entity.dxf.layer}]
    outlines = [_vertices(entity, step) for entity in entities]
    return max((outline for outline in outlines if len(outline)), key=lambda outline: np.abs(outline).max())


def _vertices(entity: Any, step: float) -> np.ndarray:
    if entity.dxftype() == "SPLINE":
        return np.array([complex(v.x, v.y) for v in entity.construction_tool().approximate(40_000)])
    if entity.dxftype() != "LWPOLYLINE":
        return np.empty(0, complex)
    rows = list(entity.get_points("xyb"))
    parts = []
    for (x, y, bulge), (u, v, _) in zip(rows, rows[1:] + rows[:1], strict=True):
        start, chord, angle = complex(x, y), complex(u - x, v - y), 4 * math.atan(bulge)
        share = np.linspace(0.0, 1.0, max(4, math.ceil(abs(chord) / step)), endpoint=False)
        if bulge:
            centre = start + chord / 2 + 1j * chord * (1 / bulge - bulge) / 4
            parts.append(centre + (start - centre) * np.exp(1j * angle * share))
        else:
            parts.append(start + chord * share)
    return np.concatenate(parts)


def peak(error, count, rounds=6):
    """Greatest |error(phi)|, (k, n) of phi (n,), over a turn: from `count` angles, refined about the highest."""
    phi = np.arange(count) * 2 * np.pi / count
    value = np.abs(error(phi))
    value = value.max(axis=0) if value.ndim == 2 else value
    best, tops = float(value.max()), phi[np.argsort(value)[-12:]]
    width = 2 * np.pi / count
    for _ in range(rounds):
        near = (tops[:, None] + np.linspace(-width, width, 21)).ravel()
        value = np.abs(error(near))
        value = (value.max(axis=0) if value.ndim == 2 else value).reshape(len(tops), 21)
        tops = near.reshape(len(tops), 21)[np.arange(len(tops)), value.argmax(axis=1)]
        best, width = max(best, float(value.max())), width / 10
    return best
