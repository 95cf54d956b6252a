"""The table of the lift that a roller on a stem through the shaft has on the ground metal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.tables.ground import ground_form

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values


def _check(file: Values, _: Values, reader: Reader) -> None:
    if "roller" not in file:
        field_path = f"{file['path']}.csv.as"
        reader.fault_at(field_path, "the lift of a roller needs its diameter", "'lift'", "give roller beside it")


FORM = ground_form("lift", _check, "roller")
