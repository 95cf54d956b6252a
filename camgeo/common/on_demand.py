"""Tables whose values are made when they are first asked for, such as what a module of its own declares."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TypeVar

T = TypeVar("T")


class OnDemand(Mapping[str, T]):
    """Names that are known from the start, and their values by `make`, each of which is called once.

    Where the names are those of a mapping that grows or shrinks, so does the table.
    """

    def __init__(self, names: Collection[str], make: Callable[[str], T]) -> None:
        self._names = names
        self._make = make
        self._values: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        """The value of a name; raises KeyError for one that there is not."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._values:
            self._values[name] = self._make(name)
        return self._values[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is such a name; nothing is made."""
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        """Go over the names; nothing is made."""
        return iter(self._names)

    def __len__(self) -> int:
        """How many names there are."""
        return len(self._names)
