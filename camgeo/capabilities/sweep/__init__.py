"""Search among designs of one recipe: which vary, by which figures they are limited and ranked."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=20,
    words=("sweep",),
    commands={"sweep": "Many designs of one recipe, ranked; the best become recipes."},
    reports=("sweep.json",),
    names={"Candidate": "library", "Search": "library", "search": "library"},
)
