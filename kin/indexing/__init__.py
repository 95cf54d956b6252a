"""Judging indexing cams: barrels and globoids whose rib leads the rollers of a turret, by positions of the rollers."""
