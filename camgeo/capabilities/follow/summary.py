"""Figures of the motion that a contour gives a follower: as plain data, and as text for a terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.common.terminal import escaped
from kin.follower.measured import LEAST_DWELL
from kin.numeric.angles import TURN
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.follow.library import Followed, Rest
    from kin.numeric.arrays import Array


def document(followed: Followed) -> dict[str, Any]:
    """The motion's figures as plain data for JSON; lengths in mm, angles in degrees."""
    scale, unit = (1.0, "mm") if followed.unit == "mm" else (math.degrees(1.0), "deg")
    travel, radius, known = followed.contact_travel, followed.radius, followed.known
    least, greatest, smoothed = followed.least, followed.greatest, None
    if not known.all():
        low, high = np.where(known, followed.position, np.inf), np.where(known, followed.position, -np.inf)
        least = float(low.min()), float(followed.theta[low.argmin()])
        greatest = float(high.max()), float(followed.theta[high.argmax()])
    if followed.facets is not None:  # what a polygon says of radii and accelerations is of its corners
        radius = np.full(len(radius), math.inf)
        if followed.smoothed is not None and known.any():
            kept = scale * followed.smoothed[known]
            smoothed = [float(kept.min()), float(kept.max())]
    return {
        "file": followed.path.name,
        "follower": followed.follower.words,
        "unit": unit,
        "base_radius": followed.follower.base_radius(least[0]),
        "lift": scale * (greatest[0] - least[0]),
        "least": {"position": scale * least[0], "at_deg": math.degrees(least[1])},
        "greatest": {"position": scale * greatest[0], "at_deg": math.degrees(greatest[1])},
        "dwells": [
            {
                "start_deg": math.degrees(rest.begin),
                "length_deg": math.degrees(rest.end - rest.begin),
                "position": scale * rest.level,
                "flatness": scale * rest.flatness,
            }
            for rest in known_rests(followed.rests, followed.unknown)
        ],
        # the greatest magnitude, as the least of the negative ones
        "pressure_angle": _least(followed, -math.degrees(1.0) * abs(followed.pressure_angle)),
        "radius_of_curvature": _least(followed, np.where(radius < 0.0, math.inf, radius)),
        "hollow_radius": _least(followed, np.where(radius < 0.0, -radius, math.inf)),
        "facets": followed.facets,
        "smoothed_acceleration": smoothed,
        "breadth": None if followed.breadth is None else list(followed.breadth),
        "play": None if followed.play is None else [scale * value for value in followed.play],
        "contact_travel": None if travel is None else list(travel),
        "across": [_across(followed, begin, end, scale) for begin, end in followed.unknown],
        "openings": followed.openings,
        "remarks": list(followed.remarks),
    }


def known_rests(rests: Sequence[Rest], unknown: Sequence[tuple[float, float]]) -> list[Rest]:
    """Dwells without what of them lies in unknown stretches, (begin, end), rad; parts below ten degrees go."""
    left = list(rests)
    for begin, end in unknown:
        parts = []
        for rest in left:
            first = begin + TURN * math.ceil((rest.begin - end) / TURN)  # the stretch that ends beyond its beginning
            last = first + end - begin
            sides = [(rest.begin, min(rest.end, first)), (max(rest.begin, last), rest.end)]
            cut = first < rest.end
            parts += [replace(rest, begin=a, end=b) for a, b in sides if b - a >= LEAST_DWELL] if cut else [rest]
        left = parts
    return left


def _across(followed: Followed, begin: float, end: float, scale: float) -> dict[str, float]:
    """Figures of the motion over a stretch of shaft angles, rad, in which nothing is known of the contour."""
    within = (followed.theta - begin) % TURN <= end - begin
    position, pressure = scale * followed.position[within], followed.pressure_angle[within]
    return {
        "start_deg": math.degrees(begin),
        "end_deg": math.degrees(end) % 360.0,
        "least": float(position.min()),
        "greatest": float(position.max()),
        "pressure_angle": math.degrees(float(np.abs(pressure).max())),
    }


def _least(followed: Followed, values: Array) -> dict[str, float] | None:
    """Magnitude of the least of values (n,) where the contour is known, and its shaft angle; None if not finite."""
    values = np.where(followed.known, values, math.inf)
    place = int(values.argmin())
    if not math.isfinite(values[place]):
        return None
    return {"value": abs(float(values[place])), "at_deg": math.degrees(float(followed.theta[place]))}


def summary(followed: Followed) -> str:
    """The motion's figures in lines of text."""
    figures = document(followed)
    unit, least, most = figures["unit"], figures["least"], figures["greatest"]
    ends = f"least at {least['at_deg']:.2f} degrees, greatest at {most['at_deg']:.2f}"
    lines = [
        f"{escaped(figures['file'])}: {figures['follower']}",
        f"  lift {figures['lift']:.6g} {unit}, {ends}; base radius {figures['base_radius']:.6g} mm",
    ]
    for dwell in figures["dwells"]:
        end = (dwell["start_deg"] + dwell["length_deg"]) % 360.0
        height = round(dwell["position"] - least["position"], 7) + 0.0  # no more than rounding on a large roller
        lines.append(
            f"  dwell at {height:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
            f"flat within {dwell['flatness']:.2g} {unit}"
        )
    angle = figures["pressure_angle"]
    lines.append(f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}")
    radii = {"least radius of curvature": "radius_of_curvature", "least radius of a hollow": "hollow_radius"}
    for words, key in radii.items():
        if (radius := figures[key]) is not None:
            corner = "" if radius["value"] else ", a corner,"
            lines.append(f"  {words} {radius['value']:.4g} mm{corner} at {radius['at_deg']:.1f} degrees")
    if (facets := figures["facets"]) is not None:
        lines.append(f"  a polygon: its edges stand {facets:.2g} mm off a curve, and say nothing of radii of curvature")
        if (pair := figures["smoothed_acceleration"]) is not None:
            lines.append(f"  acceleration of the smoothed motion from {pair[0]:.4g} to {pair[1]:.4g} {unit}/rad²")
    for words, key, scale in (("breadth", "breadth", "mm"), ("play in the groove", "play", unit)):
        if (pair := figures[key]) is not None:
            lines.append(f"  {words} from {pair[0]:.6g} to {pair[1]:.6g} {scale}")
    if (travel := figures["contact_travel"]) is not None:
        width = "" if unit == "deg" else f", a centred face is {2.0 * max(map(abs, travel)):.6g} mm wide"
        lines.append(f"  contact on the face from {travel[0]:.6g} to {travel[1]:.6g} mm{width}")
    if count := figures["openings"]:
        contours = "1 other closed contour is" if count == 1 else f"{count} other closed contours are"
        lines.append(f"  {contours} passed over: a bore that is not round, holes, or what is drawn in them")
    for part in figures["across"]:
        low, high = (round(part[key] - least["position"], 7) + 0.0 for key in ("least", "greatest"))
        lines.append(
            f"  where it is closed, from {part['start_deg']:.1f} to {part['end_deg']:.1f} degrees: at {low:.6g} to "
            f"{high:.6g} {unit}, pressure angle up to {part['pressure_angle']:.2f} degrees"
        )
    lines += [f"  {escaped(remark)}" for remark in figures["remarks"]]
    return "\n".join(lines)
