"""The verdict on a camshaft: a solid of round stretches and lobes, each lobe judged in its own section, at its angle.

Every stretch of the shaft between two intended faces is judged in the section midway: all others are the same, as no
wall leans and no face lies between. A lobe's section is turned back by the lobe's intended angle and judged as a disc's
contour is; so a lobe at another angle moves its follower otherwise. The check `phase` gives its turn, `position` the
places of its faces.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.judge.bore import bore_check, round_check
from kin.judge.contour_checks import judge_contour
from kin.judge.verdict import SurfaceVerdict, Verdict
from kin.numeric.angles import TURN
from kin.numeric.check import ROUNDING, Check, about, as_drawn, at_most, failed, less_sure
from kin.numeric.lengths import UNIT, length_words, span_words
from kin.numeric.limits import limit_of
from kin.numeric.records import dataclass
from kin.read.errors import NOT_READ, ReadError
from kin.read.files import kind_of, read_solid
from kin.read.layers import SAME, between_sections, settled
from kin.read.nesting import scaled

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.follower.base import Follower
    from kin.judge.intent import Limits, SurfaceIntent
    from kin.numeric.arrays import Array
    from kin.read.formats import AnySolid
    from kin.read.nesting import ClosedContour

COARSE = 720  # shaft angles at which the search for a lobe's phase begins
STEPS = 20  # of Newton's method
MOST_NAMED = 5  # faults named in a message


@dataclass(frozen=True)
class LobeIntent:
    """Intended lobe of a camshaft: its surface, turned by `at`, rad, from z = low to high, mm, and its limits."""

    name: str
    surface: SurfaceIntent
    at: float
    low: float
    high: float
    limits: Limits


@dataclass(frozen=True)
class BarIntent:
    """A round stretch of a shaft from z = low to high, mm."""

    name: str
    low: float
    high: float
    diameter: float


@dataclass(frozen=True)
class CamshaftIntent:
    """Intended camshaft.

    lobes     apart from one another and from the journals
    bars      the shaft itself, the first, and its journals, which are thicker
    bore      diameter of a hole all through it, mm; None for none
    mirrored  the solid is the mirror image in the x axis (the shaft turns counter-clockwise)
    tolerance of its round parts and its faces, mm
    """

    lobes: tuple[LobeIntent, ...]
    bars: tuple[BarIntent, ...]
    bore: float | None
    mirrored: bool
    tolerance: float

    @property
    def stretches(self) -> list[tuple[float, float, LobeIntent | BarIntent]]:
        """Outermost lobe or bar in each interval of height, from below: (from, to, part), mm."""
        shaft, *journals = self.bars
        parts: list[LobeIntent | BarIntent] = [*self.lobes, *journals, shaft]
        levels = sorted({z for part in parts for z in (part.low, part.high)})
        return [
            (low, high, next(part for part in parts if part.low <= low and high <= part.high))
            for low, high in pairwise(levels)
        ]


class _Sections(NamedTuple):
    """Chains of sections by their heights, in mm and as if not mirrored, the outermost first."""

    solid: AnySolid
    mirrored: bool

    def at(self, z: float) -> Sequence[ClosedContour]:
        return scaled(self.solid.section(z).chains, 1.0, mirrored=self.mirrored)


def verify_camshaft(path: Path, intent: CamshaftIntent, angles: int, units: float | None = None) -> Verdict:
    """Judge an STL, 3MF or STEP of a camshaft, its lobes at `angles` equal steps of the shaft.

    Checks of a lobe carry its name. `units`, mm, is the unit of a file that states none. A file that cannot be read
    gets a verdict that says why. Raises OSError where the disk refuses, ValueError for another suffix.
    """
    kind = kind_of(path)
    stretches = [(part, 0.5 * (low + high)) for low, high, part in intent.stretches]
    try:
        solid = read_solid(path, [middle for _, middle in stretches], units)
    except ReadError as error:
        unread = "readable" if error.reason in NOT_READ else "watertight"
        return Verdict(kind, (about(failed(unread, error.message), path.name),))
    solid = settled(solid, (), intent.tolerance)
    sections = _Sections(solid, intent.mirrored)
    phi = TURN / angles * np.arange(angles, dtype=np.float64)
    checks = [at_most("watertight", len(solid.faults), 0, "faults", detail="; ".join(solid.faults))]
    checks.append(_ends(solid, intent))
    surfaces: list[SurfaceVerdict] = []
    rounds: dict[str, list[Check]] = {"bore": []}
    for part, middle in stretches:
        outline, *inner = sections.at(middle)
        bore = bore_check([chain.contour for chain in inner], intent.bore, intent.tolerance)
        rounds["bore"] += [] if bore is None else [bore]
        if isinstance(part, BarIntent):
            checked = round_check("journal", outline.contour, part.diameter, intent.tolerance)
            rounds.setdefault(part.name, []).append(replace(checked, surface=part.name))
            continue
        surface, lobe_checks = _lobe(outline, part, phi, solid.uneven)
        lobe_checks.append(_position(solid, intent, part))
        checks += [replace(check, surface=part.name) for check in lobe_checks]
        surfaces.append(surface)
    checks += [_worst(same) for same in rounds.values() if same]
    checks.append(_volume(solid, intent, surfaces))
    chains = tuple(surface.contour for surface in surfaces if surface.contour is not None)
    drawn = (as_drawn(check, mirrored=intent.mirrored) for check in checks)
    named = tuple(about(check, path.name) for check in drawn)
    return Verdict(kind, named, tuple(surfaces), (), solid.units_mm or units or 1.0, (chains,), solid.uneven)


def outside_shaft(least: float, diameter: float) -> Check:
    """Check that a lobe's contour, `least` mm from the axis at least, stays outside the shaft of a `diameter`, mm."""
    radius = 0.5 * diameter
    remedy = "" if least > radius else "a larger base radius, or a thinner shaft"
    return Check("shaft", least > radius, least, radius, "mm", sense="at_least", detail=remedy)


