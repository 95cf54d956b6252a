"""A remark: a figure beside the rule that is usual for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.measures.placed import Figure
    from kin.law.sources.motion import Kept


@dataclass(frozen=True)
class RuleRemark:
    """A remark: a figure's `value` beside the usual `rule`, both in `unit`, and a `sentence` in the recipe's unit.

    `value` and `rule` are None for a remark without figures. `at` is the input at its place in `at_unit`, such as the
    shaft angle, None without one.
    """

    name: str
    value: float | None
    rule: float | None
    unit: str
    sentence: str
    at: float | None = None
    at_unit: str = "deg"

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of its place, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None


def source_remarks(kept: Kept | None) -> list[RuleRemark]:
    """Remarks that what a motion comes from gave when it was read, such as a table; none for a stated motion."""
    return [] if kept is None else [RuleRemark(name, None, None, "", told) for name, told in kept.remarks]


def pressure_remarks(pressure: Figure | None, bearable: float | None, at_unit: str = "deg") -> list[RuleRemark]:
    """Remark on a contact's pressure, N/mm^2, above what its materials bear; none where either is not known."""
    if pressure is None or bearable is None or pressure.value <= bearable:
        return []
    sentence = f"the contact's pressure reaches {pressure.value:.4g} N/mm^2, the materials bear {bearable:.4g}"
    return [RuleRemark("contact-pressure", pressure.value, bearable, pressure.unit, sentence, pressure.at, at_unit)]
