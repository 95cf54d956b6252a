"""Two arms about one pivot and the cam that works them, as the figures of Wunderlich 1984 show them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from drawing import ROLLER, Look, unit

import camgeo

if TYPE_CHECKING:
    from drawing import Array, Panel

    from camgeo.api.design import Design

ROOT = Path(__file__).parents[2]
STAR = Look("", "output-edge", 1.2, "5 4")


@dataclass(frozen=True)
class Position:
    """The follower at one shaft angle, in the cam's axes: pivot P, ends A and B of the arms, mm; phi and psi, rad."""

    phi: float
    psi: float
    p: Array
    a: Array
    b: Array


@dataclass(frozen=True)
class Pair:
    """A cam for two arms of length `arm` that include 2 alpha; `share` of psi is what its motion gives."""

    design: Design
    arm: float
    alpha: float
    lam: int
    roller: float
    share: float = 1.0

    @classmethod
    def of(cls, source: Path | str) -> Pair:
        """Design the cam of a recipe."""
        design = camgeo.design(camgeo.load(source))
        cam = design.recipe.cam
        flat = cam.kind == "flat-pair"
        roller = 0.0 if flat else cam.roller_radius
        return cls(design, cam.arm, np.pi * cam.mu / cam.lam, cam.lam, roller, 0.5 if flat else 1.0)

    @classmethod
    def shipped(cls, name: str) -> Pair:
        """Design a shipped recipe."""
        return cls.of(ROOT / "recipes" / f"{name}.yaml")

    @property
    def delta(self) -> float:
        """Half the law's period, rad."""
        return np.pi / self.lam

    def psi(self, phi: Array) -> Array:
        """Follower angle at shaft angles (n,), rad."""
        swing: Array = self.design.motion(phi) / self.share
        return swing

    def end(self, phi: Array, side: int) -> Array:
        """Path of A (`side` -1) or B (1) in the cam's axes, (n, 2): P, and an arm from it."""
        return self.arm * (unit(phi) + unit(phi - self.psi(phi) + side * self.alpha))

    def at(self, phi: float) -> Position:
        """Return the position at one shaft angle, rad."""
        here = np.array([phi])
        psi = float(self.psi(here)[0])
        return Position(phi, psi, self.arm * unit(phi), self.end(here, -1)[0], self.end(here, 1)[0])

    def chain(self, phi: float, count: int) -> list[Position]:
        """Return adjacent positions, each with its A where B of the one before was (W 4.6)."""
        found = [self.at(phi)]
        while len(found) < count:
            last = found[-1]
            found.append(self.at(last.phi - last.psi + self.alpha))
        return found

    def pitch(self, count: int = 361) -> Array:
        """Points of the pitch curve, the first again at the end."""
        return self.end(np.linspace(0.0, 2.0 * np.pi, count), -1)


def follower(panel: Panel, pair: Pair, at: Position) -> None:
    """Draw the arms, the rollers and the pivot."""
    for end in (at.a, at.b):
        panel.line([at.p, end], Look("", "follower-edge", 4.0))
    for end in (at.a, at.b):
        panel.circle(end, pair.roller, ROLLER)
        panel.dot(end)
    panel.pin(at.p)


def polygon(panel: Panel, chain: list[Position], look: Look = STAR) -> None:
    """Draw the chord polygon of adjacent positions."""
    panel.line([at.a for at in chain], look, closed=True)


def centre(panel: Panel, beside: tuple[float, float] = (-11, -11)) -> None:
    """Draw the shaft's centre with its letter."""
    panel.pin((0.0, 0.0))
    panel.letter((0.0, 0.0), "O", beside)


def swing(pair: Pair) -> float:
    """Greatest psi over a turn, rad."""
    return float(pair.psi(np.linspace(0.0, 2.0 * np.pi, 72_001)).max())