def _worst(checks: Sequence[Check]) -> Check:
    """The worst of several checks of one kind: one that fails before others, then the greatest figure."""
    return max(checks, key=lambda check: (not check.ok, np.inf if check.value is None else check.value))


def _lobe(outline: ClosedContour, lobe: LobeIntent, phi: Array, uneven: float) -> tuple[SurfaceVerdict, list[Check]]:
    """Judge a lobe's section, turned back to where its motion begins; its phase first."""
    chain = outline._replace(contour=outline.contour.turned(-lobe.at))
    verdict, checks = judge_contour(chain, lobe.surface, phi, lobe.limits, uneven)
    return replace(verdict, name=lobe.name), [_phase(chain, lobe), *checks]


def _phase(chain: ClosedContour, lobe: LobeIntent) -> Check:
    """Check the angle by which a lobe is turned against the intended one, in degrees of the shaft.

    By this angle the intended motion fits the measured one best, by least squares; the limit is the permitted motion
    error over the greatest velocity.
    """
    gauge, limits = lobe.surface.gauge, lobe.limits
    angle = np.arange(COARSE) * TURN / COARSE
    rest, *_ = gauge.resting(chain.contour)
    measured = rest.rows(angle + 0.5 * TURN / COARSE)[0] / gauge.si
    angle += 0.5 * TURN / COARSE
    turned = _best_turn(gauge, angle, measured)
    velocity = float(np.abs(_rows(gauge, angle)[1]).max())
    error, _ = limit_of(gauge.motion_limit, limits.motion, limits.tolerance, 0.0)
    permitted = np.radians(error) if gauge.unit == "deg" else error
    detail = f"by the motion it stands {np.degrees(turned):+.6g} degrees from where it is meant, by least squares"
    if not velocity > 0.0:
        return Check("phase", True, 0.0, None, "deg", detail="its follower does not move: every angle is right")
    limit = float(np.degrees(permitted / velocity))
    return at_most("phase", float(np.degrees(abs(turned))), limit, "deg", detail=detail, slack=1e-9)


def _rows(gauge: Follower, angle: Array) -> Array:
    """Intended position, mm or radians, and its first two derivatives, (3, n)."""
    return gauge.motion.derivatives(np.mod(angle, TURN), 2)


