"""Disc cams from a short recipe to files, their motion judged from the files themselves.

`load`, `design`, `export`, `check` and `verify` are the library; docs/library.md describes it. Each name is
imported when it is first asked for.
"""

from camgeo.version import __version__

TYPE_CHECKING = False  # as typing has it; importing that takes longer than all the rest
if TYPE_CHECKING:
    from camgeo.api.camshaft import CamshaftDesign
    from camgeo.api.check import Check, Figure, Figures
    from camgeo.api.design import Design
    from camgeo.api.designing import design
    from camgeo.api.edges import Arc, Edges, Line, Spline
    from camgeo.api.errors import BusyError, CallError, CamgeoError, SurroundingsError
    from camgeo.api.laws import Law, laws
    from camgeo.api.loading import load
    from camgeo.api.report import File, Remark, Report
    from camgeo.api.run import check, export, verify
    from camgeo.capabilities.sweep.library import Candidate, Search, search
    from camgeo.fit.nodes import ToleranceError
    from camgeo.recipe.camshaft import CamshaftRecipe
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from kin.judge.verify import UnitsError

__all__ = [  # noqa: RUF022 - a list of literals, for whoever reads this file without running it
    "__version__",
    "Arc",
    "BusyError",
    "CallError",
    "CamgeoError",
    "CamshaftDesign",
    "CamshaftRecipe",
    "Candidate",
    "Check",
    "Design",
    "Edges",
    "Figure",
    "Figures",
    "File",
    "Law",
    "Line",
    "Recipe",
    "RecipeErrors",
    "Remark",
    "Report",
    "Search",
    "Spline",
    "SurroundingsError",
    "ToleranceError",
    "UnitsError",
    "check",
    "design",
    "export",
    "laws",
    "load",
    "search",
    "verify",
]

if not TYPE_CHECKING:  # a type checker then knows the names above, and no others
    _HOMES = {
        "Arc": "camgeo.api.edges",
        "BusyError": "camgeo.api.errors",
        "CallError": "camgeo.api.errors",
        "CamgeoError": "camgeo.api.errors",
        "CamshaftDesign": "camgeo.api.camshaft",
        "CamshaftRecipe": "camgeo.recipe.camshaft",
        "Candidate": "camgeo.capabilities.sweep.library",
        "Check": "camgeo.api.check",
        "Design": "camgeo.api.design",
        "Edges": "camgeo.api.edges",
        "Figure": "camgeo.api.check",
        "Figures": "camgeo.api.check",
        "File": "camgeo.api.report",
        "Law": "camgeo.api.laws",
        "Line": "camgeo.api.edges",
        "Recipe": "camgeo.recipe.recipe",
        "RecipeErrors": "camgeo.schema.errors",
        "Remark": "camgeo.api.report",
        "Report": "camgeo.api.report",
        "Search": "camgeo.capabilities.sweep.library",
        "Spline": "camgeo.api.edges",
        "SurroundingsError": "camgeo.api.errors",
        "ToleranceError": "camgeo.fit.nodes",
        "UnitsError": "kin.judge.verify",
        "check": "camgeo.api.run",
        "design": "camgeo.api.designing",
        "export": "camgeo.api.run",
        "laws": "camgeo.api.laws",
        "load": "camgeo.api.loading",
        "search": "camgeo.capabilities.sweep.library",
        "verify": "camgeo.api.run",
    }

    def __getattr__(name: str) -> object:
        """Import a name of the library when it is first asked for."""
        if name not in _HOMES:
            raise AttributeError(f"module 'camgeo' has no attribute {name!r}")
        from importlib import import_module

        found = getattr(import_module(_HOMES[name]), name)
        globals()[name] = found
        return found


def __dir__() -> list[str]:
    """Name what there is, imported or not."""
    return sorted({*globals(), *__all__})
