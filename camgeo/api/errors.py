"""The errors of the library: one base for all that is raised on purpose, one class for a call that makes no sense."""

from __future__ import annotations

from kin.numeric.errors import KinError as CamgeoError

__all__ = ["CallError", "CamgeoError"]


class CallError(CamgeoError, ValueError):
    """What a function was asked for cannot be: a file that is none, an unknown form; `faults` has a line for each."""

    def __init__(self, *faults: str) -> None:
        super().__init__(*faults)
        self.faults = faults

    def __str__(self) -> str:
        """Write the faults one a line."""
        return "\n".join(self.faults)
