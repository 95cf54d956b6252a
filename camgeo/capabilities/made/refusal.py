"""What kin refuses of points, as an error of the call that names their files."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from kin.follower.frame_contact import FrameError
from kin.follower.motion_error import ContactError
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


@contextmanager
def as_call_errors(paths: Sequence[Path], name: str = "") -> Iterator[None]:
    """Turn what kin refuses of points into CallErrors that name their files, and the cam where there are several."""
    files, of = ", ".join(escaped(str(path)) for path in paths), f"{name}: " if name else ""
    try:
        yield
    except (ContactError, FrameError) as error:
        raise CallError(f"{files}: {of}on the metal that these points tell, {error}") from error
    except CallError as error:
        if not name:
            raise
        raise CallError(*(f"{of}{fault}" for fault in error.faults)) from error
    except (UnsettledError, ValueError) as error:
        raise CallError(f"{files}: {of}{error}") from error