def _best_turn(gauge: Follower, angle: Array, measured: Array) -> float:
    """Angle d, rad, by which the intended s(angle - d) fits the measured positions best, by least squares."""
    intended = _rows(gauge, angle)[0]
    # the best of all shifts by a whole number of steps, by their correlation; then Gauss and Newton's method
    spectrum = np.fft.rfft(measured - measured.mean()) * np.conj(np.fft.rfft(intended - intended.mean()))
    shift = int(np.argmax(np.fft.irfft(spectrum, len(angle))))
    turned = (shift if shift <= len(angle) // 2 else shift - len(angle)) * TURN / len(angle)
    for _ in range(STEPS):
        position, slope, _bend = _rows(gauge, angle - turned)
        step = float(slope @ (position - measured) / (slope @ slope)) if slope.any() else 0.0
        turned += step
        if abs(step) < 1e-12:
            break
    return turned


def _position(solid: AnySolid, intent: CamshaftIntent, lobe: LobeIntent) -> Check:
    """Check that a lobe has its faces where they are meant to be.

    Where it meets another lobe or a journal and the solid has no face between the middles of the two, equal bodies lie
    side by side: their common section is judged for either, and no face is due.
    """
    faces = np.array(solid.faces)
    if not faces.size:
        return failed("position", "the solid has no horizontal face", unit="mm", limit=lobe.limits.tolerance)
    ends = [lobe.low, lobe.high]
    for (low, z, below), (_, high, above) in pairwise(intent.stretches):
        between = (faces > 0.5 * (low + z)) & (faces < 0.5 * (z + high))
        if lobe in (below, above) and intent.bars[0] not in (below, above) and not between.any():
            ends.remove(z)
    nearest = [float(faces[np.abs(faces - z).argmin()]) for z in ends]
    off = max((abs(face - z) for face, z in zip(nearest, ends, strict=True)), default=0.0)
    named, right = (" and ".join(length_words(z, ".9g") for z in heights) for heights in (nearest, ends))
    detail = (
        f"faces at z = {named} {UNIT}, {right} {UNIT} are meant"
        if ends
        else "it has no face of its own beside its equals"
    )
    checked = at_most("position", off, lobe.limits.tolerance, "mm", detail=detail, slack=SAME)
    return less_sure(checked, solid.uneven)


def _ends(solid: AnySolid, intent: CamshaftIntent) -> Check:
    """Check both ends of the shaft, and that sections differ nowhere but at the intended faces."""
    shaft, heights = intent.bars[0], np.array([z for low, high, _ in intent.stretches for z in (low, high)])
    off = max(abs(solid.z_min - shaft.low), abs(solid.z_max - shaft.high))
    stray = [z for z in solid.faces if float(np.abs(heights - z).min()) > intent.tolerance + SAME]
    detail = f"z from {span_words(solid.z_min, solid.z_max)}, {span_words(shaft.low, shaft.high)} is expected"
    faults = [f"a horizontal face at z = {length_words(z, '.9g')} {UNIT}, where none is expected" for z in stray]
    faults += [fault for _, fault in between_sections(solid, np.unique(heights).tolist(), (), intent.tolerance)]
    if faults:
        return failed("thickness", "; ".join([*faults[:MOST_NAMED], detail]), unit="mm", limit=intent.tolerance)
    return less_sure(at_most("thickness", off, intent.tolerance, "mm", detail=detail, slack=SAME), solid.uneven)


def _volume(solid: AnySolid, intent: CamshaftIntent, surfaces: Sequence[SurfaceVerdict]) -> Check:
    """Check the volume against the areas of the exact sections, within the tolerance times the walls.

    Of a lobe whose exact contour has no closed form, such as a trimmed one, the contour as read counts.
    """
    bore, volume, wall = intent.bore or 0.0, 0.0, 0.0
    read = {surface.name: (surface.area or 0.0, surface.perimeter or 0.0) for surface in surfaces}
    for low, high, part in intent.stretches:
        if isinstance(part, BarIntent):
            area, length = 0.25 * np.pi * part.diameter**2, np.pi * part.diameter
        else:
            envelope = part.surface.gauge.envelope
            area, length = envelope.area_and_perimeter() if envelope.regular else read[part.name]
        volume += (area - 0.25 * np.pi * bore**2) * (high - low)
        wall += (length + np.pi * bore + 2.0 * np.pi * intent.tolerance) * (high - low) + 2.0 * area
    detail = f"{length_words(solid.volume, '.9g', 3)} {UNIT}^3, by the intent {length_words(volume, '.9g', 3)}"
    return at_most(
        "volume", abs(solid.volume - volume), intent.tolerance * wall, "mm^3", detail=detail, slack=ROUNDING * volume
    )
