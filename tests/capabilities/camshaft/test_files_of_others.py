"""A file that another capability writes of a camshaft: what it is given, and what is told of the file."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from camgeo.capabilities.camshaft import pipeline
from camgeo.recipe.export import FileRequest


@pytest.mark.parametrize(("units", "mm"), [("mm", 1.0), ("inch", 25.4)])
def test_the_writer_gets_recipe_cams_request_and_place(monkeypatch: pytest.MonkeyPatch, units: str, mm: float) -> None:
    calls: list[Any] = []
    stages: list[str] = []
    monkeypatch.setattr(pipeline, "writers", lambda: {"dxf": lambda *given: calls.append(given)})
    recipe = SimpleNamespace(engine="engine", units=units)
    lobes = [SimpleNamespace(on_shaft=lambda engine, name=name: (name, engine)) for name in ("intake", "exhaust")]
    clock = SimpleNamespace(stage=lambda name: stages.append(name) or nullcontext())
    request, path = FileRequest("dxf"), Path("c.dxf")
    file, checks = pipeline._made(SimpleNamespace(recipe=recipe, lobes=lobes, clock=clock), request, path)
    assert calls == [(recipe, [("intake", "engine"), ("exhaust", "engine")], request, path)]
    assert stages == ["dxf"]
    assert (file.path, file.request, file.units, checks) == (path, request, mm, ())
