"""The shop drawing: views, dimensions, tolerances, tables and verdict of a disc, as PDF and DXF."""

from camgeo.registry.label import Label

LABEL = Label(rank=75, words=("sheet",), formats={"sheet": "format"})
