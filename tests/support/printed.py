# needs: mechanism
"""Sizes of printed mechanisms, and corners of their plates."""

from __future__ import annotations

from camgeo.capabilities.mechanism.sizes import Sizes

SIZES = Sizes(
    clearance=0.2, gap=0.4, press=0.1, space=1.0, pin=4.0, bar=8.0, plate=6.0, link=5.0, wall=3.0, clip=2.0, knob=30.0
)


def corners(outline):
    """Least and greatest x and y of an outline, mm."""
    return [*outline.points[:, :2].min(axis=0), *outline.points[:, :2].max(axis=0)]
