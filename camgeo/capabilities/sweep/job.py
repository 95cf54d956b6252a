"""What decides the outcome of a sweep, as one object that travels to any worker, and its key."""

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
    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.plan import Plan

REVISION = 3  # raised with every change of what a figure comes to, as the version is with every release

Compute = Callable[[Any, "NDArray[np.float64]"], Mapping[str, "NDArray[np.float64]"]]


class VersionsError(CamgeoError):
    """A worker would compute something else: its versions, or its reading of the recipe, are not those of the sweep."""


@dataclass(frozen=True)
class Job:
    """A plan and what is asked of each design.

    `compute(scene, values (m, axes))` gives the figures of m designs, arrays (m,) of float64 by name; it is a function
    of a module, so that a worker finds it by name. `scene` is plain data without what has no bearing on a figure.
    """

    plan: Plan
    scene: Any
    compute: Compute

    @property
    def key(self) -> str:
        """SHA-256 of the plan, the scene, the function's name, and revision and versions of what computes."""
        told = {
            "plan": repr(self.plan),
            "scene": repr(self.scene),
            "compute": f"{self.compute.__module__}.{self.compute.__qualname__}",
            "revision": REVISION,
            "versions": versions(self.plan),
        }
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def versions(plan: Plan) -> dict[str, str]:
    """Versions that the figures depend on; scipy's only where it makes the plan."""
    found = {"camgeo": __version__, "numpy": np.__version__}
    if plan.method == "sobol":
        import scipy

        found["scipy"] = scipy.__version__
    return found


def result(job: Job, number: int, key: str) -> bytes:
    """Compute a chunk: the bytes of its file. Raises VersionsError where `key` is not the job's key here."""
    if job.key != key:
        here = ", ".join(f"{name} {version}" for name, version in versions(job.plan).items())
        raise VersionsError(f"a worker has other versions than this run, or reads the recipe otherwise: {here}")
    first, last = job.plan.span(number)
    return encode(key, first, last, job.compute(job.scene, job.plan.values(first, last)))
