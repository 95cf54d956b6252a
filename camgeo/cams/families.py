"""The families there are: a new one is its file and its line here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cams import constant_breadth, constant_diameter, disc, double_roller, flat_pair, support

if TYPE_CHECKING:
    from camgeo.cams.family import Family

FAMILIES: dict[str, Family] = {
    module.FAMILY.kind: module.FAMILY
    for module in (
        support,
        constant_breadth,
        constant_diameter,
        disc,
        double_roller,
        flat_pair,
    )
}
