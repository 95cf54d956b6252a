"""Declaration of a check: what it is, when it applies, and what would let it hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.follower import Follower
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe


@dataclass(frozen=True)
class CheckFacts:
    """Facts that decide which checks are made: the recipe and the follower of its motion.

    In a run `trimmed` is whether an undercut of the contour is trimmed, `turns` whether the linkage turns right round,
    True without one.
    """

    recipe: Recipe
    follower: Follower
    trimmed: bool = False
    turns: bool = True

    @property
    def roller(self) -> bool:
        """Whether the follower touches the cam with a radius: a roller or a curved shoe."""
        return self.recipe.cam.touch.radius > 0.0

    @property
    def yoke(self) -> bool:
        """Whether two parallel faces hold the cam."""
        return self.follower.breadth is not None

    @property
    def swings(self) -> bool:
        """Whether the follower swings: its position is an angle, not a length."""
        return self.recipe.cam.arrangement.unit == "deg"

    @property
    def linked(self) -> bool:
        """Whether the recipe has a linkage."""
        return self.recipe.linkage is not None


Entry: TypeAlias = dict[str, Any]
"""A check as a report has it, or the report itself: plain JSON."""
Remedy: TypeAlias = "Callable[[Entry, Entry, Recipe], str]"
Exact: TypeAlias = "Callable[[CheckFacts], bool]"
OfFile: TypeAlias = "Callable[[CheckFacts, FileRequest], bool]"


@dataclass(frozen=True)
class Declared:
    """Declaration of one check.

    units      units that it may have, lengths as mm
    exact      whether it is made for the exact cam, its motion and mechanism; None: never
    of_file    whether it is made for a file; None: never
    why_not    reason why it is not made, for the report; empty where it is made or no reason is reported
    field      path of the recipe's field that influences it most; `own_field` replaces it where the recipe has that
    remedy     sentence on a change that would let it hold, empty where none is known; None: there is none, or the
               detail of the check has it
    backlash   whether it concerns the play between contour and follower
    between    whether it is made once for a pair of discs, with the last of their files
    in_frame   whether with a linkage it concerns the cam in its frame, so that its place is the relative angle
    strict     whether a figure equal to its limit fails; `strict_at` are the limits at which it fails in any case
    after      check behind which the check of a capability or of a feature stands
    """

    name: str
    units: tuple[str, ...]
    exact: Exact | None = None
    of_file: OfFile | None = None
    why_not: Callable[[CheckFacts], str] | None = None
    field: str = ""
    own_field: str = ""
    remedy: Remedy | None = None
    backlash: bool = False
    between: bool = False
    in_frame: bool = False
    strict: bool = False
    strict_at: tuple[float, ...] = ()
    after: str = ""

    def place(self, recipe: Recipe, file: str | None) -> str:
        """Path of the recipe's field that influences the check most.

        `file` is the name of the checked file, None for a check of the exact cam.
        """
        section, _, name = self.own_field.partition(".")
        if name and getattr(getattr(recipe, section), name) is not None:
            return self.own_field
        return self.field or ("export.files" if file else "cam")
