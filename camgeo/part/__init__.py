"""The part round the contour: each feature in a file of its own, its openings and walls, and what a file is held to."""
