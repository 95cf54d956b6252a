"""A chamfer along both edges of the contour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.common.rounding import downward
from camgeo.part.feature import Feature, FeatureCheck, Refusal, check_below
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Curve
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.check import Check

NO_CHAMFER = "no chamfer, or a contour without corners"


@dataclass(frozen=True)
class Chamfer:
    """Chamfer of 45 degrees along both edges of the contour, `height` mm high."""

    height: float


def _check_contour(chamfer: Chamfer, contour: Curve, shaft_deg: Callable[[float], float]) -> Check:
    """Check that the contour is nowhere sharper than its chamfer: its parallel inside has no corners then."""
    from camgeo.curve.curvature import least_radius
    from camgeo.curve.support import is_sharp
    from kin.numeric.check import Check

    height = chamfer.height
    if not contour.closed:
        kind = "sharp" if is_sharp(contour) else "trimmed"
        detail = f"a {kind} contour has corners, along which no chamfer runs; leave it out"
        if kind == "sharp":
            detail += f", or give a reuleaux.rounding above {height:.6g} mm"
        return Check(FEATURE.name, ok=False, value=0.0, limit=height, unit="mm", sense="at_least", detail=detail)
    radius, at = least_radius(contour)
    sharp = "the contour's least radius of curvature must be above the chamfer"
    return Check(FEATURE.name, radius > height, radius, height, "mm", shaft_deg(at), "at_least", detail=sharp)


def _check(part: Values, reader: Reader) -> None:
    if "thickness" in part:
        check_below(reader, "part.chamfer", part["chamfer"], 0.5 * part["thickness"], "half the thickness")


def _remedy(check: dict[str, Any]) -> str:
    """Remedy for too wide a chamfer: the widest that the contour permits; empty for a check of a file."""
    value = check["value"]
    if value is None or check["limit"] is None or "file" in check:
        return ""
    return f"a chamfer below {downward(value)} {check['unit']}" if value > 0.0 else NO_CHAMFER


FEATURE = Feature(
    Chamfer,
    length("chamfer", "chamfer of 45 degrees along both edges of the contour, its height", default="none"),
    needs=(("thickness", "a chamfer runs along the edges of the disc"),),
    of_ring=False,
    grooved=Refusal("the edges of a groove are not chamfered", "leave it out"),
    check=_check,
    make=lambda height, _part: Chamfer(height),
    edge=lambda chamfer: chamfer.height,
    contour=_check_contour,
    judged=FeatureCheck("chamfer", exact=True, strict=True, remedy=_remedy),
    grown=lambda chamfer, _out, scale: Chamfer(scale * chamfer.height),
    remark=lambda chamfer, mm: f"chamfer: {chamfer.height / mm:.9g} at 45 degrees, both edges of CUT",
    unmilled="the cutter goes straight down",
)
