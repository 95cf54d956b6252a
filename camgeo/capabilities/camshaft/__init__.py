"""Camshafts: lobes of several cams on one shaft, made as one solid, and when they lift."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=60,
    roots=("camshaft",),
    names={"CamshaftDesign": "library", "CamshaftRecipe": "keys"},
)
