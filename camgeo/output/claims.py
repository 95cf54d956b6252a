"""Files that `verify` leaves to a capability, such as points measured on a part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.output.extension import OUTPUTS
from camgeo.registry import registry

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from camgeo.output.extension import CallOption


def options() -> dict[str, CallOption]:
    """Options of a call on files of a capability, by name."""
    claiming = OUTPUTS.of(name for name, label in registry.labels().items() if label.suffixes)
    return {name: option for answers in claiming for name, option in answers.options.items()}


def judge_of(path: Path, options: Mapping[str, object]) -> str:
    """Name of the capability that claims a file by suffix and heading, or by options of the call; empty for none.

    Raises OSError where the file cannot be read.
    """
    suffix = path.suffix.lower()
    named = [name for name, label in registry.labels().items() if suffix in label.suffixes]
    return next((name for name in named if OUTPUTS[name].claims(path, options)), "")
