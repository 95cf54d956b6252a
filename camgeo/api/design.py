"""The design of a cam without files: its motion, its contour, its figures, and the checks that need no file."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Literal, overload

import numpy as np

from camgeo.api import notebook
from camgeo.api.check import Check, Figure, Figures
from camgeo.api.edges import FORMS, Edges, Form
from camgeo.common.arguments import number_of, numbers_of, short_repr, text_of, whole_of
from camgeo.common.errors import CallError
from camgeo.schema.fields import MOST
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from camgeo.api.json_value import JSON
    from camgeo.curve.curve import Curve
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design as Exact
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check as Checked

MOST_POINTS = 1_000_000  # of a contour: more than any file has, and quickly made
MOST_DERIVATIVE = 6  # greatest order of a derivative of the motion by the shaft angle


@dataclass(frozen=True, eq=False)
class Design:
    """The exact cam of a recipe.

    `motion`, `contour` and `edges` are in mm and rad, whatever the recipe's unit is. `checks` and `figures` are in the
    recipe's own units, each with its unit beside it.
    """

    recipe: Recipe
    exact: Exact = field(repr=False)

    def __getstate__(self) -> dict[str, object]:
        """Fields for a pickle, without cached values."""
        return {"recipe": self.recipe, "exact": self.exact}

    # --- verdict ------------------------------------------------------------------------------------------------------

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Checks that need no file: curvature, undercut, walls, and the recipe's limits of figures."""
        return tuple(Check.of(self.recipe, check) for check in self._checks)

    @cached_property
    def _checks(self) -> tuple[Checked, ...]:
        checks = self.exact.checks
        if self.recipe.limits:
            from camgeo.measures.limits import limit_checks

            checks = (*checks, *limit_checks(self.recipe, self.exact, checks, (), None))
        return checks

    @property
    def ok(self) -> bool:
        """Whether every check in `checks` holds."""
        return all(check.ok for check in self.checks)

    @cached_property
    def figures(self) -> Figures:
        """Figures of the design that a recipe can limit, by name, such as `radius-of-curvature`."""
        from camgeo.measures.figures import design_figures
        from camgeo.recipe.figures import FIGURES

        paths = set(self.recipe.marks)
        offers = self.recipe.cam.arrangement.offers
        names = [
            name for name, figure in FIGURES.items() if figure.of == "design" and figure.needs.there(offers, paths)
        ]
        values = design_figures(self.recipe, self.exact, self.exact.checks, names)
        return Figures({name: Figure.of(self.recipe, figure) for name, figure in values.items()})

    @property
    def sized(self) -> Recipe:
        """Recipe in which the sizes that `sizing` leads to replace that key; the recipe itself without `sizing`.

        Comments within `sizing` are removed with it, all other text stays.
        """
        return self.recipe.sized()

    # --- motion -------------------------------------------------------------------------------------------------------

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion: a lift or a stroke is in mm, a swing in radians."""
        driven = self.exact.driven
        unit = self.exact.motion.unit if driven is None else driven.mechanism.unit
        return "rad" if unit == "deg" else "mm"

    @overload
    def motion(self, theta: float, *, derivative: int = 0) -> float: ...

    @overload
    def motion(self, theta: ArrayLike, *, derivative: int = 0) -> Array: ...

    def motion(self, theta: ArrayLike, *, derivative: int = 0) -> float | Array:
        """Position of the follower at shaft angles theta, rad, any real numbers, or a derivative by the shaft angle.

        The result has the shape of `theta`; a number gives a number. The position is in `unit`, as in the motion table:
        a lift from its datum, a swing of the arm; with a linkage the output of its last link. Derivatives are by radian
        of shaft angle, up to the sixth; where a derivative jumps it is the limit from above. Raises CallError for
        another order, angles that are not finite, and a linkage that does not make a full turn; TypeError for angles
        that are no numbers.
        """
        angle, order = numbers_of("theta", theta), whole_of("derivative", derivative)
        if not np.isfinite(angle).all():
            raise CallError("shaft angles are finite numbers, in radians")
        if order not in range(MOST_DERIVATIVE + 1):
            raise CallError(f"a derivative is one of order 0 to {MOST_DERIVATIVE}, not {short_repr(order)}")
        row = self._motion(angle.ravel(), order).reshape(angle.shape)
        return float(row) if row.ndim == 0 else row

    def _motion(self, angle: Array, order: int) -> Array:
        exact = self.exact
        if exact.driven is not None:
            if not exact.driven.turns:
                raise CallError(f"{self.recipe.name}: the linkage does not make a full turn, so it has no motion")
            mechanism = exact.driven.mechanism
            state = mechanism.at(mechanism.relative(angle), order)
            return np.asarray(state.over_shaft(state.output)[order])
        swing: Array = exact.motion.rows(angle, order)[order]
        return swing

    # --- contour ------------------------------------------------------------------------------------------------------

    def contour(self, n: int = 720) -> Array:
        """Points (n, 2) of the exact contour, mm: counter-clockwise about the shaft at (0, 0), in the drawing's axes.

        They stand at equal steps of the curve's own parameter, the first not repeated at the end. Raises CallError
        where a failed check prevents the contour, for a cam of several surfaces, and for fewer than 3 points or more
        than a million.
        """
        n = whole_of("n", n)
        if not 3 <= n <= MOST_POINTS:
            raise CallError(f"a contour takes 3 points at least and {MOST_POINTS} at most, not {short_repr(n)}")
        runs = self._made().runs
        ends = np.cumsum([run.high - run.low for run in runs])
        along = ends[-1] * np.arange(n) / n
        piece = np.searchsorted(ends, along, side="right")
        low = np.array([run.low for run in runs])
        before = np.concatenate([[0.0], ends[:-1]])
        points = self._made().sample(low[piece] + along - before[piece]).point
        if self.recipe.rotation == "ccw":  # the mirror image, and again counter-clockwise from the same first point
            points = np.roll(points[::-1], 1, axis=0) * np.array([1.0, -1.0])
        return points

    def edges(self, tolerance: float, form: Form = "arcs") -> Edges:
        """Edges of the contour within a tolerance, mm: arcs and lines, one spline, or the lines of a polyline.

        They are the edges of the files that camgeo writes, with their proved bound, in the axes of `contour`. Raises
        ToleranceError where the tolerance cannot be held, CallError where a failed check prevents the contour, for a
        cam of several surfaces, an unknown form, or a tolerance that is no length.
        """
        from camgeo.output.job import Job

        text_of("form", form, FORMS, "a form")
        within = number_of("tolerance", tolerance)
        if not 0.0 < within <= MOST:
            raise CallError(f"a tolerance is a length above 0 and up to {MOST:.10g} mm, not {within!r}")
        self._made()
        (outline,) = Job.of(self.recipe, self.exact).outlines(form, within)
        return Edges.of(outline)

    def _made(self) -> Curve:
        if len(self.exact.surfaces) > 1:
            raise CallError(f"{self.recipe.name}: a cam of several surfaces has no one contour; export it")
        contour = self.exact.only_surface.contour
        if contour is None:
            failed = next((f": {check}" for check in self.checks if not check.ok), "")
            raise CallError(f"{self.recipe.name}: no contour is made{failed}")
        return contour

    # --- to look at ---------------------------------------------------------------------------------------------------

    def scene(self) -> Mapping[str, JSON]:
        """Data of a page on the design without files, plain; lengths in the recipe's unit.

        `drawing` is the mechanism at shaft angle 0 as SVG, in which the group of body k has the id `body-k`; `bodies`
        has the rows of x, y and angle of each body over a turn, `plots` the curves, `marks` the places on the contour
        of failed checks and remarks, `checks` and `remarks` the entries of a report. The script of the report's page
        plays it (docs/page.md). Angles are in degrees. Rows of numbers are packed: `{"c": value}` is constant,
        `{"n": [...]}` are plain numbers, `{"d": digits, "v": [...]}` the first number and then differences, in units of
        the last of that many decimals.
        """
        from camgeo.measures.remarks import remarks_of
        from camgeo.report.document import Findings, document, finite
        from camgeo.report.page.content import content
        from camgeo.report.page.page import scene

        remarks = remarks_of(self.recipe, self.exact, self._checks)
        findings = Findings(self._checks, (), (), (), self.exact.follower.name, remarks=remarks)
        report = document(self.recipe, findings)
        data = scene(self.recipe, content(self.recipe, self.exact, ()), report)
        return {**data, "checks": finite(report["checks"]), "remarks": finite(report["remarks"])}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.recipe.name!r}, {self.exact.follower.name})"

    def __str__(self) -> str:
        """Text of a line with the verdict, and a line for each failed check."""
        failed = [f"\n  {check}" for check in self.checks if not check.ok]
        return f"{self.recipe.name}: {'FAILED' if failed else 'ok'}  {self.exact.follower.name}{''.join(failed)}"

    def _repr_svg_(self) -> str:
        return notebook.drawing(self.recipe, self.exact)

    def _repr_html_(self) -> str:
        rows = [(name, str(figure)) for name, figure in self.figures.items()]
        return notebook.notebook_html(
            self._repr_svg_(), self.recipe.name, self.checks, notebook.table(("figure", ""), rows)
        )
