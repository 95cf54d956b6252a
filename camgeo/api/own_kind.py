"""Library of cams with recipes of their own: functions of a recipe, and designs, alike for all such kinds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from camgeo.api.check import Check, Figures
from camgeo.api.root import Root
from camgeo.api.shown import Shown
from camgeo.checks.declared import LIMIT
from camgeo.common.arguments import numbers_of, short_repr, whole_of
from camgeo.common.errors import CallError
from camgeo.synthesis.expected_checks import Foreseen

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from camgeo.api.shown import Drawing
    from camgeo.checks.declaration import Entry
    from camgeo.files.mesh import Mesh
    from camgeo.measures.placed import Figure as Placed
    from camgeo.motions.stated import StatedMotion
    from camgeo.output.extension import FileCall
    from camgeo.output.own_kind import OwnKind
    from camgeo.output.pipeline import Outcome
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.figure_bounds import Bound
    from camgeo.recipe.recipe import Order
    from kin.numeric.arrays import Array

MOST_DERIVATIVE = 6  # of a motion by its input


class Library(Protocol):
    """Protocol of a module that answers for one kind of cam in the library."""

    @property
    def FIELDS(self) -> Mapping[str, str]:
        """Field of the recipe that influences a check most, by the check's name; `cam` for one that is not named."""
        ...

    def cam_of(self, recipe: Any, /) -> KindDesign:  # noqa: ANN401 - the kind's own recipe, as below
        """Design of a recipe; raises RecipeErrors where there is none."""
        ...

    def remedy(self, check: Entry, recipe: Any, /) -> str:  # noqa: ANN401
        """Change that would let a failed check hold; empty where none is known."""
        ...

    def foreseen(self, recipe: Any, /) -> Sequence[Foreseen]:  # noqa: ANN401
        """Checks that a run will make."""
        ...


def root_of_kind(
    run: Callable[[], OwnKind[Any, Any]],
    library: Callable[[], Library],
    kind: str,
    judged: str,
    points: Callable[[Any, FileCall], dict[str, Any]] | None = None,
) -> Root[Any]:
    """Functions of a kind of cam, from its run and its answers in the library, each imported when it is called.

    `kind` is its `cam.kind`; `judged` names the files of it that are judged: `a drawing of the plate`. `points` judges
    points measured on it, (recipe, arguments of `verify`); without it they are refused.
    """

    def export(recipe: Any, out: Path, only: tuple[str, ...], progress: Callable[[str], None]) -> Outcome:  # noqa: ANN401
        return run().export(recipe, out, only=only, progress=progress)

    def check(recipe: Any, progress: Callable[[str], None]) -> Outcome:  # noqa: ANN401
        return run().check(recipe, progress=progress)

    def claimed(recipe: Any, name: str, _call: FileCall) -> dict[str, Any]:  # noqa: ANN401
        problem = f"{name.replace('_', ' ')} judges files of disc cams"
        raise recipe.error("cam.kind", problem, kind, f"give verify {judged}")

    def explain(entry: dict[str, Any], _: dict[str, Any], recipe: Any, shown: str | None) -> str:  # noqa: ANN401
        from camgeo.report import failure

        name, answers = entry["name"], library()
        if name.startswith(LIMIT):
            field = f"limits.{name.removeprefix(LIMIT)}"
        else:
            field = "export.files" if "file" in entry else answers.FIELDS.get(name, "cam")
        return failure.failure_at(entry, recipe, recipe.stated(field), answers.remedy(entry, recipe), shown)

    return Root(
        design=lambda recipe: library().cam_of(recipe),
        export=export,
        check=check,
        judge=lambda recipe, paths, *bounds: run().report_on(recipe, paths, bounds),
        claimed=claimed if points is None else lambda recipe, _, call: points(recipe, call),
        explain=explain,
        foresee=lambda recipe: library().foreseen(recipe),
        show=lambda recipe, paths, *bounds: run().report_and_page(recipe, paths, bounds),
        shown=lambda recipe: ShownKind(recipe, run(), library()),
    )


