"""What figures, sections of the report and remarks ask of capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from camgeo.registry.slot import EMPTY, Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.measures.rule_remark import RuleRemark
    from camgeo.recipe.machining import Altered
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check


class Results(NamedTuple):
    """Results of a capability in a run: sections of the report by their keys, checks, and figures of its own runs.

    `runs` has, for each figure that is `of` a run, its values by the name of the file that drives it, None for the
    intended motion. `skipped` has pairs (name, reason) of what was left out.
    """

    sections: Mapping[str, Any] = EMPTY
    checks: Sequence[Check] = ()
    runs: Mapping[str, Mapping[str | None, Measured]] = EMPTY
    skipped: Sequence[tuple[str, str]] = ()


class MovedBody(Protocol):
    """Body that a follower on a stem moves besides itself, such as a valve; lifts in mm."""

    @property
    def name(self) -> str:
        """Noun for messages: `valve`."""

    def rows(self, tappet: Array) -> Array:
        """Lift of the body, mm, and two derivatives by the shaft angle (3, n), from those of the follower (3, n)."""

    def travel(self, lift: Array) -> Array:
        """Travel of the body without lash, mm, by the follower's lift (n,), mm, and two derivatives by it, (3, n)."""

    def follower_lift(self, lift: float) -> float:
        """Lift of the follower, mm, at a lift of the body, mm."""


def no_figure_at(_recipe: Recipe, _design: Design, name: str, _lift: float, /) -> Measured:
    """Measure a figure at a lift for a capability without such figures: raises KeyError."""
    raise KeyError(name)


@dataclass(frozen=True, kw_only=True)
class Measures:
    """Answers of a capability that measures something. Figures and checks are in mm and degrees.

    measure     figures `of` the design by name: (recipe, design, names, turns a minute of the limit of each figure)
    measure_at  figure at a lift: (recipe, design, name, lift in mm); raises KeyError for a name without such a figure
    moved       body that the follower moves besides itself, with events of its own; None for none
    alter       exact cam of a file with the option of an `Alteration`: (recipe, design, cam to be altered, the option
                as given, scale at which it is drawn); raises CallError in the words of the recipe for what cannot be
                altered, RecipeErrors for a file that it needs and that does not serve, OSError where such a file cannot
                be read
    examine     checks, sections of the report and figures of runs, when all files were judged: (recipe, design, files,
                clock)
    remarks     by the core's group of remarks behind which they stand, such as `sizing`: (recipe, design) -> remarks
    """

    measure: Callable[[Recipe, Design, Sequence[str], Mapping[str, float]], Mapping[str, Measured]] = always(EMPTY)
    measure_at: Callable[[Recipe, Design, str, float], Measured] = no_figure_at
    moved: Callable[[Recipe, Design], MovedBody | None] = always(None)
    alter: Callable[[Recipe, Design, ExactCam, Altered, float], ExactCam] | None = None
    examine: Callable[[Recipe, Design, Sequence[FileResult], Clock], Results] = always(Results())
    remarks: Mapping[str, Callable[[Recipe, Design], Sequence[RuleRemark]]] = EMPTY


MEASURES = Slot("measures", Measures())
