"""Keys `limits` and `verify` of a kind of cam with its own figures: bounds of figures, and of the motion error."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, Field, FieldTable, Kind, mapping
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Bound:
    """Bounds of a figure, in mm, rad and N; None where there is none."""

    figure: str
    at_least: float | None = None
    at_most: float | None = None


def limits_of(figures: Mapping[str, tuple[str, Kind]]) -> Field:
    """Key `limits` of figures, each with what it is and the kind of its values."""
    return mapping(
        "limits",
        "figures that must keep within bounds, each a check of its own",
        *(_bounds(name, about, kind) for name, (about, kind) in figures.items()),
    )


def _bounds(name: str, about: str, kind: Kind) -> Field:
    table = FieldTable(
        tuple(
            Field(word, Kind.NUMBER if kind is Kind.FORCE else kind, text, at_least=-(MOST**2), at_most=MOST**2)
            for word, text in (("at_least", "least value accepted"), ("at_most", "greatest value accepted"))
        )
    )
    return Field(name, Kind.TABLE, about, table=table)


def verify_of(kind: Kind, about: str) -> Field:
    """Key `verify` with the greatest motion error permitted, of a kind of values and described by `about`."""
    implied = "what the tolerance implies"
    error = Field("motion_error", kind, about, default=implied, above=0, at_most=MOST)
    return mapping("verify", "how each file is judged", error)


def check_bounds(limits: Values, there: Mapping[str, tuple[bool, str]], reader: Reader) -> None:
    """Note limits without a bound, or whose bounds contradict each other, and limits of figures that are not there.

    `there` says of a figure whether the cam has it, and what it needs; a figure that it does not name is always there.
    """
    for name, bounds in limits.items():
        is_there, need = there.get(name, (True, ""))
        if not is_there:
            reader.fault_at(f"limits.{name}", f"{name} needs {need}", None, "give that, or leave the limit out")
        if not bounds:
            reader.fault_at(f"limits.{name}", "no bound", None, "give at_least, at_most or both")
        if bounds.get("at_least", -math.inf) > bounds.get("at_most", math.inf):
            reader.fault_at(f"limits.{name}.at_most", "below at_least, so nothing is accepted", None, "exchange them")


def build_bounds(limits: Values) -> tuple[Bound, ...]:
    """Bounds from the values of `limits`, in a recipe without faults."""
    return tuple(Bound(name, **bounds) for name, bounds in limits.items())
