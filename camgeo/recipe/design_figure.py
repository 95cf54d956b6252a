"""Declaration of a figure: what it is, what a recipe must have for it, which values are good."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import KW_ONLY, dataclass

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet

    from camgeo.schema.fields import Field, Kind


@dataclass(frozen=True, eq=False)
class Need:
    """Something that a recipe must have for a figure, named by `words` in errors.

    `there` is given the offers of the cam, and the paths of the fields that the recipe gives with the words of its
    files, such as `parts: all`; it returns whether the recipe has the need. `part` is whether the figure also depends
    on the part, by its material or thickness.
    """

    words: str
    there: Callable[[AbstractSet[str], AbstractSet[str]], bool]
    part: bool = False


NOTHING = Need("", lambda _offers, _paths: True)


@dataclass(frozen=True)
class DesignFigure:
    """One figure of a design.

    about     what it is, in words
    kind      kind of its values: degrees for an angle, the recipe's unit for a length; for a motion either, as the
              follower or the last link swings or slides
    best      which values a ranking puts first
    needs     what a recipe must have for it
    per       ending of its unit's name, such as /rad
    of        whether the exact design has it, each file, or each run of a capability
    swept     whether a sweep knows it
    dear      whether it is costly, and so measured only where it ranks or limits
    eased_by  what makes it less: a smaller `motion` alone, or a larger cam (`size`) too; empty: neither
    keys      keys of its limits in a recipe besides the bounds
    at_lift   lift, mm, at which it is taken unless a limit gives another; such limits may stand in a list; None for a
              figure that belongs to no lift
    after     name of the core's figure behind which it is listed
    """

    about: str
    kind: Kind
    best: Literal["most", "least"]
    needs: Need = NOTHING
    per: str = ""
    _: KW_ONLY
    of: Literal["design", "file", "run"] = "design"
    swept: bool = True
    dear: bool = False
    eased_by: Literal["", "motion", "size"] = ""
    keys: tuple[Field, ...] = ()
    at_lift: float | None = None
    after: str = ""
