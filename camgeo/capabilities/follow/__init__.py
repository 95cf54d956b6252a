"""The motion of a contour without a recipe: what a follower does that runs on a drawing or a solid of any origin."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=30,
    commands={"follow": "The motion that a drawing or a solid gives a follower; a table, a recipe and a page of it."},
    names={"Followed": "followed", "Rest": "followed", "follow": "library"},
)
