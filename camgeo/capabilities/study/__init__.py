"""Error against run time of each output form at each tolerance, and the margins of a recipe."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=10,
    commands={"study": "Error against run time of each output form; a recipe's margins."},
    reports=("study.json",),
)
