"""Drawings: DXF and SVG as closed contours."""
