"""The follower train at a speed: forces of a rigid one, float and impacts of an elastic one, the guide of a stem."""

from camgeo.registry.label import Label

LABEL = Label(rank=30, words=("dynamics",), absent="dynamics is not given", kin=("dynamics",))
