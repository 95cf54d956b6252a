"""The part round the contour: openings, hub, chamfer, and the walls that they leave."""
