"""A place for libraries that keep files in the user's home folder, where there is none or it cannot be written.

ezdxf and matplotlib keep a list of the system's fonts there. Without a home folder they print notices, or fail; neither
is needed for what is read and drawn here.
"""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path

_FOLDERS = {"XDG_CACHE_HOME": "~/.cache", "XDG_CONFIG_HOME": "~/.config"}
_LIBRARIES = ("ezdxf", "matplotlib")


@lru_cache(maxsize=1)
def prepare_home() -> None:
    """Send ezdxf and matplotlib to a temporary folder where the home folder is missing or cannot be written.

    The folder is removed when the process ends. The call comes before the import of either library, and before other
    processes are started.
    """
    import logging

    for library in _LIBRARIES:  # without a handler Python prints their warnings
        logging.getLogger(library).addHandler(logging.NullHandler())
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
