"""The errors of the library: one base for all that is raised on purpose, one class for a call that makes no sense."""

from __future__ import annotations

from camgeo.common.errors import CallError
from kin.numeric.errors import KinError as CamgeoError

__all__ = ["CallError", "CamgeoError"]
