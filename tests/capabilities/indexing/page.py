"""Tables of keys of docs/indexing.md: those of a recipe of an indexing cam."""

from camgeo.capabilities.indexing.keys import CAM, FILES, LIMITS, PART
from camgeo.schema.fields import FieldTable


def _below(table, path):
    """Path and table of each mapping within a table; a motion's grammar stands on its own page."""
    for field in table.fields:
        if field.table is not None and field.name != "motion":
            yield f"{path}.{field.name}", field.table
            yield from _below(field.table, f"{path}.{field.name}")


LISTED = {"limits indexing": LIMITS.inner}
TABLES = {
    "cam indexing": FieldTable(tuple(field for field in CAM.fields if field.name != "kind"), CAM.alternatives),
    **dict(_below(CAM, "cam indexing")),
    "part indexing": PART.inner,
    "gcode indexing": FILES["gcode"].options,  # needs: milling
}
