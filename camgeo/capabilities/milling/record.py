"""What milling adds: the checks of programs. Their format is in the module `format`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.registry.capability import Capability

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.checks.declared import Declared


def _checks() -> Sequence[Declared]:
    from camgeo.capabilities.milling.checks import CHECKS

    return CHECKS


CAPABILITY = Capability(checks=_checks)
