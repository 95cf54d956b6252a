"""The files beside this one that a page is made of: style, script and frame."""

from __future__ import annotations

from importlib.resources import files


def asset(name: str) -> str:
    """Return a file of this folder."""
    return (files("camgeo.report.page") / name).read_text("utf-8")
