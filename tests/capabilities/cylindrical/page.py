"""Tables of keys of docs/cylindrical.md: those of a recipe of a cylindrical cam."""

from camgeo.capabilities.cylindrical.keys import CAM, FILES, LIMITS, MADE, PART
from camgeo.schema.fields import FieldTable


def _below(table, path):
    """Path and table of each mapping within a table; a motion's grammar stands on its own page."""
    for field in table.fields:
        if field.table is not None and field.name != "motion":
            yield f"{path}.{field.name}", field.table
            yield from _below(field.table, f"{path}.{field.name}")


LISTED = {"limits cylindrical": LIMITS.inner}
TABLES = {
    "cam cylindrical": FieldTable(tuple(field for field in CAM.fields if field.name != "kind")),
    **dict(_below(CAM, "cam cylindrical")),
    "part cylindrical": PART.inner,
    "made cylindrical": MADE.inner,
    "gcode cylindrical": FILES["gcode"].options,  # needs: milling
}
