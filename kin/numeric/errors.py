"""The base of all errors that are raised on purpose, and the error of a search that ended short of its promise."""

from __future__ import annotations


class KinError(Exception):
    """Base of every error that kin and camgeo raise on purpose; the library knows it as `camgeo.CamgeoError`."""


class UnsettledError(KinError, ArithmeticError):
    """A search that ended short of its promise: what was sought, and how far it came.

    `at` is the parameter near which it ended, None where there is no such place.
    """

    def __init__(self, reason: str, at: float | None = None) -> None:
        super().__init__(reason if at is None else f"{reason} near {at:.12g}")
        self.reason, self.at = reason, at
