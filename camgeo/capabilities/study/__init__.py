"""Error against run time: what each output form costs at each tolerance, and how far a recipe is from trouble."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=10,
    commands={"study": "Error against run time of each output form; a recipe's margins."},
    reports=("study.json",),
    record=False,
)
