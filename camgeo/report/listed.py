"""How a report lists a file: its name, size and checksum."""

from __future__ import annotations

import hashlib
from typing import Any


def listed(name: str, data: bytes) -> dict[str, Any]:
    """A file's entry in a report: its name, size and checksum."""
    return {"path": name, "bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
