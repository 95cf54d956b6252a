"""What stands beside the core: each folder one capability, which registers itself by a label.

The names below are what type checkers are told of `import camgeo`; when it runs, it asks the labels for them.
"""

# ruff: noqa: TC004 - the list of names is for type checkers too

TYPE_CHECKING = False  # as typing has it
if TYPE_CHECKING:
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe  # needs: camshaft
    from camgeo.capabilities.camshaft.library import CamshaftDesign  # needs: camshaft
    from camgeo.capabilities.cylindrical.followed import FollowedDrum  # needs: cylindrical
    from camgeo.capabilities.follow.followed import Followed, Rest  # needs: follow
    from camgeo.capabilities.follow.library import follow  # needs: follow
    from camgeo.capabilities.sweep.library import Candidate, Search, search  # needs: sweep

    __all__: list[str] = [
        "CamshaftDesign",  # needs: camshaft
        "CamshaftRecipe",  # needs: camshaft
        "Candidate",  # needs: sweep
        "Followed",  # needs: follow
        "FollowedDrum",  # needs: cylindrical
        "Rest",  # needs: follow
        "Search",  # needs: sweep
        "follow",  # needs: follow
        "search",  # needs: sweep
    ]
