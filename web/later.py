"""Modules that come when they are first imported: the page begins without what only files need."""

from __future__ import annotations

import sys
from importlib import invalidate_caches
from importlib.machinery import PathFinder
from importlib.util import spec_from_loader
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from importlib.machinery import ModuleSpec
    from types import ModuleType


class Later:
    """Finder and loader of modules that an archive holds: the first import of one of them fetches all of it.

    To look for such a module, as `find_spec` does, fetches nothing.
    """

    def __init__(self, names: Collection[str], fetch: Callable[[], None]) -> None:
        """`names` are the modules and packages at the root of the archive; `fetch` puts it where Python looks."""
        self._names = set(names)
        self._fetch = fetch
        self._here = False

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:  # noqa: ARG002 - importlib's
        """Spec of a module of the archive; None of any other, and of all once the archive is here."""
        return spec_from_loader(name, self) if name in self._names and not self._here else None

    def create_module(self, spec: ModuleSpec) -> None:
        """Leave a module's making to importlib."""

    def exec_module(self, module: ModuleType) -> None:
        """Fetch the archive and run the module that it holds; raises ConnectionError where it does not come."""
        name = module.__name__
        try:
            self._fetch()
        except Exception as error:
            raise ConnectionError(str(error).removeprefix("Error: ")) from error
        self._here = True
        invalidate_caches()
        parent = name.rpartition(".")[0]
        spec = PathFinder.find_spec(name, sys.modules[parent].__path__ if parent else None)
        if spec is None or spec.loader is None:
            raise ModuleNotFoundError(f"{name} is not in the archive that should hold it", name=name)
        module.__spec__, module.__loader__, module.__file__ = spec, spec.loader, spec.origin
        if spec.submodule_search_locations is not None:
            module.__path__ = spec.submodule_search_locations
            module.__package__ = name
        spec.loader.exec_module(module)


def install(fetch: Callable[[], None], listed: Path | None = None) -> None:
    """Have the modules that a file lists, by name, come from what `fetch` gets; the file is later.txt beside this."""
    names = (listed or Path(__file__).with_name("later.txt")).read_text("utf-8").split()
    sys.meta_path.append(Later(names, fetch))
