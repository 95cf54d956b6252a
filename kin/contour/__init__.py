"""Closed chains of lines, arcs and Bezier curves: support, area, offset, intersections."""
