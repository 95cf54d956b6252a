"""A part in hand: points measured on it, its profile, the motion that it will make, each with its uncertainty."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=80,
    words=("made", "dmis"),
    formats={"dmis": "dmis"},
    kin=("made",),
    suffixes=(".csv", ".txt", ".xyz", ".asc", ".dmo", ".dmi", ".dms"),
    sources={"from": "points of a cam (repeatable): KIND is then a recipe of its follower and part, FILE the new one"},
)
