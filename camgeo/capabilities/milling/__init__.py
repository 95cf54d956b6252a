"""Milling programs: the cutter's path along the contour, judged by what the cutter leaves."""

from camgeo.registry.label import Label

LABEL = Label(rank=50, words=("gcode",), formats={"gcode": "format"})
