"""The fits of one contour by form and tolerance, each made once and shared by files."""

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
    """The fits of one contour, made on first use.

    `unsure`, mm, is the contour's rounding error through a recipe's own formula, 0 if it is no more than usual.
    `outlines` are the fits made so far, by form and tolerance.
    """

    contour: Curve
    clock: Clock
    unsure: float = 0.0
    outlines: dict[tuple[str, float], Outline] = field(default_factory=dict)

    @overload
    def within(self, form: Literal["polyline"], tolerance: float) -> Polygon: ...
    @overload
    def within(self, form: Literal["arcs"], tolerance: float) -> ArcSpline: ...
    @overload
    def within(self, form: str, tolerance: float) -> Outline: ...
    def within(self, form: str, tolerance: float) -> Outline:
        """Fit by form, `polyline`, `arcs` or `spline`, within a tolerance, mm.

        Raises ToleranceError where the tolerance cannot be held, and CurveError where the contour runs backwards.
        """
        if (form, tolerance) not in self.outlines:
            with self.clock.stage(f"fit {form}"):
                self.outlines[form, tolerance] = _fit(form, self.contour, tolerance, self.unsure)
        return self.outlines[form, tolerance]


def formula_rounding(unsure: float, contour: Curve) -> float:
    """Rounding error `unsure` of the contour through a recipe's own formula, mm; 0 if it is no more than usual."""
    from camgeo.fit.nodes import rounding

    return unsure if unsure > rounding(contour.size) else 0.0


def _fit(form: str, contour: Curve, tolerance: float, unsure: float) -> Outline:
    """Outline within a tolerance; the formula's rounding takes a share for the fit and as much for the judge.

    Raises ToleranceError where the fit cannot hold the rest, or the rounding is more than a quarter of the tolerance.
    """
    if not unsure:
        return _exact_fit(form, contour, tolerance)
    if 4.0 * unsure > tolerance:
        raise ToleranceError(
            f"{tolerance:.3g} mm cannot be held: digits cancel in the formula, so that it is known to {unsure:.3g} mm "
            f"only; at least {upward(4.0 * unsure, 3)} mm, or write the formula so that they do not",
            4.0 * unsure,
        )
    outline = _exact_fit(form, contour, tolerance - 2.0 * unsure)
    return replace(outline, bound=outline.bound.widened(unsure))


def _exact_fit(form: str, contour: Curve, tolerance: float) -> Outline:
    """Fit by form within a tolerance, mm, of the contour as computed: a formula's rounding is not counted."""
    if form == "arcs":
        from camgeo.fit.arcs import fit_arcs

        return fit_arcs(contour, tolerance)
    if form == "spline":
        from camgeo.fit.spline import fit_spline

        return fit_spline(contour, tolerance)
    from camgeo.fit.polygon import fit_polygon

    return fit_polygon(contour, tolerance)
