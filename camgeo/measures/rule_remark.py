"""A remark: a figure beside the rule that is usual for it."""

from __future__ import annotations

from kin.numeric.records import dataclass


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
