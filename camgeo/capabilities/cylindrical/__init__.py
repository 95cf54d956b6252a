"""Cylindrical cams: drums with a groove, a rib or an end face that lead a roller along their axis."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=115,
    kinds={
        "cylindrical": "cylindrical cams are drums with a groove, a rib or an end face for one roller along the axis"
    },
    slips=dict.fromkeys(("barrel", "drum"), "cylindrical"),
    kin=("cylindrical",),
    names={"FollowedDrum": "followed"},
)
