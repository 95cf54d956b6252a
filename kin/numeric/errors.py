"""The base of all errors that are raised on purpose, and the error of a search that did not reach its accuracy."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class CamgeoError(Exception):
    """Base of every error that kin and camgeo raise on purpose: `camgeo.CamgeoError` of the library."""

    def __reduce__(self) -> tuple[Callable[..., CamgeoError], tuple[object, ...]]:
        """Pickle the arguments and attributes: an error cannot be made again from its text."""
        return _again, (type(self), self.args, self.__dict__)


def _again(kind: type[CamgeoError], args: tuple[object, ...], state: dict[str, object]) -> CamgeoError:
    error = kind.__new__(kind, *args)
    error.args = args
    error.__dict__.update(state)
    return error


class UnsettledError(CamgeoError, ArithmeticError):
    """A search that did not reach its accuracy: what was sought, and how far the search came.

    `at` is the parameter near which it ended, None where there is no single place.
    """

    def __init__(self, reason: str, at: float | None = None) -> None:
        super().__init__(reason if at is None else f"{reason} near {at:.12g}")
        self.reason, self.at = reason, at
