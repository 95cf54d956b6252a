"""How far the follower of a plate or a turning body is from its intended position, and how much play it has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.contacts import Unit


@dataclass(frozen=True)
class MotionError:
    """Error of the follower's position over all inputs, measured less intended, in its `unit`: mm, or deg if it swings.

    An input is the travel of a plate, mm, or the shaft angle of a turning body, degrees. An error above 0 lifts a
    plate's follower, or pushes a roller away from the metal of its flank.

    max          greatest magnitude found, at the input `at`
    remainder    by how much the magnitude may exceed `max` at most, if that is proved; else at what was looked at
    least, most  least and greatest error, with their signs
    rms          root mean square over the inputs that are looked at
    extremes     whether the remainder is proved for all inputs, or the errors are those of samples
    """

    max: float
    at: float
    remainder: float
    least: float
    most: float
    rms: float
    unit: Unit
    extremes: Literal["proved", "sampled"] = "proved"

    def less_sure(self, by: float) -> MotionError:
        """Error of a contour that may itself be off, by which a position changes by no more than `by`, in its unit."""
        if not by:
            return self
        return replace(self, max=self.max + by, least=self.least - by, most=self.most + by, rms=self.rms + by)

    def scaled(self, by: float, unit: Unit) -> MotionError:
        """The error in another unit, `by` of which are one of its own."""
        sizes = {name: by * getattr(self, name) for name in ("max", "remainder", "least", "most", "rms")}
        return replace(self, unit=unit, **sizes)

    @property
    def bound(self) -> float:
        """Greatest magnitude with what the remainder adds, in the unit of the error."""
        return self.max + self.remainder


@dataclass(frozen=True)
class Play:
    """Least and greatest free travel of the follower, cam at rest, in its `unit`, with their inputs, mm or degrees.

    Below 0 the follower is pinched. They are those of the inputs that are looked at, and no bounds.
    """

    least: float
    least_at: float
    most: float
    most_at: float
    unit: Unit
