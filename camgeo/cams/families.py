"""The families of cams by kind, each imported on first use; a new one is its file and its kind here."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from camgeo.common.on_demand import OnDemand

if TYPE_CHECKING:
    from camgeo.cams.family import Family

KINDS = ("support", "constant-breadth", "constant-diameter", "disc", "double-roller", "flat-pair")


def _family(kind: str) -> Family:
    family: Family = import_module(f"camgeo.cams.{kind.replace('-', '_')}").FAMILY
    return family


FAMILIES = OnDemand(KINDS, _family)
