"""Curves as polygons, arcs and splines, each with a proved error."""
