"""Files of this folder: style, script and frames of a page."""

from __future__ import annotations

from importlib.resources import files


def asset(name: str) -> str:
    """Return the text of a file of this folder by its name; raises FileNotFoundError for an unknown one."""
    return (files("camgeo.report.page") / name).read_text("utf-8")
