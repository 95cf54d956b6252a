"""Linear cams: a plate that travels to and fro, or endlessly, and lifts a follower from its edge or in its groove."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=110,
    kinds={"linear": "linear cams are plates on a slide for one roller, shoe or knife edge on a stem or an arm"},
    kin=("linear",),
)
