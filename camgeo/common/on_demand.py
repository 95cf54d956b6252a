"""Tables whose values are made at first use, such as records that have modules of their own."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TypeVar

T = TypeVar("T")


class OnDemand(Mapping[str, T]):
    """Mapping of the names in a collection to values, each made by `make` at its first use.

    Where the collection changes, so do the names of the mapping.
    """

    def __init__(self, names: Collection[str], make: Callable[[str], T]) -> None:
        self._names = names
        self._make = make
        self._values: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        """Value of a name; raises KeyError for an unknown one."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._values:
            self._values[name] = self._make(name)
        return self._values[name]

    def __contains__(self, name: object) -> bool:
        """Whether a name is known; no value is made."""
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        """Names in their order; no value is made."""
        return iter(self._names)

    def __len__(self) -> int:
        """Number of names."""
        return len(self._names)
