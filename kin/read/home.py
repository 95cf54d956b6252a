"""A place for libraries that keep files in the user's home folder, where there is none or it cannot be written.

ezdxf and matplotlib keep a list of the system's fonts there. Without a home folder they print notices, or fail; neither
is needed for what is read and drawn here. Of ezdxf they are an eighth of its import, for which it has no switch.
"""

from __future__ import annotations

import os
import sys
from functools import lru_cache
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_FOLDERS = {"XDG_CACHE_HOME": "~/.cache", "XDG_CONFIG_HOME": "~/.config"}
_LIBRARIES = ("ezdxf", "matplotlib")
_FONTS = "ezdxf.fonts.fonts"


class _FontsLater:
    """Finder of ezdxf's fonts, which are loaded when something of them is asked for."""

    def find_spec(self, name: str, path: Sequence[str] | None = None, _target: object = None) -> ModuleSpec | None:
        """What Python asks of a finder."""
        spec = PathFinder.find_spec(name, path) if name == _FONTS else None
        if spec is not None and spec.loader is not None:
            from importlib.util import LazyLoader

            sys.meta_path.remove(self)
            spec.loader = LazyLoader(spec.loader)
        return spec


@lru_cache(maxsize=1)
def prepare_home() -> None:
    """Send ezdxf and matplotlib to a temporary folder where the home folder is missing or cannot be written.

    ezdxf's fonts are not loaded until they are asked for.

    The folder is removed when the process ends. The call comes before the import of either library, and before other
    processes are started.
    """
    import logging

    for library in _LIBRARIES:  # without a handler Python prints their warnings
        logging.getLogger(library).addHandler(logging.NullHandler())
    if _FONTS not in sys.modules:
        sys.meta_path.insert(0, _FontsLater())
    if all(_usable(os.environ.get(variable) or default) for variable, default in _FOLDERS.items()):
        return
    import atexit
    import shutil
    import tempfile

    try:
        folder = tempfile.mkdtemp(prefix="camgeo-home-")
    except OSError:
        return  # without a temporary folder nothing can be done, and the libraries' own notices say why
    owner = os.getpid()

    def remove() -> None:
        if os.getpid() == owner:  # a forked process inherits this function, and leaves the folder alone
            shutil.rmtree(folder, ignore_errors=True)

    atexit.register(remove)
    for variable in (*_FOLDERS, "MPLCONFIGDIR"):
        os.environ[variable] = folder


def _usable(name: str) -> bool:
    """Whether the folders of both libraries in the folder `name` can be written, or made where there are none."""
    try:
        folder = Path(name).expanduser()
    except RuntimeError:  # no home folder is known
        return False
    return all(_writable(folder / library) for library in _LIBRARIES)


def _writable(folder: Path) -> bool:
    """Whether a folder can be written, or made where there is none yet."""
    at = os.path.abspath(folder)  # noqa: PTH100 - pathlib raises where it may not look
    while not os.path.lexists(at):
        at = os.path.dirname(at)  # noqa: PTH120
    return os.path.isdir(at) and os.access(at, os.W_OK | os.X_OK)  # noqa: PTH112
