"""Cams from a short recipe to files, their motion judged from the files themselves.

`load`, `design`, `export`, `check` and `verify` are the library; docs/library.md describes it. Each name is
imported when it is first asked for.
"""

from camgeo.version import __version__

TYPE_CHECKING = False  # in place of the name in `typing`, whose import takes longer than all else here
if TYPE_CHECKING:
    from camgeo import capabilities
    from camgeo.api.check import Check, Figure, Figures
    from camgeo.api.design import Design
    from camgeo.api.designing import design
    from camgeo.api.edges import Arc, Edges, Line, Spline
    from camgeo.api.laws import Law, laws
    from camgeo.api.loading import load
    from camgeo.api.report import File, Remark, Report
    from camgeo.api.run import check, export, verify
    from camgeo.capabilities import *  # noqa: F403 - their folder says which names these are
    from camgeo.common.errors import BusyError, CallError, SurroundingsError
    from camgeo.fit.nodes import ToleranceError
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from kin.numeric.errors import CamgeoError
    from kin.read.checks import UnitsError

    __all__ = [  # noqa: RUF022 - a list of literals, for tools that read this file without running it
        "__version__",
        "Arc",
        "BusyError",
        "CallError",
        "CamgeoError",
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
        "Spline",
        "SurroundingsError",
        "ToleranceError",
        "UnitsError",
        "check",
        "design",
        "export",
        "laws",
        "load",
        "verify",
    ]
    __all__ += capabilities.__all__

if not TYPE_CHECKING:  # a type checker then knows the names above, and no others
    _CORE = {
        "Arc": "camgeo.api.edges",
        "BusyError": "camgeo.common.errors",
        "CallError": "camgeo.common.errors",
        "CamgeoError": "kin.numeric.errors",
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
        "Spline": "camgeo.api.edges",
        "SurroundingsError": "camgeo.common.errors",
        "ToleranceError": "camgeo.fit.nodes",
        "UnitsError": "kin.read.checks",
        "check": "camgeo.api.run",
        "design": "camgeo.api.designing",
        "export": "camgeo.api.run",
        "laws": "camgeo.api.laws",
        "load": "camgeo.api.loading",
        "verify": "camgeo.api.run",
    }

    def _homes() -> dict[str, str]:
        """Module of each name of the library: the names of the core, and those that labels of capabilities add."""
        from camgeo.registry.registry import library_names

        return {**_CORE, **library_names()}

    def __getattr__(name: str) -> object:
        """Value of a name of the library, imported at its first use; raises AttributeError for an unknown name."""
        if name == "__all__":
            return sorted(["__version__", *_homes()])
        home = _CORE.get(name) or _homes().get(name)
        if home is None:
            raise AttributeError(f"module 'camgeo' has no attribute {name!r}")
        from importlib import import_module

        value = getattr(import_module(home), name)
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        """Names of the library in alphabetical order, imported or not."""
        return sorted({*globals(), *_homes()})
