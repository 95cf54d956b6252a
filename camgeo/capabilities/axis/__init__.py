"""Motions of a drive alone: an axis that follows a master, without a cam, a follower or metal."""

from camgeo.registry.label import Label

LABEL = Label(rank=120, roots=("axis",))
