"""The errors of the library: one base for all, a call that makes no sense, surroundings that refuse."""

from __future__ import annotations

from camgeo.common.errors import BusyError, CallError, SurroundingsError
from kin.numeric.errors import CamgeoError

__all__ = ["BusyError", "CallError", "CamgeoError", "SurroundingsError"]
