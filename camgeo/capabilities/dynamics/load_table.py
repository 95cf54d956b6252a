"""Loads over the turn from a table, whose file is read with the recipe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.motions.lift_table import SHEET, TABLE, read_rows
from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, either
from camgeo.schema.json_schema import table_schema
from camgeo.schema.quantity import split_unit
from camgeo.schema.yaml_source import Mapping, Scalar, join
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.numeric.arrays import Array
    from kin.read.tables import Quantity

MOST_LOAD = MOST**2  # N or N m: more is a slip of the unit
_MANY = 2000  # rows: a longer table loses rows within half a last digit of the straight lines between the others
_UNITS = ("N", "kN", "lbf", "Nm", "lbf in", "lbf ft")


@dataclass(frozen=True)
class LoadTable:
    """A load over the turn, linear between rows, and from the last row to the first, a turn later.

    `theta` are shaft angles, rad, rising over less than a turn; `load` is in N, or N m, above 0 towards the cam.
    """

    file: str
    theta: tuple[float, ...]
    load: tuple[float, ...]

    def __call__(self, phi: Array) -> Array:
        """The load at shaft angles (n,), rad: N or N m (n,)."""
        import numpy as np

        load: Array = np.interp(phi, self.theta, self.load, period=TURN)
        return load

    @property
    def corners(self) -> Array:
        """Shaft angles of the rows, where the slope changes, rad (n,), from 0 to below a turn, in the rows' order."""
        import numpy as np

        angles: Array = np.mod(self.theta, TURN)
        return angles


LOADS = FieldTable(
    (
        Field(
            "table",
            Kind.OWN,
            "file with a row for each angle, its path as seen from the recipe, or rows; loads in N, or N m",
            required=True,
            form=TABLE,
        ),
        *SHEET,
        Field("units", Kind.CHOICE, "unit of the loads", default="the heading's, else N or N m", choices=_UNITS),
    )
)


def _read(reader: Reader, field: Field, node: Node, path: str) -> str | LoadTable | None:
    """Read a formula, a number with its unit, or a mapping with a table; None after a fault."""
    if isinstance(node, Scalar) and split_unit(node.text)[1]:
        number = replace(field, form=None, at_least=-MOST_LOAD, at_most=MOST_LOAD)
        value: float | None = reader.readers[Kind.NUMBER](reader, number, node, path)
        return None if value is None else repr(value)
    if not isinstance(node, Mapping):
        formula: str | None = reader.readers[Kind.FORMULA](reader, field, node, path)
        return formula
    values = reader.table(LOADS, node, path)
    return _table(reader, values, join(path, "table")) if "table" in values else None


def _table(reader: Reader, values: Values, path: str) -> LoadTable | None:
    """Read the rows of a load's table; None after a fault."""
    from kin.law.normalised import IntentError
    from kin.law.sources.table import periodic, straightened
    from kin.read.tables import UNITS

    file, own = values["table"].name, reader.unit(Kind.THRUST)
    quantity: Quantity = "force" if own == "N" else "moment"
    units = tuple(UNITS[quantity])
    if values.get("units", units[0]) not in units:
        where = f"{path.rpartition('.')[0]}.units"
        reader.fault_at(where, f"no unit of a {quantity}", quote(values["units"]), f"give {either(units)}")
        return None
    table = read_rows(reader, values, path, quantity=quantity, instead="N" if own == "N" else "Nm")
    if table is None:
        return None
    try:
        rows = periodic(table.samples(), TURN, path, reader.unit(Kind.THRUST))
    except IntentError as error:
        reader.fault_at(path, f"{file}, {error.message}")
        return None
    if len(rows.s) > _MANY:
        rows = straightened(rows, min(table.rounding))
    largest, line = max(zip(map(abs, rows.s), rows.lines, strict=True))
    if largest > MOST_LOAD:
        reader.fault_at(
            path, f"{file}, line {line}: a load above {MOST_LOAD:.0f}", None, "give a table of smaller ones"
        )
        return None
    return LoadTable(file, tuple(rows.theta.tolist()), tuple(rows.s.tolist()))


LOAD = OwnForm(
    "a formula, or a mapping with a table",
    "a formula in t, or {table: load.csv}",
    _read,
    lambda _: {"anyOf": [{"type": ["string", "number"]}, table_schema(LOADS)]},
    instead=LOADS,
)
