"""Families of cams, one file each: keys of the recipe, motion, follower, exact curve, and advice.

A new family is a file beside these and its line in `camgeo.cams.families`.
"""
