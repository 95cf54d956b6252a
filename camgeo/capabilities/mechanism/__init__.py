"""Sets to print: the other bodies of the mechanism, with clearance, and their places over a turn."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=40, words=("mechanism", "parts: all"), absent="no file is requested with parts: all", kin=("mechanism",)
)
