"""Tolerance budget: what each dimension may be off, from the error that the follower or a linkage's output may have."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=40,
    words=("budget",),
    commands={"budget": "What each dimension of a cam may be off; a simulation of made parts."},
    absent="budget is not given",
    kin=("budget",),
)
