"""The job of a sweep: all that decides its outcome, as one object that travels to any worker, with a key."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.sweep.store import encode
from camgeo.version import __version__
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.sweep.plan import Plan
    from kin.numeric.arrays import Array

REVISION = 3  # raised with every change of a figure's values, as the version is with every release

Compute = Callable[[Any, "Array"], Mapping[str, "Array"]]


class VersionsError(CamgeoError):
    """A worker has other versions than the run, or reads the recipe otherwise, and so would compute other figures."""


@dataclass(frozen=True)
class Job:
    """A plan, and how the figures of its designs are computed.

    `compute(scene, values (m, axes))` gives the figures of m designs, arrays (m,) of float64 by name; it is a function
    of a module, so that a worker finds it by name. `scene` is plain data, all of which has a bearing on a figure.
    """

    plan: Plan
    scene: Any
    compute: Compute

    @property
    def key(self) -> str:
        """SHA-256 of the plan, the scene, the function's name, and revision and versions of what computes."""
        parts = {
            "plan": repr(self.plan),
            "scene": repr(self.scene),
            "compute": f"{self.compute.__module__}.{self.compute.__qualname__}",
            "revision": REVISION,
            "versions": versions(self.plan),
        }
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def versions(plan: Plan) -> dict[str, str]:
    """Versions of the packages that figures depend on, by name; scipy's only where it makes the plan."""
    packages = {"camgeo": __version__, "numpy": np.__version__}
    if plan.method == "sobol":
        import scipy

        packages["scipy"] = scipy.__version__
    return packages


def result(job: Job, number: int, key: str) -> bytes:
    """Bytes of a chunk's file, computed here. Raises VersionsError where the job has another key here than `key`."""
    if job.key != key:
        here = ", ".join(f"{name} {version}" for name, version in versions(job.plan).items())
        raise VersionsError(f"a worker has other versions than this run, or reads the recipe otherwise: {here}")
    first, last = job.plan.span(number)
    return encode(key, first, last, job.compute(job.scene, job.plan.values(first, last)))
