"""A chamfer along both edges of the contour."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.feature import Feature, check_below
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Curve
    from camgeo.schema.reader import Reader, Values
    from kin.judge.check import Check


@dataclass(frozen=True)
class Chamfer:
    """Chamfer of 45 degrees along both edges of the contour, `height` mm high."""

    height: float

    def fineness(self, radius: float) -> float:
        """Share of a tolerance within which a polygon must be fitted so that its chamfer's inner edge keeps it too.

        Let f be the polygon's distance from the contour, e at most, and b half its turn at a corner, 4 e = r b^2 for a
        radius of curvature r. Its parallel at the distance c is off by f and by up to c b^2/2 r/(r - c) = 2 e c/(r - c)
        more, to first order. `radius` is the contour's least where it is convex, mm.
        """
        share = self.height / radius
        return (1.0 - share) / (1.0 + share)


def inset(z: float, thickness: float, chamfer: float) -> float:
    """Distance of the outline inside the contour at height z of a chamfered disc, mm; exactly 0 between chamfers."""
    upper = thickness - chamfer
    return max(chamfer - z, 0.0) if z <= upper else z - upper


def chamfer_check(chamfer: float, contour: Curve, shaft_deg: Callable[[float], float]) -> Check:
    """Check that the contour is nowhere sharper than its chamfer: its parallel inside has no corners then."""
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.support import is_sharp
    from kin.judge.check import Check

    if not contour.closed:
        kind = "sharp" if is_sharp(contour) else "trimmed"
        detail = f"a {kind} contour has corners, along which no chamfer runs; leave it out"
        if kind == "sharp":
            detail += f", or give a reuleaux.rounding above {chamfer:.6g} mm"
        return Check(FEATURE.name, ok=False, value=0.0, limit=chamfer, unit="mm", sense="at_least", detail=detail)
    radius, at = least_radius(contour)
    sharp = "the contour's least radius of curvature must be above the chamfer"
    return Check(FEATURE.name, radius > chamfer, radius, chamfer, "mm", shaft_deg(at), "at_least", detail=sharp)


def _check(part: Values, reader: Reader) -> None:
    if "thickness" in part:
        check_below(reader, "part.chamfer", part.get("chamfer"), 0.5 * part["thickness"], "half the thickness")


FEATURE = Feature(
    Chamfer,
    length("chamfer", "chamfer of 45 degrees along both edges of the contour, its height", default="none"),
    needs=(("thickness", "a chamfer runs along the edges of the disc"),),
    of_ring=False,
    check=_check,
    make=lambda height, _part: Chamfer(height),
    grown=lambda chamfer, _out, scale: Chamfer(scale * chamfer.height),
    remark=lambda chamfer, mm: f"chamfer: {chamfer.height / mm:.9g} at 45 degrees, both edges of CUT",
    unmilled="the cutter goes straight down",
)
