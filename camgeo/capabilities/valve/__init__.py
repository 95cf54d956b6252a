"""The valve that a tappet works: its lift by the rocker's ratio less the lash, its events, a table, plots."""

from camgeo.registry.label import Label

LABEL = Label(rank=45, words=("valve",), absent="valve is not given")
