"""What is made once in a run of the tests, however many processes share it (pytest-xdist)."""

from __future__ import annotations

import os
import shutil
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import pytest

PATIENCE = 300.0  # s for which one process waits for what another makes


def common(factory: pytest.TempPathFactory) -> Path:
    """Give the folder that all processes of this run have in common."""
    base = factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


def once(folder: Path, fill: Callable[[Path], object], patience: float = PATIENCE) -> Path:
    """Let the first process that asks for a folder fill it; the others wait until that is done, s at most."""
    done = folder.with_name(f"{folder.name}.done")
    folder.parent.mkdir(parents=True, exist_ok=True)
    until = time.monotonic() + patience
    while not done.exists():
        try:
            folder.mkdir()
        except FileExistsError:
            assert time.monotonic() < until, f"{folder.name} is not made"
            time.sleep(0.05)
            continue
        try:
            fill(folder)
        except BaseException:
            shutil.rmtree(folder)  # so that the next one who asks sees the same failure
            raise
        done.touch()
    return folder
