"""The part round the contour: a module for each feature, openings, walls, and records for the judge."""
