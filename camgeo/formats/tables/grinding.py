"""The table of a grinding wheel's places over the angle of the work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.tables.ground import ground_form

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values


def _check(file: Values, _: Values, reader: Reader) -> None:
    path = f"{file['path']}.csv"
    if "manufacture.wheel" not in reader.marks:
        remedy = "give manufacture.wheel, its diameter, such as `manufacture: {wheel: 400}`"
        reader.fault_at(f"{path}.as", "a grinder's table needs the wheel", "'grinding'", remedy)


FORM = ground_form("grinding", _check)
