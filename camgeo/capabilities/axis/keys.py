"""Keys of the recipe of an axis: its motion over a turn of the master, the master's speed, limits in time, files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.formats.csv import FORMS
from camgeo.formats.options import RECIPE_UNITS
from camgeo.formats.tables.controller import OPTIONS
from camgeo.motions.inputs import WHOLE_PART
from camgeo.motions.motion import motion_field
from camgeo.recipe.export import export_of
from camgeo.recipe.keys import CORE
from camgeo.recipe.machining import COARSEST, FINEST, MOST_RPM
from camgeo.recipe.recipe import Order
from camgeo.registry.formats import FORMATS, Form
from camgeo.registry.slot import NO_CHECK
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, mapping
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from typing import ClassVar

    from camgeo.motions.motion import MotionSource
    from camgeo.registry.formats import Format

TABLES = ("motion", "controller")
"""Tables of CSV, by their words."""
ROTARY = "rotary"
ADVANCE = "advance"
"""Name of the check of what a table's last row misses of a cycle, and of the figure of a cycle's displacement."""
DEFAULT = 0.001  # mm or degrees: tolerance where none is given
MINUTE = 60.0


@dataclass(frozen=True)
class Bound:
    """Greatest value accepted of a figure: mm or rad, by second to the figure's order."""

    figure: str
    at_most: float


@dataclass(frozen=True)
class AxisRecipe(Order):
    """A recipe of an axis: lengths in mm, angles in rad; also its tolerance, which is an angle where the axis turns.

    `index` is whether each cycle begins where the last one ended, `modulo` the length or angle after which the axis is
    in the same place again, None without one.
    """

    root: ClassVar[str] = "axis"

    kind: Literal["linear", "rotary"]
    motion: MotionSource
    rpm: float
    index: bool = False
    modulo: float | None = None
    limits: tuple[Bound, ...] = ()

    __repr__ = Order.__repr__

    @property
    def input_words(self) -> str:
        """Speed of the master, in words."""
        return f"the master turns at {self.rpm:g} rpm"

    @property
    def swings(self) -> bool:
        """Whether the axis turns."""
        return self.kind == ROTARY

    @property
    def cycle(self) -> float:
        """Time of a turn of the master, s."""
        return MINUTE / self.rpm

    @property
    def scale(self) -> float:
        """Unit of displacements in reports, mm or rad."""
        return math.radians(1.0) if self.swings else self.mm


# --- keys -------------------------------------------------------------------------------------------------------------


FIGURES = {"velocity": 1, "acceleration": 2, "jerk": 3}
"""Figures that a recipe may limit, each with the order of its derivative."""
AXIS = FieldTable(
    (
        Field(
            "kind",
            Kind.CHOICE,
            "whether the axis runs along a line, or turns: strokes are then degrees",
            default="linear",
            choices=("linear", ROTARY),
        ),
        Field("rpm", Kind.NUMBER, "turns of the master a minute", required=True, above=0, at_most=MOST_RPM),
        motion_field("motion", Kind.STROKE, "position over a turn of the master", over=WHOLE_PART, required=True),
        Field(
            "index",
            Kind.TRUTH,
            "whether each cycle begins where the last one ended; else the motion ends where it begins",
            default="false",
        ),
        Field(
            "modulo",
            Kind.STROKE,
            "length or angle after which the axis is in the same place again",
            default="none",
            above=0,
            at_most=MOST,
        ),
    )
)


def _most(name: str, per: str) -> Field:
    most = Field("at_most", Kind.STROKE, f"greatest value accepted, by {per}", required=True, above=0, at_most=MOST**3)
    return mapping(name, f"greatest {name}, by {per}", *(most,))


LIMITS = mapping(
    "limits",
    "bounds of the motion in time, each a check of its own",
    _most("velocity", "second"),
    _most("acceleration", "second squared"),
    _most("jerk", "second cubed"),
)


def _tolerance(default: str) -> Field:
    about = "greatest error of the position that a controller makes of its table"
    return Field("tolerance", Kind.ERROR, about, default=default, above=0, at_most=MOST)


def _table_format() -> Format:
    record = FORMATS["csv"]
    form = Field("as", Kind.CHOICE, "which table it is", default="motion", choices=TABLES)
    kept = {"step", *OPTIONS} - {"tolerance"}
    own = (each for each in record.options.fields if each.name in kept)
    step = Field(
        "step",
        Kind.ANGLE,
        "between rows; 360 degrees are a whole number of it",
        default="of motion 1 degree; of controller the largest that holds the tolerance",
        at_least=FINEST,
        at_most=COARSEST,
    )
    options = (form, *(step if each.name == "step" else each for each in own), RECIPE_UNITS, _tolerance("export's"))
    forms = {name: Form(name=name, drive=FORMS[name].drive, takes=FORMS[name].takes) for name in TABLES}
    return replace(record, options=FieldTable(options), forms=forms, check=NO_CHECK)


FILES: dict[str, Format] = {
    "csv": _table_format(),
    "html": replace(FORMATS["html"], options=FieldTable(())),
}
"""Formats of the files of an axis, with the options that they take."""


def _export() -> Field:
    export = export_of(FILES, "{csv: {as: controller, for: plain}}", "[csv]")
    if export.table is None:
        raise AssertionError
    fields = (_tolerance("0.001 mm, or degrees") if each.name == "tolerance" else each for each in export.table.fields)
    return replace(export, table=FieldTable(tuple(fields)))


RECIPE = FieldTable(
    (
        *(CORE.field(name) for name in ("name", "about", "units")),
        Field("axis", Kind.TABLE, "a motion for a drive, without a cam", required=True, table=AXIS),
        _export(),
        LIMITS,
    )
)
