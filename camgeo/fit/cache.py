"""The fits of one contour, each form within its tolerance, made once for all files that ask for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, overload

from camgeo.common.rounding import upward
from camgeo.fit.nodes import ToleranceError
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from camgeo.common.clock import Clock
    from camgeo.curve.curve import Curve
    from camgeo.fit.pieces import ArcSpline, Outline, Polygon


@dataclass()
class Fits:
    """The fits of one contour; files that ask for the same one share it. `unsure`, mm: see `formula_rounding`."""

    contour: Curve
    clock: Clock
    unsure: float = 0.0
    made: dict[tuple[str, float], Outline] = field(default_factory=dict)

    @overload
    def within(self, form: Literal["polyline"], tolerance: float) -> Polygon: ...
    @overload
    def within(self, form: Literal["arcs"], tolerance: float) -> ArcSpline: ...
    @overload
    def within(self, form: str, tolerance: float) -> Outline: ...
    def within(self, form: str, tolerance: float) -> Outline:
        """Polygon, arcs or spline within a tolerance in mm.

        Raises ToleranceError where the tolerance cannot be held.
        """
        if (form, tolerance) not in self.made:
            with self.clock.stage(f"fit {form}"):
                self.made[form, tolerance] = _fitted(form, self.contour, tolerance, self.unsure)
        return self.made[form, tolerance]


def formula_rounding(unsure: float, contour: Curve) -> float:
    """By how much a recipe's own formula may have moved the contour in rounding, mm; 0 if by no more than usual."""
    from camgeo.fit.nodes import rounding

    return unsure if unsure > rounding(contour.size) else 0.0


def _fitted(form: str, contour: Curve, tolerance: float, unsure: float) -> Outline:
    """Fit within a tolerance of which the formula's rounding takes its share, and the judge's view of it another."""
    if not unsure:
        return _exactly_fitted(form, contour, tolerance)
    if 4.0 * unsure > tolerance:
        raise ToleranceError(
            f"{tolerance:.3g} mm cannot be held: digits cancel in the formula, so that it is known to {unsure:.3g} mm "
            f"only; at least {upward(4.0 * unsure, 3)} mm, or write the formula so that they do not",
            4.0 * unsure,
        )
    outline = _exactly_fitted(form, contour, tolerance - 2.0 * unsure)
    return replace(outline, bound=outline.bound.widened(unsure))


def _exactly_fitted(form: str, contour: Curve, tolerance: float) -> Outline:
    if form == "arcs":
        from camgeo.fit.arcs import fit_arcs

        return fit_arcs(contour, tolerance)
    if form == "spline":
        from camgeo.fit.spline import fit_spline

        return fit_spline(contour, tolerance)
    from camgeo.fit.polygon import fit_polygon

    return fit_polygon(contour, tolerance)
