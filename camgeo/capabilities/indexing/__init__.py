"""Indexing cams: barrels and globoids that advance a turret by one roller a turn, and hold it at rest between."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=116,
    kinds={"indexing": "indexing cams are barrels or globoids that advance a turret of rollers by one pitch a turn"},
    slips=dict.fromkeys(("indexer", "index", "globoid", "globoidal", "ferguson", "turret"), "indexing"),
    kin=("indexing",),
)
