"""Tables by name to which the core and every capability add their entries."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Protocol, TypeVar

from camgeo.registry import registry

if TYPE_CHECKING:
    from camgeo.registry.capability import Capability


class Entry(Protocol):
    """Entry of a table: it stands behind an entry of the core, or behind all of them if `after` is empty."""

    @property
    def after(self) -> str:
        """Name of the core's entry."""


E = TypeVar("E", bound=Entry)


class Gathered(Mapping[str, E]):
    """The core's entries and those of the capabilities, in one order whatever has been imported.

    A name of the core is found without an import. Any other is looked for in the records that were read, then in all
    of them; to go over the table reads all. `among` has the core's and those of some capabilities.
    """

    def __init__(self, core: Mapping[str, E], of: Callable[[Capability], Mapping[str, E]]) -> None:
        """Make the table of the core's entries; `of` gives those of a capability."""
        self._core = core
        self._of = of
        self._every: dict[str, E] = {}

    def __getitem__(self, name: str) -> E:
        """Entry of this name; raises KeyError."""
        owner = self.owner(name)
        return self._of(registry.capability(owner))[name] if owner else self._core[name]

    def __contains__(self, name: object) -> bool:
        """Whether the core or a capability has an entry of this name."""
        try:
            self.owner(str(name))
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        """Go over the names in order."""
        return iter(self._whole())

    def __len__(self) -> int:
        """Number of entries."""
        return len(self._whole())

    def owner(self, name: str) -> str:
        """Name of the capability that an entry comes from, empty for the core; raises KeyError where there is none."""
        if name in self._core:
            return ""
        read = registry.loaded()
        for capability in (*read, *(other for other in registry.recorded() if other not in read)):
            if name in self._of(registry.capability(capability)):
                return capability
        raise KeyError(name)

    def among(self, capabilities: Collection[str]) -> dict[str, E]:
        """Entries of the core and of these capabilities, in order."""
        groups: dict[str, list[tuple[str, E]]] = {"": []}
        for name, entry in self._core.items():
            groups[name] = [(name, entry)]
        for capability in registry.in_order(capabilities):
            for name, entry in self._of(capability).items():
                groups[entry.after].append((name, entry))
        last = groups.pop("")
        return dict(entry for group in (*groups.values(), last) for entry in group)

    def _whole(self) -> dict[str, E]:
        if not self._every:
            self._every = self.among(registry.recorded())
        return self._every
