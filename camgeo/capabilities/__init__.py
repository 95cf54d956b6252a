"""What stands beside the core: each folder one capability, which registers itself by a record.

The names below are what type checkers are told of `import camgeo`; when it runs, it asks the labels for them.
"""

# ruff: noqa: TC004 - the list of names is for type checkers too

TYPE_CHECKING = False  # as typing has it
if TYPE_CHECKING:
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.library import CamshaftDesign
    from camgeo.capabilities.follow.library import Followed, Rest, follow  # needs: follow
    from camgeo.capabilities.sweep.library import Candidate, Search, search

    __all__: list[str] = [
        "CamshaftDesign",
        "CamshaftRecipe",
        "Candidate",
        "Followed",  # needs: follow
        "Rest",  # needs: follow
        "Search",
        "follow",  # needs: follow
        "search",
    ]
