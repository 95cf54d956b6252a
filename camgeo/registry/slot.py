"""Questions that capabilities answer, each in the file of their folder that bears the name of the question.

Who asks declares in an `extension` what is asked, a frozen dataclass whose fields have defaults, and a `Slot` of that
dataclass. A capability has such a dataclass as `ANSWERS` of the file; without the file its answers are the defaults.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from camgeo.registry.registry import PACKAGE, folder, labels

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

A = TypeVar("A")
T = TypeVar("T")
EMPTY: Mapping[str, Any] = MappingProxyType({})


def always(value: T) -> Callable[..., T]:
    """Function of any positional arguments that returns this value."""
    return lambda *_: value


NO_CHECK: Callable[..., None] = always(None)
"""Check that notes no fault and refuses nothing."""


@cache
def modules(capability: str) -> frozenset[str]:
    """Names of the modules in the folder of a capability."""
    return frozenset(path.stem for path in (folder() / capability).iterdir() if path.suffix in {".py", ".pyc"})


class Slot(Generic[A]):
    """A question by name, and the answers of each capability to it."""

    def __init__(self, name: str, default: A) -> None:
        """Make the question of this name; `default` are the answers of a capability without a file of that name."""
        self.name = name
        self._default = default
        self._answers: dict[str, A] = {}

    def __getitem__(self, capability: str) -> A:
        """Answers of a capability, or the default; raises KeyError for an unknown capability.

        Raises TypeError for a file of the question's name without answers of its class.
        """
        if capability not in self._answers:
            labels()[capability]
            if self.name not in modules(capability):
                return self._default
            module = import_module(f"{PACKAGE}.{capability}.{self.name}")
            answers = getattr(module, "ANSWERS", None)
            if not isinstance(answers, type(self._default)):
                raise TypeError(f"{module.__name__}: ANSWERS are no {type(self._default).__name__}")
            self._answers[capability] = answers
        return self._answers[capability]

    def answering(self) -> tuple[str, ...]:
        """Names of the capabilities that have a file of the question's name, in order of rank."""
        return tuple(name for name in labels() if self.name in modules(name))

    def loaded(self) -> tuple[str, ...]:
        """Names of the capabilities whose answers were imported so far, in order of rank."""
        return tuple(name for name in self.answering() if name in self._answers)

    def of(self, names: Iterable[str]) -> list[A]:
        """Answers of those of the named capabilities that have a file of the question's name, in order of rank."""
        chosen = set(names)
        return [self[name] for name in self.answering() if name in chosen]
