"""Tables of keys of docs/linear.md: those of a recipe of a linear cam."""

from camgeo.capabilities.linear.keys import CAM, HOLE, LIMITS, PART, SLOT
from camgeo.schema.fields import FieldTable


def _below(table, path):
    """Path and table of each mapping within a table; a motion's grammar stands on its own page."""
    for field in table.fields:
        if field.table is not None and field.name != "motion":
            yield f"{path}.{field.name}", field.table
            yield from _below(field.table, f"{path}.{field.name}")


LISTED = {"limits linear": LIMITS.inner}
TABLES = {
    "cam linear": FieldTable(tuple(field for field in CAM.fields if field.name != "kind")),
    **dict(_below(CAM, "cam linear")),
    "part linear": PART.inner,
    "part linear.holes": HOLE,
    "part linear.slots": SLOT,
    **dict(_below(PART.inner, "part linear")),
}