class ShownKind(Shown):
    """A cam of a kind of its own, as that kind answers in a run."""

    def __init__(self, recipe: Any, kind: OwnKind[Any, Any], library: Library) -> None:  # noqa: ANN401
        """`recipe` is that of the cam; `kind` and `library` answer for its kind."""
        self.recipe, self.kind, self.library = recipe, kind, library

    @cached_property
    def _design(self) -> Any:  # noqa: ANN401
        from camgeo.common.clock import Clock

        return self.kind.designed(self.recipe, Clock())

    def picture(self) -> dict[str, Any]:
        """Data of the mechanism."""
        return self.kind.page_of().drawn(self._design)

    def still(self, at: float = 0.0) -> str:
        """The kind's bodies, drawn once."""
        from camgeo.report.page.svg import still

        step = self.kind.seen(self._design, 0).step_at(at)
        return still(self.kind.seen(self._design, step), step, self.recipe.name)

    def scene(self) -> dict[str, Any]:
        """Data of the whole page."""
        return self.kind.scene(self._design)

    def looks(self) -> tuple[str, str]:
        """Style and code of the kind."""
        return self.kind.page_of().looks()

    @property
    def figures(self) -> Figures:
        """Figures of the library's design."""
        return self.library.cam_of(self.recipe).figures

    def motion(self) -> StatedMotion | str:
        """The motion over the kind's own input."""
        return self.kind.motion(self._design)

    def foresee(self, request: FileRequest) -> None:
        """Refuse a file that a run would refuse, by the rules of the kind."""
        self.kind.foresee(self._design, request)

    def drawings(self, tolerance: float) -> list[Drawing]:
        """Drawings of the kind."""
        return self.kind.drawings(self._design, min(self.recipe.export.tolerance, tolerance))

    def meshes(self, request: FileRequest) -> list[Mesh]:
        """The mesh of the part."""
        return [self.kind.mesh(self._design, request)]


def order_of(derivative: int) -> int:
    """Order of a derivative of a motion; raises CallError unless it is 0 to 6, TypeError for what is no integer."""
    order = whole_of("derivative", derivative)
    if order not in range(MOST_DERIVATIVE + 1):
        raise CallError(f"a derivative is one of order 0 to {MOST_DERIVATIVE}, not {short_repr(order)}")
    return order


def angles_of(theta: ArrayLike) -> Array:
    """Shaft angles as floats; raises CallError unless all are finite, TypeError for what is no number."""
    places = numbers_of("theta", theta)
    if not np.isfinite(places).all():
        raise CallError("shaft angles are finite")
    return places


def foreseen_with(
    names: Sequence[str], recipe: Order, limits: Sequence[Bound], of_file: Callable[[FileRequest], list[str]]
) -> tuple[Foreseen, ...]:
    """Checks that a report is sure to have: those of the design by their `names`, of limits, and of each judged file.

    `of_file` gives the names of the checks of a requested file.
    """
    expected = [Foreseen(name) for name in (*names, *(f"{LIMIT}{bound.figure}" for bound in limits))]
    for request in recipe.export.files:
        if request.format.contour:
            (file,) = recipe.filenames(request)
            expected += [Foreseen(name, file) for name in of_file(request)]
    return tuple(dict.fromkeys(expected))


class KindDesign(ABC):
    """A design of a kind of its own: its verdict, in text and in a notebook, from its checks and figures."""

    recipe: Any

    @property
    @abstractmethod
    def checks(self) -> tuple[Check, ...]:
        """Checks of the design that need no file."""

    @property
    @abstractmethod
    def figures(self) -> Figures:
        """Figures of the design by name."""

    @property
    def ok(self) -> bool:
        """Whether all checks that need no file hold."""
        return all(check.ok for check in self.checks)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.recipe.name!r})"

    def __str__(self) -> str:
        """Write the verdict on one line, and each check that fails on one more."""
        failed = [f"\n  {check}" for check in self.checks if not check.ok]
        return f"{self.recipe.name}: {'FAILED' if failed else 'ok'}{''.join(failed)}"

    def _drawing(self) -> str:
        """SVG of the design; empty for a kind without one."""
        return ""

    def _repr_html_(self) -> str:
        from camgeo.api import notebook

        rows = [(name, str(figure)) for name, figure in self.figures.items()]
        return notebook.notebook_html(
            self._drawing(), self.recipe.name, self.checks, notebook.table(("figure", ""), rows)
        )


class DesignInRun(KindDesign):
    """A design of a kind that makes files: its checks and figures, in the recipe's units, are those of a run."""

    _design: Any

    @property
    @abstractmethod
    def kind(self) -> OwnKind[Any, Any]:
        """The kind, whose functions give checks and figures of the design."""

    @cached_property
    def _figures(self) -> Sequence[Placed]:
        return self.kind.figures(self._design)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The checks that need no file, those of limits among them."""
        checks = self.kind.checks(self._design, self._figures)
        every = (*checks, *self.kind.limited(self._design, self._figures, checks))
        return tuple(Check.of(self.recipe, check) for check in every)

    @cached_property
    def figures(self) -> Figures:
        """The figures by name, each with its place: over the travel, or the shaft angle in degrees."""
        return Figures.placed(self.recipe, self._figures, self.kind.at_unit)
