"""Starters of single cams."""

from camgeo.recipe.starter import STARTERS

OF_CAMS = tuple(name for name, each in STARTERS.items() if each.kind)
