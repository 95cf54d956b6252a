"""Tables of keys of docs/axis.md: those of a recipe of an axis."""

from camgeo.capabilities.axis.keys import AXIS, FILES, LIMITS
from camgeo.schema.fields import FieldTable

TABLES = {
    "axis": FieldTable(AXIS.fields),
    "limits axis": LIMITS.inner,
    "file csv": FILES["csv"].options,
}
