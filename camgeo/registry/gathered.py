"""Tables by name to which the core and every capability add their entries."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

if TYPE_CHECKING:
    from camgeo.registry.slot import Slot


class Entry(Protocol):
    """Entry of a table: it stands behind an entry of the core, or behind all of them if `after` is empty."""

    @property
    def after(self) -> str:
        """Name of the core's entry behind which this one stands; empty for a place behind all of them."""


A = TypeVar("A")
E = TypeVar("E", bound=Entry)


class Gathered(Mapping[str, E], Generic[A, E]):
    """Entries of the core and of the capabilities, in one order whatever has been imported.

    A name of the core needs no import. Any other name is sought in the answers of capabilities that were imported, then
    in all of them; iteration imports all. `among` gives the entries of the core and of some capabilities.
    """

    def __init__(self, core: Mapping[str, E], slot: Slot[A], entries_of: Callable[[A], Mapping[str, E]]) -> None:
        """Make the table of the core's entries; `entries_of` gives those in a capability's answers to a question."""
        self._core = core
        self._slot = slot
        self._entries_of = entries_of
        self._every: list[str] = []

    def __getitem__(self, name: str) -> E:
        """Entry of this name; raises KeyError where neither the core nor a capability has one."""
        owner = self.owner(name)
        return self._entries_of(self._slot[owner])[name] if owner else self._core[name]

    def __contains__(self, name: object) -> bool:
        """Whether the core or a capability has an entry of this name."""
        try:
            self.owner(str(name))
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        """Names of all entries in order."""
        return iter(self._whole())

    def __len__(self) -> int:
        """Number of entries."""
        return len(self._whole())

    __hash__ = object.__hash__

    def __eq__(self, other: object) -> bool:
        """Whether both are the same object: two tables are not compared entry by entry."""
        return self is other

    def owner(self, name: str) -> str:
        """Name of the capability that an entry comes from, empty for the core; raises KeyError for an unknown entry."""
        if name in self._core:
            return ""
        loaded = self._slot.loaded()
        for capability in (*loaded, *(unread for unread in self._slot.answering() if unread not in loaded)):
            if name in self._entries_of(self._slot[capability]):
                return capability
        raise KeyError(name)

    def among(self, capabilities: Collection[str]) -> dict[str, E]:
        """Entries of the core and of these capabilities by name, in order."""
        added = {name: entry for capability in self._added(capabilities) for name, entry in capability.items()}
        return {name: added[name] if name in added else self._core[name] for name in self._ordered(capabilities)}

    def _added(self, capabilities: Collection[str]) -> Iterator[Mapping[str, E]]:
        return map(self._entries_of, self._slot.of(capabilities))

    def _ordered(self, capabilities: Collection[str]) -> list[str]:
        """Names of the core and of these capabilities, in order; the core's entries are not imported.

        A capability's name stands behind the core's name that its entry gives as `after`, or behind all of them.
        """
        groups: dict[str, list[str]] = {"": [], **{name: [name] for name in self._core}}
        for entries in self._added(capabilities):
            for name, entry in entries.items():
                groups[entry.after].append(name)
        last = groups.pop("")
        return [name for group in (*groups.values(), last) for name in group]

    def _whole(self) -> list[str]:
        if not self._every:
            self._every = self._ordered(self._slot.answering())
        return self._every
