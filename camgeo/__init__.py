"""Disc cams from a short recipe to files, their motion judged from the files themselves.

`load`, `design`, `export`, `check` and `verify` are the library; docs/library.md describes it. Each name is
imported when it is first asked for.
"""

from camgeo.version import __version__

TYPE_CHECKING = False  # as typing has it; importing that takes longer than all the rest
if TYPE_CHECKING:
    from camgeo.api.check import Check, Figure
    from camgeo.api.design import Design, design
    from camgeo.api.edges import Arc, Edges, Line, Spline
    from camgeo.api.errors import BusyError, CallError, CamgeoError, SurroundingsError
    from camgeo.api.loading import load
    from camgeo.api.report import Report
    from camgeo.api.run import check, export, verify
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors

_HOMES = {
    "Arc": "api.edges",
    "BusyError": "api.errors",
    "CallError": "api.errors",
    "CamgeoError": "api.errors",
    "Check": "api.check",
    "Design": "api.design",
    "Edges": "api.edges",
    "Figure": "api.check",
    "Line": "api.edges",
    "Recipe": "recipe.recipe",
    "RecipeErrors": "schema.errors",
    "Report": "api.report",
    "Spline": "api.edges",
    "SurroundingsError": "api.errors",
    "check": "api.run",
    "design": "api.design",
    "export": "api.run",
    "load": "api.loading",
    "verify": "api.run",
}

__all__ = [  # noqa: RUF022 - a list of literals, for whoever reads this file without running it
    "__version__",
    "Arc",
    "BusyError",
    "CallError",
    "CamgeoError",
    "Check",
    "Design",
    "Edges",
    "Figure",
    "Line",
    "Recipe",
    "RecipeErrors",
    "Report",
    "Spline",
    "SurroundingsError",
    "check",
    "design",
    "export",
    "load",
    "verify",
]


def __getattr__(name: str) -> object:
    """Import a name of the library when it is first asked for."""
    if name not in _HOMES:
        raise AttributeError(f"module 'camgeo' has no attribute {name!r}")
    from importlib import import_module

    found = getattr(import_module(f"camgeo.{_HOMES[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """Name what there is, imported or not."""
    return sorted({*globals(), *_HOMES})
