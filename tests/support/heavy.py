"""Libraries that take long to import, imported by the first test that asks them for something, not on collection."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class Heavy:
    """Stands for a module, `Heavy("scipy.stats")`, until one of its names is asked for."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):  # pytest looks through all that a module of tests has
            raise AttributeError(name)
        return getattr(import_module(self._name), name)


distributed = Heavy("distributed")
ezdxf = Heavy("ezdxf")
interpolate = Heavy("scipy.interpolate")
lib3mf = Heavy("lib3mf")
manifold3d = Heavy("manifold3d")
optimize = Heavy("scipy.optimize")
parquet = Heavy("pyarrow.parquet")
qmc = Heavy("scipy.stats.qmc")
resvg = Heavy("resvg_py")
shapely = Heavy("shapely")
spatial = Heavy("scipy.spatial")
trimesh = Heavy("trimesh")
