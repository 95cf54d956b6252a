"""Checks that a run of a recipe is going to make, listed without running it.

Only the intended motion is built, which costs milliseconds, no curve and no file. A run may differ where an undercut
decides: without a contour no file is judged, and a trimmed one only against a limit of the motion that is given; and
where a linkage does not turn, by which files are not judged then.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from camgeo.checks.declaration import CheckFacts
from camgeo.checks.declared import declarations

if TYPE_CHECKING:
    from camgeo.cams.follower import Follower
    from camgeo.recipe.recipe import Recipe


class Foreseen(NamedTuple):
    """A check that a run will make: its name, and the name of its file, None for the exact curve and the motion."""

    name: str
    file: str | None = None

    def __str__(self) -> str:
        """Name of the check, with its file in brackets."""
        return self.name if self.file is None else f"{self.name}[{self.file}]"


def foreseen(recipe: Recipe) -> tuple[Foreseen, ...]:
    """All checks that a run of a recipe will make; the checks of each file come last.

    Raises kin's IntentError where the recipe's motion cannot be made.
    """
    scene = CheckFacts(recipe, _follower(recipe))
    every = declarations(recipe)
    expected = [Foreseen(check.name) for check in every if check.exact is not None and check.exact(scene)]
    # of a file, what its contour is in itself comes first; then the play between it and the follower, and checks that
    # the exact cam has too, in the order in which they are declared
    in_turn = sorted(every, key=lambda check: check.backlash or check.exact is not None)
    for request in recipe.export.files:
        names = recipe.filenames(request)
        for file in names:
            made = (check for check in in_turn if check.of_file is not None and check.of_file(scene, request))
            # checks between two discs stand on the last file
            expected += [Foreseen(check.name, file) for check in made if file == names[-1] or not check.between]
    return tuple(expected)


def _follower(recipe: Recipe) -> Follower:
    """The follower; the motion is built, so that one that cannot be is reported first."""
    return recipe.cam.exact(framed=recipe.linkage is not None).follower
